//! Light: from a point of a surface to what the eye receives.
//!
//! ```text
//!        sky                 L = albedo·(key·max(n·k, 0)·seen + fill·half(n·f)
//!   key      . rim                       + rim·max(n·r, 0) + sky(n)·open)
//!     \     /                  + highlight(key) + highlight(rim)
//!      (n) /                   + F(n·v)·room(reflected, roughness)·open
//!      ( )      fill
//!       *  - - - *           k, f, r are fixed to the camera; the sky is above, +z.
//! ------------------ ground  seen, open: the shares of the key light and of the sky that
//!                            nothing hides
//! ```
//!
//! The room that polished surfaces reflect is drawn by formulas: a sky that brightens upwards, a
//! soft box at the key light and a strip at the rim light. Linear light throughout, in `f32`.
//!
//! Sources: B. Walter and others, *Microfacet models for refraction through rough surfaces*
//! (2007), for the highlight (GGX); C. Schlick (1994) for Fresnel's factor; J. Jimenez and
//! others, *Practical realtime strategies for accurate indirect occlusion* (2016), for the light
//! that bounces out of hollows.

use glam::{DVec3, Vec3, Vec3A, Vec4};

use super::settings::{Background, RenderSettings, Style, Transfer};
use super::spot::Spot;
use crate::geom::to_linear;
use crate::{Camera, Paint};

/// Irradiances over π, so that a white matt surface that faces the light has this radiance.
const KEY: Vec3A = Vec3A::new(1.00, 0.955, 0.89);
const FILL: Vec3A = Vec3A::new(0.15, 0.17, 0.20);
const RIM: Vec3A = Vec3A::new(0.34, 0.36, 0.40);
const SKY: Vec3A = Vec3A::new(0.40, 0.425, 0.47);
/// What the ground sends back up.
const BOUNCE: Vec3A = Vec3A::new(0.19, 0.18, 0.17);

/// What a surface without metal reflects when seen at a right angle.
const REFLECTANCE: f32 = 0.04;

/// What is left of the background in the deepest shadow.
const SHADOW: Vec3A = Vec3A::new(0.030, 0.033, 0.042);

/// The pale clay of [`Style::Clay`].
const CLAY: [u8; 3] = [214, 205, 194];

/// What is known of the light at a point: the shares of the key light and of the sky that
/// nothing hides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Visibility {
    pub(super) key: f32,
    pub(super) sky: f32,
}

impl Visibility {
    /// Nothing is hidden.
    pub(super) const FULL: Visibility = Visibility { key: 1.0, sky: 1.0 };
}

/// A paint, ready for light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Material {
    albedo: Vec3A,
    /// The width of highlights: the square of the roughness.
    width: f32,
}

impl From<Paint> for Material {
    fn from(paint: Paint) -> Material {
        // A perfect mirror of a light without extent would not be seen at all.
        let roughness = paint.roughness.clamp(0.08, 1.0) as f32;
        Material { albedo: unit(paint.color).map(to_linear), width: roughness * roughness }
    }
}

/// The lights of a picture, and what is behind the solid.
pub(super) struct Studio {
    key: Vec3,
    fill: Vec3,
    rim: Vec3,
    /// Their strengths.
    lights: [Vec3A; 3],
    sky: f32,
    style: Style,
    transfer: Transfer,
    /// Top and bottom in sRGB from 0 to 1, or nothing.
    background: Option<[Vec3A; 2]>,
}

impl Studio {
    /// The lights for a camera that has been checked.
    pub(super) fn new(camera: &Camera, settings: &RenderSettings) -> Studio {
        let pose = camera.pose().matrix3;
        let towards = |x: f64, y: f64, z: f64| {
            let direction = x * pose.x_axis - y * pose.y_axis - z * pose.z_axis;
            direction.normalize().as_vec3()
        };
        let lights = settings.lights;
        Studio {
            key: towards(-0.58, 0.66, 0.76),
            fill: towards(0.90, 0.10, 0.42),
            rim: towards(0.55, 0.52, -0.66),
            lights: [KEY * lights.key as f32, FILL * lights.fill as f32, RIM * lights.rim as f32],
            sky: lights.sky as f32,
            style: settings.style,
            transfer: settings.transfer,
            background: match settings.background {
                Background::Transparent => None,
                Background::Plain(color) => Some([unit(color); 2]),
                Background::Gradient { top, bottom } => Some([unit(top), unit(bottom)]),
            },
        }
    }

    /// The direction to the middle of the light that casts shadows.
    pub(super) fn key(&self) -> DVec3 {
        self.key.as_dvec3().normalize()
    }

    /// The material that stands for `paint` in this style; `own` tells whether it was given to
    /// the part or is that of the settings.
    pub(super) fn material(&self, paint: Paint, own: bool) -> Material {
        match self.style {
            Style::Studio | Style::Normals => paint.into(),
            Style::Clay => Paint { color: CLAY, roughness: 1.0 }.into(),
            // Pale, so that lines stand out; what nobody painted is paper.
            Style::Technical => {
                let paper = Vec3A::new(0.93, 0.935, 0.94);
                let share = if own { 0.55 } else { 0.0 };
                Material { albedo: paper.lerp(unit(paint.color).map(to_linear), share), width: 1.0 }
            }
        }
    }

    /// The colour of a surface, as it is shown.
    pub(super) fn surface(&self, spot: &Spot, material: &Material, open: Visibility) -> Vec4 {
        let (normal, viewer) = (spot.normal, spot.viewer);
        let light = match self.style {
            Style::Studio => self.developed(self.lit(normal, viewer, material, open, 1.0)),
            Style::Clay => self.developed(self.lit(normal, viewer, material, open, 0.0)),
            Style::Normals => Vec3A::from(0.5 + 0.5 * spot.outward()).map(to_linear),
            Style::Technical => material.albedo * self.flat(normal),
        };
        light.extend(1.0)
    }

    /// The shade of a face in a manual.
    fn flat(&self, normal: Vec3) -> f32 {
        let towards = 0.5 + 0.5 * normal.dot(self.key);
        0.62 + 0.38 * towards
    }

    /// Light that leaves a surface towards the viewer; `polish` is 0 for a surface that only
    /// scatters.
    fn lit(&self, normal: Vec3, viewer: Vec3, material: &Material, open: Visibility, polish: f32) -> Vec3A {
        let cosine = |light: Vec3| normal.dot(light).max(0.0);
        let [key, fill, rim] = self.lights;
        let albedo = material.albedo;
        // Out of hollows comes light of the colour of their walls.
        let sky = bounced(open.sky, albedo);
        // The fill is a large light: it reaches around the terminator.
        let wrapped = (0.35 + 0.65 * normal.dot(self.fill)).max(0.0);
        let direct = key * (cosine(self.key) * open.key);
        let around = fill * wrapped + self.sky * BOUNCE.lerp(SKY, 0.5 + 0.5 * normal.z);
        let matt = albedo * (direct + sky * (around + rim * cosine(self.rim)));
        if polish == 0.0 {
            return matt;
        }
        let facing = cosine(viewer).max(1e-3);
        let fresnel = REFLECTANCE + (1.0 - REFLECTANCE) * (1.0 - facing).powi(5) * (1.0 - 0.7 * material.width);
        let highlight = |light: Vec3| {
            let towards = cosine(light);
            if towards == 0.0 {
                return 0.0;
            }
            let half = (light + viewer).normalize_or_zero();
            let f = REFLECTANCE + (1.0 - REFLECTANCE) * (1.0 - half.dot(viewer).clamp(0.0, 1.0)).powi(5);
            f * microfacets(cosine(half), towards, facing, material.width) * towards
        };
        let reflected = 2.0 * normal.dot(viewer) * normal - viewer;
        let lights = key * (open.key * highlight(self.key)) + rim * (open.sky * highlight(self.rim));
        matt + polish * (lights + fresnel * open.sky * self.room(reflected, material.width))
    }

    /// What a surface reflects of the room, blurred as its roughness blurs it.
    fn room(&self, direction: Vec3, width: f32) -> Vec3A {
        let sky = BOUNCE.lerp(2.2 * SKY, smooth(-0.35 - width, 0.9 + width, direction.z));
        // Lights with an extent, so that their images are soft shapes and not points.
        let soft_box = |light: Vec3, narrow: f32| {
            let away = 1.0 - direction.dot(light);
            (-away / (narrow + 1.2 * width)).exp()
        };
        let [key, fill, rim] = self.lights;
        let boxes = key * (2.6 * soft_box(self.key, 0.05))
            + fill * (2.0 * soft_box(self.fill, 0.12))
            + rim * (2.4 * soft_box(self.rim, 0.08));
        self.sky * sky + boxes / (1.0 + 6.0 * width)
    }

    /// The background as the ground shows it: darker in shadow. Transparent ground is shadow
    /// and nothing else.
    pub(super) fn ground(&self, background: Vec4, open: Visibility) -> Vec4 {
        let luminance = |c: Vec3A| c.dot(Vec3A::new(0.2126, 0.7152, 0.0722));
        let key = luminance(self.lights[0]) * self.key.z.max(0.0);
        let sky = luminance(self.lights[1]) + self.sky * luminance(SKY);
        let whole = key + sky;
        if whole <= 0.0 {
            return background;
        }
        let lit = ((key * open.key + sky * open.sky) / whole).clamp(0.0, 1.0);
        let dark = 1.0 - lit;
        (Vec3A::from_vec4(background) * lit + SHADOW * dark).extend(background.w * lit + dark)
    }

    /// The colour behind the solid; `down` runs from 0 at the top of the picture to 1.
    pub(super) fn background(&self, down: f64) -> Vec4 {
        match self.background {
            None => Vec4::ZERO,
            // Between the bytes and not the radiances, which makes steps of equal height.
            Some([top, bottom]) => top.lerp(bottom, down as f32).map(to_linear).extend(1.0),
        }
    }

    /// Light as it is shown.
    fn developed(&self, light: Vec3A) -> Vec3A {
        match self.transfer {
            Transfer::Srgb => light,
            Transfer::Filmic => filmic(light),
        }
    }
}

/// GGX: distribution of the microfacets and what they hide of each other, over 4·(n·l)·(n·v),
/// times π for lights given as irradiance over π.
fn microfacets(half: f32, light: f32, viewer: f32, width: f32) -> f32 {
    let a2 = width * width;
    let d = half * half * (a2 - 1.0) + 1.0;
    let k = 0.5 * width;
    let hidden = (light * (1.0 - k) + k) * (viewer * (1.0 - k) + k);
    // Highlights of a light of some extent do not grow without end.
    (a2 / ((d * d).max(1e-9) * (4.0 * hidden).max(1e-4))).min(14.0)
}

/// The share of light that leaves a hollow that sees `open` of the sky and whose walls have the
/// given albedo.
fn bounced(open: f32, albedo: Vec3A) -> Vec3A {
    let a = 2.0404 * albedo - 0.3324;
    let b = -4.7951 * albedo + 0.6417;
    let c = 2.7552 * albedo + 0.6903;
    (((open * a + b) * open + c) * open).max(Vec3A::splat(open))
}

/// From 0 to 1 between two edges, smoothly.
fn smooth(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A number from 0 to 1 for each byte.
fn unit(color: [u8; 3]) -> Vec3A {
    Vec3A::from_array(color.map(|c| f32::from(c) / 255.0))
}

/// A curve with a toe, nearly straight in the middle, and a shoulder towards 1.
fn filmic(light: Vec3A) -> Vec3A {
    const TOE: f32 = 0.012;
    const SHOULDER: f32 = 0.66;
    const ROOM: f32 = 1.0 - SHOULDER;
    let light = light.max(Vec3A::ZERO);
    let light = light * light / (light + TOE);
    if light.max_element() <= SHOULDER {
        return light;
    }
    light.map(|l| if l <= SHOULDER { l } else { 1.0 - ROOM * ((SHOULDER - l) / ROOM).exp() })
}

#[cfg(test)]
mod tests {
    use super::super::gbuffer::Surface;
    use super::*;
    use crate::deg;

    #[test]
    fn lit_surfaces_are_brighter_and_none_is_cut_off() {
        let camera = Camera::perspective(DVec3::new(2.0, -3.0, 2.0), DVec3::ZERO, DVec3::Z, deg(30.0));
        let studio = Studio::new(&camera, &RenderSettings::default());
        let n = camera.eye.normalize();
        // On a ball, seen from the camera.
        let facing = Surface { distance: 1.0, normal: n.as_vec3(), owner: 0 };
        let spot = Spot::new(camera.eye, -n, &facing, None);
        for color in [[255; 3], [0; 3], [200, 30, 20]] {
            for roughness in [0.0, 0.3, 1.0] {
                let material = Paint { color, roughness }.into();
                let shade = |open| studio.surface(&spot, &material, open).truncate();
                let (lit, dark) = (shade(Visibility::FULL), shade(Visibility { key: 0.0, sky: 0.3 }));
                assert!(lit.cmpgt(dark).all(), "{lit} {dark}");
                assert!(dark.min_element() >= 0.0 && lit.max_element() <= 1.0, "{lit} {dark}");
            }
        }
    }

    #[test]
    fn the_ground_is_the_background_where_nothing_hides_the_light() {
        let camera = Camera::perspective(DVec3::new(2.0, -3.0, 2.0), DVec3::ZERO, DVec3::Z, deg(30.0));
        let studio = Studio::new(&camera, &RenderSettings::default());
        let background = studio.background(0.7);
        assert_eq!(studio.ground(background, Visibility::FULL), background);
        assert_eq!(studio.ground(Vec4::ZERO, Visibility::FULL), Vec4::ZERO);
        let shadow = studio.ground(Vec4::ZERO, Visibility { key: 0.0, sky: 0.5 });
        assert!(shadow.w > 0.5 && shadow.x < 0.05, "{shadow}");
    }
}
