//! One model in every format that meshes are written in.
//!
//! ```text
//!        ____________
//!       /  .------.  \      A flange: a rounded plate with a hole through its middle and a
//!      |o |   ()   | o|     hub about it, and a ring of screw holes.
//!       \  '------'  /
//!        '----------'
//! ```
//!
//! Lengths are millimetres. STL has facets only; OBJ and PLY keep the vertices shared; GLB
//! splits them where they carry several normals; 3MF says that the unit is a millimetre.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use rvachev::{CellSize, Mesh, MeshSettings, SaveSettings, Solid};

fn flange() -> Solid {
    let plate = Solid::cylinder(30.0, 6.0);
    let hub = Solid::cylinder(14.0, 20.0).translate(DVec3::Z * 7.0);
    let bore = Solid::cylinder(8.0, 60.0);
    let holes = (0..6).map(|i| {
        let (y, x) = (f64::from(i) * std::f64::consts::FRAC_PI_3).sin_cos();
        Solid::cylinder(2.75, 20.0).translate(DVec3::new(22.0 * x, 22.0 * y, 0.0))
    });
    holes.fold((plate | hub) - bore, |flange, hole| flange - hole)
}

/// The mesh with its upper parts in another colour.
fn painted(mesh: Mesh) -> Result<Mesh, Box<dyn Error>> {
    let color = |i: u32| if mesh.positions()[i as usize].z > 3.05 { [230, 120, 40, 255] } else { [70, 90, 120, 255] };
    let colors = mesh.triangles().iter().map(|t| t.map(color)).collect();
    Ok(mesh.with_corner_colors(colors)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let settings = MeshSettings { cell: CellSize::LongestSide(120), ..MeshSettings::default() };
    let mesh = painted(flange().mesh(&settings)?)?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    println!("A flange, meshed in {:.2} s.\n{}\n", start.elapsed().as_secs_f64(), mesh.check());

    let folder = Path::new("target/export");
    fs::create_dir_all(folder)?;
    for name in ["flange.stl", "flange-text.stl", "flange.obj", "flange.ply", "flange.glb", "flange.3mf"] {
        let path = folder.join(name);
        let start = Instant::now();
        let text = SaveSettings { ascii: name.contains("text"), ..SaveSettings::default() };
        mesh.save_with(&path, &text)?;
        let size = fs::metadata(&path)?.len();
        println!("{:28} {:8.1} kB {:7.3} s", path.display(), size as f64 / 1e3, start.elapsed().as_secs_f64());
    }
    Ok(())
}
