//! Light: from a hit to a colour, and from colours to bytes.
//!
//! ```text
//!      sky            L = albedo·(key·max(n·k, 0)·lit + fill·max(n·f, 0) + hemisphere(n·up))
//!   key     .             + gloss·(highlight(n·h) + rim(n·v))
//!     \   (n)
//!      \  ( )  fill   k, f  directions to the lights, fixed to the camera: key from the upper
//!       * ( )-- *           left, fill from the right
//!       ground        h     half-way between k and the viewer v
//! ```
//!
//! Linear light throughout, in `f32`; very bright values bend into a shoulder rather than
//! being cut off. The bytes are sRGB (IEC 61966-2-1).
//!
//! Sources: J. Blinn, *Models of light reflection for computer synthesized pictures* (1977)
//! for the highlight; C. Schlick (1994) for the shape of the rim.

use glam::{DVec3, Vec3, Vec4};

use super::settings::{Background, RenderSettings};
use crate::Camera;

/// Irradiances over π, so that a white matt surface that faces the light has this radiance.
const KEY: Vec3 = Vec3::new(0.90, 0.87, 0.82);
const FILL: Vec3 = Vec3::new(0.17, 0.19, 0.22);
const SKY: Vec3 = Vec3::new(0.36, 0.38, 0.42);
const GROUND: Vec3 = Vec3::new(0.15, 0.14, 0.13);

/// The exponent of the highlight: as wide as that of brushed metal.
const SHARPNESS: i32 = 28;

/// Radiance above this bends towards 1.
const SHOULDER: f32 = 0.72;

/// The lights of a picture, and the materials of what is in it.
pub(super) struct Studio {
    /// Directions to the lights, and up.
    key: DVec3,
    fill: DVec3,
    up: DVec3,
    albedo: Vec3,
    gloss: f32,
    /// Top and bottom in sRGB from 0 to 1, or nothing.
    background: Option<[Vec3; 2]>,
}

impl Studio {
    /// The lights for a camera that has been checked.
    pub(super) fn new(camera: &Camera, settings: &RenderSettings) -> Studio {
        let (_, forward) = camera.ray(0.5, 0.5, 1, 1);
        let up = (camera.up / camera.up.abs().max_element()).normalize();
        let right = forward.cross(up).normalize();
        let above = right.cross(forward);
        let towards = |x: f64, y: f64, z: f64| (x * right + y * above - z * forward).normalize();
        Studio {
            key: towards(-0.62, 0.66, 0.62),
            fill: towards(0.85, 0.05, 0.45),
            up,
            albedo: unit(settings.color).map(linear),
            gloss: settings.gloss as f32,
            background: match settings.background {
                Background::Transparent => None,
                Background::Plain(color) => Some([unit(color); 2]),
                Background::Gradient { top, bottom } => Some([unit(top), unit(bottom)]),
            },
        }
    }

    /// The direction to the light that casts shadows.
    pub(super) fn key(&self) -> DVec3 {
        self.key
    }

    /// The colour of a surface: `normal` and `viewer` are unit vectors on the same side of
    /// it; `lit` tells whether the key light reaches it.
    pub(super) fn surface(&self, normal: DVec3, viewer: DVec3, lit: bool) -> Vec4 {
        let cosine = |light: DVec3| normal.dot(light).max(0.0) as f32;
        let key = if lit { cosine(self.key) } else { 0.0 };
        let sky = GROUND.lerp(SKY, (0.5 + 0.5 * normal.dot(self.up)) as f32);
        let matt = self.albedo * (KEY * key + FILL * cosine(self.fill) + sky);
        let half = (self.key + viewer).normalize_or_zero();
        let highlight = if key > 0.0 { 0.45 * cosine(half).powi(SHARPNESS) * KEY } else { Vec3::ZERO };
        let rim = 0.5 * (1.0 - cosine(viewer)).powi(4) * sky;
        (matt + self.gloss * (highlight + rim)).map(shoulder).extend(1.0)
    }

    /// The colour behind the solid; `down` runs from 0 at the top of the picture to 1.
    pub(super) fn background(&self, down: f64) -> Vec4 {
        match self.background {
            None => Vec4::ZERO,
            // Between the bytes and not the radiances, which makes steps of equal height.
            Some([top, bottom]) => top.lerp(bottom, down as f32).map(linear).extend(1.0),
        }
    }
}

/// Linear radiance, weighted by alpha, as bytes.
pub(super) fn bytes(light: Vec4) -> [u8; 4] {
    let alpha = light.w;
    if alpha <= 0.0 {
        return [0; 4];
    }
    let color = (light.truncate() / alpha).map(encoded).extend(alpha);
    color.to_array().map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8)
}

/// Bytes as numbers from 0 to 1.
fn unit(color: [u8; 3]) -> Vec3 {
    Vec3::from_array(color.map(|c| f32::from(c) / 255.0))
}

/// From sRGB to linear.
fn linear(c: f32) -> f32 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// From linear to sRGB.
fn encoded(c: f32) -> f32 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// The identity up to [`SHOULDER`], then smoothly towards 1.
fn shoulder(light: f32) -> f32 {
    const ROOM: f32 = 1.0 - SHOULDER;
    if light <= SHOULDER { light } else { 1.0 - ROOM * ((SHOULDER - light) / ROOM).exp() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_the_transfer() {
        for byte in 0..=255u8 {
            let color = unit([byte; 3]).map(linear);
            assert_eq!(bytes(color.extend(1.0)), [byte, byte, byte, 255]);
            // Half covered: the colour stays.
            assert_eq!(bytes(color.extend(1.0) * 0.5), [byte, byte, byte, 128]);
        }
        assert_eq!(bytes(Vec4::ZERO), [0; 4]);
    }

    #[test]
    fn lit_surfaces_are_brighter_and_none_is_cut_off() {
        let camera = Camera::perspective(DVec3::new(2.0, -3.0, 2.0), DVec3::ZERO, DVec3::Z, 30.0);
        let studio = Studio::new(&camera, &RenderSettings { color: [255; 3], gloss: 1.0, ..Default::default() });
        let viewer = camera.eye.normalize();
        let lit = studio.surface(viewer, viewer, true);
        let dark = studio.surface(viewer, viewer, false);
        assert!(lit.truncate().cmpgt(dark.truncate()).all(), "{lit} {dark}");
        assert!(dark.min_element() > 0.0 && lit.truncate().max_element() < 1.0, "{lit} {dark}");
    }
}
