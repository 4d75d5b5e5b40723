//! The surface of what was moved is that of the solid at rest, moved.
//!
//! ```text
//!      .---.        rigid map         .---.        Patches are found once, for all the places that a part
//!     /     \   ---------------->   /     \       is moved to, and turned there: an assembly that moves
//!     '-----'                        '-----'       is not measured anew in each of its positions.
//! ```

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::surface_with;
use crate::eval::{Accuracy, CompileError, Surface};
use crate::solid::Node;
use crate::{Bounds, Run, Solid};
use rvachev_field::{Patch, Patches};

/// A matrix that is off a rotation by no more turns.
const ROTATION: f64 = 1e-12;

/// Middles of sides that are off straight ones by less than this part of the size, or of how far
/// away they are, are rounding.
const ROUNDING: f64 = 1e-13;

/// A surface that was moved to where a solid is, kept with the solid.
struct Moved(Arc<Surface>);

/// The surface of a solid by that of the solid that was moved there, if that is all that was done;
/// it is found on first use.
pub(super) fn moved(solid: &Solid, run: &Run) -> Result<Option<Arc<Surface>>, CompileError> {
    let Some((still, map)) = at_rest(solid) else { return Ok(None) };
    if let Some(kept) = solid.shelf().find(|_: &Moved| true) {
        run.report(1.0);
        return Ok(Some(kept.0.clone()));
    }
    let [to_find, to_move] = run.stages([0.9, 0.1]);
    let surface = surface_with(still, &to_find)?;
    if surface.flat.is_some() {
        return Ok(None);
    }
    let patches = Patches::new(&turned(&surface.patches, &map), &to_move)?;
    let doubts = surface.doubts.iter().map(|(bounds, off)| (bounds.transformed(&map), *off)).collect();
    // A few roundings of coordinates as they are there, and as they were.
    let far = farthest(&patches.bounds()).max(farthest(&surface.patches.bounds()));
    let rounding = 4.0 * f64::EPSILON * far;
    let accuracy = surface.accuracy.plus(Accuracy::of_surface(rounding, rounding));
    let there = Surface::new(Arc::new(patches), accuracy, None).in_doubt(surface.tolerance + rounding, doubts);
    let there = Arc::new(there);
    solid.shelf().keep(Arc::new(Moved(there.clone())));
    run.report(1.0);
    Ok(Some(there))
}

/// What was moved to make a solid, and how, if it was moved rigidly.
fn at_rest(solid: &Solid) -> Option<(&Solid, DAffine3)> {
    let (mut still, mut map, mut is_moved) = (solid, DAffine3::IDENTITY, false);
    loop {
        still = match still.node() {
            Node::Affine { operand, forward, .. } if is_rigid(forward) => {
                (map, is_moved) = (map * *forward, true);
                operand
            }
            Node::Named { operand, .. } | Node::Painted { operand, .. } => operand,
            _ => return is_moved.then_some((still, map)),
        };
    }
}

/// Whether a map turns and moves, and does not mirror.
fn is_rigid(map: &DAffine3) -> bool {
    let m = map.matrix3;
    m.determinant() > 0.0 && (m.transpose() * m).abs_diff_eq(DMat3::IDENTITY, ROTATION)
}

/// How far a box reaches from the origin, along an axis.
fn farthest(bounds: &Bounds) -> f64 {
    if bounds.is_empty() { 0.0 } else { bounds.min.abs().max(bounds.max.abs()).max_element() }
}

/// The patches where a rigid map takes them.
fn turned(patches: &Patches, map: &DAffine3) -> Vec<Patch> {
    let bounds = patches.bounds();
    let rounding = ROUNDING * farthest(&bounds).max(bounds.longest_side());
    let patch = |n: usize| {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|at| patches.point(n, at));
        let middles = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]].map(|at| patches.point(n, at));
        let displacement = |i: usize| {
            let off = middles[i] - corners[i].midpoint(corners[(i + 1) % 3]);
            if off.abs().max_element() <= rounding { DVec3::ZERO } else { map.transform_vector3(off) }
        };
        Patch { corners: corners.map(|p| map.transform_point3(p)), displacements: [0, 1, 2].map(displacement) }
    };
    (0..patches.len()).map(patch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deg;

    #[test]
    fn a_moved_solid_has_the_surface_of_the_one_at_rest() {
        let still = Solid::superellipsoid([1.0, 0.7, 2.0], 0.4, 0.6).twist(deg(12.0));
        let there = still.rotate_x(deg(33.0)).named("part").translate([100.0, 20.0, -7.0]);
        let map =
            DAffine3::from_translation(DVec3::new(100.0, 20.0, -7.0)) * DAffine3::from_rotation_x(33f64.to_radians());
        let [own, moved] = [&still, &there].map(|solid| surface_with(solid, &Run::default()).unwrap());
        assert_eq!(own.patches.len(), moved.patches.len());
        assert!(Arc::ptr_eq(&moved, &surface_with(&there, &Run::default()).unwrap()));
        for p in [DVec3::X * 3.0, DVec3::new(0.2, 0.1, -0.5), DVec3::new(-1.0, 2.0, 1.5)] {
            let (a, b) = (own.patches.nearest(p).unwrap(), moved.patches.nearest(map.transform_point3(p)).unwrap());
            assert!((a.distance - b.distance).abs() < 1e-6);
            assert!(map.transform_vector3(a.normal).distance(b.normal) < 1e-4);
        }
        // Far away coordinates are rounded.
        let far = surface_with(&still.translate([1e8, 0.0, 0.0]), &Run::default()).unwrap();
        assert!(far.tolerance > own.tolerance + 1e8 * f64::EPSILON && far.accuracy.error > own.accuracy.error);
        // What is moved is told whatever it is; what is stretched or mirrored is measured itself.
        assert!(at_rest(&Solid::cuboid([1.0; 3]).rotate_z(deg(10.0))).is_some());
        for other in [still.clone(), still.scale(2.0), still.reflect_x()] {
            assert!(at_rest(&other).is_none());
        }
    }
}
