//! The table that an object stands on.

use glam::{DVec2, DVec3};

use super::grid::extent;
use super::linear::{Principal, quantile};
use super::random::Random;

/// Planes tried, and the points they are judged by.
const TRIES: usize = 100;
const JUDGES: usize = 256;

/// A plane is dropped that fewer than these of the first judges are on, or fewer of all of them
/// than that: a table has many more.
const FIRST: usize = 64;
const FEWEST: usize = 6;
const LEAST: usize = 20;

/// Points that planes are settled by, before all.
const SOME: usize = 400;

/// Directions of the outline of what is beside the plane.
const DIRECTIONS: u32 = 32;

/// A plane and how far from it points are that belong to it.
#[derive(Clone, Copy)]
pub(super) struct Table {
    normal: DVec3,
    offset: f64,
    half: f64,
}

impl Table {
    pub(super) fn holds(&self, p: DVec3) -> bool {
        (self.normal.dot(p) - self.offset).abs() <= self.half
    }
}

/// The plane that many points are of, which has nearly all others on one side, and reaches beyond
/// them.
pub(super) fn table(points: &[DVec3], random: &mut Random) -> Option<Table> {
    let [low, high] = extent(points);
    let size = high.distance(low);
    let judges: Vec<DVec3> = random.chosen(points.len(), JUDGES).into_iter().map(|i| points[i]).collect();
    let mut half = 0.01 * size;
    let mut best: (usize, Option<Table>) = (0, None);
    for _ in 0..TRIES {
        let [a, b, c] = [(); 3].map(|()| judges[random.below(judges.len())]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        let table = Table { normal, offset: normal.dot(a), half };
        let on = |judges: &[DVec3]| judges.iter().filter(|p| table.holds(**p)).count();
        let (first, others) = judges.split_at(FIRST.min(judges.len()));
        let mut count = on(first);
        if count * FIRST < FEWEST * first.len() {
            continue;
        }
        count += on(others);
        if count > best.0 {
            best = (count, Some(table));
        }
    }
    if best.0 * JUDGES < LEAST * judges.len() {
        return None;
    }
    let mut table = best.1?;
    let mut deviation = 0.0;
    for round in 1..=4 {
        // They are in random order.
        let some = if round < 4 { &points[..points.len().min(SOME)] } else { points };
        let on = some.iter().copied().filter(|p| table.holds(*p));
        if on.clone().count() < 4 {
            return None;
        }
        let plane = Principal::of(on);
        deviation = plane.variances[0].sqrt();
        half = half.min((4.0 * deviation).max(1e-9 * size));
        table = Table { normal: plane.axes.x_axis, offset: plane.axes.x_axis.dot(plane.mean), half };
    }
    let (on, rest): (Vec<DVec3>, Vec<DVec3>) = points.iter().partition(|p| table.holds(**p));
    let share = on.len() as f64 / points.len() as f64;
    if !(0.12..=0.9).contains(&share) || rest.len() < 8 {
        return None;
    }
    let above = rest.iter().filter(|p| table.normal.dot(**p) > table.offset).count() as f64 / rest.len() as f64;
    if (0.05..=0.95).contains(&above) {
        return None;
    }
    let u = table.normal.any_orthonormal_vector();
    let v = table.normal.cross(u);
    let flat = |points: &[DVec3]| -> Vec<DVec2> {
        points.iter().take(SOME).map(|p| DVec2::new(u.dot(*p), v.dot(*p))).collect()
    };
    let (on, rest) = (flat(&on), flat(&rest));
    let mut outside = vec![false; on.len()];
    for k in 0..DIRECTIONS {
        let direction = DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(DIRECTIONS));
        let mut along: Vec<f64> = rest.iter().map(|p| direction.dot(*p)).collect();
        let reach = quantile(&mut along, 0.98) + 0.02 * size;
        for (out, p) in outside.iter_mut().zip(&on) {
            *out |= direction.dot(*p) > reach;
        }
    }
    let beyond = outside.iter().filter(|out| **out).count();
    if beyond * 5 <= on.len() * 2 {
        return None;
    }
    Some(Table { half: half.max(3.0 * deviation), ..table })
}
