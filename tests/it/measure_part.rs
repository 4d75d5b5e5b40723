//! What the example `measure_part` tells other programs.

use glam::DVec3;
use rvachev::io::{FileFormat, LoadSettings, write_stl};
use rvachev::{CellSize, Mesh, MeshSettings, MeshSolid, Run, Solid};
use serde_json::Value;

#[path = "../../examples/measure_part/json.rs"]
mod json;

/// The line of a file, as the example makes it.
fn told(mesh: &Mesh) -> Value {
    let mut file = Vec::new();
    write_stl(mesh, &mut file).unwrap();
    let mesh = Mesh::read(FileFormat::Stl, &file[..], &LoadSettings::default()).unwrap();
    let solid = Solid::from_mesh(&mesh, MeshSolid::default());
    let line = json::line(&mesh, &solid.thickness(&MeshSettings::default(), &Run::default()).unwrap());
    assert!(!line.contains('\n'), "{line}");
    let value: Value = serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line}"));
    let keys: Vec<&String> = value.as_object().expect("an object").keys().collect();
    let mut expected = ["volume", "area", "components", "closed", "least_thickness", "at"];
    expected.sort_unstable();
    assert!(keys.len() == 6 && expected.iter().all(|key| keys.iter().any(|own| own == key)), "{line}");
    value
}

#[test]
fn a_part_is_told_in_one_line_of_json() {
    // A box open above whose walls are 1 and whose bottom is 3, and a block beside it.
    let box_ = Solid::cuboid([20.0, 16.0, 12.0]) - Solid::cuboid([18.0, 14.0, 12.0]).translate([0.0, 0.0, 3.0]);
    let part = box_ | Solid::cuboid([4.0, 4.0, 4.0]).translate([20.0, 0.0, 0.0]);
    let settings = MeshSettings { cell: CellSize::Tolerance(0.01), ..MeshSettings::default() };
    let mesh = part.mesh(&settings).unwrap();
    let value = told(&mesh);
    let number = |key: &str| value[key].as_f64().unwrap_or_else(|| panic!("{key} of {value}"));
    let (volume, area) = (20.0 * 16.0 * 12.0 - 18.0 * 14.0 * 9.0 + 64.0, 2.0 * 320.0 + 72.0 * 12.0 + 64.0 * 9.0 + 96.0);
    assert!((number("volume") / volume - 1.0).abs() < 1e-3, "{value}");
    assert!((number("area") / area - 1.0).abs() < 1e-3, "{value}");
    assert!(value["components"] == 2 && value["closed"] == true, "{value}");
    assert!((number("least_thickness") - 1.0).abs() < 0.01, "{value}");
    let at: Vec<f64> = value["at"].as_array().expect("coordinates").iter().filter_map(Value::as_f64).collect();
    let at = DVec3::from_slice(&at);
    // Of a wall.
    let outside = at.abs() - DVec3::new(9.0, 7.0, 0.0);
    assert!(
        outside.max_element() > -0.1 && part.closest_surface_point(at).unwrap().unwrap().distance(at) < 0.1,
        "{at}"
    );
    // Without a triangle it is open.
    let open = Mesh::new(mesh.positions().to_vec(), mesh.triangles()[1..].to_vec()).unwrap();
    assert_eq!(told(&open)["closed"], false);
}
