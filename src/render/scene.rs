//! A solid prepared for rays, once for any number of cameras.

use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

use super::blocks::Blocks;
use super::gbuffer::{GBuffer, Surface, Window};
use super::settings::RenderError;
use crate::eval::compiled;
use crate::{Bounds, Cancelled, Hit, Rays, Run, Solid};

/// Rows of a band.
const BAND: u32 = 16;

/// Rays of a packet.
const PACKET: usize = 1024;

/// A solid prepared for rays: the space around it divided into what is inside, what is
/// outside and cells that the surface may cross.
///
/// Preparing costs more than a picture of a small solid; a scene is worth keeping where the
/// camera moves.
///
/// ```
/// use rvachev::{Camera, Solid, Window};
///
/// let scene = Solid::sphere(1.0).scene()?;
/// let camera = Camera::framing(&scene.bounds());
/// let seen = scene.surfaces(&camera.rays(64, 64), Window::whole(64, 64));
/// assert!(seen.at(32, 32).is_hit() && !seen.at(0, 0).is_hit());
/// # Ok::<(), rvachev::RenderError>(())
/// ```
pub struct Scene {
    bounds: Bounds,
    /// `None` if there is nothing to see.
    blocks: Option<Blocks>,
}

impl Solid {
    /// The solid prepared for rays.
    ///
    /// # Errors
    /// What is wrong with the solid. An unbounded one is at fault; intersect it with something
    /// bounded.
    pub fn scene(&self) -> Result<Scene, RenderError> {
        self.scene_with(&Run::default())
    }

    /// [`scene`](Solid::scene) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    /// What is wrong with the solid, or that the work was cancelled.
    pub fn scene_with(&self, run: &Run) -> Result<Scene, RenderError> {
        let bounds = self.finite_bounds()?;
        let programs = compiled(self)?;
        let run = run.stage(0.0, 1.0);
        run.install(|| {
            run.check()?;
            // A box without extent holds nothing that could be seen.
            let visible = !bounds.is_empty() && bounds.longest_side() > 0.0;
            let blocks = if visible { Some(Blocks::new(&programs.surface, &bounds, 48, &run)?) } else { None };
            run.report(1.0);
            Ok(Scene { bounds, blocks })
        })
    }
}

impl Scene {
    /// The solid's box.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// A length that is small for the solid, and large for the rounding of its points: rays
    /// from a hit start this far off the surface.
    pub(super) fn hair(&self) -> f64 {
        self.blocks.as_ref().map_or(0.0, Blocks::hair)
    }

    /// The first crossing on the ray from `origin` along `direction`, which must be a unit
    /// vector. From inside the solid it is where the ray leaves it.
    #[must_use]
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        self.blocks.as_ref()?.first_hit(origin, direction)
    }

    /// [`first_hit`](Scene::first_hit) along many rays, each an origin and a unit direction,
    /// together, which is faster. Runs on the current rayon pool.
    #[must_use]
    pub fn first_hits(&self, rays: &[(DVec3, DVec3)]) -> Vec<Surface> {
        let mut found = vec![Surface::NONE; rays.len()];
        let packets = found.par_chunks_mut(PACKET).zip(rays.par_chunks(PACKET));
        packets.for_each(|(found, rays)| self.packet(rays, found));
        found
    }

    fn packet(&self, rays: &[(DVec3, DVec3)], found: &mut [Surface]) {
        for (found, (origin, direction)) in found.iter_mut().zip(rays) {
            if let Some(hit) = self.first_hit(*origin, *direction) {
                *found = Surface { distance: hit.distance, normal: hit.normal.as_vec3(), owner: hit.owner };
            }
        }
    }

    /// What the pixels of `window` see along `rays`. Runs on the current rayon pool; the
    /// result is the same for any number of threads.
    #[must_use]
    pub fn surfaces(&self, rays: &Rays, window: Window) -> GBuffer {
        // A run that nobody else holds is not cancelled.
        self.surfaces_with(rays, window, &Run::default()).unwrap_or_else(|Cancelled| GBuffer::new(window, Vec::new()))
    }

    /// [`surfaces`](Scene::surfaces) with a choice of threads, a cancel token and a progress
    /// sink.
    ///
    /// # Errors
    /// That the work was cancelled.
    pub fn surfaces_with(&self, rays: &Rays, window: Window, run: &Run) -> Result<GBuffer, Cancelled> {
        let run = run.stage(0.0, 1.0);
        run.install(|| self.trace(rays, window, &run))
    }

    fn trace(&self, rays: &Rays, window: Window, run: &Run) -> Result<GBuffer, Cancelled> {
        let mut surfaces = vec![Surface::NONE; window.count()];
        let done = AtomicU32::new(0);
        let bands = surfaces.par_chunks_mut((window.width * BAND).max(1) as usize).enumerate();
        bands.try_for_each(|(band, surfaces)| {
            run.check()?;
            for (row, y) in surfaces.chunks_mut(window.width as usize).zip(band as u32 * BAND..) {
                let rays: Vec<(DVec3, DVec3)> = (0..window.width).map(|x| window.ray(rays, x, y)).collect();
                self.packet(&rays, row);
            }
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            run.report(f64::from(done) / f64::from(window.height.div_ceil(BAND)));
            Ok(())
        })?;
        Ok(GBuffer::new(window, surfaces))
    }
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Scene({:?})", self.bounds)
    }
}
