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
//!    numbers, and find the roots on them: these are the block's vertices. Keep the signs.
//! 2. With the number of vertices before each block known: list the triangles of each cell by
//!    the case table. A corner on an edge of a neighbour is found in the neighbour's list.
//!
//! In between, [`sharp`] finds the cells that hold creases and corners, if it is asked to; they
//! have fans of triangles in the second pass, whose centres follow the vertices on edges.
//!
//! Between the two, the signs in the faces of the blocks are compared, which makes the mesh
//! closed: wherever a sign changes in a face, the block on the other side must be there and
//! have the same signs.
//!
//! Limits: there are at most 2³² − 1 vertices. A surface that leaves the given blocks is an
//! error, not an open mesh.
//!
//! Source: W. E. Lorensen and H. E. Cline, Marching cubes (1987).

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Features;
use super::feature::Slope;
use super::lattice::Lattice;
use super::signs::{BLOCK, EdgeRef, NODES, OWNED, Signs, edge_number, for_each_cell, is_mixed, list_edges};
use super::table::{CaseTable, EDGE_CORNERS, edge_axis};
use crate::geom::{Mesh, MeshError};
use crate::run::{Cancelled, Run};

mod joined;
mod region;
mod sharp;

use sharp::{Corner, Fans};

/// Blocks that share scratch memory. Small enough for threads to share work evenly.
const BATCH: usize = 32;

/// What the extractor asks of a surface.
pub(crate) trait Sampler: Sync {
    /// Memory that is used from block to block by one thread at a time.
    type Scratch: Send;

    /// New scratch memory.
    fn scratch(&self) -> Self::Scratch;

    /// The values at the nodes of a block that starts at cell `block`, x fastest, then y, then
    /// z. A value above 0 is inside, any other outside. Blocks that share a node must give it
    /// the same sign.
    fn nodes(&self, scratch: &mut Self::Scratch, block: [u32; 3], out: &mut [f32; NODES]);

    /// Where the surface crosses edges of the block that [`Sampler::nodes`] was called for
    /// last, with the same scratch. `out` is as long as `edges`.
    fn roots(&self, scratch: &mut Self::Scratch, block: [u32; 3], edges: &[EdgeRef], out: &mut [Root]);

    /// Adds values and gradients of the field at points in a block, in the order of the points,
    /// to `out`. The default knows of none: features are placed by the normals of the roots.
    fn slopes(&self, _scratch: &mut Self::Scratch, _block: [u32; 3], _points: &[DVec3], _out: &mut Vec<Slope>) -> bool {
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
    /// The list of blocks is at odds with the samples: a defect of the caller.
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

/// Extracts the surface from the given blocks, each named by its first cell, whose coordinates
/// are multiples of [`BLOCK`]. Vertices and triangles are in the order of the blocks, the same
/// for any number of threads.
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
        let sampled = sample_all(sampler, lattice, blocks, &run.stage(0.0, 0.8))?;
        let mut parts = Parts { blocks, neighbours, sampled, lattice, fans: Fans::default() };
        parts.check_faces()?;
        if features == Features::Sharp {
            parts.fans = sharp::find(&parts, sampler, lattice, &run.stage(0.8, 0.9))?;
        }
        let mesh = parts.join(&run.stage(0.9, 1.0))?;
        run.report(1.0);
        Ok(mesh)
    })
}

/// What the first pass leaves of a block.
struct Sampled {
    signs: Signs,
    /// The owned edges that are crossed, by number, ascending.
    edges: Vec<u16>,
    /// Position and normal on each of them.
    vertices: Vec<(Vec3, Vec3)>,
    triangles: usize,
    /// The smallest and the largest component of the normals along each axis.
    normals: [Vec3; 2],
}

/// The first pass.
fn sample_all<S: Sampler>(
    sampler: &S,
    lattice: &Lattice,
    blocks: &[[u32; 3]],
    run: &Run,
) -> Result<Vec<Sampled>, Cancelled> {
    let meter = Meter::new(run, blocks.len());
    let batches: Result<Vec<Vec<Sampled>>, Cancelled> = blocks
        .par_chunks(BATCH)
        .map(|batch| {
            let mut worker = Worker::new(sampler, lattice);
            let sample = |&block: &[u32; 3]| {
                meter.step()?;
                Ok(worker.sample(block))
            };
            batch.iter().map(sample).collect()
        })
        .collect();
    Ok(batches?.into_iter().flatten().collect())
}

/// One thread's means to sample blocks.
struct Worker<'a, S: Sampler> {
    sampler: &'a S,
    lattice: &'a Lattice,
    scratch: S::Scratch,
    values: Box<[f32; NODES]>,
    edges: Vec<EdgeRef>,
    numbers: Vec<u16>,
    roots: Vec<Root>,
}

impl<'a, S: Sampler> Worker<'a, S> {
    fn new(sampler: &'a S, lattice: &'a Lattice) -> Self {
        Worker {
            sampler,
            lattice,
            scratch: sampler.scratch(),
            values: Box::new([0.0; NODES]),
            edges: Vec::new(),
            numbers: Vec::new(),
            roots: Vec::new(),
        }
    }

    fn sample(&mut self, block: [u32; 3]) -> Sampled {
        self.sampler.nodes(&mut self.scratch, block, &mut self.values);
        let signs = Signs::new(&self.values);
        list_edges(&signs, &mut self.edges, &mut self.numbers);
        self.roots.clear();
        self.roots.resize(self.edges.len(), Root::default());
        if !self.edges.is_empty() {
            self.sampler.roots(&mut self.scratch, block, &self.edges, &mut self.roots);
        }
        let vertex = |(edge, root): (&EdgeRef, &Root)| {
            let node = std::array::from_fn(|axis| block[axis] + u32::from(edge.node[axis]));
            let position = self.lattice.vertex(node, usize::from(edge.axis), root.t);
            let normal = Vec3::from_array(root.normal);
            let normal = if normal.is_finite() { normal } else { Vec3::ZERO };
            (position, normal)
        };
        let vertices: Vec<(Vec3, Vec3)> = self.edges.iter().zip(&self.roots).map(vertex).collect();
        let hull = |[low, high]: [Vec3; 2], (_, normal): &(Vec3, Vec3)| [low.min(*normal), high.max(*normal)];
        let normals = vertices.iter().fold([Vec3::INFINITY, Vec3::NEG_INFINITY], hull);
        let table = CaseTable::get();
        let mut triangles = 0;
        for_each_cell(&signs, |_, case| triangles += table.triangles(case).len());
        Sampled { signs, edges: self.numbers.clone(), vertices, triangles, normals }
    }
}

/// Counts blocks that are done, and stops when the run is cancelled.
struct Meter<'a> {
    run: &'a Run,
    done: AtomicUsize,
    total: usize,
}

impl<'a> Meter<'a> {
    fn new(run: &'a Run, total: usize) -> Meter<'a> {
        Meter { run, done: AtomicUsize::new(0), total }
    }

    /// Called before each block.
    fn step(&self) -> Result<(), Cancelled> {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        self.run.report(done as f64 / self.total as f64);
        self.run.check()
    }
}

/// Finds blocks by their coordinates.
struct Neighbours(HashMap<[u32; 3], u32>);

impl Neighbours {
    fn new(blocks: &[[u32; 3]]) -> Result<Neighbours, ExtractError> {
        let mut map = HashMap::with_capacity(blocks.len());
        for (index, &block) in blocks.iter().enumerate() {
            let error = |what| Err(ExtractError::Blocks { block, what });
            if block.iter().any(|&n| n % BLOCK as u32 != 0) {
                return error("its cell is not a multiple of the block size");
            }
            let Ok(index) = u32::try_from(index) else {
                return error("there are more blocks than 32 bits can number");
            };
            if map.insert(block, index).is_some() {
                return error("it is listed twice");
            }
        }
        Ok(Neighbours(map))
    }

    /// The block that is `by` blocks further along each axis, if it is in the list.
    fn find(&self, block: [u32; 3], by: [i32; 3]) -> Option<usize> {
        let mut at = block;
        for axis in 0..3 {
            at[axis] = at[axis].checked_add_signed(by[axis] * BLOCK as i32)?;
        }
        self.0.get(&at).map(|&index| index as usize)
    }
}

/// All blocks after the first pass.
struct Parts<'a> {
    blocks: &'a [[u32; 3]],
    neighbours: Neighbours,
    sampled: Vec<Sampled>,
    lattice: &'a Lattice,
    fans: Fans,
}

impl Parts<'_> {
    /// Checks that wherever a face has both signs there is a block on its other side, and
    /// that the two agree. It follows that every cell around a crossed edge is in a block,
    /// and every vertex in the list of its owner.
    fn check_faces(&self) -> Result<(), ExtractError> {
        (0..self.blocks.len()).into_par_iter().try_for_each(|n| {
            let block = self.blocks[n];
            let error = |what| Err(ExtractError::Blocks { block, what });
            for axis in 0..3 {
                let mut by = [0; 3];
                by[axis] = 1;
                let ours = self.sampled[n].signs.face(axis, true);
                match self.neighbours.find(block, by) {
                    Some(other) if self.sampled[other].signs.face(axis, false) != ours => {
                        return error("an upper neighbour has other signs on their common face");
                    }
                    None if is_mixed(&ours) => {
                        return error("the surface goes on in an upper neighbour not listed");
                    }
                    _ => {}
                }
                by[axis] = -1;
                if is_mixed(&self.sampled[n].signs.face(axis, false)) && self.neighbours.find(block, by).is_none() {
                    return error("the surface goes on in a lower neighbour not listed");
                }
            }
            Ok(())
        })
    }

    /// The second pass.
    fn join(mut self, run: &Run) -> Result<Mesh, ExtractError> {
        let meter = Meter::new(run, self.blocks.len());
        // The number of the first vertex of each block; feature points follow.
        let mut starts = Vec::with_capacity(self.sampled.len());
        let mut vertices = 0u64;
        for part in &self.sampled {
            starts.push(vertices as u32);
            vertices += part.vertices.len() as u64;
        }
        let on_edges = vertices as usize;
        vertices += self.fans.fans.len() as u64;
        if vertices > u64::from(u32::MAX) {
            return Err(ExtractError::TooLarge { count: vertices });
        }

        let counts: Vec<usize> =
            self.sampled.iter().enumerate().map(|(n, part)| self.fans.count(n, part.triangles)).collect();
        let mut indices = vec![[0; 3]; counts.iter().sum()];
        let pieces = split(&mut indices, counts.into_iter());
        pieces.into_par_iter().enumerate().try_for_each(|(n, piece)| {
            meter.step()?;
            self.list_triangles(n, &starts, on_edges, piece)
        })?;

        let mut positions = vec![Vec3::ZERO; vertices as usize];
        let mut normals = vec![Vec3::ZERO; vertices as usize];
        let centres = positions[on_edges..].iter_mut().zip(&mut normals[on_edges..]);
        for ((position, normal), fan) in centres.zip(&self.fans.fans) {
            *position = fan.at;
            *normal = fan.normal();
        }
        let sizes = || self.sampled.iter().map(|part| part.vertices.len());
        let places = split(&mut positions[..on_edges], sizes());
        let directions = split(&mut normals[..on_edges], sizes());
        self.sampled.par_iter_mut().zip(places.into_par_iter().zip(directions)).for_each(
            |(part, (places, directions))| {
                // Taken, so that the memory is given back on the way.
                let vertices = std::mem::take(&mut part.vertices);
                let slots = places.iter_mut().zip(directions);
                for ((place, direction), vertex) in slots.zip(vertices) {
                    (*place, *direction) = vertex;
                }
            },
        );
        Ok(Mesh::new(positions, indices)?.with_normals(normals)?)
    }

    /// The triangles of block `n`: those of the table, in the order of its cells, and then those of its fans.
    /// Feature points are numbered from `centres`.
    fn list_triangles(
        &self,
        n: usize,
        starts: &[u32],
        centres: usize,
        out: &mut [[u32; 3]],
    ) -> Result<(), ExtractError> {
        let lookup = Lookup::new(self, n);
        let number = |found: Found| starts[found.part] + found.nth as u32;
        let table = CaseTable::get();
        let mut slots = out.iter_mut();
        let mut complete = true;
        let mut with_fan = self.fans.cells(n).iter().peekable();
        let mut opposite = self.fans.opposite(n).iter().peekable();
        for_each_cell(&self.sampled[n].signs, |cell, case| {
            let cell_number = sharp::cell_number(cell);
            while with_fan.next_if(|(other, _)| *other < cell_number).is_some() {}
            if with_fan.peek().is_some_and(|(other, _)| *other == cell_number) {
                return;
            }
            let is_opposite = opposite.next_if(|(other, _)| *other == cell_number).is_some();
            for triangle in table.triangles(if is_opposite { !case } else { case }) {
                match (triangle.map(|edge| lookup.vertex(cell, edge)), slots.next()) {
                    ([Some(a), Some(b), Some(c)], Some(slot)) => {
                        let [a, b, c] = [a, b, c].map(number);
                        *slot = if is_opposite { [a, c, b] } else { [a, b, c] };
                    }
                    _ => complete = false,
                }
            }
        });
        self.fans.triangles(self, n, |corners| match slots.next() {
            Some(slot) => {
                *slot = corners.map(|corner| match corner {
                    Corner::Centre(fan) => (centres + fan) as u32,
                    Corner::Edge(found) => number(found),
                });
            }
            None => complete = false,
        });
        if complete && slots.next().is_none() {
            Ok(())
        } else {
            let what = "a vertex is missing in the neighbour that owns it";
            Err(ExtractError::Blocks { block: self.blocks[n], what })
        }
    }

    /// The case of a cell of the lattice; 0 where no block is.
    fn case(&self, cell: [u32; 3]) -> u8 {
        let (block, within) = sharp::split_cell(cell);
        self.neighbours.find(block, [0; 3]).map_or(0, |block| self.sampled[block].signs.case(within))
    }

    /// The vertex on an edge of a cell of the lattice.
    fn vertex(&self, cell: [u32; 3], edge: u8) -> Option<Found> {
        let corner = EDGE_CORNERS[usize::from(edge)][0];
        let node = std::array::from_fn(|axis| cell[axis] + u32::from(corner >> axis & 1));
        let (block, within) = sharp::split_cell(node);
        let part = self.neighbours.find(block, [0; 3])?;
        let number = edge_number(within, usize::from(edge_axis(edge)));
        let nth = self.sampled[part].edges.binary_search(&number).ok()?;
        Some(Found { part, nth })
    }

    /// Position and normal of a vertex.
    fn get(&self, vertex: Found) -> (Vec3, Vec3) {
        self.sampled[vertex.part].vertices[vertex.nth]
    }
}

/// Finds the vertices of a block's cells, its own and those of its upper neighbours.
struct Lookup<'a> {
    parts: &'a Parts<'a>,
    block: usize,
    /// By the number of the edge, which of the block's vertices is on it.
    own: [u16; OWNED],
    /// The upper neighbours, by the axes along which they are further: bits 0 to 2.
    upper: [Option<usize>; 8],
}

/// A vertex: the block, and which of its vertices.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Found {
    part: usize,
    nth: usize,
}

impl<'a> Lookup<'a> {
    fn new(parts: &'a Parts<'a>, block: usize) -> Lookup<'a> {
        let mut own = [0; OWNED];
        for (nth, &edge) in parts.sampled[block].edges.iter().enumerate() {
            own[usize::from(edge)] = nth as u16;
        }
        let upper = std::array::from_fn(|bits| {
            let by = [0, 1, 2].map(|axis| (bits >> axis & 1) as i32);
            if bits == 0 { Some(block) } else { parts.neighbours.find(parts.blocks[block], by) }
        });
        Lookup { parts, block, own, upper }
    }

    /// The vertex on an edge of a cell that crosses the surface.
    fn vertex(&self, cell: [usize; 3], edge: u8) -> Option<Found> {
        let corner = usize::from(EDGE_CORNERS[usize::from(edge)][0]);
        let node: [usize; 3] = std::array::from_fn(|axis| cell[axis] + (corner >> axis & 1));
        let bits = (0..3).fold(0, |bits, axis| bits | (node[axis] / BLOCK) << axis);
        let number = edge_number(node.map(|x| x % BLOCK), usize::from(edge_axis(edge)));
        if bits == 0 {
            return Some(Found { part: self.block, nth: usize::from(self.own[usize::from(number)]) });
        }
        let part = self.upper[bits]?;
        let nth = self.parts.sampled[part].edges.binary_search(&number).ok()?;
        Some(Found { part, nth })
    }

    /// The smallest box that holds the normals of all vertices that the block's cells have, as
    /// its diagonal.
    fn normal_spread(&self) -> Vec3 {
        let parts = self.upper.iter().flatten().map(|&part| self.parts.sampled[part].normals);
        let hull = |[a, b]: [Vec3; 2], [c, d]: [Vec3; 2]| [a.min(c), b.max(d)];
        let [low, high] = parts.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], hull);
        high - low
    }
}

/// Cuts a slice into consecutive pieces of the given lengths, whose sum is its length.
fn split<T>(mut slice: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let cut = |length| {
        let (piece, rest) = std::mem::take(&mut slice).split_at_mut(length);
        slice = rest;
        piece
    };
    lengths.map(cut).collect()
}

#[cfg(test)]
mod tests;
