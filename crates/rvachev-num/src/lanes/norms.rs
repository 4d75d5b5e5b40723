//! Norms of pairs and nested norms of triples, in log space.
//!
//! With `la = log2|a|` and `lb = log2|b|` the logarithm of a p-norm is
//!
//! ```text
//! L = max(la, lb) + log2(1 + 2^(−p·|la − lb|)) / p
//! ```
//!
//! and that of a nested norm is the same once more, of `L` and `log2|z|`: three logarithms,
//! two times `log2(1 + 2^−d)`, one `exp2` for the value and no division. The derivatives are
//! powers of ratios, that is differences of logarithms that are there already:
//!
//! ```text
//! ρ = ‖(x, y)‖_p    G = ‖(ρ, z)‖_q
//! ∂G/∂x = sign(x) · 2^((q − 1)(log2 ρ − log2 G) + (p − 1)(log2|x| − log2 ρ))
//! ∂G/∂z = sign(z) · 2^((q − 1)(log2|z| − log2 G))
//! ```

use super::LogSpace;
use crate::Norm;

/// The largest exponent of a slope and of a value relative to the largest coordinate. Both
/// are unbounded where p < 1.
const STEEPEST: f64 = 100.0;

/// The norm of a pair.
#[inline(always)]
pub(crate) fn norm<T: LogSpace>(a: T, b: T, norm: Norm) -> T {
    let (a, b) = (a.abs(), b.abs());
    match norm {
        Norm::Sum => (a + b).finite(),
        Norm::Max => a.max(b),
        Norm::Euclid => euclid(a, b),
        Norm::Steep { p, inv } => pair::<T, true>(a, b, p, inv),
        Norm::P { p, inv } => pair::<T, false>(a, b, p, inv),
    }
}

/// The norm of a pair and its derivatives.
#[inline(always)]
pub(crate) fn norm_parts<T: LogSpace>(a: T, b: T, norm: Norm) -> (T, T, T) {
    let (x, y) = (a, b);
    let (a, b) = (a.abs(), b.abs());
    match norm {
        Norm::Sum => {
            let value = (a + b).finite();
            let one = a.lift(1.0).vanish_with(value);
            (value, one.copysign(x), one.copysign(y))
        }
        Norm::Max => {
            let value = a.max(b);
            let da = a.above(b).vanish_with(a);
            let db = b.above(a).vanish_with(b);
            (value, da.copysign(x), db.copysign(y))
        }
        Norm::Euclid => euclid_pair_parts(x, y),
        Norm::Steep { p, inv } => pair_parts::<T, true>(x, y, p, inv),
        Norm::P { p, inv } => pair_parts::<T, false>(x, y, p, inv),
    }
}

/// `‖(‖(x, y)‖_inner, z)‖_outer`.
#[inline(always)]
pub(crate) fn nested<T: LogSpace>(x: T, y: T, z: T, inner: Norm, outer: Norm) -> T {
    match (inner, outer) {
        (Norm::P { p, inv }, Norm::P { p: q, inv: q_inv }) => triple::<T, false>([x, y, z], [p, inv, q, q_inv]),
        (Norm::Steep { p, inv }, Norm::Steep { p: q, inv: q_inv }) => triple::<T, true>([x, y, z], [p, inv, q, q_inv]),
        (Norm::Euclid, Norm::Euclid) => euclid3([x.abs(), y.abs(), z.abs()]),
        _ => norm(norm(x, y, inner), z, outer),
    }
}

/// [`nested`] and its derivatives.
#[inline(always)]
pub(crate) fn nested_parts<T: LogSpace>(x: T, y: T, z: T, inner: Norm, outer: Norm) -> (T, [T; 3]) {
    match (inner, outer) {
        (Norm::P { p, inv }, Norm::P { p: q, inv: q_inv }) => triple_parts::<T, false>([x, y, z], [p, inv, q, q_inv]),
        (Norm::Steep { p, inv }, Norm::Steep { p: q, inv: q_inv }) => {
            triple_parts::<T, true>([x, y, z], [p, inv, q, q_inv])
        }
        (Norm::Euclid, Norm::Euclid) => euclid_triple_parts([x, y, z]),
        _ => {
            let (rho, rho_x, rho_y) = norm_parts(x, y, inner);
            let (value, value_rho, value_z) = norm_parts(rho, z, outer);
            (value, [value_rho * rho_x, value_rho * rho_y, value_z])
        }
    }
}

/// The p-norm of two numbers ≥ 0. `STEEP`: p < 1.
#[inline(always)]
pub(crate) fn pair<T: LogSpace, const STEEP: bool>(a: T, b: T, p: f64, inv: f64) -> T {
    let power = a.max(b).power_below();
    let la = log2::<T, STEEP>(a, power);
    let lb = log2::<T, STEEP>(b, power);
    raise::<T, STEEP>(T::join(la, lb, p, inv), power)
}

/// The p-norm of two numbers and its derivatives.
#[inline(always)]
pub(crate) fn pair_parts<T: LogSpace, const STEEP: bool>(x: T, y: T, p: f64, inv: f64) -> (T, T, T) {
    let (a, b) = (x.abs(), y.abs());
    let power = a.max(b).power_below();
    let la = log2::<T, STEEP>(a, power);
    let lb = log2::<T, STEEP>(b, power);
    let l = T::join(la, lb, p, inv);
    let da = slope::<T, STEEP>((la - l) * (p - 1.0), a);
    let db = slope::<T, STEEP>((lb - l) * (p - 1.0), b);
    (raise::<T, STEEP>(l, power), da.copysign(x), db.copysign(y))
}

/// The nested norm with exponents p and q, given as `[p, 1/p, q, 1/q]`.
#[inline(always)]
pub(crate) fn triple<T: LogSpace, const STEEP: bool>([x, y, z]: [T; 3], [p, p_inv, q, q_inv]: [f64; 4]) -> T {
    let (a, b, c) = (x.abs(), y.abs(), z.abs());
    let power = a.max(b).max(c).power_below();
    let la = log2::<T, STEEP>(a, power);
    let lb = log2::<T, STEEP>(b, power);
    let lc = log2::<T, STEEP>(c, power);
    raise::<T, STEEP>(T::join(T::join(la, lb, p, p_inv), lc, q, q_inv), power)
}

/// [`triple`] and its derivatives.
#[inline(always)]
pub(crate) fn triple_parts<T: LogSpace, const STEEP: bool>(
    [x, y, z]: [T; 3],
    [p, p_inv, q, q_inv]: [f64; 4],
) -> (T, [T; 3]) {
    let (a, b, c) = (x.abs(), y.abs(), z.abs());
    let power = a.max(b).max(c).power_below();
    let la = log2::<T, STEEP>(a, power);
    let lb = log2::<T, STEEP>(b, power);
    let lc = log2::<T, STEEP>(c, power);
    let lr = T::join(la, lb, p, p_inv);
    let lg = T::join(lr, lc, q, q_inv);
    let base = (lr - lg) * (q - 1.0);
    let da = slope::<T, STEEP>((la - lr).scale_add(p - 1.0, base), a);
    let db = slope::<T, STEEP>((lb - lr).scale_add(p - 1.0, base), b);
    let dc = slope::<T, STEEP>((lc - lg) * (q - 1.0), c);
    (raise::<T, STEEP>(lg, power), [da.copysign(x), db.copysign(y), dc.copysign(z)])
}

/// The logarithm of a coordinate ≥ 0 relative to `power`. That of 0 is −127 at most, which
/// is low enough for p ≥ 1, where its weight is 2^(−127·p); for less it has to be told apart.
#[inline(always)]
fn log2<T: LogSpace, const STEEP: bool>(a: T, power: T) -> T {
    let log = a.log2_over(power);
    if STEEP { log.log_vanish_with(a) } else { log }
}

/// `2^log · power`, finite.
#[inline(always)]
fn raise<T: LogSpace, const STEEP: bool>(log: T, power: T) -> T {
    let log = if STEEP { log.min(log.lift(STEEPEST)) } else { log };
    (log.exp2_within() * power).finite()
}

/// `2^exponent`, finite, and 0 where the coordinate is.
#[inline(always)]
fn slope<T: LogSpace, const STEEP: bool>(exponent: T, coordinate: T) -> T {
    let exponent = if STEEP { exponent.min(exponent.lift(STEEPEST)) } else { exponent };
    exponent.exp2_weight().vanish_with(coordinate)
}

/// Puts the coordinates near 1, so that squares neither overflow nor vanish: them and the
/// power of two.
#[inline(always)]
fn near_one<T: LogSpace>(c: [T; 3]) -> ([T; 3], T) {
    let largest = c[0].max(c[1]).max(c[2]);
    let power = largest.power_below();
    let recip = power.power_recip();
    ([c[0] * recip, c[1] * recip, c[2] * recip], power)
}

/// `√(a² + b²)`.
#[inline(always)]
pub(crate) fn euclid<T: LogSpace>(a: T, b: T) -> T {
    let power = a.max(b).power_below();
    let recip = power.power_recip();
    let (a, b) = (a * recip, b * recip);
    (a.mul_add(a, b * b).sqrt() * power).finite()
}

/// `√(a² + b² + c²)`.
#[inline(always)]
pub(crate) fn euclid3<T: LogSpace>(c: [T; 3]) -> T {
    let ([a, b, c], power) = near_one(c);
    (a.mul_add(a, b.mul_add(b, c * c)).sqrt() * power).finite()
}

/// [`euclid3`] and its derivatives.
#[inline(always)]
fn euclid_parts<T: LogSpace>(c: [T; 3]) -> (T, [T; 3]) {
    let (scaled, power) = near_one(c);
    let [x, y, z] = scaled;
    let root = x.mul_add(x, y.mul_add(y, z * z)).sqrt();
    // At the origin this is 0/0; `vanish_with` covers it.
    let recip = root.lift(1.0) / root;
    let gradient = [(x * recip).vanish_with(c[0]), (y * recip).vanish_with(c[1]), (z * recip).vanish_with(c[2])];
    ((root * power).finite(), gradient)
}

/// `√(x² + y²)` and its derivatives.
#[inline(always)]
pub(crate) fn euclid_pair_parts<T: LogSpace>(x: T, y: T) -> (T, T, T) {
    let (value, [da, db, _]) = euclid_parts([x.abs(), y.abs(), x.lift(0.0)]);
    (value, da.copysign(x), db.copysign(y))
}

/// `√(x² + y² + z²)` and its derivatives.
#[inline(always)]
pub(crate) fn euclid_triple_parts<T: LogSpace>([x, y, z]: [T; 3]) -> (T, [T; 3]) {
    let (value, [da, db, dc]) = euclid_parts([x.abs(), y.abs(), z.abs()]);
    (value, [da.copysign(x), db.copysign(y), dc.copysign(z)])
}
