//! R-functions that a formula holds, made into minima and maxima.
//!
//! ```text
//!     a + b + √(a² + b² − 2α ab)       max(a, b)          −1 < α ≤ 1
//!     a + b − √(a² + b² − 2α ab)       min(a, b)
//!     a + b ± (|a|^p + |b|^p)^(1/p)    the same           p > 1
//!     either, times (a² + b²)^k        the same           k > 0
//! ```
//!
//! They have the signs of maximum and minimum, the zero set and, on it, the direction of the normal
//! (MATHEMATICS E). So where only the sign of the formula is asked, from its last operation down
//! through minima, maxima, R-functions, negation and multiplication by constants, they are
//! replaced: the ranges of a minimum are tight, and narrowing leaves out what it does not choose.
//!
//! Smooth minima `min(a, b) − max(k − |a − b|, 0)²/4k` are no matter of signs; where the operands
//! are apart, narrowing chooses the 0 of their maximum, and then one operand, as they are.
//!
//! Limits: the textbook forms, in any order of their sums; exponents agree to 10⁻⁶, as constants of
//! single precision do.

use fidget::context::{BinaryOpcode as B, UnaryOpcode as U};

use super::code::{Builder, Code};
use super::op::Op;

/// How deep sums and products are taken apart.
const DEEP: usize = 6;

/// What an operation is, where its sign is asked.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// Nothing but its value tells.
    Opaque,
    /// Of the sign of the operand, or the other one.
    Like { of: u32, negated: bool },
    /// Minimum or maximum of operands, negated or not.
    Choice { op: B, operands: [(u32, bool); 2] },
}

/// The code with minima and maxima in place of the R-functions that only matter by their signs;
/// `None` if there are none.
pub(super) fn taken_apart(code: &Code) -> Option<Code> {
    let ops = code.ops();
    let root = ops.len().checked_sub(1)?;
    let mut is_asked = vec![false; ops.len()];
    let mut forms = vec![Form::Opaque; ops.len()];
    is_asked[root] = true;
    let mut found = false;
    for at in (0..=root).rev() {
        if !is_asked[at] {
            continue;
        }
        forms[at] = form(ops, at as u32);
        match forms[at] {
            Form::Opaque => {}
            Form::Like { of, .. } => is_asked[of as usize] = true,
            Form::Choice { operands, .. } => {
                found |= !matches!(ops[at], Op::Binary(B::Min | B::Max, ..));
                operands.iter().for_each(|(operand, _)| is_asked[*operand as usize] = true);
            }
        }
    }
    if !found {
        return None;
    }
    let mut builder = Builder::of(ops);
    // What has the sign of each operation.
    let mut stand_in: Vec<u32> = (0..ops.len() as u32).collect();
    for (at, form) in forms.iter().enumerate() {
        let mut signed = |(operand, negated): (u32, bool)| {
            let operand = stand_in[operand as usize];
            if negated { builder.unary(U::Neg, operand) } else { operand }
        };
        stand_in[at] = match *form {
            Form::Opaque => continue,
            Form::Like { of, negated } => signed((of, negated)),
            Form::Choice { op, operands } => {
                let [a, b] = operands.map(&mut signed);
                builder.binary(op, a, b)
            }
        };
    }
    Some(builder.finish(stand_in[root]))
}

fn form(ops: &[Op], at: u32) -> Form {
    let fixed = |at: u32| if let Op::Const(c) = ops[at as usize] { Some(c) } else { None };
    match ops[at as usize] {
        Op::Unary(U::Neg, of) => Form::Like { of, negated: true },
        Op::Binary(op @ (B::Min | B::Max), a, b) => Form::Choice { op, operands: [(a, false), (b, false)] },
        Op::Binary(B::Mul, a, b) => {
            let scaled = |c: Option<f64>, of: u32| c.filter(|c| *c != 0.0).map(|c| Form::Like { of, negated: c < 0.0 });
            let raised = |of: u32, by: u32| {
                let (_, under) = r_function(ops, of)?;
                (power(ops, by).0 == under).then_some(Form::Like { of, negated: false })
            };
            scaled(fixed(a), b)
                .or_else(|| scaled(fixed(b), a))
                .or_else(|| raised(a, b))
                .or_else(|| raised(b, a))
                .unwrap_or(Form::Opaque)
        }
        Op::Binary(B::Div, of, by) => match fixed(by) {
            Some(c) if c != 0.0 => Form::Like { of, negated: c < 0.0 },
            _ => Form::Opaque,
        },
        _ => r_function(ops, at).map_or(Form::Opaque, |(form, _)| form),
    }
}

/// An R-function, and the operation that its root is of.
fn r_function(ops: &[Op], at: u32) -> Option<(Form, u32)> {
    if !matches!(ops[at as usize], Op::Binary(B::Add | B::Sub, ..) | Op::Unary(U::Neg, _)) {
        return None;
    }
    let mut terms = Vec::new();
    sum(ops, at, 1.0, DEEP, &|at| power(ops, at).1 < 1.0, &mut terms);
    terms.into_iter().find_map(|(root, _)| {
        let (under, exponent) = power(ops, root);
        let ([a, b], alpha) = (exponent < 1.0).then(|| operands(ops, under, 1.0 / exponent))??;
        // The sum again, its operands whole.
        let mut whole = Vec::new();
        sum(ops, at, 1.0, DEEP, &|at| [a, b, root].contains(&at), &mut whole);
        let of = |operand: u32| match whole.iter().filter(|(at, _)| *at == operand).collect::<Vec<_>>()[..] {
            [(_, sign)] => Some(*sign),
            _ => None,
        };
        let [x, y, norm] = [of(a)?, of(b)?, of(root)?];
        let alpha = alpha * x * y;
        if whole.len() != 3 || !(alpha > -1.0 && alpha <= 1.0) {
            return None;
        }
        let op = if norm > 0.0 { B::Max } else { B::Min };
        Some((Form::Choice { op, operands: [(a, x < 0.0), (b, y < 0.0)] }, under))
    })
}

/// The terms of a sum with their signs; `is_term` says what is not taken apart.
fn sum(ops: &[Op], at: u32, sign: f64, deep: usize, is_term: &dyn Fn(u32) -> bool, terms: &mut Vec<(u32, f64)>) {
    let mut part = |at: u32, sign: f64| sum(ops, at, sign, deep - 1, is_term, terms);
    match ops[at as usize] {
        _ if deep == 0 || is_term(at) => terms.push((at, sign)),
        Op::Unary(U::Neg, a) => part(a, -sign),
        Op::Binary(B::Add, a, b) => {
            part(a, sign);
            part(b, sign);
        }
        Op::Binary(B::Sub, a, b) => {
            part(a, sign);
            part(b, -sign);
        }
        _ => terms.push((at, sign)),
    }
}

/// The operation that another is a power of, and the exponent.
fn power(ops: &[Op], at: u32) -> (u32, f64) {
    let (mut under, mut exponent) = (at, 1.0);
    for _ in 0..DEEP {
        let raised = match ops[under as usize] {
            Op::Unary(U::Sqrt, a) => Some((a, 0.5)),
            Op::Unary(U::Square, a) => Some((a, 2.0)),
            Op::Unary(U::Exp, a) => exponential(ops, a),
            _ => None,
        };
        let Some((below, factor)) = raised else { break };
        (under, exponent) = (below, exponent * factor);
    }
    (under, exponent)
}

/// The base and the exponent of `exp(c ln x)`.
fn exponential(ops: &[Op], at: u32) -> Option<(u32, f64)> {
    let fixed = |at: u32| if let Op::Const(c) = ops[at as usize] { Some(c) } else { None };
    let logarithm = |at: u32| if let Op::Unary(U::Ln, a) = ops[at as usize] { Some(a) } else { None };
    match ops[at as usize] {
        Op::Unary(U::Ln, a) => Some((a, 1.0)),
        Op::Binary(B::Mul, a, b) => logarithm(a).zip(fixed(b)).or_else(|| logarithm(b).zip(fixed(a))),
        Op::Binary(B::Div, a, b) => Some((logarithm(a)?, 1.0 / fixed(b)?)),
        _ => None,
    }
}

/// The two operands a and b of `|a|^p + |b|^p`, or of `a² + b² − 2α ab` with its α.
fn operands(ops: &[Op], at: u32, p: f64) -> Option<([u32; 2], f64)> {
    let mut terms = Vec::new();
    sum(ops, at, 1.0, DEEP, &|at| power(ops, at).1 != 1.0, &mut terms);
    let (powers, rest): (Vec<_>, Vec<_>) = terms.into_iter().partition(|(at, _)| power(ops, *at).1 != 1.0);
    let &[(a, 1.0), (b, 1.0)] = &powers[..] else { return None };
    let base = |at: u32| {
        let (under, exponent) = power(ops, at);
        let is_even = matches!(ops[at as usize], Op::Unary(U::Square, _));
        let (base, is_absolute) = absolute(ops, under);
        ((exponent - p).abs() <= 1e-6 * p && (is_even || is_absolute)).then_some(base)
    };
    let (a, b) = (base(a)?, base(b)?);
    let alpha = match rest[..] {
        [] => 0.0,
        [(product, sign)] if p == 2.0 => -0.5 * sign * cross(ops, product, [a, b])?,
        _ => return None,
    };
    (p > 1.0 && a != b).then_some(([a, b], alpha))
}

/// What an operation is but for its sign, and whether that sign is lost in it.
fn absolute(ops: &[Op], at: u32) -> (u32, bool) {
    match ops[at as usize] {
        Op::Unary(U::Abs, a) => (absolute(ops, a).0, true),
        Op::Unary(U::Neg, a) => absolute(ops, a),
        _ => (at, false),
    }
}

/// The factor c of `c a b`.
fn cross(ops: &[Op], at: u32, [a, b]: [u32; 2]) -> Option<f64> {
    let (mut factor, mut left) = (1.0, vec![a, b]);
    let mut pending = vec![at];
    while let Some(at) = pending.pop() {
        if let Some(place) = left.iter().position(|of| *of == at) {
            left.swap_remove(place);
            continue;
        }
        match ops[at as usize] {
            Op::Const(c) => factor *= c,
            Op::Unary(U::Neg, a) => {
                factor = -factor;
                pending.push(a);
            }
            Op::Binary(B::Mul, a, b) => pending.extend([a, b]),
            _ => return None,
        }
    }
    left.is_empty().then_some(factor)
}

#[cfg(test)]
mod tests {
    use fidget::context::Tree;

    use super::*;

    fn code(make: impl Fn(Tree, Tree) -> Tree) -> Code {
        let (x, y, z) = Tree::axes();
        let ball = (x.square() + y.square() + z.square()).sqrt() - 1.0;
        Code::of_tree(&make(ball, x * 0.8 - y + 0.1))
    }

    fn value(code: &Code, p: [f64; 3]) -> f64 {
        let mut all = Vec::new();
        code.values(p, &mut all);
        all[all.len() - 1]
    }

    #[test]
    fn r_functions_become_minima_and_maxima_of_the_same_sign() {
        type Make = fn(Tree, Tree) -> Tree;
        let forms: [(&str, Make); 9] = [
            ("R_0 or", |a, b| a.clone() + b.clone() + (a.square() + b.square()).sqrt()),
            ("R_0 and", |a, b| a.clone() + b.clone() - (a.square() + b.square()).sqrt()),
            ("the root first", |a, b| b.clone() + (a.clone() - (b.clone() * b + a.clone() * a).sqrt())),
            ("a difference", |a, b| (a.clone() - b.clone() - (a.square() + b.square()).sqrt()) * 0.5),
            ("turned round", |a, b| -((a.square() + b.square()).sqrt() - a - b) / 3.0),
            ("R_α", |a, b| a.clone() + b.clone() + (a.square() + b.square() - a * b * 1.5).sqrt()),
            ("R_0^1", |a, b| {
                let s = a.square() + b.square();
                (a + b - s.clone().sqrt()) * s.sqrt()
            }),
            ("R_4", |a, b| {
                let fourth = |t: &Tree| t.square().square();
                a.clone() + b.clone() - (fourth(&a) + fourth(&b)).sqrt().sqrt()
            }),
            ("R_3", |a, b| {
                let cube = |t: &Tree| (t.abs().ln() * 3.0).exp();
                a.clone() + b.clone() + ((cube(&a) + cube(&b)).ln() / 3.0).exp()
            }),
        ];
        for (name, make) in forms {
            let whole = code(make);
            let apart = taken_apart(&whole).unwrap_or_else(|| panic!("{name} is not found"));
            assert_eq!(apart.choices, 1, "{name}");
            for n in 0..4000u32 {
                let c = |k: u32| f64::from((3 * n + k).wrapping_mul(2_654_435_769) >> 8) / f64::from(1 << 23) - 1.0;
                let p = [c(0), c(1), c(2)].map(|c| 1.5 * c);
                let (value, own) = (value(&whole, p), value(&apart, p));
                assert!(value.abs() < 1e-12 || (value < 0.0) == (own < 0.0), "{name}: {value} and {own} at {p:?}");
            }
        }
    }

    #[test]
    fn a_chain_comes_apart_to_its_end_and_values_stay() {
        let or = |a: Tree, b: Tree| a.clone() + b.clone() - (a.square() + b.square()).sqrt();
        let (x, y, _) = Tree::axes();
        let row = |n: i16| (0..n).map(|k| (x.clone() - f32::from(k)).square() + y.square() - 0.2).reduce(or);
        let apart = taken_apart(&Code::of_tree(&row(3000).expect("there are some"))).expect("R-functions");
        assert_eq!(apart.choices, 2999);
        // Of a sum its terms' values count.
        assert!(taken_apart(&Code::of_tree(&(row(3).expect("there are some") + 0.1))).is_none());
        assert!(taken_apart(&Code::of_tree(&(x.clone() + y.clone() - x.square().sqrt()))).is_none());
        let beyond = x.clone() + y.clone() - (x.square() + y.square() + x * y * 3.0).sqrt();
        assert!(taken_apart(&Code::of_tree(&beyond)).is_none());
    }
}
