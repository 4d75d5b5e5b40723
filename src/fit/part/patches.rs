//! Parts of the surface that hang together without a crease, or across creases of one kind.
//!
//! ```text
//!       .---.             smooth: the top, the side              normals of neighbours differ little
//!      (  o  )            convex: all that one added leaf shows  parts meet in concave creases (minima rule)
//!    ---'   '---          concave: all that one cut leaf shows   its rim is convex
//! ```
//!
//! Source: D. Hoffman, W. Richards, *Parts of recognition* (1984).

use crate::fit::grid::{Grid, extent};

use super::samples::{Kind, Samples};

/// Neighbours of a sample.
const NEIGHBOURS: usize = 8;

/// Neighbours whose normals differ by less hang together, as cosines: 22° and 30°.
const SMOOTH: [f64; 2] = [0.927, 0.866];

/// Fewer samples are no patch.
pub(super) const FEWEST: usize = 24;

/// Neighbours, whether their normals differ little, and whether they turn away from each other.
type Link = (u32, u32, bool, bool);

/// Samples that hang together.
pub(super) struct Patch {
    pub(super) samples: Vec<u32>,
    /// Whether they may be of a leaf that is added, or cut.
    pub(super) may: [bool; 2],
}

/// All patches, the same samples in several of them.
pub(super) fn patches(samples: &Samples) -> Vec<Patch> {
    let Samples { points, normals, kind, .. } = samples;
    let smooth = if *kind == Kind::Cad { SMOOTH[0] } else { SMOOTH[1] };
    let cell = (6.0 / points.len().max(1) as f64).sqrt() * 0.5;
    let grid = Grid::new(points, extent(points), cell);
    let mut links: Vec<Link> = Vec::new();
    let mut near = Vec::new();
    for (i, p) in (0_u32..).zip(points) {
        grid.nearest(*p, NEIGHBOURS + 1, &mut near);
        for (_, j) in near.iter().filter(|(_, j)| *j != i) {
            let [a, b] = [i, *j].map(|k| k as usize);
            let is_smooth = normals[a].dot(normals[b]) > smooth;
            let turn = (normals[b] - normals[a]).dot(points[b] - points[a]);
            // Two sides of a thin wall are near each other and no neighbours.
            let is_through = normals[a].dot(normals[b]) < -0.5;
            if !is_through {
                links.push((i, *j, is_smooth, turn > 0.0));
            }
        }
    }
    let mut all = Vec::new();
    for (across, may) in [(None, [true, true]), (Some(true), [true, false]), (Some(false), [false, true])] {
        let is_kept = |(_, _, is_smooth, is_convex): &&Link| *is_smooth || across == Some(*is_convex);
        for samples in joined(points.len(), links.iter().filter(is_kept).map(|(a, b, ..)| (*a, *b))) {
            if samples.len() >= FEWEST && all.iter().all(|other: &Patch| other.samples != samples) {
                all.push(Patch { samples, may });
            }
        }
    }
    all
}

/// What hangs together by links, in the order of the first members.
fn joined(count: usize, links: impl Iterator<Item = (u32, u32)>) -> Vec<Vec<u32>> {
    let mut above: Vec<u32> = (0..count as u32).collect();
    fn root(above: &mut [u32], mut i: u32) -> u32 {
        while above[i as usize] != i {
            above[i as usize] = above[above[i as usize] as usize];
            i = above[i as usize];
        }
        i
    }
    for (a, b) in links {
        let (a, b) = (root(&mut above, a), root(&mut above, b));
        above[a.max(b) as usize] = a.min(b);
    }
    let mut sets: Vec<Vec<u32>> = vec![Vec::new(); count];
    for i in 0..count as u32 {
        sets[root(&mut above, i) as usize].push(i);
    }
    sets.retain(|set| !set.is_empty());
    sets
}
