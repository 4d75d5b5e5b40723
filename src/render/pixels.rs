//! Sets of a tile's pixels.

/// Pixels along a tile's side: the bits of a word.
pub(super) const TILE: u32 = 64;

/// Some of the pixels of a tile, such as those whose rays are still under way: a word a row.
#[derive(Clone, Copy)]
pub(super) struct Pixels(pub(super) [u64; TILE as usize]);

/// Rows and columns of a tile, the last exclusive.
#[derive(Clone, Copy)]
pub(super) struct Rectangle {
    pub(super) top: usize,
    pub(super) bottom: usize,
    pub(super) columns: u64,
}

/// The bits from `left` up to `right`, exclusive.
pub(super) fn columns(left: u32, right: u32) -> u64 {
    let below = |end: u32| if end >= 64 { u64::MAX } else { (1 << end) - 1 };
    below(right) & !below(left)
}

impl Default for Pixels {
    fn default() -> Pixels {
        Pixels::NONE
    }
}

impl Pixels {
    pub(super) const NONE: Pixels = Pixels([0; TILE as usize]);
    pub(super) const ALL: Pixels = Pixels([u64::MAX; TILE as usize]);

    /// The numbers of those in a rectangle, in a tile that is so wide.
    pub(super) fn numbers(&self, width: u32, Rectangle { top, bottom, columns }: Rectangle) -> Vec<u32> {
        let mut all = Vec::new();
        for (row, bits) in (top as u32..).zip(&self.0[top..bottom]) {
            let mut bits = bits & columns;
            while bits != 0 {
                all.push(row * width + bits.trailing_zeros());
                bits &= bits - 1;
            }
        }
        all
    }

    pub(super) fn count(&self, rectangle: Rectangle) -> usize {
        let rows = &self.0[rectangle.top..rectangle.bottom];
        rows.iter().map(|row| (row & rectangle.columns).count_ones() as usize).sum()
    }
}
