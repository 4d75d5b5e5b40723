//! What hangs together: disjoint sets, joined pair by pair (union-find).

/// Disjoint sets of the numbers below one.
pub(super) struct Groups(Vec<u32>);

impl Groups {
    pub(super) fn new(count: usize) -> Groups {
        Groups((0..count as u32).collect())
    }

    pub(super) fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            // Halving the path keeps later walks short.
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    /// Joins the sets of two numbers; whether they were different. The lowest number is the root of
    /// its set.
    pub(super) fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}
