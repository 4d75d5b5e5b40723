//! Cells cut by planes: how much of a cell is inside of what has creases.
//!
//! ```text
//!       tangents                Of a concave value, tangents at points inside cut off what is outside,
//!      ___.--*--.___            until it is 0 or hardly less at all corners: what is flat is then known
//!        /   c   \              exactly. Otherwise c is inside by m and the corners are outside by
//!     --*---------*--           δ at most, so that all of the body is inside that is drawn in to c by
//!                               δ/(δ + m).
//! ```
//!
//! Of other values the slopes tell a plane. Of meshes, and of what is measured, layers are told
//! that hold the surface. The planes of all parts of a program divide the cell into bodies that are
//! inside or outside by what minima and maxima make of the parts; what is open of the parts adds
//! up, and what is within layers is open where the other parts do not tell it. Faces between such
//! bodies are the surface where one is inside and one outside.

use glam::DVec3;

use super::bracket::{self, Held, ROUNDING};
use super::moments::Moments;
use super::polytope::{Face, Place, Plane, Polytope};
use crate::Bounds;
use crate::eval::Bend;
use crate::program::Program;
use rvachev_field::{Layer, Zone};

/// More parts are not looked at.
const PARTS: usize = 6;

/// A cell is not cut more often by one part, where it is round and where it may be flat, nor into
/// more bodies and faces.
const ROUND: usize = 4;
const FLAT: usize = 16;
const BODIES: usize = 256;

/// Tangents cut deeper than this part of what a corner is outside by.
const DEEP: f64 = 0.3;

/// Steps towards a corner at most.
const STEPS: usize = 40;

/// What a part has of a cell: what is above all of some planes, more or less.
struct Part {
    node: usize,
    planes: Vec<Plane>,
    is_complement: bool,
    /// The volume of what the planes may be wrong about.
    open: f64,
    /// Whether they are wrong by no more than rounding.
    is_exact: bool,
    /// Of a surface that is in layers about the planes: what tells the sides of these.
    layers: Option<Layers>,
}

/// What is beyond layers that hold all of a surface is inside or outside wherever it is cut off by
/// them: a point tells it. Within them nothing is told.
struct Layers {
    atom: Program,
    centre: DVec3,
    /// Half of how thick they are.
    halves: Vec<f64>,
}

/// What a cell has of a program, if planes tell it.
pub(super) fn held(program: &Program, cell: &Bounds) -> Option<Held> {
    let parts = parts(program, cell, ROUND).ok()?;
    let Bodies { moments, open: [less, more], .. } = Bodies::of(program, &parts, cell, false)?;
    let open = parts.iter().map(|part| part.open).sum::<f64>();
    let (moments, whole) = (moments.moved(cell.center()), cell.size().element_product());
    // Rounding may lead beyond the cell.
    let [least, most] =
        [moments.volume - less - open, moments.volume + more + open].map(|volume| volume.clamp(0.0, whole));
    Some(Held { least: least.min(moments.volume), most: most.max(moments.volume), moments })
}

/// What a cell has of flat faces.
pub(super) enum Flat {
    /// The moments of what is inside, and the area of the surface within the cell, to rounding.
    Exact(Moments, f64),
    /// Of its parts it may be told.
    Unknown,
    /// The surface is not flat, or in the sides of the cell.
    Other,
}

/// What a cell has of a program, if its faces are flat.
pub(super) fn flat(program: &Program, cell: &Bounds) -> Flat {
    let parts = match parts(program, cell, FLAT) {
        Ok(parts) => parts,
        Err(unknown) => return unknown,
    };
    if !parts.iter().all(|part| part.is_exact) {
        return Flat::Other;
    }
    match Bodies::of(program, &parts, cell, true) {
        Some(Bodies { has_side: true, .. }) => Flat::Other,
        Some(Bodies { moments, area, .. }) => Flat::Exact(moments.moved(cell.center()), area),
        None => Flat::Unknown,
    }
}

/// Thinner boxes are taken for so thick, as a part of their size.
const THIN: f64 = 1e-3;

/// The planes that a convex part with flat faces is above in a box, from its middle, and how far
/// these may be off; nothing of others.
pub(super) fn flat_faces(atom: &Program, cell: &Bounds) -> Option<(Vec<Plane>, f64)> {
    let mut half = cell.half_extents();
    half = half.max(DVec3::splat(THIN * half.max_element()));
    let cell = Bounds::from_center(cell.center(), half);
    if atom.bend_over(&Zone::of_bounds(&cell)) != Some(Bend::Concave) {
        return None;
    }
    let part = part(atom, 0, &cell, FLAT).ok().filter(|part| part.is_exact)?;
    let slack = Polytope::cuboid(half, far(&cell)).slack;
    Some((part.planes, 4.0 * slack + 8.0 * ROUNDING * far(&cell)))
}

/// The largest coordinate in absolute value.
fn far(cell: &Bounds) -> f64 {
    cell.min.abs().max(cell.max.abs()).max_element()
}

struct Bodies<'a> {
    program: &'a Program,
    parts: &'a [Part],
    /// Whether the body is inside of the first parts.
    signs: Vec<Option<bool>>,
    moments: Moments,
    /// Of bodies within layers that may be inside or outside: those that count as inside, and those
    /// that do not.
    open: [f64; 2],
    /// Of the faces that have the inside on one side, if that is asked for.
    area: f64,
    asks_area: bool,
    /// Whether a side of the cell is in a plane: it is not told here what is beyond.
    has_side: bool,
    /// How many bodies and faces more there may be.
    left: usize,
    slack: f64,
}

impl<'a> Bodies<'a> {
    /// All of a cell; nothing if they are too many.
    fn of(program: &'a Program, parts: &'a [Part], cell: &Bounds, asks_area: bool) -> Option<Bodies<'a>> {
        let whole = Polytope::cuboid(cell.half_extents(), far(cell));
        let (signs, moments, slack) = (vec![None; parts.len()], Moments::default(), whole.slack);
        let (open, area, has_side, left) = ([0.0; 2], 0.0, false, BODIES);
        let mut all = Bodies { program, parts, signs, moments, open, area, asks_area, has_side, left, slack };
        all.divide(&whole, 0)?;
        Some(all)
    }

    fn is_inside(&self, signs: &[Option<bool>]) -> Option<bool> {
        self.program.is_inside_by(|node| {
            let at = self.parts.iter().position(|part| part.node == node)?;
            signs[at].map(|sign| sign != self.parts[at].is_complement)
        })
    }

    /// Adds what is inside of a body of which some parts are told; nothing if there is too much.
    fn divide(&mut self, body: &Polytope, told: usize) -> Option<()> {
        if body.is_empty() {
            return Some(());
        }
        self.left = self.left.checked_sub(1)?;
        if let Some(is_inside) = self.is_inside(&self.signs) {
            if is_inside {
                self.moments.add(&body.moments());
            }
            return Some(());
        }
        let parts = self.parts;
        let Some(Part { planes, layers, .. }) = parts.get(told) else { return self.leave(body) };
        if let Some(layers) = layers {
            return self.among(body, told, (planes, layers));
        }
        let mut within = body.clone();
        self.signs[told] = Some(false);
        for (n, plane) in planes.iter().enumerate() {
            if self.asks_area {
                self.has_side |= within.has_side_in(plane);
                if within.place(plane) == Place::Across {
                    let sides = [0, 1].map(|_| self.signs.clone());
                    let area = self.faces(&within.section(plane), sides, [told, n + 1], [false, true])?;
                    self.area += area;
                }
            }
            self.divide(&within.above(&plane.turned()), told + 1)?;
            within = within.above(plane);
        }
        self.signs[told] = Some(true);
        self.divide(&within, told + 1)?;
        self.signs[told] = None;
        Some(())
    }

    /// The same of a body that layers about planes divide.
    fn among(&mut self, body: &Polytope, told: usize, (planes, layers): (&[Plane], &Layers)) -> Option<()> {
        if body.is_empty() {
            return Some(());
        }
        if let [plane, rest @ ..] = planes {
            let half = layers.halves[layers.halves.len() - planes.len()];
            let [over, under] = [plane.raised(half), plane.turned().raised(half)];
            self.among(&body.above(&over), told, (rest, layers))?;
            self.among(&body.above(&under), told, (rest, layers))?;
            return self.divide(&body.above(&over.turned()).above(&under.turned()), told + 1);
        }
        let Moments { volume, first, .. } = body.moments();
        if volume <= 0.0 {
            return Some(());
        }
        self.signs[told] = Some(layers.atom.value(layers.centre + first / volume) > 0.0);
        self.divide(body, told + 1)?;
        self.signs[told] = None;
        Some(())
    }

    /// Leaves a body open that all parts do not tell: it counts as its middle does. Without layers
    /// there is none.
    fn leave(&mut self, body: &Polytope) -> Option<()> {
        let centre = self.parts.iter().find_map(|part| part.layers.as_ref()).map(|layers| layers.centre)?;
        let moments = body.moments();
        if moments.volume <= 0.0 {
            return Some(());
        }
        let is_inside = self.program.value(centre + moments.first / moments.volume) > 0.0;
        self.open[usize::from(!is_inside)] += moments.volume;
        if is_inside {
            self.moments.add(&moments);
        }
        Some(())
    }

    /// The area of a face, or of its part, that has the inside on one side: by what is told of both
    /// sides, of which the second is where the face looks; given the plane that is to be looked at
    /// next, and which sides are above all planes of its part so far.
    fn faces(
        &mut self,
        face: &Face,
        mut sides: [Vec<Option<bool>>; 2],
        [part, plane]: [usize; 2],
        are_within: [bool; 2],
    ) -> Option<f64> {
        if face.is_empty() {
            return Some(0.0);
        }
        self.left = self.left.checked_sub(1)?;
        let parts = self.parts;
        let known = |sides: &[Vec<Option<bool>>; 2]| Some([self.is_inside(&sides[0])?, self.is_inside(&sides[1])?]);
        let next = parts.get(part).and_then(|part| part.planes.get(plane)).filter(|_| are_within != [false; 2]);
        let Some(next) = next else {
            (0..2).for_each(|side| sides[side][part] = Some(are_within[side]));
            if let Some([one, other]) = known(&sides) {
                return Some(if one == other { 0.0 } else { face.area() });
            }
            parts.get(part + 1)?;
            return self.faces(face, sides, [part + 1, 0], [true; 2]);
        };
        let after = [part, plane + 1];
        match face.place(next, self.slack) {
            Place::Above => self.faces(face, sides, after, are_within),
            Place::Below => self.faces(face, sides, after, [false; 2]),
            Place::Within => {
                let is_along = face.is_along(next);
                self.faces(face, sides, after, [are_within[0] && !is_along, are_within[1] && is_along])
            }
            Place::Across => {
                let below = self.faces(&face.above(&next.turned()), sides.clone(), after, [false; 2])?;
                Some(below + self.faces(&face.above(next), sides, after, are_within)?)
            }
        }
    }
}

/// The planes of all parts of a program, or why they are not told.
fn parts(program: &Program, cell: &Bounds, cuts: usize) -> Result<Vec<Part>, Flat> {
    let atoms = program.atoms(PARTS).ok_or(Flat::Unknown)?;
    atoms.iter().map(|atom| part(&atom.program, atom.node, cell, cuts)).collect()
}

fn part(atom: &Program, node: usize, cell: &Bounds, cuts: usize) -> Result<Part, Flat> {
    let Some(bend) = atom.bend_over(&Zone::of_bounds(cell)) else {
        if atom.bends_in_parts() {
            return Err(Flat::Unknown);
        }
        // Neither slopes nor layers are exact.
        if cuts == FLAT {
            return Err(Flat::Other);
        }
        let (planes, open, layers) = if let Some((planes, layers)) = layers(atom, cell) {
            (planes, 0.0, Some(layers))
        } else {
            let (plane, open) = bracket::by_plane(atom, cell).ok_or(Flat::Other)?;
            (vec![plane], open, None)
        };
        return Ok(Part { node, planes, is_complement: false, open, is_exact: false, layers });
    };
    let is_complement = bend == Bend::Convex;
    let sign = if is_complement { -1.0 } else { 1.0 };
    let middle = cell.center();
    let value = |p: DVec3| sign * atom.value(middle + p);
    let gradient = |p: DVec3| {
        let (value, slope) = atom.gradient(middle + p);
        (sign * value, sign * slope)
    };
    let whole = Polytope::cuboid(cell.half_extents(), far(cell));
    let Tangents { body, open, is_exact } = tangents(value, gradient, whole, (far(cell), cuts));
    Ok(Part { node, planes: body.cuts(), is_complement, open, is_exact, layers: None })
}

/// Planes in the layers that hold a leaf's surface in a cell, and the volume of these.
fn layers(atom: &Program, cell: &Bounds) -> Option<(Vec<Plane>, Layers)> {
    let found = atom.layers(&Zone::of_bounds(cell), 0.0)?;
    let (centre, slack) = (cell.center(), Polytope::cuboid(cell.half_extents(), far(cell)).slack);
    let (mut planes, mut halves) = (Vec::new(), Vec::new());
    for Layer { normal, low, high, .. } in found {
        planes.push(Plane::of(DVec3::ZERO, normal.dot(centre) - low.midpoint(high), normal)?);
        halves.push(0.5 * (high - low) + slack);
    }
    Some((planes, Layers { atom: atom.clone(), centre, halves }))
}

/// Tangents of a concave value, and what is above them all and may be outside.
struct Tangents {
    body: Polytope,
    open: f64,
    is_exact: bool,
}

/// At most so many tangents in a body about the origin; coordinates are rounded as those are that
/// are as large as `far`.
fn tangents(
    value: impl Fn(DVec3) -> f64,
    gradient: impl Fn(DVec3) -> (f64, DVec3),
    mut body: Polytope,
    (far, most): (f64, usize),
) -> Tangents {
    let mut cuts = 0;
    loop {
        let Moments { volume, first, .. } = body.moments();
        if body.is_empty() || volume <= 0.0 {
            return Tangents { body, open: 0.0, is_exact: true };
        }
        let middle = first / volume;
        let (height, slope) = gradient(middle);
        let rounding = ROUNDING * (height.abs() + far * slope.abs().max_element());
        let mut tangent = Plane::of(middle, height, slope);
        if height > 0.0 {
            let corners = body.corners().into_iter().map(|p| (value(p), p));
            let Some((lowest, corner)) = corners.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            let off = (-lowest).max(0.0) + rounding;
            let open = (1.0 - (height / (height + off)).powi(3)) * volume;
            if off <= 4.0 * rounding {
                // Planes are as far off as that to the other side, too.
                return Tangents { body, open: 2.0 * open, is_exact: true };
            }
            if cuts == most {
                return Tangents { body, open: 2.0 * open, is_exact: false };
            }
            // From a point inside towards the corner, between it and one outside.
            let (mut at, mut above, mut slope) = (middle, height, slope);
            let (mut out, mut below) = (corner, lowest);
            for _ in 0..STEPS {
                if above + slope.dot(corner - at) <= DEEP * lowest {
                    break;
                }
                // The value is above its chord.
                let chord = at.lerp(out, above.max(0.0) / (above.max(0.0) - below));
                let half = chord.midpoint(out);
                let there = gradient(half);
                if there.0 > 0.0 {
                    (at, (above, slope)) = (half, there);
                } else {
                    (out, below) = (half, there.0);
                    (at, (above, slope)) = (chord, gradient(chord));
                }
            }
            tangent = Plane::of(at, above, slope).filter(|plane| plane.height(corner) < 0.0);
        }
        match tangent {
            Some(tangent) if cuts < most => {
                body = body.above(&tangent);
                cuts += 1;
            }
            _ => break,
        }
    }
    let open = body.moments().volume;
    Tangents { body, open, is_exact: false }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::compiled;
    use crate::program::Region;
    use crate::{Profile, Run, Solid, deg};

    /// What cells have of bodies with flat faces, and of their joins, is known to rounding.
    #[test]
    fn shares_of_flat_faces_are_exact() {
        let turned = |solid: Solid| solid.rotate_x(deg(20.0)).rotate_z(deg(35.0));
        let u =
            [[-2.0, -1.5], [2.0, -1.5], [2.0, 1.5], [0.3, 1.5], [0.3, -0.5], [-0.3, -0.5], [-0.3, 1.5], [-2.0, 1.5]];
        let (block, plate) = (Solid::cuboid([2.0, 1.0, 3.0]), Solid::cuboid([3.0, 3.0, 0.1]));
        let hexagon = 1.5 * 3f64.sqrt();
        let beside = block.translate([2.0, 0.0, 0.0]);
        let bodies = [
            (turned(block.clone()), 6.0, 22.0),
            (turned(&block | &plate), 6.9 - 0.2, 22.0 + 19.2 - 4.0 - 0.6),
            (turned(&block - &plate), 5.8, 22.0 - 0.6 + 4.0),
            (turned(&block | &beside), 12.0, 38.0),
            (turned(&block - &beside), 6.0, 22.0),
            (turned((&block | &beside) - block.translate([1.0, 0.0, 1.5])), 9.0, 35.0),
            (turned(Solid::prism(6, 1.0, 2.0)), 2.0 * hexagon, 2.0 * hexagon + 12.0),
            (turned(Solid::pyramid(4, 2f64.sqrt(), 3.0)), 4.0, 4.0 + 4.0 * 10f64.sqrt()),
            (turned(Solid::wedge([2.0, 1.0, 3.0])), 3.0, 6.0 + 2.0 + 3.0 + 13f64.sqrt()),
            (turned(Profile::polygon(u).extrude(1.0)), 12.0 - 1.2, 21.6 + 14.0 + 4.0),
        ];
        for (body, volume, area) in bodies {
            let programs = compiled(&body).unwrap();
            let whole = body.bounds().unwrap().inflate(0.1);
            let whole = Bounds::new(whole.min, whole.max + 0.017);
            // Cells that the narrowed polygon has few edges in.
            let mut cells = vec![whole];
            for _ in 0..3 {
                cells = cells.iter().flat_map(Bounds::octants).collect();
            }
            let (mut found, mut faces) = (0.0, 0.0);
            for cell in cells {
                match programs.surface.narrow(&cell) {
                    Region::Inside => found += cell.size().element_product(),
                    Region::Outside => {}
                    Region::Surface(program) => {
                        let told = super::super::flat::flat(&[(cell, program.clone())], &Run::default());
                        let Some((moments, area)) = told.unwrap() else { panic!("{body} is flat") };
                        if let Some(held) = held(&program, &cell) {
                            let slack = 1e-13;
                            assert!(held.least - slack <= moments.volume && moments.volume <= held.most + slack);
                        }
                        found += moments.volume;
                        faces += area;
                    }
                }
            }
            assert!((found - volume).abs() < 1e-11, "{body}: {found} for {volume}");
            assert!((faces - area).abs() < 1e-10, "{body}: {faces} for {area}");
        }
    }

    /// Of what is round it is told what is open, and that holds.
    #[test]
    fn shares_of_round_faces_have_bounds() {
        let bodies = [
            Solid::sphere(1.0) & Solid::cylinder(0.7, 3.0),
            Solid::torus(1.0, 0.3) - Solid::sphere(0.6).translate([1.0, 0.0, 0.0]),
        ];
        for body in bodies {
            let program = &compiled(&body).unwrap().surface;
            let mut told = 0;
            for n in 0..3000_u32 {
                let random =
                    |k: u32| f64::from((8 * n + k).wrapping_mul(2_654_435_769).rotate_left(11)) / 2f64.powi(32);
                let at = 2.6 * DVec3::new(random(0), random(1), random(2)) - 1.3;
                let cell = Bounds::from_center(at, DVec3::splat(0.02 + 0.06 * random(3)));
                let Region::Surface(program) = program.narrow(&cell) else { continue };
                let Some(held) = held(&program, &cell) else { continue };
                let points = 16_u32;
                let count = (0..points.pow(3)).filter(|k| {
                    let step = DVec3::new(f64::from(k % 16), f64::from(k / 16 % 16), f64::from(k / 256)) + 0.5;
                    program.value(cell.min + cell.size() * step / 16.0) > 0.0
                });
                let whole = cell.size().element_product();
                let counted = count.count() as f64 / 4096.0 * whole;
                let slack = 0.03 * whole;
                assert!(
                    held.least <= counted + slack && counted <= held.most + slack,
                    "{body} {n}: {held:?} {counted}"
                );
                told += usize::from(held.open() < 0.5 * whole);
            }
            assert!(told > 10, "{body}: {told}");
        }
    }
}
