//! The surface of a solid as patches.

use std::sync::Arc;

use glam::DVec3;

use super::by_faces::by_faces;
use super::compiled_with;
use super::facets::{Facets, sharp};
use super::mend::{complete, mend};
use super::outline::border;
use super::quilt::{Care, GROSS, KNOWN, Quilt};
use super::sheets::cover;
use super::strips::strips;
use crate::error::MeshingError;
use crate::eval::{Accuracy, CompileError, Compiled, DistanceSource, Program, Surface, Wanted};
use crate::mesh::{Hidden, Slopes, Subject};
use crate::solid::DEVIATION;
use crate::{Bounds, Mesh, RFunction, Run, Solid, SolidError};
use rvachev_field::Patches;

/// The surfaces of solids by their meshes.
pub(super) struct FromMeshes;

/// They need not be nearer than this part of the size, or of how far the surface is from the
/// origin.
const SMALL: f64 = 1e-6;

/// They cannot be nearer than this part of it: they are kept in single precision.
const FINEST: f64 = 2e-7;

/// Cells along the longest side at least.
const ALONG_SIZE: f64 = 24.0;

/// What lengths have been taken of before bends by about as much: cells are no longer than so many
/// of them, and no smaller than half of the longest.
const ALONG_BEND: f64 = 1.25;

/// So many cells may be on the surface, and so many more for each leaf.
const CELLS: f64 = 4e4;
const CELLS_A_LEAF: f64 = 500.0;

/// Cells are halved while more than this part of the surface is off, or a patch by [`GROSS`]
/// tolerances.
pub(super) const FEW: f64 = 5e-4;

/// And at once where splitting leaves more than this part.
const PATIENCE: f64 = 5e-3;

/// The part of the work that finding the size of cells is.
const LOOKING: f64 = 0.05;

/// The part of what is left to do that is taken to be done with cells of one size.
const ATTEMPT: f64 = 0.7;

/// Cells are halved down to this part where nothing is found, though something may be hidden.
const NOTHING: f64 = 1.0 / 8.0;

/// So much of what cells show may be hidden in others: else it is sheets.
const THIN: f64 = 0.1;

/// So many more cells there may be where something is hidden in them, or walls are torn.
const HIDDEN: f64 = 12.0;

impl DistanceSource for FromMeshes {
    fn surface(
        &self,
        solid: &Solid,
        programs: &Compiled,
        wanted: &Wanted<'_>,
        run: &Run,
    ) -> Result<Surface, CompileError> {
        let whole = programs.bounds();
        let (bounds, flat, size) = extent(programs, wanted);
        let mut near = wanted.near();
        if let Some(axis) = flat {
            (near.min[axis], near.max[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        if bounds.is_empty() || size == 0.0 {
            let patches = Arc::new(Patches::new(&[], run)?);
            return Ok(Surface::new(patches, Accuracy::default(), flat));
        }
        if !size.is_finite() {
            return Err(SolidError::Unbounded { path: programs.unbounded.clone() }.into());
        }
        // Polygons and their offsets have closed forms.
        if flat == Some(2)
            && let Some(curves) = border(solid, run)?
        {
            let patches = Arc::new(Patches::new(&strips(&curves, size), run)?);
            run.report(1.0);
            let rounding = FINEST * farthest(&bounds, size);
            return Ok(Surface::new(patches, Accuracy::of_surface(rounding, rounding), flat));
        }
        let tolerance = self.tolerance(programs, wanted);
        let grain = programs.accuracy.grain();
        let enough = CELLS + CELLS_A_LEAF * programs.surface.leaf_count() as f64;
        // Of others, tips and cusps hide something in cells of any size.
        let is_gentle = programs.surface.has_gentle_leaves();
        let (mut done, mut best) = (LOOKING, None);
        // The cells that would have been the last had they not torn something, and whether these
        // are it after all.
        let (mut torn, mut is_resigned) = (None::<f64>, false);
        // Whether it is to be seen yet if it is put together from faces.
        let mut may_have_faces = true;
        let subject = Subject { program: &programs.surface, bounds, palette: None, whole: None };
        let look = run.stage(0.0, done);
        let mut longest = size / ALONG_SIZE;
        if programs.accuracy.tolerance > 0.0 {
            longest = (ALONG_BEND * wanted.length).clamp(0.5 * longest, longest);
        }
        let mut cell = run.install(|| subject.first_cell(size, longest, enough, &look)).map_err(compile_error)?;
        loop {
            // What is left is for smaller cells.
            let end = done + ATTEMPT * (1.0 - done);
            let [to_mesh, to_sew] = run.stage(done, end).stages([0.5, 0.5]);
            let slopes = Slopes { program: &programs.surface, precision: tolerance, reach: cell };
            done = end;
            let mut seen = bounds;
            let (facets, mut hidden) = match flat {
                None if bounds.contains_bounds(&whole) => {
                    let Shown { mesh, hidden } = shown(&programs.surface, bounds, cell, &to_mesh)?;
                    (Facets::new(&mesh, |corners| meets(corners, &near)), hidden)
                }
                None => part((solid, &slopes), bounds, [whole, near], cell, &to_mesh)?,
                Some(axis) => {
                    (seen.min[axis], seen.max[axis]) = (-1.5 * cell, 1.5 * cell);
                    part((solid, &slopes), seen, [whole, near], cell, &to_mesh)?
                }
            };
            hidden.retain(|hidden| hidden.cell.intersects(&near));
            // Two triangles a cell.
            let count = 0.5 * facets.triangles.len() as f64;
            let mut is_last = 4.0 * count > enough || count == 0.0 && cell < NOTHING * longest;
            let mut care = Care { panes: !wanted.by_patches, ..Care::new(tolerance) };
            // Splitting does not sew walls that are torn for they are thinner than cells: smaller
            // cells may.
            let most = HIDDEN * enough;
            let may_be_torn = || count > 0.0 && 4.0 * count <= most && (is_gentle || facets.is_torn());
            let is_hasty = !is_last || !is_resigned && (torn.is_some() || may_be_torn());
            if best.is_none() && is_hasty {
                care.patience = PATIENCE;
            }
            // Sheets are put together from what they are at a distance from.
            let asked = (tolerance, cell);
            let by_faces = || by_faces((solid, programs), wanted, asked, &to_sew);
            let is_thin = hidden.len() as f64 > THIN * count;
            if is_thin
                && std::mem::take(&mut may_have_faces)
                && let Some(found) = by_faces()?
            {
                run.report(1.0);
                return Ok(found);
            }
            let is_near = |(reached, quilt): &(f64, Quilt)| *reached <= tolerance && quilt.error <= GROSS * tolerance;
            let mut is_enough = false;
            if let Some(mut quilt) = Quilt::new(facets, &slopes, care, &to_sew)? {
                mend(&mut quilt, &slopes, cell, tolerance, &to_sew)?;
                let mut found = (quilt.reached(FEW), quilt);
                if hidden.is_empty() {
                    // Smaller cells do not always tell more.
                    let is_better = |(reached, quilt): &(f64, Quilt)| {
                        *reached < found.0 || *reached == found.0 && quilt.error < found.1.error
                    };
                    best = best.filter(is_better).or(Some(found));
                    is_enough = best.as_ref().is_some_and(is_near);
                } else {
                    // What larger cells have shown is not all.
                    best = None;
                    is_enough = is_near(&found);
                    // What is hidden is looked for once the rest is as it is to be.
                    if is_enough || is_last {
                        let mut missed =
                            cover(&mut found.1, (&subject, &near), &hidden, &slopes, [tolerance, grain], &to_sew)?;
                        if found.1.patches.is_empty() {
                            missed = hidden.iter().map(|hidden| hidden.cell).collect();
                        }
                        if !missed.is_empty() {
                            found.1.miss(missed, cell);
                            is_enough = false;
                            is_last &= count == 0.0 || !is_gentle || 4.0 * count > HIDDEN * enough;
                        }
                        found.0 = found.1.reached(FEW);
                        best = Some(found);
                    }
                }
            } else if is_last {
                let first = *torn.get_or_insert(cell);
                if 4.0 * count > most {
                    // Cusps are torn in cells of any size: of them the larger ones tell as much.
                    (cell, is_resigned) = (2.0 * first, true);
                }
            } else if torn.is_none() && !is_resigned {
                // Sheets that the smallest cells would not show are torn in all.
                let smallest = cell * (4.0 * count / most).sqrt();
                is_resigned = subject.thickness(&hidden).is_some_and(|thickness| 4.0 * thickness < smallest);
            }
            let is_lacking = !is_enough && is_last && !hidden.is_empty();
            if is_lacking
                && std::mem::take(&mut may_have_faces)
                && let Some(found) = by_faces()?
            {
                run.report(1.0);
                return Ok(found);
            }
            if let Some((reached, mut quilt)) = best.take_if(|_| is_last || is_enough) {
                let [to_join, to_look] = run.stage(done, 1.0).stages([0.5, 0.5]);
                let mut patches = Patches::new(&quilt.patches, &to_join)?;
                let own = Subject { bounds: seen, ..subject };
                if complete_by_leaves((&mut quilt, &patches), (&own, &near), &slopes, (cell, tolerance), &to_look)? {
                    patches = Patches::new(&quilt.patches, &Run { progress: None, ..run.clone() })?;
                }
                run.report(1.0);
                let accuracy = Accuracy::of_surface(reached, quilt.error);
                return Ok(Surface::new(Arc::new(patches), accuracy, flat).in_doubt(tolerance, quilt.doubts(tolerance)));
            }
            cell *= 0.5;
        }
    }

    fn tolerance(&self, programs: &Compiled, wanted: &Wanted<'_>) -> f64 {
        let (bounds, _, size) = extent(programs, wanted);
        // Vertices of meshes are in single precision.
        let far = farthest(&bounds, size);
        // A surface that is measured itself has had its part, and is no smoother than what it was
        // measured to. What is measured from it need not be as coarse as all of them together, or
        // tolerances would double with each length of a length.
        let own = programs.accuracy.tolerance;
        let least = match wanted.tolerance {
            Some(tolerance) => (tolerance - own).max(FINEST * far),
            // Lengths that are alike have one surface.
            None => (DEVIATION * wanted.asked).log2().floor().exp2().max(SMALL * far),
        };
        least.max(programs.accuracy.grain())
    }
}

/// Adds to a quilt, whose patches these are, what it lacks about leaves that may pass between the
/// nodes of cells, and tells of what it lacks still. Gives whether patches have come.
fn complete_by_leaves(
    (quilt, known): (&mut Quilt, &Patches),
    (subject, near): (&Subject<'_>, &Bounds),
    slopes: &Slopes<'_>,
    (cell, tolerance): (f64, f64),
    run: &Run,
) -> Result<bool, CompileError> {
    let is_lacking = |p: DVec3| near.contains(p) && !known.is_within(p, KNOWN * tolerance);
    let [to_look, to_add] = run.stages([0.5, 0.5]);
    let lacking = run.install(|| subject.slender(cell, &is_lacking, &to_look)).map_err(compile_error)?;
    let (count, error) = (quilt.len(), quilt.error);
    if !complete(quilt, slopes, &lacking, tolerance, &to_add)? {
        // What patches were told to be off tells of these as well.
        let untold = lacking.iter().filter(|own| !known.is_within(own.at, error));
        let missed: Vec<Bounds> = untold.map(|own| Bounds::from_center(own.at, DVec3::splat(cell))).collect();
        if !missed.is_empty() {
            quilt.miss(missed, cell);
        }
    }
    Ok(quilt.len() > count)
}

/// The size of a solid, or how far it reaches from the origin, along axes that it ends along.
fn farthest(bounds: &Bounds, size: f64) -> f64 {
    let farthest = [bounds.min, bounds.max].map(|corner| corner.abs().max_element());
    farthest.into_iter().filter(|far| far.is_finite()).fold(size, f64::max)
}

/// What of a solid is to be measured: its box, the axis along which it is a cylinder, and its size
/// across that.
fn extent(programs: &Compiled, wanted: &Wanted<'_>) -> (Bounds, Option<usize>, f64) {
    let reach = wanted.reach(programs.bounds().longest_side());
    let bounds = programs.bounds().intersection(&wanted.region.inflate(reach));
    let flat = programs.flat_axis();
    let size = (0..3).filter(|axis| Some(*axis) != flat).map(|axis| bounds.size()[axis]).fold(0.0, f64::max);
    (bounds, flat, size)
}

/// A mesh, its creases sharp, and the cells that may hide something.
struct Shown {
    mesh: Mesh,
    hidden: Vec<Hidden>,
}

fn shown(program: &Program, bounds: Bounds, cell: f64, run: &Run) -> Result<Shown, CompileError> {
    let subject = Subject { program, bounds, palette: None, whole: None };
    let [to_mesh, to_look] = run.stages([0.7, 0.3]);
    let mesh = run.install(|| sharp(program, bounds, cell, &to_mesh)).map_err(compile_error)?;
    let hidden = run.install(|| subject.hidden(&mesh, &to_look)).map_err(compile_error)?;
    Ok(Shown { mesh, hidden })
}

fn compile_error(error: MeshingError) -> CompileError {
    match error {
        MeshingError::Solid(error) => error.into(),
        MeshingError::Cancelled(cancelled) => cancelled.into(),
        other => SolidError::Surface { reason: other.to_string() }.into(),
    }
}

/// Whether a triangle is not all beyond a side of a box.
fn meets(corners: &[DVec3; 3], bounds: &Bounds) -> bool {
    let own = corners.iter().fold(Bounds::EMPTY, |all, corner| all.union(&Bounds::new(*corner, *corner)));
    (0..3).all(|axis| own.max[axis] >= bounds.min[axis] && own.min[axis] <= bounds.max[axis])
}

/// The surface of a solid within a box, without the faces of the box and what is not near, and the
/// cells that may hide some of it.
fn part(
    (solid, slopes): (&Solid, &Slopes<'_>),
    clip: Bounds,
    [whole, near]: [Bounds; 2],
    cell: f64,
    run: &Run,
) -> Result<(Facets, Vec<Hidden>), CompileError> {
    let knife = Solid::cuboid(clip.size()).translate(clip.center());
    let part = solid.intersection(knife, RFunction::MIN_MAX);
    let [to_compile, run] = &run.stages([0.1, 0.9]);
    let programs = compiled_with(&part, to_compile)?;
    let bounds = programs.bounds().intersection(&clip);
    if bounds.is_empty() {
        return Ok((Facets::default(), Vec::new()));
    }
    let Shown { mesh, hidden } = shown(&programs.surface, bounds, cell, run)?;
    let is_cap = |corners: &[DVec3; 3]| {
        // Vertices of meshes are in single precision.
        let on =
            |axis: usize, side: f64| corners.iter().all(|p| (p[axis] - side).abs() < 1e-3 * cell + SMALL * side.abs());
        (0..3).any(|axis| {
            clip.min[axis] > whole.min[axis] && on(axis, clip.min[axis])
                || clip.max[axis] < whole.max[axis] && on(axis, clip.max[axis])
        })
    };
    let mut facets = Facets::new(&mesh, |corners| !is_cap(corners) && meets(corners, &near));
    // The faces that cut it off.
    let low = DVec3::select(clip.min.cmpgt(whole.min), clip.min, DVec3::NEG_INFINITY);
    let high = DVec3::select(clip.max.cmplt(whole.max), clip.max, DVec3::INFINITY);
    facets.leave_faces(&Bounds::new(low, high), slopes, run)?;
    Ok((facets, hidden))
}
