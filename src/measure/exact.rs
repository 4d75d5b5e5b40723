//! Solids that are made of triangles: meshes, and polygons that are extruded.
//!
//! Their surface is known as it is: nothing has to be measured, and nothing is in doubt.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use rvachev_field::{AnyField, Patch, Patches, Polygon};

use super::facets::Facets;
use super::merged::merged;
use crate::eval::{Accuracy, Surface};
use crate::solid::{Node, Sweep};
use crate::{Angle, Bounds, Cancelled, Caps, Extrusion, Profile, Run, Solid};

/// Of polygons that take more triangles the surface is measured.
const MOST: usize = 1 << 18;

/// What counts as touching, as a part of the size.
const TOUCHING: f64 = 1e-4;

/// What lies in a plane to within this part of the size is flat: some more than single precision
/// moves corners by.
const FLAT: f64 = 8.0 * f32::EPSILON as f64;

/// The triangles of a solid, kept with it; nothing if it is not made of such.
struct Kept(Option<Triangles>);

/// The same surface from as few triangles as its flat faces take.
pub(super) struct Few(pub(super) Triangles);

/// A leaf with the triangles that are its surface.
pub(super) struct Known {
    pub(super) field: Arc<dyn AnyField>,
    pub(super) few: Arc<Few>,
}

/// The surface that they are where the solid was moved to, kept with that.
struct There(Arc<Surface>);

/// Triangles that are the surface of a solid.
pub(super) struct Triangles {
    pub(super) all: Vec<[DVec3; 3]>,
    /// How far the surface may be off them.
    pub(super) rounding: f64,
}

impl Triangles {
    /// After a map.
    pub(super) fn placed(&self, map: &DAffine3) -> Facets {
        let triangles = self.all.iter().map(|triangle| placed(triangle, map)).collect();
        Facets::new(triangles, self.rounding * stretch(map))
    }
}

/// The surface of a solid, if triangles are exactly that.
pub(super) fn surface(solid: &Solid, run: &Run) -> Result<Option<Arc<Surface>>, Cancelled> {
    if let Some(there) = solid.shelf().find(|_: &There| true) {
        return Ok(Some(there.0.clone()));
    }
    let (still, map) = at_rest(solid);
    if !matches!(still.node(), Node::Leaf(_) | Node::Swept { .. }) {
        return Ok(None);
    }
    let Some(few) = few(still, run)? else { return Ok(None) };
    let Few(Triangles { all, rounding }) = &*few;
    let patch = |triangle: &[DVec3; 3]| Patch::flat(placed(triangle, &map));
    let patches = Patches::new(&all.iter().map(patch).collect::<Vec<Patch>>(), run)?;
    let bounds = patches.bounds();
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    // Patches are kept in single precision, about their middle.
    let rounding =
        stretch(&map) * rounding + 4.0 * f64::from(f32::EPSILON) * bounds.longest_side() + 4.0 * f64::EPSILON * far;
    // What goes no deeper than this only touches, as where surfaces are measured.
    let touching = Accuracy::of_surface(rounding.max(TOUCHING * bounds.longest_side()), rounding);
    let surface = Arc::new(Surface::new(Arc::new(patches), touching, None).in_doubt(rounding, Vec::new()));
    solid.shelf().keep(Arc::new(There(surface.clone())));
    Ok(Some(surface))
}

/// The triangles of a mesh that was read and moved, if they are exactly its surface.
pub(super) fn facets(solid: &Solid, run: &Run) -> Result<Option<Triangles>, Cancelled> {
    let (still, map) = at_rest(solid);
    let Node::Leaf(_) = still.node() else { return Ok(None) };
    let kept = kept(still, run)?;
    let Kept(Some(own)) = &*kept else { return Ok(None) };
    let facets = own.placed(&map);
    Ok(Some(Triangles { rounding: facets.rounding(), all: facets.triangles }))
}

/// The leaf that was moved to make a solid, if triangles are exactly its surface.
pub(super) fn leaf(solid: &Solid, run: &Run) -> Result<Option<Known>, Cancelled> {
    let (still, _) = at_rest(solid);
    let Node::Leaf(field) = still.node() else { return Ok(None) };
    Ok(few(still, run)?.map(|few| Known { field: field.clone(), few }))
}

/// The triangles of a solid at rest, found once.
fn kept(still: &Solid, run: &Run) -> Result<Arc<Kept>, Cancelled> {
    if let Some(kept) = still.shelf().find(|_: &Kept| true) {
        return Ok(kept);
    }
    let kept = Arc::new(Kept(triangles(still, run)?));
    still.shelf().keep(kept.clone());
    Ok(kept)
}

/// Those of a solid at rest without what divides its flat faces, found once.
fn few(still: &Solid, run: &Run) -> Result<Option<Arc<Few>>, Cancelled> {
    if let Some(few) = still.shelf().find(|_: &Few| true) {
        return Ok(Some(few));
    }
    let kept = kept(still, run)?;
    let Kept(Some(Triangles { all, rounding })) = &*kept else { return Ok(None) };
    let off = FLAT * Bounds::from_points(all.iter().flatten().copied()).longest_side();
    let fewer = merged(all, off, run)?;
    let rounding = rounding + if fewer.len() < all.len() { 4.0 * off } else { 0.0 };
    let few = Arc::new(Few(Triangles { all: fewer, rounding }));
    still.shelf().keep(few.clone());
    Ok(Some(few))
}

/// A triangle after a map, which looks outwards still.
fn placed(triangle: &[DVec3; 3], map: &DAffine3) -> [DVec3; 3] {
    let [a, b, c] = triangle.map(|p| map.transform_point3(p));
    if map.matrix3.determinant() < 0.0 { [a, c, b] } else { [a, b, c] }
}

/// No length grows by more.
fn stretch(map: &DAffine3) -> f64 {
    map.matrix3.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// What was moved to make a solid, and how.
fn at_rest(solid: &Solid) -> (&Solid, DAffine3) {
    let (mut still, mut map) = (solid, DAffine3::IDENTITY);
    loop {
        still = match still.node() {
            Node::Affine { operand, forward, .. } => {
                map *= *forward;
                operand
            }
            Node::Named { operand, .. } | Node::Painted { operand, .. } => operand,
            _ => return (still, map),
        };
    }
}

fn triangles(still: &Solid, run: &Run) -> Result<Option<Triangles>, Cancelled> {
    match still.node() {
        Node::Leaf(field) => {
            let found = Facets::of(&**field, &DAffine3::IDENTITY, run)?;
            Ok(found.map(|found| Triangles { rounding: found.rounding(), all: found.triangles }))
        }
        Node::Swept { profile, sweep: Sweep::Extrude(extrusion), .. } => extruded(profile, extrusion, run),
        _ => Ok(None),
    }
}

/// The walls and the ends of a polygon that is extruded straight.
fn extruded(profile: &Profile, extrusion: &Extrusion, run: &Run) -> Result<Option<Triangles>, Cancelled> {
    let Extrusion { height, twist, scale, caps } = *extrusion;
    let (flat, map) = at_rest(&profile.0);
    let Node::Leaf(field) = flat.node() else { return Ok(None) };
    let Some(polygon) = (&**field as &dyn std::any::Any).downcast_ref::<Polygon>() else { return Ok(None) };
    let is_straight = twist == Angle::ZERO && scale == 1.0 && caps == Caps::Flat;
    let is_flat = map.transform_vector3(DVec3::Z).truncate() == DVec2::ZERO;
    if !is_straight || !is_flat {
        return Ok(None);
    }
    let half = 0.5 * height;
    let at = |p: DVec2, z: f64| map.transform_point3(p.extend(0.0)).truncate().extend(z);
    // What is mirrored in the plane is turned inside out.
    let is_turned = map.matrix3.x_axis.truncate().perp_dot(map.matrix3.y_axis.truncate()) < 0.0;
    let outward = |[a, b, c]: [DVec3; 3]| if is_turned { [a, c, b] } else { [a, b, c] };
    let wall = |[from, to]: [DVec2; 2]| {
        let [a, b, c, d] = [at(from, -half), at(to, -half), at(to, half), at(from, half)];
        [outward([a, b, c]), outward([a, c, d])]
    };
    let mut all: Vec<[DVec3; 3]> = polygon.edges().flat_map(wall).collect();
    let Some(ends) = polygon.triangles(MOST, run)? else { return Ok(None) };
    for [a, b, c] in ends {
        all.push(outward([at(a, half), at(b, half), at(c, half)]));
        all.push(outward([at(a, -half), at(c, -half), at(b, -half)]));
    }
    let bounds = Bounds::from_points(all.iter().flatten().copied());
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    Ok((!all.is_empty()).then_some(Triangles { all, rounding: 16.0 * f64::EPSILON * far }))
}
