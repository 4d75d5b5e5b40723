//! Space divided into tiles that are numbered: of a periodic surface modulo its period lattice, so
//! that those of a unit cell are all there are.

use glam::{DMat3, DVec3};

use super::program::{Node, Program};
use crate::Bounds;

/// The number of a tile.
pub(super) type Key = [i64; 3];

/// Which tile a point is in.
pub(super) struct Tiling {
    /// The edges of a tile, as columns; the middle of the first is at the origin.
    edges: DMat3,
    to_number: DMat3,
    /// After how many tiles along each edge they are the same again, if ever.
    counts: Option<[i64; 3]>,
}

/// A tile that is the same as another one.
#[derive(Clone, Copy)]
pub(super) struct Representative {
    /// The number of that other one, by which the same tiles are known.
    pub(super) of: Key,
    /// How far it is moved from there.
    pub(super) by: DVec3,
}

impl Tiling {
    /// Tiles with sides of about a length, for a surface that repeats by a period or has none.
    pub(super) fn new(side: f64, period: Option<DMat3>) -> Tiling {
        let (edges, counts) = match period {
            None => (DMat3::from_diagonal(DVec3::splat(side)), None),
            Some(period) => {
                let columns = [period.x_axis, period.y_axis, period.z_axis];
                let counts = columns.map(|column| (column.length() / side).round().max(1.0));
                (period * DMat3::from_diagonal(DVec3::from_array(counts).recip()), Some(counts.map(|n| n as i64)))
            }
        };
        Tiling { edges, to_number: edges.inverse(), counts }
    }

    /// The number of the tile that a point is in.
    pub(super) fn key(&self, p: DVec3) -> Key {
        (self.to_number * p).round().to_array().map(|c| c as i64)
    }

    /// The least and the largest numbers of tiles that a box meets.
    pub(super) fn keys(&self, bounds: &Bounds) -> [Key; 2] {
        let middle = self.to_number * bounds.center();
        let half = self.to_number.abs() * bounds.half_extents();
        [middle - half, middle + half].map(|end| end.round().to_array().map(|c| c as i64))
    }

    /// The tile that is the same.
    pub(super) fn copy(&self, key: Key) -> Representative {
        let Some(counts) = self.counts else { return Representative { of: key, by: DVec3::ZERO } };
        let of = [0, 1, 2].map(|axis| key[axis].rem_euclid(counts[axis]));
        let steps = [0, 1, 2].map(|axis| (key[axis] - of[axis]) as f64);
        Representative { of, by: self.edges * DVec3::from_array(steps) }
    }

    /// A box that holds a tile.
    pub(super) fn region(&self, key: Key) -> Bounds {
        let centre = self.edges * DVec3::from_array(key.map(|c| c as f64));
        Bounds::from_center(centre, self.edges.abs() * DVec3::splat(0.5))
    }
}

impl Program {
    /// Three vectors, as columns, by each of which the surface may be moved without a change: those
    /// of its leaves, if they have the same.
    pub(super) fn period(&self) -> Option<DMat3> {
        let leaves = self.nodes.iter().filter_map(Node::valued_by);
        let mut periods = leaves.map(|leaf| {
            let instance = self.instance(leaf);
            let own = instance.field.period().filter(|_| instance.frame == 0)?;
            Some(instance.to_local.matrix3.inverse() * own)
        });
        let first = periods.next()??;
        let near = 1e-12 * first.to_cols_array().into_iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let is_sound = first.is_finite() && first.determinant().abs() > 0.0;
        (is_sound && periods.all(|period| period.is_some_and(|period| period.abs_diff_eq(first, near))))
            .then_some(first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_of_tiles_are_moved_by_whole_periods() {
        let period = DMat3::from_cols_array(&[3.0, 0.5, 0.0, -0.4, 2.0, 0.0, 0.1, 0.0, 7.0]);
        let tiling = Tiling::new(1.0, Some(period));
        for p in [DVec3::new(0.2, 0.1, 0.3), DVec3::new(100.0, -57.0, 31.0), DVec3::new(-1e6, 2.0, 5.0)] {
            let key = tiling.key(p);
            let Representative { of, by } = tiling.copy(key);
            let steps = period.inverse() * by;
            assert!(steps.abs_diff_eq(steps.round(), 1e-9), "{steps}");
            assert_eq!(tiling.key(p - by), of);
            assert!(tiling.region(of).inflate(1e-9).contains(p - by));
        }
    }
}
