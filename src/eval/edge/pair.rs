//! The fillet of two parts, at a point and in lanes.

use glam::DVec3;

use super::super::Evaluator;
use super::super::composite::{Locals, Slopes};
use super::fillet::{Fillet, Search};
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
        let Some(mut search) = Search::start(self, p, here) else { return (join, 0.0) };
        while !search.ended {
            search.go_on(parts.map(|part| part.sample(search.at())));
        }
        (search.blend(join), search.tells())
    }

    /// The blend of two parts over a chunk, where it may be needed; none if it is their join there.
    pub(super) fn lanes_between(
        self,
        parts: [&Part; 2],
        here: [&Slopes; 2],
        (local, needed): (&Locals, &[bool]),
        evaluator: &mut Evaluator,
    ) -> Option<Slopes> {
        let here = |i: usize| here.map(|side| side.at(i));
        let start = |i: usize| {
            let near = needed[i] && self.near(here(i).map(|(value, _)| value));
            near.then(|| Search::start(self, local.get(i), here(i)))?
        };
        let mut searches: Vec<Option<Search>> = (0..local.count).map(start).collect();
        if searches.iter().all(Option::is_none) {
            return None;
        }
        let mut at = Locals { ..*local };
        while searches.iter().flatten().any(|search| !search.ended) {
            for (i, search) in searches.iter().enumerate() {
                at.set(i, search.filter(|search| !search.ended).map_or(local.get(i), |search| search.at()));
            }
            let sides = parts.map(|part| part.lanes(&at, evaluator));
            for (i, search) in searches.iter_mut().enumerate() {
                if let Some(search) = search.as_mut().filter(|search| !search.ended) {
                    search.go_on(sides.each_ref().map(|side| side.at(i)));
                }
            }
        }
        let mut out = Slopes::default();
        for (i, search) in searches.iter().enumerate() {
            let [x, y] = here(i);
            out.set(i, search.map_or(larger(x, y), |search| search.blend(larger(x, y))));
        }
        Some(out)
    }
}
