//! Facets of a mesh, and its vertices where it is curved.
//!
//! A facet of a cylinder is a chord: what is sampled on it is off the surface by the sagitta, and
//! its normal is right in its middle only. A vertex is on the surface, and the normal there is the
//! mean of the facets' by weights sin α/(|e₁||e₂|), which make it exact on spheres and cylinders.
//!
//! Source: N. Max, *Weights for computing vertex normals from facet normals* (1999).

use std::collections::HashMap;

use glam::DVec3;

use crate::{Cancelled, Run};

/// Facets that meet at less than this angle are of one curved surface: prisms of 12 sides are not,
/// of 14 are.
const SMOOTH: f64 = 28.5;

/// Normals closer than this, in degrees, are one facet's.
const FLAT: f64 = 0.4;

/// So many facets are gone through between two looks at whether the run is cancelled.
const CHUNK: usize = 1 << 14;

/// A vertex where the surface is curved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
    /// The angle between the normals of the facets there, in radians.
    pub(super) step: f64,
    /// Corners of one smooth part of the mesh have the same number.
    pub(super) part: u32,
}

/// The triangles of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    pub(super) normals: Vec<DVec3>,
    pub(super) areas: Vec<f64>,
}

impl Facets {
    pub(super) fn of(points: Vec<DVec3>, triangles: &[[u32; 3]], run: &Run) -> Result<Facets, Cancelled> {
        let triangles = welded(&points, triangles, run)?;
        let (mut normals, mut areas) = (Vec::with_capacity(triangles.len()), Vec::with_capacity(triangles.len()));
        for chunk in triangles.chunks(CHUNK) {
            run.check()?;
            for t in chunk {
                let [a, b, c] = t.map(|i| points[i as usize]);
                let cross = (b - a).cross(c - a);
                normals.push(cross.normalize_or_zero());
                areas.push(0.5 * cross.length());
            }
        }
        Ok(Facets { points, triangles, normals, areas })
    }

    /// The vertices' numbers, such at one position being one.
    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Where a vertex is.
    pub(super) fn at(&self, vertex: u32) -> DVec3 {
        self.points[vertex as usize]
    }

    /// The corners of a facet.
    pub(super) fn points(&self, facet: usize) -> [DVec3; 3] {
        self.triangles[facet].map(|i| self.points[i as usize])
    }

    /// Whether there are that many facets, and nine tenths of the area are of small ones.
    pub(super) fn is_fine(&self, many: usize, small: f64) -> bool {
        let longest = |facet: usize| {
            let [a, b, c] = self.points(facet);
            a.distance(b).max(b.distance(c)).max(c.distance(a))
        };
        let all: f64 = self.areas.iter().sum();
        let fine: f64 = (0..self.areas.len()).filter(|i| longest(*i) < small).map(|i| self.areas[i]).sum();
        self.areas.len() >= many && fine >= 0.9 * all
    }

    /// The edges, each with the facets that it is of: by vertices, those of a vertex with the
    /// lesser number together.
    fn edges(&self, run: &Run) -> Result<Vec<(u32, u32, u32)>, Cancelled> {
        let of_facet = |t: &[u32; 3]| [0, 1, 2].map(|k| (t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3])));
        // Where the edges of each vertex begin.
        let mut starts = vec![0_usize; self.points.len() + 1];
        for chunk in self.triangles.chunks(CHUNK) {
            run.check()?;
            chunk.iter().flat_map(of_facet).for_each(|(a, _)| starts[a as usize + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut edges = vec![(0, 0, 0); 3 * self.triangles.len()];
        let mut next = starts.clone();
        for (chunk, triangles) in self.triangles.chunks(CHUNK).enumerate() {
            run.check()?;
            for (facet, t) in (0u32..).zip(triangles) {
                for (a, b) in of_facet(t) {
                    edges[next[a as usize]] = (a, b, facet + (chunk * CHUNK) as u32);
                    next[a as usize] += 1;
                }
            }
        }
        for (vertex, range) in starts.windows(2).enumerate() {
            if vertex % CHUNK == 0 {
                run.check()?;
            }
            edges[range[0]..range[1]].sort_unstable();
        }
        Ok(edges)
    }

    /// The vertices where the surface is curved, once for each smooth surface that meets there.
    pub(super) fn corners(&self, run: &Run) -> Result<Vec<Corner>, Cancelled> {
        let smooth = SMOOTH.to_radians().cos();
        let edges = self.edges(run)?;
        let mut parts = Joined::new(self.triangles.len());
        // The three corners of each facet, joined about their vertices.
        let mut fans = Joined::new(3 * self.triangles.len());
        for (i, pair) in edges.windows(2).enumerate() {
            if i % CHUNK == 0 {
                run.check()?;
            }
            let ((a, b, f), (c, d, g)) = (pair[0], pair[1]);
            let (n, m) = (self.normals[f as usize], self.normals[g as usize]);
            if (a, b) != (c, d) || n.dot(m) < smooth {
                continue;
            }
            parts.join(f, g);
            for v in [a, b] {
                fans.join(self.corner(f, v), self.corner(g, v));
            }
        }
        let mut sums: HashMap<u32, usize> = HashMap::new();
        let mut found: Vec<(Corner, DVec3)> = Vec::new();
        for (facet, t) in (0u32..).zip(&self.triangles) {
            if (facet as usize).is_multiple_of(CHUNK) {
                run.check()?;
            }
            let normal = self.normals[facet as usize];
            if normal == DVec3::ZERO {
                continue;
            }
            for k in 0..3 {
                let point = self.points[t[k] as usize];
                let [u, v] = [1, 2].map(|j| self.points[t[(k + j) % 3] as usize] - point);
                let weight = u.cross(v).length() / (u.length_squared() * v.length_squared());
                let fan = fans.root(3 * facet + k as u32);
                let at = *sums.entry(fan).or_insert(found.len());
                if at == found.len() {
                    let part = parts.root(facet);
                    found.push((Corner { point, normal: DVec3::ZERO, step: 0.0, part }, normal));
                }
                let (corner, first) = &mut found[at];
                corner.normal += weight * normal;
                corner.step = corner.step.max(first.angle_between(normal));
            }
        }
        let mut corners: Vec<Corner> =
            found.into_iter().map(|f| f.0).filter(|corner| corner.step > FLAT.to_radians()).collect();
        for corner in &mut corners {
            corner.normal = corner.normal.normalize_or(DVec3::Z);
        }
        Ok(corners)
    }

    /// The number of a facet's corner at a vertex.
    fn corner(&self, facet: u32, vertex: u32) -> u32 {
        let at = self.triangles[facet as usize].iter().position(|v| *v == vertex);
        3 * facet + at.map_or(0, |k| k as u32)
    }
}

/// Triangles whose vertices at one position are one.
fn welded(points: &[DVec3], triangles: &[[u32; 3]], run: &Run) -> Result<Vec<[u32; 3]>, Cancelled> {
    let mut first: HashMap<[u64; 3], u32> = HashMap::with_capacity(points.len());
    let mut names: Vec<u32> = Vec::with_capacity(points.len());
    for (i, p) in (0u32..).zip(points) {
        if (i as usize).is_multiple_of(CHUNK) {
            run.check()?;
        }
        names.push(*first.entry(p.to_array().map(|x| (x + 0.0).to_bits())).or_insert(i));
    }
    Ok(triangles.iter().map(|t| t.map(|i| names[i as usize])).collect())
}

/// Sets that are joined: each is known by its least member.
struct Joined(Vec<u32>);

impl Joined {
    fn new(count: usize) -> Joined {
        Joined((0..count as u32).collect())
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[i as usize];
            self.0[i as usize] = self.0[up as usize];
            i = up;
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
