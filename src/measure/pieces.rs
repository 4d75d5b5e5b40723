//! What the surface in a region is pieced together of: numbers that are 0 on it.
//!
//! ```text
//!        \  +  /          Each piece is where a number is 0, of which minima and maxima make the solid's
//!     ----\---/----       sign: the two faces of an edge, say. It lies in a layer about a plane, and its
//!       −  \ /  −         normals are turned from one direction by an angle at most.
//! ```

use glam::DVec3;

use super::cuts::flat_faces;
use super::polytope::Plane;
use crate::Bounds;
use crate::eval::{Atom, Number};
use crate::program::Program;
use rvachev_field::Zone;

/// Values are off by rounding, as parts of the coordinates: less than this.
const ROUNDING: f64 = 1e-13;

/// More parts of a program are not looked at.
const PARTS: usize = 12;

/// Where normals may be turned from a direction by more than this angle's cosine, nothing is made
/// of it.
const LEAST: f64 = 0.1;

/// Directions that are close to one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    /// A unit vector.
    pub(super) normal: DVec3,
    /// The cosine between it and any of them is no less.
    pub(super) cosine: f64,
}

/// Where a number is 0.
pub(super) struct Piece {
    /// The part of the program that it is of. A part is inside where all of its numbers are
    /// positive.
    pub(super) node: usize,
    /// Whether it is positive all over the region, if it has one sign.
    pub(super) sign: Option<bool>,
    /// Half of how thick the layer is in which it is 0, about a plane that looks to where it is
    /// positive, from the middle of the region.
    pub(super) layer: Option<(Plane, f64)>,
    /// The solid's outward normals where it is the surface.
    pub(super) facing: Option<Facing>,
    /// Whether it is 0 on the surface of a convex body.
    is_convex: bool,
}

/// The pieces in a region; nothing if they are too many.
pub(super) fn pieces(program: &Program, region: &Bounds) -> Option<Vec<Piece>> {
    let mut all = Vec::new();
    for atom in program.atoms(PARTS)? {
        match atom.program.numbers(region) {
            Some(numbers) => {
                let of = numbers.iter().map(|number| Piece::of_number(&atom, number, region));
                // What is positive all over takes no part in the least.
                let own: Vec<Piece> = of.filter(|piece| piece.sign != Some(true)).collect();
                let is_unknown = own.iter().any(|piece| piece.sign.is_none() && piece.facing.is_none());
                let planes = if is_unknown { flat_faces(&atom.program, region) } else { None };
                match planes {
                    Some((planes, slack)) => {
                        all.extend(planes.into_iter().map(|plane| Piece::flat(&atom, plane, slack)));
                    }
                    None => all.extend(own),
                }
            }
            None => all.push(Piece::measured(&atom, region)),
        }
    }
    Some(all)
}

impl Piece {
    fn of_number(atom: &Atom, Number { value, range, slopes }: &Number, region: &Bounds) -> Piece {
        let half = region.half_extents();
        let [slope, spread] = [slopes.map(|of| of.mid()), slopes.map(|of| 0.5 * of.width())].map(DVec3::from_array);
        let far = region.min.abs().max(region.max.abs()).max_element();
        let rounding = ROUNDING * (value.abs() + far * (slope.abs() + spread).max_element());
        let (off, reach) = (spread.dot(half) + rounding, slope.abs().dot(half));
        let mut piece = Piece { node: atom.node, sign: None, layer: None, facing: None, is_convex: false };
        if range.lo() > 0.0 || *value - off - reach > 0.0 {
            piece.sign = Some(true);
        } else if range.hi() < 0.0 || *value + off + reach < 0.0 {
            piece.sign = Some(false);
        }
        if piece.sign.is_none() {
            piece.is_convex = atom.program.bend_over(&Zone::of_bounds(region)).is_some();
            piece.layer = Plane::of(DVec3::ZERO, *value, slope).map(|plane| (plane, off / slope.length()));
            piece.layer = piece.layer.filter(|(_, half)| half.is_finite());
            piece.facing = outward(atom, slope.normalize_or_zero(), least_cosine(slope, spread));
        }
        piece
    }

    /// A flat face, to within a distance.
    fn flat(atom: &Atom, plane: Plane, slack: f64) -> Piece {
        let (layer, facing) = (Some((plane, slack)), outward(atom, plane.normal(), 1.0));
        Piece { node: atom.node, sign: None, layer, facing, is_convex: true }
    }

    /// What is searched for tells a layer, or nothing.
    fn measured(atom: &Atom, region: &Bounds) -> Piece {
        let unknown = Piece { node: atom.node, sign: None, layer: None, facing: None, is_convex: false };
        let Some(layers) = atom.program.layers(&Zone::of_bounds(region), 0.0) else { return unknown };
        match layers[..] {
            [] => Piece { sign: Some(atom.program.value(region.center()) > 0.0), ..unknown },
            [layer] if layer.least_cosine > 0.0 => {
                let at = layer.normal.dot(region.center()) - layer.low.midpoint(layer.high);
                let far = region.min.abs().max(region.max.abs()).max_element();
                let half = 0.5 * (layer.high - layer.low) + ROUNDING * far;
                let layer_about = Plane::of(DVec3::ZERO, at, layer.normal).map(|plane| (plane, half));
                Piece { layer: layer_about, facing: outward(atom, layer.normal, layer.least_cosine), ..unknown }
            }
            _ => unknown,
        }
    }

    /// The area that it has in a box at most: that of its shadow along its normals, or that of the
    /// box about a convex body.
    pub(super) fn most_area(&self, size: DVec3) -> f64 {
        let sides = DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
        let by_shadow = self.facing.map_or(f64::INFINITY, |Facing { normal, cosine }| sides.dot(normal.abs()) / cosine);
        let by_box = if self.is_convex { 2.0 * sides.element_sum() } else { f64::INFINITY };
        by_shadow.min(by_box)
    }
}

/// The cosine between a slope and all that are off it by a spread: those at the corners are turned
/// most.
fn least_cosine(slope: DVec3, spread: DVec3) -> f64 {
    let corner = |n: usize| DVec3::from_array([0, 1, 2].map(|axis| if n >> axis & 1 == 0 { -1.0 } else { 1.0 }));
    let cosine = |n: usize| {
        let other = slope + spread * corner(n);
        slope.dot(other) / (slope.length() * other.length())
    };
    (0..8).map(cosine).fold(1.0, |least, cosine| if cosine < least || cosine.is_nan() { cosine } else { least })
}

/// Outward normals where a number of a part is 0, by where it rises.
fn outward(atom: &Atom, rise: DVec3, cosine: f64) -> Option<Facing> {
    let normal = if atom.is_complement? { rise } else { -rise };
    (cosine >= LEAST && normal.is_normalized()).then_some(Facing { normal, cosine: cosine - ROUNDING })
}

impl Facing {
    /// That of all pieces that may be the surface; nothing if they have none in common.
    pub(super) fn of(pieces: &[Piece]) -> Option<Facing> {
        let open = || pieces.iter().filter(|piece| piece.sign.is_none());
        let all: Vec<Facing> = open().map(|piece| piece.facing).collect::<Option<_>>()?;
        // From the middle of all towards those that are farthest.
        let mut best: Option<Facing> = None;
        let mut sum: DVec3 = all.iter().map(|facing| facing.normal).sum();
        for _ in 0..=2 * all.len() {
            let normal = sum.try_normalize()?;
            let angle = |facing: &Facing| facing.normal.dot(normal).clamp(-1.0, 1.0).acos() + facing.cosine.acos();
            let farthest = all.iter().max_by(|a, b| angle(a).total_cmp(&angle(b)))?;
            let cosine = if all.len() == 1 { farthest.cosine } else { angle(farthest).min(std::f64::consts::PI).cos() };
            if best.is_none_or(|best| cosine > best.cosine) {
                best = Some(Facing { normal, cosine });
            }
            sum = normal + 0.3 * farthest.normal;
        }
        best.filter(|facing| facing.cosine >= LEAST)
    }
}
