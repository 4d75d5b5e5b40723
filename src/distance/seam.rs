//! The sides of triangles, bent onto the surface.
//!
//! A side's middle goes to where the surface is: along the gradient from where a curve with the
//! normals of both ends has its middle, or, on a crease, to where the tangent planes of both sides
//! meet.

use glam::DVec3;

use super::crease::{Plane, meet, slide, with_known};
use super::facets::CREASE;
use super::piece::Piece;
use crate::mesh::Slopes;
use crate::{Cancelled, Run};

/// How far from a crease its sides are looked at, in parts of the side's length: from farther off
/// first, and as near as values tell the faces apart.
const NEAR: [f64; 3] = [0.05, 0.01, 0.002];

/// A crease that is cut off passes a side this far off at most, in parts of the side's length.
const ASTRAY: f64 = 2.0;

/// Where a side is compared with the surface or with the crease that it is to follow, in parts of its
/// length: a curve through both ends and the middle is farthest off about there.
const PROBES: [f64; 2] = [0.25, 0.75];

/// One that starts from a crease may pass over it soon after and come back.
const SOON: [f64; 2] = [1.0 / 12.0, 11.0 / 12.0];

/// The middle is moved by this part of the side's length at most.
const STRIDE: f64 = 0.3;

/// A step that is shorter than this part of what values may be off is the last one.
pub(super) const SETTLED: f64 = 0.3;

/// So many steps lead onto the surface at most; most settle after one or two.
pub(super) const STEPS: usize = 8;

/// No side.
const NONE: u32 = u32::MAX;

/// A side of triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seam {
    pub(super) ends: [u32; 2],
    /// Points that the triangles on both sides reach to; the same twice at a border.
    pub(super) toward: [DVec3; 2],
    pub(super) is_crease: bool,
    /// Whether a triangle beside it has a corner on a crease.
    is_by_crease: bool,
    /// Where it passes over a crease from one face to another, and the normals on the way.
    pub(super) crossing: Option<(DVec3, [DVec3; 2])>,
    /// The vertex where it was split, once it is.
    vertex: Option<u32>,
    /// Where its middle is.
    pub(super) middle: DVec3,
    /// The normals there, of both sides; before it is known, those at both ends.
    pub(super) normals: [DVec3; 2],
    /// How far the side is off the crease that it is to follow, or off the surface.
    pub(super) off: f64,
    /// The next side that starts at the same vertex.
    next: u32,
}

/// The sides of all triangles so far, by their ends.
#[derive(Default)]
pub(super) struct Seams {
    /// By vertex, the first of the sides that start there.
    starts: Vec<u32>,
    pub(super) list: Vec<Seam>,
    /// Which vertices are on creases.
    creased: Vec<bool>,
    /// From here on their middles are not known yet.
    fresh: usize,
}

/// A triangle's side, and on which side of it the triangle is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hem {
    pub(super) seam: u32,
    pub(super) side: usize,
}

impl Seams {
    /// The side between two vertices, seen from a triangle that reaches to a point and has these
    /// normals there.
    pub(super) fn hem(&mut self, ends: [u32; 2], toward: DVec3, normals: [DVec3; 2]) -> Hem {
        let side = usize::from(ends[0] > ends[1]);
        let (mut ends, mut normals) = (ends, normals);
        if side == 1 {
            ends.reverse();
            normals.reverse();
        }
        let first = ends[0] as usize;
        self.starts.resize(self.starts.len().max(first + 1), NONE);
        let mut at = self.starts[first];
        while at != NONE && self.list[at as usize].ends[1] != ends[1] {
            at = self.list[at as usize].next;
        }
        if at == NONE {
            at = self.list.len() as u32;
            self.list.push(Seam {
                ends,
                toward: [toward; 2],
                is_crease: false,
                is_by_crease: false,
                crossing: None,
                vertex: None,
                middle: DVec3::ZERO,
                normals,
                off: 0.0,
                next: self.starts[first],
            });
            self.starts[first] = at;
        } else {
            let seam = &mut self.list[at as usize];
            let differ = [0, 1].map(|i| seam.normals[i].distance(normals[i]));
            // Known middles are of sides that are not new.
            if at as usize >= self.fresh {
                seam.is_crease |= differ[0].max(differ[1]) > CREASE;
            }
        }
        self.list[at as usize].toward[side] = toward;
        Hem { seam: at, side }
    }

    /// The same side, which is part of a larger one.
    pub(super) fn part(&mut self, ends: [u32; 2], whole: Hem, normals: [DVec3; 2]) -> Hem {
        let Seam { toward, is_crease, .. } = self.list[whole.seam as usize];
        let known = self.list.len();
        let hem = self.hem(ends, toward[whole.side], normals);
        let seam = &mut self.list[hem.seam as usize];
        if hem.seam as usize == known {
            // Seen from the other side the ends are the other way round.
            (seam.toward[hem.side], seam.toward[1 - hem.side]) = (toward[whole.side], toward[1 - whole.side]);
            seam.is_crease = is_crease;
        }
        hem
    }

    /// A side along a crease, seen from a triangle that has its ends in this order; the surface on
    /// both sides of it is towards two points, that of the triangle first.
    pub(super) fn ridge(&mut self, ends: [u32; 2], toward: [DVec3; 2]) -> Hem {
        let hem = self.hem(ends, toward[0], [DVec3::ZERO; 2]);
        let seam = &mut self.list[hem.seam as usize];
        (seam.toward[hem.side], seam.toward[1 - hem.side]) = (toward[0], toward[1]);
        seam.is_crease = true;
        hem
    }

    /// The vertex where a side crosses a crease, and the normals on both sides of it, in the order
    /// of the triangle.
    pub(super) fn crossing(&mut self, hem: Hem, positions: &mut Vec<DVec3>) -> (u32, [DVec3; 2]) {
        let seam = &mut self.list[hem.seam as usize];
        let (at, mut normals) = seam.crossing.unwrap_or((seam.middle, seam.normals));
        if hem.side == 1 {
            normals.reverse();
        }
        let vertex = *seam.vertex.get_or_insert_with(|| {
            positions.push(at);
            (positions.len() - 1) as u32
        });
        (vertex, normals)
    }

    /// Tells of sides, given the normals at their ends, whether they pass over a crease.
    pub(super) fn cross(
        &mut self,
        asked: &[(u32, [DVec3; 2])],
        positions: &[DVec3],
        slopes: &Slopes<'_>,
        run: &Run,
    ) -> Result<(), Cancelled> {
        let ends = |seams: &Seams, n: u32| seams.list[n as usize].ends.map(|v| positions[v as usize]);
        let mut at: Vec<DVec3> = Vec::with_capacity(asked.len());
        let mut known: Vec<Vec<Plane>> = Vec::with_capacity(asked.len());
        for (number, normals) in asked {
            let [a, b] = ends(self, *number);
            let planes = [(a, normals[0]), (b, normals[1])].map(|(p, normal)| Plane { normal, d: normal.dot(p) });
            at.push(held(meet(&planes, 0.5 * (a + b)), [a, b]));
            known.push(planes.into());
        }
        let mut normals = vec![[DVec3::ZERO; 2]; asked.len()];
        for aside in NEAR {
            let beside = |((number, _), at): (&(u32, [DVec3; 2]), &DVec3)| {
                ends(self, *number).map(|end| at.lerp(end, 2.0 * aside))
            };
            let points: Vec<DVec3> = asked.iter().zip(&at).flat_map(beside).collect();
            let found = slopes.at(&points, run)?;
            for (i, ((number, _), (points, found))) in
                asked.iter().zip(points.chunks(2).zip(found.chunks(2))).enumerate()
            {
                let seen = points.iter().zip(found).filter_map(|(p, s)| Plane::of(*p, s)).collect();
                known[i] = with_known(seen, &known[i]);
                at[i] = held(meet(&known[i], at[i]), ends(self, *number));
                normals[i] = [found[0].normal(), found[1].normal()];
            }
        }
        for (((number, at_ends), at), near) in asked.iter().zip(at).zip(normals) {
            // A turn in a point, or one all along the side?
            if near[0].distance(near[1]) > 0.5 * at_ends[0].distance(at_ends[1]) {
                self.list[*number as usize].crossing = Some((at, near));
            }
        }
        Ok(())
    }

    pub(super) fn of(&self, hem: Hem) -> &Seam {
        &self.list[hem.seam as usize]
    }

    /// The vertex at the middle of a side.
    pub(super) fn vertex(&mut self, hem: Hem, positions: &mut Vec<DVec3>) -> u32 {
        let seam = &mut self.list[hem.seam as usize];
        *seam.vertex.get_or_insert_with(|| {
            positions.push(seam.middle);
            (positions.len() - 1) as u32
        })
    }

    pub(super) fn normal(&self, hem: Hem) -> DVec3 {
        self.of(hem).normals[hem.side]
    }

    /// Has a side looked at between its ends and its middle: a crease may pass over it and come
    /// back, though they are all on one face.
    pub(super) fn watch(&mut self, hem: Hem) {
        self.list[hem.seam as usize].is_by_crease = true;
    }

    /// Has those sides looked at that are new and of triangles with a corner on a crease.
    fn watch_creases(&mut self, pieces: &[Piece], vertices: usize) {
        self.creased.resize(vertices, false);
        for seam in self.list[self.fresh..].iter().filter(|seam| seam.is_crease) {
            seam.ends.iter().for_each(|end| self.creased[*end as usize] = true);
        }
        for piece in pieces {
            if piece.corners.iter().any(|v| self.creased[*v as usize]) {
                piece.hems.iter().for_each(|hem| self.watch(*hem));
            }
        }
    }

    /// Finds the middles of the sides of pieces that are not known yet.
    pub(super) fn find(
        &mut self,
        pieces: &[Piece],
        positions: &[DVec3],
        slopes: &Slopes<'_>,
        run: &Run,
    ) -> Result<(), Cancelled> {
        self.watch_creases(pieces, positions.len());
        let fresh = self.fresh..self.list.len();
        self.fresh = self.list.len();
        for number in fresh.clone() {
            let seam = &mut self.list[number];
            let [a, b] = seam.ends.map(|v| positions[v as usize]);
            seam.middle = 0.5 * (a + b);
            if !seam.is_crease {
                let height = |n: DVec3, p: DVec3| n * n.dot(p - seam.middle);
                let bend = 0.25 * (height(seam.normals[0], a) + height(seam.normals[1], b));
                seam.middle += bend.clamp_length_max(STRIDE * a.distance(b));
            }
        }
        let (creases, smooth): (Vec<usize>, Vec<usize>) = fresh.partition(|n| self.list[*n].is_crease);
        let asked = self.slide(&smooth, positions, slopes, run)?;
        self.probe(&asked, PROBES, positions, slopes, run)?;
        let by_creases: Vec<usize> = smooth.into_iter().filter(|n| self.list[*n].is_by_crease).collect();
        self.probe(&by_creases, SOON, positions, slopes, run)?;
        self.meet(&creases, positions, slopes, run)?;
        self.compare(&creases, positions, slopes, run)
    }

    /// Newton steps along the gradient. Gives the sides whose middles were not where their ends
    /// tell, and those by creases.
    fn slide(
        &mut self,
        numbers: &[usize],
        positions: &[DVec3],
        slopes: &Slopes<'_>,
        run: &Run,
    ) -> Result<Vec<usize>, Cancelled> {
        let before: Vec<DVec3> = numbers.iter().map(|n| self.list[*n].middle).collect();
        let mut open: Vec<(usize, Vec<Plane>)> = numbers.iter().map(|n| (*n, Vec::new())).collect();
        for _ in 0..STEPS {
            let points: Vec<DVec3> = open.iter().map(|(n, _)| self.list[*n].middle).collect();
            let mut found = slopes.at(&points, run)?.into_iter();
            open.retain_mut(|(number, known)| {
                let (seam, slope) = (&mut self.list[*number], found.next().unwrap_or_default());
                seam.moved(slide(seam.middle, &slope, known), positions);
                seam.normals = [slope.normal(); 2];
                // What is left of a step goes with its square.
                slope.distance() > SETTLED * slopes.precision
            });
        }
        let is_asked = |(n, before): &(&usize, &DVec3)| {
            let seam = &self.list[**n];
            seam.is_by_crease || seam.middle.distance(**before) > slopes.precision
        };
        Ok(numbers.iter().zip(&before).filter(is_asked).map(|(n, _)| *n).collect())
    }

    /// Sees how far sides are off the surface between their ends and middles: one that starts from
    /// a crease may pass over it and come back.
    fn probe(
        &mut self,
        numbers: &[usize],
        places: [f64; 2],
        positions: &[DVec3],
        slopes: &Slopes<'_>,
        run: &Run,
    ) -> Result<(), Cancelled> {
        for along in places {
            let points: Vec<DVec3> = numbers.iter().map(|n| self.list[*n].at(along, positions)).collect();
            for (number, slope) in numbers.iter().zip(slopes.at(&points, run)?) {
                let seam = &mut self.list[*number];
                let [from, to] = seam.ends.map(|v| positions[v as usize]);
                seam.off = seam.off.max(slope.distance_of(from.distance(to)));
            }
        }
        Ok(())
    }

    /// Steps to where the planes of both sides meet.
    fn meet(
        &mut self,
        numbers: &[usize],
        positions: &[DVec3],
        slopes: &Slopes<'_>,
        run: &Run,
    ) -> Result<(), Cancelled> {
        let mut known: Vec<Vec<Plane>> = vec![Vec::new(); numbers.len()];
        for aside in NEAR {
            let tells = |i: &usize| aside >= self.list[numbers[*i]].nearest(slopes, positions);
            let asked: Vec<usize> = (0..numbers.len()).filter(tells).collect();
            let beside = |i: &usize| {
                let seam = &self.list[numbers[*i]];
                seam.beside(seam.middle, aside, positions)
            };
            let points: Vec<DVec3> = asked.iter().flat_map(beside).collect();
            let found = slopes.at(&points, run)?;
            for ((i, points), found) in asked.iter().zip(points.chunks(2)).zip(found.chunks(2)) {
                let seen = points.iter().zip(found).filter_map(|(p, s)| Plane::of(*p, s)).collect();
                known[*i] = with_known(seen, &known[*i]);
                let seam = &mut self.list[numbers[*i]];
                seam.moved(meet(&known[*i], seam.middle), positions);
                seam.normals = [found[0].normal(), found[1].normal()];
            }
        }
        Ok(())
    }

    /// Sees how far sides are off the creases that they follow: off where the planes of both faces
    /// meet.
    fn compare(
        &mut self,
        numbers: &[usize],
        positions: &[DVec3],
        slopes: &Slopes<'_>,
        run: &Run,
    ) -> Result<(), Cancelled> {
        for along in PROBES.into_iter().chain(SOON) {
            let beside = |n: &usize| {
                let seam = &self.list[*n];
                let aside = seam.nearest(slopes, positions);
                seam.beside(seam.at(along, positions), aside, positions)
            };
            let points: Vec<DVec3> = numbers.iter().flat_map(beside).collect();
            let found = slopes.at(&points, run)?;
            for ((number, points), found) in numbers.iter().zip(points.chunks(2)).zip(found.chunks(2)) {
                let planes: Vec<Plane> = points.iter().zip(found).filter_map(|(p, s)| Plane::of(*p, s)).collect();
                let seam = &mut self.list[*number];
                let [from, to] = seam.ends.map(|v| positions[v as usize]);
                let length = from.distance(to);
                let at = seam.at(along, positions);
                let off = match &planes[..] {
                    [] => found.iter().map(|slope| slope.distance_of(length)).fold(0.0, f64::max),
                    [a, b] if a.normal.distance(b.normal) > CREASE => {
                        meet(&planes, at).distance(at).min(STRIDE * length)
                    }
                    // Where both faces are one, nothing tells where the crease is, but that it is
                    // on the surface.
                    _ => planes.iter().map(|plane| plane.distance(at)).fold(0.0, f64::max),
                };
                seam.off = seam.off.max(off);
            }
        }
        Ok(())
    }
}

impl Hem {
    /// The same side, seen from the triangle beyond.
    pub(super) fn other(self) -> Hem {
        Hem { side: 1 - self.side, ..self }
    }
}

/// A point held near the straight line between two ends.
fn held(p: DVec3, [a, b]: [DVec3; 2]) -> DVec3 {
    let middle = 0.5 * (a + b);
    middle + (p - middle).clamp_length_max(ASTRAY * a.distance(b))
}

impl Seam {
    /// Moves the middle, no farther than a part of the side's length from its straight middle.
    fn moved(&mut self, to: DVec3, positions: &[DVec3]) {
        let [a, b] = self.ends.map(|v| positions[v as usize]);
        let straight = 0.5 * (a + b);
        self.middle = straight + (to - straight).clamp_length_max(STRIDE * a.distance(b));
    }

    /// A point of the side, in parts of its length.
    fn at(&self, along: f64, positions: &[DVec3]) -> DVec3 {
        let [a, b] = self.ends.map(|v| positions[v as usize]);
        a.lerp(b, along) + 4.0 * along * (1.0 - along) * self.bend(positions)
    }

    /// The least part of its length that the faces on both sides are told apart at: farther away
    /// than values may be off.
    fn nearest(&self, slopes: &Slopes<'_>, positions: &[DVec3]) -> f64 {
        let [a, b] = self.ends.map(|v| positions[v as usize]);
        let tells = |aside: &f64| aside * a.distance(b) > slopes.precision;
        let [first, rest @ ..] = NEAR;
        rest.into_iter().rev().find(tells).unwrap_or(first)
    }

    /// Points on both sides of one on a crease, so far from it in parts of the side's length.
    fn beside(&self, point: DVec3, aside: f64, positions: &[DVec3]) -> [DVec3; 2] {
        let [a, b] = self.ends.map(|v| positions[v as usize]);
        let along = (b - a).normalize_or_zero();
        self.toward.map(|toward| {
            let across = toward - point;
            let across = (across - across.dot(along) * along).normalize_or_zero();
            point + aside * a.distance(b) * across
        })
    }

    /// How far the middle is off that of the straight side.
    pub(super) fn bend(&self, positions: &[DVec3]) -> DVec3 {
        let [a, b] = self.ends.map(|v| positions[v as usize]);
        self.middle - 0.5 * (a + b)
    }
}
