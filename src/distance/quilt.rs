//! Triangles with curved sides that are on the surface to within a tolerance.
//!
//! ```text
//!         /\            A patch that is off the surface, or turned from it, is split into four, at
//!        /__\           the middles of its sides, which are on the surface. Its neighbours stay as
//!       /\  /\          they are: what gapes is less than the tolerance, and the sign does not come
//!      /__\/__\         from patches.
//! ```

use std::collections::HashMap;

use glam::DVec3;

use super::facets::{CREASE, Facets};
use super::seam::{Hem, Seams};
use crate::mesh::{Slope, Slopes};
use crate::{Cancelled, Run};
use rvachev_field::Patch;

/// What is done for patches.
#[derive(Clone, Copy)]
pub(super) struct Care {
    /// How far they may be off.
    pub(super) tolerance: f64,
    /// The part of the surface that may be off when it is seen whether splitting helps.
    pub(super) patience: f64,
    /// How often a patch is split at most.
    pub(super) depth: u32,
}

impl Care {
    /// As much as is done for all of a surface.
    pub(super) fn new(tolerance: f64) -> Care {
        Care { tolerance, patience: f64::INFINITY, depth: 6 }
    }
}

/// After so many times it is seen whether splitting helps.
const SOON: u32 = 3;

/// Nor is any if there would be more than so many.
const MANY: usize = 1 << 21;

/// A patch is split where its normal is off by more, in radians.
const TURN: f64 = 0.03;

/// Splitting goes on where it leaves less than this part of the error.
const GAIN: f64 = 0.8;

/// Patches that are farther off than so many tolerances are to be mended.
const FAR: f64 = 3.0;

/// Patches that are farther off than this part of their width are left out.
const ASTRAY: f64 = 0.4;

/// Where a patch is compared with the surface.
const PROBES: [[f64; 3]; 4] = [[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]];

/// So many patches are compared at a time: their probes take more memory than they do.
const AT_ONCE: usize = 1 << 16;

/// Between the probes patches may be off by so much more than at them.
const BETWEEN: f64 = 1.5;

/// The patches, and how far they may be off.
pub(super) struct Quilt {
    pub(super) patches: Vec<Patch>,
    pub(super) error: f64,
    /// How far each is off, and its area.
    pub(super) measures: Vec<[f64; 2]>,
    /// Patches that are far off.
    pub(super) spots: Vec<Spot>,
}

/// A patch that is far off, and how far.
pub(super) struct Spot {
    pub(super) patch: Patch,
    pub(super) off: f64,
}

/// A triangle: its corners, their normals, and its sides from each corner to the next.
struct Piece {
    corners: [u32; 3],
    normals: [DVec3; 3],
    hems: [Hem; 3],
    /// How far off the patch was that it is a part of.
    before: f64,
}

/// How far a patch is off.
#[derive(Clone, Copy)]
struct Residual {
    /// Off the surface, between the probes too.
    off: f64,
    /// Turned from it, in radians.
    turn: f64,
    /// Of its sides, off creases and off the surface.
    rim: f64,
}

impl Residual {
    fn all(self) -> f64 {
        self.off.max(self.rim)
    }
}

impl Quilt {
    /// One that has these spots and nothing else.
    pub(super) fn of(spots: Vec<Spot>) -> Quilt {
        Quilt { patches: Vec::new(), error: 0.0, measures: Vec::new(), spots }
    }

    /// Patches of triangles near the surface; `None` if more than this part of them is far off and
    /// splitting does not mend it: triangles are too large for what they are to show.
    pub(super) fn new(
        mut facets: Facets,
        slopes: &Slopes<'_>,
        care: Care,
        run: &Run,
    ) -> Result<Option<Quilt>, Cancelled> {
        let Care { tolerance, patience, depth: last } = care;
        facets.polish(slopes, run)?;
        let mut seams = Seams::default();
        let mut pieces = first(&facets, &mut seams);
        let mut positions = facets.positions;
        let mut quilt = Quilt::of(Vec::new());
        for depth in 0..=last {
            seams.find(&positions, slopes, run)?;
            let patch = |(number, piece): (usize, &Piece)| {
                often(number, run)?;
                Ok(piece.patch(&positions, &seams, tolerance))
            };
            let patches = pieces.iter().enumerate().map(patch).collect::<Result<Vec<Patch>, Cancelled>>()?;
            let mut errors = errors(&patches, slopes, run)?;
            for (piece, error) in pieces.iter().zip(&mut errors) {
                error.rim = piece.hems.iter().map(|hem| seams.of(*hem).off).fold(0.0, f64::max);
            }
            let is_enough = quilt.patches.len() + 4 * pieces.len() > MANY;
            let fails = |piece: &Piece, error: Residual| {
                let is_off = error.all() > tolerance || error.turn > TURN && error.off > 0.05 * tolerance;
                // Where splitting does not help, more of it does not either.
                depth < last && is_off && !is_enough && (depth < 4 || error.all() < GAIN * piece.before)
            };
            let failing = pieces.iter().zip(&errors).filter(|(piece, error)| fails(piece, **error));
            cross(failing.map(|(piece, _)| piece), &positions, &mut seams, slopes, run)?;
            if depth == SOON {
                let areas = || patches.iter().map(area_of);
                let split = pieces.iter().zip(&errors).zip(areas());
                let failing: f64 = split.filter(|((piece, error), _)| fails(piece, **error)).map(|(_, own)| own).sum();
                if failing > patience * (quilt.area() + areas().sum::<f64>()) {
                    return Ok(None);
                }
            }
            let mut next = Vec::new();
            for (number, ((piece, patch), error)) in pieces.iter().zip(patches).zip(errors).enumerate() {
                often(number, run)?;
                let off = error.all();
                if fails(piece, error) {
                    let from = next.len();
                    piece.split(&mut positions, &mut seams, &mut next);
                    next[from..].iter_mut().for_each(|part| part.before = off);
                    continue;
                }
                if off > FAR * tolerance {
                    quilt.spots.push(Spot { patch, off });
                } else {
                    quilt.take(patch, off);
                }
            }
            pieces = next;
            run.report(f64::from(depth + 1) / f64::from(last + 1));
        }
        Ok(Some(quilt))
    }

    /// Takes a patch that is so far off.
    fn take(&mut self, patch: Patch, off: f64) {
        self.measures.push([off, area_of(&patch)]);
        let [a, b, c] = patch.corners;
        let width = a.distance(b).max(b.distance(c));
        // One that is farther off than it is wide tells nothing of the surface.
        if off > ASTRAY * width {
            self.error = self.error.max(width);
        } else {
            self.error = self.error.max(off);
            self.patches.push(patch);
        }
    }

    /// Takes patches that are known to be at the surface, to within so much.
    pub(super) fn add_all(&mut self, found: impl Iterator<Item = (Patch, f64)>) {
        for (patch, off) in found {
            self.measures.push([off, area_of(&patch)]);
            self.error = self.error.max(off);
            self.patches.push(patch);
        }
    }

    /// Takes patches as they are, however far off.
    pub(super) fn take_spots(&mut self, spots: Vec<Spot>) {
        spots.into_iter().for_each(|spot| self.take(spot.patch, spot.off));
    }

    /// Takes all patches of another one.
    pub(super) fn take_all(&mut self, other: Quilt) {
        self.error = self.error.max(other.error);
        self.patches.extend(other.patches);
        self.measures.extend(other.measures);
        self.spots.extend(other.spots);
    }

    /// The area of all patches, those that were left out included.
    fn area(&self) -> f64 {
        let taken: f64 = self.measures.iter().map(|[_, area]| area).sum();
        taken + self.spots.iter().map(|spot| area_of(&spot.patch)).sum::<f64>()
    }

    /// No more than this part of them, by area, is farther off than the result, which is `least` or
    /// more.
    pub(super) fn tolerance(&self, part: f64, least: f64) -> f64 {
        let mut far: Vec<[f64; 2]> = self.measures.iter().filter(|[off, _]| *off > least).copied().collect();
        far.sort_by(|a, b| b[0].total_cmp(&a[0]));
        let mut left = part * self.area();
        for [off, area] in far {
            left -= area;
            if left < 0.0 {
                return off;
            }
        }
        least
    }
}

/// Sees every now and then whether the work may go on.
fn often(number: usize, run: &Run) -> Result<(), Cancelled> {
    if number.is_multiple_of(4096) { run.check() } else { Ok(()) }
}

/// The area of a patch's triangle.
fn area_of(patch: &Patch) -> f64 {
    let [a, b, c] = patch.corners;
    0.5 * (b - a).cross(c - a).length()
}

/// The triangles as pieces, and their sides.
fn first(facets: &Facets, seams: &mut Seams) -> Vec<Piece> {
    let piece = |(corners, normals): (&[u32; 3], &[DVec3; 3])| {
        let hems = [0, 1, 2].map(|k| {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            let toward = facets.positions[corners[last] as usize];
            seams.hem([corners[k], corners[next]], toward, [normals[k], normals[next]])
        });
        Piece { corners: *corners, normals: *normals, hems, before: f64::INFINITY }
    };
    facets.triangles.iter().zip(&facets.normals).map(piece).collect()
}

/// Finds the sides of pieces that pass over a crease from one face to another.
fn cross<'a>(
    pieces: impl Iterator<Item = &'a Piece>,
    positions: &[DVec3],
    seams: &mut Seams,
    slopes: &Slopes<'_>,
    run: &Run,
) -> Result<(), Cancelled> {
    let mut asked = HashMap::new();
    for piece in pieces {
        for (k, hem) in piece.hems.iter().enumerate() {
            let ends = [piece.normals[k], piece.normals[(k + 1) % 3]];
            let is_open = !seams.of(*hem).is_crease && ends[0].distance(ends[1]) > 2.0 * CREASE;
            if is_open && !asked.contains_key(&hem.seam) {
                asked.insert(hem.seam, if hem.side == 1 { [ends[1], ends[0]] } else { ends });
            }
        }
    }
    let mut asked: Vec<(u32, [DVec3; 2])> = asked.into_iter().collect();
    asked.sort_by_key(|(seam, _)| *seam);
    seams.cross(&asked, positions, slopes, run)
}

/// How far patches are off the surface, and how far turned from it.
fn errors(patches: &[Patch], slopes: &Slopes<'_>, run: &Run) -> Result<Vec<Residual>, Cancelled> {
    let of_patch = |(patch, found): (&Patch, &[Slope])| {
        let off = found.iter().map(Slope::distance).fold(0.0, f64::max);
        let turn = PROBES.iter().zip(found).map(|(b, slope)| patch.normal(*b).angle_between(slope.normal()));
        let turn = turn.filter(|turn| turn.is_finite()).fold(0.0, f64::max);
        Residual { off: BETWEEN * off, turn, rim: 0.0 }
    };
    let mut errors = Vec::with_capacity(patches.len());
    for patches in patches.chunks(AT_ONCE) {
        let points: Vec<DVec3> = patches.iter().flat_map(|patch| PROBES.map(|b| patch.point(b))).collect();
        let found = slopes.at(&points, run)?;
        errors.extend(patches.iter().zip(found.chunks(PROBES.len())).map(of_patch));
    }
    Ok(errors)
}

impl Piece {
    fn patch(&self, positions: &[DVec3], seams: &Seams, tolerance: f64) -> Patch {
        let corners = self.corners.map(|v| positions[v as usize]);
        let bulges = self.hems.map(|hem| seams.of(hem).bend(positions));
        // What is bent by less counts as flat.
        if bulges.iter().all(|bend| bend.length() < 1e-2 * tolerance) {
            return Patch::flat(corners);
        }
        Patch { corners, bulges }
    }

    /// Its parts: those on either side of a crease that passes through it, else four.
    fn split(&self, positions: &mut Vec<DVec3>, seams: &mut Seams, parts: &mut Vec<Piece>) {
        let crossed: Vec<usize> = (0..3).filter(|k| seams.of(self.hems[*k]).crossing.is_some()).collect();
        match crossed[..] {
            [at] => self.split_from(at, positions, seams, parts),
            [first, second] => {
                // The corner that both sides start from is alone on its side of the crease.
                let alone = if (first + 1) % 3 == second { second } else { first };
                self.split_off(alone, positions, seams, parts);
            }
            _ => self.split_in_four(positions, seams, parts),
        }
    }

    /// A side is crossed: two parts, from there to the opposite corner.
    fn split_from(&self, at: usize, positions: &mut Vec<DVec3>, seams: &mut Seams, parts: &mut Vec<Piece>) {
        let (next, last) = ((at + 1) % 3, (at + 2) % 3);
        let [a, b, c] = [at, next, last].map(|k| self.corners[k]);
        let (m, [of_a, of_b]) = seams.crossing(self.hems[at], positions);
        let crease = seams.ridge([m, c], [a, b].map(|v| positions[v as usize]));
        // The opposite corner is on the crease, and has the normal of either side.
        let normals = |own: DVec3, other: DVec3| [own, other, nearer(self.normals[last], other)];
        let (n_a, n_b) = (self.normals[at], self.normals[next]);
        let left = seams.hem([a, m], positions[c as usize], [n_a, of_a]);
        let right = seams.hem([m, b], positions[c as usize], [of_b, n_b]);
        parts.push(Piece {
            corners: [a, m, c],
            normals: normals(self.normals[at], of_a),
            hems: [left, crease, self.hems[last]],
            before: f64::INFINITY,
        });
        let [n_b, n_m, n_c] = normals(self.normals[next], of_b);
        parts.push(Piece {
            corners: [m, b, c],
            normals: [n_m, n_b, n_c],
            hems: [right, self.hems[next], crease.other()],
            before: f64::INFINITY,
        });
    }

    /// Both sides at a corner are crossed: the corner's part, and two beyond the crease.
    fn split_off(&self, at: usize, positions: &mut Vec<DVec3>, seams: &mut Seams, parts: &mut Vec<Piece>) {
        let (next, last) = ((at + 1) % 3, (at + 2) % 3);
        let [a, b, c] = [at, next, last].map(|k| self.corners[k]);
        let (m, [m_a, m_b]) = seams.crossing(self.hems[at], positions);
        let (k, [k_c, k_a]) = seams.crossing(self.hems[last], positions);
        let crease = seams.ridge([m, k], [a, b].map(|v| positions[v as usize]));
        let p = |v: u32| positions[v as usize];
        let [n_a, n_b, n_c] = [at, next, last].map(|k| self.normals[k]);
        let (am, mb) = (seams.hem([a, m], p(k), [n_a, m_a]), seams.hem([m, b], p(c), [m_b, n_b]));
        let (ck, ka) = (seams.hem([c, k], p(b), [n_c, k_c]), seams.hem([k, a], p(m), [k_a, n_a]));
        parts.push(Piece {
            corners: [a, m, k],
            normals: [self.normals[at], m_a, k_a],
            hems: [am, crease, ka],
            before: f64::INFINITY,
        });
        let diagonal = seams.hem([k, b], p(m), [k_c, n_b]);
        parts.push(Piece {
            corners: [m, b, k],
            normals: [m_b, self.normals[next], k_c],
            hems: [mb, diagonal.other(), crease.other()],
            before: f64::INFINITY,
        });
        parts.push(Piece {
            corners: [k, b, c],
            normals: [k_c, self.normals[next], self.normals[last]],
            hems: [diagonal, self.hems[next], ck],
            before: f64::INFINITY,
        });
    }

    /// Four parts, at the middles of the sides.
    fn split_in_four(&self, positions: &mut Vec<DVec3>, seams: &mut Seams, parts: &mut Vec<Piece>) {
        let middles = self.hems.map(|hem| seams.vertex(hem, positions));
        let between = self.hems.map(|hem| seams.normal(hem));
        let [ab, bc, ca] = middles;
        let outer = |seams: &mut Seams, at: usize| {
            let last = (at + 2) % 3;
            let (corner, to, from) = (self.corners[at], middles[at], middles[last]);
            let normals = [self.normals[at], between[at], between[last]];
            let inner = seams.hem([to, from], positions[corner as usize], [normals[1], normals[2]]);
            let first = seams.part([corner, to], self.hems[at], [normals[0], normals[1]]);
            let second = seams.part([from, corner], self.hems[last], [normals[2], normals[0]]);
            Piece { corners: [corner, to, from], normals, hems: [first, inner, second], before: f64::INFINITY }
        };
        parts.extend([0, 1, 2].map(|at| outer(seams, at)));
        let hems = [
            seams.hem([ab, bc], positions[ca as usize], [between[0], between[1]]),
            seams.hem([bc, ca], positions[ab as usize], [between[1], between[2]]),
            seams.hem([ca, ab], positions[bc as usize], [between[2], between[0]]),
        ];
        parts.push(Piece { corners: middles, normals: between, hems, before: f64::INFINITY });
    }
}

/// A corner's own normal, if that is on the same side of a crease as another one.
fn nearer(own: DVec3, other: DVec3) -> DVec3 {
    if own.distance(other) < CREASE { own } else { other }
}
