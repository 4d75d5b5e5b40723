//! Cells of which one imported mesh tells all.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::bracket::Held;
use super::columns::Columns;
use super::exact::Known;
use super::facets::Facets;
use crate::eval::Instance;
use crate::program::Program;
use crate::{Bounds, Cancelled, Run};

/// The triangles of a program's imported meshes that tell what these hold, by their leaves.
#[derive(Default)]
pub(super) struct Enclosed(BTreeMap<u32, Columns>);

impl Enclosed {
    pub(super) fn new(program: &Program, run: &Run) -> Result<Enclosed, Cancelled> {
        let quiet = Run { progress: None, ..run.clone() };
        let mut all = BTreeMap::new();
        for leaf in program.plain_leaves() {
            if let Some(facets) = Facets::of(&*leaf.field, &leaf.to_local.inverse(), &quiet)? {
                all.insert(leaf.number, Columns::new(facets));
            }
        }
        Ok(Enclosed(all))
    }

    /// The same of leaves of which it is known, by what triangles enclose them in their frames.
    pub(super) fn known<'a>(program: &Program, known: impl Iterator<Item = &'a Known>) -> Enclosed {
        let known: Vec<&Known> = known.collect();
        let columns = |leaf: &Instance| {
            let Known { few, .. } = known.iter().find(|known| Arc::ptr_eq(&known.field, &leaf.field))?;
            Some((leaf.number, Columns::new(few.0.placed(&leaf.to_local.inverse()))))
        };
        Enclosed(program.plain_leaves().filter_map(columns).collect())
    }

    /// What a cell has of a program that is one of these leaves, or all but it.
    pub(super) fn held(&self, program: &Program, cell: &Bounds) -> Option<Held> {
        if self.0.is_empty() {
            return None;
        }
        let (leaf, is_complement) = program.only_plain_leaf()?;
        let moments = self.0.get(&leaf.number)?.moments_in(cell);
        let moments = if is_complement { Held::whole(cell).moments.less(&moments) } else { moments };
        let volume = moments.volume.clamp(0.0, cell.size().element_product());
        Some(Held { least: volume, most: volume, moments })
    }

    /// How far the volume may be off, as corners are rounded.
    pub(super) fn volume_error(&self) -> f64 {
        self.0.values().map(Columns::volume_error).sum()
    }
}
