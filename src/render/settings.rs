//! What a picture shall be, and why there is none.

use crate::error::MeshingError;
use crate::{Angle, CameraError, Cancelled, ImageError, Paint, Plane, SaveError, SolidError, deg};

/// What to render.
///
/// The default is a studio: a warm key light from the upper left that casts soft shadows, a cool
/// fill light from the right, a rim light from behind, and a sky that every part sees as much of as
/// the others leave free. The solid stands on a ground that shows shadows and nothing else. All
/// lights move with the camera; up is +z.
///
/// ```
/// use rvachev::{Background, Camera, RenderSettings, Solid};
///
/// let ball = Solid::sphere(1.0);
/// let settings = RenderSettings { width: 64, height: 48, background: Background::Transparent, ..Default::default() };
/// let image = ball.render(&Camera::framing(&ball.bounds()?), &settings)?;
/// assert_eq!(image.pixel(32, 24).map(|p| p[3]), Some(255));
/// assert_eq!(image.pixel(0, 0).map(|p| p[3]), Some(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct RenderSettings {
    /// Width of the picture in pixels, 1 to 65 535. Default: 800.
    pub width: u32,
    /// Height of the picture in pixels, 1 to 65 535. Default: 600.
    pub height: u32,
    /// Against stairs: a pixel at an outline, a crease or the edge of a hard shadow is the mean
    /// of `samples` × `samples` rays. 1 to 8, 1 meaning one ray for every pixel. Default: 3.
    ///
    /// Where to sample more is seen from one ray a pixel, so a solid that is thinner than a
    /// pixel may show gaps.
    pub samples: u32,
    /// How the solid is drawn. Default: [`Style::Studio`].
    pub style: Style,
    /// The paint of what has [none](crate::Solid::paint). Default: a warm grey, half rough.
    pub paint: Paint,
    /// The strengths of the lights. Default: 1 each.
    pub lights: Lights,
    /// Whether the key light casts shadows. Default: true.
    pub shadows: bool,
    /// The angle that the key light appears under, 0 to 90 degrees: shadows are the softer the
    /// larger it is, and have hard edges at 0. Default: 14 degrees.
    pub softness: Angle,
    /// Whether parts hide the sky from each other, which darkens corners and hollows.
    /// Default: true.
    pub occlusion: bool,
    /// Whether the solid stands on a ground, at the height of its lowest point, that receives its
    /// shadows; seen from above only. Default: true.
    pub ground: bool,
    /// How light becomes colour. Default: [`Transfer::Filmic`].
    pub transfer: Transfer,
    /// What is behind the solid. Default: nearly white, a little darker at the bottom.
    pub background: Background,
    /// Whether the surface itself is drawn, or a mesh of it. Default: [`Quality::Fine`].
    pub quality: Quality,
    /// The cells of the mesh that a [draft](Quality::Draft) shows, along the longest side of the
    /// solid's box, 4 to 1024. If something may be thinner than a cell, all are halved, and halved
    /// again, as long as the mesh takes no more of them than one of a plain solid would:
    /// [`Scene::draft_mesh`](crate::Scene::draft_mesh) tells what it shows. Default: 64.
    pub draft_cells: u32,
    /// To look into the solid: the plane that it is cut by. What is on the side that the plane's
    /// [normal](Plane::normal) points to is taken away, so that of [`Plane::xz`] the section is
    /// seen from the front, and what is left is drawn, throws shadows and stands on the ground as
    /// if it was all (a clipping plane, a section view). A [`Scene`](crate::Scene) keeps what it
    /// was last cut to: see [`Scene::cut`](crate::Scene::cut). Default: none, the solid is whole.
    ///
    #[doc = picture!("section" = "docs/section.png")]
    ///
    /// ```
    /// use rvachev::{Camera, Paint, Plane, RenderSettings, Solid};
    ///
    /// let pipe = Solid::cylinder(2.0, 6.0).paint([40, 90, 160]) - Solid::cylinder(1.0, 8.0);
    /// let camera = Camera::framing(&pipe.bounds()?);
    /// // The section has the colour of the pipe,
    /// let size = RenderSettings { width: 60, height: 40, ..RenderSettings::default() };
    /// let cut = RenderSettings { cut: Some(Plane::xz(0.0)), ..size };
    /// pipe.render(&camera, &cut)?;
    /// // or one of its own.
    /// let painted = RenderSettings { cut_paint: Some(Paint::from([200, 60, 40])), ..cut };
    /// pipe.render(&camera, &painted)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub cut: Option<Plane>,
    /// The paint of the section. Default: none, it shows the parts that it passes through.
    pub cut_paint: Option<Paint>,
}

impl Default for RenderSettings {
    fn default() -> RenderSettings {
        RenderSettings {
            width: 800,
            height: 600,
            samples: 3,
            style: Style::default(),
            paint: Paint::default(),
            lights: Lights::default(),
            shadows: true,
            softness: deg(14.0),
            occlusion: true,
            ground: true,
            transfer: Transfer::default(),
            background: Background::default(),
            quality: Quality::default(),
            draft_cells: 64,
            cut: None,
            cut_paint: None,
        }
    }
}

/// How much a picture costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Quality {
    /// The surface itself, found with certainty along every ray, with shadows, ambient occlusion
    /// and a ground.
    #[default]
    Fine,
    /// A mesh of the solid, drawn triangle by triangle with the same camera, lights and paint, for
    /// turntables and live views. The mesh has [`draft_cells`](RenderSettings::draft_cells); a
    /// [`Scene`](crate::Scene) keeps it from frame to frame. There are no shadows, no ambient
    /// occlusion and no ground; where parts of different paint flow into each other, the border
    /// runs along triangles. Width and height, each times [`samples`](RenderSettings::samples), are
    /// at most 16 384.
    ///
    /// ```
    /// use rvachev::{Camera, Quality, RenderSettings, Solid, deg};
    ///
    /// let scene = (Solid::cuboid([2.0, 2.0, 1.0]) - Solid::cylinder(0.6, 2.0)).scene()?;
    /// let camera = Camera::framing(&scene.bounds());
    /// let draft = RenderSettings { width: 96, height: 54, quality: Quality::Draft, ..RenderSettings::default() };
    /// for step in 0..8 {
    ///     let frame = scene.render(&camera.orbit(deg(45.0 * f64::from(step)), deg(0.0)), &draft)?;
    ///     assert_eq!(frame.width(), 96);
    /// }
    /// # Ok::<(), rvachev::error::RenderError>(())
    /// ```
    Draft,
}

/// How a solid is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Style {
    /// In its paint, under the lights of a studio, on a ground.
    #[default]
    Studio,
    /// As a model of pale clay in the same light: form without paint and without reflections.
    Clay,
    /// Every surface in the colour of its outward normal: red, green and blue grow with x, y
    /// and z.
    Normals,
    /// As in a manual: flat pale shades, thick lines at outlines, thin ones at creases.
    Technical,
}

impl Style {
    /// Every style.
    pub const ALL: [Style; 4] = [Style::Studio, Style::Clay, Style::Normals, Style::Technical];

    /// Whether it has light that can be kept off.
    pub(super) fn has_shadows(self) -> bool {
        matches!(self, Style::Studio | Style::Clay)
    }
}

/// The strengths of the lights: 1 is the default, 0 turns a light off, 10 is the most.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Lights {
    /// The main light, from the upper left.
    pub key: f64,
    /// The light that brightens shadows, from the right.
    pub fill: f64,
    /// The light from behind that draws bright edges.
    pub rim: f64,
    /// The light from all around, most of it from above.
    pub sky: f64,
}

impl Default for Lights {
    fn default() -> Lights {
        Lights { key: 1.0, fill: 1.0, rim: 1.0, sky: 1.0 }
    }
}

/// How light becomes colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Transfer {
    /// As it is, in sRGB; what is brighter than white is cut off.
    Srgb,
    /// As on film: a soft shoulder that keeps highlights from being cut off, a slight toe that
    /// deepens shadows.
    #[default]
    Filmic,
}

/// What is behind the solid. Colours are red, green, blue in sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Background {
    /// Nothing: alpha is 0 there, and in between at the outline and in shadows on the ground.
    Transparent,
    /// One colour.
    Plain([u8; 3]),
    /// From one colour to another.
    Gradient {
        /// The colour at the top of the picture.
        top: [u8; 3],
        /// The colour at its bottom.
        bottom: [u8; 3],
    },
}

impl Default for Background {
    fn default() -> Background {
        Background::Gradient { top: [250, 250, 250], bottom: [226, 228, 231] }
    }
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The solid is at fault, or unbounded.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// There is no mesh for a draft.
    #[error(transparent)]
    Meshing(MeshingError),
    /// The camera cannot take a picture.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A setting is out of its range.
    #[error("{setting} is {value}; allowed: {allowed}")]
    Setting {
        /// The setting.
        setting: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The file of a picture could not be written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The pixels do not make a picture: a defect of this crate.
    #[error("internal error, please report it: {0}")]
    Image(#[from] ImageError),
}

impl From<MeshingError> for RenderError {
    fn from(error: MeshingError) -> RenderError {
        match error {
            MeshingError::Solid(error) => error.into(),
            MeshingError::Cancelled(cancelled) => cancelled.into(),
            other => RenderError::Meshing(other),
        }
    }
}

/// The largest side of a picture, in pixels.
const LARGEST: u32 = 65_535;

/// The most pixels of a picture in memory; larger ones go to a file band by band.
const MOST_PIXELS: u64 = 1 << 28;

/// Cells of a draft's mesh along its longest side.
const LEAST_CELLS: u32 = 4;
const MOST_CELLS: u32 = 1024;

/// The largest number of samples along a pixel's side.
const MOST_SAMPLES: u32 = 8;

/// Whether a draft may have so many cells.
pub(super) fn check_cells(cells: u32) -> Result<(), RenderError> {
    if (LEAST_CELLS..=MOST_CELLS).contains(&cells) { Ok(()) } else { Err(setting("draft_cells", cells, "4 to 1024")) }
}

/// The error of a setting.
pub(super) fn setting(setting: &'static str, value: impl std::fmt::Display, allowed: &'static str) -> RenderError {
    RenderError::Setting { setting, value: value.to_string(), allowed }
}

/// Whether a picture of this size fits into memory.
pub(super) fn check_memory(width: u32, height: u32) -> Result<(), RenderError> {
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        let size = format!("{width} × {height}");
        return Err(setting(
            "size",
            size,
            "268 435 456 pixels in memory; `render_to` writes larger pictures to a file",
        ));
    }
    Ok(())
}

/// Whether the sides of a picture are in their range.
pub(super) fn check_size(width: u32, height: u32) -> Result<(), RenderError> {
    for (name, side) in [("width", width), ("height", height)] {
        if !(1..=LARGEST).contains(&side) {
            return Err(setting(name, side, "1 to 65 535 pixels"));
        }
    }
    Ok(())
}

impl RenderSettings {
    /// Whether every setting is in its range.
    pub(super) fn check(&self) -> Result<(), RenderError> {
        check_size(self.width, self.height)?;
        if !(1..=MOST_SAMPLES).contains(&self.samples) {
            return Err(setting("samples", self.samples, "1 to 8"));
        }
        check_cells(self.draft_cells)?;
        for (name, paint) in [("paint.roughness", Some(self.paint)), ("cut_paint.roughness", self.cut_paint)] {
            if let Some(Paint { roughness, .. }) = paint
                && !(0.0..=1.0).contains(&roughness)
            {
                return Err(setting(name, roughness, "0 to 1"));
            }
        }
        if !(Angle::ZERO..=deg(90.0)).contains(&self.softness) {
            return Err(setting("softness", self.softness, "0° to 90°"));
        }
        let Lights { key, fill, rim, sky } = self.lights;
        for (name, light) in [("lights.key", key), ("lights.fill", fill), ("lights.rim", rim), ("lights.sky", sky)] {
            if !(0.0..=10.0).contains(&light) {
                return Err(setting(name, light, "0 to 10"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_setting() {
        let good = RenderSettings::default();
        good.check().unwrap();
        let message = |settings: RenderSettings| settings.check().unwrap_err().to_string();
        assert_eq!(message(RenderSettings { width: 0, ..good.clone() }), "width is 0; allowed: 1 to 65 535 pixels");
        assert!(message(RenderSettings { height: 70_000, ..good.clone() }).starts_with("height is 70000"));
        assert!(message(RenderSettings { samples: 9, ..good.clone() }).starts_with("samples is 9"));
        assert!(message(RenderSettings { softness: deg(f64::NAN), ..good.clone() }).starts_with("softness is NaN"));
        let lights = Lights { rim: -1.0, ..Lights::default() };
        assert!(message(RenderSettings { lights, ..good.clone() }).starts_with("lights.rim is -1"));
        let paint = Paint { roughness: f64::NAN, ..Paint::default() };
        assert!(message(RenderSettings { paint, ..good.clone() }).starts_with("paint.roughness is NaN"));
        let cut_paint = Some(Paint { roughness: 2.0, ..Paint::default() });
        assert!(message(RenderSettings { cut_paint, ..good.clone() }).starts_with("cut_paint.roughness is 2"));
        assert_eq!(message(RenderSettings { draft_cells: 0, ..good }), "draft_cells is 0; allowed: 4 to 1024");
    }
}
