//! A solid cut by a plane, to look into it.
//!
//! ```text
//!            normal, towards the viewer
//!              ^
//!      - - - - | - - - - - -      what was here is gone
//!     ######___|###___#######     the section: filled with the parts that it passes through, or
//!     #####|   .  |   |######     painted
//! ```
//!
//! What is left is a solid like any other, the intersection with a half-space; so pictures of
//! either quality, depths and shadows are those of the solid that is left. Its section belongs to
//! the half-space; what of the whole solid a point of it is in tells the program of the whole.

use std::sync::{Arc, PoisonError};

use glam::DVec3;

use super::gbuffer::Surface;
use super::scene::Scene;
use super::settings::{RenderError, setting};
use crate::eval::Program;
use crate::{Paint, Plane, RFunction, Run, Solid};

/// The sections that show what they pass through.
#[derive(Default)]
pub(super) struct Sections {
    /// The numbers of the leaves that cut.
    leaves: Vec<u32>,
    /// What it was before the first cut.
    whole: Option<Program>,
}

/// A scene that was cut, and how.
pub(super) type Kept = (Plane, Option<Paint>, Arc<Scene>);

impl Scene {
    /// The scene of what is left when all is taken away on that side of a plane that its
    /// [normal](Plane::normal) points to: of [`Plane::xz`], what is in front.
    ///
    /// The section shows the parts that it passes through: a point of it has the
    /// [owner](crate::Owner::index), and so the paint, of the part that it is in. What was cut
    /// away from a part, as a bore, is no part of it. With a `paint` all of the section has that,
    /// and one owner, whose number is one more than the last of the solid. Pictures are cut by
    /// [`RenderSettings::cut`](crate::RenderSettings::cut), which calls this; layers, range images
    /// and rays are those of the scene that is returned.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::{Plane, Run, Solid};
    ///
    /// let pipe = (Solid::cylinder(2.0, 6.0) - Solid::cylinder(1.0, 8.0)).scene()?;
    /// let half = pipe.cut(&Plane::xz(0.0), None, &Run::default())?;
    /// // From the front, a ray meets the section of the wall …
    /// let hit = half.first_hit(DVec3::new(1.5, -9.0, 0.0), DVec3::Y).expect("the wall is there");
    /// assert!((hit.distance - 9.0).abs() < 1e-4 && hit.normal.distance(-DVec3::Y) < 1e-6);
    /// // … or goes on to the far side of the bore.
    /// let hit = half.first_hit(DVec3::new(0.0, -9.0, 0.0), DVec3::Y).expect("so is the bore");
    /// assert!((hit.distance - 10.0).abs() < 1e-4);
    /// # Ok::<(), rvachev::error::RenderError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the plane or the paint, or that the work was cancelled.
    pub fn cut(&self, plane: &Plane, paint: Option<Paint>, run: &Run) -> Result<Scene, RenderError> {
        if !plane.is_finite() || !plane.normal().is_normalized() {
            let value = format!("a plane through {} across {}", plane.origin(), plane.normal());
            return Err(setting("cut", value, "planes of finite numbers, whose normal is not 0"));
        }
        let normal = plane.normal();
        let kept = Solid::half_space(normal, normal.dot(plane.origin())).named("cut");
        let kept = match paint {
            Some(paint) => kept.paint(paint),
            None => kept,
        };
        let cut = self.solid().intersection(&kept, RFunction::MIN_MAX);
        let mut scene = cut.scene_with(run)?;
        let Sections { leaves, whole } = &self.sections;
        let section = paint.is_none().then(|| self.palette().leaves());
        // A solid's leaves have the same numbers in what is cut of it.
        scene.sections = Sections {
            leaves: leaves.iter().copied().chain(section).collect(),
            whole: Some(whole.as_ref().unwrap_or(self.program()).clone()),
        };
        Ok(scene)
    }

    /// [`cut`](Scene::cut), or the scene that was last cut if it was cut alike.
    pub(super) fn kept_cut(&self, plane: &Plane, paint: Option<Paint>, run: &Run) -> Result<Arc<Scene>, RenderError> {
        let kept = || self.cut.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((by, painted, scene)) = &*kept()
            && by == plane
            && *painted == paint
        {
            return Ok(scene.clone());
        }
        let scene = Arc::new(self.cut(plane, paint, run)?);
        *kept() = Some((*plane, paint, scene.clone()));
        Ok(scene)
    }

    /// The owner of a point of the surface: that of a section is the part that holds it.
    #[inline]
    pub(super) fn owner_at(&self, owner: u32, point: DVec3) -> u32 {
        match &self.sections.whole {
            Some(whole) if self.sections.leaves.contains(&owner) => whole.holding_leaf(point),
            _ => owner,
        }
    }

    /// Gives what rays meet of sections to the parts that these pass through.
    pub(super) fn fill_sections(&self, found: &mut [Surface], ray: impl Fn(usize) -> (DVec3, DVec3)) {
        if self.sections.leaves.is_empty() {
            return;
        }
        for (i, surface) in found.iter_mut().enumerate().filter(|(_, surface)| surface.is_hit()) {
            let (origin, direction) = ray(i);
            surface.owner = self.owner_at(surface.owner, origin + surface.distance * direction);
        }
    }
}
