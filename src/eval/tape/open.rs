//! Points of a chunk at which a leaf may decide.
//!
//! ```text
//!     max(A, leaf)     where A is above the band, the leaf decides nothing: it counts as far
//!     min(A, leaf)     outside there, or, where A is below the band, as far inside
//! ```
//!
//! Joins rise with their operands. What counts as far outside where one of the joins around it is
//! above the band without it leaves that join between what it is without it and what it would be:
//! above the band as well.

use super::{LeafStep, Mode, Points, split_mut};
use crate::eval::register::Guard;
use rvachev_field::kernel::{CHUNK, Element};
use rvachev_field::{Op, VALUE_LIMIT};

/// Where the leaf may decide, and what it counts as elsewhere.
pub(super) struct Open<E> {
    places: [u16; CHUNK],
    count: usize,
    told: [E; CHUNK],
}

/// Where it may decide at more than this part of the points, it is evaluated at all of them.
const MOST: f64 = 0.8;

impl<E: Element> Open<E> {
    /// Those of so many points, by the registers of what the leaf is joined with.
    pub(super) fn of(guards: &[Guard], band: f64, registers: &[E], size: usize) -> Open<E> {
        let (low, high) = (E::from_f64(-band), E::from_f64(band));
        let (outside, inside) = (E::from_f64(-VALUE_LIMIT), E::from_f64(VALUE_LIMIT));
        let mut open = Open { places: [0; CHUNK], count: 0, told: [E::default(); CHUNK] };
        let mut is_told = [false; CHUNK];
        for guard in guards {
            let known = &registers[guard.register as usize * CHUNK..][..size];
            let is_outside = (guard.op == Op::Or) != guard.negated;
            let value = if is_outside { outside } else { inside };
            for ((known, told), is_told) in known.iter().zip(&mut open.told).zip(&mut is_told) {
                let decides = if guard.op == Op::Or { *known > high } else { *known < low };
                if decides {
                    (*told, *is_told) = (value, true);
                }
            }
        }
        for (place, is_told) in (0..).zip(&is_told[..size]) {
            open.places[open.count] = place;
            open.count += usize::from(!is_told);
        }
        open
    }

    /// Whether they are so few that it is worth while to take them apart.
    pub(super) fn is_few(&self, size: usize) -> bool {
        self.count as f64 <= MOST * size as f64
    }

    /// The leaf's values, as far as they count.
    pub(super) fn leaf<M: Mode<N, E = E>, const N: usize>(
        &self,
        (leaf, band): (&LeafStep, f64),
        points: [&[E]; 3],
        own: &mut [E],
        out: &mut [E],
    ) {
        out.copy_from_slice(&self.told[..out.len()]);
        let places = &self.places[..self.count];
        let Some(last) = places.last() else { return };
        let size = self.count.next_multiple_of(E::widest());
        let mut few = points.map(|axis| [axis[usize::from(*last)]; CHUNK]);
        for (axis, few) in points.iter().zip(&mut few) {
            for (place, few) in places.iter().zip(few) {
                *few = axis[usize::from(*place)];
            }
        }
        let mut values = vec![E::default(); N * CHUNK];
        let [x, y, z] = few.each_ref().map(|axis| &axis[..size]);
        M::leaf(leaf, band, Points::World([x, y, z]), own, split_mut(&mut values, size));
        for (place, value) in places.iter().zip(&values) {
            out[usize::from(*place)] = *value;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::eval::{Evaluator, Tape};
    use crate::{Blend, Bounds, Solid};

    /// Values within the band are right, and beyond it they are beyond it on the same side.
    #[test]
    fn what_decides_nothing_is_left_out() {
        let (plate, pin) = (Solid::cuboid([2.0, 2.0, 0.4]), Solid::cylinder(0.4, 1.0));
        let blended = |blend| plate.union_with(&pin, blend);
        let chamfered = blended(Blend::Chamfer { leg: 0.15 });
        let filleted = blended(Blend::Fillet { radius: 0.2 });
        let solids = [
            chamfered.clone(),
            chamfered.clone() - filleted.translate([0.9, 0.9, 0.3]),
            (filleted | chamfered.translate([0.1, 0.2, 0.7]))
                .intersection(&!plate.shell(0.05), crate::RFunction::MIN_MAX),
        ];
        const BAND: f32 = 0.03;
        let axis = |stride: usize| -> Vec<f32> { (0..4096).map(|n| (n / stride % 16) as f32 * 0.04).collect() };
        let (x, y, z) = (axis(1), axis(16), axis(256));
        for (number, solid) in solids.iter().enumerate() {
            let tape = Tape::new(&solid.surface_program().unwrap(), &Bounds::ALL);
            let (mut all, mut near) = (vec![0.0; x.len()], vec![0.0; x.len()]);
            let mut evaluator = Evaluator::new();
            evaluator.shortest_values(&tape, [&x, &y, &z], &mut all);
            evaluator.values_within(&tape, f64::from(BAND), [&x, &y, &z], &mut near);
            let (mut within, slack) = (0, tape.roundoff() as f32);
            for (n, (all, near)) in all.iter().zip(&near).enumerate() {
                within += usize::from(all.abs() < BAND);
                let is_same = if all.abs() < BAND {
                    (all - near).abs() <= slack
                } else {
                    (*all > 0.0) == (*near > 0.0) && near.abs() >= BAND - slack
                };
                assert!(is_same, "{number}: {all} and {near} at {} {} {}", x[n], y[n], z[n]);
            }
            assert!(within > 20 && within < 3000, "{number}: {within}");
        }
    }
}
