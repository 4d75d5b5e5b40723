//! Sums, products and quotients of intervals.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Interval, product};

impl Neg for Interval {
    type Output = Interval;
    #[inline(always)]
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Add for Interval {
    type Output = Interval;
    #[inline(always)]
    fn add(self, o: Interval) -> Interval {
        Interval::outward(self.lo + o.lo, self.hi + o.hi)
    }
}

impl Sub for Interval {
    type Output = Interval;
    #[inline(always)]
    fn sub(self, o: Interval) -> Interval {
        Interval::outward(self.lo - o.hi, self.hi - o.lo)
    }
}

impl Mul for Interval {
    type Output = Interval;
    #[inline(always)]
    fn mul(self, o: Interval) -> Interval {
        let (a, b, c, d) = (self.lo * o.lo, self.lo * o.hi, self.hi * o.lo, self.hi * o.hi);
        Interval::among([a, b, c, d], || product(self.signs(), o.signs()))
    }
}

impl Div for Interval {
    type Output = Interval;
    #[inline(never)]
    fn div(self, o: Interval) -> Interval {
        if o.lo <= 0.0 && o.hi >= 0.0 {
            // One-sided divisors keep what they can say: [0, b] of a positive divisor.
            if self.lo >= 0.0 && o.lo == 0.0 && o.hi > 0.0 {
                return Interval { lo: (self.lo / o.hi).next_down().max(0.0), hi: f64::INFINITY };
            }
            return Interval::ALL;
        }
        let (a, b, c, d) = (self.lo / o.lo, self.lo / o.hi, self.hi / o.lo, self.hi / o.hi);
        Interval::among([a, b, c, d], || product(self.signs(), o.signs()))
    }
}

impl Add<f64> for Interval {
    type Output = Interval;
    #[inline(always)]
    fn add(self, k: f64) -> Interval {
        Interval::outward(self.lo + k, self.hi + k)
    }
}

impl Sub<f64> for Interval {
    type Output = Interval;
    #[inline(always)]
    fn sub(self, k: f64) -> Interval {
        Interval::outward(self.lo - k, self.hi - k)
    }
}

impl Mul<f64> for Interval {
    type Output = Interval;
    #[inline(always)]
    fn mul(self, k: f64) -> Interval {
        let (a, b) = (self.lo * k, self.hi * k);
        Interval::among([a, b, a, b], || product(self.signs(), (k < 0.0, k > 0.0)))
    }
}
