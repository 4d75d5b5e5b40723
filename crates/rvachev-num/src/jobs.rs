//! Numbered jobs on the threads of the caller, and what they give, in order.
//!
//! The loop is compiled once, for all jobs: a parallel iterator of its own for each of a hundred
//! loops was a sixth of what the compiler had to optimise.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// Parts that a loop is divided into at most: items may be tiny.
const PARTS: usize = 1024;

/// Does the jobs numbered from 0, in any order.
pub fn for_all(count: usize, job: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(job);
}

/// What the jobs numbered from 0 give, in order.
pub fn in_order<T: Send>(count: usize, job: impl Fn(usize) -> T + Sync) -> Vec<T> {
    in_order_with(count, || (), |(), number| job(number))
}

/// The same, or the error of the first job that has one. Jobs ask their run whether to go on: an
/// error does not stop the others.
///
/// # Errors
/// That of the first job that has one.
pub fn try_in_order<T: Send, E: Send>(count: usize, job: impl Fn(usize) -> Result<T, E> + Sync) -> Result<Vec<T>, E> {
    try_in_order_with(count, || (), |(), number| job(number))
}

/// The same of jobs that have scratch memory, as [`in_order_with`] has.
///
/// # Errors
/// That of the first job that has one.
pub fn try_in_order_with<S: Send, T: Send, E: Send>(
    count: usize,
    make: impl Fn() -> S + Sync,
    job: impl Fn(&mut S, usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    in_order_with(count, make, job).into_iter().collect()
}

/// What the jobs numbered from 0 give, in order. Each has scratch memory that is its own
/// meanwhile, made by `make` or left by another job.
pub fn in_order_with<S: Send, T: Send>(
    count: usize,
    make: impl Fn() -> S + Sync,
    job: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    let size = count.div_ceil(PARTS).max(1);
    let mut parts = Vec::new();
    parts.resize_with(count.div_ceil(size), || Mutex::new(Vec::new()));
    let left = Mutex::new(Vec::new());
    for_all(parts.len(), &|part| {
        let found = lock(&left).pop();
        let mut scratch = found.unwrap_or_else(&make);
        let mut own = Vec::with_capacity(size);
        for number in part * size..count.min((part + 1) * size) {
            own.push(job(&mut scratch, number));
        }
        *lock(&parts[part]) = own;
        lock(&left).push(scratch);
    });
    let mut all = Vec::with_capacity(count);
    for part in parts {
        all.append(&mut lock(&part));
    }
    all
}

/// What is said of each chunk of `size` items and its number, in order, or the first error; the
/// last chunk may be shorter.
///
/// # Errors
/// That of the first job that has one.
pub fn try_chunks<I: Sync, T: Send, E: Send>(
    items: &[I],
    size: usize,
    job: impl Fn(usize, &[I]) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    try_chunks_with(items, size, || (), |(), number, chunk| job(number, chunk))
}

/// The same with scratch memory, as [`in_order_with`] has.
///
/// # Errors
/// That of the first job that has one.
pub fn try_chunks_with<I: Sync, S: Send, T: Send, E: Send>(
    items: &[I],
    size: usize,
    make: impl Fn() -> S + Sync,
    job: impl Fn(&mut S, usize, &[I]) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let chunk = |number: usize| &items[number * size..items.len().min((number + 1) * size)];
    let job = |scratch: &mut S, number| job(scratch, number, chunk(number));
    try_in_order_with(items.len().div_ceil(size), make, job)
}

/// What becomes of each item, in order, or the first error.
///
/// # Errors
/// That of the first item that has one.
pub fn try_taking<I: Send, T: Send, E: Send>(
    items: Vec<I>,
    job: impl Fn(I) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let items: Vec<Mutex<Option<I>>> = items.into_iter().map(|item| Mutex::new(Some(item))).collect();
    let taken = in_order(items.len(), |number| lock(&items[number]).take().map(&job));
    taken.into_iter().flatten().collect()
}

/// A job that panics ends the loop: nobody looks at what it left.
fn lock<T>(of: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_found_is_in_order_and_the_first_error_is_told() {
        for count in [0, 1, 5, 1023, 1024, 5000] {
            assert_eq!(in_order(count, |n| n * n), (0..count).map(|n| n * n).collect::<Vec<_>>());
        }
        let odd = |n| if n > 2 && n % 2 == 1 { Err(n) } else { Ok(n) };
        assert_eq!(try_in_order(1000, odd), Err(3));
        assert_eq!(try_in_order(3, odd), Ok(vec![0, 1, 2]));
    }

    #[test]
    fn chunks_and_items_are_in_order() {
        let numbers: Vec<usize> = (0..1000).collect();
        let sums = |_, chunk: &[usize]| Ok::<usize, ()>(chunk.iter().sum());
        assert_eq!(try_chunks(&numbers, 300, sums), Ok(vec![44_850, 134_850, 224_850, 94_950]));
        assert_eq!(try_taking(numbers.clone(), Ok::<usize, ()>), Ok(numbers));
    }

    #[test]
    fn scratch_is_used_again() {
        let made = Mutex::new(0);
        let make = || *made.lock().unwrap() += 1;
        in_order_with(1000, make, |(), _| ());
        assert!(*made.lock().unwrap() <= rayon::current_num_threads());
    }
}
