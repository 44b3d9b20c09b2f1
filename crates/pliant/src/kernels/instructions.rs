//! Which instructions this machine has, and code compiled for them.
//!
//! Two sets are enough: those that every machine of an architecture has (SSE2, NEON, WebAssembly SIMD, or plain code), and AVX2. AVX-512
//! is not used where there is some, because every comparison of the kernels would write a mask register there, and most of them
//! only to be read at once (in trials the overlap kernel took 0.77 ns a wide node with AVX2 and 1.4 with AVX-512, and whole queries
//! about 15 % longer). A third set between them (SSE4.2) would be compiled by everyone for machines built before 2013.

use fearless_simd::Level;

/// The instructions that kernels use.
#[derive(Clone, Copy, Debug)]
pub struct Instructions(pub(crate) Set);

#[derive(Clone, Copy, Debug)]
pub(crate) enum Set {
    Baseline(Baseline),
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    Avx2(fearless_simd::x86::Avx2),
}

#[cfg(target_arch = "x86_64")]
pub(crate) type Baseline = fearless_simd::x86::Sse2;
#[cfg(target_arch = "aarch64")]
pub(crate) type Baseline = fearless_simd::aarch64::Neon;
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
pub(crate) type Baseline = Level;

impl Instructions {
    /// The widest that pay.
    pub fn widest() -> Self {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if let Some(avx2) = Level::new().as_avx2() {
            return Self(Set::Avx2(avx2));
        }
        Self::baseline()
    }

    /// Those that every machine of this architecture has.
    #[expect(
        clippy::missing_panics_doc,
        reason = "no machine of these architectures is without"
    )]
    pub fn baseline() -> Self {
        let level = Level::baseline();
        #[cfg(target_arch = "x86_64")]
        let level = level.as_sse2().expect("every x86-64 has SSE2");
        #[cfg(target_arch = "aarch64")]
        let level = level
            .as_neon()
            .expect("every AArch64 that Rust supports has NEON");
        Self(Set::Baseline(level))
    }

    /// All that this machine has, for tests that they give the same bits.
    pub fn all() -> Vec<Self> {
        vec![Self::baseline(), Self::widest()]
    }
}

/// Evaluates an expression, compiled for each set of instructions, with a token of those that are chosen. It stands round a whole
/// batch of work, never round a node: what is called inside is inlined, or it is compiled without the instructions.
macro_rules! dispatch {
    ($instructions:expr, $token:ident => $work:expr) => {
        match $instructions.0 {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            $crate::kernels::Set::Avx2(token) => {
                let $token = token;
                $crate::kernels::Simd::vectorize(
                    token,
                    #[inline(always)]
                    || $work,
                )
            }
            $crate::kernels::Set::Baseline(token) => {
                $crate::kernels::with_baseline!(token, $token => $work)
            }
        }
    };
}
pub(crate) use dispatch;

/// The baseline of the common architectures is one type; of the others, the SIMD library chooses.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
macro_rules! with_baseline {
    ($baseline:expr, $token:ident => $work:expr) => {{
        let $token = $baseline;
        $crate::kernels::Simd::vectorize(
            $token,
            #[inline(always)]
            || $work,
        )
    }};
}
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
macro_rules! with_baseline {
    ($baseline:expr, $token:ident => $work:expr) => {
        fearless_simd::dispatch!($baseline, $token => $work)
    };
}
pub(crate) use with_baseline;
