//! Cells as small as a tolerance asks, each where it does.
//!
//! A mesh is made and compared with the surface. Where it is too far off, cells are made smaller:
//! all of them while much of the surface is off, then those about the places that are, which are
//! halved. Curved parts have small cells in the end, flat ones those of the beginning. So have
//! creases of surfaces that are flat between them, however blunt: the vertices of cells are on
//! them.

use glam::DVec3;
use rvachev_num::order;

use super::corners::{corners, lost};
use super::level::Level;
use super::rims::cut_off;
use super::{Job, divided, grade, meshed};
use crate::Run;
use crate::geom::Mesh;
use crate::mesh::blocks::Blocks;
use crate::mesh::deviation::{Probe, largest, probes};
use crate::mesh::error::MeshingError;
use crate::mesh::lattice::{CellSize, Lattice};

/// Where this part of the surface is off, all cells are made smaller, so that this part should be
/// off then.
const MUCH: f64 = 0.4;
const REST: f64 = 0.03;

/// How much smaller they are made at a time. What is far off because walls are thinner than cells
/// does not come nearer by the square of the size, but at once, so the size is asked again before
/// it is much smaller.
const MOST: f64 = 0.8;
const LEAST: f64 = 0.4;

/// How often it is compared.
const ROUNDS: usize = 9;

/// Meshes of so many triangles are as fine as any get, and those with cells halved in places of so
/// many and these for each that there was without.
const ENOUGH: usize = 1 << 22;
const ENOUGH_IN_PLACES: usize = 1 << 18;
const FOR_EACH: usize = 6;

/// Of surfaces that are flat between creases all cells are halved while there are so few triangles,
/// and as long as this part of them is to be.
const FEW: usize = 1 << 16;
const PART: f64 = 0.25;

/// Cells of two sizes are worse than those of one if they are so much farther off.
const WORSE: f64 = 1.5;

/// Beside a knife edge a mesh comes no nearer than cells become small, and these would have no end:
/// it may be off by so many times as much there, which what takes triangles away leaves as it is.
const AT_KNIFE: f64 = 2.5;

/// The cosine between the normals of the triangles on both sides of a knife edge is less.
const KNIFE: f32 = -0.5;

/// How far the work is after a round, of what there was to do.
const ROUND: f64 = 0.4;

/// A mesh near the surface, how near, and what its largest cells are.
pub(in crate::mesh) struct Within {
    pub(in crate::mesh) mesh: Mesh,
    pub(in crate::mesh) probes: Vec<Probe>,
    /// How far the known corner of the surface is that is farthest from it.
    pub(in crate::mesh) lost: f64,
    pub(in crate::mesh) lattice: Lattice,
    pub(in crate::mesh) blocks: Blocks,
}

/// The mesh on a lattice whose cells are halved, at most so often where they are unresolved, and
/// where triangles are farther from the surface than a tolerance, as long as that helps.
pub(in crate::mesh) fn within(
    job: Job<'_>,
    start: (Lattice, Blocks),
    halvings: u32,
    tolerance: f64,
    run: &Run,
) -> Result<Within, MeshingError> {
    // Smaller steps than those of single precision bring no vertex nearer.
    let farthest = start.0.bounds().min.abs().max(start.0.bounds().max.abs()).max_element() as f32;
    let tolerance = tolerance.max(2.0 * f64::from(farthest.next_up() - farthest));
    let known = corners(job, tolerance, &quiet(run))?;
    let (mut levels, _) = divided(job, start, halvings, &run.stage(0.0, 0.1))?;
    let (mut done, mut most, mut enough) = (0.1, usize::MAX, ENOUGH);
    // The last mesh in cells of one size: how far off it was, and of how many triangles.
    let mut alone = None;
    for round in 1.. {
        let end = done + ROUND * (1.0 - done);
        let [to_mesh, to_compare] = run.stage(done, end).stages([0.5, 0.5]);
        done = end;
        let mesh = match meshed(job, &mut levels, &to_mesh)? {
            Ok(mesh) => mesh,
            Err(mismatched) => {
                most = mismatched;
                levels.truncate(mismatched);
                levels[mismatched - 1].forget();
                continue;
            }
        };
        let probes = probes(&mesh, job.program, tolerance, &to_compare)?;
        let at_knife = at_knives(&mesh);
        let allowed = |probe: &Probe| if at_knife[probe.triangle as usize] { AT_KNIFE * tolerance } else { tolerance };
        let is_off = |probe: &&Probe| probe.off > allowed(probe);
        let mut lost = lost(&mesh, &known, (job.program, tolerance), &quiet(run))?;
        lost.extend(cut_off(&mesh, (job.program, tolerance), &quiet(run))?);
        let farthest_lost = lost.iter().fold(0.0, |most: f64, (_, far)| most.max(*far));
        let far = largest(&probes).max(farthest_lost);
        if let [level] = &levels[..] {
            alone = Some((level.lattice, far, mesh.triangles().len()));
            enough = (ENOUGH_IN_PLACES + FOR_EACH * mesh.triangles().len()).min(ENOUGH);
        }
        let is_done = round >= ROUNDS || mesh.triangles().len() > enough;
        // Where larger and smaller cells meet, creases are cut off: that may be worse than what is
        // repaired.
        let is_worse = |(_, before, count): &(Lattice, f64, usize)| {
            levels.len() > 1 && far > tolerance && far > WORSE * before && 4 * count < ENOUGH_IN_PLACES * FOR_EACH
        };
        let smaller = match alone {
            _ if is_done => None,
            Some(alone) if is_worse(&alone) => match alone.0.halved() {
                Some(lattice) => Some(Level::new(lattice, Blocks::find(job.program, &lattice, &quiet(run))?)),
                None => None,
            },
            _ => smaller(job, &levels, &mesh, &probes, tolerance, run)?,
        };
        if let Some(smaller) = smaller {
            levels = vec![smaller];
            continue;
        }
        let before: usize = levels.iter().map(Level::inset_len).sum();
        if !is_done {
            let off = probes.iter().filter(is_off).map(|probe| middle(&mesh, probe));
            off.chain(lost.iter().map(|(corner, _)| *corner)).for_each(|p| add(&mut levels, p, most));
        }
        // A crease is cut off where it passes from larger cells to smaller ones: of a surface that
        // is all creases, cells are of one size while they are few, and where much is to be halved.
        let part = if mesh.triangles().len() < FEW { 0.0 } else { PART };
        if let [level] = &levels[..]
            && !is_done
            && job.program.is_faceted()
            && 4 * mesh.triangles().len() < ENOUGH
            && let Some(halved) = level.halved_throughout(part)
        {
            levels = vec![halved];
            continue;
        }
        if levels.iter().map(Level::inset_len).sum::<usize>() == before || !deepen(&mut levels) {
            let first = levels.swap_remove(0);
            return Ok(Within { mesh, probes, lost: farthest_lost, lattice: first.lattice, blocks: first.blocks });
        }
    }
    unreachable!("the last round returns")
}

/// The same run, told nothing: what is done again and again is a part of a round.
fn quiet(run: &Run) -> Run {
    Run { progress: None, ..run.clone() }
}

/// The triangles with a corner on a knife edge.
fn at_knives(mesh: &Mesh) -> Vec<bool> {
    let triangles = mesh.triangles();
    let mut sides: Vec<([u32; 2], u32)> = (0..)
        .zip(triangles)
        .flat_map(|(n, &[a, b, c])| [[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], n)))
        .collect();
    sides.sort_unstable();
    let normal = |n: u32| {
        let [a, b, c] = mesh.corners(triangles[n as usize]);
        (b - a).cross(c - a).as_vec3().normalize_or_zero()
    };
    let mut on_knife = vec![false; mesh.positions().len()];
    for pair in sides.windows(2) {
        let [(side, one), (other, two)] = [pair[0], pair[1]];
        if side == other && normal(one).dot(normal(two)) < KNIFE {
            side.into_iter().for_each(|vertex| on_knife[vertex as usize] = true);
        }
    }
    triangles.iter().map(|corners| corners.iter().any(|v| on_knife[*v as usize])).collect()
}

fn middle(mesh: &Mesh, probe: &Probe) -> DVec3 {
    mesh.corners(mesh.triangles()[probe.triangle as usize]).into_iter().sum::<DVec3>() / 3.0
}

/// All of the solid in cells so small that nearly all of it should be near enough, if they are of
/// one size and much is not.
fn smaller(
    job: Job<'_>,
    levels: &[Level],
    mesh: &Mesh,
    probes: &[Probe],
    tolerance: f64,
    run: &Run,
) -> Result<Option<Level>, MeshingError> {
    let [level] = levels else { return Ok(None) };
    let mut off = vec![0.0f64; mesh.triangles().len()];
    probes.iter().for_each(|probe| off[probe.triangle as usize] = off[probe.triangle as usize].max(probe.off));
    let area = |n: usize| {
        let [a, b, c] = mesh.corners(mesh.triangles()[n]);
        (b - a).cross(c - a).length()
    };
    let mut order: Vec<usize> = (0..off.len()).collect();
    order::falling(&mut order, |n| off[*n]);
    let all: f64 = (0..off.len()).map(area).sum();
    // How far the part of the surface that is farthest off is off at least.
    let least = |part: f64| {
        let mut sum = 0.0;
        let last = order.iter().find(|n| {
            sum += area(**n);
            sum >= part * all
        });
        last.map_or(0.0, |n| off[*n])
    };
    if least(MUCH) <= tolerance {
        return Ok(None);
    }
    // The distance goes by the square of the size.
    let part = (tolerance / least(REST)).sqrt().clamp(LEAST, MOST);
    let count = mesh.triangles().len() as f64 / (part * part);
    let smaller = CellSize::Length(part * level.lattice.step());
    let lattice = Lattice::new(&job.limits, smaller).ok().filter(|_| count < ENOUGH as f64);
    let Some(lattice) = lattice else { return Ok(None) };
    let blocks = Blocks::find(job.program, &lattice, &quiet(run))?;
    Ok(Some(Level::new(lattice, blocks)))
}

/// Has the cells about a point halved that are there now, if there may be another level below them.
fn add(levels: &mut [Level], p: DVec3, most: usize) {
    let last = levels.iter().position(|level| !level.has(p));
    if let Some(n) = last.filter(|n| n + 1 < most) {
        levels[n].add(p);
    }
}

/// Takes what was added to insets into the levels below; whether these could be made.
fn deepen(levels: &mut Vec<Level>) -> bool {
    let last = levels.len() - 1;
    if levels[last].inset_len() > 0 {
        let Some(halved) = levels[last].halved() else {
            levels[last].forget();
            return false;
        };
        levels.push(halved);
    }
    grade(levels);
    true
}
