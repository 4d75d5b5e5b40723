//! Depth images of the same CSG by meshes and by fields, one thread.
//!
//! `cargo bench --bench raster` prints two tables. The first is by model, at 256², 512² and 1024²:
//! milliseconds for the meshes of the operands and for finding them closed (once), for projecting
//! them and sorting them into tiles (each view), and for the depth image by each method of
//! depth-buffer CSG that can do the model, and for a shaded picture of it; then for the scene of
//! the implicit renderer (made once) and its depth image. The ratio is that of the implicit
//! renderer's image to projecting and intervals. The second table is by the number of triangles,
//! with how far the depth images differ, at worst and in the mean, beside the silhouettes.
//!
//! Every figure is the least of several rounds in which the contestants alternate.
//!
//! Words after `--` choose: `models`, `triangles`, `quick` (fewer rounds), `two` (threads).

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use glam::{DAffine3, DVec3};
use rvachev::{
    Camera, Mesh, RFunction, Run, Solid, Superellipsoid,
    camera::Window,
    raster::{ClosedMesh, Csg, CsgMethod, LayerSource, RasterView},
    surface::{ParametricSurface, PatchSettings},
};

/// Superellipsoids in their places, and a tree over them in both forms.
struct Model {
    name: &'static str,
    operands: Vec<(Superellipsoid, DAffine3)>,
    tree: Csg,
    solid: Solid,
}

impl Model {
    fn new(
        name: &'static str,
        operands: Vec<(Superellipsoid, DAffine3)>,
        tree: impl Fn(&[Csg]) -> Csg,
        solid: impl Fn(&[Solid]) -> Solid,
    ) -> Model {
        let leaves: Vec<Csg> = (0..operands.len() as u32).map(Csg::operand).collect();
        let solids: Vec<Solid> = operands.iter().map(|(shape, place)| Solid::from(*shape).affine(*place)).collect();
        Model { name, tree: tree(&leaves), solid: solid(&solids), operands }
    }

    fn meshes(&self, columns: u32) -> Result<Vec<Mesh>, Box<dyn Error>> {
        let settings = PatchSettings { rows: columns / 2, columns, ..PatchSettings::default() };
        self.operands
            .iter()
            .map(|(shape, place)| Ok(ParametricSurface::of(shape)?.mesh(&settings)?.affine(*place)?))
            .collect()
    }
}

fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// The methods take min and max: the solid is the same for every rule.
const RULE: RFunction = RFunction::MIN_MAX;

fn models() -> Vec<Model> {
    let body = Superellipsoid::new([1.2, 1.0, 0.8], 0.3, 0.3);
    let ball = |r: f64| Superellipsoid::new([r, r, r], 1.0, 1.0);
    let rod = Superellipsoid::new([0.35, 0.35, 1.5], 0.1, 1.0);
    let two = Model::new(
        "two: A - B",
        vec![(body, at(0.0, 0.0, 0.0)), (ball(0.8), at(0.7, -0.6, 0.5))],
        |o| o[0].clone() - o[1].clone(),
        |s| s[0].difference(&s[1], RULE),
    );
    let three = Model::new(
        "three: (A & B) - C",
        vec![(body, at(0.0, 0.0, 0.0)), (ball(1.15), at(0.0, 0.0, 0.0)), (rod, at(0.1, -0.1, 0.0))],
        |o| (o[0].clone() & o[1].clone()) - o[2].clone(),
        |s| s[0].intersection(&s[1], RULE).difference(&s[2], RULE),
    );
    let mut operands = vec![(body, at(0.0, 0.0, 0.0))];
    operands.extend((0..12).map(|i| {
        let (i, j) = (f64::from(i % 4), f64::from(i / 4));
        (Superellipsoid::new([0.2, 0.2, 0.4], 0.4, 1.0), at(0.5 * i - 0.75, 0.5 * j - 0.5, 0.75))
    }));
    let dents = Model::new(
        "a block less 12",
        operands,
        |o| o[1..].iter().fold(o[0].clone(), |tree, hole| tree - hole.clone()),
        |s| s[1..].iter().fold(s[0].clone(), |solid, hole| solid.difference(hole, RULE)),
    );
    let mut operands = Vec::new();
    for i in 0..16 {
        let (x, y) = (f64::from(i % 4) - 1.5, f64::from(i / 4) - 1.5);
        let e = 0.2 + 0.1 * f64::from(i);
        operands.push((Superellipsoid::new([0.45, 0.45, 0.45], e, 0.5), at(x, y, 0.0)));
        operands.push((ball(0.35), at(x + 0.25, y - 0.25, 0.25)));
    }
    let set = Model::new(
        "16 x (A - B)",
        operands,
        |o| {
            let parts = o.chunks(2).map(|pair| pair[0].clone() - pair[1].clone());
            Csg::union_all(parts).expect("there are parts")
        },
        |s| Solid::union_all(s.chunks(2).map(|pair| pair[0].difference(&pair[1], RULE)), RULE),
    );
    vec![two, three, dents, set]
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let has = |word: &str| words.iter().any(|w| w == word);
    let both = has("models") == has("triangles");
    let rounds = if has("quick") { 2 } else { 7 };
    let run = Run { threads: if has("two") { 2 } else { 1 }, ..Run::default() };
    run.install(|| -> Result<(), String> {
        if both || has("models") {
            by_model(rounds).map_err(|e| e.to_string())?;
        }
        if both || has("triangles") {
            by_triangles(rounds).map_err(|e| e.to_string())?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Milliseconds of one call, and what it gives.
fn timed<T>(call: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = black_box(call());
    (1e3 * start.elapsed().as_secs_f64(), result)
}

const METHODS: [CsgMethod; 3] = [CsgMethod::Stencil, CsgMethod::Sequenced, CsgMethod::Intervals];

/// The least times, in milliseconds.
struct Row {
    meshes: f64,
    project: f64,
    methods: [Option<f64>; 3],
    picture: f64,
    scene: f64,
    trace: f64,
}

impl Row {
    fn ratio(&self) -> f64 {
        self.trace / (self.project + self.methods[2].unwrap_or(f64::NAN))
    }
}

/// A row, and the depths that meshes and rays find.
type Measured = (Row, Vec<f64>, Vec<f64>);

/// Times one model, and gives both depth images of the last round.
fn measure(model: &Model, columns: u32, side: u32, rounds: usize) -> Result<Measured, Box<dyn Error>> {
    let bounds = model.solid.bounds()?;
    let camera = Camera::framing(&bounds);
    let view = RasterView::new(&camera, side, side)?;
    let infinite = f64::INFINITY;
    let mut row = Row {
        meshes: infinite,
        project: infinite,
        methods: [None; 3],
        picture: infinite,
        scene: infinite,
        trace: infinite,
    };
    let (mut raster, mut implicit) = (Vec::new(), Vec::new());
    for _ in 0..rounds {
        let (time, meshes) = timed(|| model.meshes(columns));
        let meshes = meshes?;
        let (check, closed) = timed(|| meshes.iter().map(ClosedMesh::new).collect::<Result<Vec<_>, _>>());
        let closed = closed?;
        row.meshes = row.meshes.min(time + check);
        let (time, layers) = timed(|| closed.iter().map(|mesh| view.layers(*mesh)).collect::<Vec<_>>());
        row.project = row.project.min(time);
        let operands: Vec<&dyn LayerSource> = layers.iter().map(|l| l as &dyn LayerSource).collect();
        for (method, least) in METHODS.into_iter().zip(&mut row.methods) {
            let (time, buffers) = timed(|| view.csg(&operands, &model.tree, method));
            if let Ok(buffers) = buffers {
                *least = Some(least.unwrap_or(f64::INFINITY).min(time));
                raster = buffers.depths();
                let (time, picture) = timed(|| buffers.picture(&operands, &[[200, 60, 40], [40, 90, 200]]));
                picture?;
                row.picture = row.picture.min(time);
            }
        }
        let (time, scene) = timed(|| model.solid.scene());
        let scene = scene?;
        row.scene = row.scene.min(time);
        let rays = camera.rays(side, side);
        let (time, seen) = timed(|| scene.surfaces(&rays, Window::whole(side, side)));
        row.trace = row.trace.min(time);
        implicit = depths(&view, |x, y| seen.at(x, y).distance);
    }
    Ok((row, raster, implicit))
}

/// Distances along rays as depths along the view.
fn depths(view: &RasterView, distance: impl Fn(u32, u32) -> f64) -> Vec<f64> {
    let forward = view.direction(0.5 * f64::from(view.width()), 0.5 * f64::from(view.height()));
    let mut depths = Vec::new();
    for y in 0..view.height() {
        for x in 0..view.width() {
            let direction = view.direction(f64::from(x) + 0.5, f64::from(y) + 0.5);
            depths.push(distance(x, y) * direction.dot(forward));
        }
    }
    depths
}

fn by_model(rounds: usize) -> Result<(), Box<dyn Error>> {
    println!("milliseconds, one depth image; 8064 triangles an operand");
    println!(
        "{:<20}{:>6}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}",
        "model", "side", "meshes", "project", "stencil", "sequence", "interval", "picture", "scene", "trace", "ratio"
    );
    for model in &models() {
        for side in [256, 512, 1024] {
            let (row, ..) = measure(model, 128, side, rounds)?;
            let [stencil, sequence, interval] =
                row.methods.map(|time| time.map_or("-".to_string(), |ms| format!("{ms:.2}")));
            println!(
                "{:<20}{:>6}{:>9.2}{:>9.2}{:>9}{:>9}{:>9}{:>9.2}{:>9.2}{:>9.2}{:>8.1}",
                model.name,
                side,
                row.meshes,
                row.project,
                stencil,
                sequence,
                interval,
                row.picture,
                row.scene,
                row.trace,
                row.ratio()
            );
        }
    }
    Ok(())
}

fn by_triangles(rounds: usize) -> Result<(), Box<dyn Error>> {
    let model = &models()[0];
    println!("\n{}, 512 x 512, by the triangles of an operand; differences in depth, as parts of the size", model.name);
    println!(
        "{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}{:>11}{:>11}{:>12}",
        "triangles", "meshes", "project", "interval", "scene", "trace", "ratio", "99 %", "mean", "silhouette"
    );
    let size = model.solid.bounds()?.longest_side();
    for columns in [32, 64, 128, 256, 512, 1024] {
        let (row, raster, implicit) = measure(model, columns, 512, rounds)?;
        let both = raster.iter().zip(&implicit).filter(|(a, b)| a.is_finite() && b.is_finite());
        let mut off: Vec<f64> = both.map(|(a, b)| (a - b).abs() / size).collect();
        off.sort_unstable_by(f64::total_cmp);
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let one_only = raster.iter().zip(&implicit).filter(|(a, b)| a.is_finite() != b.is_finite()).count();
        println!(
            "{:>9}{:>9.2}{:>9.2}{:>9.2}{:>9.2}{:>9.2}{:>8.1}{:>11.1e}{:>11.1e}{:>12}",
            2 * columns * (columns / 2 - 1),
            row.meshes,
            row.project,
            row.methods[2].unwrap_or(f64::NAN),
            row.scene,
            row.trace,
            row.ratio(),
            off[off.len() * 99 / 100],
            mean,
            one_only
        );
    }
    Ok(())
}
