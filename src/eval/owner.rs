//! Which leaf decides at a point.

use glam::DVec3;

use super::Program;

/// A leaf of a solid, as an answer: which leaf decides here?
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Owner {
    /// The leaf's number, in the order of compiling; stable for one solid.
    pub index: u32,
    /// The path from the root: `difference[1] / twist / superellipsoid`, with the names that
    /// parts [have](crate::Solid::named): `difference[1] / socket: twist / superellipsoid`.
    pub path: String,
}

impl Program {
    /// The leaf that decides at a point.
    #[must_use]
    pub fn owner(&self, p: impl Into<DVec3>) -> Owner {
        self.owner_of(self.deciding_leaf(p.into()))
    }

    pub(crate) fn owner_of(&self, leaf: u32) -> Owner {
        let step = self.scene.leaves[leaf as usize].step;
        Owner { index: leaf, path: self.scene.trail.path(step) }
    }
}
