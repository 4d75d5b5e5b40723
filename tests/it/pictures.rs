//! Cameras, styles and layers.

use glam::{DVec2, DVec3, Vec3};
use rvachev::{
    Background, Blend, Bounds, Camera, Caps, Extrusion, Image, Lights, Paint, Profile, RFunction, RenderSettings, Run,
    Scene, Solid, Style, View,
    camera::{Projection, Window},
    catalogue,
    catalogue::{Entry, Part},
    deg,
    layers::Transfer,
    rad,
};

use crate::golden::{ascii, same_as_golden};

/// A painted part with creases, a blend, a cut and a hole to look through.
fn part() -> Solid {
    let foot = Solid::cuboid([6.0, 4.0, 1.0]).paint([70, 110, 160]);
    let post = Solid::cylinder(1.2, 3.0).translate([-1.0, 0.0, 1.5]).paint([200, 160, 70]);
    let bore = Solid::cylinder(0.7, 9.0).translate([1.8, 0.0, 0.0]).paint([190, 50, 40]);
    foot.union_with(post, Blend::Smooth { radius: 0.8 }) - bore
}

fn small(style: Style) -> RenderSettings {
    RenderSettings { width: 120, height: 90, style, ..RenderSettings::default() }
}

#[test]
fn styles() {
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    for style in Style::ALL {
        let image = scene.render(&camera, &small(style)).unwrap();
        same_as_golden(&format!("style_{style:?}").to_lowercase(), &image);
    }
}

#[test]
fn switches() {
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    let whole = scene.render(&camera, &small(Style::Studio)).unwrap();
    let settings = RenderSettings {
        shadows: false,
        occlusion: false,
        ground: false,
        transfer: Transfer::Srgb,
        background: Background::Transparent,
        ..small(Style::Studio)
    };
    same_as_golden("plain", &scene.render(&camera, &settings).unwrap());
    let hard = RenderSettings { softness: deg(0.0), background: Background::Transparent, ..small(Style::Studio) };
    same_as_golden("hard_shadows", &scene.render(&camera, &hard).unwrap());
    // Every switch does something.
    let base = small(Style::Studio);
    let lights = Lights::default();
    let others = [
        RenderSettings { shadows: false, ..base.clone() },
        RenderSettings { softness: deg(0.0), ..base.clone() },
        RenderSettings { occlusion: false, ..base.clone() },
        RenderSettings { ground: false, ..base.clone() },
        RenderSettings { transfer: Transfer::Srgb, ..base.clone() },
        RenderSettings { lights: Lights { key: 0.0, ..lights }, ..base.clone() },
        RenderSettings { lights: Lights { fill: 0.0, ..lights }, ..base.clone() },
        RenderSettings { lights: Lights { rim: 0.0, ..lights }, ..base.clone() },
        RenderSettings { lights: Lights { sky: 0.0, ..lights }, ..base.clone() },
    ];
    for settings in others {
        let other = scene.render(&camera, &settings).unwrap();
        assert!(other != whole, "{settings:?}");
    }
}

/// One ray a pixel and no shadows is a way of its own through the renderer.
#[test]
fn one_ray_a_pixel_shows_the_same() {
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    for style in Style::ALL {
        let with = |samples| {
            let settings = RenderSettings { samples, shadows: false, occlusion: false, ..small(style) };
            scene.render(&camera, &settings).unwrap()
        };
        let (one, many) = (with(1), with(3));
        // Away from edges there is one ray a pixel in both.
        let same = one.pixels().iter().zip(many.pixels()).filter(|(a, b)| a == b).count();
        assert!(4 * same > 3 * one.pixels().len(), "{style:?}: {same}");
        // Lines are drawn, if not as smoothly.
        let dark = |image: &Image| image.pixels().iter().filter(|p| p[..3].iter().all(|c| *c < 140)).count();
        let (few, all) = (dark(&one), dark(&many));
        assert!(style != Style::Technical || all > 200 && 2 * few > all, "{few} of {all}");
    }
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let part = part();
    let camera = Camera::framing(&part.bounds().unwrap());
    for style in [Style::Studio, Style::Technical] {
        let with = |threads| part.render_with(&camera, &small(style), &Run { threads, ..Run::default() }).unwrap();
        let one = with(1);
        assert!(one == with(2) && one == with(3), "{style:?}");
    }
}

#[test]
fn layers() {
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    let layers = scene.layers(&camera, 96, 72, &Run::default()).unwrap();
    let depth = layers.depth();
    let (near, far) = depth.range().unwrap();
    let grey = |image: &Image<u8>| image.map(|g| [*g, *g, *g, 255]);
    same_as_golden("depth", &grey(&depth.to_grey8(near, far)));
    let along = layers.depth_along_rays();
    let byte = |c: f32| (127.5 + 127.5 * c).round() as u8;
    same_as_golden("normal", &layers.normal().map(|n| [byte(n.x), byte(n.y), byte(n.z), 255]));
    let bounds = scene.bounds();
    let place = |p: &DVec3| {
        let part = ((*p - bounds.min) / bounds.size()).to_array();
        let [x, y, z] = part.map(|c| if c.is_finite() { (255.0 * c.clamp(0.0, 1.0)).round() as u8 } else { 0 });
        [x, y, z, 255]
    };
    same_as_golden("position", &layers.position().map(place));
    same_as_golden("mask", &layers.mask().map(|m| [if *m { 255 } else { 0 }; 4]));
    let owner = layers.owner();
    let color = |o: &Option<u32>| o.map_or([0; 4], |o| [80 * (o as u8 + 1), 255 - 60 * o as u8, 40, 255]);
    same_as_golden("owner", &owner.map(color));

    let solid = part();
    let (position, normal) = (layers.position(), layers.normal());
    let rays = camera.rays(96, 72);
    let axis = camera.pose().matrix3.z_axis;
    let mut hits = 0;
    for y in 0..72 {
        for x in 0..96 {
            let p = position.pixel(x, y).unwrap();
            assert_eq!(layers.mask().pixel(x, y), Some(p.is_finite()));
            if !p.is_finite() {
                assert_eq!((depth.pixel(x, y), along.pixel(x, y)), (Some(f64::INFINITY), Some(f64::INFINITY)));
                assert_eq!((normal.pixel(x, y), owner.pixel(x, y)), (Some(Vec3::ZERO), Some(None)));
                continue;
            }
            hits += 1;
            let (origin, direction) = rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
            assert!((p.distance(origin) - along.pixel(x, y).unwrap()).abs() < 1e-9);
            assert!(((p - origin).dot(axis) - depth.pixel(x, y).unwrap()).abs() < 1e-9);
            assert!(normal.pixel(x, y).unwrap().as_dvec3().dot(direction) < 1e-3, "({x}, {y})");
            assert!(solid.value(p).unwrap().abs() < 1e-4);
        }
    }
    assert!(hits > 1000, "{hits}");
}

/// The owners of many pixels are found together, whatever joins the leaves.
#[test]
fn owners_in_pictures_are_those_of_the_points() {
    let star = Profile::regular_polygon(5, 1.0) | Profile::rectangle([2.6, 0.5]);
    let chamfered = Extrusion { twist: deg(30.0), caps: Caps::Chamfered(0.1), ..Extrusion::new(1.0) };
    let ball = |x: f64, y: f64| Solid::sphere(0.5).translate([x, y, 0.5]);
    let balls = [(0.4, 0.0), (-0.4, 0.3), (-0.2, -0.5), (0.1, 0.7)].map(|(x, y)| ball(x, y));
    let solids = [
        star.extrude_with(&chamfered) | ball(0.3, 0.2),
        part() | ball(-1.0, 0.0).twist(rad(0.1)),
        Solid::union_all(balls.clone(), RFunction::MIN_MAX) - Solid::cuboid([0.4; 3]),
        balls.iter().skip(1).fold(balls[0].clone(), |all, next| all.union_with(next, Blend::Smooth { radius: 0.1 })),
    ];
    for (number, solid) in solids.iter().enumerate() {
        let layers = solid.layers(&Camera::framing(&solid.bounds().unwrap()), 160, 120).unwrap();
        let (position, owner) = (layers.position(), layers.owner());
        let (mut hits, mut others, mut seen) = (0, 0, std::collections::BTreeSet::new());
        for (p, owner) in position.pixels().iter().zip(owner.pixels()) {
            let Some(owner) = owner else { continue };
            hits += 1;
            seen.insert(*owner);
            others += u32::from(solid.owner(*p).unwrap().index != *owner);
        }
        // At edges rounding tells.
        assert!(hits > 800 && others * 200 < hits && seen.len() > 2, "{number}: {others} of {hits}, {seen:?}");
    }
}

#[test]
fn silhouette_and_leaves_in_ascii() {
    let solid = Solid::sphere(1.0) - Solid::cuboid([0.7, 4.0, 0.7]);
    let camera = Camera::orthographic([0.0, -9.0, 0.0], DVec3::ZERO, DVec3::Z, 2.4);
    let slanted = camera.orbit(deg(0.0), deg(12.0));
    let owner = solid.layers(&slanted, 26, 13).unwrap().owner();
    let found = ascii(&owner, |o| o.map_or(' ', |o| ['o', 'x'][o as usize]));
    let expected = "
           oooo
         oooooooo
        oooooooooo
        oooooooooo
        oooooooooo
        ooo    ooo
        oooxxxxooo
        oooxxxxooo
        oooooooooo
         oooooooo
           oooo
";
    assert!(found.trim_matches('\n') == expected.trim_matches('\n'), "found:\n{found}");
}

#[cfg(feature = "exr")]
#[test]
fn files_of_every_kind() {
    let solid = Solid::sphere(1.0);
    let camera = Camera::framing(&solid.bounds().unwrap());
    let layers = solid.layers(&camera, 20, 16).unwrap();
    let folder = std::env::temp_dir().join(format!("rvachev-pictures-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let at = |name: &str| folder.join(name);
    layers.depth().save(at("depth.exr")).unwrap();
    layers.depth().save(at("depth.png")).unwrap();
    layers.normal().save(at("normal.exr")).unwrap();
    layers.normal().save(at("normal.png")).unwrap();
    layers.position().save(at("position.exr")).unwrap();
    layers.mask().save(at("mask.png")).unwrap();
    layers.owner().save(at("owner.png")).unwrap();
    let settings = RenderSettings { width: 20, height: 16, ..RenderSettings::default() };
    let light = solid.scene().unwrap().light(&camera, &settings, &Run::default()).unwrap();
    light.save(at("light.exr")).unwrap();
    light.to_16bit().save(at("deep.png")).unwrap();
    Image::save_animation(&[light.to_8bit()], std::time::Duration::from_millis(50), at("a.gif")).unwrap();
    assert!(Image::save_animation(&[], std::time::Duration::ZERO, at("b.gif")).is_err());
    assert!(layers.position().save(at("position.png")).unwrap_err().to_string().ends_with("known: .exr"));
    assert_eq!(image::open(at("deep.png")).unwrap().color(), image::ColorType::Rgb16);
    assert_eq!(image::open(at("a.gif")).unwrap().to_rgba8().dimensions(), (20, 16));

    // What is read from EXR is what was written.
    let depth = layers.depth();
    let file = exr::prelude::read_first_flat_layer_from_file(at("depth.exr")).unwrap();
    let channel = &file.layer_data.channel_data.list[0];
    assert_eq!(channel.name.to_string(), "Z");
    let read: Vec<f32> = channel.sample_data.values_as_f32().collect();
    let written: Vec<f32> = depth.pixels().iter().map(|d| *d as f32).collect();
    assert_eq!(read, written);
    std::fs::remove_dir_all(folder).unwrap();

    let mut too_small = [0u8; 10];
    assert!(rvachev::io::write_exr(&depth, &mut too_small[..]).is_err());
}

#[test]
fn views_and_orbits() {
    let bounds = Bounds::new(DVec3::new(-2.0, -1.0, 0.0), DVec3::new(2.0, 1.0, 3.0));
    for view in View::ALL {
        let camera = Camera::framing_view(&bounds, view);
        camera.check().unwrap();
        let rays = camera.pose();
        assert!((rays.matrix3.z_axis + view.direction()).length() < 1e-12, "{view:?}");
        assert!((rays.matrix3.determinant() - 1.0).abs() < 1e-12, "x right, y down, z along the view");
        let parallel = camera.parallel();
        assert!(matches!(parallel.projection, Projection::Orthographic { height } if height > 0.0));
        // The target keeps its size.
        let (a, b) = (camera.intrinsics(100, 100), parallel.intrinsics(100, 100));
        assert!((a.fx / camera.eye.distance(camera.target) - b.fx).abs() < 1e-9 * b.fx);
    }
    let start = Camera::framing_view(&bounds, View::Front);
    let whole = (0..8).fold(start, |camera, _| camera.orbit(deg(45.0), deg(0.0)));
    assert!(whole.eye.distance(start.eye) < 1e-12);
    assert!(start.orbit(deg(90.0), deg(0.0)).eye.x > 1.0 && start.orbit(deg(90.0), deg(0.0)).eye.y.abs() < 1e-9);
    let above = start.orbit(deg(0.0), deg(500.0));
    above.check().unwrap();
    assert!(above.eye.z > start.eye.distance(start.target) * 0.99);
    assert_eq!(start.orbit(deg(f64::NAN), deg(0.0)), start);
    assert_eq!(Camera::look_at([0.0, 0.0, 5.0], [0.0, 0.0, 0.0]).up, DVec3::Y);
}

#[test]
fn fitted_cameras_hold_every_point_tightly() {
    let points: Vec<DVec3> = (0..200u32)
        .map(|i| {
            let at = |k: f64| (f64::from(i) * k).fract() - 0.5;
            DVec3::new(40.0 + 6.0 * at(0.7549), 3.0 * at(0.5698), 9.0 * at(0.4386))
        })
        .collect();
    for view in View::ALL {
        let perspective = Camera::perspective(view.direction(), DVec3::ZERO, view.up(), deg(40.0));
        for camera in [perspective, perspective.parallel()] {
            for aspect in [0.5, 1.0, 2.0] {
                let camera = camera.fitted_to(&points, aspect);
                camera.check().unwrap();
                let lens = camera.intrinsics((600.0 * aspect) as u32, 600);
                let back = camera.pose().inverse();
                let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
                for p in &points {
                    let pixel = lens.project(back.transform_point3(*p)).unwrap();
                    let part = pixel / DVec2::new(600.0 * aspect, 600.0);
                    (least, most) = (least.min(part), most.max(part));
                }
                // Within, and one of the two directions filled.
                assert!(least.min_element() > 0.02 && most.max_element() < 0.98, "{view:?} {least} {most}");
                assert!((most - least).max_element() > 0.93, "{view:?} {aspect} {least} {most}");
                // What is not filled is centred in space, which depth shifts in a picture.
                let off = (least + most - 1.0).abs().max_element();
                assert!(off < if lens.parallel { 1e-9 } else { 0.2 }, "{view:?} {aspect} {least} {most}");
            }
        }
    }
    let camera = Camera::look_at(DVec3::X, DVec3::ZERO);
    assert_eq!(camera.fitted_to(&[], 1.0), camera);
    camera.fitted_to(&[DVec3::splat(5.0)], 1.0).check().unwrap();
}

#[test]
fn a_scene_is_framed_tighter_than_its_box() {
    let scene = Solid::sphere(1.0).scene().unwrap();
    let boxed = Camera::framing(&scene.bounds());
    let framed = scene.framing(View::ThreeQuarter, 1.0);
    assert!(framed.eye.length() < 0.85 * boxed.eye.length());
    let mask = scene.layers(&framed, 64, 64, &Run::default()).unwrap().mask();
    let touched =
        (0..64).any(|i| [(i, 0), (i, 63), (0, i), (63, i)].into_iter().any(|(x, y)| mask.pixel(x, y) == Some(true)));
    assert!(!touched);
}

#[test]
fn the_ground_lies_under_the_lowest_point() {
    for (solid, low) in [
        (Solid::sphere(1.0), -1.0),
        (Solid::cuboid([2.0, 2.0, 2.0]).rotate_x(deg(45.0)), -(2f64.sqrt())),
        (Solid::sphere(1.0) & Solid::half_space([0.0, 0.0, -1.0], 0.3), -0.3),
        (Solid::superellipsoid([3.0, 2.0, 1.0], 0.3, 0.3).twist(rad(0.2)).translate([0.0, 0.0, 50.0]), 49.0),
    ] {
        let found = solid.scene().unwrap().lowest();
        let height = solid.bounds().unwrap().size().z;
        assert!(found <= low + 1e-9 && found > low - 0.003 * height, "{found} {low}");
    }
}

#[test]
fn paint_shows() {
    let ball = Solid::sphere(1.0).paint(Paint::from([220, 20, 20]));
    let camera = Camera::framing(&ball.bounds().unwrap());
    let settings = RenderSettings { background: Background::Transparent, ..small(Style::Studio) };
    let red = ball.render(&camera, &settings).unwrap().pixel(60, 45).unwrap();
    assert!(red[0] > 120 && red[1] < 90 && red[2] < 90, "{red:?}");
    let clay = ball.render(&camera, &RenderSettings { style: Style::Clay, ..settings }).unwrap().pixel(60, 45).unwrap();
    assert!(clay[0].abs_diff(clay[1]) < 30, "{clay:?}");
}

/// Rays through small pictures of every entry of the catalogue, and of blocks with holes, shelled,
/// moved and capped: where a pixel is unlike those about it, another way to follow the ray says the
/// same.
#[test]
fn no_pixel_is_lost() {
    let part = |entry: &Entry| match entry.example() {
        Part::Solid(solid) => Some(solid),
        Part::Profile(profile) => Some(profile.extrude(1.0)),
        _ => None,
    };
    let block = Solid::cuboid([2.0, 1.4, 1.0]) - Solid::cylinder(0.4, 2.0);
    let star = Profile::rectangle([1.8, 0.6]) | Profile::rectangle([0.6, 1.8]);
    let capped = |caps| star.extrude_with(&Extrusion { caps, ..Extrusion::new(1.6) });
    let more = [block.offset(-0.12), block.offset(0.12), block.shell(0.1), block.rounded(0.2)];
    let capped = [Caps::Flat, Caps::Rounded(0.2), Caps::Chamfered(0.2)].map(capped);
    let (mut asked, mut lost) = (0, Vec::new());
    for solid in catalogue().iter().filter_map(part).chain(more).chain(capped) {
        let (Ok(scene), Ok(bounds)) = (solid.scene(), solid.bounds()) else { continue };
        for size in [[88, 66], [101, 77], [64, 64]] {
            asked += odd_pixels(&scene, &bounds, size, |pixel, ray, seen| {
                let want = solid.raycast(ray.0, ray.1).unwrap().map(|hit| hit.distance);
                let is_same = match (want, seen.is_finite()) {
                    (Some(want), true) => (want - seen).abs() < 1e-3 * bounds.longest_side(),
                    (want, is_hit) => want.is_some() == is_hit,
                };
                if !is_same {
                    lost.push(format!("{pixel:?} of {size:?}: {seen}, not {want:?}, of\n{solid}"));
                }
            });
        }
    }
    assert!(asked > 10 && lost.is_empty(), "{} of {asked}: {lost:#?}", lost.len());
}

/// Visits the pixels that are deeper than all about them, or less deep: with their rays and depths.
fn odd_pixels(
    scene: &Scene,
    bounds: &Bounds,
    [width, height]: [u32; 2],
    mut visit: impl FnMut([u32; 2], (DVec3, DVec3), f64),
) -> usize {
    let camera = Camera::framing(bounds).fitted(bounds, f64::from(width) / f64::from(height));
    let rays = camera.rays(width, height);
    let seen = scene.surfaces(&rays, Window::whole(width, height));
    let far = 0.05 * bounds.longest_side();
    let depth = |x: u32, y: u32| seen.at(x, y).distance.min(1e6);
    let mut count = 0;
    for (x, y) in (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y))) {
        let about = [depth(x - 1, y), depth(x + 1, y), depth(x, y - 1), depth(x, y + 1)];
        if about.into_iter().all(|other| (other - depth(x, y)).abs() > far) {
            count += 1;
            visit([x, y], rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5), seen.at(x, y).distance);
        }
    }
    count
}

/// Of spheres that overlap most cells lie in one, and what is left holds little memory.
#[test]
fn scenes_of_crowds_hold_little() {
    let held = |count: u32| {
        let at = |i: u32| [0.731, 1.317, 2.113].map(|step| (step * f64::from(i)).sin());
        let spheres = (0..count).map(|i| Solid::sphere(0.25).translate(at(i)));
        let rest = Solid::cuboid([2.0; 3]) - Solid::union_all(spheres, RFunction::MIN_MAX);
        let scene = rest.scene().unwrap();
        let camera = Camera::framing(&scene.bounds());
        drop(scene.surfaces(&camera.rays(32, 24), Window::whole(32, 24)));
        scene.memory()
    };
    let (once, twice) = (held(700), held(1400));
    assert!(once < 20_000_000 && twice < 50_000_000, "{once} {twice}");
}
