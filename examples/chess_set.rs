//! A chess set: pieces turned on a lathe, and one that is carved.
//!
//! ```text
//!       +
//!      (_)      o
//!      \_/     \W/     (/)      /^\_
//!       )(      )(      )(     /  _/   |_|_|     o
//!      /  \    /  \    /  \   /__/     |   |    ( )
//!     (____)  (____)  (____) (____)   (____)   (___)
//!      king    queen   bishop knight    rook    pawn
//! ```
//!
//! A turned piece is drawn as half of its section: rectangles, superellipses and circles, x the
//! distance from the axis and y the height, joined in the plane by R-functions and revolved
//! once. The knight's head is an outline that is cut from a lens; its eyes,
//! cheeks and nostrils are mirrored. Lengths are millimetres.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::{DVec2, DVec3};
use rvachev::{
    Camera, CellSize, MeshSettings, Profile, RFunction, RenderSettings, Solid, deg,
    law::{LinearLaw, SmoothStep},
};

/// Edge of a square of the board.
const SQUARE: f64 = 48.0;

/// A disc of the section with rounded edges, from `low` to `high`.
fn disc(radius: f64, low: f64, high: f64) -> Profile {
    let size = DVec2::new(2.0 * radius, high - low);
    Profile::rounded_rectangle(size, 0.45 * size.y).translate([0.0, 0.5 * (low + high)])
}

/// A bulge or ball of the section.
fn bulge(radius: f64, half_height: f64, z: f64) -> Profile {
    Profile::superellipse([radius, half_height], 1.0).translate([0.0, z])
}

/// A waisted part between two heights: a rectangle less an ellipse.
fn waist(radius: f64, narrowest: f64, low: f64, high: f64) -> Profile {
    let (height, middle) = (high - low, 0.5 * (low + high));
    let block = Profile::rectangle([2.0 * radius, height]).translate([0.0, middle]);
    let hollow = Profile::superellipse([radius - narrowest, 0.5 * height], 1.0).translate([radius, middle]);
    block - hollow
}

/// What all pieces stand on: foot, bulge, ring.
fn foot(radius: f64) -> Profile {
    let base = disc(radius, 0.0, 4.5) | bulge(0.88 * radius, 6.5, 4.5);
    base | disc(0.62 * radius, 10.5, 13.0)
}

/// Foot, stem and collar; the collar's upper side is at `height`.
fn pedestal(radius: f64, height: f64) -> Profile {
    let stem = waist(0.72 * radius, 0.33 * radius, 9.0, height + 6.0);
    let below = Profile::rectangle([4.0 * radius, height]).translate([0.0, 0.5 * height]);
    let collar = disc(0.68 * radius, height - 2.4, height) | disc(0.5 * radius, height - 4.6, height - 2.0);
    foot(radius) | (stem & below) | collar
}

pub(crate) fn pawn() -> Solid {
    (pedestal(14.0, 30.0) | bulge(8.2, 8.2, 36.5)).revolve()
}

pub(crate) fn rook() -> Solid {
    let cup = waist(13.0, 10.2, 36.0, 53.0) | disc(11.8, 45.0, 53.0);
    let well = Profile::rectangle([16.6, 12.0]).translate([0.0, 54.0]);
    let tower = ((pedestal(16.0, 38.0) | cup) - well).revolve();
    let gap = Solid::cuboid([10.0, 3.6, 8.0]).translate([11.0, 0.0, 53.0]);
    tower - gap.repeat_polar(6)
}

pub(crate) fn bishop() -> Solid {
    // The arc of a circle beyond the axis makes a pointed arch.
    let mitre = Profile::circle(14.5).translate([-5.5, 58.0]);
    let turned = pedestal(16.0, 48.0) | mitre | bulge(2.7, 2.7, 73.0);
    let cut = Solid::cuboid([16.0, 30.0, 1.8]).rotate_y(deg(-58.0)).translate([9.5, 0.0, 64.5]);
    turned.revolve() - cut
}

pub(crate) fn queen() -> Solid {
    let crown = waist(13.0, 7.2, 40.0, 74.0) & Profile::rectangle([60.0, 17.0]).translate([0.0, 63.5]);
    let well = Profile::superellipse([9.6, 5.0], 1.0).translate([0.0, 73.0]);
    let turned = (pedestal(18.0, 56.0) | crown) - well;
    let dome = (bulge(8.2, 5.0, 70.0) | bulge(3.1, 3.1, 77.0)).revolve();
    let scallop = Solid::capsule(2.6, 20.0).rotate_y(deg(90.0)).translate([11.5, 0.0, 73.2]);
    (turned.revolve() - scallop.repeat_polar(9)) | dome
}

pub(crate) fn king() -> Solid {
    let crown = waist(12.0, 7.6, 46.0, 82.0) & Profile::rectangle([60.0, 18.0]).translate([0.0, 70.0]);
    let lid = disc(10.6, 78.0, 80.6) | bulge(8.6, 5.4, 80.0);
    let turned = pedestal(19.0, 62.0) | crown | lid;

    // Arms of a cross that widen outwards: superellipsoids tapered from the middle.
    let arm = Solid::superellipsoid([2.2, 1.6, 3.2], 0.2, 0.2).taper(0.42, 0.0, 6.4).translate([0.0, 0.0, 2.9]);
    let quarters = (0..4).map(|i| arm.rotate_y(deg(90.0 * f64::from(i))));
    let cross = Solid::union_all(quarters, RFunction::default()).translate([0.0, 0.0, 90.0]);
    turned.revolve() | cross
}

/// The contour with its corners cut, again and again: each edge keeps its middle half.
fn rounded(mut contour: Vec<DVec2>) -> Vec<DVec2> {
    for _ in 0..3 {
        let next = contour.iter().cycle().skip(1);
        contour = contour.iter().zip(next).flat_map(|(&a, &b)| [a.lerp(b, 0.25), a.lerp(b, 0.75)]).collect();
    }
    contour
}

pub(crate) fn knight() -> Solid {
    // From the chest up the throat, round jaw and muzzle, over the forehead and the ear, and
    // down the mane.
    let contour = [
        (10.0, -4.0),
        (12.5, 5.0),
        (10.0, 12.0),
        (4.5, 17.0),
        (2.5, 22.0),
        (6.0, 21.0),
        (11.0, 18.5),
        (15.5, 14.5),
        (20.0, 15.5),
        (21.5, 21.0),
        (18.0, 26.0),
        (12.5, 31.0),
        (10.5, 35.0),
        (8.2, 39.0),
        (6.6, 47.0),
        (3.0, 41.0),
        (-2.0, 40.5),
        (-8.0, 36.5),
        (-12.0, 29.0),
        (-12.8, 19.0),
        (-10.5, 9.0),
        (-12.0, -4.0),
    ];
    let contour = rounded(contour.map(DVec2::from).to_vec());
    let locks = [(-3.6, 39.8), (-8.4, 35.6), (-11.3, 30.0), (-12.2, 24.0), (-12.0, 17.8), (-11.3, 11.6)];
    let locks = locks.map(|at| Profile::circle(1.3).translate(at));
    let outline = Profile::polygon(contour).difference_all(locks, RFunction::MIN_MAX);
    let column = outline.column().rotate_x(deg(90.0));

    // A lens across it: thinner towards the muzzle, and towards the top.
    let thinner = SmoothStep { from: (0.0, 1.0), to: (36.0, 0.66) };
    let lens = Solid::superellipsoid([27.0, 11.0, 90.0], 1.0, 1.0).translate([-4.0, 0.0, 0.0]);
    let lens = lens.taper_by(LinearLaw { at_zero: 1.0, slope: 0.0 }, thinner);
    let head = column.smooth_intersection(lens, 6.0);

    // One side's features, and their mirror images.
    let cheek = Solid::ellipsoid([6.0, 2.6, 5.6]).translate([6.2, 5.4, 25.6]).mirrored_y();
    let eye = Solid::ellipsoid([2.0, 1.5, 1.4]).rotate_y(deg(35.0)).translate([10.0, 5.6, 31.2]).mirrored_y();
    let nostril = Solid::sphere(1.3).translate([18.6, 4.6, 21.4]).mirrored_y();
    let mouth = Solid::cuboid([9.0, 30.0, 1.1]).rotate_y(deg(32.0)).translate([18.6, 0.0, 17.6]);
    let parting = Solid::superellipsoid([30.0, 2.6, 8.5], 2.0, 0.05).translate([4.0, 0.0, 48.0]);

    let carved = (head.smooth_union(cheek, 2.5) | eye) - nostril - mouth - parting;
    let block = Solid::cuboid([60.0, 30.0, 60.0]).translate([0.0, 0.0, 30.0]);
    let base = foot(17.0) | disc(14.5, 9.5, 12.5);
    (carved & block).translate([0.0, 0.0, 12.0]) | base.revolve()
}

/// A row of six squares, every second one sunk a little.
pub(crate) fn board() -> Solid {
    let plank = Solid::rounded_cuboid([6.0 * SQUARE + 12.0, SQUARE + 12.0, 8.0], 2.0).translate([0.0, 0.0, -4.0]);
    let sunk = Solid::cuboid([SQUARE, SQUARE, 2.0]).translate([-1.5 * SQUARE, 0.0, 0.0]);
    plank - sunk.repeat_linear(3, [2.0 * SQUARE, 0.0, 0.0])
}

fn wrote(path: &Path, start: Instant, facts: &str) -> Result<(), Box<dyn Error>> {
    let kilobytes = fs::metadata(path)?.len() / 1000;
    println!("{}: {kilobytes} kB, {:.2} s, {facts}", path.display(), start.elapsed().as_secs_f64());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(|| PathBuf::from("target/examples"), PathBuf::from);
    fs::create_dir_all(&folder)?;
    println!("A chess set: sections joined by R-functions and revolved, and a carved knight.");
    let pieces = [
        ("king", king()),
        ("queen", queen()),
        ("bishop", bishop()),
        ("knight", knight()),
        ("rook", rook()),
        ("pawn", pawn()),
    ];

    for (name, piece) in &pieces {
        let start = Instant::now();
        let mesh = piece.mesh(&MeshSettings { cell: CellSize::Length(0.9), ..MeshSettings::default() })?;
        for warning in mesh.warnings() {
            println!("warning: {warning}");
        }
        let path = folder.join(format!("chess_{name}.stl"));
        mesh.save(&path)?;
        let report = mesh.check();
        let sound = if report.is_closed() && report.is_manifold() { "closed, manifold" } else { "NOT SOUND" };
        let (triangles, volume, size) = (report.triangles, report.volume / 1000.0, report.bounds.size());
        let facts = format!(
            "{triangles} triangles, {sound}, {volume:.1} cm3, {:.1} x {:.1} x {:.1} mm",
            size.x, size.y, size.z
        );
        wrote(&path, start, &facts)?;
    }

    let start = Instant::now();
    let row = pieces.iter().zip(0i32..).map(|((name, piece), i)| {
        let square = f64::from(i) - 2.5;
        piece.translate([square * SQUARE, 0.0, if i % 2 == 1 { -1.0 } else { 0.0 }]).named(name)
    });
    let scene = Solid::union_all(row, RFunction::MIN_MAX) | board();
    let settings = RenderSettings {
        width: 640,
        height: 270,
        samples: 2,
        paint: [226, 205, 166].into(),
        ..RenderSettings::default()
    };
    let view = Camera::perspective([50.0, -300.0, 105.0], DVec3::ZERO, DVec3::Z, deg(24.0));
    let camera = view.fitted(&scene.bounds()?.inflate(-8.0), f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join("chess_set.png");
    scene.render(&camera, &settings)?.save(&path)?;
    wrote(&path, start, &format!("{} x {} pixels", settings.width, settings.height))
}
