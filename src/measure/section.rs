//! How much of a rectangle is inside a solid, and how much surface there is in a box, at least and
//! at most.
//!
//! ```text
//!         |   |  layer        The layers that the pieces of the surface lie in cut a rectangle into polygons.
//!    -----|---|---------      Beyond a layer its piece has one sign; what is within layers is open where the
//!     in  | ? |  out          others do not tell it.
//! ```
//!
//! A piece is surface where its sign makes the solid's. It is seen on the plane in the middle of
//! its layer: its shadow there is as large as itself, but for how far its normals are turned. The
//! layers of the others, and the sides of the box, are farther off there by what a point may be off
//! the plane.

use glam::DVec3;

use super::pieces::{Piece, pieces};
use super::polytope::{Face, Plane, Polytope};
use crate::Bounds;
use crate::eval::Narrowed;
use crate::program::Program;

/// A polygon is cut into no more parts.
const PARTS: usize = 512;

/// A piece, and its layer.
#[derive(Clone, Copy)]
struct Shown {
    number: usize,
    plane: Plane,
    half: f64,
}

struct Section<'a> {
    program: &'a Program,
    pieces: &'a [Piece],
    /// The piece in whose plane the polygon lies, if it is asked where that is surface.
    shown: Option<Shown>,
    /// Whether the first pieces are positive.
    signs: Vec<Option<bool>>,
    /// The area where what is asked is so, and where it is not told.
    sure: f64,
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
    let section = Section::of(program, &pieces, None, &whole);
    [section.sure.min(area), (section.sure + section.open).min(area)]
}

/// The area of the surface in a box, of which these are the pieces, at least and at most.
pub(super) fn area_shown(program: &Program, pieces: &[Piece], cell: &Bounds) -> [f64; 2] {
    let mut all = [0.0; 2];
    for (number, piece) in pieces.iter().enumerate().filter(|(_, piece)| piece.sign.is_none()) {
        let most = piece.most_area(cell.size());
        let (Some((plane, half)), Some(facing)) = (piece.layer, piece.facing) else {
            all[1] += most;
            continue;
        };
        let far = cell.min.abs().max(cell.max.abs()).max_element();
        let off = half * plane.normal().abs();
        let shown = Some(Shown { number, plane, half });
        let section = |half: DVec3| {
            if half.min_element() <= 0.0 {
                return [0.0; 2];
            }
            let polygon = Polytope::cuboid(half, far).section(&plane);
            let Section { sure, open, .. } = Section::of(program, pieces, shown, &polygon);
            [sure, sure + open]
        };
        all[0] += section(cell.half_extents() - off)[0];
        all[1] += (section(cell.half_extents() + off)[1] / facing.cosine).min(most);
    }
    [all[0].min(all[1]), all[1]]
}

impl<'a> Section<'a> {
    fn of(program: &'a Program, pieces: &'a [Piece], shown: Option<Shown>, polygon: &Face) -> Section<'a> {
        let (signs, left) = (vec![None; pieces.len()], PARTS);
        let mut section = Section { program, pieces, shown, signs, sure: 0.0, open: 0.0, left };
        section.divide(polygon, 0);
        section
    }

    fn is_inside(&self) -> Option<bool> {
        self.program.is_inside_by(|node| {
            let own = self.pieces.iter().zip(&self.signs).filter(|(piece, _)| piece.node == node);
            let mut signs = own.map(|(_, sign)| *sign);
            // The least of numbers is positive where all are.
            if signs.clone().any(|sign| sign == Some(false)) {
                Some(false)
            } else {
                signs.all(|sign| sign == Some(true)).then_some(true)
            }
        })
    }

    /// Whether it is inside, or whether the piece is surface, if what is known tells it.
    fn is_so(&mut self) -> Option<bool> {
        let Some(Shown { number, .. }) = self.shown else { return self.is_inside() };
        let [above, below] = [true, false].map(|sign| {
            self.signs[number] = Some(sign);
            self.is_inside()
        });
        self.signs[number] = None;
        Some(above? != below?)
    }

    /// Adds what of a polygon is so, given the signs of the first pieces.
    fn divide(&mut self, polygon: &Face, told: usize) {
        if polygon.is_empty() {
            return;
        }
        self.left = self.left.saturating_sub(1);
        match (self.is_so(), self.pieces.get(told).filter(|_| self.left > 0)) {
            (Some(true), _) => self.sure += polygon.area(),
            (Some(false), _) => {}
            (None, None) => self.open += polygon.area(),
            (None, Some(piece)) => {
                let (sign, layer) = (piece.sign, piece.layer);
                let is_shown = self.shown.is_some_and(|shown| shown.number == told);
                if let Some((plane, half)) = layer.filter(|_| sign.is_none() && !is_shown) {
                    // A point that is off the plane of the one that is shown is as far off this
                    // one.
                    let off = |shown: Shown| shown.half * shown.plane.normal().dot(plane.normal()).abs();
                    let half = half + self.shown.map_or(0.0, off);
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
        let random = |n: u32| {
            let mixed = |z: u64, by: u32, times: u64| (z ^ z >> by).wrapping_mul(times);
            let z = (u64::from(n) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let z = mixed(mixed(z, 30, 0xbf58_476d_1ce4_e5b9), 27, 0x94d0_49bb_1331_11eb);
            (z >> 33) as f64 / 2f64.powi(31)
        };
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
