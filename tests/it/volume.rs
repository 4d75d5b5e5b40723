//! Meshes of voxel arrays.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rvachev::{
    Cancelled, Mesh, MeshReport, Progress, Run, Solid,
    volume::{Volume, VolumeError, VolumeSettings},
};

use crate::support::{Random, near};

/// Samples of a function at integer points.
fn sampled(size: [usize; 3], f: impl Fn(DVec3) -> f64) -> Vec<f32> {
    let at =
        |n: usize| DVec3::new((n % size[0]) as f64, (n / size[0] % size[1]) as f64, (n / (size[0] * size[1])) as f64);
    (0..size.iter().product()).map(|n| f(at(n)) as f32).collect()
}

#[track_caller]
fn mesh(samples: &[f32], size: [usize; 3]) -> (Mesh, MeshReport) {
    let volume = Volume::new(samples, size, DVec3::ZERO, DVec3::ONE).unwrap();
    let mesh = volume.mesh(&VolumeSettings::default()).unwrap();
    let report = mesh.check();
    let empty = mesh.triangles().is_empty();
    assert!(empty || report.is_sound(), "{size:?}: {report:?}");
    (mesh, report)
}

#[test]
fn a_ball_has_its_volume_and_its_normals() {
    let (size, centre) = ([50, 47, 71], DVec3::new(24.3, 22.9, 33.1));
    let samples = sampled(size, |p| 20.0 - p.distance(centre));
    let (mesh, report) = mesh(&samples, size);
    assert_eq!((report.shells, report.genus), (1, Some(0)));
    near(report.volume, 4.0 / 3.0 * PI * 8000.0, 60.0);
    for (p, n) in mesh.positions().iter().zip(mesh.normals().unwrap()) {
        let outward = (p.as_dvec3() - centre).normalize();
        assert!(n.as_dvec3().distance(outward) < 0.01, "{n} at {p}");
    }
    let volume = Volume::new(&samples, size, DVec3::new(5.0, -3.0, 1.0), DVec3::new(0.5, 1.0, 2.0)).unwrap();
    let moved = volume.mesh(&VolumeSettings::default()).unwrap();
    near(moved.volume(), report.volume, 0.1);
    let first = mesh.positions()[0].as_dvec3() * DVec3::new(0.5, 1.0, 2.0) + DVec3::new(5.0, -3.0, 1.0);
    assert!(moved.positions()[0].as_dvec3().distance(first) < 1e-5);
    let bare = volume.mesh(&VolumeSettings { normals: false, ..VolumeSettings::default() }).unwrap();
    assert!(bare.normals().is_none());
    assert_eq!((bare.positions(), bare.triangles()), (moved.positions(), moved.triangles()));
    // The level is a distance here.
    let smaller = volume.mesh(&VolumeSettings { level: 5.0, ..VolumeSettings::default() }).unwrap();
    near(smaller.volume(), 4.0 / 3.0 * PI * 3375.0, 40.0);
}

#[test]
fn noise_is_closed_and_manifold_at_every_size() {
    let mut random = Random::new(4);
    let sizes = [1, 2, 3, 7, 61, 62, 63, 64, 65, 66, 126, 127, 128, 129, 130];
    for (n, x) in sizes.into_iter().enumerate() {
        let size = [x, 1 + n % 6, 1 + (n * 7) % 5];
        let all = size.iter().product();
        for zeros in [0.0, 0.3] {
            let samples: Vec<f32> = (0..all)
                .map(|_| if random.range(0.0, 1.0) < zeros { 0.0 } else { random.range(-1.0, 1.0) as f32 })
                .collect();
            mesh(&samples, size);
        }
        // Everything inside: the array's own box.
        let (whole, report) = mesh(&vec![1.0; all], size);
        assert_eq!(report.euler_characteristic, 2);
        let far = DVec3::from_array(size.map(|n| n as f64)) - 1.0;
        assert!(whole.bounds().max.distance(far) < 0.01 && whole.bounds().min.length() < 0.01);
    }
}

#[test]
fn numbers_that_are_none_are_outside() {
    let size = [20; 3];
    let mut samples = sampled(size, |p| 6.0 - p.distance(DVec3::splat(9.5)));
    samples[20 * 20 * 10 + 20 * 10 + 10] = f32::NAN;
    samples[20 * 20 * 10 + 20 * 8 + 8] = f32::INFINITY;
    samples[0] = f32::NEG_INFINITY;
    let (mesh, report) = mesh(&samples, size);
    assert_eq!(report.shells, 2);
    assert!(mesh.positions().iter().all(|p| p.is_finite()));
    assert!(mesh.normals().unwrap().iter().all(|n| n.is_finite()));
}

#[test]
fn an_open_mesh_ends_at_the_border() {
    let size = [30, 20, 25];
    let samples = sampled(size, |p| 12.3 - p.z + 0.01 * p.x);
    let volume = Volume::new(&samples, size, DVec3::ZERO, DVec3::ONE).unwrap();
    let open = VolumeSettings { closed: false, ..VolumeSettings::default() };
    let sheet = volume.mesh(&open).unwrap();
    assert_eq!((sheet.positions().len(), sheet.triangles().len()), (30 * 20, 2 * 29 * 19));
    assert!(sheet.positions().iter().all(|p| (p.z - 12.3 - 0.01 * p.x).abs() < 1e-4));
    assert!(sheet.normals().unwrap().iter().all(|n| n.distance(Vec3::Z) < 0.02));
    let report = sheet.check();
    assert_eq!((report.unused_vertices, report.boundary_edges), (0, 2 * (29 + 19)));
    // Too thin for cells.
    let row = Volume::new(&samples[..30], [30, 1, 1], DVec3::ZERO, DVec3::ONE).unwrap();
    assert!(row.mesh(&open).unwrap().positions().is_empty());
    assert!(Volume::new(&[], [5, 0, 3], DVec3::ZERO, DVec3::ONE).unwrap().mesh(&open).unwrap().positions().is_empty());
}

#[test]
fn threads_do_not_change_a_byte_and_progress_is_even() {
    let size = [65, 40, 90];
    let samples = sampled(size, |p| (0.4 * p.x).sin() + (0.5 * p.y).sin() + (0.45 * p.z).sin());
    let volume = Volume::new(&samples, size, DVec3::ZERO, DVec3::ONE).unwrap();
    let with = |threads| {
        let seen = std::sync::Arc::new(std::sync::Mutex::new(Vec::new()));
        let sink = seen.clone();
        let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
        let mesh = volume.mesh_with(&VolumeSettings::default(), &Run { threads, progress, ..Run::default() }).unwrap();
        let seen = seen.lock().unwrap();
        assert!(seen.windows(2).all(|w| w[1] > w[0] && w[1] - w[0] < 0.05), "{seen:?}");
        assert_eq!(seen.last(), Some(&1.0));
        mesh
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
    let run = Run::default();
    run.cancel.cancel();
    assert_eq!(volume.mesh_with(&VolumeSettings::default(), &run).unwrap_err(), VolumeError::Cancelled(Cancelled));
}

#[test]
fn errors_name_the_parameter() {
    let text =
        |samples: &[f32], size, origin, spacing| Volume::new(samples, size, origin, spacing).unwrap_err().to_string();
    let eight = [1.0; 8];
    assert_eq!(
        text(&eight, [2, 2, 3], DVec3::ZERO, DVec3::ONE),
        "8 samples for a size of [2, 2, 3]; allowed: exactly 12"
    );
    assert!(text(&eight, [usize::MAX; 3], DVec3::ZERO, DVec3::ONE).starts_with("8 samples"));
    for spacing in [DVec3::ZERO, DVec3::new(1.0, -1.0, 1.0), DVec3::NAN, DVec3::INFINITY] {
        assert!(text(&eight, [2; 3], DVec3::ZERO, spacing).starts_with("spacing is"));
    }
    for origin in [DVec3::NAN, DVec3::new(0.0, f64::NAN, 0.0), DVec3::INFINITY] {
        assert!(text(&eight, [2; 3], origin, DVec3::ONE).starts_with("origin is"), "{origin}");
    }
    for origin in [DVec3::splat(1e9), DVec3::splat(1e300)] {
        assert!(text(&eight, [2; 3], origin, DVec3::ONE).starts_with("the farthest coordinate"), "{origin}");
    }
    let volume = Volume::new(&eight, [2; 3], DVec3::ZERO, DVec3::ONE).unwrap();
    let error = volume.mesh(&VolumeSettings { level: f32::NAN, ..VolumeSettings::default() }).unwrap_err();
    assert_eq!(error, VolumeError::Level);
}

#[test]
fn voxels_are_a_solid_that_owns_them() {
    let (size, centre) = ([30, 28, 26], DVec3::new(14.3, 13.9, 12.1));
    let samples = sampled(size, |p| 10.0 - p.distance(centre));
    let solid = |level| Solid::from_volume(samples.clone(), size, [1.0, 2.0, 3.0], [0.5; 3], level).unwrap();
    let ball = solid(0.0);
    assert!(ball == solid(0.0) && ball != solid(1.0));
    let middle = 0.5 * centre + DVec3::new(1.0, 2.0, 3.0);
    near(ball.value(middle).unwrap(), 5.0, 0.03);
    near(ball.offset(1.0).value(middle + DVec3::X * 7.0).unwrap(), -1.0, 0.03);
    near(solid(2.0).value(middle).unwrap(), 4.0, 0.03);
    // What reaches the border of the array is closed there.
    let all = Solid::from_volume(vec![1.0; 27], [3; 3], [0.0; 3], [1.0; 3], 0.0).unwrap();
    assert!(all.contains([1.0; 3]).unwrap() && !all.contains([1.0, 1.0, 2.1]).unwrap());
    let wrong = Solid::from_volume(vec![1.0; 26], [3; 3], [0.0; 3], [1.0; 3], 0.0).unwrap_err();
    assert!(matches!(wrong, VolumeError::Samples { .. }));
    let none = Solid::from_volume(vec![-1.0; 27], [3; 3], [0.0; 3], [1.0; 3], 0.0).unwrap();
    assert!(none.bounds().unwrap_err().to_string().contains("triangles"));
}
