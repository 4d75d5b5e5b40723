//! Franklin and Barr's table, today: six methods of computing points of superquadrics, and the
//! throughput of subdivision. One thread.
//!
//! `cargo bench --bench points` prints, for the exponent n = 5, the time that each method takes for
//! 10 000 points and its ratio to method 1, beside the ratios printed in 1981 (a Prime 750); then,
//! for each of several exponents and tolerances, which method is best for heights over points that
//! are given, and which for whole surfaces, where `Auto` chooses. Exponents that are no whole
//! numbers are among them: whole powers are products, and cheaper. In the first two tables methods
//! are compared on the same kind of work: points of an octant or wedge in arrays. A time is the
//! least of several rounds; rounds of the contestants alternate.
//!
//! Words after `--` choose: `table`, `heights`, `surfaces`, `subdivision`.

use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;
use std::time::Instant;

use glam::{DVec2, DVec3};
use rvachev::{
    Superellipsoid, deg,
    points::{
        ExactExplicit, LogTable, PointMethod, PointSettings, PowerTables, ProductTables, RawParametric, SeriesExplicit,
    },
    rad,
    subdivision::{ControlPolygon, Tension},
};

/// Points that times are given for. (Method 5 makes 101 × 101 at a time.)
const POINTS: usize = 10_000;

const ROUNDS: usize = 15;

/// Seconds of a turn, at least.
const TURN: f64 = 2e-3;

struct Contestant<'a> {
    number: u32,
    name: &'static str,
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
    let mut add = |number, name, error, points, run| {
        all.push(Contestant { number, name, error, points, run, best: f64::INFINITY });
    };

    let raw = RawParametric::new(e, e).expect("a good exponent");
    let mut xyz = [(); 3].map(|()| vec![0.0f64; POINTS]);
    let run = move || {
        let [x, y, z] = &mut xyz;
        for i in 0..POINTS {
            [x[i], y[i], z[i]] = raw.point(rad(wedge.eta[i]), rad(wedge.omega[i]));
        }
        black_box(&xyz);
    };
    add(1, "raw parametric, scalar f64", 1e-15, POINTS, Box::new(run) as Box<dyn FnMut()>);
    let mut xyz32 = [(); 3].map(|()| vec![0.0f32; POINTS]);
    let run = move || {
        raw.octant_single(&wedge.eta32, &wedge.omega32, xyz32.each_mut().map(|v| v.as_mut_slice()));
        black_box(&xyz32);
    };
    add(1, "raw parametric, SIMD f32", 1e-6, POINTS, Box::new(run));

    let explicit = ExactExplicit::new(n).expect("a good exponent");
    let mut z = vec![0.0f64; POINTS];
    let run = move || {
        for ((&x, &y), z) in wedge.x.iter().zip(&wedge.y).zip(&mut z) {
            *z = explicit.height(x, y);
        }
        black_box(&z);
    };
    add(2, "exact explicit, scalar f64", 1e-15, POINTS, Box::new(run));
    let mut z = vec![0.0f64; POINTS];
    let run = move || {
        explicit.heights(&wedge.x, &wedge.y, &mut z);
        black_box(&z);
    };
    add(2, "exact explicit, SIMD f64", 1e-14, POINTS, Box::new(run));
    let mut z = vec![0.0f32; POINTS];
    let run = move || {
        explicit.heights_single(&wedge.x32, &wedge.y32, &mut z);
        black_box(&z);
    };
    add(2, "exact explicit, SIMD f32", 1e-6, POINTS, Box::new(run));

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
        add(3, "binomial series, scalar f64", error, POINTS, Box::new(run));
        let mut z = vec![0.0f32; POINTS];
        let run = move || {
            series.heights_single(&wedge.x32, &wedge.y32, &mut z);
            black_box(&z);
        };
        add(3, "binomial series, SIMD f32", error + 1e-6, POINTS, Box::new(run));
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
        add(4, "series and log table", error, POINTS, Box::new(run));
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
    add(5, "spherical product, SIMD f32", 3e-7, points, Box::new(run));
    let mut out = [(); 3].map(|()| vec![0.0f64; rows * columns]);
    let run = move || {
        products.octant_double(out.each_mut().map(|v| v.as_mut_slice()));
        black_box(&out);
    };
    add(5, "spherical product, SIMD f64", 1e-15, points, Box::new(run));
    let tables = PowerTables::new(n, size).expect("a good exponent");
    let error = tables.error_bound();
    let mut z = vec![0.0f32; POINTS];
    let run = move || {
        tables.heights(&wedge.x32, &wedge.y32, &mut z);
        black_box(&z);
    };
    add(6, "explicit with power tables", error, POINTS, Box::new(run));
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

const EXPONENTS: [f64; 7] = [2.0, 3.7, 5.0, 20.0, 33.3, 50.0, 100.0];
const TOLERANCES: [f64; 3] = [1e-3, 1e-5, 1e-12];

fn heights() {
    println!("heights over points that are given: the best method (ns a point), and exact explicit on SIMD lanes,");
    println!("as ratios to method 1");
    println!("      n  tolerance  best                          ns   ratio  explicit f64  explicit f32");
    for n in EXPONENTS {
        let wedge = Wedge::new(n);
        for tolerance in TOLERANCES {
            let mut all = contestants(n, tolerance, &wedge);
            race(&mut all);
            let first = all[0].best;
            let fit = all.iter().filter(|c| c.error <= tolerance && [2, 3, 4, 6].contains(&c.number));
            let best = fit.min_by(|a, b| a.best.total_cmp(&b.best)).expect("method 2 fits");
            let explicit = |name: &str| all.iter().find(|c| c.name == name).map_or(f64::NAN, |c| first / c.best);
            println!(
                "  {n:5}  {tolerance:9.0e}  {:28} {:5.2} {:7.1} {:13.1} {:13.1}",
                best.name,
                best.best * 1e9 / POINTS as f64,
                first / best.best,
                explicit("exact explicit, SIMD f64"),
                explicit("exact explicit, SIMD f32")
            );
        }
    }
    println!();
}

const METHODS: [PointMethod; 6] = [
    PointMethod::RawParametric,
    PointMethod::ExactExplicit,
    PointMethod::BinomialSeries,
    PointMethod::LogTable,
    PointMethod::SphericalProduct,
    PointMethod::PowerTables,
];

fn whole_surfaces() {
    println!("whole surfaces by Superellipsoid::points, tables, reflection and scaling included (ns a point);");
    println!("ratio: of Auto to method 1 at every point");
    println!(
        "      n  tolerance     1      2      3      4      5      6   best               Auto               ratio"
    );
    for n in EXPONENTS {
        let e = 2.0 / n;
        let raw = RawParametric::new(e, e).expect("a good exponent");
        let wedge = Wedge::new(n);
        for tolerance in TOLERANCES {
            let shape = Superellipsoid::new([1.0, 2.0, 3.0], e, e);
            let mut times = [f64::INFINITY; 7];
            let mut xyz = vec![[0.0; 3]; POINTS];
            for _ in 0..ROUNDS {
                for (method, best) in METHODS.into_iter().zip(&mut times) {
                    let settings = PointSettings { eighth: 24, method, tolerance };
                    // The others do not keep the tolerance.
                    let coarse = [PointMethod::LogTable, PointMethod::PowerTables].contains(&method);
                    if coarse && tolerance < 2e-6 {
                        continue;
                    }
                    let start = Instant::now();
                    let count = black_box(shape.points(&settings)).map_or(0, |points| points.len());
                    *best = best.min(start.elapsed().as_secs_f64() / count as f64);
                }
                let start = Instant::now();
                for (to, (&eta, &omega)) in xyz.iter_mut().zip(wedge.eta.iter().zip(&wedge.omega)) {
                    *to = raw.point(rad(eta), rad(omega));
                }
                black_box(&xyz);
                times[6] = times[6].min(start.elapsed().as_secs_f64() / POINTS as f64);
            }
            let first = times[6];
            let best = (0..6).min_by(|&i, &j| times[i].total_cmp(&times[j])).expect("six methods");
            let auto = PointMethod::Auto.resolved();
            let chosen = METHODS.iter().position(|&method| method == auto).expect("one of six");
            let each =
                times[..6].iter().map(|t| if t.is_finite() { format!("{:6.1}", t * 1e9) } else { "     -".into() });
            println!(
                "  {n:5}  {tolerance:9.0e} {}   {:18} {:18} {:5.1}",
                each.collect::<Vec<_>>().join(" "),
                format!("{:?}", METHODS[best]),
                format!("{auto:?}"),
                first / times[chosen]
            );
        }
    }
    println!();
}

fn subdivision() {
    let tension = Tension::trigonometric(deg(90.0)).expect("a right angle");
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
    let (mut fine, mut deep_fine) = (flat.clone(), deep.clone());
    let plane = [
        time(&mut || flat.subdivide_into(levels, black_box(&mut fine)).expect("10 levels")),
        time(&mut || drop(black_box(flat.subdivided(levels)))),
    ];
    let space = [
        time(&mut || deep.subdivide_into(levels, black_box(&mut deep_fine)).expect("10 levels")),
        time(&mut || drop(black_box(deep.subdivided(levels)))),
    ];
    println!("subdivision of a closed polygon of 64 points by {levels} levels, one thread: Mvertex/s");
    println!("               memory used again   fresh memory");
    println!("  in the plane {:17.0} {:14.0}", plane[0], plane[1]);
    println!("  in space     {:17.0} {:14.0}", space[0], space[1]);
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let wanted = |word: &str| words.is_empty() || words.iter().any(|w| w == word);
    if wanted("table") {
        the_table();
    }
    if wanted("heights") {
        heights();
    }
    if wanted("surfaces") {
        whole_surfaces();
    }
    if wanted("subdivision") {
        subdivision();
    }
}
