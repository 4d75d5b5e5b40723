//! From a program to a mesh: the stages, one after the other.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use rvachev_num::jobs;

use super::blocks::Blocks;
use super::deviation::Probe;
use super::error::MeshingError;
use super::extract::ExtractError;
use super::lattice::{CellSize, Lattice};
use super::paint::corner_colors;
use super::refine::{Job, refined, within};
use super::settings::{Features, MeshSettings, ThinFeatures};
use super::simplify::{SHARE, simplified};
use super::thin::thin_report;
use crate::eval::{Compiled, Palette, Program};
use crate::geom::{Findings, Mesh};
use crate::{Bounds, Paint, Run};

/// What leaves the bounds by less, in cells, is let pass: vertices may be off by a thousandth.
const SLACK: f64 = 0.01;

/// Vertices that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 1 << 14;

/// A surface with radii of so many cells is known to have no creases.
const ROUND: f64 = 2.0;

/// A mesh within a tolerance begins with so many cells on the surface at most, and so many more for
/// each leaf.
const ENOUGH: f64 = 1e5;
const ENOUGH_A_LEAF: f64 = 500.0;

/// What is to be meshed.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a> {
    pub(crate) program: &'a Program,
    /// The box that the surface is in.
    pub(crate) bounds: Bounds,
    /// The paint of the program's leaves; nothing where it does not matter.
    pub(crate) palette: Option<&'a Palette>,
    /// The whole of which it is the part within bounds, if it must not leave them.
    pub(crate) whole: Option<&'a Whole>,
}

/// A solid that must not leave its bounds.
pub(crate) struct Whole {
    pub(crate) programs: Arc<Compiled>,
    pub(crate) given: Bounds,
}

impl Subject<'_> {
    /// The mesh, on the threads of the pool that it is called in.
    pub(crate) fn mesh(&self, settings: &MeshSettings, run: &Run) -> Result<Mesh, MeshingError> {
        let &Subject { program, bounds, palette, whole } = self;
        let palette = palette.filter(|palette| palette.is_painted());
        let owned = settings.owners || palette.is_some();
        let tolerance = match settings.cell {
            CellSize::Tolerance(tolerance) => Some(tolerance),
            _ => None,
        };
        // How long each stage takes, more or less.
        let if_done = |is_done: bool, time: f64| if is_done { time } else { 0.0 };
        let most = settings.thin.halvings();
        let [own, paint] = [if_done(owned, 0.8), if_done(palette.is_some(), 0.2)];
        let extract = if most > 0 || tolerance.is_some() { 3.0 } else { 0.85 };
        let search = if_done(settings.thin == ThinFeatures::Count, 1.0);
        let simplify = if_done(tolerance.is_some(), 3.0);
        let times = [0.15, extract, if_done(whole.is_some(), 1.0), own, simplify, paint, search];
        let [to_find, to_extract, to_refuse, to_own, to_simplify, to_paint, to_search] = run.stages(times);
        let mut lattice = Lattice::new(&bounds, settings.cell)?;
        if tolerance.is_some() {
            let enough = ENOUGH + ENOUGH_A_LEAF * program.leaf_count() as f64;
            let first =
                self.first_cell(bounds.longest_side(), lattice.step(), enough, &Run { progress: None, ..run.clone() })?;
            lattice = Lattice::new(&bounds, CellSize::Length(first))?;
        }
        let mut blocks = Blocks::find(program, &lattice, &to_find)?;
        let is_round = program.least_radius() >= ROUND * lattice.step();
        let features = if is_round { Features::Smooth } else { settings.features };
        let job = Job { program, limits: bounds, features, tolerance: tolerance.map(|tolerance| SHARE * tolerance) };
        let (mut near, mut lost): (Vec<Probe>, f64) = (Vec::new(), 0.0);
        let mut mesh = match tolerance {
            Some(tolerance) => {
                let start = (lattice, blocks);
                let found = within(job, start, most, SHARE * tolerance, &to_extract)?;
                (lattice, blocks, near, lost) = (found.lattice, found.blocks, found.probes, found.lost);
                found.mesh
            }
            None if most > 0 => refined(job, (lattice, blocks.clone()), most, &to_extract)?,
            None => blocks.extract(job, &lattice, &to_extract)?,
        };
        if let Some(whole) = whole {
            whole.refuse_caps(&mesh, lattice.step(), &to_refuse)?;
            whole.refuse_beyond(CellSize::Length(lattice.step()), &to_refuse)?;
        }
        if owned {
            let owners = blocks.owners(&lattice, &mesh, program, &to_own)?;
            mesh = mesh.with_owners(owners).map_err(ExtractError::from)?;
        }
        if let Some(tolerance) = tolerance {
            mesh = simplified(mesh, (&near, lost), (program, tolerance), &to_simplify)?;
        }
        if let (Some(palette), Some(owners)) = (palette, mesh.owners()) {
            let colors = corner_colors(&mesh, palette, owners, Paint::default(), &to_paint)?;
            mesh = mesh.with_corner_colors(colors).map_err(ExtractError::from)?;
        }
        if settings.thin == ThinFeatures::Count {
            let thin = Some(thin_report(&blocks, (&lattice, bounds), &to_search)?);
            let findings = Findings { thin, ..mesh.findings().clone() };
            mesh = mesh.with_findings(findings);
        }
        Ok(mesh)
    }
}

impl Whole {
    /// An error if a vertex on a face of the bounds is inside the solid.
    fn refuse_caps(&self, mesh: &Mesh, step: f64, run: &Run) -> Result<(), MeshingError> {
        let slack = SLACK * step;
        let program = &self.programs.surface;
        let inner = self.given.inflate(-slack);
        // Values are no lengths; by the slope they tell how far it is to the surface.
        let is_inside = |p: DVec3| {
            let (value, slope) = program.gradient(p);
            value > slack * slope.length()
        };
        let beyond = |p: &&Vec3| !inner.contains(p.as_dvec3()) && is_inside(p.as_dvec3());
        jobs::try_chunks(mesh.positions(), AT_ONCE, |_, positions| {
            run.check()?;
            let found = positions.iter().find(beyond);
            found.map_or(Ok(()), |at| Err(MeshingError::LeavesBounds { at: at.as_dvec3() }))
        })?;
        Ok(())
    }

    /// An error if there is a part of the solid beyond the bounds, of a size that cells of this
    /// size show; where they would be too many, cells of a thousandth of the solid's box.
    pub(crate) fn refuse_beyond(&self, cell: CellSize, run: &Run) -> Result<(), MeshingError> {
        let (own, given) = (self.programs.bounds(), self.given);
        let step = Lattice::new(&given, cell)?.step();
        if given.contains_bounds(&own) || !own.is_finite() {
            return Ok(());
        }
        let lattice =
            Lattice::new(&own, CellSize::Length(step)).or_else(|_| Lattice::new(&own, CellSize::LongestSide(1000)))?;
        let program = &self.programs.surface;
        let [to_find, to_extract] = run.stages([0.15, 0.85]);
        let mut blocks = Blocks::find(program, &lattice, &to_find)?;
        let job = Job { program, limits: own, features: Features::Smooth, tolerance: None };
        let mesh = blocks.extract(job, &lattice, &to_extract)?;
        let within = given.inflate(SLACK * lattice.step());
        match mesh.positions().iter().find(|p| !within.contains(p.as_dvec3())) {
            Some(at) => Err(MeshingError::LeavesBounds { at: at.as_dvec3() }),
            None => Ok(()),
        }
    }
}
