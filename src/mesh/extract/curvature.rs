//! Smooth cells whose triangles would be too far off the surface: others, or a vertex in their
//! middle.
//!
//! ```text
//!     m  ___  n      The normals m, n … at the vertices p, q … of a cell's loop tell how far the surface
//!     \.' c './      is from triangles between them. Of four vertices the diagonal that bends less is the
//!      p-----q       better one. If that is too far as well, the cell has triangles from c to the segments
//!                    of the loop.
//! ```
//!
//! Let the surface be at the height h(x) = −½ xᵀKx. To first order its normal is (Kx, 1), and for
//! two of its points with the way d between them the bend dᵀKd is (q − p)·(n − m). A triangle is
//! below the surface by ½ Σ λᵢλⱼ dᵀKd over its sides, where λ are the barycentric coordinates: by
//! an eighteenth of the three bends in its middle, and by an eighth of its bend in the middle of a
//! side.
//!
//! * Two triangles with a diagonal between four vertices are off by (½ (a + b) + a)/18 in the mean,
//!   with a and b the bends of that diagonal and of the other one: the four sides bend by a + b
//!   together. Neither diagonal lies in a face of the cell, and either will do: two faces of a
//!   tetrahedron do not cross, and four points that a plane cuts from the edges of a cube are the
//!   corners of a convex polygon.
//! * With r the way from the middle of some points to each of them, the surface is above the middle
//!   by half the mean of rᵀKr, which is half the mean of n·(p − middle). Where it bends both ways,
//!   as a saddle does, the terms have both signs; the mean of their sizes tells how far it may be
//!   from triangles.
//! * The segments of the loop stay, and so does what the triangles are off there: sin²(π/n) times
//!   that height, for a regular loop of n. The vertex is as far above the surface as they are
//!   below: that takes a third to a half off what the triangles are off in the mean, and no point
//!   is farther off than those segments.
//!
//! What is of third order is left out. No more values of the field are needed, but where normals
//! differ as those of a crease do: see [`spread`](super::spread). That fans are embedded is shown
//! in [`sharp`](super::sharp).

use glam::Vec3A;

use crate::mesh::feature::{Crease, Slope, differ};

/// How far the two triangles of four vertices may be off the surface in their middles, in cells,
/// before the better diagonal is chosen.
const TURNED: f32 = 0.01;

/// And how far with the better diagonal, before there is a vertex.
const FAR: f32 = 0.0175;

/// The distance of a longer loop's middle from the surface, in cells, beyond which there is a
/// vertex.
const HIGH: f32 = 0.0125;

/// And beyond which the normals do not tell how high the surface is: a fifth less, or more, is as
/// much as the vertex may be off.
const STEEP: f32 = 0.06;

/// The most that a vertex is raised above the surface, in cells.
const MOST: f32 = 0.06;

/// How high the vertex is above the middle of a loop, as a part of how high the surface is: of
/// three to seven vertices.
const RAISED: [f32; 5] = [1.75, 1.5, 1.345, 1.25, 1.188];

/// Cells whose normals have a larger variance are hardly ever round: with half of them on each side
/// of a right angle it is 1/2.
const WIDE: f32 = 0.35;

/// How much higher or lower a round cell's surface may be than its normals tell, as a part of what
/// they do.
const OFF: f32 = 0.2;

/// The square of how much its normal in the middle may differ from the mean of those around, as a
/// part of their variance.
const ASKEW: f32 = 0.09;

/// If no normals of a cell differ by more than this angle, the cell is nearly flat: the normals of
/// a loop within 0.8 cells of its middle make it no farther off than [`TURNED`] then.
const SPREAD: f32 = 0.05;

/// The normals at the vertices on a cell's loop, in order.
pub(super) struct Ring<const N: usize> {
    pub(super) normals: [Vec3A; N],
    /// The sum of the normals.
    sum: Vec3A,
    variance: f32,
    crease: Crease,
}

/// The sum of some normals, and the mean of the squares of their distances from their mean: what
/// the square of that lacks of 1.
#[inline(always)]
fn sum_and_variance<const N: usize>(normals: &[Vec3A; N]) -> (Vec3A, f32) {
    let sum = normals.iter().sum::<Vec3A>();
    let share = 1.0 / (N * N) as f32;
    (sum, 1.0 - share * sum.length_squared())
}

/// Whether two of some normals differ as those of a crease do, given their variance.
#[inline(always)]
fn are_unlike<const N: usize>(normals: &[Vec3A; N], variance: f32, crease: Crease) -> bool {
    // The square of the distance of two is at most twice the sum of the squares of those from the
    // mean. Rounding may take some 10⁻⁷ off that.
    2.0 * N as f32 * variance + 1e-6 >= 2.0 - 2.0 * crease.smooth && differ(normals, crease)
}

/// Whether two normals of a cell differ as those of a crease do.
#[inline(always)]
pub(super) fn is_strongly_curved<const N: usize>(normals: &[Vec3A; N], crease: Crease) -> bool {
    are_unlike(normals, sum_and_variance(normals).1, crease)
}

impl<const N: usize> Ring<N> {
    #[inline(always)]
    pub(super) fn new(normals: [Vec3A; N], crease: Crease) -> Ring<N> {
        let (sum, variance) = sum_and_variance(&normals);
        Ring { normals, sum, variance, crease }
    }

    /// Whether the cell is nearly flat: a few normals in a circle of that diameter are this far
    /// from their mean.
    #[inline(always)]
    pub(super) fn is_flat(&self) -> bool {
        let spread = self.crease.part * SPREAD;
        self.variance < 0.25 * spread * spread
    }

    /// Whether no two normals differ as those of a crease do.
    #[inline(always)]
    pub(super) fn is_smooth(&self) -> bool {
        !are_unlike(&self.normals, self.variance, self.crease)
    }

    /// Whether a cell that is not smooth may be round all the same.
    #[inline(always)]
    pub(super) fn may_be_round(&self) -> bool {
        self.variance < WIDE
    }

    /// What a cell that is not smooth has in its middle, given its vertices.
    #[inline(always)]
    pub(super) fn middle(&self, positions: &[Vec3A; N]) -> Middle {
        let (height, far, at) = height(positions, &self.normals);
        Middle { count: N, at, height, far, normal: self.sum.normalize_or_zero(), variance: self.variance }
    }

    /// What a smooth cell that is not flat is to have, if it asks where its vertices are, in cells
    /// from the block's first node.
    #[inline(always)]
    pub(super) fn cover(&self, positions: impl FnOnce() -> [Vec3A; N]) -> Cover {
        // A single triangle is small.
        if N == 3 {
            return Cover::Table;
        }
        let positions = positions();
        if N == 4 {
            let [first, second] = diagonals(&positions, &self.normals);
            if first.max(second) <= TURNED {
                return Cover::Table;
            }
            if first.min(second) <= FAR {
                return Cover::Two(if first <= second { [[0, 1, 2], [0, 2, 3]] } else { [[1, 2, 3], [1, 3, 0]] });
            }
        }
        let (height, far, middle) = height(&positions, &self.normals);
        if N > 4 && far <= HIGH {
            return Cover::Table;
        }
        let normal = self.sum.normalize_or_zero();
        let at = middle + raised(N, height) * normal;
        // Beyond a face of the cell it cannot be.
        if far > STEEP || at.floor() != middle.floor() {
            return Cover::Open;
        }
        Cover::Top { at, normal }
    }
}

/// How high the vertex is above the middle of so many, given how high the surface is; never far
/// above that.
#[inline(always)]
fn raised(count: usize, height: f32) -> f32 {
    height + ((RAISED[count.clamp(3, 7) - 3] - 1.0) * height).clamp(-MOST, MOST)
}

/// What a cell has.
pub(super) enum Cover {
    /// What the field tells in its middle.
    Open,
    /// The triangles of the table.
    Table,
    /// These, with a diagonal between four vertices, by their places in the loop.
    Two([[u8; 3]; 2]),
    /// Triangles around a vertex, in cells from the block's first node, with the unit normal there.
    Top { at: Vec3A, normal: Vec3A },
}

/// The middle of a loop whose normals differ as those at a crease do, and what a smooth surface
/// would have there.
pub(super) struct Middle {
    /// How many vertices there are.
    pub(super) count: usize,
    pub(super) at: Vec3A,
    height: f32,
    far: f32,
    normal: Vec3A,
    variance: f32,
}

impl Middle {
    /// The vertex that the cell is to have, and the unit normal there, if it is round, given the
    /// field in the middle.
    #[inline(always)]
    pub(super) fn top(&self, slope: &Slope, step: f32) -> Option<(Vec3A, Vec3A)> {
        let (normal, depth) = slope.surface(step)?;
        let is_near = (depth - self.height).abs() <= OFF * self.far;
        let is_round = is_near && (normal - self.normal).length_squared() <= ASKEW * self.variance;
        is_round.then(|| (self.at + raised(self.count, depth) * normal, normal))
    }
}

/// How far the triangles with the first, and with the second diagonal between four points of a
/// surface are off it.
#[inline(always)]
fn diagonals(positions: &[Vec3A], normals: &[Vec3A]) -> [f32; 2] {
    let bend = |n: usize, m: usize| (positions[m] - positions[n]).dot(normals[m] - normals[n]);
    let (first, second) = (bend(0, 2), bend(1, 3));
    [first, second].map(|own| (1.0 / 18.0) * (0.5 * (first + second) + own).abs())
}

/// How far the surface is above the middle of points on it, given with the normals there; how far
/// it may be from triangles between them; and the middle.
#[inline(always)]
fn height(positions: &[Vec3A], normals: &[Vec3A]) -> (f32, f32, Vec3A) {
    let share = 1.0 / normals.len() as f32;
    let middle = share * positions.iter().sum::<Vec3A>();
    let (mut height, mut far) = (0.0, 0.0);
    for (at, normal) in positions.iter().zip(normals) {
        let rise = normal.dot(*at - middle);
        height += rise;
        far += rise.abs();
    }
    (0.5 * share * height, 0.5 * share * far, middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_heights_holds() {
        // A ball 16 cells across, and a saddle.
        let ball = |x: f32, y: f32| {
            let normal = Vec3A::new(x, y, 8.0).normalize();
            (8.0 * normal, normal)
        };
        let saddle = |x: f32, y: f32| (Vec3A::new(x, y, (x * x - y * y) / 16.0), Vec3A::new(-x, y, 8.0).normalize());
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let look =
            |corners: [(Vec3A, Vec3A); 4]| height(&corners.map(|corner| corner.0), &corners.map(|corner| corner.1));
        let (above, far, middle) = look(square.map(|(x, y)| ball(x, y)));
        assert!((middle.length() + above - 8.0).abs() < 1e-3 && far > 0.03, "{above}, {far}");
        let (above, far, middle) = look(square.map(|(x, y)| saddle(x - 0.5, y - 0.5)));
        assert!(middle.length() < 1e-6 && above.abs() < 1e-3, "{above}");
        assert!(far < 1e-6, "the vertices are at one height: {far}");
        let diamond = [(0.5, 0.0), (0.0, 0.5), (-0.5, 0.0), (0.0, -0.5)];
        let (above, far, _) = look(diamond.map(|(x, y)| saddle(x, y)));
        assert!(above.abs() < 1e-3 && far > 0.007, "{above}, {far}");
    }

    #[test]
    fn the_diagonal_along_a_tube_is_the_better_one() {
        // A tube along x, 10 cells across.
        let tube = |x: f32, y: f32| {
            let height = (25.0 - y * y).sqrt();
            (Vec3A::new(x, y, height), Vec3A::new(0.0, y, height) / 5.0)
        };
        let corners = [(0.5, 0.0), (0.0, 0.5), (-0.5, 0.0), (0.0, -0.5)].map(|(x, y)| tube(x, y));
        let (positions, normals) = (corners.map(|corner| corner.0), corners.map(|corner| corner.1));
        let [along, across] = diagonals(&positions, &normals);
        // What the middles of the triangles are off.
        let off = |triangle: [usize; 3]| {
            let middle = triangle.iter().map(|&n| positions[n]).sum::<Vec3A>() / 3.0;
            5.0 - middle.y.hypot(middle.z)
        };
        assert!((along - off([0, 1, 2])).abs() < 0.01 * along && along > 5e-3, "{along}, {}", off([0, 1, 2]));
        assert!((across - off([1, 2, 3])).abs() < 0.01 * across && across > 2.9 * along, "{across}, {along}");
    }

    #[test]
    fn a_raised_vertex_is_as_far_above_as_the_segments_around_it_are_below() {
        for (n, raised) in (3..8).zip(RAISED) {
            let at = |k: usize| {
                let (sin, cos) = (std::f32::consts::TAU * k as f32 / n as f32).sin_cos();
                let normal = Vec3A::new(0.5 * cos, 0.5 * sin, 8.0).normalize();
                (8.0 * normal, normal)
            };
            let (positions, normals): (Vec<Vec3A>, Vec<Vec3A>) = (0..n).map(at).unzip();
            let (height, _, middle) = height(&positions, &normals);
            let above = middle.length() + raised * height - 8.0;
            let below = 8.0 - (0.5 * (positions[0] + positions[1])).length();
            assert!((above / below - 1.0).abs() < 0.02, "{n}: {above}, {below}");
        }
    }

    /// What the cell has whose loop is a regular polygon, seen from above, if its normals spread,
    /// given the height of the surface, its slope there, and the field in cells.
    fn top_of<const N: usize>(
        turn: f32,
        surface: impl Fn(f32, f32) -> (f32, [f32; 2]),
        field: impl Fn(Vec3A) -> (f32, Vec3A),
    ) -> Option<Option<(Vec3A, Vec3A)>> {
        let corner: [_; N] = std::array::from_fn(|n| {
            let (sin, cos) = (turn + std::f32::consts::TAU * n as f32 / N as f32).sin_cos();
            let (x, y) = (0.6 * cos, 0.6 * sin);
            let (height, [u, v]) = surface(x, y);
            (Vec3A::new(x, y, height), Vec3A::new(-u, -v, 1.0).normalize())
        });
        let ring = Ring::new(corner.map(|(_, normal)| normal), Crease::USUAL);
        let middle = ring.middle(&corner.map(|(at, _)| at));
        let (value, gradient) = field(middle.at);
        let is_asked = !ring.is_smooth() && ring.may_be_round();
        is_asked.then(|| middle.top(&Slope { value, gradient }, 1.0))
    }

    #[test]
    fn roofs_are_never_round() {
        let (mut state, mut asked) = (1_u64, 0);
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        for n in 0..40_000 {
            // Two planes through a ridge that is somewhere, along y and tilted; up to 84° from each
            // other.
            let (ridge, tilt, left, right) = (next() - 0.5, next() - 0.5, 0.9 * next(), 0.9 * next());
            let planes = [left, -right].map(|slope| {
                let normal = Vec3A::new(-slope, -tilt, 1.0);
                (normal / normal.length(), normal.dot(Vec3A::X * ridge) / normal.length())
            });
            let surface = |x: f32, y: f32| {
                let slope = if x < ridge { left } else { -right };
                (slope * (x - ridge) + tilt * y, [slope, tilt])
            };
            // Joined by min, or by the R-function R_0: f + g − √(f² + g²).
            let field = |p: Vec3A| {
                let [(f, down), (g, other)] = planes.map(|(normal, d)| (d - normal.dot(p), -normal));
                if n % 2 == 0 {
                    return if f < g { (f, down) } else { (g, other) };
                }
                let root = f.hypot(g);
                (f + g - root, down * (1.0 - f / root) + other * (1.0 - g / root))
            };
            let turn = 7.0 * next();
            let found = match n / 2 % 4 {
                0 => top_of::<4>(turn, surface, field),
                1 => top_of::<5>(turn, surface, field),
                2 => top_of::<6>(turn, surface, field),
                _ => top_of::<7>(turn, surface, field),
            };
            asked += usize::from(found.is_some());
            assert!(found.flatten().is_none(), "{n}: ridge at {ridge}, slopes {left}, {right}, tilt {tilt}");
        }
        assert!(asked > 10_000, "{asked}");
    }

    #[test]
    fn arcs_and_balls_are_round() {
        for (turn, radius) in [(0.4, 1.5), (0.7, 1.45), (0.1, 1.4), (0.3, 1.3)] {
            let ball = |x: f32, y: f32| {
                let z = (radius * radius - x * x - y * y).sqrt();
                (z, [-x / z, -y / z])
            };
            let tube = |x: f32, _: f32| {
                let z = (radius * radius - x * x).sqrt();
                (z, [-x / z, 0.0])
            };
            let of_ball = |p: Vec3A| (radius - p.length(), -p.normalize());
            let of_tube = |p: Vec3A| {
                let across = Vec3A::new(p.x, 0.0, p.z);
                (radius - across.length(), -across.normalize())
            };
            let tops =
                [top_of::<4>(turn, ball, of_ball), top_of::<5>(turn, ball, of_ball), top_of::<4>(turn, tube, of_tube)];
            for (n, top) in tops.into_iter().enumerate() {
                let (at, normal) = top.expect("the normals spread").expect("it is round");
                let (value, _) = if n == 2 { of_tube(at) } else { of_ball(at) };
                // As high above the surface as the segments around it are below.
                assert!(value < 0.0 && value > -0.12 && normal.z > 0.99, "{n} at {radius}: {value}");
            }
        }
    }
}
