//! Offsets, shells, rounded and filleted solids, by closed forms: every case that was once wrong.
//!
//! Lengths are millimetres. Volumes are those of meshes; what they may be off follows from the
//! tolerance of lengths ([`layer`]) and from the cells ([`sag`]).

mod closed;
mod fillets;
mod hollow;
mod laws;
mod local;
mod nested;
mod nothing;
mod plane;
mod reference;
mod sheets;
mod subject;
mod walls;

use std::error::Error;
use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use rvachev::{
    Blend, Bounds, CellSize, Cuboid, Extrusion, Gielis, Mesh, MeshReport, MeshSettings, MinimalSurface, NetworkLattice,
    Prism, Profile, Pyramid, RFunction, SheetLattice, Solid, Supershape, Torus,
    program::{Region, Tape},
    rad,
};

use crate::length_ranges::{missed, place};
use crate::narrow::check_narrowing;
use crate::support::{Random, frame_of, lanes32, near, near_point, samples, value};
use reference::Surface;

type Outcome = Result<(), Box<dyn Error>>;

/// The share of a length that its surface may be off.
const TOLERANCE: f64 = 1e-3;

/// What a quarter circle of radius 1 leaves of the square around it.
const CORNER: f64 = 1.0 - PI / 4.0;

/// The volume of a layer as thick as the tolerance of a length.
fn layer(area: f64, length: f64) -> f64 {
    TOLERANCE * length * area
}

/// The volume that flat triangles as long as a cell lose or gain on a surface of a radius: the mean
/// of what is between a chord and its arc.
fn sag(area: f64, radius: f64, cell: f64) -> f64 {
    area * cell * cell / (12.0 * radius)
}

fn mesh_at(solid: &Solid, cell: CellSize) -> Result<Mesh, Box<dyn Error>> {
    Ok(solid.mesh(&MeshSettings { cell, ..MeshSettings::default() })?)
}

/// The report of a mesh with so many cells along the longest side, which must be sound.
fn report(solid: &Solid, cells: u32) -> Result<MeshReport, Box<dyn Error>> {
    let report = mesh_at(solid, CellSize::LongestSide(cells))?.check();
    assert!(report.is_sound(), "{solid:?}: {report}");
    Ok(report)
}

/// Fails unless the mesh of a solid has a volume, and so many shells: components and voids.
#[track_caller]
fn measures(report: &MeshReport, volume: f64, tolerance: f64, shells: usize) {
    println!("volume {:.3}, want {volume:.3} within {tolerance:.3}; {} shells", report.volume, report.shells);
    near(report.volume, volume, tolerance);
    assert_eq!(report.shells, shells, "{report}");
}

fn at(solid: Solid, place: [f64; 3]) -> Solid {
    solid.translate(place)
}

/// Two cubes of 10 side by side.
fn two_cubes() -> Solid {
    let cube = Solid::cuboid([10.0; 3]);
    at(cube.clone(), [-5.0, 0.0, 0.0]) | at(cube, [5.0, 0.0, 0.0])
}

/// An L of area 64, with one concave corner and five convex ones.
fn l_profile() -> Profile {
    Profile::polygon([[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]])
}

/// Two blocks whose tops, bottoms and one side are flush.
fn flush_blocks() -> [Solid; 2] {
    let low = at(Solid::cuboid([10.0, 10.0, 5.0]), [5.0, 5.0, 0.0]);
    [low, at(Solid::cuboid([10.0, 20.0, 5.0]), [15.0, 10.0, 0.0])]
}

/// A cube and a cylinder about one of its edges, as high as the cube.
fn flush_round() -> [Solid; 2] {
    [at(Solid::cuboid([10.0; 3]), [5.0, 5.0, 0.0]), Solid::cylinder(5.0, 10.0)]
}

fn fillet(radius: f64) -> Blend {
    Blend::Fillet { radius }
}

/// The highest vertex of a mesh.
fn top(mesh: &Mesh) -> f64 {
    mesh.positions().iter().map(|p| f64::from(p.z)).fold(f64::NEG_INFINITY, f64::max)
}

/// Two steps of single precision above a height: what a vertex on a face may be off.
fn step_above(height: f64) -> f64 {
    height * (1.0 + 2.0 * f64::from(f32::EPSILON))
}

#[test]
fn a_shell_of_two_boxes_has_no_wall_between_them() -> Outcome {
    let shell = two_cubes().shell(1.0);
    let inner = 2.0 * (8.0 * 8.0 + 2.0 * 18.0 * 8.0);
    measures(&report(&shell, 80)?, 848.0, layer(inner, 1.0), 2);
    assert!(!shell.contains([0.1, 0.0, 0.0])? && shell.contains([0.1, 4.5, 0.0])?);
    Ok(())
}

#[test]
fn two_boxes_made_smaller_stay_one() -> Outcome {
    let smaller = two_cubes().offset(-1.0);
    measures(&report(&smaller, 72)?, 1152.0, layer(2.0 * (64.0 + 288.0), 1.0), 1);
    assert!(smaller.contains([0.0, 3.9, 0.0])? && !smaller.contains([0.0, 4.1, 0.0])?);
    Ok(())
}

/// The volume of a box with rounded edges, and the area that is round.
fn rounded_box(size: DVec3, radius: f64) -> [f64; 2] {
    let core = size - 2.0 * radius;
    let (edges, faces) = (core.element_sum(), core.x * core.y + core.y * core.z + core.z * core.x);
    let volume =
        core.element_product() + 2.0 * radius * faces + PI * radius * radius * edges + 4.0 / 3.0 * PI * radius.powi(3);
    [volume, 2.0 * PI * radius * edges + 4.0 * PI * radius * radius]
}

#[test]
fn opening_rounds_the_edges_of_a_cube() -> Outcome {
    let [volume, round] = rounded_box(DVec3::splat(10.0), 2.0);
    near(volume, 907.705, 1e-3);
    let tolerance = layer(600.0, 2.0) + sag(round, 2.0, 10.0 / 64.0);
    for solid in [Solid::cuboid([10.0; 3]).offset(-2.0).offset(2.0), Solid::cuboid([10.0; 3]).rounded(2.0)] {
        measures(&report(&solid, 64)?, volume, tolerance, 1);
        // The corner is a sphere's about (3, 3, 3).
        let corner = |by: f64| DVec3::splat(3.0) + by * DVec3::ONE.normalize();
        assert!(solid.contains(corner(1.99))? && !solid.contains(corner(2.01))?);
        // Faces stay where they are.
        near(solid.bounds()?.max.x, 5.0, 2.0 * TOLERANCE);
    }
    Ok(())
}

#[test]
fn opening_rounds_a_body_of_two_boxes_as_one() -> Outcome {
    let [volume, round] = rounded_box(DVec3::new(20.0, 10.0, 10.0), 1.5);
    let tolerance = layer(1000.0, 1.5) + sag(round, 1.5, 20.0 / 80.0);
    measures(&report(&two_cubes().rounded(1.5), 80)?, volume, tolerance, 1);
    Ok(())
}

#[test]
fn a_part_that_is_eroded_away_leaves_the_rest_of_a_tree() -> Outcome {
    let nothing = at(two_cubes().offset(-5.5), [0.0, 0.0, 3.0]);
    let block = Solid::cuboid([6.0, 5.0, 4.0]);
    let trees = [
        &nothing | &block,
        &block - &nothing,
        &block ^ &nothing,
        block.union_with(&nothing, fillet(1.0)),
        nothing.union_with(&block, fillet(1.0)),
        block.difference_with(&nothing, fillet(1.0)),
        block.union_with(&nothing, Blend::Chamfer { leg: 1.0 }),
        Solid::union_all_with([&nothing, &block], fillet(1.0)),
        (&nothing | &block).rounded(0.0005),
        (&nothing | &block).union(at(nothing.offset(2.0), [3.0, 0.0, 0.0]), RFunction::P(2.0)),
    ];
    let mut random = Random::new(1201);
    for tree in trees {
        measures(&report(&tree, 24)?, 120.0, layer(148.0, 1.0), 1);
        for _ in 0..40 {
            let p = random.vector(-4.0, 4.0);
            let d = value(&block, p);
            assert!(d.abs() < 1e-3 || tree.contains(p)? == (d > 0.0), "{tree:?} at {p}");
        }
    }
    Ok(())
}

#[test]
fn closing_and_opening_of_an_l_have_their_areas() -> Outcome {
    let closed = 64.0 + 4.0 * CORNER;
    let opened = 64.0 - 5.0 * 1.5 * 1.5 * CORNER;
    near(closed, 64.858, 1e-3);
    near(opened, 61.586, 1e-3);
    let l = l_profile();
    for (area, radius, profile) in [
        (closed, 2.0, l.offset(2.0).offset(-2.0)),
        (closed, 2.0, l.filleted(2.0)),
        (opened, 1.5, l.offset(-1.5).offset(1.5)),
        (opened, 1.5, l.rounded(1.5)),
    ] {
        // A border of 40, twice as high as the unit, and arcs of up to five quarters.
        let tolerance = 2.0 * (layer(40.0, radius) + sag(2.5 * PI * radius, radius, 10.0 / 64.0));
        measures(&report(&profile.extrude(2.0), 64)?, 2.0 * area, tolerance, 1);
    }
    // The same as a solid: the edges of the end faces are rounded too, concave ones are few.
    let solid = l.extrude(8.0).filleted(2.0);
    let tolerance = layer(8.0 * 40.0 + 128.0, 2.0) + sag(8.0 * PI, 2.0, 10.0 / 64.0);
    measures(&report(&solid, 64)?, 8.0 * closed, tolerance, 1);
    Ok(())
}

#[test]
fn the_neck_of_a_bottle_is_open() -> Outcome {
    let body = Solid::cylinder(20.0, 40.0) | at(Solid::cylinder(8.0, 20.0), [0.0, 0.0, 30.0]);
    let bottle = body.shell(1.5);
    for z in [-18.0, 0.0, 18.0, 19.0, 20.0, 21.0, 30.0, 38.0] {
        assert!(!bottle.contains([0.0, 0.0, z])?, "{z}");
    }
    // The walls are where they were asked for.
    assert!(bottle.contains([0.0, 0.0, 39.0])? && bottle.contains([7.5, 0.0, 30.0])?);
    assert!(bottle.contains([15.0, 0.0, 18.6])? && !bottle.contains([15.0, 0.0, 18.4])?);
    let report = report(&bottle, 80)?;
    assert_eq!(report.shells, 2, "{report}");
    Ok(())
}

#[test]
fn opening_parts_a_bell_at_its_bar() -> Outcome {
    let weight = Solid::cuboid([6.0; 3]);
    let bar = Solid::cuboid([10.0, 1.0, 1.0]);
    let bell = at(weight.clone(), [-6.0, 0.0, 0.0]) | at(weight, [6.0, 0.0, 0.0]) | bar;
    let [volume, round] = rounded_box(DVec3::splat(6.0), 1.0);
    let tolerance = 2.0 * (layer(216.0, 1.0) + sag(round, 1.0, 18.0 / 90.0));
    measures(&report(&bell.rounded(1.0), 90)?, 2.0 * volume, tolerance, 2);
    Ok(())
}

#[test]
fn a_fillet_leaves_a_flush_top_where_it_is() -> Outcome {
    let [low, high] = flush_blocks();
    let solid = low.union_with(high, fillet(2.0));
    let mesh = mesh_at(&solid, CellSize::Length(0.1))?;
    assert!(top(&mesh) <= step_above(2.5), "{}", top(&mesh));
    let report = mesh.check();
    assert!(report.is_sound(), "{report}");
    // The prism has 1504.292. At both ends balls come over the flush faces and take some of it: one
    // with its centre h above a face is no nearer than √(4 - h²) to either edge in the plane. What
    // they cover, by quadrature:
    const AT_END: f64 = 0.0583;
    let prism = 1500.0 + 5.0 * 4.0 * CORNER;
    near(prism, 1504.292, 1e-3);
    measures(&report, prism - 2.0 * AT_END, layer(5.0 * PI, 2.0) + sag(5.0 * PI, 2.0, 0.1), 1);
    // Faces of the operands are where they were, exactly, and what is added does not rise above
    // them.
    for p in [[9.9, 5.0, 0.0], [9.999, 5.0, 0.0], [10.001, 5.0, 0.0], [10.1, 5.0, 0.0]] {
        let p = DVec3::from(p);
        assert!(!solid.contains(p.with_z(2.5 + 1e-9))? && solid.contains(p.with_z(2.5 - 1e-9))?, "{p}");
    }
    let added = DVec3::new(9.6, 10.4, 0.0);
    assert!(solid.contains(added)? && !solid.contains(added.with_z(2.5 + 1e-9))?);
    assert!(!solid.contains([10.0, -1e-9, 0.0])?);
    Ok(())
}

/// The area of a fillet in the plane, outside of a circle of radius `a` and beside a line through
/// its centre; `r` is the radius of the ball.
fn beside_a_circle(a: f64, r: f64) -> f64 {
    let along = ((a + r) * (a + r) - r * r).sqrt();
    let angle = (r / along).atan();
    0.5 * along * r - 0.5 * a * a * angle - 0.5 * r * r * (PI / 2.0 - angle)
}

#[test]
fn a_cylinder_about_an_edge_of_a_cube_keeps_its_flat_top() -> Outcome {
    let plain = 1000.0 + 0.75 * PI * 250.0;
    for blend in [fillet(2.0), Blend::Chamfer { leg: 2.0 }] {
        let [cube, cylinder] = flush_round();
        let mesh = mesh_at(&cube.union_with(cylinder, blend), CellSize::LongestSide(90))?;
        assert!(top(&mesh) <= step_above(5.0), "{blend:?}: {}", top(&mesh));
        let report = mesh.check();
        assert!(report.is_sound(), "{blend:?}: {report}");
        let cell = 15.0 / 90.0;
        let tolerance = layer(100.0, 2.0) + sag(250.0, 5.0, cell) + sag(50.0, 2.0, cell);
        match blend {
            Blend::Fillet { radius } => {
                let added = 20.0 * beside_a_circle(5.0, radius);
                measures(&report, plain + added, tolerance, 1);
            }
            // More than nothing, less than the square of the leg.
            _ => assert!((plain..plain + 80.0).contains(&report.volume), "{report}"),
        }
        assert_eq!(report.shells, 1);
    }
    Ok(())
}

#[test]
fn fillets_next_to_a_rim_leave_no_dust() -> Outcome {
    let f = fillet(2.0);
    let rim = Profile::circle(20.0)
        .column()
        .intersection_with(Solid::slab([0.0, 0.0, 1.0], 30.0), f)
        .difference_with(at(Solid::sphere(14.0), [20.0, 0.0, 0.0]), f);
    for cells in [48, 96] {
        assert_eq!(report(&rim, cells)?.shells, 1);
    }
    Ok(())
}

#[test]
fn a_plate_with_a_post_and_a_rib_is_one_sound_part() -> Outcome {
    let plate = Solid::cuboid([60.0, 40.0, 4.0]);
    let post = at(Solid::cylinder(6.0, 30.0), [0.0, 0.0, 15.0]);
    let rib = at(Solid::cuboid([40.0, 4.0, 20.0]), [10.0, 0.0, 10.0]);
    let three = plate.union_with(&post, fillet(3.0)).union_with(&rib, fillet(2.0));
    let report = report(&three, 80)?;
    assert_eq!((report.shells, report.genus), (1, Some(0)), "{report}");
    // At the foot of the post: the ball of 3 is about (0, 9, 5).
    let (ball, towards) = (DVec3::new(0.0, 9.0, 5.0), DVec3::new(0.0, -1.0, -1.0).normalize());
    assert!(three.contains(ball + 3.01 * towards)? && !three.contains(ball + 2.99 * towards)?);
    // At the foot of the rib: the ball of 2 is about (20, 4, 4).
    let (ball, towards) = (DVec3::new(20.0, 4.0, 4.0), DVec3::new(0.0, -1.0, -1.0).normalize());
    assert!(three.contains(ball + 2.01 * towards)? && !three.contains(ball + 1.99 * towards)?);
    Ok(())
}

/// A bar with a row of pins, each filleted to all before it.
fn chain(pins: u32) -> Solid {
    let length = 0.8 * f64::from(pins) + 1.0;
    let bar = at(Solid::cuboid([length, 2.0, 1.0]), [0.4 * f64::from(pins), 0.0, 0.0]);
    (0..pins)
        .fold(bar, |all, i| all.union_with(at(Solid::cylinder(0.3, 2.0), [0.8 * f64::from(i), 0.0, 0.5]), fillet(0.1)))
}

#[test]
fn chains_of_fillets_have_no_limit() -> Outcome {
    let pins = 8;
    let all = chain(pins);
    let report = mesh_at(&all, CellSize::Length(0.45))?.check();
    assert!(report.is_sound() && report.shells == 1, "{report}");
    // The last pin has its fillet: the ball is about (x + .4, 0, .6).
    let ball = DVec3::new(0.8 * f64::from(pins - 1), 0.4, 0.6);
    let towards = DVec3::new(0.0, -1.0, -1.0).normalize();
    assert!(all.contains(ball + 0.101 * towards)? && !all.contains(ball + 0.099 * towards)?);
    Ok(())
}

/// A prism on a twisted pyramid, the ball of the fillet larger than both.
fn narrow() -> Solid {
    let pyramid = Solid::from(Pyramid::new(3, 0.5, 3.0)).twist(rad(1.27));
    pyramid.union_with(Prism::across_flats(7, 0.25, 0.25), fillet(3.0))
}

#[test]
fn a_region_beside_a_large_fillet_is_not_outside_if_a_corner_is_inside() -> Outcome {
    let solid = narrow();
    let program = solid.surface_program()?;
    let region = Bounds::new(DVec3::new(0.50953, 0.35665, -1.56976), DVec3::new(1.47953, 1.20079, -0.82506));
    let found = program.narrow(&region);
    let mut random = Random::new(1202);
    for p in samples(&mut random, &region, 200) {
        let inside = program.value(p) > 0.0;
        match &found {
            Region::Inside => assert!(inside, "{p}"),
            Region::Outside => assert!(!inside, "{p}"),
            Region::Surface(narrowed) => assert_eq!(narrowed.value(p) > 0.0, inside, "{p}"),
        }
    }
    check_narrowing(&mut random, &solid, 40);
    Ok(())
}

/// Fails unless ranges hold what they are ranges of, in boxes near and far.
fn has_sound_ranges(random: &mut Random, solid: &Solid, boxes: usize) -> Outcome {
    let program = solid.surface_program()?;
    let frame = frame_of(solid);
    for _ in 0..boxes {
        let region = place(random, &frame);
        let text = missed(random, &program, &region);
        assert!(text.is_none(), "{solid:?}: {}", text.unwrap_or_default());
    }
    Ok(())
}

#[test]
fn ranges_of_fillets_and_caps_hold_every_value() -> Outcome {
    let mut random = Random::new(1203);
    let block = Solid::from(Cuboid { size: DVec3::new(2.0, 1.8, 0.5) });
    has_sound_ranges(&mut random, &block.intersection_with(Torus { radius: 0.5, tube: 0.3 }, fillet(3.0)), 60)?;
    let rounded = Extrusion { twist: rad(0.1), caps: rvachev::Caps::Rounded(0.3), ..Extrusion::new(1.0) };
    has_sound_ranges(&mut random, &Profile::rectangle([0.94, 1.0]).extrude_with(&rounded), 60)?;
    for _ in 0..10 {
        let [a, b] = [0; 2].map(|_| crate::primitives::random_primitive(&mut random).0);
        let b = b.translate(random.vector(-0.3, 0.3));
        let blend = fillet(random.log_range(0.02, 1.0));
        let joined = match random.below(3) {
            0 => a.union_with(b, blend),
            1 => a.intersection_with(b, blend),
            _ => a.difference_with(b, blend),
        };
        has_sound_ranges(&mut random, &joined, 6)?;
        let profile = crate::zoo::random_profile(&mut random, 0);
        let size = random.range(0.01, 0.1);
        let caps = random.pick(&[rvachev::Caps::Rounded(size), rvachev::Caps::Chamfered(size)]);
        let capped = profile.extrude_with(&Extrusion { caps, ..Extrusion::new(0.8) });
        // What does not fit is refused.
        if capped.bounds().is_ok() {
            has_sound_ranges(&mut random, &capped, 6)?;
        }
    }
    Ok(())
}

#[test]
fn caps_that_do_not_fit_are_refused() {
    let profile = Profile::rectangle([2.0, 3.0]);
    for (size, height, fits) in [(0.4, 5.0, true), (1.5, 5.0, false), (0.8, 1.2, false)] {
        for caps in [rvachev::Caps::Rounded(size), rvachev::Caps::Chamfered(size)] {
            let solid = profile.extrude_with(&Extrusion { caps, ..Extrusion::new(height) });
            assert_eq!(solid.bounds().is_ok(), fits, "{caps:?} on a height of {height}: {:?}", solid.bounds());
        }
    }
}

#[test]
fn lanes_of_a_shelled_network_have_the_sign_of_its_values() -> Outcome {
    let network = NetworkLattice { surface: MinimalSurface::SchwarzP, cell: 0.3, fraction: 0.7 };
    // The wall is thicker than the network in places: the shell is most of it.
    for thickness in [0.2, 0.1] {
        let solid = Solid::new(network).shell(thickness) & Solid::cuboid([0.7; 3]);
        let program = solid.surface_program()?;
        let mut random = Random::new(1204);
        let (mut wrong, mut tried) = (0, 0);
        for _ in 0..60 {
            let region = Bounds::from_center(random.vector(-0.35, 0.35), DVec3::splat(random.log_range(0.01, 0.1)));
            let doubt = Tape::new(&program, &region).roundoff();
            let (seen, lanes) = lanes32(&program, &region, &samples(&mut random, &region, 100));
            for (p, lane) in seen.into_iter().zip(lanes).filter(|(_, lane)| lane.abs() > doubt) {
                tried += 1;
                wrong += usize::from((lane > 0.0) != (program.value(p) > 0.0));
            }
        }
        println!("{wrong} of {tried} signs differ");
        assert!(tried > 2000 && wrong == 0, "{wrong} of {tried} signs differ");
    }
    Ok(())
}

#[test]
fn shells_of_shells_compile_to_what_grows_with_their_number() -> Outcome {
    let nested = |levels: u32, thickness: f64| {
        (0..levels).fold(Solid::sphere(1.0), |solid, level| solid.shell(thickness * 0.9f64.powi(level as i32)))
    };
    let wall = |levels| (0..levels).fold(Solid::sphere(1.0), |solid, _| solid.shell(0.01));
    let count = |solid: Solid| Ok::<usize, Box<dyn Error>>(solid.surface_program()?.leaf_count());
    let (few, many) = (count(wall(4))?, count(wall(12))?);
    assert!(many <= 3 * few, "{few} leaves for 4 levels, {many} for 12");
    let (few, many) = (count(nested(1, 0.4))?, count(nested(3, 0.4))?);
    assert!(many <= 3 * few, "{few} leaves for a level, {many} for 3");
    // A shell thicker than half the wall is all of the wall.
    let twice = nested(2, 0.4);
    for (depth, inside) in [(0.1, true), (0.25, true), (0.35, true), (0.41, false)] {
        assert_eq!(twice.contains(DVec3::X * (1.0 - depth))?, inside, "{depth}");
    }
    let thin = Solid::sphere(1.0).shell(0.4).shell(0.1);
    for (depth, inside) in [(0.05, true), (0.15, false), (0.25, false), (0.35, true), (0.45, false)] {
        assert_eq!(thin.contains(DVec3::X * (1.0 - depth))?, inside, "{depth}");
    }
    Ok(())
}

#[test]
fn nothing_is_inside_and_outside_of_the_bounds() -> Outcome {
    let mut random = Random::new(1205);
    let stretched = Profile::regular_polygon(5, 1.0).scale_axes([1.7, 0.6]).extrude(1.0);
    let hole = Solid::prism(6, 0.4, 2.0).scale_axes([2.5, 1.0, 1.0]);
    let body = stretched.difference_with(hole, Blend::Chamfer { leg: 0.1 });
    // What is looked for does not depend on the tolerance, and a coarse one is soon there.
    for solid in [body.offset(0.15), body.shell(0.1), body.filleted(0.2)].map(|solid| solid.with_tolerance(2e-3)) {
        let bounds = solid.bounds()?;
        let around = bounds.inflate(0.2);
        let points: Vec<DVec3> = (0..4001).map(|_| random.point_in(&around)).collect();
        let inside = solid.contains_all(&points)?;
        let beyond = points.iter().zip(inside).filter(|(p, inside)| *inside && !bounds.contains(**p)).count();
        assert_eq!(beyond, 0, "{solid:?}");
    }
    Ok(())
}

/// The distance from a point to a square column that is twisted by an angle a unit of z: by its
/// four sides, sampled densely.
fn to_twisted_column(p: DVec3, half: DVec3, rate: f64) -> f64 {
    let (steps, sides) = (800, 4);
    let square = |step: u32| -1.0 + 2.0 * f64::from(step) / f64::from(steps);
    let mut least = f64::INFINITY;
    for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
        let (z, t) = (half.z * square(i), half.x * square(j));
        for side in 0..sides {
            let angle = rate * z + f64::from(side) * PI / 2.0;
            let (sin, cos) = angle.sin_cos();
            let q = DVec3::new(half.x * cos - t * sin, half.x * sin + t * cos, z);
            least = least.min(p.distance_squared(q));
        }
    }
    least.sqrt()
}

#[test]
fn the_nearest_point_of_a_twisted_offset_is_found() -> Outcome {
    let column = Solid::cuboid([2.0, 2.0, 4.0]).twist(rad(1.0));
    let moved = column.offset(0.1);
    for p in [DVec3::new(3.0, 0.0, 0.0), DVec3::new(1.5, -1.4, 0.9)] {
        let want = to_twisted_column(p, DVec3::new(1.0, 1.0, 2.0), 1.0) - 0.1;
        let q = moved.closest_surface_point(p)?.expect("it has a surface");
        near(q.distance(p), want, 0.1 * TOLERANCE + 1e-4);
    }
    // Inside, of a block that is inset: its faces.
    let inset = two_cubes().offset(-1.0);
    let q = inset.closest_surface_point([0.5, 1.0, 3.0])?.expect("it has a surface");
    near_point(q, DVec3::new(0.5, 1.0, 4.0), TOLERANCE);
    Ok(())
}

/// Whether a wall that cells would pass by is found, or else told of.
fn found_or_told(solid: &Solid, cells: u32, is_found: impl Fn(&Solid, &MeshReport) -> bool) -> Outcome {
    let mesh = match mesh_at(solid, CellSize::LongestSide(cells)) {
        Ok(mesh) => mesh,
        Err(error) => {
            println!("told: {error}");
            return Ok(());
        }
    };
    let report = mesh.check();
    assert!(is_found(solid, &report) || !mesh.warnings().is_empty(), "{solid:?}: {report}");
    Ok(())
}

/// A box of 20 with two cavities, and a wall of .1 between them.
fn walled_box() -> Solid {
    let cavity = Solid::cuboid([9.0, 18.0, 18.0]);
    Solid::cuboid([20.0; 3]) - at(cavity.clone(), [-4.55, 0.0, 0.0]) - at(cavity, [4.55, 0.0, 0.0])
}

#[test]
fn a_wall_thinner_than_cells_is_found_or_told() -> Outcome {
    let inside = |solid: &Solid, p: [f64; 3]| solid.contains(p).expect("the solid is valid");
    // Thicker by half a millimetre on all sides.
    let [outer, _] = rounded_box(DVec3::splat(21.0), 0.5);
    let volume = outer - 2.0 * 8.0 * 17.0 * 17.0;
    found_or_told(&walled_box().offset(0.5), 64, |solid, report| {
        inside(solid, [0.3, 0.0, 0.0]) && !inside(solid, [0.7, 0.0, 0.0]) && (report.volume - volume).abs() < 5.0
    })?;
    // Opened by .2, the wall is gone, and the outer ones stay.
    found_or_told(&walled_box().rounded(0.2), 64, |solid, _| {
        !inside(solid, [0.0; 3]) && inside(solid, [0.0, 9.5, 0.0]) && inside(solid, [9.5, 0.0, 0.0])
    })?;
    // Closing fills the corners between the wall and the box, and nothing else.
    found_or_told(&walled_box().filleted(1.0), 64, |solid, _| {
        inside(solid, [0.0; 3]) && inside(solid, [0.2, 8.95, 0.0]) && !inside(solid, [0.2, 0.0, 0.0])
    })
}

/// Fails unless signs about the offsets of a solid are those of distances by brute force.
fn offsets_are_at(solid: &Solid, lengths: [f64; 2], cells: u32, count: usize) -> Outcome {
    let surface = Surface::new(solid, cells)?.expect("it has a surface");
    let mut random = Random::new(1206);
    for by in lengths {
        let moved = solid.offset(by);
        let mut decided = 0;
        for _ in 0..count {
            let from = surface.point(random.below(surface.len()), [random.unit(), random.unit()]);
            let p = from + by.abs() * random.range(0.0, 2.0) * random.direction();
            let [least, most] = surface.distance(p);
            let [least, most] = if solid.contains(p)? { [least, most] } else { [-most, -least] };
            let tolerance = 3.0 * TOLERANCE * by.abs();
            let inside = moved.contains(p)?;
            let (within, beyond) = (least > -by + tolerance, most < -by - tolerance);
            let told = || format!("{solid:?} by {by} at {p}: inside {inside}, distance {least} to {most}");
            assert!(!(within && !inside || beyond && inside), "{}", told());
            decided += usize::from(within || beyond);
        }
        assert!(2 * decided > count, "{solid:?} by {by}: {decided} of {count} points tell anything");
    }
    Ok(())
}

/// Fails unless the inner face of a shell is as deep as asked for: by brute force, and along
/// normals where a ball that touches the foot of the normal is larger than the wall.
fn has_wall(solid: &Solid, thickness: f64) -> Outcome {
    let surface = Surface::new(solid, 64)?.expect("it has a surface").known_whole();
    let shell = solid.shell(thickness);
    // Vertices of this mesh are on the surface; others may stand off it, for the sake of its
    // triangles.
    let cell = solid.bounds()?.longest_side() / 48.0;
    let settings =
        MeshSettings { cell: CellSize::Length(cell), features: rvachev::Features::Smooth, ..MeshSettings::default() };
    let mesh = shell.mesh(&settings)?;
    let doubt = 3.0 * TOLERANCE * thickness + 2e-3 * cell;
    let mut inner = 0;
    for p in mesh.positions().iter().step_by(mesh.positions().len().div_ceil(300)).map(|p| p.as_dvec3()) {
        let [least, most] = surface.distance(p);
        if most > 0.5 * thickness {
            inner += 1;
            let is_there = least <= thickness + doubt && most >= thickness - doubt;
            assert!(is_there, "{solid:?}: the inner face is {least} to {most} deep at {p}, not {thickness}");
        }
    }
    assert!(inner > 50, "{solid:?}: {inner} vertices of the inner face");
    let mut random = Random::new(1208);
    let bounds = solid.bounds()?;
    let (centre, reach) = (bounds.center(), bounds.longest_side());
    let mut measured = 0;
    for _ in 0..100 {
        let direction = random.direction();
        let Some(hit) = solid.raycast(centre - reach * direction + random.vector(-0.2, 0.2) * reach, direction)? else {
            continue;
        };
        let inwards = -hit.normal;
        let [least, _] = surface.distance(hit.point + 1.5 * thickness * inwards);
        if least < 1.4 * thickness {
            continue;
        }
        measured += 1;
        let start = 1e-3 * thickness;
        let wall = shell.raycast(hit.point + start * inwards, inwards)?.expect("an inner face").distance + start;
        near(wall, thickness, 3.0 * TOLERANCE * thickness);
    }
    assert!(measured > 20, "{solid:?}: {measured} rays");
    Ok(())
}

#[test]
fn walls_of_shells_are_as_thick_as_asked_for() -> Outcome {
    let plate = Solid::cuboid([20.0, 14.0, 6.0]) - at(Solid::cylinder(2.5, 10.0), [4.0, 0.0, 0.0]);
    let pill = Solid::superellipsoid([6.0, 4.0, 2.0], 0.3, 0.4);
    for solid in [two_cubes(), plate, pill.twist(rad(0.1)), l_profile().extrude(6.0)] {
        has_wall(&solid, 0.5)?;
    }
    Ok(())
}

/// Its ribs come to an edge between cusps.
fn star() -> Solid {
    Supershape::new(Gielis::new(5.0, 0.3, 0.3, 0.3), Gielis::new(4.0, 2.0, 2.0, 2.0)).into()
}

/// A twisted vase of so many cusped lobes, so high.
fn vase(lobes: f64, height: f64) -> Solid {
    let lobes = Supershape::new(Gielis::new(lobes, 9.0, 8.0, 8.0), Gielis::new(4.0, 30.0, 30.0, 30.0));
    Solid::from(lobes.scaled([3.4, 3.4, height])).twist(rad(0.087))
}

/// The ribs of the star are half discs of radius 1 about its axis, thinner and thinner outwards.
fn ribs_are_found(ribs: std::ops::Range<u32>, moved: &Solid, by: f64) -> Outcome {
    let told = moved.accuracy()?.error;
    assert!(told < 0.5 * by, "{told}");
    for number in ribs {
        let side = DVec3::X.rotate_z(f64::from(number) * TAU / 5.0);
        let across = side.cross(DVec3::Z);
        for (radius, up) in [(0.6, 0.0), (0.7, 0.6), (0.8, -0.4), (0.9, 0.2), (0.97, 1.0)] {
            let on_rib = radius * (side * f64::cos(up) + DVec3::Z * f64::sin(up));
            for p in [on_rib + by * across, on_rib - by * across] {
                let value = moved.value(p)?;
                assert!(value > -told && value < 0.06 * by, "{value} at {p}, beside {on_rib}");
            }
        }
        let value = moved.value((1.0 + by) * side)?;
        assert!(value.abs() < 0.02 * by, "{value} beyond the rim of rib {number}");
    }
    Ok(())
}

/// Rods and walls thinner than any cell, on a body and beside it, straight and turned: what is
/// measured of them is theirs, or it is told how far it may be off.
#[test]
fn rods_thinner_than_cells_are_found_or_told() -> Outcome {
    let body = Solid::superellipsoid([1.0, 0.8, 0.6], 0.5, 0.7);
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let rod = |thickness: f64| Solid::cylinder(0.5 * thickness, 3.0).rotate_y(rad(PI / 2.0));
    let oval = |thickness: f64| Solid::superellipsoid([1.5, thickness, 0.7 * thickness], 1.0, 1.0);
    for (name, thin, body, turn) in [
        ("a rod on a body", rod(3e-4), body.clone(), DQuat::IDENTITY),
        ("an oval rod beside it", oval(3e-3), at(body.clone(), [0.0, 0.0, 3.0]), turn),
        ("a wall on it", Solid::cuboid([3.0, 3e-4, 1.0]), body.clone(), turn),
    ] {
        let moved = (thin | body).rotate(turn).offset(0.1);
        let is_found = moved.contains(turn * DVec3::new(1.4, 0.08, 0.0))?;
        let accuracy = moved.accuracy()?;
        println!("{name}: {is_found}, {accuracy:?}");
        assert!(is_found || accuracy.error > 20.0 * accuracy.tolerance, "{name}: {accuracy:?}");
    }
    Ok(())
}

/// Holes thinner than cells beside an edge, of which cells show the edge alone; straight and
/// turned.
#[test]
fn holes_thinner_than_cells_are_found_or_told() -> Outcome {
    let mut random = Random::new(34);
    // Of many cells along itself, and few across.
    let bar = Solid::cuboid([20.0, 4.0, 2.0]);
    for radius in [0.001, 0.02, 0.04, 0.056] {
        let turn = DQuat::from_axis_angle(random.direction(), 4.0 * random.unit());
        let at_edge = DVec3::new(9.9 - radius - 0.2 * random.unit(), 2.0 * random.unit() - 1.0, 0.0);
        let plate = bar.clone() - at(Solid::cylinder(radius, 4.0), at_edge.to_array());
        let moved = plate.rotate(turn).offset(0.05);
        let off = (moved.value(turn * at_edge)? - (0.05 - radius)).abs();
        let accuracy = moved.accuracy()?;
        println!("{radius}: off {off}, {accuracy:?}");
        assert!(off <= accuracy.error + accuracy.tolerance, "{radius} at {at_edge}: off {off}, {accuracy:?}");
        assert!(off < 1e-3, "{radius} at {at_edge}: off {off}, {accuracy:?}");
    }
    // Of other convex leaves, a tenth of a cell thick and about one, by turns.
    let (thin, thick) = (0.01, 0.1);
    for (name, cut, within) in [
        ("a slot", Solid::cuboid([2.0 * thin, 2.0 * thin, 4.0]), thin),
        ("a prism", Solid::prism(6, thick, 4.0), thick * 0.75_f64.sqrt()),
        ("an ellipsoid", Solid::ellipsoid([thin, thin, 3.0]), thin),
        ("a superellipsoid", Solid::superellipsoid([thick, thick, 3.0], 0.4, 0.7), thick),
        ("a capsule", Solid::capsule(thin, 4.0), thin),
        ("a cone", Solid::cone(thick, 0.5 * thick, 4.0), 0.75 * thick),
    ] {
        let at_edge = DVec3::new(9.7 + 0.1 * random.unit(), 2.0 * random.unit() - 1.0, 0.0);
        let turn = DQuat::from_axis_angle(random.direction(), 4.0 * random.unit());
        let plate = bar.clone() - cut.translate(at_edge);
        let moved = plate.rotate(turn).offset(0.05);
        let off = (moved.value(turn * at_edge)? - (0.05 - within)).abs();
        assert!(off < 1e-3, "{name} at {at_edge}: off {off}, {:?}", moved.accuracy()?);
    }
    // Twisted, a leaf has no box of its own to look in.
    let plate = bar.clone() - at(Solid::cylinder(0.02, 4.0), [9.7, 0.5, 0.0]);
    let twisted = plate.twist(rad(0.002)).offset(0.05);
    let (off, accuracy) = ((twisted.value([9.7, 0.5, 0.0])? - 0.03).abs(), twisted.accuracy()?);
    println!("twisted: off {off}, {accuracy:?}");
    assert!(off <= accuracy.error + accuracy.tolerance, "twisted: off {off}, {accuracy:?}");
    Ok(())
}

/// Gaps and fins that no cell shows.
#[test]
fn what_is_thinner_than_any_cell_is_measured() -> Outcome {
    let block = Solid::cuboid([6.0, 6.0, 3.0]);
    for thickness in [1e-3, 1e-6] {
        let beside = 1.5 + 0.5 * thickness;
        let gap = at(block.clone(), [0.0, 0.0, beside]) | at(block.clone(), [0.0, 0.0, -beside]);
        let value = gap.offset(-0.2).value([0.3, 0.4, -0.3 - 0.5 * thickness])?;
        near(value, 0.1, 1e-3);
        // A hole makes it a solid that has to be measured.
        let fin = Solid::cuboid([10.0, 10.0, thickness]) | Solid::cuboid([6.0; 3]);
        let fin = fin - at(Solid::cylinder(0.5, 8.0), [2.0, 0.0, 0.0]);
        let moved = fin.offset(0.2);
        for p in [[1.0, 4.0, 0.3 + 0.5 * thickness], [-4.0, -4.9, -0.3 - 0.5 * thickness], [5.3, 0.7, 0.0]] {
            near(moved.value(p)?, -0.1, 2e-3);
        }
    }
    Ok(())
}

#[test]
#[ignore = "takes minutes"]
fn offsets_of_more_lobes_are_at_their_distance() -> Outcome {
    ribs_are_found(0..5, &star().offset(0.1).with_tolerance(2e-3), 0.1)?;
    ribs_are_found(0..5, &star().offset(0.1), 0.1)?;
    offsets_are_at(&star(), [0.1, -0.05], 80, 1500)?;
    offsets_are_at(&vase(7.0, 6.0), [0.16, -0.08], 80, 150)
}

#[test]
fn offsets_of_cusped_lobes_are_at_their_distance() -> Outcome {
    // One rib of a star; `offsets_of_more_lobes_are_at_their_distance` asks all, and more lobes.
    let rib = star() & Solid::cuboid([1.0, 0.4, 2.4]).translate([0.9, 0.0, 0.0]);
    ribs_are_found(0..1, &rib.offset(0.1).with_tolerance(2e-3), 0.1)?;
    offsets_are_at(&vase(3.0, 3.0), [0.16, -0.08], 64, 150)
}

#[test]
fn offsets_over_jumps_of_curvature_are_at_their_distance() -> Outcome {
    let pebble = Solid::rounded_cuboid([4.0, 3.0, 2.0], 0.5).twist(rad(0.2));
    let pill = Profile::rounded_rectangle([4.0, 2.0], 0.9).extrude(2.0).bend(0.2, rad(0.3));
    offsets_are_at(&pebble, [0.3, -0.3], 64, 150)?;
    offsets_are_at(&pill, [0.3, -0.3], 64, 150)
}

#[test]
fn what_does_not_end_has_its_lengths_where_it_is_cut() -> Outcome {
    // Columns: the corners of the L are rounded all the way up.
    let column = l_profile().column();
    let rounded = column.rounded(1.5);
    let corner = DVec3::new(8.5, 1.5, 0.0);
    for z in [0.0, -3.0, 1e4] {
        let along = |by: f64| (corner + by * DVec3::new(1.0, -1.0, 0.0).normalize()).with_z(z);
        assert!(rounded.contains(along(1.49))? && !rounded.contains(along(1.51))?, "{z}");
    }
    let cut = &rounded & at(Solid::cuboid([20.0, 20.0, 3.0]), [5.0, 5.0, 0.0]);
    let area = 64.0 - 5.0 * 2.25 * CORNER;
    let tolerance = 3.0 * (layer(40.0, 1.5) + sag(4.0 * PI, 1.5, 10.0 / 64.0));
    measures(&report(&cut, 64)?, 3.0 * area, tolerance, 1);
    // Two columns across: the ball of 1 about (x, 3, 3) between them, where they cross.
    let rod = Profile::rectangle([4.0; 2]).column();
    let cross = &rod | rod.rotate_y(rad(PI / 2.0));
    let filled = cross.filleted(1.0) & Solid::cuboid([12.0; 3]);
    let ball = DVec3::new(3.0, 0.0, 3.0);
    let towards = DVec3::new(-1.0, 0.0, -1.0).normalize();
    assert!(filled.contains(ball + 1.01 * towards)? && !filled.contains(ball + 0.99 * towards)?);
    assert_eq!(report(&filled, 60)?.shells, 1);
    Ok(())
}

#[test]
fn an_offset_lattice_is_at_its_distance_where_it_is_cut() -> Outcome {
    let lattice = Solid::new(SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.8, thickness: 0.1 });
    // Of a larger piece, whose own faces are too far away to matter.
    let surface = Surface::new(&(&lattice & Solid::cuboid([1.2; 3])), 64)?.expect("it has a surface");
    let by = 0.08;
    let moved = lattice.offset(by) & Solid::cuboid([0.6; 3]);
    let mut random = Random::new(1207);
    for _ in 0..150 {
        let p = random.vector(-0.29, 0.29);
        let [least, most] = surface.distance(p);
        let [least, most] = if lattice.contains(p)? { [least, most] } else { [-most, -least] };
        let inside = moved.contains(p)?;
        assert!(least <= -by + 3.0 * TOLERANCE * by || inside, "{p}: outside, distance {least} to {most}");
        assert!(most >= -by - 3.0 * TOLERANCE * by || !inside, "{p}: inside, distance {least} to {most}");
    }
    let mesh = report(&moved, 48)?;
    assert_eq!(mesh.shells, 1, "{mesh}");
    Ok(())
}

/// What is cut off far away does not make lengths coarser.
#[test]
fn large_operands_are_measured_where_they_are_cut() -> Outcome {
    let cube = Solid::cuboid([10.0, 8.0, 6.0]);
    let large = at(Solid::superellipsoid([1000.0, 900.0, 800.0], 0.5, 0.7), [997.0, 0.0, 0.0]);
    let long = Solid::cuboid([4.0, 3.0, 4000.0]).twist(rad(0.1));
    let mut random = Random::new(3426);
    for solid in [&large & &cube, &long & &cube, &cube - &long, &cube & &long & &large] {
        let [inwards, outwards] = [-0.1, 0.1].map(|by| solid.offset(by));
        let [told, right] = [inwards.accuracy()?, outwards.accuracy()?];
        assert!(told.tolerance <= right.tolerance && told.error <= 2.0 * right.tolerance, "{told:?}, {right:?}");
        for _ in 0..200 {
            let p = random.point_in(&solid.bounds()?);
            if solid.contains(p)? {
                let [a, b] = [inwards.value(p)? + 0.1, outwards.value(p)? - 0.1];
                assert!((a - b).abs() < 2e-3, "{solid:?}: {a} and {b} at {p}");
            }
        }
    }
    Ok(())
}

/// Walls and gaps that are just as wide as the ball are there still: its centre rolls on a sheet, a line
/// or a curved one of them, to whose rims the rounding follows.
#[test]
fn what_is_as_wide_as_the_ball_is_left() {
    let without = |solid: &Solid, tool: Solid| solid.difference(tool, RFunction::MIN_MAX);
    let plate = Solid::cuboid([4.0, 3.0, 1.0]);
    let bored = without(&Solid::cuboid([4.0, 4.0, 1.0]), Solid::cylinder(0.6, 3.0));
    let tube = without(&Solid::cylinder(2.0, 5.0), Solid::cylinder(1.0, 6.0));
    let cross = Solid::cuboid([1.0, 1.0, 4.0]) | Solid::cuboid([4.0, 1.0, 1.0]);
    // The nearest places for the ball's centre.
    let on_plate = |p: DVec3| {
        let flat = DVec3::new(p.x.clamp(-1.5, 1.5), p.y.clamp(-1.5, 1.5), 0.0);
        let radius = flat.truncate().length();
        if radius < 1.1 { (1.1 / radius * flat.truncate()).extend(0.0) } else { flat }
    };
    let on_tube = |p: DVec3| (1.5 * p.truncate().normalize()).extend(p.z.clamp(-2.0, 2.0));
    let on_cross = |p: DVec3| {
        let [x, z] = [DVec3::X * p.x.clamp(-1.5, 1.5), DVec3::Z * p.z.clamp(-1.5, 1.5)];
        if p.distance(x) < p.distance(z) { x } else { z }
    };
    check_balls("bored plate", &bored, on_plate);
    check_balls("tube", &tube, on_tube);
    check_balls("cross", &cross, on_cross);
    let l = (&plate | Solid::cuboid([1.0, 3.0, 3.0]).translate([-1.5, 0.0, 1.0])).rounded(0.5);
    assert!([[1.0, 0.2, 0.3], [-1.4, 0.3, 1.4]].iter().all(|p| l.contains(*p).unwrap()));
    assert!(![[1.97, 0.0, 0.3], [-1.8, 0.0, 2.45]].iter().any(|p| l.contains(*p).unwrap()));
    let slot = Solid::cuboid([1.0, 4.0, 2.0]).translate([0.0, 0.0, 0.6]);
    let filled = without(&Solid::cuboid([4.0, 3.0, 2.0]), slot).filleted(0.5);
    assert!(!filled.contains([0.0, 0.0, 0.2]).unwrap() && filled.contains([0.45, 0.0, -0.38]).unwrap());
}

/// That a solid rounded by .5 ends where balls about the nearest places for their centres do.
fn check_balls(name: &str, solid: &Solid, nearest: impl Fn(DVec3) -> DVec3) {
    /// How far off it may be.
    const OFF: f64 = 2e-3;
    let rounded = solid.rounded(0.5);
    let mut random = Random::new(35);
    for _ in 0..4000 {
        let reach = solid.finite_bounds().unwrap().half_extents();
        let at = DVec3::new(random.unit(), random.unit(), random.unit()) * 2.0 - 1.0;
        let centre = nearest(reach * at);
        let away = random.direction();
        for (by, is_inside) in [(0.5 - OFF, true), (0.5 + OFF, false)] {
            let p = centre + by * away;
            let is_right = rounded.contains(p).unwrap() == is_inside;
            // Other centres may be nearer.
            assert!(is_right || !is_inside && p.distance(nearest(p)) < by - 1e-9, "{name} at {p}, {by} from {centre}");
        }
    }
}

/// What is measured to no more than half a wall's thickness is not gone for that.
#[test]
fn a_lattice_in_a_box_that_is_moved_in_is_there() {
    let gyroid = Solid::from(SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: 0.15 });
    let part = gyroid & Solid::cuboid([2.0, 1.6, 1.0]);
    let volume = |solid: &Solid| {
        let settings = MeshSettings { cell: CellSize::LongestSide(96), ..MeshSettings::default() };
        solid.mesh(&settings).unwrap().check().volume
    };
    let share = volume(&part.offset(-0.01)) / volume(&part);
    assert!((0.8..0.95).contains(&share), "{share}");
}
