//! A solid prepared for rays, once for any number of cameras.

use std::cell::RefCell;

use glam::DVec3;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::cells::Cells;
use super::draft_mesh::DraftMesh;
use super::extent::{corners, lowest};
use super::facets::Facets;
use super::gbuffer::{GBuffer, Surface, Window};
use super::pixels::TILE;
use super::section::{Kept, Sections};
use super::settings::RenderError;
use super::tile::{Tracer, View, divide_top};
use crate::distance::compiled_with;
use crate::eval::Program;
use crate::{Bounds, Cancelled, Hit, Palette, Rays, Run, Solid};
use rvachev_num::{Meter, jobs};

/// How far a ray from a hit starts off the surface, in proportion to the solid.
const RAY_EPSILON: f64 = 1e-7;

/// What more pixels see is not kept: some megabytes.
const KEPT: usize = 1 << 20;

/// Rays of a packet.
const PACKET: usize = 8192;

thread_local! {
    static TRACER: RefCell<Tracer> = RefCell::default();
}

/// A solid prepared for rays: the space around it divided into what is inside, what is
/// outside and cells that the surface may cross.
///
/// Preparing costs more than a picture of a small solid; a scene is worth keeping where the
/// camera moves.
///
/// ```
/// use rvachev::camera::Window;
/// use rvachev::{Camera, Solid};
///
/// let scene = Solid::sphere(1.0).scene()?;
/// let camera = Camera::framing(&scene.bounds());
/// let seen = scene.surfaces(&camera.rays(64, 64), Window::whole(64, 64));
/// assert!(seen.at(32, 32).is_hit() && !seen.at(0, 0).is_hit());
/// # Ok::<(), rvachev::error::RenderError>(())
/// ```
pub struct Scene {
    solid: Solid,
    bounds: Bounds,
    /// `None` if there is nothing to see.
    cells: Option<Cells>,
    palette: Palette,
    pub(super) program: Program,
    /// What pixels have last seen, and along which rays.
    seen: Mutex<Option<(Rays, GBuffer)>>,
    /// What it was cut by.
    pub(super) sections: Sections,
    /// The scene that it was last cut to.
    pub(super) cut: Mutex<Option<Kept>>,
    /// What drafts show, and in how many cells, once somebody has asked for one.
    pub(super) draft: Mutex<Option<(u32, Arc<DraftMesh>)>>,
    /// What hides light, and how fine it is, once somebody has asked for it.
    facets: Mutex<Option<(u32, Arc<Facets>)>>,
    /// The height of the lowest point, once somebody has asked for it.
    lowest: OnceLock<f64>,
}

impl Solid {
    /// The solid prepared for rays.
    ///
    /// # Errors
    /// What is wrong with the solid. An unbounded one is at fault; intersect it with something
    /// bounded.
    pub fn scene(&self) -> Result<Scene, RenderError> {
        self.scene_with(&Run::default())
    }

    /// [`scene`](Solid::scene) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn scene_with(&self, run: &Run) -> Result<Scene, RenderError> {
        let run = run.stage(0.0, 1.0);
        // Cells are found in no time, beside what a solid may have to measure.
        let programs = compiled_with(self, &run.stage(0.0, 0.9))?;
        let bounds = self.finite_bounds()?;
        run.install(|| {
            run.check()?;
            // A box without extent holds nothing that could be seen.
            let visible = !bounds.is_empty() && bounds.longest_side() > 0.0;
            let cells = visible.then(|| Cells::new(&programs.surface, &bounds));
            run.report(1.0);
            Ok(Scene {
                solid: self.clone(),
                bounds,
                cells,
                palette: self.palette()?,
                program: programs.surface.clone(),
                seen: Mutex::new(None),
                sections: Sections::default(),
                cut: Mutex::new(None),
                draft: Mutex::new(None),
                facets: Mutex::new(None),
                lowest: OnceLock::new(),
            })
        })
    }
}

impl Scene {
    /// The solid's box.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The paint of the solid's parts.
    #[must_use]
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// How many bytes the cells take that the rays so far have asked for, with the programs that
    /// are narrowed to them, and what the pixels of the last picture have seen. Cells grow with what
    /// is seen of the surface, from the first picture on, and stay until the scene is dropped. Not
    /// counted are the solid itself, what hides light in shaded pictures, the mesh of
    /// [drafts](crate::Quality::Draft), and the scene of the last [cut](Scene::cut).
    ///
    /// ```
    /// use rvachev::camera::Window;
    /// use rvachev::{Camera, Solid};
    ///
    /// let scene = Solid::torus(1.0, 0.3).scene()?;
    /// let before = scene.memory();
    /// let camera = Camera::framing(&scene.bounds());
    /// drop(scene.surfaces(&camera.rays(64, 64), Window::whole(64, 64)));
    /// assert!(scene.memory() > before && scene.memory() < 10_000_000);
    /// # Ok::<(), rvachev::error::RenderError>(())
    /// ```
    #[must_use]
    pub fn memory(&self) -> usize {
        let seen = self.seen().as_ref().map_or(0, |(_, seen)| size_of_val(seen.surfaces()));
        seen + self.cells.as_ref().map_or(0, Cells::bytes)
    }

    /// The height at which the solid stands on a level ground: its lowest point, to a thousandth
    /// of its height, or a little below.
    #[must_use]
    pub fn lowest(&self) -> f64 {
        *self.lowest.get_or_init(|| lowest(&self.program, &self.bounds))
    }

    pub(super) fn solid(&self) -> &Solid {
        &self.solid
    }

    pub(super) fn program(&self) -> &Program {
        &self.program
    }

    /// Whether there is nothing to see.
    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_none()
    }

    /// Points such that what holds them holds the solid.
    pub(super) fn hull(&self) -> Vec<DVec3> {
        corners(&self.program, &self.bounds)
    }

    /// The facets that hide light, about so many along the longest side; none if there is nothing
    /// to see.
    ///
    /// Those last asked for are kept: the next picture is likely to be of the same size.
    pub(super) fn facets(&self, cells: u32, run: &Run) -> Result<Option<Arc<Facets>>, Cancelled> {
        if self.cells.is_none() {
            return Ok(None);
        }
        let kept = || self.facets.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((count, facets)) = &*kept()
            && *count == cells
        {
            return Ok(Some(facets.clone()));
        }
        let facets = Arc::new(Facets::new(&self.program, &self.bounds, cells, run)?);
        *kept() = Some((cells, facets.clone()));
        Ok(Some(facets))
    }

    /// A length that is small for the solid, and large for the rounding of its points: rays
    /// from a hit start this far off the surface.
    pub(super) fn ray_epsilon(&self) -> f64 {
        if self.cells.is_some() { RAY_EPSILON * self.bounds.longest_side() } else { 0.0 }
    }

    /// The first crossing on the ray from `origin` along `direction`, which must be a unit
    /// vector. From inside the solid it is where the ray leaves it. A ray with NaN in it hits
    /// nothing; [`Solid::raycast`](crate::Solid::raycast) says so.
    #[must_use]
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let mut found = [Surface::NONE];
        let cells = self.cells.as_ref()?;
        TRACER.with_borrow_mut(|tracer| tracer.list(cells, &[(origin, direction)], &mut found));
        let Surface { distance, normal, owner } = found[0];
        let point = origin + distance * direction;
        found[0].is_hit().then(|| {
            let owner = self.owner_at(owner, point);
            Hit { distance, point, normal: normal.as_dvec3(), owner }
        })
    }

    /// [`first_hit`](Scene::first_hit) along many rays, each an origin and a unit direction,
    /// together, which is faster. Runs on the current rayon pool.
    #[must_use]
    pub fn first_hits(&self, rays: &[(DVec3, DVec3)]) -> Vec<Surface> {
        // A run that nobody else holds is not cancelled.
        self.hits(rays, &Run::default()).unwrap_or_else(|Cancelled| vec![Surface::NONE; rays.len()])
    }

    /// [`first_hits`](Scene::first_hits) with a choice of threads, a cancel token and a progress
    /// sink.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::{Run, Solid};
    ///
    /// let scene = Solid::sphere(1.0).scene()?;
    /// let rays = [(DVec3::X * 3.0, -DVec3::X), (DVec3::X * 3.0, DVec3::X)];
    /// let found = scene.first_hits_with(&rays, &Run { threads: 1, ..Run::default() })?;
    /// assert!((found[0].distance - 2.0).abs() < 1e-5 && !found[1].is_hit());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// That the work was cancelled.
    pub fn first_hits_with(&self, rays: &[(DVec3, DVec3)], run: &Run) -> Result<Vec<Surface>, Cancelled> {
        let run = run.stage(0.0, 1.0);
        run.check()?;
        run.install(|| self.hits(rays, &run))
    }

    /// The same as a part of a job, on its threads.
    pub(super) fn hits(&self, rays: &[(DVec3, DVec3)], run: &Run) -> Result<Vec<Surface>, Cancelled> {
        let mut found = vec![Surface::NONE; rays.len()];
        if let Some(cells) = &self.cells {
            let meter = Meter::new(run, rays.len());
            jobs::try_chunks_mut(&mut found, PACKET, |packet, found| {
                meter.check()?;
                let rays = &rays[packet * PACKET..][..found.len()];
                TRACER.with_borrow_mut(|tracer| tracer.list(cells, rays, found));
                self.fill_sections(found, |i| rays[i]);
                meter.add(rays.len() as u64);
                Ok::<_, Cancelled>(())
            })?;
        }
        Ok(found)
    }

    /// What the pixels of `window` see along `rays`. Runs on the current rayon pool; the
    /// result is the same for any number of threads.
    ///
    /// What up to 2²⁰ pixels have last seen is kept, 24 bytes each: the same view once more, in
    /// another light or style, say, takes no rays through the pixels' middles. Of another view the
    /// cells are known as far as rays have been there before.
    #[must_use]
    pub fn surfaces(&self, rays: &Rays, window: Window) -> GBuffer {
        // A run that nobody else holds is not cancelled.
        self.surfaces_with(rays, window, &Run::default()).unwrap_or_else(|Cancelled| GBuffer::new(window, Vec::new()))
    }

    /// [`surfaces`](Scene::surfaces) with a choice of threads, a cancel token and a progress
    /// sink.
    ///
    /// # Errors
    /// That the work was cancelled.
    pub fn surfaces_with(&self, rays: &Rays, window: Window, run: &Run) -> Result<GBuffer, Cancelled> {
        let run = run.stage(0.0, 1.0);
        run.install(|| self.trace(rays, window, &run))
    }

    fn trace(&self, rays: &Rays, window: Window, run: &Run) -> Result<GBuffer, Cancelled> {
        run.check()?;
        if let Some((of, seen)) = &*self.seen()
            && of == rays
            && seen.window() == window
        {
            run.report(1.0);
            return Ok(seen.clone());
        }
        let mut surfaces = vec![Surface::NONE; window.count()];
        let Some(cells) = &self.cells else { return Ok(GBuffer::new(window, surfaces)) };
        let view = View::new(cells, rays);
        if rayon::current_num_threads() > 1 {
            divide_top(cells, &view, &window);
        }
        let (across, down) = (window.width.div_ceil(TILE), window.height.div_ceil(TILE));
        let meter = Meter::new(run, across * down);
        jobs::try_chunks_mut(&mut surfaces, (window.width * TILE).max(1) as usize, |band, surfaces| {
            // The rows of each tile.
            let mut tiles: Vec<Vec<&mut [Surface]>> = (0..across).map(|_| Vec::with_capacity(TILE as usize)).collect();
            for row in surfaces.chunks_mut(window.width as usize) {
                tiles.iter_mut().zip(row.chunks_mut(TILE as usize)).for_each(|(tile, part)| tile.push(part));
            }
            let tiles = tiles.into_iter().enumerate().collect();
            jobs::try_taking(tiles, |(column, mut rows): (usize, Vec<&mut [Surface]>)| {
                meter.check()?;
                let (x, y) = (column as u32 * TILE, band as u32 * TILE);
                let (width, height) = (TILE.min(window.width - x), TILE.min(window.height - y));
                let tile = Window { left: window.left + x, top: window.top + y, width, height, ..window };
                TRACER.with_borrow_mut(|tracer| tracer.tile(cells, &view, tile, &mut rows));
                for (row, y) in rows.iter_mut().zip(0..) {
                    self.fill_sections(row, |x| tile.ray(rays, x as u32, y));
                }
                meter.add(1);
                Ok(())
            })?;
            Ok(())
        })?;
        let seen = GBuffer::new(window, surfaces);
        *self.seen() = (window.count() <= KEPT).then(|| (*rays, seen.clone()));
        Ok(seen)
    }

    fn seen(&self) -> MutexGuard<'_, Option<(Rays, GBuffer)>> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Scene({:?})", self.bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, deg};

    #[test]
    fn the_last_view_is_kept() {
        let scene = (Solid::cuboid([2.0; 3]) - Solid::sphere(1.2)).scene().expect("the solid is valid");
        let camera = Camera::framing(&scene.bounds());
        let see = |camera: &Camera, window: Window| scene.surfaces(&camera.rays(40, 30), window);
        let is_kept = |a: &GBuffer, b: &GBuffer| std::ptr::eq(a.surfaces(), b.surfaces());
        let whole = Window::whole(40, 30);
        let first = see(&camera, whole);
        assert!(is_kept(&first, &see(&camera, whole)) && scene.memory() > size_of_val(first.surfaces()));
        // Another part, other points of the pixels, and another camera show something else.
        let part = see(&camera, Window { left: 3, width: 20, ..whole });
        assert!(part.at(9, 9) == first.at(12, 9) && part.surfaces().len() == 600);
        assert_ne!(see(&camera, Window { within: (0.25, 0.5), ..whole }), first);
        assert_ne!(see(&camera.orbit(deg(20.0), deg(0.0)), whole), first);
        let again = see(&camera, whole);
        assert!(again == first && !is_kept(&again, &first));
        let large = Window { width: 1025, height: 1024, ..whole };
        assert!(!is_kept(&see(&camera, large), &see(&camera, large)));
    }
}
