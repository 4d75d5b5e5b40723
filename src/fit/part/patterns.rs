//! Equal leaves on a line, a ring or a grid.
//!
//! ```text
//!     o  o  o  o           o           o   o   o
//!                       o     o        o   o   o
//!       line              o o          o   o   o
//! ```

use glam::{DMat3, DVec3};

use super::result::{PartFit, PartLeaf};

/// Leaves are equal whose sizes differ by less, and in place that are nearer than that to it: in
/// parts of the part's size.
const EQUAL: f64 = 5e-4;
const PLACED: f64 = 1e-3;

/// Axes are one within this sine, and turned shapes within this distance of their rotations.
const ALONG: f64 = 2e-3;

/// Leaves of a line and of a ring at least.
const LINE: usize = 3;
const RING: usize = 3;

/// Equal leaves that are placed by a rule.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pattern {
    /// Their places in [`PartFit::leaves`], in the order of the rule.
    pub leaves: Vec<usize>,
    /// Where they are.
    pub layout: Layout,
}

/// Where the leaves of a pattern are, in length units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Layout {
    /// Three or more, each a step from the one before.
    Line {
        /// The centre of the first.
        first: DVec3,
        /// From one to the next.
        step: DVec3,
    },
    /// Three or more at equal angles all around an axis.
    Ring {
        /// The middle.
        centre: DVec3,
        /// The unit axis.
        axis: DVec3,
        /// From the middle to the centre of the first.
        first: DVec3,
    },
    /// Rows of columns, two or more of each; the columns of a row follow each other.
    Grid {
        /// The centre of the first.
        first: DVec3,
        /// From one to the next in a row, and from one row to the next.
        steps: [DVec3; 2],
        /// Leaves of a row, and rows.
        counts: [usize; 2],
    },
}

impl PartFit {
    /// Leaves that are equal but for their places, which are on a line, a ring or a grid: of the
    /// leaves that have the same kind, sizes and direction. A leaf is in one pattern at most. Those
    /// of more leaves come first. In the [solid](PartFit::solid) a pattern is its first leaf, repeated,
    /// unless something of the other sign comes between its leaves.
    ///
    /// ```
    /// use rvachev::fit::{Layout, PartSettings, part};
    /// use rvachev::{MeshSettings, Solid};
    ///
    /// let hole = |x: f64| Solid::cylinder(3.0, 20.0).translate([x, 0.0, 0.0]);
    /// let plate = Solid::cuboid([60.0, 20.0, 8.0]) - hole(-20.0) - hole(0.0) - hole(20.0);
    /// let found = part(&plate.mesh(&MeshSettings::default())?, &PartSettings::default())?;
    /// let patterns = found.patterns();
    /// let Layout::Line { step, .. } = patterns[0].layout else { panic!("a line") };
    /// assert!(patterns[0].leaves.len() == 3 && (step.x.abs() - 20.0).abs() < 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn patterns(&self) -> Vec<Pattern> {
        let size = self.solid.bounds().map_or(1.0, |bounds| bounds.size().length());
        patterns_of(&self.leaves, size)
    }
}

/// The patterns of leaves of a part of a size.
pub(super) fn patterns_of(leaves: &[PartLeaf], size: f64) -> Vec<Pattern> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, leaf) in leaves.iter().enumerate() {
        match groups.iter_mut().find(|group| is_equal(&leaves[group[0]], leaf, size)) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    let mut patterns = Vec::new();
    for mut left in groups {
        let axis = leaves[left[0]].leaf.rotation.z_axis;
        let at = |i: &usize| leaves[*i].leaf.centre;
        while left.len() >= LINE {
            let best = [all(&left, axis, &at, PLACED * size), line(&left, &at, PLACED * size)]
                .into_iter()
                .flatten()
                .max_by_key(|pattern| pattern.leaves.len());
            let Some(best) = best else { break };
            left.retain(|i| !best.leaves.contains(i));
            patterns.push(best);
        }
    }
    patterns.sort_by_key(|pattern| (usize::MAX - pattern.leaves.len(), pattern.leaves[0]));
    patterns
}

/// Whether two leaves differ by their places only.
fn is_equal(a: &PartLeaf, b: &PartLeaf, size: f64) -> bool {
    let (p, q) = (a.leaf.sizes(), b.leaf.sizes());
    let sizes = p.len() == q.len() && p.iter().zip(&q).all(|(p, q)| (p - q).abs() < EQUAL * size);
    let turned = if a.leaf.is_round() {
        a.leaf.rotation.z_axis.distance(b.leaf.rotation.z_axis) < ALONG
    } else {
        let off: DMat3 = a.leaf.rotation - b.leaf.rotation;
        off.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt() < 2.0 * ALONG
    };
    a.adds == b.adds && a.leaf.kind() == b.leaf.kind() && sizes && turned
}

/// A ring or a grid of all of a group.
fn all(group: &[usize], axis: DVec3, at: &impl Fn(&usize) -> DVec3, near: f64) -> Option<Pattern> {
    ring(group, axis, at, near).or_else(|| grid(group, at, near))
}

fn ring(group: &[usize], axis: DVec3, at: &impl Fn(&usize) -> DVec3, near: f64) -> Option<Pattern> {
    let count = group.len() as f64;
    let centre = group.iter().map(at).sum::<DVec3>() / count;
    let first = at(&group[0]) - centre;
    let round = axis.cross(first);
    if group.len() < RING || first.dot(axis).abs() > near || first.length() < 4.0 * near {
        return None;
    }
    let turn = |i: &usize| {
        let d = at(i) - centre;
        (round.dot(d) / first.length()).atan2(first.dot(d) / first.length()).rem_euclid(std::f64::consts::TAU)
    };
    let mut leaves = group.to_vec();
    // The first one's angle may be a little below a whole turn.
    leaves.sort_by(|i, j| turn(i).total_cmp(&turn(j)));
    let whole = leaves.iter().position(|i| *i == group[0])?;
    leaves.rotate_left(whole);
    let sector = std::f64::consts::TAU / count;
    let placed = leaves.iter().enumerate().all(|(k, i)| {
        let (sin, cos) = (sector * k as f64).sin_cos();
        (centre + cos * first + sin * round).distance(at(i)) < near
    });
    placed.then_some(Pattern { leaves, layout: Layout::Ring { centre, axis, first } })
}

fn grid(group: &[usize], at: &impl Fn(&usize) -> DVec3, near: f64) -> Option<Pattern> {
    // From the leaf that is farthest out the rows go to its neighbours.
    let centre = group.iter().map(at).sum::<DVec3>() / group.len() as f64;
    let corner = *group
        .iter()
        .max_by(|i, j| at(i).distance_squared(centre).total_cmp(&at(j).distance_squared(centre)).then(j.cmp(i)))?;
    let mut away: Vec<DVec3> = group.iter().filter(|i| **i != corner).map(|i| at(i) - at(&corner)).collect();
    away.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let along = *away.first()?;
    let across = *away.iter().find(|d| d.dot(along).abs() < near * along.length().max(near))?;
    let steps = [along, across];
    let place = |i: &usize| {
        let d = at(i) - at(&corner);
        let [a, b] = steps.map(|step| (d.dot(step) / step.length_squared()).round());
        (d.distance(a * along + b * across) < near && a >= 0.0 && b >= 0.0).then_some([a as usize, b as usize])
    };
    let places: Vec<[usize; 2]> = group.iter().map(place).collect::<Option<_>>()?;
    let counts = [0, 1].map(|k| places.iter().map(|p| p[k] + 1).max().unwrap_or(0));
    if counts[0] * counts[1] != group.len() || counts.contains(&1) {
        return None;
    }
    let mut order: Vec<usize> = (0..group.len()).collect();
    order.sort_by_key(|k| places[*k][1] * counts[0] + places[*k][0]);
    let leaves: Vec<usize> = order.iter().map(|k| group[*k]).collect();
    let is_full = order.iter().enumerate().all(|(n, k)| places[*k] == [n % counts[0], n / counts[0]]);
    is_full.then(|| Pattern { leaves, layout: Layout::Grid { first: at(&corner), steps, counts } })
}

/// The longest line of a group.
fn line(group: &[usize], at: &impl Fn(&usize) -> DVec3, near: f64) -> Option<Pattern> {
    let mut best: Option<Pattern> = None;
    for first in group {
        for second in group.iter().filter(|i| *i != first) {
            let step = at(second) - at(first);
            if step.length() < 4.0 * near {
                continue;
            }
            let mut leaves = vec![*first];
            while let Some(next) = group
                .iter()
                .find(|i| at(i).distance(at(first) + leaves.len() as f64 * step) < near && !leaves.contains(i))
            {
                leaves.push(*next);
            }
            let most = best.as_ref().map_or(LINE - 1, |pattern| pattern.leaves.len());
            if leaves.len() > most {
                best = Some(Pattern { leaves, layout: Layout::Line { first: at(first), step } });
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::leaf::Leaf;
    use super::*;

    fn cut(x: f64, y: f64, radius: f64) -> PartLeaf {
        let leaf = Leaf::cylinder(DVec3::Z, DVec3::new(x, y, 1.0), radius, [-4.0, 4.0]);
        PartLeaf { adds: false, leaf, name: String::new(), surface: 0.1, seen: 1.0 }
    }

    #[test]
    fn a_ring_a_grid_and_a_line_are_told() {
        let angle = |k: i32| 0.3 + std::f64::consts::TAU * f64::from(k) / 5.0;
        let ring = (0..5).map(|k| cut(20.0 * angle(2 * k).cos(), 20.0 * angle(2 * k).sin(), 1.0));
        let grid = (0..6).map(|k| cut(7.0 * f64::from(k % 3), 9.0 * f64::from(k / 3), 1.5));
        let row = [2, 0, 3, 1].map(|k| cut(5.0 * f64::from(k), 2.0 * f64::from(k), 2.0));
        let stray = [cut(3.0, 30.0, 2.0), cut(1.0, 1.0, 3.0)];
        let leaves: Vec<PartLeaf> = ring.chain(grid).chain(row).chain(stray).collect();
        let found = patterns_of(&leaves, 60.0);
        assert_eq!(found.len(), 3, "{found:?}");
        let Layout::Grid { steps, counts, .. } = found[0].layout else { panic!("{found:?}") };
        assert_eq!(counts, [3, 2]);
        assert!((steps[0].x.abs() - 7.0).abs() < 1e-9 && (steps[1].y.abs() - 9.0).abs() < 1e-9);
        assert!(matches!(found[1].layout, Layout::Ring { .. }) && found[1].leaves == [0, 3, 1, 4, 2]);
        let Layout::Line { step, .. } = found[2].layout else { panic!("{found:?}") };
        assert!((step.abs() - DVec3::new(5.0, 2.0, 0.0)).length() < 1e-9);
        assert!(found[2].leaves.len() == 4 && !found[2].leaves.contains(&15));
    }

    #[test]
    fn four_on_a_circle_are_a_ring_and_unlike_ones_nothing() {
        let four = [[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0], [0.0, -5.0]].map(|[x, y]| cut(x, y, 1.0)).to_vec();
        assert!(matches!(patterns_of(&four, 20.0)[0].layout, Layout::Ring { .. }));
        let mut unlike = four;
        unlike[1] = cut(0.0, 5.0, 1.2);
        unlike[2] = cut(-5.0, 0.0, 0.8);
        assert!(patterns_of(&unlike, 20.0).is_empty());
    }
}
