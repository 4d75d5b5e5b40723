//! Formulas that are data: a user's expression tree, or the text of a `.vm` file.
//!
//! ```text
//!     Tree or text ──► Code: a list of operations, operands first
//!                       ├── for the surface alone: the list with minima and maxima for R-functions
//!                       ├── points, ranges, gradients: one walk each, on the numbers concerned
//!                       ├── lanes: loops over chunks, operation by operation, in f32 and f64
//!                       ├── after some chunks of f32: fidget's JIT, where every operation is an instruction
//!                       └── narrowed to a zone: the list without what min and max do not choose there
//! ```
//!
//! fidget knows single precision only; double precision is a walk over the same operations,
//! so that doubtful signs are settled as for every other leaf. Ranges are interval
//! arithmetic in double precision, rounded outward: sound by construction, without an
//! inflation. fidget's own intervals are of single precision, rounded to nearest, and are
//! not used; nor is its virtual machine, which would need a tape of its own for every
//! narrowed formula, while the list is run as it is.
//!
//! Limits: a formula is neither convex nor a distance, whatever it looks like, and its slope
//! may be anything. What is undefined (the root of −1, 0/0) is outside.
//!
//! Source of the format and of narrowing by choices: M. J. Keeter, *Massively parallel
//! rendering of complex closed-form implicit surfaces*, ACM Transactions on Graphics 39
//! (2020).

mod arithmetic;
mod bulk;
mod code;
mod erased;
mod functions;
mod gradients;
mod joints;
mod jumps;
mod live;
mod many;
mod narrow;
mod native;
mod op;
mod plan;
mod roundoff;
mod slope;
mod sure;
mod survey;
#[cfg(test)]
mod tests;
mod text;
mod write;

use std::fmt;
use std::sync::{Arc, OnceLock};

use fidget::context::Tree;

use self::code::{Code, Flaw};
use self::native::Native;
pub use self::text::FormulaError;
use super::{ParamError, check};
use crate::{Bounds, Interval};

/// A solid given by a formula of x, y and z: a fidget [`Tree`], or the text of a `.vm` file.
///
#[doc = picture!("formula" = "docs/gallery/formula.png", "formula_vm" = "docs/gallery/formula_vm.png")]
///
/// The sign is fidget's, **negative inside**; it is turned at the door, so the value of the
/// solid is `−formula(x, y, z)`. The value is whatever the formula gives, not a distance;
/// where it is undefined is outside.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | formula | length, best with a slope of about 1 | of x, y and z alone; no constant is NaN |
/// | `bounds` | length | a box that holds the shape: not empty, not NaN, finite sides up to 10⁹; infinite along the axes where the shape does not end |
///
/// The bounds are believed: what sticks out of them may be there or not. To cut a formula
/// that goes on, intersect it with a cuboid. A formula without z is a prism without ends:
/// bounds infinite along z say so, and an intersection gives it ends.
///
/// Cloning is cheap. In bulk the operations are run over chunks of points; after some
/// thousands of points as native code (by fidget, feature `jit`), unless the formula calls
/// for functions (sine, exponential …), where native code is slower: sine, cosine, exponential
/// and logarithm have vectors of their own, within 2 units in the last place. Over a small
/// region `min` and `max` choose one operand for good, and only what is chosen is run: of
/// formulas of thousands of operations some dozens are left.
///
/// ```
/// use fidget::context::Tree;
/// use glam::DVec3;
/// use rvachev::{Bounds, Formula, Solid};
///
/// let (x, y, z) = Tree::axes();
/// let ball = (x.square() + y.square() + z.square()).sqrt() - 1.0;
/// let ball = Solid::from(Formula::new(&ball, Bounds::new(-DVec3::ONE, DVec3::ONE)));
/// assert_eq!(ball.value(DVec3::ZERO)?, 1.0);
/// assert!(!ball.contains(DVec3::new(1.0, 1.0, 0.0))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone)]
pub struct Formula(Arc<Inner>);

struct Inner {
    code: Code,
    bounds: Bounds,
    /// The box that the operations stand for the formula in; infinite unless narrowed.
    region: [Interval; 3],
    /// The range of the solid's value in that box.
    range: Interval,
    /// The first of those that it was narrowed from that has a region.
    elder: Option<Formula>,
    /// The bound of rounding errors in all of its region, once it or a narrowed one was asked for
    /// it.
    roundoff: OnceLock<f64>,
    native: Native,
}

impl Formula {
    /// The solid where `tree` is negative. `bounds` must hold it.
    ///
    /// Variables other than x, y and z are found when the solid is first evaluated, as are
    /// bounds that are none.
    #[must_use]
    pub fn new(tree: &Tree, bounds: Bounds) -> Formula {
        Formula::of_code(Code::of_tree(tree), bounds)
    }

    /// The solid where the formula of a `.vm` text is negative. `bounds` must hold it.
    ///
    /// A line is `name operation operands…`, the last line is the value, and lines that begin
    /// with `#` are comments. Operations are
    ///
    /// * `var-x`, `var-y`, `var-z`, and `const` with a number;
    /// * of one operand `abs`, `acos`, `asin`, `atan`, `ceil`, `cos`, `exp`, `floor`, `ln`,
    ///   `neg`, `not`, `rand`, `recip`, `round`, `sin`, `sqrt`, `square`, `tan`;
    /// * of two `add`, `and`, `atan2`, `compare`, `div`, `max`, `min`, `mix`, `mod`, `mul`,
    ///   `or`, `sub`.
    ///
    /// # Errors
    /// The first line that is not understood: its number, its text, what is expected and what was
    /// found.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::{Bounds, Formula, Solid};
    ///
    /// let text = "x var-x\ny var-y\nm max x y\none const 1\nout sub m one";
    /// let corner = Solid::from(Formula::from_vm(text, Bounds::ALL)?);
    /// assert!(corner.contains(DVec3::new(0.5, -7.0, 100.0))?);
    ///
    /// let error = Formula::from_vm("x var-x\nout sub x one", Bounds::ALL).unwrap_err();
    /// assert_eq!(error.to_string(), "line 2, `out sub x one`: expected the name of an earlier line, found `one`");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_vm(text: &str, bounds: Bounds) -> Result<Formula, FormulaError> {
        Ok(Formula::of_code(text::parse(text)?, bounds))
    }

    fn of_code(code: Code, bounds: Bounds) -> Formula {
        Formula(Arc::new(Inner {
            code,
            bounds,
            region: [Interval::ALL; 3],
            range: Interval::ALL,
            elder: None,
            roundoff: OnceLock::new(),
            native: Native::default(),
        }))
    }

    /// How many operations it takes, axes and constants counted.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "no formula is empty")]
    pub fn len(&self) -> usize {
        self.0.code.len
    }

    /// The box that holds the shape.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// The formula as a fidget tree, negative inside, its constants in single precision.
    #[must_use]
    pub fn tree(&self) -> Tree {
        self.0.code.tree()
    }

    /// The formula with minima and maxima for its R-functions: of the same sign and the same
    /// surface.
    fn taken_apart(&self) -> Option<Formula> {
        let code = joints::taken_apart(&self.0.code)?;
        Some(Formula::of_code(code, self.0.bounds))
    }

    fn check(&self) -> Result<(), ParamError> {
        match self.0.code.flaw {
            Some(Flaw::Variables(count)) => {
                return Err(ParamError::new("number of variables other than x, y and z", count as f64, "0"));
            }
            Some(Flaw::NotANumber) => {
                return Err(ParamError::new("a constant of the formula", f64::NAN, "any number"));
            }
            None => {}
        }
        let bounds = &self.0.bounds;
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            if min != f64::NEG_INFINITY {
                check::finite(&format!("bounds.min.{name}"), min)?;
            }
            if max != f64::INFINITY {
                check::finite(&format!("bounds.max.{name}"), max)?;
            }
            if min >= max {
                let allowed = format_args!("above bounds.min.{name}, which is {min}").to_string();
                return Err(ParamError::new(format_args!("bounds.max.{name}"), max, allowed));
            }
        }
        Ok(())
    }
}

impl Formula {
    /// Bounds and operations, written out.
    fn text(&self) -> String {
        format!("{:?} {:?} {:?}", self.0.bounds, self.0.region, self.0.code.ops())
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Formula({} operations)", self.len())
    }
}
