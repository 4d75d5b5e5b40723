//! The leaf's values: those of the distance, held by the way to the membrane where there is one.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::super::SurfaceDistance;
use super::MeshLeaf;
use super::rim::Membrane;
use crate::kernel::{Element, distinct, repeat};
use crate::leaf::bounds_by_support;
use crate::{
    AnyField, Bounds, COORDINATE_LIMIT, Chunk, Dual, Facets, Interval, Layer, ParamError, Placement, VALUE_LIMIT, Way,
    Zone, bits, steep_slopes,
};
use rvachev_num::symbol::Symbol;

/// Normals of stored triangles are off by less.
const ROUNDING: f64 = 1e-6;

impl MeshLeaf {
    /// The value of a point, given the distance from the triangles and what is known of the
    /// membrane.
    fn held(distance: f64, (side, way): (f64, f64)) -> f64 {
        let size = distance.min(way);
        if side > 0.0 {
            size
        } else if side < 0.0 {
            -size
        } else {
            0.0
        }
    }

    /// Values where there are openings, point by point.
    fn open<E: Element>(&self, membrane: &Membrane, points: [&[E]; 3], placement: &Placement, out: &mut [E]) {
        let own = distinct(points);
        for at in 0..own {
            let p = placement.apply([points[0][at], points[1][at], points[2][at]].map(E::to_f64));
            out[at] = E::from_f64(placement.finish(self.open_value(membrane, DVec3::from_array(p))));
        }
        repeat(out, own);
    }

    fn open_value(&self, membrane: &Membrane, p: DVec3) -> f64 {
        let distance = self.patches().distance(p).unwrap_or(VALUE_LIMIT).min(VALUE_LIMIT);
        MeshLeaf::held(distance, membrane.side(p, distance))
    }

    /// Value and derivatives where there are openings.
    fn open_jet(&self, membrane: &Membrane, p: [f64; 3]) -> (f64, [f64; 3]) {
        let at = DVec3::from_array(p);
        let distance = self.patches().distance(at).unwrap_or(VALUE_LIMIT);
        let (side, way) = membrane.side(at, distance);
        if way < distance {
            return (MeshLeaf::held(way, (side, way)), membrane.slope(at).to_array());
        }
        self.distance.signed_with_slope(p, side)
    }

    /// The unit normals of the triangles in a zone, where these are all of the surface, and few.
    fn normals_in(&self, zone: &Zone) -> Option<Vec<DVec3>> {
        if self.is_open() || !zone.is_finite() {
            return None;
        }
        self.patches().normals_within(zone, self.distance.slack(zone, 0.0))
    }

    /// The leaf with another distance.
    fn with(&self, distance: SurfaceDistance) -> MeshLeaf {
        MeshLeaf { distance, ..self.clone() }
    }
}

impl AnyField for MeshLeaf {
    fn name(&self) -> &'static str {
        "mesh"
    }

    fn signature(&self) -> String {
        let side = self.distance.side;
        format!("{self:?}, {side:?}")
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        // What is kept of the triangles is rounded; what is not turned is known better.
        let own = self.bounds.inflate(self.patches().rounding()).transformed(map);
        // What fills an opening is no triangle.
        if self.membrane.is_some() {
            return own;
        }
        own.intersection(&bounds_by_support(&|direction| self.patches().support(direction), map))
    }

    fn check(&self) -> Result<(), ParamError> {
        if self.is_empty() {
            return Err(ParamError::new("triangles", 0.0, "1 or more"));
        }
        let bounds = self.patches().bounds();
        let far = bounds.min.to_array().into_iter().chain(bounds.max.to_array());
        let farthest = far.fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
        if farthest.abs() > COORDINATE_LIMIT {
            let allowed = format!("{:e} to {COORDINATE_LIMIT:e}; scale the mesh", -COORDINATE_LIMIT);
            return Err(ParamError::new("coordinate", farthest, allowed));
        }
        if let Some(volume) = self.turned {
            let allowed = "above 0; the mesh is inside out, Mesh::flipped turns it";
            return Err(ParamError::new("volume", volume, allowed));
        }
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        self.distance.roundoff(reach)
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        match &self.membrane {
            None => self.distance.value(p),
            Some(membrane) => self.open_value(membrane, DVec3::from_array(p)),
        }
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let Some(membrane) = &self.membrane else { return self.distance.dual(p) };
        let (value, slope) = self.open_jet(membrane, p.map(Dual::value));
        let along = |axis: usize| (0..3).map(|i| slope[i] * p[i].d[axis]).sum();
        Dual::new(value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let zone = Zone::of_sides(p.map(Dual::value));
        Dual::new(AnyField::range(self, &zone), steep_slopes(1.0, p))
    }

    /// A bound where there are openings.
    fn exact(&self) -> bool {
        !self.is_open()
    }

    fn is_faceted(&self) -> bool {
        true
    }

    fn facets(&self) -> Option<Facets> {
        const NONE: u32 = u32::MAX;
        let patches = self.patches();
        let count = self.vertices.iter().flatten().fold(0, |count, vertex| count.max(*vertex as usize + 1));
        let mut places = vec![NONE; count];
        let (mut positions, mut triangles) = (Vec::new(), Vec::with_capacity(patches.len()));
        for (at, number) in patches.numbers.iter().enumerate() {
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
            let mut triangle = self.vertices[*number as usize];
            for (vertex, corner) in triangle.iter_mut().zip(corners) {
                let place = &mut places[*vertex as usize];
                if *place == NONE {
                    *place = positions.len() as u32;
                    positions.push(patches.point(at, corner));
                }
                *vertex = *place;
            }
            triangles.push(triangle);
        }
        Some(Facets { positions, triangles, is_closed: !self.is_open(), rounding: patches.rounding() })
    }

    fn convex(&self) -> bool {
        false
    }

    fn layers(&self, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
        if level != 0.0 {
            return self.distance.layers(zone, level);
        }
        if self.is_open() || !zone.is_finite() {
            return None;
        }
        self.patches().layers(zone, self.distance.slack(zone, 0.0))
    }

    fn is_formula(&self) -> bool {
        false
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn growth(&self) -> DVec3 {
        if self.is_open() { DVec3::INFINITY } else { DVec3::ONE }
    }

    fn range(&self, zone: &Zone) -> Interval {
        let Some(membrane) = &self.membrane else { return self.distance.range(zone) };
        if !zone.is_finite() {
            return Interval::ALL;
        }
        let Some(distance) = self.patches().distance(zone.centre) else { return Interval::ALL };
        let (radius, slack) = (zone.radius(), self.distance.slack(zone, distance));
        let most = distance + radius + slack;
        if distance - radius - slack <= 0.0 && self.distance.apart(zone, slack) <= 0.0 {
            return Interval::new(-most, most);
        }
        let (side, way) = membrane.side(zone.centre, distance.max(2.0 * (radius + slack)));
        if way - radius - slack <= 0.0 {
            return Interval::new(-most, most);
        }
        // The sign is certain; how large the value is, less: the rim is seen box by box.
        if side > 0.0 { Interval::new(f64::MIN_POSITIVE, most) } else { Interval::new(-most, -f64::MIN_POSITIVE) }
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        if self.is_open() { 0 } else { self.distance.rises(zone, ways) }
    }

    /// Along a line the winding number grows where it passes triangles from in front, and changes
    /// nowhere else.
    fn enters(&self, zone: &Zone, ways: &[Way], level: f64) -> u8 {
        let normals = if level == 0.0 { self.normals_in(zone) } else { None };
        let is_entered = |way: Way| {
            let least = way.sway + ROUNDING * way.middle.length();
            normals.as_ref().is_some_and(|normals| normals.iter().all(|normal| -normal.dot(way.middle) > least))
        };
        let found = bits(ways, is_entered);
        if self.is_open() || found == bits(ways, |_| true) {
            found
        } else {
            found | self.distance.enters(zone, ways, level)
        }
    }

    fn inward(&self, zone: &Zone) -> Option<DVec3> {
        (-self.normals_in(zone)?.iter().sum::<DVec3>()).try_normalize()
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        if self.is_open() {
            return None;
        }
        self.distance.narrowed_to(zone).map(|distance| Arc::new(self.with(distance)) as Arc<dyn AnyField>)
    }

    /// What is searched for fits no tree, and is not asked for one.
    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        p[0]
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        self.lanes32_within(chunk, f64::INFINITY);
    }

    fn lanes32_within(&self, chunk: Chunk<'_, f32, 1>, band: f64) {
        match &self.membrane {
            None => self.distance.lanes32_within(chunk, band),
            Some(membrane) => {
                let Chunk { points, placement, out: [out] } = chunk;
                self.open(membrane, points, placement, out);
            }
        }
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        match &self.membrane {
            None => self.distance.lanes64(chunk),
            Some(membrane) => {
                let Chunk { points, placement, out: [out] } = chunk;
                self.open(membrane, points, placement, out);
            }
        }
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Some(membrane) = &self.membrane else { return self.distance.gradients(chunk) };
        let Chunk { points: [x, y, z], placement, out } = chunk;
        let own = distinct([x, y, z]);
        for at in 0..own {
            let p = placement.apply([x[at], y[at], z[at]].map(f64::from));
            let (value, slope) = self.open_jet(membrane, p);
            let pulled = placement.pull(slope.map(|part| part * placement.scale));
            out[0][at] = placement.finish(value) as f32;
            for (axis, part) in pulled.into_iter().enumerate() {
                out[1 + axis][at] = part as f32;
            }
        }
        out.into_iter().for_each(|column| repeat(column, own));
    }

    fn cost(&self) -> usize {
        if self.is_open() { 64 } else { 8 }
    }

    fn parts(&self) -> &[u32] {
        self.owners.as_ref().map_or(&[], |owners| &owners.numbers)
    }

    fn part(&self, p: DVec3) -> usize {
        self.part_near(p)
    }

    fn is_colored(&self) -> bool {
        self.colors.is_some()
    }

    fn color(&self, p: DVec3) -> Option<[u8; 3]> {
        self.color_near(p)
    }
}
