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
//! measures a pot that it writes first. Lengths are millimetres.

use std::error::Error;
use std::path::{Path, PathBuf};

use rvachev::{Camera, CellSize, Mesh, MeshSettings, MeshSolid, RenderSettings, Run, Solid, ThicknessReport, deg};

/// A pot whose wall is thinner than its bottom.
fn pot() -> Result<PathBuf, Box<dyn Error>> {
    let pot = Solid::cylinder(20.0, 30.0) - Solid::cylinder(18.8, 30.0).translate([0.0, 0.0, 3.0]);
    std::fs::create_dir_all("target/examples")?;
    let path = PathBuf::from("target/examples/pot.stl");
    let settings = MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() };
    pot.mesh(&settings)?.save(&path)?;
    Ok(path)
}

/// What is told of a part, as one line of JSON.
fn json(mesh: &Mesh, thickness: &ThicknessReport) -> String {
    let number = |x: f64| if x.is_finite() { x.to_string() } else { "null".into() };
    let [x, y, z] = thickness.at.to_array().map(number);
    format!(
        r#"{{"volume": {}, "area": {}, "components": {}, "closed": {}, "least_thickness": {}, "at": [{x}, {y}, {z}]}}"#,
        number(mesh.volume()),
        number(mesh.area()),
        mesh.components().len(),
        mesh.open_edges().is_closed(),
        number(thickness.least),
    )
}

/// A picture of the part, red where it is thinnest and blue where it is thickest, with a legend.
fn picture(solid: &Solid, thickness: &ThicknessReport, path: &Path) -> Result<(), Box<dyn Error>> {
    let finite = thickness.thicknesses().iter().filter(|thickness| thickness.is_finite());
    let thickest = finite.fold(thickness.least, |most, thickness| most.max(*thickness));
    let bounds = solid.bounds()?;
    let settings = RenderSettings { width: 640, height: 480, ..RenderSettings::default() };
    // With room for the legend.
    let framed = bounds.inflate(0.1 * bounds.longest_side());
    let camera = Camera::framing(&bounds).orbit(deg(0.0), deg(15.0)).fitted(&framed, 4.0 / 3.0);
    thickness.picture([thickness.least, thickest], &camera, &settings, &Run::default())?.save(path)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let file = match args.iter().find(|arg| *arg != "--json") {
        Some(file) => PathBuf::from(file),
        None => pot()?,
    };
    let mesh = Mesh::load(&file)?;
    let solid = Solid::from_mesh(&mesh, MeshSolid::default());
    let thickness = solid.thickness(&MeshSettings::default(), &Run::default())?;
    let path = file.with_extension("thickness.png");
    picture(&solid, &thickness, &path)?;
    if args.iter().any(|arg| arg == "--json") {
        println!("{}", json(&mesh, &thickness));
        return Ok(());
    }
    let size = mesh.bounds().size();
    println!("{}: {:.1} x {:.1} x {:.1} mm", file.display(), size.x, size.y, size.z);
    let open_edges = mesh.open_edges();
    if !open_edges.is_closed() {
        println!(
            "  open: {} edges of {:.2} mm together have no triangle on one side",
            open_edges.edges, open_edges.length
        );
    }
    println!("  {:.1} mm3, {:.1} mm2", mesh.volume(), mesh.area());
    for part in mesh.components() {
        let size = part.bounds().size();
        println!("  a part of {:.1} mm3, {:.1} x {:.1} x {:.1} mm", part.volume(), size.x, size.y, size.z);
    }
    println!("  {thickness}");
    for limit in [1.0, 2.0, 4.0] {
        println!("  thinner than {limit} mm: {:.1} % of the surface", 100.0 * thickness.share_below(limit));
    }
    println!("{}: red where it is thinnest, blue where it is thickest", path.display());
    Ok(())
}
