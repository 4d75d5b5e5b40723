//! Points and sizes as reports tell them.

use glam::DVec3;
use rvachev_num::{figures, figures_beside};

/// A point, as exactly as ten-thousandths of a length tell it.
pub(crate) fn point(at: DVec3, length: f64) -> String {
    const COUNT: usize = 5;
    let [x, y, z] = at.to_array().map(|c| match length > 0.0 {
        true => figures_beside(c, length, digits(c, length, COUNT)),
        false => figures_beside(c, at.abs().max_element(), COUNT),
    });
    format!("({x}, {y}, {z})")
}

/// How many figures a coordinate has down to the last that a length has.
fn digits(c: f64, length: f64, count: usize) -> usize {
    count + (c.abs() / length).max(1.0).log10().ceil().min(12.0) as usize
}

/// The sides of a box.
pub(crate) fn size(size: DVec3) -> String {
    let [x, y, z] = size.to_array().map(|side| figures(side, 6));
    format!("{x} x {y} x {z}")
}
