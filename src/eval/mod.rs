//! From a graph to programs, and the programs' evaluators.
//!
//! A [`Solid`](crate::Solid) compiles to two [`Program`]s over one `Scene` of placed leaves:
//! the *field program* gives true values; the *surface program* has min and max in place of
//! R-functions, which is the same solid with the same surface and normals, and which can be
//! narrowed to a region.

mod accuracy;
mod apart;
mod around;
mod atoms;
mod bend;
mod bevel;
mod bracket;
mod bytes;
mod chain;
mod chamfer;
mod coat;
mod code;
mod compile;
mod composite;
mod context;
mod contrary;
mod crossing;
mod depth;
mod even;
mod exact;
mod extent;
mod few;
mod fill;
mod fillets;
mod fit;
mod flatten;
mod flush;
mod hierarchy;
mod joint;
mod known;
mod layers;
mod list;
mod local;
mod moved_in;
mod narrow;
mod nothing;
mod owner;
mod palette;
mod partial;
mod pass;
mod point;
mod program;
mod ranges;
mod ray;
mod register;
mod repeat;
mod rise;
mod rolled;
mod room;
mod runs;
mod sampled;
mod scene;
mod seamless;
mod shares;
mod sided;
mod sides;
mod signed;
mod source;
mod support;
mod swell;
mod tape;
mod thin;
mod tiles;
mod tiling;
mod unfold;

pub use accuracy::Accuracy;
pub(crate) use narrow::Narrowed;
pub use owner::Owner;
pub use palette::Palette;
pub use program::{Program, Region};
pub use ray::Hit;
pub use tape::{Evaluator, Gradients, Tape, UnequalSlices};

/// To so many boxes a program is best narrowed in one go, if any of its leaves are dear.
pub(crate) use rvachev_field::BOXES as BOXES_AT_ONCE;

pub(crate) use around::{AROUND, BESIDE, ROUNDING};
pub(crate) use atoms::{Atom, Number};
pub(crate) use bend::Bend;
pub(crate) use bracket::Bracket;
pub(crate) use bytes::Counted;
pub(crate) use compile::{Compiled, compile, compile_and_bound};
pub(crate) use composite::{as_leaf, with_evaluator};
pub(crate) use crossing::distance;
pub(crate) use fillets::Fillets;
pub(crate) use partial::Partial;
pub(crate) use point::limited;
pub(crate) use ray::{Care, bracket, first_hit};
pub(crate) use runs::Block;
pub(crate) use rvachev_field::{Crease, Op};
pub(crate) use scene::Instance;
pub(crate) use source::{CompileError, DistanceSource, Surface, Wanted, surface};
pub(crate) use thin::SlenderLeaf;
