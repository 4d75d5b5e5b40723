//! Which candidates make the part, in which order.
//!
//! ```text
//!     beam of 3:   + c at the end     − c at the end     + c before what is subtracted     + c, − d at once
//!     then:        drop, exchange, move, add anywhere, add again below holes, change an end and cut
//! ```
//!
//! Adding alone returns nothing of a tube: its cylinder is more wrong than right before it is
//! bored, so pairs are tried with what is wrong counted a little. The order decides: what is added
//! late closes holes that were cut before, which are then cut again if they pay.

use rvachev_num::order;

use super::bits::{Bits, Stakes, weight};
use super::boxes::Grid;
use super::leaf::Leaf;
use super::model::{GRAIN, Judge, Model, Step};
use super::pool::Pool;
use super::queries::Queries;
use crate::{CancelToken, Cancelled, Run};

/// Models that are followed at once.
const BEAM: usize = 3;

/// What wrong samples count at most in a leaf that is to be cut after it is added.
const FORGIVING: f64 = 0.15;

/// Cuts of one leaf that are tried before it is given up.
const CUTS: usize = 16;

/// Leaves that are tried in the place of one.
const REBUILT: usize = 4;

/// What a leaf costs beside its own price in the second search, in parameters, which is for trees
/// of so many leaves: of more it takes long.
const DEARER: f64 = 7.0;
const SEARCHED_AGAIN: std::ops::RangeInclusive<usize> = 4..=16;

/// Most leaves.
const MOST: usize = 48;

/// Rounds of changes.
const PASSES: usize = 6;

/// Chooses leaves.
pub(super) struct Selector<'a> {
    pub(super) pool: Pool,
    pub(super) queries: &'a Queries,
    /// Where boxes are looked for.
    pub(super) grids: Vec<Grid>,
    /// Changes are left off when it is cancelled; what comes of them is of no use then.
    pub(super) cancel: CancelToken,
}

impl Selector<'_> {
    fn judge(&self) -> Judge<'_> {
        Judge { pool: &self.pool, queries: self.queries }
    }

    pub(super) fn model(&self, steps: Vec<Step>) -> Model {
        self.judge().model(steps)
    }

    /// The leaves of steps.
    pub(super) fn leaves(&self, steps: &[Step]) -> Vec<(bool, Leaf)> {
        steps.iter().map(|step| (step.adds, self.pool.candidates[step.which as usize].leaf.clone())).collect()
    }

    /// What a model has wrong, without what its leaves cost.
    pub(super) fn error(&self, model: &Model) -> f64 {
        self.judge().error(&model.state)
    }

    /// The best candidates for stakes, boxes included that are not yet among them.
    fn best(&mut self, steps: &[Step], stakes: &Stakes, adds: bool, dear: f64, count: usize) -> Vec<(f64, u32)> {
        for grid in &mut self.grids {
            grid.propose(stakes, adds, dear, self.queries, &mut self.pool);
        }
        self.judge().best(steps, stakes, adds, dear, count)
    }

    fn with(&self, steps: &[Step], place: usize, step: Step) -> Model {
        let mut steps = steps.to_vec();
        steps.insert(place, step);
        self.model(steps)
    }

    /// The better of two trees for the part: from leaves at their own prices, and from such as are
    /// dearer, which brings forth few and large ones. Where planes are cheap, a wedge is begun as a
    /// block with planes cut off, which nothing leads back from.
    pub(super) fn search(&mut self, run: &Run) -> Result<Model, Cancelled> {
        let [to_begin, to_begin_again] = run.stages([1.0, 1.0]);
        let first = self.select(Vec::new(), &to_begin)?;
        if !SEARCHED_AGAIN.contains(&first.steps.len()) {
            return Ok(first);
        }
        self.pool.charge(DEARER);
        let second = self.grown(Vec::new(), &to_begin_again)?;
        self.pool.charge(0.0);
        let second = self.improve(self.model(second.steps), &to_begin_again)?;
        Ok(if second.cost < first.cost - GRAIN { second } else { first })
    }

    /// The tree for the part, from a model that may be empty.
    pub(super) fn select(&mut self, start: Vec<Step>, run: &Run) -> Result<Model, Cancelled> {
        let grown = self.grown(start, run)?;
        self.improve(grown, run)
    }

    /// A model to which leaves were added, or cut, as long as that is for the better.
    fn grown(&mut self, start: Vec<Step>, run: &Run) -> Result<Model, Cancelled> {
        let mut best = self.model(start);
        let mut beam = vec![best.clone()];
        while beam[0].steps.len() < MOST {
            run.check()?;
            let mut children: Vec<Model> = Vec::new();
            for model in &beam {
                run.check()?;
                for child in self.children(model) {
                    let is_new = children.iter().all(|other| other.state != child.state);
                    if child.cost < model.cost - GRAIN && is_new {
                        children.push(child);
                    }
                }
            }
            if children.is_empty() {
                break;
            }
            order::rising(&mut children, |a| a.cost);
            children.truncate(BEAM);
            if children[0].cost < best.cost - GRAIN {
                best = children[0].clone();
                // What is explained; the changes that come then take a while as well.
                run.report(0.8 * (1.0 - best.cost));
            }
            beam = children;
        }
        Ok(best)
    }

    /// What may come next.
    fn children(&mut self, model: &Model) -> Vec<Model> {
        let steps = &model.steps;
        let end = steps.len();
        let first_cut = steps.iter().position(|step| !step.adds).unwrap_or(end);
        let mut children = Vec::new();
        for (place, adds) in [(end, true), (end, false), (first_cut, true)] {
            if (place == first_cut && place == end && children.len() > BEAM) || (!adds && end == 0) {
                continue;
            }
            if self.cancel.is_cancelled() {
                return Vec::new();
            }
            let stakes = self.judge().stakes(steps, place, adds);
            for (_, which) in self.best(steps, &stakes, adds, 1.0, BEAM) {
                children.push(self.with(steps, place, Step { adds, which }));
            }
        }
        children.extend(self.pairs(model, first_cut));
        if first_cut < end {
            children.extend(self.added_again(steps));
        }
        children
    }

    /// A leaf before what is subtracted and cuts of it at once, as many as it takes to be better
    /// than before.
    fn pairs(&mut self, model: &Model, place: usize) -> Vec<Model> {
        let stakes = self.judge().stakes(&model.steps, place, true);
        // Of a thin shell nearly all that the leaf holds is wrong before it is cut.
        let queries = self.queries;
        let weights = &queries.weights;
        let dear = FORGIVING.min(0.5 * weight(&stakes.gain, weights) / weight(&stakes.loss, weights).max(GRAIN));
        let added = self.best(&model.steps, &stakes, true, dear, 2 * BEAM);
        let mut pairs = Vec::new();
        for (_, which) in added {
            if self.cancel.is_cancelled() {
                break;
            }
            let mut next = self.with(&model.steps, place, Step { adds: true, which });
            for _ in 0..CUTS {
                let stakes = self.judge().stakes(&next.steps, next.steps.len(), false);
                // If all that is too much were cut at once it would not do.
                if next.cost - weight(&stakes.gain, weights) > model.cost {
                    break;
                }
                let Some((_, which)) = self.best(&next.steps, &stakes, false, 1.0, 1).first().copied() else { break };
                next = self.with(&next.steps, next.steps.len(), Step { adds: false, which });
                if next.cost < model.cost - GRAIN {
                    pairs.push(next);
                    break;
                }
            }
        }
        pairs
    }

    /// Leaves added at the end, with those cuts after them that would be closed and pay.
    fn added_again(&mut self, steps: &[Step]) -> Vec<Model> {
        let end = steps.len();
        let mut stakes = self.judge().stakes(steps, end, true);
        let mut cuts = Bits::none(self.queries.words());
        for step in steps.iter().filter(|step| !step.adds) {
            cuts.join(self.judge().bits(*step));
        }
        // What a cut can open again is not lost.
        stakes.loss.remove(&cuts);
        let added = self.best(steps, &stakes, true, 1.0, 2 * BEAM);
        added.into_iter().map(|(_, which)| self.reinserted(steps, which)).collect()
    }

    /// The steps with a leaf added after the others, and the cuts that it would close made after
    /// it.
    ///
    /// Cuts are credited one after the other, as an overlap of two is opened only once.
    fn reinserted(&self, steps: &[Step], which: u32) -> Model {
        let judge = self.judge();
        let weights = &self.queries.weights;
        let mut open = self.pool.candidates[which as usize].bits.clone();
        let all = Stakes { gain: open.clone(), loss: Bits::none(self.queries.words()) };
        let mut cuts: Vec<(f64, usize)> = (steps.iter().enumerate())
            .filter(|(_, step)| !step.adds)
            .map(|(i, step)| (all.of(judge.bits(*step), weights), i))
            .filter(|(overlap, _)| *overlap > 0.0)
            .collect();
        order::falling(&mut cuts, |a| a.0);
        let mut last = Vec::new();
        for (_, i) in cuts {
            let bits = judge.bits(steps[i]);
            let stakes = judge.staked(&open.and(bits), false);
            if stakes.of(bits, weights) > 0.0 {
                open.remove(bits);
                last.push(i);
            }
        }
        last.sort_unstable();
        let mut order: Vec<Step> = (0..steps.len()).filter(|i| !last.contains(i)).map(|i| steps[i]).collect();
        order.push(Step { adds: true, which });
        order.extend(last.into_iter().map(|i| steps[i]));
        judge.model(order)
    }

    /// Changes a model until no change is for the better.
    pub(super) fn improve(&mut self, mut model: Model, run: &Run) -> Result<Model, Cancelled> {
        for pass in 0..PASSES {
            let before = model.cost;
            run.report(0.8 + 0.2 * pass as f64 / PASSES as f64);
            let changes: [fn(&mut Self, &mut Model); 6] =
                [Self::drop_one, Self::exchange, Self::move_one, Self::add_one, Self::change_end, Self::rebuild];
            for change in changes {
                run.check()?;
                change(self, &mut model);
            }
            if model.cost > before - GRAIN {
                break;
            }
        }
        Ok(model)
    }

    fn keep(&self, model: &mut Model, steps: Vec<Step>) -> bool {
        let next = self.model(steps);
        let better = next.cost < model.cost - GRAIN;
        if better {
            *model = next;
        }
        better
    }

    /// Leaves out what is not worth its parameters.
    fn drop_one(&mut self, model: &mut Model) {
        let mut i = 0;
        while i < model.steps.len() {
            let mut steps = model.steps.clone();
            steps.remove(i);
            if !self.keep(model, steps) {
                i += 1;
            }
        }
    }

    /// Another leaf in the place of each.
    fn exchange(&mut self, model: &mut Model) {
        for i in 0..model.steps.len() {
            if self.cancel.is_cancelled() {
                return;
            }
            let mut rest = model.steps.clone();
            rest.remove(i);
            for adds in [true, false] {
                let stakes = self.judge().stakes(&rest, i, adds);
                for (_, which) in self.best(&rest, &stakes, adds, 1.0, 1) {
                    let mut steps = rest.clone();
                    steps.insert(i, Step { adds, which });
                    self.keep(model, steps);
                }
            }
        }
    }

    /// Several leaves in the place of each: one that does the work of two badly is in the way of
    /// both.
    fn rebuild(&mut self, model: &mut Model) {
        let mut i = 0;
        while i < model.steps.len() && !self.cancel.is_cancelled() {
            let mut steps = model.steps.clone();
            steps.remove(i);
            let mut next = self.model(steps);
            for _ in 0..REBUILT {
                let end = next.steps.len();
                let mut best: Option<Model> = None;
                for adds in [true, false] {
                    let stakes = self.judge().stakes(&next.steps, end, adds);
                    if let Some((_, which)) = self.best(&next.steps, &stakes, adds, 1.0, 1).first().copied() {
                        let one = self.with(&next.steps, end, Step { adds, which });
                        if one.cost < best.as_ref().unwrap_or(&next).cost - GRAIN {
                            best = Some(one);
                        }
                    }
                }
                let Some(best) = best else { break };
                next = best;
            }
            self.drop_one(&mut next);
            if next.cost < model.cost - GRAIN {
                *model = next;
            } else {
                i += 1;
            }
        }
    }

    fn move_one(&mut self, model: &mut Model) {
        for from in 0..model.steps.len() {
            if self.cancel.is_cancelled() {
                return;
            }
            for to in 0..model.steps.len() {
                let mut steps = model.steps.clone();
                let step = steps.remove(from);
                steps.insert(to, step);
                self.keep(model, steps);
            }
        }
    }

    /// One more, at whatever place it is best.
    fn add_one(&mut self, model: &mut Model) {
        let mut tried: Vec<Model> = Vec::new();
        for place in 0..=model.steps.len() {
            if self.cancel.is_cancelled() {
                return;
            }
            for adds in [true, false] {
                if !adds && place == 0 {
                    continue;
                }
                let stakes = self.judge().stakes(&model.steps, place, adds);
                for (_, which) in self.best(&model.steps, &stakes, adds, 1.0, 1) {
                    tried.push(self.with(&model.steps, place, Step { adds, which }));
                }
            }
        }
        tried.extend(self.children(model));
        if let Some(best) = tried.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
            && best.cost < model.cost - GRAIN
        {
            *model = best;
        }
    }

    /// The same surface with another end, and the best cut then: a bore that ends where a wider one
    /// begins.
    fn change_end(&mut self, model: &mut Model) {
        let mut i = 0;
        while i < model.steps.len() && !self.cancel.is_cancelled() {
            let step = model.steps[i];
            if let Some(family) = self.pool.candidates[step.which as usize].family {
                let others: Vec<u32> = (0..)
                    .zip(&self.pool.candidates)
                    .filter(|(which, other)| *which != step.which && other.family == Some(family))
                    .map(|(which, _)| which)
                    .collect();
                for which in others {
                    if self.cancel.is_cancelled() {
                        return;
                    }
                    let Some(at) = model.steps.get(i).copied() else { break };
                    let mut steps = model.steps.clone();
                    steps[i] = Step { which, ..at };
                    let stakes = self.judge().stakes(&steps, steps.len(), false);
                    let Some((_, cut)) = self.judge().best(&steps, &stakes, false, 1.0, 1).first().copied() else {
                        continue;
                    };
                    steps.push(Step { adds: false, which: cut });
                    self.keep(model, steps);
                }
            }
            i += 1;
        }
    }
}
