//! A pair of spur gears: teeth of arcs joined by R-functions, and their clearance in mesh.
//!
//! ```text
//!            tip circle        a tooth is what two discs have in common. Each flank is the
//!         .-'''-.              arc that touches the involute at the pitch circle and has its
//!        /       \             curvature there (Grant's odontograph): with the pitch radius
//!   ----(---------)----        r and the pressure angle α its centre lies on the base circle,
//!        \  | |  /   pitch     radius r·cos α, and its radius is r·sin α
//!       --'-----'-- root
//! ```
//!
//! Whether the gears run free is asked of their fields. Outside, the values of both are minus
//! the distances to them; where the lesser is largest, in the middle of the narrowest gap, it
//! is minus half the gap. That is the R-conjunction min: the value of their intersection.
//!
//! Lengths are millimetres; angles are radians.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::{
    Bounds, Camera, CellSize, MeshSettings, Profile, RFunction, RenderSettings, Solid, deg, program::Region, rad,
};

/// Pitch diameter over the number of teeth.
const MODULE: f64 = 2.5;
const PRESSURE_ANGLE: f64 = 20.0 * PI / 180.0;

/// By how much a tooth is thinner than the gap it runs in.
const BACKLASH: f64 = 0.2;

/// Length of the teeth.
const WIDTH: f64 = 14.0;

struct Gear {
    teeth: u32,
    bore: f64,
    hub: f64,
    /// Number and radius of the lightening holes.
    holes: Option<(u32, f64)>,
}

impl Gear {
    fn pitch_radius(&self) -> f64 {
        0.5 * MODULE * f64::from(self.teeth)
    }

    fn tip_radius(&self) -> f64 {
        self.pitch_radius() + MODULE
    }

    fn root_radius(&self) -> f64 {
        self.pitch_radius() - 1.25 * MODULE
    }

    /// All teeth on their root disc, as a column along z. The first tooth points along x.
    fn toothing(&self) -> Solid {
        let pitch_radius = self.pitch_radius();
        // A tooth and a gap share the pitch; seen from the axis half a tooth is this wide.
        let half_tooth = (0.25 * PI * MODULE - 0.25 * BACKLASH) / pitch_radius;
        let base_radius = pitch_radius * PRESSURE_ANGLE.cos();
        let flank = Profile::circle(pitch_radius * PRESSURE_ANGLE.sin()).translate([base_radius, 0.0]);
        let (right, left) =
            (flank.rotate(rad(PRESSURE_ANGLE - half_tooth)), flank.rotate(rad(half_tooth - PRESSURE_ANGLE)));
        // Joins by min and max keep the arcs' true distances.
        let tooth = right.intersection(&left, RFunction::MIN_MAX).column().named("tooth");
        let tips = Profile::circle(self.tip_radius()).column();
        let root = Profile::circle(self.root_radius()).column().named("root");
        tooth.repeat_polar(self.teeth).intersection(tips, RFunction::MIN_MAX).union(root, RFunction::MIN_MAX)
    }

    /// What the gear is turned to before its teeth are cut: a rim with its corners bevelled, a
    /// thin web, a hub that stands out on top.
    fn blank(&self) -> Solid {
        let (tip, rim, hub) = (self.tip_radius(), self.root_radius() - 1.6 * MODULE, self.hub);
        let (half, web, top) = (0.5 * WIDTH, -0.2 * WIDTH, 0.5 * WIDTH + 7.0);
        // Radius and height, counter-clockwise from below.
        let outline = [
            [-1.0, -half],
            [tip - 1.0, -half],
            [tip, 1.0 - half],
            [tip, half - 1.0],
            [tip - 1.0, half],
            [rim, half],
            [rim - 1.5, web],
            [hub + 1.5, web],
            [hub, top - 1.0],
            [hub - 1.0, top],
            [-1.0, top],
        ];
        Profile::polygon(outline).revolve().named("blank")
    }

    fn solid(&self) -> Solid {
        let bore = Solid::cylinder(self.bore, 60.0).named("bore");
        // A quarter of the shaft wide, and half as deep in the hub.
        let key = Solid::cuboid([0.5 * self.bore, 0.5 * self.bore, 60.0]);
        let keyway = key.translate([0.0, self.bore, 0.0]).named("keyway");
        let mut gear = (self.toothing() & self.blank()) - bore - keyway;
        if let Some((count, radius)) = self.holes {
            let middle = 0.5 * (self.root_radius() - 1.6 * MODULE + self.hub);
            let hole = Solid::cylinder(radius, 60.0).translate([middle, 0.0, 0.0]);
            gear -= hole.repeat_polar(count).named("lightening holes");
        }
        gear
    }
}

/// Both in mesh, the first one turned by `angle`: its tooth along x runs in a gap of the other.
fn in_mesh(gears: [&Gear; 2], parts: [Solid; 2], angle: f64) -> [Solid; 2] {
    let [pinion, wheel] = gears;
    let half_pitch = PI / f64::from(wheel.teeth);
    // The wheel has a tooth opposite to its first one if their number is even.
    let phase = if wheel.teeth % 2 == 0 { half_pitch } else { 0.0 };
    let ratio = f64::from(pinion.teeth) / f64::from(wheel.teeth);
    let distance = pinion.pitch_radius() + wheel.pitch_radius();
    [parts[0].rotate_z(rad(angle)), parts[1].rotate_z(rad(phase - ratio * angle)).translate([distance, 0.0, 0.0])]
}

fn gears() -> [Gear; 2] {
    let pinion = Gear { teeth: 18, bore: 6.0, hub: 10.5, holes: None };
    let wheel = Gear { teeth: 30, bore: 8.0, hub: 14.0, holes: Some((6, 4.6)) };
    [pinion, wheel]
}

/// The pinion and the wheel in mesh.
pub(crate) fn pair() -> Solid {
    let [pinion, wheel] = gears();
    let [first, second] = in_mesh([&pinion, &wheel], [pinion.solid(), wheel.solid()], 0.0);
    first | second
}

/// The narrowest gap between the teeth over a whole pitch, by sampling the plane where they
/// meet, and whether intervals prove that they nowhere have a point in common.
fn clearance(pinion: &Gear, wheel: &Gear) -> Result<(f64, bool), Box<dyn Error>> {
    const POSITIONS: u32 = 12;
    const STEPS: u32 = 160;
    let (centre, half) = (pinion.pitch_radius(), DVec3::new(1.2 * MODULE, 6.0 * MODULE, 0.0));
    let zone = Bounds::from_center([centre, 0.0, 0.0], half);
    let (mut deepest, mut free) = (f64::NEG_INFINITY, true);
    for position in 0..POSITIONS {
        let angle = TAU / f64::from(pinion.teeth) * f64::from(position) / f64::from(POSITIONS);
        let [a, b] = in_mesh([pinion, wheel], [pinion.toothing(), wheel.toothing()], angle);
        let common = a.intersection(b, RFunction::MIN_MAX);
        let at =
            |i: u32, j: u32| zone.min + zone.size() * DVec3::new(f64::from(i), f64::from(j), 0.0) / f64::from(STEPS);
        let points: Vec<DVec3> = (0..=STEPS).flat_map(|j| (0..=STEPS).map(move |i| at(i, j))).collect();
        deepest = common.values(&points)?.into_iter().fold(deepest, f64::max);
        free &= is_empty(&common, &zone, 24)?;
    }
    Ok((-2.0 * deepest, free))
}

/// Whether nothing of the solid is in the box: by intervals over the box, or over its halves.
fn is_empty(solid: &Solid, zone: &Bounds, halvings: u32) -> Result<bool, Box<dyn Error>> {
    match solid.region(zone)? {
        Region::Outside => Ok(true),
        Region::Inside => Ok(false),
        Region::Surface(_) if halvings == 0 => Ok(false),
        Region::Surface(_) => {
            let (size, mut middle) = (zone.size(), [zone.max, zone.min]);
            let axis = if size.x > size.y { 0 } else { 1 };
            middle[0][axis] -= 0.5 * size[axis];
            middle[1][axis] += 0.5 * size[axis];
            let halves = [Bounds::new(zone.min, middle[0]), Bounds::new(middle[1], zone.max)];
            Ok(is_empty(solid, &halves[0], halvings - 1)? && is_empty(solid, &halves[1], halvings - 1)?)
        }
    }
}

fn written(path: &Path, start: Instant) -> Result<(), Box<dyn Error>> {
    let (bytes, seconds) = (std::fs::metadata(path)?.len(), start.elapsed().as_secs_f64());
    println!("{}: {} kB, {seconds:.1} s", path.display(), bytes.div_ceil(1000));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;

    let [pinion, wheel] = gears();
    println!("A pair of spur gears, module {MODULE} mm, {} and {} teeth.", pinion.teeth, wheel.teeth);
    let (gap, free) = clearance(&pinion, &wheel)?;
    let proof = if free { "proved by intervals" } else { "NOT PROVED" };
    println!("  clearance in 12 positions over a pitch: {gap:.3} mm; that no teeth interpenetrate in them is {proof}");

    let pair = pair();
    let bounds = pair.bounds()?;
    println!("  {:.1} x {:.1} x {:.1} mm", bounds.size().x, bounds.size().y, bounds.size().z);

    let start = Instant::now();
    let settings =
        RenderSettings { width: 800, height: 520, samples: 2, paint: [190, 154, 84].into(), ..Default::default() };
    let eye = DVec3::new(0.5, -1.7, 2.4);
    let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, deg(28.0));
    // Gears leave the corners of their box empty.
    let frame = Bounds::from_center(bounds.center(), 0.84 * bounds.half_extents());
    let camera = camera.fitted(&frame, f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join("gear_pair.png");
    pair.render(&camera, &settings)?.save(&path)?;
    written(&path, start)?;

    // One mesh each: the cells are wider than the gap between the teeth.
    for (name, gear) in [("pinion", &pinion), ("wheel", &wheel)] {
        let start = Instant::now();
        let mesh = gear.solid().mesh(&MeshSettings { cell: CellSize::Length(0.6), ..MeshSettings::default() })?;
        for warning in mesh.warnings() {
            println!("warning: {warning}");
        }
        let path = folder.join(format!("gear_pair_{name}.stl"));
        mesh.save(&path)?;
        written(&path, start)?;
        let report = mesh.check();
        println!(
            "  {} triangles, {}, {}, volume {:.0} mm3",
            report.triangles,
            if report.is_closed() { "closed" } else { "NOT CLOSED" },
            if report.is_manifold() { "manifold" } else { "NOT MANIFOLD" },
            report.volume
        );
    }
    Ok(())
}
