//! What a leaf is, in an engineer's words: "hole, ⌀ 6.35, through".

use std::fmt::Write as _;

use super::leaf::{Leaf, Shape};
use super::measures::{across, extent};
use super::patterns::{Layout, Pattern};
use super::result::PartLeaf;
use super::through::{End, ends_in_the_open};
use crate::Supershape;

/// A length in five digits, which is what a drawing has.
pub(super) fn length(v: f64) -> String {
    format!("{v:.4e}").parse::<f64>().map_or_else(|_| v.to_string(), |v| v.to_string())
}

/// Says of each leaf of a tree what it is, in a part of such a size.
pub(super) fn describe(leaves: &mut [PartLeaf], size: f64) {
    let plain: Vec<(bool, Leaf)> = leaves.iter().map(|leaf| (leaf.adds, leaf.leaf.clone())).collect();
    for (i, leaf) in leaves.iter_mut().enumerate() {
        let open = || ends_in_the_open(&plain, i, size, 0.0);
        leaf.text = if leaf.adds { added(&leaf.leaf) } else { cut(&leaf.leaf, &open()) };
    }
}

/// How a pattern is laid out: "5 of them on a circle, ⌀ 44".
pub(super) fn laid_out(pattern: &Pattern) -> String {
    let count = pattern.leaves.len();
    match pattern.layout {
        Layout::Line { step, .. } => format!("{count} of them in a row, {} apart", length(step.length())),
        Layout::Ring { axis, first, .. } => {
            let radius = (first - first.dot(axis) * axis).length();
            if count == 2 {
                return format!("2 of them, turned about an axis, {} apart", length(2.0 * radius));
            }
            format!("{count} of them on a circle, ⌀ {}", length(2.0 * radius))
        }
        Layout::Grid { steps: [along, across], counts: [columns, rows], .. } => {
            let [along, across] = [along, across].map(|step| length(step.length()));
            format!("{columns} × {rows} of them in a grid, {along} × {across} apart")
        }
    }
}

fn joined(lengths: impl IntoIterator<Item = f64>) -> String {
    lengths.into_iter().map(length).collect::<Vec<_>>().join(" × ")
}

fn added(leaf: &Leaf) -> String {
    let height = length(leaf.height());
    match &leaf.shape {
        Shape::HalfSpace => "all on one side of a plane".to_owned(),
        Shape::Box(s) => format!("block, {}", joined(s.size.to_array())),
        Shape::Sphere(s) => format!("ball, ⌀ {}", length(2.0 * s.radius)),
        Shape::Torus(s) => format!("ring, ⌀ {}, of a rod, ⌀ {}", length(2.0 * s.radius), length(2.0 * s.tube)),
        Shape::Cylinder(s) => format!("cylinder, ⌀ {}, {height} high", length(2.0 * s.radius)),
        Shape::Cone(s) => format!("cone, {}, {height} high", widths(s.bottom_radius, s.top_radius)),
        Shape::Superellipsoid(s) => format!("superellipsoid, {}", joined((2.0 * s.semi_axes()).to_array())),
        Shape::Supersolid(s) => supersolid(s),
        _ => format!("{}, {height} high", outline(leaf)),
    }
}

fn cut(leaf: &Leaf, open: &[End]) -> String {
    let of_axis = |axis: usize| open.iter().filter(move |end| end.axis == axis);
    let reach = 2.0 * leaf.reach();
    // Along an axis: how wide it is, how deep from a face, or that it goes through.
    let depth = |axis: usize| match of_axis(axis).collect::<Vec<_>>()[..] {
        [] => Depth::Closed(reach[axis]),
        [end] => Depth::Blind(end.depth),
        _ => Depth::Through,
    };
    let how_deep = || match depth(2) {
        Depth::Closed(length_) => format!("{} long", length(length_)),
        Depth::Blind(length_) => format!("{} deep", length(length_)),
        Depth::Through => "through".to_owned(),
    };
    match &leaf.shape {
        Shape::HalfSpace => "cut off by a plane".to_owned(),
        Shape::Box(_) => box_cut([0, 1, 2].map(depth)),
        Shape::Sphere(s) => format!("hollow of a ball, ⌀ {}", length(2.0 * s.radius)),
        Shape::Torus(s) => format!("groove, ⌀ {}, of a rod, ⌀ {}", length(2.0 * s.radius), length(2.0 * s.tube)),
        Shape::Cylinder(s) => format!("hole, ⌀ {}, {}", length(2.0 * s.radius), how_deep()),
        Shape::Cone(s) => {
            format!("conical hole, {}, {} long", widths(s.bottom_radius, s.top_radius), length(s.height))
        }
        Shape::Superellipsoid(s) => {
            format!("hollow of a superellipsoid, {}", joined((2.0 * s.semi_axes()).to_array()))
        }
        Shape::Supersolid(s) => format!("hollow of a {}", supersolid(s)),
        _ => format!("cut-out, {}, {}", outline(leaf), how_deep()),
    }
}

/// How a cut ends along an axis.
enum Depth {
    /// On both sides in what it is cut from.
    Closed(f64),
    /// So far from a face.
    Blind(f64),
    Through,
}

fn box_cut(depths: [Depth; 3]) -> String {
    let closed: Vec<f64> =
        depths.iter().filter_map(|d| if let Depth::Closed(width) = d { Some(*width) } else { None }).collect();
    let mut text = match closed.len() {
        0 => "corner cut off".to_owned(),
        3 => format!("hollow, {}", joined(closed)),
        _ => format!("cut-out, {} wide", joined(closed)),
    };
    let mut through = false;
    for depth in depths {
        match depth {
            Depth::Closed(_) => {}
            Depth::Blind(depth) => write!(text, ", {} deep", length(depth)).unwrap_or(()),
            Depth::Through => through = true,
        }
    }
    if through { text + ", through" } else { text }
}

fn widths(bottom: f64, top: f64) -> String {
    match (bottom == 0.0, top == 0.0) {
        (false, false) => format!("⌀ {} to ⌀ {}", length(2.0 * bottom), length(2.0 * top)),
        _ => format!("⌀ {}, pointed", length(2.0 * bottom.max(top))),
    }
}

fn supersolid(s: &Supershape) -> String {
    let sizes = joined(extent(s).to_array());
    format!("supershape of {} arms and meridians of {}, {sizes}", length(s.equator().m), length(s.meridian().m))
}

/// What is extruded.
fn outline(leaf: &Leaf) -> String {
    match &leaf.shape {
        Shape::Prism(s) => format!("prism of {} sides, ⌀ {} over corners", s.sides(), length(2.0 * s.radius())),
        Shape::RoundedRectangle { base, .. } => {
            format!("rectangle, {}, corners of radius {}", joined(base.size.to_array()), length(base.radius))
        }
        Shape::Profile { outline, .. } => match (outline.corners.len(), outline.arc_count()) {
            (corners, 0) => format!("outline of {corners} corners"),
            (corners, 1) => format!("outline of {corners} corners, one of its sides an arc"),
            (corners, arcs) => format!("outline of {corners} corners, {arcs} of its sides arcs"),
        },
        Shape::Supershape { base, .. } => {
            format!("supershape of {} arms, {}", length(base.curve().m), joined(across(base).to_array()))
        }
        _ => joined((2.0 * leaf.reach()).to_array()),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DVec3};

    use super::*;

    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Leaf {
        Leaf::cuboid(DMat3::IDENTITY, [low, high].map(DVec3::from_array))
    }

    #[test]
    fn cuts_are_told_by_where_they_end() {
        let hole = |x: f64, radius: f64, low: f64| Leaf::cylinder(DVec3::Z, DVec3::X * x, radius, [low, 9.0]);
        let leaves = [
            (true, cuboid([-30.0, -20.0, 0.0], [30.0, 20.0, 8.0])),
            (false, hole(-12.0, 3.175, -1.0)),
            (false, hole(-12.0, 6.0, 5.0)),
            (false, hole(12.0, 2.5, 2.0)),
            (false, cuboid([20.0, -21.0, 6.0], [24.0, 21.0, 9.0])),
            (true, Leaf::cylinder(DVec3::Z, DVec3::X * 3.0, 4.0, [7.0, 20.0])),
        ];
        let mut leaves = leaves.map(|(adds, leaf)| PartLeaf {
            adds,
            leaf,
            name: String::new(),
            tilt: DAffine3::IDENTITY,
            text: String::new(),
            surface: 0.1,
            seen: 1.0,
        });
        describe(&mut leaves, 75.0);
        let texts = leaves.map(|leaf| leaf.text);
        let expected = [
            "block, 60 × 40 × 8",
            "hole, ⌀ 6.35, through",
            "hole, ⌀ 12, 3 deep",
            "hole, ⌀ 5, 6 deep",
            "cut-out, 4 wide, 2 deep, through",
            "cylinder, ⌀ 8, 13 high",
        ];
        assert_eq!(texts, expected);
        let layout = Layout::Ring { centre: DVec3::ZERO, axis: DVec3::Z, first: DVec3::new(22.0, 0.0, 3.0) };
        assert_eq!(laid_out(&Pattern { leaves: vec![1; 5], layout }), "5 of them on a circle, ⌀ 44");
    }
}
