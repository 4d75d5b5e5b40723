//! Lists that are cut into pieces, and lists with holes.

/// Fills holes in a list, in ascending order, with the last of it, as far as they follow after
/// `start`; what is left of the holes is closed.
pub(super) fn fill<T: Copy>(list: &mut Vec<T>, start: usize, holes: &[usize]) {
    let (filled, left) = holes.split_at(holes.len().min(list.len() - start));
    let end = list.len() - filled.len();
    for (from, &hole) in (end..).zip(filled) {
        list[hole] = list[from];
    }
    list.truncate(end);
    keep(list, left);
}

/// Where [`fill`] leaves the `count` items that follow after `start`.
pub(super) fn filled_numbers(start: usize, count: usize, holes: &[usize]) -> impl Iterator<Item = u32> {
    let (filled, left) = holes.split_at(holes.len().min(count));
    let stay = start..start + count - filled.len();
    // Holes that are left are closed: all items have gone into others, which come before them.
    debug_assert!(left.is_empty() || stay.is_empty());
    stay.chain(filled.iter().copied()).map(|number| number as u32)
}

/// Takes the ones that are not used, in ascending order, out of a list.
pub(super) fn keep<T: Copy>(list: &mut Vec<T>, unused: &[usize]) {
    let ends = unused.iter().skip(1).copied().chain([list.len()]);
    let mut kept = unused.first().copied().unwrap_or(list.len());
    for (&gone, end) in unused.iter().zip(ends) {
        list.copy_within(gone + 1..end, kept);
        kept += end - gone - 1;
    }
    list.truncate(kept);
}

/// Cuts a slice into consecutive pieces of the given lengths, whose sum is its length.
pub(super) fn split<T>(mut slice: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let cut = |length| {
        let (piece, rest) = std::mem::take(&mut slice).split_at_mut(length);
        slice = rest;
        piece
    };
    lengths.map(cut).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_filled_or_closed() {
        let filled = |start: usize, holes: &[usize]| {
            let mut list: Vec<u8> = (0..8).collect();
            let numbers: Vec<u32> = filled_numbers(start, list.len() - start, holes).collect();
            let items = list[start..].to_vec();
            fill(&mut list, start, holes);
            for (number, item) in numbers.into_iter().zip(items) {
                assert_eq!(list[number as usize], item);
            }
            list
        };
        assert_eq!(filled(6, &[]), [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(filled(6, &[2]), [0, 1, 7, 3, 4, 5, 6]);
        assert_eq!(filled(6, &[0, 5]), [6, 1, 2, 3, 4, 7]);
        // There are more holes than there is to fill them.
        assert_eq!(filled(6, &[1, 2, 3, 5]), [0, 6, 7, 4]);
        assert_eq!(filled(8, &[0, 7]), [1, 2, 3, 4, 5, 6]);
    }
}
