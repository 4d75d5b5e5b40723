//! Some points of a chunk, and values there: what is not told by less is asked of few.

use glam::DVec3;

use super::signed::Signed;
use rvachev_field::kernel::Element;
use rvachev_field::{AnyField, Chunk, Placement};

/// Numbers that values are asked for in.
pub(super) trait Lane: Element {
    fn values(field: &dyn AnyField, chunk: Chunk<'_, Self, 1>, band: f64);
}

impl Lane for f32 {
    fn values(field: &dyn AnyField, chunk: Chunk<'_, f32, 1>, band: f64) {
        field.lanes32_within(chunk, band);
    }
}

impl Lane for f64 {
    fn values(field: &dyn AnyField, chunk: Chunk<'_, f64, 1>, _band: f64) {
        field.lanes64(chunk);
    }
}

/// Some points of a chunk.
pub(super) struct Few<E> {
    points: [Vec<E>; 3],
    /// Where they are in the chunk.
    pub(super) places: Vec<usize>,
    /// What is known of each.
    pub(super) known: Vec<f64>,
}

impl<E: Lane> Few<E> {
    pub(super) fn of(places: impl Iterator<Item = usize>, points: [&[E]; 3]) -> Few<E> {
        let places: Vec<usize> = places.collect();
        let points = points.map(|axis| places.iter().map(|i| axis[*i]).collect());
        Few { points, places, known: Vec::new() }
    }

    /// Values at the points, told apart up to so far from a level.
    pub(super) fn values(&self, of: &Signed, placement: &Placement, (level, band): (f64, f64)) -> Vec<f64> {
        let (count, points) = (self.places.len(), self.filled());
        let mut values = vec![E::default(); points[0].len()];
        let shift = if band == f64::INFINITY { 0.0 } else { of.sign * level };
        let mut placement = *placement;
        placement.shift = -shift;
        let [x, y, z] = &points;
        E::values(&*of.field, Chunk { points: [x, y, z], placement: &placement, out: [&mut values] }, band);
        values.truncate(count);
        values.into_iter().map(|value| of.sign * (value.to_f64() + shift)).collect()
    }

    /// The points that are filled up with the last one, as many as lanes take.
    fn filled(&self) -> [Vec<E>; 3] {
        let count = self.places.len().next_multiple_of(E::widest());
        self.points.each_ref().map(|axis| {
            let last = axis.last().copied().unwrap_or_default();
            axis.iter().copied().chain(std::iter::repeat(last)).take(count).collect()
        })
    }

    /// Keeps those that are chosen by what is known of them and where they are.
    pub(super) fn retain(&mut self, known: &[f64], mut keep: impl FnMut(f64, usize) -> bool) {
        let kept: Vec<usize> = (0..known.len()).filter(|n| keep(known[*n], self.places[*n])).collect();
        self.points = self.points.each_ref().map(|axis| kept.iter().map(|n| axis[*n]).collect());
        self.known = kept.iter().map(|n| known[*n]).collect();
        self.places = kept.iter().map(|n| self.places[*n]).collect();
    }
}

impl Few<f32> {
    /// Values and gradients at the points.
    pub(super) fn slopes(&self, of: &Signed, placement: &Placement) -> Vec<(f64, DVec3)> {
        if self.places.is_empty() {
            return Vec::new();
        }
        let [x, y, z] = self.filled();
        let mut out = [(); 4].map(|()| vec![0.0f32; x.len()]);
        let [value, dx, dy, dz] = &mut out;
        of.field.gradients(Chunk { points: [&x, &y, &z], placement, out: [value, dx, dy, dz] });
        let at = |n: usize| {
            let [value, x, y, z] = [0, 1, 2, 3].map(|k| of.sign * f64::from(out[k][n]));
            (value, DVec3::new(x, y, z))
        };
        (0..self.places.len()).map(at).collect()
    }
}
