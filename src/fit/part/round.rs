//! Round numbers: the scale on which most of the numbers of a part are short.
//!
//! A number is round on a scale if one of its steps has a multiple within the tolerance, and so few
//! of them that this is no chance. It then costs the bits that tell which multiple; any other
//! number costs all the bits down to the tolerance.

/// Steps from coarse to fine, each a numerator and a denominator: of whole numbers, the multiples
/// are the nearest numbers to what they are in decimals.
pub(super) struct Scale {
    steps: Vec<[f64; 2]>,
}

/// So many multiples of the tolerance a step has at the least, so that one number in ten is round
/// by chance.
const CHANCE: f64 = 20.0;

/// Lengths of an inch, where the unit is an inch, a millimetre, a centimetre or a metre.
const INCHES: [[f64; 2]; 4] = [[1.0, 1.0], [254.0, 10.0], [254.0, 100.0], [254.0, 10_000.0]];

impl Scale {
    fn decimal(size: f64) -> Scale {
        let most = size.log10().floor() as i32;
        let step = |k: f64, n: i32| if n < 0 { [k, 10f64.powi(-n)] } else { [k * 10f64.powi(n), 1.0] };
        Scale { steps: (most - 8..=most).rev().flat_map(|n| [step(5.0, n), step(1.0, n)]).collect() }
    }

    fn binary([inch, parts]: [f64; 2], size: f64) -> Scale {
        let most = (size * parts / inch).log2().floor() as i32;
        Scale { steps: (most - 20..=most).rev().map(|n| [inch * f64::from(n).exp2(), parts]).collect() }
    }

    /// The scale that the numbers, each with a tolerance, are shortest on.
    pub(super) fn of(numbers: &[(f64, f64)], size: f64) -> Scale {
        let mut scales = vec![Scale::decimal(size)];
        scales.extend(INCHES.map(|inch| Scale::binary(inch, size)));
        let cost = |scale: &Scale| numbers.iter().map(|(v, within)| scale.bits(*v, *within, size)).sum::<f64>();
        // Of two alike the first.
        let costs: Vec<f64> = scales.iter().map(cost).collect();
        let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
        let best = costs.iter().position(|cost| *cost <= least).unwrap_or(0);
        scales.swap_remove(best)
    }

    /// The round number within the tolerance, and its step.
    fn rounded(&self, value: f64, within: f64) -> Option<(f64, f64)> {
        let steps = self.steps.iter().map(|[n, d]| (n / d, [*n, *d])).take_while(|(step, _)| *step >= CHANCE * within);
        let mut rounded = steps.map(|(step, parts)| (multiple((value / step).round(), parts), step));
        rounded.find(|(round, _)| (value - round).abs() <= within)
    }

    fn bits(&self, value: f64, within: f64, size: f64) -> f64 {
        let step = self.rounded(value, within).map_or(0.25 * within, |(_, step)| step);
        (size / step).log2().max(0.0)
    }

    /// The round number within the tolerance.
    pub(super) fn round(&self, value: f64, within: f64) -> Option<f64> {
        self.rounded(value, within).map(|(round, _)| round)
    }

    /// The first round number beyond a value, at least so far, upwards or downwards.
    pub(super) fn beyond(&self, value: f64, least: f64, up: bool) -> f64 {
        let parts = self.steps.iter().copied().find(|[n, d]| n / d <= least).unwrap_or([least, 1.0]);
        let step = parts[0] / parts[1];
        let from = if up { value + least } else { value - least };
        multiple(if up { (from / step).ceil() } else { (from / step).floor() }, parts)
    }
}

/// A multiple of a step; never −0.
fn multiple(count: f64, [numerator, denominator]: [f64; 2]) -> f64 {
    count * numerator / denominator + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn millimetres_and_inches_are_told_apart() {
        let within = 1e-3;
        let millimetres: Vec<(f64, f64)> = [30.0004, 12.0, 3.4996, 22.0003, -0.0004].map(|v| (v, within)).to_vec();
        let scale = Scale::of(&millimetres, 80.0);
        let rounded: Vec<f64> = millimetres.iter().map(|(v, w)| scale.round(*v, *w).unwrap()).collect();
        assert_eq!(rounded, [30.0, 12.0, 3.5, 22.0, 0.0]);
        let inches: Vec<(f64, f64)> = [76.2004, 19.0497, 22.2252, 12.6999, 25.4].map(|v| (v, within)).to_vec();
        let scale = Scale::of(&inches, 110.0);
        let rounded: Vec<f64> = inches.iter().map(|(v, w)| scale.round(*v, *w).unwrap()).collect();
        assert_eq!(rounded, [76.2, 19.05, 22.225, 12.7, 25.4]);
    }

    #[test]
    fn what_is_not_round_is_left_alone() {
        let scale = Scale::of(&[(1.0, 1e-3), (2.5, 1e-3)], 10.0);
        let mut told = 0;
        for i in 0..1000 {
            told += usize::from(scale.round(10.0 * (f64::from(i) * 0.618_034).fract(), 1e-3).is_some());
        }
        assert!(told < 150, "{told}");
    }

    #[test]
    fn beyond_is_at_least_so_far() {
        let scale = Scale::of(&[(1.0, 1e-3), (2.5, 1e-3)], 100.0);
        assert_eq!(scale.beyond(3.9, 1.0, true), 5.0);
        assert_eq!(scale.beyond(-4.0, 1.2, false), -6.0);
    }
}
