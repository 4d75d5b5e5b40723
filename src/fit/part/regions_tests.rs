//! Regions of turned bodies, of scans, and of real parts.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3, Vec3};
use rvachev_num::order;

use super::regions::{Form, Regions, detect};
use super::samples::{Kind, Samples};
use crate::fit::random::Random;
use crate::geom::PointCloud;
use crate::{Mesh, Run};

/// An oblique frame.
fn oblique() -> DMat3 {
    DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7)
}

/// A closed outline of radii and heights, counter-clockwise, turned about the z axis of a frame in
/// so many facets.
fn turned(outline: &[[f64; 2]], facets: usize, frame: DMat3) -> Mesh {
    let (count, mut positions, mut triangles) = (outline.len(), Vec::new(), Vec::new());
    for i in 0..facets {
        let (sin, cos) = (TAU * i as f64 / facets as f64).sin_cos();
        positions.extend(outline.iter().map(|[r, z]| (frame * DVec3::new(r * cos, r * sin, *z)).as_vec3()));
        for k in 0..count {
            let l = (k + 1) % count;
            let at = |i: usize, k: usize| (i % facets * count + k) as u32;
            let quad = [at(i, k), at(i + 1, k), at(i + 1, l), at(i, l)];
            triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
    Mesh::new(positions, triangles).unwrap()
}

/// An arc of an outline.
fn arc(centre: [f64; 2], radius: f64, from: f64, to: f64, steps: usize) -> Vec<[f64; 2]> {
    let angle = |i: usize| (from + (to - from) * i as f64 / steps as f64).to_radians();
    (0..=steps).map(|i| [centre[0] + radius * angle(i).cos(), centre[1] + radius * angle(i).sin()]).collect()
}

fn found(samples: &Samples) -> Regions {
    let regions = detect(samples, 1, &Run::default()).unwrap();
    assert_eq!(regions.regions, detect(samples, 1, &Run::default()).unwrap().regions, "one seed, one result");
    for region in &regions.regions {
        let sum: f64 = region.points.iter().map(|i| samples.weights[*i as usize]).sum();
        assert!((sum - region.share).abs() < 1e-9);
    }
    regions
}

fn regions_of(mesh: &Mesh) -> (f64, Regions) {
    let samples = Samples::of_mesh(mesh, 1, &Run::default()).unwrap();
    assert!((samples.weights.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    (samples.size, found(&samples))
}

/// Diameters of cylinders with their signs, in length units, and the axes.
fn cylinders(size: f64, regions: &Regions) -> Vec<(f64, DVec3)> {
    let of = |region: &super::regions::Region| match region.form {
        Form::Cylinder { axis, radius, .. } => Some((2.0 * region.sign * size * radius, axis)),
        _ => None,
    };
    regions.regions.iter().filter_map(of).collect()
}

/// Points of a mesh with normals, noise in diagonals on both.
fn scan(mesh: &Mesh, noise: f64, tilt: f64) -> Samples {
    let samples = Samples::of_mesh(mesh, 7, &Run::default()).unwrap();
    let mut random = Random::new(3);
    let mut bell = |scale: f64| scale * ((0..6).map(|_| random.unit()).sum::<f64>() - 3.0) * std::f64::consts::SQRT_2;
    let points = samples.points.iter().zip(&samples.normals).map(|(p, n)| *p + *n * bell(noise)).collect();
    let turned = |n: &DVec3| (*n + DVec3::new(bell(tilt), bell(tilt), bell(tilt))).normalize().as_vec3();
    let normals = samples.normals.iter().map(turned).collect();
    Samples::of_cloud(&PointCloud::new(points).unwrap().with_normals(normals).unwrap(), 0.0, 1, &Run::default())
        .unwrap()
}

#[test]
fn a_faceted_tube_has_the_radii_of_its_vertices() {
    let axis = oblique().z_axis;
    for facets in [14, 20, 64] {
        let tube = turned(&[[2.0, -3.0], [2.5, -3.0], [2.5, 3.0], [2.0, 3.0]], facets, oblique());
        let (size, regions) = regions_of(&tube);
        let found = cylinders(size, &regions);
        assert_eq!(found.len(), 2, "{facets} facets: {:?}", regions.regions);
        assert!((found[0].0 - 5.0).abs() < 1e-3 && (found[1].0 + 4.0).abs() < 1e-3, "{facets} facets: {found:?}");
        assert!(found.iter().all(|f| f.1.cross(axis).length() < 1e-3));
        assert_eq!(regions.regions.len(), 4);
        for region in &regions.regions {
            if let Form::Cylinder { along, arc, .. } = region.form {
                assert!(size * (along[0] + 3.0 / size).abs() < 1e-3 && size * (along[1] - 3.0 / size).abs() < 1e-3);
                assert!(arc > 330.0);
            }
        }
    }
}

#[test]
fn prisms_are_planes() {
    for sides in [3, 6, 8, 12] {
        let (_, regions) = regions_of(&turned(&[[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]], sides, oblique()));
        assert_eq!(
            regions.regions.len(),
            sides + 2,
            "{:?}",
            regions.regions.iter().map(|r| (r.form, r.share)).collect::<Vec<_>>()
        );
        assert!(regions.regions.iter().all(|r| matches!(r.form, Form::Plane { .. })));
    }
}

#[test]
fn cones_spheres_and_tori_are_told_from_each_other() {
    let cone = turned(&[[0.0, 0.0], [2.0, 0.0], [0.5, 3.0], [0.0, 3.0]], 40, oblique());
    let (size, regions) = regions_of(&cone);
    let Form::Cone { slope, axis, origin, radius, .. } = regions.regions[0].form else { panic!("{regions:?}") };
    let up = axis.dot(oblique().z_axis).signum();
    assert!((up * slope + 0.5).abs() < 1e-3);
    let centre = Samples::of_mesh(&cone, 1, &Run::default()).unwrap().centre;
    let height = (centre + size * origin).dot(oblique().z_axis);
    assert!((size * radius - (2.0 - 0.5 * height)).abs() < 1e-3);

    let ball = turned(&arc([0.0, 0.0], 1.5, -90.0, 90.0, 24), 48, oblique());
    let (size, regions) = regions_of(&ball);
    let Form::Sphere { radius, centre } = regions.regions[0].form else { panic!("{regions:?}") };
    assert!((size * radius - 1.5).abs() < 1e-3 && size * centre.length() < 1e-3 && regions.regions[0].share > 0.99);

    let mut tube = arc([3.0, 0.0], 1.0, 0.0, 360.0, 24);
    tube.pop();
    let ring = turned(&tube, 64, DMat3::IDENTITY);
    let (size, regions) = regions_of(&ring);
    let Form::Torus { major, minor, axis, .. } = regions.regions[0].form else { panic!("{regions:?}") };
    assert!(
        (size * major - 3.0).abs() < 1e-2 && (size * minor - 1.0).abs() < 1e-2,
        "{} {}",
        size * major,
        size * minor
    );
    assert!(axis.z > 0.999 && regions.regions[0].share > 0.95 && regions.regions[0].sign > 0.0);
}

#[test]
fn a_thin_plate_is_no_cylinder() {
    let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32 * 0.7, (i >> 2) as f32 * 0.02);
    let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let plate = Mesh::new((0..8).map(corner).collect(), triangles).unwrap();
    let (_, regions) = regions_of(&plate);
    assert_eq!(regions.regions.len(), 6);
    assert!(regions.regions.iter().all(|r| matches!(r.form, Form::Plane { .. })));
    let samples = scan(&plate, 0.002, 0.05);
    assert!(samples.kind == Kind::Scan && (0.0002..0.001).contains(&samples.noise), "{}", samples.noise);
    let regions = found(&samples);
    assert!(cylinders(1.0, &regions).is_empty(), "{regions:?}");
}

#[test]
fn scans_of_turned_bodies() {
    let outline = [[0.5, -1.0], [1.5, -1.0], [1.5, 1.0], [0.8, 1.0], [0.8, 2.0], [0.5, 2.0]];
    let body = turned(&outline, 90, oblique());
    let size = Samples::of_mesh(&body, 1, &Run::default()).unwrap().size;
    for (noise, slack) in [(0.0, 0.01), (0.002, 0.03)] {
        let samples = scan(&body, noise, 20.0 * noise);
        let regions = found(&samples);
        let found = cylinders(size * samples.size, &regions);
        for diameter in [3.0, 1.6, -1.0] {
            let near = found.iter().filter(|f| (f.0 - diameter).abs() < slack * diameter.abs()).count();
            assert_eq!(near, 1, "{diameter} with noise {noise}: {found:?}");
        }
        assert!(found.iter().all(|f| f.1.cross(oblique().z_axis).length() < 0.03));
    }
}

/// A real part, or a printed line.
#[cfg(feature = "import")]
fn part(name: &str) -> Option<Mesh> {
    let path =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts").join(name).with_extension("ply");
    if !path.exists() {
        println!("{} is missing: skipped", path.display());
        return None;
    }
    Some(Mesh::load(path).unwrap())
}

#[cfg(feature = "import")]
#[test]
fn holes_of_real_parts() {
    let inch = 25.4;
    let Some(mesh) = part("holder") else { return };
    let (size, regions) = regions_of(&mesh);
    let mut diameters: Vec<f64> = cylinders(size, &regions).iter().map(|c| c.0 / inch).collect();
    order::numbers(&mut diameters);
    let meant = [-1.0, -1.0, -1.0, -1.0, -0.75, -0.75, -0.75, -0.75, -0.5, 3.0];
    assert_eq!(diameters.len(), meant.len(), "{diameters:?}");
    assert!(diameters.iter().zip(meant).all(|(d, m)| (d / m - 1.0).abs() < 0.002), "{diameters:?}");

    let Some(mesh) = part("plate_holes") else { return };
    let (_, regions) = regions_of(&mesh);
    let slope = |region: &super::regions::Region| match region.form {
        Form::Cone { slope, .. } if region.sign < 0.0 => Some(slope.abs()),
        _ => None,
    };
    let slopes: Vec<f64> = regions.regions.iter().filter_map(slope).collect();
    assert!(slopes.len() == 4 && slopes.iter().all(|s| (s - 0.86).abs() < 0.03), "{slopes:?}");

    let Some(mesh) = part("round") else { return };
    let (size, regions) = regions_of(&mesh);
    let found = cylinders(size, &regions);
    assert!(found.len() == 2 && (found[0].0 - 5.08).abs() < 0.001 && (found[1].0 + 4.4704).abs() < 0.001, "{found:?}");

    let Some(mesh) = part("machinist") else { return };
    let (size, regions) = regions_of(&mesh);
    let found = cylinders(size, &regions);
    for axis in DVec3::AXES {
        for diameter in [22.225, 15.875, 9.525] {
            let is = |f: &&(f64, DVec3)| (f.0 + diameter).abs() < 0.002 * diameter && f.1.dot(axis).abs() > 0.9999;
            assert_eq!(found.iter().filter(is).count(), 1, "{diameter} along {axis}: {found:?}");
        }
    }
}
