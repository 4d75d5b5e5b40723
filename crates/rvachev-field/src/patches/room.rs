//! Memory for blocks of points, which threads keep: to make it anew takes as long as a few packets.

use std::cell::RefCell;
use std::thread::LocalKey;

use super::block::Block;
use super::pairs::Found;
use crate::kernel::Element;

/// A block of points, and what is found of them.
pub(super) struct Room<E> {
    pub(super) block: Block<E>,
    pub(super) found: Found<E>,
}

type Spare<E> = LocalKey<RefCell<Vec<Box<Room<E>>>>>;

/// Numbers that rooms are kept for.
pub(super) trait Roomy: Element {
    fn spare() -> &'static Spare<Self>;
}

impl Roomy for f32 {
    fn spare() -> &'static Spare<f32> {
        thread_local! {
            static SPARE: RefCell<Vec<Box<Room<f32>>>> = const { RefCell::new(Vec::new()) };
        }
        &SPARE
    }
}

impl Roomy for f64 {
    fn spare() -> &'static Spare<f64> {
        thread_local! {
            static SPARE: RefCell<Vec<Box<Room<f64>>>> = const { RefCell::new(Vec::new()) };
        }
        &SPARE
    }
}

impl<E: Roomy> Room<E> {
    /// One that nobody else on this thread is using; what is in it is left from before.
    #[inline(never)]
    pub(super) fn take() -> Box<Room<E>> {
        let spare = E::spare().with_borrow_mut(Vec::pop);
        spare.unwrap_or_else(|| Box::new(Room { block: Block::new(), found: Found::none() }))
    }

    /// Puts it back for others.
    #[inline(never)]
    pub(super) fn give(self: Box<Self>) {
        E::spare().with_borrow_mut(|spare| spare.push(self));
    }
}
