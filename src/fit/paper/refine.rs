//! Joint refinement: Levenberg–Marquardt on the global error, by all parameters of all supershapes.
//! Their boxes stay: they are those of the points, and would flee from them.
//!
//! Every step makes the error smaller and leaves the points as near to the surface as they were in
//! the beginning, or is not taken: the error alone is least for members that shrink to nothing, as
//! their weights do. Parameters are logarithms, angles and lengths; the damping is relative to the
//! diagonal, so that their units do not matter.

use glam::DVec3;

use super::truncated::{PARAMETERS, Row};
use super::whole::Whole;
use crate::{Cancelled, Run};
use rvachev_num::jobs;

/// Tasks that the points are split into, however many threads there are.
const TASKS: usize = 8;

/// A step that lowers the error by less than this share is the last one.
const GAIN: f64 = 1e-5;

/// The squares of the distances may grow by this factor over all steps.
const FARTHER: f64 = 1.05;

/// Steps that may fail one after the other.
const FAILURES: usize = 8;

/// What refinement came to.
pub(super) struct Refined {
    pub(super) whole: Whole,
    pub(super) error: f64,
    /// Steps that were taken.
    pub(super) steps: usize,
}

/// The columns of the members' parameters: tied ones share one.
struct Columns {
    /// None of what is held.
    of: Vec<[Option<usize>; PARAMETERS]>,
    count: usize,
}

impl Columns {
    fn of(whole: &Whole) -> Columns {
        let (mut of, mut count) = (Vec::new(), 0);
        for member in whole.members() {
            let groups = member.groups();
            let mut columns = [None; PARAMETERS];
            for i in 0..PARAMETERS {
                if groups[i] == Some(i) {
                    columns[i] = Some(count);
                    count += 1;
                }
            }
            for i in 0..PARAMETERS {
                columns[i] = groups[i].and_then(|group| columns[group]);
            }
            of.push(columns);
        }
        Columns { of, count }
    }
}

/// Normal equations: half the gradient of E, and JᵀJ by rows, of which the lower triangle is
/// filled.
struct Normal {
    gradient: Vec<f64>,
    matrix: Vec<f64>,
}

impl Normal {
    fn of(whole: &Whole, columns: &Columns, points: &[DVec3], run: &Run) -> Result<Normal, Cancelled> {
        let n = columns.count;
        let sum = |chunk: &[DVec3]| {
            let mut sums = Normal { gradient: vec![0.0; n], matrix: vec![0.0; n * n] };
            let mut rows: Vec<Row> = vec![[0.0; PARAMETERS]; whole.count()];
            let mut dense = vec![0.0; n];
            for (at, p) in chunk.iter().enumerate() {
                if at.is_multiple_of(64) {
                    run.check()?;
                }
                let value = whole.slopes(*p, &mut rows);
                dense.fill(0.0);
                for (row, columns) in rows.iter().zip(&columns.of) {
                    for (slope, column) in row.iter().zip(columns) {
                        if let Some(column) = column {
                            dense[*column] += slope;
                        }
                    }
                }
                for i in 0..n {
                    if dense[i] == 0.0 {
                        continue;
                    }
                    sums.gradient[i] += dense[i] * value;
                    for (to, slope) in sums.matrix[i * n..=i * n + i].iter_mut().zip(&dense) {
                        *to += dense[i] * slope;
                    }
                }
            }
            Ok(sums)
        };
        let size = points.len().div_ceil(TASKS).max(1);
        let parts = jobs::try_chunks(points, size, |_, chunk| sum(chunk))?;
        let mut all = Normal { gradient: vec![0.0; n], matrix: vec![0.0; n * n] };
        for part in parts {
            all.gradient.iter_mut().zip(part.gradient).for_each(|(to, x)| *to += x);
            all.matrix.iter_mut().zip(part.matrix).for_each(|(to, x)| *to += x);
        }
        Ok(all)
    }

    /// The damped step, unless it is not finite.
    fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let n = self.gradient.len();
        let largest = (0..n).map(|i| self.matrix[i * n + i]).fold(0.0, f64::max);
        let mut low = self.matrix.clone();
        for i in 0..n {
            // Free directions, of which there are many in supershapes, get no step.
            low[i * n + i] += damping * low[i * n + i] + 1e-10 * largest + f64::MIN_POSITIVE;
        }
        for i in 0..n {
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| low[i * n + k] * low[j * n + k]).sum();
                let rest = low[i * n + j] - dot;
                if i != j {
                    low[i * n + j] = rest / low[j * n + j];
                } else if rest > 0.0 && rest.is_finite() {
                    low[i * n + i] = rest.sqrt();
                } else {
                    return None;
                }
            }
        }
        let mut x: Vec<f64> = self.gradient.iter().map(|g| -g).collect();
        for i in 0..n {
            let dot: f64 = (0..i).map(|k| low[i * n + k] * x[k]).sum();
            x[i] = (x[i] - dot) / low[i * n + i];
        }
        for i in (0..n).rev() {
            let dot: f64 = (i + 1..n).map(|k| low[k * n + i] * x[k]).sum();
            x[i] = (x[i] - dot) / low[i * n + i];
        }
        x.iter().all(|x| x.is_finite()).then_some(x)
    }
}

/// At most so many steps from a solid.
pub(super) fn refined(start: Whole, points: &[DVec3], steps: usize, run: &Run) -> Result<Refined, Cancelled> {
    let mut best = Refined { error: start.error(points, run)?, whole: start, steps: 0 };
    let columns = Columns::of(&best.whole);
    let limit = FARTHER * best.whole.squares(points, run)?;
    let (mut damping, mut failures) = (1e-3, 0);
    let mut normal = None;
    while best.steps < steps && failures < FAILURES {
        run.report((best.steps as f64 + failures as f64 / FAILURES as f64) / steps as f64);
        let equations = match normal.take() {
            Some(equations) => equations,
            None => Normal::of(&best.whole, &columns, points, run)?,
        };
        let next = equations.step(damping).map(|step| {
            let mut next = best.whole.clone();
            for (member, columns) in next.members_mut().zip(&columns.of) {
                *member = member.moved(&std::array::from_fn(|i| columns[i].map_or(0.0, |column| step[column])));
            }
            next
        });
        let error = next.as_ref().map_or(Ok(f64::INFINITY), |next| next.error(points, run))?;
        match next {
            // NaN is no less.
            Some(next) if error < best.error && next.squares(points, run)? <= limit => {
                let is_last = best.error - error < GAIN * best.error;
                best = Refined { whole: next, error, steps: best.steps + 1 };
                damping = f64::max(0.2 * damping, 1e-9);
                failures = 0;
                if is_last {
                    break;
                }
            }
            _ => {
                damping *= 8.0;
                failures += 1;
                normal = Some(equations);
            }
        }
    }
    run.report(1.0);
    Ok(best)
}
