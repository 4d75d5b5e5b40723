//! Franklin and Barr's table, today: six methods of computing points of superquadrics, and the
//! throughput of subdivision. One thread.
//!
//! `cargo bench --bench points` prints, for the exponent n = 5, the time that each method takes for
//! 10 000 points and its ratio to method 1, beside the ratios printed in 1981 (a Prime 750); then,
//! for each of several exponents and tolerances, which method is best, and whether `Auto` is. Methods
//! are compared on the same kind of work: points of an octant or wedge in three arrays. A time is
//! the least of several rounds; rounds of the contestants alternate.

use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;
use std::time::Instant;

use glam::{DVec2, DVec3};
use rvachev::{
    ControlPolygon, ExactExplicit, LogTable, PointMethod, PowerTables, ProductTables, RawParametric, SeriesExplicit,
    Tension,
};

/// Points that times are given for. (Method 5 makes 101 × 101 at a time.)
const POINTS: usize = 10_000;

const ROUNDS: usize = 15;

/// Seconds of a turn, at least.
const TURN: f64 = 2e-3;

struct Contestant<'a> {
    number: u32,
    name: &'static str,
    method: Option<PointMethod>,
    error: f64,
    /// Points of a run.
    points: usize,
    run: Box<dyn FnMut() + 'a>,
    best: f64,
}

/// x and y of the wedge where the height is the largest coordinate, on nodes of a table.
struct Wedge {
    x: Vec<f64>,
    y: Vec<f64>,
    x32: Vec<f32>,
    y32: Vec<f32>,
    eta: Vec<f64>,
    omega: Vec<f64>,
    eta32: Vec<f32>,
    omega32: Vec<f32>,
}

impl Wedge {
    fn new(n: f64) -> Wedge {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let (mut x, mut y) = (vec![], vec![]);
        // The points of a picture's rows, as in the paper: nodes of a table, row by row.
        let top = 0.5f64.powf(1.0 / n);
        while x.len() < POINTS {
            let (a, b) = (random() * top, random() * top);
            let (a, b) = ((a.min(b) * 1000.0).round() / 1000.0, (a.max(b) * 1000.0).round() / 1000.0);
            if a.powf(n) + 2.0 * b.powf(n) <= 1.0 {
                x.push(a);
                y.push(b);
            }
        }
        let mut angle = || (0..POINTS).map(|_| random() * FRAC_PI_2).collect::<Vec<f64>>();
        let (eta, omega) = (angle(), angle());
        let single = |v: &[f64]| v.iter().map(|&c| c as f32).collect::<Vec<f32>>();
        let (x32, y32, eta32, omega32) = (single(&x), single(&y), single(&eta), single(&omega));
        Wedge { x, y, x32, y32, eta, omega, eta32, omega32 }
    }
}

/// Times the contestants in turn.
fn race(contestants: &mut [Contestant]) {
    for _ in 0..ROUNDS {
        for c in contestants.iter_mut() {
            let start = Instant::now();
            let mut runs = 0;
            while runs == 0 || start.elapsed().as_secs_f64() < TURN {
                (c.run)();
                runs += 1;
            }
            let each = start.elapsed().as_secs_f64() / f64::from(runs) / c.points as f64 * POINTS as f64;
            c.best = c.best.min(each);
        }
    }
}

fn contestants(n: f64, tolerance: f64, wedge: &Wedge) -> Vec<Contestant<'_>> {
    let e = 2.0 / n;
    let mut all: Vec<Contestant> = vec![];
    let mut add = |number, name, method, error, points, run| {
        all.push(Contestant { number, name, method, error, points, run, best: f64::INFINITY });
    };

    let raw = RawParametric::new(e, e).expect("a good exponent");
    let mut xyz = [(); 3].map(|()| vec![0.0f64; POINTS]);
    let run = move || {
        let [x, y, z] = &mut xyz;
        for i in 0..POINTS {
            [x[i], y[i], z[i]] = raw.point(wedge.eta[i], wedge.omega[i]);
        }
        black_box(&xyz);
    };
    add(
        1,
        "raw parametric, scalar f64",
        Some(PointMethod::RawParametric),
        1e-15,
        POINTS,
        Box::new(run) as Box<dyn FnMut()>,
    );
    let mut xyz32 = [(); 3].map(|()| vec![0.0f32; POINTS]);
    let run = move || {
        raw.octant_single(&wedge.eta32, &wedge.omega32, xyz32.each_mut().map(|v| v.as_mut_slice()));
        black_box(&xyz32);
    };
    add(1, "raw parametric, SIMD f32", None, 1e-6, POINTS, Box::new(run));

    let explicit = ExactExplicit::new(n).expect("a good exponent");
    let mut z = vec![0.0f64; POINTS];
    let run = move || {
        for ((&x, &y), z) in wedge.x.iter().zip(&wedge.y).zip(&mut z) {
            *z = explicit.height(x, y);
        }
        black_box(&z);
    };
    add(2, "exact explicit, scalar f64", Some(PointMethod::ExactExplicit), 1e-15, POINTS, Box::new(run));
    let mut z = vec![0.0f64; POINTS];
    let run = move || {
        explicit.heights(&wedge.x, &wedge.y, &mut z);
        black_box(&z);
    };
    add(2, "exact explicit, SIMD f64", None, 1e-14, POINTS, Box::new(run));
    let mut z = vec![0.0f32; POINTS];
    let run = move || {
        explicit.heights_single(&wedge.x32, &wedge.y32, &mut z);
        black_box(&z);
    };
    add(2, "exact explicit, SIMD f32", None, 1e-6, POINTS, Box::new(run));

    if let Ok(series) = SeriesExplicit::new(n, tolerance) {
        let mut z = vec![0.0f64; POINTS];
        let scalar = series.clone();
        let run = move || {
            for ((&x, &y), z) in wedge.x.iter().zip(&wedge.y).zip(&mut z) {
                *z = scalar.height(x, y);
            }
            black_box(&z);
        };
        let error = series.error_bound();
        add(3, "binomial series, scalar f64", Some(PointMethod::BinomialSeries), error, POINTS, Box::new(run));
        let mut z = vec![0.0f32; POINTS];
        let run = move || {
            series.heights_single(&wedge.x32, &wedge.y32, &mut z);
            black_box(&z);
        };
        add(3, "binomial series, SIMD f32", None, error + 1e-6, POINTS, Box::new(run));
    }
    let size = ((1.0 / tolerance) as u32).clamp(1000, 1 << 20);
    // A whole number of thousandths, so that the points are nodes.
    let size = size / 1000 * 1000;
    if let Ok(logs) = LogTable::new(n, size, tolerance) {
        let mut z = vec![0.0f32; POINTS];
        let error = logs.error_bound();
        let run = move || {
            logs.heights(&wedge.x32, &wedge.y32, &mut z);
            black_box(&z);
        };
        add(4, "series and log table", Some(PointMethod::LogTable), error, POINTS, Box::new(run));
    }
    let products = ProductTables::new(e, e, 50).expect("good exponents");
    let [rows, columns] = products.size();
    let mut out = [(); 3].map(|()| vec![0.0f32; rows * columns]);
    let single = products.clone();
    let run = move || {
        single.octant(out.each_mut().map(|v| v.as_mut_slice()));
        black_box(&out);
    };
    let points = rows * columns;
    add(5, "spherical product, SIMD f32", None, 3e-7, points, Box::new(run));
    let mut out = [(); 3].map(|()| vec![0.0f64; rows * columns]);
    let run = move || {
        products.octant_double(out.each_mut().map(|v| v.as_mut_slice()));
        black_box(&out);
    };
    add(5, "spherical product, SIMD f64", Some(PointMethod::SphericalProduct), 1e-15, points, Box::new(run));
    let tables = PowerTables::new(n, size).expect("a good exponent");
    let error = tables.error_bound();
    let mut z = vec![0.0f32; POINTS];
    let run = move || {
        tables.heights(&wedge.x32, &wedge.y32, &mut z);
        black_box(&z);
    };
    add(6, "explicit with power tables", Some(PointMethod::PowerTables), error, POINTS, Box::new(run));
    all
}

/// Ratios to method 1 as printed in 1981.
const PRINTED: [f64; 6] = [1.00, 1.93, 2.69, 5.09, 54.10, 219.00];

fn the_table() {
    let (n, tolerance) = (5.0, 1e-3);
    let wedge = Wedge::new(n);
    let mut all = contestants(n, tolerance, &wedge);
    race(&mut all);
    let first = all[0].best;
    println!("n = {n}, tolerance {tolerance}: time for {POINTS} points, ratio to method 1, error bound");
    println!("  # method                          ms      ns a point   ratio    1981");
    for c in &all {
        let printed = PRINTED[c.number as usize - 1];
        println!(
            "  {} {:30} {:7.4} {:10.2} {:9.1} {:7.2}   {:.0e}",
            c.number,
            c.name,
            c.best * 1e3,
            c.best * 1e9 / POINTS as f64,
            first / c.best,
            printed,
            c.error
        );
    }
    println!();
}

fn the_best() {
    println!("best method for whole octants, and for heights over given points (ns a point)");
    println!("      n  tolerance  octant                              heights                        Auto, ratio to 1");
    for n in [2.0, 5.0, 20.0, 50.0, 100.0] {
        let wedge = Wedge::new(n);
        for tolerance in [1e-3, 1e-5, 1e-12] {
            let mut all = contestants(n, tolerance, &wedge);
            race(&mut all);
            let first = all[0].best;
            let fastest = |numbers: &[u32]| {
                let fit = all.iter().filter(|c| c.error <= tolerance && numbers.contains(&c.number));
                fit.min_by(|a, b| a.best.total_cmp(&b.best)).expect("method 1 or 2 fits")
            };
            let each = |c: &Contestant| c.best * 1e9 / POINTS as f64;
            let (octant, heights) = (fastest(&[1, 2, 3, 4, 5, 6]), fastest(&[2, 3, 4, 6]));
            let auto = PointMethod::Auto.resolved();
            let chosen = all.iter().find(|c| c.method == Some(auto)).expect("every method runs");
            println!(
                "  {n:5}  {tolerance:9.0e}  {:28} {:5.2}  {:26} {:5.2}  {:?} {:.1}",
                octant.name,
                each(octant),
                heights.name,
                each(heights),
                auto,
                first / chosen.best
            );
        }
    }
    println!();
}

fn subdivision() {
    let tension = Tension::trigonometric(FRAC_PI_2).expect("a right angle");
    let flat: Vec<DVec2> = (0..64).map(|i| DVec2::from_angle(f64::from(i))).collect();
    let deep: Vec<DVec3> = flat.iter().map(|p| p.extend(p.x * p.y)).collect();
    let flat = ControlPolygon::closed(&flat, tension).expect("64 points");
    let deep = ControlPolygon::closed(&deep, tension).expect("64 points");
    let levels = 10;
    let vertices = flat.len() << levels;
    let time = |run: &mut dyn FnMut()| {
        let mut best = f64::INFINITY;
        for _ in 0..200 {
            let start = Instant::now();
            run();
            best = best.min(start.elapsed().as_secs_f64());
        }
        vertices as f64 / best / 1e6
    };
    let plane = time(&mut || {
        black_box(flat.subdivided(levels).expect("10 levels"));
    });
    let space = time(&mut || {
        black_box(deep.subdivided(levels).expect("10 levels"));
    });
    println!("subdivision of a closed polygon of 64 points by {levels} levels, one thread: Mvertex/s");
    println!("  in the plane {plane:8.0}\n  in space     {space:8.0}");
}

fn main() {
    the_table();
    the_best();
    subdivision();
}
