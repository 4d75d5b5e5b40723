//! Rays by what a solid is without what is searched for: fillets, chamfers, cavities.
//!
//! ```text
//!           |    /|         Most rays meet the rest where no fillet is, and balls that roll there
//!     ray   |   / |         tell so (`roll`): those are done without a value of the fillet. What meets
//!     ---------+  |         a fillet before is searched for it. The few rays that meet the rest where
//!     ______|_/___|___      something is cut off from it go through the whole tree.
//! ```

use glam::DVec3;

use super::cells::{Cell, Cells};
use super::gbuffer::Surface;
use super::job::{Job, Ray};
use super::march::Marcher;
use super::slopes::Known;
use super::tile::{TIE, Tracer, nearer};
use crate::Bounds;
use crate::eval::{Fillets, Program, Region};

/// What rays meet is where it is told to be to this part of the solid's size.
const EXACT: f64 = 1e-4;

/// Sides of the box are halved so often to see that there is nothing.
const HALVINGS: u32 = 8;

/// A tree in parts.
pub(super) struct Apart {
    /// Without what is searched for.
    pub(super) rest: Cells,
    /// Fillets that are material, and whether each of them is inside wherever it is.
    added: Vec<Cell>,
    are_operands: bool,
    /// What is cut off from the rest.
    cut: Vec<Cell>,
}

impl Apart {
    /// `None` where the rest goes on beyond the bounds, or is nothing.
    pub(super) fn new(fillets: Fillets, bounds: Bounds, margin: f64) -> Option<Apart> {
        let Fillets { rest: Region::Surface(rest), added, are_operands, cut } = fillets else { return None };
        if !bounds.contains_bounds(&rest.reach()) && !is_outside_of_sides(&rest, &bounds) {
            return None;
        }
        let rest = Cells::within(&rest, bounds, margin, [true; 3]);
        let [added, cut] = [added, cut].map(|all| all.into_iter().filter_map(|part| rest.part(part)).collect());
        Some(Apart { rest, added, are_operands, cut })
    }

    /// The parts beside the rest.
    pub(super) fn parts(&self) -> impl Iterator<Item = &Cell> {
        self.added.iter().chain(&self.cut)
    }
}

/// Whether there is nothing at the sides of a box: what is in it does not go on beyond.
fn is_outside_of_sides(program: &Program, bounds: &Bounds) -> bool {
    let side = |axis: usize, end: f64| {
        let mut side = *bounds;
        (side.min[axis], side.max[axis]) = (end, end);
        side
    };
    let sides = (0..3).flat_map(|axis| [side(axis, bounds.min[axis]), side(axis, bounds.max[axis])]);
    sides.into_iter().all(|side| is_outside(program, &side, HALVINGS))
}

/// Whether all of a box is outside, halved so often at most.
fn is_outside(program: &Program, bounds: &Bounds, halvings: u32) -> bool {
    match program.narrow(bounds) {
        Region::Outside => true,
        Region::Surface(program) if halvings > 0 => {
            let size = bounds.size();
            let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
            let (mut low, mut high) = (*bounds, *bounds);
            (low.max[axis], high.min[axis]) = (bounds.center()[axis], bounds.center()[axis]);
            is_outside(&program, &low, halvings - 1) && is_outside(&program, &high, halvings - 1)
        }
        _ => false,
    }
}

impl Tracer {
    /// Whether a ray starts outside of what is a tree's rest: within, it meets that from the wrong
    /// side, as from a cavity.
    pub(super) fn starts_outside(&self, apart: &Apart, ray: u32) -> bool {
        let Ray { origin, base, .. } = self.rays[ray as usize];
        base > 0.0 || !apart.rest.contains(origin)
    }

    /// Takes rays that have met what there is of the rest on to what is beside it, of which `near`
    /// tells those that may pass a box. What they meet goes to `surfaces`, and the rays to the
    /// hits; gives those of which nothing is told.
    pub(super) fn besides(
        &mut self,
        cells: &Cells,
        apart: &Apart,
        near: impl Fn(&Bounds) -> Vec<u32>,
        surfaces: &mut [Surface],
    ) -> Vec<u32> {
        let size = cells.bounds().longest_side();
        self.marcher.hits.clear();
        let mut open = Vec::new();
        for part in &apart.added {
            let spans = near(&part.bounds).into_iter();
            self.spans.clear();
            self.spans.extend(spans.filter_map(|ray| nearer(part, ray, &self.rays, surfaces, TIE * size)));
            if self.spans.is_empty() {
                continue;
            }
            let known = part.rolled.map_or(Known::ANY, Known::steep);
            if apart.are_operands {
                self.marcher.march(cells, part, &known, &self.rays, &self.spans, surfaces);
            } else {
                open.extend(self.marcher.unrolled(&Job::new(cells, part, &known, &self.rays, &self.spans)));
            }
        }
        for part in &apart.cut {
            let room = part.bounds.inflate(EXACT * size);
            let point = |ray: u32| {
                let (own, seen) = (&self.rays[ray as usize], &surfaces[ray as usize]);
                seen.is_hit().then(|| (ray, own.origin + (seen.distance - own.base) * own.direction))
            };
            let met = near(&room).into_iter().filter_map(point).filter(|(_, p)| room.contains(*p));
            open.extend(self.marcher.filled(part, &met.collect::<Vec<_>>()));
        }
        open.sort_unstable();
        open.dedup();
        open
    }
}

impl Marcher {
    /// The points that what is cut off may be at, by the numbers of their rays.
    fn filled(&mut self, part: &Cell, points: &[(u32, DVec3)]) -> Vec<u32> {
        let (tape, count) = (part.tape(), points.len());
        let axis =
            |axis: usize| -> Vec<f32> { points.iter().map(|(_, p)| (*p - tape.origin())[axis] as f32).collect() };
        let (x, y, z, mut values) = (axis(0), axis(1), axis(2), vec![0.0; count]);
        self.evaluator.values_within(tape, 2.0 * tape.roundoff(), [&x, &y, &z], &mut values);
        let is_told = |value: f32| f64::from(value) < -tape.roundoff();
        points.iter().zip(values).filter(|(_, value)| !is_told(*value)).map(|((ray, _), _)| *ray).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Blend, Solid, deg};

    #[test]
    fn hits_just_beyond_the_box_of_what_is_cut_off_are_asked_about() {
        let plate = Solid::cuboid([2.0, 2.0, 0.4]);
        let solid = plate.difference_with(Solid::cylinder(0.5, 2.0), Blend::Fillet { radius: 0.1 });
        let program = solid.surface_program().expect("the solid is valid");
        let cells = Cells::new(&program, &solid.bounds().expect("the solid is valid"));
        let apart = cells.apart().expect("it has a fillet");
        // Down to the round rim, to where the sharp edge would be, and beside it.
        let mut tracer = Tracer::default();
        for x in [0.52, 0.9] {
            let (origin, direction) = (DVec3::new(x, 0.0, 3.0), -DVec3::Z);
            tracer.rays.push(Ray { origin, direction, inverse: direction.recip(), base: 0.0, inside: false });
        }
        let mut surfaces = [Surface { distance: 2.8 - 1e-6, ..Surface::NONE }; 2];
        assert_eq!(tracer.besides(&cells, apart, |_| vec![0, 1], &mut surfaces), [0]);
    }

    /// What a list of rays meets of a solid that has something apart.
    fn seen(solid: &Solid, rays: &[(DVec3, DVec3)]) -> Vec<f64> {
        let program = solid.surface_program().expect("the solid is valid");
        let cells = Cells::new(&program, &solid.bounds().expect("the solid is valid"));
        assert!(cells.apart().is_some());
        let mut surfaces = vec![Surface::NONE; rays.len()];
        Tracer::default().list(&cells, rays, &mut surfaces);
        surfaces.iter().map(|seen| seen.distance).collect()
    }

    #[test]
    fn fillets_that_are_cut_away_are_not_met() {
        let joint =
            Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::cylinder(0.5, 2.0), Blend::Fillet { radius: 0.15 });
        let half = joint - Solid::cuboid([4.0, 4.0, 4.0]).translate([0.0, -2.0, 0.0]);
        // Through the fillet before the cut, to the fillet in the cut.
        let found = seen(&half, &[(DVec3::new(0.52, -3.0, 0.22), DVec3::Y)]);
        assert!((found[0] - 3.0).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn what_goes_on_beyond_the_box_is_not_apart() {
        let joint =
            Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::cylinder(0.5, 2.0), Blend::Fillet { radius: 0.15 });
        let twisted = Solid::cuboid([2.0, 2.0, 4.0]).twist(deg(20.0)).shell(0.1);
        for solid in [joint, twisted] {
            let program = solid.surface_program().expect("the solid is valid");
            let whole = solid.bounds().expect("the solid is valid");
            assert!(Cells::new(&program, &whole).apart().is_some());
            // Rays that enter the lower half of the box may start within.
            let lower = Bounds { max: whole.max.with_z(0.0), ..whole };
            assert!(Cells::new(&program, &lower).apart().is_none());
        }
    }

    #[test]
    fn walls_are_met_from_within_a_cavity() {
        let solid = Solid::superellipsoid([0.5, 0.5, 1.0], 0.7, 0.7).shell(0.1);
        let found = seen(&solid, &[DVec3::X, -DVec3::Y].map(|way| (DVec3::ZERO, way)));
        assert!(found.iter().all(|distance| (distance - 0.4).abs() < 1e-3), "{found:?}");
    }
}
