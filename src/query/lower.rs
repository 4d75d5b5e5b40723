//! Lowering to fidget.

use fidget::context::Tree;

use crate::distance::compiled;
use crate::{Solid, SolidError};
use rvachev_num::symbol::Arena;

impl Solid {
    /// The field as a fidget tree, with fidget's sign: negative inside.
    ///
    /// # Errors
    /// What is wrong with the solid.
    ///
    /// ```
    /// use fidget::{shape::EzShape, vm::VmShape};
    /// use rvachev::Solid;
    ///
    /// let shape = VmShape::from(Solid::sphere(2.0).to_fidget()?);
    /// let mut point = VmShape::new_point_eval();
    /// let (value, _) = point.eval(&shape.ez_point_tape(), 0.0, 0.0, 3.0).expect("no variables");
    /// assert_eq!(value, 1.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    pub fn to_fidget(&self) -> Result<Tree, SolidError> {
        let programs = compiled(self)?;
        let field = &programs.field;
        if let Some(leaf) = field.unlowered() {
            return Err(SolidError::NotLowered { path: field.scene.trail.path(leaf.step) });
        }
        let arena = Arena::default();
        let (x, y, z) = Tree::axes();
        let p = [arena.symbol(x), arena.symbol(y), arena.symbol(z)];
        let value = programs.field.evaluate(p, &mut Vec::new());
        Ok((-value).tree())
    }
}
