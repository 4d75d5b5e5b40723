//! A lattice, and what is meshed on it: what is in the inset of the one before, but not in its own.

use glam::{DVec3, Vec3A};

use super::Job;
use super::inset::Inset;
use super::piece::{Piece, Rim};
use super::seam::Seam;
use super::side::Side;
use crate::Bounds;
use crate::Run;
use crate::eval::Program;
use crate::mesh::blocks::Blocks;
use crate::mesh::extract::{ExtractError, Root, Sampler, extract};
use crate::mesh::feature::{Crease, Slope};
use crate::mesh::lattice::Lattice;
use crate::mesh::sampler::{BESIDE, Scratch, SolidSampler};
use crate::mesh::settings::Features;
use crate::mesh::signs::{BLOCK, EdgeRef, NODES, SIDE};

pub(super) struct Level {
    pub(super) lattice: Lattice,
    /// Those that the surface may cross.
    pub(super) blocks: Blocks,
    /// Those that the next level meshes.
    pub(super) inset: Inset,
}

impl Level {
    pub(super) fn new(lattice: Lattice, blocks: Blocks) -> Level {
        let inset = Inset::none(&lattice);
        Level { lattice, blocks, inset }
    }

    /// Leaves nothing to the next level.
    pub(super) fn forget(&mut self) {
        self.inset = Inset::none(&self.lattice);
    }

    /// The same in halved cells everywhere, if more than a part of it is left to the next level.
    pub(super) fn halved_throughout(&self, part: f64) -> Option<Level> {
        let side = BLOCK as u32;
        let left = self.blocks.cells.iter().filter(|block| self.inset.has(block.map(|at| at / side))).count();
        let is_more = left as f64 > part * self.blocks.cells.len() as f64;
        let lattice = self.lattice.halved().filter(|_| is_more)?;
        Some(Level::new(lattice, self.blocks.halves(&lattice, |_| true)))
    }

    /// How many blocks are left to the next level.
    pub(super) fn inset_len(&self) -> usize {
        self.inset.len()
    }

    /// The inset in halved cells; `None` if there can be none so small.
    pub(super) fn halved(&self) -> Option<Level> {
        let lattice = self.lattice.halved()?;
        let blocks = self.blocks.halves(&lattice, |block| self.inset.has(block));
        Some(Level::new(lattice, blocks))
    }

    /// Whose a block is, by its number along each axis.
    fn side(&self, outer: Option<&Seam>, block: [u32; 3]) -> Side {
        match outer {
            Some(seam) if !seam.inset.has_half(block) => Side::Around,
            _ if self.inset.has(block) => Side::Within,
            _ => Side::Own,
        }
    }

    /// The mesh in the blocks of this level; `outer` is the seam around them.
    pub(super) fn extract(
        &mut self,
        job: Job<'_>,
        outer: Option<&Seam>,
        run: &Run,
    ) -> Result<(Piece, Vec<Rim>), ExtractError> {
        if let Some(seam) = outer {
            self.blocks.add(seam.blocks.iter().map(|block| block.map(|at| at * BLOCK as u32)), job.program);
        }
        let has = |block| outer.is_none_or(|seam| seam.inset.has_half(numbered(block)));
        let mesh = loop {
            let mut inner = SolidSampler::new(&self.lattice, &self.blocks, job.limits, BESIDE);
            if job.features == Features::Sharp {
                inner.look_for(job.crease(&self.lattice));
            }
            let sampler = LevelSampler { inner, level: self, outer, program: job.program };
            match extract(&sampler, &self.lattice, &self.blocks.cells, job.features, run) {
                Err(ExtractError::Mismatches(mismatches))
                    if self.blocks.repair(&mismatches, job.program, (&self.lattice, &job.limits), has, run)? => {}
                result => break result?,
            }
        };
        Ok(Piece::cut(&mesh, |p| self.side(outer, self.block_at(p)), run)?)
    }

    /// Adds to the inset the block that a point is in, and those that its cell is close to.
    pub(super) fn add(&mut self, p: DVec3) {
        let block = self.block_at(p);
        let first = block.map(|at| at * BLOCK as u32);
        let within = (p - self.lattice.node(first[0], first[1], first[2])) / self.lattice.step();
        let cell = within.to_array().map(|at| (at.max(0.0) as usize).min(BLOCK - 1));
        self.inset.add_near(block, cell);
    }

    /// Whether the next level meshes where a point is.
    pub(super) fn has(&self, p: DVec3) -> bool {
        self.inset.has(self.block_at(p))
    }

    /// The block that a point is in, by its number along each axis. What is rounded to f32 is
    /// between planes that are, too.
    fn block_at(&self, p: DVec3) -> [u32; 3] {
        let place = (p - self.lattice.origin()) / (self.lattice.step() * BLOCK as f64);
        let plane = |block: u32| {
            let at = block * BLOCK as u32;
            self.lattice.node(at, at, at).as_vec3().as_dvec3()
        };
        std::array::from_fn(|axis| {
            let block = place[axis].max(0.0) as u32;
            if p[axis] < plane(block)[axis] {
                block.saturating_sub(1)
            } else {
                block + u32::from(p[axis] >= plane(block + 1)[axis])
            }
        })
    }
}

/// The surface program, but at the seam around a level and beyond.
struct LevelSampler<'a> {
    inner: SolidSampler<'a>,
    level: &'a Level,
    outer: Option<&'a Seam>,
    program: &'a Program,
}

/// A block by its number along each axis.
fn numbered(block: [u32; 3]) -> [u32; 3] {
    block.map(|cell| cell / BLOCK as u32)
}

impl LevelSampler<'_> {
    fn is_around(&self, block: [u32; 3]) -> bool {
        self.level.side(self.outer, numbered(block)) == Side::Around
    }

    /// Where the surface crosses an edge that starts or ends in the seam, if the program does not
    /// tell.
    fn root_at_seam(&self, seam: &Seam, edge: &EdgeRef) -> Option<Root> {
        let axis = usize::from(edge.axis);
        let mut ends = [edge.node; 2];
        ends[1][axis] += 1;
        let in_seam = ends.map(|node| seam.inset.is_seam(node));
        if in_seam == [false; 2] {
            return None;
        }
        let place = |t: f64| {
            let [i, j, k] = edge.node;
            let mut p = self.level.lattice.node(i, j, k);
            p[axis] += t * self.level.lattice.step();
            p
        };
        let root = |t: f64| {
            let slope = self.program.gradient(place(t)).1;
            Root { t, normal: (-slope.normalize_or_zero()).as_vec3().to_array(), is_off: false }
        };
        if in_seam == [true; 2] {
            // Within a face of a larger cell it is on that one's segment.
            let is_off = (0..3).any(|n| n != axis && edge.node[n] % 2 == 1);
            return Some(Root { is_off, ..root(seam.crossing(edge.node, edge.axis)?) });
        }
        let beyond = ends[usize::from(in_seam[0])];
        if !seam.inset.blocks_at(beyond, BLOCK as u32).any(|block| seam.inset.has_half(block)) {
            return Some(Root { t: 0.5, ..Root::default() });
        }
        // The sign in the seam is that of the larger cells. Where the program's is the other the
        // surface is beyond.
        let is_crossed = (self.program.value(place(0.0)) > 0.0) != (self.program.value(place(1.0)) > 0.0);
        (!is_crossed).then(|| root(if in_seam[0] { 0.0 } else { 1.0 }))
    }
}

impl Sampler for LevelSampler<'_> {
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        self.inner.scratch()
    }

    fn limits(&self) -> Bounds {
        self.inner.limits()
    }

    fn crease(&self) -> Crease {
        self.inner.crease()
    }

    fn nodes(&self, scratch: &mut Scratch, number: usize, block: [u32; 3], out: &mut [f32; NODES]) {
        let is_around = self.is_around(block);
        if is_around {
            out.fill(-1.0);
        } else {
            self.inner.nodes(scratch, number, block, out);
        }
        let Some(seam) = self.outer.filter(|seam| is_around || seam.is_near(numbered(block))) else { return };
        for (n, value) in out.iter_mut().enumerate() {
            let node = [1, SIDE, SIDE * SIDE].map(|stride| (n / stride % SIDE) as u32);
            let node = std::array::from_fn(|axis| block[axis] + node[axis]);
            if seam.inset.is_seam(node) {
                let size = value.abs().max(f32::MIN_POSITIVE);
                *value = if seam.is_inside(node) { size } else { -size };
            }
        }
    }

    fn roots(&self, scratch: &mut Scratch, edges: &[EdgeRef], out: &mut [Root]) {
        let Some(seam) = self.outer else { return self.inner.roots(scratch, edges, out) };
        // Where the larger cells tell, there may be no root of the program's, and looking for it
        // takes all the steps there are.
        let told: Vec<Option<Root>> = edges.iter().map(|edge| self.root_at_seam(seam, edge)).collect();
        let open: Vec<EdgeRef> =
            edges.iter().zip(&told).filter(|(_, told)| told.is_none()).map(|(own, _)| *own).collect();
        if open.len() == edges.len() {
            return self.inner.roots(scratch, edges, out);
        }
        let mut found = vec![Root::default(); open.len()];
        self.inner.roots(scratch, &open, &mut found);
        let mut found = found.into_iter();
        for (root, told) in out.iter_mut().zip(told) {
            *root = told.or_else(|| found.next()).unwrap_or_default();
        }
    }

    fn insides(
        &self,
        scratch: &mut Scratch,
        number: usize,
        block: [u32; 3],
        points: &[DVec3],
        out: &mut Vec<bool>,
    ) -> bool {
        !self.is_around(block) && self.inner.insides(scratch, number, block, points, out)
    }

    fn is_plain(&self, block: [u32; 3]) -> bool {
        self.level.side(self.outer, numbered(block)) != Side::Own
    }

    fn slopes(
        &self,
        scratch: &mut Scratch,
        number: usize,
        block: [u32; 3],
        points: &[Vec3A],
        out: &mut Vec<Slope>,
    ) -> bool {
        self.inner.slopes(scratch, number, block, points, out)
    }
}
