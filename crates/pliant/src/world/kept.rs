//! Buffers of every kind of query, kept from query to query, as the registry of kinds lists them.

use crate::collide::Ask;
use crate::held::Held;
use crate::kernels::Coordinate;

/// Makes, from the lines of `every_kind`, all that the library has for every kind.
macro_rules! keep {
    ($($name:ident: $kept:ty => $($hit:ty: $method:ident($of:ident $(, $length:ident)?)),+;)*) => {
        /// Buffers that are kept for each kind of query.
        pub(crate) struct Kinds<S: Coordinate> {
            $(pub(super) $name: $kept,)*
        }

        impl<S: Coordinate> Default for Kinds<S> {
            fn default() -> Self {
                Self {
                    $($name: Default::default(),)*
                }
            }
        }

        impl<S: Coordinate> Held for Kinds<S> {
            fn held(&self) -> usize {
                0 $(+ self.$name.held())*
            }
        }

        /// A state that answers queries of every kind.
        pub(crate) trait AskAll: $($(Ask<$hit> +)+)* Send + Sync {}

        impl<T: $($(Ask<$hit> +)+)* Send + Sync> AskAll for T {}
    };
}

every_kind! { keep }
