//! A row per leaf, profile, join, blend and map: nanoseconds a point of the field program, as
//! it is (not narrowed), over the solid's box.

use glam::{DVec2, DVec3};
use rvachev::{
    Blend, Bounds, Caps, Capsule, Circle, Cone, Cuboid, Cylinder, Ellipsoid, Extrusion, GeneralisedSuperquadric,
    Gielis, Grading, HalfSpace, Helix, Interval, MinimalSurface, NetworkLattice, ParamError, Polygon, Prism, Profile,
    Pyramid, RFunction, Radius, Rectangle, RegularPolygon, RoundedCuboid, SheetLattice, Slab, Solid, Sphere,
    Superellipse, Superellipsoid, Superhyperboloid, Superpolygon, Supershape, Supertoroid, Torus, Turns, Wedge, deg,
    field::{Field, Real},
    law::{LawTable, SineWave, SmoothStep},
    rad,
};

use super::{Contestant, Points, program, race};

/// Points of a row: whole chunks, and so few that runs of the slowest rows are seldom
/// interrupted.
const COUNT: usize = 1024;

/// What a point of M1, the unit of the table, takes on the machine that limits are stated for.
const UNIT: f64 = 1.54;

/// What a leaf may take on that machine: common ones, and supershapes.
const COMMON: f64 = 6.0;
const SUPERSHAPE: f64 = 12.0;

/// What is evaluated, and where.
pub struct Row {
    pub name: &'static str,
    pub solid: Solid,
    /// Nanoseconds a point that it may take on the machine that limits are stated for.
    limit: Option<f64>,
    /// Where points are, if not in the solid's box.
    region: Option<Bounds>,
}

fn row(name: &'static str, solid: impl Into<Solid>) -> Row {
    Row { name, solid: solid.into(), limit: None, region: None }
}

impl Row {
    fn limit(self, limit: f64) -> Row {
        Row { limit: Some(limit), ..self }
    }

    fn within(self, region: Bounds) -> Row {
        Row { region: Some(region), ..self }
    }

    /// The solid's box, cut where it is infinite.
    fn region(&self) -> Bounds {
        let own = self.region.unwrap_or_else(|| self.solid.bounds().expect("the solid is valid"));
        own.intersection(&Bounds::new(DVec3::splat(-10.0), DVec3::splat(10.0)))
    }
}

/// A title and its rows.
pub type Section = (&'static str, Vec<Row>);

/// Prints the rows whose name contains one of `words`, or all if there are none.
pub fn print(words: &[String]) {
    let wanted = |row: &Row| words.is_empty() || words.iter().any(|word| row.name.contains(&**word));
    let sections: Vec<Section> = [leaves(), profiles(), sweeps(), joins(), lengths(), maps()]
        .into_iter()
        .map(|(title, rows)| (title, rows.into_iter().filter(&wanted).collect::<Vec<Row>>()))
        .filter(|(_, rows)| !rows.is_empty())
        .collect();
    if sections.is_empty() {
        return;
    }
    let unit = row("M1", super::models::m1().solid);
    let rows: Vec<&Row> = std::iter::once(&unit).chain(sections.iter().flat_map(|(_, rows)| rows)).collect();
    let points: Vec<Points> = rows.iter().map(|row| Points::random(COUNT, row.region().half_extents())).collect();
    let mut contestants: Vec<Contestant<'_>> = Vec::new();
    for (row, points) in rows.iter().zip(&points) {
        let field = row.solid.field_program().unwrap_or_else(|error| panic!("{}: {error}", row.name));
        contestants.push(program(row.name, &field, &row.region(), points));
    }
    let mut times = race(COUNT, &mut contestants).into_iter().map(|speed| 1e3 / speed);
    let unit = times.next().unwrap_or(f64::NAN);
    println!("\nField programs, not narrowed, over the solid's box: ns a point. M1 takes {unit:.2} ns; limits are");
    println!("{COMMON} ns, for supershapes {SUPERSHAPE} ns, on a machine where it takes {UNIT} ns.");
    for (title, rows) in &sections {
        println!("\n{title:32} {:>8} {:>8} {:>8}", "ns", "over M1", "of limit");
        for (row, time) in rows.iter().zip(times.by_ref()) {
            let ratio = time / unit;
            print!("{:32} {time:8.2} {ratio:8.2}", row.name);
            match row.limit.map(|limit| ratio * UNIT / limit) {
                Some(share) if share > 1.0 => println!(" {share:8.2}  over"),
                Some(share) => println!(" {share:8.2}"),
                None => println!(),
            }
        }
    }
}

fn leaves() -> Section {
    let common = |name, solid: Solid| row(name, solid).limit(COMMON);
    let a = DVec3::new(1.0, 0.8, 0.6);
    let mut rows = vec![
        common("superellipsoid", Superellipsoid::new(a, 0.3, 0.7).into()),
        common("superellipsoid, pinched", Superellipsoid::new(a, 0.5, 2.5).into()),
        common("superellipsoid, an ellipsoid", Superellipsoid::new(a, 1.0, 1.0).into()),
        common("supertoroid", Supertoroid::new(a, 2.0, 0.4, 0.6).into()),
        common("superhyperboloid, 1 sheet", Superhyperboloid::one_sheet(a, 0.7, 0.5, 2.4).into()),
        common("superhyperboloid, 1 sheet, x", Superhyperboloid::one_sheet_x(a, 0.7, 0.5, 4.0).into()),
        common("superhyperboloid, 2 sheets", Superhyperboloid::two_sheets(a, 0.7, 0.5, 2.4).into()),
        common("superhyperboloid, 2 sheets, x", Superhyperboloid::two_sheets_x(a, 0.7, 0.5, 4.0).into()),
        row("generalised superquadric", GeneralisedSuperquadric::new(a, [5.0, 3.0, 1.5])),
    ];
    let star = Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
    let arms = Gielis::rational(5, 2, 3.0, 7.0, 7.0);
    let round = Gielis::new(2.0, 2.0, 2.0, 2.0);
    rows.extend(
        [
            ("supershape", star.clone()),
            ("supershape, rational radius", star.rational()),
            ("supershape, 2 turns outside", Supershape::new(arms, round)),
            ("supershape, 2 turns inside", Supershape::new(arms.with_turns(Turns::Inner), round)),
            ("supershape, 2 turns, rational", Supershape::with(arms, round, DVec3::ONE, Radius::Rational)),
        ]
        .map(|(name, shape)| row(name, shape).limit(SUPERSHAPE)),
    );
    rows.extend([
        common("sphere", Sphere { radius: 1.0 }.into()),
        common("box", Cuboid { size: 2.0 * a }.into()),
        common("rounded box", RoundedCuboid { size: 2.0 * a, radius: 0.2 }.into()),
        common("cylinder", Cylinder { radius: 1.0, height: 1.5 }.into()),
        common("cone", Cone { bottom_radius: 1.0, top_radius: 0.3, height: 1.5 }.into()),
        common("capsule", Capsule { radius: 0.5, height: 2.0 }.into()),
        common("torus", Torus { radius: 1.0, tube: 0.4 }.into()),
        common("ellipsoid", Ellipsoid { semi_axes: a }.into()),
        common("prism, 6 sides", Prism::new(6, 1.0, 1.5).into()),
        common("prism, 100 sides", Prism::new(100, 1.0, 1.5).into()),
        common("pyramid, 4 sides", Pyramid::new(4, 1.0, 1.5).into()),
        common("wedge", Wedge { size: 2.0 * a }.into()),
        common("half-space", HalfSpace { normal: DVec3::new(0.6, 0.0, 0.8), offset: 0.3 }.into()),
        common("slab", Slab { normal: DVec3::new(0.6, 0.0, 0.8), thickness: 0.3 }.into()),
    ]);
    let [gyroid, p, d] = [MinimalSurface::Gyroid, MinimalSurface::SchwarzP, MinimalSurface::SchwarzD];
    let sheet = |surface| SheetLattice { surface, cell: 1.0, thickness: 0.1 };
    let network = |surface| NetworkLattice { surface, cell: 1.0, fraction: 0.3 };
    let lattice = |name, solid: Solid| common(name, solid).within(Bounds::from_center(DVec3::ZERO, DVec3::splat(4.0)));
    rows.extend([
        lattice("gyroid, sheet", sheet(gyroid).into()),
        lattice("Schwarz P, sheet", sheet(p).into()),
        lattice("Schwarz D, sheet", sheet(d).into()),
        lattice("gyroid, network", network(gyroid).into()),
        lattice("Schwarz P, network", network(p).into()),
        lattice("Schwarz D, network", network(d).into()),
        lattice("gyroid, graded sheet", Solid::new(SheetLattice { surface: gyroid, cell: 1.0, thickness: Downwards })),
        common("a user's leaf (heart)", Solid::new(Heart)),
    ]);
    ("leaf", rows)
}

fn profiles() -> Section {
    let common = |name, profile: Profile| row(name, profile.column()).limit(COMMON);
    let a = DVec2::new(1.0, 0.7);
    let star = Gielis::new(5.0, 3.0, 7.0, 7.0);
    let arms = Gielis::rational(5, 2, 3.0, 7.0, 7.0);
    let arrow = [[-1.0, -0.3], [0.2, -0.3], [0.2, -0.7], [1.0, 0.0], [0.2, 0.7], [0.2, 0.3], [-1.0, 0.3]];
    let rows = vec![
        common("circle", Circle { radius: 1.0 }.into()),
        common("superellipse", Superellipse::new(a, 0.6).into()),
        common("superellipse, pinched", Superellipse::new(a, 2.5).into()),
        common("superellipse, an ellipse", Superellipse::new(a, 1.0).into()),
        common("superpolygon", Superpolygon::new(star, 1.0).into()).limit(SUPERSHAPE),
        common("superpolygon, 2 turns", Superpolygon::new(arms, 1.0).into()).limit(SUPERSHAPE),
        common("rectangle", Rectangle { size: 2.0 * a, radius: 0.2 }.into()),
        common("regular polygon, 6 sides", RegularPolygon::new(6, 1.0).into()),
        common("regular polygon, 100 sides", RegularPolygon::new(100, 1.0).into()),
        row("polygon, 7 edges", Profile::from(Polygon::new([arrow])).column()),
    ];
    ("profile (a column)", rows)
}

fn sweeps() -> Section {
    let section = Profile::rounded_rectangle(DVec2::new(0.8, 0.5), 0.1);
    let off = section.translate(DVec2::new(1.5, 0.0));
    let extruded = |extrusion: Extrusion| section.extrude_with(&extrusion);
    let upright = Extrusion::new(1.0);
    let rows = vec![
        row("extruded", section.extrude(1.0)),
        row("extruded, chamfered", extruded(Extrusion { caps: Caps::Chamfered(0.1), ..upright })),
        row("extruded, rounded", extruded(Extrusion { caps: Caps::Rounded(0.1), ..upright })),
        row("extruded, twisted and scaled", extruded(Extrusion { twist: rad(1.0), scale: 0.5, ..upright })),
        row("revolved", off.revolve()),
        row("revolved by half a turn", off.revolve_by(deg(180.0))),
        row("swept along a helix", off.sweep_helix(&Helix::new(2.0, 1.5, 3.0))),
        row("swept, turns meeting", off.sweep_helix(&Helix::new(2.0, 0.4, 8.0))),
    ];
    ("of a rounded rectangle", rows)
}

/// Two spheres, and boxes about a point of the circle where their surfaces meet and far from
/// it.
fn pair() -> ([Solid; 2], [Bounds; 2]) {
    let (radius, centre) = (0.8, DVec3::new(1.0, 0.3, 0.2));
    let axis = centre.normalize();
    let along = 0.5 * (1.0 - radius * radius + centre.length_squared()) / centre.length();
    let edge = along * axis + (1.0 - along * along).sqrt() * axis.any_orthonormal_vector();
    let about = |p: DVec3| Bounds::from_center(p, DVec3::splat(0.1));
    ([Solid::sphere(1.0), Solid::sphere(radius).translate(centre)], [about(edge), about(-axis)])
}

fn joins() -> Section {
    let ([a, b], [edge, far]) = pair();
    let mut rows: Vec<Row> = [
        ("min and max", RFunction::MIN_MAX),
        ("R_alpha", RFunction::Alpha(0.5)),
        ("R_0 with m = 2", RFunction::Zero { m: 2 }),
        ("R_p with p = 2", RFunction::P(2.0)),
        ("R_p with p = 3", RFunction::P(3.0)),
        ("associative", RFunction::Associative(4.0)),
        ("distance", RFunction::Distance),
    ]
    .into_iter()
    .map(|(name, rule)| row(name, a.union(&b, rule)))
    .collect();
    let blended = |blend: Blend| a.union_with(&b, blend);
    let (fillet, chamfer) = (Blend::Fillet { radius: 0.1 }, Blend::Chamfer { leg: 0.07 });
    rows.extend([
        row("displacement", blended(Blend::Displacement { height: 0.1, falloff: [0.3, 0.3] })),
        row("Ricci", blended(Blend::Ricci { p: 3.0 })),
        row("smooth", blended(Blend::Smooth { radius: 0.2 })),
        row("fillet", blended(fillet)),
        row("fillet, at the edge", blended(fillet)).within(edge),
        row("fillet, far from the edge", blended(fillet)).within(far),
        row("chamfer", blended(chamfer)),
        row("chamfer, at the edge", blended(chamfer)).within(edge),
        row("chamfer, far from the edge", blended(chamfer)).within(far),
    ]);
    ("union of two spheres", rows)
}

fn lengths() -> Section {
    let shape: Solid = Superellipsoid::new(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7).into();
    let torus: Solid = Torus { radius: 1.0, tube: 0.4 }.into();
    let star: Solid = Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0)).into();
    let rows = vec![
        row("level, superellipsoid", shape.level(0.05)),
        row("offset, superellipsoid", shape.offset(0.05)),
        row("shell, superellipsoid", shape.shell(0.05)),
        row("offset, tapered superellipsoid", shape.taper(0.2, 0.2, 1.2).offset(0.05)),
        row("offset, supershape", star.offset(0.05)),
        row("offset, torus", torus.offset(0.05)),
        row("shell, torus", torus.shell(0.05)),
    ];
    ("length", rows)
}

fn maps() -> Section {
    let ball = Solid::sphere(1.0);
    let bar = Solid::cuboid(DVec3::new(1.0, 0.6, 2.0));
    let step = SmoothStep { from: (-1.0, 1.0), to: (1.0, 0.5) };
    let swing = SineWave { mean: 0.0, amplitude: 0.5, wavelength: 4.0, phase: deg(0.0) };
    let table = LawTable::new([(-1.0, 1.0), (-0.5, 0.7), (0.0, 0.9), (0.5, 0.6), (1.0, 0.8)]);
    let small = Solid::sphere(0.3);
    let rows = vec![
        row("none: a box", bar.clone()),
        row("affine", bar.rotate_x(rad(0.3)).rotate_z(rad(0.4)).translate(DVec3::ONE)),
        row("taper", bar.taper(0.2, 0.3, 2.0)),
        row("twist", bar.twist(rad(0.5))),
        row("bend", bar.bend(0.3, rad(0.5))),
        row("taper by a smooth step", bar.taper_by(step, 1.0)),
        row("taper by a table of 5", bar.taper_by(table, 1.0)),
        row("twist by a sine wave", bar.twist_by(rad(1.0), swing)),
        row("elongate", ball.elongate(DVec3::new(0.0, 1.0, 2.0))),
        row("mirrored", bar.translate(DVec3::X).mirrored_x()),
        row("repeat, a row of 10", small.repeat([10, 1, 1], DVec3::ONE)),
        row("repeat, a grid of 1000", small.repeat([10, 10, 10], DVec3::ONE)),
        row("repeat_polar, 12", small.translate(DVec3::X * 2.0).repeat_polar(12)),
        row("repeat_polar, 13", small.translate(DVec3::X * 2.0).repeat_polar(13)),
    ];
    ("map, of a box or a sphere", rows)
}

/// Walls that are thicker below.
#[derive(Debug)]
struct Downwards;

impl Grading for Downwards {
    #[inline(always)]
    fn at<R: Real>(&self, [_, _, z]: [R; 3]) -> R {
        z * -0.02 + 0.15
    }

    fn limits(&self) -> Interval {
        Interval::new(0.05, 0.2)
    }
}

/// A heart-shaped section, two units thick.
#[derive(Debug)]
struct Heart;

impl Field for Heart {
    fn name(&self) -> &'static str {
        "heart"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let lift = y - x.abs().pow(0.5) * 0.8;
        (-(x.square() + lift.square()).sqrt() + 1.0).min(-z.abs() + 1.0)
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(1.0, 1.8, 1.0))
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}
