//! What the modules share: a random source, random solids, lanes by the list of points.

mod random;

use glam::DVec3;
use rvachev::{
    Bounds, Cuboid, Cylinder, Gielis, Mesh, RFunction, Solid, Sphere, Supershape, Turns,
    program::{Evaluator, Program, Tape},
    rad,
};

pub use random::{Random, extra_seed};

/// A rule of each kind, and the extremes.
pub const RULES: [RFunction; 10] = [
    RFunction::MIN_MAX,
    RFunction::Alpha(0.0),
    RFunction::Alpha(0.5),
    RFunction::Alpha(-0.9),
    RFunction::Zero { m: 2 },
    RFunction::P(2.0),
    RFunction::P(3.5),
    RFunction::P(1.2),
    RFunction::Associative(2.0),
    RFunction::Distance,
];

impl Random {
    pub fn rule(&mut self) -> RFunction {
        self.pick(&RULES)
    }
}

/// A leaf of any kind, of a size between 0.2 and 1.6, about the origin.
pub fn random_leaf(random: &mut Random) -> Solid {
    let size = |random: &mut Random| random.range(0.2, 0.8);
    match random.below(14) {
        11..14 => crate::zoo::catalogue_leaf(random),
        8 | 9 => crate::primitives::random_primitive(random).0,
        10 => crate::lattices::random_lattice(random),
        0 => Sphere { radius: size(random) }.into(),
        1 => Cuboid { size: random.vector(0.4, 1.6) }.into(),
        2 => Cylinder { radius: size(random), height: 2.0 * size(random) }.into(),
        3 => Solid::half_space(random.direction(), random.range(-0.5, 0.5)),
        4 => {
            let shape = Supershape::new(random_curve(random, true), random_curve(random, false));
            shape.scaled(random.vector(0.3, 0.7)).into()
        }
        5 => Solid::superellipsoid(random.vector(0.2, 0.8), random.pick(&EXPONENTS), random.pick(&EXPONENTS)),
        _ => Solid::superellipsoid(random.vector(0.2, 0.8), random.range(0.05, 2.5), random.range(0.05, 2.5)),
    }
}

/// Exponents at which the formulas change their form, and their neighbours.
const EXPONENTS: [f64; 7] = [0.05, 0.1, 0.999_999, 1.0, 1.000_001, 2.0, 2.5];

fn random_curve(random: &mut Random, equator: bool) -> Gielis {
    match random.below(3) {
        0 => Gielis::circle(),
        1 => Gielis::polygon(3 + random.below(6) as u32, random.pick(&[5.0, 20.0, 60.0])),
        _ => {
            let n1 = random.range(0.8, 6.0);
            let (m, turns) = match random.below(9) {
                7 => (7.0 / 3.0, Turns::Outer),
                8 => (2.5, Turns::Inner),
                m => (m as f64, Turns::Principal),
            };
            let curve = Gielis::new(m, n1, n1 * random.range(0.4, 3.0), n1 * random.range(0.4, 3.0));
            if equator { curve.with_turns(turns) } else { curve }
        }
    }
}

/// A small tree: leaves under maps, joined.
pub fn random_solid(random: &mut Random, depth: usize) -> Solid {
    if depth == 0 {
        let leaf = random_leaf(random);
        return mapped(random, leaf);
    }
    let first = random_solid(random, depth - 1);
    let below = random.below(depth);
    let second = random_solid(random, below);
    let rule = random.rule();
    let joined = match random.below(8) {
        6 | 7 => crate::zoo::blended(random, &first, &second),
        0 | 1 => first.union(&second, rule),
        2 => first.intersection(&second, rule),
        3 => first.difference(&second, rule),
        4 => first.symmetric_difference(&second, rule),
        _ => Solid::union_all([first, second, random_leaf(random)], rule),
    };
    let whole = mapped(random, joined);
    if random.chance(0.1) { !whole } else { whole }
}

/// The solid under one or two maps, or none; a bend that would fold it is left out.
fn mapped(random: &mut Random, solid: Solid) -> Solid {
    let mut solid = solid;
    for _ in 0..random.below(3) {
        let moved = match random.below(10) {
            7 | 8 => crate::zoo::catalogue_map(random, &solid),
            9 => crate::zoo::lengthened(random, &solid),
            0 | 1 => solid.translate(random.vector(-0.6, 0.6)),
            2 => solid.rotate(random.rotation()),
            3 => solid.affine(random.affine()),
            4 => solid.taper(random.range(-0.6, 0.6), random.range(-0.6, 0.6), random.range(0.6, 2.0)),
            5 => solid.twist(rad(random.range(-2.0, 2.0))),
            _ => solid.bend(random.range(-0.5, 0.5), rad(random.range(-3.0, 3.0))),
        };
        if moved.bounds().is_ok() {
            solid = moved;
        }
    }
    solid
}

/// The solid's box, or the part of it within ±3 if it is unbounded; a unit box if it is empty.
pub fn frame_of(solid: &Solid) -> Bounds {
    let bounds = solid.bounds().expect("the solid is valid");
    let cut = bounds.intersection(&Bounds::from_center(DVec3::ZERO, DVec3::splat(3.0)));
    if cut.is_empty() || cut.longest_side() == 0.0 { Bounds::from_center(DVec3::ZERO, DVec3::ONE) } else { cut }
}

/// A box of any size between a hundredth of `frame` and all of it, around a point in it.
pub fn random_box(random: &mut Random, frame: &Bounds) -> Bounds {
    let center = random.point_in(frame);
    let size = frame.longest_side();
    let half = DVec3::new(random.log_range(0.005, 0.5), random.log_range(0.005, 0.5), random.log_range(0.005, 0.5));
    // Cubes are what the engine itself asks about.
    let half = if random.chance(0.5) { DVec3::splat(half.x) } else { half };
    Bounds::from_center(center, size * half)
}

/// Points in a box, its corners among them.
pub fn samples(random: &mut Random, bounds: &Bounds, count: usize) -> Vec<DVec3> {
    let mut points = bounds.corners().to_vec();
    points.extend((points.len()..count).map(|_| random.point_in(bounds)));
    points
}

/// Coordinates, axis by axis.
pub fn columns(points: &[DVec3]) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect())
}

/// The points rounded to single precision relative to `origin`, which is where lanes of `f32`
/// look, and the coordinates to call the lanes with.
pub fn rounded(points: &[DVec3], origin: DVec3) -> (Vec<DVec3>, [Vec<f32>; 3]) {
    let local: [Vec<f32>; 3] = [0, 1, 2].map(|axis| points.iter().map(|p| (p[axis] - origin[axis]) as f32).collect());
    let seen = (0..points.len()).map(|i| origin + DVec3::from_array([0, 1, 2].map(|axis| f64::from(local[axis][i]))));
    (seen.collect(), local)
}

/// Values on lanes of `f32` for points in `region`: the points that the lanes saw, and values.
pub fn lanes32(program: &Program, region: &Bounds, points: &[DVec3]) -> (Vec<DVec3>, Vec<f64>) {
    let tape = Tape::new(program, region);
    let (seen, [x, y, z]) = rounded(points, tape.origin());
    let mut values = vec![0.0; points.len()];
    Evaluator::new().values(&tape, &x, &y, &z, &mut values).unwrap();
    (seen, values.into_iter().map(f64::from).collect())
}

/// Values on lanes of `f64`.
pub fn lanes64(program: &Program, region: &Bounds, points: &[DVec3]) -> Vec<f64> {
    let tape = Tape::new(program, region);
    let local: Vec<DVec3> = points.iter().map(|p| *p - tape.origin()).collect();
    let [x, y, z] = columns(&local);
    let mut values = vec![0.0; points.len()];
    Evaluator::new().values_f64(&tape, &x, &y, &z, &mut values).unwrap();
    values
}

/// Fails unless the two numbers are within `tolerance` of each other.
#[track_caller]
pub fn near(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "got {got}, want {want} within {tolerance:e}");
}

/// Fails unless the two points are within `tolerance` of each other along every axis.
#[track_caller]
pub fn near_point(got: DVec3, want: DVec3, tolerance: f64) {
    let off = (got - want).abs().max_element();
    assert!(off <= tolerance, "got {got}, want {want} within {tolerance:e}");
}

/// A solid's value at a point.
#[track_caller]
pub fn value(solid: &Solid, p: DVec3) -> f64 {
    solid.value(p).expect("the solid is valid")
}

/// The cases of a file of the corpus: failures found by random search, a line of numbers each.
pub fn corpus(file: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split(' ').map(|word| word.parse().expect("a number")).collect();
    file.lines().filter(|line| !line.starts_with('#')).map(numbers).collect()
}

/// How many vertices have no change of sign close by along any axis. Distances that are searched
/// for jump here and there: what tells is the sign.
pub fn off_surface(program: &Program, mesh: &Mesh, cell: f64) -> usize {
    let crosses = |p: DVec3| {
        DVec3::AXES.iter().any(|axis| {
            let [before, after] = [-1e-5, 1e-5].map(|by| program.value(p + by * cell * axis) > 0.0);
            before != after
        })
    };
    mesh.positions().iter().filter(|p| !crosses(p.as_dvec3())).count()
}
