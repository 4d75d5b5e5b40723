//! Parts that the user names.

use super::{Node, Solid};

impl Solid {
    /// The same solid, called `name` by errors, by [`owner`](Solid::owner) and when the solid
    /// is [written out](Solid#impl-Display-for-Solid). Nothing else changes: a name costs
    /// nothing in evaluation.
    ///
    /// Control characters in the name, line breaks among them, become spaces.
    ///
    /// ```
    /// use rvachev::{rad, Solid};
    ///
    /// let socket = Solid::superellipsoid([3.0, 3.0, -2.0], 0.2, 1.0).twist(rad(0.1)).named("socket");
    /// let head = Solid::cylinder(5.0, 4.0).named("head") - socket;
    /// let error = head.bounds().unwrap_err().to_string();
    /// assert!(error.starts_with("difference[1] / socket: twist / superellipsoid: semi_axes.z is -2"));
    /// ```
    #[must_use]
    pub fn named(&self, name: impl AsRef<str>) -> Solid {
        let name: String = name.as_ref().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        Solid::from_node(Node::Named { operand: self.clone(), name: name.into() })
    }
}
