//! Lists of numbers whose memory a thread keeps: leaves that are made of programs need a dozen of
//! them for each chunk of points.

use std::cell::RefCell;
use std::ops::{Deref, DerefMut};

/// So many are kept.
const KEPT: usize = 64;

thread_local! {
    static SPARE: RefCell<Vec<Vec<f32>>> = const { RefCell::new(Vec::new()) };
}

/// A list in memory that was used before, if there is some.
#[derive(Debug)]
pub(super) struct List(Vec<f32>);

impl List {
    /// So many zeroes.
    pub(super) fn zeroes(count: usize) -> List {
        let mut list = SPARE.with_borrow_mut(Vec::pop).unwrap_or_default();
        list.clear();
        list.resize(count, 0.0);
        List(list)
    }
}

impl Drop for List {
    fn drop(&mut self) {
        let list = std::mem::take(&mut self.0);
        // A thread that ends keeps nothing.
        let _ = SPARE.try_with(|spare| {
            if let Ok(mut spare) = spare.try_borrow_mut()
                && spare.len() < KEPT
            {
                spare.push(list);
            }
        });
    }
}

impl Deref for List {
    type Target = Vec<f32>;

    fn deref(&self) -> &Vec<f32> {
        &self.0
    }
}

impl DerefMut for List {
    fn deref_mut(&mut self) -> &mut Vec<f32> {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_used_again() {
        let mut long = List::zeroes(1000);
        long.iter_mut().for_each(|v| *v = 1.0);
        let place = long.as_ptr();
        drop(long);
        let short = List::zeroes(10);
        assert!(short.as_ptr() == place && *short == [0.0; 10]);
    }
}
