//! The erasing of what is built in: one function for each leaf and deformation.
//!
//! A leaf that is put behind a pointer brings all its kernels along. These functions are neither
//! generic nor inlined, so that the kernels are compiled here, and not again wherever a solid is
//! made. A user's own leaf is erased, with its kernels, in the user's crate.

use std::sync::Arc;

use crate::deform::{Cells, Sectors, TaperBy, TwistBy};
use crate::sweep::{HelixWarp, Opening, Revolution, Span};
use crate::{AnyField, AnyWarp, Law};

/// A built-in leaf or deformation, to be put behind a pointer.
pub trait Erase<Any: ?Sized> {
    /// Behind a pointer, with all its kernels.
    fn erase(self) -> Arc<Any>;
}

macro_rules! erase {
    ($any:ty: $($built_in:ty),* $(,)?) => {$(
        impl Erase<$any> for $built_in {
            #[inline(never)]
            fn erase(self) -> Arc<$any> {
                Arc::new(self)
            }
        }
    )*};
}

// What verbs are made of. What users make by name is declared, and erased, in the catalogue.
erase!(dyn AnyField: Opening, Span);
erase!(dyn AnyWarp: Cells, HelixWarp, Revolution, Sectors);

impl<X: Law, Y: Law> Erase<dyn AnyWarp> for TaperBy<X, Y> {
    fn erase(self) -> Arc<dyn AnyWarp> {
        Arc::new(self)
    }
}

impl<A: Law> Erase<dyn AnyWarp> for TwistBy<A> {
    fn erase(self) -> Arc<dyn AnyWarp> {
        Arc::new(self)
    }
}
