//! Instruction sets of the machine, and code compiled for each of them.
//!
//! There are two sets: the baseline of the architecture (SSE2, NEON, WebAssembly SIMD or plain
//! code), and AVX2. AVX-512 is not used where it exists: every comparison there writes a mask
//! register, mostly only to be read at once. In trials the overlap kernel took 0.77 ns a wide node
//! with AVX2 and 1.4 ns with AVX-512; whole queries took about 15 % longer. A third set between the
//! two (SSE4.2) would serve machines built before 2013, and everyone would compile it.

use fearless_simd::Level;

/// Instruction set that kernels use.
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
    /// The widest instruction set that this machine has and that pays: AVX2, else the baseline.
    pub fn widest() -> Self {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if let Some(avx2) = Level::new().as_avx2() {
            return Self(Set::Avx2(avx2));
        }
        Self::baseline()
    }

    /// The instruction set that every machine of this architecture has.
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

    /// Every instruction set that this machine has: tests check that all give the same bits.
    pub fn all() -> Vec<Self> {
        vec![Self::baseline(), Self::widest()]
    }
}

/// Evaluates an expression that is compiled for each instruction set, with the token of the chosen
/// one.
///
/// It stands round a whole batch of work, never round a node. Whatever is called inside must be
/// inlined, or it is compiled without the instructions.
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

/// Evaluates an expression for the baseline, with its token.
///
/// The baseline of x86-64 and of AArch64 is one type. On other architectures the SIMD library
/// chooses.
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
