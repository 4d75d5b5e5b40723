//! Equality and hashing by structure.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use super::Solid;
use super::signature::{Numbering, Signature, in_order};

/// Two solids are equal if they are written alike: the same nodes with the same parameters,
/// rules and names, and equal operands in the same order. Equal solids have the same values;
/// solids with the same values need not be equal ([`simplified`](Solid::simplified) makes
/// more of them so).
///
/// * Whether equal parts are stored once or several times makes no difference, nor does the
///   method that made an affine map: `translate` equals `affine` with the same map.
/// * Parameters are compared by their `Debug` text, which gives numbers exactly: 0 and −0
///   differ, NaN equals NaN. For users' leaves see [`Field`](crate::field::Field).
///
/// The work is proportional to the number of nodes; parts that are stored once are compared
/// once.
///
/// ```
/// use rvachev::Solid;
///
/// let pin = |radius: f64| Solid::cylinder(radius, 4.0).translate([0.0, 0.0, 2.0]);
/// assert_eq!(pin(1.0), pin(1.0));
/// assert_ne!(pin(1.0), pin(1.5));
/// ```
impl PartialEq for Solid {
    fn eq(&self, other: &Solid) -> bool {
        if self.address() == other.address() {
            return true;
        }
        // Most solids that differ do so at the root.
        let root = |solid: &Solid| Signature::new(solid.node(), vec![solid.node().operands().len() as u64]);
        if root(self) != root(other) {
            return false;
        }
        let mut numbering = Numbering::default();
        numbering.number(self) == numbering.number(other)
    }
}

impl Eq for Solid {}

impl Hash for Solid {
    /// Hashes the structure: equal solids have equal hashes. Solids may be keys of a map; what
    /// changes inside one is the evaluator's cache, which is no part of the hash (clippy's
    /// `mutable_key_type` cannot know).
    fn hash<H: Hasher>(&self, state: &mut H) {
        let mut hashes: HashMap<usize, u64> = HashMap::new();
        let mut last = 0;
        for solid in in_order(self) {
            let operands = solid.node().operands().iter().map(|operand| hashes[&operand.address()]).collect();
            let mut hasher = DefaultHasher::new();
            Signature::new(solid.node(), operands).hash(&mut hasher);
            last = hasher.finish();
            hashes.insert(solid.address(), last);
        }
        // The root comes last.
        state.write_u64(last);
    }
}

impl Solid {
    /// How many nodes the solid is made of: leaves, maps, joins and names. A part that is
    /// stored once and used in several places counts once.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let ball = Solid::sphere(1.0);
    /// assert_eq!((&ball | ball.translate([1.0, 0.0, 0.0])).node_count(), 3);
    /// ```
    #[must_use]
    pub fn node_count(&self) -> usize {
        in_order(self).len()
    }
}
