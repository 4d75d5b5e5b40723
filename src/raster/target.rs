//! The buffers of one tile, and the passes that fill them.

use super::buffers::SurfaceId;
use super::layers::{Facing, Fragments, LANES, LayerSource, Tile};

/// In place of an operand where nothing is seen.
pub(super) const NOTHING: u32 = u32::MAX;

/// Set in an operand's number where its inner side is seen.
pub(super) const REVERSED: u32 = 1 << 31;

/// Depth, stencil and id of the pixels of a tile.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Target {
    /// +∞ where nothing is.
    pub(super) depth: Vec<f64>,
    pub(super) stencil: Vec<i32>,
    /// The operand, with [`REVERSED`], or [`NOTHING`].
    pub(super) operand: Vec<u32>,
    pub(super) face: Vec<u32>,
}

impl Target {
    pub(crate) fn new() -> Target {
        Target {
            depth: vec![f64::INFINITY; Tile::PIXELS],
            stencil: vec![0; Tile::PIXELS],
            operand: vec![NOTHING; Tile::PIXELS],
            face: vec![0; Tile::PIXELS],
        }
    }

    /// What is seen at a pixel where anything is.
    #[inline]
    pub(super) fn id(&self, i: usize) -> SurfaceId {
        let operand = self.operand[i];
        let facing = if operand & REVERSED == 0 { Facing::Front } else { Facing::Back };
        SurfaceId { operand: operand & !REVERSED, face: self.face[i], facing }
    }

    /// What is seen at a pixel of the picture, in the tile that it is drawn in, and how deep it
    /// lies.
    #[inline]
    pub(crate) fn seen(&self, tile: &Tile, [x, y]: [u32; 2]) -> Option<(SurfaceId, f64)> {
        let i = ((y - tile.y) * Tile::SIDE + x - tile.x) as usize;
        (self.depth[i] < f64::INFINITY).then(|| (self.id(i), self.depth[i]))
    }

    /// Nothing is seen any more. The stencil stays.
    pub(super) fn clear_depth(&mut self) {
        self.depth.fill(f64::INFINITY);
        self.operand.fill(NOTHING);
    }

    /// Depth test LESS: what is nearer replaces what is there. One side of the operand's surface,
    /// or both.
    pub(super) fn draw<L: LayerSource + ?Sized>(
        &mut self,
        layers: &L,
        operand: u32,
        facing: Option<Facing>,
        tile: &Tile,
    ) {
        layers.layers(tile, &mut |runs| {
            for run in runs.iter().filter(|run| facing.is_none_or(|facing| run.facing == facing)) {
                let operand = operand | if run.facing == Facing::Back { REVERSED } else { 0 };
                let Some(depth) = lanes_mut(&mut self.depth, run) else { continue };
                for (lane, (depth, new)) in depth.iter_mut().zip(run.depth).enumerate() {
                    if new < *depth {
                        *depth = new;
                        self.operand[run.at as usize + lane] = operand;
                        self.face[run.at as usize + lane] = run.face;
                    }
                }
            }
        });
    }

    /// Counts, for every stored point, the front less the back faces up to it: not 0 where the
    /// point is inside. Depth and ids stay as they are.
    ///
    /// Faces at the very depth of the point count too, so that a solid holds the points of its
    /// front faces and not those of its back faces, and flush faces are seen once.
    pub(super) fn classify<L: LayerSource + ?Sized>(&mut self, layers: &L, tile: &Tile) {
        layers.layers(tile, &mut |runs| {
            for run in runs {
                let sign = if run.facing == Facing::Front { 1 } else { -1 };
                let Some(depth) = lanes_mut(&mut self.depth, run) else { continue };
                let passes: [bool; LANES] = std::array::from_fn(|lane| run.depth[lane] <= depth[lane]);
                let Some(stencil) = lanes_mut(&mut self.stencil, run) else { continue };
                for lane in 0..LANES {
                    stencil[lane] += if passes[lane] { sign } else { 0 };
                }
            }
        });
    }

    /// Clears what does not pass the stencil test.
    pub(super) fn keep(&mut self, test: impl Fn(i32) -> bool) {
        for i in 0..Tile::PIXELS {
            if !test(self.stencil[i]) {
                self.depth[i] = f64::INFINITY;
                self.operand[i] = NOTHING;
            }
        }
    }

    /// The nearer of the two, pixel by pixel; this one where they are equal.
    pub(super) fn merge(&mut self, other: &Target) {
        for i in 0..Tile::PIXELS {
            if other.depth[i] < self.depth[i] {
                self.depth[i] = other.depth[i];
                self.operand[i] = other.operand[i];
                self.face[i] = other.face[i];
            }
        }
    }
}

/// The part of a buffer that a run covers; `None` for a run that is not of this tile.
fn lanes_mut<'a, T>(buffer: &'a mut [T], run: &Fragments) -> Option<&'a mut [T; LANES]> {
    buffer.get_mut(run.at as usize..)?.first_chunk_mut()
}
