//! What the benches show.

use rvachev::catalogue;
use rvachev::catalogue::Group;

#[allow(dead_code, reason = "of the rows their names are asked for")]
#[path = "../../benches/render/rows.rs"]
mod pictures;

#[test]
fn every_leaf_join_blend_and_map_has_a_picture() {
    let rows = pictures::catalogued();
    for entry in catalogue() {
        let is_value = matches!(entry.group(), Group::Curve | Group::Law | Group::Caps);
        assert_eq!(rows.iter().any(|row| row.name == entry.name()), !is_value, "{}", entry.name());
    }
}
