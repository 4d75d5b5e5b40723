//! A cache that structurally equal solids share (by structural hash), freed with the last of them.
//!
//! ```text
//!     node --+
//!            +--> shelf        A node that has no shelf yet takes that of one that is equal to it and still
//!     node --+                 there: the list of all shelves keeps neither nodes nor shelves alive.
//! ```

use std::any::Any;
use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, LazyLock, Mutex, PoisonError, Weak};

use super::Solid;
use super::node::Inner;

/// So many things are kept of one solid: those that were last put there or asked for.
const MOST: usize = 8;

/// Things that are kept; who puts them there knows their types.
#[derive(Default)]
pub(crate) struct Shelf(Mutex<Vec<Arc<dyn Any + Send + Sync>>>);

impl Shelf {
    /// The first thing of a type that will do.
    pub(crate) fn find<T: Send + Sync + 'static>(&self, will_do: impl Fn(&T) -> bool) -> Option<Arc<T>> {
        let mut things = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let of = |thing: &Arc<dyn Any + Send + Sync>| thing.clone().downcast::<T>().ok().filter(|thing| will_do(thing));
        let (at, found) = things.iter().enumerate().find_map(|(at, thing)| Some((at, of(thing)?)))?;
        // The oldest is the first to go.
        let thing = things.remove(at);
        things.push(thing);
        Some(found)
    }

    pub(crate) fn keep<T: Send + Sync + 'static>(&self, thing: Arc<T>) {
        let mut things = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if things.len() >= MOST {
            things.remove(0);
        }
        things.push(thing);
    }
}

/// A node that has a shelf.
struct Owner {
    node: Weak<Inner>,
    shelf: Weak<Shelf>,
}

/// The nodes that have shelves, by the hash of their solids.
#[derive(Default)]
struct Owners {
    by_hash: HashMap<u64, Vec<Owner>>,
    /// When there are more, those that are gone are removed.
    limit: usize,
}

static OWNERS: LazyLock<Mutex<Owners>> = LazyLock::new(Mutex::default);

impl Owners {
    /// Removes those that are gone, now and then.
    fn tidy(&mut self) {
        if self.by_hash.len() <= self.limit {
            return;
        }
        self.by_hash.retain(|_, owners| {
            owners.retain(|owner| owner.node.strong_count() > 0);
            !owners.is_empty()
        });
        self.limit = 2 * self.by_hash.len();
    }
}

impl Solid {
    /// The shelf of this solid and of all that are equal to it; solids that ask for the first time
    /// at the same moment may each get their own.
    pub(crate) fn shelf(&self) -> &Shelf {
        self.0.shelf.get_or_init(|| {
            let mut hasher = DefaultHasher::new();
            self.hash(&mut hasher);
            let hash = hasher.finish();
            // What is known is compared when nobody holds the list: solids may be large.
            let known: Vec<(Solid, Arc<Shelf>)> = {
                let mut owners = OWNERS.lock().unwrap_or_else(PoisonError::into_inner);
                owners.tidy();
                let known = owners.by_hash.get(&hash).into_iter().flatten();
                known.filter_map(|owner| Some((Solid(owner.node.upgrade()?), owner.shelf.upgrade()?))).collect()
            };
            let shelf = known.into_iter().find(|(solid, _)| solid == self).map(|(_, shelf)| shelf).unwrap_or_default();
            let owner = Owner { node: Arc::downgrade(&self.0), shelf: Arc::downgrade(&shelf) };
            let mut owners = OWNERS.lock().unwrap_or_else(PoisonError::into_inner);
            let equal = owners.by_hash.entry(hash).or_default();
            equal.retain(|owner| owner.node.strong_count() > 0);
            equal.push(owner);
            shelf
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holed() -> Solid {
        Solid::cuboid([3.0, 2.0, 0.71]) - Solid::cylinder(0.53, 2.0)
    }

    #[test]
    fn equal_solids_have_one_shelf_and_others_have_their_own() {
        let (a, b) = (holed(), holed());
        a.shelf().keep(Arc::new(7_u32));
        assert_eq!(b.shelf().find(|n: &u32| *n > 5).as_deref(), Some(&7));
        assert_eq!(b.shelf().find(|n: &u32| *n > 8), None);
        assert_eq!(b.shelf().find(|_: &u64| true), None);
        assert_eq!(a.offset(0.1).shelf().find(|_: &u32| true), None);
    }

    #[test]
    fn little_is_kept_of_what_is_gone_or_was_asked_for_long_ago() {
        let held: Vec<Solid> = (1..12).map(|n| Solid::sphere(1.7 + f64::from(n))).collect();
        held.iter().for_each(|solid| solid.shelf().keep(Arc::new(0_u8)));
        let again = || holed().scale(1.017);
        (0..100).for_each(|_| again().shelf().keep(Arc::new(0_u8)));
        let mut hasher = DefaultHasher::new();
        again().hash(&mut hasher);
        let owners = OWNERS.lock().unwrap();
        assert!(owners.by_hash.get(&hasher.finish()).is_none_or(|equal| equal.len() <= 1));
        drop(owners);
        let solid = again();
        (0..3 * MOST).for_each(|n| solid.shelf().keep(Arc::new(n)));
        assert!(solid.shelf().find(|n: &usize| *n == 2 * MOST).is_some());
        assert!(solid.shelf().find(|n: &usize| *n < 2 * MOST).is_none());
        // What was asked for stays.
        (0..MOST - 1).for_each(|n| solid.shelf().keep(Arc::new(100 + n)));
        assert!(solid.shelf().find(|n: &usize| *n == 2 * MOST).is_some());
    }

    #[test]
    fn what_is_kept_goes_with_the_last_solid() {
        let thing = Arc::new(7_u32);
        let (a, b) = (holed().scale(1.013), holed().scale(1.013));
        a.shelf().keep(thing.clone());
        assert!(b.shelf().find(|_: &u32| true).is_some());
        drop(a);
        // The one that had it first is gone.
        assert!(holed().scale(1.013).shelf().find(|_: &u32| true).is_some());
        drop(b);
        assert_eq!(Arc::strong_count(&thing), 1);
        assert!(holed().scale(1.013).shelf().find(|_: &u32| true).is_none());
    }
}
