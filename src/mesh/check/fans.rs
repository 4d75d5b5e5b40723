//! The triangles around the vertices: what is closed, manifold, connected and folded.
//!
//! ```text
//!       q1 ----- q0        Around its corner v, the triangle [v, q0, q1] is a step from q0
//!       / \     / \        to q1. At a manifold vertex the steps make a single ring, or at
//!      /   \   /   \       a boundary a single path. Every edge v–q is a step's start once
//!    q2 --- v ----- q5     and a step's end once: two triangles, opposite directions.
//!      \   / \   /
//!       \ /   \ /          The fan is *flat* if, looked at along some direction, it goes
//!       q3 ----- q4        round v anticlockwise, once at most. Then no two of its
//!                          triangles meet in more than v and the edges they share.
//! ```
//!
//! The direction tried is that of the sum of the triangles' normals, in f64: every step must
//! turn by an angle that is clearly between 0 and π, and the steps together by one full turn
//! in a ring and by less in a path. Both are found with margins far above the rounding, so
//! that "flat" is a proof; what is not flat may still be sound, and is looked at pair by pair.
//!
//! Triangles with a repeated index take no part.

use glam::DVec3;

use crate::geom::Mesh;
use crate::mesh::groups::Groups;
use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// The sine of the turn of a step, at least, as a part of the product of its sides.
const TURN: f64 = 1e-8;

/// The sine by which a point counts as beyond the ray where the turning began.
const BEYOND: f64 = 1e-11;

/// The square of the cosine between a side and the direction looked along, at most: seen so,
/// a side keeps a seventh of its length, and [`TURN`] stays well above [`BEYOND`].
const STEEP: f64 = 0.98;

/// A chunk of vertices for a thread.
const CHUNK: usize = 1 << 12;

/// What the triangles around the vertices tell.
pub(super) struct Fans {
    /// Vertices that a triangle uses.
    pub used: usize,
    pub edges: usize,
    pub boundary_edges: usize,
    pub non_manifold_edges: usize,
    pub non_manifold_vertices: usize,
    pub duplicate_triangles: usize,
    /// Connected pieces, by edges.
    pub shells: usize,
    /// For each vertex, whether its fan is flat.
    pub flat: Vec<bool>,
}

/// A triangle around one of its vertices.
#[derive(Clone, Copy, Default)]
struct Step {
    from: u32,
    to: u32,
    triangle: u32,
}

/// What the steps around one vertex tell; edges are counted at their lower vertex.
#[derive(Clone, Copy, Default)]
struct Tally {
    used: usize,
    edges: usize,
    boundary: usize,
    edges_off: usize,
    vertices_off: usize,
    duplicates: usize,
}

impl Tally {
    fn add(self, other: Tally) -> Tally {
        Tally {
            used: self.used + other.used,
            edges: self.edges + other.edges,
            boundary: self.boundary + other.boundary,
            edges_off: self.edges_off + other.edges_off,
            vertices_off: self.vertices_off + other.vertices_off,
            duplicates: self.duplicates + other.duplicates,
        }
    }
}

impl Fans {
    pub(super) fn new(mesh: &Mesh, run: &Run) -> Result<Fans, Cancelled> {
        let vertices = mesh.positions().len();
        // How long each stage takes, more or less.
        let [to_sort, to_look, to_join] = run.stages([0.3, 0.4, 0.3]);
        let (starts, mut steps) = steps_by_vertex(mesh, &to_sort)?;
        let mut flat = vec![false; vertices];

        // Each chunk of vertices owns the steps around them.
        let mut rest = &mut steps[..];
        let mut chunks = Vec::with_capacity(vertices / CHUNK + 1);
        for (chunk, flat) in flat.chunks_mut(CHUNK).enumerate() {
            let first = chunk * CHUNK;
            let length = (starts[first + flat.len()] - starts[first]) as usize;
            let (own, others) = rest.split_at_mut(length);
            rest = others;
            chunks.push((first, flat, own));
        }
        let meter = Meter::new(&to_look, chunks.len());
        let tallies = jobs::try_taking(chunks, |(first, flat, own)| {
            meter.step()?;
            let mut tally = Tally::default();
            let mut scratch = Vec::new();
            let offset = starts[first];
            for (i, flat) in flat.iter_mut().enumerate() {
                let [low, high] = [starts[first + i], starts[first + i + 1]].map(|s| (s - offset) as usize);
                if low < high {
                    let vertex = (first + i) as u32;
                    tally = tally.add(look(vertex, &mut own[low..high], &mut scratch));
                    *flat = is_flat(mesh, vertex, &own[low..high]);
                }
            }
            Ok::<Tally, Cancelled>(tally)
        })?;
        let tally = tallies.into_iter().fold(Tally::default(), Tally::add);
        Ok(Fans {
            used: tally.used,
            edges: tally.edges,
            boundary_edges: tally.boundary,
            non_manifold_edges: tally.edges_off,
            non_manifold_vertices: tally.vertices_off,
            duplicate_triangles: tally.duplicates,
            shells: shells(mesh, &starts, &steps, &to_join)?,
            flat,
        })
    }
}

/// Whether a triangle names a vertex twice.
pub(super) fn repeats([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// The steps, put together by vertex with a counting sort: those of vertex v are
/// `steps[starts[v]..starts[v + 1]]`, in the order of the triangles.
fn steps_by_vertex(mesh: &Mesh, run: &Run) -> Result<(Vec<u64>, Vec<Step>), Cancelled> {
    let vertices = mesh.positions().len();
    let mut starts = vec![0u64; vertices + 1];
    let meter = Meter::new(run, 2 * mesh.triangles().len().div_ceil(CHUNK));
    for triangles in mesh.triangles().chunks(CHUNK) {
        meter.step()?;
        for &v in triangles.iter().filter(|t| !repeats(**t)).flatten() {
            starts[v as usize + 1] += 1;
        }
    }
    for v in 0..vertices {
        starts[v + 1] += starts[v];
    }
    let mut free = starts.clone();
    let count = starts[vertices] as usize;
    let mut steps = Vec::with_capacity(count);
    while steps.len() < count {
        run.check()?;
        steps.resize(count.min(steps.len() + 16 * CHUNK), Step::default());
    }
    for (chunk, triangles) in mesh.triangles().chunks(CHUNK).enumerate() {
        meter.step()?;
        for (t, &[a, b, c]) in triangles.iter().enumerate().filter(|(_, t)| !repeats(**t)) {
            let triangle = (chunk * CHUNK + t) as u32;
            for (corner, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
                let slot = &mut free[corner as usize];
                steps[*slot as usize] = Step { from, to, triangle };
                *slot += 1;
            }
        }
    }
    Ok((starts, steps))
}

/// Counts what is around a vertex and puts the steps in order along the ring or path, if they
/// make a single one; else by where they start.
fn look(vertex: u32, steps: &mut [Step], scratch: &mut Vec<(u32, bool)>) -> Tally {
    let mut tally = Tally { used: 1, ..Tally::default() };
    let above = |v: u32| usize::from(v > vertex);
    if put_in_order(steps) {
        let (first, last) = (steps[0].from, steps[steps.len() - 1].to);
        tally.edges = steps.iter().map(|s| above(s.from)).sum();
        if last != first {
            tally.edges += above(last);
            tally.boundary = above(first) + above(last);
        } else if let [one, other] = *steps {
            // Two triangles back to back. Each of their three vertices sees them.
            tally.duplicates = usize::from(vertex < one.from.min(other.from));
        }
        return tally;
    }
    tally.vertices_off = 1;
    scratch.clear();
    scratch.extend(steps.iter().flat_map(|s| [(s.from, true), (s.to, false)]));
    scratch.sort_unstable();
    for edge in scratch.chunk_by(|a, b| a.0 == b.0) {
        let own = above(edge[0].0);
        tally.edges += own;
        match edge {
            [_] => tally.boundary += own,
            [(_, false), (_, true)] => {}
            _ => tally.edges_off += own,
        }
    }
    let mut others: Vec<[u32; 2]> = steps.iter().map(|s| [s.from.min(s.to), s.from.max(s.to)]).collect();
    others.sort_unstable();
    tally.duplicates = others.windows(2).filter(|w| w[0] == w[1] && w[0][0] > vertex).count();
    tally
}

/// Puts the steps in order, each where the one before it ends; whether that takes in all of
/// them, and starts and ends do not repeat. If not, they are in the order of their starts.
fn put_in_order(steps: &mut [Step]) -> bool {
    if steps.len() <= 16 {
        if chain(steps) {
            return true;
        }
        // A path must begin with the step that no other leads to.
        if let Some(first) = (0..steps.len()).find(|&i| steps.iter().all(|s| s.to != steps[i].from)) {
            steps.swap(0, first);
            if chain(steps) {
                return true;
            }
        }
        steps.sort_unstable_by_key(|s| (s.from, s.to, s.triangle));
        return false;
    }
    // Many: found by bisection instead.
    steps.sort_unstable_by_key(|s| (s.from, s.to, s.triangle));
    if steps.windows(2).any(|w| w[0].from == w[1].from) {
        return false;
    }
    let sorted = steps.to_vec();
    let find = |from: u32| sorted.binary_search_by_key(&from, |s| s.from).ok();
    let mut is_reached = vec![false; sorted.len()];
    for step in &sorted {
        if let Some(i) = find(step.to) {
            is_reached[i] = true;
        }
    }
    let first = is_reached.iter().position(|&r| !r).unwrap_or(0);
    let mut order = vec![sorted[first]];
    let mut at = first;
    while let Some(next) = find(sorted[at].to)
        && next != first
        && order.len() < sorted.len()
    {
        order.push(sorted[next]);
        at = next;
    }
    // A path that ends in a loop visits some steps twice and others never.
    let closed_or_free = find(sorted[at].to).is_none_or(|next| next == first);
    if order.len() < sorted.len() || !closed_or_free {
        return false;
    }
    steps.copy_from_slice(&order);
    true
}

/// Swaps the steps into a chain from the first one; whether all of them are in it, and none
/// leads back into its midst.
fn chain(steps: &mut [Step]) -> bool {
    for i in 1..=steps.len() {
        let (done, rest) = steps.split_at_mut(i);
        let end = done[i - 1].to;
        let closes = done[0].from == end;
        if (closes && !rest.is_empty()) || done[1..].iter().any(|s| s.from == end) {
            return false;
        }
        match rest.iter().position(|s| s.from == end) {
            Some(next) => rest.swap(0, next),
            None => return rest.is_empty(),
        }
    }
    true
}

/// Whether the fan is flat, of steps in order; false is no proof of the contrary.
fn is_flat(mesh: &Mesh, vertex: u32, steps: &[Step]) -> bool {
    let at = |v: u32| mesh.positions()[v as usize].as_dvec3();
    let v = at(vertex);
    let mut direction = DVec3::ZERO;
    let mut side = at(steps[0].from) - v;
    let first = side;
    let mut end = steps[0].from;
    for step in steps {
        if step.from != end {
            return false;
        }
        let next = at(step.to) - v;
        direction += side.cross(next);
        (side, end) = (next, step.to);
    }
    let square = direction.length_squared();
    let axis = first.cross(direction);

    side = first;
    let (first_length, mut length) = (first.length(), first.length());
    let size = square.sqrt();
    let is_steep = |side: DVec3, length: f64| {
        let rise = side.dot(direction);
        rise * rise > STEEP * (length * length) * square
    };
    if is_steep(first, first_length) {
        return false;
    }
    let mut is_before = false;
    let mut turns = 0;
    for step in steps {
        let next = at(step.to) - v;
        let next_length = next.length();
        let turn = side.cross(next).dot(direction);
        let is_clear = turn > TURN * length * next_length * size;
        if !is_clear || is_steep(next, next_length) {
            return false;
        }
        // (direction × first) · next, which is negative in the second half of a turn.
        let was_before = is_before;
        is_before = -axis.dot(next) < -BEYOND * first_length * next_length * size;
        turns += usize::from(was_before && !is_before);
        (side, length) = (next, next_length);
    }
    turns == usize::from(end == steps[0].from)
}

/// The number of pieces that hang together by edges.
fn shells(mesh: &Mesh, starts: &[u64], steps: &[Step], run: &Run) -> Result<usize, Cancelled> {
    let mut groups = Groups::new(mesh.triangles().len());
    let mut count = steps.len() / 3;
    let meter = Meter::new(run, starts.len() / CHUNK);
    for (vertex, range) in starts.windows(2).enumerate() {
        if vertex % CHUNK == CHUNK - 1 {
            meter.step()?;
        }
        let fan = &steps[range[0] as usize..range[1] as usize];
        let mut join = |a: u32, b: u32| count -= usize::from(groups.join(a, b));
        if fan.windows(2).all(|w| w[0].to == w[1].from) {
            fan.windows(2).for_each(|w| join(w[0].triangle, w[1].triangle));
            if let [first, .., last] = fan
                && last.to == first.from
            {
                join(last.triangle, first.triangle);
            }
        } else {
            let mut ends: Vec<(u32, u32)> =
                fan.iter().flat_map(|s| [(s.from, s.triangle), (s.to, s.triangle)]).collect();
            ends.sort_unstable();
            ends.windows(2).filter(|w| w[0].0 == w[1].0).for_each(|w| join(w[0].1, w[1].1));
        }
    }
    Ok(count)
}
