//! Points of a block that are on the side of others.
//!
//! ```text
//!        .---.
//!      .'   p '.        No triangle is nearer to q than the ball is large: what is in it is on the
//!      |   q   |  r     side of q, and so on from there, the largest balls first. So are points r
//!      '.     .'        whose own balls hold q.
//!        '---'
//! ```

use rvachev_num::lanes::Lanes;

use super::super::block::{BLOCK, Block};
use super::super::packet::Packet;
use crate::kernel::Element;

/// Balls that tell nothing new, one after the other, end it.
const IN_VAIN: usize = 3;

/// Which points of a block have a side, and which of them are still to be asked about others.
pub(super) struct Flood<E> {
    /// Below 0 where the side is known.
    open: [E; BLOCK],
    /// How large balls are that have not been looked into, below 0 where there are none.
    balls: [E; BLOCK],
}

impl<E: Element> Flood<E> {
    #[inline(always)]
    pub(super) fn new() -> Flood<E> {
        Flood { open: [E::default(); BLOCK], balls: [E::default(); BLOCK] }
    }

    /// Nothing is known.
    #[inline(always)]
    pub(super) fn start(&mut self) {
        self.open.fill(E::from_f64(1.0));
        self.balls.fill(E::from_f64(-1.0));
    }

    /// The side of a point is known.
    #[inline(always)]
    pub(super) fn know(&mut self, at: usize) {
        self.open[at % BLOCK] = E::from_f64(-1.0);
    }

    /// The side of a point is known for certain, and there is no triangle in a ball about it.
    #[inline(always)]
    pub(super) fn fill(&mut self, at: usize, ball: E) {
        self.know(at);
        self.balls[at % BLOCK] = ball;
    }

    #[inline(always)]
    pub(super) fn is_open(&self, at: usize) -> bool {
        self.open[at % BLOCK].to_f64() >= 0.0
    }

    /// Numbers of a packet that are below 0 where the side is known.
    #[inline(always)]
    pub(super) fn packet<L: Lanes<Element = E>>(&self, simd: L::Token, at: usize) -> L {
        L::load(simd, &self.open[at..at + L::WIDTH])
    }

    /// Tells the sides of those that are on the side of others, of the first `len` points of a
    /// block whose numbers are the balls.
    #[inline(always)]
    pub(super) fn spread<L: Lanes<Element = E> + Packet>(
        &mut self,
        simd: L::Token,
        block: &Block<E>,
        len: usize,
        found: &mut [E; BLOCK],
    ) {
        let mut in_vain = 0;
        while in_vain < IN_VAIN {
            let Some(at) = self.largest::<L>(simd, len) else { return };
            self.balls[at] = E::from_f64(-1.0);
            let ([x, y, z], ball) = (block.point(at), block.numbers[at % BLOCK].to_f64());
            let [x, y, z] = [x.to_f64(), y.to_f64(), z.to_f64()];
            let above = found[at].to_f64();
            in_vain += 1;
            let mut at = 0;
            while at < len {
                let here = at..at + L::WIDTH;
                let dx = L::load(simd, &block.columns[0][here.clone()]) - x;
                let dy = L::load(simd, &block.columns[1][here.clone()]) - y;
                let dz = L::load(simd, &block.columns[2][here.clone()]) - z;
                let square = dx.mul_add(dx, dy.mul_add(dy, dz * dz));
                let own = L::load(simd, &block.numbers[here.clone()]);
                let held = own.max(own.lift(ball));
                let open = L::load(simd, &self.open[here.clone()]);
                // Above 0 where it is told now; of what is no number nothing is.
                let told = (held * held - square).select(open, open.lift(-1.0));
                if told.lift(0.0).any_below(told) {
                    told.select(open.lift(above), L::load(simd, &found[here.clone()])).store(&mut found[here.clone()]);
                    told.select(own, L::load(simd, &self.balls[here.clone()])).store(&mut self.balls[here.clone()]);
                    told.select(told.lift(-1.0), open).store(&mut self.open[here]);
                    in_vain = 0;
                }
                at += L::WIDTH;
            }
        }
    }

    /// The largest ball that has not been looked into.
    #[inline(always)]
    fn largest<L: Lanes<Element = E> + Packet>(&self, simd: L::Token, len: usize) -> Option<usize> {
        let mut most = L::load(simd, &self.balls[..L::WIDTH]);
        let mut at = L::WIDTH;
        while at < len {
            most = most.max(L::load(simd, &self.balls[at..at + L::WIDTH]));
            at += L::WIDTH;
        }
        let (all, count) = most.all();
        let mut largest = 0.0;
        let mut i = 0;
        while i < count {
            largest = if all[i] > largest { all[i] } else { largest };
            i += 1;
        }
        if largest <= 0.0 {
            return None;
        }
        // Of single precision, so that it is found again.
        let less = most.lift(f64::from(largest) * (1.0 - 1e-6));
        let mut at = 0;
        while at < len {
            let bits = less.below(L::load(simd, &self.balls[at..at + L::WIDTH]));
            if bits != 0 {
                return Some(at + bits.trailing_zeros() as usize);
            }
            at += L::WIDTH;
        }
        None
    }
}
