//! A leaf behind a chain of affine maps and deformations: value and gradient with respect to
//! the points before the chain.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::super::pull::{product, pull};
use super::super::{AnyField, AnyWarp, Chunk, Placement, Zone};
use crate::kernel::CHUNK;
use crate::{Dual, Interval};
#[cfg(feature = "formula")]
use rvachev_num::symbol::Symbol;

/// The maps from the frame of the points to that of the leaf, and the leaf.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) maps: Vec<(DAffine3, Arc<dyn AnyWarp>)>,
    pub(super) to_leaf: DAffine3,
    pub(super) leaf: Arc<dyn AnyField>,
}

/// Value and gradient.
pub(super) struct Seen {
    pub(super) value: f64,
    pub(super) gradient: DVec3,
}

impl Chain {
    pub(super) fn at(&self, p: DVec3) -> Seen {
        let mut local = Dual::point(p.to_array());
        for (map, warp) in &self.maps {
            local = warp.duals(Placement::new(map, 1.0, 0.0).apply(local));
        }
        let dual = self.leaf.dual(Placement::new(&self.to_leaf, 1.0, 0.0).apply(local));
        Seen { value: dual.v, gradient: DVec3::from_array(dual.d) }
    }

    pub(super) fn value(&self, p: [f64; 3]) -> f64 {
        let mut local = p;
        for (map, warp) in &self.maps {
            local = warp.point(Placement::new(map, 1.0, 0.0).apply(local));
        }
        self.leaf.value(Placement::new(&self.to_leaf, 1.0, 0.0).apply(local))
    }

    #[cfg(feature = "formula")]
    pub(super) fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        let mut local = p;
        for (map, warp) in &self.maps {
            local = warp.symbols(Placement::new(map, 1.0, 0.0).apply(local));
        }
        self.leaf.symbol(Placement::new(&self.to_leaf, 1.0, 0.0).apply(local))
    }

    /// The leaf's own range over a zone.
    pub(super) fn range(&self, zone: &Zone) -> Interval {
        let mut zone = *zone;
        for (map, warp) in &self.maps {
            zone = zone.mapped(map).warped(&**warp);
        }
        self.leaf.range(&zone.mapped(&self.to_leaf))
    }

    /// The chain made ready for points that `placement` brings to its frame.
    pub(super) fn placed(&self, placement: &Placement) -> Placed<'_> {
        let mut before = placement.map();
        let mut maps = Vec::with_capacity(self.maps.len());
        for (map, warp) in &self.maps {
            maps.push((Placement::new(&(*map * before), 1.0, 0.0), &**warp));
            before = DAffine3::IDENTITY;
        }
        Placed { maps, to_leaf: Placement::new(&(self.to_leaf * before), 1.0, 0.0), leaf: &*self.leaf }
    }
}

/// A chain with its placements, for lanes.
pub(super) struct Placed<'a> {
    maps: Vec<(Placement, &'a dyn AnyWarp)>,
    to_leaf: Placement,
    leaf: &'a dyn AnyField,
}

/// A chunk of one number a point.
pub(super) type Column = [f32; CHUNK];

/// `K` numbers each of the first `len` points, as slices.
pub(super) fn columns<const K: usize>(all: &[Column; K], len: usize) -> [&[f32]; K] {
    std::array::from_fn(|i| &all[i][..len])
}

pub(super) fn columns_mut<const K: usize>(all: &mut [Column; K], len: usize) -> [&mut [f32]; K] {
    all.each_mut().map(|column| &mut column[..len])
}

impl Placed<'_> {
    /// Whether slices may be shorter than a chunk.
    pub(super) fn takes_short(&self) -> bool {
        self.leaf.takes_short()
    }

    /// Value and gradient.
    pub(super) fn gradients(&self, points: [&[f32]; 3], out: &mut [Column; 4]) {
        let len = points[0].len();
        let leaf = |points, out: &mut [Column; 4]| {
            self.leaf.gradients(Chunk { points, placement: &self.to_leaf, out: columns_mut(out, len) });
        };
        let Some(((first, warp), rest)) = self.maps.split_first() else { return leaf(points, out) };
        // The point behind the deformations so far, and its derivatives, row by row.
        let mut local = [[0.0; CHUNK]; 12];
        warp.jacobians(Chunk { points, placement: first, out: columns_mut(&mut local, len) });
        for (placement, warp) in rest {
            let above = local;
            let [x, y, z, ..] = columns(&above, len);
            let mut own = [[0.0; CHUNK]; 12];
            warp.jacobians(Chunk { points: [x, y, z], placement, out: columns_mut(&mut own, len) });
            let both = std::array::from_fn(|i| if i < 9 { &own[i + 3][..len] } else { &above[i - 6][..len] });
            let [px, py, pz, derivatives @ ..] = &mut local;
            for (to, from) in [px, py, pz].into_iter().zip(&own) {
                *to = *from;
            }
            product(both, columns_mut(derivatives, len));
        }
        let mut own = [[0.0; CHUNK]; 4];
        let [x, y, z, ..] = columns(&local, len);
        leaf([x, y, z], &mut own);
        let inputs = std::array::from_fn(|i| if i < 9 { &local[i + 3][..len] } else { &own[i - 8][..len] });
        let [value, slopes @ ..] = out;
        value.copy_from_slice(&own[0]);
        pull(inputs, columns_mut(slopes, len));
    }

    /// Values, by the kernel of values.
    pub(super) fn values(&self, points: [&[f32]; 3], out: &mut Column) {
        let len = points[0].len();
        let mut slot;
        let mut at = points;
        for (placement, warp) in &self.maps {
            let mut next = [[0.0; CHUNK]; 3];
            warp.lanes32(Chunk { points: at, placement, out: columns_mut(&mut next, len) });
            slot = next;
            at = columns(&slot, len);
        }
        self.leaf.lanes32(Chunk { points: at, placement: &self.to_leaf, out: [&mut out[..len]] });
    }
}
