//! Models for fidget, negative inside, written with as few operations as its instruction set
//! allows.

use fidget::context::Tree;
use glam::DVec3;

use super::models::{self, Model};

/// The model for fidget, negative inside, with as few operations as it takes.
pub fn lean(model: &Model) -> Option<Tree> {
    let set = models::set(model.name)?;
    let min = |v: DVec3| v.min_element() as f32;
    let solids: Vec<Tree> =
        set.solids.iter().map(|s| superellipsoid(s.semi_axes, s.exponents, &s.inverse(), min(s.semi_axes))).collect();
    let (united, subtracted) = solids.split_at(set.united);
    let smooth = matches!(model.name, "M3" | "M5");
    // Negative inside: a union is the minimum, and R_p with p = 2 is x + y − √(x² + y²).
    let or = |x: Tree, y: Tree| match smooth {
        true => x.clone() + y.clone() - (x.square() + y.square()).sqrt(),
        false => x.min(y),
    };
    let and = |x: Tree, y: Tree| match smooth {
        true => x.clone() + y.clone() + (x.square() + y.square()).sqrt(),
        false => x.max(y),
    };
    let balanced = |trees: &[Tree]| {
        let mut level = trees.to_vec();
        while level.len() > 1 {
            level = level.chunks(2).map(|pair| pair.iter().cloned().reduce(or).expect("one or two")).collect();
        }
        level.pop()
    };
    let union = balanced(united)?;
    Some(subtracted.iter().fold(union, |all, hole| and(all, -hole.clone())))
}

pub fn superellipsoid(a: DVec3, [e1, e2]: [f64; 2], to_local: &glam::DAffine3, size: f32) -> Tree {
    let (x, y, z) = Tree::axes();
    let rows = to_local.matrix3.transpose();
    let axis = |i: usize| {
        let (row, offset) = (rows.col(i), to_local.translation[i]);
        if row[i] == 1.0 && offset == 0.0 {
            return [x.clone(), y.clone(), z.clone()][i].clone();
        }
        x.clone() * row.x as f32 + y.clone() * row.y as f32 + z.clone() * row.z as f32 + offset as f32
    };
    // |t/a|^p, guarded against the logarithm of 0.
    let power = |t: Tree, p: f64| ((t.max(1e-30f32)).ln() * p as f32).exp();
    let term = |i: usize, p: f64| power((axis(i) * (1.0 / a[i]) as f32).abs(), p);
    let rho = term(0, 2.0 / e2) + term(1, 2.0 / e2);
    let gauge = power(power(rho, e2 / e1) + term(2, 2.0 / e1), 0.5 * e1);
    (gauge - 1.0) * size
}
