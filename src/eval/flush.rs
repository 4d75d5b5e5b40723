//! Operands that begin where others end.
//!
//! ```text
//!     +-------+-------+      Two boxes side by side: the value is 0 on the face that they share, and above 0
//!     |   a   |   b   |      on either side. No range tells, for a and b by themselves have either sign there.
//!     +-------+-------+      But where one leaf is left by the way that another is entered by, and both change
//!                            sign at the same points, they share a face.
//! ```
//!
//! That is seen along some lines across the face. Between them neither leaf can be left by more
//! than the tolerance, for their normals are found to be within an angle of one direction that is
//! small enough for that.

use std::f64::consts::SQRT_2;

use glam::DVec3;

use super::program::{Edge, Kind, Program};
use super::ray::bracket;
use rvachev_field::{Op, Rule, Way, Zone};

/// Of more operands pairs are not looked at.
const MANY: usize = 8;

/// Points of a rectangle that keep off lines through its middle and its corners.
const SHOWN: [[f64; 2]; 5] = [[0.07, -0.13], [0.93, 0.89], [-0.91, 0.97], [-0.94, -0.86], [0.87, -0.96]];

/// Where lines across a face are taken, from one side of a rectangle to the other.
const LINES: [f64; 5] = [-1.0, -0.41, 0.03, 0.52, 1.0];

/// The most that is between two of them, in half widths.
const APART: f64 = 0.6;

/// How far along them a face is looked for.
const REACH: f64 = 3.0;

impl Program {
    /// Whether a rectangle is all inside, because a leaf of a union begins there where another
    /// ends, or all outside, of an intersection: to within `doubt` at some points, and to within
    /// the tolerance between them. `None` where nothing is flush.
    pub(crate) fn flush(&self, zone: &Zone, axes: [DVec3; 2], [doubt, tolerance]: [f64; 2]) -> Option<bool> {
        let node = &self.nodes[self.root.node()];
        let Kind::Join { op, rule: Rule::MinMax, .. } = &node.kind else { return None };
        let operands = self.list(node);
        if !(2..=MANY).contains(&operands.len()) {
            return None;
        }
        // Where it is so it shows at some points, but for those on the very face.
        let is_inside = (*op == Op::Or) != self.root.negated();
        let shows = |[x, y]: [f64; 2]| {
            let p = zone.centre + x * zone.axes.x_axis + y * zone.axes.y_axis;
            (self.value(p) > 0.0) == is_inside
        };
        if !SHOWN.into_iter().all(shows) {
            return None;
        }
        let leaf = |edge: &Edge| {
            let program = self.trimmed(self.nodes.to_vec(), self.operands.to_vec(), self.simpler.to_vec(), *edge);
            (program.leaf_count() == 1).then_some(program)
        };
        let leaves: Vec<Program> = operands.iter().filter_map(leaf).collect();
        let is_flush = |a: &Program, b: &Program| are_flush([a, b], zone, axes, [doubt, tolerance]);
        let any = (0..leaves.len()).any(|i| (0..i).any(|j| is_flush(&leaves[i], &leaves[j])));
        any.then_some(is_inside)
    }
}

/// Whether one of two is left where the other is entered, as far as the first is in a rectangle.
fn are_flush([a, b]: [&Program; 2], zone: &Zone, axes: [DVec3; 2], [doubt, tolerance]: [f64; 2]) -> bool {
    // Both normals are to be within an angle of one direction, which is known before it is proved:
    // in the middle they are opposite to within twice that.
    let slope = |program: &Program| {
        let slope = program.gradient(zone.centre).1;
        axes.map(|axis| slope.dot(axis) * axis).into_iter().sum::<DVec3>()
    };
    let (of_a, of_b) = (slope(a), slope(b));
    let (along, aside) = (-of_a.dot(of_b), of_a.cross(of_b).length());
    let steep = SQRT_2 * tolerance / (APART * zone.radius());
    if steep < 1.0 && aside * (1.0 - steep * steep) > 2.0 * steep * along {
        return false;
    }
    let Some(way) = a.way_in_plane(zone, axes) else { return false };
    let across = way.cross(axes[0].cross(axes[1]));
    // Between the first and the last line is all of the rectangle.
    let half = zone.axes.x_axis.dot(across).abs() + zone.axes.y_axis.dot(across).abs();
    // What rises along both of these is no steeper than the tolerance from one line to the next.
    let lean = APART * half / tolerance * across;
    let ways = |way: DVec3| [way - lean, way + lean].map(|middle| Way { middle, sway: 0.0 });
    if a.enters(zone, &ways(way), 0.0) != 3 || b.enters(zone, &ways(-way), 0.0) != 3 {
        return false;
    }
    LINES.into_iter().all(|line| {
        let start = zone.centre + line * half * across;
        let at = |t: f64| start + t * way;
        let reach = REACH * half;
        if a.value(at(-reach)) > 0.0 || a.value(at(reach)) <= 0.0 {
            return false;
        }
        let (value, ends) = (|t: f64| a.value(at(t)), [-reach, reach]);
        let t = bracket(&value, ends, ends.map(value), 0.0);
        b.value(at(t - doubt)) > 0.0 && b.value(at(t + doubt)) <= 0.0
    })
}
