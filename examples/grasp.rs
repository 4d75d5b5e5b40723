//! What is on the table? Range images with noise, by rays and by a depth buffer, split into
//! objects, each fitted by a superellipsoid and drawn over the image.
//!
//! ```text
//!     camera *                     1. depths to points
//!             \    .-.   __        2. the plane that most points are of is the table
//!              \  (   ) |  |       3. what is above it falls into parts that do not touch
//!     __________\__'-'__|__|__     4. each part is seen from one side: fit::superellipsoid
//! ```
//!
//! `cargo run --release --example grasp -- folder` prints what was found beside the truth, and
//! writes `grasp.png`: the range image of either kind, the nearer the lighter, with the solids
//! found over it.

use std::collections::{HashMap, HashSet};
use std::error::Error;

use glam::{DVec2, DVec3, IVec3};
use rvachev::fit::{FitSettings, Shape, superellipsoid};
use rvachev::range_image::{Coordinates, Noise, RangeImage};
use rvachev::raster::{Buffers, ClosedMesh, Facing, RasterView};
use rvachev::{Bounds, Camera, CellSize, Image, MeshSettings, PointCloud, Solid, Superellipsoid, deg};

/// Pixels of an image.
const WIDTH: u32 = 320;
const HEIGHT: u32 = 240;

/// Semi-axes, exponents, place on the table and turn about z, in centimetres and degrees.
type Object = ([f64; 3], [f64; 2], [f64; 2], f64);

const OBJECTS: [Object; 6] = [
    ([4.0, 4.0, 5.0], [0.1, 1.0], [-14.0, 8.0], 0.0),
    ([5.0, 3.0, 2.5], [0.2, 0.2], [0.0, 10.0], 30.0),
    ([3.5, 3.5, 3.5], [1.0, 1.0], [13.0, 8.0], 0.0),
    ([6.0, 2.5, 3.0], [0.5, 0.9], [-13.0, -7.0], 70.0),
    ([3.0, 4.5, 4.0], [1.2, 0.3], [1.0, -6.0], 15.0),
    ([4.0, 3.0, 6.0], [0.3, 1.6], [14.0, -6.0], 50.0),
];

fn object(index: usize) -> Solid {
    let (semi_axes, [e1, e2], [x, y], turn) = OBJECTS[index];
    Solid::superellipsoid(semi_axes, e1, e2).rotate_z(deg(turn)).translate([x, y, semi_axes[2]])
}

/// The plane that most of the points are of: a unit normal and an offset.
fn table(points: &[DVec3], within: f64) -> (DVec3, f64) {
    let mut best = (0, DVec3::Z, 0.0);
    let mut at = 1usize;
    let mut next = || {
        at = at.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        points[(at >> 33) % points.len()]
    };
    for _ in 0..200 {
        let (a, b, c) = (next(), next(), next());
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        let offset = normal.dot(a);
        let count = points.iter().filter(|p| (normal.dot(**p) - offset).abs() < within).count();
        if count > best.0 {
            best = (count, normal, offset);
        }
    }
    // Three points with noise are no more than a start: all that are near it are the plane.
    let (mut normal, mut offset) = (best.1, best.2);
    for _ in 0..4 {
        let near: Vec<DVec3> = points.iter().copied().filter(|p| (normal.dot(*p) - offset).abs() < within).collect();
        let mean = near.iter().sum::<DVec3>() / near.len() as f64;
        // Heights over the plane as a linear function across it.
        let (u, v) = normal.any_orthonormal_pair();
        let (mut uu, mut uv, mut vv, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for p in &near {
            let at = DVec3::new(u.dot(*p - mean), v.dot(*p - mean), normal.dot(*p - mean));
            (uu, uv, vv) = (uu + at.x * at.x, uv + at.x * at.y, vv + at.y * at.y);
            right += at.z * at.truncate();
        }
        let slope = DVec2::new(right.x * vv - right.y * uv, right.y * uu - right.x * uv) / (uu * vv - uv * uv);
        normal = (normal - slope.x * u - slope.y * v).normalize();
        offset = normal.dot(mean);
    }
    (normal, offset)
}

/// Points that hang together: those in cells of this size that touch.
fn parts(points: &[DVec3], cell: f64) -> Vec<Vec<DVec3>> {
    let home = |p: &DVec3| (*p / cell).floor().as_ivec3();
    let mut cells: HashMap<IVec3, Vec<DVec3>> = HashMap::new();
    for p in points {
        cells.entry(home(p)).or_default().push(*p);
    }
    let mut seen = HashSet::new();
    let mut parts = Vec::new();
    for p in points {
        let mut part = Vec::new();
        let mut pending = vec![home(p)];
        while let Some(at) = pending.pop() {
            let Some(inside) = cells.get(&at).filter(|_| seen.insert(at)) else { continue };
            part.extend_from_slice(inside);
            for i in 0..27 {
                pending.push(at + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1);
            }
        }
        if part.len() > 100 {
            parts.push(part);
        }
    }
    parts
}

/// The range image of the scene by one ray a pixel.
fn by_rays(scene: &Solid, camera: &Camera) -> Result<RangeImage, Box<dyn Error>> {
    Ok(scene.layers(camera, WIDTH, HEIGHT)?.range_image())
}

/// The same by drawing its mesh into a depth buffer.
fn by_depth_buffer(scene: &Solid, camera: &Camera) -> Result<RangeImage, Box<dyn Error>> {
    let mesh = scene.mesh(&MeshSettings { cell: CellSize::Length(0.5), ..MeshSettings::default() })?;
    let view = RasterView::new(camera, WIDTH, HEIGHT)?;
    let mut buffers = Buffers::new(&view);
    buffers.draw(&view.layers(ClosedMesh::new(&mesh)?), 0, Facing::Front)?;
    Ok(buffers.range_image()?)
}

/// Fits what stands on the plane, and prints it beside the truth.
fn found(image: &RangeImage) -> Result<Vec<Solid>, Box<dyn Error>> {
    let cloud = image.points(Coordinates::World)?;
    let points = cloud.positions();
    let (normal, offset) = table(points, 0.2);
    let above: Vec<DVec3> = points.iter().copied().filter(|p| (normal.dot(*p) - offset).abs() > 0.25).collect();
    println!("{} points, {} above the table", points.len(), above.len());
    let mut solids = Vec::new();
    for part in parts(&above, 0.9) {
        let fit = superellipsoid(&PointCloud::new(part)?, &FitSettings::default())?;
        let Shape::Superellipsoid(leaf) = fit.shape() else { continue };
        let away = |i: &usize| {
            let ([_, _, z], _, [x, y], _) = OBJECTS[*i];
            DVec3::new(x, y, z).distance(fit.translation())
        };
        let nearest = (0..OBJECTS.len()).min_by(|i, j| away(i).total_cmp(&away(j))).unwrap_or(0);
        let (semi_axes, [e1, e2], ..) = OBJECTS[nearest];
        let truth = Superellipsoid::new(semi_axes, e1, e2);
        println!(
            "object {nearest}: centre off by {:.2}, volume {:.1} of {:.1}, semi-axes {:.2} (true {semi_axes:?}), \
             exponents {:.2?} (true {:?}), noise {:.3}",
            away(&nearest),
            volume(leaf),
            volume(&truth),
            leaf.semi_axes(),
            leaf.exponents(),
            [e1, e2],
            fit.noise()
        );
        solids.push(fit.solid());
    }
    Ok(solids)
}

/// Colours of solids over an image.
const COLORS: [[f64; 3]; 6] = [
    [230.0, 130.0, 30.0],
    [60.0, 140.0, 220.0],
    [80.0, 180.0, 80.0],
    [200.0, 70.0, 150.0],
    [210.0, 190.0, 40.0],
    [60.0, 190.0, 190.0],
];

/// The image, the nearer the lighter, with solids over it: filled lightly, their outlines in full.
fn drawn(image: &RangeImage, solids: &[Solid], camera: &Camera) -> Result<Vec<[u8; 4]>, Box<dyn Error>> {
    let (near, far) = image.depth().range().ok_or("the image is empty")?;
    let mut pixels: Vec<[f64; 3]> =
        image.depth().to_grey8(near, far).pixels().iter().map(|grey| [0.8 * f64::from(*grey); 3]).collect();
    for (solid, color) in solids.iter().zip(COLORS.iter().cycle()) {
        let depths = solid.layers(camera, WIDTH, HEIGHT)?.range_image();
        let is_seen = |x: i64, y: i64| {
            let inside = (0..i64::from(WIDTH)).contains(&x) && (0..i64::from(HEIGHT)).contains(&y);
            inside && depths.depth().pixel(x as u32, y as u32).is_some_and(f64::is_finite)
        };
        for (i, pixel) in (0i64..).zip(&mut pixels) {
            let (x, y) = (i % i64::from(WIDTH), i / i64::from(WIDTH));
            if is_seen(x, y) {
                let is_inner = [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().all(|(dx, dy)| is_seen(x + dx, y + dy));
                let share = if is_inner { 0.35 } else { 1.0 };
                *pixel = std::array::from_fn(|k| (1.0 - share) * pixel[k] + share * color[k]);
            }
        }
    }
    Ok(pixels.into_iter().map(|[r, g, b]| [r as u8, g as u8, b as u8, 255]).collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "target/examples".into());
    std::fs::create_dir_all(&folder)?;
    let board = Solid::cuboid([60.0, 46.0, 1.0]).translate([0.0, 0.0, -0.5]);
    let scene = board | Solid::union_all((0..OBJECTS.len()).map(object), rvachev::RFunction::MIN_MAX);
    let view = Bounds::new(DVec3::new(-22.0, -16.0, -1.0), DVec3::new(22.0, 16.0, 12.0));
    let camera = Camera::framing(&view).orbit(deg(20.0), deg(25.0));
    let mut sides = Vec::new();
    for (name, image) in [("rays", by_rays(&scene, &camera)?), ("depth buffer", by_depth_buffer(&scene, &camera)?)] {
        println!("by {name}:");
        let noisy = image.with_noise(&Noise { deviation: 0.05, missing: 0.05, seed: 3 })?;
        sides.push(drawn(&noisy, &found(&noisy)?, &camera)?);
    }
    let rows = sides[0].chunks(WIDTH as usize).zip(sides[1].chunks(WIDTH as usize));
    let picture = Image::new(2 * WIDTH, HEIGHT, rows.flat_map(|(left, right)| [left, right].concat()).collect())?;
    let path = std::path::Path::new(&folder).join("grasp.png");
    picture.save(&path)?;
    println!("{}", path.display());
    Ok(())
}

/// By counting points of a grid in its box.
fn volume(leaf: &Superellipsoid) -> f64 {
    let steps = 40;
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
    let inside = (0..steps * steps * steps)
        .filter(|i| {
            let p = DVec3::new(at(i % steps), at(i / steps % steps), at(i / steps / steps));
            leaf.gauge(p * leaf.semi_axes()) <= 1.0
        })
        .count();
    8.0 * leaf.semi_axes().element_product() * inside as f64 / f64::from(steps * steps * steps)
}
