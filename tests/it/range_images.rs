//! Range images and the clouds made of them.

use glam::{DAffine3, DVec3};
use rvachev::{
    Camera, Image, Solid,
    io::write_ply_points,
    rad,
    range_image::{Coordinates, Noise, RangeImage},
};

fn ball() -> (Camera, RangeImage) {
    let ball = Solid::sphere(1.0).translate([3.0, -2.0, 1.0]);
    let camera = Camera::framing(&ball.bounds().unwrap());
    let range = ball.layers(&camera, 80, 60).unwrap().range_image();
    (camera, range)
}

#[test]
fn points_lie_on_the_solid_in_either_coordinates() {
    let center = DVec3::new(3.0, -2.0, 1.0);
    let (camera, range) = ball();
    let world = range.points(Coordinates::World).unwrap();
    let own = range.points(Coordinates::Camera).unwrap();
    assert!(world.len() > 800 && world.len() == own.len(), "{}", world.len());
    for (p, q) in world.positions().iter().zip(own.positions()) {
        assert!((p.distance(center) - 1.0).abs() < 1e-5, "{p}");
        assert!(camera.pose().transform_point3(*q).distance(*p) < 1e-9);
        assert!(q.z > 0.0);
    }
    for (p, n) in world.positions().iter().zip(world.normals().unwrap()) {
        assert!((*p - center).dot(n.as_dvec3()) > 0.999);
    }
    for (q, n) in own.positions().iter().zip(own.normals().unwrap()) {
        assert!(q.dot(n.as_dvec3()) < 0.0, "towards the camera");
    }
    let parallel = camera.parallel();
    let ball = Solid::sphere(1.0).translate(center);
    let range = ball.layers(&parallel, 80, 60).unwrap().range_image();
    let cloud = range.points(Coordinates::World).unwrap();
    assert!(cloud.positions().iter().all(|p| (p.distance(center) - 1.0).abs() < 1e-5));
}

#[test]
fn noise_is_along_the_ray_and_repeats() {
    let (camera, range) = ball();
    let noise = Noise { deviation: 0.02, missing: 0.25, seed: 42 };
    let noisy = range.with_noise(&noise).unwrap();
    assert_eq!(noisy, range.with_noise(&noise).unwrap());
    assert_ne!(noisy, range.with_noise(&Noise { seed: 43, ..noise }).unwrap());
    let rays = camera.rays(80, 60);
    let (mut errors, mut missing, mut all) = (Vec::new(), 0, 0);
    for y in 0..60 {
        for x in 0..80 {
            let (clean, dirty) = (range.depth().pixel(x, y).unwrap(), noisy.depth().pixel(x, y).unwrap());
            if !clean.is_finite() {
                assert!(!dirty.is_finite());
                continue;
            }
            all += 1;
            if !dirty.is_finite() {
                missing += 1;
                continue;
            }
            let (_, direction) = rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
            errors.push((dirty - clean) / direction.dot(camera.pose().matrix3.z_axis));
        }
    }
    let count = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / count;
    let deviation = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / count).sqrt();
    assert!(mean.abs() < 0.003 && (deviation - 0.02).abs() < 0.002, "{mean} {deviation}");
    let share = f64::from(missing) / f64::from(all);
    assert!((share - 0.25).abs() < 0.05, "{share}");
    // Without noise nothing changes; with all missing nothing is left.
    assert_eq!(range.with_noise(&Noise::default()).unwrap(), range);
    let none = range.with_noise(&Noise { missing: 1.0, ..Noise::default() }).unwrap();
    assert!(none.points(Coordinates::World).unwrap().is_empty());
}

#[test]
fn clouds_are_saved() {
    let (_, range) = ball();
    let cloud = range.points(Coordinates::World).unwrap();
    let cloud = cloud.clone().with_colors(vec![[9, 8, 7]; cloud.len()]).unwrap();
    let mut file = Vec::new();
    write_ply_points(&cloud, &mut file).unwrap();
    let header = b"end_header\n";
    let at = file.windows(header.len()).position(|w| w == header).unwrap() + header.len();
    assert_eq!(file.len() - at, 39 * cloud.len());
    let x = f64::from_le_bytes(file[at..at + 8].try_into().unwrap());
    assert_eq!(x, cloud.positions()[0].x);
    assert_eq!(file[file.len() - 3..], [9, 8, 7]);
    let path = std::env::temp_dir().join(format!("rvachev-cloud-{}.ply", std::process::id()));
    cloud.save(&path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), file);
    std::fs::remove_file(path).unwrap();
    assert!(cloud.save("a.las").unwrap_err().to_string().ends_with("known: .ply"));
}

#[test]
fn errors() {
    let (camera, range) = ball();
    let message = |noise| range.with_noise(&noise).unwrap_err().to_string();
    assert!(message(Noise { deviation: -1.0, ..Noise::default() }).starts_with("deviation is -1"));
    assert!(message(Noise { missing: f64::NAN, ..Noise::default() }).starts_with("missing is NaN"));
    let depth = Image::new(2, 1, vec![1.0, f64::NAN]).unwrap();
    let lens = camera.intrinsics(2, 1);
    let good = RangeImage::new(depth.clone(), lens, DAffine3::IDENTITY).unwrap();
    assert_eq!(good.points(Coordinates::World).unwrap().len(), 1);
    assert!(RangeImage::new(depth.clone(), camera.intrinsics(3, 1), DAffine3::IDENTITY).is_err());
    let blind = rvachev::camera::Intrinsics { fx: 0.0, ..lens };
    assert!(RangeImage::new(depth, blind, DAffine3::IDENTITY).unwrap_err().to_string().starts_with("focal length"));
}

#[test]
fn layers_of_extreme_cameras_are_errors_or_have_a_range_image() {
    let ball = Solid::sphere(1.0);
    let eye = DVec3::new(3.0, -4.0, 2.0);
    for size in [5e-324, 1e-300, 1e-9, 1e-8, 1e9, 1e300] {
        let cameras = [
            Camera::perspective(eye, DVec3::ZERO, DVec3::Z, rad(size)),
            Camera::orthographic(eye, DVec3::ZERO, DVec3::Z, size),
        ];
        for layers in cameras.iter().filter_map(|camera| ball.layers(camera, 4, 3).ok()) {
            assert_eq!(layers.range_image().depth().width(), 4);
        }
    }
}
