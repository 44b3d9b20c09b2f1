//! A thread whose caller has switched subnormal numbers off, as audio code and some physics engines
//! do.

/// Runs `work` with flush-to-zero and denormals-are-zero set, and restores the control word.
///
/// `None` where the processor is not x86-64: no way is known there. A panic in `work` leaves both
/// set in this thread.
pub fn subnormals_flushed<T>(work: impl FnOnce() -> T) -> Option<T> {
    #[cfg(target_arch = "x86_64")]
    let result = Some(x86_64::with_control_bits(
        x86_64::FLUSH_TO_ZERO | x86_64::DENORMALS_ARE_ZERO,
        work,
    ));
    #[cfg(not(target_arch = "x86_64"))]
    let result = {
        drop(work);
        None
    };
    result
}

#[cfg(target_arch = "x86_64")]
mod x86_64 {
    use std::arch::asm;

    /// Control bit: subnormal results become zero.
    pub(super) const FLUSH_TO_ZERO: u32 = 1 << 15;
    /// Control bit: subnormal operands count as zero.
    pub(super) const DENORMALS_ARE_ZERO: u32 = 1 << 6;

    #[expect(unsafe_code, reason = "there is no safe way to the control word")]
    pub(super) fn with_control_bits<T>(bits: u32, work: impl FnOnce() -> T) -> T {
        let mut before = 0_u32;
        // SAFETY: stmxcsr writes the four bytes of `before`, ldmxcsr reads the four of `during` and
        // `before`. The bits set are defined and raise no exception. Rust assumes that the control
        // word is as at the start of the thread. So the compiler may compute with constants as if
        // subnormals were kept, and the tests hide their constants from it. Memory safety depends
        // on no rounding. The word is restored before anything else runs.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut before, options(nostack)) };
        let during = before | bits;
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const during, options(nostack)) };
        let result = work();
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const before, options(nostack)) };
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hint::black_box;

    #[test]
    fn subnormals_are_gone_and_come_back() {
        let half_of_the_smallest = || black_box(f64::MIN_POSITIVE) * black_box(0.5);
        let twice_a_subnormal = || black_box(f64::MIN_POSITIVE / 2.0) * black_box(2.0);
        let both = || (half_of_the_smallest(), twice_a_subnormal());
        let kept = (f64::MIN_POSITIVE / 2.0, f64::MIN_POSITIVE);
        assert_eq!(both(), kept);
        // Compared out here, since inside a subnormal would equal zero.
        if let Some(flushed) = subnormals_flushed(both) {
            assert_eq!(flushed, (0.0, 0.0));
        }
        assert_eq!(both(), kept);
    }
}
