//! Paint on what lengths, fillets and chamfers make.

use glam::{DQuat, DVec3};
use rvachev::{Background, Blend, Camera, CellSize, MeshSettings, Paint, RenderSettings, Solid, Style, deg, rad};

use super::{BLUE, GREEN, RED, color};

/// A pebble: its value is no distance.
fn pebble(at: f64) -> Solid {
    Solid::superellipsoid([1.2, 0.8, 0.6], 0.7, 0.7).translate([at, 0.0, 0.0])
}

/// Two pebbles side by side, red on the left and blue on the right.
fn pebbles() -> Solid {
    pebble(-0.9).paint(RED) | pebble(0.9).paint(BLUE)
}

/// A block of two halves, red where x < 0 and blue where x > 0.
fn block() -> Solid {
    let half = |x: f64| Solid::cuboid([2.0, 2.0, 2.0]).translate([x, 0.0, 0.0]);
    half(-1.0).paint(RED) | half(1.0).paint(BLUE)
}

/// Where a ray first meets a solid.
#[track_caller]
fn hit(solid: &Solid, from: DVec3, direction: DVec3) -> DVec3 {
    solid.raycast(from, direction).unwrap().unwrap().point
}

/// Fails unless a solid is red where it is hit from the left and blue from the right, in the
/// coordinates that `map` leads out of.
#[track_caller]
fn is_red_and_blue(solid: &Solid, map: impl Fn(DVec3) -> DVec3) {
    for (x, expected) in [(-1.0, RED), (1.0, BLUE)] {
        for [y, z] in [[0.1, 0.05], [0.4, 0.2], [-0.3, -0.3]] {
            for towards in [DVec3::X * -x, DVec3::Y, -DVec3::Z] {
                let target = DVec3::new(x, y, z);
                let (from, to) = (map(target - 9.0 * towards), map(target));
                let p = hit(solid, from, to - from);
                assert_eq!(color(solid, p.to_array()), Some(expected), "{target} along {towards}");
            }
        }
    }
}

#[test]
fn offsets_have_the_colours_beneath() {
    for by in [0.3, 0.02, -0.1] {
        is_red_and_blue(&pebbles().offset(by), |p| p);
    }
    is_red_and_blue(&block().offset(-0.2), |p| p);
}

#[test]
fn offsets_of_one_paint_have_that_paint() {
    let red = pebble(0.0).paint(RED).offset(0.2);
    let owner = red.owner([1.4, 0.0, 0.0]).unwrap();
    assert_eq!(red.palette().unwrap().of(owner.index), Some(Paint::from(RED)));
    let plain = (pebble(-0.9) | pebble(0.9)).offset(0.2);
    assert_eq!(color(&plain, [2.3, 0.0, 0.0]), None);
    assert!(!plain.palette().unwrap().is_painted());
    // Of several paints there is none that the whole leaf has.
    let both = pebbles().offset(0.2);
    let owner = both.owner([2.3, 0.0, 0.0]).unwrap();
    let palette = both.palette().unwrap();
    assert!(palette.is_painted());
    assert_eq!(palette.of(owner.index), None);
}

#[test]
fn a_part_without_paint_has_none_on_the_offset() {
    let half = (pebble(-0.9) | pebble(0.9).paint(BLUE)).offset(0.2);
    assert_eq!(color(&half, hit(&half, DVec3::X * -9.0, DVec3::X).to_array()), None);
    assert_eq!(color(&half, hit(&half, DVec3::X * 9.0, -DVec3::X).to_array()), Some(BLUE));
}

#[test]
fn the_inner_wall_of_a_shell_has_the_colour_of_the_nearest_outer_face() {
    let shell = block().shell(0.2);
    for (p, expected) in [
        ([-2.0, 0.3, 0.1], RED),
        ([2.0, 0.3, 0.1], BLUE),
        ([-1.8, 0.3, 0.1], RED),
        ([1.8, 0.3, 0.1], BLUE),
        ([-0.1, 0.8, 0.1], RED),
        ([0.1, 0.8, 0.1], BLUE),
        ([0.7, 0.3, -0.8], BLUE),
    ] {
        assert_eq!(color(&shell, p), Some(expected), "{p:?}");
    }
    // A bore of another colour has a wall of its own colour around it.
    let bored = (block().paint(GREEN) - Solid::cylinder(0.3, 4.0).paint(RED)).shell(0.2);
    assert_eq!(color(&bored, [0.5, 0.0, 0.1]), Some(RED));
    let plate = Solid::cuboid([4.0, 4.0, 2.0]).paint(BLUE) - Solid::cylinder(1.0, 3.0).paint(RED);
    assert_eq!(color(&plate.shell(0.2), [1.2, 0.0, 0.0]), Some(RED));
    assert_eq!(color(&bored, [1.8, 0.0, 0.1]), Some(GREEN));
}

#[test]
fn rounded_edges_have_the_colours_of_their_faces() {
    let round = block().rounded(0.3);
    let edge = |x: f64| hit(&round, DVec3::new(x, 9.0, 8.9), DVec3::new(0.0, -1.0, -1.0));
    assert!(edge(1.0).y < 0.98);
    for (x, expected) in [(-1.0, RED), (-0.1, RED), (0.1, BLUE), (1.0, BLUE)] {
        assert_eq!(color(&round, edge(x).to_array()), Some(expected), "{x}");
        assert_eq!(color(&round, [x, 0.1, 1.0]), Some(expected), "{x}");
    }
    // A groove between two painted banks, filled.
    let banks = (Solid::cuboid([2.0, 2.0, 1.0]).translate([-1.0, 0.0, 0.0]).paint(RED)
        | Solid::cuboid([2.0, 2.0, 2.0]).translate([1.0, 0.0, 0.5]).paint(BLUE))
    .filleted(0.4);
    let line = |t: f64| {
        let start = DVec3::new(-1.2 + t, 0.1, 1.7 + t);
        color(&banks, hit(&banks, start, DVec3::new(1.0, 0.0, -1.0)).to_array())
    };
    assert_eq!((line(-0.2), line(0.2)), (Some(RED), Some(BLUE)));
}

/// The colours along the transition of two parts, from the first to the second.
fn between(solid: &Solid, [start, end]: [DVec3; 2], direction: DVec3) -> Vec<[u8; 3]> {
    let at = |i: i32| hit(solid, start.lerp(end, f64::from(i) / 20.0), direction);
    (0..=20).map(|i| color(solid, at(i).to_array()).unwrap()).collect()
}

#[test]
fn fillets_and_chamfers_go_from_one_colour_to_the_other() {
    let plate = Solid::cuboid([6.0, 6.0, 1.0]).paint(RED);
    let post = Solid::cuboid([2.0, 2.0, 6.0]).paint(BLUE);
    // From a point of the plate to one of the post; for what is cut away, from a face of the plate
    // to the wall of the hole.
    let corner = [DVec3::new(5.0, 0.1, 3.0), DVec3::new(3.0, 0.1, 5.0)];
    let slab = Solid::cuboid([14.0, 14.0, 3.0]).translate([0.0, 0.0, -1.0]).paint(RED);
    let rim = [DVec3::new(0.5, 0.1, 3.4), DVec3::new(0.5, 0.1, 1.1)];
    let direction = DVec3::new(-1.0, 0.0, -1.0);
    for blend in [Blend::Fillet { radius: 0.8 }, Blend::Chamfer { leg: 0.8 }] {
        let cases = [(plate.union_with(&post, blend), corner), (slab.difference_with(&post, blend), rim)];
        for (solid, ends) in cases {
            let colors = between(&solid, ends, direction);
            assert!(colors.contains(&RED) && colors.contains(&BLUE), "{blend:?} {colors:?}");
            let mixed = colors.iter().filter(|[red, _, blue]| *red > 60 && *blue > 60).count();
            assert!(mixed > 1, "{blend:?} {colors:?}");
            assert!(colors.windows(2).all(|w| w[0][0] >= w[1][0] && w[0][2] <= w[1][2]), "{blend:?} {colors:?}");
        }
        let filled = plate.union_with(&post, blend);
        let middle = hit(&filled, DVec3::new(4.0, 0.1, 3.5), DVec3::new(-1.0, 0.0, -1.0));
        let [red, green, blue] = color(&filled, middle.to_array()).unwrap();
        assert!(red.abs_diff(blue) < 12 && red > 100 && green == 0, "{blend:?} {red} {green} {blue}");
        for (p, expected) in [([2.6, 0.1, 0.5], RED), ([1.0, 0.1, 2.6], BLUE)] {
            assert_eq!(color(&filled, p), Some(expected), "{blend:?}");
        }
        // Painted alike, or painted over, there is nothing to mix.
        let same = plate.paint(GREEN).union_with(post.paint(GREEN), blend);
        let over = filled.paint(GREEN);
        assert_eq!([&same, &over].map(|solid| color(solid, middle.to_array())), [Some(GREEN); 2], "{blend:?}");
    }
}

#[test]
fn the_second_of_two_close_fillets_takes_no_colour_of_the_third_part() {
    let plate = Solid::cuboid([8.0, 3.0, 1.0]).paint(RED);
    let post = |x: f64| Solid::cylinder(0.4, 4.0).translate([x, 0.0, 1.0]);
    let all =
        Solid::union_all_with([plate, post(-2.0).paint(BLUE), post(2.0).paint(GREEN)], Blend::Fillet { radius: 0.4 });
    let foot = hit(&all, DVec3::new(3.5, 0.0, 1.6), DVec3::new(-1.0, 0.0, -1.0));
    let [red, green, blue] = color(&all, foot.to_array()).unwrap();
    assert!(red > 60 && green > 60 && blue == 0, "{red} {green} {blue}");
}

#[test]
fn lengths_of_lengths_have_the_colours_at_the_bottom() {
    is_red_and_blue(&pebbles().offset(0.2).offset(-0.1), |p| p);
    is_red_and_blue(&pebbles().offset(-0.05).rounded(0.1).offset(0.1), |p| p);
    let shell = pebbles().offset(0.1).shell(0.2);
    is_red_and_blue(&shell, |p| p);
    // From the inside.
    let wall = hit(&shell, DVec3::new(-1.0, 0.0, 0.0), -DVec3::X);
    assert_eq!(color(&shell, wall.to_array()), Some(RED));
    let fillet = Blend::Fillet { radius: 0.3 };
    let bridge = pebble(-0.9).paint(RED).union_with(pebble(0.9).paint(BLUE), fillet);
    is_red_and_blue(&bridge.offset(-0.05), |p| p);
    // The offset of a fillet is mixed where the fillet is.
    let grown = bridge.offset(0.05);
    let [red, _, blue] = color(&grown, hit(&grown, DVec3::Z * 9.0, -DVec3::Z).to_array()).unwrap();
    assert!(red.abs_diff(blue) < 12 && red > 100, "{red} {blue}");
}

#[test]
fn the_paint_on_top_of_a_length_shows() {
    for painted in [
        pebbles().offset(0.2).paint(GREEN),
        pebbles().offset(0.1).paint(GREEN).offset(0.1),
        pebbles().paint(GREEN).offset(0.2),
        pebbles().shell(0.1).paint(GREEN),
        block().rounded(0.2).paint(GREEN),
    ] {
        for direction in [DVec3::X, -DVec3::X, DVec3::new(1.0, 1.0, 1.0)] {
            let p = hit(&painted, -9.0 * direction, direction);
            assert_eq!(color(&painted, p.to_array()), Some(GREEN), "{painted}");
        }
    }
    // The same length painted and not painted.
    let length = pebbles().offset(0.2);
    let two = length.translate([0.0, 0.0, 5.0]) | length.paint(GREEN);
    assert_eq!(color(&two, hit(&two, DVec3::X * 9.0, -DVec3::X).to_array()), Some(GREEN));
    let above = DVec3::new(9.0, 0.0, 5.0);
    assert_eq!(color(&two, hit(&two, above, -DVec3::X).to_array()), Some(BLUE));
}

#[test]
fn colours_move_with_what_is_placed() {
    let by = DVec3::new(3.0, -2.0, 5.0);
    for length in [pebbles().offset(0.2), block().rounded(0.2)] {
        let placed = length.rotate_z(deg(120.0)).scale(2.5).translate(by);
        let turn = DQuat::from_rotation_z(deg(120.0).radians());
        is_red_and_blue(&placed, |p| turn * p * 2.5 + by);
        is_red_and_blue(&length.reflect_x().rotate_y(deg(180.0)), |p| DVec3::new(p.x, p.y, -p.z));
    }
    // Placed below a length as well.
    let placed = pebbles().offset(0.1).rotate_z(deg(120.0)).scale(2.5).translate(by).offset(0.1);
    let turn = DQuat::from_rotation_z(deg(120.0).radians());
    is_red_and_blue(&placed, |p| turn * p * 2.5 + by);
    // A gentle twist moves hardly anything, but it has a frame of its own.
    is_red_and_blue(&pebbles().offset(0.2).twist(rad(0.05)), |p| p);
}

const PAINTS: [[u8; 3]; 3] = [RED, BLUE, GREEN];

/// A row of balls of three colours in turn, joined by fillets one after the other.
fn row(count: usize, radius: impl Fn(usize) -> f64) -> Solid {
    let ball = |i: usize| Solid::sphere(0.6).translate([i as f64, 0.0, 0.0]).paint(PAINTS[i % 3]);
    (1..count).fold(ball(0), |all, i| all.union_with(ball(i), Blend::Fillet { radius: radius(i) }))
}

/// Fails unless the fillet after a ball of a row has the colours of both balls, and of no other.
#[track_caller]
fn is_mixed_after(row: &Solid, i: usize) {
    let p = hit(row, DVec3::new(i as f64 + 0.5, 0.0, 9.0), -DVec3::Z);
    assert!(p.z > 0.34, "{p}");
    let mixed = color(row, p.to_array()).unwrap();
    for part in 0..3 {
        let is_there = [i, i + 1].iter().any(|n| PAINTS[n % 3][part] > 0);
        assert_eq!(mixed[part] > 60, is_there, "{i}: {mixed:?}");
    }
}

#[test]
fn chains_of_fillets_have_their_colours() {
    let many = row(80, |_| 0.1);
    for i in [0, 1, 2, 40, 78] {
        is_mixed_after(&many, i);
        assert_eq!(color(&many, [i as f64, 0.0, 0.6]), Some(PAINTS[i % 3]), "{i}");
    }
}

#[test]
fn fillets_of_fillets_have_their_colours() {
    // Fillets of different radii are nested.
    let nested = row(4, |i| if i % 2 == 0 { 0.2 } else { 0.3 });
    for i in 0..3 {
        is_mixed_after(&nested, i);
    }
}

#[test]
fn meshes_and_pictures_show_the_same_colours() {
    let solid = block().shell(0.2) - Solid::half_space(-DVec3::Z, -0.5);
    let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let colors = mesh.corner_colors().unwrap();
    let mut seen = [0; 2];
    for (triangle, colors) in mesh.triangles().iter().zip(colors) {
        let corners = triangle.map(|i| mesh.positions()[i as usize]);
        // Off the seam, and but for the cut, which has no paint.
        if corners.iter().any(|p| p.x.abs() < 0.05) || corners.iter().all(|p| (p.z - 0.5).abs() < 1e-3) {
            continue;
        }
        for (p, [r, g, b, _]) in corners.iter().zip(colors) {
            assert_eq!([*r, *g, *b], if p.x < 0.0 { RED } else { BLUE }, "{p}");
            seen[usize::from(p.x > 0.0)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 500), "{seen:?}");
    let camera = Camera::orthographic(9.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 3.0);
    let settings = RenderSettings {
        width: 60,
        height: 40,
        samples: 1,
        style: Style::Studio,
        background: Background::Transparent,
        shadows: false,
        ..RenderSettings::default()
    };
    let picture = solid.render(&camera, &settings).unwrap();
    let positions = solid.layers(&camera, 60, 40).unwrap().position();
    let mut seen = [0; 2];
    for (p, [r, g, b, a]) in positions.pixels().iter().zip(picture.pixels()) {
        // The floor and the inner walls.
        if p.is_finite() && p.z < 0.45 && p.x.abs() > 0.05 && *a == 255 {
            let (own, other) = if p.x < 0.0 { (r, b) } else { (b, r) };
            assert!(*own > 40 + (*other).max(*g), "{p} {r} {g} {b}");
            seen[usize::from(p.x > 0.0)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
}
