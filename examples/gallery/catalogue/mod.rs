//! All that is shown: families of entries, each a name and the solid it stands for.
//!
//! Solids are about 2 length units wide.

mod joins;
mod leaves;
mod maps;
mod plane;

use rvachev::Solid;

/// A name, and how the solid is made.
pub type Entry = (&'static str, fn() -> Solid);

/// Entries that belong together, and their colour.
pub struct Family {
    pub title: &'static str,
    pub color: [u8; 3],
    pub entries: &'static [Entry],
}

pub const FAMILIES: &[Family] = &[
    Family { title: "superquadrics", color: [206, 122, 90], entries: leaves::SUPERQUADRICS },
    Family { title: "supershapes", color: [208, 158, 72], entries: leaves::SUPERSHAPES },
    Family { title: "exact primitives", color: [112, 150, 186], entries: leaves::PRIMITIVES },
    Family { title: "lattices", color: [92, 160, 152], entries: leaves::LATTICES },
    Family { title: "formulas", color: [178, 134, 112], entries: leaves::FORMULAS },
    Family { title: "profiles", color: [152, 172, 96], entries: plane::PROFILES },
    Family { title: "extruded revolved swept", color: [104, 160, 116], entries: plane::SWEEPS },
    Family { title: "joins", color: [146, 130, 184], entries: joins::JOINS },
    Family { title: "rules seen at a level", color: [124, 128, 190], entries: joins::RULES },
    Family { title: "blends", color: [190, 122, 156], entries: joins::BLENDS },
    Family { title: "levels and lengths", color: [132, 146, 160], entries: maps::LENGTHS },
    Family { title: "maps", color: [196, 164, 124], entries: maps::MAPS },
];
