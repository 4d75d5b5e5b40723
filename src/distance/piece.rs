//! Triangles as they are sewn together, and how they are split.

use glam::DVec3;

use super::facets::CREASE;
use super::plots::Plot;
use super::seam::{Hem, Seams};
use rvachev_field::Patch;

/// A triangle: its corners, their normals, and its sides from each corner to the next.
pub(super) struct Piece {
    pub(super) corners: [u32; 3],
    pub(super) normals: [DVec3; 3],
    pub(super) hems: [Hem; 3],
    /// How far off the patch was that it is a part of.
    pub(super) before: f64,
}

/// The triangles of a plot as pieces, and their sides.
pub(super) fn first(plot: &Plot, seams: &mut Seams) -> Vec<Piece> {
    let facets = &plot.facets;
    let piece = |(corners, normals): (&[u32; 3], &[DVec3; 3])| {
        let hems = [0, 1, 2].map(|k| {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            let toward = facets.positions[corners[last] as usize];
            seams.hem([corners[k], corners[next]], toward, [normals[k], normals[next]])
        });
        Piece { corners: *corners, normals: *normals, hems, before: f64::INFINITY }
    };
    let pieces = facets.triangles.iter().zip(&facets.normals).map(piece).collect();
    for rim in &plot.rims {
        let hem = seams.hem(rim.ends, rim.toward, rim.normals);
        if rim.is_by_crease {
            seams.watch(hem);
        }
    }
    pieces
}

impl Piece {
    pub(super) fn patch(&self, positions: &[DVec3], seams: &Seams, tolerance: f64) -> Patch {
        let corners = self.corners.map(|v| positions[v as usize]);
        let displacements = self.hems.map(|hem| seams.of(hem).bend(positions));
        // What is bent by less counts as flat.
        if displacements.iter().all(|bend| bend.length() < 1e-2 * tolerance) {
            return Patch::flat(corners);
        }
        Patch { corners, displacements }
    }

    /// How far its sides are off.
    pub(super) fn rim(&self, seams: &Seams) -> f64 {
        self.hems.iter().map(|hem| seams.of(*hem).off).fold(0.0, f64::max)
    }

    /// Its parts: those on either side of a crease that passes through it, else four.
    pub(super) fn split(&self, positions: &mut Vec<DVec3>, seams: &mut Seams, parts: &mut Vec<Piece>) {
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
