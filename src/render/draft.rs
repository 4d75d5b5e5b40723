//! Drafts: what the pixels of a picture see of a mesh, by the rasteriser.
//!
//! ```text
//!    scene --once--> mesh, kept          view --> triangles in tiles --> depth, triangle
//!                                                                             |
//!    picture's own rays <------- distance along the ray, normal, leaf  <------'
//! ```
//!
//! What comes out is what rays give, so that lights, paint and lines are those of any picture.
//! Pixels at edges are drawn once more in a view of `samples` times as many columns and rows, as
//! far as there are any in a tile.

use glam::DVec3;
use rvachev_num::jobs;

use super::draft_mesh::DraftMesh;
use super::gbuffer::{Surface, Window};
use super::scene::Scene;
use super::settings::{RenderError, RenderSettings, setting};
use crate::raster::{Facing, LayerSource, MeshLayers, RasterError, RasterView, Slant, SurfaceId, Target, Tile};
use crate::{Camera, Cancelled, Mesh, Run};

/// The near plane, in proportion to the distance from the eye to its target: there is none for
/// rays.
const NEAR: f64 = 1e-6;

/// Where the mean of the corners' normals faces away from the eye though the triangle does not, it
/// is turned to this cosine.
const FACING: f64 = 1e-2;

/// A mesh in a picture.
pub(super) struct Draft<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    pixels: MeshLayers<'a>,
    /// With so many columns and rows for one of a pixel, if there are more than one.
    samples: Option<MeshLayers<'a>>,
}

impl<'a> Draft<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        DraftMesh { mesh, is_closed }: &'a DraftMesh,
        camera: &Camera,
        settings: &RenderSettings,
    ) -> Result<Draft<'a>, RenderError> {
        let RenderSettings { width, height, samples, .. } = *settings;
        let layers = |times: u32| {
            let too_large = || setting("size", format!("{width} × {height}"), DRAFT_SIZE);
            let [width, height] = [width, height].map(|side| side.saturating_mul(times));
            let view = RasterView::new(camera, width, height).map_err(|error| match error {
                RasterError::Camera(error) => error.into(),
                _ => too_large(),
            })?;
            let near = NEAR * camera.eye.distance(camera.target);
            let view = if view.near() > 0.0 { view.with_near(near).map_err(|_| too_large())? } else { view };
            Ok::<_, RenderError>(if *is_closed { view.seen(mesh) } else { view.surface(mesh) })
        };
        let pixels = layers(1)?;
        let samples = if samples > 1 { Some(layers(samples)?) } else { None };
        Ok(Draft { scene, mesh, pixels, samples })
    }

    /// What the pixels of some rows see through their middles.
    pub(super) fn surfaces(&self, window: Window, run: &Run) -> Result<Vec<Surface>, Cancelled> {
        let mut surfaces = vec![Surface::NONE; window.count()];
        let mut bands = Vec::new();
        let (mut rest, mut top, end) = (&mut surfaces[..], window.top, window.top + window.height);
        while top < end {
            let next = (top / Tile::SIDE + 1) * Tile::SIDE;
            let (band, after) = std::mem::take(&mut rest).split_at_mut(((next.min(end) - top) * window.width) as usize);
            bands.push((top, band));
            (rest, top) = (after, next);
        }
        jobs::try_taking_with(bands, Target::new, |target, (top, band): (u32, &mut [Surface])| {
            run.check()?;
            let bottom = top + band.len() as u32 / window.width;
            for tile in row_of_tiles(&self.pixels, top / Tile::SIDE) {
                let mut last = None;
                self.pixels.seen(&tile, target, |[x, y], id, depth| {
                    if (top..bottom).contains(&y) {
                        let seen = self.surface(&self.pixels, &mut last, [x, y], id, depth);
                        band[((y - top) * window.width + x) as usize] = seen;
                    }
                });
            }
            Ok(())
        })?;
        Ok(surfaces)
    }

    /// What the samples of some pixels see, pixel by pixel, row by row in each. `numbers` has the
    /// place of each pixel among them, or `u32::MAX`, for rows of the picture from `top` on;
    /// `columns` is how many samples there are to a pixel along a side, and `count` how many of
    /// the pixels.
    pub(super) fn samples(&self, numbers: &[u32], top: u32, columns: u32, count: usize) -> Vec<Surface> {
        let layers = self.samples.as_ref().filter(|_| columns > 1).unwrap_or(&self.pixels);
        let [width, _] = layers.size();
        let across = (width / columns) as usize;
        let rows = numbers.len() as u32 / across as u32;
        let (first, last) = (top * columns / Tile::SIDE, ((top + rows) * columns).div_ceil(Tile::SIDE));
        let mut surfaces = vec![Surface::NONE; count * (columns * columns) as usize];
        let (mut target, mut asked) = (Target::new(), Vec::new());
        for tile in (first..last).flat_map(|band| row_of_tiles(layers, band)) {
            // The pixels of the picture that have samples in the tile.
            let (right, bottom) = (tile.x + tile.width, tile.y + tile.height);
            asked.clear();
            for y in (tile.y / columns).max(top)..bottom.div_ceil(columns).min(top + rows) {
                let row = (y - top) as usize * across;
                let range = (tile.x / columns) as usize..right.div_ceil(columns) as usize;
                let own = (range.start as u32..).zip(&numbers[row + range.start..row + range.end]);
                asked.extend(own.filter(|(_, number)| **number != u32::MAX).map(|(x, number)| ([x, y], *number)));
            }
            if asked.is_empty() || !layers.draws(&tile, &mut target) {
                continue;
            }
            let mut last = None;
            for &([left, upper], number) in &asked {
                let own = &mut surfaces[(number * columns * columns) as usize..];
                for y in (upper * columns).max(tile.y)..((upper + 1) * columns).min(bottom) {
                    for x in (left * columns).max(tile.x)..((left + 1) * columns).min(right) {
                        if let Some((id, depth)) = target.seen(&tile, [x, y]) {
                            let place = (y - upper * columns) * columns + x - left * columns;
                            own[place as usize] = self.surface(layers, &mut last, [x, y], id, depth);
                        }
                    }
                }
            }
        }
        surfaces
    }

    /// What a pixel of a view sees, as a ray through its middle would tell it; `last` is the face
    /// that the pixel before it has shown.
    #[inline]
    fn surface(
        &self,
        layers: &MeshLayers<'_>,
        last: &mut Option<(u32, Slant)>,
        [x, y]: [u32; 2],
        id: SurfaceId,
        depth: f64,
    ) -> Surface {
        let (point, distance, direction) = layers.view().sight(f64::from(x) + 0.5, f64::from(y) + 0.5, depth);
        let viewer = -direction;
        if last.as_ref().is_none_or(|(face, _)| *face != id.face) {
            *last = Some((id.face, Slant::new(self.mesh, id.face)));
        }
        let normal = last.as_ref().map_or(DVec3::ZERO, |(_, slant)| slant.normal(point));
        let towards = if id.facing == Facing::Front { normal } else { -normal };
        let cosine = towards.dot(viewer);
        let normal = if cosine >= FACING || normal == DVec3::ZERO {
            normal
        } else {
            let turned = (towards + (FACING - cosine) * viewer).normalize_or_zero();
            if id.facing == Facing::Front { turned } else { -turned }
        };
        let owner = self.mesh.owners().and_then(|owners| owners.get(id.face as usize)).copied().unwrap_or_default();
        let owner = self.scene.owner_at(self.scene.program.leaf_of(owner), point);
        Surface { distance, normal: normal.as_vec3(), owner }
    }
}

/// What the size of a draft may be.
const DRAFT_SIZE: &str = "16 384 pixels a side in drafts, samples counted; `Quality::Fine` draws larger pictures";

fn row_of_tiles(layers: &MeshLayers<'_>, row: u32) -> impl Iterator<Item = Tile> + use<> {
    let [width, height] = layers.size();
    let [across, _] = Tile::grid(width, height);
    (0..across).map(move |column| Tile::number(row * across + column, width, height))
}
