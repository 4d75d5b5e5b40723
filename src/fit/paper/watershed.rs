//! Labels by concave creases: a watershed of the distance from them, and what is convex together.
//!
//! ```text
//!         .--------.                     distance from the crease ^
//!         |   1    |
//!         |        '---------.           1 __                     __ 2     two summits: two floods;
//!         |        :    2    |              '-.__  pass       _.-'         they stay two where a part of
//!         '--------'---------'                   '-._  ___.-'              either is in front of the other
//!           a crease at ':', none below              ''
//! ```
//!
//! A crease parts two leaves of a solid, but often not all around: the ends of an angle are flat.
//! So the surface is flooded from the summits of the distance to the nearest crease. Floods that
//! meet are one segment unless most of their border is a crease, or they are concave together: many
//! points of one are in front of the tangent planes of the other. Small and flat segments, such as
//! the ground of a blind hole, join the one that they have the longest border with.
//!
//! Source: A. Mangan, R. Whitaker, *Partitioning 3D surface meshes using watershed segmentation*
//! (1999), with the distance to concave creases in place of curvature, which facets do not have.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use glam::DVec3;
use rvachev_num::{Meter, order};

use super::neighbours::{Link, Neighbours, link};
use crate::fit::grid::{Grid, extent};
use crate::fit::linear::Principal;
use crate::{Cancelled, Run};

/// Two floods that meet are one where the pass is higher than this times the lower summit.
const PASS: f64 = 0.8;

/// Two floods that meet are one segment if fewer pairs of their points than this share are concave:
/// points of a hole's wall are in front of each other as well, those of an angle's legs are more.
const CONCAVE: f64 = 0.3;

/// They also are two where less than this share of their border is without a crease.
const OPEN: f64 = 0.4;

/// A point is in front of a tangent plane by this sine.
const IN_FRONT: f64 = 0.05;

/// Points of either flood that pairs are made of, some more at most.
const ASKED: usize = 120;

/// Segments of fewer points join others: fewer do not tell a supershape.
pub(super) const FEWEST: usize = 60;

/// Segments that are thinner than this, in proportion to their width, join others.
const FLAT: f64 = 1e-3;

/// A label for each point, from 0 on in the order of the points. `crease` is a cosine.
pub(super) fn watershed(
    points: &[DVec3],
    normals: &[DVec3],
    near: &Neighbours,
    crease: f64,
    run: &Run,
) -> Result<Vec<u32>, Cancelled> {
    let [measuring, flooding, small, convex] = run.stages([4.0, 4.0, 2.0, 1.0]);
    let between = |i: usize, j: usize| link([points[i], points[j]], [normals[i], normals[j]], crease);
    let open = |i: usize| near.of(i).iter().map(|j| *j as usize).filter(move |j| between(i, *j) == Link::Open);
    let is_creased = |i: usize| near.of(i).iter().any(|j| between(i, *j as usize) == Link::Crease);
    let away = distances(points, &open, is_creased, &measuring)?;
    let mut floods = Floods::new(points.len());
    let mut order: Vec<usize> = (0..points.len()).collect();
    order::falling(&mut order, |i| away[*i]);
    let meter = Meter::new(&flooding, points.len());
    for i in order {
        meter.step()?;
        floods.flood(i, away[i], open(i));
    }
    let mut labels: Vec<usize> = (0..points.len()).map(|i| floods.summit_of(i)).collect();
    join_small(points, near, &mut labels, &small)?;
    join_convex(points, normals, near, &between, &mut labels, &convex)?;
    let mut numbers = BTreeMap::new();
    let numbered = labels.iter().map(|summit| {
        let next = numbers.len() as u32;
        *numbers.entry(*summit).or_insert(next)
    });
    Ok(numbered.collect())
}

/// The distance from the nearest crease of the same part of the surface; infinite where there is
/// none.
fn distances<I: Iterator<Item = usize>>(
    points: &[DVec3],
    open: &impl Fn(usize) -> I,
    is_creased: impl Fn(usize) -> bool,
    run: &Run,
) -> Result<Vec<f64>, Cancelled> {
    let meter = Meter::new(run, points.len());
    let mut away = vec![f64::INFINITY; points.len()];
    let mut is_seen = vec![false; points.len()];
    for start in 0..points.len() {
        if is_seen[start] {
            continue;
        }
        is_seen[start] = true;
        let mut part = vec![start];
        let mut next = 0;
        while next < part.len() {
            for j in open(part[next]) {
                if !std::mem::replace(&mut is_seen[j], true) {
                    part.push(j);
                }
            }
            next += 1;
        }
        let creases: Vec<DVec3> = part.iter().filter(|i| is_creased(**i)).map(|i| points[*i]).collect();
        if creases.is_empty() {
            continue;
        }
        let bounds = extent(&creases);
        let cell = (bounds[1] - bounds[0]).length() / (creases.len() as f64).cbrt();
        let grid = Grid::new(&creases, bounds, cell);
        let mut found = Vec::new();
        for i in part {
            meter.step()?;
            grid.nearest(points[i], 1, &mut found);
            away[i] = found.first().map_or(f64::INFINITY, |f| f.0.sqrt());
        }
    }
    Ok(away)
}

/// Disjoint sets of points, each with the height of its summit.
struct Floods {
    parent: Vec<usize>,
    height: Vec<f64>,
    is_wet: Vec<bool>,
}

impl Floods {
    fn new(count: usize) -> Floods {
        Floods { parent: (0..count).collect(), height: vec![0.0; count], is_wet: vec![false; count] }
    }

    fn summit_of(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// The next lower point: it is a summit, or joins the highest flood beside it; floods that meet
    /// here become one unless the pass is low.
    fn flood(&mut self, i: usize, level: f64, beside: impl Iterator<Item = usize>) {
        (self.is_wet[i], self.height[i]) = (true, level);
        let mut floods: Vec<usize> = Vec::new();
        for j in beside {
            if self.is_wet[j] {
                floods.push(self.summit_of(j));
            }
        }
        floods.sort_by(|a, b| self.height[*b].total_cmp(&self.height[*a]).then(a.cmp(b)));
        let Some(&highest) = floods.first() else { return };
        self.parent[i] = highest;
        for other in floods {
            let other = self.summit_of(other);
            // An infinite height is that of a part without creases, which is one.
            if other != highest && (level >= PASS * self.height[other] || level.is_infinite()) {
                self.parent[other] = highest;
            }
        }
    }
}

/// The points of each label.
fn by_label(labels: &[usize]) -> BTreeMap<usize, Vec<usize>> {
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, label) in labels.iter().enumerate() {
        members.entry(*label).or_default().push(i);
    }
    members
}

/// Joins floods that meet and are convex together, the most convex ones first.
fn join_convex(
    points: &[DVec3],
    normals: &[DVec3],
    near: &Neighbours,
    between: &impl Fn(usize, usize) -> Link,
    labels: &mut [usize],
    run: &Run,
) -> Result<(), Cancelled> {
    // Each round but the last makes one of two.
    let meter = Meter::new(run, by_label(labels).len());
    loop {
        meter.step()?;
        let members = by_label(labels);
        // Links over each border: open ones, and over a crease.
        let mut borders: BTreeMap<[usize; 2], [usize; 2]> = BTreeMap::new();
        for i in 0..points.len() {
            for &j in near.of(i).iter().filter(|j| labels[**j as usize] > labels[i]) {
                let links = borders.entry([labels[i], labels[j as usize]]).or_default();
                match between(i, j as usize) {
                    Link::Open => links[0] += 1,
                    Link::Crease => links[1] += 1,
                    Link::Apart => {}
                }
            }
        }
        let is_open = |[open, crease]: &[usize; 2]| *open as f64 > OPEN * (open + crease) as f64;
        let pairs: Vec<[usize; 2]> =
            borders.iter().filter(|(_, links)| is_open(links)).map(|(pair, _)| *pair).collect();
        let share = |[a, b]: &[usize; 2]| concave(points, normals, &members[a], &members[b]);
        let shares = pairs.iter().map(|pair| (share(pair), *pair)).filter(|(share, _)| *share < CONCAVE);
        let Some((_, [a, b])) = shares.min_by(|x, y| x.0.total_cmp(&y.0)) else { return Ok(()) };
        members[&b].iter().for_each(|i| labels[*i] = a);
    }
}

/// The share of the pairs of points of which one is in front of the tangent plane of the other.
fn concave(points: &[DVec3], normals: &[DVec3], a: &[usize], b: &[usize]) -> f64 {
    let some = |of: &[usize]| of.iter().copied().step_by((of.len() / ASKED).max(1)).collect::<Vec<usize>>();
    let (a, b) = (some(a), some(b));
    let mut count = 0;
    for &i in &a {
        for &j in &b {
            let d = points[j] - points[i];
            let limit = IN_FRONT * d.length();
            count += usize::from(normals[i].dot(d) > limit || -normals[j].dot(d) > limit);
        }
    }
    count as f64 / (a.len() * b.len()).max(1) as f64
}

/// Joins small and flat segments to the one that they have the longest border with.
fn join_small(points: &[DVec3], near: &Neighbours, labels: &mut [usize], run: &Run) -> Result<(), Cancelled> {
    let mut left_alone = Vec::new();
    // Each round but the last joins one, or leaves it alone.
    let meter = Meter::new(run, by_label(labels).len() + 1);
    loop {
        meter.step()?;
        let members = by_label(labels);
        let is_small = |of: &Vec<usize>| {
            let [least, middle, _] = Principal::of(of.iter().map(|i| points[*i])).variances;
            of.len() < FEWEST || least <= FLAT * FLAT * middle
        };
        let small = members.iter().filter(|(label, of)| !left_alone.contains(*label) && is_small(of));
        let Some((&label, of)) = small.min_by_key(|(label, of)| (of.len(), **label)) else { return Ok(()) };
        let mut borders: BTreeMap<usize, usize> = BTreeMap::new();
        for j in of.iter().flat_map(|i| near.of(*i)) {
            let other = labels[*j as usize];
            if other != label {
                *borders.entry(other).or_default() += 1;
            }
        }
        match borders.iter().max_by_key(|(other, links)| (**links, Reverse(**other))) {
            Some((&other, _)) => of.iter().for_each(|i| labels[*i] = other),
            None => left_alone.push(label),
        }
    }
}
