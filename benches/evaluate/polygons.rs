//! A polygon of 5000 edges: building it, its values through the hierarchy, and narrowed; and
//! polygons of very many edges that are long beside what is between them.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use glam::{DVec2, DVec3};
use rvachev::{
    Bounds, Polygon, Profile,
    program::{Program, Region},
};

use super::{Contestant, Points, ROUNDS, median, program, race};

const EDGES: u32 = 5000;

/// Regions about corners of the contour that the polygon is narrowed to.
const REGIONS: u32 = 16;

/// Points of a run: a chunk in one region.
const COUNT: usize = 256;

/// A gear-like contour about the unit circle.
fn corner(i: u32) -> DVec2 {
    let angle = TAU * f64::from(i) / f64::from(EDGES);
    DVec2::from_angle(angle) * (1.0 + 0.2 * (40.0 * angle).sin() + 0.01 * (700.0 * angle).sin())
}

fn cube(half: f64) -> impl Fn(u32) -> Bounds {
    move |i| Bounds::from_center(corner(i * EDGES / REGIONS).extend(0.0), DVec3::splat(half))
}

pub fn print() {
    let mut builds = Vec::new();
    for _ in 0..ROUNDS {
        let start = Instant::now();
        black_box(Polygon::new([(0..EDGES).map(corner)]));
        builds.push(1e3 * start.elapsed().as_secs_f64());
    }
    let solid = Profile::from(Polygon::new([(0..EDGES).map(corner)])).column();
    let whole = solid.field_program().expect("the polygon is valid");
    let all = Bounds::from_center(DVec3::ZERO, DVec3::splat(1.3));
    let near = |half: f64| (0..REGIONS).map(cube(half)).collect::<Vec<Bounds>>();
    let narrowed = |half: f64| near(half).into_iter().filter_map(|region| narrow(&whole, region)).collect::<Vec<_>>();
    let parts: [(&'static str, Vec<(Program, Bounds)>); 6] = [
        ("whole, over its box", vec![(whole.clone(), all)]),
        ("whole, 1/5 about the contour", near(0.1).into_iter().map(|region| (whole.clone(), region)).collect()),
        ("whole, 1/200 about it", near(0.0025).into_iter().map(|region| (whole.clone(), region)).collect()),
        ("narrowed to 1/5 about it", narrowed(0.1)),
        ("narrowed to 1/50 about it", narrowed(0.01)),
        ("narrowed to 1/200 about it", narrowed(0.0025)),
    ];
    let points: Vec<Vec<Points>> = parts
        .iter()
        .map(|(_, parts)| parts.iter().map(|(_, region)| Points::random(COUNT, region.half_extents())).collect())
        .collect();
    let mut contestants: Vec<Contestant<'_>> = Vec::new();
    for ((name, parts), points) in parts.iter().zip(&points) {
        let mut runs: Vec<Contestant<'_>> =
            parts.iter().zip(points).map(|((part, region), points)| program("", part, region, points)).collect();
        let mut turn = 0;
        let next = move || {
            turn = (turn + 1) % runs.len().max(1);
            if let Some((_, run)) = runs.get_mut(turn) {
                run();
            }
        };
        contestants.push((name, Box::new(next)));
    }
    println!("\nA polygon of {EDGES} edges, built in {:.2} ms", median(&mut builds));
    let speeds = race(COUNT, &mut contestants);
    for ((name, parts), speed) in parts.iter().zip(speeds) {
        println!("{name:32} {:8.2} ns a point, {} of {REGIONS} regions", 1e3 / speed, parts.len());
    }
    print_bristly();
}

/// A comb of so many teeth, a hundred times as long as wide, turned.
fn comb(teeth: u32, turn: f64) -> Vec<DVec2> {
    let tooth = |k: u32| {
        let (x, y) = (f64::from(k), 100.0 + f64::from(k).sin());
        [[x, 0.0], [x + 0.3, y], [x + 0.7, y], [x + 0.9, 0.0]]
    };
    let back = [[f64::from(teeth), -10.0], [0.0, -10.0]];
    let all = (0..teeth).flat_map(tooth).chain(back);
    all.map(|p| DVec2::from_angle(turn).rotate(DVec2::from(p))).collect()
}

/// Rays about a point.
fn fan(rays: u32) -> Vec<DVec2> {
    let radius = |i: u32| if i.is_multiple_of(2) { 1.0 } else { 100.0 };
    (0..2 * rays).map(|i| radius(i) * DVec2::from_angle(3.1 * f64::from(i) / f64::from(rays))).collect()
}

/// Of each how long it takes to build, and a value somewhere in its box.
fn print_bristly() {
    const MANY: u32 = 40_000;
    let all = [("comb", comb(MANY, 0.0)), ("comb, turned", comb(MANY, 0.6)), ("fan", fan(MANY))];
    for (name, contour) in all {
        let edges = contour.len();
        let start = Instant::now();
        let solid = Profile::polygon(contour).column();
        let whole = solid.field_program().expect("the polygon is valid");
        let build = start.elapsed().as_secs_f64();
        let mut bounds = solid.bounds().expect("the polygon is valid");
        (bounds.min.z, bounds.max.z) = (-1.0, 1.0);
        let points = Points::random(COUNT, bounds.half_extents());
        let region = Bounds::from_center(bounds.center(), bounds.half_extents());
        let speed = race(COUNT, &mut [program("", &whole, &region, &points)])[0];
        println!("{name:32} {:8.2} µs a point, {edges} edges, built in {:.0} ms", 1.0 / speed, 1e3 * build);
    }
}

fn narrow(whole: &Program, region: Bounds) -> Option<(Program, Bounds)> {
    match whole.narrow(&region) {
        Region::Surface(part) => Some((part, region)),
        Region::Inside | Region::Outside => None,
    }
}
