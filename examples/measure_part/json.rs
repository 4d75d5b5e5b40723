//! What is told of a part, for other programs.

use rvachev::{Mesh, ThicknessReport};

/// What is told of a part, as one line of JSON.
pub fn line(mesh: &Mesh, thickness: &ThicknessReport) -> String {
    let number = |x: f64| if x.is_finite() { x.to_string() } else { "null".into() };
    let [x, y, z] = thickness.at.to_array().map(number);
    format!(
        r#"{{"volume": {}, "area": {}, "components": {}, "closed": {}, "least_thickness": {}, "at": [{x}, {y}, {z}]}}"#,
        number(mesh.volume()),
        number(mesh.area()),
        mesh.components().len(),
        mesh.open_edges().is_closed(),
        number(thickness.least),
    )
}
