//! `Display` of a solid: an indented tree.

use std::collections::{HashMap, HashSet};
use std::fmt::{self, Write};

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::signature::in_order;
use super::{Node, Solid};

/// How many lines are written without being asked for more.
const LINES: usize = 60;

/// How many characters of a node's parameters are written.
const WIDTH: usize = 160;

/// From this depth on lines are indented no further and say their depth.
const DEEPEST: usize = 24;

/// A line for every node, operands indented below their operator, names in front of what they
/// name. A part with operands that is used in several places is written out once.
///
/// Numbers of affine maps are rounded to nine digits, angles are in degrees. After 60 lines
/// the rest is counted; `{:.10}` stops after ten lines, `{:#}` writes everything, long
/// parameters too.
///
/// ```
/// use rvachev::{deg, Solid};
///
/// let hole = Solid::cylinder(0.5, 2.0).named("hole");
/// let plate = Solid::cuboid([4.0, 4.0, 1.0]) - hole.translate([1.0, 0.0, 0.0]) - hole.rotate_x(deg(90.0));
/// assert_eq!(plate.to_string(), "\
/// difference by P(2.0)
///   difference by P(2.0)
///     box { size: DVec3(4.0, 4.0, 1.0) }
///     translate (1, 0, 0)
///       part 1, hole: cylinder { radius: 0.5, height: 2.0 }
///   rotate_x 90° about (1, 0, 0)
///     part 1 again");
/// assert_eq!(format!("{plate:.1}"), "difference by P(2.0)\n... and 6 more lines");
/// ```
impl fmt::Display for Solid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (limit, width) =
            if f.alternate() { (usize::MAX, usize::MAX) } else { (f.precision().unwrap_or(LINES), WIDTH) };
        let mut parts = Parts::of(self);
        let mut lines = 0;
        let mut pending = vec![(self, 0)];
        while let Some((solid, depth)) = pending.pop() {
            let (heading, node) = parts.head(solid);
            if let Some(node) = node {
                pending.extend(node.operands().iter().rev().map(|operand| (operand, depth + 1)));
            }
            if lines < limit {
                if lines > 0 {
                    f.write_char('\n')?;
                }
                for _ in 0..depth.min(DEEPEST) {
                    f.write_str("  ")?;
                }
                if depth > DEEPEST {
                    write!(f, "(depth {depth}) ")?;
                }
                f.write_str(&heading)?;
                if let Some(node) = node {
                    f.write_str(&cut(label(node), width))?;
                }
            }
            lines += 1;
        }
        if lines > limit {
            write!(f, "{}... and {} more lines", if limit == 0 { "" } else { "\n" }, lines - limit)?;
        }
        Ok(())
    }
}

/// The parts that are used several times, and their numbers in the order of their first line.
struct Parts {
    shared: HashSet<usize>,
    numbers: HashMap<usize, usize>,
}

impl Parts {
    fn of(root: &Solid) -> Parts {
        let (mut met, mut shared) = (HashSet::new(), HashSet::new());
        for solid in in_order(root) {
            for operand in solid.node().operands() {
                if !met.insert(operand.address()) && !operand.node().operands().is_empty() {
                    shared.insert(operand.address());
                }
            }
        }
        Parts { shared, numbers: HashMap::new() }
    }

    /// What stands in front of a node's own text, and that node below its names; none if it
    /// has been written before.
    fn head<'a>(&mut self, solid: &'a Solid) -> (String, Option<&'a Node>) {
        let mut heading = String::new();
        let mut solid = solid;
        loop {
            if self.shared.contains(&solid.address()) {
                let next = self.numbers.len() + 1;
                let number = *self.numbers.entry(solid.address()).or_insert(next);
                if number != next {
                    let _ = write!(heading, "part {number} again");
                    return (heading, None);
                }
                let _ = write!(heading, "part {number}, ");
            }
            match solid.node() {
                Node::Named { operand, name } => {
                    let _ = write!(heading, "{name}: ");
                    solid = operand;
                }
                node => return (heading, Some(node)),
            }
        }
    }
}

/// A node in words, without its operands.
pub(super) fn label(node: &Node) -> String {
    let name = node.name();
    match node {
        Node::Affine { forward, .. } => format!("{name} {}", affine(forward, name)),
        node => {
            // The type's name says nothing that the node's does not.
            let parameters = node.parameters();
            let rest = match node {
                Node::Leaf(_) | Node::Warp { .. } => {
                    parameters.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_')
                }
                _ => &parameters,
            };
            let gap = if rest.is_empty() || rest.starts_with([' ', '(']) { "" } else { " " };
            format!("{name}{gap}{rest}")
        }
    }
}

/// The numbers of an affine map: of a translation its vector, of a scaling its factors, of a
/// rotation angle and axis, else the images of the axes and of the origin.
fn affine(map: &DAffine3, name: &str) -> String {
    let DAffine3 { matrix3: m, translation } = map;
    let diagonal = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
    let moved = *translation != DVec3::ZERO;
    let apart =
        (*m * m.transpose() - DMat3::IDENTITY).to_cols_array().into_iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    if !moved && apart < 1e-12 && m.determinant() > 0.0 && (name.starts_with("rotate") || *m != DMat3::IDENTITY) {
        let (axis, angle) = DQuat::from_mat3(m).to_axis_angle();
        // The least negative of the two ways to say it.
        let (axis, angle) = if axis.element_sum() < 0.0 { (-axis, -angle) } else { (axis, angle) };
        return format!("{}° about {}", number(angle.to_degrees()), vector(axis));
    }
    if *m == DMat3::IDENTITY {
        return vector(*translation);
    }
    if !moved && *m == DMat3::from_diagonal(diagonal) {
        let same = diagonal.x == diagonal.y && diagonal.y == diagonal.z;
        return if same { number(diagonal.x) } else { vector(diagonal) };
    }
    let mut text = format!("x to {}, y to {}, z to {}", vector(m.x_axis), vector(m.y_axis), vector(m.z_axis));
    if moved {
        let _ = write!(text, ", origin to {}", vector(*translation));
    }
    text
}

fn vector(v: DVec3) -> String {
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}

/// A number to nine digits, without trailing zeros; no negative zero.
fn number(v: f64) -> String {
    let rounded: f64 = format!("{v:.8e}").parse().unwrap_or(v);
    // What rounding left of 0 beside numbers of the order of 1.
    let rounded = if rounded.abs() < 1e-15 { 0.0 } else { rounded };
    format!("{rounded}")
}

/// The text, its end left out if it is too long.
fn cut(text: String, width: usize) -> String {
    match text.char_indices().nth(width) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
