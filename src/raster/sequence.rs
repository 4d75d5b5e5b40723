//! Unions of products of convex operands, by sequenced subtraction.
//!
//! ```text
//! product P1 ∩ P2 ∩ … − N1 − N2 − …        zf, zb: depth of front and back of an operand
//!     z := the farthest zf of the P
//!     for every N: if zf ≤ z < zb then z := zb;   again, until none moves z
//!     keep z if it is nearer than every zb of the P
//! union: the nearest z of all products
//! ```
//!
//! z only grows and an N moves it once at most, so that #N + 1 sweeps suffice.
//!
//! Exact for convex operands, with the eye outside. Of a non-convex operand the nearest front and
//! the nearest back are taken for all there is.
//!
//! Sources: N. Stewart, G. Leach and S. John, *An improved z-buffer CSG rendering algorithm*
//! (1998) for the sequences; J. Goldfeather et al. (1989) for unions of products.

use super::error::RasterError;
use super::expression::{Csg, Product, products};
use super::layers::{Facing, LayerSource, Tile};
use super::target::Target;

/// A union of products, each split into what it intersects and what it subtracts.
pub(super) struct Sequences {
    products: Vec<(Vec<u32>, Vec<u32>)>,
    /// For each operand whether a product names it.
    is_used: Vec<bool>,
}

impl Sequences {
    /// The products of a tree.
    ///
    /// # Errors
    ///
    /// [`RasterError::Products`] if there are too many.
    pub(super) fn new(tree: &Csg, operands: usize) -> Result<Sequences, RasterError> {
        let products = products(tree)?;
        let mut is_used = vec![false; operands];
        for literal in products.iter().flatten() {
            is_used[literal.operand as usize] = true;
        }
        let split = |product: Product| {
            let (n, p): (Product, Product) = product.into_iter().partition(|literal| literal.complement);
            let numbers = |side: Product| side.into_iter().map(|literal| literal.operand).collect();
            (numbers(p), numbers(n))
        };
        Ok(Sequences { products: products.into_iter().map(split).collect(), is_used })
    }

    pub(super) fn tile(&self, operands: &[&dyn LayerSource], tile: &Tile) -> Target {
        let sides: Vec<Option<[Target; 2]>> = operands
            .iter()
            .enumerate()
            .map(|(number, layers)| {
                (self.is_used[number] && layers.touches(tile)).then(|| {
                    [Facing::Front, Facing::Back].map(|facing| {
                        let mut side = Target::new();
                        side.draw(*layers, number as u32, Some(facing), tile);
                        side
                    })
                })
            })
            .collect();
        let side = |operand: &u32| sides[*operand as usize].as_ref();
        let mut target = Target::new();
        let mut product = Sides { intersected: Vec::new(), subtracted: Vec::new() };
        for (intersected, subtracted) in &self.products {
            product.intersected.clear();
            product.intersected.extend(intersected.iter().filter_map(side));
            if product.intersected.len() < intersected.len() {
                continue;
            }
            product.subtracted.clear();
            product.subtracted.extend(subtracted.iter().filter_map(side));
            for pixel in 0..Tile::PIXELS {
                product.pixel(pixel, &mut target);
            }
        }
        target
    }
}

/// Front and back of the operands of one product in a tile.
struct Sides<'a> {
    intersected: Vec<&'a [Target; 2]>,
    subtracted: Vec<&'a [Target; 2]>,
}

impl Sides<'_> {
    /// Draws the product at one pixel; the stencil holds the most sweeps that a product took.
    fn pixel(&self, i: usize, target: &mut Target) {
        let mut z = f64::NEG_INFINITY;
        let mut seen = None;
        let mut end = f64::INFINITY;
        for [front, back] in &self.intersected {
            if front.depth[i] > z {
                (z, seen) = (front.depth[i], Some(front));
            }
            end = end.min(back.depth[i]);
        }
        // Behind what is drawn already, also if nothing is here: z is infinite then.
        if z >= end || z >= target.depth[i] {
            return;
        }
        let mut sweeps = 0;
        let mut moves = true;
        while moves {
            moves = false;
            sweeps += 1;
            for [front, back] in &self.subtracted {
                if front.depth[i] <= z && z < back.depth[i] {
                    (z, seen) = (back.depth[i], Some(back));
                    moves = true;
                }
            }
        }
        target.stencil[i] = target.stencil[i].max(sweeps);
        if let Some(seen) = seen
            && z < end
            && z < target.depth[i]
        {
            target.depth[i] = z;
            target.operand[i] = seen.operand[i];
            target.face[i] = seen.face[i];
        }
    }
}
