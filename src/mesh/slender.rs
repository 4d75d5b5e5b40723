//! Points of the surface on leaves that are thinner than cells.
//!
//! ```text
//!     |  .  |     A hole or a rod may pass between the nodes of cells that show something else, and
//!     |_(o)_|     leave no trace in a mesh. From points about the leaf by itself steps lead to it, and
//!     |  '  |     from there to the surface of the solid.
//! ```

use glam::DVec3;

use super::blocks::Blocks;
use super::error::MeshingError;
use super::lattice::{CellSize, Lattice};
use super::signs::BLOCK;
use super::subject::Subject;
use crate::eval::SlenderLeaf;
use crate::{Bounds, Cancelled, Run};
use rvachev_num::jobs;

/// What is thinner than this may pass between nodes, in cells: their diagonal.
const PASSES: f64 = 1.74;

/// Points along a cell that are looked from at least.
const ALONG: f64 = 2.0;

/// And along a leaf: on its axis it does not tell where its surface is.
const LEAST: f64 = 2.0;

/// Boxes about points that are so far apart, in thicknesses, leave nothing between them.
const BESIDE: f64 = 2.0;

/// So many points of a block are looked from at most to that end.
const MOST: f64 = 4096.0;

/// A point of the surface, and how thick the leaf is that it was found by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slender {
    pub(crate) at: DVec3,
    pub(crate) thickness: f64,
    /// Whether others are as near as it is thick, or nearly so.
    pub(crate) is_close: bool,
}

impl Subject<'_> {
    /// Points of the surface on convex leaves that may pass between the nodes of cells of a size,
    /// of those that are asked for.
    pub(crate) fn slender(
        &self,
        cell: f64,
        is_asked_for: &(dyn Fn(DVec3) -> bool + Sync),
        run: &Run,
    ) -> Result<Vec<Slender>, MeshingError> {
        let thin = self.program.thin_leaves(PASSES * cell);
        if !thin.contains(&true) {
            return Ok(Vec::new());
        }
        let lattice = Lattice::new(&self.bounds, CellSize::Length(cell))?;
        let [to_find, to_look] = run.stages([0.3, 0.7]);
        let blocks = Blocks::find(self.program, &lattice, &to_find)?;
        let of_block = |(number, block): (usize, &[u32; 3])| {
            to_look.check()?;
            let program = blocks.programs.of(number);
            let region = lattice.region(*block, BLOCK);
            let own = Subject { program, ..*self };
            let leaves = program.slender_in(&thin, &region);
            let found = leaves.iter().flat_map(|leaf| own.on_leaf(leaf, &region, cell));
            Ok(found.filter(|own| is_asked_for(own.at)).collect())
        };
        let found: Result<Vec<Vec<Slender>>, Cancelled> =
            jobs::try_in_order(blocks.cells.len(), |n| of_block((n, &blocks.cells[n])));
        Ok(found?.concat())
    }

    /// Points of the surface in a region that steps lead to from points about a leaf.
    fn on_leaf(&self, leaf: &SlenderLeaf, region: &Bounds, cell: f64) -> Vec<Slender> {
        let &SlenderLeaf { ref program, within, to_world, thickness } = leaf;
        let alone = Subject { program, ..*self };
        let axes = to_world.matrix3;
        let size = within.size() * DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
        let counts = |along: f64| (size / along).ceil().max(DVec3::splat(LEAST));
        // As close as what is to be found is thick, unless those are too many.
        let close = counts((BESIDE * thickness).min(cell / ALONG));
        let is_close = close.element_product() <= MOST;
        let counts = if is_close { close } else { counts(cell / ALONG) }.as_uvec3();
        let step = within.size() / counts.as_dvec3();
        let places = (0..counts.element_product()).map(|n| {
            let at = [n % counts.x, n / counts.x % counts.y, n / (counts.x * counts.y)];
            to_world.transform_point3(within.min + step * (DVec3::from_array(at.map(f64::from)) + 0.5))
        });
        let feet = places.filter_map(|p| self.foot(alone.foot(p, thickness)?, thickness));
        feet.filter(|foot| region.contains(*foot)).map(|at| Slender { at, thickness, is_close }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::compiled;

    /// A ball that fits between eight nodes is looked for, one that holds a node wherever it is is
    /// not.
    #[test]
    fn what_may_pass_between_nodes_is_found() {
        let cell = 0.25;
        for (diameter, is_found) in [(0.01, true), (0.9, true), (1.7, true), (1.8, false)] {
            let centre = DVec3::new(1.1, -0.3, 0.2);
            let ball = Solid::sphere(0.5 * diameter * cell).translate(centre);
            let programs = compiled(&(Solid::cuboid([4.0, 3.0, 2.0]) - ball)).unwrap();
            let subject = Subject { program: &programs.surface, bounds: programs.bounds(), palette: None, whole: None };
            let found = subject.slender(cell, &|_| true, &Run::default()).unwrap();
            assert_eq!(!found.is_empty(), is_found, "{diameter}: {}", found.len());
            for Slender { at, thickness, is_close } in found {
                assert!((thickness / cell - diameter).abs() < 1e-9 && is_close);
                assert!((at.distance(centre) / cell - 0.5 * diameter).abs() < 0.01 * diameter, "{diameter}: {at}");
            }
        }
    }

    /// What is wide and thin has more places than are looked from one by one.
    #[test]
    fn places_of_what_is_wide_are_apart() {
        let fin = Solid::cuboid([3.9, 2.9, 1e-4]) | Solid::cuboid([1.0; 3]);
        let programs = compiled(&fin).unwrap();
        let subject = Subject { program: &programs.surface, bounds: programs.bounds(), palette: None, whole: None };
        let found = subject.slender(0.25, &|p| p.x > 0.6, &Run::default()).unwrap();
        assert!(found.len() > 100 && found.iter().all(|own| own.at.x > 0.6 && !own.is_close), "{}", found.len());
        assert!(found.iter().all(|own| (own.at.z.abs() - 5e-5).abs() < 1e-5));
    }
}
