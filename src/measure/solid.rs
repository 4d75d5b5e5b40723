//! Volume, centroid, inertia and area of solids: `solid.measure(..)`.

use super::MeasureReport;
use super::area::{Area, area};
use super::closed::{Closed, closed};
use super::enclosed::Enclosed;
use super::integral::{Effort, Integral, ROUNDING, about_centroid, integral};
use crate::distance::compiled_with;
use crate::error::MeshingError;
use crate::program::Program;
use crate::{Bounds, ParamError, Run, Solid, SolidError};

/// The tolerance may be from this to that.
const TOLERANCES: [f64; 2] = [1e-9, 1.0];

impl Solid {
    /// The volume, centroid, inertia tensor and area of the solid, with how far each may be off.
    ///
    /// `tolerance` says how far the volume may be off, as a part of it, from 10⁻⁹ to 1; the area
    /// as well, as far as some 65 000 cells tell it.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// // A plate with a hole, and a rounded foot below it.
    /// let plate = Solid::cuboid([40.0, 20.0, 4.0]) - Solid::cylinder(5.0, 6.0).translate([8.0, 0.0, 0.0]);
    /// let foot = Solid::superellipsoid([6.0, 6.0, 8.0], 0.4, 1.0).translate([-10.0, 0.0, -12.0]);
    /// let report = (plate | foot).measure(1e-3)?;
    /// assert!(report.volume_error <= 1e-3 * report.volume);
    /// let centroid = report.centroid.expect("it is not empty");
    /// assert!(centroid.x < 0.0 && centroid.z < 0.0 && centroid.y.abs() <= report.centroid_error);
    ///
    /// // A superellipsoid, moved and stretched, has a closed form.
    /// let egg = Solid::superellipsoid([1.0, 2.0, 3.0], 0.3, 0.8).translate([5.0, 0.0, 0.0]);
    /// let report = egg.scale_axes([1.0, 2.0, 1.0]).measure(1e-3)?;
    /// assert!((report.volume - 2.0 * 38.359362386288).abs() < 1e-10);
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    ///
    /// # Details
    ///
    /// * **Volume, centroid and inertia** are those of the solid itself, not of a mesh, and their
    ///   errors are certain, up to the rounding of double precision. Blocks that are inside count
    ///   exactly. In blocks that the surface may cross, ranges of the slopes tell a plane and how
    ///   far the surface may be turned from it. Blocks are divided where most is left open. The
    ///   errors are bounds: what they bound is often a tenth of them, or less.
    /// * **Flat faces**: solids of flat-faced leaves, joined, copied and cut in any way, are right
    ///   to rounding, their area as well, in some milliseconds to tens of them.
    /// * **Area** of others: in each cell how far normals may be turned tells how much more the
    ///   surface has than what flows through it. The error is certain, and falls with the square
    ///   of the cells' size where the surface is smooth, with the size where it has creases. Some
    ///   ten thousand cells are enough for a hundredth of smooth leaves. Where they are not, or
    ///   nothing is known of normals, as in what is read from meshes and joined, in deformations
    ///   that tear and in fillets that fade away, the area is that of finer and finer meshes, and
    ///   the error an estimate: `is_area_certain` of the report tells.
    /// * **Closed forms**: superellipsoids, supertoroids, generalised superquadrics, ellipsoids and
    ///   the bounded exact primitives, also under rigid motions, scalings and affine maps,
    ///   are right to rounding, whatever the tolerance. No area has a closed form of superquadrics
    ///   and ellipsoids, nor of what is stretched unevenly.
    /// * **Imported meshes** that are closed, do not cross themselves and have nothing inside of
    ///   what is inside are summed up triangle by triangle, by themselves and in the blocks of a
    ///   join that nothing else passes; their corners are rounded to some 10⁻⁷ of their size.
    ///   Others go by ranges, which takes long.
    /// * A volume of less than a millionth of the box is found to the tolerance of that millionth.
    /// * An **empty** solid has volume and area 0, no centroid and no inertia.
    /// * The work is limited to about a million blocks. If they do not suffice, as where a surface
    ///   has no volume on one side, the errors say what was reached. A thousandth takes
    ///   milliseconds for convex leaves and what is joined of them; a hundredth takes a second or
    ///   more for supershapes and for what is bent, and seconds to minutes for fillets, and for
    ///   what is measured or read from meshes that overlap or are open: if an estimate does, ask a
    ///   mesh ([`Mesh::check`](crate::Mesh::check)).
    /// * Offsets, shells and fillets whose surface is [measured](crate::lengths#exact-or-measured)
    ///   are integrated as they are; how far that is from what was asked for, times the area, comes
    ///   on top: [`accuracy`](Solid::accuracy).
    ///
    /// # Errors
    /// What is wrong with the solid or the tolerance; [`SolidError::Unbounded`] of a solid without
    /// end.
    pub fn measure(&self, tolerance: f64) -> Result<MeasureReport, MeshingError> {
        self.measure_with(tolerance, &Run::default())
    }

    /// [`measure`](Solid::measure) with a choice of threads, a cancel token and a progress sink.
    /// The result does not depend on the number of threads.
    ///
    /// # Errors
    /// As for [`measure`](Solid::measure), or that the work was cancelled.
    pub fn measure_with(&self, tolerance: f64, run: &Run) -> Result<MeasureReport, MeshingError> {
        let [least, most] = TOLERANCES;
        if !(least..=most).contains(&tolerance) {
            let allowed = format!("{least:e} to {most}, a part of the volume");
            let source = ParamError::new("tolerance", tolerance, allowed);
            return Err(SolidError::Parameter { path: "measure".into(), source }.into());
        }
        let run = run.stage(0.0, 1.0);
        let [to_compile, to_measure] = run.stages([0.1, 0.9]);
        let programs = compiled_with(self, &to_compile)?;
        let bounds = self.finite_bounds()?;
        // A box without extent, but for rounding, holds no volume.
        let rounding = 1e-12 * bounds.min.abs().max(bounds.max.abs()).max_element();
        let report = if bounds.is_empty() || bounds.size().min_element() <= rounding {
            MeasureReport::empty()
        } else {
            run.install(|| report(self, &programs.surface, tolerance, &to_measure))?
        };
        run.report(1.0);
        Ok(report)
    }
}

/// Cells along the longest side at first, and how many there may be.
const FIRST: f64 = 12.0;
const MOST: usize = 1 << 20;

fn report(solid: &Solid, program: &Program, tolerance: f64, run: &Run) -> Result<MeasureReport, MeshingError> {
    let [to_integrate, to_mesh] = run.stages([0.5, 0.5]);
    let known = closed(solid, &Run { progress: None, ..run.clone() })?;
    let Integral { moments, volume_error, centroid_error, inertia_error, area: flat } = match &known {
        Some(known) => exact(known, &solid.bounds()?),
        None => {
            let enclosed = Enclosed::new(program, &to_integrate)?;
            let effort = Effort { tolerance, first: FIRST, most: MOST };
            integral((program, enclosed), &solid.finite_bounds()?, effort, &to_integrate)?
        }
    };
    let closed_area = known.and_then(|known| known.area);
    let Area { area, error: area_error, is_certain } = match closed_area.or(flat.map(|area| [area, ROUNDING * area])) {
        Some([area, error]) => Area { area, error, is_certain: true },
        None => area(solid, program, moments.volume, tolerance, &to_mesh)?,
    };
    Ok(MeasureReport {
        volume: moments.volume,
        volume_error,
        centroid: moments.centroid(),
        centroid_error,
        inertia: about_centroid(&moments),
        inertia_error,
        area,
        area_error,
        is_area_certain: is_certain,
        is_closed_form: closed_area.is_some(),
    })
}

/// Moments that are right to rounding, of what is within bounds.
fn exact(&Closed { moments, rounding, .. }: &Closed, bounds: &Bounds) -> Integral {
    let middle = moments.centroid().unwrap_or_default();
    let (centre, reach) = (middle.abs().max_element(), (bounds.center() - middle).abs() + bounds.half_extents());
    Integral {
        moments,
        volume_error: rounding * moments.volume,
        area: None,
        centroid_error: rounding * (centre + reach.max_element()),
        inertia_error: rounding * moments.volume * (reach.length_squared() + centre * centre),
    }
}
