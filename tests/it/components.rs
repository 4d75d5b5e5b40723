//! The parts of a mesh.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rvachev::{CellSize, Mesh, MeshSettings, Run, Solid};

fn settings(cell: f64) -> MeshSettings {
    MeshSettings { cell: CellSize::Length(cell), ..MeshSettings::default() }
}

#[test]
fn two_cubes_apart_are_two_parts() {
    let cube = |size: f64, x: f64| Solid::cuboid([size; 3]).translate([x, 0.0, 0.0]);
    let both = cube(1.0, 0.0).paint([200, 0, 0]) | cube(2.0, 5.0).paint([0, 0, 200]);
    let mesh = both.mesh(&MeshSettings { owners: true, ..settings(0.2) }).unwrap();
    let mut parts = mesh.components();
    assert_eq!(parts.len(), 2);
    parts.sort_by(|a, b| a.volume().total_cmp(&b.volume()));
    for (part, size, x) in [(&parts[0], 1.0f64, 0.0), (&parts[1], 2.0, 5.0)] {
        assert!((part.volume() - size.powi(3)).abs() < 1e-3 && (part.area() - 6.0 * size * size).abs() < 1e-3);
        assert!((part.bounds().center() - DVec3::X * x).length() < 1e-3);
        let alone = part.mesh();
        let report = alone.check();
        assert!(report.is_sound() && report.shells == 1, "{report}");
        assert_eq!(alone.triangles().len(), part.triangles().len());
        assert!((alone.volume() - part.volume()).abs() < 1e-9);
        // What triangles carry goes along.
        for (n, number) in part.triangles().iter().enumerate() {
            let whole = *number as usize;
            assert_eq!(alone.owners().unwrap()[n], mesh.owners().unwrap()[whole]);
            assert_eq!(alone.corner_colors().unwrap()[n], mesh.corner_colors().unwrap()[whole]);
            assert_eq!(alone.corner_normals().unwrap()[n], mesh.corner_normals().unwrap()[whole]);
        }
    }
    assert_eq!(parts.iter().map(|part| part.triangles().len()).sum::<usize>(), mesh.triangles().len());
}

#[test]
fn a_cavity_is_a_part_of_negative_volume() {
    let hollow = Solid::sphere(2.0) - Solid::sphere(1.0);
    let parts = hollow.mesh(&settings(0.1)).unwrap().components();
    let volumes: Vec<f64> = parts.iter().map(|part| part.volume() * 3.0 / (4.0 * PI)).collect();
    assert!(volumes.len() == 2 && volumes.iter().any(|v| (v - 8.0).abs() < 0.05));
    assert!(volumes.iter().any(|v| (v + 1.0).abs() < 0.01), "{volumes:?}");
}

#[test]
fn a_thousand_spheres() {
    let many = Solid::sphere(0.4).repeat([10, 10, 10], [1.0, 1.0, 1.0]);
    let parts = many.mesh(&settings(0.1)).unwrap().components();
    assert_eq!(parts.len(), 1000);
    let exact = 4.0 / 3.0 * PI * 0.4f64.powi(3);
    assert!(parts.iter().all(|part| (part.volume() / exact - 1.0).abs() < 0.03));
    assert!(parts.iter().all(|part| part.bounds().longest_side() < 0.81));
}

#[test]
fn vertices_join_and_places_do_not() {
    // Two triangles at a vertex, and one at the same place with vertices of its own; a vertex of
    // none.
    let positions =
        vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y, Vec3::ZERO, Vec3::Z, Vec3::ONE, Vec3::X];
    let triangles = vec![[5, 6, 8], [0, 1, 2], [0, 3, 4]];
    let parts = Mesh::new(positions, triangles).unwrap().components();
    let numbers: Vec<&[u32]> = parts.iter().map(|part| part.triangles()).collect();
    assert_eq!(numbers, [&[0][..], &[1, 2]]);
    assert!(Mesh::default().components().is_empty());
    let run = Run::default();
    run.cancel.cancel();
    assert!(Mesh::default().components_with(&run).is_ok());
    assert!(Solid::sphere(1.0).mesh(&settings(0.5)).unwrap().components_with(&run).is_err());
}

#[test]
fn components_are_kept_by_size() {
    let cube = |size: f64, x: f64| Solid::cuboid([size; 3]).translate([x, 0.0, 0.0]);
    let three = cube(1.0, 0.0).paint([200, 0, 0]) | cube(2.0, 5.0).paint([0, 0, 200]) | cube(0.4, 8.0);
    let mesh = three.mesh(&MeshSettings { owners: true, ..settings(0.2) }).unwrap();
    let large = mesh.keep_components(|part| part.volume() > 0.5);
    assert!(large.components().len() == 2 && (large.volume() - 9.0).abs() < 0.01);
    let report = large.check();
    assert!(report.is_sound() && report.shells == 2, "{report}");
    // They are as they were, with all that they carry, in their order.
    let parts = mesh.components();
    let mut kept: Vec<u32> =
        parts.iter().filter(|part| part.volume() > 0.5).flat_map(|part| part.triangles().to_vec()).collect();
    kept.sort_unstable();
    let owners: Vec<u32> = kept.iter().map(|t| mesh.owners().unwrap()[*t as usize]).collect();
    assert_eq!(large.owners(), Some(&owners[..]));
    assert!(mesh.keep_components(|_| false).triangles().is_empty());
    assert_eq!(mesh.keep_components(|_| true).triangles().len(), mesh.triangles().len());
    let run = Run::default();
    run.cancel.cancel();
    assert!(mesh.keep_components_with(|_| true, &run).is_err());
}
