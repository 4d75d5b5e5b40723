//! Vertices of the meshes of one solid, against its values about them.

use glam::DVec3;
use rvachev::{Solid, program::Program};

use super::make::bounded;
use super::shapes::meshed;
use super::{Fault, fault};

/// How far a vertex may be off the surface, in cells.
const OFF: f64 = 0.105;

/// Cells along the longest side.
const CELLS: [u32; 2] = [24, 61];

pub fn check(solid: &Solid) -> Result<(), Fault> {
    let Some(solid) = &bounded(solid) else { return Ok(()) };
    let program = solid.surface_program().unwrap();
    for cells in CELLS {
        let mesh = meshed(solid, cells)?;
        let cell = solid.bounds().unwrap().longest_side() / f64::from(cells);
        let positions = mesh.positions().iter().map(|position| position.as_dvec3());
        let off: Vec<DVec3> = positions.clone().filter(|&at| !is_close(&program, at, OFF * cell)).collect();
        let text = || {
            let at = off[0];
            let parts = [0.15, 0.2, 0.3, 0.5, 1.0];
            let away = parts.into_iter().find(|part| is_close(&program, at, part * cell));
            let (value, gradient) = program.gradient(at);
            format!(
                "{} of {} are off, {at} by {away:?} of {cells} cells; {value} {gradient} {cell}",
                off.len(),
                mesh.positions().len()
            )
        };
        fault("vertices", off.is_empty(), text)?;
    }
    Ok(())
}

/// Whether the surface is within a distance of a point, by its value and slope, or as the value
/// changes its sign.
fn is_close(program: &Program, at: DVec3, distance: f64) -> bool {
    let (value, gradient) = program.gradient(at);
    let sign = value > 0.0;
    let along = gradient.normalize_or_zero() * distance * if sign { -1.0 } else { 1.0 };
    let others = |p: DVec3| (program.value(p) > 0.0) != sign;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let about = |n: u32| {
        let z = 1.0 - f64::from(n).mul_add(2.0, 1.0) / 60.0;
        let (radius, turn) = ((1.0 - z * z).sqrt(), golden * f64::from(n));
        DVec3::new(radius * turn.cos(), radius * turn.sin(), z)
    };
    value.abs() <= distance * gradient.length()
        || others(at + along)
        || others(at + 0.3 * along)
        || [1.0, 0.6, 0.2].iter().any(|part| (0..60).any(|n| others(at + part * distance * about(n))))
}
