//! The mesh that drafts show.
//!
//! ```text
//!    cells as asked for --something may be lost?--> cells of a half --?--> of a quarter
//!                               as long as there are few enough
//!                                       |
//!                                       '--rounds, bevels, rims that are cut off--> edges bent
//! ```
//!
//! All cells are halved, not those alone that something is lost in: which these are is a question
//! of ranges for each of them, and takes ten times as long as to mesh them.

use std::sync::{Arc, PoisonError};

use super::scene::Scene;
use super::settings::{RenderError, check_cells};
use crate::geom::Findings;
use crate::mesh::{BLOCK, MeshingError, Subject, bent};
use crate::raster::ClosedMesh;
use crate::{CellSize, Mesh, MeshSettings, Run};

/// Where something may be thinner than a cell, cells of a half and of a quarter are tried.
const HALVINGS: u32 = 2;

/// Edges are bent that are off the surface by more than this part of a cell, and their halves: in 64
/// cells it is half a pixel of a large picture.
const OFF: f64 = 0.07;
const BENT: u32 = 2;

/// What drafts show of a scene.
#[derive(Default)]
pub(super) struct DraftMesh {
    pub(super) mesh: Arc<Mesh>,
    /// Whether its front faces hide the others.
    pub(super) is_closed: bool,
}

impl Scene {
    /// The mesh that [drafts](crate::Quality::Draft) of so many
    /// [cells](crate::RenderSettings::draft_cells) show. [`Mesh::warnings`] tells whether anything
    /// may be too thin for it. The scene keeps the one that was last asked for, by this or by a
    /// draft.
    ///
    /// ```
    /// use rvachev::{Run, Solid};
    ///
    /// let plate = Solid::cuboid([4.0, 4.0, 0.5]);
    /// let with_fin = |thickness: f64| &plate | Solid::cuboid([thickness, 2.0, 1.0]).translate([0.0, 0.0, 0.5]);
    /// let mesh = with_fin(0.05).scene()?.draft_mesh(64, &Run::default())?;
    /// assert!(mesh.warnings().is_empty() && mesh.bounds().max.z > 0.99);
    /// let mesh = with_fin(0.001).scene()?.draft_mesh(64, &Run::default())?;
    /// assert!(!mesh.warnings().is_empty());
    /// # Ok::<(), rvachev::error::RenderError>(())
    /// ```
    ///
    /// # Errors
    /// Cells that are less than 4 or more than 1024; that there is no mesh; that the work was
    /// cancelled.
    pub fn draft_mesh(&self, cells: u32, run: &Run) -> Result<Arc<Mesh>, RenderError> {
        check_cells(cells)?;
        let run = run.stage(0.0, 1.0);
        run.install(|| Ok(self.shown(cells, &run)?.mesh.clone()))
    }

    /// The same with what is known of it, as a part of a job, on its threads.
    pub(super) fn shown(&self, cells: u32, run: &Run) -> Result<Arc<DraftMesh>, RenderError> {
        if self.is_empty() {
            return Ok(Arc::default());
        }
        let kept = || self.draft.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((count, mesh)) = &*kept()
            && *count == cells
        {
            return Ok(mesh.clone());
        }
        let subject = Subject { program: self.program(), bounds: self.bounds(), palette: None, whole: None };
        let mesh = |halvings: u32, run: &Run| {
            let cell = CellSize::LongestSide(cells << halvings);
            subject.mesh(&MeshSettings { cell, owners: true, ..MeshSettings::default() }, run)
        };
        let stages = run.stages([2.0, 1.0, 2.0, 1.0]);
        let mut found = mesh(0, &stages[0])?;
        for (halvings, run) in (1..=HALVINGS).zip(&stages[1..3]) {
            // A block has eight halves at most: what they take is known beforehand.
            let Findings { possibly_lost, blocks, .. } = *found.findings();
            if possibly_lost == 0 || 8 * blocks > most_blocks(cells) {
                break;
            }
            match mesh(halvings, run) {
                // So small cells have no place in single precision.
                Err(MeshingError::Lattice(_)) => break,
                finer => found = finer?,
            }
        }
        let off = OFF * found.findings().cell;
        let found = bent(found, self.program(), (off, BENT), &stages[3])?;
        let is_closed = ClosedMesh::new(&found).is_ok();
        let shown = Arc::new(DraftMesh { mesh: Arc::new(found), is_closed });
        *kept() = Some((cells, shown.clone()));
        Ok(shown)
    }
}

/// As many blocks as a cube's faces have in cells of a quarter: what the twice halved mesh of a
/// plain solid may take, is allowed to all.
fn most_blocks(cells: u32) -> usize {
    let along = (cells as usize).div_ceil(BLOCK);
    6 * (along << HALVINGS).pow(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{RFunction, Solid};

    /// Of so many teeth, six tenths of their distance thick.
    fn comb(teeth: u32) -> Solid {
        let pitch = 3.0 / f64::from(teeth);
        let tooth =
            |n: u32| Solid::cuboid([0.6 * pitch, 2.0, 1.0]).translate([(f64::from(n) + 0.5) * pitch - 1.5, 0.0, 0.0]);
        let back = Solid::cuboid([3.0, 0.3, 1.1]).translate([0.0, 1.0, 0.0]);
        Solid::union_all((0..teeth).map(tooth), RFunction::MIN_MAX) | back
    }

    /// Cells along the longest side that a draft of 64 shows, and its mesh.
    fn shown(solid: &Solid) -> (u32, Arc<Mesh>) {
        let scene = solid.scene().unwrap();
        let mesh = scene.draft_mesh(64, &Run::default()).unwrap();
        ((scene.bounds().longest_side() / mesh.findings().cell).round() as u32, mesh)
    }

    #[test]
    fn cells_are_halved_as_long_as_it_costs_no_more_than_a_plain_solid() {
        // Nothing is thin.
        let (cells, mesh) = shown(&Solid::cuboid([3.0, 2.0, 1.0]));
        assert!(cells == 64 && mesh.warnings().is_empty());
        // One fin is: it is resolved.
        let fin = Solid::cuboid([3.0, 2.0, 1.0]) | Solid::cuboid([2.0, 0.02, 1.0]).translate([0.0, 0.0, 1.0]);
        let (cells, mesh) = shown(&fin);
        assert!(cells > 64 && mesh.warnings().is_empty() && mesh.bounds().max.z > 1.49, "{cells}");
        // Two hundred teeth fill the box at any size of cells, and it is told that they are lost.
        for teeth in [60, 100, 200] {
            let (cells, mesh) = shown(&comb(teeth));
            let blocks = mesh.findings().blocks;
            assert!((127..=129).contains(&cells) && blocks <= most_blocks(64), "{teeth}: {cells}, {blocks} blocks");
            assert!(mesh.possibly_lost() > 0 && !mesh.warnings().is_empty(), "{teeth}");
        }
    }

    #[test]
    fn where_there_is_no_room_for_smaller_cells_they_stay_as_they_are() {
        // Far from the origin single precision has room for these cells and none smaller.
        let sheet = Solid::cuboid([1.0, 1.0, 1e-4]).translate([8000.0, 0.0, 0.0]);
        let scene = sheet.scene().unwrap();
        let cells = (1..10).map(|n| 4 << n).take_while(|cells| scene.draft_mesh(*cells, &Run::default()).is_ok());
        let last = cells.last().unwrap();
        assert!(last < 1024 && scene.draft_mesh(last, &Run::default()).unwrap().findings().cell > 0.0);
    }

    #[test]
    fn errors() {
        let scene = Solid::sphere(1.0).scene().unwrap();
        let error = scene.draft_mesh(3, &Run::default()).unwrap_err().to_string();
        assert_eq!(error, "draft_cells is 3; allowed: 4 to 1024");
        let run = Run::default();
        run.cancel.cancel();
        assert!(matches!(scene.draft_mesh(64, &run), Err(RenderError::Cancelled(_))));
    }
}
