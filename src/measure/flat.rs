//! Solids with flat faces: what is inside and the area of the surface, summed up to rounding.

use rvachev_num::jobs;

use super::cuts::{self, Flat};
use super::integral::unfolded;
use super::moments::Moments;
use crate::eval::Narrowed;
use crate::program::Program;
use crate::{Bounds, Cancelled, Run};

/// Cells that are not told are halved so often at most, until there are so many.
const HALVINGS: usize = 6;
const MOST: usize = 1 << 14;

/// What cells have of a solid with flat faces, and the area of these; nothing of another.
pub(super) fn flat(cells: &[(Bounds, Program)], run: &Run) -> Result<Option<(Moments, f64)>, Cancelled> {
    let (mut all, mut sum) = (Moments::default(), 0.0);
    let mut cells = std::borrow::Cow::Borrowed(cells);
    for _ in 0..=HALVINGS {
        run.check()?;
        let told = |(bounds, program): &(Bounds, Program)| match cuts::flat(program, bounds) {
            Flat::Exact(moments, area) => Ok(Some((moments, area))),
            Flat::Unknown => Ok(None),
            Flat::Other => Err(()),
        };
        let Ok(told) = jobs::try_in_order(cells.len(), |n| told(&cells[n])) else { return Ok(None) };
        let mut open = Vec::new();
        for (cell, told) in cells.iter().zip(told) {
            match told {
                Some((moments, area)) => {
                    all.add(&moments);
                    sum += area;
                }
                None => open.push(cell),
            }
        }
        if open.is_empty() {
            return Ok(Some((all, sum)));
        }
        if 8 * open.len() > MOST {
            return Ok(None);
        }
        let mut next = Vec::new();
        for (bounds, program) in open {
            for part in bounds.octants() {
                match program.narrowed(&part) {
                    Narrowed::Inside => all.add(&Moments::cuboid(part.center(), part.size())),
                    Narrowed::Outside => {}
                    Narrowed::Same => next.push((part, unfolded(program.clone(), &part))),
                    Narrowed::Simpler(simpler) => next.push((part, unfolded(simpler, &part))),
                }
            }
        }
        cells = next.into();
    }
    Ok(None)
}
