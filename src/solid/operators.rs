//! The set operations as operators, of solids and of profiles alike.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Not, Sub, SubAssign};

use super::{Profile, Solid};
use crate::RFunction;

/// Implements an operator for one of `$shape` or a reference to it on the left and anything that
/// becomes one on the right, and its assigning form.
macro_rules! operator {
    ($shape:ident, $trait:ident, $method:ident, $assign:ident, $assign_method:ident, $named:ident, $doc:literal) => {
        impl<T: Into<$shape>> $trait<T> for $shape {
            type Output = $shape;

            #[doc = $doc]
            fn $method(self, other: T) -> $shape {
                self.$named(other, RFunction::default())
            }
        }

        impl<T: Into<$shape>> $trait<T> for &$shape {
            type Output = $shape;

            #[doc = $doc]
            fn $method(self, other: T) -> $shape {
                self.$named(other, RFunction::default())
            }
        }

        impl<T: Into<$shape>> $assign<T> for $shape {
            #[doc = $doc]
            fn $assign_method(&mut self, other: T) {
                *self = self.$named(other, RFunction::default());
            }
        }
    };
}

/// Implements all of them.
macro_rules! operators {
    ($shape:ident) => {
        operator!($shape, BitOr, bitor, BitOrAssign, bitor_assign, union, "Union by R_p, p = 2.");
        operator!($shape, BitAnd, bitand, BitAndAssign, bitand_assign, intersection, "Intersection by R_p, p = 2.");
        operator!($shape, Sub, sub, SubAssign, sub_assign, difference, "Difference by R_p, p = 2.");
        operator!(
            $shape,
            BitXor,
            bitxor,
            BitXorAssign,
            bitxor_assign,
            symmetric_difference,
            "Symmetric difference by R_p, p = 2."
        );

        impl Not for $shape {
            type Output = $shape;

            /// Everything outside.
            fn not(self) -> $shape {
                self.complement()
            }
        }

        impl Not for &$shape {
            type Output = $shape;

            /// Everything outside.
            fn not(self) -> $shape {
                self.complement()
            }
        }
    };
}

operators!(Solid);
operators!(Profile);
