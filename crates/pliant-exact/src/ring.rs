//! What can be added, subtracted and multiplied, so that formulas are written once for rounded numbers, integers and polynomials.

/// Numbers, or what is like them: sums, differences and products. All are exact but those of `f64`, which are rounded each time.
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
