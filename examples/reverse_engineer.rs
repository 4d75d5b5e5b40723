//! From a mesh to code: the tree of leaves that a part is made of, as Rust that one can edit.
//!
//! ```text
//!     part.stl  →  fit::part  →  tree, table            printed
//!                                part.rs                the tree as Rust code
//!                                sides.png              the mesh and the recovered solid
//!                                deviations.png         how far the mesh is from it, by colours
//! ```
//!
//! `cargo run --release --example reverse_engineer -- FILE [--out FOLDER] [--json] [--no-snap] [--mesh OUT]`
//! reads an STL, OBJ, PLY, 3MF or GLB file; without one, a part of its own. `--json` prints one
//! object on one line and writes nothing but what `--mesh` asks for: the recovered solid as a mesh.
//! `--no-snap` leaves numbers as they fit best.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::fit::{PartFit, PartSettings, inspect, part};
use rvachev::{Camera, CellSize, Image, Mesh, MeshSettings, MeshSolid, PointCloud, RenderSettings, Solid, deg};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 560;

/// What the command line asks for.
struct Arguments {
    file: Option<PathBuf>,
    folder: PathBuf,
    json: bool,
    snap: bool,
    mesh: Option<PathBuf>,
}

impl Arguments {
    fn read() -> Result<Arguments, Box<dyn Error>> {
        let mut arguments = Arguments {
            file: None,
            folder: "target/examples/reverse_engineer".into(),
            json: false,
            snap: true,
            mesh: None,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut path = |what: &str| words.next().map(PathBuf::from).ok_or(format!("{what} is followed by a path"));
            match &*word {
                "--json" => arguments.json = true,
                "--no-snap" => arguments.snap = false,
                "--mesh" => arguments.mesh = Some(path("--mesh")?),
                "--out" => arguments.folder = path("--out")?,
                _ if word.starts_with("--") => {
                    return Err(format!("{word} is none of --out FOLDER, --json, --no-snap, --mesh OUT").into());
                }
                _ => arguments.file = Some(word.into()),
            }
        }
        Ok(arguments)
    }
}

/// A part to try it with: a flange with a pipe, bored through, and a ring of holes. Millimetres.
fn flange() -> Solid {
    let disc = Solid::cylinder(30.0, 8.0);
    let pipe = Solid::cylinder(12.0, 30.0).translate([0.0, 0.0, 15.0]);
    let bore = Solid::cylinder(8.0, 80.0);
    let holes = Solid::cylinder(3.5, 20.0).translate([22.0, 0.0, 0.0]).repeat_polar(6);
    (disc | pipe) - bore - holes
}

/// Points all over a mesh, near evenly by area.
fn points_of(mesh: &Mesh, count: f64) -> Vec<DVec3> {
    let corners = |triangle: &[u32; 3]| triangle.map(|v| mesh.positions()[v as usize].as_dvec3());
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = corners(triangle);
        0.5 * (b - a).cross(c - a).length()
    };
    let all: f64 = mesh.triangles().iter().map(area).sum();
    let mut points = Vec::new();
    // How many points are due: whole ones are laid, the rest is left to the next triangle.
    let mut due = 0.0;
    for triangle in mesh.triangles() {
        let [a, b, c] = corners(triangle);
        due += count * area(triangle) / all;
        while due >= 1.0 {
            due -= 1.0;
            let n = points.len() as f64;
            let (s, t) = ((n * 0.754_877_666).fract(), (n * 0.569_840_291).fract());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            points.push(a + s * (b - a) + t * (c - a));
        }
    }
    points
}

/// Two pictures side by side.
fn beside(left: &Image, right: &Image) -> Result<Image, Box<dyn Error>> {
    let rows = left.pixels().chunks(left.width() as usize).zip(right.pixels().chunks(right.width() as usize));
    let pixels = rows.flat_map(|(left, right)| [left, right].concat()).collect();
    Ok(Image::new(left.width() + right.width(), left.height(), pixels)?)
}

/// One object on one line.
fn json(fit: &PartFit, seconds: f64) -> String {
    let genus = |genus: Option<i64>| genus.map_or("null".to_owned(), |genus| genus.to_string());
    format!(
        r#"{{"iou": {:.5}, "leaves": {}, "parameters": {}, "genus": {}, "genus_input": {}, "shells": {}, "seconds": {:.3}}}"#,
        fit.iou(),
        fit.leaf_count(),
        fit.parameters(),
        genus(fit.topology().genus),
        genus(fit.topology_of_input().genus),
        fit.topology().shells,
        seconds
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::read()?;
    let (name, mesh) = match &arguments.file {
        Some(file) => (file.file_stem().unwrap_or_default().to_string_lossy().into_owned(), Mesh::load(file)?),
        None => {
            let cells = MeshSettings { cell: CellSize::Tolerance(0.01), ..MeshSettings::default() };
            ("flange".to_owned(), flange().mesh(&cells)?)
        }
    };
    let start = Instant::now();
    let fit = part(&mesh, &PartSettings { snap: arguments.snap, ..PartSettings::default() })?;
    let seconds = start.elapsed().as_secs_f64();
    let solid = fit.solid();
    if let Some(out) = &arguments.mesh {
        solid.mesh(&MeshSettings { cell: CellSize::LongestSide(160), ..MeshSettings::default() })?.save(out)?;
    }
    if arguments.json {
        println!("{}", json(&fit, seconds));
        return Ok(());
    }

    println!("{name}: {} triangles, {:.2} s\n", mesh.triangles().len(), seconds);
    println!("{:<24} {:<44} {:>10} {:>9}  centre", "leaf", "what it is", "parameters", "surface");
    for leaf in fit.leaves() {
        let [x, y, z] = leaf.centre().to_array().map(|v| (1000.0 * v).round() / 1000.0 + 0.0);
        let (name, text, share) = (leaf.name(), leaf.text(), 100.0 * leaf.surface());
        println!("{name:<24} {text:<44} {:>10} {share:>7.1} %  {x}, {y}, {z}", leaf.parameters());
    }
    let (genus, shells) = (fit.topology().genus, fit.topology().shells);
    let (iou, leaves, parameters) = (fit.iou(), fit.leaf_count(), fit.parameters());
    println!("\nIoU {iou:.4}, {leaves} leaves, {parameters} parameters, genus {genus:?}, {shells} shells");
    let input = fit.topology_of_input();
    println!("the mesh: genus {:?}, {} shells", input.genus, input.shells);
    for place in fit.unexplained() {
        let what = if place.missing { "missing" } else { "too much" };
        println!("{what}: {:.2} % of the volume in {}", 100.0 * place.share, place.bounds);
    }
    println!("\n{solid}");

    std::fs::create_dir_all(&arguments.folder)?;
    let text = fit.to_rust(&name);
    println!("{text}");
    write(&arguments.folder, &name, &mesh, &solid, &text)
}

/// The code and both pictures.
fn write(folder: &Path, name: &str, mesh: &Mesh, solid: &Solid, code: &str) -> Result<(), Box<dyn Error>> {
    std::fs::write(folder.join(format!("{name}.rs")), code)?;
    let camera = Camera::framing(&solid.bounds()?).orbit(deg(35.0), deg(28.0));
    let settings = RenderSettings { width: WIDTH, height: HEIGHT, samples: 2, ..RenderSettings::default() };
    let scan = Solid::from_mesh(mesh, MeshSolid::default());
    let sides = beside(&scan.render(&camera, &settings)?, &solid.render(&camera, &settings)?)?;
    sides.save(folder.join("sides.png"))?;
    let cloud = PointCloud::new(points_of(mesh, 60_000.0))?;
    let report = inspect(solid, &cloud)?;
    let reach = (4.0 * report.sizes().percentile_95).max(1e-4 * solid.bounds()?.size().length());
    report.picture(&cloud, reach, &camera, 960, 720)?.save(folder.join("deviations.png"))?;
    println!("95 % of the mesh within {:.4} of the solid; {}", report.sizes().percentile_95, folder.display());
    Ok(())
}
