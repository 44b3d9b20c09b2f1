//! Which instructions this machine has.

use fearless_simd::Level;

/// The widest instruction set that pays: AVX2 where there is AVX-512, because every comparison of the kernels would write a
/// mask register there and most of them only to be read at once (in trials the overlap kernel took 0.77 ns a group with AVX2
/// and 1.4 with AVX-512; whole queries about 15 % longer).
pub(crate) fn widest() -> Level {
    let level = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = level.as_avx2() {
        return fearless_simd::Simd::level(avx2);
    }
    level
}

/// Every level this machine can run, for tests that all of them give the same bits.
#[cfg(test)]
pub(crate) fn all() -> Vec<Level> {
    let mut levels = vec![Level::baseline(), widest(), Level::new()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    levels.extend(Level::new().as_sse4_2().map(fearless_simd::Simd::level));
    levels
}
