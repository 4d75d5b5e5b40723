//! The generalised winding number of triangles.
//!
//! ```text
//!     w(p) = 1/4π Σ Ω(p),      Ω the solid angle of a triangle as seen from p, positive from behind
//! ```
//!
//! From far away the triangles of a box of the hierarchy are seen as a dipole and a quadrupole
//! about their middle, of which the box keeps the moments; near ones are seen one by one.
//!
//! Sources: G. Barill et al., *Fast Winding Numbers for Soups and Clouds* (2018), section 3; A. van
//! Oosterom and J. Strackee, *The Solid Angle of a Plane Triangle* (1983).

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use rvachev_num::{Cancelled, Real, Run};

use super::super::face::{double, wide};
use super::super::hierarchy::{DEEPEST, PARENT};
use super::super::packet::Packet;
use super::super::{AT_ONCE, Patches};

/// From as many radii away a box is seen as one: of coarse facets the winding number is off by up
/// to some hundredths.
const FAR: f64 = 2.0;

/// The same of points whose side is in doubt: by less than 10⁻³.
const FARTHER: f64 = 5.0;

/// Nearer to one half a winding number is in doubt.
const DOUBT: f64 = 0.2;

/// The triangles of a box as seen from afar.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    /// The middle by area, and how far the triangles are from it at most.
    centre: [f32; 3],
    radius: f32,
    /// The sum of the area vectors.
    dipole: [f32; 3],
    /// The symmetric part of the sum of their products with the ways from the middle: xx, yy, zz,
    /// xy, yz, zx.
    quadrupole: [f32; 6],
}

/// Moments while they are summed up.
#[derive(Clone, Copy)]
struct Sum {
    centre: DVec3,
    area: f64,
    dipole: DVec3,
    /// About the centre.
    quadrupole: DMat3,
}

impl Sum {
    const NONE: Sum = Sum { centre: DVec3::ZERO, area: 0.0, dipole: DVec3::ZERO, quadrupole: DMat3::ZERO };

    /// Both about a common middle.
    fn with(self, other: Sum) -> Sum {
        let area = self.area + other.area;
        let centre = if area > 0.0 {
            (self.area * self.centre + other.area * other.centre) / area
        } else {
            0.5 * (self.centre + other.centre)
        };
        let about = |sum: Sum| sum.quadrupole + product(sum.centre - centre, sum.dipole);
        Sum { centre, area, dipole: self.dipole + other.dipole, quadrupole: about(self) + about(other) }
    }
}

/// The symmetric part of a product.
fn product(v: DVec3, w: DVec3) -> DMat3 {
    let product = DMat3::from_cols(w.x * v, w.y * v, w.z * v);
    (product + product.transpose()) * 0.5
}

/// Triangles and the moments of the boxes that hold them.
pub(super) struct Winding {
    pub(super) patches: Arc<Patches>,
    moments: Vec<Moments>,
    /// Whether the triangles leave no opening: numbers are whole then.
    is_closed: bool,
}

impl Winding {
    pub(super) fn new(patches: Arc<Patches>, is_closed: bool, run: &Run) -> Result<Winding, Cancelled> {
        let nodes = &patches.nodes;
        let mut sums = vec![Sum::NONE; nodes.len()];
        let mut moments = vec![Moments::default(); nodes.len()];
        // Children come after their parents.
        for (at, node) in nodes.iter().enumerate().rev() {
            if at.is_multiple_of(AT_ONCE) {
                run.check()?;
            }
            let mut sum = Sum::NONE;
            let mut within: f64 = 0.0;
            if node.count >= PARENT {
                let children = [node.first as usize, node.first as usize + 1];
                sum = sums[children[0]].with(sums[children[1]]);
                for child in children {
                    within = within.max(sums[child].centre.distance(sum.centre) + f64::from(moments[child].radius));
                }
            } else {
                let triangles = || (node.first..node.first + node.count).map(|at| at as usize);
                sum = triangles().fold(sum, |sum, at| sum.with(patches.sum_of(at)));
                for corner in triangles().flat_map(|at| patches.corners_of(at)) {
                    within = within.max(corner.distance(sum.centre));
                }
            }
            // No corner of the box is farther away, nor any triangle.
            let (low, high) = (double(node.low), double(node.high));
            let radius = (sum.centre - low).abs().max((high - sum.centre).abs()).length().min(within * (1.0 + 1e-6));
            let q = sum.quadrupole;
            let quadrupole = [q.x_axis.x, q.y_axis.y, q.z_axis.z, q.x_axis.y, q.y_axis.z, q.z_axis.x];
            moments[at] = Moments {
                centre: sum.centre.as_vec3().to_array(),
                radius: radius as f32,
                dipole: sum.dipole.as_vec3().to_array(),
                quadrupole: quadrupole.map(|part| part as f32),
            };
            sums[at] = sum;
        }
        Ok(Winding { patches, moments, is_closed })
    }

    pub(super) fn is_closed(&self) -> bool {
        self.is_closed
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.moments)
    }

    /// The number at a point.
    pub(super) fn number(&self, p: DVec3) -> f64 {
        self.number_at(self.patches.frame.into_local(p).to_array())
    }

    /// The same in the frame of the patches.
    pub(super) fn number_at(&self, local: [f64; 3]) -> f64 {
        let number = self.sum(local, FAR, &mut Stack::default());
        if Winding::is_doubtful(number) { self.sum(local, FARTHER, &mut Stack::default()) } else { number }
    }

    /// Whether a number from [`roughly`](Winding::roughly) does not tell the side.
    pub(super) fn is_doubtful(number: f64) -> bool {
        number.is_nan() || (number - 0.5).abs() <= DOUBT
    }

    /// The numbers at points, to tell their sides unless these are doubtful.
    #[inline(always)]
    pub(super) fn roughly<R: Packet>(&self, p: [R; 3], stack: &mut Stack) -> R {
        self.sum(p, FAR, stack)
    }

    #[inline(always)]
    fn sum<R: Packet>(&self, p: [R; 3], far: f64, stack: &mut Stack) -> R {
        let mut near = p[0].lift(0.0);
        let mut beyond = near;
        let mut height = usize::from(!self.moments.is_empty());
        stack.0[0] = 0;
        while height > 0 {
            height -= 1;
            let at = stack.0[height] as usize;
            let seen = &self.moments[at];
            let [x, y, z] = wide(seen.centre);
            let d = [-p[0] + x, -p[1] + y, -p[2] + z];
            let square = dot(d, d);
            let reach = far * f64::from(seen.radius);
            if !square.any_below(square.lift(reach * reach)) && reach > 0.0 {
                beyond = beyond + seen.at(d, square);
                continue;
            }
            let node = &self.patches.nodes[at];
            if node.count >= PARENT {
                stack.0[height] = node.first;
                stack.0[height + 1] = node.first + 1;
                height += 2;
                continue;
            }
            for at in node.first..node.first + node.count {
                let Some((face, sides)) = self.patches.at(at as usize) else { continue };
                let triangle = Triangle { a: wide(face.a), e: wide(sides.e), f: wide(sides.f) };
                let (d, square) = triangle.seen_from(p);
                if square.any_below(square.lift(far * far * triangle.square_radius())) {
                    near = near + triangle.half_angle(p);
                } else {
                    // About its middle a flat triangle has no quadrupole.
                    let [x, y, z] = triangle.area();
                    let per = square.lift(1.0) / square.sqrt();
                    let dipole = d[0].scale_add(x, d[1].scale_add(y, d[2] * z));
                    beyond = beyond + dipole * per * per * per;
                }
            }
        }
        near * (0.5 / PI) + beyond * (0.25 / PI)
    }
}

/// A corner and the sides from there.
struct Triangle {
    a: [f64; 3],
    e: [f64; 3],
    f: [f64; 3],
}

impl Triangle {
    /// The area vector.
    #[inline(always)]
    fn area(&self) -> [f64; 3] {
        let Triangle { e, f, .. } = self;
        [0.5 * (e[1] * f[2] - e[2] * f[1]), 0.5 * (e[2] * f[0] - e[0] * f[2]), 0.5 * (e[0] * f[1] - e[1] * f[0])]
    }

    /// The square of how far the farthest corner is from the middle.
    #[inline(always)]
    fn square_radius(&self) -> f64 {
        let Triangle { e, f, .. } = self;
        let (ee, ef, ff) = (dot(*e, *e), dot(*e, *f), dot(*f, *f));
        let from_a = ee + ff + 2.0 * ef;
        let from_b = 4.0 * ee + ff - 4.0 * ef;
        let from_c = ee + 4.0 * ff - 4.0 * ef;
        from_a.max(from_b).max(from_c) / 9.0
    }

    /// The way from a point to the middle, and its square.
    #[inline(always)]
    fn seen_from<R: Real>(&self, p: [R; 3]) -> ([R; 3], R) {
        let Triangle { a, e, f } = self;
        let d = [
            -p[0] + (a[0] + (e[0] + f[0]) * (1.0 / 3.0)),
            -p[1] + (a[1] + (e[1] + f[1]) * (1.0 / 3.0)),
            -p[2] + (a[2] + (e[2] + f[2]) * (1.0 / 3.0)),
        ];
        (d, dot(d, d))
    }

    /// Half the solid angle.
    #[inline(always)]
    fn half_angle<R: Real>(&self, p: [R; 3]) -> R {
        let Triangle { a, e, f } = self;
        let a = [-p[0] + a[0], -p[1] + a[1], -p[2] + a[2]];
        let b = [a[0] + e[0], a[1] + e[1], a[2] + e[2]];
        let c = [a[0] + f[0], a[1] + f[1], a[2] + f[2]];
        let (la, lb, lc) = (dot(a, a).sqrt(), dot(b, b).sqrt(), dot(c, c).sqrt());
        // a·(b × c) = a·(e × f).
        let [x, y, z] = self.area();
        let over = a[0].scale_add(2.0 * x, a[1].scale_add(2.0 * y, a[2] * (2.0 * z)));
        let under = la.mul_add(lb * lc, dot(a, b).mul_add(lc, dot(b, c).mul_add(la, dot(c, a) * lb)));
        over.atan2(under)
    }
}

/// Boxes that are still to be looked into.
pub(super) struct Stack(pub(super) [u32; DEEPEST + 1]);

impl Default for Stack {
    fn default() -> Stack {
        Stack([0; DEEPEST + 1])
    }
}

impl Moments {
    /// 4π times the winding number of what is at `d` from a point.
    #[inline(always)]
    fn at<R: Real>(&self, d: [R; 3], square: R) -> R {
        let [x, y, z] = wide(self.dipole);
        let [xx, yy, zz, xy, yz, zx] = self.quadrupole;
        let ([xx, yy, zz], [xy, yz, zx]) = (wide([xx, yy, zz]), wide([xy, yz, zx]));
        let per = square.lift(1.0) / square.sqrt();
        let per_square = per * per;
        let dipole = d[0].scale_add(x, d[1].scale_add(y, d[2] * z));
        let row_x = d[0].scale_add(xx, d[1].scale_add(2.0 * xy, d[2] * (2.0 * zx)));
        let row_y = d[1].scale_add(yy, d[2] * (2.0 * yz));
        let across = d[0].mul_add(row_x, d[1].mul_add(row_y, d[2] * d[2] * zz));
        let quadrupole = across * per_square * -3.0 + (xx + yy + zz);
        (dipole + quadrupole) * per_square * per
    }
}

#[inline(always)]
fn dot<R: Real>(v: [R; 3], w: [R; 3]) -> R {
    v[0].mul_add(w[0], v[1].mul_add(w[1], v[2] * w[2]))
}

impl Patches {
    /// The corners of one triangle.
    fn corners_of(&self, at: usize) -> [DVec3; 3] {
        let Some((face, sides)) = self.at(at) else { return [DVec3::ZERO; 3] };
        let [a, e, f] = [double(face.a), double(sides.e), double(sides.f)];
        [a, a + e, a + f]
    }

    /// The moments of one triangle about its middle.
    fn sum_of(&self, at: usize) -> Sum {
        let Some((face, sides)) = self.at(at) else { return Sum::NONE };
        let [a, e, f] = [double(face.a), double(sides.e), double(sides.f)];
        let dipole = 0.5 * e.cross(f);
        Sum { centre: a + (e + f) / 3.0, area: dipole.length(), dipole, quadrupole: DMat3::ZERO }
    }
}
