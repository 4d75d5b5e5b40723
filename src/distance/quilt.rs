//! Triangles with curved sides that are on the surface to within a tolerance.
//!
//! ```text
//!         /\            A patch that is off the surface, or turned from it, is split into four, at
//!        /__\           the middles of its sides, which are on the surface. Its neighbours stay as
//!       /\  /\          they are: what gapes is less than the tolerance, and the sign does not come
//!      /__\/__\         from patches.
//! ```

use std::collections::HashMap;

use glam::DVec3;
use rvachev_num::order;

use super::facets::{CREASE, Facets};
use super::panes::{OFF, panes};
use super::piece::{Piece, first};
use super::plots::{Plot, Plots};
use super::seam::Seams;
use crate::mesh::Slopes;
use crate::{Bounds, Cancelled, Run};
use rvachev_field::{Patch, Patches};

/// What is done for patches.
#[derive(Clone, Copy)]
pub(super) struct Care {
    /// How far they may be off.
    pub(super) tolerance: f64,
    /// The part of the surface that may be off when it is seen whether splitting helps.
    pub(super) patience: f64,
    /// How often a patch is split at most.
    pub(super) depth: u32,
    /// No patch is split if there would be more than so many.
    pub(super) most: usize,
    /// Whether flat patches become large ones.
    pub(super) panes: bool,
}

impl Care {
    /// As much as is done for all of a surface.
    pub(super) fn new(tolerance: f64) -> Care {
        Care { tolerance, patience: f64::INFINITY, depth: 6, most: MOST, panes: true }
    }
}

/// So many triangles are sewn at a time: their sides take some megabytes.
const PLOT: usize = 1 << 14;

/// After so many times it is seen whether splitting helps.
const SOON: u32 = 3;

/// A surface has no more patches than so many, spots among them, unless its mesh has.
pub(super) const MOST: usize = 1 << 21;

/// A patch is split where its normal is off by more, in radians.
const TURN: f64 = 0.03;

/// Splitting goes on where it leaves less than this part of the error.
const GAIN: f64 = 0.8;

/// Patches that are farther off than so many tolerances are to be mended.
const FAR: f64 = 2.0;

/// What is found within so many tolerances of known patches is known.
pub(super) const KNOWN: f64 = 3.0;

/// A surface is not done while a patch is off by so many.
pub(super) const GROSS: f64 = 8.0;

/// The surface of a spot is looked for so many tolerances beside it at least.
const BESIDE: f64 = 8.0;

/// Patches that are farther off than this part of their width are left out.
const ASTRAY: f64 = 0.4;

/// So many steps lead from one that was left out to the surface.
const STEPS: usize = 4;

/// Where a patch is compared with the surface.
pub(super) const PROBES: [[f64; 3]; 4] =
    [[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]];

/// So many patches are compared at a time: their probes take more memory than they do.
const AT_ONCE: usize = 1 << 16;

/// Between the probes patches may be off by so much more than at them.
pub(super) const BETWEEN: f64 = 1.5;

/// The patches, and how far they may be off.
pub(super) struct Quilt {
    pub(super) patches: Vec<Patch>,
    pub(super) error: f64,
    /// The area of all.
    area: f64,
    tolerance: f64,
    /// Patches that are far off.
    pub(super) spots: Vec<Spot>,
    /// Patches that are farther off than they are wide.
    astray: Vec<Patch>,
    /// Where patches are farther off than the tolerance, or miss something.
    doubts: Vec<Doubt>,
}

/// A box in which patches are off, how far, and the area of those that are; 0 where they miss
/// something.
struct Doubt {
    bounds: Bounds,
    off: f64,
    area: f64,
}

/// A patch that is far off, and how far.
pub(super) struct Spot {
    pub(super) patch: Patch,
    pub(super) off: f64,
}

impl Spot {
    /// The box that the surface is in which the patch is to be on, within a tolerance.
    pub(super) fn near(&self, tolerance: f64) -> Bounds {
        self.patch.bounds().inflate(2.0 * self.off + BESIDE * tolerance)
    }
}

/// How far a patch is off.
#[derive(Clone, Copy)]
struct Residual {
    /// Off the surface, between the probes too.
    off: f64,
    /// Turned from it, in radians.
    turn: f64,
    /// Of its sides, off creases and off the surface.
    rim: f64,
}

impl Residual {
    fn all(self) -> f64 {
        self.off.max(self.rim)
    }
}

impl Quilt {
    /// One that has these spots and nothing else, to be within a tolerance of the surface.
    pub(super) fn of(spots: Vec<Spot>, tolerance: f64) -> Quilt {
        Quilt { patches: Vec::new(), error: 0.0, area: 0.0, tolerance, spots, astray: Vec::new(), doubts: Vec::new() }
    }

    /// Patches of triangles near the surface; `None` if more than this part of them is far off and
    /// splitting does not mend it: triangles are too large for what they are to show.
    pub(super) fn new(
        mut facets: Facets,
        slopes: &Slopes<'_>,
        care: Care,
        run: &Run,
    ) -> Result<Option<Quilt>, Cancelled> {
        facets.polish(slopes, run)?;
        let mut patience = care.patience * facets.area();
        let (mut quilt, mut plots) = (Quilt::of(Vec::new(), care.tolerance), Plots::new(facets, PLOT));
        let (mut number, count) = (0, plots.len());
        while let Some(plot) = plots.next() {
            let run = run.stage(number as f64 / count as f64, (number + 1) as f64 / count as f64);
            number += 1;
            patience = quilt.sew(plot, plots.left(), patience, slopes, care, &run)?;
            if patience < 0.0 {
                return Ok(None);
            }
        }
        Ok(Some(quilt))
    }

    /// Adds patches of a plot, so many triangles being left. When it is seen whether splitting
    /// helps, the area that is far off is taken from what may be: gives what is left of that, and
    /// goes no further if it is less than nothing.
    fn sew(
        &mut self,
        plot: Plot,
        left: usize,
        mut patience: f64,
        slopes: &Slopes<'_>,
        Care { tolerance, depth: last, most, panes: is_merged, .. }: Care,
        run: &Run,
    ) -> Result<f64, Cancelled> {
        let mut seams = Seams::default();
        let mut pieces = first(&plot, &mut seams);
        let mut positions = plot.facets.positions;
        let mut flat = Vec::<(Piece, f64)>::new();
        for depth in 0..=last {
            seams.find(&pieces, &positions, slopes, run)?;
            let patch = |(number, piece): (usize, &Piece)| {
                often(number, run)?;
                Ok(piece.patch(&positions, &seams, tolerance))
            };
            let patches = pieces.iter().enumerate().map(patch).collect::<Result<Vec<Patch>, Cancelled>>()?;
            let is_enough = self.len() + flat.len() + left + 4 * pieces.len() > most;
            let is_split = depth < last && !is_enough;
            let rims: Vec<f64> = pieces.iter().map(|piece| piece.rim(&seams)).collect();
            let is_off = |error: Residual| error.all() > tolerance || error.turn > TURN && error.off > 0.05 * tolerance;
            // What is split whatever else there is need not be compared any further.
            let is_clear = |error: Residual| is_split && depth < SOON && is_off(error);
            let errors = errors(&patches, &rims, is_clear, slopes, run)?;
            let fails = |piece: &Piece, error: Residual| {
                // Where splitting does not help, more of it does not either.
                is_split && is_off(error) && (depth < 4 || error.all() < GAIN * piece.before)
            };
            let failing = pieces.iter().zip(&errors).filter(|(piece, error)| fails(piece, **error));
            cross(failing.map(|(piece, _)| piece), &positions, &mut seams, slopes, run)?;
            // What cannot be split any further is no nearer later on.
            if depth == SOON || depth < SOON && is_enough {
                let off = patches.iter().zip(&errors).filter(|(_, error)| is_off(**error));
                patience -= off.map(|(own, _)| area_of(own)).sum::<f64>();
                if patience < 0.0 {
                    return Ok(patience);
                }
            }
            let mut next = Vec::new();
            for (number, ((piece, patch), error)) in pieces.into_iter().zip(patches).zip(errors).enumerate() {
                often(number, run)?;
                // Where values hardly rise they tell of much more than there can be.
                let off = error.all().min(slopes.reach);
                if fails(&piece, error) {
                    let from = next.len();
                    piece.split(&mut positions, &mut seams, &mut next);
                    next[from..].iter_mut().for_each(|part| part.before = off);
                    continue;
                }
                if off > FAR * tolerance {
                    self.spots.push(Spot { patch, off });
                } else if is_merged && patch.is_flat() && off <= tolerance {
                    self.note(&patch, off);
                    flat.push((piece, off));
                } else {
                    self.take(patch, off);
                }
            }
            pieces = next;
            run.report(f64::from(depth + 1) / f64::from(last + 1));
        }
        for pane in panes(&flat, &positions, &seams, OFF * tolerance, run)? {
            self.error = self.error.max(pane.off);
            let patch = |corners: [u32; 3]| Patch::flat(corners.map(|v| positions[v as usize]));
            self.patches.extend(pane.triangles.into_iter().map(patch));
        }
        Ok(patience)
    }

    /// How many patches there are, spots among them.
    pub(super) fn len(&self) -> usize {
        self.patches.len() + self.spots.len()
    }

    /// Takes a patch that is so far off. One that is farther off than it is wide tells nothing of
    /// the surface.
    fn take(&mut self, patch: Patch, off: f64) {
        if off > ASTRAY * width(&patch) {
            self.astray.push(patch);
        } else {
            self.note(&patch, off);
            self.error = self.error.max(off);
            self.patches.push(patch);
        }
    }

    /// How far off it is at most, if nothing is known beside patches that were left out.
    pub(super) fn worst(&self) -> f64 {
        self.astray.iter().map(width).fold(self.error, f64::max)
    }

    /// Tells what is missed without the patches that were left out: of the surface beside them what
    /// is not near others, and all of their size where there is none.
    pub(super) fn leave(&mut self, slopes: &Slopes<'_>, run: &Run) -> Result<(), Cancelled> {
        let astray = std::mem::take(&mut self.astray);
        if astray.is_empty() {
            return Ok(());
        }
        let alone = Run { progress: None, ..run.clone() };
        let known = Patches::new(&self.patches, &alone)?;
        let mut feet: Vec<DVec3> = astray.iter().flat_map(|patch| patch.corners).collect();
        let mut left = vec![f64::INFINITY; feet.len()];
        for _ in 0..STEPS {
            let found = slopes.at(&feet, &alone)?;
            for ((foot, left), slope) in feet.iter_mut().zip(&mut left).zip(found) {
                (*foot, *left) = (*foot + slope.newton(), slope.distance());
            }
        }
        for (patch, (feet, left)) in astray.iter().zip(feet.chunks(3).zip(left.chunks(3))) {
            let gap = |(foot, left): (&DVec3, &f64)| {
                let is_foot = *left <= self.tolerance;
                known.nearest(*foot).filter(|_| is_foot).map_or(f64::INFINITY, |near| near.distance)
            };
            let (gap, width) = (feet.iter().zip(left).map(gap).fold(0.0, f64::max), width(patch));
            if gap > KNOWN * self.tolerance {
                self.error = self.error.max(gap.min(width));
                self.doubts.push(Doubt::missed(patch.bounds().inflate(gap.min(2.0 * width))));
            }
        }
        Ok(())
    }

    /// Takes patches that are known to be at the surface, to within so much.
    pub(super) fn add_all(&mut self, found: impl Iterator<Item = (Patch, f64)>) {
        for (patch, off) in found {
            self.note(&patch, off);
            self.error = self.error.max(off);
            self.patches.push(patch);
        }
    }

    /// Takes patches as they are, however far off.
    pub(super) fn take_spots(&mut self, spots: Vec<Spot>) {
        spots.into_iter().for_each(|spot| self.take(spot.patch, spot.off));
    }

    /// Leaves out patches that are not near any of these spots, as far as spots may be off, and
    /// what is doubtful of them.
    pub(super) fn keep_near(&mut self, spots: &[&Spot]) {
        let near: Vec<Bounds> = spots.iter().map(|spot| spot.near(self.tolerance)).collect();
        let is_near = |own: &Bounds| near.iter().any(|near| near.intersects(own));
        let mut area = self.area;
        self.patches.retain(|patch| {
            let is_near = is_near(&patch.bounds());
            area -= if is_near { 0.0 } else { area_of(patch) };
            is_near
        });
        self.area = area;
        self.astray.retain(|patch| is_near(&patch.bounds()));
        self.doubts.retain(|doubt| is_near(&doubt.bounds));
        // Many parts are kept before they are taken together.
        self.patches.shrink_to_fit();
        self.doubts.shrink_to_fit();
    }

    /// Takes all patches of another one.
    pub(super) fn take_all(&mut self, other: Quilt) {
        self.error = self.error.max(other.error);
        self.patches.extend(other.patches);
        self.area += other.area;
        self.spots.extend(other.spots);
        self.astray.extend(other.astray);
        self.doubts.extend(other.doubts);
    }

    /// Tells of cells of some size that have more of the surface than the patches.
    pub(super) fn miss(&mut self, cells: Vec<Bounds>, size: f64) {
        self.error = self.error.max(size);
        self.doubts.extend(cells.into_iter().map(Doubt::missed));
    }

    /// Boxes in which patches may be farther off than this, and how far.
    pub(super) fn doubts(&self, off: f64) -> Vec<(Bounds, f64)> {
        self.doubts.iter().filter(|own| own.off > off).map(|own| (own.bounds, own.off)).collect()
    }

    fn note(&mut self, patch: &Patch, off: f64) {
        let area = area_of(patch);
        self.area += area;
        if off > self.tolerance {
            self.doubts.push(Doubt { bounds: patch.bounds().inflate(off), off, area });
        }
    }

    /// No more than this part of them, by area, is farther off than the result, which is no less
    /// than what they are to be within.
    pub(super) fn reached(&self, part: f64) -> f64 {
        let mut far: Vec<[f64; 2]> =
            self.doubts.iter().filter(|own| own.area > 0.0).map(|own| [own.off, own.area]).collect();
        order::falling(&mut far, |a| a[0]);
        let of_spots: f64 = self.spots.iter().map(|spot| area_of(&spot.patch)).sum();
        let mut left = part * (self.area + of_spots);
        for [off, area] in far {
            left -= area;
            if left < 0.0 {
                return off;
            }
        }
        self.tolerance
    }
}

impl Doubt {
    /// Where something is missed.
    fn missed(bounds: Bounds) -> Doubt {
        Doubt { bounds, off: f64::INFINITY, area: 0.0 }
    }
}

/// Sees every now and then whether the work may go on.
pub(super) fn often(number: usize, run: &Run) -> Result<(), Cancelled> {
    if number.is_multiple_of(4096) { run.check() } else { Ok(()) }
}

/// How long a patch is, more or less.
fn width(patch: &Patch) -> f64 {
    let [a, b, c] = patch.corners;
    a.distance(b).max(b.distance(c))
}

/// The area of a patch's triangle.
fn area_of(patch: &Patch) -> f64 {
    let [a, b, c] = patch.corners;
    0.5 * (b - a).cross(c - a).length()
}

/// Finds the sides of pieces that pass over a crease from one face to another.
fn cross<'a>(
    pieces: impl Iterator<Item = &'a Piece>,
    positions: &[DVec3],
    seams: &mut Seams,
    slopes: &Slopes<'_>,
    run: &Run,
) -> Result<(), Cancelled> {
    let mut asked = HashMap::new();
    for piece in pieces {
        for (k, hem) in piece.hems.iter().enumerate() {
            let ends = [piece.normals[k], piece.normals[(k + 1) % 3]];
            let is_open = !seams.of(*hem).is_crease && ends[0].distance(ends[1]) > 2.0 * CREASE;
            if is_open && !asked.contains_key(&hem.seam) {
                asked.insert(hem.seam, if hem.side == 1 { [ends[1], ends[0]] } else { ends });
            }
        }
    }
    let mut asked: Vec<(u32, [DVec3; 2])> = asked.into_iter().collect();
    order::rising(&mut asked, |(seam, _)| f64::from(*seam));
    seams.cross(&asked, positions, slopes, run)
}

/// How far patches are off the surface, and how far turned from it, given how far their sides are
/// off: as much of it as it takes until it is clear enough.
fn errors(
    patches: &[Patch],
    rims: &[f64],
    is_clear: impl Fn(Residual) -> bool,
    slopes: &Slopes<'_>,
    run: &Run,
) -> Result<Vec<Residual>, Cancelled> {
    let mut errors: Vec<Residual> = rims.iter().map(|rim| Residual { off: 0.0, turn: 0.0, rim: *rim }).collect();
    let [first, rest @ ..] = PROBES;
    for probes in [&[first][..], &rest] {
        for (patches, errors) in patches.chunks(AT_ONCE).zip(errors.chunks_mut(AT_ONCE)) {
            let open: Vec<usize> = (0..patches.len()).filter(|n| !is_clear(errors[*n])).collect();
            let points: Vec<DVec3> = open.iter().flat_map(|n| probes.iter().map(|b| patches[*n].point(*b))).collect();
            let found = slopes.at(&points, run)?;
            for (n, found) in open.iter().zip(found.chunks(probes.len())) {
                let (patch, error) = (&patches[*n], &mut errors[*n]);
                for (b, slope) in probes.iter().zip(found) {
                    error.off = error.off.max(BETWEEN * slope.distance_of(patch.bounds().longest_side()));
                    error.turn = error.turn.max(slope.turn(patch.normal(*b)));
                }
            }
        }
    }
    Ok(errors)
}
