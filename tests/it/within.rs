//! Meshes within a tolerance: how far they are off, how many triangles they have, that they are
//! sound.

use glam::DVec3;
use rvachev::{
    Blend, Bounds, CancelToken, CellSize, Features, Gielis, Mesh, MeshSettings, MeshSolid, MinimalSurface, Run,
    SheetLattice, Solid, Supershape, ThinFeatures, deg, error::MeshingError,
};

use super::support::Random;
use crate::workpieces;

fn within(solid: &Solid, tolerance: f64) -> Mesh {
    let cell = CellSize::Tolerance(tolerance);
    solid.mesh(&MeshSettings { cell, ..MeshSettings::default() }).unwrap()
}

/// The largest distance from the surface of points of triangles: their middles, those of their
/// sides, others.
fn off(mesh: &Mesh, solid: &Solid) -> f64 {
    let mut random = Random::new(7);
    let step = mesh.triangles().len().div_ceil(400);
    let mut points = Vec::new();
    for triangle in mesh.triangles().iter().step_by(step) {
        let [a, b, c] = triangle.map(|v| mesh.positions()[v as usize].as_dvec3());
        let (s, t) = (random.unit(), random.unit());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        points.extend([(a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), a + s * (b - a) + t * (c - a)]);
    }
    let feet = solid.closest_surface_points(&points).unwrap();
    points.iter().zip(feet).map(|(p, foot)| p.distance(foot.unwrap())).fold(0.0, f64::max)
}

fn bracket() -> Solid {
    let plate = Solid::cuboid([60.0, 40.0, 6.0]);
    let wall = Solid::cuboid([6.0, 40.0, 40.0]).translate([-27.0, 0.0, 17.0]);
    let hole = Solid::cylinder(4.0, 20.0).translate([12.0, 10.0, 0.0]);
    let bore = Solid::cylinder(7.0, 20.0).rotate_y(deg(90.0)).translate([-27.0, 0.0, 22.0]);
    plate.union_with(wall, Blend::Fillet { radius: 5.0 }) - (hole.clone() | hole.mirrored(DVec3::Y, 0.0)) - bore
}

fn models() -> Vec<(&'static str, Solid)> {
    let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: 0.2 };
    let flower =
        Supershape::new(Gielis::polygon(6, 60.0), Gielis::polygon(4, 60.0)).scaled(DVec3::new(10.0, 10.0, 6.0));
    vec![
        ("box", Solid::cuboid([40.0, 30.0, 20.0])),
        ("turned box", Solid::cuboid([40.0, 30.0, 20.0]).rotate_x(deg(20.0)).rotate_z(deg(33.0))),
        ("sphere", Solid::sphere(10.0)),
        ("cylinder", Solid::cylinder(10.0, 30.0)),
        ("torus", Solid::torus(10.0, 3.0)),
        ("cone", Solid::cone(10.0, 0.0, 20.0)),
        ("superellipsoid", Solid::superellipsoid([20.0, 12.0, 8.0], 0.3, 0.5)),
        ("twisted", Solid::superellipsoid([6.0, 12.0, 20.0], 0.3, 0.5).twist(deg(3.0))),
        ("supershape", flower.into()),
        ("bracket", bracket()),
        ("gyroid", Solid::from(gyroid) & Solid::cuboid([1.0, 1.0, 1.0])),
    ]
}

/// The cells of one size that come as near, and the triangles of their mesh.
fn alike(solid: &Solid, tolerance: f64) -> usize {
    let mut cells = 16;
    loop {
        let cell = CellSize::LongestSide(cells);
        let mesh = solid.mesh(&MeshSettings { cell, ..MeshSettings::default() }).unwrap();
        if off(&mesh, solid) <= tolerance || cells > 400 {
            return mesh.triangles().len();
        }
        cells = cells * 5 / 4;
    }
}

/// Those that take longest.
const LONG: [&str; 4] = ["superellipsoid", "supershape", "torus", "gyroid"];

#[test]
fn meshes_are_within_the_tolerance_and_sound() {
    all_are_within(|name| !LONG.contains(&name));
}

#[test]
#[ignore = "takes minutes"]
fn meshes_are_within_the_tolerance_at_length() {
    all_are_within(|_| true);
}

fn all_are_within(is_asked: impl Fn(&str) -> bool) {
    let is_long = is_asked(LONG[0]);
    for (name, solid) in models().into_iter().filter(|(name, _)| is_asked(name)) {
        let size = solid.bounds().unwrap().longest_side();
        let tolerance = if name == "gyroid" { 3e-3 } else { 1e-3 } * size;
        let mesh = within(&solid, tolerance);
        let (off, told, count) = (off(&mesh, &solid), mesh.deviation().unwrap(), mesh.triangles().len());
        println!("{name}: {count} triangles, off {:.2}, told {:.2}", off / tolerance, told / tolerance);
        let report = mesh.check();
        assert!(report.is_sound(), "{name}: {report}");
        assert!(off <= tolerance && told <= tolerance, "{name}: {off}, told {told}, of {tolerance}");
        assert!(off <= 1.3 * told + 1e-9, "{name}: {off}, told {told}");
        if name == "sphere" || is_long && ["turned box", "superellipsoid", "bracket"].contains(&name) {
            let alike = alike(&solid, tolerance);
            println!("  {alike} in cells of one size");
            assert!(4 * count < 3 * alike, "{name}: {count}, {alike} in cells of one size");
        }
        assert!(mesh.warnings().iter().all(|warning| !warning.contains("off the surface")), "{:?}", mesh.warnings());
    }
}

#[test]
fn flat_faces_have_few_triangles_at_any_tolerance() {
    let plain = Solid::cuboid([40.0, 30.0, 20.0]);
    for part in [1e-1, 1e-3, 1e-5] {
        let mesh = within(&plain, 40.0 * part);
        assert!(mesh.triangles().len() < 100 && mesh.check().is_sound(), "{part}: {}", mesh.triangles().len());
        let part = part.max(3e-4);
        let turned = within(&plain.rotate_x(deg(20.0)).rotate_z(deg(33.0)), 40.0 * part);
        println!("{part}: {} {}", mesh.triangles().len(), turned.triangles().len());
        assert!(turned.triangles().len() < 1000 && turned.check().is_sound(), "{part}: {}", turned.triangles().len());
        assert!((turned.volume() / 24000.0 - 1.0).abs() < 3.0 * part);
    }
}

#[test]
fn a_sphere_has_triangles_in_proportion_to_its_radius_over_the_tolerance() {
    for (radius, tolerance) in [(1.0, 1e-2), (1.0, 1e-3), (50.0, 0.05)] {
        let count = within(&Solid::sphere(radius), tolerance).triangles().len() as f64;
        let share = count * tolerance / radius;
        assert!((6.0..16.0).contains(&share), "{share}");
    }
}

#[test]
fn what_else_is_asked_for_is_kept() {
    let half = Solid::cylinder(3.0, 10.0).paint([200, 30, 30]);
    let part = Solid::cuboid([10.0, 10.0, 4.0]).paint([20, 20, 200]) | half;
    let settings = MeshSettings { cell: CellSize::Tolerance(0.01), owners: true, ..MeshSettings::default() };
    let mesh = part.mesh(&settings).unwrap();
    assert!(mesh.check().is_sound());
    // Each triangle is of one leaf, and has its colour: none spans the joint.
    for (number, &triangle) in mesh.triangles().iter().enumerate().step_by(mesh.triangles().len().div_ceil(400)) {
        let middle = triangle.map(|v| mesh.positions()[v as usize].as_dvec3()).into_iter().sum::<DVec3>() / 3.0;
        let owner = part.owner(middle).unwrap();
        let red = mesh.corner_colors().unwrap()[number][0][0] == 200;
        assert_eq!(owner.path.contains("cylinder"), red, "{middle}");
    }
    assert!(mesh.corner_normals().unwrap().len() == mesh.triangles().len() && mesh.owners().is_some());
    // Cut by bounds, thin walls found, creases cut off.
    let bounds = Some(Bounds::from_center(DVec3::ZERO, DVec3::splat(3.0)));
    let cut = part.mesh(&MeshSettings { bounds, cell: CellSize::Tolerance(0.1), ..settings.clone() }).unwrap();
    assert!(cut.check().is_sound() && (cut.bounds().size() - DVec3::splat(6.0)).abs().max_element() < 1e-3);
    let fin = Solid::cuboid([0.03, 0.8, 0.8]).translate([0.0, 0.0, 1.3]) | Solid::cuboid([2.0, 2.0, 2.0]);
    let thin = ThinFeatures::Refine { halvings: 2 };
    let mesh = fin.mesh(&MeshSettings { thin, cell: CellSize::Tolerance(0.01), ..MeshSettings::default() }).unwrap();
    assert!(mesh.check().is_sound() && mesh.possibly_lost() == 0 && mesh.bounds().max.z > 1.69);
    let features = Features::Smooth;
    let smooth =
        part.mesh(&MeshSettings { features, cell: CellSize::Tolerance(0.3), ..MeshSettings::default() }).unwrap();
    assert!(smooth.check().is_sound() && smooth.deviation().unwrap() <= 0.3);
}

#[test]
fn what_cannot_be_reached_is_told() {
    // Single precision has steps of 0.0005 there.
    let far = Solid::sphere(1.0).translate([5000.0, 0.0, 0.0]);
    let mesh = within(&far, 1e-5);
    assert!(mesh.deviation().unwrap() > 1e-5 && mesh.check().is_manifold());
    assert!(mesh.warnings().iter().any(|warning| warning.contains("off the surface")), "{:?}", mesh.warnings());
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let cell = CellSize::Tolerance(wrong);
        let error = Solid::sphere(1.0).mesh(&MeshSettings { cell, ..MeshSettings::default() }).unwrap_err();
        assert!(error.to_string().starts_with(&format!("tolerance is {wrong}; it must be finite")), "{error}");
    }
}

#[test]
fn threads_do_not_matter_and_it_can_be_cancelled() {
    let settings = MeshSettings { cell: CellSize::Tolerance(0.05), ..MeshSettings::default() };
    let [one, two] = [1, 2].map(|threads| bracket().mesh_with(&settings, &Run { threads, ..Run::default() }).unwrap());
    assert_eq!(one, two);
    let cancel = CancelToken::new();
    cancel.cancel();
    let cancelled = bracket().mesh_with(&settings, &Run { cancel, ..Run::default() });
    assert!(matches!(cancelled, Err(MeshingError::Cancelled(_))));
    let empty = (Solid::sphere(1.0) & Solid::sphere(1.0).translate([5.0, 0.0, 0.0])).mesh(&settings).unwrap();
    assert!(empty.triangles().is_empty());
}

/// Bounds that touch the solid on some sides, and cut it on others, add nothing where they touch.
#[test]
fn bounds_that_touch_a_round_side_are_no_edges() {
    let can = Solid::cylinder(1.0, 2.0);
    let mesh = |reach: f64| {
        let bounds = Some(Bounds::new([-reach, -reach, -0.5], [reach, reach, 0.5]));
        can.mesh(&MeshSettings { bounds, cell: CellSize::Tolerance(0.03), ..MeshSettings::default() }).unwrap()
    };
    let (touched, free) = (mesh(1.0), mesh(1.5));
    let (few, most) = (free.triangles().len(), touched.triangles().len());
    assert!(most < 2 * few, "{most} triangles, {few} without sides that touch");
    assert!((touched.volume() - std::f64::consts::PI).abs() < 0.1 && touched.check().is_closed());
}

/// What does not end on a side is cut there by the bounds, whatever it does on the others.
#[test]
fn what_has_no_end_is_cut_by_the_bounds() {
    let bounds = Some(Bounds::new(DVec3::splat(-1.0), DVec3::splat(1.0)));
    let settings = MeshSettings { cell: CellSize::LongestSide(16), bounds, ..MeshSettings::default() };
    let volume = |solid: Solid| {
        let mesh = solid.mesh(&settings).unwrap();
        assert!(mesh.check().is_sound());
        mesh.volume()
    };
    for axis in DVec3::AXES {
        let half = volume(Solid::half_space(axis, 0.0));
        assert!((half - 4.0).abs() < 1e-3, "{axis}: {half}");
        let half = volume(Solid::half_space(-axis, 0.25));
        assert!((half - 5.0).abs() < 1e-3, "{axis}: {half}");
    }
    let column = volume(rvachev::Profile::rectangle([1.0, 0.5]).column());
    assert!((column - 1.0).abs() < 1e-3, "{column}");
    let corner = Solid::half_space(DVec3::X, 0.0) & Solid::half_space(DVec3::Y, 0.0);
    assert!((volume(corner) - 2.0).abs() < 1e-3);
}

/// No point of a mesh that ends before an acute rim is far from the surface; the rim is from it.
#[test]
fn rims_are_within_the_tolerance() {
    let cone = Solid::cone(3.0, 0.0, 0.76);
    let rows = [
        (Solid::cone(3.0, 0.0, 2.0), [3.0, -1.0], 0.02),
        (cone.clone(), [3.0, -0.38], 0.05),
        (Solid::cylinder(3.2, 2.0) - cone.translate([0.0, 0.0, 0.9]), [3.0, 0.52], 0.04),
    ];
    for (number, (solid, [radius, height], tolerance)) in rows.into_iter().enumerate() {
        let mesh = within(&solid, tolerance);
        let measured = Solid::from_mesh(&mesh, MeshSolid::default());
        let at = |k: u32| DVec3::new(radius, 0.0, height).rotate_z(f64::from(k) * 0.0314);
        let points: Vec<DVec3> = (0..200).map(at).collect();
        let feet = measured.closest_surface_points(&points).unwrap();
        let off = points.iter().zip(feet).map(|(p, foot)| p.distance(foot.unwrap())).fold(0.0, f64::max);
        assert!(mesh.check().is_sound(), "row {number}");
        assert!(off < tolerance, "row {number}: {off}");
    }
}

/// Cells beside edges of an angle near 0 are not halved without end, and where triangles are wrong
/// once others are taken away, what is near them alone is kept.
#[test]
fn knife_edges_have_few_triangles() {
    have_few_triangles(&["king", "bishop"], 8000);
}

#[test]
#[ignore = "a minute"]
fn knife_edges_and_threads_have_few_triangles() {
    have_few_triangles(&["queen", "rook", "bolt"], 16_000);
}

fn have_few_triangles(names: &[&str], most: usize) {
    for (name, piece) in workpieces::plain().into_iter().filter(|(name, _)| names.contains(name)) {
        let tolerance = 0.2 / 64.0 * piece.bounds().unwrap().longest_side();
        let mesh = within(&piece, tolerance);
        assert!(mesh.check().is_sound() && mesh.triangles().len() < most, "{name}: {}", mesh.triangles().len());
        assert!(mesh.deviation().unwrap() <= tolerance, "{name}: {:?} of {tolerance}", mesh.deviation());
    }
}
