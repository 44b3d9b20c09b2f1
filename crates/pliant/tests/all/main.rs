//! Tests of the library in one program, a module a file.
//!
//! Each program would be linked with the whole library, and waited for while its last test runs
//! alone. To run one file: `cargo test -p pliant --test all candidates::`.
//!
//! Tests that nothing may disturb are programs of their own. `allocation` and `memory` count what
//! is allocated; `queries` counts how often a query looks whether it is interrupted.

#[path = "../common/mod.rs"]
mod common;

mod adjacent;
mod boxes;
mod boxes_of_levels;
mod candidates;
mod changes;
mod circles;
mod clearance;
mod cloth_on_ball;
mod configurations;
mod connectivity;
mod contacts;
mod crossing_edges;
mod curves;
mod distances;
mod edits;
mod edits_refused;
mod every_kind;
mod fans;
mod feature_pairs;
mod figure_2;
mod first_impact;
mod flush_to_zero;
mod free_step;
mod hashes;
mod hit_rows;
mod impacts;
mod inside;
mod labels;
mod layers;
mod mending;
mod metamorphic;
mod motions;
mod never_stale;
mod oracle;
mod pairs;
mod pieces;
mod readme;
mod refusals;
mod second_kind;
mod site;
mod threads;
mod words;
mod work;
