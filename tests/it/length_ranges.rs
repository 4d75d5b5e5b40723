//! Ranges of offsets and shells: they hold every value, of points and of lanes, near and far.

use glam::DVec3;
use rvachev::{
    Blend, Bounds, Solid,
    program::{Program, Region, Tape},
    rad,
};

use crate::support::{Random, frame_of, lanes32, lanes64, random_leaf, samples};
use crate::zoo;

/// A leaf, some deformed, once or twice.
pub fn operand(random: &mut Random) -> Solid {
    let mut solid = random_leaf(random);
    for _ in 0..random.below(3) {
        let moved = match random.below(7) {
            0 => solid.affine(random.affine()),
            1 => solid.taper(random.range(-0.6, 0.6), random.range(-0.6, 0.6), random.range(0.6, 2.0)),
            2 | 3 => solid.twist(rad(random.range(-2.0, 2.0))),
            4 => solid.bend(random.range(-0.5, 0.5), rad(random.range(-3.0, 3.0))),
            _ => zoo::catalogue_map(random, &solid),
        };
        if moved.bounds().is_ok() {
            solid = moved;
        }
    }
    solid
}

/// A box near the frame, or up to thirty times as far away, of any size.
pub fn place(random: &mut Random, frame: &Bounds) -> Bounds {
    let size = frame.longest_side();
    let centre = match random.below(4) {
        0 => frame.center() + size * random.log_range(1.0, 30.0) * random.direction(),
        _ => random.point_in(&frame.inflate(0.3 * size)),
    };
    let half = DVec3::from_array([0; 3].map(|_| size * random.log_range(0.002, 0.5)));
    Bounds::from_center(centre, if random.chance(0.5) { DVec3::splat(half.x) } else { half })
}

/// What a range leaves out.
pub fn missed(random: &mut Random, program: &Program, region: &Bounds) -> Option<String> {
    let points = samples(random, region, 40);
    let range = program.range(region);
    let doubt = Tape::new(program, region).roundoff();
    let exact = points.iter().map(|&p| ("a point", p, program.value(p), 0.0));
    let wide = points.iter().zip(lanes64(program, region, &points)).map(|(&p, v)| ("f64 lanes", p, v, 0.0));
    let (seen, values) = lanes32(program, region, &points);
    let lanes = seen.into_iter().zip(values).map(|(p, v)| ("f32 lanes", p, v, doubt));
    for (what, p, value, doubt) in exact.chain(wide).chain(lanes) {
        let doubt = doubt + 1e-6 * value.abs();
        if !range.inflate(doubt).contains(value) {
            return Some(format!("{what} at {p}: {value} not in {range:?} over {region:?}, up to {doubt:e}"));
        }
    }
    None
}

fn check(seed: u64, cases: usize, boxes: usize) {
    let mut random = Random::new(seed);
    let mut failures = Vec::new();
    for case in 0..cases {
        let solid = operand(&mut random);
        let size = frame_of(&solid).size().min_element();
        let by = size * random.log_range(0.005, 0.3);
        let solid = match random.below(3) {
            0 => solid.offset(by),
            1 => solid.offset(-0.3 * by),
            _ => solid.shell(0.3 * by),
        };
        let program = solid.surface_program().unwrap();
        let frame = frame_of(&solid);
        for _ in 0..boxes {
            let region = place(&mut random, &frame);
            if let Some(text) = missed(&mut random, &program, &region) {
                failures.push(format!("case {case}: {solid:?}: {text}"));
                break;
            }
        }
    }
    let count = failures.len();
    assert!(failures.is_empty(), "{count} of {cases}:\n{}", failures[..count.min(8)].join("\n"));
}

#[test]
fn ranges_of_lengths_hold_every_value() {
    check(120, 8, 12);
}

#[test]
#[ignore = "takes minutes"]
fn ranges_of_lengths_hold_every_value_at_length() {
    for seed in 0..20 {
        check(500 + seed, 400, 30);
    }
}

/// The ball of a blend is measured about the joint: beyond that the sign of its distance changes
/// where no patch is.
#[test]
fn ranges_of_blends_hold_every_value_beyond_the_joint() {
    let (fillet, chamfer) = (|radius: f64| Blend::Fillet { radius }, |leg: f64| Blend::Chamfer { leg });
    let (plate, post) = (Solid::cuboid([2.0, 1.0, 1.0]), Solid::cylinder(0.35, 2.2).translate([0.3, 0.2, 0.1]));
    let body = Solid::cuboid([1.4, 1.0, 1.2]).taper(0.3, -0.2, 1.2);
    let bore = Solid::cylinder(0.35, 1.0).translate([0.1, -0.1, 0.4]);
    let solids = [
        plate.union_with(&post, fillet(0.2)),
        plate.union_with(&post, chamfer(0.1)),
        body.difference_with(&bore, fillet(0.03)),
        body.difference_with(&bore, chamfer(0.05)),
        body.intersection_with(&post, fillet(0.05)),
        body.twist(rad(0.4)).union_with(&post, fillet(0.1)).rounded(0.05),
    ];
    let mut random = Random::new(43);
    for (number, solid) in solids.iter().enumerate() {
        let (program, frame) = (solid.surface_program().unwrap(), frame_of(solid));
        let held = Bounds::new(
            DVec3::new(-0.08250662525433894, 0.2029470499435011, 0.8473327481136552),
            DVec3::new(1.142446666235323, 0.2029470499435011, 1.574899418459152),
        );
        let places = (0..600).map(|_| place(&mut random, &frame)).collect::<Vec<_>>();
        for place in places.into_iter().chain([held]) {
            let range = program.range(&place).inflate(1e-9 + 1e-12 * place.max.abs().max_element());
            let narrowed = program.narrow(&place);
            for _ in 0..12 {
                let p = random.point_in(&place);
                let value = program.value(p);
                assert!(range.contains(value), "{number}: {value} at {p} not in {range:?} over {place:?}");
                let sign = match &narrowed {
                    Region::Surface(narrowed) => narrowed.value(p),
                    Region::Inside => 1.0,
                    Region::Outside => -1.0,
                };
                assert!((sign > 0.0) == (value > 0.0) || value.abs() < 1e-3, "{number}: {value}, {sign} at {p}");
            }
            let p = place.max;
            assert!(range.contains(program.value(p)), "{number}: {} at {p} not in {range:?}", program.value(p));
        }
    }
}

#[test]
fn lanes_find_the_distance_to_flat_faces_from_afar() {
    // Planes through one face are parallel but for rounding errors, and the other face is near.
    let mut random = Random::new(121);
    for _ in 0..100 {
        let flat = if random.chance(0.3) { Solid::slab(DVec3::Z, 0.5) } else { Solid::cuboid(random.vector(0.1, 2.0)) };
        let program = flat.affine(random.affine()).offset(-0.014).surface_program().unwrap();
        let p = random.log_range(0.5, 300.0) * random.direction();
        let region = Bounds::from_center(p, DVec3::splat(0.1));
        let points = samples(&mut random, &region, 16);
        let (seen, values) = lanes32(&program, &region, &points);
        for (p, value) in seen.into_iter().zip(values) {
            let want = program.value(p);
            assert!((value - want).abs() < 2e-3 * (want.abs() + 0.01), "{value} for {want} at {p}");
        }
    }
}
