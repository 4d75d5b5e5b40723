//! Placing by boxes.

use glam::DVec3;
use rvachev::{Face, Profile, Solid, deg};

fn bounds(solid: &Solid) -> [DVec3; 2] {
    let bounds = solid.bounds().unwrap();
    [bounds.min, bounds.max]
}

#[test]
fn boxes_are_where_they_are_asked_for() {
    let part = Solid::cuboid([4.0, 6.0, 8.0]).rotate_x(deg(90.0)).translate([10.0, 20.0, 30.0]);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let [low, high] = bounds(&part.on_ground());
    assert!(near(low.z, 0.0) && near(high.z, 6.0) && near(low.x, 8.0) && near(low.y, 16.0));
    let [low, high] = bounds(&part.centered());
    assert!((low + high).length() < 1e-9 && (high - DVec3::new(2.0, 4.0, 3.0)).length() < 1e-9);
    let other = Solid::sphere(5.0);
    let faces = [Face::Left, Face::Right, Face::Front, Face::Back, Face::Bottom, Face::Top];
    for (n, face) in faces.into_iter().enumerate() {
        for (m, there) in faces.into_iter().enumerate().filter(|(m, _)| m / 2 == n / 2) {
            let placed = part.aligned(face, &other, there);
            let (own, wanted) = (bounds(&placed)[n % 2][n / 2], bounds(&other)[m % 2][m / 2]);
            assert!(near(own, wanted), "{face:?} at {there:?}: {own}, {wanted}");
            // Along the other axes it stays.
            assert!(
                (0..3).filter(|axis| *axis != n / 2).all(|axis| near(bounds(&placed)[0][axis], bounds(&part)[0][axis]))
            );
        }
    }
    let [low, high] = bounds(&Profile::rectangle([2.0, 2.0]).extrude_up(7.0));
    assert!(near(low.z, 0.0) && near(high.z, 7.0));
    let plane = Profile::circle(1.0).translate([5.0, 6.0]).centered();
    assert!(plane.contains([0.9, 0.0]).unwrap() && !plane.contains([1.1, 0.0]).unwrap());
    let row = Solid::sphere(1.0).translate([0.0, 3.0, 0.0]).repeat_centered([3, 1, 2], [4.0, 0.0, 6.0]);
    let [low, high] = bounds(&row);
    assert!((low - DVec3::new(-5.0, 2.0, -4.0)).length() < 1e-9 && (high - DVec3::new(5.0, 4.0, 4.0)).length() < 1e-9);
}

#[test]
fn profiles_are_placed_as_solids_are() {
    let part = Profile::rectangle([4.0, 6.0]).translate([10.0, 20.0]);
    let sides = |profile: &Profile| {
        let bounds = profile.bounds().unwrap();
        [bounds.min, bounds.max]
    };
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let [low, high] = sides(&part.on_ground());
    assert!(near(low.y, 0.0) && near(high.y, 6.0) && near(low.x, 8.0));
    let other = Profile::circle(5.0);
    let faces = [Face::Left, Face::Right, Face::Front, Face::Back];
    for (n, face) in faces.into_iter().enumerate() {
        for (m, there) in faces.into_iter().enumerate().filter(|(m, _)| m / 2 == n / 2) {
            let placed = part.aligned(face, &other, there);
            let (own, wanted) = (sides(&placed)[n % 2][n / 2], sides(&other)[m % 2][m / 2]);
            assert!(near(own, wanted), "{face:?} at {there:?}: {own}, {wanted}");
            assert!(near(sides(&placed)[0][1 - n / 2], sides(&part)[0][1 - n / 2]), "{face:?} at {there:?}");
        }
    }
    let turned = Profile::circle(0.5).translate([2.0, 2.0]).rotate_around([1.0, 2.0], deg(90.0));
    assert!(near(turned.value([1.0, 3.0]).unwrap(), 0.5));
    let message = |profile: Profile| profile.bounds().unwrap_err().to_string();
    let mixed = message(other.aligned(Face::Left, &other, Face::Front));
    assert!(mixed.contains("aligned: translation.x") && mixed.contains("by faces across the same axis"), "{mixed}");
    let upright = message(other.aligned(Face::Top, &other, Face::Bottom));
    assert!(upright.contains("aligned: translation.z"), "{upright}");
}

#[test]
fn turned_about_a_line() {
    let point = DVec3::new(1.0, 2.0, 3.0);
    let ball = Solid::sphere(0.5).translate(point + DVec3::X).rotate_around(point, DVec3::Z * 7.0, deg(90.0));
    assert!((ball.value(point + DVec3::Y).unwrap() - 0.5).abs() < 1e-9);
}

#[test]
fn what_cannot_be_placed_is_told_on_first_use() {
    let message = |solid: &Solid| solid.bounds().unwrap_err().to_string();
    let plane = Solid::half_space([0.0, 0.0, 1.0], 0.0);
    assert!(message(&plane.on_ground()).contains("on_ground: translation.z"), "{}", message(&plane.on_ground()));
    assert!(message(&plane.on_ground()).ends_with("by a solid with a finite box"), "{}", message(&plane.on_ground()));
    assert!(message(&plane.centered()).contains("centered: translation."));
    let ball = Solid::sphere(1.0);
    let mixed = ball.aligned(Face::Left, &ball, Face::Top);
    assert!(message(&mixed).contains("by faces across the same axis"), "{}", message(&mixed));
    assert!(message(&ball.aligned(Face::Left, &Solid::sphere(-1.0), Face::Left)).contains("aligned"));
    // The fault of a part is its own.
    assert!(message(&Solid::sphere(-1.0).on_ground()).starts_with("on_ground / sphere: radius is -1"));
    assert!(message(&Profile::circle(1.0).extrude_up(f64::NAN)).contains("extrude"));
    let empty = ball.clone() & ball.translate([5.0, 0.0, 0.0]);
    assert!(empty.centered().bounds().unwrap().is_empty());
}
