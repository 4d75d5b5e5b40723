//! Offsets of planes along the axes of frames, between which boxes are looked for.

use glam::{DMat3, DVec3};
use rvachev_num::order;

use super::boxes::{Grid, MOST};
use super::queries::Queries;
use super::regions::{Form, Region};

/// Normals off an axis by less than this are along it, as a cosine: 2°.
const ALONG: f64 = 0.9994;

/// Offsets nearer to each other are one.
const SAME: f64 = 0.002;

/// The grid of a frame: its planes first, then what cylinders and spheres touch, then their
/// centres, larger regions first.
pub(super) fn grid(frame: DMat3, regions: &[Region], points: &[DVec3], queries: &Queries) -> Grid {
    let offsets = [0, 1, 2].map(|k| along(frame.col(k), regions, points));
    Grid::new(frame, offsets, queries)
}

fn along(axis: DVec3, regions: &[Region], points: &[DVec3]) -> Vec<f64> {
    let mut found: Vec<(u32, f64, f64)> = Vec::new();
    for region in regions {
        let mut tangent = |centre: DVec3, radius: f64| {
            let at = centre.dot(axis);
            found.extend([(1, region.share, at - radius), (1, region.share, at + radius)]);
            found.push((2, region.share, at));
        };
        match region.form {
            Form::Plane { normal, offset } => {
                let cosine = normal.dot(axis);
                if cosine.abs() > ALONG {
                    found.push((0, region.share, offset / cosine));
                }
            }
            Form::Cylinder { axis: other, origin, radius, .. } if other.dot(axis).abs() < 0.03 => {
                tangent(origin, radius);
            }
            Form::Cylinder { axis: other, origin, along, .. } if other.dot(axis).abs() > ALONG => {
                let (at, step) = (origin.dot(axis), other.dot(axis));
                found.extend(along.map(|end| (2, region.share, at + step * end)));
            }
            Form::Sphere { centre, radius } => tangent(centre, radius),
            _ => {}
        }
    }
    // The sort is stable: where shares are equal the order of the regions decides.
    found.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        let at = p.dot(axis);
        (low.min(at), high.max(at))
    });
    let mut kept: Vec<f64> = Vec::new();
    let mut keep = |at: f64, most: usize| {
        if kept.len() < most && kept.iter().all(|other| (other - at).abs() > SAME) {
            kept.push(at);
        }
    };
    let planes = found.iter().take_while(|found| found.0 == 0).map(|found| found.2);
    planes.for_each(|at| keep(at, MOST - 2));
    keep(low, MOST);
    keep(high, MOST);
    found.iter().filter(|found| found.0 > 0).for_each(|found| keep(found.2, MOST));
    order::numbers(&mut kept);
    kept
}
