//! Control polygons and their limit curves.
//!
//! ```text
//!     closed   every point has two neighbours; the limit curve is closed
//!
//!     open     p0 . . p1 ___ p2 ___ p3 . . p4     the curve runs from the limit of the second
//!                                                 point to that of the last but one
//!     clamped  the same with a mirrored point before and after: 2p0 − p1; the curve runs from
//!              the first point to the last
//! ```

use glam::{DVec2, DVec3};

use super::refine::{refine, refined_len, stencil};
use super::{MOST_ON_CURVE, SubdivisionError, Tension, check_coordinates, check_levels};

/// A point of the plane or of space: `DVec2` or `DVec3`.
pub trait ControlPoint: Copy + sealed::Coordinates {}

impl ControlPoint for DVec2 {}
impl ControlPoint for DVec3 {}

pub(super) mod sealed {
    use glam::{DVec2, DVec3};

    /// A point as a row of coordinates.
    pub trait Coordinates: Sized {
        /// A row of rows of them.
        type Rows: Rows<Self>;
    }

    /// Rows of coordinates of one dimension.
    pub trait Rows<P>: Clone + std::fmt::Debug + PartialEq + Default {
        fn new(points: &[P]) -> Self;
        fn points(&self) -> Vec<P>;
        fn len(&self) -> usize;
        fn assign(&mut self, other: &Self);
        fn check(&self) -> Result<(), super::SubdivisionError>;
        fn refine(&mut self, closed: bool, masks: impl ExactSizeIterator<Item = [f64; 2]>);
        fn stencilled(&self, closed: bool, weights: [f64; 3]) -> Self;
    }

    impl Coordinates for DVec2 {
        type Rows = Vec<[f64; 2]>;
    }

    impl Coordinates for DVec3 {
        type Rows = Vec<[f64; 3]>;
    }

    impl<P: Copy + From<[f64; N]> + Into<[f64; N]>, const N: usize> Rows<P> for Vec<[f64; N]> {
        fn new(points: &[P]) -> Self {
            points.iter().map(|&p| p.into()).collect()
        }
        fn points(&self) -> Vec<P> {
            self.iter().map(|&p| P::from(p)).collect()
        }
        fn len(&self) -> usize {
            Vec::len(self)
        }
        fn assign(&mut self, other: &Self) {
            self.clone_from(other);
        }
        fn check(&self) -> Result<(), super::SubdivisionError> {
            super::check_coordinates(self.iter().copied())
        }
        fn refine(&mut self, closed: bool, masks: impl ExactSizeIterator<Item = [f64; 2]>) {
            let mut count = Vec::len(self);
            let len = (0..masks.len()).fold(count, |count, _| super::refined_len(count, closed));
            self.resize(len, [0.0; N]);
            for mask in masks {
                super::refine(self, count, closed, mask);
                count = super::refined_len(count, closed);
            }
        }
        fn stencilled(&self, closed: bool, weights: [f64; 3]) -> Self {
            super::stencil(self, closed, weights)
        }
    }
}

use sealed::Rows;

/// A control polygon: points, whether it is closed, and its [`Tension`].
///
/// ```
/// use glam::DVec2;
/// use rvachev::subdivision::ControlPolygon;
///
/// // The ellipse that touches the sides of a rectangle of 6 × 3.
/// let ellipse = ControlPolygon::ellipse(DVec2::new(3.0, 1.5))?;
/// for p in ellipse.limit(5)? {
///     assert!(((p.x / 3.0).powi(2) + (p.y / 1.5).powi(2) - 1.0).abs() < 1e-14);
/// }
/// # Ok::<(), rvachev::subdivision::SubdivisionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ControlPolygon<P: ControlPoint> {
    rows: P::Rows,
    closed: bool,
    tension: Tension,
}

impl<P: ControlPoint> ControlPolygon<P> {
    /// A closed polygon of 3 points or more.
    ///
    /// # Errors
    /// Fewer points, or a coordinate that is not finite or beyond 10¹².
    pub fn closed(points: &[P], tension: Tension) -> Result<ControlPolygon<P>, SubdivisionError> {
        ControlPolygon::new(points, true, tension, 3)
    }

    /// An open polygon of 4 points or more. Its curve runs from the limit of the second point to
    /// that of the last but one: the ends only steer.
    ///
    /// # Errors
    /// Fewer points, or a coordinate that is not finite or beyond 10¹².
    pub fn open(points: &[P], tension: Tension) -> Result<ControlPolygon<P>, SubdivisionError> {
        ControlPolygon::new(points, false, tension, 4)
    }

    fn new(points: &[P], closed: bool, tension: Tension, least: usize) -> Result<ControlPolygon<P>, SubdivisionError> {
        let of = if closed { "a closed polygon" } else { "an open polygon" };
        let rows = P::Rows::new(points);
        if rows.len() < least {
            return Err(SubdivisionError::TooFewPoints { of, points: points.len(), least });
        }
        rows.check()?;
        Ok(ControlPolygon { rows, closed, tension })
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> Vec<P> {
        self.rows.points()
    }

    /// How many points there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no points: never.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the polygon is closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The tension.
    #[must_use]
    pub fn tension(&self) -> Tension {
        self.tension
    }

    /// The polygon after some levels of subdivision, with the tension that goes on from there. A
    /// closed polygon doubles its points a level; an open one of n has 2n − 3 after it.
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁶ points.
    pub fn subdivided(&self, levels: u32) -> Result<ControlPolygon<P>, SubdivisionError> {
        let mut fine = ControlPolygon { rows: P::Rows::default(), closed: self.closed, tension: self.tension };
        self.subdivide_into(levels, &mut fine)?;
        Ok(fine)
    }

    /// The same in place of another polygon, whose memory is used again: fresh memory from the
    /// system may cost several times what the arithmetic does.
    ///
    /// ```
    /// use rvachev::subdivision::ControlPolygon;
    ///
    /// let mut fine = ControlPolygon::ellipse([1.0, 1.0])?;
    /// for width in [1.0, 2.0, 3.0] {
    ///     ControlPolygon::ellipse([width, 1.0])?.subdivide_into(8, &mut fine)?;
    ///     assert_eq!(fine.len(), 4 << 8);
    ///     assert!((fine.limit_points()[0].x - width).abs() < 1e-14);
    /// }
    /// # Ok::<(), rvachev::subdivision::SubdivisionError>(())
    /// ```
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁶ points; `fine` is then as it was.
    pub fn subdivide_into(&self, levels: u32, fine: &mut ControlPolygon<P>) -> Result<(), SubdivisionError> {
        check_levels(self.len(), levels, 1, MOST_ON_CURVE)?;
        let ControlPolygon { rows, closed, tension } = fine;
        (*closed, *tension) = (self.closed, self.tension.at_level(levels));
        rows.assign(&self.rows);
        rows.refine(self.closed, (0..levels).map(|level| self.tension.mask(level + 1)));
        Ok(())
    }

    /// Where the points end up on the limit curve; of an open polygon all but the first and last.
    #[must_use]
    pub fn limit_points(&self) -> Vec<P> {
        let [neighbour, own] = self.tension.limit_weights(0);
        self.rows.stencilled(self.closed, [neighbour, own, neighbour]).points()
    }

    /// The derivatives of the limit curve at the limit points, per radian of the tension's step
    /// (per control interval for the cubic one).
    #[must_use]
    pub fn limit_tangents(&self) -> Vec<P> {
        let weight = self.tension.tangent_weight(0);
        self.rows.stencilled(self.closed, [-weight, 0.0, weight]).points()
    }

    /// Points of the limit curve after some levels: [`subdivided`](Self::subdivided), then
    /// [`limit_points`](Self::limit_points).
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁶ points.
    pub fn limit(&self, levels: u32) -> Result<Vec<P>, SubdivisionError> {
        Ok(self.subdivided(levels)?.limit_points())
    }
}

impl<P: ControlPoint + std::ops::Sub<Output = P> + std::ops::Add<Output = P>> ControlPolygon<P> {
    /// An open polygon of 2 points or more, whose curve runs from the first to the last of them.
    ///
    /// # Errors
    /// Fewer points, or a coordinate that is not finite or beyond 10¹².
    pub fn clamped(points: &[P], tension: Tension) -> Result<ControlPolygon<P>, SubdivisionError> {
        let of = "a clamped polygon";
        let (&[first, second, ..], &[.., before, last]) = (points, points) else {
            return Err(SubdivisionError::TooFewPoints { of, points: points.len(), least: 2 });
        };
        let mut extended = vec![first + first - second];
        extended.extend_from_slice(points);
        extended.push(last + last - before);
        ControlPolygon::open(&extended, tension)
    }
}
