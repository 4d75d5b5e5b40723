//! Marching cubes over blocks of cells, with vertices welded by the edge that they are on.
//!
//! ```text
//!         block A       |   block B
//!     +---+-- ... --+---+---+-- ...    Every lattice edge is owned by one block, that of its
//!     |   |         |   g   |          lower end, by integer coordinates. The edge g in the
//!     +---+-- ... --+-e-+---+-- ...    face between A and B starts at a node that is number 8
//!     0   1         7  8=0  1          of A and 0 of B, so B owns it. A owns e, and looks g
//!                                      up in the list of B.
//! ```
//!
//! Blocks are independent of each other in both passes, so that the result does not depend on
//! the number of threads:
//!
//! 1. Sample the nodes; list the owned edges that cross the surface, in the order of their
//!    numbers, and find the roots on them, a batch of blocks at a time: these are the
//!    blocks' vertices. Keep the signs.
//! 2. With the number of vertices before each block known: list the triangles of each cell by
//!    the case table. The vertex of an edge has the number of its row's first one and the
//!    count of crossed edges between them, in the own block or in a neighbour.
//!
//! If it is asked to, [`sharp`] finds the cells that hold creases and corners in place of that.
//! They have fans of triangles, which follow those of all other cells; the vertices that are added
//! follow those on edges.
//!
//! Between the two, the signs in the faces of the blocks are compared, which makes the mesh
//! closed: wherever a sign changes in a face, the block on the other side must be there and
//! have the same signs.
//!
//! Limits: there are at most 2³² − 1 vertices. A surface that leaves the given blocks is an
//! error, not an open mesh.
//!
//! Source: W. E. Lorensen and H. E. Cline, Marching cubes (1987).

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use glam::{DVec3, Vec3, Vec3A};

use self::joined::{UPPER, proposals};
pub(super) use self::lost::BORE;
use self::lost::{suspected, torn_nodes};
use self::neighbours::Neighbours;
use self::parts::Parts;
use self::skipped::Skips;
pub(crate) use self::suspect::CellBits;
use self::suspect::Suspect;
use super::Features;
use super::feature::{Crease, Slope};
use super::lattice::Lattice;
use super::loops::ambiguous_faces;
use super::signs::{EdgeRef, NODES, Rows, Signs, for_each_cell, list_edges};
use super::table::CaseTable;
use crate::geom::{Mesh, MeshError};
use crate::{Cancelled, Run};
use rvachev_num::Meter;
use rvachev_num::{Bounds, jobs};

mod block_vertices;
mod cells;
mod corners;
mod crease;
mod curvature;
mod halves;
mod join;
mod joined;
mod lists;
mod lost;
mod nearby;
mod neighbours;
mod parts;
mod patches;
mod plain;
mod probe;
mod region;
mod samples;
mod sharp;
mod skipped;
mod span;
mod special;
mod spread;
mod suspect;
mod third;
mod trend;
mod turn;
mod verify;

/// Blocks whose roots are found together. Small enough for threads to share work evenly.
pub(super) const BATCH: usize = 128;

/// What the extractor asks of a surface.
pub(crate) trait Sampler: Sync {
    /// Memory that is used from block to block by one thread at a time.
    type Scratch: Send;

    /// New scratch memory.
    fn scratch(&self) -> Self::Scratch;

    /// The values at the nodes of a block, given by its place in the list of blocks and by
    /// its first cell: x fastest, then y, then z. A value above 0 is inside, any other outside.
    /// Blocks that share a node must give it the same sign.
    fn nodes(&self, scratch: &mut Self::Scratch, number: usize, block: [u32; 3], out: &mut [f32; NODES]);

    /// Where the surface crosses edges, in the order of their blocks. `out` is as long as
    /// `edges`.
    fn roots(&self, scratch: &mut Self::Scratch, edges: &[EdgeRef], out: &mut [Root]);

    /// Whether points of a block are inside, in the order of the points, added to `out`; whether it
    /// did. It is asked right after the [`nodes`](Sampler::nodes) of the block. The default knows
    /// of none.
    fn insides(
        &self,
        _scratch: &mut Self::Scratch,
        _number: usize,
        _block: [u32; 3],
        _points: &[DVec3],
        _out: &mut Vec<bool>,
    ) -> bool {
        false
    }

    /// Whether blocks that may have lost a feature thinner than a cell are to be counted: by what
    /// the next ones tell. By default they are not.
    fn watches(&self) -> bool {
        false
    }

    /// The most that the value changes by per length unit in a block, given by its first cell. The
    /// default knows of no bound.
    fn lipschitz_bound(&self, _number: usize, _block: [u32; 3]) -> f64 {
        f64::INFINITY
    }

    /// Whether a block, given by its first cell, may hold a leaf that passes between nodes. By
    /// default none does.
    fn is_bored(&self, _number: usize, _block: [u32; 3]) -> bool {
        false
    }

    /// Whether the surface may pass between two nodes of a block there and back. By default it does
    /// not.
    fn may_skip(&self, _number: usize, _block: [u32; 3]) -> bool {
        false
    }

    /// Adds values at points of a block, given in cells from its first node, in the order of the
    /// points, to `out`; whether it did. It is asked right after the [`nodes`](Sampler::nodes) of
    /// the block. The default knows of none.
    fn values_at_hand(
        &self,
        _scratch: &mut Self::Scratch,
        _number: usize,
        _points: &[Vec3A],
        _out: &mut Vec<f32>,
    ) -> bool {
        false
    }

    /// The same of values and gradients.
    fn slopes_at_hand(
        &self,
        _scratch: &mut Self::Scratch,
        _number: usize,
        _points: &[Vec3A],
        _out: &mut Vec<Slope>,
    ) -> bool {
        false
    }

    /// Whether a feature may hide in some cells of a block, all of whose nodes have one sign; so
    /// many intervals may be taken to decide that, and it may if they do not suffice. By default it
    /// may.
    fn may_hide(&self, _number: usize, _block: [u32; 3], _cells: &CellBits, _intervals: usize) -> bool {
        true
    }

    /// A box that the surface is in: features are held in it, where it cuts the cell of one. The
    /// default is all space.
    fn limits(&self) -> Bounds {
        Bounds::ALL
    }

    /// Which normals are those of a crease. By default those that are as far apart as usual.
    fn crease(&self) -> Crease {
        Crease::USUAL
    }

    /// Whether a block, given by its first cell, is to have the triangles of the case table: no fan
    /// reaches into it. The default has no such blocks.
    fn is_plain(&self, _block: [u32; 3]) -> bool {
        false
    }

    /// Adds values and gradients of the field at points of a block, given in cells from its first
    /// node, in the order of the points, to `out`; whether it did. The default knows of none:
    /// features are placed by the normals of the roots alone.
    fn slopes(
        &self,
        _scratch: &mut Self::Scratch,
        _number: usize,
        _block: [u32; 3],
        _points: &[Vec3A],
        _out: &mut Vec<Slope>,
    ) -> bool {
        false
    }
}

/// Where the surface crosses an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Root {
    /// 0 at the lower end of the edge, 1 at the upper. Values beyond are moved to the range,
    /// NaN to the middle.
    pub t: f64,
    /// The unit normal there, out of the solid. One that is not finite becomes 0.
    pub normal: [f32; 3],
    /// Whether the value is not near 0 there: it jumps, or the place is told by what is beside the
    /// block.
    pub is_off: bool,
}

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum ExtractError {
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There are more vertices than indices of 32 bits.
    #[error("the mesh has {count} vertices; at most 4294967295 are allowed")]
    TooLarge {
        /// Number of vertices.
        count: u64,
    },
    /// Signs do not go on from block to block: what told the blocks and their samples is at odds.
    /// There is at least one.
    #[error("internal error: block at cell {:?}: {}", .0[0].block, .0[0].what)]
    Mismatches(Vec<Mismatch>),
    /// The list of blocks is no such list: a defect of the caller.
    #[error("internal error: block at cell {block:?}: {what}")]
    Blocks {
        /// The first cell of the block.
        block: [u32; 3],
        /// What is wrong with it.
        what: &'static str,
    },
    /// The result is not a mesh: a defect of this module or of the lattice.
    #[error("internal error: {0}")]
    Mesh(#[from] MeshError),
}

/// A face of a block beyond which signs do not go on as they are in it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mismatch {
    /// The first cell of the block.
    pub block: [u32; 3],
    /// That of the block beyond, unless it is below the lattice.
    pub beyond: Option<[u32; 3]>,
    /// What is wrong.
    pub what: &'static str,
}

/// Extracts the surface from the given blocks, each named by its first cell, whose coordinates are
/// multiples of [`BLOCK`]. Vertices on edges and triangles of the case table are in the order of
/// the blocks; all is the same for any number of threads.
///
/// # Errors
///
/// [`ExtractError`]; cancelling is noticed at the next block.
pub(crate) fn extract<S: Sampler>(
    sampler: &S,
    lattice: &Lattice,
    blocks: &[[u32; 3]],
    features: Features,
    run: &Run,
) -> Result<Mesh, ExtractError> {
    run.install(|| {
        let neighbours = Neighbours::new(blocks)?;
        // How long each stage takes, more or less.
        let times = match features {
            Features::Smooth => [70.0, 2.0, 28.0],
            Features::Sharp => [56.0, 2.0, 42.0],
        };
        let [to_sample, to_check, to_join] = run.stages(times);
        let mut parts = sample_all(sampler, lattice, (blocks, neighbours), features, &to_sample)?;
        parts.check_faces(&to_check.stage(0.0, 0.5))?;
        parts.note_lost(sampler, &to_check.stage(0.5, 1.0))?;
        let mesh = parts.join(sampler, lattice, features, &to_join)?;
        run.report(1.0);
        Ok(mesh)
    })
}

/// What the first pass leaves of a block.
struct Part {
    signs: Signs,
    rows: Rows,
    /// The number of its first vertex: within the batch first, then in the mesh.
    first: u32,
    triangles: u32,
    /// The upper ambiguous faces of its cells that would rather be joined, if that is asked for.
    joins: Vec<(u16, u8)>,
}

impl Part {
    /// The vertex on an owned edge that is crossed, given by its lower node.
    fn vertex(&self, [i, j, k]: [usize; 3], axis: usize) -> u32 {
        let crossed = self.signs.crossed(j, k);
        let before = crossed[..axis].iter().map(|bits| bits.count_ones()).sum::<u32>();
        self.first + self.rows.start(j, k) + before + (crossed[axis] & ((1 << i) - 1)).count_ones()
    }
}

/// What it leaves of consecutive blocks.
struct Batch {
    parts: Vec<Part>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// How many of them are moved to keep clear of nodes, or off the surface.
    clamped: usize,
    /// Blocks that may have lost a feature, in their order.
    suspects: Vec<Suspect>,
}

/// Takes batches as they come, and adds them in their order. No thread waits for another that adds.
struct Queue<'a> {
    /// What is added, and how many.
    all: Mutex<(Parts<'a>, usize)>,
    /// Those that are not, by number.
    waiting: Mutex<BTreeMap<usize, Batch>>,
}

impl<'a> Queue<'a> {
    fn add(&self, number: usize, batch: Batch) -> Result<(), ExtractError> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner).insert(number, batch);
        // Another thread that adds takes this one as well, if it still looks for more; if not, it
        // is taken with the next.
        self.all.try_lock().map_or(Ok(()), |mut all| self.add_waiting(&mut all))
    }

    fn add_waiting(&self, (all, added): &mut (Parts<'a>, usize)) -> Result<(), ExtractError> {
        let next = |number| self.waiting.lock().unwrap_or_else(PoisonError::into_inner).remove(&number);
        while let Some(batch) = next(*added) {
            all.add(batch)?;
            *added += 1;
        }
        Ok(())
    }

    /// All of them, when no more come.
    fn into_parts(self) -> Result<Parts<'a>, ExtractError> {
        self.add_waiting(&mut self.all.lock().unwrap_or_else(PoisonError::into_inner))?;
        Ok(self.all.into_inner().unwrap_or_else(PoisonError::into_inner).0)
    }
}

/// The first pass. Threads take the next batch each; one thread adds while the others sample.
fn sample_all<'a, S: Sampler>(
    sampler: &S,
    lattice: &Lattice,
    (blocks, neighbours): (&'a [[u32; 3]], Neighbours),
    features: Features,
    run: &Run,
) -> Result<Parts<'a>, ExtractError> {
    let meter = Meter::new(run, blocks.len());
    let all = Mutex::new((Parts::new(blocks, neighbours, features), 0));
    let queue = Queue { all, waiting: Mutex::default() };
    let worker = || Worker::new(sampler, lattice, features);
    let sample = |worker: &mut Worker<'_, S>, n: usize, blocks: &[[u32; 3]]| {
        let batch = worker.sample(n * BATCH, blocks, &meter)?;
        queue.add(n, batch)
    };
    jobs::try_chunks_with(blocks, BATCH, worker, sample)?;
    queue.into_parts()
}

/// One thread's means to sample blocks.
struct Worker<'a, S: Sampler> {
    sampler: &'a S,
    lattice: &'a Lattice,
    features: Features,
    scratch: S::Scratch,
    values: Box<[f32; NODES]>,
    edges: Vec<EdgeRef>,
    roots: Vec<Root>,
    skips: Skips,
}

impl<'a, S: Sampler> Worker<'a, S> {
    fn new(sampler: &'a S, lattice: &'a Lattice, features: Features) -> Self {
        let scratch = sampler.scratch();
        let values = Box::new([0.0; NODES]);
        let (edges, roots, skips) = (Vec::new(), Vec::new(), Skips::default());
        Worker { sampler, lattice, features, scratch, values, edges, roots, skips }
    }

    /// Samples the blocks from number `start` on.
    fn sample(&mut self, start: usize, blocks: &[[u32; 3]], meter: &Meter<'_>) -> Result<Batch, Cancelled> {
        let (table, faces) = (CaseTable::get(), ambiguous_faces());
        self.edges.clear();
        let watches = self.sampler.watches();
        let (mut parts, mut suspects) = (Vec::with_capacity(blocks.len()), Vec::new());
        for (number, &block) in (start..).zip(blocks) {
            meter.step()?;
            self.sampler.nodes(&mut self.scratch, number, block, &mut self.values);
            let signs = Signs::new(&self.values);
            let first = self.edges.len() as u32;
            let rows = list_edges(&signs, &self.values, number as u32, block, &mut self.edges);
            let (mut triangles, mut ambiguous) = (0, 0);
            for_each_cell(&signs, |_, case| {
                triangles += table.triangles(case).len() as u32;
                ambiguous |= faces[usize::from(case)];
            });
            let joins = if ambiguous & UPPER != 0 && self.features == Features::Sharp {
                proposals(self.sampler, &mut self.scratch, self.lattice, (number, block), &signs)
            } else {
                Vec::new()
            };
            if watches {
                let means = (&mut self.scratch, &mut self.skips);
                suspects.push(suspected((self.sampler, self.lattice), means, (number, block), (&signs, &self.values)));
            }
            parts.push(Part { signs, rows, first, triangles, joins });
        }
        self.roots.clear();
        self.roots.resize(self.edges.len(), Root::default());
        if !self.edges.is_empty() {
            self.sampler.roots(&mut self.scratch, &self.edges, &mut self.roots);
        }
        let count = self.edges.len();
        let (mut positions, mut normals, mut clamped) = (vec![Vec3::ZERO; count], vec![Vec3::ZERO; count], 0);
        let vertices = positions.iter_mut().zip(&mut normals);
        for ((position, normal), (edge, root)) in vertices.zip(self.edges.iter().zip(&self.roots)) {
            *position = self.lattice.vertex(edge.node, usize::from(edge.axis), root.t);
            clamped += usize::from(root.is_off || self.lattice.is_clamped(root.t));
            let given = Vec3::from_array(root.normal);
            if given.is_finite() {
                *normal = given;
            }
        }
        let step = self.lattice.step();
        for (suspect, part) in suspects.iter_mut().zip(&parts) {
            suspect.torn = torn_nodes(part, [&positions, &normals], step);
        }
        suspects.retain(Suspect::is_one);
        Ok(Batch { parts, positions, normals, clamped, suspects })
    }
}

#[cfg(test)]
mod tests;
