//! A formula from a file: a `.vm` text meshed, rendered and sliced.
//!
//! ```text
//!     cargo run --release --example vm_import -- [model.vm ...] [folder]
//! ```
//!
//! Without a model: a small one that is part of this text, and a broken one, to show how
//! errors are told. What a `.vm` text says about a point is negative inside; it says nothing
//! about its size, so the part within ±1.5 is taken, of a text without z a plate.
//!
//! The slice z = 0 shows what lies below `mesh` and `render`: a program is narrowed to
//! smaller and smaller tiles, most of which turn out to be all inside or all outside, and
//! evaluated in bulk, with gradients, in those that are left.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::{
    Bounds, Camera, CellSize, Formula, Image, MeshSettings, RenderSettings, Solid, deg,
    program::{Evaluator, Gradients, Program, Region, Tape},
};

/// A cube with round windows, and a ball in it.
const CAGE: &str = "\
# a ball in a cage: a cube less a ball, max(|x|, |y|, |z|) - 0.8 and 1 - r, and a smaller ball
x var-x
y var-y
z var-z
ax abs x
ay abs y
az abs z
m1 max ax ay
m2 max m1 az
half const 0.8
box sub m2 half
xx square x
yy square y
zz square z
s1 add xx yy
s2 add s1 zz
r sqrt s2
one const 1
outer sub one r
frame max box outer
small const 0.5
ball sub r small
out min frame ball
";

/// Half the side of the cube that is looked at, and of the plate if there is no z.
const REACH: f64 = 1.5;
const PLATE: f64 = 0.06;

/// Pixels along the slice's side, and along that of the smallest tile.
const SLICE: usize = 768;
const TILE: usize = 24;

const INSIDE: [f64; 3] = [196.0, 96.0, 58.0];
const OUTSIDE: [f64; 3] = [246.0, 244.0, 240.0];

/// The slice while it is painted.
struct Slice {
    pixels: Vec<[u8; 4]>,
    evaluator: Evaluator,
    /// Pixels in tiles that are all inside or all outside, and pixels evaluated.
    plain: usize,
    evaluated: usize,
}

/// A colour between outside and inside.
fn mixed(inside: f64) -> [u8; 4] {
    let channel = |i: usize| (OUTSIDE[i] + (INSIDE[i] - OUTSIDE[i]) * inside).round() as u8;
    [channel(0), channel(1), channel(2), 255]
}

/// Where the middle of a pixel is, along x; along y it is the negative.
fn position(pixel: f64) -> f64 {
    REACH * (2.0 * pixel / SLICE as f64 - 1.0)
}

impl Slice {
    /// Paints the tile of `side` pixels whose first one is `[column, row]`.
    fn paint(&mut self, program: &Program, [column, row]: [usize; 2], side: usize) {
        let (x, y) = (position(column as f64), -position(row as f64));
        let size = 2.0 * REACH * side as f64 / SLICE as f64;
        let tile = Bounds::from_corners([x, y, 0.0], [x + size, y - size, 0.0]);
        match program.narrow(&tile) {
            Region::Inside => self.fill([column, row], side, 1.0),
            Region::Outside => self.fill([column, row], side, 0.0),
            Region::Surface(program) if side > TILE => {
                let half = side / 2;
                for [right, down] in [[0, 0], [half, 0], [0, half], [half, half]] {
                    self.paint(&program, [column + right, row + down], half);
                }
            }
            Region::Surface(program) => self.evaluate(&program, &tile, [column, row]),
        }
    }

    fn fill(&mut self, [column, row]: [usize; 2], side: usize, inside: f64) {
        self.plain += side * side;
        for line in self.pixels.chunks_mut(SLICE).skip(row).take(side) {
            line[column..column + side].fill(mixed(inside));
        }
    }

    /// All pixels of a smallest tile at once. The value over the slope is the distance to the
    /// surface, to first order: within half a pixel of it the colour is in between.
    fn evaluate(&mut self, program: &Program, tile: &Bounds, [column, row]: [usize; 2]) {
        const COUNT: usize = TILE * TILE;
        self.evaluated += COUNT;
        let tape = Tape::new(program, tile);
        let origin = tape.origin();
        let (mut x, mut y) = ([0.0f32; COUNT], [0.0f32; COUNT]);
        for (i, (x, y)) in x.iter_mut().zip(&mut y).enumerate() {
            *x = (position((column + i % TILE) as f64 + 0.5) - origin.x) as f32;
            *y = (-position((row + i / TILE) as f64 + 0.5) - origin.y) as f32;
        }
        let [mut value, mut dx, mut dy, mut dz] = [[0.0f32; COUNT]; 4];
        let out = Gradients { value: &mut value, dx: &mut dx, dy: &mut dy, dz: &mut dz };
        self.evaluator.gradients(&tape, &x, &y, &[0.0; COUNT], out).unwrap();
        let pixel = 2.0 * REACH / SLICE as f64;
        for (i, value) in value.iter().enumerate() {
            let slope = f64::from(dx[i].hypot(dy[i])).max(1e-3);
            let inside = (0.5 + f64::from(*value) / (slope * pixel)).clamp(0.0, 1.0);
            self.pixels[(row + i / TILE) * SLICE + column + i % TILE] = mixed(inside);
        }
    }
}

fn wrote(path: &Path, start: Instant, facts: &str) -> Result<(), Box<dyn Error>> {
    let kilobytes = fs::metadata(path)?.len() / 1000;
    println!("{}: {kilobytes} kB, {:.2} s, {facts}", path.display(), start.elapsed().as_secs_f64());
    Ok(())
}

fn import(name: &str, text: &str, folder: &Path) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let formula = Formula::from_vm(text, Bounds::ALL)?;
    let operations = formula.len();
    let endless = Solid::from(formula);
    println!("{name}: {operations} operations, read in {:.1} ms", 1e3 * start.elapsed().as_secs_f64());

    let flat = !text.contains("var-z");
    let half = DVec3::new(REACH, REACH, if flat { PLATE } else { REACH });
    let model = (&endless & Solid::cuboid(2.0 * half)).named(name);

    let start = Instant::now();
    let program = endless.surface_program()?;
    let pixels = vec![mixed(0.0); SLICE * SLICE];
    let mut slice = Slice { pixels, evaluator: Evaluator::new(), plain: 0, evaluated: 0 };
    slice.paint(&program, [0, 0], SLICE);
    let path = folder.join(format!("vm_{name}_slice.png"));
    let (plain, evaluated) = (slice.plain, slice.evaluated);
    Image::new(SLICE as u32, SLICE as u32, slice.pixels)?.save(&path)?;
    let facts = format!("{SLICE} x {SLICE} pixels, {evaluated} evaluated, {plain} in tiles of one kind");
    wrote(&path, start, &facts)?;

    let start = Instant::now();
    let mesh = model.mesh(&MeshSettings { cell: CellSize::LongestSide(160), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    let path = folder.join(format!("vm_{name}.stl"));
    mesh.save(&path)?;
    let report = mesh.check();
    let sound = if report.is_closed() && report.is_manifold() { "closed, manifold" } else { "NOT SOUND" };
    let (triangles, volume, leaves) = (report.triangles, report.volume, model.surface_program()?.leaf_count());
    wrote(&path, start, &format!("{triangles} triangles, {sound}, volume {volume:.3}, {leaves} leaves"))?;

    // The mesh knows how large the model is.
    let start = Instant::now();
    let settings = RenderSettings {
        width: 480,
        height: 400,
        samples: 2,
        paint: [204, 160, 118].into(),
        ..RenderSettings::default()
    };
    let eye = if flat { DVec3::new(0.5, -2.0, 4.0) } else { DVec3::new(2.0, -3.0, 2.0) };
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, deg(30.0));
    let camera = camera.fitted(&report.bounds, f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join(format!("vm_{name}.png"));
    model.render(&camera, &settings)?.save(&path)?;
    wrote(&path, start, &format!("{} x {} pixels", settings.width, settings.height))
}

fn main() -> Result<(), Box<dyn Error>> {
    let (models, folders): (Vec<PathBuf>, Vec<PathBuf>) =
        std::env::args().skip(1).map(PathBuf::from).partition(|path| path.extension().is_some_and(|end| end == "vm"));
    let folder = folders.into_iter().next().unwrap_or_else(|| PathBuf::from("target/examples"));
    fs::create_dir_all(&folder)?;

    for path in &models {
        let name = path.file_stem().map_or("model".into(), |stem| stem.to_string_lossy());
        let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        import(&name, &text, &folder).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    if models.is_empty() {
        import("cage", CAGE, &folder)?;
        let broken = CAGE.replace("max box outer", "max box outside");
        if let Err(error) = import("broken", &broken, &folder) {
            println!("broken: {error}");
        }
    }
    Ok(())
}
