//! The tree of a part's leaves, with patterns as one leaf that is repeated.
//!
//! ```text
//!     − cut cylinder 2                          − cut cylinder 2, in a ring of 4
//!     − cut cylinder 3         →
//!     − cut cylinder 4         of leaves that are added, or cut, one after the other: their order
//!     − cut cylinder 5         among each other is of no matter
//! ```

use glam::{DMat3, DVec3};

use super::layouts::patterns_of;
use super::leaf::{Leaf, along, posed};
use super::measures::{TO_X, TO_Y, tidy};
use super::patterns::{Layout, Pattern};
use super::result::PartLeaf;
use super::topology::tree;
use crate::Solid;

/// How far a leaf may be from where the rule has it, in diagonals: what vertices leave open.
const PLACED: f64 = 1e-4;

/// The solid of leaves, in the order in which they are added and cut, for a part of such a size;
/// and the patterns that are repeated in it.
pub(super) fn repeated(leaves: &[PartLeaf], size: f64) -> Option<(Solid, Vec<Pattern>)> {
    // Which run of leaves that are all added, or all cut, each is in.
    let runs: Vec<usize> = (leaves.iter())
        .scan((0, true), |(run, adds), leaf| {
            *run += usize::from(leaf.adds != *adds);
            *adds = leaf.adds;
            Some(*run)
        })
        .collect();
    let mut solids: Vec<Option<Solid>> = leaves.iter().map(|leaf| Some(leaf.leaf.solid().named(&leaf.name))).collect();
    let mut kept = Vec::new();
    let plain: Vec<&Leaf> = leaves.iter().map(|leaf| &leaf.leaf).collect();
    for mut pattern in patterns_of(&plain, &runs, size) {
        if let Layout::Ring { centre, first, .. } = &mut pattern.layout {
            // A ring may begin anywhere: where its numbers are shortest.
            let members = &mut pattern.leaves;
            let length = |k: &usize| format!("{:?}", leaves[members[*k]].leaf.centre).len();
            let shortest = (0..members.len()).min_by_key(length).unwrap_or(0);
            members.rotate_left(shortest);
            *first = leaves[members[0]].leaf.centre - *centre;
        }
        let first = &leaves[pattern.leaves[0]];
        let places: Vec<DVec3> = pattern.leaves.iter().map(|i| leaves[*i].leaf.centre).collect();
        // What cannot be repeated stays as it is.
        let repeated = copies(&pattern.layout, &places, &first.leaf, pattern.name(leaves), size);
        let Some(repeated) = repeated.filter(|solid| solid.bounds().is_ok()) else { continue };
        pattern.leaves.iter().for_each(|i| solids[*i] = None);
        solids[pattern.leaves[0]] = Some(repeated);
        kept.push(pattern);
    }
    let solid = tree(leaves.iter().zip(solids).filter_map(|(leaf, solid)| Some((leaf.adds, solid?))))?;
    Some((solid, kept))
}

/// The first leaf of a pattern, repeated; none if some leaves are not where the rule has them.
fn copies(layout: &Layout, places: &[DVec3], first: &Leaf, name: &str, size: f64) -> Option<Solid> {
    let is_placed = |rule: &dyn Fn(usize) -> DVec3| {
        places.iter().enumerate().all(|(k, place)| place.distance(rule(k)) < PLACED * size)
    };
    match *layout {
        Layout::Ring { centre, axis, .. } => {
            let count = u32::try_from(places.len()).ok()?;
            // Made about z, and laid along the axis then.
            let frame = upright(axis);
            let to = frame.transpose();
            let [middle, at] = [centre, places[0]].map(|p| to * p);
            let middle = DVec3::new(on_axis(middle.x, size), on_axis(middle.y, size), 0.0);
            let rule = |k: usize| {
                let turn = DMat3::from_rotation_z(std::f64::consts::TAU / f64::from(count) * k as f64);
                frame * (middle + turn * (at - middle))
            };
            let own = Leaf { shape: first.shape.clone(), rotation: to * first.rotation, centre: tidied(at - middle) };
            let own = own.aligned(1e-9).solid().named(name);
            is_placed(&rule).then(|| posed(own.repeat_polar(count), frame, tidied(frame * middle)))
        }
        Layout::Line { .. } => {
            let last = places.len() - 1;
            let step = tidied((places[last] - places[0]) / last as f64);
            let rule = |k: usize| places[0] + k as f64 * step;
            is_placed(&rule).then(|| first.solid().named(name).repeat_linear(last as u32 + 1, step))
        }
        Layout::Grid { counts: [columns, rows], .. } => {
            let along = tidied((places[columns - 1] - places[0]) / (columns - 1) as f64);
            let across = tidied((places[columns * (rows - 1)] - places[0]) / (rows - 1) as f64);
            let rule = |k: usize| places[0] + (k % columns) as f64 * along + (k / columns) as f64 * across;
            let row = || first.solid().named(name).repeat_linear(columns as u32, along);
            is_placed(&rule).then(|| row().repeat_linear(rows as u32, across))
        }
    }
}

/// A frame whose z axis is the given one, by a quarter turn if that will do.
fn upright(axis: DVec3) -> DMat3 {
    match axis {
        DVec3::X => TO_X,
        DVec3::Y => TO_Y,
        axis => along(axis),
    }
}

fn tidied(step: DVec3) -> DVec3 {
    DVec3::from_array(step.to_array().map(tidy))
}

/// A coordinate of a middle: none, if it is hardly any.
fn on_axis(v: f64, size: f64) -> f64 {
    if v.abs() < 0.1 * PLACED * size { 0.0 } else { v }
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;

    fn leaf(adds: bool, name: &str, leaf: Leaf) -> PartLeaf {
        let (name, text) = (name.to_owned(), String::new());
        PartLeaf { adds, leaf, name, tilt: DAffine3::IDENTITY, text, surface: 0.1, seen: 1.0 }
    }

    fn cut(name: &str, x: f64, y: f64) -> PartLeaf {
        leaf(false, name, Leaf::cylinder(DVec3::Z, DVec3::new(x, y, 0.0), 1.0, [-4.0, 4.0]))
    }

    #[test]
    fn rings_rows_and_grids_are_one_leaf_and_the_same_solid() {
        let plate = leaf(
            true,
            "plate",
            Leaf::cuboid(glam::DMat3::IDENTITY, [DVec3::splat(-30.0), DVec3::new(30.0, 30.0, 3.0)]),
        );
        let angle = |k: i32| 0.3 + std::f64::consts::TAU * f64::from(k) / 5.0;
        let ring = (0..5).map(|k| cut("ring", 2.0 + 9.0 * angle(2 * k).cos(), 9.0 * angle(2 * k).sin()));
        let grid = (0..6).map(|k| cut("grid", 12.0 + 5.0 * f64::from(k % 3), 12.0 + 6.0 * f64::from(k / 3)));
        let row = [2, 0, 3, 1].map(|k| cut("row", -25.0 + 5.0 * f64::from(k), -20.0));
        for holes in [ring.collect::<Vec<_>>(), grid.collect(), row.to_vec()] {
            let leaves: Vec<PartLeaf> = std::iter::once(plate.clone()).chain(holes).collect();
            let plain = tree(leaves.iter().map(|leaf| (leaf.adds, leaf.leaf.solid()))).unwrap();
            let (solid, patterns) = repeated(&leaves, 100.0).unwrap();
            assert_eq!(patterns.len(), 1);
            let name = &leaves[1].name;
            assert!(solid.to_string().matches(&**name).count() == 1, "{solid}");
            for i in 0..3000 {
                let t = |k: f64| 60.0 * (f64::from(i) * k).fract() - 30.0;
                let p = DVec3::new(t(0.618), t(0.414), 1.0);
                assert!((solid.value(p).unwrap() - plain.value(p).unwrap()).abs() < 1e-9, "{name} at {p}");
            }
        }
    }

    #[test]
    fn what_is_between_keeps_a_pattern_apart() {
        let ball = |x: f64| leaf(true, "ball", Leaf::sphere(DVec3::X * x, 2.0));
        let leaves = [ball(0.0), ball(10.0), cut("hole", 0.0, 0.0), ball(20.0)];
        let (solid, patterns) = repeated(&leaves, 30.0).unwrap();
        assert!(patterns.is_empty());
        assert_eq!(solid.to_string().matches("ball").count(), 3, "{solid}");
    }
}
