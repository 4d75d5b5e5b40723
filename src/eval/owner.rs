//! Which leaf decides at a point.

use glam::DVec3;

use super::Program;

/// From this number on owners are parts of leaves, other than the first part of each.
const PARTS: u32 = 1 << 31;

/// A leaf of a solid, as an answer: which leaf decides here?
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Owner {
    /// The leaf's number, in the order of compiling; stable for one solid. Of an imported mesh with
    /// owners the least of these has it; the others, sorted, are counted from 2³¹ on, those of the
    /// first such mesh first.
    pub index: u32,
    /// The path from the root: `difference[1] / twist / superellipsoid`, with the names that
    /// parts [have](crate::Solid::named): `difference[1] / socket: twist / superellipsoid`. Of an
    /// imported mesh with owners it ends with that of the nearest triangle: `union[0] / mesh[7]`.
    pub path: String,
}

impl Program {
    /// The number of the leaf that an owner is, or is a part of.
    pub(crate) fn leaf_of(&self, owner: u32) -> u32 {
        self.leaf_and_part(owner).0
    }

    /// The leaf that an owner is of, and which of its parts it is.
    fn leaf_and_part(&self, owner: u32) -> (u32, usize) {
        let Some(number) = owner.checked_sub(PARTS) else { return (owner, 0) };
        let number = number as usize;
        let after = self.scene.parted.partition_point(|parted| parted.before <= number);
        let Some(parted) = after.checked_sub(1).and_then(|at| self.scene.parted.get(at)) else { return (owner, 0) };
        (parted.leaf, number - parted.before + 1)
    }

    /// The owner that a part of a leaf is.
    fn owner_of_part(&self, leaf: u32, part: usize) -> u32 {
        let at = self.scene.parted.binary_search_by_key(&leaf, |parted| parted.leaf);
        let number = at.ok().filter(|_| part > 0).map(|at| self.scene.parted[at].before + part - 1);
        number.map_or(leaf, |number| PARTS.saturating_add(u32::try_from(number).unwrap_or(u32::MAX)))
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
        let part = if field.parts().len() > 1 { field.part(self.local(leaf, p)) } else { 0 };
        self.owner_of_part(leaf, part)
    }

    fn owner_of(&self, index: u32) -> Owner {
        let (leaf, part) = self.leaf_and_part(index);
        let leaf = &self.scene.leaves[leaf as usize];
        let mut path = self.scene.trail.path(leaf.step);
        if let Some(part) = leaf.field.parts().get(part) {
            path = format!("{path}[{part}]");
        }
        Owner { index, path }
    }
}
