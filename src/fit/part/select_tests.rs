//! The selector alone, on candidates made by hand.

use glam::{DMat3, DVec3};

use super::leaf::Leaf;
use super::model::{Model, Step};
use super::pool::Pool;
use super::queries::{Queries, Strip, Told};
use super::select::Selector;
use crate::{CancelToken, Run};

/// What a parameter costs.
pub(super) const PRICE: f64 = 1.5e-4;

/// A part that is told by steps, asked in its box and about the surfaces of its leaves.
pub(super) fn asked(truth: &[(bool, Leaf)], half: DVec3) -> Queries {
    let is_inside =
        |p: DVec3| truth.iter().fold(false, |inside, (adds, leaf)| if leaf.contains(p) { *adds } else { inside });
    // Samples of the surface: from points in the box along the gradient of each leaf.
    let (mut points, mut normals, mut samples) = (Vec::new(), Vec::new(), Vec::new());
    for (_, leaf) in truth {
        let mut own = Vec::new();
        for p in super::sobol::Sobol::new().take(3000) {
            let p = (2.0 * p - 1.0) * half;
            let normal = leaf.gradient(p);
            let foot = p - leaf.distance(p) * normal;
            let sides = [0.003, -0.003].map(|d| is_inside(foot + d * normal));
            if leaf.distance(foot).abs() < 1e-6 && sides[0] != sides[1] {
                own.push(points.len() as u32);
                points.push(foot);
                normals.push(normal);
            }
        }
        samples.push(own);
    }
    let strips: Vec<Strip<'_>> = samples.iter().map(|samples| Strip { samples, share: 0.2, apart: 0.004 }).collect();
    let winding = |points: &[DVec3]| Ok(points.iter().map(|p| f64::from(u8::from(is_inside(*p)))).collect());
    Queries::new([-half, half], [&points, &normals], &strips, 7, Told::ByWinding, winding).unwrap()
}

fn selected(queries: &Queries, leaves: Vec<(Leaf, [bool; 2], Option<u32>)>) -> (Vec<String>, Model) {
    let mut pool = Pool::new(PRICE);
    for (leaf, may, family) in leaves {
        pool.add(leaf, queries, may, family);
    }
    let mut selector = Selector { pool, queries, grids: Vec::new(), cancel: CancelToken::default() };
    let model = selector.select(Vec::new(), &Run::default()).unwrap();
    let name = |step: &Step| {
        let leaf = &selector.pool.candidates[step.which as usize].leaf;
        format!("{}{}", if step.adds { "+" } else { "-" }, leaf.kind())
    };
    (model.steps.iter().map(name).collect(), model)
}

fn error(queries: &Queries, model: &Model) -> f64 {
    super::bits::differing(&model.state, &queries.inside, &queries.weights)
}

fn rod(radius: f64, ends: [f64; 2]) -> Leaf {
    Leaf::cylinder(DVec3::Z, DVec3::ZERO, radius, ends)
}

const ADD: [bool; 2] = [true, false];
const CUT: [bool; 2] = [false, true];

#[test]
fn a_thin_tube_is_a_cylinder_and_a_bore() {
    let (outer, inner) = (rod(0.3, [-0.2, 0.2]), rod(0.29, [-0.22, 0.22]));
    let queries = asked(&[(true, outer.clone()), (false, inner.clone())], DVec3::new(0.3, 0.3, 0.2));
    let wrong = Leaf::cuboid(DMat3::IDENTITY, [DVec3::splat(-0.2), DVec3::new(0.1, 0.1, 0.2)]);
    let leaves = vec![(outer, ADD, None), (inner, CUT, None), (wrong, ADD, None)];
    let (names, model) = selected(&queries, leaves);
    assert_eq!(names, ["+cylinder", "-cylinder"]);
    assert_eq!(error(&queries, &model), 0.0);
}

#[test]
fn a_boss_is_added_under_the_hole_through_it() {
    // The plate with its hole is found first; the boss then closes the hole unless it is cut again.
    let plate = Leaf::cuboid(DMat3::IDENTITY, [DVec3::new(-0.4, -0.3, -0.1), DVec3::new(0.4, 0.3, 0.0)]);
    let (boss, hole) = (rod(0.15, [-0.1, 0.2]), rod(0.1, [-0.12, 0.22]));
    let truth = [(true, plate.clone()), (true, boss.clone()), (false, hole.clone())];
    let queries = asked(&truth, DVec3::new(0.4, 0.3, 0.2));
    let leaves = vec![(hole, CUT, None), (plate, ADD, None), (boss, ADD, None)];
    let (names, model) = selected(&queries, leaves.clone());
    assert_eq!(names.len(), 3, "{names:?}");
    assert_eq!(error(&queries, &model), 0.0);

    let mut pool = Pool::new(PRICE);
    for (leaf, may, family) in leaves {
        pool.add(leaf, &queries, may, family);
    }
    let mut selector = Selector { pool, queries: &queries, grids: Vec::new(), cancel: CancelToken::default() };
    let found_first = vec![Step { adds: true, which: 1 }, Step { adds: false, which: 0 }];
    let model = selector.select(found_first, &Run::default()).unwrap();
    assert_eq!(error(&queries, &model), 0.0);
    assert_eq!(model.steps.len(), 3);
}

#[test]
fn a_counterbore_is_two_bores() {
    // As one bore through all the wider one is a minimum that no single step leaves.
    let block = Leaf::cuboid(DMat3::IDENTITY, [DVec3::new(-0.3, -0.3, -0.2), DVec3::new(0.3, 0.3, 0.2)]);
    let (wide, narrow) = (rod(0.2, [0.05, 0.22]), rod(0.14, [-0.22, 0.22]));
    let truth = [(true, block.clone()), (false, wide.clone()), (false, narrow.clone())];
    let queries = asked(&truth, DVec3::new(0.3, 0.3, 0.2));
    let through = rod(0.2, [-0.22, 0.22]);
    let leaves = vec![(block, ADD, None), (through, CUT, Some(1)), (wide, CUT, Some(1)), (narrow, CUT, Some(2))];
    let mut pool = Pool::new(PRICE);
    for (leaf, may, family) in leaves.clone() {
        pool.add(leaf, &queries, may, family);
    }
    let mut selector = Selector { pool, queries: &queries, grids: Vec::new(), cancel: CancelToken::default() };
    let stuck = selector.model(vec![Step { adds: true, which: 0 }, Step { adds: false, which: 1 }]);
    let model = selector.improve(stuck, &Run::default()).unwrap();
    assert_eq!(error(&queries, &model), 0.0);
    let (names, model) = selected(&queries, leaves);
    assert_eq!((names.len(), error(&queries, &model)), (3, 0.0));
}
