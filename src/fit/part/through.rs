//! Where cuts go through.
//!
//! ```text
//!           |      |          an end beyond which there is nothing to cut is in the open, or in a face:
//!     ......|......|......    it may be moved outwards without a difference
//!           |      |
//!     ......'------'......
//! ```

use glam::{DVec2, DVec3};

use super::leaf::{Leaf, Shape};

/// Points of an end that are asked whether there is anything to cut, and how far out those at its
/// edge are.
const ASKED: usize = 64;
const EDGE: f64 = 0.995;

/// Steps by which a face is looked for, and how finely it is found, in diagonals.
const STEP: f64 = 0.005;
const FINE: f64 = 1e-7;

/// An end is in the open if there is nothing for two times this, in diagonals.
pub(super) const BEYOND: f64 = 0.01;

/// An end of a cut with nothing left to cut beyond it.
pub(super) struct End {
    /// Which of the leaf's numbers it is, and along which of its axes.
    pub(super) nth: usize,
    pub(super) axis: usize,
    /// The face that it goes through, or where it is itself, if that is farther.
    pub(super) face: f64,
    pub(super) up: bool,
    /// How far it is from there to the other end.
    pub(super) depth: f64,
}

/// A cut of a tree with its ends that are in the open, or so near to it, farther out; none of such.
pub(super) fn lengthened(leaves: &[(bool, Leaf)], nth: usize, size: f64, near: f64) -> Option<Leaf> {
    let ends = ends_in_the_open(leaves, nth, size, near);
    let cut = &leaves[nth].1;
    let mut numbers: Vec<f64> = cut.measures().into_iter().map(|(_, v)| v).collect();
    for end in &ends {
        numbers[end.nth] = end.face + if end.up { BEYOND * size } else { -BEYOND * size };
    }
    if ends.is_empty() { None } else { cut.made_of(&numbers) }
}

/// The ends of a cut of a tree that lie in the open, or in a face of what is cut, or nearer to one
/// than given in diagonals. The cuts that follow it are there as well, up to what is added next.
pub(super) fn ends_in_the_open(leaves: &[(bool, Leaf)], nth: usize, size: f64, near: f64) -> Vec<End> {
    let run = leaves[nth..].iter().take_while(|(adds, _)| !*adds).count();
    let (before, cut, after) = (&leaves[..nth], &leaves[nth].1, &leaves[nth..nth + run]);
    let is_solid = |p: DVec3| {
        let mut others = before.iter().chain(after.iter().skip(1));
        // The last one that holds it tells.
        others.rfind(|(_, leaf)| leaf.contains(p)).is_some_and(|(adds, _)| *adds)
    };
    // Of a cone only the size changes with its height; it is left as it is.
    let axes: &[(usize, [usize; 2])] = match &cut.shape {
        Shape::Box(_) => &[(0, [0, 1]), (1, [2, 3]), (2, [4, 5])],
        Shape::Cylinder(_) | Shape::Prism(_) | Shape::Supershape { .. } => &[(2, [2, 3])],
        Shape::RoundedRectangle { .. } => &[(2, [4, 5])],
        Shape::Profile { .. } => &[(2, [0, 1])],
        _ => &[],
    };
    let numbers: Vec<f64> = cut.measures().into_iter().map(|(_, v)| v).collect();
    let points = inner(cut);
    let mut ends = Vec::new();
    for (axis, pair) in axes {
        for (nth, up) in [(pair[0], false), (pair[1], true)] {
            let sign = if up { 1.0 } else { -1.0 };
            let outward = sign * cut.rotation.col(*axis);
            let here = cut.rotation.transpose() * cut.centre;
            let half = (numbers[nth] - here[*axis]).abs();
            // The section of the cut, moved from its end by so many diagonals.
            let moved = |by: f64| {
                let onto =
                    move |p: &DVec3| *p - (*p - cut.centre).dot(outward) * outward + (half + by * size) * outward;
                points.iter().map(onto)
            };
            let steps = [1e-4, 1e-3, 3e-3, BEYOND, 1.5 * BEYOND, 2.0 * BEYOND];
            let mut farther = steps.iter().filter(|by| **by > near);
            let is_free = !points.is_empty() && farther.all(|by| !moved(*by).any(is_solid));
            if is_free {
                // Where what is cut begins, back from the end.
                let is_within = |depth: f64| moved(-depth).any(is_solid);
                let first = (1..200).map(|k| f64::from(k) * STEP).find(|depth| is_within(*depth));
                let depth = first.map_or(0.0, |first| {
                    let [mut clear, mut solid] = [first - STEP, first];
                    while solid - clear > FINE {
                        let middle = 0.5 * (clear + solid);
                        *(if is_within(middle) { &mut solid } else { &mut clear }) = middle;
                    }
                    clear
                });
                let over = (depth * size).min(2.0 * half);
                ends.push(End { nth, axis: *axis, face: numbers[nth] - sign * over, up, depth: 2.0 * half - over });
            }
        }
    }
    ends
}

/// Points inside of a leaf: near evenly, and where it reaches farthest.
fn inner(leaf: &Leaf) -> Vec<DVec3> {
    let reach = leaf.reach();
    let at = |local: DVec3| leaf.centre + leaf.rotation * local;
    let point = |n: u32| {
        let t = |k: f64| 2.0 * (f64::from(n) * k).fract() - 1.0;
        at(reach * DVec3::new(t(0.819_172_513), t(0.671_043_607), t(0.549_700_478)))
    };
    let evenly = (1..2000).map(point).filter(|p| leaf.contains(*p)).take(ASKED);
    let corner = |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -EDGE } else { EDGE });
    let corners = (0..8).map(|k| at(reach * DVec3::from_array(corner(k))));
    let rim = (0..32).map(|k| {
        let on = EDGE * DVec2::from_angle(std::f64::consts::TAU / 32.0 * f64::from(k));
        at(reach * on.extend(0.0))
    });
    let outline = match &leaf.shape {
        Shape::Profile { outline, .. } => &outline.corners[..],
        _ => &[],
    };
    let of_outline = outline.iter().map(|corner| at((EDGE * *corner).extend(0.0)));
    evenly.chain(corners.chain(rim).chain(of_outline).filter(|p| leaf.contains(*p))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A skin that noise leaves over a hole is none, a floor is.
    #[test]
    fn cuts_that_nearly_go_through_do() {
        let plate = Leaf::cuboid(glam::DMat3::IDENTITY, [DVec3::new(-0.4, -0.3, 0.0), DVec3::new(0.4, 0.3, 0.1)]);
        let hole = Leaf::cylinder(DVec3::Z, DVec3::ZERO, 0.1, [0.05, 0.099]);
        let leaves = [(true, plate), (false, hole)];
        assert!(lengthened(&leaves, 1, 1.0, 0.0).is_none());
        let longer = lengthened(&leaves, 1, 1.0, 0.002).expect("one end is in the open");
        let numbers: Vec<f64> = longer.measures().into_iter().map(|(_, v)| v).collect();
        assert!(numbers[3] > 0.105 && (numbers[2] - 0.05).abs() < 1e-12, "{numbers:?}");
    }
}
