//! Numbered jobs on the threads of the caller, and what they give, in order.
//!
//! The loop is compiled once, for all jobs: a parallel iterator of its own for each of a hundred
//! loops was a sixth of what the compiler had to optimise.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// Parts that a loop is divided into at most: items may be tiny.
const PARTS: usize = 1024;

/// Does the jobs numbered from 0. Each thread takes the next: jobs end nearly in their order, and
/// what is put together in it waits for few.
pub fn for_all(count: usize, job: &(dyn Fn(usize) + Sync)) {
    let next = AtomicUsize::new(0);
    (0..count).into_par_iter().for_each(|_| job(next.fetch_add(1, Ordering::Relaxed)));
}

/// Does two jobs, side by side if there is a thread for it.
pub fn both(one: &mut (dyn FnMut() + Send), other: &mut (dyn FnMut() + Send)) {
    rayon::join(one, other);
}

/// What the first job has that has any. A job that can no more be the first is not begun.
struct First<T> {
    number: AtomicUsize,
    found: Mutex<Option<T>>,
}

impl<T> First<T> {
    fn new() -> First<T> {
        First { number: AtomicUsize::new(usize::MAX), found: Mutex::new(None) }
    }

    /// What a job gives if it is begun and has no error.
    fn unless<U>(&self, number: usize, job: impl FnOnce() -> Result<U, T>) -> Option<U> {
        if self.number.load(Ordering::Relaxed) < number {
            return None;
        }
        job().map_err(|found| self.note(number, found)).ok()
    }

    fn note(&self, number: usize, found: T) {
        let mut first = lock(&self.found);
        if number < self.number.load(Ordering::Relaxed) {
            self.number.store(number, Ordering::Relaxed);
            *first = Some(found);
        }
    }

    /// All, unless a job had an error.
    fn or<U>(self, all: U) -> Result<U, T> {
        self.found.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(all), Err)
    }
}

/// What the first of the jobs finds that finds anything. Jobs after one that did are not begun.
pub fn first<T: Send>(count: usize, job: impl Fn(usize) -> Option<T> + Sync) -> Option<T> {
    let first = First::new();
    for_all(count, &|number| {
        first.unless(number, || job(number).map_or(Ok(()), Err));
    });
    first.or(()).err()
}

/// What the jobs numbered from 0 give, in order.
pub fn in_order<T: Send>(count: usize, job: impl Fn(usize) -> T + Sync) -> Vec<T> {
    in_order_with(count, || (), |(), number| job(number))
}

/// The same, or the error of the first job that has one. Jobs after one that has are not begun.
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
    let first = First::new();
    let all = in_order_with(count, make, |scratch, number| first.unless(number, || job(scratch, number)));
    first.or(all.into_iter().map_while(|told| told).collect())
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
    try_taking_with(items, || (), |(), item| job(item))
}

/// The same with scratch memory, as [`in_order_with`] has.
///
/// # Errors
/// That of the first item that has one.
pub fn try_taking_with<I: Send, S: Send, T: Send, E: Send>(
    items: Vec<I>,
    make: impl Fn() -> S + Sync,
    job: impl Fn(&mut S, I) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let items: Vec<Mutex<Option<I>>> = items.into_iter().map(|item| Mutex::new(Some(item))).collect();
    let taken = try_in_order_with(items.len(), make, |scratch, number| {
        let item = lock(&items[number]).take();
        item.map(|item| job(scratch, item)).transpose()
    })?;
    Ok(taken.into_iter().flatten().collect())
}

/// Does a job on each chunk of `size` items, given its number; the last chunk may be shorter.
pub fn for_chunks_mut<T: Send>(items: &mut [T], size: usize, job: impl Fn(usize, &mut [T]) + Sync) {
    let chunks: Vec<Mutex<&mut [T]>> = items.chunks_mut(size).map(Mutex::new).collect();
    for_all(chunks.len(), &|number| job(number, &mut lock(&chunks[number])));
}

/// The same, unless there is an error. Jobs after one that has an error are not begun.
///
/// # Errors
/// That of the first job that has one.
pub fn try_chunks_mut<T: Send, E: Send>(
    items: &mut [T],
    size: usize,
    job: impl Fn(usize, &mut [T]) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let first = First::new();
    for_chunks_mut(items, size, |number, chunk| {
        first.unless(number, || job(number, chunk));
    });
    first.or(())
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
    fn chunks_are_changed_in_place() {
        let mut numbers = vec![0; 1000];
        let fill = |nth: usize, chunk: &mut [usize]| (300 * nth..).zip(chunk).for_each(|(n, to)| *to = n);
        for_chunks_mut(&mut numbers, 300, fill);
        assert_eq!(numbers, (0..1000).collect::<Vec<_>>());
        let odd = |nth: usize, chunk: &mut [usize]| if nth % 2 == 1 { Err(chunk[0]) } else { Ok(()) };
        assert_eq!(try_chunks_mut(&mut numbers, 300, odd), Err(300));
        assert_eq!(try_chunks_mut(&mut numbers[..300], 300, odd), Ok(()));
    }

    #[test]
    fn the_first_is_found() {
        for at in [0, 1, 77, 9999] {
            assert_eq!(first(10_000, |n| (n >= at).then_some(n)), Some(at));
        }
        assert_eq!(first(10_000, |_| None::<usize>), None);
    }

    #[test]
    fn after_an_error_no_job_is_begun() {
        let begun = AtomicUsize::new(0);
        let fails = |n: usize| if begun.fetch_add(1, Ordering::Relaxed) == 7 { Err(n) } else { Ok(()) };
        let alone = crate::Run { threads: 1, ..crate::Run::default() };
        assert_eq!(alone.install(|| try_in_order(10_000, fails)), Err(7));
        assert_eq!(begun.into_inner(), 8);
    }

    #[test]
    fn an_error_is_that_of_the_first_job_whichever_ends_first() {
        let first = First::new();
        first.unless(2, || Err::<(), _>(2));
        first.unless(1, || {
            first.unless(0, || Err::<(), _>(0));
            Err::<(), _>(1)
        });
        assert_eq!(first.or(()), Err(0));
    }

    #[test]
    fn jobs_are_begun_in_their_order() {
        let begun = Mutex::new(Vec::new());
        // The lock is taken after the number is: no more than the other threads come between.
        for_all(10_000, &|n| begun.lock().unwrap().push(n));
        let begun = begun.into_inner().unwrap();
        let early = (0..).zip(&begun).map(|(place, n): (usize, &usize)| n.saturating_sub(place)).max();
        assert!(early < Some(rayon::current_num_threads()), "{early:?}");
    }

    #[test]
    fn scratch_is_used_again() {
        let made = Mutex::new(0);
        let make = || *made.lock().unwrap() += 1;
        in_order_with(1000, make, |(), _| ());
        assert!(*made.lock().unwrap() <= rayon::current_num_threads());
    }
}
