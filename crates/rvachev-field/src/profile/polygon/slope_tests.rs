//! Slopes on the edges of polygons.

use glam::DVec3;

use super::*;
use crate::Placement;
use crate::kernel::CHUNK;

/// Values are 0 there, and a mesh has its vertices there.
#[test]
fn slopes_on_edges_are_inwards() {
    // An L, each side of it along an axis or at half a right angle, turned and mirrored.
    let corners = [[0.0, 0.0], [8.0, 0.0], [8.0, 4.0], [6.0, 6.0], [4.0, 4.0], [2.0, 4.0], [2.0, 8.0], [0.0, 8.0]];
    for turn in 0..4 {
        let turned = |[x, y]: [f64; 2]| (0..turn).fold(DVec2::new(x, y), |p, _| p.perp());
        let contour = corners.map(turned).to_vec();
        let polygon = Polygon::new([contour.clone()]);
        let middle = |k: usize| 0.5 * (contour[k] + contour[(k + 1) % contour.len()]);
        let points: Vec<DVec2> = (0..contour.len()).map(middle).collect();
        let whole: &dyn AnyField = &polygon;
        let around = Bounds::from_center(points[1].extend(0.0), DVec3::ONE);
        let part = whole.narrowed(&Zone::of_bounds(&around)).expect("few edges are near");
        for (field, points) in [(whole, &points[..]), (&*part, &points[1..2])] {
            for p in points {
                let axis = |v: f64| vec![v as f32; CHUNK];
                let mut out = [(); 4].map(|()| vec![0.0f32; CHUNK]);
                let [v, dx, dy, dz] = &mut out;
                let (x, y, z) = (axis(p.x), axis(p.y), axis(0.0));
                let placement = &Placement::IDENTITY;
                field.gradients(Chunk { points: [&x, &y, &z], placement, out: [v, dx, dy, dz] });
                let single = DVec2::new(f64::from(out[1][0]), f64::from(out[2][0]));
                let slope = field.dual(Dual::point([p.x, p.y, 0.0])).gradient();
                for slope in [single, DVec2::new(slope[0], slope[1])] {
                    let inwards = polygon.border().value(*p + 1e-3 * slope);
                    assert!(slope.length() > 0.99 && inwards > 0.9e-3, "{slope} at {p}, turned {turn} times");
                }
            }
        }
    }
}
