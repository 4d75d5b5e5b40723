//! Supertoroids, superhyperboloids and generalised superquadrics: known figures, volumes,
//! slopes, distances, ranges, boxes, and random search for numbers that are not finite.

use std::f64::consts::TAU;

use glam::DVec3;
use rvachev::{
    Bounds, GeneralisedSuperquadric, Interval, Solid, Superhyperboloid, Supertoroid,
    field::Field,
    program::{Evaluator, Gradients, Tape},
};

use crate::support::{Random, lanes32, lanes64, near, samples, value};

/// Logarithm of the gamma function: Stirling's series far out, from where the recurrence leads
/// back.
fn ln_gamma(x: f64) -> f64 {
    if x < 12.0 {
        return ln_gamma(x + 1.0) - x.ln();
    }
    let r = 1.0 / x;
    let tail = r / 12.0 - r.powi(3) / 360.0 + r.powi(5) / 1260.0 - r.powi(7) / 1680.0;
    (x - 0.5) * x.ln() - x + 0.5 * TAU.ln() + tail
}

fn gamma(x: f64) -> f64 {
    ln_gamma(x).exp()
}

fn beta(a: f64, b: f64) -> f64 {
    (ln_gamma(a) + ln_gamma(b) - ln_gamma(a + b)).exp()
}

/// Area of a superellipse with semi-axes 1.
fn area(e: f64) -> f64 {
    2.0 * e * beta(0.5 * e, 0.5 * e + 1.0)
}

fn toroid_volume(leaf: &Supertoroid) -> f64 {
    let [e1, e2] = leaf.exponents();
    let b = beta(0.5 * e1, 0.5 * e1 + 1.0) * beta(0.5 * e2, 0.5 * e2 + 1.0);
    8.0 * leaf.semi_axes().element_product() * leaf.ring() * e1 * e2 * b
}

fn generalised_volume(leaf: &GeneralisedSuperquadric) -> f64 {
    let inverse = leaf.exponents().map(f64::recip);
    let product: f64 = inverse.iter().map(|n| gamma(1.0 + n)).product();
    8.0 * leaf.semi_axes().element_product() * product / gamma(1.0 + inverse.iter().sum::<f64>())
}

/// The share of a sequence of points, evenly spread in the box, that is inside, as a volume.
fn counted_volume(solid: &Solid, count: u32) -> f64 {
    let bounds = solid.bounds().unwrap();
    // Multiples of powers of the root of x⁴ = x + 1.
    let spread = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    let points: Vec<DVec3> = (0..count)
        .map(|i| {
            let unit = DVec3::from_array(spread.map(|s| (0.5 + s * f64::from(i)).fract()));
            bounds.min + unit * bounds.size()
        })
        .collect();
    let inside = solid.contains_all(&points).unwrap().into_iter().filter(|inside| *inside).count();
    bounds.size().element_product() * inside as f64 / f64::from(count)
}

fn axes(random: &mut Random) -> DVec3 {
    random.vector(0.5, 1.5)
}

/// Convex exponents of generalised superquadrics.
const CONVEX: [[f64; 3]; 7] = [
    [2.0, 2.0, 2.0],
    [5.0, 3.0, 1.5],
    [1.0, 1.0, 1.0],
    [60.0, 1.0, 2.0],
    [1.2, 20.0, 40.0],
    [1.5, 1.1, 8.0],
    [3.0, 4.0, 60.0],
];

/// One of each kind, all of them 1-Lipschitz.
fn tame(random: &mut Random) -> Vec<Solid> {
    let mut solids: Vec<Solid> = Vec::new();
    for [e1, e2] in [[0.05, 0.4], [0.3, 0.7], [1.0, 1.0], [1.6, 0.5], [1.8, 2.0], [2.0, 2.0]] {
        solids.push(Supertoroid::new(axes(random), random.range(1.0, 3.0), e1, e2).into());
        for leaf in hyperboloids(random, e1, e2) {
            solids.push(leaf.into());
        }
    }
    solids.extend(CONVEX.map(|n| Solid::from(GeneralisedSuperquadric::new(axes(random), n))));
    solids
}

fn hyperboloids(random: &mut Random, e1: f64, e2: f64) -> [Superhyperboloid; 4] {
    let mut longer = |axis: f64| axis * random.range(1.1, 2.0);
    let a = DVec3::new(0.9, 0.7, 0.5);
    [
        Superhyperboloid::one_sheet(a, e1, e2, 2.0 * longer(a.z)),
        Superhyperboloid::one_sheet_x(a, e1, e2, 2.0 * longer(a.x)),
        Superhyperboloid::two_sheets(a, e1, e2, 2.0 * longer(a.z)),
        Superhyperboloid::two_sheets_x(a, e1, e2, 2.0 * longer(a.x)),
    ]
}

#[test]
fn a_known_supertoroid() {
    let leaf = Supertoroid::new(DVec3::new(1.2, 0.8, 0.6), 1.5, 0.3, 0.7);
    let p = DVec3::new(1.5, 0.4, 0.2);
    near(leaf.gauge(p), 0.336280192061495, 1e-14);
    near(leaf.barr(p), 0.336280192061495f64.powf(2.0 / 0.3), 1e-14);
    near(toroid_volume(&leaf), 23.439946622042, 1e-10);
    near(counted_volume(&leaf.into(), 15_000), 23.44, 0.15);
    let bounds = Solid::from(leaf).bounds().unwrap();
    near(bounds.max.distance(DVec3::new(3.0, 2.0, 0.6)), 0.0, 1e-12);
    // The round one, about a circle, is the torus.
    let ring = Solid::supertoroid(DVec3::splat(0.25), 4.0, 1.0, 1.0);
    let q = DVec3::new(0.9, -0.7, 0.2);
    near(value(&ring, q), 0.25 - (q.truncate().length() - 1.0).hypot(q.z), 1e-15);
}

#[test]
fn parametric_points_are_on_the_supertoroid() {
    let spow = |x: f64, e: f64| x.abs().powf(e).copysign(x);
    for [e1, e2] in [[0.05, 0.05], [0.3, 0.7], [1.0, 1.0], [2.0, 1.5], [3.0, 2.5]] {
        let leaf = Supertoroid::new(DVec3::new(1.2, 0.8, 0.6), 1.5, e1, e2);
        for i in 0..500 {
            let (h, w) = (0.618_033_988_7 * TAU * f64::from(i), 0.754_877_666_2 * TAU * f64::from(i));
            let across = 1.5 + spow(h.cos(), e1);
            let unit = DVec3::new(across * spow(w.cos(), e2), across * spow(w.sin(), e2), spow(h.sin(), e1));
            near(leaf.gauge(unit * leaf.semi_axes()), 1.0, if e1 > 2.0 { 1e-5 } else { 1e-13 });
        }
    }
}

#[test]
fn known_superhyperboloids() {
    let (a, p) = (DVec3::new(1.2, 0.8, 0.6), DVec3::new(1.0, 0.5, 0.7));
    near(Superhyperboloid::one_sheet(a, 0.4, 1.3, 4.0).unclipped(p), 0.108385205645, 1e-12);
    near(Superhyperboloid::two_sheets(a, 0.4, 1.3, 4.0).unclipped(p), -0.080346339887, 1e-12);
    let p = DVec3::new(2.0, 0.5, 0.7);
    near(Superhyperboloid::two_sheets_x(a, 0.4, 1.3, 4.0).unclipped(p), 0.143644190814, 1e-12);
    // The form along x is the other with its axes renamed.
    let turned = Superhyperboloid::one_sheet_x(DVec3::new(a.z, a.x, a.y), 0.4, 1.3, 4.0);
    near(turned.unclipped(DVec3::new(0.7, 1.0, 0.5)), 0.108385205645, 1e-12);
}

#[test]
fn parametric_points_are_on_the_superhyperboloids() {
    let (a, spow) = (DVec3::new(1.2, 0.8, 0.6), |x: f64, e: f64| x.abs().powf(e).copysign(x));
    for [e1, e2] in [[0.1, 0.4], [0.4, 1.3], [1.0, 1.0], [2.0, 1.5], [2.5, 3.0]] {
        let one = Superhyperboloid::one_sheet(a, e1, e2, 10.0);
        let two = Superhyperboloid::two_sheets(a, e1, e2, 10.0);
        let two_x = Superhyperboloid::two_sheets_x(a, e1, e2, 10.0);
        for i in 0..300 {
            let h = 1.2 * ((0.618_033_988_7 * f64::from(i)).fract() * 2.0 - 1.0);
            let w = 0.754_877_666_2 * TAU * f64::from(i);
            let (sec, tan) = (h.cos().recip().powf(e1), spow(h.tan(), e1));
            let ring = DVec3::new(spow(w.cos(), e2), spow(w.sin(), e2), 0.0);
            near(one.unclipped(a * (sec * ring + tan * DVec3::Z)), 0.0, 1e-12 * sec);
            near(two.unclipped(a * (tan.abs() * ring + sec * DVec3::Z)), 0.0, 1e-12 * sec);
            let v = 1.2 * ((0.754_877_666_2 * f64::from(i)).fract() * 2.0 - 1.0);
            let far = v.cos().recip().powf(e2);
            let p = DVec3::new(sec * far, sec * spow(v.tan(), e2), tan);
            near(two_x.unclipped(a * p), 0.0, 1e-12 * sec * far);
        }
    }
}

#[test]
fn volumes_of_superhyperboloids() {
    let (a, half) = (DVec3::new(1.2, 0.8, 0.6), 1.5);
    for [e1, e2] in [[1.0, 1.0], [0.4, 1.3], [2.0, 0.3]] {
        let p = 2.0 / e1;
        // Sections across z are superellipses; the integral over z by the midpoint rule.
        let steps = 4000;
        let sections = |radius: &dyn Fn(f64) -> f64| -> f64 {
            let at = |i: u32| radius(half / a.z * (f64::from(i) + 0.5) / f64::from(steps)).powi(2);
            2.0 * half / f64::from(steps) * (0..steps).map(at).sum::<f64>() * a.x * a.y * area(e2)
        };
        let one = sections(&|z| (1.0 + z.powf(p)).powf(1.0 / p));
        let two = sections(&|z| (z.powf(p) - 1.0).max(0.0).powf(1.0 / p));
        let got = counted_volume(&Superhyperboloid::one_sheet(a, e1, e2, 2.0 * half).into(), 15_000);
        near(got / one, 1.0, 0.01);
        let got = counted_volume(&Superhyperboloid::two_sheets(a, e1, e2, 2.0 * half).into(), 15_000);
        near(got / two, 1.0, 0.01);
    }
    // Quadrics: 2π(t³/3 − t + 2/3) in units of the semi-axes.
    let t: f64 = 2.0 / a.x;
    let want = TAU * (t.powi(3) / 3.0 - t + 2.0 / 3.0) * a.element_product();
    let got = counted_volume(&Superhyperboloid::two_sheets_x(a, 1.0, 1.0, 4.0).into(), 15_000);
    near(got / want, 1.0, 0.01);
    // Barr's form with p = 1 in its profile along z: |x| ≥ ‖(y, 1 + |z|)‖.
    let (p, steps) = (2.0 / 0.7, 400);
    let mut sum = 0.0;
    for i in 0..steps {
        let x = 1.0 + (t - 1.0) * (f64::from(i) + 0.5) / f64::from(steps);
        for j in 0..steps {
            let z = (x - 1.0) * (f64::from(j) + 0.5) / f64::from(steps);
            let width = (x.powf(p) - (1.0 + z).powf(p)).powf(1.0 / p);
            sum += width * (x - 1.0) * (t - 1.0) / f64::from(steps * steps);
        }
    }
    let got = counted_volume(&Superhyperboloid::two_sheets_x(a, 2.0, 0.7, 4.0).into(), 15_000);
    near(got / (8.0 * sum * a.element_product()), 1.0, 0.015);
}

#[test]
fn a_known_generalised_superquadric() {
    let leaf = GeneralisedSuperquadric::new(DVec3::ONE, [5.0, 3.0, 1.5]);
    let p = DVec3::new(0.7, 0.6, 0.5);
    near(leaf.barr(p), 0.737623390593, 1e-12);
    near(leaf.gauge(p), 0.898475217235, 1e-12);
    near(generalised_volume(&leaf), 5.374220338472, 1e-10);
    near(counted_volume(&leaf.into(), 15_000), 5.374, 0.03);
    near(leaf.radial_distance(p), p.length() * (1.0 - 1.0 / leaf.gauge(p)), 1e-15);

    let q = DVec3::new(0.3, -0.5, 0.9);
    let ball = GeneralisedSuperquadric::new(DVec3::ONE, [2.0; 3]);
    near(ball.gauge(q), q.length(), 1e-14);
    near(ball.inscribed_radius(), 1.0, 1e-12);
    let octahedron = GeneralisedSuperquadric::new(DVec3::ONE, [1.0; 3]);
    near(octahedron.gauge(q), q.abs().element_sum(), 1e-14);
    near(octahedron.inscribed_radius(), 1.0 / 3f64.sqrt(), 1e-6);
    for n in [[1.0, 2.0, 3.0], [0.3, 0.5, 40.0], [1.2, 7.0, 2.0]] {
        let leaf = GeneralisedSuperquadric::new(DVec3::new(0.7, 1.1, 0.9), n);
        near(counted_volume(&leaf.into(), 15_000) / generalised_volume(&leaf), 1.0, 0.03);
    }
}

#[test]
fn the_steps_of_the_gauge_suffice() {
    let mut random = Random::new(31);
    let mut worst = 0.0f64;
    let mut leaf = GeneralisedSuperquadric::new(DVec3::ONE, [2.0; 3]);
    for round in 0..8000 {
        let mut exponent =
            || if random.chance(0.3) { random.pick(&[0.2, 1.0, 2.0, 60.0]) } else { random.log_range(0.2, 60.0) };
        if round % 200 == 0 {
            // A leaf costs more than its gauge.
            leaf = GeneralisedSuperquadric::new(DVec3::ONE, [exponent(), exponent(), exponent()]);
        }
        let n = leaf.exponents();
        let mut coordinate =
            || if random.chance(0.3) { 1.0 } else { 2f64.powf(random.range(-1.0, 1.0) / random.pick(&n)) };
        let u = [coordinate(), coordinate(), coordinate()];
        let gauge = leaf.gauge(DVec3::from_array(u));
        // How far the sum is from 1, over its slope.
        let w: [f64; 3] = std::array::from_fn(|i| (u[i] / gauge).powf(n[i]));
        let slope: f64 = w.iter().zip(n).map(|(w, n)| w * n).sum();
        let error = ((w.iter().sum::<f64>() - 1.0) / slope).abs();
        assert!(error < 2e-14, "{error:e}: {u:?} with {n:?}");
        worst = worst.max(error);
    }
    println!("gauges of generalised superquadrics: {worst:.1e}");
}

#[test]
fn the_inscribed_radius_is_the_least_radius() {
    let mut random = Random::new(32);
    for round in 0..20 {
        let n = CONVEX.get(round).copied().unwrap_or_else(|| [0; 3].map(|_| random.log_range(0.3, 60.0)));
        let leaf = GeneralisedSuperquadric::new(axes(&mut random), n);
        let mut least = f64::INFINITY;
        for i in 0..8_000u32 {
            let v = DVec3::from_array(
                [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3]
                    .map(|s| (s * f64::from(i)).fract()),
            );
            let v = if i % 2 == 0 { v / v.element_sum() } else { v.powf(6.0) / v.powf(6.0).element_sum() };
            let p = DVec3::from_array(std::array::from_fn(|k| leaf.semi_axes()[k] * v[k].powf(1.0 / n[k])));
            least = least.min(p.length());
        }
        least = least.min(leaf.semi_axes().min_element());
        let found = leaf.inscribed_radius();
        assert!(found <= least * (1.0 + 1e-12) && found > 0.97 * least, "{leaf:?}: {found}, sampled {least}");
    }
}

#[test]
fn slopes_are_at_most_one() {
    let mut random = Random::new(33);
    for solid in tame(&mut random) {
        let reach = 1.5 * solid.bounds().unwrap().half_extents().max_element();
        let points: Vec<DVec3> = (0..250).map(|_| random.vector(-reach, reach)).collect();
        let slopes = solid.gradients(&points).unwrap();
        let most = slopes.iter().map(|g| g.length()).fold(0.0, f64::max);
        assert!(most <= 1.0 + 1e-11, "{solid:?}: {most}");
        assert!(most > 0.8, "{solid:?}: {most}");
        for pair in points.windows(2) {
            let change = (value(&solid, pair[0]) - value(&solid, pair[1])).abs();
            assert!(change <= pair[0].distance(pair[1]) * (1.0 + 1e-12), "{solid:?}");
        }
    }
}

#[test]
fn the_value_and_the_radial_distance_enclose_the_distance() {
    let mut random = Random::new(34);
    for n in CONVEX {
        let leaf = GeneralisedSuperquadric::new(axes(&mut random), n);
        let solid = Solid::from(leaf);
        const ACROSS: u32 = 40;
        let mut surface = Vec::new();
        for face in 0..6usize {
            for i in 0..=ACROSS {
                for j in 0..=ACROSS {
                    let at = |k: u32| 2.0 * f64::from(k) / f64::from(ACROSS) - 1.0;
                    let mut p = [if face % 2 == 0 { 1.0 } else { -1.0 }, at(i), at(j)];
                    p.rotate_right(face / 2);
                    let p = DVec3::from_array(p) * leaf.semi_axes();
                    surface.push(p / leaf.gauge(p));
                }
            }
        }
        let spacing = 6.0 * leaf.semi_axes().length() / f64::from(ACROSS);
        for _ in 0..40 {
            let p = random.vector(-2.0, 2.0);
            let distance = surface.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
            assert!(value(&solid, p).abs() <= distance * (1.0 + 1e-12), "{leaf:?} at {p}");
            assert!(distance <= leaf.radial_distance(p).abs() + spacing, "{leaf:?} at {p}");
        }
    }
}

/// The least and the largest value over points of a box, the grid's ends among them.
fn sampled(leaf: &impl Field, region: [Interval; 3], across: u32) -> (f64, f64) {
    let at = |side: Interval, i: u32| side.lo() + side.width() * f64::from(i) / f64::from(across);
    let mut found = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..=across {
        for j in 0..=across {
            for k in 0..=across {
                let v = leaf.eval([at(region[0], i), at(region[1], j), at(region[2], k)]);
                found = (found.0.min(v), found.1.max(v));
            }
        }
    }
    found
}

fn tight(leaf: &impl Field, random: &mut Random) {
    for _ in 0..12 {
        let centre = random.vector(-2.0, 2.0);
        let half = random.log_range(0.01, 0.5);
        let region = [0, 1, 2].map(|i| Interval::new(centre[i] - half, centre[i] + half));
        let range = leaf.range(region);
        let (lo, hi) = sampled(leaf, region, 8);
        assert!(range.lo() <= lo && hi <= range.hi(), "{leaf:?}: {lo} to {hi} is not in {range:?}");
        // A grid of nine misses the extremes by half a step at most, and slopes are 1.
        let slack = 0.25 * half;
        assert!(range.lo() > lo - slack, "{leaf:?}: {lo} to {hi}, {range:?}");
        // Leaves of several parts look closer only where the sign is open.
        let open = range.contains(0.0);
        assert!(!open || range.hi() < hi + slack, "{leaf:?}: {lo} to {hi}, {range:?}");
        assert!(open || lo > 0.0 || hi < 0.0, "{leaf:?}: {lo} to {hi}, {range:?}");
    }
}

#[test]
fn ranges_are_exact() {
    let mut random = Random::new(35);
    for [e1, e2] in [[0.3, 0.7], [1.0, 1.0], [2.0, 0.5], [1.5, 2.0]] {
        tight(&Supertoroid::new(axes(&mut random), 1.3, e1, e2), &mut random);
        for leaf in hyperboloids(&mut random, e1, e2) {
            tight(&leaf, &mut random);
        }
    }
    for n in CONVEX {
        tight(&GeneralisedSuperquadric::new(axes(&mut random), n), &mut random);
    }
}

#[test]
fn a_box_beyond_the_rim_is_outside() {
    // h is positive in a part of the box, the slab in another: together nowhere.
    let leaf = Superhyperboloid::one_sheet(DVec3::ONE, 1.0, 1.0, 2.0);
    let region = [Interval::new(1.42, 1.5), Interval::point(0.0), Interval::new(0.9, 1.2)];
    assert!(leaf.range(region).hi() <= 1e-12, "{:?}", leaf.range(region));
}

#[test]
fn boxes_of_rotated_superquadrics_hold_them_and_touch_them() {
    let mut random = Random::new(36);
    let mut solids = tame(&mut random);
    solids.push(Supertoroid::new(DVec3::ONE, 1.4, 2.6, 3.0).into());
    solids.push(GeneralisedSuperquadric::new(DVec3::ONE, [0.5, 2.0, 0.8]).into());
    for solid in solids {
        let own = solid.bounds().unwrap();
        let turn = random.rotation();
        let rotated = solid.rotate(turn).bounds().unwrap();
        // Walk to the surface's farthest points along each axis: the best of many inside.
        let mut inside = Bounds::EMPTY;
        let points: Vec<DVec3> = (0..4000)
            .map(|i| {
                let p = random.point_in(&own);
                // Half of the points on the box's own faces, where flat ends are.
                if i % 2 == 0 {
                    p
                } else {
                    let axis = i / 2 % 3;
                    let mut q = p;
                    q[axis] = own.max[axis] * (1.0 - 1e-6);
                    q
                }
            })
            .collect();
        for (p, is) in points.iter().zip(solid.contains_all(&points).unwrap()) {
            if is {
                inside = inside.union(&Bounds::new(turn * *p, turn * *p));
            }
        }
        assert!(rotated.contains_bounds(&inside), "{solid:?}");
        let gap = (inside.min - rotated.min).max(rotated.max - inside.max).max_element();
        assert!(gap < 0.25 * rotated.longest_side(), "{solid:?}: {gap} of {}", rotated.longest_side());
    }
}

/// Any parameters of their ranges.
fn wild(random: &mut Random) -> Solid {
    let size = random.log_range(1e-6, 1e6);
    let axes = DVec3::from_array([0; 3].map(|_| (size * random.log_range(1e-3, 1e3)).clamp(1e-9, 1e9)));
    let mut e = || if random.chance(0.3) { random.pick(&[0.01, 1.0, 2.0, 10.0]) } else { random.log_range(0.01, 10.0) };
    let (e1, e2) = (e(), e());
    let longer = random.log_range(1.000_001, 900.0);
    match random.below(6) {
        0 => Supertoroid::new(axes, random.log_range(1.0, 1000.0), e1, e2).into(),
        1 => Superhyperboloid::one_sheet(axes, e1, e2, (2.0 * axes.z * longer * 1e-3).clamp(1e-9, 1e9)).into(),
        2 => Superhyperboloid::one_sheet_x(axes, e1, e2, (2.0 * axes.x * longer).min(1e9)).into(),
        3 => Superhyperboloid::two_sheets(axes, e1, e2, (2.0 * axes.z * longer).min(1e9)).into(),
        4 => Superhyperboloid::two_sheets_x(axes, e1, e2, (2.0 * axes.x * longer).min(1e9)).into(),
        _ => {
            let n = [0; 3]
                .map(|_| if random.chance(0.3) { random.pick(&[0.2, 1.0, 60.0]) } else { random.log_range(0.2, 60.0) });
            GeneralisedSuperquadric::new(axes, n).into()
        }
    }
}

#[test]
fn random_parameters_give_finite_numbers_and_sound_ranges() {
    let mut random = Random::new(37);
    for _ in 0..150 {
        let solid = wild(&mut random);
        let bounds = solid.bounds().unwrap_or_else(|error| panic!("{solid:?}: {error}"));
        assert!(bounds.is_finite(), "{solid:?}: {bounds:?}");
        let program = solid.field_program().unwrap();
        let mut points: Vec<DVec3> = (0..20).map(|_| random.point_in(&bounds)).collect();
        points.extend((0..10).map(|_| random.log_range(1e-12, 1e12) * random.direction()));
        for p in &mut points {
            if random.chance(0.3) {
                p[random.below(3)] = 0.0;
            }
        }
        points.push(DVec3::ZERO);
        for p in &points {
            let (v, g) = program.gradient(*p);
            assert!(v.is_finite() && g.is_finite(), "{solid:?} at {p}: {v}, {g}");
        }
        assert!(lanes64(&program, &Bounds::ALL, &points).iter().all(|v| v.is_finite()), "{solid:?}");
        assert!(lanes32(&program, &Bounds::ALL, &points).1.iter().all(|v| v.is_finite()), "{solid:?}");
        let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect::<Vec<f32>>());
        let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; points.len()]);
        let [value, dx, dy, dz] = &mut out;
        Evaluator::new()
            .gradients(&Tape::new(&program, &Bounds::ALL), &x, &y, &z, Gradients { value, dx, dy, dz })
            .unwrap();
        for (i, p) in points.iter().enumerate() {
            let all = out.each_ref().map(|column| column[i]);
            assert!(all.iter().all(|v| v.is_finite()), "{solid:?} at {p}: {all:?} on lanes");
        }
        for _ in 0..4 {
            let region = crate::support::random_box(&mut random, &bounds);
            let range = solid.range(&region).unwrap();
            for p in samples(&mut random, &region, 24) {
                let v = solid.value(p).unwrap();
                assert!(range.contains(v), "{solid:?}: {v} at {p} is not in {range:?} of {region:?}");
            }
        }
    }
}

#[test]
fn wrong_parameters_are_named() {
    let text = |solid: Solid| solid.bounds().unwrap_err().to_string();
    let one = DVec3::ONE;
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0, 0.5, 1e4] {
        assert!(text(Solid::supertoroid(one, bad, 1.0, 1.0)).starts_with("supertoroid: ring is "));
    }
    assert!(text(Solid::supertoroid(one, 2.0, f64::NAN, 1.0)).contains("e1 is NaN"));
    assert!(text(Superhyperboloid::one_sheet(one, 1.0, 20.0, 2.0).into()).contains("e2 is 20"));
    assert!(text(Superhyperboloid::one_sheet(one, 1.0, 1.0, f64::NAN).into()).contains("length is NaN"));
    assert!(text(Superhyperboloid::two_sheets(one, 1.0, 1.0, 2.0).into()).contains("length is 2, allowed: above 2"));
    assert!(text(Superhyperboloid::two_sheets_x(one, 1.0, 1.0, 4e3).into()).contains("up to 2000 times"));
    for bad in [f64::NAN, f64::INFINITY, 0.0, 0.1, 61.0, -2.0] {
        let solid = Solid::from(GeneralisedSuperquadric::new(one, [1.0, bad, 1.0]));
        assert!(text(solid).starts_with("generalised superquadric: exponents.n2 is "));
    }
}
