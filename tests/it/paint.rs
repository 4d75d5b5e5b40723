//! Paint: on leaves, through joins and blends.

mod lengths;

use glam::DVec3;
use rvachev::{Blend, CellSize, MeshSettings, Paint, RFunction, Solid, SolidError, deg, rad};

const RED: [u8; 3] = [200, 0, 0];
const BLUE: [u8; 3] = [0, 0, 200];
const GREEN: [u8; 3] = [0, 160, 0];

fn color(solid: &Solid, p: [f64; 3]) -> Option<[u8; 3]> {
    solid.paint_at(p).unwrap().map(|paint| paint.color)
}

#[test]
fn cut_faces_have_the_colour_of_what_cut_them() {
    for rule in [RFunction::MIN_MAX, RFunction::P(2.0), RFunction::Zero { m: 1 }, RFunction::Distance] {
        let plate = Solid::cuboid([4.0, 4.0, 1.0]).paint(RED);
        let hole = Solid::cylinder(1.0, 3.0).paint(BLUE);
        let part = plate.difference(&hole, rule);
        assert_eq!(color(&part, [2.0, 0.3, 0.1]), Some(RED));
        assert_eq!(color(&part, [1.0, 0.0, 0.1]), Some(BLUE));
        let both = plate.union(&hole, rule);
        assert_eq!(color(&both, [1.0, 0.0, 1.2]), Some(BLUE));
        assert_eq!(color(&plate.intersection(&hole, rule), [0.0, 0.0, 0.5]), Some(RED));
    }
}

#[test]
fn the_outermost_paint_shows() {
    let part = Solid::cuboid([4.0, 4.0, 1.0]).paint(RED) - Solid::cylinder(1.0, 3.0).paint(BLUE);
    let again = part.paint(GREEN);
    assert_eq!(color(&again, [1.0, 0.0, 0.1]), Some(GREEN));
    let pair = part.translate([5.0, 0.0, 0.0]) | Solid::sphere(1.0);
    assert_eq!(color(&pair, [4.0 + 2.0, 0.0, 0.1]), Some(BLUE));
    assert_eq!(color(&pair, [-1.0, 0.0, 0.0]), None);
}

#[test]
fn one_part_in_two_paints() {
    // The same node twice at the same place, painted differently.
    let ball = Solid::sphere(1.0);
    let left = (&ball & Solid::half_space(DVec3::X, 0.0)).paint(RED);
    let right = (&ball & Solid::half_space(-DVec3::X, 0.0)).paint(BLUE);
    let both = left | right;
    assert_eq!(color(&both, [-0.8, 0.6, 0.0]), Some(RED));
    assert_eq!(color(&both, [0.8, 0.6, 0.0]), Some(BLUE));
}

#[test]
fn paint_survives_maps_copies_and_lengths() {
    let part = (Solid::cuboid([2.0, 2.0, 2.0]).paint(RED) - Solid::cylinder(0.5, 3.0).paint(BLUE))
        .rotate_z(deg(45.0))
        .translate([3.0, 0.0, 0.0])
        .repeat_polar(6);
    assert_eq!(color(&part, [-3.5, 0.0, 0.0]), Some(BLUE));
    let shell = Solid::sphere(2.0).paint(GREEN).shell(0.2);
    assert_eq!(color(&shell, [1.8, 0.0, 0.0]), Some(GREEN));
    let twisted = Solid::cuboid([2.0, 1.0, 4.0]).paint(RED).twist(rad(0.3));
    assert_eq!(color(&twisted, [0.0, 0.0, 2.0]), Some(RED));
}

#[test]
fn blends_mix() {
    let foot = Solid::half_space(DVec3::Z, 0.0).paint(RED);
    let wall = Solid::half_space(DVec3::X, 0.0).paint(BLUE);
    for blend in [Blend::Smooth { radius: 1.0 }, Blend::Fillet { radius: 1.0 }, Blend::Chamfer { leg: 1.0 }] {
        let both = foot.union_with(&wall, blend);
        // Along a line from one operand to the other, red falls and blue rises.
        let at = |t: f64| {
            let start = DVec3::new(2.0 + 4.0 * t, 0.0, 6.0 - 4.0 * t);
            let hit = both.raycast(start, [-1.0, 0.0, -1.0]).unwrap().unwrap();
            both.paint_at(hit.point).unwrap().unwrap().color
        };
        assert_eq!((at(1.0), at(0.0)), (RED, BLUE), "{blend:?}");
        let colors: Vec<[u8; 3]> = (0..=20).map(|i| at(f64::from(i) / 20.0)).collect();
        assert!(colors.windows(2).all(|w| w[0][0] <= w[1][0] && w[0][2] >= w[1][2]), "{blend:?} {colors:?}");
        let [red, green, blue] = at(0.5);
        assert!(red.abs_diff(blue) < 6 && red > 100 && green == 0, "{blend:?} {:?}", at(0.5));
    }
    // What is painted alike is not mixed.
    let same = foot.paint(GREEN).union_with(wall.paint(GREEN), Blend::Fillet { radius: 1.0 });
    let hit = same.raycast([2.0, 0.0, 2.0], [-1.0, 0.0, -1.0]).unwrap().unwrap();
    assert_eq!(same.paint_at(hit.point).unwrap(), Some(Paint::from(GREEN)));
}

#[test]
fn paint_changes_nothing_else() {
    let plain = Solid::cuboid([4.0, 4.0, 1.0]) - Solid::cylinder(1.0, 3.0);
    let painted = Solid::cuboid([4.0, 4.0, 1.0]).paint(RED) - Solid::cylinder(1.0, 3.0).paint(BLUE);
    for i in 0..200 {
        let at = |k: f64| 5.0 * ((f64::from(i) * k).fract() - 0.5);
        let p = DVec3::new(at(0.7549), at(0.5698), at(0.4386));
        assert_eq!(plain.value(p).unwrap(), painted.value(p).unwrap());
    }
    assert_eq!(plain.bounds().unwrap(), painted.bounds().unwrap());
    assert_ne!(plain, painted);
    assert_ne!(plain.paint(RED), plain.paint(BLUE));
    assert_eq!(plain.paint(RED), plain.paint(RED));
    assert_eq!(Solid::sphere(1.0).paint(RED).to_string(), "paint #c80000, roughness 0.5\n  sphere { radius: 1.0 }");
    assert_eq!(painted.simplified(), painted);
    let palette = painted.palette().unwrap();
    assert!(palette.is_painted() && !plain.palette().unwrap().is_painted());
}

#[test]
fn errors_name_the_paint() {
    let wrong = Solid::sphere(1.0).paint(Paint { color: RED, roughness: 2.0 });
    let error = wrong.bounds().unwrap_err();
    assert!(matches!(error, SolidError::Parameter { .. }));
    assert_eq!(error.to_string(), "paint: roughness is 2, allowed: 0 to 1");
}

#[test]
fn a_mesh_carries_the_paint_of_its_owners() {
    let plate = Solid::cuboid([4.0, 4.0, 1.0]).paint(RED);
    let part = plate - Solid::cylinder(1.0, 3.0).paint(BLUE);
    let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() }).unwrap();
    let mesh = mesh.painted(&part, Paint::default()).unwrap();
    let (colors, owners) = (mesh.corner_colors().unwrap(), mesh.owners().unwrap());
    let mut blue = 0;
    for ((triangle, corners), owner) in mesh.triangles().iter().zip(colors).zip(owners) {
        let center = triangle.map(|i| mesh.positions()[i as usize]).into_iter().sum::<glam::Vec3>() / 3.0;
        // Each triangle has one colour, that of its owner; the bore is blue.
        assert!(corners.iter().all(|corner| corner == &corners[0]));
        let [r, g, b, _] = corners[0];
        assert_eq!(part.palette().unwrap().of(*owner).unwrap().color, [r, g, b]);
        let radius = center.truncate().length();
        if radius < 0.97 + 0.03 && center.z.abs() < 0.4 {
            assert_eq!([r, g, b], BLUE, "{center}");
            blue += 1;
        }
        if radius > 1.2 {
            assert_eq!([r, g, b], RED, "{center}");
        }
    }
    assert!(blue > 50, "{blue}");
    // A blend mixes corner by corner.
    let ball =
        Solid::sphere(1.0).paint(RED).smooth_union(Solid::sphere(1.0).translate([1.5, 0.0, 0.0]).paint(BLUE), 0.8);
    let mesh = ball.mesh(&MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() }).unwrap();
    let mesh = mesh.painted(&ball, Paint::default()).unwrap();
    let mixed = mesh.corner_colors().unwrap().iter().flatten().filter(|c| c[0] > 30 && c[2] > 30).count();
    assert!(mixed > 50, "{mixed}");
}
