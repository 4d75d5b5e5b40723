//! Plots of a mesh (k-d median splits, each with the boundary edges of its neighbours, a halo):
//! sewn one after the other, so that the sides of one alone are in memory.
//!
//! ```text
//!      \  / \  / \  /
//!     --\/___\/___\/--     Triangles are parted at the medians of their middles until few are together. A
//!       /\   /\   /\       side where plots meet is in each of them, and each is told what the other has
//!     --  \ /  \ /  --     beyond it: so both find the same, to within rounding.
//! ```

use glam::DVec3;

use super::facets::Facets;

/// A part of a mesh.
#[derive(Default)]
pub(super) struct Plot {
    pub(super) facets: Facets,
    /// Its sides to other plots, as triangles beyond have them.
    pub(super) rims: Vec<Rim>,
}

/// A side of a triangle of another plot.
#[derive(Clone, Copy)]
pub(super) struct Rim {
    pub(super) ends: [u32; 2],
    pub(super) toward: DVec3,
    pub(super) normals: [DVec3; 2],
    /// Whether the triangle has a corner on a crease.
    pub(super) is_by_crease: bool,
}

/// The plots of a mesh, in turn.
pub(super) struct Plots {
    facets: Facets,
    /// The triangles, plot by plot, and where plots end.
    order: Vec<u32>,
    ends: Vec<usize>,
    /// Sides of triangles that are a plot's and another one's: whose, and the triangle and side of
    /// the other.
    shared: Vec<(usize, u32, u8)>,
    /// The vertices on creases.
    creased: Vec<bool>,
    /// Vertices as the plot that is made counts them.
    own: Vec<u32>,
    next: usize,
}

/// No vertex.
const NONE: u32 = u32::MAX;

impl Plots {
    /// Plots of so many triangles at most.
    pub(super) fn new(facets: Facets, most: usize) -> Plots {
        let (order, ends) = parted(&facets, most);
        let shared = shared(&facets, &order, &ends);
        let own = vec![NONE; facets.positions.len()];
        let creased = facets.creased();
        Plots { facets, order, ends, shared, creased, own, next: 0 }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// How many triangles are in those to come.
    pub(super) fn left(&self) -> usize {
        self.order.len() - self.from(self.next)
    }

    fn from(&self, number: usize) -> usize {
        number.checked_sub(1).map_or(0, |before| self.ends[before])
    }
}

impl Iterator for Plots {
    type Item = Plot;

    fn next(&mut self) -> Option<Plot> {
        let number = self.next;
        let end = *self.ends.get(number)?;
        let triangles = self.from(number)..end;
        self.next += 1;
        if self.ends.len() == 1 {
            return Some(Plot { facets: std::mem::take(&mut self.facets), rims: Vec::new() });
        }
        let (all, own) = (&self.facets, &mut self.own);
        let mut plot = Plot::default();
        for number in &self.order[triangles] {
            let corners = all.triangles[*number as usize].map(|vertex| {
                let place = &mut own[vertex as usize];
                if *place == NONE {
                    *place = plot.facets.positions.len() as u32;
                    plot.facets.positions.push(all.positions[vertex as usize]);
                }
                *place
            });
            plot.facets.triangles.push(corners);
            plot.facets.normals.push(all.normals[*number as usize]);
        }
        let first = self.shared.partition_point(|(of, ..)| *of < number);
        for (_, triangle, side) in self.shared[first..].iter().take_while(|(of, ..)| *of == number) {
            let [a, b, c] = [0, 1, 2].map(|k| (usize::from(*side) + k) % 3);
            let (corners, normals) = (all.triangles[*triangle as usize], all.normals[*triangle as usize]);
            plot.rims.push(Rim {
                ends: [a, b].map(|k| own[corners[k] as usize]),
                toward: all.positions[corners[c] as usize],
                normals: [a, b].map(|k| normals[k]),
                is_by_crease: corners.iter().any(|corner| self.creased[*corner as usize]),
            });
        }
        for number in &self.order[self.from(number)..end] {
            self.facets.triangles[*number as usize].iter().for_each(|vertex| self.own[*vertex as usize] = NONE);
        }
        Some(plot)
    }
}

/// Triangles in an order in which plots are together, and where these end.
fn parted(facets: &Facets, most: usize) -> (Vec<u32>, Vec<usize>) {
    let mut order: Vec<u32> = (0..facets.triangles.len() as u32).collect();
    let middle =
        |number: &u32| facets.triangles[*number as usize].map(|v| facets.positions[v as usize]).iter().sum::<DVec3>();
    let (mut ends, mut pending) = (Vec::new(), vec![(0, order.len())]);
    while let Some((from, to)) = pending.pop() {
        let part = &mut order[from..to];
        if part.len() <= most {
            ends.push(to);
            continue;
        }
        let (low, high) = part
            .iter()
            .map(middle)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let axis = (high - low).max_position();
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
        pending.extend([(from + half, to), (from, from + half)]);
    }
    (order, ends)
}

/// The sides of triangles that plots share, by the plot that is told of them.
fn shared(facets: &Facets, order: &[u32], ends: &[usize]) -> Vec<(usize, u32, u8)> {
    if ends.len() < 2 {
        return Vec::new();
    }
    const SEVERAL: u32 = u32::MAX - 1;
    let mut plots = vec![NONE; facets.positions.len()];
    let of_plots = || {
        let starts = [0].into_iter().chain(ends.iter().copied());
        starts
            .zip(ends)
            .enumerate()
            .flat_map(move |(plot, (from, to))| order[from..*to].iter().map(move |t| (plot, *t)))
    };
    for (plot, triangle) in of_plots() {
        for vertex in facets.triangles[triangle as usize] {
            let known = &mut plots[vertex as usize];
            *known = if [NONE, plot as u32].contains(known) { plot as u32 } else { SEVERAL };
        }
    }
    let mut sides: Vec<([u32; 2], usize, u32, u8)> = Vec::new();
    for (plot, triangle) in of_plots() {
        let corners = facets.triangles[triangle as usize];
        for side in 0..3u8 {
            let [a, b] = [0, 1].map(|k| corners[(usize::from(side) + k) % 3]);
            if plots[a as usize] == SEVERAL && plots[b as usize] == SEVERAL {
                sides.push(([a.min(b), a.max(b)], plot, triangle, side));
            }
        }
    }
    sides.sort_unstable();
    let mut shared = Vec::new();
    for group in sides.chunk_by(|a, b| a.0 == b.0) {
        for (_, plot, ..) in group {
            let others = group.iter().filter(|(_, other, ..)| other != plot);
            shared.extend(others.map(|(_, _, triangle, side)| (*plot, *triangle, *side)));
        }
    }
    shared.sort_unstable();
    shared.dedup();
    shared
}
