//! A count that is made when it is first asked for.

use std::fmt;
use std::sync::{Arc, OnceLock};

/// A count that costs too much to be made for each mesh, if there is one; copies share it.
///
/// It says nothing about the shape: all are equal.
#[derive(Clone, Default)]
pub(crate) struct LateCount(Option<Arc<Late>>);

struct Late {
    known: OnceLock<usize>,
    count: Box<dyn Fn() -> usize + Send + Sync>,
}

impl LateCount {
    pub(crate) fn new(count: impl Fn() -> usize + Send + Sync + 'static) -> LateCount {
        LateCount(Some(Arc::new(Late { known: OnceLock::new(), count: Box::new(count) })))
    }

    /// The count. Threads that ask at once may count each: one that waited for another could be waited for itself.
    pub(super) fn get(&self) -> Option<usize> {
        let Late { known, count } = self.0.as_deref()?;
        let fresh = || {
            let fresh = count();
            *known.get_or_init(|| fresh)
        };
        Some(known.get().copied().unwrap_or_else(fresh))
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
