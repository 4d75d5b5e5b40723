//! What runs tapes: the memory that a thread brings.

use super::{Balls, Slopes, Tape, UnequalSlices, Values, execute};
use crate::Bounds;

/// Scratch memory for bulk evaluation, one per thread; it grows to what the largest tape
/// needs and is reused.
#[derive(Default)]
pub struct Evaluator {
    single: Memory<f32>,
    double: Memory<f64>,
    far: Vec<bool>,
}

#[derive(Default)]
pub(super) struct Memory<E> {
    pub(super) registers: Vec<E>,
    pub(super) slots: Vec<E>,
    pub(super) padded: Vec<E>,
    /// What a leaf or a deformation makes in its own coordinates.
    pub(super) own: Vec<E>,
}

/// Value and gradient at many points, as slices of one length.
pub struct Gradients<'a> {
    /// Values.
    pub value: &'a mut [f32],
    /// Derivatives along x.
    pub dx: &'a mut [f32],
    /// Derivatives along y.
    pub dy: &'a mut [f32],
    /// Derivatives along z.
    pub dz: &'a mut [f32],
}

impl Evaluator {
    /// An evaluator without memory yet.
    #[must_use]
    pub fn new() -> Evaluator {
        Evaluator::default()
    }

    /// Values at points relative to the tape's origin. Finite coordinates give finite values.
    ///
    /// # Errors
    /// [`UnequalSlices`] if the slices are not of one length; nothing is written then.
    pub fn values(
        &mut self,
        tape: &Tape,
        x: &[f32],
        y: &[f32],
        z: &[f32],
        out: &mut [f32],
    ) -> Result<(), UnequalSlices> {
        UnequalSlices::check(x.len(), [("y", y.len()), ("z", z.len()), ("out", out.len())])?;
        self.shortest_values(tape, [x, y, z], out);
        Ok(())
    }

    /// Values of as many points as the shortest of the slices holds.
    pub(crate) fn shortest_values(&mut self, tape: &Tape, points: [&[f32]; 3], out: &mut [f32]) {
        execute::<Values<f32>, 1>(tape, &mut self.single, (&[], f64::INFINITY), points, [out]);
    }

    /// The same for points in `region`, which is not relative to the origin; leaves of a union that
    /// it is outside of are left out: what is outside of all of them has any value below 0.
    /// Values beyond the band may be nearer to 0, not nearer than the band.
    pub(crate) fn values_in(
        &mut self,
        (tape, region): (&Tape, &Bounds),
        band: f64,
        points: [&[f32]; 3],
        out: &mut [f32],
    ) {
        tape.mark_far(region, &mut self.far);
        execute::<Values<f32>, 1>(tape, &mut self.single, (&self.far, band), points, [out]);
    }

    /// The same in any region.
    pub(crate) fn values_within(&mut self, tape: &Tape, band: f64, points: [&[f32]; 3], out: &mut [f32]) {
        execute::<Values<f32>, 1>(tape, &mut self.single, (&[], band), points, [out]);
    }

    /// [`values`](Evaluator::values) on lanes of `f64`: as accurate as
    /// [`Program::value`](crate::program::Program::value), to some 10⁻¹⁴ of the solid's size.
    ///
    /// # Errors
    /// [`UnequalSlices`] if the slices are not of one length; nothing is written then.
    pub fn values_f64(
        &mut self,
        tape: &Tape,
        x: &[f64],
        y: &[f64],
        z: &[f64],
        out: &mut [f64],
    ) -> Result<(), UnequalSlices> {
        UnequalSlices::check(x.len(), [("y", y.len()), ("z", z.len()), ("out", out.len())])?;
        self.shortest_values_f64(tape, [x, y, z], out);
        Ok(())
    }

    /// The same of as many points as the shortest of the slices holds.
    pub(crate) fn shortest_values_f64(&mut self, tape: &Tape, points: [&[f64]; 3], out: &mut [f64]) {
        execute::<Values<f64>, 1>(tape, &mut self.double, (&[], f64::INFINITY), points, [out]);
    }

    /// Values and gradients at points relative to the tape's origin.
    ///
    /// # Errors
    /// [`UnequalSlices`] if the slices are not of one length; nothing is written then.
    pub fn gradients(
        &mut self,
        tape: &Tape,
        x: &[f32],
        y: &[f32],
        z: &[f32],
        out: Gradients<'_>,
    ) -> Result<(), UnequalSlices> {
        let Gradients { value, dx, dy, dz } = &out;
        let lengths = [("y", y), ("z", z), ("value", &**value), ("dx", &**dx), ("dy", &**dy), ("dz", &**dz)];
        UnequalSlices::check(x.len(), lengths.map(|(name, slice)| (name, slice.len())))?;
        self.shortest_gradients(tape, [x, y, z], out);
        Ok(())
    }

    /// The same of as many points as the shortest of the slices holds.
    pub(crate) fn shortest_gradients(&mut self, tape: &Tape, points: [&[f32]; 3], out: Gradients<'_>) {
        let Gradients { value, dx, dy, dz } = out;
        execute::<Slopes, 4>(tape, &mut self.single, (&[], f64::INFINITY), points, [value, dx, dy, dz]);
    }

    /// The radii and middles of balls in which no value is above 0, of a program that is
    /// [`rolled`](crate::eval::Program::rolled).
    pub(crate) fn empty_balls(&mut self, tape: &Tape, points: [&[f32]; 3], [radius, x, y, z]: [&mut [f32]; 4]) {
        execute::<Balls, 4>(tape, &mut self.single, (&[], f64::INFINITY), points, [radius, x, y, z]);
    }
}
