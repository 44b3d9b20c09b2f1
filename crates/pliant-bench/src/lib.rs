//! Benchmark of collision detection methods for deforming bodies.
//!
//! Compares ours in every configuration, the older algorithms that the paper compares with, and
//! Rust libraries of today. All do the same work in one run, with the same triangle decision and
//! equal lists of pairs.
//!
//! | module | content |
//! |---|---|
//! | [`motion`] | bodies and their shapes at some steps: the input of every method |
//! | [`method`] | the trait of a method: build, step, ask |
//! | [`methods`] | the methods, one file or folder each |
//! | [`decision`] | triangle against triangle, the same for all: a frozen yardstick |
//! | [`contest`] | methods play a motion in turns; answers are compared, then times |
//! | [`experiments`] | the paper's and ours: which motion, which methods, which claims |
//! | [`cores`] | no contest: what a step gains from more threads |
//! | [`soak`] | no contest: one long-lived world, compared with worlds built fresh |
//! | [`time`] | durations as text for people |

pub mod contest;
pub mod cores;
pub mod decision;
pub mod experiments;
pub mod machine;
pub mod method;
pub mod methods;
pub mod motion;
pub mod record;
pub mod soak;
pub mod time;
