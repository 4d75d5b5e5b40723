//! From squares to closed chains of points.
//!
//! Going round a square anticlockwise, a piece of a contour begins where the walk leaves the inside
//! and ends where it enters it again. A side has the corners of its smaller neighbours on it, so
//! that both sides of it see the same crossings, and every crossing has one way in and one way out.

use std::collections::{HashMap, HashSet};

use glam::DVec2;
use rvachev_num::order;

use super::section::{Entry, Filling, Section};
use super::spread::Spread;
use super::square::{Node, Root, Square};
use super::tree::{Found, Leaf, key};
use crate::eval::bracket;
use crate::{Cancelled, Polyline, Run};

/// A chord is halved at most this many times.
const DEEPEST: u32 = 14;

/// A chord is divided if its middle is off by more, in proportion to the tolerance.
const CHORD: f64 = 0.7;

/// Into so many parts at once at most, and as if it were off by so much more: its parts are not
/// equal, as it is divided along the way into the solid.
const PARTS: f64 = 8.0;
const UNEVEN: f64 = 1.4;

/// Corners are looked for between points of chords that were halved so often.
const SMOOTH: u32 = 3;

/// Contours that turn by less than an angle with this sine, between two points, have no corner
/// there.
const TURN: f64 = 0.2;

/// What corners may be off, in proportion to the tolerance.
const SHARP: f64 = 0.1;

/// Points are found to this part of the tolerance.
const PRECISE: f64 = 1e-6;

/// The width of what is convex is at most this times its area, by the length around it: so much
/// that of a triangle with equal sides is.
const WIDE: f64 = 6.0;

/// A part of the tolerance that points are left out for.
const THIN: f64 = 0.02;

/// A crossing: the two corners of squares that it is between, the lower one first.
type Crossing = [Node; 2];

/// From one crossing to the next, through a square.
struct Piece {
    to: Crossing,
    leaf: usize,
}

/// A point of a contour, and where the value rises there; zero where it does not.
#[derive(Clone, Copy)]
struct End {
    point: DVec2,
    slope: DVec2,
}

/// The sagitta of the arc with these ends: ½ c tan(θ/4) where its tangents turn by θ.
fn sagitta([a, b]: [End; 2]) -> f64 {
    let turn = a.slope.perp_dot(b.slope).atan2(a.slope.dot(b.slope));
    0.5 * a.point.distance(b.point) * (0.25 * turn.abs()).tan()
}

/// What a plane is made into contours with.
pub(super) struct Chains<'a> {
    pub(super) section: &'a Section,
    pub(super) root: &'a Root,
    pub(super) found: &'a Found,
    /// What decides about points beyond their square.
    pub(super) whole: &'a Filling,
    pub(super) tolerance: f64,
}

impl Chains<'_> {
    /// The contours, and how many squares were left undecided.
    pub(super) fn contours(&self, run: &Run) -> Result<(Vec<Polyline>, usize), Cancelled> {
        let (mut unresolved, mut undecided, mut met) = (0, Vec::new(), HashSet::new());
        let keys = |[a, b]: Crossing| (key(a), key(b));
        let mut next: HashMap<(u64, u64), Piece, Spread> = HashMap::default();
        let mut starts = Vec::new();
        for (number, leaf) in self.found.leaves.iter().enumerate() {
            if number.is_multiple_of(1024) {
                run.check()?;
            }
            let pieces = self.pieces(leaf);
            let Square { node, size, side, .. } = leaf.square;
            match (leaf.way, pieces.len()) {
                (Some(entry), _) => unresolved += usize::from(entry.by_samples),
                // One that was not divided any more.
                (None, _) if side > self.tolerance => unresolved += 1,
                (None, 1) => drop(met.insert((node, size))),
                (None, _) => undecided.push((node, size)),
            }
            for [from, to] in pieces {
                next.insert(keys(from), Piece { to, leaf: number });
                starts.push(from);
            }
        }
        let mut contours = Vec::new();
        for start in starts {
            let mut points: Vec<DVec2> = Vec::new();
            let (mut at, mut last) = (start, None);
            while let Some(Piece { to, leaf }) = next.remove(&keys(at)) {
                if points.len().is_multiple_of(1024) {
                    run.check()?;
                }
                let leaf = &self.found.leaves[leaf];
                let from = last.unwrap_or_else(|| self.crossing(leaf, at));
                let ends = [from, self.crossing(leaf, to)];
                points.push(from);
                last = Some(ends[1]);
                match leaf.way {
                    Some(Entry { way, .. }) => unresolved += self.refine(leaf, ends, way, &mut points),
                    None => {
                        let left = (ends[1] - ends[0]).perp().normalize_or_zero();
                        points.extend(self.corner(leaf, ends.map(|point| self.end(leaf, point, left))));
                    }
                }
                at = to;
            }
            let kept = thinned(&points, THIN * self.tolerance);
            // The ends of narrow gaps and tips are cut off where they are thinner than the
            // tolerance.
            let line = Polyline::closed(kept);
            if WIDE * line.area().abs() > self.tolerance * line.length() {
                contours.push(line);
            } else if !points.is_empty() {
                unresolved += 1;
            }
        }
        // What is beside a contour is no farther from it than the tolerance.
        undecided.retain(|(node, size)| !beside(*node, *size).any(|node| met.contains(&(node, *size))));
        Ok((contours, unresolved + undecided.len()))
    }

    /// The pieces of contours in a square, the inside to the left.
    fn pieces(&self, leaf: &Leaf) -> Vec<[Crossing; 2]> {
        let corners = leaf.square.corners();
        // The crossings on the way round: those by which the inside is left and those by which it
        // is entered take turns.
        let mut met: Vec<(Crossing, bool)> = Vec::new();
        for k in 0..4 {
            let mut pending = vec![[corners[k], corners[(k + 1) % 4]]];
            while let Some([from, to]) = pending.pop() {
                let middle = [0, 1].map(|axis| from[axis] / 2 + to[axis] / 2);
                if from.iter().zip(to).any(|(a, b)| a.abs_diff(b) > 1) && self.found.is_inside(middle).is_some() {
                    pending.extend([[middle, to], [from, middle]]);
                    continue;
                }
                let leaves = self.is_inside(from);
                if leaves != self.is_inside(to) {
                    met.push(([from.min(to), from.max(to)], leaves));
                }
            }
        }
        let count = met.len();
        if let (Some(Entry { way, .. }), 4..) = (leaf.way, count) {
            // A graph: from each crossing to the next along it.
            let along = |crossing: &Crossing| way.perp_dot(self.crossing(leaf, *crossing));
            let ends = |leaving: bool| {
                let ends = met.iter().filter(|(_, leaves)| *leaves == leaving);
                let mut ends: Vec<Crossing> = ends.map(|(crossing, _)| *crossing).collect();
                order::falling(&mut ends, along);
                ends
            };
            return ends(true).into_iter().zip(ends(false)).map(|(from, to)| [from, to]).collect();
        }
        // Two corners inside across from each other: joined through the middle, or apart.
        let is_joined = count > 2 && self.section.is_inside(&leaf.filling, leaf.square.centre());
        let other = |at: usize| met[(at + if is_joined { count - 1 } else { 1 }) % count].0;
        let leaving = (0..count).filter(|at| met[*at].1);
        leaving.map(|at| [met[at].0, other(at)]).collect()
    }

    fn is_inside(&self, node: Node) -> bool {
        self.found.is_inside(node).unwrap_or(false)
    }

    /// Where the contour is between two corners.
    fn crossing(&self, leaf: &Leaf, [a, b]: Crossing) -> DVec2 {
        let [from, to] = [a, b].map(|node| self.root.point(node));
        let value = |t: f64| self.section.value(&leaf.filling, from.lerp(to, t));
        let ends = [0.0, 1.0];
        from.lerp(to, bracket(&value, ends, ends.map(value), PRECISE * self.tolerance / from.distance(to)))
    }

    /// Points between two, such that chords deviate by less than the tolerance; and how many chords
    /// do not.
    fn refine(&self, leaf: &Leaf, ends: [DVec2; 2], way: DVec2, points: &mut Vec<DVec2>) -> usize {
        let [first, last] = ends.map(|point| self.end(leaf, point, way));
        let mut far = 0;
        let mut pending = vec![(first, last, 0)];
        while let Some((a, b, depth)) = pending.pop() {
            let chord = [a.point, b.point];
            let is_short = depth >= DEEPEST || a.point.distance(b.point) <= 0.5 * self.tolerance;
            let sagitta = UNEVEN * sagitta([a, b]);
            let is_on = |t: f64| self.is_on(leaf, chord, a.point.lerp(b.point, t), CHORD);
            // An S has its middle on the chord.
            let is_straight = is_short
                || sagitta <= CHORD * self.tolerance && is_on(0.5) && (depth > 0 || is_on(0.25) && is_on(0.75));
            // What is curved has come nearer by now.
            let corner = if is_straight || depth >= SMOOTH { self.corner(leaf, [a, b]) } else { None };
            match corner {
                Some(corner) => points.push(corner),
                None if is_straight => {}
                None => {
                    let parts = |count: u32| -> Option<Vec<DVec2>> {
                        let part = |k: u32| {
                            let from = a.point.lerp(b.point, f64::from(k) / f64::from(count));
                            self.across(leaf, from, way, [sagitta, a.point.distance(b.point)])
                        };
                        (1..count).map(part).collect()
                    };
                    let count = (sagitta / (CHORD * self.tolerance)).sqrt().ceil().clamp(2.0, PARTS) as u32;
                    if let Some(between) = parts(count).or_else(|| parts(2)) {
                        let (mut to, deeper) = (b, depth + (between.len() as u32 + 1).ilog2());
                        for point in between.into_iter().rev() {
                            let from = self.end(leaf, point, way);
                            pending.push((from, to, deeper));
                            to = from;
                        }
                        pending.push((a, to, deeper));
                        continue;
                    }
                    far += 1;
                }
            }
            if b.point != last.point {
                points.push(b.point);
            }
        }
        far
    }

    /// A point of a contour, where the solid is entered along `way`.
    fn end(&self, leaf: &Leaf, point: DVec2, way: DVec2) -> End {
        // A little outside: inside, a face beside the plane may be nearer.
        let aside = 0.1 * SHARP * self.tolerance * way;
        let slope = self.section.gradient(self.filling(leaf, point), point - aside).normalize_or_zero();
        End { point, slope }
    }

    /// What decides about a point that is in a square, or beside it: there the contour may go on
    /// for a while.
    fn filling<'b>(&'b self, leaf: &'b Leaf, p: DVec2) -> &'b Filling {
        let from_low = p - leaf.square.low;
        let is_in = from_low.min_element() >= 0.0 && from_low.max_element() <= leaf.square.side;
        if is_in { &leaf.filling } else { self.whole }
    }

    fn value(&self, leaf: &Leaf, p: DVec2) -> f64 {
        self.section.value(self.filling(leaf, p), p)
    }

    /// Whether a contour that goes the way of a chord passes a point nearer than a part of the
    /// tolerance.
    fn is_on(&self, leaf: &Leaf, [a, b]: [DVec2; 2], p: DVec2, part: f64) -> bool {
        // The inside is to the left.
        let left = part * self.tolerance * (b - a).perp().normalize_or_zero();
        self.value(leaf, p + left) > 0.0 && self.value(leaf, p - left) <= 0.0
    }

    /// The point of the contour beside one of a chord, along a way that the solid is entered by:
    /// looked for as far as the chord may be off first, then as far as it is long.
    fn across(&self, leaf: &Leaf, from: DVec2, way: DVec2, [near, most]: [f64; 2]) -> Option<DVec2> {
        let value = |t: f64| self.value(leaf, from + t * way);
        let own = value(0.0);
        let outwards = if own > 0.0 { -1.0 } else { 1.0 };
        // In the square the solid is entered once along the way; beyond it may be anything.
        let border = leaf.square.exit(from, outwards * way);
        let mut reach = near.clamp(0.02 * most, most);
        if 0.02 * most < border && border < reach {
            reach = border;
        }
        let beyond = loop {
            let there = value(outwards * reach);
            if (there > 0.0) != (own > 0.0) {
                break there;
            }
            if reach >= most {
                return None;
            }
            let next = (3.0 * reach).min(most);
            reach = if reach < border && border < next { border } else { next };
        };
        let (mut ends, mut values) = ([0.0, outwards * reach], [own, beyond]);
        if ends[1] < 0.0 {
            ends.reverse();
            values.reverse();
        }
        Some(from + bracket(&value, ends, values, PRECISE * self.tolerance) * way)
    }

    /// The corner between two points of a contour, if its tangents there meet in one and are all of
    /// it.
    fn corner(
        &self,
        leaf: &Leaf,
        [End { point: a, slope: of_a }, End { point: b, slope: of_b }]: [End; 2],
    ) -> Option<DVec2> {
        if of_a.perp_dot(of_b).abs() < TURN {
            return None;
        }
        // of_a · (x − a) = 0 and of_b · (x − b) = 0.
        let (p, q) = (of_a.dot(a), of_b.dot(b));
        let meet = DVec2::new(p * of_b.y - q * of_a.y, of_a.x * q - of_b.x * p) / of_a.perp_dot(of_b);
        let is_near = meet.distance(a.midpoint(b)) < 4.0 * leaf.square.side;
        let is_on = |p: DVec2| self.is_on(leaf, [a, b], p, SHARP);
        (is_near && [meet, a.midpoint(meet), b.midpoint(meet)].into_iter().all(is_on)).then_some(meet)
    }
}

/// The squares of the same size about one.
fn beside([x, y]: Node, size: u32) -> impl Iterator<Item = Node> {
    let around = move |at: u32| [at.checked_sub(size), Some(at), at.checked_add(size)].into_iter().flatten();
    around(x).flat_map(move |x| around(y).map(move |y| [x, y]))
}

/// The closed chain without the points that its neighbours' chord passes within `tolerance` of.
fn thinned(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::with_capacity(points.len());
    // What has been left out since the last point that was kept.
    let mut skipped: Vec<DVec2> = Vec::new();
    for (i, &p) in points.iter().enumerate() {
        let Some(&last) = kept.last() else {
            kept.push(p);
            continue;
        };
        let next = points[(i + 1) % points.len()];
        skipped.push(p);
        let chord = next - last;
        let length = chord.length();
        let off = |q: &DVec2| {
            if length == 0.0 { q.distance(last) } else { chord.perp_dot(*q - last).abs() / length }
        };
        if skipped.iter().all(|q| off(q) <= tolerance && (q - last).dot(chord) >= 0.0) {
            continue;
        }
        kept.push(p);
        skipped.clear();
    }
    // The first is a point like any other.
    if let [first, second, .., last] = kept[..]
        && (second - last).perp_dot(first - last).abs() <= tolerance * second.distance(last)
        && (second - last).dot(first - last) >= 0.0
    {
        kept.remove(0);
    }
    kept
}
