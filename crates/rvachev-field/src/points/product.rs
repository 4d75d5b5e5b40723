//! The spherical product of two tabulated curves: method 5.

use std::ops::Mul;

use glam::DVec2;

use super::{PointError, curve_points};
use crate::kernel::{Task, dispatched};

/// Two quarters of superellipses in tables; their products are the points of an octant (method
/// 5): three loads and two multiplications a point, as exact as the tables.
///
/// ```text
/// (C₁.c·C₂.c, C₁.c·C₂.s, C₁.s)      C₁ the meridian (from equator to pole), C₂ the equator
/// ```
///
/// The tables are sampled evenly by the explicit form, not by angles.
///
/// ```
/// use rvachev::points::ProductTables;
///
/// let tables = ProductTables::new(0.5, 0.5, 45)?;
/// let mut out = [vec![0.0; 91 * 91], vec![0.0; 91 * 91], vec![0.0; 91 * 91]];
/// tables.octant(out.each_mut().map(|v| v.as_mut_slice()));
/// for ((x, y), z) in out[0].iter().zip(&out[1]).zip(&out[2]) {
///     assert!((x.powi(4) + y.powi(4) + z.powi(4) - 1.0).abs() < 1e-6);
/// }
/// # Ok::<(), rvachev::points::PointError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ProductTables {
    double: Tables<f64>,
    single: Tables<f32>,
}

/// Coordinates of both quarters.
#[derive(Clone, Debug, PartialEq)]
struct Tables<T> {
    meridian: [Vec<T>; 2],
    equator: [Vec<T>; 2],
}

impl ProductTables {
    /// Tables of `2·eighth + 1` samples each, for the exponents e1 and e2 (0.0002 to 10);
    /// `eighth` is 1 to 100 000.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn new(e1: f64, e2: f64, eighth: u32) -> Result<ProductTables, PointError> {
        let table = |e: f64| -> Result<[Vec<f64>; 2], PointError> {
            let quarter: Vec<DVec2> = curve_points::quarter(e, eighth)?;
            Ok([quarter.iter().map(|p| p.x).collect(), quarter.iter().map(|p| p.y).collect()])
        };
        let (meridian, equator) = (table(e1)?, table(e2)?);
        let rounded = |table: &[Vec<f64>; 2]| table.each_ref().map(|v| v.iter().map(|&c| c as f32).collect());
        let single = Tables { meridian: rounded(&meridian), equator: rounded(&equator) };
        Ok(ProductTables { double: Tables { meridian, equator }, single })
    }

    /// Samples of the meridian and of the equator.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.double.meridian[0].len(), self.double.equator[0].len()]
    }

    /// All products: x, y and z of one octant, meridian sample by meridian sample, in single
    /// precision.
    ///
    /// # Panics
    /// If the slices do not hold as many numbers as the product of both [sizes](Self::size).
    pub fn octant(&self, out: [&mut [f32]; 3]) {
        products(&self.single, out);
    }

    /// The same in double precision.
    ///
    /// # Panics
    /// If the slices do not hold as many numbers as the product of both [sizes](Self::size).
    pub fn octant_double(&self, out: [&mut [f64]; 3]) {
        products(&self.double, out);
    }
}

fn products<T: Copy + Mul<Output = T>>(tables: &Tables<T>, out: [&mut [T]; 3]) {
    let (rows, columns) = (tables.meridian[0].len(), tables.equator[0].len());
    assert!(out.iter().all(|o| o.len() == rows * columns), "slices of {rows} × {columns} numbers are needed");
    dispatched(Products { tables, out });
}

struct Products<'a, T> {
    tables: &'a Tables<T>,
    out: [&'a mut [T]; 3],
}

impl<T: Copy + Mul<Output = T>> Task for Products<'_, T> {
    #[inline(always)]
    fn run(self) {
        let Tables { meridian: [mc, ms], equator: [ec, es] } = self.tables;
        let columns = ec.len();
        let [xs, ys, zs] = self.out;
        let rows = xs.chunks_exact_mut(columns).zip(ys.chunks_exact_mut(columns)).zip(zs.chunks_exact_mut(columns));
        for (((xs, ys), zs), (&c, &s)) in rows.zip(mc.iter().zip(ms)) {
            for (x, &e) in xs.iter_mut().zip(ec) {
                *x = c * e;
            }
            for (y, &e) in ys.iter_mut().zip(es) {
                *y = c * e;
            }
            zs.fill(s);
        }
    }
}
