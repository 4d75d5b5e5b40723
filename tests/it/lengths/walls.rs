//! Walls of the thickness that is asked for, leaf by leaf.

use glam::DVec3;
use rvachev::{
    Capsule, CellSize, Cone, Cuboid, Cylinder, Ellipsoid, Features, GeneralisedSuperquadric, Gielis, MeshSettings,
    MinimalSurface, Prism, Pyramid, RFunction, RoundedCuboid, SheetLattice, Solid, SolidError, Sphere, Superellipsoid,
    Superhyperboloid, Supershape, Wedge, law::SineWave, program::Region, rad,
};

use crate::support::{Random, lanes32, off_surface};

fn convex_leaves() -> Vec<(String, Solid)> {
    let mut leaves: Vec<(String, Solid)> = vec![
        ("sphere".into(), Sphere { radius: 0.8 }.into()),
        ("box".into(), Cuboid { size: DVec3::new(1.0, 2.0, 1.5) }.into()),
        ("cylinder".into(), Cylinder { radius: 0.6, height: 2.0 }.into()),
        ("rounded box".into(), RoundedCuboid { size: DVec3::new(1.0, 2.0, 1.5), radius: 0.2 }.into()),
        ("cone".into(), Cone { bottom_radius: 0.8, top_radius: 0.3, height: 1.4 }.into()),
        ("capsule".into(), Capsule { radius: 0.4, height: 2.0 }.into()),
        ("prism".into(), Prism::new(5, 0.8, 1.2).into()),
        ("pyramid".into(), Pyramid::new(4, 1.0, 1.4).into()),
        ("wedge".into(), Wedge { size: DVec3::new(1.0, 1.5, 1.2) }.into()),
        ("ellipsoid".into(), Ellipsoid { semi_axes: DVec3::new(1.0, 0.6, 1.4) }.into()),
        ("generalised".into(), GeneralisedSuperquadric::new(DVec3::new(1.0, 0.7, 0.9), [5.0, 3.0, 1.5]).into()),
    ];
    for [e1, e2] in [[0.1, 0.1], [0.3, 0.7], [0.1, 1.0], [1.0, 1.0], [1.0, 0.2], [1.5, 0.5], [1.2, 1.8], [2.0, 2.0]] {
        let leaf = Superellipsoid::new(DVec3::new(1.0, 0.7, 0.5), e1, e2);
        leaves.push((format!("superellipsoid {e1} {e2}"), leaf.into()));
    }
    leaves
}

/// The point where the way from `inside` along `direction` leaves the solid.
fn way_out(solid: &Solid, inside: DVec3, direction: DVec3) -> Result<Option<DVec3>, SolidError> {
    if !solid.contains(inside)? {
        return Ok(None);
    }
    let (mut near, mut far) = (0.0, 10.0);
    for _ in 0..50 {
        let middle = 0.5 * (near + far);
        if solid.contains(inside + middle * direction)? { near = middle } else { far = middle }
    }
    Ok(Some(inside + near * direction))
}

/// How far, relative to `by`, the offset of a solid is from its surface: least and most.
fn measured(solid: &Solid, by: f64, count: usize) -> Result<(f64, f64), SolidError> {
    let moved = solid.offset(by);
    // Well inside, the wedge's slanted face being half way.
    let bounds = solid.bounds()?;
    let centre = bounds.center() - 0.2 * bounds.half_extents();
    let mut random = Random::new(91);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for _ in 0..count {
        let Some(p) = way_out(&moved, centre, random.direction())? else { continue };
        let Some(foot) = solid.closest_surface_point(p)? else { continue };
        let thickness = p.distance(foot) / by.abs();
        (least, most) = (least.min(thickness), most.max(thickness));
    }
    Ok((least, most))
}

#[test]
fn walls_of_convex_leaves_have_their_thickness() -> Result<(), SolidError> {
    for (name, solid) in convex_leaves() {
        let half = solid.bounds()?.half_extents().min_element();
        for part in [0.02, 0.1] {
            for sign in [-1.0, 1.0] {
                let (least, most) = measured(&solid, sign * part * half, 12)?;
                println!("{name:24} {:+.0} % of the half-size: {least:.4} to {most:.4}", 100.0 * sign * part);
                assert!(least > 0.98 && (0.98..1.02).contains(&most), "{name} {part} {sign}: {least} to {most}");
            }
        }
    }
    Ok(())
}

#[test]
fn walls_keep_their_thickness_under_maps() -> Result<(), SolidError> {
    let pill = Solid::superellipsoid(DVec3::new(1.0, 0.7, 0.5), 0.3, 0.7);
    for (name, solid) in [
        ("turned and scaled", pill.scale(1.5).rotate_x(rad(0.4))),
        ("stretched", pill.scale_axes(DVec3::new(1.0, 1.4, 0.8))),
        ("twisted", pill.twist(rad(0.5))),
        ("tapered", pill.taper(0.3, -0.2, 1.0)),
        ("bent", pill.bend(0.4, rad(0.3))),
        ("box, stretched", Solid::cuboid(DVec3::ONE).scale_axes(DVec3::new(1.0, 2.0, 1.5))),
    ] {
        let half = solid.bounds()?.half_extents().min_element();
        for sign in [-1.0, 1.0] {
            let (least, most) = measured(&solid, sign * 0.1 * half, 12)?;
            println!("{name:24} {sign:+}: {least:.4} to {most:.4}");
            assert!(least > 0.97 && most < 1.03, "{name} {sign}: {least} to {most}");
        }
    }
    Ok(())
}

#[test]
fn shells_prune_and_their_boxes_hold() -> Result<(), SolidError> {
    for (name, solid) in convex_leaves() {
        let half = solid.bounds()?.half_extents().min_element();
        let (shell, grown) = (solid.shell(0.1 * half), solid.offset(0.1 * half));
        let (program, bounds) = (shell.surface_program()?, grown.bounds()?);
        let mut random = Random::new(92);
        for _ in 0..60 {
            let p = random.point_in(&bounds.inflate(0.2));
            assert!(bounds.contains(p) || !grown.contains(p)?, "{name} {p}");
            let size = random.log_range(0.005, 0.3);
            let region = rvachev::Bounds::new(p - size, p + size);
            let inside = program.value(p) > 0.0;
            match program.narrow(&region) {
                Region::Inside => assert!(inside, "{name} {p}"),
                Region::Outside => assert!(!inside, "{name} {p}"),
                Region::Surface(narrowed) => assert_eq!(narrowed.value(p) > 0.0, inside, "{name} {p}"),
            }
        }
    }
    Ok(())
}

#[test]
fn offsets_of_leaves_that_are_not_convex_keep_their_sign_when_narrowed() -> Result<(), SolidError> {
    let star =
        Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0)).scaled(DVec3::splat(0.3));
    let cases = [
        ("pinched", Solid::superellipsoid([0.5165, 0.5505, 0.2221], 2.435, 0.164)),
        ("star", star.into()),
        ("one sheet", Superhyperboloid::one_sheet([0.4, 0.3, 0.5], 0.7, 1.2, 1.6).into()),
    ];
    for (name, solid) in cases {
        for by in [0.13, -0.05] {
            let moved = solid.offset(by);
            let (program, bounds) = (moved.surface_program()?, moved.bounds()?);
            let mut random = Random::new(93);
            for _ in 0..150 {
                let p = random.point_in(&bounds.inflate(0.3));
                let size = random.log_range(0.01, 0.3);
                let region = rvachev::Bounds::new(p - size, p + size);
                let q = random.point_in(&region);
                let inside = program.value(q) > 0.0;
                assert!(bounds.contains(q) || !inside, "{name} {by} {q} beyond {bounds:?}");
                match program.narrow(&region) {
                    Region::Inside => assert!(inside, "{name} {by} {q}"),
                    Region::Outside => assert!(!inside, "{name} {by} {q}"),
                    Region::Surface(narrowed) => assert_eq!(narrowed.value(q) > 0.0, inside, "{name} {by} {q}"),
                }
            }
        }
    }
    Ok(())
}

/// A supershape of five lobes, twisted and with a waist: not convex, and curved both ways.
fn lobed() -> Solid {
    let body = Supershape::new(Gielis::new(5.0, 14.0, 6.0, 6.0), Gielis::new(4.0, 6.0, 6.0, 6.0));
    let law = SineWave { mean: 0.9, amplitude: 0.1, wavelength: 3.5, phase: rad(-1.9) };
    Solid::from(body.scaled(DVec3::new(1.0, 1.0, 1.8))).taper_by(law, law).twist(rad(0.4))
}

#[test]
fn walls_of_deformed_supershapes_have_their_thickness() -> Result<(), SolidError> {
    for part in [0.02, 0.06] {
        for sign in [-1.0, 1.0] {
            let (least, most) = measured(&lobed(), sign * part, 30)?;
            println!("{sign:+} {part}: {least:.4} to {most:.4}");
            assert!(least > 0.98 && most < 1.02, "{sign} {part}: {least} to {most}");
        }
    }
    Ok(())
}

#[test]
fn beside_a_surface_the_distance_is_small() -> Result<(), SolidError> {
    let solid = lobed();
    let shell = solid.offset(-0.06);
    let program = shell.surface_program()?;
    let mut random = Random::new(94);
    for _ in 0..200 {
        let Some(p) = way_out(&solid, DVec3::ZERO, random.direction())? else { continue };
        let normal = -solid.gradient(p)?.normalize();
        let beside = random.log_range(1e-5, 1e-2) * if random.chance(0.5) { 1.0 } else { -1.0 };
        let q = p + beside * normal;
        let region = rvachev::Bounds::from_center(q, DVec3::splat(0.01));
        let (seen, lanes) = lanes32(&program, &region, &[q]);
        for (at, value) in [(q, program.value(q)), (seen[0], lanes[0])] {
            let off = value + 0.06 + (at - p).dot(normal);
            assert!(off.abs() < 0.02 * beside.abs() + 2e-4, "{value} at {at}, {beside} from {p}");
        }
    }
    Ok(())
}

/// A leaf without bounds has no size that would tell how far rounding moves a point.
#[test]
fn meshes_of_offset_lattices_are_where_the_field_is_zero() {
    let lattice = Solid::new(SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.4, thickness: 0.05 });
    let solid = (Solid::sphere(0.3) & lattice).offset(0.03);
    let program = solid.surface_program().unwrap();
    let settings = MeshSettings { cell: CellSize::Length(0.02), features: Features::Smooth, ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let count = mesh.positions().len();
    let off = mesh.positions().iter().filter(|p| program.value(p.as_dvec3()).abs() > 2e-4).count();
    let clamped = mesh.clamped_vertices().unwrap();
    println!("{off} of {count} vertices off by more than a hundredth of a cell, {clamped} clamped");
    assert!(off * 50 < count && clamped * 50 < count, "{off} and {clamped} of {count}");
}

/// A distance does not jump where the nearest point of its surface does.
#[test]
fn vertices_of_an_offset_lattice_are_roots() {
    const CELL: f64 = 1.0 / 16.0;
    let lattice = SheetLattice { surface: MinimalSurface::SchwarzP, cell: 0.4, thickness: 0.06970074901675335 };
    let part = Solid::sphere(0.3518411910567806).intersection(Solid::new(lattice), RFunction::P(2.0));
    let solid = part.offset(0.0857908967549771).translate((-0.1875, 0.4375, 0.3125));
    let program = solid.surface_program().unwrap();
    let settings = MeshSettings { cell: CellSize::Length(CELL), features: Features::Smooth, ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let off = off_surface(&program, &mesh, CELL);
    let clamped = mesh.clamped_vertices().unwrap();
    println!("{off} of {} vertices, {clamped} clamped", mesh.positions().len());
    assert_eq!((off, clamped), (0, 0), "of {} vertices", mesh.positions().len());
}

/// Walls that are thinner than the cells in which as large a solid is measured else. A mesh that is
/// torn there is told by its holes, and its cells are halved until it is whole.
#[test]
fn walls_of_a_seventieth_are_measured() -> Result<(), SolidError> {
    let tube = Solid::cylinder(7.0, 2.5) - Solid::cylinder(6.9, 3.0);
    let lobes = |size: f64| {
        let body = Supershape::new(Gielis::new(5.0, 3.0, 6.0, 6.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
        Solid::from(body.scaled(DVec3::splat(size)))
    };
    // Beside a tip, a foot is where the axis meets the surface.
    let star = lobes(1.0) - lobes(0.94);
    for (name, solid, by, feet) in [("tube", tube, 0.5, [7.0, 6.9]), ("star", star, 0.05, [1.0, 0.94])] {
        let moved = solid.offset(by);
        let accuracy = moved.accuracy()?;
        println!("{name}: {accuracy:?}");
        assert!(accuracy.tolerance < 1.1e-3 * by && accuracy.error < 4e-3 * by, "{name}: {accuracy:?}");
        for (foot, out) in feet.into_iter().zip([1.0, -1.0]) {
            for gap in [0.2, 0.6] {
                let p = DVec3::X * (foot + out * gap * by);
                let off = (moved.value(p)? - (1.0 - gap) * by).abs();
                assert!(off < 2e-3 * by, "{name} at {p}: off {off}");
            }
        }
    }
    Ok(())
}
