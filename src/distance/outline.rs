//! The border of polygons that are joined in the plane, and the curve at a distance from it: lines
//! and arcs, in closed form.
//!
//! ```text
//!      ._______.       The curve is a part of the lines beside the border's pieces and of the
//!     /  .___.  \      circles about their ends. Where these cross they are cut, and what is
//!     |  |   |  |      nearer to some other piece is left out.
//!     \__|   |__/
//! ```

use std::any::Any;
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use glam::{DAffine3, DVec2, IVec2};
use rvachev_num::order;

use super::compiled_with;
use crate::eval::CompileError;
use crate::solid::{Length, Node};
use crate::{Cancelled, Polygon, Rectangle, RegularPolygon, Run, Solid};

/// Of more edges a mesh is made.
const MOST: usize = 2000;

/// What is nearer than this part of the size is there.
const ROUNDING: f64 = 1e-10;

/// So far beside a piece, in parts of the size, it is looked what is inside.
const BESIDE: f64 = 1e-8;

/// A line or an arc that the inside is on the left of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Curve {
    Line([DVec2; 2]),
    /// From an angle on, by another one: clockwise if that is negative.
    Arc {
        centre: DVec2,
        radius: f64,
        from: f64,
        turn: f64,
    },
}

impl Curve {
    /// The point at a part of its length.
    pub(super) fn at(&self, part: f64) -> DVec2 {
        match *self {
            Curve::Line([a, b]) => a.lerp(b, part),
            Curve::Arc { centre, radius, from, turn } => centre + radius * DVec2::from_angle(from + part * turn),
        }
    }

    fn part(&self, [low, high]: [f64; 2]) -> Curve {
        match *self {
            Curve::Line(_) => Curve::Line([self.at(low), self.at(high)]),
            Curve::Arc { centre, radius, from, turn } => {
                Curve::Arc { centre, radius, from: from + low * turn, turn: (high - low) * turn }
            }
        }
    }

    /// The corners of a box that holds it.
    fn bounds(&self) -> [DVec2; 2] {
        let [a, b] = [self.at(0.0), self.at(1.0)];
        match *self {
            Curve::Line(_) => [a.min(b), a.max(b)],
            // It is no farther from its chord than this.
            Curve::Arc { radius, turn, .. } if turn.abs() < 1.0 => {
                let rise = 0.125 * radius * turn * turn;
                [a.min(b) - rise, a.max(b) + rise]
            }
            Curve::Arc { centre, radius, .. } => [centre - radius, centre + radius],
        }
    }

    /// At what parts of its length another one crosses it, or ends on it.
    fn cuts(&self, other: &Curve, rounding: f64) -> Vec<f64> {
        let points: Vec<DVec2> = match (*self, *other) {
            (Curve::Line([a, b]), Curve::Line([c, d])) => {
                let (along, across) = (b - a, d - c);
                let sine = along.perp_dot(across);
                if sine.abs() > 1e-12 * along.length() * across.length() {
                    vec![a + (c - a).perp_dot(across) / sine * along]
                } else {
                    vec![c, d]
                }
            }
            (Curve::Line(ends), Curve::Arc { centre, radius, .. })
            | (Curve::Arc { centre, radius, .. }, Curve::Line(ends)) => on_circle(ends, centre, radius).to_vec(),
            (Curve::Arc { centre: c, radius, .. }, Curve::Arc { centre: d, .. }) => {
                let (middle, apart) = (0.5 * (c + d), d - c);
                let by = (radius * radius - 0.25 * apart.length_squared()).max(0.0).sqrt();
                let across = by * apart.normalize_or_zero().perp();
                vec![middle + across, middle - across]
            }
        };
        let is_on = |curve: &Curve, p: DVec2| match *curve {
            Curve::Line([a, b]) => p.distance(a + part_of(p, [a, b]).clamp(0.0, 1.0) * (b - a)) < rounding,
            Curve::Arc { centre, radius, .. } => (p.distance(centre) - radius).abs() < rounding,
        };
        let on_both = points.into_iter().filter(|p| is_on(self, *p) && is_on(other, *p));
        on_both.map(|p| self.part_at(p)).filter(|part| *part > 0.0 && *part < 1.0).collect()
    }

    /// At what part of its length a point of it is.
    fn part_at(&self, p: DVec2) -> f64 {
        match *self {
            Curve::Line(ends) => part_of(p, ends),
            Curve::Arc { centre, from, turn, .. } => {
                let angle = (p - centre).to_angle() - from;
                (angle * turn.signum()).rem_euclid(TAU) / turn.abs()
            }
        }
    }

    fn length(&self) -> f64 {
        match *self {
            Curve::Line([a, b]) => a.distance(b),
            Curve::Arc { radius, turn, .. } => radius * turn.abs(),
        }
    }
}

fn part_of(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    (p - a).dot(b - a) / (b - a).length_squared()
}

/// Where a line is at a distance from a point; where it is nearest, if it touches the circle.
fn on_circle([a, b]: [DVec2; 2], centre: DVec2, radius: f64) -> [DVec2; 2] {
    let along = (b - a).normalize_or_zero();
    let foot = a + (centre - a).dot(along) * along;
    let by = (radius * radius - foot.distance_squared(centre)).max(0.0).sqrt();
    [foot + by * along, foot - by * along]
}

/// Boxes by the squares that they are in.
struct Squares {
    side: f64,
    all: HashMap<IVec2, Vec<u32>>,
}

impl Squares {
    fn new(side: f64, curves: &[Curve]) -> Squares {
        let mut squares = Squares { side, all: HashMap::new() };
        for (number, curve) in curves.iter().enumerate() {
            squares.each(curve.bounds(), |all, at| all.entry(at).or_default().push(number as u32));
        }
        squares
    }

    fn each(&mut self, [low, high]: [DVec2; 2], mut take: impl FnMut(&mut HashMap<IVec2, Vec<u32>>, IVec2)) {
        let [low, high] = [low, high].map(|corner| (corner / self.side).floor().as_ivec2());
        for x in low.x..=high.x {
            (low.y..=high.y).for_each(|y| take(&mut self.all, IVec2::new(x, y)));
        }
    }

    /// The numbers of those that may be in a box.
    fn near(&self, [low, high]: [DVec2; 2]) -> HashSet<u32> {
        let [low, high] = [low, high].map(|corner| (corner / self.side).floor().as_ivec2());
        let squares = (low.x..=high.x).flat_map(|x| (low.y..=high.y).map(move |y| IVec2::new(x, y)));
        squares.filter_map(|at| self.all.get(&at)).flatten().copied().collect()
    }
}

/// The parts that curves are cut into where they cross each other, and at some more parts of their
/// lengths.
fn cut(curves: &[Curve], more: &[Vec<f64>], side: f64, rounding: f64, run: &Run) -> Result<Vec<Curve>, Cancelled> {
    let squares = Squares::new(side, curves);
    let mut parts = Vec::new();
    for (number, curve) in curves.iter().enumerate() {
        run.check()?;
        let mut cuts = vec![0.0, 1.0];
        cuts.extend(more.get(number).into_iter().flatten());
        let others = squares.near(curve.bounds()).into_iter().filter(|other| *other as usize != number);
        cuts.extend(others.flat_map(|other| curve.cuts(&curves[other as usize], rounding)));
        order::numbers(&mut cuts);
        parts
            .extend(cuts.windows(2).map(|ends| curve.part([ends[0], ends[1]])).filter(|part| part.length() > rounding));
    }
    Ok(parts)
}

/// Where pieces meet: the numbers of those that end there, and of those that start.
struct Corner {
    place: DVec2,
    ends: Vec<usize>,
    starts: Vec<usize>,
}

/// The corners of pieces. Two that are no farther apart than this may be one.
fn corners(pieces: &[[DVec2; 2]], apart: f64) -> Vec<Corner> {
    let mut known: HashMap<[i64; 2], usize> = HashMap::new();
    let mut corners: Vec<Corner> = Vec::new();
    for (number, piece) in pieces.iter().enumerate() {
        for (place, is_end) in [(piece[0], false), (piece[1], true)] {
            let at = (place / apart).round().to_array().map(|at| at as i64);
            let corner = *known.entry(at).or_insert_with(|| {
                corners.push(Corner { place, ends: Vec::new(), starts: Vec::new() });
                corners.len() - 1
            });
            let corner = &mut corners[corner];
            if is_end { corner.ends.push(number) } else { corner.starts.push(number) }
        }
    }
    corners
}

/// The edges of all polygons that a profile's column is joined of by R-functions; `None` if it is
/// made of anything else.
fn edges(solid: &Solid) -> Option<Vec<[DVec2; 2]>> {
    let mut pending = vec![(solid, DAffine3::IDENTITY)];
    let mut found = Vec::new();
    while let Some((solid, map)) = pending.pop() {
        match solid.node() {
            Node::Leaf(field) => {
                let any: &dyn Any = &**field;
                let place = |p: DVec2| map.transform_point3(p.extend(0.0)).truncate();
                for contour in contours(any)? {
                    let contour: Vec<DVec2> = contour.into_iter().map(place).collect();
                    let next = contour.iter().cycle().skip(1);
                    found.extend(contour.iter().zip(next).map(|(a, b)| [*a, *b]).filter(|[a, b]| a != b));
                }
            }
            Node::Affine { operand, forward, .. } => {
                let [x, y, z] = [forward.matrix3.x_axis, forward.matrix3.y_axis, forward.matrix3.z_axis];
                if x.z != 0.0 || y.z != 0.0 || z.x != 0.0 || z.y != 0.0 {
                    return None;
                }
                pending.push((operand, map * *forward));
            }
            Node::Join { operands: parts, .. } => pending.extend(parts.iter().map(|part| (part, map))),
            Node::Complement(operand) | Node::Named { operand, .. } | Node::Painted { operand, .. } => {
                pending.push((operand, map));
            }
            Node::Swept { .. } => pending.extend(solid.node().parts().iter().map(|part| (part, map))),
            _ => return None,
        }
        if found.len() > MOST {
            return None;
        }
    }
    Some(found)
}

/// The contours of a leaf, if it is a polygon.
fn contours(leaf: &dyn Any) -> Option<Vec<Vec<DVec2>>> {
    if let Some(polygon) = leaf.downcast_ref::<Polygon>() {
        return Some(polygon.contours().to_vec());
    }
    if let Some(Rectangle { size, radius: 0.0 }) = leaf.downcast_ref::<Rectangle>() {
        let [x, y] = (0.5 * *size).to_array();
        return Some(vec![[[x, -y], [x, y], [-x, y], [-x, -y]].map(DVec2::from).to_vec()]);
    }
    let polygon = leaf.downcast_ref::<RegularPolygon>()?;
    let count = f64::from(polygon.sides());
    let corner = |n: u32| polygon.radius() * DVec2::from_angle((f64::from(n) + 0.5) * TAU / count);
    Some(vec![(0..polygon.sides()).map(corner).collect()])
}

/// The border of a column of polygons, or of their offset, in the plane; `None` of anything else.
pub(super) fn border(solid: &Solid, run: &Run) -> Result<Option<Vec<Curve>>, CompileError> {
    let (joined, by) = match solid.node() {
        Node::Length { operand, length: Length::Offset(by), .. } => (operand, *by),
        _ => (solid, 0.0),
    };
    let Some(edges) = edges(joined) else { return Ok(None) };
    let programs = compiled_with(joined, &Run { progress: None, ..run.clone() })?;
    let (low, high) = edges
        .iter()
        .flatten()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    let size = (high - low).max_element();
    if !(size > 0.0 && size.is_finite()) {
        return Ok(None);
    }
    // Where polygons touch each other values are 0.
    let is_inside = |p: DVec2| programs.surface.value_or_around(p.extend(0.0), size) > 0.0;
    let (rounding, least) = (ROUNDING * size, size / (edges.len() as f64).sqrt().max(8.0));
    let lines: Vec<Curve> = edges.into_iter().map(Curve::Line).collect();
    let mut pieces = Vec::new();
    for part in cut(&lines, &[], least, rounding, run)? {
        let Curve::Line([a, b]) = part else { continue };
        let across = BESIDE * size * (b - a).normalize_or_zero().perp();
        let middle = part.at(0.5);
        match [is_inside(middle + across), is_inside(middle - across)] {
            [true, false] => pieces.push([a, b]),
            [false, true] => pieces.push([b, a]),
            _ => {}
        }
    }
    if by == 0.0 {
        return Ok(Some(pieces.into_iter().map(Curve::Line).collect()));
    }
    let radius = by.abs();
    let beside = |[a, b]: [DVec2; 2]| -by * (b - a).normalize_or_zero().perp();
    let mut curves: Vec<Curve> = pieces.iter().map(|piece| Curve::Line(piece.map(|p| p + beside(*piece)))).collect();
    let mut touched = vec![Vec::new(); curves.len()];
    for Corner { place, ends, starts } in corners(&pieces, 100.0 * rounding) {
        if let ([last], [next]) = (&ends[..], &starts[..]) {
            let [from, to] = [last, next].map(|number| beside(pieces[*number]).to_angle());
            let turn = (to - from + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
            // Around the other way both lines cross.
            if turn * by > 0.0 {
                curves.push(Curve::Arc { centre: place, radius, from, turn });
                touched.push(Vec::new());
            }
        } else {
            // Where corners touch each other: all around, cut where lines touch it.
            let circle = Curve::Arc { centre: place, radius, from: 0.0, turn: by.signum() * TAU };
            let lines = ends.iter().chain(&starts);
            touched.push(lines.map(|number| circle.part_at(place + beside(pieces[*number]))).collect());
            curves.push(circle);
        }
    }
    let lines: Vec<Curve> = pieces.iter().copied().map(Curve::Line).collect();
    let squares = Squares::new(least.max(radius), &lines);
    let is_kept = |curve: &Curve| {
        let p = curve.at(0.5);
        let near = squares.near([p - radius, p + radius]);
        let way = |number: u32| {
            let ends @ [a, b] = pieces[number as usize];
            p.distance(a + part_of(p, ends).clamp(0.0, 1.0) * (b - a))
        };
        is_inside(p) == (by < 0.0) && near.into_iter().all(|number| way(number) > radius - 10.0 * rounding)
    };
    let parts = cut(&curves, &touched, least.max(radius), rounding, run)?;
    let mut kept = Vec::new();
    for part in parts {
        run.check()?;
        kept.extend(Some(part).filter(is_kept));
    }
    Ok(Some(kept))
}
