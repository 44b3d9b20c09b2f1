//! Scalars as users name them, `f32` and `f64`, and the one place where generic code is compiled
//! for each.

use super::state::State;
use super::verbs::Verbs;
use crate::kernels::Coordinate;
use crate::options::Options;
use crate::threads::Threads;

/// Coordinate type: `f32` or `f64`.
///
/// The trait is sealed, because the proofs behind the decisions are for these two.
#[expect(
    private_bounds,
    reason = "sealed; what the library needs of it is not for users"
)]
pub trait Scalar: sealed::HasVerbs + Coordinate {
    /// Converts to `f64`, exactly.
    fn to_f64(self) -> f64;

    /// Whether the value is finite and at most `f32::MAX` in magnitude.
    fn is_in_range(self) -> bool;
}

pub(super) mod sealed {
    use super::{Coordinate, Options, Threads, Verbs};

    pub(crate) trait HasVerbs: Coordinate {
        fn state(options: Options, threads: Threads) -> Box<dyn Verbs<Self>>;
    }
}

macro_rules! scalar {
    ($($type:ty),*) => {$(
        impl Scalar for $type {
            #[inline]
            fn to_f64(self) -> f64 {
                self.into()
            }

            #[inline]
            fn is_in_range(self) -> bool {
                crate::geometry::Real::is_in_range(self)
            }
        }

        impl sealed::HasVerbs for $type {
            fn state(options: Options, threads: Threads) -> Box<dyn Verbs<Self>> {
                Box::new(State::new(options, threads))
            }
        }
    )*};
}

scalar!(f32, f64);
