//! What the examples show.

use rvachev::Solid;

macro_rules! examples {
    ($($name:ident $path:literal)*) => {
        $(
            #[allow(dead_code, clippy::duplicate_mod, reason = "of an example only what it shows is asked for")]
            #[path = $path]
            mod $name;
        )*
    };
}

examples! {
    bolt "../../examples/bolt.rs"
    bottle "../../examples/bottle.rs"
    bracket "../../examples/bracket.rs"
    chess_set "../../examples/chess_set.rs"
    custom_field "../../examples/custom_field.rs"
    distributor_cap "../../examples/distributor_cap.rs"
    gear_pair "../../examples/gear_pair.rs"
    inspect "../../examples/inspect.rs"
    lattice "../../examples/lattice.rs"
    lengths "../../examples/lengths.rs"
    measuring "../../examples/measuring.rs"
    parts "../../examples/parts.rs"
    piston "../../examples/piston.rs"
    turntable "../../examples/turntable.rs"
}

/// A name, and a solid that an example shows.
pub type Workpiece = (&'static str, Solid);

/// One of every kind that they show, without lengths and fillets.
pub fn plain() -> Vec<Workpiece> {
    vec![
        ("bolt", bolt::bolt()),
        ("sharp bracket", bracket::sharp()),
        ("pawn", chess_set::pawn()),
        ("rook", chess_set::rook()),
        ("bishop", chess_set::bishop()),
        ("queen", chess_set::queen()),
        ("king", chess_set::king()),
        ("knight", chess_set::knight()),
        ("board", chess_set::board()),
        ("knot on a dish", custom_field::dish()),
        ("distributor cap", distributor_cap::cap()),
        ("gear pair", gear_pair::pair()),
        ("inspected bracket", inspect::bracket(0.0, 0.0)),
        ("lattice", lattice::light_block()),
        ("block with a bore", measuring::block()),
        ("tray", measuring::tray()),
        ("flange", parts::flange()),
        ("bracket in inches", parts::bracket()),
        ("housing", parts::housing()),
        ("piston", piston::piston()),
        ("valve", turntable::valve()),
    ]
}

/// Those with lengths and fillets, which are measured.
pub fn measured() -> Vec<Workpiece> {
    let flush = ["flush", "flush, fillet", "flush, chamfer", "flush, smooth"].into_iter().zip(lengths::flush());
    let rounded = ["comb", "filled comb", "rounded comb"].into_iter().zip(lengths::no_fit());
    let others = [("bottle", bottle::wall() | bottle::thread()), ("bracket", bracket::bracket())];
    others.into_iter().chain(flush).chain(rounded).collect()
}
