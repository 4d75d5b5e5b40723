//! The SIMD level that a kernel runs at.

/// Calls a function with the token of the machine's SIMD level; without `else`, with that of the
/// least that the target has where the machine has no more.
///
/// On x86-64 the levels are AVX2 and AVX-512, and what machines without either (from before 2013)
/// have: every further one costs a compilation of every kernel. The switches of `fearless_simd`
/// that leave levels out of a build are honoured.
#[doc(hidden)]
#[macro_export]
macro_rules! on_level {
    ($simd:ident => $call:expr, else $other:expr) => {
        'level: {
            #[cfg(not(target_arch = "x86_64"))]
            break 'level ::fearless_simd::dispatch!(::fearless_simd::Level::new(), $simd => $call);
            #[cfg(all(target_arch = "x86_64", not(disable_dispatch_avx512)))]
            if let Some($simd) = ::fearless_simd::Level::new().as_avx512() {
                break 'level ::fearless_simd::Simd::vectorize($simd, #[inline(always)] || $call);
            }
            #[cfg(all(target_arch = "x86_64", not(disable_dispatch_avx2)))]
            if let Some($simd) = ::fearless_simd::Level::new().as_avx2() {
                break 'level ::fearless_simd::Simd::vectorize($simd, #[inline(always)] || $call);
            }
            #[cfg(target_arch = "x86_64")]
            $other
        }
    };
    ($simd:ident => $call:expr) => {
        $crate::on_level!($simd => $call, else match ::fearless_simd::Level::new().as_sse2() {
            Some($simd) => ::fearless_simd::Simd::vectorize($simd, #[inline(always)] || $call),
            None => unreachable!("the target has SSE2"),
        })
    };
}
