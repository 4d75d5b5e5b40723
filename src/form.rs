//! The graph of a solid as others may read it: [`Solid::form`](crate::Solid::form).

pub use crate::solid::{DeformationForm, Form, LeafForm, Length, Operation, Repetition};
