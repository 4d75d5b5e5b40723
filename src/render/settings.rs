//! What a picture shall be, and why there is none.

use crate::{CameraError, Cancelled, ImageError, SolidError};

/// What to render.
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
pub struct RenderSettings {
    /// Width of the picture in pixels, 1 to 16384. Default: 800.
    pub width: u32,
    /// Height of the picture in pixels, 1 to 16384. Default: 600.
    pub height: u32,
    /// Against stairs: a pixel at an outline, a crease or the edge of a shadow is the mean of
    /// `samples` × `samples` rays. 1 to 8, 1 meaning one ray for every pixel. Default: 3.
    ///
    /// Where to sample more is seen from one ray a pixel, so a solid that is thinner than a
    /// pixel may show gaps.
    pub samples: u32,
    /// Colour of the solid: red, green, blue in sRGB. Default: a warm grey.
    pub color: [u8; 3],
    /// Strength of the highlights, 0 (matt) to 1 (polished). Default: 0.4.
    pub gloss: f64,
    /// Whether the key light casts shadows. Default: true.
    pub shadows: bool,
    /// What is behind the solid. Default: nearly white, a little darker at the bottom.
    pub background: Background,
}

impl Default for RenderSettings {
    fn default() -> RenderSettings {
        RenderSettings {
            width: 800,
            height: 600,
            samples: 3,
            color: [186, 178, 168],
            gloss: 0.4,
            shadows: true,
            background: Background::default(),
        }
    }
}

/// What is behind the solid. Colours are red, green, blue in sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// Nothing: alpha is 0 there, and in between at the outline.
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
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The solid is at fault, or unbounded.
    #[error(transparent)]
    Solid(#[from] SolidError),
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
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The pixels do not make a picture: a defect of this crate.
    #[error("internal error, please report it: {0}")]
    Image(#[from] ImageError),
}

/// The largest side of a picture, in pixels.
const LARGEST: u32 = 16384;

/// The largest number of samples along a pixel's side.
const MOST_SAMPLES: u32 = 8;

impl RenderSettings {
    /// Whether every setting is in its range.
    pub(super) fn check(&self) -> Result<(), RenderError> {
        let error = |setting, value: &dyn std::fmt::Display, allowed| {
            Err(RenderError::Setting { setting, value: value.to_string(), allowed })
        };
        for (name, side) in [("width", self.width), ("height", self.height)] {
            if !(1..=LARGEST).contains(&side) {
                return error(name, &side, "1 to 16384 pixels");
            }
        }
        if !(1..=MOST_SAMPLES).contains(&self.samples) {
            return error("samples", &self.samples, "1 to 8");
        }
        if !(0.0..=1.0).contains(&self.gloss) {
            return error("gloss", &self.gloss, "0 to 1");
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
        assert_eq!(good.check(), Ok(()));
        let message = |settings: RenderSettings| settings.check().unwrap_err().to_string();
        assert_eq!(message(RenderSettings { width: 0, ..good.clone() }), "width is 0; allowed: 1 to 16384 pixels");
        let high = RenderSettings { height: 20_000, ..good.clone() };
        assert_eq!(message(high), "height is 20000; allowed: 1 to 16384 pixels");
        assert_eq!(message(RenderSettings { samples: 9, ..good.clone() }), "samples is 9; allowed: 1 to 8");
        assert_eq!(message(RenderSettings { gloss: f64::NAN, ..good }), "gloss is NaN; allowed: 0 to 1");
    }
}
