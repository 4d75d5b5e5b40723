//! Spots where patches are far off the surface: meshed anew, in small cells (local remeshing).
//!
//! ```text
//!     ________            Cells of a mesh cut some creases off, and tips and cusps as they turn out. A box
//!     \     +-|-+         about such a spot is meshed by itself, and what is found is added: patches that
//!      \____|_/ |         lie on the surface may overlap, for the least of all distances counts.
//!           +---+
//! ```

use std::collections::BTreeMap;

use glam::DVec3;

use super::compiled_with;
use super::facets::{Facets, sharp};
use super::quilt::{Care, GROSS, MOST, Quilt, Spot, often};
use crate::eval::{Region, as_leaf};
use crate::mesh::{Slender, Slopes};
use crate::solid::Node;
use crate::{Bounds, Cancelled, Mesh, RFunction, Run, Solid};
use rvachev_field::{Patch, Patches};
use rvachev_num::{jobs, order};

/// So many boxes are meshed, those of the farthest spots. Boxes in these share as many.
const BOXES: usize = 512;

/// Cells along a box, and how often their patches are split.
const CELLS: f64 = 8.0;
const SPLITS: u32 = 4;

/// Cells of a box are smaller than those before by this factor at least.
const SMALLER: f64 = 0.8;

/// So many boxes are meshed at a time: what is found is kept until all of them are.
const AT_ONCE: usize = 16;

/// The part of the patches that may still be added which one box may have for itself: hardly one
/// has as many, and most are not near spots.
const SHARE: usize = 8;

/// Where the surface is there is a patch that is nearer than this, in cells.
const NEAR: f64 = 1.0;

/// What is within a box, in parts of its longest side, is mended.
const MARGIN: f64 = 0.3;

/// The parts of large groups, in parts of the longest box that is meshed: boxes about spots reach
/// beyond them.
const PART: f64 = 0.6;

/// A mesh that patches were made of: the size of its cells, how many boxes about its spots may be
/// meshed anew, and how many patches there may be then.
#[derive(Clone, Copy)]
struct Cells {
    size: f64,
    boxes: usize,
    most: usize,
}

/// Meshes the spots of a quilt anew that a mesh in such cells has left. Those that it does not mend
/// are taken as they are.
pub(super) fn mend(
    quilt: &mut Quilt,
    slopes: &Slopes<'_>,
    cell: f64,
    tolerance: f64,
    run: &Run,
) -> Result<(), Cancelled> {
    mend_of(Cells { size: cell, boxes: BOXES, most: MOST }, quilt, slopes, tolerance, run)?;
    quilt.leave(slopes, run)
}

fn mend_of(cells: Cells, quilt: &mut Quilt, slopes: &Slopes<'_>, tolerance: f64, run: &Run) -> Result<(), Cancelled> {
    let Cells { size, boxes, most } = cells;
    let spots = std::mem::take(&mut quilt.spots);
    let worst = |numbers: &[usize]| numbers.iter().map(|n| spots[*n].off).fold(0.0, f64::max);
    let found = if boxes == 0 { Vec::new() } else { groups(&spots, tolerance, run)? };
    let mut groups: Vec<Group> = found.into_iter().flat_map(|group| parted(group, &spots, size, tolerance)).collect();
    order::falling(&mut groups, |(_, numbers)| worst(numbers));
    groups.truncate(boxes);
    // What is within a few tolerances may stay as it is, so what is not has more.
    let is_gross = |(_, numbers): &&Group| worst(numbers) > GROSS * tolerance;
    let (all, gross) = (groups.len().max(1), groups.iter().filter(is_gross).count().max(1));
    let share = |group: &Group| boxes / if is_gross(&group) { gross } else { all };
    let mut left = vec![true; spots.len()];
    let mended = |group: &Group, most: usize| {
        let (bounds, numbers) = group;
        run.check()?;
        // In cells that are hardly smaller nothing would be seen that was not, and it would not end;
        // those below the tolerance tell nothing more.
        let cell = bounds.longest_side() / CELLS;
        if cell > SMALLER * size || cell < tolerance {
            return Ok(None);
        }
        let care = Care { depth: SPLITS, most, ..Care::new(tolerance) };
        let Some(mut part) = anew(slopes, bounds, care, run)? else { return Ok(None) };
        mend_of(Cells { size: cell, boxes: share(group), most }, &mut part, slopes, tolerance, run)?;
        let own: Vec<&Spot> = numbers.iter().map(|n| &spots[*n]).collect();
        part.keep_near(&own);
        Ok(covers(&part, &own, slopes, NEAR * cell, run)?.then_some(part))
    };
    for groups in groups.chunks(AT_ONCE) {
        let most = most.saturating_sub(quilt.len() + spots.len()) / SHARE;
        let found = jobs::try_in_order(groups.len(), |n| mended(&groups[n], most))?;
        for ((_, numbers), part) in groups.iter().zip(found) {
            match part {
                Some(part) if part.worst() < worst(numbers) => {
                    numbers.iter().for_each(|n| left[*n] = false);
                    quilt.take_all(part);
                }
                _ => {}
            }
        }
    }
    quilt.take_spots(spots.into_iter().zip(left).filter_map(|(spot, left)| left.then_some(spot)).collect());
    Ok(())
}

/// Meshes what a quilt lacks about points of the surface, in boxes of some thicknesses of what is
/// there. Gives whether it is all there now: of many boxes, or points that are not close, nothing
/// is meshed.
pub(super) fn complete(
    quilt: &mut Quilt,
    slopes: &Slopes<'_>,
    lacking: &[Slender],
    tolerance: f64,
    run: &Run,
) -> Result<bool, Cancelled> {
    // Cells of half the thickness show what is so thick.
    let side = |slender: &Slender| 0.5 * CELLS * slender.thickness;
    let mut boxes: BTreeMap<([i64; 3], u64), Vec<Spot>> = BTreeMap::new();
    for (number, slender) in lacking.iter().enumerate() {
        often(number, run)?;
        let place = (slender.at / side(slender)).to_array().map(|at| at.floor() as i64);
        let spot = Spot { patch: Patch::flat([slender.at; 3]), off: 0.5 * slender.thickness };
        boxes.entry((place, side(slender).to_bits())).or_default().push(spot);
        if boxes.len() > BOXES || !slender.is_close {
            return Ok(false);
        }
    }
    let most = MOST.saturating_sub(quilt.len()) / SHARE;
    let made = |((place, side), spots): &(([i64; 3], u64), Vec<Spot>)| {
        run.check()?;
        let side = f64::from_bits(*side);
        let min = side * DVec3::from_array(place.map(|at| at as f64));
        let bounds = Bounds::new(min, min + side).inflate(MARGIN * side);
        let care = Care { depth: SPLITS, most, ..Care::new(tolerance) };
        let Some(mut part) = anew(slopes, &bounds, care, run)? else { return Ok(None) };
        let size = bounds.longest_side() / CELLS;
        mend_of(Cells { size, boxes: BOXES, most }, &mut part, slopes, tolerance, run)?;
        let own: Vec<&Spot> = spots.iter().collect();
        Ok(covers(&part, &own, slopes, NEAR * size, run)?.then_some(part))
    };
    let mut is_all = true;
    let boxes: Vec<_> = boxes.into_iter().collect();
    for boxes in boxes.chunks(AT_ONCE) {
        for part in jobs::try_in_order(boxes.len(), |n| made(&boxes[n]))? {
            is_all &= part.is_some();
            part.into_iter().for_each(|part| quilt.take_all(part));
        }
    }
    quilt.leave(slopes, run)?;
    Ok(is_all)
}

/// A box, and the numbers of the spots that it is about.
type Group = (Bounds, Vec<usize>);

/// The box about a spot in which it is mended.
fn around(spot: &Spot, tolerance: f64) -> Bounds {
    spot.near(tolerance).inflate(MARGIN * spot.patch.bounds().longest_side())
}

/// A group in parts that are small enough for cells of half the size. Along a crease spots are
/// beside each other from end to end, and the box about all of them holds much that is none.
///
/// Boxes of neighbouring parts overlap, and so do the patches that are found in them: each part
/// holds all of the surface in its box, so nothing gapes between them, whatever their cells are.
fn parted((bounds, numbers): Group, spots: &[Spot], size: f64, tolerance: f64) -> Vec<Group> {
    let longest = 0.5 * CELLS * size;
    if bounds.longest_side() <= longest {
        return vec![(bounds, numbers)];
    }
    let mut parts: BTreeMap<[u64; 3], Group> = BTreeMap::new();
    for number in numbers {
        let own = around(&spots[number], tolerance);
        let place = ((own.center() - bounds.min) / (PART * longest)).to_array().map(|at| at as u64);
        let (part, numbers) = parts.entry(place).or_insert((Bounds::EMPTY, Vec::new()));
        *part = part.union(&own);
        numbers.push(number);
    }
    parts.into_values().collect()
}

/// Boxes about spots, apart from each other, and the numbers of the spots in each: no more than are
/// meshed, about those that are farthest off.
fn groups(spots: &[Spot], tolerance: f64, run: &Run) -> Result<Vec<Group>, Cancelled> {
    let mut order: Vec<usize> = (0..spots.len()).collect();
    order::falling(&mut order, |a| spots[*a].off);
    let mut groups: Vec<Group> = Vec::new();
    for (count, number) in order.into_iter().enumerate() {
        often(count, run)?;
        let (mut bounds, mut numbers) = (around(&spots[number], tolerance), vec![number]);
        while let Some(at) = groups.iter().position(|(other, _)| other.intersects(&bounds)) {
            let (other, mut others) = groups.swap_remove(at);
            bounds = bounds.union(&other);
            // The longer list stays where it is, or a large group would be copied for each of its
            // spots.
            if others.len() > numbers.len() {
                std::mem::swap(&mut others, &mut numbers);
            }
            numbers.append(&mut others);
        }
        if groups.len() < BOXES {
            groups.push((bounds, numbers));
        }
    }
    Ok(groups)
}

/// Whether there are patches wherever spots are on the surface: what small cells do not show either
/// is not to be lost.
fn covers(part: &Quilt, spots: &[&Spot], slopes: &Slopes<'_>, near: f64, run: &Run) -> Result<bool, Cancelled> {
    let patches = Patches::new(&part.patches, &Run { progress: None, ..run.clone() })?;
    let corners: Vec<DVec3> = spots.iter().flat_map(|spot| spot.patch.corners).collect();
    let found = slopes.at(&corners, run)?;
    // What is no corner of the surface at all tells nothing.
    let mut feet = corners.iter().zip(found).filter(|(_, slope)| slope.distance() < near).map(|(p, s)| *p + s.newton());
    Ok(!patches.is_empty() && feet.all(|foot| patches.is_within(foot, near)))
}

/// The surface in a box.
fn anew(slopes: &Slopes<'_>, bounds: &Bounds, care: Care, run: &Run) -> Result<Option<Quilt>, Cancelled> {
    let cell = bounds.longest_side() / CELLS;
    let program = match slopes.program.narrow(&bounds.inflate(cell)) {
        Region::Surface(program) => program,
        Region::Inside | Region::Outside => return Ok(None),
    };
    let knife = Solid::cuboid(bounds.size()).translate(bounds.center());
    let part = Solid::from_node(Node::Leaf(as_leaf(program.clone(), *bounds))).intersection(knife, RFunction::MIN_MAX);
    let alone = Run { progress: None, ..run.clone() };
    let Some(mesh) = meshed(&part, bounds, cell, &alone)? else { return Ok(None) };
    // Where two sides of the box meet, triangles are on both.
    let is_on = |p: &DVec3| {
        let at = |axis: usize, side: f64| (p[axis] - side).abs() < 1e-3 * cell;
        (0..3).any(|axis| at(axis, bounds.min[axis]) || at(axis, bounds.max[axis]))
    };
    let mut facets = Facets::new(&mesh, |corners| !corners.iter().all(is_on));
    let slopes = Slopes { program: &program, ..*slopes };
    facets.leave_faces(bounds, &slopes, &alone)?;
    Quilt::new(facets, &slopes, care, &alone)
}

/// A mesh, if it can be made.
fn meshed(part: &Solid, bounds: &Bounds, cell: f64, run: &Run) -> Result<Option<Mesh>, Cancelled> {
    let Ok(programs) = compiled_with(part, run) else {
        run.check()?;
        return Ok(None);
    };
    let mesh = sharp(&programs.surface, *bounds, cell, run);
    run.check()?;
    Ok(mesh.ok())
}
