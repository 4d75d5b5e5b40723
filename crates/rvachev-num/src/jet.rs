//! A range with those of its first and second derivatives: how far a gradient may turn in a box.
//!
//! ```text
//!     f(g)      f′·∂ᵢⱼg + f″·∂ᵢg·∂ⱼg
//!     f(g, h)   f_g·∂ᵢⱼg + f_h·∂ᵢⱼh + f_gg·∂ᵢg·∂ⱼg + f_gh·(∂ᵢg·∂ⱼh + ∂ⱼg·∂ᵢh) + f_hh·∂ᵢh·∂ⱼh
//! ```
//!
//! At a kink the gradient jumps: where a box may hold one, second derivatives are without bound.
//! So where they have one, the gradient is a continuous function that they bound the changes of.

use std::f64::consts::{LN_2, LOG2_E};
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Dual, Interval, Monotone, Monotone3, Norm, NormKind, OfOne, Real};

/// Ranges of a value, its derivatives with respect to three variables and their derivatives.
///
/// ```
/// use rvachev_num::{Interval, Jet, Real};
///
/// let [x, y, _] = Jet::point([Interval::new(3.0, 3.1), Interval::new(4.0, 4.1), Interval::point(0.0)]);
/// let length = (x.square() + y.square()).sqrt();
/// // y²/r³ and −xy/r³.
/// assert!(length.bend(0, 0).contains(16.0 / 125.0) && length.bend(0, 0).width() < 0.02);
/// assert!(length.bend(0, 1).contains(-12.0 / 125.0));
/// assert_eq!((x - 3.05).abs().bend(0, 0), Interval::ALL);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The value.
    pub v: Interval,
    /// Its derivatives.
    pub d: [Interval; 3],
    /// Those along x and x, y and y, z and z, x and y, x and z, y and z.
    h: [Interval; 6],
}

const ZERO: Interval = Interval::ZERO;

/// The two variables of each second derivative.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

impl Jet {
    /// The point as three variables.
    #[must_use]
    pub fn point(p: [Interval; 3]) -> [Jet; 3] {
        let variable = |axis: usize| {
            let mut jet = Jet::constant(p[axis]);
            jet.d[axis] = Interval::point(1.0);
            jet
        };
        [variable(0), variable(1), variable(2)]
    }

    /// A value of whose second derivatives nothing is known.
    #[must_use]
    pub fn unbounded(dual: Dual<Interval>) -> Jet {
        Jet { v: dual.v, d: dual.d, h: [Interval::ALL; 6] }
    }

    /// The value and its derivatives.
    #[must_use]
    pub fn dual(&self) -> Dual<Interval> {
        Dual::new(self.v, self.d)
    }

    /// The second derivative along two variables, each 0, 1 or 2.
    #[must_use]
    pub fn bend(&self, i: usize, j: usize) -> Interval {
        self.h[if i == j { i } else { i + j + 2 }]
    }

    /// How the derivatives change along a direction.
    #[must_use]
    pub fn turn(&self, direction: [Interval; 3]) -> [Interval; 3] {
        let term = |i: usize, j: usize| self.bend(i, j).times(direction[j]);
        [0, 1, 2].map(|i| term(i, 0).plus(term(i, 1)).plus(term(i, 2)))
    }

    fn constant(v: Interval) -> Jet {
        Jet { v, d: [ZERO; 3], h: [ZERO; 6] }
    }

    /// The value `v` of a function of this one, by its first and second derivatives.
    #[inline(never)]
    fn chain(&self, v: Interval, a: Interval, aa: Interval) -> Jet {
        let d = self.d.map(|d| d.times(a));
        let mut h = self.h.map(|h| h.times(a));
        if aa != ZERO {
            for (h, [i, j]) in h.iter_mut().zip(PAIRS) {
                let both = if i == j && self.d[i] != ZERO { self.d[i].square() } else { self.d[i].times(self.d[j]) };
                *h = h.plus(both.times(aa));
            }
        }
        Jet { v, d, h }
    }

    /// The same of two.
    #[inline(never)]
    fn chain2(&self, o: &Jet, v: Interval, [a, b]: [Interval; 2], [aa, ab, bb]: [Interval; 3]) -> Jet {
        let mut sum = self.chain(v, a, aa);
        let other = o.chain(v, b, bb);
        for axis in 0..3 {
            sum.d[axis] = sum.d[axis].plus(other.d[axis]);
        }
        for (at, [i, j]) in PAIRS.into_iter().enumerate() {
            let mixed = self.d[i].times(o.d[j]).plus(self.d[j].times(o.d[i]));
            sum.h[at] = sum.h[at].plus(other.h[at]).plus(mixed.times(ab));
        }
        sum
    }

    /// One of two with the value `v`, wherever which of them it is may change in the box.
    #[inline(never)]
    fn either(&self, o: &Jet, v: Interval) -> Jet {
        let d = [0, 1, 2].map(|axis| self.d[axis].hull(o.d[axis]));
        let mut h = [Interval::ALL; 6];
        for (at, [i, j]) in PAIRS.into_iter().enumerate() {
            // What neither has cannot jump.
            let is_still = |axis: usize| d[axis] == ZERO;
            if is_still(i) && is_still(j) && self.h[at] == ZERO && o.h[at] == ZERO {
                h[at] = ZERO;
            }
        }
        Jet { v, d, h }
    }

    /// One over the value.
    fn recip(&self) -> Jet {
        let inverse = Interval::point(1.0) / self.v;
        let squared = inverse.square();
        self.chain(inverse, -squared, squared * inverse * 2.0)
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet { v: -self.v, d: self.d.map(Neg::neg), h: self.h.map(Neg::neg) }
    }
}

impl Add for Jet {
    type Output = Jet;
    #[inline(never)]
    fn add(self, o: Jet) -> Jet {
        let mut sum = Jet::constant(self.v + o.v);
        for axis in 0..3 {
            sum.d[axis] = self.d[axis].plus(o.d[axis]);
        }
        for at in 0..6 {
            sum.h[at] = self.h[at].plus(o.h[at]);
        }
        sum
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, o: Jet) -> Jet {
        self + -o
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, o: Jet) -> Jet {
        self.chain2(&o, self.v * o.v, [o.v, self.v], [ZERO, Interval::point(1.0), ZERO])
    }
}

impl Div for Jet {
    type Output = Jet;
    fn div(self, o: Jet) -> Jet {
        self.mul(o.recip())
    }
}

impl Add<f64> for Jet {
    type Output = Jet;
    fn add(self, k: f64) -> Jet {
        Jet { v: self.v + k, ..self }
    }
}

impl Sub<f64> for Jet {
    type Output = Jet;
    fn sub(self, k: f64) -> Jet {
        Jet { v: self.v - k, ..self }
    }
}

impl Mul<f64> for Jet {
    type Output = Jet;
    #[inline(never)]
    fn mul(self, k: f64) -> Jet {
        if k == 1.0 {
            return self;
        }
        let scaled = |side: Interval| if k == 0.0 || side == ZERO { ZERO } else { side * k };
        Jet { v: scaled(self.v), d: self.d.map(scaled), h: self.h.map(scaled) }
    }
}

impl Real for Jet {
    fn lift(self, c: f64) -> Jet {
        Jet::constant(Interval::point(c))
    }

    fn scale_add(self, k: f64, b: Jet) -> Jet {
        if k == 0.0 { b } else { self * k + b }
    }

    fn square(self) -> Jet {
        self.chain(self.v.square(), self.v * 2.0, Interval::point(2.0))
    }

    #[inline(never)]
    fn abs(self) -> Jet {
        if self.v.lo() >= 0.0 {
            self
        } else if self.v.hi() < 0.0 {
            -self
        } else {
            self.either(&-self, self.v.abs())
        }
    }

    #[inline(never)]
    fn min(self, o: Jet) -> Jet {
        -(-self).max(-o)
    }

    #[inline(never)]
    fn max(self, o: Jet) -> Jet {
        if self.v.lo() >= o.v.hi() {
            self
        } else if o.v.lo() > self.v.hi() {
            o
        } else {
            self.either(&o, self.v.max(o.v))
        }
    }

    fn sqrt(self) -> Jet {
        let root = self.v.sqrt();
        let slope = Interval::point(0.5) / root;
        self.chain(root, slope, -(slope / self.v) * 0.5)
    }

    fn exp2(self) -> Jet {
        let v = self.v.exp2();
        self.chain(v, v * LN_2, v * (LN_2 * LN_2))
    }

    fn log2(self) -> Jet {
        let slope = Interval::point(LOG2_E) / self.v;
        self.chain(self.v.log2(), slope, -(slope / self.v))
    }

    #[inline(never)]
    fn pow(self, p: f64) -> Jet {
        if p == 1.0 {
            return self.abs();
        }
        let size = self.v.abs();
        // Powers of a negative exponent are without bound at 0.
        let power = |p: f64| match p {
            0.0 => Interval::point(1.0),
            p if p > 0.0 => size.pow(p),
            p => Interval::point(1.0) / size.pow(-p),
        };
        let slope = power(p - 1.0) * p;
        // At a cusp the slope jumps from one end to the other.
        let is_cusp = p < 1.0 && self.v.contains(0.0);
        let bend = if is_cusp { Interval::ALL } else { power(p - 2.0) * (p * (p - 1.0)) };
        self.chain(self.v.pow(p), self.v.select(slope, -slope), bend)
    }

    fn sin_cos(self) -> (Jet, Jet) {
        let (sin, cos) = self.v.sin_cos();
        (self.chain(sin, cos, -sin), self.chain(cos, -sin, -cos))
    }

    fn atan2(self, x: Jet) -> Jet {
        let squared = self.v.square() + x.v.square();
        let [a, b] = [x.v / squared, -self.v / squared];
        // What is made of an angle that jumps may have a kink there.
        let jumps = x.v.lo() <= 0.0 && self.v.contains(0.0);
        let second = match jumps {
            true => [Interval::ALL; 3],
            false => [a * b * 2.0, b.square() - a.square(), -(a * b * 2.0)],
        };
        self.chain2(&x, self.v.atan2(x.v), [a, b], second)
    }

    fn floor(self) -> Jet {
        let (v, slope) = self.v.floor_parts();
        if slope == ZERO { Jet::constant(v) } else { self.chain(v, slope, Interval::ALL) }
    }

    fn select(self, nonneg: Jet, neg: Jet) -> Jet {
        if self.v.lo() >= 0.0 {
            nonneg
        } else if self.v.hi() < 0.0 {
            neg
        } else {
            // What is chosen jumps wherever this changes its sign, constants as well.
            let mut jet = nonneg.either(&neg, nonneg.v.hull(neg.v));
            for (h, [i, j]) in jet.h.iter_mut().zip(PAIRS) {
                if nonneg != neg && (self.d[i] != ZERO || self.d[j] != ZERO) {
                    *h = Interval::ALL;
                }
            }
            jet
        }
    }

    fn log2_sum_exp2(self, o: Jet) -> Jet {
        let v = self.v.log2_sum_exp2(o.v);
        let one = Interval::point(1.0);
        let [a, b] = [(self.v - v).exp2().min(one), (o.v - v).exp2().min(one)];
        let both = a * b * LN_2;
        self.chain2(&o, v, [a, b], [both, -both, both])
    }

    #[inline(never)]
    fn norm(self, o: Jet, norm: Norm) -> Jet {
        let (v, a, b) = self.v.norm_parts(o.v, norm);
        self.chain2(&o, v, [a, b], norm_bends([self.v, o.v], v, [a, b], norm))
    }

    fn norm_parts(self, o: Jet, norm: Norm) -> (Jet, Jet, Jet) {
        let (v, a, b) = self.v.norm_parts(o.v, norm);
        let bends = norm_bends([self.v, o.v], v, [a, b], norm);
        let [aa, ab, bb] = bends;
        let slope = |v: Interval, by: [Interval; 2]| self.chain2(&o, v, by, [Interval::ALL; 3]);
        (self.chain2(&o, v, [a, b], bends), slope(a, [aa, ab]), slope(b, [ab, bb]))
    }

    fn norm_as<N: NormKind>(self, o: Jet, norm: N) -> Jet {
        self.norm(o, norm.norm())
    }

    fn of_one<F: OfOne>(self, function: &F) -> Jet {
        function.value(self)
    }

    // The formula tells how slopes change, the function's own slopes what they are.
    fn monotone<M: Monotone>(self, o: Jet, function: &M) -> Jet {
        if let Some(which) = function.only([self.v, o.v]) {
            return [self, o][which];
        }
        let (v, a, b) = function.parts(self.v, o.v);
        Jet { h: function.value(self, o).h, ..self.chain2(&o, v, [a, b], [ZERO; 3]) }
    }

    fn monotone3<M: Monotone3>(self, y: Jet, z: Jet, function: &M) -> Jet {
        if let Some(which) = function.only([self.v, y.v, z.v]) {
            return [self, y, z][which];
        }
        let (v, [a, b, c]) = function.parts(self.v, y.v, z.v);
        let both = self.chain2(&y, v, [a, b], [ZERO; 3]);
        let h = if M::ITERATES { [Interval::ALL; 6] } else { function.value(self, y, z).h };
        Jet { h, ..both.chain2(&z, v, [Interval::point(1.0), c], [ZERO; 3]) }
    }
}

/// The second derivatives of `N = ‖(a, b)‖` by a and a, a and b, b and b, from its slopes α and β:
/// with U = |a|/N and V = |b|/N they are (p − 1)/N times `U^(p−2)·V^p`, `−α·β` and `V^(p−2)·U^p`.
fn norm_bends([a, b]: [Interval; 2], v: Interval, [alpha, beta]: [Interval; 2], norm: Norm) -> [Interval; 3] {
    let kink = |side: Interval| if side.contains(0.0) { Interval::ALL } else { ZERO };
    match norm {
        Norm::Sum => [kink(a), ZERO, kink(b)],
        Norm::Max if a.abs().lo() > b.abs().hi() => [kink(a), ZERO, ZERO],
        Norm::Max if b.abs().lo() > a.abs().hi() => [ZERO, ZERO, kink(b)],
        Norm::Max => [Interval::ALL; 3],
        Norm::Euclid => [beta.square() / v, -(alpha * beta) / v, alpha.square() / v],
        Norm::P { p, .. } | Norm::Steep { p, .. } if p < 1.0 && (a.contains(0.0) || b.contains(0.0)) => {
            [Interval::ALL; 3]
        }
        Norm::P { p, .. } | Norm::Steep { p, .. } => {
            let share = Interval::new(0.0, 1.0);
            let power = |slope: Interval, exponent: f64| match exponent {
                0.0 => Interval::point(1.0),
                q if q > 0.0 => slope.abs().pow(q),
                q => Interval::point(1.0) / slope.abs().pow(-q),
            };
            // The slopes are U^(p−1) and V^(p−1).
            let steep = |slope: Interval| power(slope, (p - 2.0) / (p - 1.0));
            let part = |slope: Interval| power(slope, p / (p - 1.0)).narrowed_by(share);
            let factor = Interval::point(p - 1.0) / v;
            [steep(alpha) * part(beta) * factor, -(alpha * beta * factor), steep(beta) * part(alpha) * factor]
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// x + 2y + 3z, by iteration or not; how often it was run.
    struct Sum<const ITERATES: bool>(Cell<u32>);

    impl<const ITERATES: bool> Monotone3 for Sum<ITERATES> {
        const ITERATES: bool = ITERATES;

        fn value<R: Real>(&self, x: R, y: R, z: R) -> R {
            self.0.set(self.0.get() + 1);
            x + y * 2.0 + z * 3.0
        }

        fn parts<R: Real>(&self, x: R, y: R, z: R) -> (R, [R; 3]) {
            (x + y * 2.0 + z * 3.0, [1.0, 2.0, 3.0].map(|slope| x.lift(slope)))
        }
    }

    #[test]
    fn what_iterates_is_not_run_for_its_bends() {
        let [x, y, z] = Jet::point([Interval::new(0.0, 1.0); 3]);
        let (closed, found) = (Sum::<false>(Cell::new(0)), Sum::<true>(Cell::new(0)));
        let (sum, other) = (x.monotone3(y, z, &closed), x.monotone3(y, z, &found));
        assert_eq!((closed.0.get(), found.0.get()), (1, 0));
        assert_eq!((sum.d, sum.bend(0, 1), other.bend(0, 1)), (other.d, ZERO, Interval::ALL));
        assert!(sum.d[2].contains(3.0) && sum.d[2].width() < 1e-12);
    }

    /// x from −1 to 1, y about 1 and nothing.
    fn variables() -> [Jet; 3] {
        Jet::point([Interval::new(-1.0, 1.0), Interval::new(1.0, 1.1), ZERO])
    }

    #[test]
    fn cusps_bend_without_bound() {
        let [x, y, _] = variables();
        // Of √|x| the slope is −½ at −1 and ½ at 1.
        assert_eq!(x.pow(0.5).bend(0, 0), Interval::ALL);
        assert_eq!(x.pow(-0.5).bend(0, 0), Interval::ALL);
        assert!(x.pow(3.0).bend(0, 0).contains(6.0) && x.pow(3.0).bend(0, 0).hi() < 6.1);
        assert_eq!(x.norm(y, Norm::of_exponent(4.0)).bend(0, 0), Interval::ALL);
    }

    #[test]
    fn what_is_chosen_by_a_sign_jumps_where_it_changes() {
        let [x, y, _] = variables();
        let sign = x.select(x.lift(1.0), x.lift(-1.0));
        assert_eq!((x * sign).bend(0, 0), Interval::ALL);
        // Of y it is not chosen, and equal ones do not jump.
        assert_eq!(sign.bend(1, 1), ZERO);
        assert_eq!(y.select(x.lift(1.0), x.lift(-1.0)).bend(0, 0), ZERO);
        assert_eq!(x.select(y, y).bend(0, 0), ZERO);
    }
}
