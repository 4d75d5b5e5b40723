//! The tree of a part's leaves, with patterns as one leaf that is repeated.
//!
//! ```text
//!     − cut cylinder 2                          − cut cylinder 2, in a ring of 4
//!     − cut cylinder 3         →
//!     − cut cylinder 4         of leaves that are added, or cut, one after the other: their order
//!     − cut cylinder 5         among each other is of no matter
//! ```

use glam::DVec3;

use super::measures::tidy;
use super::patterns::{Layout, Pattern, patterns_of};
use super::result::PartLeaf;
use super::topology::tree;
use crate::Solid;

/// How far a leaf may be from where the rule has it, in diagonals: what vertices leave open.
const PLACED: f64 = 1e-4;

/// The solid of leaves, in the order in which they are added and cut, for a part of such a size.
pub(super) fn solid_of(leaves: &[PartLeaf], size: f64) -> Option<Solid> {
    let named = |leaf: &PartLeaf| leaf.leaf.solid().named(&leaf.name);
    // Which run of leaves that are all added, or all cut, each is in.
    let runs: Vec<usize> = (leaves.iter())
        .scan((0, true), |(run, adds), leaf| {
            *run += usize::from(leaf.adds != *adds);
            *adds = leaf.adds;
            Some(*run)
        })
        .collect();
    let mut solids: Vec<Option<Solid>> = leaves.iter().map(|leaf| Some(named(leaf))).collect();
    for Pattern { leaves: mut members, layout } in patterns_of(leaves, size) {
        if let Layout::Ring { .. } = layout {
            // A ring may begin anywhere: where its numbers are shortest.
            let length = |k: &usize| format!("{:?}", leaves[members[*k]].leaf.centre).len();
            let shortest = (0..members.len()).min_by_key(length).unwrap_or(0);
            members.rotate_left(shortest);
        }
        let first = &leaves[members[0]];
        if members.iter().any(|i| runs[*i] != runs[members[0]]) {
            continue;
        }
        let places: Vec<DVec3> = members.iter().map(|i| leaves[*i].leaf.centre).collect();
        let Some(repeated) = repeated(&layout, &places, first, size).map(|repeat| repeat(named(first))) else {
            continue;
        };
        // What cannot be repeated stays as it is.
        if repeated.bounds().is_ok() {
            members.iter().for_each(|i| solids[*i] = None);
            solids[members[0]] = Some(repeated);
        }
    }
    tree(leaves.iter().zip(solids).filter_map(|(leaf, solid)| Some((leaf.adds, solid?))))
}

/// How the first leaf of a pattern becomes all of them; none if some are not where the rule has them.
fn repeated(layout: &Layout, places: &[DVec3], first: &PartLeaf, size: f64) -> Option<Box<dyn Fn(Solid) -> Solid>> {
    let is_placed = |rule: &dyn Fn(usize) -> DVec3| {
        places.iter().enumerate().all(|(k, place)| place.distance(rule(k)) < PLACED * size)
    };
    match *layout {
        Layout::Ring { centre, axis, .. } => {
            let count = u32::try_from(places.len()).ok()?;
            // Copies are turned, which is to be seen of what is not round; only rings about z are repeated.
            let is_about_z = first.leaf.is_round() && axis.truncate().length() < 1e-9;
            let centre = DVec3::new(on_axis(centre.x, size), on_axis(centre.y, size), 0.0);
            let sector = std::f64::consts::TAU / f64::from(count) * axis.z.signum();
            let rule = |k: usize| {
                let (sin, cos) = (sector * k as f64).sin_cos();
                let d = places[0] - centre;
                centre + DVec3::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y, d.z)
            };
            (is_about_z && is_placed(&rule)).then(|| -> Box<dyn Fn(Solid) -> Solid> {
                if centre == DVec3::ZERO {
                    Box::new(move |solid| solid.repeat_polar(count))
                } else {
                    Box::new(move |solid| solid.translate(-centre).repeat_polar(count).translate(centre))
                }
            })
        }
        Layout::Line { .. } => {
            let last = places.len() - 1;
            let step = tidied((places[last] - places[0]) / last as f64);
            let rule = |k: usize| places[0] + k as f64 * step;
            is_placed(&rule).then(|| -> Box<dyn Fn(Solid) -> Solid> {
                Box::new(move |solid| solid.repeat_linear(last as u32 + 1, step))
            })
        }
        Layout::Grid { counts: [columns, rows], .. } => {
            let along = tidied((places[columns - 1] - places[0]) / (columns - 1) as f64);
            let across = tidied((places[columns * (rows - 1)] - places[0]) / (rows - 1) as f64);
            let rule = |k: usize| places[0] + (k % columns) as f64 * along + (k / columns) as f64 * across;
            is_placed(&rule).then(|| -> Box<dyn Fn(Solid) -> Solid> {
                Box::new(move |solid| solid.repeat_linear(columns as u32, along).repeat_linear(rows as u32, across))
            })
        }
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
    use super::super::leaf::Leaf;
    use super::*;

    fn leaf(adds: bool, name: &str, leaf: Leaf) -> PartLeaf {
        PartLeaf { adds, leaf, name: name.to_owned(), surface: 0.1, seen: 1.0 }
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
            let solid = solid_of(&leaves, 100.0).unwrap();
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
        let solid = solid_of(&leaves, 30.0).unwrap();
        assert_eq!(solid.to_string().matches("ball").count(), 3, "{solid}");
    }
}
