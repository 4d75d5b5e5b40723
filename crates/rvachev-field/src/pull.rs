//! Derivatives through a chain of maps, on lanes: the chain rule as two kernels.

use crate::kernel::{Formula, run};

use crate::Real;

/// `Jᵀ g` at each point, J row by row before g; slices as for [`run`].
#[inline(never)]
pub fn pull(jacobian_and_gradient: [&[f32]; 12], out: [&mut [f32]; 3]) {
    run(&Pull, jacobian_and_gradient, out);
}

/// The product of two matrices at each point, row by row; slices as for [`run`].
#[inline(never)]
pub fn product(matrices: [&[f32]; 18], out: [&mut [f32]; 9]) {
    run(&Product, matrices, out);
}

struct Pull;

impl Formula<12, 3> for Pull {
    #[inline(always)]
    fn run<R: Real>(&self, x: [R; 12]) -> [R; 3] {
        [
            x[0].mul_add(x[9], x[3].mul_add(x[10], x[6] * x[11])),
            x[1].mul_add(x[9], x[4].mul_add(x[10], x[7] * x[11])),
            x[2].mul_add(x[9], x[5].mul_add(x[10], x[8] * x[11])),
        ]
    }
}

struct Product;

impl Formula<18, 9> for Product {
    #[inline(always)]
    fn run<R: Real>(&self, x: [R; 18]) -> [R; 9] {
        let mut product = [x[0]; 9];
        let mut at = 0;
        while at < 9 {
            let (row, column) = (at / 3 * 3, at % 3);
            product[at] =
                x[row].mul_add(x[9 + column], x[row + 1].mul_add(x[12 + column], x[row + 2] * x[15 + column]));
            at += 1;
        }
        product
    }
}
