//! Long lists made from others, and put in order, part by part.

use std::ops::Range;

use rayon::prelude::*;

use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// How many buckets there are.
const BUCKETS: usize = 1 << 12;

/// Items that are looked at or moved before it is asked whether to go on.
const AT_ONCE: usize = 1 << 16;

/// Items that a thread makes of others before it is asked.
const SHARE: usize = 1 << 12;

/// What becomes of each of some items, in order.
pub(super) fn mapped<T: Sync, U: Clone + Default + Send>(
    items: &[T],
    each: impl Fn(&T) -> U + Sync,
    run: &Run,
) -> Result<Vec<U>, Cancelled> {
    let mut all = vec![U::default(); items.len()];
    jobs::try_chunks_mut(&mut all, SHARE, |chunk, own| {
        run.check()?;
        own.iter_mut().zip(&items[chunk * SHARE..]).for_each(|(own, item)| *own = each(item));
        Ok(())
    })?;
    Ok(all)
}

/// The same items by buckets, those of each in order. `bucket` tells which one an item belongs
/// to, by twelve bits.
///
/// It can be stopped between buckets, as a sort of the whole list can't; a bucket that has most of
/// the items, as where one is far from all others, is sorted by all threads.
pub(super) fn sorted<T: Copy + Default + Ord + Send>(
    items: &[T],
    bucket: impl Fn(&T) -> u32,
    run: &Run,
) -> Result<Vec<T>, Cancelled> {
    let bucket = |item: &T| bucket(item) as usize % BUCKETS;
    let meter = Meter::new(run, 2 * items.len().div_ceil(AT_ONCE) + BUCKETS);
    let mut starts = vec![0; BUCKETS + 1];
    for items in items.chunks(AT_ONCE) {
        meter.step()?;
        items.iter().for_each(|item| starts[bucket(item) + 1] += 1);
    }
    (0..BUCKETS).for_each(|n| starts[n + 1] += starts[n]);
    let mut free = starts.clone();
    let mut sorted = vec![T::default(); items.len()];
    for items in items.chunks(AT_ONCE) {
        meter.step()?;
        for item in items {
            let place: &mut usize = &mut free[bucket(item)];
            sorted[*place] = *item;
            *place += 1;
        }
    }
    let mut rest = &mut sorted[..];
    let ranges = starts.windows(2).map(|ends| Range { start: ends[0], end: ends[1] });
    let own: Vec<&mut [T]> = ranges.map(|range| rest.split_off_mut(..range.len()).unwrap_or_default()).collect();
    jobs::try_taking(own, |own| {
        meter.step()?;
        own.par_sort_unstable();
        Ok(())
    })?;
    Ok(sorted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_follow_each_other_and_are_in_order() {
        let items: Vec<u32> = (0..200_000u32).map(|n| n.wrapping_mul(2_654_435_761)).collect();
        let found = sorted(&items, |item| item >> 20, &Run::default()).unwrap();
        let mut expected = items.clone();
        expected.sort_unstable();
        assert_eq!(found, expected);
        assert_eq!(sorted(&[], |item: &u32| *item, &Run::default()), Ok(Vec::new()));
        let run = Run::default();
        run.cancel.cancel();
        assert_eq!(sorted(&items, |item| item >> 20, &run), Err(Cancelled));
        assert_eq!(mapped(&items, |item| item >> 20, &run), Err(Cancelled));
    }
}
