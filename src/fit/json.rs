//! Deviations as JSON.

use std::fmt::Write;

use glam::DVec3;

use super::deviations::Deviation;
use super::inspect::{Deviations, LeafDeviation};

impl Deviations {
    /// The report as one JSON object on one line, for other programs: the sizes of all deviations,
    /// and of each leaf the same and what was found of it. Lengths are in length units, in full;
    /// what is not finite is `null`.
    ///
    /// ```text
    /// {"points": 900, "mean": 0.01, "rms": 0.012, "median": 0.009, "percentile_95": 0.02, "largest": 0.03,
    ///  "leaves": [{"path": "union[1] / boss: cylinder", "points": 90, "mean": …, "rms": …, "median": …,
    ///   "percentile_95": …, "largest": …, "signed_median": 0.08, "spread": 0.01,
    ///   "least": {"deviation": -0.01, "place": [1.0, 2.0, 3.0]}, "greatest": {"deviation": …, "place": …},
    ///   "shift": [0.0, 0.0, 0.08], "growth": 0.0, "significance": 40.0, "is_off": true}]}
    /// ```
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::fit::inspect;
    /// use rvachev::{PointCloud, Solid};
    ///
    /// let scan = PointCloud::new(vec![DVec3::X * 2.5, DVec3::Y * 2.0])?;
    /// let report = inspect(&Solid::sphere(2.0).named("ball"), &scan)?;
    /// assert!(report.to_json().starts_with(r#"{"points": 2, "mean": 0.25, "#));
    /// assert!(report.to_json().contains(r#""path": "ball: sphere", "points": 2, "#));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn to_json(&self) -> String {
        let leaves: Vec<String> = self.leaves().iter().map(leaf).collect();
        format!("{{{}, \"leaves\": [{}]}}", sizes(&self.sizes()), leaves.join(", "))
    }
}

fn sizes(sizes: &Deviation) -> String {
    let Deviation { points, mean, rms, median, percentile_95, largest } = *sizes;
    let mut text = format!("\"points\": {points}");
    let numbers =
        [("mean", mean), ("rms", rms), ("median", median), ("percentile_95", percentile_95), ("largest", largest)];
    for (name, value) in numbers {
        let _ = write!(text, ", \"{name}\": {}", number(value));
    }
    text
}

fn leaf(leaf: &LeafDeviation) -> String {
    let extreme = |(deviation, place): (f64, DVec3)| {
        format!("{{\"deviation\": {}, \"place\": {}}}", number(deviation), numbers(place))
    };
    let fields = [
        ("signed_median", number(leaf.median)),
        ("spread", number(leaf.spread)),
        ("least", extreme(leaf.least)),
        ("greatest", extreme(leaf.greatest)),
        ("shift", numbers(leaf.shift)),
        ("growth", number(leaf.growth)),
        ("significance", number(leaf.significance)),
        ("is_off", leaf.is_off().to_string()),
    ];
    let fields: Vec<String> = fields.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
    format!("{{\"path\": {}, {}, {}}}", quoted(&leaf.owner.path), sizes(&leaf.sizes), fields.join(", "))
}

/// The shortest text that is read back as the same number.
pub(super) fn number(value: f64) -> String {
    match value {
        // Of −0, too.
        0.0 => "0.0".to_string(),
        _ if value.is_finite() => format!("{value:?}"),
        _ => "null".to_string(),
    }
}

pub(super) fn numbers<const N: usize>(values: impl Into<[f64; N]>) -> String {
    format!("[{}]", values.into().map(number).join(", "))
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04x}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
