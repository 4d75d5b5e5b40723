//! How thick a solid is.

use std::fmt;

use glam::DVec3;

use crate::error::RenderError;
use crate::geom::{label, legend};
use crate::{Camera, Image, Mesh, MeshSolid, ParamError, RenderSettings, Run, Solid, SolidError};
use rvachev_field::check;
use rvachev_num::figures;

/// The most ranges of a histogram.
const MOST_RANGES: usize = 1_000_000;

/// How thick a solid is, by the triangles of its mesh:
/// [`Solid::thickness`](crate::Solid::thickness).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ThicknessReport {
    /// The least thickness, in length units; infinite if no part of the surface faces another.
    pub least: f64,
    /// Where it is: the middle of a triangle.
    pub at: DVec3,
    /// The mesh.
    pub mesh: Mesh,
    thicknesses: Vec<f64>,
    areas: Vec<f64>,
}

/// A range of thicknesses and how much of the surface has them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ThicknessBin {
    /// The least of the range, in length units.
    pub from: f64,
    /// The most of the range, which is the least of the next.
    pub to: f64,
    /// The area of the surface with such a thickness, in square length units.
    pub area: f64,
}

impl ThicknessReport {
    pub(super) fn new(mesh: Mesh, thicknesses: Vec<f64>) -> ThicknessReport {
        let corners = |t: usize| mesh.corners(mesh.triangles()[t]);
        let area = |t: usize| {
            let [a, b, c] = corners(t);
            0.5 * (b - a).cross(c - a).length()
        };
        let areas = (0..thicknesses.len()).map(area).collect();
        let thinnest = (0..thicknesses.len()).min_by(|a, b| thicknesses[*a].total_cmp(&thicknesses[*b]));
        let least = thinnest.map_or(f64::INFINITY, |t| thicknesses[t]);
        let at = thinnest.map_or(DVec3::ZERO, |t| corners(t).into_iter().sum::<DVec3>() / 3.0);
        ThicknessReport { least, at, mesh, thicknesses, areas }
    }

    /// The thickness at the middle of each triangle of the mesh, in length units; infinite where no
    /// part of the surface faces it.
    #[must_use]
    pub fn thicknesses(&self) -> &[f64] {
        &self.thicknesses
    }

    /// The share of the surface that is thinner than `limit`, a length, from 0 to 1.
    ///
    /// # Errors
    /// If the limit is NaN.
    pub fn share_below(&self, limit: f64) -> Result<f64, ParamError> {
        if limit.is_nan() {
            return Err(ParamError::new("limit", limit, "any number"));
        }
        let whole: f64 = self.areas.iter().sum();
        let below = self.thicknesses.iter().zip(&self.areas).filter(|(thickness, _)| **thickness < limit);
        Ok(if whole > 0.0 { below.fold(0.0, |sum, (_, area)| sum + area) / whole } else { 0.0 })
    }

    /// How much of the surface is how thick: so many ranges of one width, from 0 to the largest
    /// thickness that is finite; at most a million ranges.
    #[must_use]
    pub fn histogram(&self, ranges: usize) -> Vec<ThicknessBin> {
        let ranges = ranges.min(MOST_RANGES);
        let finite = self.thicknesses.iter().filter(|thickness| thickness.is_finite());
        let largest = finite.fold(0.0, |largest: f64, thickness| largest.max(*thickness));
        let width = largest / ranges as f64;
        let bin = |k: usize| ThicknessBin { from: k as f64 * width, to: (k + 1) as f64 * width, area: 0.0 };
        let mut bins: Vec<ThicknessBin> = (0..ranges).map(bin).collect();
        for (thickness, area) in self.thicknesses.iter().zip(&self.areas).filter(|(thickness, _)| thickness.is_finite())
        {
            let at = if width > 0.0 { (thickness / width) as usize } else { 0 };
            if let Some(bin) = bins.get_mut(at.min(ranges.saturating_sub(1))) {
                bin.area += area;
            }
        }
        bins
    }

    /// The mesh in colours: from red at thicknesses of `thin` and less, by yellow and green, to
    /// blue at those of `thick` and more, in length units. In place of [`mesh`](Self::mesh) another
    /// one, of other triangles, stays as it is.
    ///
    /// # Errors
    /// If one of them is not finite, or `thick` is not above `thin`.
    pub fn colored(&self, thin: f64, thick: f64) -> Result<Mesh, ParamError> {
        check::number("thin", thin)?;
        check::number("thick", thick)?;
        if thick <= thin {
            return Err(ParamError::new("thick", thick, format_args!("above {thin}, which is thin")));
        }
        let color = |thickness: &f64| {
            let part = ((thickness - thin) / (thick - thin)).clamp(0.0, 1.0);
            let [r, g, b] = heat(part);
            [[r, g, b, 255]; 3]
        };
        let colors = self.thicknesses.iter().map(color).collect();
        Ok(self.mesh.clone().with_corner_colors(colors).unwrap_or_else(|_| self.mesh.clone()))
    }

    /// A picture of the mesh in the colours of [`colored`](Self::colored) from the first to the
    /// second thickness, with a bar at the right that says what they stand for, in length units; a
    /// small picture has no bar. `settings` are those of any picture.
    ///
    /// ```
    /// use rvachev::{Camera, MeshSettings, RenderSettings, Run, Solid};
    ///
    /// let tube = Solid::cylinder(10.0, 20.0) - Solid::cylinder(9.0, 21.0);
    /// let report = tube.thickness(&MeshSettings::default(), &Run::default())?;
    /// let camera = Camera::framing(&tube.bounds()?);
    /// let settings = RenderSettings { width: 240, height: 180, ..RenderSettings::default() };
    /// let picture = report.picture([0.5, 3.0], &camera, &settings, &Run::default())?;
    /// assert_eq!((picture.width(), picture.height()), (240, 180));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the thicknesses, the camera or the settings, that the mesh has no
    /// triangles, or that the work was cancelled.
    pub fn picture(
        &self,
        [thin, thick]: [f64; 2],
        camera: &Camera,
        settings: &RenderSettings,
        run: &Run,
    ) -> Result<Image, RenderError> {
        let run = run.stage(0.0, 1.0);
        let [to_build, to_render] = run.stages([0.2, 0.8]);
        let colored = self.colored(thin, thick).map_err(SolidError::Argument)?;
        let colored = Solid::from_mesh_with(&colored, MeshSolid::default(), &to_build)?;
        let scene = colored.scene_with(&to_render.stage(0.0, 0.2))?;
        let image = scene.render_with(camera, settings, &to_render.stage(0.2, 1.0))?;
        let mut pixels = image.pixels().to_vec();
        let at = |part: f64| thin + part * (thick - thin);
        let labels = [1.0, 0.75, 0.5, 0.25, 0.0].map(|part| label(at(part), thin.abs().max(thick.abs()), false));
        legend(&mut pixels, image.width() as usize, &labels, heat);
        run.report(1.0);
        Ok(Image::new(image.width(), image.height(), pixels).unwrap_or(image))
    }
}

/// Red, yellow, green, cyan, blue, from 0 to 1.
fn heat(part: f64) -> [u8; 3] {
    let ramp = |centre: f64| (255.0 * (1.5 - (4.0 * part - centre).abs() * 0.75).clamp(0.0, 1.0)).round() as u8;
    [ramp(0.0), ramp(2.0), ramp(4.0)]
}

impl fmt::Display for ThicknessReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.least.is_infinite() {
            return f.write_str("no part of the surface faces another");
        }
        let [x, y, z] = self.at.to_array().map(|x| figures(x, 4));
        write!(f, "least thickness {} at ({x}, {y}, {z})", figures(self.least, 4))
    }
}
