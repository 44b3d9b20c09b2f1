//! Addition, subtraction and multiplication, so that a formula is written once for whatever has
//! them.
//!
//! Integers and polynomials are exact; `f64` is rounded each time, in the order in which the
//! formula is written.

/// Numbers, or what is like them: sums, differences and products.
pub(super) trait Ring: Sized {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

impl Ring for f64 {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}
