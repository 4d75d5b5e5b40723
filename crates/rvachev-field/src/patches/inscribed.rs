//! The largest ball that touches at a point, and holds nothing of the patches that face it.
//!
//! ```text
//!      p---               Balls about p − r n, r being less and less, are within each other. So one
//!     / \  \              walk over the boxes will do: where a patch reaches into the ball, the ball
//!    | c |  |             shrinks to touch it there, by r = |p − q|² / 2 (p − q)·n, and goes on.
//!     \ q  /
//! ```
//!
//! All of a round surface is at one distance from its middle, and boxes about pieces of it reach
//! into the ball however small they are. So each box of the hierarchy also knows how its patches
//! look: the mean of their normals, how far others are from that, and how far along it the patches
//! begin. A piece of a round surface begins there at nearly its distance.
//!
//! ```text
//!        .--|--.           A box about an arc has corners in the ball about c; but the arc is
//!     .-'   |   '-. box    beyond the plane across its mean normal a, and that misses the ball.
//!     |-----+-----| low
//!           | a
//!           c
//! ```

use glam::{DVec3, Vec3};
use rvachev_num::{Cancelled, Run};

use super::face::{Face, double};
use super::hierarchy::{Node, PARENT};
use super::{Patch, Patches};

/// A patch is asked so often at most while the ball shrinks.
const PATIENCE: usize = 16;

/// What single precision does to the places of planes, in units of the frame, and to cosines.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

/// The same of the cosines between normals that face each other.
const FACING: f32 = 1e-5;

/// Patches with a normal each, to be asked for the balls that are free of them.
pub struct Walls {
    patches: Patches,
    /// The normals, as the hierarchy sorts the patches.
    normals: Vec<DVec3>,
    looks: Vec<Look>,
}

/// How the patches of a box look.
#[derive(Clone, Copy)]
struct Look {
    /// The mean normal, of length 1.
    axis: Vec3,
    /// The least cosine between that and a normal, and the sine of that angle.
    least: f32,
    sine: f32,
    /// No point of a patch is lower along the axis.
    low: f32,
}

impl Look {
    /// No normals, as of all.
    const UNKNOWN: Look = Look { axis: Vec3::ZERO, least: -1.0, sine: 0.0, low: f32::NEG_INFINITY };

    /// Whether one of the normals may be turned so far from another one that the cosine between is
    /// less than `facing`.
    #[inline(always)]
    fn may_face(&self, n: Vec3, facing: f32) -> bool {
        let cosine = self.axis.dot(n);
        // The cosine of the sum of both angles, if that is not beyond a half turn.
        cosine <= -self.least || cosine * self.least - (1.0 - cosine * cosine).max(0.0).sqrt() * self.sine < facing
    }

    /// Whether all patches are beyond a ball.
    #[inline(always)]
    fn is_beyond(&self, centre: Vec3, radius: f32) -> bool {
        self.low - self.axis.dot(centre) >= radius
    }
}

/// A ball that touches at a point, less what may reach into it.
struct Ball {
    centre: DVec3,
    within: f64,
    /// The same as boxes know it.
    single: (Vec3, f32),
}

impl Ball {
    fn new(p: DVec3, normal: DVec3, radius: f64, slack: f64) -> Ball {
        let (centre, within) = (p - radius * normal, radius * (1.0 - slack));
        Ball { centre, within, single: (centre.as_vec3(), within as f32) }
    }

    /// Whether a box reaches into it.
    #[inline(always)]
    fn meets(&self, node: &Node) -> bool {
        let (low, high) = (double(node.low), double(node.high));
        self.centre.distance_squared(self.centre.clamp(low, high)) < self.within * self.within
    }
}

impl Face {
    /// Whether the plane of a flat patch misses a ball.
    #[inline(always)]
    fn is_beyond(&self, (centre, radius): (Vec3, f32)) -> bool {
        let (n, a) = (Vec3::from_array(self.n), Vec3::from_array(self.a));
        n.dot(centre - a).abs() - ROUNDING >= radius
    }
}

impl Walls {
    /// Flat patches with a unit normal each, which need not be quite that of the patch.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn new(all: &[(Patch, DVec3)], run: &Run) -> Result<Walls, Cancelled> {
        let (flat, normals): (Vec<Patch>, Vec<DVec3>) = all.iter().copied().unzip();
        let patches = Patches::new(&flat, run)?;
        let normals: Vec<DVec3> = patches.numbers.iter().map(|number| normals[*number as usize]).collect();
        run.check()?;
        let mut sums = vec![DVec3::ZERO; patches.nodes.len()];
        let mut ranges = vec![(0, 0); patches.nodes.len()];
        let mut looks = vec![Look::UNKNOWN; patches.nodes.len()];
        // Children come after their parents.
        for (at, node) in patches.nodes.iter().enumerate().rev() {
            let first = node.first as usize;
            (sums[at], ranges[at]) = if node.count >= PARENT {
                (sums[first] + sums[first + 1], (ranges[first].0, ranges[first + 1].1))
            } else {
                let own = first..first + node.count as usize;
                (normals[own.clone()].iter().sum(), (own.start, own.end))
            };
        }
        let mut open = Vec::new();
        open.extend((!looks.is_empty()).then_some(0));
        while let Some(at) = open.pop() {
            let (node, (from, to)) = (&patches.nodes[at], ranges[at]);
            if to - from > 1024 {
                run.check()?;
            }
            let look = patches.look(sums[at], from..to, &normals);
            looks[at] = look;
            if node.count >= PARENT {
                open.extend([node.first as usize, node.first as usize + 1]);
            }
        }
        Ok(Walls { patches, normals, looks })
    }

    /// Whether a box may hold patches that face a normal and reach into a ball.
    #[inline(always)]
    fn may_hold(&self, child: u32, ball: &Ball, (normal, facing): (Vec3, f32)) -> bool {
        let (look, (centre, within)) = (&self.looks[child as usize], ball.single);
        !look.is_beyond(centre, within)
            && look.may_face(normal, facing)
            && ball.meets(&self.patches.nodes[child as usize])
    }

    /// The square of how far a box is from a point.
    #[inline(always)]
    fn away(&self, child: u32, p: DVec3) -> f64 {
        let node = &self.patches.nodes[child as usize];
        p.distance_squared(p.clamp(double(node.low), double(node.high)))
    }

    /// The radius of the largest ball that touches at `p`, to one side of `normal`, which is to be
    /// of length 1, and holds nothing of the patches that face it but what reaches into it by less
    /// than the part `slack` of its radius: those face it whose normals have a cosine of less than
    /// `facing` with this one. Nothing if a ball of radius `most` is free of them.
    pub fn ball(&self, p: DVec3, normal: DVec3, most: f64, slack: f64, facing: f64) -> Option<f64> {
        let Walls { patches, normals, .. } = self;
        let (p, start) = (patches.frame.into_local(p), most / patches.frame.unit);
        let mut radius = start;
        let mut ball = Ball::new(p, normal, radius, slack);
        let (look_from, facing_from) = (normal.as_vec3(), facing as f32 + FACING);
        let mut open: Vec<u32> = Vec::with_capacity(64);
        open.extend((!patches.nodes.is_empty()).then_some(0));
        while let Some(at) = open.pop() {
            let node = &patches.nodes[at as usize];
            if node.count >= PARENT {
                let (a, b) = (node.first, node.first + 1);
                let from = (look_from, facing_from);
                match (self.may_hold(a, &ball, from), self.may_hold(b, &ball, from)) {
                    // What is near to p makes the ball small soonest.
                    (true, true) if self.away(a, p) <= self.away(b, p) => open.extend([b, a]),
                    (true, true) => open.extend([a, b]),
                    (true, false) => open.push(a),
                    (false, true) => open.push(b),
                    (false, false) => {}
                }
                continue;
            }
            for at in (node.first..node.first + node.count).map(|at| at as usize) {
                if patches.faces[at].is_beyond(ball.single) || normals[at].dot(normal) >= facing {
                    continue;
                }
                for _ in 0..PATIENCE {
                    let closest = patches.closest(at, ball.centre.to_array());
                    if closest.square >= ball.within * ball.within {
                        break;
                    }
                    let way = p - (ball.centre - DVec3::from_array(closest.from));
                    let next = way.length_squared() / (2.0 * way.dot(normal));
                    if next.is_nan() || next >= radius {
                        break;
                    }
                    radius = next.max(0.0);
                    ball = Ball::new(p, normal, radius, slack);
                }
            }
        }
        (radius < start).then_some(radius * patches.frame.unit)
    }
}

impl Patches {
    /// How flat patches look, given the sum of their normals.
    fn look(&self, sum: DVec3, own: std::ops::Range<usize>, normals: &[DVec3]) -> Look {
        let Some(axis) = sum.try_normalize() else { return Look::UNKNOWN };
        let axis = axis.as_vec3();
        let wide = axis.as_dvec3();
        let (mut least, mut low) = (1.0_f64, f64::INFINITY);
        for at in own {
            least = least.min(wide.dot(normals[at]));
            let (a, [e, f]) = (double(self.faces[at].a), [self.sides[at].e, self.sides[at].f].map(double));
            low = low.min(wide.dot(a) + wide.dot(e).min(wide.dot(f)).min(0.0));
        }
        let least = (least as f32 - ROUNDING).max(-1.0);
        Look { axis, least, sine: (1.0 - least * least).sqrt(), low: low as f32 - ROUNDING }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::sphere;
    use super::*;

    /// A ball of facets with the normals of the ball.
    fn ball(n: usize) -> Walls {
        let facets = sphere(n, false);
        let all: Vec<_> = facets.iter().map(|facet| (*facet, facet.point([1.0 / 3.0; 3]).normalize())).collect();
        Walls::new(&all, &Run::default()).unwrap()
    }

    #[test]
    fn what_a_box_tells_of_its_patches_holds() {
        let walls = ball(9);
        let patches = &walls.patches;
        for (node, look) in patches.nodes.iter().zip(&walls.looks).filter(|(node, _)| node.count < PARENT) {
            for at in (node.first..node.first + node.count).map(|at| at as usize) {
                assert!(look.axis.as_dvec3().dot(walls.normals[at]) >= f64::from(look.least));
                for [s, t] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.3, 0.3]] {
                    let local = patches.frame.into_local(patches.point(at, [s, t]));
                    assert!(look.axis.as_dvec3().dot(local) >= f64::from(look.low));
                }
                // All of the cone's normals but those beyond it face what they face.
                let n = walls.normals[at];
                assert!(look.may_face(-n.as_vec3(), -0.5) && !look.is_beyond(Vec3::ZERO, 0.999));
            }
        }
        assert!(Look::UNKNOWN.may_face(Vec3::X, -0.5) && !Look::UNKNOWN.is_beyond(Vec3::ZERO, 1.0));
    }

    #[test]
    fn the_largest_ball_of_a_ball_is_itself() {
        let walls = ball(24);
        for k in 0..40 {
            let (sin, cos) = (0.7 * f64::from(k)).sin_cos();
            let normal = DVec3::new(cos, sin, 0.1 * f64::from(k) - 2.0).normalize();
            let radius = walls.ball(normal, normal, 5.0, 2e-3, -0.5).expect("the other side faces it");
            assert!((radius - 1.0).abs() < 5e-3, "{radius}");
        }
        // Nothing faces what is beyond.
        assert_eq!(walls.ball(DVec3::Z, DVec3::NEG_Z, 5.0, 2e-3, -0.5), None);
    }
}
