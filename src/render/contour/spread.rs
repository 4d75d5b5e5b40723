//! Whole numbers as keys of tables: nobody chooses planes, or corners of squares, so that they
//! collide.

use std::hash::{BuildHasherDefault, Hasher};

pub(super) type Spread = BuildHasherDefault<Product>;

/// 2⁶⁴ by the golden ratio: products with it differ in all bits where factors differ in few.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// What has been met, multiplied up.
#[derive(Default)]
pub(super) struct Product(u64);

impl Hasher for Product {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64(u64::from(*byte));
        }
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn write_u64(&mut self, number: u64) {
        let product = u128::from(self.0 ^ number) * u128::from(GOLDEN);
        self.0 = product as u64 ^ (product >> 64) as u64;
    }
}
