//! Which leaves are on a line, a ring or a grid.

use std::f64::consts::{FRAC_1_PI, FRAC_1_SQRT_2, TAU};

use glam::{DMat3, DVec3};
use rvachev_num::order;

use super::leaf::{Leaf, Shape};
use super::patterns::{Layout, Pattern};

/// Sizes that differ by less are equal, and leaves that are nearer than that to their place are in
/// it: in parts of the part's size.
pub(super) const EQUAL: f64 = 5e-4;
const PLACED: f64 = 1e-3;

/// The patterns of leaves of a part of a size, those that save most numbers first; leaves of a run
/// may be taken in any order.
pub(super) fn patterns_of(leaves: &[&Leaf], runs: &[usize], size: f64) -> Vec<Pattern> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, leaf) in leaves.iter().enumerate() {
        let is_of =
            |group: &&mut Vec<usize>| runs[group[0]] == runs[i] && leaf.is_equal(leaves[group[0]], EQUAL * size);
        match groups.iter_mut().find(is_of) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    let mut patterns: Vec<(usize, Pattern)> = Vec::new();
    for mut group in groups {
        // In the order of their places: that in which they were found may hang on the last digits
        // of how well they fit.
        order::rising(&mut group, |i| along(leaves[*i].centre));
        let parameters = leaves[group[0]].parameters();
        let mut group = Group { leaves, left: group, near: PLACED * size };
        while let Some((saved, best)) = group.best(parameters) {
            group.left.retain(|i| !best.leaves.contains(i));
            patterns.push((saved, best));
        }
    }
    patterns.sort_by_key(|(saved, pattern)| (usize::MAX - saved, pattern.leaves[0]));
    patterns.into_iter().map(|(_, pattern)| pattern).collect()
}

/// How far along a place is, in a direction across which no two places of a pattern are: steps
/// along x come first, along z last.
fn along(place: DVec3) -> f64 {
    place.dot(DVec3::new(FRAC_1_PI, FRAC_1_SQRT_2, 1.0))
}

impl Leaf {
    /// What two leaves have alike that differ by their poses only.
    pub(super) fn sorted_sizes(&self) -> Vec<f64> {
        let mut sizes = self.sizes();
        match &self.shape {
            Shape::Box(_) => order::numbers(&mut sizes),
            Shape::Profile { outline, height } => {
                sizes = outline.corners.iter().map(|corner| corner.length()).collect();
                order::numbers(&mut sizes);
                let mut radii: Vec<f64> = outline.radii.iter().copied().filter(|radius| *radius != 0.0).collect();
                order::numbers(&mut radii);
                sizes.extend(radii);
                sizes.push(*height);
            }
            _ => {}
        }
        sizes
    }

    /// Whether another leaf differs by its pose only.
    pub(super) fn is_equal(&self, other: &Leaf, near: f64) -> bool {
        let (p, q) = (self.sorted_sizes(), other.sorted_sizes());
        let sizes = || p.iter().zip(&q).all(|(p, q)| (p - q).abs() < near);
        self.kind() == other.kind() && p.len() == q.len() && sizes()
    }

    /// Whether it is the same as this one turned and moved: by the distances of points about it.
    pub(super) fn is_copy(&self, of: &Leaf, turn: DMat3, to: DVec3, near: f64) -> bool {
        let reach = of.reach().max(DVec3::splat(near));
        let local = (0..14).map(|k| match k {
            0..6 => DVec3::AXES[k / 2] * if k % 2 == 0 { 1.2 } else { -1.2 },
            _ => {
                DVec3::new(f64::from(k as u8 & 1), f64::from(k as u8 >> 1 & 1), f64::from(k as u8 >> 2 & 1)) * 1.8 - 0.9
            }
        });
        self.centre.distance(to) < near
            && local.into_iter().all(|p| {
                let away = of.rotation * (reach * p);
                (of.distance(of.centre + away) - self.distance(to + turn * away)).abs() < 2.0 * near
            })
    }
}

/// Equal leaves of which some are a pattern.
struct Group<'a> {
    leaves: &'a [&'a Leaf],
    left: Vec<usize>,
    /// How far a leaf may be from its place.
    near: f64,
}

impl Group<'_> {
    fn at(&self, i: usize) -> DVec3 {
        self.leaves[i].centre
    }

    /// The pattern that saves most numbers of leaves that have so many, if one saves some; of those
    /// that save as many the first.
    fn best(&self, parameters: usize) -> Option<(usize, Pattern)> {
        let saved =
            |pattern: &Pattern| ((pattern.leaves.len() - 1) * parameters).saturating_sub(pattern.layout.parameters());
        let mut best: Option<(usize, Pattern)> = None;
        for pattern in self.rings().into_iter().chain(self.grids()).chain(self.lines()).chain(self.turned()) {
            let saved = saved(&pattern);
            if saved > best.as_ref().map_or(0, |best| best.0) {
                best = Some((saved, pattern));
            }
        }
        best
    }

    /// The leaf that is where the rule has a copy of another.
    fn copy(&self, of: usize, turn: DMat3, to: DVec3) -> Option<usize> {
        let is_copy = |i: &usize| self.leaves[*i].is_copy(self.leaves[of], turn, to, self.near);
        self.left.iter().copied().find(is_copy)
    }

    fn rings(&self) -> Vec<Pattern> {
        let mut rings: Vec<Pattern> = Vec::new();
        let after = |n: usize| self.left.iter().copied().enumerate().skip(n);
        for (n, a) in after(0) {
            for (m, b) in after(n + 1) {
                for (_, c) in after(m + 1) {
                    let three = [a, b, c];
                    if rings.iter().any(|ring| three.iter().all(|i| ring.leaves.contains(i))) {
                        continue;
                    }
                    rings.extend(self.ring(three));
                }
            }
        }
        // About z they need not be laid along an axis.
        let is_about_z = |ring: &Pattern| matches!(ring.layout, Layout::Ring { axis, .. } if axis == DVec3::Z);
        order::falling(&mut rings, |ring| f64::from(is_about_z(ring)));
        rings
    }

    /// The ring of all leaves on the circle through three.
    fn ring(&self, three: [usize; 3]) -> Option<Pattern> {
        let [a, b, c] = three.map(|i| self.at(i));
        let (u, v) = (b - a, c - a);
        let across = u.cross(v);
        if across.length() < 4.0 * self.near * u.length().max(v.length()) {
            return None;
        }
        let away = (u.length_squared() * v - v.length_squared() * u).cross(across) / (2.0 * across.length_squared());
        let (centre, radius, axis) = (a + away, away.length(), upright(across.normalize()));
        let is_of = |i: &usize| {
            let d = self.at(*i) - centre;
            d.dot(axis).abs() < self.near && (d.length() - radius).abs() < self.near
        };
        let on: Vec<usize> = self.left.iter().copied().filter(is_of).collect();
        let centre = on.iter().map(|i| self.at(*i)).sum::<DVec3>() / on.len() as f64;
        let (first, sector) = (self.at(on[0]) - centre, TAU / on.len() as f64);
        let placed = (0..on.len()).map(|k| {
            let turn = DMat3::from_axis_angle(axis, sector * k as f64);
            self.copy(on[0], turn, centre + turn * first)
        });
        let leaves = placed.collect::<Option<Vec<usize>>>()?;
        Some(Pattern { leaves, layout: Layout::Ring { centre, axis, first } })
    }

    /// Two that are half a turn about an axis of either from each other, and no line.
    fn turned(&self) -> Vec<Pattern> {
        let mut pairs = Vec::new();
        for (n, &a) in self.left.iter().enumerate() {
            for &b in &self.left[n + 1..] {
                let (centre, step) = (0.5 * (self.at(a) + self.at(b)), self.at(b) - self.at(a));
                if self.leaves[b].is_copy(self.leaves[a], DMat3::IDENTITY, self.at(b), self.near) {
                    continue;
                }
                let frame = self.leaves[a].rotation;
                let own = [frame.x_axis, frame.y_axis, frame.z_axis].map(upright);
                let across = DVec3::AXES.into_iter().chain(own).filter(|axis| axis.dot(step).abs() < self.near);
                for axis in across {
                    let turn = DMat3::from_axis_angle(axis, 0.5 * TAU);
                    if self.leaves[b].is_copy(self.leaves[a], turn, self.at(b), self.near) {
                        let layout = Layout::Ring { centre, axis, first: -0.5 * step };
                        pairs.push(Pattern { leaves: vec![a, b], layout });
                    }
                }
            }
        }
        pairs
    }

    /// From each leaf by each step, all that follow.
    fn lines(&self) -> Vec<Pattern> {
        let mut lines: Vec<Pattern> = Vec::new();
        for &first in &self.left {
            for &second in self.left.iter().filter(|i| **i != first) {
                let step = self.at(second) - self.at(first);
                let leaves = self.run(first, step);
                // Of one in both directions the first, and nothing that is a part of another.
                let is_known = |line: &Pattern| leaves.iter().all(|i| line.leaves.contains(i));
                if leaves.len() > 1 && !lines.iter().any(is_known) {
                    lines.push(Pattern { leaves, layout: Layout::Line { first: self.at(first), step } });
                }
            }
        }
        lines
    }

    fn run(&self, first: usize, step: DVec3) -> Vec<usize> {
        let next = |k: usize| self.copy(first, DMat3::IDENTITY, self.at(first) + k as f64 * step);
        let longer = step.length() > 4.0 * self.near;
        let others = (1..self.left.len()).map_while(|k| next(k).filter(|_| longer));
        std::iter::once(first).chain(others).collect()
    }

    /// Lines that are repeated across, two or more of each.
    fn grids(&self) -> Vec<Pattern> {
        let mut grids = Vec::new();
        for line in self.lines() {
            let Layout::Line { first, step: along } = line.layout else { continue };
            for &other in self.left.iter().filter(|i| !line.leaves.contains(i)) {
                let across = self.at(other) - first;
                if across.dot(along).abs() > self.near * along.length() {
                    continue;
                }
                let mut leaves = line.leaves.clone();
                let row = |k: usize| {
                    let moved =
                        line.leaves.iter().map(|i| self.copy(*i, DMat3::IDENTITY, self.at(*i) + k as f64 * across));
                    moved.collect::<Option<Vec<usize>>>()
                };
                let mut rows = 1;
                while let Some(row) = row(rows) {
                    leaves.extend(row);
                    rows += 1;
                }
                if rows > 1 {
                    let counts = [line.leaves.len(), rows];
                    grids.push(Pattern { leaves, layout: Layout::Grid { first, steps: [along, across], counts } });
                }
            }
        }
        grids
    }
}

/// A direction or its opposite: an axis of coordinates where it is hardly off it, its greatest
/// coordinate positive.
fn upright(axis: DVec3) -> DVec3 {
    let greatest = axis.abs().max_position();
    let own = DVec3::AXES[greatest];
    if axis.cross(own).length() < 1e-6 { own } else { axis * axis[greatest].signum() }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::super::outline::Outline;
    use super::*;

    fn cut(x: f64, y: f64, radius: f64) -> Leaf {
        Leaf::cylinder(DVec3::Z, DVec3::new(x, y, 1.0), radius, [-4.0, 4.0])
    }

    fn found(leaves: &[Leaf], size: f64) -> Vec<Pattern> {
        let leaves: Vec<&Leaf> = leaves.iter().collect();
        patterns_of(&leaves, &vec![1; leaves.len()], size)
    }

    #[test]
    fn a_ring_a_grid_and_a_line_are_told() {
        let angle = |k: i32| 0.3 + TAU * f64::from(k) / 5.0;
        let ring = (0..5).map(|k| cut(20.0 * angle(2 * k).cos(), 20.0 * angle(2 * k).sin(), 1.0));
        let grid = (0..6).map(|k| cut(7.0 * f64::from(k % 3), 9.0 * f64::from(k / 3), 1.5));
        let row = [2, 0, 3, 1].map(|k| cut(5.0 * f64::from(k), 2.0 * f64::from(k), 2.0));
        let stray = [cut(3.0, 30.0, 2.0), cut(1.0, 1.0, 3.0)];
        let leaves: Vec<Leaf> = ring.chain(grid).chain(row).chain(stray).collect();
        let found = found(&leaves, 60.0);
        assert_eq!(found.len(), 3, "{found:?}");
        let Layout::Grid { steps, counts, .. } = found[0].layout else { panic!("{found:?}") };
        assert_eq!(counts, [3, 2]);
        assert!((steps[0].x.abs() - 7.0).abs() < 1e-9 && (steps[1].y.abs() - 9.0).abs() < 1e-9);
        let Layout::Ring { axis, .. } = found[1].layout else { panic!("{found:?}") };
        assert!(axis == DVec3::Z && found[1].leaves == [4, 2, 0, 3, 1], "{found:?}");
        let Layout::Line { step, .. } = found[2].layout else { panic!("{found:?}") };
        assert!((step.abs() - DVec3::new(5.0, 2.0, 0.0)).length() < 1e-9);
        assert!(found[2].leaves.len() == 4 && !found[2].leaves.contains(&15));
    }

    #[test]
    fn patterns_are_the_same_in_whatever_order_leaves_are() {
        let grid = |k: usize| cut(7.0 * (k % 3) as f64, 9.0 * (k / 3) as f64, 1.5);
        let pattern = |order: [usize; 6]| {
            let leaves = order.map(grid);
            let Layout::Grid { first, steps, counts } = found(&leaves, 30.0)[0].layout else { panic!("no grid") };
            (first, steps, counts)
        };
        for order in [[5, 4, 3, 2, 1, 0], [2, 5, 0, 4, 3, 1]] {
            assert_eq!(pattern(order), pattern([0, 1, 2, 3, 4, 5]));
        }
    }

    /// Bores from all six faces of a cube.
    #[test]
    fn what_is_turned_is_a_ring_and_two_are_a_line() {
        let bore = |axis: DVec3| Leaf::cylinder(axis, DVec3::ZERO, 3.0, [6.0, 11.0]).aligned(1e-9);
        let leaves: Vec<Leaf> = DVec3::AXES.into_iter().flat_map(|axis| [bore(axis), bore(-axis)]).collect();
        let found = found(&leaves, 35.0);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(matches!(found[0].layout, Layout::Ring { axis, .. } if axis == DVec3::Z), "{found:?}");
        assert_eq!((&found[0].leaves[..], &found[1].leaves[..]), (&[3, 0, 2, 1][..], &[5, 4][..]));
        // Slots that are not turned are a grid, not a ring.
        let slot = |x: f64, y: f64| {
            let corner = DVec3::new(2.0, 1.0, 1.0);
            Leaf::cuboid(DMat3::IDENTITY, [DVec3::new(x, y, 0.0) - corner, DVec3::new(x, y, 0.0) + corner])
        };
        let slots = [slot(8.0, 8.0), slot(-8.0, 8.0), slot(-8.0, -8.0), slot(8.0, -8.0)];
        assert!(matches!(self::found(&slots, 30.0)[0].layout, Layout::Grid { .. }));
    }

    #[test]
    fn four_on_a_circle_are_a_ring_and_unlike_ones_nothing() {
        let four = [[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0], [0.0, -5.0]].map(|[x, y]| cut(x, y, 1.0)).to_vec();
        assert!(matches!(found(&four, 20.0)[0].layout, Layout::Ring { .. }));
        let unlike: Vec<Leaf> = (0..4).map(|k| cut(5.0 * f64::from(k), 0.0, 1.0 + 0.2 * f64::from(k))).collect();
        assert!(found(&unlike, 20.0).is_empty());
        // An L and the same half a turn about y from it.
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]].map(DVec2::from_array);
        let middle = corners.iter().sum::<DVec2>() / 6.0;
        let l = |mirror: f64| {
            let corners = corners.map(|c| DVec2::new(mirror * (c.x - middle.x), c.y - middle.y)).to_vec();
            let centre = DVec3::new(7.0 * mirror, 2.0, 0.0);
            Leaf {
                shape: Shape::Profile { outline: Outline::polygon(corners), height: 5.0 },
                rotation: DMat3::IDENTITY,
                centre,
            }
        };
        let pair = found(&[l(1.0), l(-1.0)], 20.0);
        assert!(matches!(pair[0].layout, Layout::Ring { axis: DVec3::Y, .. }), "{pair:?}");
        let balls = [3.0, 9.0].map(|x| Leaf::sphere(DVec3::X * x, 1.0));
        assert!(found(&balls, 20.0).is_empty(), "no number is saved");
    }
}
