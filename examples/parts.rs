//! The pictures of the page on whole parts: what is given, and the tree that is found, a colour a
//! leaf.
//!
//! ```sh
//! cargo run --release --example parts             # into target/examples/parts
//! cargo run --release --example parts docs        # into docs/parts, as committed
//! ```
//!
//! The code of each tree is printed.

use std::error::Error;
use std::path::PathBuf;

use glam::DVec3;
use rvachev::fit::{PartFit, PartSettings, part, part_of_points};
use rvachev::{CellSize, Mesh, MeshSettings, MeshSolid, PointCloud, RFunction, Solid, deg};

mod page;

use page::{GREY, picture, save, side_by_side};

/// Leaves are coloured one after the other.
const COLORS: [[u8; 3]; 6] =
    [[112, 150, 186], [206, 122, 90], [104, 160, 116], [214, 178, 94], [150, 118, 170], [110, 176, 180]];

/// Towards the eye.
const DIRECTION: DVec3 = DVec3::new(0.45, -1.0, 0.8);

/// Between two solids, in parts of their width.
const GAP: f64 = 0.12;

/// A flange: a disc with a pipe, bored through, and a ring of holes. Millimetres.
pub(crate) fn flange() -> Solid {
    let disc = Solid::cylinder(30.0, 8.0);
    let pipe = Solid::cylinder(12.0, 30.0).translate([0.0, 0.0, 15.0]);
    let holes = Solid::cylinder(3.5, 20.0).translate([22.0, 0.0, 0.0]).repeat_polar(6);
    (disc | pipe) - Solid::cylinder(8.0, 80.0) - holes
}

/// A bracket in inches, modelled in millimetres: two plates, a slot, and a grid of counterbores.
pub(crate) fn bracket() -> Solid {
    let inch = 25.4;
    let foot = Solid::cuboid([4.0 * inch, 2.5 * inch, 0.5 * inch]);
    let back = Solid::cuboid([4.0 * inch, 0.5 * inch, 2.0 * inch]).translate([0.0, 1.0 * inch, 1.0 * inch]);
    let bore = |radius: f64, height: f64, z: f64| {
        let one = Solid::cylinder(radius * inch, height * inch).translate([-1.5 * inch, -0.875 * inch, z * inch]);
        one.repeat_linear(3, [1.5 * inch, 0.0, 0.0]).repeat_linear(2, [0.0, 1.0 * inch, 0.0])
    };
    let window = Solid::cylinder(0.5 * inch, 2.0 * inch).rotate_x(deg(90.0)).translate([0.0, inch, 1.25 * inch]);
    (foot | back) - bore(0.125, 2.0, 0.0) - bore(0.25, 0.5, 0.375) - window
}

/// A housing: a block with a pocket, a boss on its floor, and a bore through both. Millimetres.
pub(crate) fn housing() -> Solid {
    let block = Solid::cuboid([60.0, 44.0, 24.0]);
    let pocket = Solid::cuboid([48.0, 32.0, 24.0]).translate([0.0, 0.0, 8.0]);
    let boss = Solid::cylinder(9.0, 16.0).translate([8.0, 0.0, -2.0]);
    ((block - pocket) | boss) - Solid::cylinder(5.0, 60.0).translate([8.0, 0.0, 0.0])
}

fn meshed(solid: &Solid, tolerance: f64) -> Result<Mesh, Box<dyn Error>> {
    Ok(solid.mesh(&MeshSettings { cell: CellSize::Tolerance(tolerance), ..MeshSettings::default() })?)
}

/// Points of a surface as a scanner has them: off it by so much on the average of squares.
fn scanned(solid: &Solid, noise: f64) -> Result<PointCloud, Box<dyn Error>> {
    let mesh = solid.mesh(&MeshSettings { cell: CellSize::LongestSide(48), ..MeshSettings::default() })?;
    let normals = mesh.normals().ok_or("a mesh of a solid has normals")?;
    let points = (0_u32..).zip(mesh.positions()).map(|(i, p)| {
        // Three numbers that look random have nearly a normal sum.
        let t = |k: f64| (f64::from(i) * k).fract() - 0.5;
        let off = 2.0 * noise * (t(0.754_877_666) + t(0.569_840_291) + t(0.381_966_011));
        p.as_dvec3() + off * normals[i as usize].as_dvec3()
    });
    Ok(PointCloud::new(points.collect())?.with_normals(normals.to_vec())?)
}

/// The tree with a colour a leaf, those of a pattern of one.
fn painted(fit: &PartFit) -> Solid {
    let mut colors: Vec<usize> = (0..fit.leaves().len()).collect();
    for pattern in fit.patterns() {
        pattern.leaves.iter().for_each(|i| colors[*i] = pattern.leaves[0]);
    }
    let leaf = |i: usize| fit.leaves()[i].solid().paint(COLORS[colors[i] % COLORS.len()]);
    (1..fit.leaves().len())
        .fold(leaf(0), |solid, i| if fit.leaves()[i].is_cut() { solid - leaf(i) } else { solid | leaf(i) })
}

fn main() -> Result<(), Box<dyn Error>> {
    let docs = std::env::args().nth(1).is_some_and(|argument| argument == "docs");
    let folder = PathBuf::from(if docs { "docs/parts" } else { "target/examples/parts" });
    std::fs::create_dir_all(&folder)?;
    let samples = if docs { 3 } else { 1 };
    let of_mesh = |mesh: &Mesh| Solid::from_mesh(mesh, MeshSolid::default()).paint(GREY);
    let [flange, bracket] = [(flange(), 0.02), (bracket(), 0.02)].map(|(solid, within)| meshed(&solid, within));
    let (flange, bracket, cloud) = (flange?, bracket?, scanned(&housing(), 0.15)?);
    let dots = cloud.positions().iter().map(|p| Solid::sphere(0.35).translate(*p));
    let scenes = [
        ("flange", of_mesh(&flange), part(&flange, &PartSettings::default())?),
        ("bracket", of_mesh(&bracket), part(&bracket, &PartSettings::default())?),
        (
            "housing",
            Solid::union_all(dots, RFunction::MIN_MAX).paint(GREY),
            part_of_points(&cloud, &PartSettings::default())?,
        ),
    ];
    for (name, given, fit) in scenes {
        let (iou, leaves, parameters) = (fit.iou(), fit.leaf_count(), fit.parameters());
        println!("{name}: IoU {iou:.4}, {leaves} leaves, {parameters} parameters, {:?}\n", fit.topology());
        println!("{}", fit.to_rust(name));
        let found = painted(&fit);
        let gap = GAP * found.bounds()?.size().dot(DVec3::Z.cross(DIRECTION).normalize().abs());
        let row = side_by_side(&[given, found], gap, DIRECTION)?;
        save(&picture(&row, DIRECTION, (760, 380), samples)?, &folder.join(format!("{name}.png")))?;
        println!();
    }
    Ok(())
}
