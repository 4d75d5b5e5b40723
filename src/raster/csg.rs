//! Depth buffers of whole trees.

use super::buffers::Buffers;
use super::error::RasterError;
use super::expression::{Circuit, Csg};
use super::intervals;
use super::layers::{LayerSource, Tile};
use super::sequence::Sequences;
use super::stencil::Passes;
use super::target::Target;
use super::view::RasterView;
use crate::Run;
use rvachev_num::{Meter, jobs};

/// How the depth buffer of a tree is found.
///
/// | method | trees | operands | the eye |
/// |---|---|---|---|
/// | `Intervals` | any bounded one | any closed solids | anywhere |
/// | `Sequenced` | unions of up to 4096 products | convex | outside of all |
/// | `Stencil` | unions; intersection and difference of two | convex, but in unions any | outside of all |
///
/// All give the same depths where all apply. `Intervals` is as quick as the others in pictures of
/// 256 × 256 pixels and from some ten operands on (32: 0.7 of the time of `Sequenced`); for few
/// operands in larger pictures it takes up to 1.7 times as long, for it keeps every layer. Passes
/// and sequences are what graphics hardware can do, and are here to be compared and followed step
/// by step.
///
/// # Or rays
///
/// The [`Scene`](crate::Scene) of the implicit renderer makes the same depth image from the field.
/// `cargo bench --bench raster` measures both, on one thread, in one run; how many times as long
/// rays take as projecting the meshes and joining their intervals:
///
/// | superellipsoids, of 8064 triangles each | 256² pixels | 512² | 1024² |
/// |---|---|---|---|
/// | 2 | 2.2 | 1.9 | 2.2 |
/// | 3 | 1.9 | 1.8 | 2.2 |
/// | 13 | 1.1 | 1.8 | 2.3 |
/// | 32 | 1.1 | 1.3 | 1.7 |
///
/// | triangles of each of 2, 512² pixels | 960 | 3968 | 16 128 | 65 024 | 261 120 | 1 046 528 |
/// |---|---|---|---|---|---|---|
/// | times as long by rays | 3.1 | 2.3 | 2.2 | 1.2 | 0.7 | 0.2 |
/// | mean difference of the depths, of the size | 3·10⁻³ | 8·10⁻⁴ | 2·10⁻⁴ | 5·10⁻⁵ | 1·10⁻⁵ | 3·10⁻⁶ |
///
/// * Rasterising costs by the triangles, and by the pixels and layers that they cover, whatever
///   the surfaces are made of. Rays cost by the pixels, and by what the field costs.
/// * Meshes have a chord error, which falls as one over the number of triangles; their joints are
///   exact to the pixel for the meshes. Rays find the surface itself.
/// * A mesh is made and [found closed](super::ClosedMesh) once, which takes up to some fifteen
///   times as long as a view of it; it serves any number of views.
///
/// So: many views of primitives of up to some 100 000 triangles, synthetic range images by the
/// thousand, scans and other meshes that have no field: rasterise. A single view, blends, fillets,
/// offsets, lattices and formulas, close-ups, shadows, and whatever must be exact: cast rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CsgMethod {
    /// The sorted layers of each pixel.
    #[default]
    Intervals,
    /// Products of convex operands, by sequenced subtraction.
    Sequenced,
    /// The stencil passes of Kim et al.
    Stencil,
}

enum Plan {
    Intervals(Circuit),
    Sequenced(Sequences),
    Stencil(Passes),
}

impl Plan {
    fn tile(&self, operands: &[&dyn LayerSource], tile: &Tile, scratch: &mut intervals::Scratch) -> Target {
        match self {
            Plan::Intervals(circuit) => intervals::tile(circuit, operands, tile, scratch),
            Plan::Sequenced(sequences) => sequences.tile(operands, tile),
            Plan::Stencil(passes) => passes.tile(operands, tile),
        }
    }
}

impl RasterView {
    /// The depth buffer of a tree of operands, which it names by their place in `operands`.
    ///
    /// What is seen is the first surface of the result behind the near plane. An eye inside of
    /// the result sees its walls from behind.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::raster::{ClosedMesh, Csg, CsgMethod, RasterView};
    /// use rvachev::{Camera, CellSize, MeshSettings, Solid, deg};
    ///
    /// let settings = MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() };
    /// let block = Solid::cuboid([2.0, 2.0, 2.0]).mesh(&settings)?;
    /// let hole = Solid::cylinder(0.5, 3.0).mesh(&settings)?;
    ///
    /// let camera = Camera::perspective(DVec3::new(0.0, 0.0, 6.0), DVec3::ZERO, DVec3::Y, deg(40.0));
    /// let view = RasterView::new(&camera, 80, 60)?;
    /// let block = view.layers(ClosedMesh::new(&block)?);
    /// let hole = view.layers(ClosedMesh::new(&hole)?);
    /// let part = Csg::operand(0) - Csg::operand(1);
    /// let buffers = view.csg(&[&block, &hole], &part, CsgMethod::Intervals)?;
    /// assert!((buffers.depth(52, 30).unwrap() - 5.0).abs() < 1e-4);
    /// assert_eq!(buffers.depth(40, 30), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`RasterError::Operand`], [`Size`](RasterError::Size), [`Surface`](RasterError::Surface)
    /// or [`Unbounded`](RasterError::Unbounded) for what no method takes;
    /// [`Tree`](RasterError::Tree), [`Products`](RasterError::Products) or
    /// [`Cut`](RasterError::Cut) for what `method` does not. Whether operands are convex is not
    /// looked at.
    pub fn csg(&self, operands: &[&dyn LayerSource], tree: &Csg, method: CsgMethod) -> Result<Buffers, RasterError> {
        self.csg_with(operands, tree, method, &Run::default())
    }

    /// [`csg`](RasterView::csg) with a choice of threads, a cancel token and a progress sink.
    ///
    /// The result is the same to the byte for any number of threads.
    ///
    /// # Errors
    ///
    /// Those of [`csg`](RasterView::csg), and [`RasterError::Cancelled`].
    pub fn csg_with(
        &self,
        operands: &[&dyn LayerSource],
        tree: &Csg,
        method: CsgMethod,
        run: &Run,
    ) -> Result<Buffers, RasterError> {
        if tree.operands() > operands.len() {
            return Err(RasterError::Operand { operand: tree.operands() - 1, operands: operands.len() });
        }
        for (operand, layers) in operands.iter().enumerate() {
            self.fits(layers.size())?;
            if !layers.is_closed() {
                return Err(RasterError::Surface { operand });
            }
            if layers.is_cut() && method != CsgMethod::Intervals {
                return Err(RasterError::Cut { operand });
            }
        }
        // Every method wants a bounded tree.
        let circuit = Circuit::new(tree, operands.len())?;
        let plan = match method {
            CsgMethod::Intervals => Plan::Intervals(circuit),
            CsgMethod::Sequenced => Plan::Sequenced(Sequences::new(tree, operands.len())?),
            CsgMethod::Stencil => Plan::Stencil(Passes::new(tree)?),
        };
        let run = run.stage(0.0, 1.0);
        let [across, down] = Tile::grid(self.width, self.height);
        let count = across * down;
        let meter = Meter::new(&run, count);
        let tiles = run.install(|| {
            let tile = |scratch: &mut intervals::Scratch, number: usize| {
                meter.check()?;
                let target = plan.tile(operands, &Tile::number(number as u32, self.width, self.height), scratch);
                meter.add(1);
                Ok::<_, RasterError>(target)
            };
            jobs::try_in_order_with(count as usize, intervals::Scratch::default, tile)
        })?;
        Ok(Buffers { view: *self, tiles })
    }
}
