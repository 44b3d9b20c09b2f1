//! The extension module of the Python package `pliant`: the Rust library under the same names, numpy in and out.
//!
//! | file | idea |
//! |---|---|
//! | `arrays.rs` | numpy arrays of callers, and arrays made for them |
//! | `copies.rs` | copies of them, to which nobody else can write: what is checked is what is kept |
//! | `state.rs` | a world whose precision the first body fixes |
//! | `world.rs`, `query.rs` | `World`, `Selection` and `Query` (intersections, candidates), as Python sees them |
//! | `close.rs` | `CloseQuery`: close pairs, with distance, direction and closest points |
//! | `contacts.rs` | `ContactQuery`: which triangles intersect, and how |
//! | `edit.rs` | `Edit`: changes of a mesh, made all at once |
//! | `impacts.rs` | `ImpactQuery`: which elements meet on their way, and when; and of single pairs |
//! | `pickled.rs` | a world as pickle writes it down |
//! | `signals.rs` | Ctrl-C while a query computes |
//! | `options.rs` | its keyword arguments |
//! | `one_liners.rs` | questions that need no world to be made, and `pliant.reference` |
//! | `check.rs` | files, frame by frame |
//! | `usd.rs` | USD files, which Python evaluates |
//! | `error.rs` | every refusal as a `pliant.Error` |
//! | `../python/pliant/` | the package: what is easier said in Python (named tuples, the exception), and the types |
//!
//! What always holds: the interpreter lock is released while anything is computed; only the calls of a visitor,
//! and looks for signals, take it back. A
//! world or a check is in use by one call at a time, and another is refused, not left waiting, so that nothing here can wait
//! for ever.

mod arrays;
mod check;
mod close;
mod contacts;
mod copies;
mod edit;
mod error;
mod impacts;
mod one_liners;
mod options;
mod pickled;
mod query;
mod signals;
mod state;
mod usd;
mod world;

#[pyo3::pymodule]
mod _pliant {
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "as Python names it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use crate::check::{Check, check};
    #[pymodule_export]
    use crate::close::CloseQuery;
    #[pymodule_export]
    use crate::contacts::ContactQuery;
    #[pymodule_export]
    use crate::edit::Edit;
    #[pymodule_export]
    use crate::impacts::{ImpactQuery, edge_edge_impacts, vertex_triangle_impacts};
    #[pymodule_export]
    use crate::one_liners::{
        intersection_pairs, reference_intersection_pairs, reference_self_intersection_pairs,
        self_intersection_pairs,
    };
    #[pymodule_export]
    use crate::query::{Query, Selection};
    #[pymodule_export]
    use crate::world::World;
}
