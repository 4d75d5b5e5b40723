//! How much memory programs take.

use std::collections::HashSet;
use std::mem::size_of_val;
use std::sync::Arc;

use super::Program;
use super::program::Kind;

/// The lists that were counted, by their addresses: programs share them.
#[derive(Default)]
pub(crate) struct Counted(HashSet<usize>);

impl Counted {
    /// The bytes of a list, if it was not counted before.
    fn list<T>(&mut self, list: &Arc<[T]>) -> Option<usize> {
        self.0.insert(Arc::as_ptr(list).cast::<T>().addr()).then(|| size_of_val(&**list))
    }
}

impl Program {
    /// The bytes that it takes beside the scene of its solid and what was counted before.
    pub(crate) fn bytes(&self, counted: &mut Counted) -> usize {
        let mut bytes = counted.list(&self.operands).unwrap_or(0);
        bytes += counted.list(&self.simpler).unwrap_or(0) + counted.list(&self.frames).unwrap_or(0);
        let Some(nodes) = counted.list(&self.nodes) else { return bytes };
        let hierarchies = self.nodes.iter().filter_map(|node| match &node.kind {
            Kind::Join { hierarchy, .. } => hierarchy.as_ref(),
            _ => None,
        });
        let taken = hierarchies.map(|all| if counted.0.insert(Arc::as_ptr(all).addr()) { all.bytes() } else { 0 });
        bytes + nodes + taken.sum::<usize>()
    }
}
