//! Buffers of every kind of query, kept from query to query, and the hits that a world answers for: from the registry.

use crate::collide::Ask;
use crate::held::Held;
use crate::kernels::Coordinate;

/// Makes what the library has for every kind, of the lines of `every_kind`.
macro_rules! keep {
    ($($name:ident: $kept:ty => $($hit:ty: $method:ident($of:ident $(, $length:ident)?)),+;)*) => {
        /// What is kept for each kind of query.
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

        /// Answers queries of every kind.
        pub(crate) trait AskAll: $($(Ask<$hit> +)+)* Send + Sync {}

        impl<T: $($(Ask<$hit> +)+)* Send + Sync> AskAll for T {}
    };
}

every_kind! { keep }
