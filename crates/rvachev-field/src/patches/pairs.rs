//! Points and the curved patches that may be nearest to them.
//!
//! The nearest points of a packet are on half as many patches as it has points: to ask every patch
//! on behalf of all would be mostly in vain. So what a search keeps is written down as pairs of a
//! point and a patch, and vectors are filled with pairs, each lane with its own patch.

use rvachev_num::lanes::Lanes;

use super::Patches;
use super::block::{BLOCK, Block};
use super::curved::Around;
use super::packet::{Packet, WIDEST};
use super::search::Keep;
use crate::kernel::Element;

/// How many numbers there are in a pair: what [`Around`] holds.
const ROWS: usize = 18;

/// Patches that packets keep, how far they are at least, and pairs of a point and a patch.
pub(super) struct Pairs<R> {
    /// The first point of the packet that is searched for.
    pub(super) first: u32,
    kept: Vec<Kept<R>>,
    pairs: Vec<(u32, u32)>,
}

/// A patch that may be nearest to some point of a packet.
#[derive(Clone, Copy)]
struct Kept<R> {
    first: u32,
    at: u32,
    /// The squares of the distances are not less.
    least: R,
}

impl<R: Packet> Keep<R> for Pairs<R> {
    #[inline(always)]
    fn keep(&mut self, at: u32, least: R, most: R) {
        if least.any_below(most) {
            self.kept.push(Kept { first: self.first, at, least });
        }
    }
}

/// The nearest points that are known of a block.
pub(super) struct Found<E> {
    pub(super) squares: [E; BLOCK],
    /// From the nearest points.
    pub(super) ways: [[E; BLOCK]; 3],
    pub(super) patches: [u32; BLOCK],
    /// The patches that are likely to have them.
    pub(super) likely: [u32; BLOCK],
    /// Whether no more is asked, though it may be nearer than the square says.
    pub(super) is_near: [bool; BLOCK],
    /// Whether it is not known to be nearer than the farthest that is asked for.
    pub(super) is_far: [bool; BLOCK],
}

impl<E: Element> Found<E> {
    /// The square of what is not known.
    #[inline(always)]
    fn farthest() -> E {
        E::from_f64(f64::from(f32::MAX))
    }

    /// Nothing is known.
    #[inline(always)]
    pub(super) fn none() -> Found<E> {
        Found {
            squares: [Found::<E>::farthest(); BLOCK],
            ways: [[E::default(); BLOCK]; 3],
            patches: [0; BLOCK],
            likely: [0; BLOCK],
            is_near: [false; BLOCK],
            is_far: [false; BLOCK],
        }
    }
}

impl<L: Lanes<Element: Element> + Packet> Pairs<L> {
    #[inline(always)]
    pub(super) fn new() -> Pairs<L> {
        Pairs { first: 0, kept: Vec::new(), pairs: Vec::new() }
    }

    /// Finds the nearest points of the first `len` points of a block, where they are on curved
    /// patches: on those that are likely to have them, and then on those that are kept and may be
    /// nearer still.
    #[inline(always)]
    pub(super) fn settle(
        &mut self,
        simd: L::Token,
        patches: &Patches,
        block: &Block<L::Element>,
        found: &mut Found<L::Element>,
        len: usize,
    ) {
        self.pairs.clear();
        for point in 0..len {
            let likely = found.likely[point];
            let is_curved = patches.at(likely as usize).is_some_and(|(face, _)| !face.is_flat());
            if is_curved && !found.is_near[point] && !found.is_far[point] {
                self.pairs.push((point as u32, likely));
            }
        }
        let mut round = 0;
        while round < 2 {
            self.solve(simd, patches, block, found);
            self.pairs.clear();
            if round == 0 {
                self.pair(simd, found);
            }
            round += 1;
        }
        self.kept.clear();
    }

    /// Pairs what is kept with the points that it may be nearer to than what is found.
    #[inline(always)]
    fn pair(&mut self, simd: L::Token, found: &Found<L::Element>) {
        for Kept { first, at, least } in &self.kept {
            let known = L::load(simd, &found.squares[*first as usize..*first as usize + L::WIDTH]);
            let mut points = least.below(known);
            while points != 0 {
                let point = first + points.trailing_zeros();
                let place = point as usize % BLOCK;
                if !found.is_near[place] && (found.is_far[place] || found.likely[place] != *at) {
                    self.pairs.push((point, *at));
                }
                points &= points - 1;
            }
        }
    }

    /// Finds the nearest points of all pairs.
    #[inline(always)]
    fn solve(&mut self, simd: L::Token, patches: &Patches, block: &Block<L::Element>, found: &mut Found<L::Element>) {
        // Every lane that is read is written before.
        let mut rows = [[L::Element::default(); WIDEST]; ROWS];
        let mut from = 0;
        while from < self.pairs.len() {
            let pairs = &self.pairs[from..self.pairs.len().min(from + L::WIDTH)];
            for lane in 0..L::WIDTH {
                let (point, at) = pairs[lane.min(pairs.len() - 1)];
                fill(&mut rows, lane, patches, at as usize, block.point(point as usize));
            }
            let around = Around {
                r: vector::<L>(simd, &rows, 0),
                e: vector::<L>(simd, &rows, 3),
                f: vector::<L>(simd, &rows, 6),
                c: vector::<L>(simd, &rows, 9),
                d: vector::<L>(simd, &rows, 12),
                mixed: vector::<L>(simd, &rows, 15),
            };
            let closest = around.closest();
            closest.square.store(&mut rows[0][..L::WIDTH]);
            closest.from[0].store(&mut rows[1][..L::WIDTH]);
            closest.from[1].store(&mut rows[2][..L::WIDTH]);
            closest.from[2].store(&mut rows[3][..L::WIDTH]);
            for (lane, (point, at)) in pairs.iter().enumerate() {
                let point = *point as usize % BLOCK;
                let (square, known) = (rows[0][lane], found.squares[point]);
                if square < known || (square == known && *at < found.patches[point]) {
                    found.squares[point] = square;
                    found.ways[0][point] = rows[1][lane];
                    found.ways[1][point] = rows[2][lane];
                    found.ways[2][point] = rows[3][lane];
                    found.patches[point] = *at;
                }
            }
            from += L::WIDTH;
        }
    }
}

/// Writes a pair's numbers down.
#[inline(always)]
fn fill<E: Element>(rows: &mut [[E; WIDEST]; ROWS], lane: usize, patches: &Patches, at: usize, p: [E; 3]) {
    let (Some((face, sides)), Some(quadratic)) = (patches.at(at), patches.quadratics.get(at)) else { return };
    for axis in 0..3 {
        rows[axis][lane] = p[axis].plus(E::from_f64(f64::from(-face.a[axis])));
        rows[3 + axis][lane] = E::from_f64(f64::from(sides.e[axis]));
        rows[6 + axis][lane] = E::from_f64(f64::from(sides.f[axis]));
        rows[9 + axis][lane] = E::from_f64(f64::from(quadratic.c[axis]));
        rows[12 + axis][lane] = E::from_f64(f64::from(quadratic.d[axis]));
        rows[15 + axis][lane] = E::from_f64(f64::from(quadratic.e[axis]));
    }
}

/// Three rows, from one on.
#[inline(always)]
fn vector<L: Lanes>(simd: L::Token, rows: &[[L::Element; WIDEST]; ROWS], row: usize) -> [L; 3] {
    [
        L::load(simd, &rows[row][..L::WIDTH]),
        L::load(simd, &rows[row + 1][..L::WIDTH]),
        L::load(simd, &rows[row + 2][..L::WIDTH]),
    ]
}
