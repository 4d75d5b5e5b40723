//! Blocks whose normals change evenly from place to place, and little from cell to cell.
//!
//! ```text
//!      n ^   _.-'|'-._   ^        The normals of a smooth surface are nearly an affine map of the place, the trend
//!         \.'    |    './         of a block: a + Kp. What they have beside it is in a small box. For two blocks
//!        .'  A   |  B   '.        the maps are not the same; how far they are apart where the surface leaves A
//!       /        |        \       for B is found from the maps.
//! ```
//!
//! Two normals of a cell differ at most by |Kd|, with d a diagonal of the cell, and by the size of
//! the box: so a look at each vertex, with no look at any cell, tells that no cell of a block has a
//! crease, and how far they may be off their triangles.
//!
//! A block's cells have vertices of upper neighbours as well, in the common faces. Those are beside
//! the block's trend by what they are beside that of the neighbour, and by what the two trends
//! differ by. That is an affine map again: in the face, and no farther from a plane along the
//! surface than vertices of the neighbour are, its values are in a box that a few products tell.
//!
//! Vertices tell nothing of K across the surface. There it is taken to be the mean of what it is
//! along it, as it is with a sphere: whose normals have nothing beside their trend then, and that
//! is the same in all blocks.

use glam::{Mat3A, Vec3, Vec3A, Vec4, Vec4Swizzles};

use super::samples::Samples;
use crate::mesh::signs::BLOCK;
use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// How much the trend may change the normal within a cell, and how large the box may be of what a
/// block's own normals have beside it; with those of neighbours it may be twice that. Two normals
/// of a cell differ by less than those of a [crease](crate::mesh::feature::Crease) do then. The
/// middles of triangles are off by a fiftieth of a cell at most by the trend (see
/// [`curvature`](super::curvature)), and by as much again where a blunt ridge of 6° makes all of
/// the box.
const EVEN: f32 = 0.1;

/// The same where blunter creases count.
fn even(samples: &Samples<'_>) -> f32 {
    EVEN * samples.crease.part
}

/// So many vertices tell a trend.
const ENOUGH: usize = 24;

/// What is added to how much places spread along an axis, as a part of how much they do along all:
/// flat surfaces have no spread across.
const LEAST: f32 = 1e-3;

/// The size of a block, in cells.
const LENGTH: Vec3A = Vec3A::splat(BLOCK as f32);

/// Normals as an affine map of the place, in cells from a block's first node. The fourth coordinate
/// is how high the place is along the mean normal.
#[derive(Clone, Copy)]
struct Trend {
    start: Vec4,
    by: [Vec4; 3],
}

/// The least and the greatest coordinates of what some normals have beside a trend; the fourth is
/// minus the height of their places.
type Rest = [Vec4; 2];

/// What is known of the vertices of a block.
enum Vertices {
    /// They are too few to tell a trend.
    Few,
    Even(Trend, Rest),
    Uneven,
}

impl Trend {
    /// The trend of normals, given with their places: by least squares.
    fn new(vertices: impl Iterator<Item = (Vec3A, Vec3A)>) -> Trend {
        let (mut count, mut place, mut normal) = (0.0, Vec3A::ZERO, Vec3A::ZERO);
        let (mut spread, mut with) = (Mat3A::ZERO, Mat3A::ZERO);
        for (at, there) in vertices {
            count += 1.0;
            place += at;
            normal += there;
            spread += product(at, at);
            with += product(there, at);
        }
        let share = 1.0 / count;
        (place, normal) = (share * place, share * normal);
        let spread = share * spread - product(place, place);
        let with = share * with - product(normal, place);
        let least = LEAST * trace(&spread);
        let mut by = with * (spread + Mat3A::from_diagonal(Vec3::splat(least))).inverse();
        let across = normal.normalize_or_zero();
        let change = by * across;
        let mean = 0.5 * (trace(&by) - across.dot(change));
        by += product(mean * across - change, across);
        let columns = [by.x_axis.extend(across.x), by.y_axis.extend(across.y), by.z_axis.extend(across.z)];
        Trend { start: (normal - by * place).extend(0.0), by: columns }
    }

    #[inline(always)]
    fn at(&self, place: Vec3A) -> Vec4 {
        let ([x, y, z], [i, j, k]) = (self.by, place.to_array());
        self.start + i * x + j * y + k * z
    }

    /// The same for places from another node, which is so far below.
    fn moved(mut self, step: Vec3A) -> Trend {
        self.start = self.at(-step);
        self
    }

    /// Whether it changes normals within a cell by little; one that is no number does not.
    fn is_slow(&self, even: f32) -> bool {
        let [x, y, z] = self.by;
        [x + y + z, x + y - z, x - y + z, x - y - z].iter().all(|change| change.xyz().length_squared() <= even * even)
    }

    /// What normals, given with their places, have beside it.
    fn beside(&self, vertices: impl Iterator<Item = (Vec3A, Vec3A)>) -> Rest {
        vertices.fold([Vec4::INFINITY, Vec4::NEG_INFINITY], |[low, high], (place, normal)| {
            let rest = normal.extend(0.0) - self.at(place);
            [low.min(rest), high.max(rest)]
        })
    }

    /// What normals in a box of places, given by its middle and half its size, have beside it if
    /// they have so much beside another trend.
    fn beside_other(&self, (other, rest): (&Trend, &Rest), [middle, half]: [Vec3A; 2]) -> Rest {
        let (there, across) = (other.at(middle), other.by.map(|column| column.w));
        let by: [Vec4; 3] = std::array::from_fn(|n| other.by[n] - self.by[n]);
        let up = across[0] * by[0] + across[1] * by[1] + across[2] * by[2];
        let along: [Vec4; 3] = std::array::from_fn(|n| (by[n] - across[n] * up).abs());
        // The vertices are between these heights above the middle.
        let [low, high] = [-rest[1].w - there.w, -rest[0].w - there.w];
        let apart = there - self.at(middle) + 0.5 * (low + high) * up;
        let reach = half.x * along[0] + half.y * along[1] + half.z * along[2] + 0.5 * (high - low) * up.abs();
        [apart - reach + rest[0], apart + reach + rest[1]]
    }
}

/// The matrix that takes a vector to its dot product with `b` times `a`.
fn product(a: Vec3A, b: Vec3A) -> Mat3A {
    let [x, y, z] = b.to_array();
    Mat3A::from_cols(x * a, y * a, z * a)
}

fn trace(matrix: &Mat3A) -> f32 {
    matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z
}

impl Vertices {
    /// Those that block `n` owns.
    fn new(samples: &Samples<'_>, n: usize) -> Vertices {
        let own = || samples.vertices_of(n, samples.blocks()[n]);
        let (count, even) = (own().len(), even(samples));
        if count < ENOUGH {
            return Vertices::Few;
        }
        let some = || own().step_by(count / ENOUGH);
        // From end to end of a block, a slow trend and what may be beside it come to no more.
        let (mut low, mut high) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        some().for_each(|(_, normal)| (low, high) = (low.min(normal), high.max(normal)));
        if (high - low).max_element() > (BLOCK + 1) as f32 * even {
            return Vertices::Uneven;
        }
        let trend = Trend::new(some());
        if !trend.is_slow(even) {
            return Vertices::Uneven;
        }
        let rest = trend.beside(own());
        if is_within(&rest, even) { Vertices::Even(trend, rest) } else { Vertices::Uneven }
    }

    /// Their trend.
    fn trend(&self) -> Option<&Trend> {
        match self {
            Vertices::Even(trend, _) => Some(trend),
            _ => None,
        }
    }
}

/// By block, whether normals change so evenly that all its cells are nearly flat.
pub(super) fn even_blocks(samples: &Samples<'_>, run: &Run) -> Result<Vec<bool>, Cancelled> {
    let count = samples.blocks().len();
    let meter = Meter::new(run, 2 * count);
    let goes_on = || meter.step().is_ok();
    let look = |n| if goes_on() { Vertices::new(samples, n) } else { Vertices::Uneven };
    let own: Vec<Vertices> = jobs::in_order(count, look);
    let even = jobs::in_order(count, |n| goes_on() && is_even(samples, &own, n));
    run.check()?;
    Ok(even)
}

fn is_even(samples: &Samples<'_>, own: &[Vertices], n: usize) -> bool {
    if samples.parts.part(n).triangles == 0 || samples.is_plain(samples.blocks()[n]) {
        return true;
    }
    let neighbours = &samples.parts.neighbours;
    match &own[n] {
        Vertices::Even(trend, rest) => holds(samples, own, n, (trend, *rest)),
        Vertices::Uneven => false,
        // That of a neighbour will do.
        Vertices::Few => {
            let upper = (1..7).filter_map(|bits| Some((step(bits), neighbours.upper(n, bits)?)));
            let lower = (0..3).filter_map(|axis| Some((-step(1 << axis), neighbours.lower(n, axis)?)));
            let known = |(step, other): (Vec3A, usize)| Some(own[other].trend()?.moved(step));
            upper.chain(lower).filter_map(known).any(|trend| {
                let rest = trend.beside(samples.vertices_of(n, samples.blocks()[n]));
                holds(samples, own, n, (&trend, rest))
            })
        }
    }
}

/// Whether the normals of a block's cells have little beside a trend, given with what the block's
/// own have.
fn holds(samples: &Samples<'_>, own: &[Vertices], n: usize, (trend, mut rest): (&Trend, Rest)) -> bool {
    for bits in 1..7 {
        let (Some(other), step) = (samples.parts.neighbours.upper(n, bits), step(bits)) else { continue };
        let [low, high] = match &own[other] {
            Vertices::Even(other, rest) => {
                let half = 0.5 * (LENGTH - step);
                trend.beside_other((&other.moved(step), rest), [step + half, half])
            }
            Vertices::Uneven => return false,
            Vertices::Few => {
                // Rounding of coordinates is less than that.
                let in_face = |&(place, _): &(Vec3A, Vec3A)| place.cmplt(LENGTH + 0.25).all();
                trend.beside(samples.vertices_of(other, samples.blocks()[n]).filter(in_face))
            }
        };
        rest = [rest[0].min(low), rest[1].max(high)];
    }
    is_within(&rest, 2.0 * even(samples))
}

/// The way to a neighbour, in cells, by the axes along which it is further, as bits.
fn step(bits: usize) -> Vec3A {
    LENGTH * Vec3A::from_array(std::array::from_fn(|axis| (bits >> axis & 1) as f32))
}

fn is_within([low, high]: &Rest, most: f32) -> bool {
    (high - low).xyz().length_squared() <= most * most
}
