//! A truncated supershape, and whole parts from segmented meshes.

use std::error::Error;
use std::path::Path;

use glam::DVec3;
use rvachev::fit::{PartSettings, Segments, UnionFit, UnionSettings, part as part_of, supershape_union};
use rvachev::{
    Bounds, Camera, CellSize, Gielis, MeshSettings, RFunction, Radius, RenderSettings, Solid, Supershape, deg,
};

use super::canvas::Sheet;

const PANEL: [u32; 2] = [340, 260];

/// What a label's points and body are painted with.
const PAINTS: [[u8; 3]; 6] =
    [[70, 110, 170], [215, 130, 50], [90, 150, 90], [160, 80, 150], [190, 70, 70], [120, 120, 60]];

fn paint(label: u32) -> [u8; 3] {
    PAINTS[label as usize % PAINTS.len()]
}

fn settings() -> RenderSettings {
    RenderSettings { width: PANEL[0], height: PANEL[1], ..RenderSettings::default() }
}

fn camera(bounds: &Bounds) -> Camera {
    Camera::framing(bounds).orbit(deg(25.0), deg(30.0)).fitted(bounds, f64::from(PANEL[0]) / f64::from(PANEL[1]))
}

/// A supershape, the box that cuts it, and what is in both.
pub fn truncated(folder: &Path) -> Result<(), Box<dyn Error>> {
    let star = Supershape::with(
        Gielis::new(6.0, 4.0, 7.0, 7.0),
        Gielis::new(4.0, 4.0, 4.0, 4.0),
        [1.0, 1.0, 0.9],
        Radius::Standard,
    );
    let star = Solid::from(star).paint(paint(0));
    let cut = Solid::cuboid([2.2, 3.4, 0.9]).translate([0.2, 0.0, 0.1]).paint(paint(1));
    let camera = camera(&star.bounds()?);
    let mut sheet = Sheet::new(3, 1, PANEL);
    let cases =
        [("supershape", star.clone()), ("box", cut.clone()), ("truncated", star.intersection(&cut, RFunction::P(2.0)))];
    for (title, solid) in cases {
        sheet.panel(title).picture(&solid.render(&camera, &settings())?);
    }
    sheet.save(&folder.join("paper_truncated.png"))?;
    Ok(())
}

/// The parts, by their names.
fn catalogue() -> [(&'static str, Solid); 8] {
    let plate = Solid::cuboid([3.0, 2.0, 1.0]);
    let hole = |radius: f64| Solid::cylinder(radius, 4.0);
    let star = Supershape::with(
        Gielis::new(5.0, 1.3, 1.1, 1.1),
        Gielis::new(4.0, 10.0, 10.0, 10.0),
        [1.6, 1.6, 0.5],
        Radius::Standard,
    );
    let shaft = Solid::cylinder(0.6, 4.0).rotate_y(deg(90.0));
    let disc = Solid::cylinder(1.2, 0.6).rotate_y(deg(90.0));
    let lever = Solid::cuboid([2.4, 0.7, 0.6]).translate([1.6, 0.0, 0.0])
        | Solid::cylinder(0.8, 1.6)
        | Solid::cylinder(0.6, 1.2).translate([3.0, 0.0, 0.0]);
    [
        ("two balls", Solid::sphere(1.0) | Solid::sphere(0.7).translate([1.3, 0.2, 0.0])),
        ("pin on a plate", &plate | Solid::cylinder(0.5, 2.0).translate([0.3, 0.2, 1.0])),
        ("star and ball", Solid::from(star) | Solid::sphere(0.7).translate([0.0, 0.0, 0.6])),
        ("box with a hole", Solid::cuboid([2.0, 2.0, 1.2]) - hole(0.4)),
        ("two holes", &plate - hole(0.35).translate([0.8, 0.1, 0.0]) - hole(0.45).translate([-0.7, 0.0, 0.0])),
        ("angle", Solid::cuboid([4.0, 2.0, 0.8]) | Solid::cuboid([0.8, 2.0, 3.0]).translate([-1.6, 0.0, 1.1])),
        ("stepped shaft", shaft | disc),
        ("lever", lever - hole(0.45) - hole(0.3).translate([3.0, 0.0, 0.0])),
    ]
}

/// Each part, the segments of its mesh, and what was recovered; errors are printed.
pub fn parts(folder: &Path) -> Result<(), Box<dyn Error>> {
    let parts = catalogue();
    let mut sheet = Sheet::new(3, parts.len() as u32, PANEL);
    println!("part: bodies, holes, IoU, rms deviation; error of fit of bodies, with holes, refined;");
    println!("beside it what fit::part makes of the same mesh: leaves, IoU, rms deviation, parameters");
    for (name, part) in parts {
        let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(60), ..MeshSettings::default() })?;
        let segments = Segments::of_mesh_by_creases(&mesh, deg(40.0))?;
        let fit = supershape_union(&segments, &UnionSettings::default())?;
        let error = fit.error();
        let tree = part_of(&mesh, &PartSettings::default())?;
        println!(
            "  {name}: {}, {}, {:.3}, {:.4}; {:.4}, {:.4}, {:.4} in {} steps; {} parameters; tree: {}, {:.3}, {:.4}, {}",
            fit.parts().len(),
            fit.holes(),
            overlap(&part, &fit.solid())?,
            fit.deviation().rms,
            error.bodies,
            error.holes,
            error.refined,
            fit.refinement_steps(),
            fit.parameters(),
            tree.leaves().len(),
            overlap(&part, &tree.solid())?,
            tree.deviation().rms,
            tree.parameters()
        );
        let camera = camera(&part.bounds()?);
        sheet.panel(name).picture(&part.render(&camera, &settings())?);
        points(&mut sheet, &segments, &camera);
        sheet.panel("recovered").picture(&painted(&fit).render(&camera, &settings())?);
    }
    sheet.save(&folder.join("paper_parts.png"))?;
    Ok(())
}

/// The union with each body painted as its segment is.
fn painted(fit: &UnionFit) -> Solid {
    let parts = fit.parts().iter().map(|part| part.solid().paint(paint(part.label)));
    Solid::union_all(parts, RFunction::P(2.0))
}

/// The points that face the camera, by their labels.
fn points(sheet: &mut Sheet, segments: &Segments, camera: &Camera) {
    let (pose, intrinsics) = (camera.pose().inverse(), camera.intrinsics(PANEL[0], PANEL[1]));
    let normals = segments.cloud().normals().unwrap_or_default();
    let mut seen: Vec<(f64, glam::DVec2, [u8; 3])> = Vec::new();
    for ((p, n), label) in segments.cloud().positions().iter().zip(normals).zip(segments.labels()) {
        let local = pose.transform_point3(*p);
        let facing = -pose.transform_vector3(n.as_dvec3()).dot(local.normalize_or_zero());
        if facing > 0.0
            && let Some(at) = intrinsics.project(local)
        {
            seen.push((local.z, at, paint(*label).map(|c| (f64::from(c) * (0.45 + 0.65 * facing)).min(255.0) as u8)));
        }
    }
    seen.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut panel = sheet.panel("segments");
    for (_, at, color) in seen {
        panel.dot(at, 2.6, color);
    }
}

/// The volume of what is in both over that of what is in either, by points of a box about the
/// first.
fn overlap(truth: &Solid, found: &Solid) -> Result<f64, Box<dyn Error>> {
    let bounds = truth.bounds()?;
    let (low, size) = (bounds.min - 0.05 * bounds.size(), 1.1 * bounds.size());
    // An additive sequence of low discrepancy.
    let steps = DVec3::new(0.819_172_513_396_164_5, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3);
    let points: Vec<DVec3> = (1..=40_000).map(|i| low + size * (steps * f64::from(i)).fract()).collect();
    let (a, b) = (truth.contains_all(&points)?, found.contains_all(&points)?);
    let count = |of: fn(bool, bool) -> bool| a.iter().zip(&b).filter(|(a, b)| of(**a, **b)).count();
    Ok(count(|a, b| a && b) as f64 / count(|a, b| a || b).max(1) as f64)
}
