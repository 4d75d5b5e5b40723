//! The field of equation 15: parts that are weighted by their sizes, joined by R_p with p = 2.
//!
//! ```text
//!     F = ∨ⱼ √(a₁a₂a₃)ⱼ fⱼ        fⱼ = 1 − G of a superquadric or supershape
//! ```
//!
//! The fields of other leaves are taken over their values in the middle, so that they are 1 there;
//! their semi-axes are half the sides of their boxes. What is intersected with a leaf has the
//! leaf's weight, as the boxes have that truncate supershapes.
//!
//! Source: Y. D. Fougerolle et al., *Rational supershapes for surface reconstruction*, equation 15.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::error::FitError;
use super::paper::{both, either};
use crate::distance::compiled_with;
use crate::eval::Compiled;
use crate::mesh::{Slope, Slopes};
use crate::{Cancelled, Form, Operation, Run, Solid, Superellipsoid, Supershape};

/// A solid by its weighted parts, operands before what is made of them.
pub(super) struct Weighted(Vec<Step>);

enum Step {
    /// A leaf, and what its values are multiplied by.
    Leaf(Arc<Compiled>, f64),
    /// The last two are joined.
    Join(Operation),
    /// What is outside of the last one.
    Outside,
}

/// What is left to do, the next at the end.
enum Work<'a> {
    /// A solid that is moved, with the product of the semi-axes that it is weighted by, its own if
    /// none is given.
    Visit(&'a Solid, DAffine3, Option<f64>),
    /// The same for what is joined to the operand before it.
    Others(Operation, &'a [Solid], DAffine3, Option<f64>),
    Do(Step),
}

/// The product of a leaf's semi-axes, and its middle; none of what has no ends.
fn size(leaf: &Solid) -> Result<Option<(f64, DVec3)>, FitError> {
    if let Form::Leaf(form) = leaf.form() {
        if let Some(leaf) = form.get::<Superellipsoid>() {
            return Ok(Some((leaf.semi_axes().element_product(), DVec3::ZERO)));
        }
        if let Some(leaf) = form.get::<Supershape>() {
            return Ok(Some((leaf.scale().element_product(), DVec3::ZERO)));
        }
    }
    let bounds = leaf.bounds()?;
    let half = 0.5 * bounds.size();
    Ok((half.is_finite() && half.min_element() > 0.0).then(|| (half.element_product(), bounds.min + half)))
}

impl Weighted {
    pub(super) fn of(solid: &Solid, run: &Run) -> Result<Weighted, FitError> {
        let mut steps = Vec::new();
        // The products of what is found and not joined yet: of a join that of its first leaf.
        let mut products = Vec::new();
        let mut works = vec![Work::Visit(solid, DAffine3::IDENTITY, None)];
        while let Some(work) = works.pop() {
            run.check()?;
            match work {
                Work::Visit(solid, map, given) => match solid.form() {
                    Form::Affine { operand, map: own, .. } => works.push(Work::Visit(operand, map * own, given)),
                    Form::Name { operand, .. } | Form::Paint { operand, .. } => {
                        works.push(Work::Visit(operand, map, given));
                    }
                    Form::Complement { operand } => {
                        works.extend([Work::Do(Step::Outside), Work::Visit(operand, map, given)]);
                    }
                    Form::Join { operation, operands: [first, others @ ..], .. }
                        if operation != Operation::SymmetricDifference =>
                    {
                        works.push(Work::Others(operation, others, map, given));
                        works.push(Work::Visit(first, map, given));
                    }
                    _ => {
                        let (step, product) = leaf(solid, map, given, run)?;
                        steps.push(step);
                        products.push(product);
                    }
                },
                Work::Others(operation, others, map, given) => {
                    let weight = if operation == Operation::Intersection { products.last().copied() } else { given };
                    for other in others.iter().rev() {
                        works.extend([Work::Do(Step::Join(operation)), Work::Visit(other, map, weight)]);
                    }
                }
                Work::Do(step) => {
                    if matches!(step, Step::Join(_)) {
                        products.pop();
                    }
                    steps.push(step);
                }
            }
        }
        Ok(Weighted(steps))
    }

    /// F and its gradient at points.
    pub(super) fn at(&self, points: &[DVec3], run: &Run) -> Result<Vec<Slope>, Cancelled> {
        let mut found: Vec<Vec<Slope>> = Vec::new();
        for step in &self.0 {
            let next = match step {
                Step::Leaf(programs, factor) => {
                    let mut own =
                        Slopes { program: &programs.surface, precision: 0.0, reach: f64::INFINITY }.at(points, run)?;
                    for slope in &mut own {
                        slope.value *= factor;
                        slope.gradient *= *factor;
                    }
                    own
                }
                Step::Outside => {
                    let inside = found.pop().unwrap_or_default();
                    inside.into_iter().map(|s| Slope { value: -s.value, gradient: -s.gradient }).collect()
                }
                Step::Join(operation) => {
                    let (b, a) = (found.pop().unwrap_or_default(), found.pop().unwrap_or_default());
                    a.iter().zip(&b).map(|(a, b)| joined(*operation, *a, *b)).collect()
                }
            };
            found.push(next);
        }
        Ok(found.pop().unwrap_or_default())
    }
}

/// A moved leaf, weighted by a product of semi-axes or its own, and that product.
fn leaf(solid: &Solid, map: DAffine3, given: Option<f64>, run: &Run) -> Result<(Step, f64), FitError> {
    let leaf = solid.affine(map);
    let programs = compiled_with(&leaf, &Run { progress: None, ..run.clone() })?;
    let own = size(solid)?;
    let scale = map.matrix3.determinant().abs();
    let product = given.or(own.map(|(product, _)| product * scale)).unwrap_or(1.0);
    let middle = match own {
        Some((_, middle)) => leaf.value(map.transform_point3(middle))?,
        None => 0.0,
    };
    // The middle of a ring is outside of it, and what has no ends has none.
    let middle = if middle > 0.0 { middle } else { product.cbrt() };
    Ok((Step::Leaf(programs, product.sqrt() / middle), product))
}

fn joined(operation: Operation, a: Slope, b: Slope) -> Slope {
    let (sign, (value, [by_a, by_b])) = match operation {
        Operation::Union => (1.0, either(a.value, b.value)),
        Operation::Difference => (-1.0, both(a.value, -b.value)),
        _ => (1.0, both(a.value, b.value)),
    };
    Slope { value, gradient: by_a * a.gradient + sign * by_b * b.gradient }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RFunction;

    /// Two superellipsoids, the second one with a hole: what the formula says.
    #[test]
    fn fields_are_those_of_the_formula() {
        let (a, b) = (Superellipsoid::new([1.0, 2.0, 3.0], 0.5, 0.8), Superellipsoid::new([2.0, 1.0, 0.5], 1.0, 0.3));
        let hole = Superellipsoid::new([0.4, 0.4, 2.0], 0.1, 1.0);
        let shift = DVec3::new(1.0, 0.5, -0.2);
        let solid =
            Solid::from(a).union((Solid::from(b) - Solid::from(hole)).scale(1.5).translate(shift), RFunction::MIN_MAX);
        let weighted = Weighted::of(&solid, &Run::default()).unwrap();
        let points: Vec<DVec3> =
            (0..60).map(|i| f64::from(i) * DVec3::new(0.031, 0.047, 0.023) + DVec3::new(-1.0, 0.1, -0.7)).collect();
        let found = weighted.at(&points, &Run::default()).unwrap();
        let moved = |h: DVec3| {
            let at: Vec<DVec3> = points.iter().map(|p| *p + h).collect();
            weighted.at(&at, &Run::default()).unwrap()
        };
        for (p, slope) in points.iter().zip(&found) {
            let f = |leaf: &Superellipsoid, p: DVec3, scale: f64| {
                (leaf.semi_axes().element_product() * scale.powi(3)).sqrt() * (1.0 - leaf.gauge(p / scale))
            };
            let second = both(f(&b, *p - shift, 1.5), -f(&hole, *p - shift, 1.5)).0;
            let wanted = either(f(&a, *p, 1.0), second).0;
            assert!((slope.value - wanted).abs() < 1e-9, "{p}: {} {wanted}", slope.value);
        }
        let h = 1e-5;
        for axis in DVec3::AXES {
            for ((up, down), slope) in moved(h * axis).iter().zip(&moved(-h * axis)).zip(&found) {
                let wanted = (up.value - down.value) / (2.0 * h);
                assert!((slope.gradient.dot(axis) - wanted).abs() < 1e-4 * (1.0 + wanted.abs()), "{wanted} {slope:?}");
            }
        }
    }

    #[test]
    fn many_operations_take_no_stack() {
        let mut solid = Solid::sphere(1.0);
        for i in 0..100_000 {
            solid = if i % 1000 == 0 { solid.translate([1e-6, 0.0, 0.0]) } else { solid.named("again") };
        }
        let weighted = Weighted::of(&solid, &Run::default()).unwrap();
        assert!(weighted.at(&[DVec3::ZERO], &Run::default()).unwrap()[0].value > 0.99);
    }
}
