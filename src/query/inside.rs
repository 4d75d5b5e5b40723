//! Whether a point is inside where the value is 0.
//!
//! ```text
//!     +-------+-------+      On the face that two boxes share the value is 0, and inside is all around: such a
//!     |       o       |      point is inside. One on the surface has some outside beside it: along a normal, or,
//!     +-------+-------+      on an edge, where two faces are left, or three at a corner.
//! ```

use glam::DVec3;

use crate::eval::{AROUND, BESIDE, Compiled, Program, ROUNDING, limited};

/// Normals that differ by less are one.
const SAME: f64 = 1e-4;

/// Whether a point is inside, or inside is all around it.
pub(super) fn is_inside(programs: &Compiled, p: DVec3) -> bool {
    let program = &programs.surface;
    let value = program.value(p);
    if value > 0.0 || p.is_nan() {
        return value > 0.0;
    }
    // Where its value is taken.
    let p = DVec3::from(limited(p));
    let size = if programs.bounds().is_finite() { programs.bounds().longest_side() } else { 1.0 };
    let scale = size + p.abs().max_element();
    value > -ROUNDING * scale && is_surrounded(program, p, scale)
}

/// How long a ray that starts in a face that operands share is in what counts as inside; else 0.
pub(super) fn joint(programs: &Compiled, origin: DVec3) -> f64 {
    // Values of 0 at jumps say nothing of faces.
    let program = &programs.surface;
    if program.value(origin) > 0.0 || program.jumps() || !is_inside(programs, origin) {
        return 0.0;
    }
    let size = if programs.bounds().is_finite() { programs.bounds().longest_side() } else { 1.0 };
    BESIDE * (size + origin.abs().max_element())
}

/// Whether inside is all around a point on the surface of the program's operands.
fn is_surrounded(program: &Program, p: DVec3, scale: f64) -> bool {
    let by = BESIDE * scale;
    let mut normals: Vec<DVec3> = Vec::new();
    for direction in AROUND {
        let (value, slope) = program.gradient(p + by * DVec3::from_array(direction));
        if value <= -ROUNDING * scale {
            return false;
        }
        let normal = slope.normalize_or_zero();
        if normal != DVec3::ZERO && normals.iter().all(|other| other.distance(normal) > SAME) {
            normals.push(normal);
        }
    }
    let is_inside = |out: DVec3| out.try_normalize().is_none_or(|out| program.value(p - by * out) > -ROUNDING * scale);
    let n = &normals;
    (0..n.len()).all(|i| {
        is_inside(n[i]) && (0..i).all(|j| is_inside(n[i] + n[j]) && (0..j).all(|k| is_inside(n[i] + n[j] + n[k])))
    })
}
