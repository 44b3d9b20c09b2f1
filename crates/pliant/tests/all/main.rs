//! The tests of the library, one file a module, in one program: a program each is linked with the whole library each time, and is waited for
//! while its last test runs alone. One file: `cargo test -p pliant --test all candidates::`.
//!
//! Beside it stand those that nothing may disturb: `allocation` and `memory` count what is allocated, `queries` how often a query looks
//! whether it is interrupted.

#[path = "../common/mod.rs"]
mod common;

mod boxes;
mod boxes_of_levels;
mod candidates;
mod circles;
mod clearance;
mod cloth_on_ball;
mod configurations;
mod connectivity;
mod contacts;
mod distances;
mod edits;
mod edits_refused;
mod every_kind;
mod figure_2;
mod first_impact;
mod flush_to_zero;
mod free_step;
mod hashes;
mod impacts;
mod layers;
mod mending;
mod metamorphic;
mod motions;
mod never_stale;
mod oracle;
mod pieces;
mod readme;
mod refusals;
mod second_kind;
mod threads;
mod work;
