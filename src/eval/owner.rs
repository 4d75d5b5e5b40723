//! Which leaf decides at a point.

use glam::DVec3;

use super::Program;

/// From this bit on the index of an [`Owner`] says which part of its leaf it is.
const PART: u32 = 20;

/// So many parts of a leaf are told apart.
const MOST: usize = 1 << 11;

/// A leaf of a solid, as an answer: which leaf decides here?
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Owner {
    /// The leaf's number, in the order of compiling; stable for one solid. Of an imported mesh with
    /// owners 2²⁰ times their place among the owners, sorted, is added: 0 of the least, 2047 of all
    /// from the 2048th on; nothing in a solid of more than 2²⁰ leaves.
    pub index: u32,
    /// The path from the root: `difference[1] / twist / superellipsoid`, with the names that
    /// parts [have](crate::Solid::named): `difference[1] / socket: twist / superellipsoid`. Of an
    /// imported mesh with owners it ends with that of the nearest triangle: `union[0] / mesh[7]`.
    pub path: String,
}

impl Program {
    /// Whether owners tell parts of leaves: where there are more leaves, there is no room.
    fn tells_parts(&self) -> bool {
        self.scene.leaves.len() <= 1 << PART
    }

    /// The number of the leaf that an owner is, or is a part of.
    pub(crate) fn leaf_of(&self, owner: u32) -> u32 {
        if self.tells_parts() { owner & ((1 << PART) - 1) } else { owner }
    }

    /// The leaf that decides at a point.
    #[must_use]
    pub fn owner(&self, p: impl Into<DVec3>) -> Owner {
        self.owner_of(self.deciding_owner(p.into()))
    }

    /// The number of the leaf that decides at a point, with its part.
    pub(crate) fn deciding_owner(&self, p: DVec3) -> u32 {
        let leaf = self.deciding_leaf(p);
        let field = &self.scene.leaves[leaf as usize].field;
        let is_told = field.parts().len() > 1 && self.tells_parts();
        let part = if is_told { field.part(self.local(leaf, p)).min(MOST - 1) } else { 0 };
        leaf | (part as u32) << PART
    }

    fn owner_of(&self, index: u32) -> Owner {
        let leaf = &self.scene.leaves[self.leaf_of(index) as usize];
        let mut path = self.scene.trail.path(leaf.step);
        if self.tells_parts()
            && let Some(part) = leaf.field.parts().get((index >> PART) as usize)
        {
            path = format!("{path}[{part}]");
        }
        Owner { index, path }
    }
}
