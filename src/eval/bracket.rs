//! A crossing between two ends that differ in sign: the false position method with halving
//! (Illinois), which never leaves the bracket.

/// What is known of a crossing, one value at a time.
#[derive(Clone, Copy)]
pub(crate) struct Bracket {
    ends: [f64; 2],
    values: [f64; 2],
    /// Whether the first end is inside.
    inside: bool,
    /// How often in a row the first end, or if it is below 0 the second, was the one to move.
    moved: i32,
    /// So many halvings come next, and so many the next time.
    halvings: u32,
    more: u32,
    /// Whether this step halves.
    halves: bool,
}

impl Bracket {
    /// After so many steps the ends are as close as they come.
    pub(crate) const MOST: usize = 80;

    pub(crate) fn new(ends: [f64; 2], values: [f64; 2]) -> Bracket {
        let inside = values[0] > 0.0;
        Bracket { ends, values, inside, moved: 0, halvings: 0, more: 1, halves: false }
    }

    /// Where the next value is asked for; nowhere if the ends are closer than `precision`.
    pub(crate) fn next(&mut self, precision: f64) -> Option<f64> {
        let ([t0, t1], [f0, f1]) = (self.ends, self.values);
        let width = t1 - t0;
        if width <= precision.max(4.0 * f64::EPSILON * t1.abs().max(f64::MIN_POSITIVE)) {
            return None;
        }
        let secant = t0 + width * (f0 / (f0 - f1));
        // Three sides in a row mean slow progress: halve, each time more often. (In a face the
        // value is level.)
        if self.moved.abs() >= 3 {
            (self.halvings, self.more) = (self.more, 2 * self.more);
        }
        self.halves = self.halvings > 0 || !(secant > t0 && secant < t1);
        self.halvings -= self.halvings.min(1);
        Some(if self.halves { 0.5 * (t0 + t1) } else { secant })
    }

    /// The value there.
    pub(crate) fn narrow(&mut self, t: f64, value: f64) {
        let first = (value > 0.0) == self.inside;
        let (at, other) = if first { (0, 1) } else { (1, 0) };
        (self.ends[at], self.values[at]) = (t, value);
        let way = if first { 1 } else { -1 };
        if self.moved * way > 0 {
            self.values[other] *= 0.5;
        }
        self.moved = if self.moved * way > 0 { self.moved + way } else { way };
        if self.halves {
            self.moved = 0;
        }
    }

    /// The middle of what is left.
    pub(crate) fn middle(&self) -> f64 {
        0.5 * (self.ends[0] + self.ends[1])
    }
}
