//! Long lists that nobody waits for when they are made or dropped.

use std::ops::{Deref, DerefMut};

use rayon::prelude::*;

/// Bytes that are given back at once.
const PIECE: usize = 1 << 25;

/// A list of a mesh in the making. If it is long when it is dropped, as when the run is cancelled,
/// another thread gives its memory back: that takes the system a tenth of a second for a gigabyte.
#[derive(Clone, Debug)]
pub(super) struct Bulk<T: Send + 'static>(Vec<T>);

impl<T: Send> Bulk<T> {
    /// The list itself.
    pub(super) fn into_vec(mut self) -> Vec<T> {
        std::mem::take(&mut self.0)
    }
}

impl Bulk<[u32; 3]> {
    /// Adds zeros. A long list is of memory that the system gives as zeros when it is first
    /// written. That for a short one may have been used before: it is cleared by all threads, if
    /// there are several.
    pub(super) fn add_zeros(&mut self, count: usize) {
        let length = self.0.len() + count;
        if rayon::current_num_threads() > 1 && length * size_of::<[u32; 3]>() <= PIECE {
            return self.0.par_extend(rayon::iter::repeat_n([0; 3], count));
        }
        let mut all = vec![[0; 3]; length];
        all[..self.0.len()].copy_from_slice(&self.0);
        self.0 = all;
    }
}

impl<T: Send> Default for Bulk<T> {
    fn default() -> Bulk<T> {
        Bulk(Vec::new())
    }
}

impl<T: Send> From<Vec<T>> for Bulk<T> {
    fn from(list: Vec<T>) -> Bulk<T> {
        Bulk(list)
    }
}

impl<T: Send> Deref for Bulk<T> {
    type Target = Vec<T>;

    #[inline(always)]
    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Send> DerefMut for Bulk<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<T: Send> Drop for Bulk<T> {
    #[inline]
    fn drop(&mut self) {
        if size_of::<T>() * self.0.capacity() > PIECE {
            let list = std::mem::take(&mut self.0);
            // Where there is no thread, the list is dropped here, with the closure.
            drop(std::thread::Builder::new().spawn(move || shrink(list)));
        }
    }
}

/// Gives a list back piece by piece: while the system takes a piece, no other thread of the program
/// gets memory or gives any back.
fn shrink<T>(mut list: Vec<T>) {
    list.clear();
    let piece = PIECE / size_of::<T>();
    while list.capacity() > piece {
        list.shrink_to(list.capacity() - piece);
    }
}
