//! Slices: pictures of fields, and contours.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rvachev::{
    Blend, Bounds, CancelToken, ContourSettings, Contours, ParamError, Plane, PlaneBounds, Polyline, Profile,
    RFunction, Run, Side, SliceSettings, Solid,
    error::RenderError,
    field::{Field, Norm, Real},
    io::{write_dxf, write_svg},
    layers::Isolines,
    rad,
};

use crate::golden::{ascii, same_as_golden};

fn ring() -> Solid {
    Solid::cylinder(2.0, 1.0) - Solid::cuboid([1.4, 1.4, 3.0])
}

#[test]
fn picture_of_a_slice() {
    let settings = SliceSettings { width: 90, ..SliceSettings::default() };
    let slice = ring().slice(&Plane::xy(0.1)).unwrap();
    same_as_golden("slice", &slice.picture(&settings).unwrap());
    let (x, y) = (Solid::half_space(-DVec3::X, 0.0), Solid::half_space(-DVec3::Y, 0.0));
    let region = PlaneBounds { min: DVec2::NEG_ONE, max: DVec2::ONE };
    let settings = SliceSettings { isolines: Isolines::Every(0.2), ..settings };
    let union = x.union(&y, RFunction::P(2.0)).slice_within(&Plane::xy(0.0), region).unwrap();
    same_as_golden("slice_r_p", &union.picture(&settings).unwrap());
    let signs = ascii(&union.values(8).unwrap(), |v| if v > 0.0 { '#' } else { '.' });
    assert_eq!(signs, "########\n########\n########\n########\n....####\n....####\n....####\n....####\n");
}

#[test]
fn pictures_of_joints_are_of_what_is_above() {
    let brick = Solid::cuboid([20.0, 20.0, 10.0]);
    let tower = brick.clone() | Solid::cylinder(5.0, 10.0).translate([0.0, 0.0, 10.0]);
    let slice = tower.slice(&Plane::xy(5.0)).unwrap();
    let picture =
        slice.picture(&SliceSettings { width: 80, isolines: Isolines::None, ..SliceSettings::default() }).unwrap();
    let at = |x: u32, y: u32| picture.pixels()[(y * picture.width() + x) as usize];
    // The post's disc is light and warm, what is about it light and cool.
    let (disc, about) = (at(40, 40), at(40, 15));
    assert!(disc[0] > 150 && disc[0] > disc[2], "{disc:?}");
    assert!(about[0] > 150 && about[0] < about[2], "{about:?}");
}

#[test]
fn contours_are_closed_oriented_and_on_the_surface() {
    let solid = ring();
    let plane = Plane::xy(0.1);
    let contours = solid.slice(&plane).unwrap().contours(1e-5).unwrap();
    assert_eq!(contours.len(), 2);
    let mut areas: Vec<f64> = contours.iter().map(Polyline::area).collect();
    areas.sort_by(f64::total_cmp);
    // The hole runs clockwise.
    assert!((areas[0] + 1.96).abs() < 1e-4, "{areas:?}");
    assert!((areas[1] - 4.0 * PI).abs() < 1e-3, "{areas:?}");
    for contour in &contours {
        assert!(contour.is_closed());
        for p in contour.points() {
            assert!(solid.value(plane.point(*p)).unwrap().abs() < 1e-9);
        }
    }
    // Straight sides need few points.
    let hole = contours.iter().find(|contour| contour.area() < 0.0).unwrap();
    assert!(hole.points().len() < 40, "{}", hole.points().len());
}

#[test]
fn contours_of_slanted_planes_and_many_pieces() {
    let grid = Solid::sphere(0.4).repeat([4, 3, 1], [1.0, 1.0, 1.0]);
    let contours = grid.slice(&Plane::new([0.0, 0.0, 0.0], [0.05, 0.03, 1.0])).unwrap().contours(1e-4).unwrap();
    assert_eq!(contours.len(), 12);
    assert!(contours.iter().all(|contour| contour.area() > 0.0));
    let cone = Solid::cone(2.0, 0.0, 4.0).slice(&Plane::xz(0.0)).unwrap().contours(1e-4).unwrap();
    assert_eq!(cone.len(), 1);
    assert!((cone[0].area() - 8.0).abs() < 1e-2, "{}", cone[0].area());
}

#[test]
fn contours_end_at_the_region() {
    let wall = Solid::half_space(DVec3::X, 0.3);
    let region = PlaneBounds { min: DVec2::ZERO, max: DVec2::ONE };
    let contours = wall.slice_within(&Plane::xy(0.0), region).unwrap().contours(1e-6).unwrap();
    assert_eq!(contours.len(), 1);
    assert!((contours[0].area() - 0.3).abs() < 1e-5);
    let all = Solid::half_space(DVec3::X, 9.0).slice_within(&Plane::xy(0.0), region).unwrap();
    assert!((all.contours(1e-6).unwrap()[0].area() - 1.0).abs() < 1e-5);
    let none = Solid::half_space(DVec3::X, -9.0).slice_within(&Plane::xy(0.0), region).unwrap();
    assert!(none.contours(1e-6).unwrap().is_empty());
}

#[test]
fn drawings() {
    let contours = ring().slice(&Plane::xy(0.1)).unwrap().contours(1e-3).unwrap();
    let (mut svg, mut dxf) = (Vec::new(), Vec::new());
    write_svg(&contours, &mut svg).unwrap();
    write_dxf(&contours, &mut dxf).unwrap();
    let (svg, dxf) = (String::from_utf8(svg).unwrap(), String::from_utf8(dxf).unwrap());
    assert_eq!(svg.matches('Z').count(), 2);
    assert_eq!(dxf.matches("\nPOLYLINE\n").count(), 2);
    let points: usize = contours.iter().map(|contour| contour.points().len()).sum();
    assert_eq!(dxf.matches("\nVERTEX\n").count(), points);
    let mut nothing = Vec::new();
    write_svg(&[], &mut nothing).unwrap();
    assert!(nothing.ends_with(b"</svg>\n"));
    let path = std::env::temp_dir().join(format!("rvachev-drawing-{}.dxf", std::process::id()));
    Polyline::save_all(&contours, &path).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), dxf);
    std::fs::remove_file(path).unwrap();
    assert!(Polyline::save_all(&contours, "a.pdf").unwrap_err().to_string().ends_with("known: .dxf, .svg"));
}

#[test]
fn errors() {
    let ball = Solid::sphere(1.0);
    let slice = ball.slice(&Plane::xy(0.0)).unwrap();
    let message = |e: rvachev::error::RenderError| e.to_string();
    assert!(message(slice.contours(0.0).unwrap_err()).starts_with("tolerance is 0"));
    assert!(message(slice.values(0).unwrap_err()).starts_with("width is 0"));
    let settings = SliceSettings { isolines: Isolines::Every(-1.0), ..SliceSettings::default() };
    assert!(message(slice.picture(&settings).unwrap_err()).starts_with("isolines is -1"));
    let across_nothing = message(ball.slice(&Plane::new(DVec3::ZERO, DVec3::ZERO)).unwrap_err());
    assert!(across_nothing.starts_with("plane is through [0, 0, 0] across ["), "{across_nothing}");
    let flat = PlaneBounds { min: DVec2::ZERO, max: DVec2::X };
    let flat = message(ball.slice_within(&Plane::xy(0.0), flat).unwrap_err());
    assert!(flat.starts_with("region is [0, 0] to [1, 0]; allowed: "), "{flat}");
    assert!(ball.complement().slice(&Plane::xy(0.0)).is_err());
    let nothing = ball.slice(&Plane::xy(5.0)).unwrap();
    assert!(nothing.contours(1e-3).unwrap().is_empty());
}

#[test]
fn drawings_of_points_that_are_not_finite_are_errors() {
    let lines =
        [Polyline::open(vec![DVec2::ZERO, DVec2::X]), Polyline::open(vec![DVec2::ONE, DVec2::new(2.0, f64::NAN)])];
    let (mut svg, mut dxf) = (Vec::new(), Vec::new());
    let errors = [write_svg(&lines, &mut svg), write_dxf(&lines, &mut dxf)];
    for error in errors {
        let text = error.unwrap_err().to_string();
        assert_eq!(text, "polyline 1: point 1 is (2, NaN); both coordinates must be finite, and within ±1e300");
    }
    assert!(svg.is_empty() && dxf.is_empty());
}

/// Contours on a plane at a height.
fn cut(solid: &Solid, z: f64, tolerance: f64) -> Contours {
    solid.slice(&Plane::xy(z)).unwrap().contours(tolerance).unwrap()
}

#[test]
fn all_holes_of_a_perforated_plate_are_found() {
    let holes = Solid::cylinder(1.5, 20.0).repeat([58, 38, 1], [10.0, 10.0, 1.0]).translate([-285.0, -185.0, 0.0]);
    let plate = Solid::cuboid([600.0, 400.0, 2.0]) - holes;
    let contours = cut(&plate, 0.0, 0.01);
    assert_eq!((contours.len(), contours.unresolved()), (1 + 58 * 38, 0));
    let want = 600.0 * 400.0 - 2204.0 * PI * 2.25;
    assert!((contours.area() - want).abs() < 0.01 * 2204.0 * 3.0 * PI, "{} of {want}", contours.area());
    let outlines = contours.outlines();
    assert_eq!((outlines.len(), outlines[0].holes.len()), (1, 2204));
    // Of a circle that many points make chords that are off by the tolerance.
    let least = PI / (1.0 - 0.01 / 1.5_f64).acos();
    let points: usize = contours.iter().map(|line| line.points().len()).sum();
    assert!(points as f64 / 2204.0 < 1.75 * least, "{points} points");
}

#[test]
fn a_hole_is_found_wherever_it_is() {
    for i in 0..40 {
        let at = [f64::from(i) * 7.123 - 140.0, f64::from(i) * 3.777 - 75.0, 0.0];
        let plate = Solid::cuboid([600.0, 400.0, 2.0]) - Solid::cylinder(1.5, 20.0).translate(at);
        assert_eq!(cut(&plate, 0.0, 0.01).len(), 2, "{i}");
    }
}

#[test]
fn a_turned_slot_is_one_hole() {
    let slot = Profile::rectangle([600.0, 400.0]) - Profile::rectangle([500.0, 1.5]).rotate(rvachev::rad(0.3));
    let contours = cut(&slot.extrude(1.0), 0.0, 0.01);
    assert_eq!((contours.len(), contours.unresolved()), (2, 0));
    assert!((contours.area() - (240_000.0 - 750.0)).abs() < 1.0, "{}", contours.area());
    // Straight sides and sharp corners need no points but those at the corners.
    assert!(contours.iter().all(|line| line.points().len() == 4), "{contours:?}");
}

#[test]
fn what_is_above_a_joint_counts_or_what_is_below() {
    let tower = Solid::cuboid([20.0, 20.0, 10.0]) | Solid::cuboid([20.0, 20.0, 10.0]).translate([0.0, 0.0, 10.0]);
    let contours = cut(&tower, 5.0, 1e-3);
    assert_eq!((contours.len(), contours.unresolved()), (1, 0));
    assert!((contours.area() - 400.0).abs() < 1e-6, "{}", contours.area());
    let plate = Solid::cuboid([40.0, 30.0, 4.0]) | Solid::cylinder(5.0, 20.0).translate([0.0, 0.0, 12.0]);
    let slice = plate.slice(&Plane::xy(2.0)).unwrap();
    let of = |side| {
        let settings = ContourSettings { side, ..ContourSettings::default() };
        slice.contours_with(&settings, &Run::default()).unwrap().area()
    };
    assert!((of(Side::Above) - 25.0 * PI).abs() < 0.05, "{}", of(Side::Above));
    assert!((of(Side::Below) - 1200.0).abs() < 1e-6, "{}", of(Side::Below));
}

/// In the neck of a smooth join no direction leads into both parts, but the contour is smooth.
#[test]
fn smooth_joins_have_smooth_contours() {
    let ball = |x: f64| Solid::sphere(1.0).translate([x, 0.0, 0.0]);
    let neck = ball(-1.05).union_with(ball(1.05), Blend::Smooth { radius: 0.5 });
    let post = Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::cylinder(0.5, 2.0), Blend::Smooth { radius: 0.15 });
    for (solid, z) in [(neck, 0.1), (post, 0.25)] {
        let contours = cut(&solid, z, 1e-4);
        assert_eq!((contours.len(), contours.unresolved()), (1, 0));
    }
}

#[test]
fn parts_that_touch_have_one_contour_about_them() {
    let c = Solid::cuboid([10.0; 3]);
    let beside = |by: [f64; 3]| c.clone() | c.translate(by);
    for turn in [0.0, 0.3, 1.1] {
        let turned = |solid: Solid| cut(&solid.rotate_z(rvachev::rad(turn)), 1.0, 1e-3);
        let two = turned(beside([10.0, 0.0, 0.0]));
        assert_eq!((two.len(), two.unresolved()), (1, 0), "{turn}");
        assert!((two.area() - 200.0).abs() < 1e-2, "{turn}: {}", two.area());
        let aside = turned(beside([10.0, 4.0, 0.0]));
        assert_eq!((aside.len(), aside.unresolved()), (1, 0), "{turn}");
        assert!((aside.area() - 200.0).abs() < 1e-2, "{turn}: {}", aside.area());
    }
    // What is plugged with what was cut out of it is whole.
    let plug = Solid::cylinder(3.0, 10.0);
    let plugged = (c.clone() - plug.clone()) | plug;
    let contours = cut(&plugged, 1.0, 1e-3);
    assert_eq!(contours.len(), 1);
    assert!((contours.area() - 100.0).abs() < 1e-2, "{}", contours.area());
}

#[test]
fn a_stack_of_slices_is_the_slices() {
    let part = (Solid::cuboid([20.0, 14.0, 8.0]) - Solid::sphere(5.0).translate([4.0, 2.0, 3.0]))
        | Solid::cone(4.0, 1.0, 9.0).translate([-5.0, 0.0, 6.0]);
    let heights: Vec<f64> = (0..37).rev().map(|layer| -4.5 + 0.41 * f64::from(layer)).collect();
    let stack = part.slices(&heights, &ContourSettings::default(), &Run::default()).unwrap();
    for (height, layer) in heights.iter().zip(&stack) {
        let alone = cut(&part, *height, 1e-3);
        assert_eq!((layer.len(), layer.unresolved()), (alone.len(), alone.unresolved()), "{height}");
        assert!((layer.area() - alone.area()).abs() < 0.1, "{height}: {} {}", layer.area(), alone.area());
    }
    let wrong = part.slices(&[0.0, f64::NAN], &ContourSettings::default(), &Run::default());
    assert_eq!(wrong.unwrap_err().to_string(), "heights is NaN; allowed: finite");
    let run = Run::default();
    run.cancel.cancel();
    assert!(part.slices(&heights, &ContourSettings::default(), &run).is_err());
}

/// A plane far away changes nothing on the others.
#[test]
fn far_planes_of_a_stack_are_empty() {
    let part = Solid::cuboid([4.0, 4.0, 2.0]) - Solid::cylinder(1.0, 4.0);
    let area = |heights: &[f64]| {
        let layers = part.slices(heights, &ContourSettings::default(), &Run::default()).unwrap();
        layers.iter().map(Contours::area).collect::<Vec<_>>()
    };
    let own = area(&[0.0])[0];
    for far in [-1e13, -1e9, 1e5, 1e200, f64::MAX] {
        assert_eq!(area(&[far, 0.0]), [0.0, own], "{far}");
        assert_eq!(area(&[far]), [0.0], "{far}");
    }
    let cancel = CancelToken::new();
    cancel.cancel();
    let run = Run { cancel, ..Run::default() };
    for heights in [&[][..], &[0.0], &[1e9]] {
        let cancelled = part.slices(heights, &ContourSettings::default(), &run);
        assert!(matches!(cancelled, Err(RenderError::Cancelled(_))), "{heights:?}: {cancelled:?}");
    }
    // No planes cut whatever there is.
    let half = Solid::half_space([0.0, 0.0, 1.0], 0.0);
    assert_eq!(half.slices(&[], &ContourSettings::default(), &Run::default()).unwrap(), []);
}

#[test]
fn slices_of_lengths_have_all_contours() {
    let shell = (Solid::cuboid([20.0, 14.0, 8.0]) | Solid::cylinder(5.0, 14.0)).shell(1.0);
    let contours = cut(&shell, 0.5, 1e-2);
    assert_eq!(contours.outlines().len(), 1);
    assert_eq!(contours.len(), 2);
}

/// Ranges tell all of the contour, samples nothing: these would count.
#[test]
fn contours_of_lengths_and_blends_are_told_by_ranges() {
    let block = Solid::cuboid([20.0, 14.0, 8.0]) | Solid::cylinder(5.0, 14.0);
    let cushion = Solid::superellipsoid([30.0, 20.0, 10.0], 0.3, 0.4);
    let plate = Solid::cuboid([2.0, 2.0, 0.4]);
    let (post, round) = (Solid::cylinder(0.5, 2.0), Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7));
    let (fillet, chamfer) = (Blend::Fillet { radius: 0.15 }, Blend::Chamfer { leg: 0.15 });
    let holes = Solid::cylinder(0.3, 4.0).repeat([4, 3, 1], [1.5, 1.5, 1.0]);
    let circle = |radius: f64| PI * radius * radius;
    // The surface of the fillet at .25: .1 below the ball's centre, .65 from the axis.
    let of_fillet = circle(0.65 - (0.15f64.powi(2) - 0.1f64.powi(2)).sqrt());
    let rows: [(Solid, f64, f64, Option<f64>); 12] = [
        (block.shell(1.0), 0.5, 1e-3, Some(280.0 - 18.0 * 12.0)),
        (block.offset(1.0), 0.5, 1e-3, Some(22.0 * 16.0 - 4.0 + PI)),
        (block.rounded(1.0), 0.5, 1e-3, Some(280.0 - 4.0 + PI)),
        (block.filleted(1.0), 0.5, 1e-3, Some(280.0)),
        (cushion.shell(1.0), 0.1, 1e-3, None),
        (cushion.rounded(1.0), 0.1, 1e-3, None),
        (cushion.twist(rad(0.02)).shell(1.0), 0.1, 1e-3, None),
        ((Solid::cuboid([8.0, 6.0, 2.0]) - holes).offset(0.1), 0.5, 1e-3, None),
        (plate.union_with(&post, fillet), 0.25, 1e-4, Some(of_fillet)),
        (plate.union_with(&round, fillet), 0.25, 1e-4, None),
        (plate.union_with(&round, chamfer), 0.25, 1e-4, None),
        (Solid::sphere(1.0).union_with(cushion.scale(0.05), Blend::Ricci { p: 4.0 }), 0.05, 1e-3, None),
    ];
    for (number, (solid, height, tolerance, area)) in rows.iter().enumerate() {
        let contours = cut(solid, *height, *tolerance);
        assert_eq!(contours.unresolved(), 0, "row {number}: {} lines", contours.len());
        let area = area.unwrap_or(contours.area());
        let length: f64 = contours.iter().map(Polyline::length).sum();
        let off = tolerance + solid.accuracy().unwrap().error;
        assert!((contours.area() - area).abs() < off * length, "row {number}: {} {area}", contours.area());
    }
}

/// Planes in faces that lengths are measured to, and just beside them.
#[test]
fn planes_in_and_beside_measured_faces_are_told() {
    let tower = Solid::cuboid([2.0, 1.6, 1.0]) | Solid::cuboid([0.7, 0.7, 2.0]).translate([0.4, 0.2, 0.3]);
    let shell = tower.shell(0.05);
    // The roof of the cavity is at 1.25.
    for (height, area) in [(1.25, 0.49), (1.247, 0.13), (1.249, 0.13), (1.2497, 0.13)] {
        let contours = cut(&shell, height, 1e-3);
        assert_eq!(contours.unresolved(), 0, "at {height}");
        assert!((contours.area() - area).abs() < 1e-4, "at {height}: {}", contours.area());
    }
    let box_moved_out =
        Profile::polygon([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]).extrude(1.0).offset(0.08);
    let contours = cut(&box_moved_out, 0.01, 1e-3);
    assert_eq!(contours.unresolved(), 0);
    assert!((contours.area() - (4.64 + PI * 0.0064)).abs() < 1e-3, "{}", contours.area());
    // Beside the corners of a hexagon's hole its inner face is out of sight.
    let hole = Profile::regular_polygon(6, 1.0).extrude(1.0);
    let contours = cut(&(Solid::cuboid([3.0, 3.0, 0.7]) - hole).shell(0.08), 0.0137, 1e-2);
    assert_eq!(contours.unresolved(), 0);
    // The floor of a bottle's cavity is at -3.6: on it, feet leap from the floor to the wall.
    let bottle = (Solid::cylinder(5.5, 9.0) | Solid::cylinder(2.5, 6.0).translate([0.0, 0.0, 6.0])).shell(0.9);
    for height in [-3.6, -3.5999, -3.599, -3.59] {
        let contours = cut(&bottle, height, 1e-3);
        assert_eq!(contours.unresolved(), 0, "at {height}");
        let area = PI * (5.5f64.powi(2) - 4.6f64.powi(2));
        assert!((contours.area() - area).abs() < 1e-3, "at {height}: {}", contours.area());
    }
    // A fillet leaves a face at no angle: on it some squares are told by samples.
    let (plate, fillet) = (Solid::cuboid([2.0, 1.6, 1.0]), Blend::Fillet { radius: 0.15 });
    let post = plate.union_with(Solid::cylinder(0.4, 2.4), fillet);
    assert_eq!(cut(&post, 0.501, 1e-3).unresolved(), 0);
    let unresolved = cut(&post, 0.5, 1e-3).unresolved();
    assert!(unresolved < 1500, "{unresolved}");
}

/// Patches of a fillet's ball are of the region about the joint alone: beyond it the ball's sign changes
/// where none is near, and that is seen.
#[test]
fn beyond_the_region_of_a_fillet_its_sign_is_seen() {
    let body = Solid::cuboid([1.4, 1.0, 1.2]).taper(0.3, -0.2, 1.2);
    let bore = Solid::cylinder(0.35, 1.0).translate([0.1, -0.1, 0.4]);
    let part = body.difference_with(bore, Blend::Fillet { radius: 0.03 });
    let normal = DVec3::new(-0.04016461081796307, 0.53483160548194, 0.8440035295041434);
    let plane = Plane::new(DVec3::new(0.1, 0.05, 0.11512422438297754), normal);
    for tolerance in [1e-2, 1e-3] {
        let contours = part.slice(&plane).unwrap().contours(tolerance).unwrap();
        assert_eq!((contours.len(), contours.unresolved()), (1, 0));
    }
}

/// The face of a chamfer jumps where an operand's normal does: the contour goes along the jump.
#[test]
fn contours_follow_the_jumps_of_chamfers() {
    let rod = Solid::cylinder(0.8, 1.4).rotate_y(rad(1.0));
    let part = Solid::cuboid([2.0, 1.6, 1.0]).intersection_with(rod, Blend::Chamfer { leg: 0.15 });
    let contours = cut(&part, 0.03, 1e-3);
    // Points of a grid about it that are inside and outside, and not near the contour.
    for i in -12..=12 {
        for j in -12..=12 {
            let p = DVec2::new(0.7964 + 5e-4 * f64::from(i), -0.6727 + 5e-4 * f64::from(j));
            let edges = contours.iter().flat_map(Polyline::edges);
            let off = edges.map(|[a, b]| {
                let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                p.distance(a.lerp(b, t))
            });
            let is_near = off.fold(f64::INFINITY, f64::min) < 1.5e-3;
            let is_inside = part.contains([p.x, p.y, 0.03]).unwrap();
            assert!(is_near || is_within(&contours, p) == is_inside, "{p}");
        }
    }
}

/// A ball whose slopes no range tells.
#[derive(Debug)]
struct Rough;

impl Field for Rough {
    fn name(&self) -> &'static str {
        "rough"
    }
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        // The root of a difference of all but equal numbers has any slope, as far as ranges tell.
        -x.norm(y, Norm::Euclid).norm(z, Norm::Euclid) + 1.0 + (x * x - x * x * (1.0 + 1e-12)).abs().sqrt()
    }
    fn bounds(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::splat(1.0))
    }
    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
    fn convex(&self) -> bool {
        false
    }
}

#[test]
fn what_only_samples_show_is_told() {
    let contours = cut(&Solid::new(Rough), 0.3, 1e-4);
    assert_eq!(contours.len(), 1);
    assert!((contours.area() - PI * 0.91).abs() < 1e-2, "{}", contours.area());
    // And not halved for long.
    assert!((100..50_000).contains(&contours.unresolved()), "{}", contours.unresolved());
}

/// Whether a point is within contours, by the even-odd rule.
fn is_within(contours: &Contours, p: DVec2) -> bool {
    let crosses =
        |[a, b]: [DVec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    contours.iter().flat_map(Polyline::edges).filter(|edge| crosses(*edge)).count() % 2 == 1
}

/// What is wrong with the contours of a solid on a plane: points of a grid that are on another side
/// than the field says, although it says so all around, as far as contours may be off.
fn wrong(solid: &Solid, plane: &Plane, part: f64) -> Option<String> {
    const POINTS: u32 = 24;
    let slice = solid.slice(plane).unwrap();
    let PlaneBounds { min, max } = slice.region();
    let tolerance = part * (max - min).max_element();
    let contours = slice.contours(tolerance).unwrap();
    let inside = |p: DVec2| solid.contains(plane.point(p)).unwrap();
    let mut off = 0;
    let mut first = None;
    for i in 0..POINTS {
        for j in 0..POINTS {
            let p = min + (max - min) * (DVec2::new(f64::from(i), f64::from(j)) + 0.37) / f64::from(POINTS);
            let here = inside(p);
            if here == is_within(&contours, p) {
                continue;
            }
            let around = |k: u32| inside(p + 1.5 * tolerance * DVec2::from_angle(f64::from(k) * 0.785));
            if (0..8).all(|k| around(k) == here) {
                off += 1;
                first = first.or(Some(p));
            }
        }
    }
    // Points are on the surface: both signs are near, be it in a tip that is thin.
    let astray = |p: &DVec2| {
        let beside = |k: u32| f64::from(k % 12 + 1) / 12.0 * DVec2::from_angle(f64::from(k) * 0.1);
        let (low, high) = (min + 2.0 * tolerance, max - 2.0 * tolerance);
        let within = p.cmpgt(low).all() && p.cmplt(high).all();
        let mut all = (0..756).map(|k| inside(*p + 1.5 * tolerance * beside(k)));
        let first = inside(*p);
        within && all.all(|other| other == first)
    };
    let points = || contours.iter().flat_map(|line| line.points());
    let astray = points().step_by(points().count().div_ceil(100).max(1)).filter(|p| astray(p)).count();
    let text = || format!("{off} points, first {first:?}; {astray} astray; {} undecided", contours.unresolved());
    (off > 0 || astray > 0).then(text)
}

#[test]
fn contours_of_every_kind_are_where_the_sign_changes() {
    let mut failures = Vec::new();
    for (i, (name, solid)) in crate::queries::whole_catalogue().into_iter().enumerate() {
        let bounds = solid.bounds().unwrap();
        let planes = [
            ("across", Plane::new(bounds.center() + 0.013 * bounds.size(), [0.02, -0.03, 1.0])),
            ("level", Plane::xy(bounds.center().z + 0.21 * bounds.size().z)),
            ("upright", Plane::xz(bounds.center().y + 0.05 * bounds.size().y)),
        ];
        // One plane of each solid, by turns; all of them take three times as long.
        let (what, plane) = &planes[i % planes.len()];
        if let Some(text) = wrong(&solid, plane, 1e-3) {
            failures.push(format!("{name}, {what}: {text}"));
        }
    }
    assert!(failures.is_empty(), "{}:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn grooves_in_a_joint_are_found() {
    let left = Solid::cuboid([10.0, 10.0, 4.0]);
    for i in 0..30 {
        let (y, w) = (-4.3 + 0.277 * f64::from(i), 0.3);
        let right = Profile::polygon([
            [5.0, -5.0],
            [15.0, -5.0],
            [15.0, 5.0],
            [5.0, 5.0],
            [5.0, y + w],
            [5.0 + 0.4 * w, y + 0.5 * w],
            [5.0, y],
        ]);
        let contours = cut(&(left.clone() | right.extrude(4.0)), 0.5, 1e-3);
        assert_eq!(contours.len(), 2, "{i}");
    }
}

#[test]
fn what_is_wider_than_the_tolerance_is_found() {
    let hole = |i: u32| {
        let at = [f64::from(i) * 0.173 - 3.0, f64::from(i) * 0.119 - 2.0, 0.0];
        Solid::cuboid([10.0, 10.0, 2.0]) - Solid::cylinder(0.0055, 3.0).translate(at)
    };
    for i in 0..30 {
        assert_eq!(cut(&hole(i), 0.1, 0.01).len(), 2, "{i}");
    }
}

#[test]
fn stacks_of_many_contours_are_whole() {
    let holes = Solid::cylinder(0.3, 9.0).repeat([40, 40, 1], [1.0, 1.0, 1.0]).translate([-19.5, -19.5, 0.0]);
    let plate = Solid::cuboid([40.0, 40.0, 4.0]) - holes;
    let heights: Vec<f64> = (0..30).map(|layer| -1.9 + 0.12 * f64::from(layer)).collect();
    let layers = plate.slices(&heights, &ContourSettings { tolerance: 0.01, ..Default::default() }, &Run::default());
    for (height, layer) in heights.iter().zip(layers.unwrap()) {
        assert_eq!((layer.len(), layer.unresolved()), (1601, 0), "{height}");
    }
}

#[test]
fn slices_tell_how_far_they_are() {
    let told = std::sync::Arc::new(std::sync::Mutex::new(Vec::new()));
    let to = told.clone();
    let progress = rvachev::Progress::new(move |part| to.lock().unwrap().push(part));
    let run = Run { threads: 1, progress: Some(progress), ..Run::default() };
    let holes = Solid::cylinder(0.3, 9.0).repeat([20, 20, 1], [1.0, 1.0, 1.0]);
    let plate = Solid::cuboid([40.0, 40.0, 4.0]) - holes;
    plate.slice(&Plane::xy(0.0)).unwrap().contours_with(&ContourSettings::default(), &run).unwrap();
    let told = told.lock().unwrap();
    assert!(told.len() > 10 && told.windows(2).all(|pair| pair[0] <= pair[1]) && told.last() == Some(&1.0), "{told:?}");
}
