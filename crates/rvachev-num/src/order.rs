//! Sorting by numbers.
//!
//! What is sorted is numbers and places, whatever the items are: the sort is compiled once. Numbers
//! are in the order of [`f64::total_cmp`], and items with equal ones stay in theirs.

/// Sorts items by a number of each, the least first.
pub fn rising<T>(items: &mut [T], number: impl Fn(&T) -> f64) {
    let keys = items.iter().zip(0..).map(|(item, place)| key(rank(number(item)), place)).collect();
    arrange(keys, &mut |a, b| items.swap(a, b));
}

/// Sorts items by a number of each, the greatest first.
pub fn falling<T>(items: &mut [T], number: impl Fn(&T) -> f64) {
    let keys = items.iter().zip(0..).map(|(item, place)| key(!rank(number(item)), place)).collect();
    arrange(keys, &mut |a, b| items.swap(a, b));
}

/// Sorts numbers, the least first.
pub fn numbers(all: &mut [f64]) {
    all.sort_unstable_by(f64::total_cmp);
}

/// The bits of a number such that they are in the order of the numbers.
fn rank(number: f64) -> u64 {
    let bits = number.to_bits();
    if number.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

fn key(rank: u64, place: u64) -> u128 {
    u128::from(rank) << 64 | u128::from(place)
}

/// Swaps the items at the places that the keys name into the order of the keys.
fn arrange(mut keys: Vec<u128>, swap: &mut dyn FnMut(usize, usize)) {
    keys.sort_unstable();
    let place = |key: u128| key as u64 as usize;
    for start in 0..keys.len() {
        // Along the cycle of places that each get what was at the next; those that have it are
        // their own next.
        let mut to = start;
        while place(keys[to]) != start {
            let next = place(std::mem::replace(&mut keys[to], to as u128));
            swap(to, next);
            to = next;
        }
        keys[to] = to as u128;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_that_of_a_stable_sort() {
        let odd = [0.0, -0.0, f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e-320, -3.5, 7.0];
        for count in [0, 1, 2, 9, 40, 1000] {
            let number = |n: usize| if n.is_multiple_of(3) { odd[n * 7 % 9] } else { ((n * 7919) % 64) as f64 - 20.0 };
            let items: Vec<(f64, usize)> = (0..count).map(|n| (number(n), n)).collect();
            let places = |items: &[(f64, usize)]| items.iter().map(|item| item.1).collect::<Vec<_>>();
            let (mut own, mut expected) = (items.clone(), items.clone());
            rising(&mut own, |item| item.0);
            expected.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert_eq!(places(&own), places(&expected));
            let (mut own, mut expected) = (items.clone(), items.clone());
            falling(&mut own, |item| item.0);
            expected.sort_by(|a, b| b.0.total_cmp(&a.0));
            assert_eq!(places(&own), places(&expected));
            let mut own: Vec<f64> = items.iter().map(|item| item.0).collect();
            let mut expected = own.clone();
            numbers(&mut own);
            expected.sort_by(f64::total_cmp);
            assert_eq!(
                own.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
                expected.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
            );
        }
    }
}
