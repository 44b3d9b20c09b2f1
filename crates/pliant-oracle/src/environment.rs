//! A thread whose caller has switched subnormal numbers off, as audio code and some physics engines do.

/// Runs `work` with flush-to-zero and denormals-are-zero set, and sets them back as they were; `None` where there is no way to do
/// it (only x86-64 is known). A panic in `work` leaves them set, in this thread.
pub fn subnormals_flushed<T>(work: impl FnOnce() -> T) -> Option<T> {
    with_control_bits(FLUSH_TO_ZERO | DENORMALS_ARE_ZERO, work)
}

/// Results that are subnormal become zero.
const FLUSH_TO_ZERO: u32 = 1 << 15;
/// Operands that are subnormal are taken for zero.
const DENORMALS_ARE_ZERO: u32 = 1 << 6;

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
fn with_control_bits<T>(bits: u32, work: impl FnOnce() -> T) -> Option<T> {
    use std::arch::asm;
    let mut before = 0_u32;
    // SAFETY: stmxcsr writes the four bytes of `before`, ldmxcsr reads the four bytes of `during` and of `before`; the bits set are
    // defined ones and raise no exception. Rust supposes the control word to be what it is at the start of a thread. What that allows
    // the compiler is to compute with constants as if subnormals were kept, so the tests hide theirs from it; memory safety
    // depends on no rounding. The word is put back before anything else runs.
    unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut before, options(nostack)) };
    let during = before | bits;
    unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const during, options(nostack)) };
    let result = work();
    unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const before, options(nostack)) };
    Some(result)
}

#[cfg(not(target_arch = "x86_64"))]
fn with_control_bits<T>(_bits: u32, _work: impl FnOnce() -> T) -> Option<T> {
    None
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
        // Compared outside, where a subnormal is not taken for the zero it should be.
        if let Some(flushed) = subnormals_flushed(both) {
            assert_eq!(flushed, (0.0, 0.0));
        }
        assert_eq!(both(), kept);
    }
}
