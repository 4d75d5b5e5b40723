//! Lattices: measured walls, measured volumes, slopes, gradings.

use glam::DVec3;
use rvachev::{
    Bounds, Grading, Interval, MinimalSurface, NetworkLattice, SheetLattice, Solid,
    field::{Field, Real},
};

use crate::support::{Random, near, random_box, samples, value};

const SURFACES: [MinimalSurface; 3] = [MinimalSurface::Gyroid, MinimalSurface::SchwarzP, MinimalSurface::SchwarzD];

/// Rises along x and z, by at most 0.1 either way.
#[derive(Debug)]
struct Slanted {
    middle: f64,
    rise: f64,
}

impl Grading for Slanted {
    #[inline(always)]
    fn at<R: Real>(&self, [x, _, z]: [R; 3]) -> R {
        x.scale_add(self.rise, z * (0.5 * self.rise)) + self.middle
    }

    fn limits(&self) -> Interval {
        Interval::new(self.middle - 0.1, self.middle + 0.1)
    }
}

fn sheet(surface: MinimalSurface, thickness: f64) -> Solid {
    SheetLattice { surface, cell: 1.0, thickness }.into()
}

fn network(surface: MinimalSurface, fraction: f64) -> Solid {
    NetworkLattice { surface, cell: 1.0, fraction }.into()
}

/// The solids of the conformance tests, with their sizes.
pub fn lattices() -> Vec<(&'static str, Solid, f64)> {
    let [g, p, d] = SURFACES;
    vec![
        ("gyroid sheet", sheet(g, 0.1), 1.0),
        ("P sheet", sheet(p, 0.15), 1.0),
        ("D sheet", sheet(d, 0.08), 1.0),
        ("gyroid network", network(g, 0.3), 1.0),
        ("P network", network(p, 0.7), 1.0),
        ("D network", network(d, 0.2), 1.0),
        (
            "graded sheet",
            Solid::new(SheetLattice { surface: g, cell: 1.0, thickness: Slanted { middle: 0.12, rise: 0.05 } }),
            1.0,
        ),
        (
            "graded network",
            Solid::new(NetworkLattice { surface: d, cell: 1.0, fraction: Slanted { middle: 0.4, rise: 0.05 } }),
            1.0,
        ),
    ]
}

/// A lattice with a cell of 1.
pub fn random_lattice(random: &mut Random) -> Solid {
    let surface = random.pick(&SURFACES);
    if random.chance(0.5) {
        sheet(surface, random.range(0.02, 0.25))
    } else {
        network(surface, random.range(0.25, 0.75))
    }
}

/// A point of the surface in the middle of the walls, and its normal.
fn on_surface(random: &mut Random, half: &Solid) -> (DVec3, DVec3) {
    loop {
        let mut p = random.vector(0.0, 1.0);
        for _ in 0..40 {
            let (v, g) = (value(half, p), half.gradient(p).unwrap());
            p -= v / g.length_squared().max(0.05) * g;
        }
        if value(half, p).abs() < 1e-12 {
            return (p, half.gradient(p).unwrap().normalize());
        }
    }
}

/// How far the wall reaches from `p` along `n`.
fn reach(wall: &Solid, p: DVec3, n: DVec3, thickness: f64) -> f64 {
    let (mut lo, mut hi) = (0.0, 1.2 * thickness);
    for _ in 0..40 {
        let mid = 0.5 * (lo + hi);
        if value(wall, p + mid * n) > 0.0 { lo = mid } else { hi = mid }
    }
    lo
}

#[test]
fn walls_are_as_thick_as_asked() {
    let mut random = Random::new(711);
    let allowed = [
        (0.05, [0.005, 0.01, 0.005]),
        (0.1, [0.01, 0.02, 0.02]),
        (0.15, [0.02, 0.04, 0.05]),
        (0.2, [0.03, 0.07, 0.09]),
    ];
    for (i, surface) in SURFACES.into_iter().enumerate() {
        let half = network(surface, 0.5);
        for (thickness, allowed) in allowed {
            let wall = sheet(surface, thickness);
            let mut worst: f64 = 0.0;
            for _ in 0..60 {
                let (p, n) = on_surface(&mut random, &half);
                near(value(&wall, p), 0.5 * thickness, 1e-9);
                let measured = reach(&wall, p, n, thickness) + reach(&wall, p, -n, thickness);
                worst = worst.max((measured / thickness - 1.0).abs());
            }
            println!("{surface:?} wall of {thickness}: off by {:.2} %", 100.0 * worst);
            assert!(worst <= allowed[i], "{surface:?} wall of {thickness}: off by {worst}");
        }
    }
}

#[test]
fn networks_fill_what_they_are_asked_to() {
    // A grid over one period; an odd one, as D repeats within it.
    const ACROSS: usize = 41;
    let at = |i: usize| (i as f64 + 0.37) / ACROSS as f64;
    let grid: Vec<DVec3> = (0..ACROSS.pow(3))
        .map(|i| DVec3::new(at(i % ACROSS), at(i / ACROSS % ACROSS), at(i / ACROSS / ACROSS)))
        .collect();
    for surface in SURFACES {
        let fractions: &[f64] =
            if surface == MinimalSurface::SchwarzP { &[0.25, 0.4, 0.5, 0.75] } else { &[0.1, 0.3, 0.5, 0.9] };
        for &fraction in fractions {
            let inside = network(surface, fraction).contains_all(&grid).unwrap();
            let measured = inside.iter().filter(|inside| **inside).count() as f64 / grid.len() as f64;
            println!("{surface:?} of {fraction}: {measured:.4}");
            near(measured, fraction, 2e-3);
        }
    }
}

#[test]
fn slopes_are_within_what_is_stated() {
    let mut random = Random::new(712);
    let stated = [(1.08, 1.37), (1.63, 1.32), (1.11, 1.54)];
    for (surface, (wall, part)) in SURFACES.into_iter().zip(stated) {
        let (least, most) = if surface == MinimalSurface::SchwarzP { (0.25, 0.75) } else { (0.1, 0.9) };
        let cases = [
            (sheet(surface, 0.1), wall),
            (network(surface, least), part),
            (network(surface, 0.5), part),
            (network(surface, most), part),
        ];
        for (solid, stated) in cases {
            let mut steepest: f64 = 0.0;
            for _ in 0..2000 {
                steepest = steepest.max(solid.gradient(random.vector(0.0, 1.0)).unwrap().length());
            }
            assert!(steepest <= stated, "{surface:?}: {steepest}, stated {stated}");
        }
    }
}

#[test]
fn gradings_are_followed_and_cut() {
    let graded = Solid::new(SheetLattice {
        surface: MinimalSurface::Gyroid,
        cell: 1.0,
        thickness: Slanted { middle: 0.12, rise: 0.05 },
    });
    // The origin's periods are on the surface.
    for (at, thickness) in [(0.0, 0.12), (1.0, 0.17), (-1.0, 0.07), (5.0, 0.22), (-7.0, 0.02)] {
        near(value(&graded, DVec3::X * at), 0.5 * thickness, 1e-12);
    }
}

#[test]
fn ranges_hold_far_away_and_over_large_boxes() {
    let mut random = Random::new(713);
    for (name, solid, _) in lattices() {
        for center in [DVec3::ZERO, DVec3::new(300.0, -20.0, 1e3), DVec3::splat(1e7)] {
            let frame = Bounds::from_center(center, DVec3::splat(2.0));
            for _ in 0..40 {
                let bounds = random_box(&mut random, &frame);
                let range = solid.range(&bounds).unwrap();
                for p in samples(&mut random, &bounds, 30) {
                    let v = value(&solid, p);
                    assert!(range.contains(v), "{name}: {v} at {p} is not in {range:?} of {bounds:?}");
                }
            }
        }
    }
}

#[test]
fn wrong_lattices_are_named() {
    let surface = MinimalSurface::SchwarzP;
    let text = |solid: Solid| solid.bounds().unwrap_err().to_string();
    assert_eq!(text(sheet(surface, 0.3)), "sheet lattice: thickness is 0.3, allowed: 0.000001 to 0.25");
    assert_eq!(text(network(surface, 0.2)), "network lattice: fraction is 0.2, allowed: 0.25 to 0.75");
    assert_eq!(text(network(surface, f64::NAN)), "network lattice: fraction is -inf, allowed: 0.25 to 0.75");
    let endless = SheetLattice { surface, cell: f64::INFINITY, thickness: 0.1 };
    assert!(endless.check().is_err());
}
