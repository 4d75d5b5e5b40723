//! Shapes through two points with normals.
//!
//! ```text
//!     surface of revolution      seen along the axis, normals meet at the centre:  pₐ − tₐmₐ = p_b − t_b·m_b
//!       radii |t|, slopes −σ·n_z/|n_xy|         alike: a cylinder or cone
//!       else in the half-plane through the axis, normals meet in the tube: a torus
//!     sphere                     normals meet at the centre
//! ```

use glam::{DMat3, DVec2, DVec3};

use super::columns::Shape;
use super::seeds::Seed;

/// Normals less steep across the axis tell no radius.
const ACROSS: f64 = 0.3;

/// The sine of the least angle of lines that meet.
const MEETING: f64 = 0.07;

/// Tubes of tori that turn less than this between two points tell no radius.
const BENDING: f64 = 0.17;

/// Tori have a hole: their radius is this times that of the tube at least.
const RING: f64 = 1.02;

/// Radii, in diagonals.
const RADII: std::ops::Range<f64> = 0.0015..1.0;

/// How much the two points may contradict each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slack {
    /// Of radii, in parts of the larger one.
    pub(super) radius: f64,
    /// Of angles, in radians.
    pub(super) angle: f64,
    /// Slopes below this are 0.
    pub(super) slope: f64,
}

/// How far back on two lines they meet: pₐ − tₐ·mₐ = p_b − t_b·m_b.
fn meeting(apart: DVec2, a: DVec2, b: DVec2, least: f64) -> Option<[f64; 2]> {
    let sine = a.perp_dot(b);
    (sine.abs() > least).then(|| [apart.perp_dot(b) / sine, apart.perp_dot(a) / sine])
}

/// Whether two signed radii are alike; their sign.
fn alike(radii: [f64; 2], slack: f64) -> Option<f64> {
    let [a, b] = radii;
    let larger = a.abs().max(b.abs());
    (a * b > 0.0 && RADII.contains(&larger) && (a.abs() - b.abs()).abs() <= slack * larger).then(|| a.signum())
}

/// The cylinder, cone or torus about the z axis of a frame that two seeds are of.
pub(super) fn revolved(frame: &DMat3, [a, b]: [Seed; 2], slack: Slack) -> Option<Shape> {
    let inverse = frame.transpose();
    let [pa, pb] = [inverse * a.point, inverse * b.point];
    let [na, nb] = [inverse * a.normal, inverse * b.normal];
    let across = [na.truncate().length(), nb.truncate().length()];
    if across[0] < ACROSS || across[1] < ACROSS {
        return None;
    }
    let [ma, mb] = [na.truncate() / across[0], nb.truncate() / across[1]];
    let t = meeting(pa.truncate() - pb.truncate(), ma, mb, MEETING)?;
    if t[0] * t[1] <= 0.0 {
        return None;
    }
    let sign = t[0].signum();
    let centre = (0.5 * (pa.truncate() - t[0] * ma + pb.truncate() - t[1] * mb)).to_array();
    let tilts = [(-sign * na.z / across[0]).atan(), (-sign * nb.z / across[1]).atan()];
    if (tilts[0] - tilts[1]).abs() <= slack.angle {
        let mut slope = (0.5 * (tilts[0] + tilts[1])).tan();
        if slope.abs() < slack.slope {
            slope = 0.0;
        }
        let radii = [t[0].abs() - slope * pa.z, t[1].abs() - slope * pb.z];
        let larger = t[0].abs().max(t[1].abs());
        let agree = RADII.contains(&larger) && (radii[0] - radii[1]).abs() <= slack.radius * larger;
        return agree.then(|| Shape::Cone { centre, radius: 0.5 * (radii[0] + radii[1]), slope, sign });
    }
    let [qa, qb] = [DVec2::new(t[0].abs(), pa.z), DVec2::new(t[1].abs(), pb.z)];
    let [va, vb] = [DVec2::new(sign * across[0], na.z), DVec2::new(sign * across[1], nb.z)];
    let tube = meeting(qa - qb, va, vb, BENDING)?;
    let sign = alike(tube, slack.radius)?;
    let middle = 0.5 * (qa - tube[0] * va + qb - tube[1] * vb);
    let minor = 0.5 * (tube[0] + tube[1]).abs();
    let fits = RADII.contains(&middle.x) && middle.x > RING * minor;
    fits.then(|| Shape::Torus { centre: DVec3::new(centre[0], centre[1], middle.y), major: middle.x, minor, sign })
}

/// The sphere that two seeds are of.
pub(super) fn sphere([a, b]: [Seed; 2], slack: Slack) -> Option<Shape> {
    let cosine = a.normal.dot(b.normal);
    let sine = 1.0 - cosine * cosine;
    if sine < 4.0 * MEETING * MEETING {
        return None;
    }
    let apart = a.point - b.point;
    let [da, db] = [a.normal.dot(apart), b.normal.dot(apart)];
    let tb = (cosine * da - db) / sine;
    let ta = da + cosine * tb;
    let sign = alike([ta, tb], slack.radius)?;
    let [ca, cb] = [a.point - ta * a.normal, b.point - tb * b.normal];
    let radius = 0.5 * (ta + tb).abs();
    (ca.distance(cb) <= slack.radius * radius).then(|| Shape::Sphere { centre: 0.5 * (ca + cb), radius, sign })
}
