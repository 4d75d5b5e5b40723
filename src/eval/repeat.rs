//! Repetition: rows, grids and rings of copies. (It lies here, above `solid`, because it asks
//! the operand for its box.)
//!
//! Copies are not made one by one: space is folded onto the operand, a few times where copies
//! are near one another, so that the cost does not depend on how many there are.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DQuat, DVec3};

use crate::{Bounds, RFunction, Repetition, Solid};
use rvachev_field::{AnyWarp, Cells, Comb, Sectors};

/// More folds than this along one axis are not worth it: the copies overlap so much that each
/// is made on its own.
const FOLDS: f64 = 16.0;

/// The most copies that are made one by one, or folds, of one repetition.
const COPIES: f64 = 4096.0;

/// What a width in spacings may be over a whole number.
const ROUNDING: f64 = 1e-9;

impl Solid {
    /// A grid of copies along the axes: `counts` of them, `spacing` apart. The first one is the
    /// solid where it is, the others are moved by `(i·spacing.x, j·spacing.y, k·spacing.z)`.
    ///
    #[doc = picture!("repeat" = "docs/gallery/repeat.png")]
    ///
    /// The inside is that of the union of all copies, which may overlap as they like, and so is
    /// the value there (by the maximum). Outside, where the solid's value is the true
    /// distance, the value is that of the union too; where it is a bound of the distance, the
    /// value is a bound of the distance to the nearest copy, and may step half-way between
    /// copies. The cost does not depend on `counts`: space is folded onto the solid twice along
    /// each axis, and more often only where the solid is wider than its spacing.
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `counts` | copies | 1 to 10⁶ along each axis |
    /// | `spacing` | length | 10⁻⁹ to 10⁹ along each axis with more than one copy, and so `counts` times `spacing` |
    ///
    /// A solid that is unbounded along an axis, or wider than 15 spacings, is copied one by
    /// one, which is an error for more than 4096 copies.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let holes = Solid::cylinder(0.3, 2.0).repeat([20, 10, 1], DVec3::new(1.0, 1.0, 0.0));
    /// let plate = Solid::cuboid(DVec3::new(20.0, 10.0, 1.0)).translate(DVec3::new(9.5, 4.5, 0.0));
    /// let sieve = plate - holes;
    /// assert!(!sieve.contains(DVec3::new(12.0, 7.2, 0.0))?);
    /// assert!(sieve.contains(DVec3::new(12.5, 7.5, 0.0))?);
    /// // 200 holes for the price of four.
    /// assert_eq!(sieve.surface_program()?.leaf_count(), 5);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat(&self, counts: [u32; 3], spacing: impl Into<DVec3>) -> Solid {
        let spacing = spacing.into();
        Repetition::Grid { counts, spacing }.of(self, self.grid(counts, spacing))
    }

    /// What a grid is made of.
    fn grid(&self, counts: [u32; 3], spacing: DVec3) -> Solid {
        let mut fold = Cells { axes: [Comb::ONE; 3], counts, spacing, crowded: None };
        if fold.check(&Bounds::ALL).is_err() {
            // The fault is told when the solid is compiled, and so is one of the operand.
            return self.warp(fold);
        }
        let bounds = self.bounds().unwrap_or(Bounds::EMPTY);
        let folds = [0, 1, 2].map(|axis| {
            let width = if bounds.is_empty() { 0.0 } else { bounds.max[axis] - bounds.min[axis] };
            folds_of(width, spacing[axis], counts[axis])
        });
        let all: f64 = folds.iter().copied().map(f64::from).product();
        if all > COPIES {
            fold.crowded = Some(all);
            return self.warp(fold);
        }
        let comb = |axis: usize, class: u32| match counts[axis] {
            1 => Comb::ONE,
            count => Comb {
                offset: f64::from(class) * spacing[axis],
                pitch: f64::from(folds[axis]) * spacing[axis],
                last: f64::from((count - 1 - class) / folds[axis]),
                centre: bounds.center()[axis],
            },
        };
        let mut parts = Vec::new();
        for k in 0..folds[2] {
            for j in 0..folds[1] {
                for i in 0..folds[0] {
                    let axes = [comb(0, i), comb(1, j), comb(2, k)];
                    let offset = DVec3::from_array(axes.map(|comb| comb.offset));
                    parts.push(match axes.iter().all(|comb| comb.last == 0.0) {
                        true if offset == DVec3::ZERO => self.clone(),
                        true => self.affine_as("repeat", DAffine3::from_translation(offset)),
                        false => self.warp(Cells { axes, ..fold }),
                    });
                }
            }
        }
        union_of(parts)
    }

    /// A row of `count` copies, each `step` from the one before; the first one is the solid
    /// where it is. Values and limits are those of [`repeat`](Solid::repeat).
    ///
    #[doc = picture!("repeat_linear" = "docs/gallery/repeat_linear.png")]
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let step = DVec3::new(0.0, 0.3, 0.2);
    /// let stairs = Solid::cuboid(DVec3::new(1.0, 0.4, 0.2)).repeat_linear(12, step);
    /// assert!(stairs.contains(11.0 * step)?);
    /// assert!(!stairs.contains(12.0 * step)?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat_linear(&self, count: u32, step: impl Into<DVec3>) -> Solid {
        let step = step.into();
        Repetition::Row { count, step }.of(self, self.row(count, step))
    }

    /// What a row is made of.
    fn row(&self, count: u32, step: DVec3) -> Solid {
        let length = step.length();
        let along = |axis: usize, from: &Solid, spacing: f64| {
            let mut counts = [1; 3];
            counts[axis] = count;
            from.grid(counts, DVec3::AXES[axis] * spacing)
        };
        // Along an axis nothing needs turning. (What is no direction is told as a spacing.)
        let alone = (0..3).find(|&axis| step[axis].abs() == length);
        match alone {
            Some(axis) if step[axis] < 0.0 => {
                let last = step * f64::from(count.max(1) - 1);
                along(axis, &self.translate(last), length)
            }
            Some(axis) => along(axis, self, length),
            None if !(length.is_finite() && length > 0.0) => along(0, self, length),
            None => {
                let turn = DQuat::from_rotation_arc(step / length, DVec3::X);
                along(0, &self.rotate(turn), length).rotate(turn.inverse())
            }
        }
    }

    /// A ring of `count` copies about the z axis, at equal angles of a whole turn; the first
    /// one is the solid where it is.
    ///
    #[doc = picture!("repeat_polar" = "docs/gallery/repeat_polar.png")]
    ///
    /// Values are those of [`repeat`](Solid::repeat): the cost does not depend on `count` (two
    /// folds where `count` is even, three or four where it is not, more only where the solid
    /// spans more than its share of the turn). A solid whose box meets the axis is copied one
    /// by one.
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `count` | copies | 1 to 1000 |
    ///
    /// ```
    /// use rvachev::{deg, Solid};
    /// use glam::DVec3;
    ///
    /// let bolts = Solid::cylinder(0.2, 1.0).translate(DVec3::X * 3.0).repeat_polar(24);
    /// let (sin, cos) = deg(15.0).sin_cos();
    /// assert!(bolts.contains(DVec3::new(3.0 * cos, 3.0 * sin, 0.0))?);
    /// assert_eq!(bolts.surface_program()?.leaf_count(), 2);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat_polar(&self, count: u32) -> Solid {
        Repetition::Ring { count }.of(self, self.ring(count))
    }

    /// What a ring is made of.
    fn ring(&self, count: u32) -> Solid {
        let fold = Sectors { count, blocks: 1, class: 0, middle: 0.0 };
        if fold.check(&Bounds::ALL).is_err() {
            return self.warp(fold);
        }
        let bounds = self.bounds().unwrap_or(Bounds::EMPTY);
        let (middle, half) = angles_of(&bounds);
        let blocks = blocks_of(half / (TAU / f64::from(count)), count);
        let mut parts = Vec::new();
        for class in 0..count.div_ceil(blocks) {
            parts.push(match (blocks, class) {
                (1, 0) => self.clone(),
                (1, _) => {
                    let angle = TAU * f64::from(class) / f64::from(count);
                    self.affine_as("repeat_polar", DAffine3::from_rotation_z(angle))
                }
                _ => self.warp(Sectors { blocks, class, middle, ..fold }),
            });
        }
        union_of(parts)
    }
}

/// The union by maxima; of a single part, the part.
fn union_of(parts: Vec<Solid>) -> Solid {
    match parts.as_slice() {
        [only] => only.clone(),
        _ => Solid::union_all(parts, RFunction::MIN_MAX),
    }
}

/// How many classes the copies of a solid of this width fall into along an axis.
fn folds_of(width: f64, spacing: f64, count: u32) -> u32 {
    if count == 1 {
        return 1;
    }
    let folds = (width / spacing + 1.0 - ROUNDING).ceil().max(2.0);
    // A comparison that holds of no NaN.
    if folds <= FOLDS { count.min(folds as u32) } else { count }
}

/// Middle and half width of the angles about z that a box spans; a whole turn if it meets the
/// axis.
fn angles_of(bounds: &Bounds) -> (f64, f64) {
    let (low, high) = (bounds.min, bounds.max);
    let meets = low.x <= 0.0 && high.x >= 0.0 && low.y <= 0.0 && high.y >= 0.0;
    // Along z it may be unbounded, as a column is.
    let is_finite = low.truncate().is_finite() && high.truncate().is_finite();
    if bounds.is_empty() || !is_finite || meets {
        return (0.0, PI);
    }
    // Seen from its centre's direction a box beside the axis lies within half a turn.
    let centre = bounds.center().truncate();
    let angles = bounds.corners().map(|corner| centre.angle_to(corner.truncate()));
    let (least, most) = angles.iter().fold((0.0f64, 0.0f64), |(a, b), &angle| (a.min(angle), b.max(angle)));
    (centre.to_angle() + 0.5 * (least + most), 0.5 * (most - least))
}

/// Into how many blocks a ring is cut for an operand of this half width in copies: as many as
/// leave it exact.
fn blocks_of(half: f64, count: u32) -> u32 {
    let copies = f64::from(count);
    let even = (2.0 * half + 1.0 - ROUNDING).max(2.0);
    let uneven = ((copies / (2.0 * half + 2.0)) as u32).max(1);
    let divisor = (1..=count).find(|&d| count.is_multiple_of(d) && f64::from(d) >= even);
    divisor.map_or(1, |d| count / d).max(uneven)
}
