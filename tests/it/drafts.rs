//! Draft pictures beside fine ones.

use glam::DVec3;
use rvachev::{
    Background, Camera, Image, Quality, RenderSettings, Run, Scene, Solid, View, catalogue,
    catalogue::{Entry, Group, Part},
    deg,
};

use crate::workpieces;

fn settings(width: u32, height: u32, quality: Quality) -> RenderSettings {
    RenderSettings {
        width,
        height,
        samples: 1,
        shadows: false,
        occlusion: false,
        ground: false,
        background: Background::Transparent,
        quality,
        ..RenderSettings::default()
    }
}

/// How many pixels of one silhouette are more than 1.5 pixels from the other.
fn apart(one: &Image, other: &Image) -> usize {
    let (width, height) = (i64::from(one.width()), i64::from(one.height()));
    let seen =
        |image: &Image, x: i64, y: i64| x >= 0 && y >= 0 && image.pixel(x as u32, y as u32).is_some_and(|p| p[3] > 127);
    let near = |image: &Image, x: i64, y: i64| {
        let state = !seen(image, x, y);
        (-1..=1).any(|dy| (-1..=1).any(|dx| seen(image, x + dx, y + dy) == state))
    };
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.filter(|&(x, y)| seen(one, x, y) != seen(other, x, y) && !(near(one, x, y) && near(other, x, y))).count()
}

/// Lengths and what is filleted are measured, which takes a hundred times as long.
fn is_measured(entry: &Entry) -> bool {
    matches!(entry.group(), Group::Length | Group::BlendedJoin)
}

#[test]
fn silhouettes_of_the_catalogue_are_those_of_fine_pictures() {
    compare([240, 135], entries(|entry| !is_measured(entry)));
}

#[test]
#[ignore = "minutes"]
fn silhouettes_of_large_pictures_are_those_of_fine_ones() {
    compare([960, 540], entries(|_| true));
}

#[test]
fn silhouettes_of_the_examples_are_those_of_fine_pictures() {
    compare([240, 135], workpieces::plain());
}

#[test]
#[ignore = "minutes"]
fn silhouettes_of_large_pictures_of_the_examples_are_those_of_fine_ones() {
    compare([960, 540], workpieces::plain().into_iter().chain(workpieces::measured()));
}

/// Of the catalogue.
fn entries(is_asked: impl Fn(&Entry) -> bool) -> impl Iterator<Item = (&'static str, Solid)> {
    catalogue().iter().filter(move |entry| is_asked(entry)).filter_map(|entry| {
        let solid = match entry.example() {
            Part::Solid(solid) => solid,
            Part::Profile(profile) => profile.extrude(0.5),
            _ => return None,
        };
        let is_finite = solid.bounds().is_ok_and(|bounds| bounds.is_finite());
        Some((entry.name(), if is_finite { solid } else { solid & Solid::cuboid([4.0; 3]) }))
    })
}

/// Of the mesh in 64 cells.
fn compare([width, height]: [u32; 2], solids: impl IntoIterator<Item = (&'static str, Solid)>) {
    let mut wrong = Vec::new();
    for (name, solid) in solids {
        let scene = solid.scene().unwrap();
        let camera = scene.framing(View::ThreeQuarter, 16.0 / 9.0);
        let picture = |quality| scene.render(&camera, &settings(width, height, quality)).unwrap();
        let apart = apart(&picture(Quality::Fine), &picture(Quality::Draft));
        if apart > 0 {
            wrong.push(format!("{name}: {apart}"));
        }
    }
    assert!(wrong.is_empty(), "pixels too far from the silhouette: {wrong:?}");
}

/// A block with a bore, and a ring on it.
fn part() -> Solid {
    let block = Solid::cuboid([4.0, 3.0, 1.5]).paint([70, 110, 160]);
    let ring = Solid::torus(1.0, 0.3).translate([0.0, 0.0, 0.9]).paint([200, 160, 70]);
    (block | ring) - Solid::cylinder(0.5, 4.0).paint([190, 50, 40])
}

fn scene() -> Scene {
    part().scene().unwrap()
}

#[test]
fn light_and_paint_are_those_of_fine_pictures() {
    let scene = scene();
    let perspective = scene.framing(View::ThreeQuarter, 16.0 / 9.0);
    let inside = Camera::perspective([0.0, -1.2, 0.0], [0.0, 1.0, 0.3], DVec3::Z, deg(80.0));
    for camera in [perspective, perspective.parallel(), inside] {
        for samples in [1, 3] {
            let picture = |quality| {
                let settings = RenderSettings { samples, ..settings(160, 90, quality) };
                scene.render(&camera, &settings).unwrap()
            };
            let (fine, draft) = (picture(Quality::Fine), picture(Quality::Draft));
            let off = fine
                .pixels()
                .iter()
                .zip(draft.pixels())
                .map(|(a, b)| a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).max().unwrap_or(0));
            let off: Vec<u64> = off.collect();
            let (far, sum) = (off.iter().filter(|off| **off > 24).count(), off.iter().sum::<u64>());
            assert!(far < 160 * 90 / 50, "{far} pixels are off by more than 24 levels, {samples} samples");
            assert!(sum < 2 * 160 * 90, "off by {} levels in the mean", sum as f64 / (160.0 * 90.0));
        }
    }
}

#[test]
fn drafts_are_the_same_for_any_number_of_threads_and_as_files() {
    let (scene, settings) = (scene(), RenderSettings { samples: 2, ..settings(130, 70, Quality::Draft) });
    let camera = scene.framing(View::Front, 1.8);
    let with = |threads| scene.render_with(&camera, &settings, &Run { threads, ..Run::default() }).unwrap();
    let one = with(1);
    assert!(one == with(2) && one == with(3) && one == part().render(&camera, &settings).unwrap());
    let path = std::env::temp_dir().join(format!("rvachev-draft-{}.png", std::process::id()));
    scene.render_to(&path, &camera, &settings, &Run::default()).unwrap();
    assert!(image::open(&path).unwrap().into_rgba8().as_raw() == one.pixels().as_flattened());
    std::fs::remove_file(&path).unwrap();
    let wide = RenderSettings { width: 9000, height: 20, ..settings };
    let error = scene.render(&camera, &wide).unwrap_err().to_string();
    assert!(error.starts_with("size is 9000 × 20; allowed: 16 384 pixels a side in drafts"), "{error}");
    let nothing = Solid::sphere(1.0) & Solid::sphere(1.0).translate([3.0, 0.0, 0.0]);
    let image = nothing.render(&camera, &RenderSettings { width: 20, height: 20, ..wide }).unwrap();
    assert!(image.pixels().iter().all(|p| *p == [0; 4]));
}
