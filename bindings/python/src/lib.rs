//! Extension module of the Python package `pliant`: the Rust library under the same names.
//!
//! Files use only those above them in this list:
//!
//! | file | idea |
//! |---|---|
//! | `error.rs` | refusals as `pliant.Error`, and what to do about them in words of Python |
//! | `signals.rs` | Ctrl-C while a query computes |
//! | `answers.rs` | answers: arrays made of vectors, named tuples |
//! | `columns.rs` | columns of hits, which several threads fill |
//! | `options.rs` | the keyword arguments of a world |
//! | `copies.rs` | private copies of arrays, so that what is checked is what is kept |
//! | `arrays.rs` | numpy arrays of callers |
//! | `selection.rs` | `Selection`, and the numbers of bodies |
//! | `state.rs` | a world whose precision the first body fixes, for one call at a time |
//! | `edit.rs` | `Edit`: changes of a mesh, made all at once |
//! | `changes.rs` | `Changes`: hits that began, persist, ended |
//! | `pickled.rs` | the state that pickle writes |
//! | `inside.rs` | points of callers and closed bodies: rules, and answers |
//! | `queries/mod.rs` | the part that all kinds of queries share |
//! | `queries/frames.rs` | one question about many shapes, on several threads |
//! | `queries/pairs.rs` | `Query`: intersections, crossing edges, and candidates |
//! | `queries/close.rs` | `CloseQuery`: close pairs, with distance, direction and closest points |
//! | `queries/contacts.rs` | `ContactQuery`: which triangles intersect, and how |
//! | `queries/impacts.rs` | `ImpactQuery`: which elements meet during a motion, and when |
//! | `world.rs` | `World`, method by method |
//! | `curves.rs` | segments and curves in which listed pairs meet |
//! | `feature_pairs.rs` | each contact of close elements once |
//! | `pairs.rs` | single pairs: impacts, distances, contacts |
//! | `one_liners.rs` | intersections of meshes in one call, and `pliant.reference` |
//! | `usd.rs` | USD files, which Python evaluates |
//! | `check.rs` | files, frame by frame |
//! | `../python/pliant/` | the package: the exception, named tuples, stubs of types |
//!
//! The interpreter lock is released while anything is computed. Only calls of a visitor, and looks
//! for signals, take it back. A world or a check is in use by one call at a time. Another call is
//! refused, not left waiting, so nothing here can deadlock.

mod answers;
mod arrays;
mod changes;
mod check;
mod columns;
mod copies;
mod curves;
mod edit;
mod error;
mod feature_pairs;
mod inside;
mod one_liners;
mod options;
mod pairs;
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
        arrays::of_caller,
        changes::Changes,
        check::{Check, check},
        curves::{curves, segments},
        edit::Edit,
        feature_pairs::feature_pairs,
        one_liners::{
            intersection_pairs, reference_intersection_pairs, reference_self_intersection_pairs,
            self_intersection_pairs,
        },
        pairs::{
            edge_edge_distances, edge_edge_impacts, triangle_contacts, vertex_triangle_distances,
            vertex_triangle_impacts,
        },
        queries::close::CloseQuery,
        queries::contacts::ContactQuery,
        queries::impacts::ImpactQuery,
        queries::pairs::Query,
        selection::Selection,
        world::World,
    };
}
