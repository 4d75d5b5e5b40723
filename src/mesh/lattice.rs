//! The lattice that a solid is sampled on.
//!
//! ```text
//!      +---+---+---+---+---+---+     node (i, j, k) is at origin + step · (i, j, k)
//!      |   |   |   |   |   |   |
//!      +---+---+---+---+---+---+     cells are cubes
//!      |   |###|###|###|###|   |
//!      +---+#bounds asked#-+---+     at least one cell of margin all around
//!      |   |###|###|###|###|   |
//!      +---+---+---+---+---+---+
//!      |   |   |   |   |   |   |
//! origin --+---+---+---+---+---+
//! ```
//!
//! Along each axis the nodes are at (n + 11/32) · step for integers n, and the step has at most
//! 8 significant bits: m · 2ᵉ with 128 ≤ m ≤ 255.
//!
//! * A node is then (32 n + 11) · m · 2ᵉ⁻⁵, which is exact in f32 while |n| < 2¹¹, and in f64
//!   while |n| < 2⁴⁰: neighbouring blocks, and f32 and f64, mean the same point.
//! * The lattice does not depend on the bounds, which only choose a part of it: the mesh of a
//!   part of a solid fits that of the whole.
//! * Designs have faces on round coordinates, and a node on a face has no certain sign. The
//!   shift of 11/32 keeps nodes off all multiples of step / 16, and those of other round
//!   lengths are met by chance only.

use glam::{DVec3, Vec3};

use rvachev_num::Bounds;

use crate::eval::BESIDE;

/// The resolution of a mesh.
///
/// The cell size that is used is the one asked for, rounded up to 8 significant bits: by less
/// than 0.8 %.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CellSize {
    /// The side of a cubic cell in length units, finite and above 0.
    Length(f64),
    /// The number of cells along the longest side of the bounds, at least 1; of a solid that is
    /// cut, of the part of its box within them. The default: 128.
    LongestSide(u32),
    /// How far triangles and surface may be apart, in length units, finite and above 0: cells are
    /// as small as the surface's curvature asks, each where it does, and then as many triangles are
    /// taken away as the tolerance allows. Flat faces have few: a plain box has a dozen, some
    /// hundred where it is turned out of the axes, a sphere of radius r about 12 r / tolerance.
    ///
    /// The mesh is closed, manifold and free of self-intersection as all others are, edges and
    /// corners stay sharp, and what is thinner than the cells that it begins with may be lost as in
    /// any mesh: those are as large as half of the thinnest leaf, and a twenty-fourth of the
    /// longest side at most. Of [meshes that are solids](crate::Solid::from_mesh) the creases
    /// between facets are kept however blunt they are, and cells are halved where the mesh has lost
    /// a corner. Where the tolerance is not reached, [`Mesh::warnings`](crate::Mesh::warnings) says
    /// so, and [`Mesh::deviation`](crate::Mesh::deviation) how far off the mesh is. It takes
    /// several times as long as one mesh in cells of the smallest size.
    ///
    /// Where only a cell size is asked for, as by
    /// [`Solid::thin_features`](crate::Solid::thin_features), it stands for a twenty-fourth of the
    /// longest side.
    ///
    /// ```
    /// use rvachev::{CellSize, MeshSettings, Solid};
    ///
    /// let plate = Solid::cuboid([60.0, 40.0, 5.0]) - Solid::cylinder(8.0, 20.0);
    /// let settings = MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() };
    /// let mesh = plate.mesh(&settings)?;
    /// assert!(mesh.check().is_sound() && mesh.warnings().is_empty());
    /// assert!(mesh.deviation().unwrap() < 0.02 && mesh.triangles().len() < 1000);
    /// # Ok::<(), rvachev::error::MeshingError>(())
    /// ```
    Tolerance(f64),
}

impl Default for CellSize {
    fn default() -> Self {
        CellSize::LongestSide(128)
    }
}

/// Why there is no lattice of the given resolution over the given bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// The cell size is not a positive length.
    #[error("cell size is {value}; it must be finite, above {MIN_STEP:e} and below {MAX_STEP:e}")]
    Length {
        /// The cell size, in length units.
        value: f64,
    },
    /// The number of cells is 0.
    #[error("cells along the longest side is {value}; it must be at least 1")]
    LongestSide {
        /// The number of cells.
        value: u32,
    },
    /// The tolerance is not a positive length.
    #[error("tolerance is {value}; it must be finite, above {MIN_STEP:e} and below {MAX_STEP:e}")]
    Tolerance {
        /// The tolerance, in length units.
        value: f64,
    },
    /// The bounds are empty, infinite, a single point where the cell size is relative to
    /// them, or out of the range of f32.
    #[error(
        "bounds are from {} to {}; they must be finite, not empty, within ±1e37, and have a \
         size if the cell size is a part of it", .value.min, .value.max
    )]
    Bounds {
        /// The bounds.
        value: Bounds,
    },
    /// There are too many cells along an axis or in all.
    #[error(
        "cell size is {step}, which makes {x:e} × {y:e} × {z:e} cells; at most {} along an \
         axis and {:e} in all are allowed",
        MAX_CELLS_ALONG_AXIS,
        MAX_CELLS
    )]
    Cells {
        /// The side of a cell, in length units.
        step: f64,
        /// Cells along x.
        x: f64,
        /// Cells along y.
        y: f64,
        /// Cells along z.
        z: f64,
    },
    /// The cells are too small for their distance from the origin: the positions of a mesh,
    /// which are f32, would fall together.
    #[error(
        "cell size is {step}; with coordinates up to {farthest} it must be at least {smallest}, \
         for positions are f32"
    )]
    Far {
        /// The side of a cell, in length units.
        step: f64,
        /// The largest coordinate, in length units.
        farthest: f64,
        /// The smallest cell size that is allowed there, in length units.
        smallest: f64,
    },
}

/// Smaller steps meet the denormal numbers of f32.
const MIN_STEP: f64 = 1e-30;
/// Larger steps meet the largest numbers of f32.
const MAX_STEP: f64 = 1e36;
/// The largest coordinate.
const MAX_COORDINATE: f64 = 1e37;
/// The largest number of cells along an axis, 2³¹: node numbers stay clear of the end of u32.
const MAX_CELLS_ALONG_AXIS: f64 = 2_147_483_648.0;
/// The largest number of cells in all, 2⁴⁴: a mesh of a smooth solid has about the 2/3rd power
/// of it in triangles, which is at the end of 32-bit indices.
const MAX_CELLS: f64 = 17_592_186_044_416.0;
/// Cells along the longest side that a mesh within a tolerance begins with.
const AT_FIRST: u32 = 24;
/// Where nodes are within a step, see the module.
const SHIFT: f64 = 11.0 / 32.0;
/// How far vertices stay from nodes, in cells, where f32 allows it.
const CLEARANCE: f64 = 1.0 / 1024.0;

/// A cubic lattice of sample points, and the cells between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    origin: DVec3,
    step: f64,
    cells: [u32; 3],
    /// How far a vertex on a lattice edge stays from its ends, as a part of the edge: 2⁻¹⁰, or
    /// more where the coordinates are so large that f32 does not resolve that.
    clearance: f64,
}

impl Lattice {
    /// The lattice of a resolution over `bounds`: the whole box is covered, and a margin of one
    /// cell on each side.
    ///
    /// # Errors
    ///
    /// [`LatticeError`] names the parameter, its value and what is allowed.
    pub fn new(bounds: &Bounds, cell: CellSize) -> Result<Lattice, LatticeError> {
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        if bounds.is_empty() || reach > MAX_COORDINATE {
            return Err(LatticeError::Bounds { value: *bounds });
        }
        let along = |cells: u32| match bounds.longest_side() {
            0.0 => Err(LatticeError::Bounds { value: *bounds }),
            longest => Ok(longest / f64::from(cells)),
        };
        let wanted = match cell {
            CellSize::Length(length) => length,
            CellSize::LongestSide(0) => return Err(LatticeError::LongestSide { value: 0 }),
            CellSize::LongestSide(cells) => along(cells)?,
            CellSize::Tolerance(value) if value > MIN_STEP && value < MAX_STEP => along(AT_FIRST)?,
            CellSize::Tolerance(value) => return Err(LatticeError::Tolerance { value }),
        };
        // Written such that NaN fails as well.
        if !(wanted > MIN_STEP && wanted < MAX_STEP) {
            return Err(LatticeError::Length { value: wanted });
        }
        let step = round_up(wanted);

        // In cells. The division is rounded, and so may a face be that lies on a node: one
        // cell in 2⁴⁰ is lost from the margin then, none from the bounds.
        let first = (bounds.min / step - SHIFT).floor() - 1.0;
        let last = (bounds.max / step - SHIFT).ceil() + 1.0;
        let count = last - first;
        if count.max_element() > MAX_CELLS_ALONG_AXIS || count.element_product() > MAX_CELLS {
            let DVec3 { x, y, z } = count;
            return Err(LatticeError::Cells { step, x, y, z });
        }
        Lattice::clear((first + SHIFT) * step, step, count.to_array(), reach + 2.0 * step)
    }

    /// The lattice of so many cells from a node, with vertices clear of nodes; coordinates are up
    /// to `farthest`.
    fn clear(origin: DVec3, step: f64, cells: [f64; 3], farthest: f64) -> Result<Lattice, LatticeError> {
        // Two f32 apart, a vertex cannot fall together with the node or with a vertex on
        // another edge of it; a quarter of a cell is left between those at its two ends.
        let spacing = f64::from((farthest as f32).next_up() - farthest as f32);
        let clearance = CLEARANCE.max(2.0 * spacing / step);
        if clearance > 0.25 {
            return Err(LatticeError::Far { step, farthest, smallest: 8.0 * spacing });
        }
        Ok(Lattice {
            origin,
            step,
            // Integers between 3 and 2³¹.
            cells: cells.map(|n| n as u32),
            clearance,
        })
    }

    /// The same box in cells of half the side: node (i, j, k) is node (2i, 2j, 2k) of it. `None` if
    /// they are too many along an axis, or too small for f32.
    pub(crate) fn halved(&self) -> Option<Lattice> {
        let farthest = self.origin.abs().max(self.bounds().max.abs()).max_element();
        let (step, cells) = (0.5 * self.step, self.cells.map(|n| 2.0 * f64::from(n)));
        let is_allowed = step > MIN_STEP && cells.iter().all(|&n| n <= MAX_CELLS_ALONG_AXIS);
        Lattice::clear(self.origin, step, cells, farthest).ok().filter(|_| is_allowed)
    }

    /// The position of node (0, 0, 0), exact.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The side of a cell, in length units.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The number of cells along each axis; there is one node more.
    #[must_use]
    pub fn cells(&self) -> [u32; 3] {
        self.cells
    }

    /// The position of a node, exact. Nodes beyond the last one are defined as well.
    #[must_use]
    #[inline]
    pub fn node(&self, i: u32, j: u32, k: u32) -> DVec3 {
        let index = DVec3::new(f64::from(i), f64::from(j), f64::from(k));
        self.origin + index * self.step
    }

    /// The box of so many cells along each axis, from one on.
    pub(super) fn region(&self, [i, j, k]: [u32; 3], size: usize) -> Bounds {
        let size = size as u32;
        Bounds::new(self.node(i, j, k), self.node(i + size, j + size, k + size))
    }

    /// The same with what is close about it: a face that operands share there is within it.
    pub(super) fn about(&self, first: [u32; 3], size: usize) -> Bounds {
        self.region(first, size).inflate(self.close())
    }

    /// What is closer than this is close about a point.
    pub(super) fn close(&self) -> f64 {
        2.0 * BESIDE * self.scale()
    }

    /// The largest length about it: what rounding is in proportion to.
    pub(super) fn scale(&self) -> f64 {
        let bounds = self.bounds();
        bounds.longest_side() + bounds.min.abs().max(bounds.max.abs()).max_element()
    }

    /// The box of all cells.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let [i, j, k] = self.cells;
        Bounds::new(self.origin, self.node(i, j, k))
    }

    /// A vertex on an edge is farther than this from the planes of nodes across it, and closer to
    /// those along it, in cells, whatever f32 makes of it.
    pub(crate) fn slack(&self) -> f64 {
        0.5 * self.clearance
    }

    /// Whether [`vertex`](Lattice::vertex) moves `t`.
    #[inline(always)]
    pub(crate) fn is_clamped(&self, t: f64) -> bool {
        !(self.clearance..=1.0 - self.clearance).contains(&t)
    }

    /// The vertex on the edge that leaves a node along an axis, at `t` from 0 to 1 of its
    /// length. `t` is moved to be clear of the ends; that of NaN is the middle.
    #[inline(always)]
    pub(crate) fn vertex(&self, node: [u32; 3], axis: usize, t: f64) -> Vec3 {
        let [i, j, k] = node;
        let mut p = self.node(i, j, k);
        let t = if t.is_nan() { 0.5 } else { t };
        let by = t.clamp(self.clearance, 1.0 - self.clearance) * self.step;
        match axis {
            0 => p.x += by,
            1 => p.y += by,
            _ => p.z += by,
        }
        p.as_vec3()
    }
}

/// The smallest number of at most 8 significant bits that is not below `x`, which is positive
/// and normal.
fn round_up(x: f64) -> f64 {
    // The lower 45 of the 52 bits of the fraction are dropped; a carry into the exponent is
    // what it should be.
    const DROPPED: u64 = (1 << 45) - 1;
    f64::from_bits((x.to_bits() + DROPPED) & !DROPPED)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(half: f64) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::splat(half))
    }

    #[test]
    fn steps_have_eight_bits_and_are_rounded_up() {
        assert_eq!(round_up(1.0), 1.0);
        assert_eq!(round_up(255.0), 255.0);
        assert_eq!(round_up(255.1), 256.0);
        assert_eq!(round_up(1.0 + 1e-9), 129.0 / 128.0);
        let mut x = 1.234e-12;
        while x < 1e12 {
            let up = round_up(x);
            assert!(up >= x && up < x * (1.0 + 1.0 / 127.0));
            x *= 1.37;
        }
    }

    #[test]
    fn nodes_are_exact_in_f32() {
        for cells in [100, 128, 777, 2000] {
            let lattice = Lattice::new(&cube(1.37), CellSize::LongestSide(cells)).unwrap();
            for i in 0..=lattice.cells()[0] {
                let p = lattice.node(i, 2 * i, 0).x;
                assert_eq!(f64::from(p as f32), p);
                // The same by another road.
                let n = (lattice.origin().x / lattice.step()).floor() + f64::from(i);
                assert_eq!((n + SHIFT) * lattice.step(), p);
            }
        }
    }

    #[test]
    fn the_bounds_are_covered_with_a_margin() {
        for (bounds, cell) in [
            (cube(1.25), CellSize::LongestSide(128)),
            (cube(1.25), CellSize::Length(0.3)),
            (Bounds::new(DVec3::new(1e3, -2.0, 0.0), DVec3::new(1001.0, 0.5, 1e-3)), CellSize::default()),
            (Bounds::new(DVec3::ONE, DVec3::ONE), CellSize::Length(0.01)),
        ] {
            let lattice = Lattice::new(&bounds, cell).unwrap();
            let inner = lattice.bounds().inflate(-lattice.step());
            assert!(inner.contains_bounds(&bounds));
            assert!(!inner.inflate(-2.0 * lattice.step()).contains_bounds(&bounds));
        }
        let lattice = Lattice::new(&cube(1.25), CellSize::LongestSide(128)).unwrap();
        assert_eq!(lattice.step(), 2.5 / 128.0);
    }

    #[test]
    fn vertices_stay_clear_of_nodes() {
        let lattice = Lattice::new(&cube(1.0), CellSize::Length(1.0 / 64.0)).unwrap();
        assert_eq!(lattice.clearance, CLEARANCE);
        let base = lattice.node(3, 4, 5).as_vec3();
        for (t, want) in [(-1.0, CLEARANCE), (0.5, 0.5), (2.0, 1.0 - CLEARANCE)] {
            let p = lattice.vertex([3, 4, 5], 1, t);
            assert_eq!((p.x, p.z), (base.x, base.z));
            assert_eq!(p.y, base.y + (want * lattice.step()) as f32);
        }
        let middle = lattice.vertex([3, 4, 5], 1, 0.5);
        assert_eq!(lattice.vertex([3, 4, 5], 1, f64::NAN), middle);

        // Far from the origin the clearance is two f32.
        let far = Bounds::from_center(DVec3::splat(1000.0), DVec3::splat(0.05));
        let lattice = Lattice::new(&far, CellSize::Length(1e-3)).unwrap();
        assert!(lattice.clearance > 0.1);
        let low = lattice.vertex([7, 7, 7], 0, 0.0);
        let high = lattice.vertex([7, 7, 7], 0, 1.0);
        let ends = [7, 8].map(|i| lattice.node(i, 7, 7).as_vec3());
        assert!(ends[0].x < low.x && low.x < high.x && high.x < ends[1].x);
    }

    #[test]
    fn errors_name_the_parameter() {
        for length in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-40] {
            let error = Lattice::new(&cube(1.0), CellSize::Length(length)).unwrap_err();
            assert!(matches!(error, LatticeError::Length { .. }), "{error}");
            assert!(error.to_string().starts_with("cell size is"));
        }
        let none = Lattice::new(&cube(1.0), CellSize::LongestSide(0)).unwrap_err();
        assert_eq!(none.to_string(), "cells along the longest side is 0; it must be at least 1");
        let nan = Bounds::new(DVec3::ZERO, DVec3::NAN);
        for bounds in [Bounds::EMPTY, Bounds::ALL, cube(0.0), cube(1e38), nan] {
            let error = Lattice::new(&bounds, CellSize::default()).unwrap_err();
            assert!(matches!(error, LatticeError::Bounds { .. }), "{error}");
        }
        let flat = Bounds::from_center(DVec3::ZERO, DVec3::new(1.0, 1e-9, 1e-9));
        let along = Lattice::new(&flat, CellSize::Length(1e-10)).unwrap_err();
        assert!(matches!(along, LatticeError::Cells { .. }), "{along}");
        let all = Lattice::new(&cube(1.0), CellSize::LongestSide(30_000)).unwrap_err();
        assert!(matches!(all, LatticeError::Cells { .. }), "{all}");
        let far = Bounds::from_center(DVec3::splat(1e6), DVec3::splat(0.1));
        let far = Lattice::new(&far, CellSize::Length(0.01)).unwrap_err();
        assert!(matches!(far, LatticeError::Far { .. }), "{far}");
    }
}
