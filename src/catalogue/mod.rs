//! The catalogue: all that solids and profiles are made of, by name.
//!
//! Leaves, plane shapes and deformations come from the declarations in the crate of formulas that
//! also erase them; verbs, R-functions, blends, laws and caps are declared here, in the same form.

mod attributes;
mod call;
mod entry;
#[cfg(feature = "formula")]
mod formulas;
mod joins;
mod maps;
mod part;
mod sweeps;
mod values;
mod verb;

use std::sync::OnceLock;

pub use call::Call;
pub use entry::{Entry, Group, Operands};
pub use part::Part;
#[doc(inline)]
pub use rvachev_field::catalogue::{Kind, Parameter, Range, Unit, Value, ValueError};

use rvachev_field::catalogue::{CURVES, DEFORMATIONS, LAW_DEFORMATIONS, PLANE_LEAVES, leaves};

/// Everything that solids and profiles are made of: each leaf, plane shape, operation, blend,
/// length, map and what parameters are made of, with name, parameters, ranges and a line of docs.
///
/// Names are those of the Rust methods. A name stands for one entry.
///
/// ```
/// use rvachev::catalogue::{Part, Value};
/// use rvachev::{Solid, catalogue};
///
/// let find = |name: &str| catalogue().iter().find(|entry| entry.name() == name).expect("it is there");
/// let ball = find("sphere").make(&[], &[Value::Number(2.0)])?;
/// assert_eq!(ball, Part::Solid(Solid::sphere(2.0)));
///
/// let offset = find("offset");
/// assert_eq!(offset.parameters()[0].name(), "distance");
/// let larger = offset.make(&[ball], &[Value::Number(0.5)])?;
/// assert_eq!(larger.into_solid(), Some(Solid::sphere(2.0).offset(0.5)));
/// # Ok::<(), rvachev::catalogue::ValueError>(())
/// ```
#[must_use]
pub fn catalogue() -> &'static [Entry] {
    static CATALOGUE: OnceLock<Vec<Entry>> = OnceLock::new();
    CATALOGUE.get_or_init(|| {
        let leaves = leaves().map(Entry::leaf);
        let profiles = PLANE_LEAVES.iter().map(Entry::plane_leaf);
        let deformations = DEFORMATIONS.iter().chain(LAW_DEFORMATIONS).map(Entry::deformation);
        let verbs = [
            sweeps::VERBS,
            #[cfg(feature = "formula")]
            formulas::VERBS,
            joins::VERBS,
            maps::VERBS,
            attributes::VERBS,
            values::VERBS,
        ];
        let entries = leaves.chain(profiles).chain(deformations).chain(CURVES.iter().map(Entry::curve));
        entries.chain(verbs.into_iter().flatten().map(Entry::verb)).collect()
    })
}

/// The entry with this name.
fn entry(name: &str) -> Option<&'static Entry> {
    catalogue().iter().find(|entry| entry.name() == name)
}
