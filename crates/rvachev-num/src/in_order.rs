//! What parallel loops give, in the order of what they are over.

use rayon::iter::IndexedParallelIterator;

/// What the items of a parallel loop give, in order.
///
/// `collect` does the same, and is compiled for loops whose length is not known as well; at an
/// error it stops the others. Jobs ask their run whether to go on.
pub trait InOrder: IndexedParallelIterator {
    /// All of it.
    fn in_order(self) -> Vec<Self::Item> {
        let mut found = Vec::new();
        self.collect_into_vec(&mut found);
        found
    }

    /// All of it, or the first error.
    ///
    /// # Errors
    /// That of the first item that has one.
    fn try_in_order<T: Send, E: Send>(self) -> Result<Vec<T>, E>
    where
        Self: IndexedParallelIterator<Item = Result<T, E>>,
    {
        self.in_order().into_iter().collect()
    }
}

impl<I: IndexedParallelIterator> InOrder for I {}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::InOrder;

    #[test]
    fn what_is_found_is_in_order_and_the_first_error_is_told() {
        let squares = (0..1000).into_par_iter().map(|n: u32| n * n).in_order();
        assert_eq!(squares, (0..1000).map(|n| n * n).collect::<Vec<u32>>());
        let odd = |n: u32| if n > 2 && n % 2 == 1 { Err(n) } else { Ok(n) };
        assert_eq!((0..1000).into_par_iter().map(odd).try_in_order(), Err(3));
        assert_eq!((0..3).into_par_iter().map(odd).try_in_order(), Ok(vec![0, 1, 2]));
    }
}
