//! The solids that lengths are timed on. Each call builds anew: what is compiled is kept with a
//! solid.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use rvachev::{Blend, Caps, Extrusion, Gielis, Profile, RFunction, Solid, Supershape, deg, rad};

/// What may be taken: so many times what the plain solid takes, or so many seconds more.
#[derive(Clone, Copy)]
pub struct Limit {
    pub times: f64,
    pub plus: f64,
}

/// A solid with a length, and the same without.
pub struct Row {
    pub name: &'static str,
    pub plain: fn() -> Solid,
    pub made: fn() -> Solid,
    pub mesh: Limit,
    /// The first picture, in times of the plain one; the second may take half of that.
    pub picture: f64,
}

const CSG: (Limit, f64) = (Limit { times: 6.0, plus: 0.06 }, 5.0);
const CURVED: (Limit, f64) = (Limit { times: 6.0, plus: 0.12 }, 4.0);
const BLENDED: (Limit, f64) = (Limit { times: 12.0, plus: 0.25 }, 6.0);

pub fn rows() -> Vec<Row> {
    let row = |name, plain, made, (mesh, picture)| Row { name, plain, made, mesh, picture };
    vec![
        row("block, shell", block, || block().shell(1.0), CSG),
        row("block, inset", block, || block().offset(-1.0), CSG),
        row("bracket, shell", bracket, || bracket().shell(1.0), CSG),
        row("bracket, offset", bracket, || bracket().offset(1.0), CSG),
        row("twisted, shell", twisted, || twisted().shell(1.0), CURVED),
        row("twisted, offset", twisted, || twisted().offset(1.0), CURVED),
        row("vase, shell", vase, || vase().shell(1.6), CURVED),
        row("block, opening", block, || block().rounded(2.0), BLENDED),
        row("bracket, opening", bracket, || bracket().rounded(0.8), BLENDED),
        row("bracket, closing", bracket, || bracket().filleted(1.5), BLENDED),
        row("bracket, both", bracket, || bracket().filleted(1.5).rounded(0.8), BLENDED),
        row("thin plates, opening", plates, || plates().rounded(0.5), BLENDED),
        row("twisted, opening", twisted, || twisted().rounded(2.0), BLENDED),
        row("one fillet", || post(PLAIN), || post(Some(fillet(3.0))), BLENDED),
        row("two fillets", || three([PLAIN; 2]), || three([3.0, 2.0].map(|radius| Some(fillet(radius)))), BLENDED),
        row("six radii, chain", || radii(PLAIN), || radii(Some(fillet(0.1))), BLENDED),
        row("ten fillets, chain", || chain(10, PLAIN), || chain(10, Some(fillet(0.05))), BLENDED),
        row("one chamfer", || post(PLAIN), || post(Some(Blend::Chamfer { leg: 2.0 })), BLENDED),
        row("chamfered joint", || joint(PLAIN), || joint(Some(Blend::Chamfer { leg: 0.15 })), BLENDED),
        row("filleted joint", || joint(PLAIN), || joint(Some(fillet(0.15))), BLENDED),
        row("gear, rounded caps", || gear(Caps::Flat), || gear(Caps::Rounded(1.0)), BLENDED),
        row("gear, chamfered caps", || gear(Caps::Flat), || gear(Caps::Chamfered(1.0)), BLENDED),
    ]
}

/// Without a blend.
const PLAIN: Option<Blend> = None;

pub fn fillet(radius: f64) -> Blend {
    Blend::Fillet { radius }
}

fn joined(a: &Solid, b: &Solid, blend: Option<Blend>) -> Solid {
    blend.map_or_else(|| a.union(b, RFunction::MIN_MAX), |blend| a.union_with(b, blend))
}

fn at(solid: Solid, place: [f64; 3]) -> Solid {
    solid.translate(place)
}

/// Two cubes of 10 side by side.
pub fn block() -> Solid {
    let cube = Solid::cuboid([10.0; 3]);
    at(cube.clone(), [-5.0, 0.0, 0.0]) | at(cube, [5.0, 0.0, 0.0])
}

/// Plate, wall, rib and counterbored holes.
pub fn bracket() -> Solid {
    let plate = at(Solid::cuboid([60.0, 40.0, 6.0]), [0.0, 0.0, 3.0]);
    let wall = at(Solid::cuboid([6.0, 40.0, 40.0]), [-27.0, 0.0, 20.0]);
    let rib = at(Solid::wedge([30.0, 5.0, 30.0]), [-9.0, 0.0, 21.0]);
    let hole = Solid::cylinder(3.0, 30.0) | at(Solid::cylinder(6.0, 10.0), [0.0, 0.0, 5.0]);
    let upright = |y: f64| at(hole.clone(), [16.0, y, 4.0]);
    let across = |y: f64| at(hole.rotate_y(deg(90.0)), [-26.0, y, 29.0]);
    let body = plate | wall | rib;
    body.difference_all([upright(-12.0), upright(12.0), across(-12.0), across(12.0)], RFunction::MIN_MAX)
}

/// Two plates that are as thick as a ball of .5 is wide, turned.
pub fn plates() -> Solid {
    let wall = at(Solid::cuboid([1.0, 10.0, 15.0]), [-9.5, 0.0, 7.0]);
    (Solid::cuboid([20.0, 10.0, 1.0]) | wall).rotate_y(deg(20.0)).rotate_x(deg(10.0))
}

/// A superellipsoid, twisted.
pub fn twisted() -> Solid {
    Solid::superellipsoid([30.0, 20.0, 40.0], 0.3, 0.4).twist(rad(0.02))
}

/// A vase with seven sharp lobes, twisted.
pub fn vase() -> Solid {
    let lobes = Supershape::new(Gielis::new(7.0, 9.0, 8.0, 8.0), Gielis::new(4.0, 30.0, 30.0, 30.0));
    Solid::from(lobes.scaled([34.0, 34.0, 60.0])).twist(rad(0.0087))
}

fn plate() -> Solid {
    Solid::cuboid([60.0, 40.0, 4.0])
}

/// A post on a plate.
fn post(blend: Option<Blend>) -> Solid {
    joined(&plate(), &at(Solid::cylinder(6.0, 30.0), [0.0, 0.0, 15.0]), blend)
}

/// A post and a rib on a plate. Fillets of different radii nest.
fn three([of_post, of_rib]: [Option<Blend>; 2]) -> Solid {
    joined(&post(of_post), &at(Solid::cuboid([40.0, 4.0, 20.0]), [10.0, 0.0, 10.0]), of_rib)
}

/// Six pins in a row on a plate, each with a fillet that is a little larger than the one before.
fn radii(blend: Option<Blend>) -> Solid {
    (0..6).fold(Solid::cuboid([7.0, 1.5, 0.4]), |all, n| {
        let pin = at(Solid::cylinder(0.2, 1.0), [f64::from(n) - 2.5, 0.0, 0.2]);
        let larger = |blend| match blend {
            Blend::Fillet { radius } => fillet(radius * (1.0 + 1e-3 * f64::from(n))),
            other => other,
        };
        joined(&all, &pin, blend.map(larger))
    })
}

/// A pin of superelliptic shape through a plate.
fn joint(blend: Option<Blend>) -> Solid {
    joined(&Solid::cuboid([2.0, 2.0, 0.4]), &Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7), blend)
}

/// A plate, and pins through it that are as far apart whatever their number.
fn pins(count: usize) -> (Solid, Vec<Solid>) {
    const PITCH: f64 = 0.6;
    let rows = (1..).find(|rows| rows * rows >= count).unwrap_or(1);
    let side = PITCH * rows as f64;
    let pin = |i: usize| {
        let place = (DVec2::new((i % rows) as f64, (i / rows) as f64) + 0.5) * PITCH - 0.5 * side;
        Solid::cylinder(0.1 + 0.05 * ((7 * i) % 10) as f64 / 9.0, 1.0).translate(place.extend(0.0))
    };
    (Solid::cuboid(DVec3::new(side, side, 0.4)), (0..count).map(pin).collect())
}

/// Pins joined to a plate one after the other.
pub fn chain(count: usize, blend: Option<Blend>) -> Solid {
    let (plate, pins) = pins(count);
    pins.iter().fold(plate, |all, pin| joined(&all, pin, blend))
}

/// Pins joined to a plate at once.
pub fn at_once(count: usize, blend: Option<Blend>) -> Solid {
    let (plate, pins) = pins(count);
    let all = std::iter::once(plate).chain(pins);
    match blend {
        Some(blend) => Solid::union_all_with(all, blend),
        None => Solid::union_all(all, RFunction::MIN_MAX),
    }
}

/// A gear of twelve teeth, its involutes polygons: 96 edges.
fn gear(caps: Caps) -> Solid {
    const TEETH: u32 = 12;
    const PITCH_RADIUS: f64 = 18.0;
    let pressure = 20f64.to_radians();
    let base = PITCH_RADIUS * pressure.cos();
    let involute = |angle: f64| angle.tan() - angle;
    // Half the angle of a tooth at a radius.
    let half = |radius: f64| {
        let angle = (base / radius).min(1.0).acos();
        0.5 * PI / f64::from(TEETH) + involute(pressure) - involute(angle)
    };
    let radii = [14.25, 17.2, 19.2, 21.0];
    let tooth = |i: u32| {
        let middle = TAU * f64::from(i) / f64::from(TEETH);
        let up = radii.map(|radius| DVec2::from_angle(middle - half(radius)) * radius);
        let down = radii.map(|radius| DVec2::from_angle(middle + half(radius)) * radius);
        up.into_iter().chain(down.into_iter().rev())
    };
    Profile::polygon((0..TEETH).flat_map(tooth)).extrude_with(&Extrusion { caps, ..Extrusion::new(10.0) })
}
