//! Regions: cells that share a fan, where a crease passes a cell that has no surface of its own.
//!
//! ```text
//!     +-------+-------+        The crease leaves A, cuts the corner of C, and goes on in D. All nodes
//!     |  A  . | - . C |        of C are outside, so the mesh has nothing there: the point of E,
//!     |  .    |     . |        held in E, is too low by the depth of the cut. The four cells
//!     o-------+-------o        together are convex and have a single loop, as the edge in the
//!     |   E   |  D   .|        middle is not crossed: they can have one fan, whose point may
//!     |       |       |        be anywhere in the four, on the crease.
//!     o-------o-------+
//! ```
//!
//! A cell asks for a region if the planes of its sides meet outside. First it asks for a slab, so
//! that the crease has a point in each layer of cells: the box of cells up to where the planes meet
//! in its own layer, across the axis that the crease goes along most, or else across the next one.
//! Then it asks for the box up to where they meet at all. Last come cells and regions whose crease
//! leaves them through an empty cell, which is to be theirs as well, and regions that are still
//! off. A box that cuts into regions is merged with them; one for a slab only if that makes a slab.
//! A region comes about if
//!
//! * it has up to four cells along each axis;
//! * the patches of the box make a disc: they hang together and have a single loop as boundary,
//!   without holes or handles;
//! * the planes of all its cells meet better in the region than those of the cell did in it, or as
//!   well as those of a region have to.
//!
//! The loop lies in the boundary of a convex box then, and what [`sharp`](super::sharp) says of the
//! fans of cells holds for that of the region. A vertex on an edge within the box is in no triangle
//! any more, and is left out.

use glam::{Vec3, Vec3A};

use super::cells::CellSet;
use super::joined::Joined;
use super::patches::{Disc, Patches};
use super::samples::{Samples, cell_number, cell_of, split_cell};
use super::span::{Span, offset};
use super::special::Special;
use crate::mesh::feature::{CLOSE, Candidate, Crease, INSET, Segment, settle};
use crate::mesh::loops::{CellLoop, LONGEST};
use crate::mesh::qef::Planes;
use crate::{Cancelled, Run};
use rvachev_num::{Meter, order};

/// A cell asks for a region if its point is farther from the planes than this, in cells.
pub(super) const RESIDUAL: f32 = 0.02;

/// The most cells along an axis of a region.
const LARGEST: u32 = 4;

const _: () = assert!(LARGEST <= Segment::REACH);

/// How much farther from the planes than allowed the point may be that a request for a region
/// starts from.
const NO_FARTHER: f32 = 1.5;

/// How often regions may grow so.
const ROUNDS: usize = 3;

/// How often the point of a region is sought: the weights of planes depend on it.
const STEPS: usize = 3;

/// A point that is farther than this from the planes, as a part of what is allowed, will not come
/// close enough.
const NO_HOPE: f32 = 1.2;

/// A crease that is in an empty cell for less than this, in cells, asks for nothing.
const SHORT: f32 = 0.05;

/// Cells that share a fan.
pub(super) struct Region {
    /// The block of the cell that asked for it.
    pub(super) block: usize,
    pub(super) segments: Vec<Segment>,
    /// The feature point.
    pub(super) at: Vec3,
    /// The same in cells from the first node of its box, as are the planes.
    place: Vec3A,
    planes: Planes,
    /// The vertices within, ascending.
    pub(super) within: Vec<u32>,
    pub(super) span: Span,
}

/// The regions that candidates ask for, those that fit their planes worst first; in the order of
/// the blocks.
pub(super) fn regions(
    samples: &Samples<'_>,
    special: &Special,
    joined: &Joined,
    run: &Run,
) -> Result<Vec<Region>, Cancelled> {
    let stages = [Stage::Slab(0), Stage::Slab(1), Stage::Box];
    let steps = Meter::new(run, stages.len() + ROUNDS);
    let blocks = samples.blocks().len();
    let mut known = Known {
        samples,
        special,
        joined,
        run,
        taken: vec![Taken::default(); blocks],
        regions: Vec::new(),
        patches: Patches::default(),
    };
    let mut all: Vec<Requester<'_>> = Vec::new();
    for block in 0..blocks {
        run.check()?;
        for candidate in special.candidates(block) {
            if candidate.residual > samples.crease.part * RESIDUAL {
                all.push(Requester::candidate(samples, block, candidate));
            }
        }
    }
    // Regions that stand alone come first: they are smaller than those that others are merged into.
    for stage in stages {
        let mut requests = Vec::new();
        steps.step()?;
        for requester in all.iter().filter(|requester| !known.is_accepted(requester.who, requester.block)) {
            match stage {
                Stage::Slab(nth) => requester.slabs(nth, &mut requests),
                Stage::Box => requester.boxes(&mut requests),
            }
        }
        let mut requests = largest_first(&requests);
        requests.retain(|request| !known.accept(request, false));
        if matches!(stage, Stage::Box) {
            requests.retain(|request| !known.accept(request, true));
        }
    }
    // Then those that creases leave through empty cells.
    let mut asked = 0;
    for round in 0..ROUNDS {
        steps.step()?;
        let mut requests = Vec::new();
        for block in (0..blocks).filter(|_| round == 0) {
            let leaves = special.candidates(block).iter().filter(|candidate| candidate.leaves);
            for candidate in leaves.filter(|candidate| known.own_taken(block, candidate.number).is_none()) {
                let crossed = Segment::faces(special.segments(block, candidate));
                known.exits(&Requester::candidate(samples, block, candidate), crossed, &mut requests);
            }
        }
        // What was not accepted before is not asked for again.
        for (number, region) in known.regions.iter().enumerate().skip(asked) {
            let Some(region) = region else { continue };
            let requester = Requester::region(number, region, samples.crease);
            if requester.planes.distance(requester.at) > 2.0 * samples.crease.part * RESIDUAL {
                requester.slabs(0, &mut requests);
                requester.boxes(&mut requests);
            }
            known.exits(&requester, 0, &mut requests);
        }
        let mut requests = largest_first(&requests);
        asked = known.regions.len();
        requests.retain(|request| request.slab.is_none() || !known.accept(request, false));
        requests.retain(|request| !known.accept(request, true));
        if known.regions.len() == asked {
            break;
        }
    }
    run.check()?;
    let mut regions: Vec<Region> = known.regions.into_iter().flatten().collect();
    order::rising(&mut regions, |region| region.block as f64);
    Ok(regions)
}

/// What cells ask for.
enum Stage {
    /// Slabs across the axis that is the nth of those that the crease goes along.
    Slab(usize),
    /// Any boxes.
    Box,
}

/// The axes that a crease goes along: that which it is closest to, and the next one if it is not
/// much farther from that.
fn axes(along: Vec3A) -> [Option<usize>; 2] {
    let size = along.abs().to_array();
    let mut order = [0, 1, 2];
    order::falling(&mut order, |n| f64::from(size[*n]));
    [Some(order[0]), Some(order[1]).filter(|_| size[order[1]] >= 0.5 * size[order[0]])]
}

/// A cell, or a region by its number.
#[derive(Clone, Copy)]
enum Who<'a> {
    Cell(&'a Candidate),
    Region(usize),
}

/// A cell or a region that may want to be part of a larger one.
struct Requester<'a> {
    who: Who<'a>,
    block: usize,
    span: Span,
    /// The feature point, and what it should be on, in cells from the first node of the box.
    at: Vec3A,
    planes: Planes,
    crease: Crease,
}

impl<'a> Requester<'a> {
    fn candidate(samples: &Samples<'_>, block: usize, candidate: &'a Candidate) -> Requester<'a> {
        let span = Span::single(cell_of(samples.blocks()[block], candidate.number));
        let (at, planes) = (candidate.at.into(), candidate.planes());
        Requester { who: Who::Cell(candidate), block, span, at, planes, crease: samples.crease }
    }

    fn region(number: usize, region: &Region, crease: Crease) -> Requester<'a> {
        let Region { block, span, place, planes, .. } = *region;
        Requester { who: Who::Region(number), block, span, at: place, planes, crease }
    }

    fn request(&self, size: f32, span: Span, at: Vec3A, allowed: f32) -> Request<'a> {
        Request { size, block: self.block, who: self.who, from: self.span.low, span, slab: None, at, allowed }
    }

    /// Requests for slabs up to where the planes meet, across the axis that is the nth of those
    /// that the crease goes along, if it is a slab itself.
    fn slabs(&self, nth: usize, requests: &mut Vec<Request<'a>>) {
        let axis = self.planes.crease(self.crease.pull()).and_then(|along| axes(along)[nth]);
        if let Some(axis) = axis.filter(|&axis| self.span.is_slab(axis)) {
            let mut across = Vec3A::ONE;
            across[axis] = 0.0;
            self.towards([across, 2.0 * across, 3.0 * across], Some(axis), requests);
        }
    }

    /// Requests for the boxes up to where the planes meet.
    fn boxes(&self, requests: &mut Vec<Request<'a>>) {
        self.towards([1.0, 2.0].map(Vec3A::splat), None, requests);
    }

    /// Requests for the boxes up to where the planes meet, among the cells that are so far away
    /// along the axes.
    fn towards<const N: usize>(&self, reaches: [Vec3A; N], slab: Option<usize>, requests: &mut Vec<Request<'a>>) {
        let (residual, mut last) = (self.planes.distance(self.at), self.span);
        for reach in reaches {
            let (first, end) = (-reach, self.span.size() + reach);
            let at = settle(&self.planes, self.at, [first, end], (3, self.crease));
            let low = self.span.low;
            let cell = std::array::from_fn(|axis| low[axis].saturating_add_signed(floor(at[axis])));
            let span = self.span.union(&Span::single(cell));
            if span != last {
                // What is much farther off than allowed here will hardly be close enough in a
                // region.
                let allowed = 0.5 * residual;
                if self.planes.distance(at) <= NO_FARTHER * allowed {
                    requests.push(Request { slab, ..self.request(residual, span, at, allowed) });
                }
                last = span;
            }
            // A point that is held by no side that moves is there among more cells as well.
            let is_free = at.cmpgt(first + INSET) & at.cmplt(end - INSET) | reach.cmpeq(Vec3A::ZERO);
            if is_free.all() {
                break;
            }
        }
    }
}

/// The largest whole number that is not above a small one; `f32::floor` is a call where the
/// processor may be an old one.
fn floor(x: f32) -> i32 {
    let towards_zero = x as i32;
    towards_zero - i32::from(towards_zero as f32 > x)
}

/// A region that a cell, or another region, asks for.
struct Request<'a> {
    /// How far off the mesh may be without it, in cells.
    size: f32,
    /// Who asks, and the block of it.
    who: Who<'a>,
    block: usize,
    span: Span,
    /// The axis along which it is to stay one cell thick, if there is one.
    slab: Option<usize>,
    /// About where the point goes, from the first node of the box of who asks.
    at: Vec3A,
    from: [u32; 3],
    /// How far it may be from the planes.
    allowed: f32,
}

/// Requests in the order that they are accepted in: the mesh gains most by the first.
fn largest_first<'w, 'a>(requests: &'w [Request<'a>]) -> Vec<&'w Request<'a>> {
    let mut order: Vec<&Request<'_>> = requests.iter().collect();
    order::falling(&mut order, |request| f64::from(request.size));
    order
}

struct Known<'a> {
    samples: &'a Samples<'a>,
    special: &'a Special,
    joined: &'a Joined,
    run: &'a Run,
    /// By block.
    taken: Vec<Taken>,
    /// All regions; `None` for those that others are merged from.
    regions: Vec<Option<Region>>,
    /// Memory for the patches at hand.
    patches: Patches<'a>,
}

/// The cells of a block that are in regions, by number, and in which.
#[derive(Clone, Default)]
struct Taken {
    cells: CellSet,
    regions: Vec<(u16, u32)>,
}

impl<'a> Known<'a> {
    /// Makes the region that is requested, if it can be: merged with the regions in its way if it
    /// `merges`, or if that makes a slab of a slab, and else only where there are none. Whether
    /// there is no more to be done for the request.
    fn accept(&mut self, request: &Request<'_>, merges: bool) -> bool {
        if self.is_accepted(request.who, request.block) || self.run.cancel.is_cancelled() {
            return true;
        }
        let mut span = request.span;
        let mut merged: Vec<u32> = Vec::new();
        while let Some(region) =
            span.cells().filter_map(|cell| self.taken(request.block, cell)).find(|region| !merged.contains(region))
        {
            if let Some(other) = &self.regions[region as usize] {
                span = span.union(&other.span);
            }
            merged.push(region);
            let may_merge = merges || request.slab.is_some_and(|axis| span.is_slab(axis));
            if !may_merge || !span.is_small(LARGEST) {
                return merges;
            }
        }
        let mut patches = std::mem::take(&mut self.patches);
        let region = self.region(request, span, &mut patches);
        self.patches = patches;
        let Some(region) = region else { return merged.is_empty() };
        for old in merged {
            self.regions[old as usize] = None;
        }
        for cell in region.span.cells() {
            let (block, within) = split_cell(cell);
            if let Some(block) = self.samples.find_near(request.block, block) {
                self.taken[block].put(cell_number(within), self.regions.len() as u32);
            }
        }
        self.regions.push(Some(region));
        true
    }

    /// The boxes that hold an empty cell as well, which the crease goes on through by a face that
    /// is not crossed.
    fn exits<'w>(&self, requester: &Requester<'w>, crossed: u8, requests: &mut Vec<Request<'w>>) {
        let Some(along) = requester.planes.crease(requester.crease.pull()) else { return };
        for along in [along, -along] {
            let Some((cell, length)) = requester.span.exit(requester.at, along, crossed) else { continue };
            let is_empty = matches!(self.samples.case_near(requester.block, cell), 0 | 255);
            if length > SHORT && is_empty && self.taken(requester.block, cell).is_none() {
                let allowed = requester.planes.distance(requester.at).max(2.0 * requester.crease.part * RESIDUAL);
                let span = requester.span.union(&Span::single(cell));
                let slab = axes(along)[0].filter(|&axis| span.is_slab(axis));
                requests.push(Request { slab, ..requester.request(0.5 * length, span, requester.at, allowed) });
            }
        }
    }

    /// Whether who asks is a cell, of that block, that is in a region already: that is what it
    /// requested, or better.
    fn is_accepted(&self, who: Who<'_>, block: usize) -> bool {
        matches!(who, Who::Cell(candidate) if self.own_taken(block, candidate.number).is_some())
    }

    /// The region that a cell, close to block `near`, is in.
    fn taken(&self, near: usize, cell: [u32; 3]) -> Option<u32> {
        let (block, within) = split_cell(cell);
        self.own_taken(self.samples.find_near(near, block)?, cell_number(within))
    }

    /// The same, of a cell of that block, by its number.
    fn own_taken(&self, block: usize, number: u16) -> Option<u32> {
        self.taken[block].get(number)
    }

    fn region(&self, request: &Request<'_>, span: Span, patches: &mut Patches<'a>) -> Option<Region> {
        patches.clear();
        for cell in span.cells() {
            let (first, within) = split_cell(cell);
            if self.samples.is_plain(first) {
                return None;
            }
            let Some(block) = self.samples.find_near(request.block, first) else { continue };
            let case = self.samples.parts.part(block).signs.case(within);
            if case != 0 && case != 255 {
                self.add_patches(block, within, (cell, case), patches)?;
            }
        }
        let (shift, size) = (offset(request.from, span.low), span.size());
        let own = match request.who {
            Who::Cell(candidate) => candidate.planes(),
            // None if it is part of another by now.
            Who::Region(number) => self.regions[number].as_ref()?.planes,
        };
        let (mut planes, mut place) = (Planes::NONE, request.at + shift);
        for step in 1..=STEPS {
            planes = patches.planes(span.low, place);
            let next = settle(&planes, place, [Vec3A::ZERO, size], (3, self.samples.crease));
            let way = next - place;
            place = next;
            let is_last = step == STEPS || way.length_squared() < CLOSE * CLOSE;
            let allowed = if is_last { request.allowed } else { NO_HOPE * request.allowed };
            if planes.distance(place).max(own.distance(place - shift)) > allowed {
                return None;
            }
            if is_last {
                break;
            }
        }
        let Disc { ring, within } = patches.glued(&span)?;
        let at = self.samples.inside(place, span.low, span.high);
        Some(Region { block: request.block, segments: ring, at, place, planes, within, span })
    }

    /// Adds the planes of a crossed cell of a block, and its patches.
    fn add_patches(
        &self,
        block: usize,
        within: [usize; 3],
        (cell, case): ([u32; 3], u8),
        patches: &mut Patches<'a>,
    ) -> Option<()> {
        if let Some(candidate) = self.special.candidate(block, cell_number(within)) {
            patches.add(cell, self.special.segments(block, candidate), candidate.planes());
            return Some(());
        }
        let faces = self.joined.of(self.samples, cell, case);
        let mut add = |outline: &CellLoop| {
            let mut vertices = [0; LONGEST];
            for (vertex, &edge) in vertices.iter_mut().zip(outline.edges()) {
                *vertex = self.samples.vertex(block, cell, edge)?;
            }
            patches.add_loop(self.samples, cell, outline, &vertices[..outline.len()]);
            Some(())
        };
        match CellLoop::single(case, faces) {
            Some(outline) => add(&outline),
            None => CellLoop::all(case, faces).try_for_each(|outline| add(&outline)),
        }
    }
}

impl Taken {
    /// The region that a cell is in.
    #[inline]
    fn get(&self, number: u16) -> Option<u32> {
        // Most are in none.
        let find = || self.regions.iter().find(|&&(cell, _)| cell == number).map(|&(_, region)| region);
        self.cells.has(number).then(find)?
    }

    /// Puts a cell in a region.
    fn put(&mut self, number: u16, region: u32) {
        self.cells.insert(number);
        match self.regions.iter_mut().find(|(cell, _)| *cell == number) {
            Some(cell) => cell.1 = region,
            None => self.regions.push((number, region)),
        }
    }
}
