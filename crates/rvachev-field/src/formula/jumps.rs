//! Where formulas jump: planes, as far as they are known.
//!
//! A remainder, or a number rounded, jumps where its operand is a certain number. Of an operand
//! that is linear in x, y and z that is a plane; between two such planes the operation is linear
//! itself, or a constant.
//!
//! ```text
//!      /|  /|  /|       mod(x, 2): planes at x = 0, 2, 4 …; in between it is x, x − 2, x − 4 …
//!     / | / | / |
//! ```

use fidget::context::{BinaryOpcode, UnaryOpcode};
use glam::DVec3;

use super::Formula;
use super::arithmetic::Arithmetic;
use super::op::Op;
use super::slope::Slope;
use super::sure::Sure;
use crate::{Crease, Interval};

/// Formulas with more planes are not asked for them.
const MOST: f64 = 64.0;

/// Whether an operation has steps.
pub(super) fn has_steps(op: &Op) -> bool {
    use {BinaryOpcode as B, UnaryOpcode as U};
    matches!(op, Op::Unary(U::Floor | U::Ceil | U::Round, _) | Op::Binary(B::Mod | B::Compare, ..))
}

/// A value that is linear in the coordinates: `slopes · p + constant`; of others `constant` is NaN.
#[derive(Clone, Copy)]
struct Linear {
    slopes: DVec3,
    constant: f64,
}

impl Linear {
    const NONE: Linear = Linear { slopes: DVec3::ZERO, constant: f64::NAN };

    fn is_constant(self) -> bool {
        self.slopes == DVec3::ZERO
    }

    fn times(self, k: f64) -> Linear {
        Linear { slopes: self.slopes * k, constant: self.constant * k }
    }

    fn plus(self, other: Linear) -> Linear {
        Linear { slopes: self.slopes + other.slopes, constant: self.constant + other.constant }
    }

    /// The planes in a region at which it is `first` plus a multiple of `step`.
    fn planes(self, first: f64, step: f64, region: [Interval; 3]) -> impl Iterator<Item = Crease> {
        let sides = [0, 1, 2].map(|axis| region[axis] * self.slopes[axis]);
        let range = sides[0] + sides[1] + sides[2] + (self.constant - first);
        let (from, to) = ((range.lo() / step).ceil(), (range.hi() / step).floor());
        let is_known = self.constant.is_finite() && !self.is_constant() && step > 0.0;
        // One more than are told is enough to see that there are too many.
        let count = if is_known && to >= from { (to - from).min(MOST) as u32 + 1 } else { 0 };
        let crease = move |n: u32| {
            let offset = first + (from + f64::from(n)) * step - self.constant;
            Crease { normal: self.slopes, offset, jumps: true }
        };
        (0..count).map(crease)
    }
}

impl Formula {
    /// The planes in a region at which it is known to jump; none if there are too many to tell.
    pub(super) fn jumps_in(&self, region: [Interval; 3]) -> Option<Vec<Crease>> {
        use {BinaryOpcode as B, UnaryOpcode as U};
        let code = &self.0.code;
        let mut planes = Vec::new();
        if !code.jumps {
            return Some(planes);
        }
        let mut all: Vec<Linear> = Vec::with_capacity(code.len);
        for op in code.ops() {
            let linear = match *op {
                Op::Axis(axis) => Linear { slopes: DVec3::AXES[usize::from(axis)], constant: 0.0 },
                Op::Const(constant) => Linear { slopes: DVec3::ZERO, constant },
                Op::Unary(op, a) => {
                    let a = all[a as usize];
                    match op {
                        U::Floor | U::Ceil => planes.extend(a.planes(0.0, 1.0, region)),
                        U::Round => planes.extend(a.planes(0.5, 1.0, region)),
                        _ => {}
                    }
                    if op == U::Neg { a.times(-1.0) } else { Linear::NONE }
                }
                Op::Binary(op, a, b) => {
                    let (a, b) = (all[a as usize], all[b as usize]);
                    match op {
                        B::Add => a.plus(b),
                        B::Sub => a.plus(b.times(-1.0)),
                        B::Mul if b.is_constant() => a.times(b.constant),
                        B::Mul if a.is_constant() => b.times(a.constant),
                        B::Div if b.is_constant() => a.times(1.0 / b.constant),
                        B::Mod if b.is_constant() => {
                            planes.extend(a.planes(0.0, b.constant.abs(), region));
                            Linear::NONE
                        }
                        B::Compare => {
                            planes.extend(a.plus(b.times(-1.0)).planes(0.0, f64::MAX, region));
                            Linear::NONE
                        }
                        _ => Linear::NONE,
                    }
                }
            };
            all.push(linear);
        }
        (planes.len() as f64 <= MOST).then_some(planes)
    }
}

/// A range and its slopes, of what lies on the same side of all planes as a point.
#[derive(Clone, Copy)]
pub(super) struct Beside<const N: usize> {
    pub(super) slope: Slope<Sure, N>,
    /// The value at the point.
    pub(super) at: f64,
    /// Whether it is linear in the coordinates, and whether it is a constant.
    pub(super) is_linear: bool,
    pub(super) is_constant: bool,
}

impl<const N: usize> Beside<N> {
    fn level(at: f64) -> Slope<Sure, N> {
        Slope { v: Sure::constant(at), d: [Sure::constant(0.0); N] }
    }
}

impl<const N: usize> Arithmetic for Beside<N> {
    fn constant(c: f64) -> Self {
        Beside { slope: Slope::constant(c), at: c, is_linear: true, is_constant: true }
    }

    fn unary(op: UnaryOpcode, a: Self) -> Self {
        use UnaryOpcode as U;
        let at = f64::unary(op, a.at);
        let slope = match op {
            U::Floor | U::Ceil | U::Round if a.is_linear => Beside::level(at),
            _ => Slope::unary(op, a.slope),
        };
        Beside { slope, at, is_linear: a.is_linear && op == U::Neg, is_constant: false }
    }

    fn binary(op: BinaryOpcode, a: Self, b: Self) -> Self {
        use BinaryOpcode as B;
        let at = f64::binary(op, a.at, b.at);
        let slope = match op {
            B::Mod if a.is_linear && b.is_constant && b.at != 0.0 => {
                let size = b.at.abs();
                let v = a.slope.v;
                let exact = v.range - size * (a.at / size).floor();
                let range = exact.inflate(1e-15 * (v.range.magnitude() + size));
                Slope { v: Sure::new(range.narrowed_by(Interval::new(0.0, size)), v.sure), ..a.slope }
            }
            B::Compare if a.is_linear && b.is_linear => Beside::level(at),
            _ => Slope::binary(op, a.slope, b.slope),
        };
        let is_linear = match op {
            B::Add | B::Sub => a.is_linear && b.is_linear,
            B::Mul => a.is_linear && b.is_constant || a.is_constant && b.is_linear,
            B::Div => a.is_linear && b.is_constant,
            _ => false,
        };
        Beside { slope, at, is_linear, is_constant: false }
    }
}
