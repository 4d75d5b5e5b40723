//! The clearance of two solids.

use std::time::Instant;

use glam::DVec3;
use rvachev::{
    CellSize, Clearance, Helix, MeshSettings, MeshSolid, Polygon, Prism, Profile, RFunction, Run, Solid, SolidError,
    deg, error::PrepareError, rad,
};

fn clearance(a: &Solid, b: &Solid) -> Clearance {
    let now = Instant::now();
    let found = a.clearance(b, &Run::default()).unwrap().unwrap();
    println!("{found:?} in {:?}", now.elapsed());
    // The points are of the surfaces, and as far apart as is said, whichever is asked.
    for (solid, p) in [a, b].into_iter().zip(found.points).filter(|_| !found.overlaps) {
        assert!(solid.value(p).unwrap().abs() < 1e-6 * solid.bounds().unwrap().longest_side(), "{p}");
    }
    assert!((found.points[0].distance(found.points[1]) - found.distance).abs() < 1e-12);
    if found.overlaps {
        assert!(a.contains(found.points[0]).unwrap() && b.contains(found.points[0]).unwrap());
    }
    let back = b.clearance(a, &Run::default()).unwrap().unwrap();
    assert!((back.distance - found.distance).abs() <= found.tolerance + back.tolerance);
    assert_eq!(back.overlaps, found.overlaps);
    assert!((back.depth - found.depth).abs() <= 0.02 * found.depth + found.tolerance, "{back:?} {found:?}");
    found
}

fn right(found: &Clearance, exact: f64) {
    assert!(!found.overlaps && found.distance >= exact - 1e-9, "{found:?}, {exact}");
    assert!(found.distance - exact <= found.tolerance && found.tolerance < 0.002 * exact + 0.02, "{found:?}, {exact}");
}

#[test]
fn spheres_and_boxes() {
    let ball = Solid::sphere(2.0);
    right(&clearance(&ball, &Solid::sphere(1.0).translate([2.0, 3.0, 6.0])), 4.0);
    right(&clearance(&ball, &Solid::cuboid([2.0, 2.0, 2.0]).translate([5.0, 0.0, 0.0])), 2.0);
    // A corner towards an edge.
    let tip = Solid::cuboid([2.0; 3]).rotate_z(deg(45.0)).translate([4.0, 0.0, 0.0]);
    let turned = Solid::cuboid([2.0; 3]).rotate_y(deg(45.0));
    right(&clearance(&tip, &turned), 4.0 - 2.0 * 2f64.sqrt());
}

#[test]
fn a_peg_in_a_hole_has_its_gap_all_round() {
    let plate = Solid::cuboid([30.0, 30.0, 5.0]) - Solid::cylinder(5.1, 10.0);
    let found = clearance(&Solid::cylinder(5.0, 20.0), &plate);
    right(&found, 0.1);
    assert!(found.tolerance < 0.018, "{found:?}");
    assert!((found.points[0].truncate().length() - 5.0).abs() < 1e-6);
    let aside = clearance(&Solid::cylinder(5.0, 20.0).translate([0.05, 0.0, 0.0]), &plate);
    right(&aside, 0.05);
    assert!(aside.points[0].x > 4.9);
    assert!(clearance(&Solid::cylinder(5.0, 20.0).translate([0.2, 0.0, 0.0]), &plate).overlaps);
    // In a cavity, and in the material.
    let hollow = Solid::sphere(10.0).shell(1.0);
    right(&clearance(&Solid::sphere(3.0).translate([4.0, 0.0, 0.0]), &hollow), 2.0);
    let found = clearance(&Solid::sphere(3.0), &Solid::sphere(10.0));
    assert!(found.overlaps && found.distance == 0.0);
}

#[test]
fn what_touches_does_not_overlap_and_what_is_the_same_does() {
    let block = Solid::cuboid([4.0, 4.0, 2.0]);
    let found = clearance(&block, &block.translate([1.0, 0.0, 2.0]));
    assert!(!found.overlaps && found.distance <= found.tolerance);
    assert!(clearance(&block, &block).overlaps);
    assert!(clearance(&block, &block.translate([1.0, 1.0, 0.0])).overlaps);
}

#[test]
fn twisted_ones_are_as_far_apart_as_dense_points_say() {
    let twisted = Solid::superellipsoid([3.0, 1.5, 6.0], 0.3, 0.5).twist(deg(10.0));
    let other = twisted.rotate_y(deg(70.0)).translate([0.5, 5.5, 1.0]);
    let found = clearance(&twisted, &other);
    let mesh = twisted.mesh(&MeshSettings { cell: CellSize::Length(0.15), ..MeshSettings::default() }).unwrap();
    let points: Vec<DVec3> = mesh.positions().iter().map(|p| p.as_dvec3()).collect();
    let feet = other.closest_surface_points(&points).unwrap();
    let dense = points.iter().zip(feet).map(|(p, foot)| p.distance(foot.unwrap())).fold(f64::INFINITY, f64::min);
    // Vertices of the mesh are off the surface where it curves, by a small part of a cell.
    assert!(!found.overlaps && (found.distance - dense).abs() < 0.005, "{found:?}, {dense}");
    assert!(found.tolerance < 0.01, "{found:?}");
}

#[test]
fn nothing_has_no_clearance_and_faults_are_told() {
    let ball = Solid::sphere(1.0);
    let empty = ball.clone() & ball.translate([5.0, 0.0, 0.0]);
    assert_eq!(ball.clearance(&empty, &Run::default()).unwrap(), None);
    let block = Solid::cuboid([1.0; 3]).twist(deg(20.0));
    assert_eq!(ball.clearance(&(&block - &block), &Run::default()).unwrap(), None);
    // What is too thin to be measured is no empty solid.
    for thin in [[1e-6, 1e-6, 10.0], [1e-8, 10.0, 10.0]] {
        let error = Solid::cuboid(thin).clearance(&ball.translate([30.0, 0.0, 0.0]), &Run::default()).unwrap_err();
        assert!(error.to_string().contains("thicker"), "{error}");
        assert!(matches!(error, PrepareError::Solid(SolidError::Surface { .. })));
    }
    // Nor is what may be: of faces that fall together no range tells that nothing is between them.
    let slab = Solid::cuboid([1.0; 3]);
    let touching = (&slab & slab.translate([1.0, 0.0, 0.0])).rotate_z(deg(20.0));
    let error = ball.translate([30.0, 0.0, 0.0]).clearance(&touching, &Run::default()).unwrap_err();
    assert!(matches!(&error, PrepareError::Solid(SolidError::Surface { .. })), "{error}");
    assert!(error.to_string().contains("not known"), "{error}");
    let endless = Solid::half_space([0.0, 0.0, 1.0], -5.0);
    assert!(matches!(ball.clearance(&endless, &Run::default()), Err(PrepareError::Solid(_))));
    let run = Run::default();
    run.cancel.cancel();
    let fresh = Solid::sphere(1.5).twist(deg(1.0));
    assert!(matches!(fresh.clearance(&ball, &run), Err(PrepareError::Cancelled(_))));
}

#[test]
fn a_corner_that_is_dipped_into_a_face_overlaps() {
    let block = Solid::cuboid([20.0, 20.0, 10.0]);
    // A cube on its corner: half its diagonal below its middle.
    let turn = glam::DQuat::from_rotation_arc(glam::DVec3::ONE.normalize(), -glam::DVec3::Z);
    let reach = 5.0 * 3f64.sqrt();
    for (dip, overlaps) in [(0.1, true), (0.5, true), (-0.1, false)] {
        for at in [[0.0, 0.0], [1.37, -2.11], [3.3, 4.7]] {
            let cube = Solid::cuboid([10.0; 3]).rotate(turn).translate([at[0], at[1], 5.0 + reach - dip]);
            let found = cube.clearance(&block, &Run::default()).unwrap().unwrap();
            assert_eq!(found.overlaps, overlaps, "{dip} at {at:?}: {found:?}");
            if !overlaps {
                assert!((found.distance + dip).abs() <= found.tolerance + 1e-9, "{found:?}");
            }
        }
    }
}

#[test]
fn depth_and_volume_of_an_overlap_are_told() {
    let deep = |found: &Clearance, depth: f64, volume: f64| {
        assert!(found.overlaps && (found.depth - depth).abs() <= 0.015 * depth + found.tolerance, "{found:?} {depth}");
        assert!((found.volume - volume).abs() <= found.volume_error, "{found:?} {volume}");
        assert!(found.volume_error <= 0.021 * volume, "{found:?} {volume}");
    };
    // Boxes that are pushed into each other by .1 over a face.
    let block = Solid::cuboid([4.0, 4.0, 2.0]);
    deep(&clearance(&block, &block.translate([0.0, 0.0, 1.9])), 0.1, 1.6);
    // Two balls: the lens between them.
    let (r, apart) = (2.0, 3.5);
    let lens = std::f64::consts::PI * (2.0f64 * r - apart).powi(2) * (apart * apart + 4.0 * apart * r) / (12.0 * apart);
    deep(&clearance(&Solid::sphere(r), &Solid::sphere(r).translate([apart, 0.0, 0.0])), 0.5, lens);
    // One within the other.
    let inner = 4.0 / 3.0 * std::f64::consts::PI;
    deep(&clearance(&Solid::sphere(1.0), &Solid::sphere(10.0)), 9.0, inner);
    // Long triangles: no corner nor middle of one is in the thin blade, nor the other way round.
    let blade = Solid::cuboid([0.4, 12.0, 12.0]).rotate_y(deg(10.0)).translate([1.4, 1.0, 4.0]);
    let slab = Solid::cuboid([40.0, 40.0, 1.0]).rotate_z(deg(17.0));
    let found = clearance(&blade, &slab);
    assert!(found.overlaps && found.volume > 0.0, "{found:?}");
}

#[test]
fn parts_that_touch_along_faces_and_rounds_do_not_overlap() {
    // A pin that fills its bore, a ball on a plate, and two balls.
    let bore = Solid::cuboid([12.0, 12.0, 8.0]) - Solid::cylinder(3.0, 10.0);
    let found = clearance(&Solid::cylinder(3.0, 8.0), &bore);
    assert!(!found.overlaps && found.distance <= found.tolerance && found.tolerance < 0.06, "{found:?}");
    let ball = Solid::sphere(2.0);
    let found = clearance(&ball, &Solid::cuboid([4.0, 4.0, 1.0]).translate([0.0, 0.0, -2.5]));
    assert!(!found.overlaps && found.distance <= found.tolerance && found.tolerance < 0.06, "{found:?}");
    let found = clearance(&ball, &ball.rotate_x(deg(20.0)).translate([4.0, 0.0, 0.0]));
    assert!(!found.overlaps && found.distance <= found.tolerance && found.tolerance < 0.06, "{found:?}");
}

#[test]
fn a_foil_through_a_block_overlaps() {
    let foil = Solid::cuboid([3.0, 3.0, 0.01]).rotate_x(deg(20.0)).rotate_z(deg(35.0));
    let block = Solid::cuboid([2.0; 3]);
    let found = clearance(&foil, &block);
    assert!(found.overlaps && found.depth + found.depth_error >= 0.9, "{found:?}");
}

#[test]
fn surfaces_that_all_but_fall_together_are_as_deep_as_they_are_apart() {
    let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
    let mesh = Solid::sphere(2.0).mesh(&settings).unwrap();
    let ball = Solid::from_mesh(&mesh, MeshSolid::default());
    // By more than what counts as touching, less than a triangle is wide.
    let by = DVec3::new(0.03, 0.01, 0.0);
    let found = ball.clearance(&ball.translate(by), &Run::default()).unwrap().unwrap();
    let depth = |p: DVec3| ball.value(p).unwrap();
    let deepest = mesh.positions().iter().map(|p| depth(p.as_dvec3() + by)).fold(0.0, f64::max);
    assert!(found.overlaps && found.depth + found.depth_error >= deepest, "{found:?} {deepest}");
    // No point is deeper than it was moved.
    assert!(found.depth <= by.length() + 1e-6 && found.depth_error < 0.1 * by.length(), "{found:?}");
    // Turned about its middle, it is as it was, to within what triangles are off a ball.
    let turned = ball.clearance(&ball.rotate_x(deg(50.0)), &Run::default()).unwrap().unwrap();
    assert!(turned.overlaps && turned.depth + turned.depth_error < 0.005, "{turned:?}");
}

#[test]
fn a_mesh_in_a_hollow_has_its_even_gap() {
    let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
    let [ball, shell] = [Solid::sphere(2.0), Solid::sphere(3.0).shell(0.8)].map(|solid| solid.mesh(&settings).unwrap());
    let [inner, outer] = [&ball, &shell].map(|mesh| Solid::from_mesh(mesh, MeshSolid::default()));
    let found = clearance(&inner, &outer);
    let gap = |p: &glam::Vec3| -outer.value(p.as_dvec3()).unwrap();
    let nearest = ball.positions().iter().map(gap).fold(f64::INFINITY, f64::min);
    // Faces may be nearer than vertices, by what they are off the hollow.
    assert!(!found.overlaps && found.distance <= nearest + found.tolerance, "{found:?} {nearest}");
    assert!(found.distance > nearest - 0.01 && found.tolerance < 0.002, "{found:?} {nearest}");
}

/// A screw: a ridge on a core, all grown by a length.
fn screw(by: f64) -> Solid {
    let section =
        Profile::polygon([[-0.3, -0.42 - by], [0.6 + by, -0.12 - by], [0.6 + by, 0.12 + by], [-0.3, 0.42 + by]]);
    let ridge = section.sweep_helix(&Helix::new(4.0, 1.25, 2.5));
    ridge.union(Solid::cylinder(4.0 + by, 5.0), RFunction::MIN_MAX)
}

#[test]
fn a_bolt_in_its_nut_runs_free_touches_or_is_too_thick() {
    let bolt = screw(0.0);
    let nut = |gap: f64| Solid::from(Prism::across_flats(6, 13.0, 2.0)) - screw(gap);
    let found = bolt.clearance(&nut(0.1), &Run::default()).unwrap().unwrap();
    assert!(!found.overlaps && (found.distance - 0.1).abs() < 0.001, "{found:?}");
    assert!(found.tolerance < 0.015, "{found:?}");
    // Along the edges of the thread patches are folded, and the nut ends in knife edges.
    let found = bolt.clearance(&nut(0.0), &Run::default()).unwrap().unwrap();
    assert!(!found.overlaps && found.distance < 0.001 && found.tolerance < 0.02, "{found:?}");
    let found = bolt.clearance(&nut(-0.1), &Run::default()).unwrap().unwrap();
    // The thread is larger by as much along its axis and across it: its corners are the deepest.
    let deepest = 0.1 * f64::sqrt(2.0);
    assert!(found.overlaps && (found.depth - deepest).abs() <= found.depth_error + found.tolerance, "{found:?}");
    // The overlap is thin all over.
    assert!(found.volume_error < 0.1 * found.volume, "{found:?}");
}

/// A spur gear with involute teeth, the first in the middle of +x.
fn gear(teeth: u32, backlash: f64) -> Profile {
    let (module, pressure) = (2.0, 20f64.to_radians());
    let pitch = 0.5 * module * f64::from(teeth);
    let (base, tip, root) = (pitch * pressure.cos(), pitch + module, pitch - 1.25 * module);
    let involute = |angle: f64| angle.tan() - angle;
    let half = (0.25 * std::f64::consts::PI * module - 0.25 * backlash) / pitch + involute(pressure);
    let flank: Vec<[f64; 2]> = (0..=8)
        .map(|k| {
            let radius = base + (tip - base) * f64::from(k) / 8.0;
            [radius, half - involute((base / radius).acos())]
        })
        .collect();
    let flank = [vec![[root, half]], flank].concat();
    let mut outline = Vec::new();
    for tooth in 0..teeth {
        let middle = std::f64::consts::TAU * f64::from(tooth) / f64::from(teeth);
        let at = |[radius, angle]: [f64; 2]| [radius * (middle + angle).cos(), radius * (middle + angle).sin()];
        outline.extend(flank.iter().map(|[radius, angle]| at([*radius, -angle])));
        outline.extend(flank.iter().rev().map(|p| at(*p)));
    }
    Profile::polygon(outline)
}

#[test]
fn gears_in_mesh_have_their_backlash() {
    let backlash = 0.2;
    let [pinion, wheel] = [17, 30].map(|teeth| gear(teeth, backlash).extrude(4.0));
    // Half of it on each side, along the line of action, less what chords cut off.
    let expected = 0.5 * backlash * 20f64.to_radians().cos();
    let turned = wheel.rotate_z(rad(std::f64::consts::PI / 30.0)).translate([47.0, 0.0, 0.0]);
    let found = clearance(&pinion, &turned);
    assert!(!found.overlaps && (found.distance - expected).abs() < 0.01, "{found:?} {expected}");
    // Their faces are flat and known: nothing is measured.
    assert!(found.tolerance < 0.002, "{found:?}");
    // Turned by all of the play and more a flank goes into the other.
    let jammed = pinion.rotate_z(rad(0.15 / 17.0)).clearance(&turned, &Run::default()).unwrap().unwrap();
    assert!(jammed.overlaps && jammed.depth > 0.02 && jammed.depth < 0.1, "{jammed:?}");
    // Their ends fall together, and are not deep.
    assert!(jammed.depth_error < 0.15, "{jammed:?}");
    // Plates are as deep all over as their boxes tell.
    let plate = Solid::from_mesh(
        &Solid::cuboid([80.0, 60.0, 4.0]).mesh(&MeshSettings::default()).unwrap(),
        MeshSolid::default(),
    );
    let found = plate.clearance(&plate.translate([0.0, 0.0, 3.0]), &Run::default()).unwrap().unwrap();
    assert!(found.overlaps && (found.depth - 1.0).abs() < 0.02 && found.depth_error < 0.05, "{found:?}");
}

#[test]
fn meshes_and_extruded_polygons_have_the_clearance_of_their_triangles() {
    let settings = MeshSettings { cell: CellSize::LongestSide(12), ..MeshSettings::default() };
    let mesh = |solid: &Solid| Solid::from_mesh(&solid.mesh(&settings).unwrap(), MeshSolid::default());
    // Edge against edge, off all corners of the triangles.
    let block = Solid::cuboid([4.0, 4.0, 2.0]);
    // How far the edges of a square bar are from its middle.
    let tip = 2f64.sqrt();
    let bar = Solid::cuboid([4.0, 2.0, 2.0]).rotate_x(deg(45.0));
    let edge = bar.rotate_z(deg(70.0)).translate([0.3, 0.2, tip + 0.125]);
    let low = bar.rotate_z(deg(90.0)).translate([0.0, 0.0, -tip]);
    for (upper, lower) in [(mesh(&edge), mesh(&low)), (mesh(&edge), low)] {
        let found = clearance(&upper, &lower);
        assert!((found.distance - 0.125).abs() < 1e-4 && found.tolerance < 1e-3, "{found:?}");
    }
    // A frame about a bar, mirrored and stretched.
    let frame = [[-4.0, -3.0], [5.0, -3.0], [5.0, 3.0], [-4.0, 3.0]];
    let hole = [[-2.0, -1.0], [3.0, -1.0], [3.0, 1.0], [-2.0, 1.0]];
    let frame = Profile::from(Polygon::new([frame, hole])).extrude(2.0).reflect_x().scale(2.0);
    let bar = Profile::polygon([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]).extrude(30.0);
    let found = clearance(&frame, &bar.translate([-4.5, 0.5, 0.0]));
    assert!(!found.overlaps && (found.distance - 0.5).abs() < 1e-4, "{found:?}");
    assert!(clearance(&frame, &bar.translate([-4.5, 1.5, 0.0])).overlaps);
    // Above each other.
    let found = clearance(&frame, &bar.translate([7.0, 0.0, 17.25]));
    assert!(!found.overlaps && (found.distance - 0.25).abs() < 1e-4, "{found:?}");
    // One within the other's hollow, and within its material.
    let shell = mesh(&Solid::cuboid([10.0; 3]).shell(1.0));
    let found = clearance(&mesh(&Solid::cuboid([2.0; 3]).translate([2.5, 0.0, 0.0])), &shell);
    assert!(!found.overlaps && (found.distance - 0.5).abs() < 1e-4, "{found:?}");
    assert!(clearance(&mesh(&block), &mesh(&Solid::cuboid([10.0; 3]))).overlaps);
}

#[test]
fn of_default_meshes_that_touch_it_is_told_at_once_that_they_do() {
    let mesh = |solid: &Solid| Solid::from_mesh(&solid.mesh(&MeshSettings::default()).unwrap(), MeshSolid::default());
    let tilt = |solid: &Solid| solid.rotate_x(deg(20.0)).rotate_z(deg(35.0));
    let block = Solid::cuboid([4.0, 4.0, 2.0]);
    // What only touches goes no deeper than what counts as that, and nothing is left open.
    let touching = |solid: &Solid| 2e-4 * solid.bounds().unwrap().longest_side();
    let (own, tilted) = (mesh(&block), mesh(&tilt(&block)));
    for (one, other) in [
        (own.clone(), own.translate([1.0, 0.3, 2.0])),
        (tilted.clone(), mesh(&tilt(&block.translate([0.5, 0.2, 2.0])))),
        (tilted.clone(), mesh(&tilt(&Solid::cuboid([0.004; 3]).translate([0.5, 0.2, 1.002])))),
        // In a corner of an L.
        (mesh(&(&block | block.translate([0.0, 2.0, 2.0]))), own.translate([0.0, -2.0, 2.0])),
    ] {
        let found = one.clearance(&other, &Run::default()).unwrap().unwrap();
        let most = touching(&one) + touching(&other);
        assert!(!found.overlaps && found.distance < most && found.tolerance < 1.25 * most, "{found:?}");
    }
    for solid in [own, tilted, mesh(&Solid::sphere(2.0))] {
        let found = solid.clearance(&solid, &Run::default()).unwrap().unwrap();
        let most = touching(&solid);
        assert!(found.overlaps && found.depth < 1.01 * most && found.depth_error < 1.01 * most, "{found:?}");
        assert!((found.volume - solid.measure(1e-3).unwrap().volume).abs() <= found.volume_error, "{found:?}");
    }
}
