//! Pictures of solids that are cut by a plane.

use glam::DVec3;
use rvachev::{
    Background, Camera, Paint, Plane, Quality, RenderSettings, Run, Solid, Style, View, deg, layers::Transfer,
    range_image::Coordinates,
};

use crate::support::near;

const BLUE: [u8; 3] = [40, 90, 200];
const GOLD: [u8; 3] = [214, 164, 72];
const RED: [u8; 3] = [186, 44, 36];

/// A blue block with a gold pin through a red bore that is wider than the pin.
fn pinned() -> Solid {
    let block = Solid::cuboid([4.0, 4.0, 2.0]).paint(BLUE);
    let bore = Solid::cylinder(1.0, 6.0).paint(RED);
    let pin = Solid::cylinder(0.5, 4.0).paint(GOLD);
    (block - bore) | pin
}

fn front() -> Camera {
    Camera::orthographic([0.0, -10.0, 0.0], DVec3::ZERO, DVec3::Z, 5.0)
}

fn settings(quality: Quality) -> RenderSettings {
    RenderSettings {
        width: 100,
        height: 100,
        samples: 1,
        shadows: false,
        occlusion: false,
        ground: false,
        background: Background::Transparent,
        cut: Some(Plane::xz(0.0)),
        quality,
        ..RenderSettings::default()
    }
}

/// The pixel that a point of the plane of the section appears at.
fn pixel(x: f64, z: f64) -> (u32, u32) {
    ((50.0 + 20.0 * x) as u32, (50.0 - 20.0 * z) as u32)
}

#[test]
fn a_section_has_the_normal_of_the_plane_and_the_paint_of_what_it_passes() {
    let scene = pinned().scene().unwrap();
    for quality in [Quality::Fine, Quality::Draft] {
        let normals = RenderSettings { style: Style::Normals, ..settings(quality) };
        let image = scene.render(&front(), &normals).unwrap();
        let at = |x, z| image.pixel(pixel(x, z).0, pixel(x, z).1).unwrap();
        // −y, on the block and on the pin.
        assert_eq!([at(1.5, 0.3), at(-1.8, -0.8), at(0.2, 0.2), at(0.0, 1.7)], [[128, 0, 128, 255]; 4]);
        // The far wall of the bore faces the front as well where it is farthest; nothing is above.
        assert_eq!(at(1.5, 1.3), [0; 4]);

        // A section is as bright as a board of that colour that faces the same way.
        let look = RenderSettings { transfer: Transfer::Srgb, style: Style::Studio, ..settings(quality) };
        let image = scene.render(&front(), &look).unwrap();
        let plain = |color: [u8; 3]| {
            let board = Solid::cuboid([4.0, 2.0, 2.0]).translate([0.0, 1.0, 0.0]).paint(color);
            let whole = RenderSettings { cut: None, ..look.clone() };
            board.render(&front(), &whole).unwrap().pixel(pixel(1.5, 0.3).0, pixel(1.5, 0.3).1).unwrap()
        };
        let at = |x, z| image.pixel(pixel(x, z).0, pixel(x, z).1).unwrap();
        let close = |a: [u8; 4], b: [u8; 4]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2);
        assert!(close(at(1.5, 0.3), plain(BLUE)), "{:?} {:?}", at(1.5, 0.3), plain(BLUE));
        // Next to the bore as well: what was cut away is no part of the block.
        assert!(close(at(1.08, 0.3), plain(BLUE)), "{:?}", at(1.08, 0.3));
        assert!(close(at(0.2, 0.3), plain(GOLD)), "{:?}", at(0.2, 0.3));
        // Within the bore, beside the pin, its red wall is seen.
        let [r, g, b, _] = at(0.75, 0.3);
        assert!(r > 2 * g && r > 2 * b, "{r} {g} {b}");

        let painted = RenderSettings { cut_paint: Some(Paint::from([30, 160, 60])), ..look.clone() };
        let image = scene.render(&front(), &painted).unwrap();
        let at = |x, z| image.pixel(pixel(x, z).0, pixel(x, z).1).unwrap();
        let green = plain([30, 160, 60]);
        assert!(close(at(1.5, 0.3), green) && close(at(0.2, 0.3), green), "{:?} {green:?}", at(1.5, 0.3));
        assert!(at(0.75, 0.3)[0] > 2 * at(0.75, 0.3)[1]);
    }
}

#[test]
fn nothing_is_seen_on_the_removed_side_and_depths_are_right() {
    let solid = pinned().rotate_x(deg(20.0));
    let scene = solid.scene().unwrap();
    let plane = Plane::new([0.1, -0.3, 0.2], [0.4, -1.0, 0.3]);
    let cut = scene.cut(&plane, None, &Run::default()).unwrap();
    let above = |p: DVec3| (p - plane.origin()).dot(plane.normal());
    let camera = scene.framing(View::ThreeQuarter, 1.0).orbit(deg(-20.0), deg(5.0));
    let layers = cut.layers(&camera, 80, 80, &Run::default()).unwrap();
    let (mut on, mut below) = (0, 0);
    for (p, owner) in layers.position().pixels().iter().zip(layers.owner().pixels()) {
        if !p.is_finite() {
            continue;
        }
        assert!(above(*p) < 1e-6, "{p} is {} beyond the plane", above(*p));
        if above(*p) > -1e-6 {
            on += 1;
            // A point of the section is inside of the whole, and of the part that it is said to be.
            assert!(solid.contains(*p - 1e-6 * plane.normal()).unwrap(), "{p}");
            let local = DVec3::new(p.x, p.y, p.z);
            let turned = glam::DQuat::from_rotation_x(-20f64.to_radians()) * local;
            let wanted = if turned.truncate().length() < 0.5 { 2 } else { 0 };
            assert_eq!(*owner, Some(wanted), "{turned}");
        } else {
            below += 1;
        }
    }
    assert!(on > 800 && below > 500, "{on} {below}");
    let cloud = layers.range_image().points(Coordinates::World).unwrap();
    assert!(cloud.positions().len() == on + below && cloud.positions().iter().all(|p| above(*p) < 1e-6));
    // The same by a single ray.
    let hit = cut.first_hit(plane.origin() + 8.0 * plane.normal(), -plane.normal()).unwrap();
    near(hit.distance, 8.0, 1e-6);
    // What is cut once more.
    let twice = cut.cut(&Plane::yz(0.0), None, &Run::default()).unwrap();
    let hit = twice.first_hit(DVec3::new(5.0, 1.5, 0.0), -DVec3::X).unwrap();
    assert_eq!((hit.owner, hit.normal), (0, DVec3::X));
    near(hit.distance, 5.0, 1e-6);
    // A section shows the solid's parts, also close to a section that is painted.
    let painted = pinned().scene().unwrap().cut(&Plane::xz(0.0), Some(Paint::from([30, 160, 60])), &Run::default());
    let through = painted.unwrap().cut(&Plane::yz(0.0), None, &Run::default()).unwrap();
    let hit = through.first_hit(DVec3::new(5.0, 0.05, 0.3), -DVec3::X).unwrap();
    assert_eq!((hit.owner, hit.normal), (2, DVec3::X));
}

#[test]
fn a_scene_keeps_what_it_was_cut_to_and_whole_pictures_stay_whole() {
    let scene = pinned().scene().unwrap();
    let cut = settings(Quality::Fine);
    let whole = RenderSettings { cut: None, ..cut.clone() };
    let first = scene.render(&front(), &whole).unwrap();
    let section = scene.render(&front(), &cut).unwrap();
    assert!(first != section);
    assert!(section == scene.render(&front(), &cut).unwrap() && first == scene.render(&front(), &whole).unwrap());
    assert!(section == pinned().render(&front(), &cut).unwrap());
    // A plane that misses the solid on either side.
    let beside = RenderSettings { cut: Some(Plane::xz(-5.0)), ..cut.clone() };
    assert!(scene.render(&front(), &beside).unwrap() == first);
    for quality in [Quality::Fine, Quality::Draft] {
        let gone = RenderSettings { cut: Some(Plane::xz(5.0)), quality, ..cut.clone() };
        assert!(scene.render(&front(), &gone).unwrap().pixels().iter().all(|p| *p == [0; 4]));
    }
    let no_plane = RenderSettings { cut: Some(Plane::new(DVec3::ZERO, DVec3::ZERO)), ..cut };
    let error = scene.render(&front(), &no_plane).unwrap_err().to_string();
    assert!(error.starts_with("cut is a plane through [0, 0, 0] across"), "{error}");
}
