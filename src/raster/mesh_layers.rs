//! The layers of a mesh in a view: vertices are projected, triangles cut off at the near plane,
//! and sorted into the tiles that they touch.

use fearless_simd::Simd;
use glam::DVec3;

use super::buffers::SurfaceId;
use super::closed::{ClosedMesh, Slant};
use super::layers::{Fragments, LayerSource, Tile};
use super::target::Target;
use super::triangle::{Batch, Triangle};
use super::view::RasterView;
use crate::{Cancelled, Mesh, Run};
use rvachev_num::{Meter, jobs};

/// Triangles that are prepared at once by a thread.
const CHUNK: usize = 4096;

/// A mesh in a view, ready to be drawn and joined: made by
/// [`RasterView::layers`] and [`RasterView::surface`].
#[derive(Clone, Debug)]
pub struct MeshLayers<'a> {
    mesh: &'a Mesh,
    view: RasterView,
    is_closed: bool,
    is_cut: bool,
    triangles: Vec<Triangle>,
    /// The triangles of tile i are `bins[starts[i]..starts[i + 1]]`, in their order in the mesh.
    starts: Vec<u32>,
    bins: Vec<u32>,
}

/// A vertex in the picture, in fractions of a pixel, with the key.
type Corner = (i32, i32, f64);

/// That of a vertex that is beyond what can be drawn, by its key.
const BEYOND: Corner = (0, 0, f64::NAN);

/// What of a mesh is made ready.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sides {
    Both,
    /// Of a closed mesh that is seen from outside nothing else shows.
    Fronts,
}

impl RasterView {
    /// The layers of a solid's mesh, seen in this view.
    ///
    /// Uses the rayon pool of the caller ([`Run::install`](crate::Run::install) chooses one).
    #[must_use]
    pub fn layers<'a>(&self, mesh: ClosedMesh<'a>) -> MeshLayers<'a> {
        MeshLayers::whole(mesh.mesh(), self, true, Sides::Both)
    }

    /// [`layers`](RasterView::layers) with a choice of threads, a cancel token and a progress sink.
    ///
    /// ```
    /// use rvachev::raster::{Buffers, ClosedMesh, Facing, RasterView};
    /// use rvachev::{Camera, MeshSettings, Progress, Run, Solid};
    ///
    /// let mesh = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
    /// let view = RasterView::new(&Camera::framing(&mesh.bounds()), 80, 60)?;
    /// // One run serves a job after the other; each tells from 0 on.
    /// let progress = Some(Progress::new(|part| println!("{:.0} %", 100.0 * part)));
    /// let run = Run { threads: 2, progress, ..Run::default() };
    /// let layers = view.layers_with(ClosedMesh::new(&mesh)?, &run)?;
    /// let mut buffers = Buffers::new(&view);
    /// buffers.draw_with(&layers, 0, Facing::Front, &run)?;
    /// assert_eq!(buffers.picture_with(&[&layers], &[[200; 3]], &run)?.pixel(0, 0), Some([0; 4]));
    /// assert_eq!(buffers.depth_picture_with(&run)?, buffers.depth_picture()?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Cancelled`].
    pub fn layers_with<'a>(&self, mesh: ClosedMesh<'a>, run: &Run) -> Result<MeshLayers<'a>, Cancelled> {
        run.install(|| MeshLayers::new(mesh.mesh(), self, (true, Sides::Both), run))
    }

    /// The layers of any mesh, also of an open one. They can be drawn
    /// ([`Buffers::draw`](super::Buffers::draw)), but not be joined with others.
    #[must_use]
    pub fn surface<'a>(&self, mesh: &'a Mesh) -> MeshLayers<'a> {
        MeshLayers::whole(mesh, self, false, Sides::Both)
    }

    /// What is seen of a closed mesh: its front faces, unless the near plane may cut it. They can
    /// be drawn, and nothing else.
    pub(crate) fn seen<'a>(&self, mesh: &'a Mesh) -> MeshLayers<'a> {
        let is_before = |corner: DVec3| self.clearance(0, self.relative(corner)) > 0.0;
        let is_outside = mesh.bounds().corners().into_iter().all(is_before);
        MeshLayers::whole(mesh, self, false, if is_outside { Sides::Fronts } else { Sides::Both })
    }

    /// [`surface`](RasterView::surface) with a choice of threads, a cancel token and a progress
    /// sink.
    ///
    /// # Errors
    ///
    /// [`Cancelled`].
    pub fn surface_with<'a>(&self, mesh: &'a Mesh, run: &Run) -> Result<MeshLayers<'a>, Cancelled> {
        run.install(|| MeshLayers::new(mesh, self, (false, Sides::Both), run))
    }
}

impl<'a> MeshLayers<'a> {
    /// The layers when nobody cancels.
    fn whole(mesh: &'a Mesh, view: &RasterView, is_closed: bool, sides: Sides) -> MeshLayers<'a> {
        let none = MeshLayers {
            mesh,
            view: *view,
            is_closed,
            is_cut: false,
            triangles: Vec::new(),
            starts: Vec::new(),
            bins: Vec::new(),
        };
        MeshLayers::new(mesh, view, (is_closed, sides), &Run::default()).unwrap_or(none)
    }

    fn new(
        mesh: &'a Mesh,
        view: &RasterView,
        (is_closed, sides): (bool, Sides),
        run: &Run,
    ) -> Result<MeshLayers<'a>, Cancelled> {
        let run = run.stage(0.0, 1.0);
        run.check()?;
        let [preparing, sorting] = run.stages([3.0, 1.0]);
        let corner = |p: &glam::Vec3| {
            let relative = view.relative(p.as_dvec3());
            let mut is_whole = true;
            for bound in 0..RasterView::BOUNDS {
                is_whole &= view.clearance(bound, relative) > 0.0;
            }
            if is_whole { snapped(view, relative) } else { BEYOND }
        };
        let corners: Vec<Corner> = jobs::in_order(mesh.positions().len(), |n| corner(&mesh.positions()[n]));
        let meter = Meter::new(&preparing, mesh.triangles().len());
        let parts: Vec<(Vec<Triangle>, bool)> = jobs::try_chunks(mesh.triangles(), CHUNK, |chunk, triangles| {
            meter.check()?;
            let mut part = (Vec::with_capacity(triangles.len()), false);
            for (i, t) in triangles.iter().enumerate() {
                let face = (chunk * CHUNK + i) as u32;
                let drawn = [corners[t[0] as usize], corners[t[1] as usize], corners[t[2] as usize]];
                if drawn.iter().all(|(.., key)| !key.is_nan()) {
                    add(view, drawn, (face, sides), &mut part.0);
                } else {
                    let relative = mesh.corners(*t).map(|p| view.relative(p));
                    part.1 |= add_cut(view, relative, (face, sides), &mut part.0);
                }
            }
            meter.add(triangles.len() as u64);
            Ok(part)
        })?;
        let is_cut = parts.iter().any(|part| part.1);
        let mut triangles = Vec::with_capacity(parts.iter().map(|part| part.0.len()).sum());
        for mut part in parts {
            triangles.append(&mut part.0);
        }
        let mut layers =
            MeshLayers { mesh, view: *view, is_closed, is_cut, triangles, starts: Vec::new(), bins: Vec::new() };
        layers.sort_into_tiles(&sorting)?;
        run.report(1.0);
        Ok(layers)
    }

    /// A counting sort, which keeps the order.
    fn sort_into_tiles(&mut self, run: &Run) -> Result<(), Cancelled> {
        let meter = Meter::new(run, 2 * self.triangles.len());
        let [across, down] = Tile::grid(self.view.width, self.view.height);
        let fraction = self.view.fraction;
        let mut starts = vec![0u32; (across * down) as usize + 1];
        for triangle in &self.triangles {
            meter.step()?;
            for_tiles(triangle, fraction, across, down, |tile| starts[tile as usize + 1] += 1);
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut free = starts.clone();
        let mut bins = vec![0; starts[starts.len() - 1] as usize];
        for (number, triangle) in self.triangles.iter().enumerate() {
            meter.step()?;
            for_tiles(triangle, fraction, across, down, |tile| {
                let slot = &mut free[tile as usize];
                bins[*slot as usize] = number as u32;
                *slot += 1;
            });
        }
        (self.starts, self.bins) = (starts, bins);
        Ok(())
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a Mesh {
        self.mesh
    }

    /// What of the mesh is seen in a tile, from either side: for each pixel of the picture that
    /// shows any, its column and row, what it shows and how deep it lies. `target` is scratch
    /// memory.
    pub(crate) fn seen(&self, tile: &Tile, target: &mut Target, mut see: impl FnMut([u32; 2], SurfaceId, f64)) {
        if !self.draws(tile, target) {
            return;
        }
        for y in tile.y..tile.y + tile.height {
            for x in tile.x..tile.x + tile.width {
                if let Some((id, depth)) = target.seen(tile, [x, y]) {
                    see([x, y], id, depth);
                }
            }
        }
    }

    /// Draws what of the mesh is seen in a tile, from either side, to scratch memory; whether there
    /// may be any.
    pub(crate) fn draws(&self, tile: &Tile, target: &mut Target) -> bool {
        let touches = self.touches(tile);
        if touches {
            target.clear_depth();
            target.draw(self, 0, None, tile);
        }
        touches
    }

    /// The view that it is drawn in.
    pub(crate) fn view(&self) -> &RasterView {
        &self.view
    }

    /// Every level gives the same to the bit: no operation rounds less on some.
    #[inline(always)]
    fn draw<S: Simd, const PERSPECTIVE: bool>(&self, simd: S, tile: &Tile, sink: &mut dyn FnMut(&[Fragments])) {
        let mut batch = Batch::new();
        for &number in self.bin(tile) {
            self.triangles[number as usize].draw::<S, PERSPECTIVE>(simd, tile, self.view.fraction, &mut batch, sink);
        }
        batch.flush(sink);
    }

    fn bin(&self, tile: &Tile) -> &[u32] {
        let [across, _] = Tile::grid(self.view.width, self.view.height);
        let number = (tile.y / Tile::SIDE * across + tile.x / Tile::SIDE) as usize;
        &self.bins[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

impl LayerSource for MeshLayers<'_> {
    fn size(&self) -> [u32; 2] {
        [self.view.width, self.view.height]
    }

    fn layers(&self, tile: &Tile, sink: &mut dyn FnMut(&[Fragments])) {
        if self.view.parallel {
            rvachev_num::on_level!(simd => self.draw::<_, false>(simd, tile, sink));
        } else {
            rvachev_num::on_level!(simd => self.draw::<_, true>(simd, tile, sink));
        }
    }

    fn touches(&self, tile: &Tile) -> bool {
        !self.bin(tile).is_empty()
    }

    fn normal(&self, face: u32, point: DVec3) -> DVec3 {
        Slant::new(self.mesh, face).normal(point)
    }

    fn normals(&self, face: u32, points: &[DVec3], normals: &mut [DVec3]) {
        let slant = Slant::new(self.mesh, face);
        normals.iter_mut().zip(points).for_each(|(normal, point)| *normal = slant.normal(*point));
    }

    fn is_closed(&self) -> bool {
        self.is_closed
    }

    fn is_cut(&self) -> bool {
        self.is_cut
    }
}

/// Calls a function with the number of each tile that a triangle may touch, most often one.
#[inline(always)]
fn for_tiles(triangle: &Triangle, fraction: u32, across: u32, down: u32, mut call: impl FnMut(u32)) {
    let side = Tile::SIDE as i32;
    let [left, right, top, bottom] = triangle.pixels(fraction);
    let (across, down) = (across as i32, down as i32);
    if left > right || top > bottom || right < 0 || bottom < 0 {
        return;
    }
    let (first, last) = (left.max(0) / side, (right / side).min(across - 1));
    let (upper, lower) = (top.max(0) / side, (bottom / side).min(down - 1));
    for row in upper..=lower {
        for column in first..=last {
            call((row * across + column) as u32);
        }
    }
}

#[inline]
fn snapped(view: &RasterView, relative: DVec3) -> Corner {
    let [x, y, z] = view.picture(relative);
    let one = f64::from(1u32 << view.fraction);
    // Within the guard: the conversions are exact.
    ((x * one).round() as i32, (y * one).round() as i32, view.key(z))
}

/// Adds what is left of a triangle, whose corners are relative to the eye, within the bounds of
/// what can be drawn. Whether the near plane cut it.
fn add_cut(view: &RasterView, relative: [DVec3; 3], face: (u32, Sides), out: &mut Vec<Triangle>) -> bool {
    let is_cut = relative.iter().any(|&q| view.clearance(0, q) <= 0.0);
    let mut polygon = relative.to_vec();
    for bound in 0..RasterView::BOUNDS {
        polygon = cut(&polygon, |q| view.clearance(bound, q));
    }
    // A fan from the first corner.
    let drawn: Vec<_> = polygon.into_iter().map(|q| held(view, q)).collect();
    for i in 2..drawn.len() {
        add(view, [drawn[0], drawn[i - 1], drawn[i]], face, out);
    }
    is_cut
}

/// Adds a triangle if it is wanted and there is a pixel's middle in its box.
#[inline]
fn add(view: &RasterView, corners: [Corner; 3], (face, sides): (u32, Sides), out: &mut Vec<Triangle>) {
    if let Some(triangle) = Triangle::new(corners, face).filter(|t| sides == Sides::Both || t.is_front()) {
        let [left, right, top, bottom] = triangle.pixels(view.fraction);
        let (width, height) = (view.width as i32, view.height as i32);
        if left <= right && top <= bottom && left < width && right >= 0 && top < height && bottom >= 0 {
            out.push(triangle);
        }
    }
}

/// A point that rounding may have put a little beyond the guard.
fn held(view: &RasterView, relative: DVec3) -> (i32, i32, f64) {
    let (x, y, key) = snapped(view, relative);
    let most = (view.guard as i32 + 1) << view.fraction;
    (x.clamp(-most, most), y.clamp(-most, most), key)
}

/// What is left of a polygon on the side of a plane where `clearance` is above 0 (I. E.
/// Sutherland and G. W. Hodgman, 1974). An edge is cut at the same point whichever way it runs,
/// so neighbours stay neighbours.
fn cut(polygon: &[DVec3], clearance: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (at_a, at_b) = (clearance(a), clearance(b));
        if (at_a > 0.0) != (at_b > 0.0) {
            // From the inner end to the outer one.
            let (inner, outer, at_inner, at_outer) = if at_a > 0.0 { (a, b, at_a, at_b) } else { (b, a, at_b, at_a) };
            kept.push(inner + (outer - inner) * (at_inner / (at_inner - at_outer)));
        }
        if at_b > 0.0 {
            kept.push(b);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, MeshSettings, Solid};

    #[test]
    fn front_faces_show_all_of_a_closed_mesh_from_outside() {
        let solid = (Solid::cuboid([2.0, 1.5, 1.0]) - Solid::cylinder(0.5, 3.0)) | Solid::torus(1.2, 0.2);
        let mesh = solid.mesh(&MeshSettings::default()).unwrap();
        let outside = Camera::framing(&mesh.bounds());
        let within = Camera { eye: DVec3::new(0.75, 0.5, 0.0), ..outside };
        for (camera, is_outside) in [(outside, true), (outside.parallel(), true), (within, false)] {
            let view = RasterView::new(&camera, 200, 150).unwrap();
            let view = if view.near() > 0.0 { view.with_near(1e-6).unwrap() } else { view };
            let (all, seen) = (view.surface(&mesh), view.seen(&mesh));
            assert!(!is_outside || 3 * seen.triangles.len() < 2 * all.triangles.len());
            let mut targets = [Target::new(), Target::new()];
            let [across, down] = Tile::grid(200, 150);
            let mut count = 0;
            for tile in (0..across * down).map(|number| Tile::number(number, 200, 150)) {
                let mut shown = Vec::new();
                for (layers, target) in [&all, &seen].into_iter().zip(&mut targets) {
                    let mut own = Vec::new();
                    layers.seen(&tile, target, |at, id, depth| own.push((at, id.face, id.facing, depth)));
                    shown.push(own);
                }
                count += shown[0].len();
                assert!(shown[0] == shown[1], "{tile:?}");
            }
            assert!(count > 3000, "{count}");
        }
    }
}
