//! The extension module of the Python package `pliant`: the Rust library under the same names, numpy in and out.
//!
//! Files use only those above them in this list:
//!
//! | file | idea |
//! |---|---|
//! | `error.rs` | every refusal as a `pliant.Error` |
//! | `signals.rs` | Ctrl-C while a query computes |
//! | `answers.rs` | what calls answer with: arrays made of vectors, named tuples |
//! | `options.rs` | the keyword arguments of a world |
//! | `copies.rs` | copies of arrays, to which nobody else can write: what is checked is what is kept |
//! | `arrays.rs` | numpy arrays of callers |
//! | `selection.rs` | `Selection`, and the numbers of bodies |
//! | `state.rs` | a world whose precision the first body fixes, for one call at a time |
//! | `edit.rs` | `Edit`: changes of a mesh, made all at once |
//! | `pickled.rs` | a world as pickle writes it down |
//! | `queries/mod.rs` | what is the same for every kind of query |
//! | `queries/pairs.rs` | `Query`: intersections, and candidates |
//! | `queries/close.rs` | `CloseQuery`: close pairs, with distance, direction and closest points |
//! | `queries/contacts.rs` | `ContactQuery`: which triangles intersect, and how |
//! | `queries/impacts.rs` | `ImpactQuery`: which elements meet on their way, and when |
//! | `world.rs` | `World`, method by method |
//! | `pair_impacts.rs` | when single pairs of elements meet |
//! | `one_liners.rs` | questions that need no world to be made, and `pliant.reference` |
//! | `usd.rs` | USD files, which Python evaluates |
//! | `check.rs` | files, frame by frame |
//! | `../python/pliant/` | the package: what is easier said in Python (named tuples, the exception), and the types |
//!
//! What always holds: the interpreter lock is released while anything is computed; only the calls
//! of a visitor, and looks for signals, take it back. A world or a check is in use by one call at a
//! time, and another is refused, not left waiting, so that nothing here can wait for ever.

mod answers;
mod arrays;
mod check;
mod copies;
mod edit;
mod error;
mod one_liners;
mod options;
mod pair_impacts;
mod pickled;
mod queries;
mod selection;
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
    use crate::{
        check::{Check, check},
        edit::Edit,
        one_liners::{
            intersection_pairs, reference_intersection_pairs, reference_self_intersection_pairs,
            self_intersection_pairs,
        },
        pair_impacts::{edge_edge_impacts, vertex_triangle_impacts},
        queries::close::CloseQuery,
        queries::contacts::ContactQuery,
        queries::impacts::ImpactQuery,
        queries::pairs::Query,
        selection::Selection,
        world::World,
    };
}
