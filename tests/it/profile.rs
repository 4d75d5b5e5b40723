//! Profiles and the solids made of them: values, boxes, errors, volumes of their meshes.

use std::f64::consts::{PI, TAU};

use glam::{DAffine2, DMat2, DVec2, DVec3};
use rvachev::{
    Caps, CellSize, Extrusion, Gielis, Helix, Mesh, MeshSettings, Polygon, Profile, RFunction, Radius, Solid,
    Superpolygon, deg, program::Region, rad,
};

use crate::support::{Random, near, near_point, value};

fn plane(random: &mut Random, half: f64) -> DVec2 {
    DVec2::new(random.range(-half, half), random.range(-half, half))
}

/// The mesh, which must be closed and manifold.
#[track_caller]
fn mesh(solid: &Solid, across: u32) -> Mesh {
    let settings = MeshSettings { cell: CellSize::LongestSide(across), ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).expect("the solid is bounded");
    let report = mesh.check();
    assert!(report.is_closed() && report.is_manifold(), "{solid:?}: {report:?}");
    mesh
}

#[track_caller]
fn has_volume(solid: &Solid, across: u32, want: f64, relative: f64) {
    let got = mesh(solid, across).volume();
    assert!((got / want - 1.0).abs() < relative, "{solid:?}: volume {got}, want {want}");
}

/// A comb of `teeth` teeth: many edges, long and short.
fn comb(teeth: u32) -> Vec<DVec2> {
    let mut points = vec![DVec2::new(f64::from(teeth), -1.0), DVec2::new(f64::from(teeth), 0.0)];
    for i in (0..teeth).rev() {
        let x = f64::from(i);
        points.extend([(0.9, 0.0), (0.6, 1.0), (0.3, 1.0), (0.1, 0.0)].map(|(dx, y)| DVec2::new(x + dx, y)));
    }
    points.extend([DVec2::new(0.0, 0.0), DVec2::new(0.0, -1.0)]);
    points
}

#[test]
fn joins_and_maps_are_those_of_the_plane() {
    let mut random = Random::new(301);
    let (a, b) = (Profile::circle(1.0), Profile::rectangle(DVec2::new(1.5, 0.8)));
    let angle = 0.7f64;
    let map = DAffine2::from_mat2_translation(DMat2::from_cols_array(&[1.2, 0.1, -0.4, 0.9]), DVec2::new(0.3, 0.1));
    for _ in 0..200 {
        let p = plane(&mut random, 2.0);
        let (in_a, in_b) = (a.contains(p).unwrap(), b.contains(p).unwrap());
        let inside = |profile: Profile| profile.contains(p).unwrap();
        assert_eq!(inside(&a | &b), in_a | in_b);
        assert_eq!(inside(&a & &b), in_a & in_b);
        assert_eq!(inside(&a - &b), in_a & !in_b);
        assert_eq!(inside(&a ^ &b), in_a ^ in_b);
        assert_eq!(inside(!&a), !in_a);
        let at = |p: DVec2| b.value(p).unwrap();
        near(b.translate(DVec2::X).value(p).unwrap(), at(p - DVec2::X), 1e-14);
        near(b.rotate(rad(angle)).value(p).unwrap(), at(DVec2::from_angle(-angle).rotate(p)), 1e-14);
        near(b.scale(-2.5).value(p).unwrap(), 2.5 * at(p / -2.5), 1e-14);
        near(b.scale_axes(DVec2::new(2.0, -0.5)).value(p).unwrap(), 0.5 * at(p / DVec2::new(2.0, -0.5)), 1e-14);
        let line = DVec2::from_angle(angle);
        near(b.reflect(line, 0.0).value(p).unwrap(), at(p - 2.0 * p.dot(line) * line), 1e-14);
        let stretch = at(map.inverse().transform_point2(p)) / b.affine(map).value(p).unwrap();
        let least = b.affine(map).value(p).unwrap() / at(map.inverse().transform_point2(p));
        assert!(stretch > 0.0 && (0.78..0.99).contains(&least), "{least}");
    }
    let bounds = b.rotate(deg(90.0)).translate(DVec2::new(3.0, 4.0)).bounds().unwrap();
    near_point((bounds.min - DVec2::new(2.6, 3.25)).extend(0.0), DVec3::ZERO, 1e-12);
    near_point((bounds.max - DVec2::new(3.4, 4.75)).extend(0.0), DVec3::ZERO, 1e-12);
}

#[test]
fn straight_extrusions_and_rings_are_true_distances() {
    let mut random = Random::new(302);
    let block = Profile::rectangle(DVec2::new(2.0, 1.0)).extrude(3.0);
    let cuboid = Solid::cuboid(DVec3::new(2.0, 1.0, 3.0));
    let rod = Profile::rectangle(DVec2::new(2.0, 5.0)).revolve();
    let cylinder = Solid::cylinder(1.0, 5.0);
    for _ in 0..300 {
        let p = random.vector(-4.0, 4.0);
        near(value(&block, p), value(&cuboid, p), 1e-14);
        near(value(&rod, p), value(&cylinder, p), 1e-14);
    }
}

#[test]
fn unbounded_profiles_make_bounded_solids() {
    let strip = Profile::from(rvachev::Rectangle { size: DVec2::new(2.0, 1.0), radius: 0.2 });
    let near_box = |solid: &Solid, min: DVec3, max: DVec3| {
        let bounds = solid.bounds().unwrap();
        near_point(bounds.min, min, 1e-9);
        near_point(bounds.max, max, 1e-9);
    };
    near_box(&strip.extrude(3.0), DVec3::new(-1.0, -0.5, -1.5), DVec3::new(1.0, 0.5, 1.5));
    let ring = strip.translate(DVec2::new(4.0, 1.0));
    near_box(&ring.revolve(), DVec3::new(-5.0, -5.0, 0.5), DVec3::new(5.0, 5.0, 1.5));
    near_box(&ring.revolve_by(rad(1.0)), DVec3::new(0.0, 0.0, 0.5), DVec3::new(5.0, 5.0, 1.5));
    near_box(&strip.sweep_helix(&Helix::new(4.0, 3.0, 2.0)), DVec3::new(-5.0, -5.0, -3.5), DVec3::new(5.0, 5.0, 3.5));
    assert!(strip.translate(DVec2::new(-4.0, 0.0)).revolve().bounds().unwrap().is_empty());
    assert!(strip.column().mesh(&MeshSettings::default()).is_err());
}

#[test]
fn extrusions_have_their_volume() {
    let hexagon = Profile::regular_polygon(6, 1.0);
    let area = 1.5 * 3f64.sqrt();
    has_volume(&hexagon.extrude(2.0), 40, 2.0 * area, 6e-3);
    let twisted = Extrusion { twist: rad(1.2), ..Extrusion::new(2.0) };
    has_volume(&hexagon.extrude_with(&twisted), 40, 2.0 * area, 8e-3);
    // A frustum.
    let tapered = Extrusion { scale: 0.4, ..Extrusion::new(2.0) };
    let frustum = 2.0 * area * (1.0 + 0.4 + 0.16) / 3.0;
    has_volume(&hexagon.extrude_with(&tapered), 40, frustum, 8e-3);
    has_volume(&hexagon.extrude_with(&Extrusion { twist: rad(-0.8), ..tapered }), 40, frustum, 1e-2);
    let polygon = Polygon::new([comb(8)]);
    let area = polygon.area();
    near(area, 8.0 + 8.0 * 0.55, 1e-12);
    has_volume(&Profile::from(polygon).extrude(1.0), 64, area, 2e-2);
}

#[test]
fn twisted_and_scaled_sections_are_where_they_ought_to_be() {
    let mut random = Random::new(303);
    let profile = Profile::polygon([[0.0, 0.0], [2.0, 0.3], [1.0, 1.5]]);
    let (twist, scale, height) = (1.1, 0.6, 4.0);
    let solid = profile.extrude_with(&Extrusion { twist: rad(twist), scale, caps: Caps::Flat, height });
    for _ in 0..500 {
        let (p, z) = (plane(&mut random, 2.5), random.range(-1.99, 1.99));
        let up = z / height + 0.5;
        let q = DVec2::from_angle(-twist * up).rotate(p) / (1.0 + (scale - 1.0) * up);
        let want = profile.value(q).unwrap();
        if want.abs() > 1e-9 {
            assert_eq!(solid.contains(p.extend(z)).unwrap(), want > 0.0, "{p} {z}");
        }
        assert!(!solid.contains(p.extend(2.001)).unwrap());
    }
}

#[test]
fn revolved_solids_have_their_volume() {
    // Pappus: area times the way of the centroid.
    let section = Profile::superellipse(DVec2::new(0.6, 0.4), 0.5).translate(DVec2::new(2.0, 0.3));
    let slice = section.extrude(1.0);
    let area = mesh(&slice, 48).volume();
    has_volume(&section.revolve(), 64, area * TAU * 2.0, 1.5e-2);
    for angle in [0.5, PI, 5.5] {
        has_volume(&section.revolve_by(rad(angle)), 48, area * angle * 2.0, 2e-2);
    }
    // The part beyond the axis is left out.
    let disc = Profile::circle(1.0);
    has_volume(&disc.revolve(), 40, 4.0 / 3.0 * PI, 6e-3);
    let sector = disc.revolve_by(rad(TAU / 3.0));
    has_volume(&sector, 40, 4.0 / 9.0 * PI, 8e-3);
    assert!(sector.contains(DVec3::new(0.5, 0.1, 0.0)).unwrap());
    assert!(!sector.contains(DVec3::new(0.5, -0.1, 0.0)).unwrap());
}

/// Whether a point is in a helix, by going through its turns.
fn in_helix(profile: &Profile, helix: &Helix, p: DVec3) -> (bool, f64) {
    let hand = if helix.left_handed { -1.0 } else { 1.0 };
    let (mut inside, mut least) = (false, f64::INFINITY);
    let first = (hand * p.y).atan2(p.x);
    for turn in -12..=12 {
        let angle = first + TAU * f64::from(turn);
        let section = DVec2::new(p.truncate().length() - helix.radius, p.z - helix.pitch * angle / TAU);
        let end = (0.5 * helix.turns - (angle / TAU).abs()) * helix.pitch;
        let value = profile.value(section).unwrap().min(end);
        inside |= value > 0.0;
        least = least.min(value.abs());
    }
    (inside, least)
}

#[test]
fn helices_hold_the_points_of_their_turns() {
    let mut random = Random::new(304);
    let tooth = Profile::polygon([[-0.2, -0.9], [0.5, 0.1], [-0.2, 0.5]]);
    for (profile, left_handed) in [
        (Profile::circle(0.4), false),
        (Profile::circle(0.4).translate(DVec2::new(0.1, 5.0)), true),
        // Higher than half the pitch, than the pitch, and far from its middle.
        (tooth.clone(), false),
        (tooth.scale(1.9), true),
        (tooth.translate(DVec2::new(0.0, -3.3)), false),
    ] {
        let helix = Helix { left_handed, ..Helix::new(2.0, 1.6, 3.3) };
        let solid = profile.sweep_helix(&helix);
        let bounds = solid.bounds().unwrap().inflate(0.2);
        let mut tried = 0;
        for _ in 0..1500 {
            let p = random.point_in(&bounds);
            let (inside, least) = in_helix(&profile, &helix, p);
            if least > 1e-9 {
                tried += 1;
                assert_eq!(solid.contains(p).unwrap(), inside, "{profile:?} at {p}");
            }
        }
        assert!(tried > 1400);
    }
}

#[test]
fn helices_have_their_volume() {
    let area = PI * 0.09;
    let spring = Profile::circle(0.3).sweep_helix(&Helix::new(2.0, 1.0, 2.25));
    has_volume(&spring, 64, area * TAU * 2.0 * 2.25, 2.5e-2);
    // The centroid counts, not the helix's radius; turns of this thread nearly touch.
    let thread = Profile::polygon([[0.0, -0.45], [0.5, -0.05], [0.5, 0.05], [0.0, 0.45]]);
    let (area, centroid) = (0.25, 0.55 / 3.0);
    let solid = thread.sweep_helix(&Helix { left_handed: true, ..Helix::new(2.0, 1.0, 1.5) });
    let report = mesh(&solid, 64).check();
    assert_eq!(report.shells, 1);
    let want = area * TAU * (2.0 + centroid) * 1.5;
    near(report.volume, want, 3e-2 * want);
    // On a core it is a screw.
    let screw = solid.union(Solid::cylinder(2.05, 4.0), RFunction::MIN_MAX);
    assert_eq!(mesh(&screw, 48).check().shells, 1);
}

#[test]
fn meshes_of_polygons_with_holes_are_closed() {
    let square = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
    let polygon = Polygon::new([square(3.0), square(2.0), square(1.0)]);
    near(polygon.area(), 36.0 - 16.0 + 4.0, 1e-12);
    let solid = Profile::from(polygon).extrude(1.0);
    let report = mesh(&solid, 48).check();
    assert_eq!(report.shells, 2);
    near(report.volume, 24.0, 0.3);
    // Many edges: more than a list holds.
    let gear: Vec<DVec2> = (0..400)
        .map(|i| (if i / 2 % 2 == 0 { 2.0 } else { 1.95 }) * DVec2::from_angle(TAU * f64::from(i) / 400.0))
        .collect();
    let gear = Polygon::new([gear]);
    has_volume(&Profile::from(gear.clone()).extrude(0.5), 64, 0.5 * gear.area(), 1.5e-2);
}

#[test]
fn superpolygons_follow_their_curve() {
    for curve in [Gielis::new(5.0, 0.6, 1.7, 1.7), Gielis::polygon(6, 30.0), Gielis::new(3.0, 4.0, 6.0, 6.0)] {
        let shape = Superpolygon::new(curve, 2.5);
        let profile = Profile::from(shape.clone());
        for i in 0..64 {
            let angle = TAU * f64::from(i) / 64.0 - PI;
            let p = 2.5 * curve.radius(rad(angle), Radius::Standard) * DVec2::from_angle(angle);
            near(shape.gauge(p), 1.0, 1e-12);
            near(profile.value(p).unwrap(), 0.0, 1e-11);
            let bounds = profile.bounds().unwrap();
            assert!(bounds.min.cmple(p).all() && p.cmple(bounds.max).all());
        }
    }
}

#[test]
fn regions_of_profiles_are_told_apart() {
    let solid = Profile::from(Polygon::new([comb(40)])).extrude(2.0);
    let program = solid.surface_program().unwrap();
    let mut random = Random::new(305);
    let bounds = solid.bounds().unwrap().inflate(0.5);
    for _ in 0..300 {
        let block = crate::support::random_box(&mut random, &bounds);
        let region = program.narrow(&block);
        for p in crate::support::samples(&mut random, &block, 24) {
            let inside = program.value(p) > 0.0;
            match &region {
                Region::Inside => assert!(inside, "{block:?} at {p}"),
                Region::Outside => assert!(!inside, "{block:?} at {p}"),
                Region::Surface(narrowed) => assert_eq!(narrowed.value(p) > 0.0, inside, "{block:?} at {p}"),
            }
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    let text = |solid: Solid| solid.value(DVec3::X).unwrap_err().to_string();
    let disc = Profile::circle(1.0);
    assert_eq!(
        text(Profile::circle(-1.0).extrude(1.0)),
        "extrude / circle: radius is -1, allowed: 0.000000001 to 1000000000"
    );
    assert!(text(disc.extrude(0.0)).starts_with("extrude: height is 0, allowed"));
    assert!(text(disc.extrude_with(&Extrusion { scale: 0.0, ..Extrusion::new(1.0) })).contains("extrude: scale is 0"));
    assert!(
        text(disc.extrude_with(&Extrusion { twist: rad(f64::NAN), ..Extrusion::new(1.0) })).contains("twist is NaN")
    );
    assert!(text(disc.revolve_by(deg(-1.0))).contains("revolve_by: angle is -1, allowed"));
    let error = text(disc.revolve_by(deg(400.0)));
    assert!(error.contains("revolve_by: angle is 400, allowed: 0.0001 to 360 degrees"), "{error}");
    let helix = Helix::new(3.0, 2.0, 2.0);
    assert!(text(disc.sweep_helix(&Helix { turns: 0.0, ..helix })).contains("sweep_helix: turns is 0"));
    assert!(text(disc.sweep_helix(&Helix { radius: 0.9, ..helix })).contains("radius is 0.9, allowed: above 1"));
    assert!(text(disc.sweep_helix(&Helix { pitch: 0.8, ..helix })).contains("pitch is 0.8, allowed: at least 1"));
    assert!(text((!disc).sweep_helix(&helix)).contains("sweep_helix"));
    assert!(text(Profile::regular_polygon(2, 1.0).extrude(1.0)).contains("sides is 2, allowed: 3 to 1024"));
    assert!(
        text(Profile::rounded_rectangle(DVec2::ONE, 0.6).extrude(1.0)).contains("radius is 0.6, allowed: 0 to 0.5")
    );
    let bow = Profile::polygon([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
    assert!(text(bow.revolve()).contains("polygon: where edge 0 of contour 0 crosses edge 2 of contour 0, at (1, 1)"));
}

/// The slope of a cut through the edge of an end face: where the surface is along rays from
/// inside the edge.
#[test]
fn caps_have_their_size() {
    let height = 2.0;
    let profile = Profile::rectangle(DVec2::new(3.0, 3.0));
    let with = |caps| profile.extrude_with(&Extrusion { caps, ..Extrusion::new(height) });
    let (rounded, chamfered) = (with(Caps::Rounded(0.3)), with(Caps::Chamfered(0.3)));
    for i in 1..10 {
        let angle = 0.5 * PI * f64::from(i) / 10.0;
        let direction = DVec3::new(angle.cos(), 0.0, angle.sin());
        let centre = DVec3::new(1.2, 0.0, 0.7);
        let hit = rounded.raycast(centre, direction).unwrap().expect("it is inside");
        near(hit.distance, 0.3, 0.015);
        let hit = chamfered.raycast(centre, direction).unwrap().expect("it is inside");
        near(hit.distance * (angle.cos() + angle.sin()), 0.3, 0.015);
    }
}

#[test]
fn a_half_section_has_no_border_on_the_axis() -> Result<(), rvachev::SolidError> {
    let section = [[0.0, 0.0], [4.0, 0.0], [9.0, 6.0], [8.0, 6.0], [3.5, 1.0], [0.0, 1.0], [0.0, 0.5]];
    let bowl = Profile::polygon(section).revolve();
    near(bowl.value(DVec3::new(0.0, 0.0, 0.5))?, 0.5, 1e-12);
    near(bowl.value(DVec3::new(1.0, 0.0, 0.25))?, 0.25, 1e-12);
    near(bowl.value(DVec3::new(0.0, 0.1, 1.5))?, -0.5, 1e-12);
    let cone = Profile::polygon([[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]).revolve();
    near(cone.value(DVec3::new(0.0, 0.0, 2.5))?, -0.5, 1e-12);
    assert!(bowl.shell(0.1).value(DVec3::new(0.0, 0.0, 0.5))? < -0.3);
    Ok(())
}

#[test]
fn polygons_are_equal_by_their_points() -> Result<(), rvachev::SolidError> {
    let a = Profile::polygon([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).extrude(1.0);
    let b = Profile::polygon([[5.0, 5.0], [6.0, 5.0], [5.0, 6.0]]).extrude(1.0);
    assert_ne!(a, b);
    let both = Solid::union_all([&a, &b], RFunction::MIN_MAX);
    assert!(both.simplified().contains(DVec3::new(5.2, 5.2, 0.0))?);
    Ok(())
}
