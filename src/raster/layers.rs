//! Surfaces as the layers that a ray through a pixel crosses.
//!
//! ```text
//!            F          Bk     F     Bk         F front: the ray enters
//!     eye ---(##########)------(#####)--->      Bk back: the ray leaves
//! ```
//!
//! Layers come in runs of [`LANES`] neighbours of a row, tile by tile. The methods of
//! depth-buffer CSG ask for nothing else, so whatever can tell its layers can be an operand: a
//! mesh ([`MeshLayers`](super::MeshLayers)), or a sphere by its equation.

use glam::DVec3;

/// Which side of a surface is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Facing {
    /// The outer side: the ray enters the solid here.
    Front,
    /// The inner side: the ray leaves the solid here.
    Back,
}

/// A part of the picture: at most [`Tile::SIDE`] × [`Tile::SIDE`] pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// The column of its first pixel.
    pub x: u32,
    /// The row of its first pixel.
    pub y: u32,
    /// Pixels in a row, 1 to [`Tile::SIDE`].
    pub width: u32,
    /// Number of rows, 1 to [`Tile::SIDE`].
    pub height: u32,
}

impl Tile {
    /// The sides of a whole tile, in pixels: the buffers of a few operands fit into a
    /// processor's nearest cache.
    pub const SIDE: u32 = 32;

    /// Pixels of a whole tile. Those beyond the picture's edge are kept and never shown.
    pub(super) const PIXELS: usize = (Tile::SIDE * Tile::SIDE) as usize;

    /// The place of a pixel of the picture in the tile.
    #[must_use]
    pub fn index(&self, x: u32, y: u32) -> usize {
        ((y - self.y) * Tile::SIDE + (x - self.x)) as usize
    }

    /// How many tiles cover a picture, across and down.
    pub(crate) fn grid(width: u32, height: u32) -> [u32; 2] {
        [width.div_ceil(Tile::SIDE), height.div_ceil(Tile::SIDE)]
    }

    /// The tile of this number, row by row from the top left.
    pub(crate) fn number(number: u32, width: u32, height: u32) -> Tile {
        let [across, _] = Tile::grid(width, height);
        let (x, y) = (number % across * Tile::SIDE, number / across * Tile::SIDE);
        Tile { x, y, width: (width - x).min(Tile::SIDE), height: (height - y).min(Tile::SIDE) }
    }
}

/// Pixels of a run.
pub const LANES: usize = 4;

/// A piece of one layer: what it covers of [`LANES`] neighbouring pixels of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragments {
    /// The place of the first pixel in the tile ([`Tile::index`]), a multiple of [`LANES`].
    pub at: u32,
    /// Which side is seen.
    pub facing: Facing,
    /// The face of the operand: for a mesh, its triangle.
    pub face: u32,
    /// The depths at the pixels' middles, in length units; +∞ where the layer does not cover
    /// them.
    pub depth: [f64; LANES],
}

impl Fragments {
    /// A layer that covers a single pixel, given by its place in the tile ([`Tile::index`]).
    #[must_use]
    pub fn pixel(index: usize, depth: f64, facing: Facing, face: u32) -> Fragments {
        let lane = index % LANES;
        let mut depths = [f64::INFINITY; LANES];
        depths[lane] = depth;
        Fragments { at: (index - lane) as u32, facing, face, depth: depths }
    }
}

/// A surface, seen in a picture as layers.
///
/// ```
/// use rvachev::raster::{Csg, CsgMethod, Facing, Fragments, LayerSource, RasterView, Tile};
/// use rvachev::Camera;
/// use glam::DVec3;
///
/// /// A sphere about the origin, seen from −y without perspective.
/// struct Ball { radius: f64, view: RasterView }
///
/// impl LayerSource for Ball {
///     fn size(&self) -> [u32; 2] {
///         [self.view.width(), self.view.height()]
///     }
///     fn layers(&self, tile: &Tile, sink: &mut dyn FnMut(&[Fragments])) {
///         for y in tile.y..tile.y + tile.height {
///             for x in tile.x..tile.x + tile.width {
///                 let p = self.view.point(f64::from(x) + 0.5, f64::from(y) + 0.5, 0.0);
///                 let half = (self.radius * self.radius - p.x * p.x - p.z * p.z).sqrt();
///                 if half >= 0.0 {
///                     let i = tile.index(x, y);
///                     sink(&[Fragments::pixel(i, -p.y - half, Facing::Front, 0)]);
///                     sink(&[Fragments::pixel(i, -p.y + half, Facing::Back, 0)]);
///                 }
///             }
///         }
///     }
/// }
///
/// let camera = Camera::orthographic(DVec3::new(0.0, -5.0, 0.0), DVec3::ZERO, DVec3::Z, 4.0);
/// let view = RasterView::new(&camera, 41, 41)?;
/// let (ball, core) = (Ball { radius: 1.5, view }, Ball { radius: 1.0, view });
/// let shell = Csg::operand(0) - Csg::operand(1);
/// let buffers = view.csg(&[&ball, &core], &shell, CsgMethod::Intervals)?;
/// assert_eq!(buffers.depth(20, 20), Some(3.5));
/// assert_eq!(buffers.depth(0, 0), None);
/// # Ok::<(), rvachev::raster::RasterError>(())
/// ```
pub trait LayerSource: Sync {
    /// Width and height of the picture that the layers are made for, in pixels.
    fn size(&self) -> [u32; 2];

    /// Hands all layers in a tile to `sink`, in any order that is always the same, as slices of
    /// any length. No depth may be NaN.
    fn layers(&self, tile: &Tile, sink: &mut dyn FnMut(&[Fragments]));

    /// Whether layers can occur in the tile; a quick answer, which may be `true` without need.
    fn touches(&self, tile: &Tile) -> bool {
        let _ = tile;
        true
    }

    /// The unit normal of a face at a point on it, out of the solid; 0 where it is not known.
    fn normal(&self, face: u32, point: DVec3) -> DVec3 {
        let _ = (face, point);
        DVec3::ZERO
    }

    /// The same at several points of a face, one for each of `normals`.
    fn normals(&self, face: u32, points: &[DVec3], normals: &mut [DVec3]) {
        for (normal, point) in normals.iter_mut().zip(points) {
            *normal = self.normal(face, *point);
        }
    }

    /// Whether a ray leaves the solid as often as it enters, which is what joins ask for.
    fn is_closed(&self) -> bool {
        true
    }

    /// Whether the near plane has cut layers off.
    fn is_cut(&self) -> bool {
        false
    }
}
