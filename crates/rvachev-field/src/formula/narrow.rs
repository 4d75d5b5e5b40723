//! Ranges over zones, and the formula that is left of one there.
//!
//! One walk in interval arithmetic gives the range and, at every `min` and `max`, whether one
//! operand is the result throughout. Narrowing takes the other out, with all that only it
//! needs. An operand that may be undefined is not taken out, as it makes the result
//! undefined.

use std::cell::RefCell;
use std::sync::{Arc, OnceLock};

use fidget::context::{BinaryOpcode, UnaryOpcode};
use glam::DVec3;

use super::arithmetic::Arithmetic;
use super::code::{Code, live};
use super::jumps::Beside;
use super::native::Native;
use super::op::Op;
use super::slope::Slope;
use super::sure::Sure;
use super::survey::Survey;
use super::{Formula, Inner};
use crate::{Dual, Interval};
use crate::{VALUE_LIMIT, Zone};

/// The last walk of a thread. The range over a zone is asked for before the narrowed formula
/// is, and the walk serves both.
struct Walk {
    number: u64,
    hull: [Interval; 3],
    ranges: Vec<Sure>,
}

thread_local! {
    /// The last walk of a thread over many boxes.
    static SURVEY: RefCell<Survey> = const { RefCell::new(Survey::new()) };
    static WALK: RefCell<Walk> =
        const { RefCell::new(Walk { number: u64::MAX, hull: [Interval::ALL; 3], ranges: Vec::new() }) };
}

/// The box by the axes that matter: boxes that differ along others are the same.
fn seen(code: &Code, hull: [Interval; 3]) -> [Interval; 3] {
    [0, 1, 2].map(|axis| if code.axes[axis] { hull[axis] } else { Interval::point(0.0) })
}

/// Calls `then` with the ranges of all operations over a box.
fn walked<T>(code: &Code, hull: [Interval; 3], then: impl FnOnce(&[Sure]) -> T) -> T {
    let hull = seen(code, hull);
    WALK.with_borrow_mut(|walk| {
        if walk.number != code.number || walk.hull != hull {
            // A coordinate is a number wherever it is.
            code.values(hull.map(|range| Sure { range, sure: true }), &mut walk.ranges);
            walk.number = code.number;
            walk.hull = hull;
        }
        then(&walk.ranges)
    })
}

/// Formulas up to this length, and with up to so many minima and maxima, are worth the price of
/// gradients for a tighter range: where there are more, what helps is to leave some of them out.
const SHORT: usize = 256;
const CHOICES: usize = 8;

/// A narrowed formula must leave at most this part of the operations, in eighths.
const EIGHTHS_LEFT: usize = 6;

/// The value of the solid from that of the formula.
pub(super) fn turned(value: Sure) -> Interval {
    let range = -value.range;
    let held = Interval::new(range.lo().clamp(-VALUE_LIMIT, VALUE_LIMIT), range.hi().clamp(-VALUE_LIMIT, VALUE_LIMIT));
    if value.sure { held } else { held.hull(Interval::point(-VALUE_LIMIT)) }
}

impl Formula {
    /// Walks over many zones at once: their ranges and narrowed formulas will be asked for.
    pub(super) fn survey(&self, zones: &[Zone]) {
        let code = &self.0.code;
        if zones.len() > 1 && zones.iter().all(Zone::is_finite) {
            SURVEY.with_borrow_mut(|survey| survey.walk(code, zones.iter().map(|zone| seen(code, zone.hull()))));
        }
    }

    pub(super) fn range_over(&self, zone: &Zone) -> Interval {
        let code = &self.0.code;
        let Some(whole) = whole_range(code, zone.hull()) else { return Interval::ALL };
        let range = turned(whole);
        let decided = range.lo() > 0.0 || range.hi() < 0.0;
        let is_dear = code.len > SHORT || code.choices > CHOICES;
        if decided || is_dear || !whole.sure || !zone.is_finite() {
            return range;
        }
        match self.centred(zone) {
            Some(centred) => range.narrowed_by(centred),
            None => range,
        }
    }

    /// The mean-value form: the value at the centre, and the slopes times the way from there.
    fn centred(&self, zone: &Zone) -> Option<Interval> {
        let plan = self.0.code.plan();
        let at = zone.centre.to_array().map(|c| Sure { range: Interval::point(c), sure: true });
        let value = plan.value(at, &mut Vec::new());
        let slopes = plan.value(variables(zone.hull()), &mut Vec::new());
        if !(value.sure && slopes.v.sure && slopes.d.iter().all(|d| d.sure)) {
            return None;
        }
        let slope = slopes.d.map(|d| d.range);
        let way = |direction: DVec3| {
            let [x, y, z] = direction.to_array();
            slope[0] * x + slope[1] * y + slope[2] * z
        };
        let either = Interval::new(-1.0, 1.0);
        let slack = Interval::point(
            slope[0].magnitude() * zone.slack.x
                + slope[1].magnitude() * zone.slack.y
                + slope[2].magnitude() * zone.slack.z,
        );
        let axes = way(zone.axes.x_axis) * either + way(zone.axes.y_axis) * either + way(zone.axes.z_axis) * either;
        // Points of the zone are rounded to it from wherever they come.
        let coordinates = zone.centre.abs() + zone.extent();
        let rounding = 1e-14 * (0..3).map(|axis| slope[axis].magnitude() * coordinates[axis]).sum::<f64>();
        let centred = value.range + axes + slack * either;
        Some(turned(Sure::new(centred.inflate(rounding), true)))
    }

    pub(super) fn narrowed_to(&self, zone: &Zone) -> Option<Formula> {
        if !zone.is_finite() {
            return None;
        }
        let code = &self.0.code;
        let hull = zone.hull();
        let (code, range) = narrowed(code, hull)?;
        let region = [0, 1, 2].map(|axis| self.0.region[axis].narrowed_by(hull[axis]));
        let has_region = self.0.region != [Interval::ALL; 3];
        Some(Formula(Arc::new(Inner {
            code,
            bounds: self.0.bounds,
            region,
            range: turned(range),
            elder: self.0.elder.clone().or_else(|| has_region.then(|| self.clone())),
            roundoff: OnceLock::new(),
            native: Native::default(),
        })))
    }

    pub(super) fn dual_range_of(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        // A derivative of 0 that was rounded outwards is 0: steep formulas would make much of it.
        const LEVEL: f64 = 1e-300;
        let level = |d: Interval| if d.magnitude() < LEVEL { Interval::point(0.0) } else { d };
        let p = p.map(|c| Dual::new(c.value(), c.gradient().map(level)));
        let moves = |c: &Dual<Interval>, i: usize| c.gradient()[i].magnitude() > 0.0;
        let code = &self.0.code;
        if !p.iter().zip(code.axes).any(|(c, used)| used && (0..3).any(|i| moves(c, i))) {
            let region = &self.0.region;
            let within = |axis: usize| !code.axes[axis] || region[axis].hull(p[axis].v) == region[axis];
            let range = if (0..3).all(within) {
                self.0.range
            } else {
                walked(code, p.map(Dual::value), |ranges| ranges.last().copied().map_or(Interval::ALL, turned))
            };
            return Dual::constant(range);
        }
        // Rays ask for one derivative: the others are those of nothing.
        if p.iter().any(|c| moves(c, 1) || moves(c, 2)) {
            let (range, slopes) = self.slopes_of(p.map(|c| (c.value(), c.gradient())));
            Dual::new(range, slopes)
        } else {
            let (range, [slope]) = self.slopes_of(p.map(|c| (c.value(), [c.gradient()[0]])));
            Dual::new(range, [slope, Interval::point(0.0), Interval::point(0.0)])
        }
    }

    /// Ranges of the derivatives over what of a box lies on the same side of all jumps as a point.
    pub(super) fn slopes_of_side(&self, region: [Interval; 3], beside: DVec3) -> [Interval; 3] {
        let point = variables(region);
        let point =
            [0, 1, 2].map(|axis| Beside { slope: point[axis], at: beside[axis], is_linear: true, is_constant: false });
        let Slope { v, d } = self.0.code.plan().value(point, &mut Vec::new()).slope;
        d.map(|d| if v.sure && d.sure { -d.range } else { Interval::ALL })
    }

    /// The ranges of the value and of its derivatives from those of the coordinates.
    fn slopes_of<const N: usize>(&self, p: [(Interval, [Interval; N]); 3]) -> (Interval, [Interval; N]) {
        let sure = |range| Sure { range, sure: true };
        let point = p.map(|(v, d)| Slope { v: sure(v), d: d.map(sure) });
        let value = self.0.code.plan().value(point, &mut Vec::new());
        let slopes = value.d.map(|d| if value.v.sure && d.sure { -d.range } else { Interval::ALL });
        (turned(value.v), slopes)
    }
}

/// The point of a box, as variables to differentiate by.
fn variables(hull: [Interval; 3]) -> [Slope<Sure>; 3] {
    std::array::from_fn(|axis| Slope {
        v: Sure { range: hull[axis], sure: true },
        d: std::array::from_fn(|i| Sure::constant(f64::from(u8::from(i == axis)))),
    })
}

/// The range of the formula over a box.
fn whole_range(code: &Code, hull: [Interval; 3]) -> Option<Sure> {
    let known = SURVEY.with_borrow(|survey| Some(survey.range(survey.lane(code, &seen(code, hull))?)));
    known.or_else(|| walked(code, hull, |ranges| ranges.last().copied()))
}

/// The code without what is not chosen in a box, if that saves enough, and its range.
fn narrowed(code: &Code, hull: [Interval; 3]) -> Option<(Code, Sure)> {
    let most = EIGHTHS_LEFT * code.len / 8;
    let known = SURVEY.with_borrow_mut(|survey| {
        let lane = survey.lane(code, &seen(code, hull))?;
        let left = survey.narrowed(code, lane, most);
        Some(left.map(|(plan, len)| (code.narrowed(plan, len), survey.range(lane))))
    });
    known.unwrap_or_else(|| {
        walked(code, hull, |ranges| {
            let ops = code.ops();
            let left = live(ops, most, |at| choice(&ops[at], ranges))?;
            Some((Code::new(left, code.flaw), ranges.last().copied()?))
        })
    })
}

/// The operand that the operation is equal to throughout.
fn choice(op: &Op, ranges: &[Sure]) -> Option<u32> {
    match *op {
        Op::Binary(op, a, b) => {
            let (x, y) = (ranges[a as usize], ranges[b as usize]);
            match op {
                BinaryOpcode::Min if y.sure && x.range.hi() <= y.range.lo() => Some(a),
                BinaryOpcode::Min if x.sure && y.range.hi() <= x.range.lo() => Some(b),
                BinaryOpcode::Max if y.sure && x.range.lo() >= y.range.hi() => Some(a),
                BinaryOpcode::Max if x.sure && y.range.lo() >= x.range.hi() => Some(b),
                BinaryOpcode::And | BinaryOpcode::Or if x.excludes_zero() => {
                    Some(if op == BinaryOpcode::And { b } else { a })
                }
                _ => None,
            }
        }
        Op::Unary(UnaryOpcode::Abs, a) if ranges[a as usize].range.lo() >= 0.0 => Some(a),
        _ => None,
    }
}
