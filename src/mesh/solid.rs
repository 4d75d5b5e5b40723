//! Meshing a solid: `solid.mesh(..)`.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::{DVec3, Vec3, Vec3A};
use rayon::prelude::*;

use super::deciders::Deciders;
use super::extract::{BATCH, ExtractError, Rift, Root, Sampler, extract};
use super::feature::Slope;
use super::lattice::{CellSize, Lattice, LatticeError};
use super::paint::{corner_colors, each_triangle};
use super::resolve::unresolved_cells;
use super::settings::{AtBounds, Features, MeshSettings, ThinFeatures};
use super::signs::{BLOCK, EdgeRef, NODES, SIDE, Signs, is_mixed};
use crate::eval::{Evaluator, Gradients, Program, Tape, compiled};
use crate::geom::Mesh;
use crate::space::{Grid, surface_blocks};
use crate::{Bounds, Cancelled, Paint, RFunction, Run, Solid, SolidError};

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshingError {
    /// The solid is at fault, or unbounded while no bounds are given.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// The resolution does not suit the bounds.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There are more vertices than 32-bit indices count.
    #[error("{vertices} vertices, allowed: at most {}", u32::MAX)]
    TooLarge {
        /// How many vertices the mesh would have.
        vertices: u64,
    },
    /// The solid leaves the bounds, and the settings do not want it cut.
    #[error("the solid goes on beyond the bounds at {at}; allowed: a solid within them, or `AtBounds::Cap`")]
    LeavesBounds {
        /// A point of the boundary of the bounds that is inside the solid.
        at: DVec3,
    },
    /// The extraction contradicts itself: a defect of this crate.
    #[error("internal error, please report it: {what}")]
    Internal {
        /// What was found.
        what: String,
    },
}

impl From<ExtractError> for MeshingError {
    fn from(error: ExtractError) -> MeshingError {
        match error {
            ExtractError::Cancelled(cancelled) => MeshingError::Cancelled(cancelled),
            ExtractError::TooLarge { count } => MeshingError::TooLarge { vertices: count },
            other => MeshingError::Internal { what: other.to_string() },
        }
    }
}

impl Solid {
    /// The surface as triangles: closed, manifold and oriented outward, with a normal at each
    /// vertex. An empty solid gives an empty mesh.
    ///
    /// # Errors
    /// What is wrong with the solid or the settings: see [`MeshingError`].
    pub fn mesh(&self, settings: &MeshSettings) -> Result<Mesh, MeshingError> {
        self.mesh_with(settings, &Run::default())
    }

    /// [`mesh`](Solid::mesh) with a choice of threads, a cancel token and a progress sink.
    ///
    /// The result is the same to the byte for any number of threads.
    ///
    /// # Errors
    /// What is wrong with the solid or the settings, or that the work was cancelled: see
    /// [`MeshingError`].
    pub fn mesh_with(&self, settings: &MeshSettings, run: &Run) -> Result<Mesh, MeshingError> {
        let (solid, bounds) = self.cut_to(settings.bounds.as_ref())?;
        let run = run.stage(0.0, 1.0);
        if bounds.is_empty() {
            run.report(1.0);
            return Ok(Mesh::default());
        }
        let programs = compiled(&solid)?;
        // A mesh has the paint of its solid, if there is any, by the owners of its triangles.
        let palette = solid.palette()?;
        let painted = palette.is_painted();
        let owned = settings.owners || painted;
        run.install(|| {
            // How long each stage takes, more or less.
            let if_done = |is_done: bool, time: f64| if is_done { time } else { 0.0 };
            let counts = settings.thin != ThinFeatures::Ignore;
            let times = [0.15, if_done(counts, 7.0), 0.85, if_done(owned, 0.8), if_done(painted, 0.2)];
            let [to_find, to_count, to_extract, to_own, to_paint] = run.stages(times);
            let mut lattice = Lattice::new(&bounds, settings.cell)?;
            let mut blocks = Blocks::find(&programs.surface, &lattice, &to_find)?;
            let (mut unresolved, mut halvings) = (None, 0);
            if let Some(most) = settings.thin.halvings() {
                loop {
                    let [done, next] = [halvings, halvings + 1].map(|n| f64::from(n) / (f64::from(most) + 1.0));
                    let run = to_count.stage(done, next);
                    let count = unresolved_cells(&lattice, &blocks.cells, |n| blocks.programs.of(n), &run)?;
                    unresolved = Some(count);
                    if count == 0 || halvings == most {
                        break;
                    }
                    halvings += 1;
                    lattice = Lattice::new(&bounds, CellSize::Length(0.5 * lattice.step()))?;
                    blocks = Blocks::find(&programs.surface, &lattice, &to_find)?;
                }
            }
            let mut mesh = blocks.extract(&programs.surface, (&lattice, bounds), settings.features, &to_extract)?;
            if let (AtBounds::Refuse, Some(given)) = (settings.at_bounds, &settings.bounds) {
                self.refuse_caps(&mesh, given, lattice.step())?;
            }
            if owned {
                let owners = blocks.owners(&lattice, &mesh, &programs.surface, &to_own)?;
                if painted {
                    let colors = corner_colors(&mesh, &palette, &owners, Paint::default(), &to_paint)?;
                    mesh = mesh.with_corner_colors(colors).map_err(ExtractError::from)?;
                }
                mesh = mesh.with_owners(owners).map_err(ExtractError::from)?;
            }
            run.report(1.0);
            Ok(match unresolved {
                Some(count) => mesh.with_unresolved_cells(count),
                None => mesh,
            })
        })
    }

    /// An error if a vertex on a face of the bounds is inside the solid.
    fn refuse_caps(&self, mesh: &Mesh, given: &Bounds, step: f64) -> Result<(), MeshingError> {
        // Vertices may be off by a thousandth of a cell.
        let slack = 0.01 * step;
        let program = &compiled(self)?.surface;
        let inner = given.inflate(-slack);
        // Values are no lengths; by the slope they tell how far it is to the surface.
        let is_inside = |p: DVec3| {
            let (value, slope) = program.gradient(p);
            value > slack * slope.length()
        };
        let beyond = |p: &&Vec3| !inner.contains(p.as_dvec3()) && is_inside(p.as_dvec3());
        match mesh.positions().iter().find(beyond) {
            Some(at) => Err(MeshingError::LeavesBounds { at: at.as_dvec3() }),
            None => Ok(()),
        }
    }

    /// The solid cut to a box, if there is one and the solid leaves it, and the box that
    /// holds what is left.
    fn cut_to(&self, bounds: Option<&Bounds>) -> Result<(Solid, Bounds), SolidError> {
        let Some(given) = bounds else { return Ok((self.clone(), self.finite_bounds()?)) };
        let size = given.size();
        if given.is_empty() || !given.is_finite() || size.min_element() <= 0.0 {
            return Err(SolidError::Bounds { bounds: format!("{} to {}", given.min, given.max) });
        }
        let own = self.bounds()?;
        if own.is_empty() || given.contains_bounds(&own) {
            return Ok((self.clone(), own));
        }
        let cut = self.intersection(Solid::cuboid(size).translate(given.center()), RFunction::MIN_MAX);
        Ok((cut, own.intersection(given)))
    }
}

/// The blocks that the surface may cross.
struct Blocks {
    /// Their first cells.
    cells: Vec<[u32; 3]>,
    programs: Programs,
    /// Those sampled by the whole program in double precision, if there are any.
    exact: Vec<bool>,
}

/// The programs of blocks: of each its number, and all.
struct Programs {
    numbers: Vec<u32>,
    all: Vec<Program>,
}

impl Programs {
    fn of(&self, block: usize) -> &Program {
        &self.all[self.numbers[block] as usize]
    }

    /// Whether two blocks have the same.
    fn is_same(&self, one: usize, other: usize) -> bool {
        self.numbers[one] == self.numbers[other] || self.of(one).is_same(self.of(other))
    }
}

impl Blocks {
    fn find(program: &Program, lattice: &Lattice, run: &Run) -> Result<Blocks, Cancelled> {
        let grid = Grid {
            origin: lattice.origin(),
            side: lattice.step() * BLOCK as f64,
            blocks: lattice.cells().map(|cells| cells.div_ceil(BLOCK as u32)),
        };
        let found = surface_blocks(program, &grid, 0.0, run)?;
        let cells = found.blocks.iter().map(|block| block.index.map(|i| i * BLOCK as u32)).collect();
        let numbers = found.blocks.iter().map(|block| block.program).collect();
        Ok(Blocks { cells, programs: Programs { numbers, all: found.programs }, exact: Vec::new() })
    }

    /// The surface in the blocks, and in others where it goes on.
    fn extract(
        &mut self,
        whole: &Program,
        (lattice, limits): (&Lattice, Bounds),
        features: Features,
        run: &Run,
    ) -> Result<Mesh, ExtractError> {
        loop {
            let mut sampler = SolidSampler::new(lattice, self, limits);
            if features == Features::Sharp {
                sampler.keep_tapes();
            }
            match extract(&sampler, lattice, &self.cells, features, run) {
                Err(ExtractError::Rifts(rifts)) if self.mend(&rifts, whole, (lattice, &limits), run)? => {}
                result => return result,
            }
        }
    }

    /// Makes blocks exact on both sides of rifts; and so, wherever the surface goes on from those in a block that is not
    /// among them, that one. Whether there was anything to be done.
    ///
    /// Samples of a field that jumps depend on rounding, and ranges that are told of it, or that users tell of theirs, may
    /// be wrong. All exact blocks have the same value at a node, so in the end all rifts are mended.
    fn mend(
        &mut self,
        rifts: &[Rift],
        whole: &Program,
        (lattice, limits): (&Lattice, &Bounds),
        run: &Run,
    ) -> Result<bool, Cancelled> {
        self.exact.resize(self.cells.len(), false);
        let number = self.programs.all.len() as u32;
        self.programs.all.push(whole.clone());
        let mut known: HashMap<[u32; 3], usize> = self.cells.iter().copied().zip(0..).collect();
        let is_there = |block: &[u32; 3]| (0..3).all(|axis| block[axis] < lattice.cells()[axis]);
        let mut open: Vec<[u32; 3]> =
            rifts.iter().flat_map(|rift| [Some(rift.block), rift.beyond.filter(is_there)]).flatten().collect();
        let (mut values, mut changed) = ([0.0; NODES], false);
        while let Some(block) = open.pop() {
            run.check()?;
            let n = *known.entry(block).or_insert_with(|| {
                self.cells.push(block);
                self.programs.numbers.push(number);
                self.exact.push(false);
                self.cells.len() - 1
            });
            if self.exact[n] {
                continue;
            }
            (self.exact[n], self.programs.numbers[n], changed) = (true, number, true);
            exact_nodes(whole, (lattice, limits), block, &mut values);
            let signs = Signs::new(&values);
            for (axis, up) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, false), (axis, true)]) {
                let mut beyond = block;
                beyond[axis] = beyond[axis].wrapping_add_signed(if up { BLOCK as i32 } else { -(BLOCK as i32) });
                if is_mixed(&signs.face(axis, up)) && is_there(&beyond) && !known.contains_key(&beyond) {
                    open.push(beyond);
                }
            }
        }
        Ok(changed)
    }

    /// The leaves that decide at the middles of the triangles, by the programs of their blocks;
    /// `whole` is that of the solid.
    fn owners(&self, lattice: &Lattice, mesh: &Mesh, whole: &Program, run: &Run) -> Result<Vec<u32>, Cancelled> {
        let mut places: Vec<([u32; 3], usize)> = self.cells.iter().copied().zip(0..).collect();
        places.par_sort_unstable();
        each_triangle(mesh, run, |_, triangle| {
            let middle = mesh.corners(triangle).into_iter().sum::<DVec3>() / 3.0;
            let cell = (middle - lattice.origin()) / lattice.step();
            let block = cell.to_array().map(|x| x.max(0.0) as u32 / BLOCK as u32 * BLOCK as u32);
            // A triangle of several blocks may have its middle in one that holds no vertex.
            let nth = places.binary_search_by_key(&block, |&(block, _)| block).ok();
            nth.map_or(whole, |nth| self.programs.of(places[nth].1)).deciding_leaf(middle)
        })
    }
}

/// The values at the nodes of a block in double precision; beyond the limits of the solid they are outside.
fn exact_nodes(program: &Program, (lattice, limits): (&Lattice, &Bounds), block: [u32; 3], out: &mut [f32; NODES]) {
    for (n, value) in out.iter_mut().enumerate() {
        let at = |axis: usize, stride: usize| block[axis] + (n / stride % SIDE) as u32;
        let p = lattice.node(at(0, 1), at(1, SIDE), at(2, SIDE * SIDE));
        let exact = if limits.contains(p) { program.value(p) } else { -lattice.step() };
        *value = if exact > 0.0 { (exact as f32).max(f32::MIN_POSITIVE) } else { (exact as f32).min(0.0) };
    }
}

/// The surface program, block by block.
///
/// The blocks of a batch that have the same program form a group; a group has one tape.
struct SolidSampler<'a> {
    lattice: &'a Lattice,
    blocks: &'a [[u32; 3]],
    programs: &'a Programs,
    /// Which of the blocks are sampled in double precision, by their programs.
    exact: &'a [bool],
    /// The number of the first block of each block's group.
    groups: Vec<u32>,
    /// The box that the surface is in.
    limits: Bounds,
    /// The nodes of a block, relative to the first, x fastest.
    pattern: [Vec<f32>; 3],
    /// By batch, the tapes of its groups once its roots are found; empty if they are not to be kept.
    kept: Vec<OnceLock<Vec<(u32, Tape)>>>,
}

/// Roots that are found at once; a multiple of the points that lanes are run on.
const AT_ONCE: usize = 2048;

/// So many layers of a block's nodes are sampled together: a third of them.
const LAYERS: usize = 3;

/// What a thread keeps from block to block.
#[derive(Default)]
struct Scratch {
    evaluator: Evaluator,
    /// The tapes of the groups sampled since roots were asked for.
    tapes: Vec<(u32, Tape)>,
    finder: Deciders,
    single: [Vec<f32>; 3],
    slopes: [Vec<f32>; 4],
    /// Edges in the order of their groups: their places, themselves, their roots.
    order: Vec<u32>,
    edges: Vec<EdgeRef>,
    roots: Vec<Root>,
}

impl SolidSampler<'_> {
    fn new<'a>(lattice: &'a Lattice, blocks: &'a Blocks, limits: Bounds) -> SolidSampler<'a> {
        let Blocks { cells: blocks, programs, exact } = blocks;
        let mut groups = vec![0; blocks.len()];
        groups.par_chunks_mut(BATCH).enumerate().for_each(|(batch, groups)| {
            let mut heads: Vec<u32> = Vec::new();
            for (n, group) in (batch * BATCH..).zip(groups) {
                // The latest first: blocks that follow each other are near each other.
                let head = heads.iter().rev().find(|&&head| programs.is_same(head as usize, n));
                *group = head.copied().unwrap_or(n as u32);
                if *group == n as u32 {
                    heads.push(*group);
                }
            }
        });
        let at = |node: usize, stride: usize| (node / stride % SIDE) as f64 * lattice.step();
        let pattern = [1, SIDE, SIDE * SIDE].map(|stride| (0..NODES).map(|n| at(n, stride) as f32).collect());
        SolidSampler { lattice, blocks, programs, exact, groups, limits, pattern, kept: Vec::new() }
    }

    /// The tape of a group, made if it is not among those at hand.
    fn tape_of<'t>(&self, tapes: &'t mut Vec<(u32, Tape)>, group: u32) -> &'t mut Tape {
        // The latest first: blocks that follow each other are near each other.
        let made = tapes.iter().rposition(|(other, _)| *other == group);
        let at = made.unwrap_or_else(|| {
            tapes.push((group, self.tape(group)));
            tapes.len() - 1
        });
        &mut tapes[at].1
    }

    /// The tape of a group for slopes: that which its roots were found with, if it is kept. Moved from block to block it
    /// rounds, so each block starts from the same.
    fn tape_for_slopes(&self, group: u32) -> Tape {
        let kept = self.kept.get(group as usize / BATCH).and_then(OnceLock::get);
        let kept = kept.and_then(|tapes| tapes.iter().find(|(other, _)| *other == group));
        kept.map_or_else(|| self.tape(group), |(_, tape)| tape.clone())
    }

    /// Keeps tapes for the slopes that are asked for after all roots.
    fn keep_tapes(&mut self) {
        self.kept.resize_with(self.blocks.len().div_ceil(BATCH), OnceLock::new);
    }

    /// Ends the use of the tapes of a batch for roots.
    fn put_by(&self, batch: usize, tapes: &mut Vec<(u32, Tape)>) {
        match self.kept.get(batch) {
            // The roots of a batch are asked for once.
            Some(kept) => _ = kept.set(std::mem::take(tapes)),
            None => tapes.clear(),
        }
    }

    /// A tape for the group that starts with a block.
    fn tape(&self, group: u32) -> Tape {
        let first = group as usize;
        let batch = first..(first / BATCH * BATCH + BATCH).min(self.blocks.len());
        let bounds = batch.filter(|&n| self.groups[n] == group).fold(Bounds::EMPTY, |all, n| {
            let block = self.blocks[n];
            let at = |i: u32| self.lattice.node(block[0] + i, block[1] + i, block[2] + i);
            all.union(&Bounds::new(at(0), at(BLOCK as u32)))
        });
        Tape::new(self.programs.of(first), &bounds)
    }
}

impl Sampler for SolidSampler<'_> {
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    fn limits(&self) -> Bounds {
        self.limits
    }

    fn nodes(&self, scratch: &mut Scratch, number: usize, block: [u32; 3], out: &mut [f32; NODES]) {
        let group = self.groups[number];
        let tape = self.tape_of(&mut scratch.tapes, group);
        if self.exact.get(number) == Some(&true) {
            return exact_nodes(self.programs.of(number), (self.lattice, &self.limits), block, out);
        }
        tape.recentre(self.lattice.node(block[0], block[1], block[2]));
        // A few layers at a time: not all leaves of the block reach all of them. Nodes beside those
        // inside of a leaf are in its reach.
        for (layers, out) in out.chunks_mut(LAYERS * SIDE * SIDE).enumerate() {
            let first = layers * LAYERS;
            let points = self.pattern.each_ref().map(|axis| &axis[first * SIDE * SIDE..][..out.len()]);
            let [x, y, z] = block;
            let low = self.lattice.node(x, y, z + first as u32);
            let last = first + out.len() / (SIDE * SIDE) - 1;
            let high = self.lattice.node(x + BLOCK as u32, y + BLOCK as u32, z + last as u32);
            let region = Bounds::new(low, high).inflate(1.01 * self.lattice.step());
            scratch.evaluator.values_in((tape, &region), points, out);
        }
        // A sign that rounding may have turned is settled in double precision.
        let doubt = tape.roundoff() as f32;
        if !out.iter().fold(false, |any, value| any | (value.abs() <= doubt)) {
            return;
        }
        let program = self.programs.of(number);
        for (n, value) in out.iter_mut().enumerate() {
            if value.abs() <= doubt {
                let at = |axis: usize, stride: usize| block[axis] + (n / stride % SIDE) as u32;
                let exact = program.value(self.lattice.node(at(0, 1), at(1, SIDE), at(2, SIDE * SIDE)));
                *value = if exact > 0.0 { value.abs().max(f32::MIN_POSITIVE) } else { -value.abs() };
            }
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
        let group = self.groups[number];
        let Scratch { evaluator, tapes, single, slopes: [values, ..], .. } = scratch;
        let Some((_, tape)) = tapes.iter().rfind(|(other, _)| *other == group) else { return false };
        let origin = self.lattice.node(block[0], block[1], block[2]);
        place(points.iter().map(|p| (*p - origin).as_vec3a()), single);
        values.resize(points.len(), 0.0);
        let [x, y, z] = &*single;
        evaluator.values(tape, x, y, z, values);
        out.extend(values.iter().map(|value| *value > 0.0));
        true
    }

    fn roots(&self, scratch: &mut Scratch, edges: &[EdgeRef], out: &mut [Root]) {
        let Scratch { evaluator, tapes, finder, order, edges: sorted, roots, .. } = scratch;
        let group = |edge: &EdgeRef| self.groups[edge.block as usize];
        let (Some(first), Some(last)) = (edges.first(), edges.last()) else { return };
        let start = first.block as usize / BATCH * BATCH;
        let mut find = |edges: &[EdgeRef], roots: &mut [Root]| {
            let group = group(&edges[0]);
            let pair = (self.programs.of(group as usize), &*self.tape_of(tapes, group));
            // As many as the cache holds.
            for (edges, roots) in edges.chunks(AT_ONCE).zip(roots.chunks_mut(AT_ONCE)) {
                finder.find(evaluator, pair, self.lattice, edges, roots);
            }
        };
        let blocks = &self.groups[first.block as usize..=last.block as usize];
        if blocks.iter().all(|other| *other == blocks[0]) {
            find(edges, out);
            self.put_by(start / BATCH, tapes);
            return;
        }
        // Counted first, then each to its place: a group is named by a block of the batch.
        let mut places = [0u32; BATCH + 1];
        edges.iter().for_each(|edge| places[group(edge) as usize - start + 1] += 1);
        (0..BATCH).for_each(|n| places[n + 1] += places[n]);
        order.resize(edges.len(), 0);
        for (n, edge) in (0..).zip(edges) {
            let place = &mut places[group(edge) as usize - start];
            order[*place as usize] = n;
            *place += 1;
        }
        sorted.clear();
        sorted.extend(order.iter().map(|&n| edges[n as usize]));
        roots.resize(edges.len(), Root::default());
        let mut rest = &mut roots[..edges.len()];
        for edges in sorted.chunk_by(|a, b| group(a) == group(b)) {
            find(edges, rest.split_off_mut(..edges.len()).unwrap_or_default());
        }
        for (&n, root) in order.iter().zip(&*roots) {
            out[n as usize] = *root;
        }
        self.put_by(start / BATCH, tapes);
    }

    fn slopes(
        &self,
        scratch: &mut Scratch,
        number: usize,
        block: [u32; 3],
        points: &[Vec3A],
        out: &mut Vec<Slope>,
    ) -> bool {
        let mut tape = self.tape_for_slopes(self.groups[number]);
        tape.recentre(self.lattice.node(block[0], block[1], block[2]));
        // The program holds in the block and nowhere else.
        let (high, step) = (Vec3A::splat(BLOCK as f32), self.lattice.step() as f32);
        place(points.iter().map(|p| step * p.clamp(Vec3A::ZERO, high)), &mut scratch.single);
        for slope in &mut scratch.slopes {
            slope.resize(points.len(), 0.0);
        }
        let [x, y, z] = &scratch.single;
        let [value, dx, dy, dz] = &mut scratch.slopes;
        scratch.evaluator.gradients(&tape, x, y, z, Gradients { value, dx, dy, dz });
        out.extend((0..points.len()).map(|n| Slope { value: value[n], gradient: Vec3A::new(dx[n], dy[n], dz[n]) }));
        true
    }
}

/// The coordinates of points, axis by axis.
fn place(points: impl Iterator<Item = Vec3A>, [x, y, z]: &mut [Vec<f32>; 3]) {
    x.clear();
    y.clear();
    z.clear();
    for p in points {
        x.push(p.x);
        y.push(p.y);
        z.push(p.z);
    }
}
