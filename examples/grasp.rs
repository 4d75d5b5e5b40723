//! What is on the table? A range image with noise, split into objects, each fitted by a
//! superellipsoid.
//!
//! ```text
//!     camera *                     1. depths to points
//!             \    .-.   __        2. the plane that most points are of is the table
//!              \  (   ) |  |       3. what is above it falls into parts that do not touch
//!     __________\__'-'__|__|__     4. each part is seen from one side: fit::superellipsoid
//! ```
//!
//! `cargo run --release --example grasp -- folder` writes pictures of the scene and of what was
//! found.

use std::collections::{HashMap, HashSet};
use std::error::Error;

use glam::{DVec3, IVec3};
use rvachev::fit::{FitSettings, Shape, superellipsoid};
use rvachev::range_image::{Coordinates, Noise};
use rvachev::{Bounds, Camera, PointCloud, RenderSettings, Solid, Superellipsoid, deg};

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
    (best.1, best.2)
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

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "target/examples".into());
    std::fs::create_dir_all(&folder)?;
    let board = Solid::cuboid([60.0, 46.0, 1.0]).translate([0.0, 0.0, -0.5]).paint([180, 170, 150]);
    let objects = Solid::union_all((0..OBJECTS.len()).map(object), rvachev::RFunction::MIN_MAX);
    let scene = board.clone() | objects.paint([70, 110, 170]);
    let view = Bounds::new(DVec3::new(-22.0, -16.0, -1.0), DVec3::new(22.0, 16.0, 12.0));
    let camera = Camera::framing(&view).orbit(deg(20.0), deg(25.0));
    let noise = Noise { deviation: 0.05, missing: 0.05, seed: 3 };
    let cloud = scene.layers(&camera, 320, 240)?.range_image().with_noise(&noise)?.points(Coordinates::World)?;
    let points = cloud.positions();
    let (normal, offset) = table(points, 0.2);
    let above: Vec<DVec3> = points.iter().copied().filter(|p| (normal.dot(*p) - offset).abs() > 0.25).collect();
    println!("{} points, {} above the table", points.len(), above.len());

    let mut found = board;
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
        found |= fit.solid().paint([220, 140, 40]);
    }
    let settings = RenderSettings { width: 640, height: 480, ..RenderSettings::default() };
    for (name, solid) in [("grasp_scene.png", &scene), ("grasp_found.png", &found)] {
        let path = std::path::Path::new(&folder).join(name);
        solid.render(&camera, &settings)?.save(&path)?;
        println!("{}", path.display());
    }
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
