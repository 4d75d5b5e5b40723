//! Whole surfaces as points: a wedge by one of the methods, reflected and scaled.
//!
//! ```text
//!            z = y = x                 rows i of constant x from 0 to where x = y = z,
//!           .                          columns j from y = x to y = z; both borders are
//!         . | .   i = j: x = y         points of the wedge to the last digit, so that
//!       .   |   .                      their images coincide and are emitted once
//!      .____|____.
//!     i = 0: x = 0   j = k: y = z
//! ```

use glam::{DVec2, DVec3};

use super::PointError;
use super::curve_points;
use super::explicit::{ExactExplicit, SeriesExplicit};
use super::raw::RawParametric;
use super::tables::{LogTable, PowerTables};
use super::wedge::{Symmetry, reflect};
use crate::{Angle, Field, GeneralisedSuperquadric, Superellipsoid};

/// How the points of a superellipsoid are computed: Franklin and Barr's six methods.
///
/// | method | shapes | error |
/// |---|---|---|
/// | `RawParametric` | any | rounding; uneven for e below 0.5 |
/// | `ExactExplicit` | e1 = e2 | rounding |
/// | `BinomialSeries` | e1 = e2 < 2 | the tolerance |
/// | `LogTable` | e1 = e2 < 2 | the tolerance, at least 10⁻⁶ |
/// | `SphericalProduct` | any | rounding |
/// | `PowerTables` | e1 = e2 | the tolerance, at least 10⁻⁶ |
/// | `Auto` | any | rounding |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PointMethod {
    /// Method 1: signed powers of sines and cosines at equal angles.
    RawParametric,
    /// Method 2: three powers.
    ExactExplicit,
    /// Method 3: two powers and the series.
    BinomialSeries,
    /// Method 4: the series on a table of logarithms.
    LogTable,
    /// Method 5: products of two tabulated curves.
    SphericalProduct,
    /// Method 6: tables of `a^n` and `a^(1/n)`.
    PowerTables,
    /// The fastest that meets the tolerance: products, whatever the exponents and the tolerance.
    /// Their tables cost two curves, a point two multiplications, and they are as exact as the
    /// tables: whole surfaces take 1/80 to 1/115 of the time of method 1 at every point.
    ///
    /// For heights over points that are given, where products cannot serve, what is fastest
    /// depends: [`ExactExplicit`] on lanes of `f32` takes 1/17 to 1/50 of the time of method 1, for
    /// n = 2 1/385; for whole n above 2 and tolerances of 10⁻³ [`SeriesExplicit`] up to 1/89. On
    /// lanes of `f64`, [`ExactExplicit`] takes 1/16 to 1/25 for whole n, 1/7 to 1/10 for others.
    /// `cargo bench --bench points` prints all that, for each exponent and tolerance, beside the
    /// ratios of 1981.
    #[default]
    Auto,
}

/// What points are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct PointSettings {
    /// Samples from the middle of a side to the corner, 1 to 2000. Default: 16.
    pub eighth: u32,
    /// The method. Default: [`PointMethod::Auto`].
    pub method: PointMethod,
    /// How far off the unit surface a point may be, 10⁻¹⁴ to 0.01. Default: 10⁻⁶.
    pub tolerance: f64,
}

impl Default for PointSettings {
    fn default() -> PointSettings {
        PointSettings { eighth: 16, method: PointMethod::Auto, tolerance: 1e-6 }
    }
}

impl PointSettings {
    fn check(&self) -> Result<(), PointError> {
        if !(1..=2000).contains(&self.eighth) {
            let value = f64::from(self.eighth);
            return Err(PointError::Parameter { parameter: "eighth", value, allowed: "1 to 2000" });
        }
        if !(1e-14..=0.01).contains(&self.tolerance) {
            let value = self.tolerance;
            return Err(PointError::Parameter { parameter: "tolerance", value, allowed: "10⁻¹⁴ to 0.01" });
        }
        Ok(())
    }
}

impl PointMethod {
    /// The method that `Auto` stands for.
    #[must_use]
    pub fn resolved(self) -> PointMethod {
        if self == PointMethod::Auto { PointMethod::SphericalProduct } else { self }
    }
}

impl Superellipsoid {
    /// Points all over the surface, each once: a wedge of the unit surface by the method, reflected
    /// 48-fold or 8-fold as the method allows, then scaled; or, by products, a wedge of the equator
    /// reflected 8-fold, and a meridian.
    ///
    /// ```
    /// use rvachev::points::PointSettings;
    /// use rvachev::Superellipsoid;
    ///
    /// let shape = Superellipsoid::new([1.0, 2.0, 3.0], 0.3, 0.3);
    /// let points = shape.points(&PointSettings::default())?;
    /// assert!(points.len() > 5000);
    /// assert!(points.iter().all(|&p| (shape.gauge(p) - 1.0).abs() < 1e-6));
    /// # Ok::<(), rvachev::points::PointError>(())
    /// ```
    ///
    /// # Errors
    /// A parameter out of its range, or a method that is not for these exponents.
    pub fn points(&self, settings: &PointSettings) -> Result<Vec<DVec3>, PointError> {
        self.check()?;
        settings.check()?;
        let [e1, e2] = self.exponents();
        let PointSettings { eighth, tolerance, .. } = *settings;
        let n = 2.0 / e1;
        // On nodes of a table that is as fine as the tolerance asks.
        let size = ((1.0 / tolerance) as u32).clamp(1000, 1 << 20);
        let unit = match settings.method.resolved() {
            PointMethod::RawParametric => raw(&RawParametric::new(e1, e2)?, eighth),
            PointMethod::SphericalProduct | PointMethod::Auto => return products(self, eighth),
            _ if e1 != e2 => return Err(PointError::Exponents { e1, e2 }),
            PointMethod::ExactExplicit => {
                let explicit = ExactExplicit::new(n)?;
                wedge(n, eighth, |x, y, z| explicit.heights(x, y, z))
            }
            PointMethod::BinomialSeries => {
                let series = SeriesExplicit::new(n, tolerance)?;
                wedge(n, eighth, |x, y, z| series.heights(x, y, z))
            }
            PointMethod::LogTable => {
                let table = LogTable::new(n, size, tolerance)?;
                on_nodes(n, eighth, size, |x, y| table.height(x, y))
            }
            PointMethod::PowerTables => {
                let tables = PowerTables::new(n, size)?;
                on_nodes(n, eighth, size, |x, y| tables.height(x, y))
            }
        };
        Ok(unit.into_iter().map(|p| p * self.semi_axes()).collect())
    }
}

/// The cube's wedge 0 ≤ x ≤ y ≤ z by heights, reflected.
fn wedge(n: f64, k: u32, heights: impl Fn(&[f64], &[f64], &mut [f64])) -> Vec<DVec3> {
    let root = 1.0 / n;
    let corner = (1.0f64 / 3.0).powf(root);
    // What lies on the border y = z is known; the rest wants its height.
    let mut points = vec![DVec3::splat(corner)];
    let (mut xs, mut ys) = (vec![], vec![]);
    for i in 0..k {
        let x = corner * f64::from(i) / f64::from(k);
        let widest = ((1.0 - x.powf(n)) / 2.0).powf(root);
        points.push(DVec3::new(x, widest, widest));
        for j in i..k {
            xs.push(x);
            ys.push(x + (widest - x) * f64::from(j - i) / f64::from(k - i));
        }
    }
    let mut zs = vec![0.0; xs.len()];
    heights(&xs, &ys, &mut zs);
    points.extend(xs.iter().zip(&ys).zip(&zs).map(|((&x, &y), &z)| DVec3::new(x, y, z)));
    reflect(&points, Symmetry::Cube)
}

/// The same with x and y moved to nodes of a table of `size` intervals.
fn on_nodes(n: f64, k: u32, size: u32, height: impl Fn(f64, f64) -> f64) -> Vec<DVec3> {
    let size = f64::from(size);
    let node = |v: f64| (v * size).floor() / size;
    let mut points: Vec<DVec3> = Vec::new();
    for i in 0..=k {
        let x = node((1.0f64 / 3.0).powf(1.0 / n) * f64::from(i) / f64::from(k));
        let widest = ((1.0 - x.powf(n)) / 2.0).powf(1.0 / n);
        for j in i..=k {
            let share = if i == k { 1.0 } else { f64::from(j - i) / f64::from(k - i) };
            let y = node(x + (widest - x) * share).max(x);
            let p = DVec3::new(x, y, height(x, y).max(y));
            if points.last() != Some(&p) {
                points.push(p);
            }
        }
    }
    reflect(&points, Symmetry::Cube)
}

/// Equal angles over the octant, reflected.
fn raw(parametric: &RawParametric, eighth: u32) -> Vec<DVec3> {
    let quarter = 2 * eighth;
    let angle = |i: u32| Angle::QUARTER_TURN * f64::from(i) / f64::from(quarter);
    let mut points = vec![DVec3::Z];
    for i in 0..quarter {
        points.extend((0..=quarter).map(|j| DVec3::from(parametric.point(angle(i), angle(j)))));
    }
    reflect(&points, Symmetry::Cuboid)
}

/// Products of two tables, ring by ring from pole to pole: what is reflected is the equator, so
/// that a point costs two multiplications here too.
fn products(shape: &Superellipsoid, eighth: u32) -> Result<Vec<DVec3>, PointError> {
    let ([e1, e2], a) = (shape.exponents(), shape.semi_axes());
    let (meridian, equator) = (curve_points::quarter(e1, eighth)?, curve_points::quarter(e2, eighth)?);
    let last = equator.len() - 1;
    let (onward, back) = (1..=last, (0..last).rev());
    // From the x axis through y, −x and −y; each axis once, and no negative zeros.
    let ring: Vec<DVec2> = std::iter::once(equator[0])
        .chain(onward.clone().map(|i| equator[i]))
        .chain(back.clone().map(|i| DVec2::new(0.0 - equator[i].x, equator[i].y)))
        .chain(onward.map(|i| DVec2::new(0.0 - equator[i].x, 0.0 - equator[i].y)))
        .chain(back.filter(|&i| i > 0).map(|i| DVec2::new(equator[i].x, 0.0 - equator[i].y)))
        .map(|p| p * a.truncate())
        .collect();
    let mut points = Vec::with_capacity(2 + (2 * meridian.len() - 3) * ring.len());
    let mut row = |width: f64, z: f64| points.extend(ring.iter().map(|p| DVec3::new(width * p.x, width * p.y, z)));
    for m in meridian[1..last].iter().rev() {
        row(m.x, a.z * m.y);
    }
    for m in &meridian[..last] {
        row(m.x, 0.0 - a.z * m.y);
    }
    points.extend([DVec3::Z * a.z, DVec3::NEG_Z * a.z + DVec3::ZERO]);
    Ok(points)
}

impl GeneralisedSuperquadric {
    /// Points all over the surface, each once: directions d through the nodes of a cube's faces,
    /// `2·eighth` to a side, moved to `d/G(d)`; reflected 48-fold, 16-fold or 8-fold as the
    /// exponents are equal or not, then scaled.
    ///
    /// ```
    /// use rvachev::field::Field;
    /// use rvachev::GeneralisedSuperquadric;
    ///
    /// let shape = GeneralisedSuperquadric::new([1.0, 2.0, 3.0], [5.0, 3.0, 1.5]);
    /// let points = shape.points(8)?;
    /// assert_eq!(points.len(), 6 * 16 * 16 + 2);
    /// assert!(points.iter().all(|p| shape.eval(p.to_array()).abs() < 1e-12));
    /// # Ok::<(), rvachev::points::PointError>(())
    /// ```
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn points(&self, eighth: u32) -> Result<Vec<DVec3>, PointError> {
        self.check()?;
        PointSettings { eighth, ..PointSettings::default() }.check()?;
        let n = self.exponents();
        let unit = GeneralisedSuperquadric::new(DVec3::ONE, n);
        let symmetry = if n[0] == n[1] && n[1] == n[2] {
            Symmetry::Cube
        } else if n[0] == n[1] {
            Symmetry::SquarePrism
        } else {
            Symmetry::Cuboid
        };
        let mut points = vec![];
        for x in 0..=eighth {
            for y in 0..=eighth {
                for z in 0..=eighth {
                    let wanted = match symmetry {
                        Symmetry::Cuboid => true,
                        Symmetry::SquarePrism => x <= y,
                        Symmetry::Cube => x <= y && y <= z,
                    };
                    if wanted && x.max(y).max(z) == eighth {
                        let d = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) / f64::from(eighth);
                        points.push(d / unit.gauge(d));
                    }
                }
            }
        }
        Ok(reflect(&points, symmetry).into_iter().map(|p| p * self.semi_axes()).collect())
    }
}
