//! Meshing a solid: `solid.mesh(..)`.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::blocks::Blocks;
use super::error::MeshingError;
use super::extract::ExtractError;
use super::lattice::{CellSize, Lattice};
use super::paint::corner_colors;
use super::refine::{Job, refined};
use super::settings::{AtBounds, Features, MeshSettings, ThinFeatures};
use super::thin::thin_report;
use crate::eval::compiled;
use crate::geom::{Findings, Mesh, ThinReport};
use crate::{Bounds, Paint, RFunction, Run, Solid, SolidError};
use rvachev_field::check::{LARGEST_LENGTH, SMALLEST_LENGTH};

/// What leaves the bounds by less, in cells, is let pass: vertices may be off by a thousandth.
const SLACK: f64 = 0.01;

/// Vertices that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 1 << 14;

/// A surface with radii of so many cells is known to have no creases.
const ROUND: f64 = 2.0;

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
        let whole = settings.bounds.as_ref().filter(|_| settings.at_bounds == AtBounds::Refuse);
        if bounds.is_empty() {
            if let Some(given) = whole {
                run.install(|| self.refuse_beyond(given, Lattice::new(given, settings.cell)?.step(), &run))?;
            }
            run.report(1.0);
            let thin = (settings.thin == ThinFeatures::Count).then(ThinReport::default);
            return Ok(Mesh::default().with_findings(Findings {
                clamped_vertices: Some(0),
                thin,
                ..Findings::default()
            }));
        }
        let programs = compiled(&solid)?;
        // A mesh has the paint of its solid, if there is any, by the owners of its triangles.
        let palette = solid.palette()?;
        let painted = palette.is_painted();
        let owned = settings.owners || painted;
        run.install(|| {
            // How long each stage takes, more or less.
            let if_done = |is_done: bool, time: f64| if is_done { time } else { 0.0 };
            let most = settings.thin.halvings();
            let [own, paint] = [if_done(owned, 0.8), if_done(painted, 0.2)];
            let [refine, extract] = [if_done(most > 0, 3.0), if_done(most == 0, 0.85)];
            let search = if_done(settings.thin == ThinFeatures::Count, 1.0);
            let times = [0.15, refine, extract, if_done(whole.is_some(), 1.0), own, paint, search];
            let [to_find, to_refine, to_extract, to_refuse, to_own, to_paint, to_search] = run.stages(times);
            let lattice = Lattice::new(&bounds, settings.cell)?;
            let mut blocks = Blocks::find(&programs.surface, &lattice, &to_find)?;
            let is_round = programs.surface.least_radius() >= ROUND * lattice.step();
            let features = if is_round { Features::Smooth } else { settings.features };
            let job = Job { program: &programs.surface, limits: bounds, features };
            let mut mesh = if most > 0 {
                refined(job, (lattice, blocks.clone()), most, &to_refine)?
            } else {
                blocks.extract(&programs.surface, (&lattice, bounds), features, &to_extract)?
            };
            if let Some(given) = whole {
                self.refuse_caps(&mesh, given, lattice.step(), &to_refuse)?;
                self.refuse_beyond(given, lattice.step(), &to_refuse)?;
            }
            if owned {
                let owners = blocks.owners(&lattice, &mesh, &programs.surface, &to_own)?;
                if painted {
                    let colors = corner_colors(&mesh, &palette, &owners, Paint::default(), &to_paint)?;
                    mesh = mesh.with_corner_colors(colors).map_err(ExtractError::from)?;
                }
                mesh = mesh.with_owners(owners).map_err(ExtractError::from)?;
            }
            if settings.thin == ThinFeatures::Count {
                let thin = Some(thin_report(&blocks, (&lattice, bounds), &to_search)?);
                let findings = Findings { thin, ..mesh.findings().clone() };
                mesh = mesh.with_findings(findings);
            }
            run.report(1.0);
            Ok(mesh)
        })
    }

    /// An error if a vertex on a face of the bounds is inside the solid.
    fn refuse_caps(&self, mesh: &Mesh, given: &Bounds, step: f64, run: &Run) -> Result<(), MeshingError> {
        let slack = SLACK * step;
        let program = &compiled(self)?.surface;
        let inner = given.inflate(-slack);
        // Values are no lengths; by the slope they tell how far it is to the surface.
        let is_inside = |p: DVec3| {
            let (value, slope) = program.gradient(p);
            value > slack * slope.length()
        };
        let beyond = |p: &&Vec3| !inner.contains(p.as_dvec3()) && is_inside(p.as_dvec3());
        for positions in mesh.positions().chunks(AT_ONCE) {
            run.check()?;
            if let Some(at) = positions.par_iter().find_first(beyond) {
                return Err(MeshingError::LeavesBounds { at: at.as_dvec3() });
            }
        }
        Ok(())
    }

    /// An error if there is a part of the solid beyond the bounds, of a size that cells of this size show; where
    /// they would be too many, cells of a thousandth of the solid's box.
    fn refuse_beyond(&self, given: &Bounds, step: f64, run: &Run) -> Result<(), MeshingError> {
        let own = self.bounds()?;
        if given.contains_bounds(&own) || !own.is_finite() {
            return Ok(());
        }
        let lattice =
            Lattice::new(&own, CellSize::Length(step)).or_else(|_| Lattice::new(&own, CellSize::LongestSide(1000)))?;
        let program = &compiled(self)?.surface;
        let [to_find, to_extract] = run.stages([0.15, 0.85]);
        let mut blocks = Blocks::find(program, &lattice, &to_find)?;
        let mesh = blocks.extract(program, (&lattice, own), Features::Smooth, &to_extract)?;
        let within = given.inflate(SLACK * lattice.step());
        match mesh.positions().iter().find(|p| !within.contains(p.as_dvec3())) {
            Some(at) => Err(MeshingError::LeavesBounds { at: at.as_dvec3() }),
            None => Ok(()),
        }
    }

    /// The solid cut to a box, if there is one and the solid leaves it, and the box that
    /// holds what is left.
    pub(super) fn cut_to(&self, bounds: Option<&Bounds>) -> Result<(Solid, Bounds), SolidError> {
        let Some(given) = bounds else { return Ok((self.clone(), self.finite_bounds()?)) };
        let wrong = || SolidError::Bounds { bounds: format!("{} to {}", given.min, given.max) };
        if given.is_empty() || !given.is_finite() || given.size().min_element() < SMALLEST_LENGTH {
            return Err(wrong());
        }
        let own = self.bounds()?;
        if own.is_empty() || given.contains_bounds(&own) {
            return Ok((self.clone(), own));
        }
        let part = own.intersection(given);
        // Boxes are larger than what they hold by rounding.
        let rounding = 1e-12 * part.min.abs().max(part.max.abs()).max_element();
        if part.size().min_element() <= rounding {
            return Ok((self.clone(), Bounds::EMPTY));
        }
        // Far from the solid the bounds cut nothing.
        let knife = given.intersection(&own.inflate(own.size().max_element()));
        if knife.size().max_element() > LARGEST_LENGTH {
            return Err(wrong());
        }
        let cut = self.intersection(Solid::cuboid(knife.size()).translate(knife.center()), RFunction::MIN_MAX);
        Ok((cut, part))
    }
}
