//! Many answers, each of its own, on the threads of a run.

use rvachev_num::{Meter, jobs};

use crate::{Cancelled, Run};

/// What `answer` says of each number below `count`, in their order, on the threads of the caller;
/// a thread tells how far it is after `chunk` answers. One may take milliseconds: the run is asked
/// before each.
pub(crate) fn each<R: Send>(
    count: usize,
    chunk: usize,
    run: &Run,
    answer: impl Fn(usize) -> R + Sync,
) -> Result<Vec<R>, Cancelled> {
    let meter = Meter::new(run, count);
    let answers_of = |number: usize| {
        let numbers = number * chunk..count.min((number + 1) * chunk);
        let steps = numbers.len() as u64;
        let answers = numbers.map(|number| run.check().map(|()| answer(number)));
        let answers = answers.collect::<Result<Vec<R>, Cancelled>>()?;
        meter.add(steps);
        Ok(answers)
    };
    let all = jobs::try_in_order(count.div_ceil(chunk), answers_of)?;
    Ok(all.into_iter().flatten().collect())
}
