//! Settings, cameras and reports as data.

use rvachev::{
    Bounds, Camera, CellSize, Features, MeshReport, MeshSettings, RenderSettings, SaveSettings, Solid, Style, deg,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

fn again<T: Serialize + DeserializeOwned>(data: &T) -> T {
    serde_json::from_str(&serde_json::to_string(data).unwrap()).unwrap()
}

#[test]
fn what_is_written_is_read_again() {
    let settings = RenderSettings { style: Style::Technical, softness: deg(9.0), ..RenderSettings::default() };
    assert_eq!(again(&settings), settings);
    let bounds = Bounds::new([-1.0, 0.25, 3.0], [2.0, 5.0, 1e9]);
    assert_eq!(again(&bounds), bounds);
    let camera = Camera::framing(&bounds).orbit(deg(30.0), deg(10.0));
    assert_eq!(again(&camera), camera);
    let meshing = MeshSettings { cell: CellSize::LongestSide(12), features: Features::Smooth, ..Default::default() };
    let read = again(&meshing);
    assert_eq!((read.cell, read.features, read.bounds), (meshing.cell, meshing.features, None));
    let report: MeshReport = Solid::sphere(1.0).mesh(&meshing).unwrap().check();
    assert_eq!(again(&report), report);
}

#[test]
fn what_is_not_written_is_the_default() {
    let settings: RenderSettings = serde_json::from_str(r#"{"width": 320}"#).unwrap();
    assert_eq!(settings, RenderSettings { width: 320, ..RenderSettings::default() });
    let settings: SaveSettings = serde_json::from_str("{}").unwrap();
    assert_eq!(settings, SaveSettings::default());
}
