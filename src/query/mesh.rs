//! Meshing a solid: `solid.mesh(..)`.

use crate::distance::compiled_with;
use crate::error::MeshingError;
use crate::geom::{Findings, Mesh, ThinReport};
use crate::mesh::{AtBounds, Subject, ThinFeatures, Whole, thin_features_of};
use crate::{Bounds, MeshSettings, RFunction, Run, Solid, SolidError};
use rvachev_field::check::{LARGEST_LENGTH, SMALLEST_LENGTH};

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
        let run = run.stage(0.0, 1.0);
        let [to_compile, to_mesh] = run.stages([0.1, 0.9]);
        let (solid, bounds) = self.cut_to(settings.bounds.as_ref(), &to_compile)?;
        let whole = settings.bounds.filter(|_| settings.at_bounds == AtBounds::Refuse);
        let whole = match whole {
            Some(given) => Some(Whole { programs: compiled_with(self, &to_compile)?, given }),
            None => None,
        };
        if bounds.is_empty() {
            if let Some(whole) = whole {
                run.install(|| whole.refuse_beyond(settings.cell, &run))?;
            }
            run.report(1.0);
            let thin = (settings.thin == ThinFeatures::Count).then(ThinReport::default);
            return Ok(Mesh::default().with_findings(Findings {
                clamped_vertices: Some(0),
                thin,
                ..Findings::default()
            }));
        }
        let programs = compiled_with(&solid, &to_compile)?;
        // A mesh has the paint of its solid, if there is any, by the owners of its triangles.
        let subject =
            Subject { program: &programs.surface, bounds, palette: Some(&programs.palette), whole: whole.as_ref() };
        let mesh = run.install(|| subject.mesh(settings, &to_mesh))?;
        run.report(1.0);
        Ok(mesh)
    }

    /// Searches for features that are thinner than cells show: walls, gaps, needles and holes,
    /// with their places and estimated sizes. `settings` are those that the solid is to be meshed
    /// with: its cell size and bounds count.
    ///
    /// It costs a tenth to a half of the time of a mesh for simple parts; up to six times as much
    /// as the mesh for blends, lattices and walls of a few cells; up to twelve times for parts
    /// seen through several deformations. [`Mesh::possibly_lost`](crate::Mesh::possibly_lost) is
    /// always there, and tells whether it is worth while.
    ///
    /// ```
    /// use rvachev::{CellSize, MeshSettings, Run, Solid};
    ///
    /// let fin = Solid::cuboid([0.03, 0.8, 0.8]).translate([0.0, 0.0, 1.3]);
    /// let part = Solid::cuboid([2.0, 2.0, 2.0]) | fin;
    /// let settings = MeshSettings { cell: CellSize::LongestSide(32), ..MeshSettings::default() };
    /// let report = part.thin_features(&settings, &Run::default())?;
    /// assert_eq!(report.count, 1);
    /// let fin = &report.places[0];
    /// assert!((fin.thickness.unwrap() - 0.03).abs() < 1e-6 && fin.position.x.abs() < 0.015);
    /// assert!(fin.size.y > 0.7 && fin.position.z > 1.0);
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    ///
    /// # Details
    ///
    /// A cell counts if the range of the value over it contains 0, and no direction is found such
    /// that along it, and along all directions within 8° of it, the solid is entered, and not
    /// left, throughout the cell: the surface may come into it and turn round, as at a thin wall,
    /// a narrow slot, or a fin with a draft of less than that. Of cells with corners on both sides
    /// those count whose surface is found to turn round: a flat wall that is thicker than the
    /// diagonal of a cell, 1.74 times its side, is whole. What may be lost in other cells is the
    /// tip of something blunter, up to six cells of it. A fillet or chamfer is taken to have no
    /// features of its own that are thinner than its size. Ranges are wider than what they hold:
    /// edges of acute angles, lattices of few cells a period, and radii of two or three cells may
    /// give places where there is nothing, without a thickness.
    ///
    /// # Errors
    /// As for [`mesh`](Solid::mesh): what is wrong with the solid or the settings, or that the
    /// work was cancelled.
    pub fn thin_features(&self, settings: &MeshSettings, run: &Run) -> Result<ThinReport, MeshingError> {
        let run = run.stage(0.0, 1.0);
        let (solid, bounds) = self.cut_to(settings.bounds.as_ref(), &run)?;
        let report = if bounds.is_empty() {
            ThinReport::default()
        } else {
            let programs = compiled_with(&solid, &run)?;
            run.install(|| thin_features_of(&programs.surface, bounds, settings.cell, &run))?
        };
        run.report(1.0);
        Ok(report)
    }

    /// The solid cut to a box, if there is one and the solid leaves it, and the box that
    /// holds what is left.
    fn cut_to(&self, bounds: Option<&Bounds>, run: &Run) -> Result<(Solid, Bounds), MeshingError> {
        compiled_with(self, run)?;
        let Some(given) = bounds else { return Ok((self.clone(), self.finite_bounds()?)) };
        let wrong = || MeshingError::from(SolidError::Bounds { bounds: format!("{} to {}", given.min, given.max) });
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
        // Far from the solid the bounds cut nothing. Where the solid ends before them they are
        // taken away from it: a face that touches it would be an edge of almost no angle.
        let mut knife = given.intersection(&own.inflate(own.size().max_element()));
        let beyond = part.size().max_element();
        for axis in 0..3 {
            if own.min[axis] >= given.min[axis] - rounding {
                knife.min[axis] = own.min[axis] - beyond;
            }
            if own.max[axis] <= given.max[axis] + rounding {
                knife.max[axis] = own.max[axis] + beyond;
            }
        }
        if knife.size().max_element() > LARGEST_LENGTH {
            return Err(wrong());
        }
        let cut = self.intersection(Solid::cuboid(knife.size()).translate(knife.center()), RFunction::MIN_MAX);
        Ok((cut, part))
    }
}
