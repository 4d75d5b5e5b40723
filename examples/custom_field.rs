//! A leaf of one's own: a torus knot, from its formula to a picture and a mesh.
//!
//! ```text
//!      .--.  .--.       a tube that winds about the circle of radius `major` at the distance
//!     /   /\/   \       `minor`, and closes after two rounds and `turns` half turns of its
//!     \__/  \___/       section: with three half turns, a trefoil
//! ```
//!
//! In the half plane of an angle φ about z the tube's section is two discs, opposite one
//! another on the circle of radius `minor` and turned by `turns·φ/2`. Turned back they lie at
//! `(±minor, 0)`, and an absolute value makes one of them:
//!
//! ```text
//!     (u, v) = (ρ − major, z) turned by −turns·φ/2,     f = k (tube − |(|u| − minor, v)|)
//! ```
//!
//! It is continuous where φ jumps from π to −π for any whole number of half turns. k makes it
//! 1-Lipschitz in the neighbourhood of the tube.

use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

use glam::DVec3;
use rvachev::{
    Bounds, Camera, CellSize, Interval, MeshSettings, ParamError, RenderSettings, Solid,
    field::{Dual, Field, Norm, Real},
    program::{Program, Region},
};

/// Lengths in millimetres.
#[derive(Clone, Debug)]
struct TorusKnot {
    major: f64,
    minor: f64,
    tube: f64,
    turns: u32,
}

impl TorusKnot {
    /// How far the tube reaches from the circle.
    fn reach(&self) -> f64 {
        self.minor + self.tube
    }

    /// The formula for a given angle. Every function in a formula is `#[inline(always)]`, so
    /// that it becomes one loop on SIMD lanes.
    #[inline(always)]
    fn at_angle<R: Real>(&self, [x, y, z]: [R; 3], angle: R) -> R {
        let across = x.norm(y, Norm::Euclid) - self.major;
        let (sin, cos) = (angle * (0.5 * f64::from(self.turns))).sin_cos();
        let u = across.mul_add(cos, z * sin);
        let v = z.mul_add(cos, -(across * sin));
        let distance = (u.abs() - self.minor).norm(v, Norm::Euclid);
        (-distance + self.tube) * self.scale()
    }

    /// What keeps the value below the distance.
    fn scale(&self) -> f64 {
        let rise = 0.5 * f64::from(self.turns) * self.reach() / (self.major - self.reach());
        1.0 / (1.0 + rise * rise).sqrt()
    }

    /// At no angle is the value more than that of the torus that the tube winds in: about the axis,
    /// where the angle may be any, this alone tells that there is nothing.
    fn most(&self, [x, y, z]: [Interval; 3]) -> f64 {
        let from_circle = (x.norm(y, Norm::Euclid) - self.major).norm(z, Norm::Euclid);
        ((-from_circle + self.reach()) * self.scale()).hi()
    }

    /// The mean-value form: the value at the centre, and over the box no more than the slopes
    /// add. It shrinks with the square of the box where the formula on intervals shrinks with
    /// its size.
    fn by_slopes(&self, region: [Interval; 3], angle: impl Fn([Dual<Interval>; 3]) -> Dual<Interval>) -> Interval {
        let box_of = Dual::point(region);
        let over = self.at_angle(box_of, angle(box_of));
        let centre = region.map(|side| Interval::point(side.mid()));
        let at = Dual::point(centre);
        let mut range = self.at_angle(at, angle(at)).value();
        for axis in 0..3 {
            range = range + over.gradient()[axis] * (region[axis] - centre[axis]);
        }
        over.value().narrowed_by(range)
    }
}

impl Field for TorusKnot {
    fn name(&self) -> &'static str {
        "torus knot"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        self.at_angle([x, y, z], y.atan2(x))
    }

    fn bounds(&self) -> Bounds {
        let side = self.major + self.reach();
        Bounds::from_center(DVec3::ZERO, DVec3::new(side, side, self.reach()))
    }

    fn check(&self) -> Result<(), ParamError> {
        for (name, length) in [("major", self.major), ("minor", self.minor), ("tube", self.tube)] {
            if !(1e-9..=1e9).contains(&length) {
                return Err(ParamError::new(name, length, "1e-9 to 1e9"));
            }
        }
        if self.reach() >= self.major {
            return Err(ParamError::new("major", self.major, format_args!("above minor + tube, {}", self.reach())));
        }
        Ok(())
    }

    // Not `convex`, and not `exact`: both stay false.

    /// Tighter than the formula on intervals: by slopes, with an angle that does not jump where the
    /// box lies across the negative x axis, and no more than the torus has.
    fn range(&self, region: [Interval; 3]) -> Interval {
        let range = if region[0].hi() < 0.0 && region[1].contains(0.0) {
            self.by_slopes(region, |[x, y, _]| (-y).atan2(-x) + PI)
        } else {
            self.by_slopes(region, |[x, y, _]| y.atan2(x))
        };
        range.narrowed_by(Interval::new(f64::NEG_INFINITY, self.most(region)))
    }
}

/// The same knot without a range of its own.
#[derive(Debug)]
struct Plain(TorusKnot);

impl Field for Plain {
    fn name(&self) -> &'static str {
        "plain torus knot"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        self.0.eval(p)
    }

    fn bounds(&self) -> Bounds {
        self.0.bounds()
    }

    fn check(&self) -> Result<(), ParamError> {
        self.0.check()
    }
}

/// Cells that may hold surface after halving a box so often, and the leaves left in them.
fn walk(program: &Program, bounds: &Bounds, depth: u32) -> (usize, usize) {
    let Region::Surface(program) = program.narrow(bounds) else { return (0, 0) };
    if depth == 0 {
        return (1, program.leaf_count());
    }
    let centre = bounds.center();
    let parts = bounds.corners().map(|corner| Bounds::new(corner.min(centre), corner.max(centre)));
    parts.iter().fold((0, 0), |(cells, leaves), part| {
        let found = walk(&program, part, depth - 1);
        (cells + found.0, leaves + found.1)
    })
}

fn pruning(title: &str, solid: &Solid) -> Result<(), Box<dyn Error>> {
    let bounds = solid.bounds()?;
    let cube = Bounds::from_center(bounds.center(), DVec3::splat(0.51 * bounds.longest_side()));
    let program = solid.surface_program()?;
    let start = Instant::now();
    let (cells, leaves) = walk(&program, &cube, 6);
    println!(
        "  {title}: {} leaves; of 64^3 cells {cells} kept, with {:.2} leaves each, {:.2} s",
        program.leaf_count(),
        leaves as f64 / cells.max(1) as f64,
        start.elapsed().as_secs_f64()
    );
    Ok(())
}

const KNOT: TorusKnot = TorusKnot { major: 10.0, minor: 3.2, tube: 1.5, turns: 3 };

/// The knot joined by R-functions, and under maps: a dish with a ring of pearls carries it.
pub(crate) fn dish() -> Solid {
    let pearls = Solid::sphere(1.0).translate(DVec3::new(15.5, 0.0, -4.6)).repeat_polar(36);
    let plate = Solid::superellipsoid(DVec3::new(16.5, 16.5, 1.6), 0.4, 1.0).translate(DVec3::Z * -6.0);
    (Solid::new(KNOT) | plate) | pearls
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("A trefoil knot as a leaf of one's own, joined and mapped like any other.");

    // A parameter that is wrong is named, like those of built-in leaves.
    let wrong = Solid::new(TorusKnot { major: 4.0, ..KNOT }) | Solid::sphere(1.0);
    if let Err(error) = wrong.bounds() {
        println!("  {error}");
    }

    pruning("by the formula alone", &Solid::new(Plain(KNOT)))?;
    pruning("with its own range", &Solid::new(KNOT))?;

    let ornament = dish();
    pruning("knot, dish and 36 pearls", &ornament)?;

    std::fs::create_dir_all("out")?;
    let bounds = ornament.bounds()?;

    let start = Instant::now();
    let settings = RenderSettings { width: 320, height: 240, samples: 2, ..RenderSettings::default() };
    let camera = Camera::framing(&bounds).fitted(&bounds, f64::from(settings.width) / f64::from(settings.height));
    ornament.render(&camera, &settings)?.save("out/custom_field.png")?;
    let seconds = start.elapsed().as_secs_f64();
    println!("out/custom_field.png: {} x {} pixels, {seconds:.1} s", settings.width, settings.height);

    let start = Instant::now();
    let cells = 100;
    let mesh = ornament.mesh(&MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    mesh.save("out/custom_field.stl")?;
    let seconds = start.elapsed().as_secs_f64();
    println!("out/custom_field.stl: {cells} cells along the longest side, {seconds:.1} s");

    let report = mesh.check();
    println!(
        "{} triangles, {}, {}, volume {:.0} mm3",
        report.triangles,
        if report.is_closed() { "closed" } else { "NOT CLOSED" },
        if report.is_manifold() { "manifold" } else { "NOT MANIFOLD" },
        report.volume
    );
    Ok(())
}
