//! What a part measures that somebody else has made: a mesh is read, and told are its volume, its
//! area, its components, whether it is closed, and how thin its walls are.
//!
//! ```text
//!     |  |        |  |
//!     |  |<- t    |  |      The thickness at a point of the surface is the diameter of the largest ball that touches
//!     |  '--------'  |      there from inside.
//!     '--------------'
//! ```
//!
//! `cargo run --release --example measure_part -- part.stl` reads the file, and writes a picture of
//! its thickness beside it; with `--json`, what is told is one line of JSON. Without a file it
//! measures a pot that it writes first. Lengths are millimetres: of files that do not say what
//! theirs are, `--unit inch` (or micron, millimeter, centimeter, foot, meter) does.

mod json;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use glam::DVec3;
use rvachev::io::LoadSettings;
use rvachev::{
    Camera, CellSize, LengthUnit, Mesh, MeshSettings, MeshSolid, RenderSettings, Run, Solid, ThicknessReport, deg,
};

/// In the picture blue are so many times the least thickness, and more.
const THICK: f64 = 4.0;

/// What lengths of a file may be.
const UNITS: [(&str, LengthUnit); 6] = [
    ("micron", LengthUnit::Micron),
    ("millimeter", LengthUnit::Millimeter),
    ("centimeter", LengthUnit::Centimeter),
    ("inch", LengthUnit::Inch),
    ("foot", LengthUnit::Foot),
    ("meter", LengthUnit::Meter),
];

/// What is asked for.
#[derive(Default)]
struct Arguments {
    file: Option<PathBuf>,
    unit: Option<LengthUnit>,
    is_json: bool,
}

impl Arguments {
    fn read() -> Result<Arguments, Box<dyn Error>> {
        let mut found = Arguments::default();
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            match &word[..] {
                "--json" => found.is_json = true,
                "--unit" => {
                    let name = words.next().unwrap_or_default();
                    let unit = UNITS.iter().find(|(own, _)| *own == name).map(|(_, unit)| *unit);
                    found.unit = Some(unit.ok_or_else(|| format!("--unit: {name:?} is no unit, as inch is"))?);
                }
                option if option.starts_with("--") => return Err(format!("{option} is no option").into()),
                _ => found.file = Some(word.into()),
            }
        }
        Ok(found)
    }
}

/// A pot whose wall is thinner than its bottom.
fn pot() -> Result<PathBuf, Box<dyn Error>> {
    let pot = Solid::cylinder(20.0, 30.0) - Solid::cylinder(18.8, 30.0).translate([0.0, 0.0, 3.0]);
    std::fs::create_dir_all("target/examples")?;
    let path = PathBuf::from("target/examples/pot.stl");
    let settings = MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() };
    pot.mesh(&settings)?.save(&path)?;
    Ok(path)
}

/// A number with four digits that count.
fn figures(x: f64) -> String {
    let digits = if x == 0.0 || !x.is_finite() { 0 } else { 3 - x.abs().log10().floor() as i32 };
    if (0..=9).contains(&digits) { format!("{x:.*}", digits as usize) } else { format!("{x:.3e}") }
}

/// A picture of the part, red where it is thinnest and blue where it is thick, with a legend.
fn picture(solid: &Solid, thickness: &ThicknessReport, path: &Path) -> Result<(), Box<dyn Error>> {
    let finite = thickness.thicknesses().iter().filter(|thickness| thickness.is_finite());
    let thickest = finite.fold(thickness.least, |most, thickness| most.max(*thickness));
    let bounds = solid.bounds()?;
    let settings = RenderSettings { width: 640, height: 480, ..RenderSettings::default() };
    // With room for the legend.
    let framed = bounds.inflate(0.1 * bounds.longest_side());
    let camera = Camera::framing(&bounds).orbit(deg(0.0), deg(15.0)).fitted(&framed, 4.0 / 3.0);
    let range = [thickness.least, thickest.min(THICK * thickness.least)];
    thickness.picture(range, &camera, &settings, &Run::default())?.save(path)?;
    Ok(())
}

/// Round limits, from the first above a thickness on.
fn limits(least: f64) -> [f64; 3] {
    let decade = 10f64.powf(least.log10().floor());
    let round = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0].map(|part| part * decade);
    let first = round.iter().position(|limit| *limit > least).unwrap_or(0).min(3);
    [round[first], round[first + 1], round[first + 2]]
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::read()?;
    let file = match arguments.file {
        Some(file) => file,
        None => pot()?,
    };
    let mesh = Mesh::load_with(&file, &LoadSettings { file_unit: arguments.unit, ..LoadSettings::default() })?;
    let solid = Solid::from_mesh(&mesh, MeshSolid::default());
    let thickness = solid.thickness(&MeshSettings::default(), &Run::default())?;
    let path = file.with_extension("thickness.png");
    picture(&solid, &thickness, &path)?;
    if arguments.is_json {
        println!("{}", json::line(&mesh, &thickness));
        return Ok(());
    }
    let sides = |size: DVec3| size.to_array().map(figures).join(" x ");
    println!("{}: {} mm", file.display(), sides(mesh.bounds().size()));
    let open_edges = mesh.open_edges();
    if !open_edges.is_closed() {
        let (edges, length) = (open_edges.edges, figures(open_edges.length));
        println!("  open: {edges} edges of {length} mm together have no triangle on one side");
    }
    println!("  {} mm3, {} mm2", figures(mesh.volume()), figures(mesh.area()));
    for part in mesh.components() {
        println!("  a part of {} mm3, {} mm", figures(part.volume()), sides(part.bounds().size()));
    }
    println!("  {thickness}");
    if thickness.mesh.possibly_lost() > 0 {
        println!("  what is thinner than a cell of its mesh may be missing");
    }
    for limit in limits(thickness.least).into_iter().filter(|limit| limit.is_finite()) {
        let share = 100.0 * thickness.share_below(limit)?;
        println!("  thinner than {} mm: {share:.1} % of the surface", figures(limit));
    }
    println!("{}: red where it is thinnest, blue where it is thick", path.display());
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("measure_part: {error}");
            ExitCode::FAILURE
        }
    }
}
