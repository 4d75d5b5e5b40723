//! CSG of superquadrics in the depth buffer, step by step.
//!
//! ```text
//!   steps   A − B, pass by pass: what each leaves in depth, stencil and ids
//!   joins   union, intersection and differences of two and of three
//!   set     a table set: many operands, some tapered, twisted and bent
//! ```
//!
//! After the figures of the paper by Kim et al. on superquadrics and the depth buffer, with its
//! passes put right. No field is evaluated: everything is drawn from meshes of parameter patches.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use glam::{DAffine3, DVec3};
use rvachev::{
    Bounds, Camera, Image, Mesh, Superellipsoid, Supertoroid, deg, rad,
    raster::{Buffers, ClosedMesh, Csg, CsgMethod, Facing, LayerSource, MeshLayers, RasterView},
    surface::{ParametricSurface, PatchSettings},
};

/// A picture is drawn this many times as large, and every square of pixels becomes one.
const FINER: u32 = 2;

/// Colours of the operands.
const COLORS: [[u8; 3]; 6] =
    [[92, 138, 178], [214, 140, 86], [126, 166, 108], [186, 118, 140], [205, 184, 110], [140, 130, 176]];

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn patch(rows: u32, columns: u32) -> PatchSettings {
    PatchSettings { rows, columns, ..PatchSettings::default() }
}

fn superellipsoid(semi_axes: [f64; 3], e1: f64, e2: f64) -> Result<Mesh> {
    Ok(ParametricSurface::of(&Superellipsoid::new(semi_axes, e1, e2))?.mesh(&patch(64, 128))?)
}

fn moved(mesh: Mesh, x: f64, y: f64, z: f64) -> Result<Mesh> {
    Ok(mesh.affine(DAffine3::from_translation(DVec3::new(x, y, z)))?)
}

/// A picture in parts, side by side and row by row, on white.
struct Sheet {
    across: u32,
    panels: Vec<Image>,
}

/// Pixels of white around what a panel shows.
const MARGIN: u32 = 16;

impl Sheet {
    fn image(&self) -> Result<Image> {
        let [left, top, right, bottom] = self.shown();
        let (w, h) = (right - left + 2 * MARGIN, bottom - top + 2 * MARGIN);
        let down = (self.panels.len() as u32).div_ceil(self.across);
        let (width, height) = (w * self.across, h * down);
        let mut pixels = vec![[255u8; 4]; (width * height) as usize];
        for (i, panel) in (0u32..).zip(&self.panels) {
            let (x0, y0) = (i % self.across * w + MARGIN, i / self.across * h + MARGIN);
            for y in top..bottom {
                for x in left..right {
                    pixels[((y0 + y - top) * width + x0 + x - left) as usize] = mean(panel, x, y);
                }
            }
        }
        Ok(Image::new(width, height, pixels)?)
    }

    /// The columns and rows of the picture where any of the panels shows something, the last ones
    /// excluded: the same of all, so that panels can be compared.
    fn shown(&self) -> [u32; 4] {
        let (w, h) = (self.panels[0].width(), self.panels[0].height());
        let seen = |x: u32, y: u32| self.panels.iter().any(|p| p.pixel(x, y).is_some_and(|[.., alpha]| alpha > 0));
        let columns: Vec<u32> = (0..w).filter(|&x| (0..h).any(|y| seen(x, y))).map(|x| x / FINER).collect();
        let rows: Vec<u32> = (0..h).filter(|&y| (0..w).any(|x| seen(x, y))).map(|y| y / FINER).collect();
        let first = |v: &[u32]| v.first().copied().unwrap_or(0);
        let last = |v: &[u32]| v.last().map_or(1, |i| i + 1);
        [first(&columns), first(&rows), last(&columns), last(&rows)]
    }
}

/// The mean of a square of pixels over white.
fn mean(panel: &Image, x: u32, y: u32) -> [u8; 4] {
    let mut sum = [0u32; 3];
    for (dx, dy) in (0..FINER).flat_map(|dy| (0..FINER).map(move |dx| (dx, dy))) {
        let [r, g, b, alpha] = panel.pixel(FINER * x + dx, FINER * y + dy).unwrap_or([0; 4]);
        let over = if alpha == 0 { [255; 3] } else { [r, g, b] };
        for (sum, c) in sum.iter_mut().zip(over) {
            *sum += u32::from(c);
        }
    }
    let [r, g, b] = sum.map(|c| (c / (FINER * FINER)) as u8);
    [r, g, b, 255]
}

/// The stencil as a picture: grey where it is 0, in colours else.
fn stencil_picture(buffers: &Buffers) -> Result<Image> {
    let (width, height) = (buffers.view().width(), buffers.view().height());
    let color = |(x, y): (u32, u32)| match (buffers.depth(x, y), buffers.stencil(x, y)) {
        (None, _) => [0; 4],
        (Some(_), 0) => [200, 200, 200, 255],
        (Some(_), 1) => [224, 104, 72, 255],
        (Some(_), _) => [96, 64, 160, 255],
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(color).collect();
    Ok(Image::new(width, height, pixels)?)
}

/// The difference of two, each pass as a panel.
fn steps() -> Result<Sheet> {
    let a = superellipsoid([1.2, 1.0, 0.8], 0.35, 0.35)?;
    let b = moved(superellipsoid([0.8, 0.8, 0.8], 1.0, 1.0)?, 0.75, -0.65, 0.45)?;
    let camera = Camera::framing(&a.bounds().union(&b.bounds()));
    let view = RasterView::new(&camera, 420 * FINER, 380 * FINER)?;
    let [a, b] = [view.layers(ClosedMesh::new(&a)?), view.layers(ClosedMesh::new(&b)?)];
    let operands: [&dyn LayerSource; 2] = [&a, &b];
    let mut panels = Vec::new();
    let mut take = |buffers: &Buffers, stencil: bool| -> Result<()> {
        panels.push(if stencil { stencil_picture(buffers)? } else { buffers.picture(&operands, &COLORS)? });
        Ok(())
    };

    // Pass 1: the front of A, the count of B's faces up to it, what is outside.
    let mut outer = Buffers::new(&view);
    outer.draw(&a, 0, Facing::Front)?;
    take(&outer, false)?;
    outer.classify(&b)?;
    take(&outer, true)?;
    outer.keep(|count| count == 0);
    take(&outer, false)?;
    // Pass 2: the back of B, the count of A's faces up to it, what is inside.
    let mut inner = Buffers::new(&view);
    inner.draw(&b, 1, Facing::Back)?;
    take(&inner, false)?;
    inner.classify(&a)?;
    take(&inner, true)?;
    inner.keep(|count| count != 0);
    take(&inner, false)?;
    // The nearer of the two; its depth; and the union for comparison.
    outer.merge(&inner)?;
    take(&outer, false)?;
    panels.push(outer.depth_picture()?);
    let union = view.csg(&operands, &(Csg::operand(0) | Csg::operand(1)), CsgMethod::Stencil)?;
    panels.push(union.picture(&operands, &COLORS)?);
    Ok(Sheet { across: 3, panels })
}

/// Two operands by stencil passes, three in sequence.
fn joins() -> Result<Sheet> {
    let a = superellipsoid([1.0, 0.9, 0.8], 0.3, 0.3)?;
    let b = moved(superellipsoid([0.75, 0.75, 0.75], 1.0, 1.0)?, 0.55, -0.6, 0.4)?;
    let c = superellipsoid([0.42, 0.42, 1.4], 0.1, 1.0)?;
    let camera = Camera::framing(&a.bounds().union(&b.bounds()).union(&c.bounds()));
    let view = RasterView::new(&camera, 380 * FINER, 380 * FINER)?;
    let layers =
        [view.layers(ClosedMesh::new(&a)?), view.layers(ClosedMesh::new(&b)?), view.layers(ClosedMesh::new(&c)?)];
    let operands: Vec<&dyn LayerSource> = layers.iter().map(|l| l as &dyn LayerSource).collect();
    let [a, b, c] = [0, 1, 2].map(Csg::operand);
    let mut panels = Vec::new();
    let two = [a.clone() | b.clone(), a.clone() & b.clone(), a.clone() - b.clone(), b.clone() - a.clone()];
    let three = [
        (a.clone() | b.clone()) | c.clone(),
        (a.clone() - b.clone()) - c.clone(),
        (a.clone() | c.clone()) - b.clone(),
        (a ^ b) - c,
    ];
    for (trees, method) in [(two, CsgMethod::Stencil), (three, CsgMethod::Sequenced)] {
        for tree in trees {
            let buffers = view.csg(&operands, &tree, method)?;
            // The general method agrees to the bit.
            let general = view.csg(&operands, &tree, CsgMethod::Intervals)?;
            let different = buffers.depths().iter().zip(general.depths()).filter(|(a, b)| *a != b).count();
            println!("  {tree}: {different} pixels differ between {method:?} and Intervals");
            panels.push(buffers.picture(&operands, &COLORS)?);
        }
    }
    Ok(Sheet { across: 4, panels })
}

/// What a set is made of: meshes with their colours.
#[derive(Default)]
struct Parts {
    meshes: Vec<Mesh>,
    colors: Vec<[u8; 3]>,
}

impl Parts {
    fn add(&mut self, mesh: Mesh, color: [u8; 3]) -> Csg {
        self.meshes.push(mesh);
        self.colors.push(color);
        Csg::operand(self.meshes.len() as u32 - 1)
    }
}

/// A mug with a bent handle, a twisted candle on a stand, a bowl, and dice on a table.
fn set(parts: &mut Parts) -> Result<Csg> {
    let table = parts.add(moved(superellipsoid([3.6, 2.3, 0.12], 0.1, 0.2)?, 0.0, 0.0, -0.12)?, [150, 128, 104]);

    let outside = superellipsoid([0.72, 0.72, 0.85], 0.2, 1.0)?.taper(0.12, 0.12, 1.7)?;
    let outside = parts.add(moved(outside, -2.1, -0.3, 0.85)?, [92, 138, 178]);
    let inside = superellipsoid([0.62, 0.62, 0.85], 0.25, 1.0)?.taper(0.12, 0.12, 1.7)?;
    let inside = parts.add(moved(inside, -2.1, -0.3, 0.99)?, [226, 226, 220]);
    let ring = ParametricSurface::of(&Supertoroid::new([0.13, 0.13, 0.13], 3.2, 1.0, 1.0))?.mesh(&patch(32, 96))?;
    let ring = ring.affine(DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2))?;
    let ring = parts.add(moved(ring, -1.38, -0.3, 0.85)?, [92, 138, 178]);
    let mug = (outside | ring) - inside;

    let ball = parts.add(moved(superellipsoid([0.95, 0.95, 0.8], 1.0, 1.0)?, 0.1, 0.75, 0.62)?, [126, 166, 108]);
    let hollow = parts.add(moved(superellipsoid([0.85, 0.85, 0.7], 1.0, 1.0)?, 0.1, 0.75, 0.66)?, [222, 226, 210]);
    let above = parts.add(moved(superellipsoid([1.2, 1.2, 0.6], 0.1, 0.1)?, 0.1, 0.75, 1.3)?, [186, 190, 176]);
    let foot = parts.add(moved(superellipsoid([0.5, 0.5, 0.1], 0.1, 1.0)?, 0.1, 0.75, 0.1)?, [126, 166, 108]);
    let bowl = ((ball | foot) - hollow) - above;
    let fruit = parts.add(moved(superellipsoid([0.34, 0.34, 0.3], 0.8, 1.0)?, 0.0, 0.62, 0.6)?, [206, 92, 66]);
    let banana = superellipsoid([0.13, 0.13, 0.75], 0.8, 0.7)?.taper(-0.15, -0.15, 1.5)?.bend(1.1, deg(0.0))?;
    let banana = banana.affine(DAffine3::from_rotation_y(-0.5) * DAffine3::from_rotation_z(0.4))?;
    let banana = parts.add(moved(banana, 0.42, 0.8, 0.95)?, [226, 192, 84]);

    let candle = superellipsoid([0.24, 0.24, 0.95], 0.15, 0.25)?.twist(rad(1.9))?.taper(-0.25, -0.25, 1.9)?;
    let candle = parts.add(moved(candle, 2.2, 0.4, 1.15)?, [236, 222, 190]);
    let plate = parts.add(moved(superellipsoid([0.75, 0.75, 0.2], 0.6, 1.0)?, 2.2, 0.4, 0.2)?, [140, 130, 176]);
    let dish = parts.add(moved(superellipsoid([0.62, 0.62, 0.18], 0.6, 1.0)?, 2.2, 0.4, 0.36)?, [190, 184, 208]);
    let stand = (plate - dish) | candle;

    let mut all = table | mug | bowl | fruit | banana | stand;
    for (x, y, turn, spots) in [(0.55, -1.25, 0.5, [1, 2, 3]), (1.6, -1.1, -0.3, [5, 4, 6])] {
        all = all | die(parts, x, y, turn, spots)?;
    }
    Ok(all)
}

/// A die on the table, with spots on top, in front and at its right.
fn die(parts: &mut Parts, x: f64, y: f64, turn: f64, spots: [usize; 3]) -> Result<Csg> {
    let place = DAffine3::from_translation(DVec3::new(x, y, 0.32)) * DAffine3::from_rotation_z(turn);
    let mut die = parts.add(superellipsoid([0.32, 0.32, 0.32], 0.25, 0.25)?.affine(place)?, [232, 230, 224]);
    let ball = ParametricSurface::of(&Superellipsoid::new([0.062, 0.062, 0.062], 1.0, 1.0))?.mesh(&patch(16, 32))?;
    let all = [(0.0, 0.0), (0.15, 0.15), (-0.15, -0.15), (0.15, -0.15), (-0.15, 0.15), (0.15, 0.0), (-0.15, 0.0)];
    let places: [&[usize]; 6] = [&[0], &[1, 2], &[0, 1, 2], &[1, 2, 3, 4], &[0, 1, 2, 3, 4], &[1, 2, 3, 4, 5, 6]];
    let sides: [fn(f64, f64) -> DVec3; 3] =
        [|u, v| DVec3::new(u, v, 0.33), |u, v| DVec3::new(u, -0.33, v), |u, v| DVec3::new(0.33, u, v)];
    for (count, side) in spots.into_iter().zip(sides) {
        for &spot in places[count - 1] {
            let (u, v) = all[spot];
            let dent = ball.affine(place * DAffine3::from_translation(side(u, v)))?;
            die = die - parts.add(dent, [48, 46, 52]);
        }
    }
    Ok(die)
}

fn main() -> Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;
    let save = |name: &str, sheet: &Sheet, start: Instant| -> Result<()> {
        let path = folder.join(format!("zbuffer_csg_{name}.png"));
        sheet.image()?.save(&path)?;
        println!("{}: {:.1} s", path.display(), start.elapsed().as_secs_f64());
        Ok(())
    };

    println!("The difference of two superquadrics, pass by pass.");
    let start = Instant::now();
    save("steps", &steps()?, start)?;

    println!("Two operands by stencil passes, three in sequence.");
    let start = Instant::now();
    save("joins", &joins()?, start)?;

    println!("A set.");
    let start = Instant::now();
    let mut parts = Parts::default();
    let tree = set(&mut parts)?;
    let bounds = parts.meshes.iter().map(Mesh::bounds).reduce(|a, b| a.union(&b)).unwrap_or(Bounds::EMPTY);
    let camera =
        Camera::perspective([2.5, -7.0, 4.6], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], deg(30.0)).fitted(&bounds, 1.5);
    let view = RasterView::new(&camera, 1080 * FINER, 660 * FINER)?;
    let layers: std::result::Result<Vec<MeshLayers>, _> = parts
        .meshes
        .iter()
        .map(|mesh| Ok::<_, rvachev::raster::RasterError>(view.layers(ClosedMesh::new(mesh)?)))
        .collect();
    let layers = layers?;
    let operands: Vec<&dyn LayerSource> = layers.iter().map(|l| l as &dyn LayerSource).collect();
    let triangles: usize = parts.meshes.iter().map(|mesh| mesh.triangles().len()).sum();
    let drawing = Instant::now();
    let buffers = view.csg(&operands, &tree, CsgMethod::Intervals)?;
    println!(
        "  {} operands, {triangles} triangles, {} x {} pixels: depth buffer in {:.2} s",
        operands.len(),
        view.width(),
        view.height(),
        drawing.elapsed().as_secs_f64()
    );
    let sheet = Sheet { across: 1, panels: vec![buffers.picture(&operands, &parts.colors)?] };
    save("set", &sheet, start)?;
    Ok(())
}
