//! Meshing a solid: `solid.mesh(..)`.

use std::collections::HashMap;

use glam::DVec3;

use super::extract::{ExtractError, Root, Sampler, extract};
use super::feature::Slope;
use super::lattice::{CellSize, Lattice, LatticeError};
use super::signs::{BLOCK, EdgeRef, NODES};
use crate::eval::{Evaluator, Gradients, Program, Tape, compiled};
use crate::geom::Mesh;
use crate::space::{Grid, surface_blocks};
use crate::{Bounds, Cancelled, RFunction, Run, Solid, SolidError};

/// What to mesh.
///
/// ```
/// use rvachev::{CellSize, MeshSettings, Solid};
///
/// let settings = MeshSettings { cell: CellSize::LongestSide(32), ..MeshSettings::default() };
/// let mesh = Solid::sphere(1.0).mesh(&settings)?;
/// assert!(mesh.check().is_closed());
/// # Ok::<(), rvachev::MeshingError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct MeshSettings {
    /// The resolution. Default: 128 cells along the longest side of the bounds.
    pub cell: CellSize,
    /// The box to mesh, in length units; where the solid leaves it, the mesh is that of
    /// their intersection. Default (`None`): the box of the solid.
    pub bounds: Option<Bounds>,
    /// Whether creases and corners are kept. Default: [`Features::Sharp`].
    pub features: Features,
}

/// What becomes of creases and corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Features {
    /// They are cut off, by a fraction of a cell: marching cubes.
    Smooth,
    /// They are kept: where the normals in a cell spread, the cell has a vertex on the crease or
    /// in the corner, and the mesh has edges along the crease. Elsewhere the mesh is that of
    /// [`Smooth`](Features::Smooth).
    #[default]
    Sharp,
}

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
        if bounds.is_empty() {
            return Ok(Mesh::default());
        }
        let lattice = Lattice::new(&bounds, settings.cell)?;
        let programs = compiled(&solid)?;
        let run = run.stage(0.0, 1.0);
        run.install(|| {
            let grid = Grid {
                origin: lattice.origin(),
                side: lattice.step() * BLOCK as f64,
                blocks: lattice.cells().map(|cells| cells.div_ceil(BLOCK as u32)),
            };
            let found = surface_blocks(&programs.surface, &grid, 0.0, &run)?;
            run.report(0.3);
            let blocks: Vec<[u32; 3]> = found.iter().map(|b| b.index.map(|i| i * BLOCK as u32)).collect();
            let programs = blocks.iter().copied().zip(found.into_iter().map(|b| b.program)).collect();
            let sampler = SolidSampler { lattice: &lattice, programs };
            Ok(extract(&sampler, &lattice, &blocks, settings.features, &run.stage(0.3, 1.0))?)
        })
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

/// The surface program, block by block.
struct SolidSampler<'a> {
    lattice: &'a Lattice,
    programs: HashMap<[u32; 3], Program>,
}

/// What a thread keeps between the nodes of a block and its roots.
#[derive(Default)]
struct Scratch {
    evaluator: Evaluator,
    tape: Option<Tape>,
    single: [Vec<f32>; 3],
    double: [Vec<f64>; 3],
    values: Vec<f64>,
    slopes: [Vec<f32>; 4],
}

/// Roots are bracketed to this part of an edge.
const PRECISION: f64 = 1e-9;

/// At most this many steps; from `HALVING` on they halve.
const STEPS: usize = 40;
const HALVING: usize = 12;

impl Sampler for SolidSampler<'_> {
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    fn nodes(&self, scratch: &mut Scratch, block: [u32; 3], out: &mut [f32; NODES]) {
        let Some(program) = self.programs.get(&block) else { return };
        let tape = Tape::new(program, &self.bounds(block));
        let origin = tape.origin();
        for axis in &mut scratch.single {
            axis.clear();
        }
        let place = |i: usize, axis: usize| block[axis] + i as u32;
        let side = BLOCK + 1;
        for k in 0..side {
            for j in 0..side {
                for i in 0..side {
                    let p = self.lattice.node(place(i, 0), place(j, 1), place(k, 2)) - origin;
                    scratch.single[0].push(p.x as f32);
                    scratch.single[1].push(p.y as f32);
                    scratch.single[2].push(p.z as f32);
                }
            }
        }
        let [x, y, z] = &scratch.single;
        scratch.evaluator.values(&tape, x, y, z, out);
        // A sign that rounding may have turned is settled in double precision.
        let doubt = tape.roundoff() as f32;
        for (n, value) in out.iter_mut().enumerate() {
            if value.abs() <= doubt {
                let (i, j, k) = (n % side, n / side % side, n / (side * side));
                let exact = program.value(self.lattice.node(place(i, 0), place(j, 1), place(k, 2)));
                *value = if exact > 0.0 { value.abs().max(f32::MIN_POSITIVE) } else { -value.abs() };
            }
        }
        scratch.tape = Some(tape);
    }

    fn roots(&self, scratch: &mut Scratch, block: [u32; 3], edges: &[EdgeRef], out: &mut [Root]) {
        let Some(tape) = scratch.tape.take() else { return };
        let origin = tape.origin();
        let step = self.lattice.step();
        let starts: Vec<DVec3> = edges
            .iter()
            .map(|edge| {
                let node: [u32; 3] = std::array::from_fn(|axis| block[axis] + u32::from(edge.node[axis]));
                self.lattice.node(node[0], node[1], node[2]) - origin
            })
            .collect();
        let point = |edge: usize, t: f64| {
            let mut p = starts[edge];
            p[edges[edge].axis as usize] += t * step;
            p
        };
        let mut brackets: Vec<Bracket> = edges.iter().map(|edge| Bracket::new(edge.leaves)).collect();
        for end in [0.0, 1.0] {
            evaluate(scratch, &tape, (0..edges.len()).map(|edge| point(edge, end)));
            for (bracket, value) in brackets.iter_mut().zip(&scratch.values) {
                bracket.end(end, *value);
            }
        }
        let mut open: Vec<usize> = (0..edges.len()).collect();
        for round in 0..STEPS {
            open.retain(|&edge| brackets[edge].is_open());
            if open.is_empty() {
                break;
            }
            for &edge in &open {
                brackets[edge].propose(round >= HALVING);
            }
            evaluate(scratch, &tape, open.iter().map(|&edge| point(edge, brackets[edge].t)));
            for (&edge, value) in open.iter().zip(&scratch.values) {
                brackets[edge].learn(*value);
            }
        }
        for (root, bracket) in out.iter_mut().zip(&brackets) {
            root.t = bracket.root();
        }
        self.normals(scratch, &tape, out, point);
    }

    fn slopes(&self, scratch: &mut Scratch, block: [u32; 3], points: &[DVec3], out: &mut Vec<Slope>) -> bool {
        let Some(program) = self.programs.get(&block) else { return false };
        let bounds = self.bounds(block);
        let tape = Tape::new(program, &bounds);
        // The program holds in the block and nowhere else.
        let inside = points.iter().map(|p| p.clamp(bounds.min, bounds.max) - tape.origin());
        gradients(scratch, &tape, inside);
        let [value, dx, dy, dz] = &scratch.slopes;
        out.extend(
            (0..points.len()).map(|n| Slope {
                value: value[n].into(),
                gradient: DVec3::new(dx[n].into(), dy[n].into(), dz[n].into()),
            }),
        );
        true
    }
}

impl SolidSampler<'_> {
    /// The box of a block.
    fn bounds(&self, block: [u32; 3]) -> Bounds {
        let at = |i: u32| self.lattice.node(block[0] + i, block[1] + i, block[2] + i);
        Bounds::new(at(0), at(BLOCK as u32))
    }

    fn normals(&self, scratch: &mut Scratch, tape: &Tape, out: &mut [Root], point: impl Fn(usize, f64) -> DVec3) {
        gradients(scratch, tape, out.iter().enumerate().map(|(edge, root)| point(edge, root.t)));
        let [_, dx, dy, dz] = &scratch.slopes;
        for (edge, root) in out.iter_mut().enumerate() {
            let inward = DVec3::new(dx[edge].into(), dy[edge].into(), dz[edge].into());
            root.normal = (-inward.normalize_or_zero()).as_vec3().to_array();
        }
    }
}

/// Values and gradients at points relative to the tape's origin, into the scratch.
fn gradients(scratch: &mut Scratch, tape: &Tape, points: impl Iterator<Item = DVec3>) {
    for axis in &mut scratch.single {
        axis.clear();
    }
    for p in points {
        for axis in 0..3 {
            scratch.single[axis].push(p[axis] as f32);
        }
    }
    for slope in &mut scratch.slopes {
        slope.resize(scratch.single[0].len(), 0.0);
    }
    let [x, y, z] = &scratch.single;
    let [value, dx, dy, dz] = &mut scratch.slopes;
    scratch.evaluator.gradients(tape, x, y, z, Gradients { value, dx, dy, dz });
}

/// The values at points relative to the tape's origin, into the scratch.
fn evaluate(scratch: &mut Scratch, tape: &Tape, points: impl Iterator<Item = DVec3>) {
    for axis in &mut scratch.double {
        axis.clear();
    }
    for p in points {
        for axis in 0..3 {
            scratch.double[axis].push(p[axis]);
        }
    }
    let [x, y, z] = &scratch.double;
    scratch.values.resize(x.len(), 0.0);
    scratch.evaluator.values_f64(tape, x, y, z, &mut scratch.values);
}

/// A root on an edge, closed in on by false position with halved weights (Illinois).
struct Bracket {
    low: f64,
    high: f64,
    at_low: f64,
    at_high: f64,
    inside_low: bool,
    t: f64,
    /// Which end has stayed: −1 low, 1 high.
    stayed: i8,
}

impl Bracket {
    fn new(inside_low: bool) -> Bracket {
        Bracket { low: 0.0, high: 1.0, at_low: 0.0, at_high: 0.0, inside_low, t: 0.5, stayed: 0 }
    }

    /// The value at an end. Its sign is known from the node, so one that rounding has turned
    /// is as good as 0.
    fn end(&mut self, end: f64, value: f64) {
        let size = value.abs().max(f64::MIN_POSITIVE);
        let inside = if end == 0.0 { self.inside_low } else { !self.inside_low };
        let agrees = (value > 0.0) == inside;
        let signed = if agrees { size } else { f64::MIN_POSITIVE } * if inside { 1.0 } else { -1.0 };
        if end == 0.0 {
            self.at_low = signed;
        } else {
            self.at_high = signed;
        }
    }

    fn is_open(&self) -> bool {
        self.high - self.low > PRECISION
    }

    fn propose(&mut self, halve: bool) {
        let width = self.high - self.low;
        let secant = self.low + width * (self.at_low / (self.at_low - self.at_high));
        // A hair beyond the secant closes the bracket from the other side next time.
        let inner = secant.clamp(self.low + 0.25 * PRECISION, self.high - 0.25 * PRECISION);
        self.t = if halve || !secant.is_finite() { 0.5 * (self.low + self.high) } else { inner };
    }

    fn learn(&mut self, value: f64) {
        if (value > 0.0) == self.inside_low {
            self.low = self.t;
            self.at_low = value;
            if self.stayed == 1 {
                self.at_high *= 0.5;
            }
            self.stayed = 1;
        } else {
            self.high = self.t;
            self.at_high = if value == 0.0 { f64::MIN_POSITIVE.copysign(self.at_high) } else { value };
            if self.stayed == -1 {
                self.at_low *= 0.5;
            }
            self.stayed = -1;
        }
    }

    fn root(&self) -> f64 {
        0.5 * (self.low + self.high)
    }
}
