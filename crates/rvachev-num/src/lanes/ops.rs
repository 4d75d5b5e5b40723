//! The operators of a vector type, the same for both element types.

/// Implements negation, the four operations and the operations with a parameter.
macro_rules! operators {
    ($name:ident, $element:ty) => {
        impl<S: Simd> Neg for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                $name(-self.0)
            }
        }
        operators!(@pair $name, Add, add);
        operators!(@pair $name, Sub, sub);
        operators!(@pair $name, Mul, mul);
        operators!(@pair $name, Div, div);
        operators!(@parameter $name, $element, Add, add);
        operators!(@parameter $name, $element, Sub, sub);
        operators!(@parameter $name, $element, Mul, mul);
    };
    (@pair $name:ident, $operator:ident, $method:ident) => {
        impl<S: Simd> $operator for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $name($operator::$method(self.0, other.0))
            }
        }
    };
    (@parameter $name:ident, $element:ty, $operator:ident, $method:ident) => {
        impl<S: Simd> $operator<f64> for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, k: f64) -> Self {
                $name($operator::$method(self.0, k as $element))
            }
        }
    };
}

/// A polynomial in `x`, the constant coefficient first, by Horner's rule in `x²` on pairs of
/// coefficients: one multiplication more than Horner's rule in `x` and half the latency.
macro_rules! polynomial {
    ($x:expr, $($coefficient:expr),+) => {{
        let x = $x;
        let square = x * x;
        polynomial!(@pairs x, square, $($coefficient),+)
    }};
    (@pairs $x:ident, $square:ident, $a:expr, $b:expr) => {
        $x.mul_add($b, $a)
    };
    (@pairs $x:ident, $square:ident, $a:expr, $b:expr, $c:expr) => {
        $square.mul_add($c, $x.mul_add($b, $a))
    };
    (@pairs $x:ident, $square:ident, $a:expr, $b:expr, $($rest:expr),+) => {
        $square.mul_add(
            polynomial!(@pairs $x, $square, $($rest),+),
            $x.mul_add($b, $a),
        )
    };
}

/// [`polynomial!`] on a number that takes no bare coefficients.
macro_rules! polynomial_of {
    ($x:ident, $($coefficient:expr),+) => {
        polynomial!($x, $($x.lift($coefficient)),+)
    };
}

/// The methods of [`Real`](crate::Real) that are the same text for both element types.
macro_rules! native_methods {
    ($name:ident, $element:ty) => {
        #[inline(always)]
        fn lift(self, c: f64) -> Self {
            $name(SimdBase::splat(self.0.token(), c as $element))
        }

        #[inline(always)]
        fn mul_add(self, a: Self, b: Self) -> Self {
            $name(self.0.mul_add(a.0, b.0))
        }

        #[inline(always)]
        fn scale_add(self, k: f64, b: Self) -> Self {
            $name(self.0.mul_add(k as $element, b.0))
        }

        #[inline(always)]
        fn abs(self) -> Self {
            $name(self.0.abs())
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            $name(self.0.min(other.0))
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            $name(self.0.max(other.0))
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            $name(self.0.max(0.0).sqrt())
        }

        #[inline(always)]
        fn floor(self) -> Self {
            $name(self.0.floor())
        }

        #[inline(always)]
        fn select(self, nonneg: Self, neg: Self) -> Self {
            $name(self.0.simd_ge(0.0).select(nonneg.0, neg.0))
        }

        #[inline(always)]
        fn pow(self, p: f64) -> Self {
            let size = self.abs();
            (size.log2() * p).exp2().vanish_with(size)
        }
    };
}

/// The methods of [`Real`](crate::Real) that the logarithms serve.
macro_rules! norm_methods {
    () => {
        #[inline(always)]
        fn log2_sum_exp2(self, other: Self) -> Self {
            Self::join(self, other, 1.0, 1.0)
        }

        #[inline(always)]
        fn norm(self, other: Self, norm: Norm) -> Self {
            norms::norm(self, other, norm)
        }

        #[inline(always)]
        fn norm_parts(self, other: Self, norm: Norm) -> (Self, Self, Self) {
            norms::norm_parts(self, other, norm)
        }

        #[inline(always)]
        fn nested(self, y: Self, z: Self, inner: Norm, outer: Norm) -> Self {
            norms::nested(self, y, z, inner, outer)
        }

        #[inline(always)]
        fn nested_parts(self, y: Self, z: Self, inner: Norm, outer: Norm) -> (Self, [Self; 3]) {
            norms::nested_parts(self, y, z, inner, outer)
        }

        #[inline(always)]
        fn norm_as<N: NormKind>(self, other: Self, norm: N) -> Self {
            norm.of_pair(self, other)
        }

        #[inline(always)]
        fn norm_parts_as<N: NormKind>(self, other: Self, norm: N) -> (Self, Self, Self) {
            norm.parts_of_pair(self, other)
        }

        #[inline(always)]
        fn nested_as<N: NormKind>(self, y: Self, z: Self, inner: N, outer: N) -> Self {
            inner.of_triple(outer, [self, y, z])
        }

        #[inline(always)]
        fn nested_parts_as<N: NormKind>(self, y: Self, z: Self, inner: N, outer: N) -> (Self, [Self; 3]) {
            inner.parts_of_triple(outer, [self, y, z])
        }
    };
}

pub(super) use {native_methods, norm_methods, operators, polynomial, polynomial_of};
