//! Where a solid is entered once along every line of a direction.
//!
//! ```text
//!     -----.            Along w both faces are entered. All joins rise with their operands, so along w
//!           \   w -->   the whole rises: its surface does not turn round here.
//!     -------`----
//! ```
//!
//! A direction is guessed from the gradients in the middle of a region; that all leaves rise along
//! it is shown of each [by itself](rvachev_field::AnyField::rises), as they see it: through a
//! deformation it may be any within a cone.

use glam::DVec3;

use super::program::{Kind, Program};
use super::scene::Instance;
use crate::{Bounds, Dual, Interval};
use rvachev_field::{AnyField, AnyWarp, Pieces, Placement, Rule, Way, Zone, bits, dot, largest_stretch, steepest};

/// A leaf, and whether its complement counts.
#[derive(Clone, Copy)]
struct Part {
    leaf: u32,
    negated: bool,
}

impl Part {
    /// What is said of the leaf, as what is said of what counts.
    fn turned(self, way: DVec3) -> DVec3 {
        if self.negated { -way } else { way }
    }
}

/// The sine of 8.6°: the value is to rise along all directions within that angle of one. Two faces
/// of a fin or a slot with a draft rise along a direction as well, but not along all of those if it
/// is thin.
///
/// ```text
///        .  o        Where all normals are within 81° of w, what is d beyond a tip, along w, holds a ball of radius
///     o  |     o     0.15 d: within six cells of the tip, at most, it holds a node.
///        |\    w
/// ```
const CONE: f64 = 0.15;

/// A slope within a plane that is less is that of a face beside it.
const FLAT: f64 = 1e-6;

/// The tangent of 30°.
const LEAN: f64 = 0.577;

/// Of unit vectors with a smaller product none is within 60° of both.
const APART: f64 = -0.5;

/// A slope that is less is rounding.
const LEVEL: f64 = 1e-12;

/// How far beyond a zone it is seen whether a convex leaf is entered, in radii of the zone.
const BEYOND: [f64; 3] = [1.2, 3.0, 8.0];

/// How often a direction is turned towards the part that rises least along it.
const TURNS: usize = 16;

impl Program {
    /// Whether a direction is found such that along it, and all close to it, the solid is entered,
    /// and not left, throughout these regions.
    pub(crate) fn is_entered_once(&self, regions: &[Bounds]) -> bool {
        self.way_in(regions).is_some()
    }

    /// Such a direction.
    fn way_in(&self, regions: &[Bounds]) -> Option<DVec3> {
        let parts = self.parts()?;
        let whole = regions.iter().fold(Bounds::EMPTY, |all, region| all.union(region));
        let guesses = self.guesses(&parts, whole.center());
        let rising = |guesses: &[DVec3]| {
            let ways: Vec<Way> = guesses.iter().map(|&middle| Way { middle, sway: CONE }).collect();
            let mut left = u8::MAX;
            for region in regions {
                if left == 0 {
                    break;
                }
                let world = Pieces::one(Zone::of_bounds(region));
                left &= self.all_rise(&parts, (&self.zones(&world), &world), &ways);
            }
            guesses.get(left.trailing_zeros() as usize).copied()
        };
        // The first guess does most often; edges that pass beside the middle show at the corners.
        let (first, others) = guesses.split_at(guesses.len().min(1));
        let by_corners = || {
            let corner =
                |n: usize| whole.min + whole.size() * DVec3::from_array([0, 1, 2].map(|i| (n >> i & 1) as f64));
            let slopes: Vec<DVec3> = (0..8).flat_map(|n| self.slopes_at(&parts, corner(n))).collect();
            rising(&common(&slopes).into_iter().collect::<Vec<_>>())
        };
        rising(first).or_else(|| rising(others)).or_else(by_corners)
    }

    /// Unit vectors along the gradients of parts at a point.
    fn slopes_at(&self, parts: &[Part], p: DVec3) -> Vec<DVec3> {
        let p = Dual::point(p.to_array());
        let frames = self.frame_points(p);
        let mut slopes = Vec::with_capacity(parts.len());
        for part in parts {
            let seen = self.in_frame(&frames, self.instance(part.leaf).frame, p);
            let slope = DVec3::from_array(self.leaf(part.leaf, seen).d);
            slopes.push(part.turned(slope).normalize_or_zero());
        }
        slopes
    }

    /// The direction along which a part's surface tells that a zone is entered.
    fn inward(&self, part: Part, zone: &Zone) -> Option<DVec3> {
        let Instance { field, frame, to_local, .. } = self.instance(part.leaf);
        let inward = field.inward(&zone.mapped(to_local)).filter(|_| *frame == 0)?;
        (to_local.matrix3.transpose() * part.turned(inward)).try_normalize()
    }

    /// A unit vector within a plane, of these axes, such that along all directions within 30° of it
    /// the solid is entered, and not left, throughout a zone.
    pub(crate) fn way_in_plane(&self, zone: &Zone, axes: [DVec3; 2]) -> Option<DVec3> {
        let Some(parts) = self.parts() else { return self.rise_in_plane(zone, axes) };
        // A face that lies beside the plane has no slope in it, and tells nothing there.
        let within = |slope: DVec3| {
            let slope = axes.map(|axis| slope.dot(axis) * axis).into_iter().sum::<DVec3>();
            (slope.length() > FLAT).then(|| slope.normalize())
        };
        let at = |p: DVec3| self.slopes_at(&parts, p).into_iter().filter_map(within);
        // Edges that pass beside the middle show at the corners, and what turns round within the
        // zone: it is not worth a proof.
        let corner = |x: f64, y: f64| zone.centre + x * zone.axes.x_axis + y * zone.axes.y_axis;
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)];
        let around: Vec<DVec3> = corners.into_iter().flat_map(at).collect();
        let are_apart = |a: &DVec3| around.iter().any(|b| a.dot(*b) < APART);
        if around.iter().any(are_apart) {
            return self.rise_in_plane(zone, axes);
        }
        let world = Pieces::one(*zone);
        let zones = self.zones(&world);
        let entered = |way: DVec3| {
            let middle = within(way)?;
            // What rises along two directions does so along all between them.
            let across = middle.cross(axes[0].cross(axes[1]));
            let ways = [-LEAN, LEAN].map(|lean| Way { middle: middle + lean * across, sway: 0.0 });
            (self.all_enter(&parts, (&zones, &world), &ways, 0.0) == 3).then_some(middle)
        };
        let middle: Vec<DVec3> = at(zone.centre).collect();
        let of_middle = common(&middle).filter(|way| around.iter().all(|slope| slope.dot(*way) > 0.0));
        let inward = || {
            let inward: Vec<DVec3> =
                parts.iter().filter_map(|part| self.inward(*part, zone)).filter_map(within).collect();
            common(&inward).and_then(entered)
        };
        let guess = of_middle.or_else(|| common(&around));
        guess.and_then(entered).or_else(inward).or_else(|| self.rise_in_plane(zone, axes))
    }

    /// The same as the slopes of the whole tell it: in the neck of a smooth join no direction leads
    /// into both operands, but the join rises along one.
    fn rise_in_plane(&self, zone: &Zone, axes: [DVec3; 2]) -> Option<DVec3> {
        let is_blend = |kind: &Kind| matches!(kind, Kind::Join { rule, .. } if *rule != Rule::MinMax);
        if !self.nodes.iter().any(|node| is_blend(&node.kind)) {
            return None;
        }
        let slope = self.gradient(zone.centre).1;
        let middle = axes.map(|axis| slope.dot(axis) * axis).into_iter().sum::<DVec3>().try_normalize()?;
        let across = middle.cross(axes[0].cross(axes[1]));
        let [one, other] = [-LEAN, LEAN].map(|lean| (middle + lean * across).to_array().map(Interval::point));
        let (hull, level) = (zone.hull(), Interval::point(0.0));
        let seen = [0, 1, 2].map(|axis| Dual::new(hull[axis], [one[axis], other[axis], level]));
        let [one, other, _] = self.evaluate(seen, &mut Vec::new()).gradient();
        (one.lo() > 0.0 && other.lo() > 0.0).then_some(middle)
    }

    /// The directions, of up to eight, along which what is above a level is found to be entered, and
    /// not left, throughout a zone.
    pub(crate) fn enters(&self, zone: &Zone, ways: &[Way], level: f64) -> u8 {
        let world = Pieces::one(*zone);
        self.parts().map_or(0, |parts| self.all_enter(&parts, (&self.zones(&world), &world), ways, level))
    }

    /// The same of these parts.
    fn all_enter(&self, parts: &[Part], seen: (&[Pieces], &Pieces), ways: &[Way], level: f64) -> u8 {
        // Joins of other rules, and shifts, ask more of a part than its sign.
        let is_sign = |kind: &Kind| match kind {
            Kind::Leaf(_) => true,
            Kind::Join { rule, .. } => *rule == Rule::MinMax,
            Kind::Shift(_) => false,
        };
        let by_sign = self.nodes.iter().all(|node| is_sign(&node.kind));
        self.all_along(parts, seen, ways, |negated, instance, zone, ways| {
            let is_all = |found: u8| found.count_ones() as usize == ways.len();
            let (field, Placement { scale, shift, .. }) = (&*instance.field, &instance.placement);
            let level = if negated { -level } else { level };
            let level = by_sign.then(|| (level - shift) / scale);
            let by_beyond = |level: f64| bits(ways, |way| is_entered(field, zone, way, level));
            let found = level.filter(|_| field.convex()).map_or(0, by_beyond);
            let found = match level {
                _ if is_all(found) => found,
                Some(level) => found | field.enters(zone, ways, level),
                None => found | field.rises(zone, ways),
            };
            if is_all(found) {
                return found;
            }
            // What a value does not depend on neither enters nor leaves.
            let slopes = instance.field.dual_range(Dual::point(zone.hull())).d;
            let is_level = |way: Way| {
                let along = dot(slopes, way.middle.to_array().map(Interval::point)).magnitude();
                along + way.sway * steepest(slopes) <= LEVEL * way.middle.length()
            };
            found | bits(ways, is_level)
        })
    }

    /// The directions, of up to eight, along which the value is found to rise, or to stay,
    /// throughout a zone.
    pub(super) fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        let world = Pieces::one(*zone);
        self.parts().map_or(0, |parts| self.all_rise(&parts, (&self.zones(&world), &world), ways))
    }

    /// A bound of the length of the gradient over a region.
    pub(crate) fn steepest(&self, region: &Bounds) -> f64 {
        let zone = Zone::of_bounds(region);
        let is_plain = |kind: &Kind| match kind {
            Kind::Join { rule, .. } => matches!(rule, Rule::MinMax | Rule::Smooth(_)),
            _ => true,
        };
        let Some(parts) = self.parts().filter(|_| self.nodes.iter().all(|node| is_plain(&node.kind))) else {
            return f64::INFINITY;
        };
        let p = Dual::point(zone.hull());
        let frames = self.frame_points(p);
        let of_part = |part: &Part| {
            let Instance { field, frame, to_local, placement, .. } = self.instance(part.leaf);
            if *frame == 0 {
                return placement.scale * largest_stretch(&to_local.matrix3) * field.steepest(&zone.mapped(to_local));
            }
            steepest(self.leaf(part.leaf, self.in_frame(&frames, *frame, p)).d)
        };
        // Where a slope is not told, it may be any.
        let steeper = |a: f64, b: f64| if b.is_nan() { f64::INFINITY } else { a.max(b) };
        parts.iter().map(of_part).fold(0.0, steeper)
    }

    /// No radius of curvature of the surface is less than this; 0 where it may have creases. It is
    /// told of single leaves.
    pub(crate) fn least_radius(&self) -> f64 {
        let (Kind::Leaf(leaf), false) = (&self.nodes[self.root.node()].kind, self.root.negated()) else { return 0.0 };
        let Instance { field, frame, to_local, placement, .. } = self.instance(*leaf);
        if *frame != 0 || placement.shift != 0.0 {
            return 0.0;
        }
        // A map that stretches by s at least and by t at most makes of a radius r one of r s² / t
        // or more.
        let [most, least] = [to_local.matrix3, to_local.matrix3.inverse()].map(|map| largest_stretch(&map));
        field.least_radius() / (most * most * least)
    }

    /// Ranges of the derivatives over a region.
    pub(crate) fn slopes(&self, region: &Bounds) -> [Interval; 3] {
        self.evaluate(Dual::point(Zone::of_bounds(region).hull()), &mut Vec::new()).d
    }

    /// The leaves that values come from; `None` if one of them counts both as it is and as its
    /// complement, or if they are joined in a way that need not rise with them.
    fn parts(&self) -> Option<Vec<Part>> {
        let mut met = vec![[false; 2]; self.nodes.len()];
        met[self.root.node()][usize::from(self.root.negated())] = true;
        let mut parts = Vec::new();
        for (at, node) in self.nodes.iter().enumerate().rev() {
            let [plain, negated] = met[at];
            if plain && negated {
                return None;
            }
            if !(plain || negated) {
                continue;
            }
            match &node.kind {
                Kind::Leaf(leaf) => parts.push(Part { leaf: *leaf, negated }),
                Kind::Join { rule, .. } if !rule.rises() => return None,
                Kind::Join { .. } | Kind::Shift(_) => {
                    for edge in self.list(node) {
                        met[edge.node()][usize::from(edge.negated() != negated)] = true;
                    }
                }
            }
        }
        Some(parts)
    }

    /// Directions that may do: by the gradients at a point, then those of them along an axis, and
    /// with the ways to the middles of leaves in place of the gradients.
    fn guesses(&self, parts: &[Part], from: DVec3) -> Vec<DVec3> {
        let slopes = self.slopes_at(parts, from);
        let inwards = |part: &Part| {
            let Instance { frame, bounds, .. } = self.instance(part.leaf);
            let is_known = *frame == 0 && bounds.is_finite();
            is_known.then(|| part.turned(bounds.center() - from).normalize_or_zero())
        };
        let known: Vec<DVec3> = parts.iter().filter_map(inwards).collect();
        let mut guesses: Vec<DVec3> = common(&slopes).into_iter().collect();
        let Some(first) = slopes.first() else { return guesses };
        for axis in DVec3::AXES {
            let along = axis * first.dot(axis).signum();
            if slopes.iter().all(|slope| slope.dot(along) > 0.1) {
                guesses.push(along);
            }
        }
        // Towards the middles of all.
        guesses.extend(common(&known).filter(|_| known.len() == parts.len()));
        guesses
    }

    /// The directions of the world along which all parts rise, throughout its zone and those of the
    /// frames.
    fn all_rise(&self, parts: &[Part], seen: (&[Pieces], &Pieces), ways: &[Way]) -> u8 {
        self.all_along(parts, seen, ways, |_, instance, zone, ways| instance.field.rises(zone, ways))
    }

    /// The directions along which something is true of all parts, as they see them.
    fn all_along(
        &self,
        parts: &[Part],
        (zones, world): (&[Pieces], &Pieces),
        ways: &[Way],
        holds: impl Fn(bool, &Instance, &Zone, &[Way]) -> u8,
    ) -> u8 {
        // The directions as the frames see them.
        let mut seen: Vec<Vec<Way>> = Vec::with_capacity(self.frames.len());
        for &number in &self.frames[..] {
            let Some(frame) = self.scene.frame(number) else { continue };
            let above = self.frames.binary_search(&frame.parent).map_or(ways, |slot| &seen[slot]);
            let above: Vec<Way> = above.iter().map(|way| way.mapped(&frame.to_local.matrix3)).collect();
            let mut own: Vec<Way> = Vec::new();
            self.zone_in(zones, frame.parent, world).each(|zone| {
                let hull = zone.mapped(&frame.to_local).hull();
                let mut see = |warp: &dyn AnyWarp| {
                    let rows = warp.dual_ranges(Dual::point(hull)).map(|side| side.d);
                    let images = above.iter().map(|way| way.seen_through(rows));
                    if own.is_empty() {
                        own = images.collect();
                    } else {
                        own.iter_mut().zip(images).for_each(|(own, image)| *own = own.hull(image));
                    }
                };
                match frame.warp.sheets(hull) {
                    Some(sheets) => sheets.iter().for_each(|sheet| see(&**sheet)),
                    None => see(&*frame.warp),
                }
            });
            seen.push(own);
        }
        let mut left = u8::MAX;
        for part in parts {
            if left == 0 {
                break;
            }
            let instance = self.instance(part.leaf);
            let Instance { frame, to_local, .. } = instance;
            let ways = self.frames.binary_search(frame).map_or(ways, |slot| &seen[slot]);
            let own: Vec<Way> = ways.iter().map(|way| way.mapped(&to_local.matrix3).flip_if(part.negated)).collect();
            self.zone_in(zones, *frame, world)
                .each(|zone| left &= holds(part.negated, instance, &zone.mapped(to_local), &own));
        }
        left
    }
}

/// Whether what is above a level of a convex leaf is entered along these directions, and not left,
/// throughout a zone: what is beyond is all inside. (A complement is left by them, so its
/// directions are turned.)
fn is_entered(field: &dyn AnyField, zone: &Zone, Way { middle, sway }: Way, level: f64) -> bool {
    let scale = zone.radius() / middle.length();
    let [a, b, c] = [zone.axes.x_axis, zone.axes.y_axis, zone.axes.z_axis];
    BEYOND.iter().any(|by| {
        let centre = zone.centre + by * scale * middle;
        // The value of a convex leaf changes by no more than 1 per length unit.
        let least = level + zone.slack.length() + by * scale * sway;
        let is_inside = |p: DVec3| field.value(p.to_array()) > least;
        let layer = |c: DVec3| [a + b, a - b, -a + b, -a - b].into_iter().all(|side| is_inside(centre + side + c));
        if c == DVec3::ZERO { layer(c) } else { layer(c) && layer(-c) }
    })
}

/// A direction at less than a right angle to all of these, if one is found.
fn common(ways: &[DVec3]) -> Option<DVec3> {
    let mut sum: DVec3 = ways.iter().sum();
    for _ in 0..TURNS {
        let least = ways.iter().min_by(|a, b| a.dot(sum).total_cmp(&b.dot(sum)))?;
        if least.dot(sum) > 0.6 * sum.length() {
            break;
        }
        sum += *least;
    }
    let is_common = ways.iter().all(|way| way.dot(sum) > 0.0);
    sum.try_normalize().filter(|_| is_common)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec2;

    use super::*;
    use crate::distance::compiled;
    use crate::eval::Region;
    use crate::{Blend, Helix, MinimalSurface, Polygon, Profile, SheetLattice, Solid, rad};

    /// Once in the solid, a ray along the direction, or close to it, stays in it.
    #[test]
    fn what_is_entered_once_is_not_left() {
        let cube = Solid::cuboid(DVec3::new(1.0, 0.8, 0.6)).rotate(glam::DQuat::from_rotation_x(0.5));
        let cushion =
            Solid::superellipsoid(DVec3::new(0.7, 0.5, 0.4), 0.3, 1.6).rotate(glam::DQuat::from_rotation_y(1.1));
        let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: 0.15 };
        let rod = Solid::cylinder(0.2, 2.0);
        let star = (0..10).map(|n| DVec2::from_angle(f64::from(n) * 0.2 * PI) * if n % 2 == 0 { 0.8 } else { 0.4 });
        let solids = [
            &cube - &rod,
            &cube | cushion.translate(DVec3::X * 0.4),
            cushion.twist(rad(0.9)).bend(0.4, rad(0.3)),
            Solid::torus(0.6, 0.2) ^ &rod,
            Solid::from(gyroid),
            Profile::from(Polygon::new([star])).extrude(1.2),
            Profile::circle(0.12).sweep_helix(&Helix::new(0.4, 0.4, 2.0)) | &rod,
            cube.union_with(&rod, Blend::Chamfer { leg: 0.15 }),
            cushion.offset(0.05),
            cube.shell(0.1),
            cube.union_with(&rod, Blend::Fillet { radius: 0.15 }),
            cushion.translate(DVec3::X * 0.3).union_with(&cube, Blend::Fillet { radius: 0.15 }),
            cushion.union_with(&rod, Blend::Chamfer { leg: 0.15 }),
            (&cube | &rod).filleted(0.1).rounded(0.05),
        ];
        let mut state = 5u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for (number, solid) in solids.iter().enumerate() {
            let program = &compiled(solid).unwrap().surface;
            let (mut told, mut crossed) = (0, 0);
            for n in 0..12_000 {
                let centre = DVec3::new(random(), random(), random()) * 2.0 - 1.0;
                let region = Bounds::from_center(centre, DVec3::splat(0.005 * f64::powi(2.0, n % 6)));
                let Region::Surface(narrowed) = program.narrow(&region) else { continue };
                let Some(way) = narrowed.way_in(&[region]) else { continue };
                told += 1;
                for _ in 0..40 {
                    let p = region.min + region.size() * DVec3::new(random(), random(), random());
                    // Any of the directions that are promised.
                    let aside = DVec3::new(random(), random(), random()) * 2.0 - 1.0;
                    let way = way + aside.clamp_length_max(1.0) * CONE;
                    let q = p + way * (random() * 0.5 * region.size().x);
                    if region.contains(q) {
                        let (before, after) = (narrowed.value(p), narrowed.value(q));
                        assert!(
                            before < 1e-9 || after > -1e-9,
                            "{number}: {before} at {p}, {after} at {q}, {region:?}"
                        );
                        crossed += usize::from(before < 0.0 && after > 0.0);
                    }
                }
            }
            assert!(told > 30 && crossed > 60, "{number}: {told} {crossed}");
        }
    }
}
