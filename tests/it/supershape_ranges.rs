//! Ranges of supershapes over boxes: sound for every parameter, exact along the axes, and close
//! enough elsewhere that few cells without surface are kept.

use glam::{DQuat, DVec3};
use rvachev::{
    Bounds, Gielis, Solid, Supershape, Turns,
    field::{Field, Segment},
    program::{Program, Region},
};

use crate::support::{Random, lanes32, random_box, samples, value};

fn star() -> Supershape {
    Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0))
}

fn uneven() -> Supershape {
    Supershape::new(Gielis::new(5.0, 3.0, 2.0, 8.0), Gielis::new(3.0, 4.0, 4.0, 4.0))
}

fn seven_thirds() -> Supershape {
    Supershape::new(Gielis::rational(7, 3, 3.0, 7.0, 7.0), Gielis::new(4.0, 4.0, 4.0, 4.0))
}

fn nut() -> Supershape {
    let nut = Supershape::new(Gielis::polygon(6, 60.0), Gielis::new(4.0, 30.0, 30.0, 30.0));
    nut.scaled(DVec3::new(1.0, 1.0, 0.5))
}

/// A curve of any allowed kind, mild or extreme.
fn any_curve(random: &mut Random, equator: bool) -> Gielis {
    let n1 = random.log_range(0.05, 1000.0);
    let most = (100.0 * n1).min(1000.0);
    let exponent = |random: &mut Random| match random.below(5) {
        0 => random.log_range(0.1, most),
        1 => 1.0f64.min(most),
        2 => 2.0f64.min(most),
        3 => random.range(0.1, most.min(1.0)),
        _ => random.range(0.4, 3.0).mul_add(n1, 0.1).min(most),
    };
    let mut curve = Gielis::new(0.0, n1, exponent(random), exponent(random));
    if random.chance(0.3) {
        curve.n3 = curve.n2;
    }
    if random.chance(0.3) {
        (curve.a, curve.b) = (random.log_range(0.3, 3.0), random.log_range(0.3, 3.0));
    }
    if equator && random.chance(0.4) {
        let turns = random.pick(&[Turns::Outer, Turns::Inner]);
        return Gielis { m: random.below(30) as f64 / (1 + random.below(8)) as f64, turns, ..curve };
    }
    let m = if random.chance(0.5) { random.below(13) as f64 } else { random.range(0.0, 20.0) };
    Gielis { m, ..curve }
}

#[test]
fn ranges_of_any_supershape_hold_every_sample() {
    let mut random = Random::new(74);
    for _ in 0..80 {
        let curves = [any_curve(&mut random, true), any_curve(&mut random, false)];
        let mut shape = Supershape::new(curves[0], curves[1]);
        if random.chance(0.2) && curves.iter().all(|c| c.a == 1.0 && c.b == 1.0) {
            shape = shape.rational();
        }
        let shape = shape.scaled(random.vector(0.3, 2.0));
        let solid = Solid::from(shape.clone());
        let turned = solid.rotate(random.rotation());
        let whole = solid.bounds().unwrap();
        assert!(whole.min.is_finite() && whole.max.is_finite(), "{shape:?}");
        // Boxes are as large as the shape's thinnest part, or somewhat larger.
        let size = value(&solid, DVec3::ZERO).abs().max(1e-3 * whole.longest_side()).min(1e9);
        for _ in 0..12 {
            let frame = Bounds::from_center(DVec3::ZERO, DVec3::splat(size * random.log_range(1.0, 30.0)));
            let region = random_box(&mut random, &frame);
            for solid in [&solid, &turned] {
                let range = solid.range(&region).unwrap();
                for p in samples(&mut random, &region, 30) {
                    let v = value(solid, p);
                    assert!(v.is_finite() && range.contains(v), "{shape:?} at {p}: {v} in {range:?} of {region:?}");
                }
            }
        }
    }
}

/// What is told of a segment holds the value and its changes all along, short or long, and much
/// more is told than of the box about it.
#[test]
fn values_along_segments_are_as_told() {
    let mut random = Random::new(79);
    let (mut tighter, mut told) = (0, 0);
    for _ in 0..120 {
        let curves = [any_curve(&mut random, true), any_curve(&mut random, false)];
        let shape = Supershape::new(curves[0], curves[1]).scaled(random.vector(0.3, 2.0));
        let solid = Solid::from(shape.clone());
        let size = value(&solid, DVec3::ZERO).abs().max(1e-3 * solid.bounds().unwrap().longest_side()).min(1e9);
        for _ in 0..16 {
            let direction = random.direction();
            let length = size * random.log_range(1e-5, 3.0);
            let from = random.point_in(&Bounds::from_center(DVec3::ZERO, DVec3::splat(2.0 * size)));
            let ends = [from, from + length * direction].map(|end| end.to_array());
            let segment = Segment::new(ends, direction.to_array(), length);
            let (along, boxed) = (shape.along(&segment), shape.dual_range(segment.sides()));
            told += 1;
            tighter += usize::from(along.slope.width() < 0.9 * boxed.gradient()[0].width());
            let values: Vec<f64> =
                (0..=24).map(|k| value(&solid, from + length * f64::from(k) / 24.0 * direction)).collect();
            let rounding = 1e-9 * values.iter().fold(size, |most, v| most.max(v.abs()));
            for pair in values.windows(2) {
                let range = along.value.inflate(rounding);
                assert!(range.contains(pair[0]), "{shape:?}: {} in {along:?} of {segment:?}", pair[0]);
                let change = (along.slope * (length / 24.0)).inflate(rounding);
                assert!(change.contains(pair[1] - pair[0]), "{shape:?}: {pair:?}, {along:?} of {segment:?}");
            }
        }
    }
    assert!(6 * tighter > told, "{tighter} of {told}");
}

#[test]
fn ranges_over_boxes_of_the_own_frame_are_exact() {
    let mut random = Random::new(75);
    let meridian = Gielis::new(3.0, 4.0, 2.0, 6.0);
    let shapes = [
        star(),
        uneven(),
        uneven().rational(),
        Supershape::new(Gielis::rational(7, 3, 3.0, 7.0, 4.0), meridian),
        Supershape::new(Gielis::rational(5, 2, 3.0, 1.2, 5.0).with_turns(Turns::Inner), meridian),
        Supershape::new(Gielis::polygon(6, 1000.0), Gielis::circle()),
    ];
    for shape in shapes {
        let solid = Solid::from(shape.clone());
        let frame = solid.bounds().unwrap();
        for _ in 0..8 {
            let region = random_box(&mut random, &frame);
            let range = solid.range(&region).unwrap();
            let mut seen = (f64::INFINITY, f64::NEG_INFINITY);
            const STEPS: u32 = 16;
            for n in 0..(STEPS + 1).pow(3) {
                let at = |k: u32| f64::from(n / (STEPS + 1).pow(k) % (STEPS + 1)) / f64::from(STEPS);
                let v = value(&solid, region.min + DVec3::new(at(0), at(1), at(2)) * region.size());
                seen = (seen.0.min(v), seen.1.max(v));
            }
            assert!(range.lo() <= seen.0 && range.hi() >= seen.1, "{shape:?} over {region:?}");
            let slack = (seen.0 - range.lo()).max(range.hi() - seen.1);
            assert!(slack <= 0.12 * (seen.1 - seen.0) + 1e-6, "{shape:?} over {region:?}: {range:?}, seen {seen:?}");
        }
    }
}

#[test]
fn lanes_keep_within_the_stated_error_near_the_surface() {
    let mut random = Random::new(77);
    let mut worst = 0.0f64;
    for i in 0..60 {
        let mut curve = |equator: bool| {
            let n1 = random.log_range(0.5, 20.0);
            let mut exponent = || (n1 * random.log_range(0.2, 5.0)).max(if i % 2 == 0 { 0.3 } else { 1.0 });
            let (n2, n3) = (exponent(), exponent());
            let m = random.range(0.0, 12.0);
            if equator && random.chance(0.5) {
                let turns = random.pick(&[Turns::Outer, Turns::Inner]);
                return Gielis::new(m.round() / random.pick(&[1.0, 2.0, 3.0, 5.0]), n1, n2, n3).with_turns(turns);
            }
            Gielis::new(m, n1, n2, n3)
        };
        let shape = Supershape::new(curve(true), curve(false));
        let solid = Solid::from(shape.clone());
        let program = solid.field_program().unwrap();
        let points: Vec<DVec3> = (0..256)
            .map(|_| {
                let direction = random.direction();
                direction * random.range(0.98, 1.02) / shape.gauge(direction)
            })
            .collect();
        let reach = points.iter().map(|p| p.length()).fold(0.0, f64::max);
        let stated = shape.roundoff(reach);
        let (seen, values) = lanes32(&program, &Bounds::from_center(DVec3::ZERO, DVec3::splat(reach)), &points);
        for (p, got) in seen.iter().zip(values) {
            let error = (got - program.value(*p)).abs();
            worst = worst.max(error / stated);
            assert!(error <= stated, "{shape:?} at {p}: {error:e}, stated {stated:e}");
        }
    }
    println!("worst: {worst:.3} of what is stated");
}

/// Counts the cells of a cube that are kept, and those of them that the surface crosses.
struct Count {
    half: f64,
    across: u32,
    kept: u32,
    crossed: u32,
}

impl Count {
    fn bounds(&self, at: [u32; 3], side: u32) -> Bounds {
        let step = 2.0 * self.half / f64::from(self.across);
        let corner = |at: [u32; 3]| DVec3::from_array(at.map(f64::from)) * step - DVec3::splat(self.half);
        Bounds::new(corner(at), corner(at.map(|i| i + side)))
    }

    fn visit(&mut self, program: &Program, at: [u32; 3], side: u32) {
        let bounds = self.bounds(at, side);
        let Region::Surface(program) = program.narrow(&bounds) else { return };
        if side > 1 {
            let half = side / 2;
            for corner in 0..8u32 {
                self.visit(&program, std::array::from_fn(|axis| at[axis] + (corner >> axis & 1) * half), half);
            }
            return;
        }
        self.kept += 1;
        // A change of sign among 5³ samples, the corners first.
        let inside = |p: DVec3| program.value(p) > 0.0;
        let first = inside(bounds.min);
        let changes = |p: DVec3| inside(p) != first;
        let at = |n: u32| DVec3::new(f64::from(n % 5), f64::from(n / 5 % 5), f64::from(n / 25)) / 4.0;
        let crossed =
            bounds.corners().into_iter().any(changes) || (0..125).any(|n| changes(bounds.min + at(n) * bounds.size()));
        self.crossed += u32::from(crossed);
    }
}

#[test]
fn few_cells_without_surface_are_kept() {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 1.1));
    let shapes = [
        ("superellipsoid", Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.9), 0.4, 0.7), 1.01),
        ("star", star().into(), 1.01),
        ("uneven", uneven().into(), 1.01),
        ("seven thirds", seven_thirds().into(), 1.01),
        ("turned nut", Solid::from(nut()).rotate(turn), 1.3),
    ];
    let mut failures = Vec::new();
    for (name, solid, allowed) in shapes {
        let program = solid.surface_program().unwrap();
        let half = 0.5 * solid.bounds().unwrap().longest_side() * 1.013;
        for across in [8, 32, 128] {
            let mut count = Count { half, across, kept: 0, crossed: 0 };
            // At the finer levels a sample of the blocks.
            let share = if across == 8 { 1.0 } else { 3.2 / f64::from(across) };
            let block = across / 8;
            let mut random = Random::new(76);
            for n in 0..512u32 {
                if !random.chance(share) {
                    continue;
                }
                count.visit(&program, [n % 8 * block, n / 8 % 8 * block, n / 64 * block], block);
            }
            let ratio = f64::from(count.kept) / f64::from(count.crossed);
            let line = format!("{name} at {across}³: {} kept, {} crossed, {ratio:.4}", count.kept, count.crossed);
            println!("{line}");
            if across == 128 && ratio > allowed {
                failures.push(format!("{line}; allowed {allowed}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
