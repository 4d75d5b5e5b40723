//! Values and gradients of a program at many points that lie about.
//!
//! Points are sorted into boxes, each with the program narrowed to it, until few are left or the
//! program is short; each box is a task of its own.

use glam::DVec3;

use crate::eval::{Evaluator, Gradients, Program, Region, Tape, with_evaluator};
use crate::{Bounds, Cancelled, Run};
use rvachev_num::jobs;

/// After so many points it is seen whether the work may go on, where each takes long.
const OFTEN: usize = 64;

/// So few points are not sorted any further.
const FEW: usize = 256;

/// Programs of so few leaves are not narrowed any further.
const SHORT: usize = 2;

/// What is compared with a tolerance is known to this part of it.
const PART: f64 = 0.02;

/// Values and gradients of `program`, to `precision` where single precision reaches it, else in
/// double precision, of points that are no farther from its surface than `reach`.
///
/// ```text
///     | . . . . |     A program that is narrowed to points within a wall knows the sign there, but
///     |  . . .  |     not how far it is to either side: neither is among them. So it is narrowed
///     | . . . . |     to all that is within reach of them. What is farther off is told to be that
///    reach           far or farther.
/// ```
#[derive(Clone, Copy)]
pub(crate) struct Slopes<'a> {
    pub(crate) program: &'a Program,
    pub(crate) precision: f64,
    pub(crate) reach: f64,
}

/// A value and its gradient.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slope {
    pub(crate) value: f64,
    pub(crate) gradient: DVec3,
}

impl Slope {
    /// The step to where a linear function of this value and gradient is 0.
    pub(crate) fn newton(&self) -> DVec3 {
        if self.is_told() { -self.value / self.gradient.length_squared() * self.gradient } else { DVec3::ZERO }
    }

    /// Whether there is a gradient, and all is finite.
    fn is_told(&self) -> bool {
        let square = self.gradient.length_squared();
        square > 1e-24 && square.is_finite() && self.value.is_finite()
    }

    /// How far that is; infinitely where the value or its gradient is not finite, or where there is
    /// a value and no gradient.
    pub(crate) fn distance(&self) -> f64 {
        let is_there = self.value == 0.0 && self.gradient.is_finite();
        if self.is_told() || is_there { self.newton().length() } else { f64::INFINITY }
    }

    /// The same of something that is to be on the surface: as far as it is long where nothing is
    /// told.
    pub(crate) fn distance_of(&self, length: f64) -> f64 {
        let distance = self.distance();
        if distance.is_finite() { distance } else { length }
    }

    /// The outward unit normal; 0 where there is no gradient.
    pub(crate) fn normal(&self) -> DVec3 {
        -self.gradient.normalize_or_zero()
    }

    /// How far a unit normal is turned from it, the length of their difference: the angle, if it is
    /// small; 0 where there is no gradient.
    pub(crate) fn turn(&self, normal: DVec3) -> f64 {
        let own = self.normal();
        if own == DVec3::ZERO { 0.0 } else { own.distance(normal) }
    }
}

/// Points of a box, by number, and the program there.
struct Task {
    numbers: Vec<u32>,
    bounds: Bounds,
    program: Program,
}

/// The box of some points.
fn hull(numbers: &[u32], points: &[DVec3]) -> Bounds {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for number in numbers {
        let p = points[*number as usize];
        (min, max) = (min.min(p), max.max(p));
    }
    Bounds::new(min, max)
}

impl<'a> Slopes<'a> {
    /// As precise as it takes to compare them with a tolerance.
    pub(crate) fn within(program: &'a Program, tolerance: f64) -> Slopes<'a> {
        Slopes { program, precision: PART * tolerance, reach: tolerance }
    }
}

impl Slopes<'_> {
    /// The slopes at points, in their order.
    pub(crate) fn at(&self, points: &[DVec3], run: &Run) -> Result<Vec<Slope>, Cancelled> {
        let tasks = self.tasks(points, run)?;
        let found: Result<Vec<Vec<Slope>>, Cancelled> = jobs::try_in_order(tasks.len(), |n| {
            run.check()?;
            with_evaluator(|evaluator| self.of_task(evaluator, &tasks[n], points, run))
        });
        let mut all = vec![Slope::default(); points.len()];
        for (task, found) in tasks.iter().zip(found?) {
            for (number, slope) in task.numbers.iter().zip(found) {
                all[*number as usize] = slope;
            }
        }
        Ok(all)
    }

    fn tasks(&self, points: &[DVec3], run: &Run) -> Result<Vec<Task>, Cancelled> {
        let numbers: Vec<u32> = (0..points.len() as u32).collect();
        let mut tasks = Vec::new();
        let mut pending = vec![(numbers, self.program.clone())];
        while let Some((numbers, program)) = pending.pop() {
            run.check()?;
            let bounds = hull(&numbers, points);
            if numbers.len() <= FEW || (program.leaf_count() <= SHORT && numbers.len() <= 64 * FEW) {
                tasks.push(Task { numbers, bounds, program });
                continue;
            }
            let (centre, count) = (bounds.center(), numbers.len());
            let mut parts: [Vec<u32>; 8] = Default::default();
            for number in numbers {
                let above = points[number as usize].cmpgt(centre);
                parts[above.bitmask() as usize].push(number);
            }
            // All at one place, or so near to it that no number is between them.
            if parts.iter().any(|part| part.len() == count) {
                let numbers = parts.into_iter().flatten().collect();
                tasks.push(Task { numbers, bounds, program });
                continue;
            }
            for part in parts.into_iter().filter(|part| !part.is_empty()) {
                let margin = self.reach + 1e-6 * bounds.longest_side();
                let program = match program.narrow(&hull(&part, points).inflate(margin)) {
                    Region::Surface(narrowed) => narrowed,
                    Region::Inside | Region::Outside => program.clone(),
                };
                pending.push((part, program));
            }
        }
        Ok(tasks)
    }

    fn of_task(
        &self,
        evaluator: &mut Evaluator,
        task: &Task,
        points: &[DVec3],
        run: &Run,
    ) -> Result<Vec<Slope>, Cancelled> {
        let tape = Tape::new(&task.program, &task.bounds);
        let exact = |(i, number): (usize, &u32)| {
            if i.is_multiple_of(OFTEN) {
                run.check()?;
            }
            let (value, gradient) = task.program.gradient(points[*number as usize]);
            Ok(Slope { value, gradient })
        };
        if tape.roundoff() > self.precision {
            return task.numbers.iter().enumerate().map(exact).collect();
        }
        let axis = |axis: usize| -> Vec<f32> {
            task.numbers.iter().map(|n| (points[*n as usize] - tape.origin())[axis] as f32).collect()
        };
        let (x, y, z) = (axis(0), axis(1), axis(2));
        let mut out = [(); 4].map(|()| vec![0.0f32; x.len()]);
        let [value, dx, dy, dz] = &mut out;
        evaluator.shortest_gradients(&tape, [&x, &y, &z], Gradients { value, dx, dy, dz });
        let slope = |i: usize| Slope {
            value: f64::from(out[0][i]),
            gradient: DVec3::new(f64::from(out[1][i]), f64::from(out[2][i]), f64::from(out[3][i])),
        };
        // Where the value rises slowly its rounding is a longer way.
        let tells = |slope: &Slope| slope.gradient.length() * self.precision >= tape.roundoff();
        let slopes = task.numbers.iter().enumerate().map(|(i, number)| {
            let slope = slope(i);
            if tells(&slope) { Ok(slope) } else { exact((i, number)) }
        });
        slopes.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::compiled;

    #[cfg(feature = "formula")]
    #[test]
    fn slow_values_are_as_near_as_lengths_are_to_be() {
        // The ball (1 - |p|²) / 10⁶, away from the origin, where single precision is coarse.
        let text = "a var-x\nb var-y\nc var-z\nm const 300\no const 1\nk const 0.000001\nd sub a m\nx square d\n\
                    y square b\nz square c\ns add x y\nt add s z\nu sub o t\nv mul u k\n";
        let bounds = Bounds::from_center(DVec3::X * 300.0, DVec3::splat(1.0));
        let solid = Solid::from(crate::Formula::from_vm(text, bounds).unwrap());
        let program = &compiled(&solid).unwrap().surface;
        let precision = 1.01 * Tape::new(program, &bounds).roundoff();
        let points: Vec<DVec3> = (0..200)
            .map(|n| DVec3::X * 300.0 + DVec3::new(0.6, 0.0, 0.0) + DVec3::splat(1e-3 * f64::from(n)))
            .collect();
        let found = Slopes { program, precision, reach: 1.0 }.at(&points, &Run::default()).unwrap();
        for (p, slope) in points.iter().zip(found) {
            let (value, gradient) = program.gradient(*p);
            let off = (slope.distance() - Slope { value, gradient }.distance()).abs();
            assert!(off < precision, "{off} at {p}, of {precision}");
        }
    }

    /// Points within a wall, none of which is at either side of it.
    #[test]
    fn within_reach_values_are_right() {
        let wall = Solid::sphere(2.0) - Solid::sphere(1.0) - Solid::sphere(0.002).translate([1.005, 0.005, 0.0]);
        let program = &compiled(&wall).unwrap().surface;
        let place = |n: u32| DVec3::new(1.002 + 2e-4 * f64::from(n % 30), 1.5e-3 * f64::from(n / 30), 0.0);
        let points: Vec<DVec3> = (0..600).map(place).collect();
        let slopes = Slopes { program, precision: 1e-6, reach: 0.02 };
        for (p, slope) in points.iter().zip(slopes.at(&points, &Run::default()).unwrap()) {
            assert!((slope.value - program.value(*p)).abs() < 1e-5, "{} at {p}", slope.value);
        }
    }

    #[test]
    fn points_that_no_number_is_between_are_one_task() {
        let ball = |x: f64| Solid::sphere(0.5).translate([x, 0.0, 0.0]);
        let solid = ball(0.0) | ball(1.0) | ball(2.0);
        let program = &compiled(&solid).unwrap().surface;
        let near = |n: u32| DVec3::new(1.0 + f64::EPSILON * f64::from(1 + n % 2), 0.5, 0.0);
        let points: Vec<DVec3> = (0..600).map(near).collect();
        let found = Slopes { program, precision: 1e-3, reach: 0.0 }.at(&points, &Run::default()).unwrap();
        assert!(found.iter().all(|slope| slope.distance() < 1e-3));
    }

    #[test]
    fn what_is_not_finite_or_has_no_gradient_is_far() {
        let flat = (0.5, DVec3::ZERO);
        for (value, gradient) in [(1.0, DVec3::INFINITY), (f64::NAN, DVec3::X), (0.0, DVec3::NAN), flat] {
            let slope = Slope { value, gradient };
            assert_eq!((slope.distance(), slope.distance_of(2.0)), (f64::INFINITY, 2.0), "{slope:?}");
            assert_eq!(slope.newton(), DVec3::ZERO, "{slope:?}");
        }
        assert_eq!(Slope { value: 0.0, gradient: DVec3::ZERO }.distance(), 0.0);
    }
}
