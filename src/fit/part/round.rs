//! Round numbers: the scale on which most of the numbers of a part are short.
//!
//! A number is round on a scale if one of its steps has a multiple within the tolerance, and so few of them that this
//! is no chance. It then costs the bits that tell which multiple; any other number costs all the bits down to the
//! tolerance.

/// Steps from coarse to fine.
pub(super) struct Scale {
    steps: Vec<f64>,
}

/// So many multiples of the tolerance a step has at the least, so that one number in ten is round by chance.
const CHANCE: f64 = 20.0;

/// Lengths of an inch, where the unit is an inch, a millimetre, a centimetre or a metre.
const INCHES: [f64; 4] = [1.0, 25.4, 2.54, 0.0254];

impl Scale {
    fn decimal(size: f64) -> Scale {
        let most = size.log10().floor() as i32;
        let steps = (most - 8..=most).rev().flat_map(|n| [5.0, 1.0].map(|k| decimal_power(k, n)));
        Scale { steps: steps.collect() }
    }

    fn binary(inch: f64, size: f64) -> Scale {
        let most = (size / inch).log2().floor() as i32;
        Scale { steps: (most - 20..=most).rev().map(|n| inch * f64::from(n).exp2()).collect() }
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

    /// The step of which a multiple is within the tolerance of a number.
    fn step(&self, value: f64, within: f64) -> Option<f64> {
        let is_near = |step: &&f64| (value - (value / **step).round() * **step).abs() <= within;
        self.steps.iter().take_while(|step| **step >= CHANCE * within).find(is_near).copied()
    }

    fn bits(&self, value: f64, within: f64, size: f64) -> f64 {
        let step = self.step(value, within);
        (size / step.unwrap_or(0.25 * within)).log2().max(0.0)
    }

    /// The round number within the tolerance.
    pub(super) fn round(&self, value: f64, within: f64) -> Option<f64> {
        self.step(value, within).map(|step| multiple((value / step).round(), step))
    }

    /// The first round number beyond a value, at least so far, upwards or downwards.
    pub(super) fn beyond(&self, value: f64, least: f64, up: bool) -> f64 {
        let step = self.steps.iter().copied().find(|step| *step <= least).unwrap_or(least);
        let from = if up { value + least } else { value - least };
        let count = if up { (from / step).ceil() } else { (from / step).floor() };
        multiple(count, step)
    }
}

/// k·10ⁿ, the nearest number to it.
fn decimal_power(k: f64, n: i32) -> f64 {
    if n < 0 { k / 10f64.powi(-n) } else { k * 10f64.powi(n) }
}

/// The nearest number to a multiple of a step: of .001, which is none itself, 7 are .007.
fn multiple(count: f64, step: f64) -> f64 {
    let inverse = (1.0 / step).round();
    let is_part = step < 1.0 && (inverse * step - 1.0).abs() < 1e-12;
    // Never −0.
    (if is_part { count / inverse } else { count * step }) + 0.0
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
        let rounded: Vec<f64> = inches.iter().map(|(v, w)| scale.round(*v, *w).unwrap() / 25.4).collect();
        assert_eq!(rounded, [3.0, 0.75, 0.875, 0.5, 1.0]);
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
