//! Flat cylinders about the patches of boxes.
//!
//! ```text
//!      .------.
//!      |    / |       Of a surface that is oblique to the axes a box is as thick as it is wide,
//!      |  /   |       and seems to be nearer by that. A disc along the surface is thin.
//!      |/     |
//!      '------'
//! ```

use glam::DVec3;
use rvachev_num::{Cancelled, Real, Run};

use super::face::{Face, SLACK, Sides, double, wide};
use super::gathered;
use super::hierarchy::{Node, PARENT};

/// Boxes with more patches have none: few of what they hold is flat.
const MANY: u32 = 256;

/// What is left of a lower bound after rounding. Of a point that is more than twice as far from the
/// middle as the disc is large, some forty units in the last place of the square are lost at most.
const SURE: f64 = 1.0 - 128.0 * f32::EPSILON as f64;

/// How much discs are grown, as a part of their radius, for points that are nearer.
const GROWTH: f64 = 256.0 * f32::EPSILON as f64;

/// The numbers of a flat cylinder.
pub(super) struct Cylinder {
    pub(super) centre: DVec3,
    pub(super) normal: DVec3,
    pub(super) half: f64,
    pub(super) radius: f64,
}

/// A flat cylinder.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Disc {
    centre: [f32; 3],
    /// The square of the radius; below 0 if there is none, as the box is closer to the patches.
    square: f32,
    /// A unit vector along the axis, and half the length along it.
    normal: [f32; 3],
    half: f32,
}

impl Disc {
    const NONE: Disc = Disc { centre: [0.0; 3], square: -1.0, normal: [0.0; 3], half: 0.0 };

    #[inline(always)]
    pub(super) fn is_none(&self) -> bool {
        self.square < 0.0
    }

    /// Its centre, its axis, and half its length along that with its radius; nothing if there is none.
    pub(super) fn cylinder(&self) -> Option<Cylinder> {
        let [half, radius] = [f64::from(self.half), f64::from(self.square.max(0.0)).sqrt()];
        (!self.is_none()).then_some(Cylinder { centre: double(self.centre), normal: double(self.normal), half, radius })
    }

    /// The squares of how far points are from it, at least.
    #[inline(always)]
    pub(super) fn gap<R: Real>(&self, p: [R; 3]) -> R {
        let ([x, y, z], [u, v, w]) = (wide(self.centre), wide(self.normal));
        let [x, y, z] = [p[0] - x, p[1] - y, p[2] - z];
        let height = x.scale_add(u, y.scale_add(v, z * w));
        let square = x.mul_add(x, y.mul_add(y, z * z));
        let zero = square.lift(0.0);
        // (L − ρ)² is at least L²/3 − ρ²/2 and 2 L²/3 − 2 ρ², and hardly more than the larger.
        let own = f64::from(self.square);
        let aside = (square - height * height) * (1.0 / 3.0) - 0.5 * own;
        let aside = aside.max(aside + aside - own).max(zero);
        let above = (height.abs() - f64::from(self.half)).max(zero);
        above.mul_add(above, aside) * SURE
    }

    /// That of the patches of a box, if it is closer to them than the box is.
    fn new(node: &Node, faces: &[Face], sides: &[Sides]) -> Disc {
        let patches = || faces.iter().zip(sides);
        let area: DVec3 = patches().map(|(_, sides)| double(sides.e).cross(double(sides.f))).sum();
        let Some(normal) = area.try_normalize() else { return Disc::NONE };
        let (low, high) = (double(node.low), double(node.high));
        let middle = 0.5 * (low + high);
        let (mut least, mut most, mut reach) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for (face, sides) in patches() {
            let a = double(face.a);
            for corner in [a, a + double(sides.e), a + double(sides.f)] {
                let way = corner - middle;
                let height = way.dot(normal);
                (least, most) = (least.min(height), most.max(height));
                reach = reach.max(way.length_squared() - height * height);
            }
        }
        let sag = faces.iter().fold(0.0, |most: f64, face| most.max(f64::from(face.sag)));
        let half = 0.5 * (most - least) + sag;
        let radius = (reach.max(0.0).sqrt() + sag + SLACK).max(half) * (1.0 + GROWTH);
        // How far from the middle points reach that are no nearer to the box, or to the disc, than
        // to the surface, as high above it as the disc is wide.
        let (size, along) = (high - low, normal.abs());
        let across = along.x * size.y * size.z + along.y * size.z * size.x + along.z * size.x * size.y;
        let of_box = (across / std::f64::consts::PI).sqrt() + (radius * along.dot(size)).sqrt();
        if radius + (2.0 * radius * half).sqrt() >= of_box {
            return Disc::NONE;
        }
        let centre = middle + 0.5 * (most + least) * normal;
        Disc {
            centre: centre.as_vec3().to_array(),
            square: radius.powi(2) as f32,
            normal: normal.as_vec3().to_array(),
            half: (half + GROWTH * radius + SLACK) as f32,
        }
    }
}

/// Those of all boxes.
pub(super) fn discs(nodes: &[Node], faces: &[Face], sides: &[Sides], run: &Run) -> Result<Vec<Disc>, Cancelled> {
    // Children come after their parents.
    let mut ranges = vec![(0, 0); nodes.len()];
    for (at, node) in nodes.iter().enumerate().rev() {
        ranges[at] = if node.count < PARENT {
            (node.first, node.first + node.count)
        } else {
            let first = node.first as usize;
            (ranges[first].0, ranges[first + 1].1)
        };
    }
    let disc = |(node, (from, to)): (&Node, &(u32, u32))| {
        let here = *from as usize..*to as usize;
        if to - from > MANY { Disc::NONE } else { Disc::new(node, &faces[here.clone()], &sides[here]) }
    };
    gathered(nodes.iter().zip(&ranges).map(disc), run)
}
