//! Points that are in one place.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};

/// Points by place, each with something of it: those are in one place whose cells touch.
pub(super) fn places<T>(points: impl IntoIterator<Item = (DVec3, T)>, cell: f64) -> Vec<Vec<(DVec3, T)>> {
    let mut cells: BTreeMap<[i32; 3], Vec<(DVec3, T)>> = BTreeMap::new();
    for (p, of) in points {
        cells.entry((p / cell).floor().as_ivec3().to_array()).or_default().push((p, of));
    }
    let mut places = Vec::new();
    while let Some((first, mut place)) = cells.pop_first() {
        let mut open = vec![IVec3::from_array(first)];
        while let Some(cell) = open.pop() {
            for i in 0..27 {
                let next = cell + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1;
                if let Some(more) = cells.remove(&next.to_array()) {
                    place.extend(more);
                    open.push(next);
                }
            }
        }
        places.push(place);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_touches_is_one_place() {
        let points = [0.0, 0.5, 1.4, 5.0, 5.2].map(|x| (DVec3::X * x, x));
        let found = places(points, 1.0);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [3, 2]);
        assert_eq!(found[1][0].1, 5.0);
    }
}
