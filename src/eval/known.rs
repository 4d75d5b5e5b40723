//! What is known of the nodes of a graph, found out of what is known of their operands.

use std::collections::HashMap;

use crate::{Cancelled, Run, Solid};

/// By node. Who asks holds the nodes.
pub(super) struct Known<T>(HashMap<usize, T>);

impl<T> Default for Known<T> {
    fn default() -> Known<T> {
        Known(HashMap::new())
    }
}

impl<T> Known<T> {
    /// The number of nodes.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn get(&self, solid: &Solid) -> Option<&T> {
        self.0.get(&solid.address())
    }

    /// Finds it out for a solid and what is `below` its nodes, that first, of each node once.
    pub(super) fn find<'a, I: IntoIterator<Item = &'a Solid>>(
        &mut self,
        root: &'a Solid,
        below: impl Fn(&'a Solid) -> I,
        found: impl Fn(&Known<T>, &Solid) -> Result<T, Cancelled>,
        run: &Run,
    ) -> Result<(), Cancelled> {
        let mut pending = vec![(root, false)];
        while let Some((solid, is_open)) = pending.pop() {
            run.check()?;
            if self.0.contains_key(&solid.address()) {
                continue;
            }
            if is_open {
                let found = found(self, solid)?;
                self.0.insert(solid.address(), found);
            } else {
                pending.push((solid, true));
                pending.extend(below(solid).into_iter().map(|part| (part, false)));
            }
        }
        Ok(())
    }
}
