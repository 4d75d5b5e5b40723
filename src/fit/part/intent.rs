//! What the numbers of a part are meant to be.
//!
//! ```text
//!     found                                     meant
//!     cut cylinder: x 21.99998, ⌀ 7.00003       x 22, ⌀ 7       round on the part's scale
//!                   z −5.8282 … 4.00003         z −6 … 6        ends in the open: beyond the face, not in it
//!     box: turned by .0001                      not turned
//! ```
//!
//! Vertices judge: nothing is moved by more than they leave open. Axes were settled when leaves
//! were found; where vertices tell more of a turn than they leave open, the leaf is turned. A
//! number that is not round, but equal to another one, becomes that one. A cut that ends where
//! there is nothing left to cut is lengthened to a round number, as an end in a face would leave a
//! skin there, or not, by the last digit.

use glam::{DAffine3, DMat3, DVec3};
use rvachev_num::order;

use super::leaf::Leaf;
use super::measures::{Measure, tilt};
use super::round::Scale;
use super::through::{BEYOND, ends_in_the_open};
use crate::{Cancelled, Run};

/// How far from a principal axis a leaf may be turned to be along it, in radians, at the most.
const TURNED: f64 = 2e-3;

/// Turns by less, in radians, are rounding.
const LEAST_TURN: f64 = 1e-6;

/// Axes that differ by less, as a sine, were made one, or square.
const SAME: f64 = 1e-9;

/// What vertices leave open of a length at the least, in diagonals, and what is of a leaf's
/// surface.
const OPEN: f64 = 1e-5;
const NEAR: f64 = 3e-3;

/// What is this part of what is open means nothing.
const DIGITS: f64 = 0.1;

/// A number that was made round, a cut that was lengthened, or a leaf that was turned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub(super) leaf: usize,
    pub(super) of: Changed,
    pub(super) measure: Measure,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// What was changed of a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Changed {
    /// Which of its numbers.
    Number(usize),
    /// What turns it back.
    Turn(DAffine3),
}

/// The numbers that a leaf has instead of its own, where they differ.
pub(super) fn changes(leaf: usize, old: &Leaf, numbers: &[f64]) -> Vec<Change> {
    let pairs = old.measures().into_iter().zip(numbers).enumerate();
    let changed = pairs.filter(|(_, ((_, from), to))| from != *to);
    changed
        .map(|(nth, ((measure, from), to))| Change { leaf, of: Changed::Number(nth), measure, from, to: *to })
        .collect()
}

/// A leaf in length units, with what was changed of it.
#[derive(Clone)]
pub(super) struct Meant {
    pub(super) leaf: Leaf,
    pub(super) changes: Vec<Change>,
}

impl Meant {
    pub(super) fn of(leaf: Leaf) -> Meant {
        Meant { leaf, changes: Vec::new() }
    }
}

/// A leaf as it is turned if its axes are not settled.
#[derive(Clone, Debug)]
pub(super) struct Free {
    pub(super) leaf: Leaf,
    /// Whether vertices tell that, and not samples alone.
    pub(super) is_told: bool,
}

impl Free {
    /// What was settled of its axes: a turn of so many radians that is taken back by the motion.
    fn settled(&self, leaf: &Leaf) -> (f64, DAffine3) {
        let back = tilt(&self.leaf, leaf);
        let off = back.matrix3 - DMat3::IDENTITY;
        ((0.5 * off.to_cols_array().iter().map(|x| x * x).sum::<f64>()).sqrt(), back)
    }

    /// What is told of the settled axes of a leaf, which is the nth.
    pub(super) fn turn(&self, nth: usize, leaf: &Leaf) -> Option<Change> {
        let (angle, back) = self.settled(leaf);
        let of = Changed::Turn(back);
        let change = Change { leaf: nth, of, measure: Measure::Turn, from: angle.to_degrees(), to: 0.0 };
        (angle > LEAST_TURN).then_some(change)
    }
}

/// Leaves with whether each adds, in their order.
type Leaves = Vec<(bool, Leaf)>;

/// Whether axes of a leaf are those of coordinates, or along or across those of another one: they
/// were settled, then. What is oblique to all is as it was found.
pub(super) fn is_settled(leaves: &[(bool, Leaf)], nth: usize) -> bool {
    let axes = |leaf: &Leaf| {
        let Leaf { rotation, .. } = leaf;
        let first = if leaf.turns() == 3 { 0 } else { 2 };
        (first..3).map(|axis| rotation.col(axis)).collect::<Vec<_>>()
    };
    let others = leaves.iter().enumerate().filter(|(i, (_, leaf))| *i != nth && leaf.turns() > 0);
    let others: Vec<DVec3> = others.flat_map(|(_, (_, leaf))| axes(leaf)).collect();
    axes(&leaves[nth].1).iter().any(|own| {
        DVec3::AXES.iter().chain(&others).any(|axis| own.cross(*axis).length() < SAME)
            || others.iter().any(|axis| own.dot(*axis).abs() < SAME)
    })
}

/// The leaves with the numbers that are meant, in length units of a part with such vertices and
/// such a diagonal.
pub(super) fn intended(
    leaves: &[(bool, Leaf)],
    free: &[Free],
    vertices: &[DVec3],
    size: f64,
    run: &Run,
) -> Result<(Leaves, Vec<Change>), Cancelled> {
    let open: Vec<f64> = (leaves.iter().zip(free))
        .map(|((_, leaf), free)| open(if free.is_told { &free.leaf } else { leaf }, vertices, size))
        .collect();
    let meant = |(i, (adds, leaf)): (usize, &(bool, Leaf))| {
        // By what a turn moves the ends: that is left open as well. Half-spaces reach all over.
        let reach = if leaf.reach() == DVec3::ZERO { 0.5 * size } else { leaf.reach().length() };
        let within = (open[i] / reach).min(TURNED);
        let is_turned = free[i].is_told && (free[i].settled(leaf).0 > within || !is_settled(leaves, i));
        (*adds, if is_turned { &free[i].leaf } else { leaf }.aligned(within))
    };
    let mut meant: Leaves = leaves.iter().enumerate().map(meant).collect();
    // How far each number may be moved, by leaves.
    let within: Vec<Vec<f64>> = (meant.iter().zip(&open))
        .map(|((_, leaf), open)| leaf.leverages().into_iter().map(|by| by * open).collect())
        .collect();
    let all = meant.iter().flat_map(|(_, leaf)| leaf.measures()).map(|(_, v)| v);
    let scale = Scale::of(&all.zip(within.iter().flatten().copied()).collect::<Vec<_>>(), size);
    let mut numbers: Vec<Vec<f64>> = Vec::new();
    let mut loose = Vec::new();
    // Cuts before one are as they will be: what two of them share is left to one at the least.
    let mut current = meant.clone();
    for (i, (adds, leaf)) in meant.iter().enumerate() {
        run.check()?;
        let ends = if *adds { Vec::new() } else { ends_in_the_open(&current, i, size, 0.0) };
        let number = |(nth, (_, v)): (usize, (Measure, f64))| {
            if let Some(end) = ends.iter().find(|end| end.nth == nth) {
                return scale.beyond(end.face, BEYOND * size, end.up);
            }
            let within = within[i][nth];
            scale.round(v, within).unwrap_or_else(|| {
                loose.push(Loose { leaf: i, nth, within });
                v
            })
        };
        let own: Vec<f64> = leaf.measures().into_iter().enumerate().map(number).collect();
        current[i].1 = leaf.made_of(&own).unwrap_or_else(|| leaf.clone());
        numbers.push(own);
    }
    make_equal(&mut numbers, loose);
    let are_settled: Vec<bool> = (0..meant.len()).map(|i| is_settled(&meant, i)).collect();
    let mut all = Vec::new();
    for (i, (((_, leaf), numbers), free)) in meant.iter_mut().zip(&numbers).zip(free).enumerate() {
        all.extend(free.turn(i, leaf).filter(|_| are_settled[i]));
        let Some(made) = leaf.made_of(numbers) else { continue };
        all.extend(changes(i, leaf, numbers));
        *leaf = made;
    }
    Ok((meant, all))
}

/// A number that is not round.
struct Loose {
    leaf: usize,
    nth: usize,
    within: f64,
}

/// Numbers that are not round, but equal to within what is open, whatever their signs, become one;
/// and they lose the digits that mean nothing.
fn make_equal(numbers: &mut [Vec<f64>], mut loose: Vec<Loose>) {
    let value = |numbers: &[Vec<f64>], l: &Loose| numbers[l.leaf][l.nth];
    order::rising(&mut loose, |a| value(numbers, a).abs());
    let mut rest = &loose[..];
    while let Some(first) = rest.first() {
        let least = value(numbers, first).abs();
        // The number that leaves least open tells how much all of them may be moved.
        let mut within = first.within;
        let is_equal = |l: &&Loose| {
            let common = within.min(l.within);
            let is_equal = value(numbers, l).abs() - least <= common;
            if is_equal {
                within = common;
            }
            is_equal
        };
        let (equal, others) = rest.split_at(rest.iter().take_while(is_equal).count());
        let mean = equal.iter().map(|l| value(numbers, l).abs()).sum::<f64>() / equal.len() as f64;
        // A power of ten that is no more than a part of what is open.
        let places = -(DIGITS * within).log10().floor();
        let unit = 10f64.powi(places.abs() as i32);
        let mean = if places > 0.0 { (mean * unit).round() / unit } else { (mean / unit).round() * unit };
        for l in equal {
            let number = &mut numbers[l.leaf][l.nth];
            *number = mean.copysign(*number);
        }
        rest = others;
    }
}

/// How far the vertices of a leaf leave open where it is: the error of their mean distance, three
/// times.
fn open(leaf: &Leaf, vertices: &[DVec3], size: f64) -> f64 {
    let mut off: Vec<f64> = vertices.iter().map(|p| leaf.distance(*p).abs()).filter(|d| *d < NEAR * size).collect();
    if off.is_empty() {
        return OPEN * size;
    }
    order::numbers(&mut off);
    let spread = 1.5 * off[off.len() / 2];
    OPEN * size + 3.0 * spread / (off.len().min(100) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What leaves are meant to be of which no vertex tells anything.
    fn of(leaves: &[(bool, Leaf)]) -> (Leaves, Vec<Change>) {
        let free: Vec<Free> = leaves.iter().map(|(_, leaf)| Free { leaf: leaf.clone(), is_told: false }).collect();
        intended(leaves, &free, &[], 70.0, &Run::default()).unwrap()
    }

    /// A plate of 60 × 40 × 8 with a hole that ends in its top, a little off round numbers.
    #[test]
    fn numbers_are_round_and_holes_go_through() {
        let plate =
            Leaf::cuboid(DMat3::IDENTITY, [DVec3::new(-30.0003, -20.0, 0.0), DVec3::new(30.0, 19.9998, 8.0001)]);
        let hole = Leaf::cylinder(-DVec3::Z, DVec3::new(10.0002, 5.0, 0.0), 3.4999, [-8.0, 1.8]);
        let pocket = Leaf::cylinder(DVec3::X, DVec3::new(-30.0, 0.0, 4.0), 2.0, [-3.0, 12.0001]);
        let (meant, changes) = of(&[(true, plate), (false, hole), (false, pocket)]);
        let numbers = |i: usize| meant[i].1.measures().into_iter().map(|(_, v)| v).collect::<Vec<_>>();
        assert_eq!(numbers(0), [-30.0, 30.0, -20.0, 20.0, 0.0, 8.0]);
        let hole = numbers(1);
        assert_eq!([hole[0], hole[1], hole[4]], [10.0, 5.0, 7.0]);
        assert!(hole[2] <= -0.7 && hole[2] > -2.0 && hole[3] >= 8.7 && hole[3] < 10.0, "{hole:?}");
        assert_eq!(meant[1].1.rotation, DMat3::IDENTITY);
        // Hardly turned is not turned, which is told and can be taken back.
        let turn = DMat3::from_rotation_z(1e-5);
        let block = Leaf::cuboid(turn, [DVec3::new(-30.0, 4.0, 0.0), DVec3::new(30.0, 9.0, 8.0)]);
        let (upright, told) = of(&[(true, block)]);
        let change = told.iter().find(|change| change.measure == Measure::Turn).expect("it was turned");
        let Changed::Turn(back) = change.of else { panic!("{change:?}") };
        assert!(upright[0].1.rotation == DMat3::IDENTITY && (change.from.to_radians() - 1e-5).abs() < 1e-9);
        assert!((upright[0].1.turned_by(&back).rotation - turn).to_cols_array().iter().all(|off| off.abs() < 1e-9));
        // Numbers that are not round are equal at least, and short.
        let pins = [12.34567, -12.34571].map(|x| (true, Leaf::sphere(DVec3::new(x, 0.0, 0.0), 1.0)));
        let [a, b] = [0, 1].map(|i| of(&pins).0[i].1.centre.x);
        assert!(a == -b && a.to_string().len() <= 8, "{a}");
        // The pocket ends in the plate on one side only.
        let pocket = numbers(2);
        assert_eq!([pocket[3], pocket[4]], [-18.0, 4.0], "{pocket:?}");
        assert!(pocket[2] < -30.6, "{pocket:?}");
        assert!(
            changes.iter().any(|change| change.leaf == 1 && change.measure == Measure::Diameter && change.to == 7.0)
        );
    }

    /// A turn is only told of axes that were made those of coordinates, or of another leaf.
    #[test]
    fn turns_of_what_is_oblique_to_all_are_not_told() {
        let axis = DVec3::new(0.48, 0.6, 0.64);
        let rod = |x: f64, axis: DVec3| (true, Leaf::cylinder(axis, DVec3::X * x, 2.0, [-10.0, 10.0]));
        let told = |axes: [DVec3; 2]| {
            let leaves = [rod(-9.3, axes[0]), rod(8.1, axes[1])];
            let turn = DMat3::from_axis_angle(axis.any_orthonormal_vector(), 1e-3);
            let free = leaves.each_ref().map(|(_, leaf)| Free {
                leaf: Leaf { rotation: turn * leaf.rotation, ..leaf.clone() },
                is_told: false,
            });
            let changes = intended(&leaves, &free, &[], 70.0, &Run::default()).unwrap().1;
            changes.into_iter().filter(|change| change.measure == Measure::Turn).count()
        };
        let other = DVec3::new(0.6, 0.64, -0.48);
        let across = axis.cross(axis.any_orthonormal_vector());
        assert_eq!(
            [told([axis, other]), told([axis, axis]), told([axis, across]), told([axis, DVec3::Z])],
            [0, 2, 2, 1]
        );
    }

    /// What leaves little open is moved by no more than that, though it is equal to what leaves
    /// much open.
    #[test]
    fn equal_numbers_stay_within_what_each_leaves_open() {
        let [found, within] = [[10.0034, 10.0038, 10.0044], [0.1, 0.001, 0.0001]];
        let mut numbers = vec![found.to_vec()];
        let loose = (0..3).map(|nth| Loose { leaf: 0, nth, within: within[nth] }).collect();
        make_equal(&mut numbers, loose);
        assert!(numbers[0][0] == numbers[0][1] && numbers[0][1] != numbers[0][2], "{numbers:?}");
        for nth in 0..3 {
            assert!((numbers[0][nth] - found[nth]).abs() <= 1.1 * within[nth], "{numbers:?}");
        }
    }
}
