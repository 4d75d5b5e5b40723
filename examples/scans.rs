//! The pictures of the page on scans: points, and the solids that were found in them.
//!
//! ```sh
//! cargo run --example scans             # into target/examples/scans
//! cargo run --example scans docs        # into docs/scans, as committed
//! ```
//!
//! Points are on the left, or above; what was found in them is beside, or below.

use std::error::Error;
use std::path::PathBuf;

use glam::{DVec3, dvec3};
use image::{Rgb, RgbImage, imageops};
use rvachev::fit::{Fit, FitError, FitSettings, Shape, deformed, superellipsoid, supershape};
use rvachev::surface::ParametricSurface;
use rvachev::{
    Background, Camera, CellSize, Gielis, MeshSettings, PointCloud, RenderSettings, Solid, Superellipsoid, Supershape,
    deg,
};

#[allow(dead_code, reason = "panels are of points as well, and as large as each other")]
mod page;

const GREY: [u8; 3] = [140, 140, 138];
const BLUE: [u8; 3] = [112, 150, 186];
const RED: [u8; 3] = [206, 122, 90];
const BACKGROUND: [u8; 3] = [248, 248, 248];

/// Pixels of a panel.
const SIDE: u32 = 260;

/// Colours are rounded to multiples of this: the files are half as large.
const COLOR_STEP: u8 = 8;

/// Random numbers that are the same on every run.
struct Noise(u64);

impl Noise {
    /// From −1 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    /// Nearly normal, of deviation 1.
    fn normal(&mut self) -> DVec3 {
        self.vector() + self.vector() + self.vector()
    }
}

type Points = Vec<DVec3>;

fn pebble() -> Superellipsoid {
    Superellipsoid::new([1.2, 0.8, 2.0], 0.4, 1.3)
}

/// A panel of points.
fn dots(points: &[DVec3], color: [u8; 3], camera: &Camera) -> RgbImage {
    let mut panel = RgbImage::from_pixel(SIDE, SIDE, Rgb(BACKGROUND));
    let lens = camera.intrinsics(SIDE, SIDE);
    let to_camera = camera.pose().inverse();
    let mut seen: Vec<DVec3> = points.iter().map(|p| to_camera.transform_point3(*p)).collect();
    // The nearest last, and darkest.
    seen.sort_by(|a, b| b.z.total_cmp(&a.z));
    let (far, near) = (seen.first().map_or(1.0, |p| p.z), seen.last().map_or(0.0, |p| p.z));
    for p in &seen {
        let Some(at) = lens.project(*p) else { continue };
        let fade = 0.6 * (p.z - near) / (far - near).max(1e-9);
        let faded = color.map(|c| (f64::from(c) * (1.0 - fade) + 248.0 * fade) as u8);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (x, y) = (at.x as i64 + dx, at.y as i64 + dy);
            if (0..i64::from(SIDE)).contains(&x) && (0..i64::from(SIDE)).contains(&y) {
                panel.put_pixel(x as u32, y as u32, Rgb(faded));
            }
        }
    }
    panel
}

/// A panel of a solid.
fn rendered(solid: &Solid, color: [u8; 3], camera: &Camera) -> Result<RgbImage, Box<dyn Error>> {
    let settings = RenderSettings {
        width: SIDE,
        height: SIDE,
        samples: 2,
        ground: false,
        background: Background::Plain(BACKGROUND),
        ..RenderSettings::default()
    };
    let image = solid.paint(color).render(camera, &settings)?;
    Ok(RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let [red, green, blue, _] = image.pixel(x, y).unwrap_or_default();
        Rgb([red, green, blue])
    }))
}

/// Panels by rows.
fn laid(rows: &[Vec<RgbImage>]) -> RgbImage {
    let columns = rows.iter().map(Vec::len).max().unwrap_or_default() as u32;
    let mut picture = RgbImage::from_pixel(columns * SIDE, rows.len() as u32 * SIDE, Rgb(BACKGROUND));
    for (y, row) in (0u32..).zip(rows) {
        for (x, panel) in (0u32..).zip(row) {
            imageops::replace(&mut picture, panel, i64::from(x * SIDE), i64::from(y * SIDE));
        }
    }
    for pixel in picture.pixels_mut() {
        pixel.0 = pixel.0.map(|channel| channel.min(BACKGROUND[0]).next_multiple_of(COLOR_STEP));
    }
    picture
}

fn looking_at(solid: &Solid) -> Result<Camera, Box<dyn Error>> {
    Ok(Camera::framing(&solid.bounds()?))
}

/// 1000 points of a surface with noise, and 1500 that are strewn about it.
fn strewn() -> Result<RgbImage, Box<dyn Error>> {
    let mut noise = Noise(1);
    let sampled = ParametricSurface::of(&pebble())?.sample(1000, 1)?;
    let mut points: Points = sampled.iter().map(|s| s.point + 0.012 * noise.normal()).collect();
    points.extend((0..1500).map(|_| dvec3(2.4, 1.6, 4.0) * noise.vector()));
    let fit = superellipsoid(&PointCloud::new(points.clone())?, &FitSettings::default())?;
    println!("60 % strewn: {}", fit.to_json());
    let camera = Camera::framing(&fit.solid().bounds()?.inflate(0.9));
    let kept = points.iter().zip(fit.weights()).filter(|(_, weight)| **weight > 0.5).map(|(p, _)| *p);
    let kept: Points = kept.collect();
    Ok(laid(&[vec![dots(&points, GREY, &camera), dots(&kept, BLUE, &camera), rendered(&fit.solid(), BLUE, &camera)?]]))
}

/// The three kinds of solids.
fn kinds() -> Result<RgbImage, Box<dyn Error>> {
    let mut noise = Noise(2);
    let star = Supershape::new(Gielis::new(5.0, 2.0, 4.5, 4.5), Gielis::new(4.0, 6.0, 6.0, 6.0));
    let horn = Solid::superellipsoid([0.8, 0.6, 1.8], 0.5, 0.4).taper(-0.6, -0.6, 3.6).bend(0.5, deg(20.0));
    let mesh = horn.mesh(&MeshSettings { cell: CellSize::LongestSide(22), ..MeshSettings::default() })?;
    let clouds: [Points; 3] = [
        ParametricSurface::of(&pebble())?.sample(1000, 1)?.iter().map(|s| s.point).collect(),
        ParametricSurface::of(&star)?.sample(1000, 1)?.iter().map(|s| s.point).collect(),
        mesh.positions().iter().map(|p| p.as_dvec3()).collect(),
    ];
    type Fitter = fn(&PointCloud, &FitSettings) -> Result<Fit, FitError>;
    let fitters: [Fitter; 3] = [superellipsoid, supershape, deformed];
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for (points, fitter) in clouds.into_iter().zip(fitters) {
        let points: Points = points.into_iter().map(|p| p + 0.01 * noise.normal()).collect();
        let fit = fitter(&PointCloud::new(points.clone())?, &FitSettings::default())?;
        println!("{}", fit.to_json());
        let camera = looking_at(&fit.solid())?;
        above.push(dots(&points, GREY, &camera));
        below.push(rendered(&fit.solid(), BLUE, &camera)?);
    }
    Ok(laid(&[above, below]))
}

/// A box that is seen from above: what its depth is, nobody knows.
fn depth() -> Result<RgbImage, Box<dyn Error>> {
    let mut noise = Noise(3);
    let truth = Superellipsoid::new([1.0, 1.4, 0.8], 0.3, 0.8);
    let sampled = ParametricSurface::of(&truth)?.sample(3000, 1)?;
    let seen = sampled.iter().map(|s| s.point).filter(|p| p.z > 0.4 && p.x.abs() < 0.95);
    let points: Points = seen.map(|p| p + 0.01 * noise.normal()).collect();
    let fit = superellipsoid(&PointCloud::new(points.clone())?, &FitSettings::default())?;
    let Shape::Superellipsoid(leaf) = fit.shape() else { return Err("a superellipsoid".into()) };
    println!("from above: {}", fit.to_json());
    let names = ["ln a1", "ln a2", "ln a3"];
    let deviations = names.map(|name| fit.covariance().deviation(name).unwrap_or_default());
    println!("deviations of {names:?}: {deviations:.3?}");
    // Which of its axes is the view's.
    let along = |k: usize| fit.rotation().mul_vec3(DVec3::AXES[k]).z.abs();
    let deep = (0..3).max_by(|i, j| along(*i).total_cmp(&along(*j))).unwrap_or(2);
    // Two deviations deeper, with the same face.
    let mut axes = leaf.semi_axes();
    let grown = (2.0 * deviations[deep]).min(1.0).exp();
    let [e1, e2] = leaf.exponents();
    let lower = axes[deep] * (grown - 1.0);
    axes[deep] *= grown;
    let pose = glam::DAffine3::from_rotation_translation(fit.rotation(), fit.translation() - DVec3::Z * lower);
    let deeper = Solid::superellipsoid(axes, e1, e2).affine(pose);
    let camera = Camera::framing(&deeper.bounds()?).orbit(deg(10.0), deg(-12.0));
    Ok(laid(&[vec![
        dots(&points, GREY, &camera),
        rendered(&fit.solid(), BLUE, &camera)?,
        rendered(&deeper, RED, &camera)?,
    ]]))
}

fn main() -> Result<(), Box<dyn Error>> {
    let docs = std::env::args().nth(1).is_some_and(|argument| argument == "docs");
    let folder = PathBuf::from(if docs { "docs/scans" } else { "target/examples/scans" });
    std::fs::create_dir_all(&folder)?;
    type Scene = (&'static str, fn() -> Result<RgbImage, Box<dyn Error>>);
    let scenes: [Scene; 3] = [("strewn", strewn), ("kinds", kinds), ("depth", depth)];
    for (name, scene) in scenes {
        page::save(&scene()?, &folder.join(name).with_extension("png"))?;
    }
    Ok(())
}
