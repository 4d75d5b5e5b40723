//! A count that is made when it is first asked for.

use std::fmt;
use std::sync::{Arc, OnceLock};

use crate::{Cancelled, Run};

/// A count that costs too much to be made for each mesh, if there is one; copies share it.
///
/// It says nothing about the shape: all are equal.
#[derive(Clone, Default)]
pub(crate) struct LateCount(Option<Arc<Late>>);

struct Late {
    known: OnceLock<usize>,
    count: Box<Count>,
}

type Count = dyn Fn(&Run) -> Result<usize, Cancelled> + Send + Sync;

impl LateCount {
    pub(crate) fn new(count: impl Fn(&Run) -> Result<usize, Cancelled> + Send + Sync + 'static) -> LateCount {
        LateCount(Some(Arc::new(Late { known: OnceLock::new(), count: Box::new(count) })))
    }

    /// One that is known.
    pub(crate) fn known(count: usize) -> LateCount {
        LateCount::new(move |_| Ok(count))
    }

    /// Whether it has yet to be made.
    pub(super) fn is_open(&self) -> bool {
        self.0.as_ref().is_some_and(|late| late.known.get().is_none())
    }

    /// The count. Threads that ask at once may count each: one that waited for another could be waited for itself.
    pub(super) fn get(&self, run: &Run) -> Result<Option<usize>, Cancelled> {
        let Some(Late { known, count }) = self.0.as_deref() else { return Ok(None) };
        let fresh = || {
            let fresh = count(run)?;
            Ok(*known.get_or_init(|| fresh))
        };
        known.get().copied().map_or_else(fresh, Ok).map(Some)
    }
}

impl PartialEq for LateCount {
    fn eq(&self, _: &LateCount) -> bool {
        true
    }
}

impl fmt::Debug for LateCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.as_ref().map(|late| late.known.get()) {
            None => f.write_str("none"),
            Some(None) => f.write_str("not counted yet"),
            Some(Some(known)) => known.fmt(f),
        }
    }
}
