//! The fillet of two parts: steps to the foot, at a point and in lanes.

use glam::DVec3;

use super::super::Evaluator;
use super::super::composite::{Locals, Slopes};
use super::fillet::{Fillet, Foot, STEPS};
use super::sides::Part;
use super::{Sample, larger};

impl Fillet {
    /// The blend of two parts, and how far around it tells anything: nowhere if the search for the foot
    /// has failed, as it does on a part's medial axis and beside its own edges.
    pub(super) fn between(self, parts: [&Part; 2], here: [Sample; 2], p: DVec3) -> (Sample, f64) {
        let join = larger(here[0], here[1]);
        if !self.near(here.map(|(value, _)| value)) {
            return (join, f64::INFINITY);
        }
        let mut foot = Foot::new(p);
        if !foot.step(p, here, self) {
            return (join, 0.0);
        }
        let (first, mut off) = (foot, f64::INFINITY);
        for step in 1..=STEPS {
            let sides = parts.map(|part| part.sample(foot.q));
            off = self.off(&foot, sides);
            if step == STEPS {
                break;
            }
            if !foot.step(p, sides, self) {
                off = f64::INFINITY;
                break;
            }
            if self.ends(&foot, step) {
                break;
            }
        }
        (self.blend(p, join, &first, &foot, off), self.tells(p, &foot, off))
    }

    /// The blend of two parts over a chunk, where it may be needed; none if it is their join there.
    pub(super) fn lanes_between(
        self,
        parts: [&Part; 2],
        here: [&Slopes; 2],
        (local, needed): (&Locals, &[bool]),
        evaluator: &mut Evaluator,
    ) -> Option<Slopes> {
        let mut feet: Vec<Option<[Foot; 2]>> = (0..local.count)
            .map(|i| {
                let (p, sides) = (local.get(i), here.map(|side| side.at(i)));
                let mut foot = Foot::new(p);
                let near = needed[i] && self.near(sides.map(|(value, _)| value)) && foot.step(p, sides, self);
                near.then_some([foot; 2])
            })
            .collect();
        if feet.iter().all(Option::is_none) {
            return None;
        }
        let mut offs = vec![f64::INFINITY; local.count];
        let mut ends: Vec<bool> = feet.iter().map(Option::is_none).collect();
        let mut at = Locals { ..*local };
        for step in 1..=STEPS {
            for (i, feet) in feet.iter().enumerate() {
                at.set(i, feet.filter(|_| !ends[i]).map_or(local.get(i), |[_, foot]| foot.q));
            }
            let sides = parts.map(|part| part.lanes(&at, evaluator));
            for (i, feet) in feet.iter_mut().enumerate() {
                let Some([_, foot]) = feet.as_mut().filter(|_| !ends[i]) else { continue };
                let sides = sides.each_ref().map(|side| side.at(i));
                offs[i] = self.off(foot, sides);
                if step == STEPS {
                    continue;
                }
                if foot.step(local.get(i), sides, self) {
                    ends[i] = self.ends(foot, step);
                } else {
                    (offs[i], ends[i]) = (f64::INFINITY, true);
                }
            }
            if !ends.contains(&false) {
                break;
            }
        }
        let mut out = Slopes::default();
        for (i, feet) in feet.iter().enumerate() {
            let join = larger(here[0].at(i), here[1].at(i));
            out.set(
                i,
                feet.as_ref().map_or(join, |[first, last]| self.blend(local.get(i), join, first, last, offs[i])),
            );
        }
        Some(out)
    }
}
