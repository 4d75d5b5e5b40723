//! Where the patches of a surface may be off by more than elsewhere, or miss something.
//!
//! ```text
//!     .------.      Of what is in such a box only the solid's value tells: it is divided, and parts
//!     |/\    |      that the value says nothing is in are left out, until what is left is beyond
//!     '------'      the other solid, farther from it than what is known, or small.
//! ```

use glam::DVec3;

use super::levels::Levels;
use super::overlap::Entry;
use super::{Side, distance};
use crate::eval::{Narrowed, Program};
use crate::{Bounds, Cancelled, Run};
use rvachev_num::jobs;

/// After so many boxes the work ends, with what is known then.
const MOST: usize = 1 << 13;

/// More pairs of boxes are not compared.
const PAIRS: usize = 1 << 22;

/// What a program has in a box.
enum Part {
    Nothing,
    All,
    Some(Program),
}

impl Part {
    fn of(program: &Program, bounds: &Bounds) -> Part {
        match program.narrowed(bounds) {
            Narrowed::Outside => Part::Nothing,
            Narrowed::Inside => Part::All,
            Narrowed::Same => Part::Some(program.clone()),
            Narrowed::Simpler(simpler) => Part::Some(simpler),
        }
    }
}

/// A box, and what is left of both programs in it; nothing of one that holds all of it.
struct Shared {
    bounds: Bounds,
    programs: [Option<Program>; 2],
}

impl Shared {
    /// A part of it, if both solids may be there.
    fn part(&self, bounds: Bounds) -> Option<Shared> {
        let [one, other] = &self.programs;
        let narrowed = |program: &Option<Program>| match program.as_ref().map(|own| Part::of(own, &bounds)) {
            None | Some(Part::All) => Some(None),
            Some(Part::Nothing) => None,
            Some(Part::Some(program)) => Some(Some(program)),
        };
        Some(Shared { bounds, programs: [narrowed(one)?, narrowed(other)?] })
    }
}

/// A point of both solids in the boxes of both surfaces, or how deep one may be, given how deep one
/// may be as the patches are, and how far these may be off without being looked into.
pub(super) fn entry(
    sides: [&Side<'_>; 2],
    slack: f64,
    [deepest, spare]: [f64; 2],
    run: &Run,
) -> Result<Entry, Cancelled> {
    let programs = sides.map(|side| Some(side.program.clone()));
    let whole = Shared { bounds: Bounds::EMPTY, programs };
    let astray = |side: &Side<'_>| {
        let all = side.surface.doubts.iter().filter(|(_, off)| *off > side.exactness());
        let (near, far): (Vec<&(Bounds, f64)>, Vec<_>) = all.partition(|(_, off)| *off <= spare);
        let far: Vec<Shared> = far.into_iter().filter_map(|(bounds, _)| whole.part(*bounds)).collect();
        (near.into_iter().map(|(_, off)| *off).fold(0.0, f64::max), far)
    };
    let [(off, mut open), (off_other, others)] = sides.map(astray);
    open.extend(others);
    // Of surfaces that are apart, in doubt as they are, neither goes into the other.
    let as_patches = if deepest > 0.0 { deepest + off + off_other } else { 0.0 };
    let (mut left, mut asked) = (as_patches, open.len());
    let mut levels = Levels::new(run);
    while !open.is_empty() {
        run.check()?;
        let is_common = |p: DVec3| {
            sides.iter().all(|side| side.program.value(p) > 0.0 && distance(&side.surface.patches, p) > slack)
        };
        let middle = |n: usize| Some(open[n].bounds.center()).filter(|p| is_common(*p));
        if let Some(found) = jobs::first(open.len(), middle) {
            return Ok(Entry::At(found));
        }
        asked += 8 * open.len();
        let (small, large): (Vec<Shared>, Vec<Shared>) =
            open.into_iter().partition(|part| asked > MOST || part.bounds.size().length() <= slack);
        // What is in doubt within the other solid may be as deep there as it is from its surface.
        let deepest = |part: &Shared| {
            let middle = part.bounds.center();
            let holds = (0..2).filter(|n| part.programs[*n].is_none() || sides[*n].program.value(middle) > 0.0);
            let deep = holds.map(|side| distance(&sides[side].surface.patches, middle));
            let half = part.bounds.half_extents().length();
            deep.fold(half, f64::max) + half
        };
        left = small.iter().map(deepest).fold(left, f64::max);
        let parts = |n: usize| large[n].bounds.octants().map(|own| large[n].part(own));
        open = jobs::in_order(large.len(), parts).into_iter().flatten().flatten().collect();
        levels.down()?;
    }
    Ok(Entry::AtMost(left))
}

/// What is known of two surfaces where they are not in doubt.
pub(super) struct Known {
    /// They are no nearer to each other.
    pub(super) least: f64,
    /// What it may be less by without being looked into.
    pub(super) loss: f64,
}

/// What no point of a surface in its boxes is nearer to the other one than, more or less exactly
/// where that is less than what is known.
///
/// Where patches are off by no more than a length the surface is that much nearer than they are at
/// most. Boxes are divided where that is too much, or where patches are missing.
pub(super) fn least(sides: [&Side<'_>; 2], known: &Known, run: &Run) -> Result<f64, Cancelled> {
    /// A box, what is left of the program in it, and what is known of it without looking into it.
    type Boxes = Vec<(Bounds, Program, f64)>;
    let slack = sides.iter().map(|side| side.fineness()).sum::<f64>();
    let surface = |bounds: Bounds, program: &Program, least: f64| match Part::of(program, &bounds) {
        Part::Some(program) => Some((bounds, program, least)),
        Part::All | Part::Nothing => None,
    };
    // Where both surfaces are off, what they are nearer by adds up: what is not looked into may be
    // half of it of each.
    let more = |n: usize, off: f64| (off - sides[n].fineness()).max(0.0);
    let most = 0.5 * known.loss;
    let spare = [1, 0].map(|n: usize| {
        let all = sides[n].surface.doubts.iter().map(|(_, off)| more(n, *off));
        all.filter(|own| *own <= most).fold(0.0, f64::max)
    });
    let mut least = known.least;
    let mut boxes = |n: usize| -> Boxes {
        let mut open = Vec::new();
        for (bounds, off) in &sides[n].surface.doubts {
            let own = (known.least - more(n, *off) - spare[n]).max(0.0);
            if more(n, *off) <= most {
                least = least.min(own);
            } else {
                open.extend(surface(*bounds, sides[n].program, own));
            }
        }
        open
    };
    let mut open = [boxes(0), boxes(1)];
    let mut asked = open[0].len() + open[1].len();
    let mut levels = Levels::new(run);
    while open.iter().any(|boxes| !boxes.is_empty()) {
        run.check()?;
        let are_compared = open[0].len() * open[1].len() <= PAIRS;
        let near = |side: usize, bounds: &Bounds, own: f64| {
            let to_patches =
                distance(&sides[1 - side].surface.patches, bounds.center()) - bounds.half_extents().length() - slack;
            let others = open[1 - side].iter().filter(|_| are_compared);
            let to_boxes = others.map(|(other, ..)| gap(bounds, other)).fold(f64::INFINITY, f64::min);
            (to_patches - spare[side]).max(own).min(to_boxes).max(0.0)
        };
        let of_box = |side: usize, (bounds, _, own): &_| near(side, bounds, *own);
        let found = [0, 1].map(|side: usize| jobs::in_order(open[side].len(), |n| of_box(side, &open[side][n])));
        asked += 8 * (found[0].len() + found[1].len());
        let mut next: [Boxes; 2] = [Vec::new(), Vec::new()];
        for (side, (boxes, found)) in open.into_iter().zip(found).enumerate() {
            let mut large = Vec::new();
            for ((bounds, program, own), near) in boxes.into_iter().zip(found) {
                // Boxes of the other surface that are left may be anywhere.
                let near = if are_compared { near } else { 0.0 };
                if near >= known.least - known.loss || asked > MOST || bounds.size().length() <= slack {
                    least = least.min(near);
                } else {
                    large.push((bounds, program, own));
                }
            }
            let parts = |n: usize| {
                let (bounds, program, least): &(Bounds, Program, f64) = &large[n];
                bounds.octants().map(|own| surface(own, program, *least))
            };
            next[side] = jobs::in_order(large.len(), parts).into_iter().flatten().flatten().collect();
        }
        open = next;
        levels.down()?;
    }
    Ok(least)
}

/// How far two boxes are apart.
fn gap(one: &Bounds, other: &Bounds) -> f64 {
    (one.min - other.max).max(other.min - one.max).max(DVec3::ZERO).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::{compiled, surface_of};
    use crate::eval::Surface;

    /// What is told of two balls that are 1 apart, whose patches are those of balls that are
    /// smaller by .1 each, in doubt all over: in so many boxes each.
    fn told(boxes: usize, loss: f64) -> f64 {
        let by = 0.1;
        let balls = [0.0, 3.0].map(|x| Solid::sphere(1.0).translate([x, 0.0, 0.0]));
        let small = [0.0, 3.0].map(|x| surface_of(&Solid::sphere(1.0 - by).translate([x, 0.0, 0.0])).unwrap());
        let programs = balls.each_ref().map(|ball| compiled(ball).unwrap());
        let fine = small.iter().map(|surface| surface.tolerance).sum::<f64>();
        let surfaces = [0, 1].map(|n| {
            let doubts = vec![(balls[n].bounds().unwrap().inflate(0.01), by + small[n].tolerance); boxes];
            Surface::new(small[n].patches.clone(), small[n].accuracy, None).in_doubt(small[n].tolerance, doubts)
        });
        let sides = [0, 1].map(|n| Side::new(&programs[n], &surfaces[n], false));
        let known = Known { least: 1.0 + 2.0 * by - fine, loss };
        least([&sides[0], &sides[1]], &known, &Run::default()).unwrap()
    }

    #[test]
    fn what_both_surfaces_are_off_by_adds_up() {
        // Looked into, of one or both, or not at all; and with too many boxes to compare.
        for (boxes, loss) in [(1, 0.01), (1, 0.15), (1, 0.25), (2100, 0.01), (2100, 0.25)] {
            let least = told(boxes, loss);
            assert!(least <= 1.0 + 1e-9, "{least} of {boxes} boxes, with a loss of {loss}");
        }
        assert!(told(1, 0.01) > 0.75 && told(1, 0.25) > 0.95);
    }
}
