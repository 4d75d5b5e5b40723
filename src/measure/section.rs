//! How much of a rectangle is inside a solid, at least and at most.
//!
//! The layers that the pieces of the surface lie in cut the rectangle into polygons. Beyond a layer
//! its piece has one sign; what is within layers is open where the others do not tell it.

use super::pieces::{Piece, pieces};
use super::polytope::Face;
use crate::Bounds;
use crate::eval::Narrowed;
use crate::program::Program;

/// A rectangle is cut into no more parts.
const PARTS: usize = 512;

struct Section<'a> {
    program: &'a Program,
    pieces: &'a [Piece],
    /// Whether the first pieces are positive.
    signs: Vec<Option<bool>>,
    inside: f64,
    open: f64,
    left: usize,
}

/// The area inside a solid of a box that is flat along an axis, at least and at most.
pub(super) fn area_inside(program: &Program, rectangle: &Bounds, axis: usize) -> [f64; 2] {
    let whole = Face::rectangle(rectangle.half_extents(), axis);
    let area = whole.area();
    let narrowed;
    let program = match program.narrowed(rectangle) {
        Narrowed::Inside => return [area; 2],
        Narrowed::Outside => return [0.0; 2],
        Narrowed::Same => program,
        Narrowed::Simpler(simpler) => {
            narrowed = simpler;
            &narrowed
        }
    };
    let Some(pieces) = pieces(program, rectangle) else { return [0.0, area] };
    let (signs, left) = (vec![None; pieces.len()], PARTS);
    let mut section = Section { program, pieces: &pieces, signs, inside: 0.0, open: 0.0, left };
    section.divide(&whole, 0);
    [section.inside.min(area), (section.inside + section.open).min(area)]
}

impl Section<'_> {
    fn is_inside(&self) -> Option<bool> {
        self.program.is_inside_by(|node| {
            let own = self.pieces.iter().zip(&self.signs).filter(|(piece, _)| piece.node == node);
            // The least of numbers is positive where all are.
            own.fold(Some(true), |all, (_, sign)| match (all, *sign) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (Some(true), Some(true)) => Some(true),
                _ => None,
            })
        })
    }

    /// Adds what of a polygon is inside, given the signs of the first pieces.
    fn divide(&mut self, polygon: &Face, told: usize) {
        if polygon.is_empty() {
            return;
        }
        self.left = self.left.saturating_sub(1);
        match (self.is_inside(), self.pieces.get(told).filter(|_| self.left > 0)) {
            (Some(true), _) => self.inside += polygon.area(),
            (Some(false), _) => {}
            (None, None) => self.open += polygon.area(),
            (None, Some(piece)) => {
                let (sign, layer) = (piece.sign, piece.layer);
                if let Some((plane, half)) = layer.filter(|_| sign.is_none()) {
                    let [over, under] = [plane.raised(half), plane.turned().raised(half)];
                    self.told(&polygon.above(&over), told, Some(true));
                    self.told(&polygon.above(&under), told, Some(false));
                    self.told(&polygon.above(&over.turned()).above(&under.turned()), told, None);
                } else {
                    self.told(polygon, told, sign);
                }
            }
        }
    }

    fn told(&mut self, polygon: &Face, told: usize, sign: Option<bool>) {
        self.signs[told] = sign;
        self.divide(polygon, told + 1);
        self.signs[told] = None;
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::distance::compiled;
    use crate::{Blend, Solid, deg};

    /// What is counted is between what is told, and this is little.
    #[test]
    fn sections_have_bounds() {
        let plate = Solid::cuboid([2.0, 2.0, 0.5]);
        let post = Solid::cylinder(0.4, 2.0);
        let bodies = [
            Solid::torus(1.0, 0.4) - Solid::sphere(0.5).translate([1.0, 0.0, 0.2]),
            (&plate | &post).rotate_x(deg(20.0)),
            plate.union_with(&post, Blend::Fillet { radius: 0.3 }),
            Solid::superellipsoid([1.0, 0.8, 0.9], 0.4, 1.4).shell(0.2),
        ];
        let random = |n: u32| f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11)) / 2f64.powi(32);
        for (number, body) in bodies.iter().enumerate() {
            let program = &compiled(body).unwrap().surface;
            let (mut told, mut asked) = (0, 0);
            for n in 0..1500u32 {
                let axis = (n % 3) as usize;
                let mut half = DVec3::splat(0.01 + 0.04 * random(8 * n));
                half[axis] = 0.0;
                let at = (DVec3::new(random(8 * n + 1), random(8 * n + 2), random(8 * n + 3)) - 0.5) * 2.8;
                let rectangle = Bounds::new(at - half, at + half);
                let [least, most] = area_inside(program, &rectangle, axis);
                let whole = 4.0 * half[(axis + 1) % 3] * half[(axis + 2) % 3];
                let count = 24;
                let inside = (0..count * count).filter(|k| {
                    let step = |k: u32| (f64::from(k) + 0.5) / f64::from(count) * 2.0 - 1.0;
                    let mut p = at;
                    p[(axis + 1) % 3] += half[(axis + 1) % 3] * step(k % count);
                    p[(axis + 2) % 3] += half[(axis + 2) % 3] * step(k / count);
                    program.value(p) > 0.0
                });
                let counted = inside.count() as f64 / f64::from(count * count) * whole;
                let slack = 0.05 * whole;
                assert!(
                    least - slack <= counted && counted <= most + slack,
                    "{number} {n}: {least} {counted} {most} of {whole}"
                );
                if counted > 0.0 && counted < whole {
                    asked += 1;
                    told += usize::from(most - least < 0.3 * whole);
                }
            }
            assert!(asked > 20 && 2 * told > asked, "{number}: {told} of {asked}");
        }
    }
}
