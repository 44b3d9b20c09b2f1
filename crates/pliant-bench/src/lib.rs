//! Methods of collision detection for deforming bodies, side by side: ours in every configuration, the older algorithms that
//! the paper compares with, and what a Rust user would take today. Same work, same triangle decision, equal pair lists, one
//! run.
//!
//! ```text
//! motion       bodies and their shapes at some steps: what every method is given
//! method       the trait: build, step, ask
//! methods      one file or folder a method
//! decision     triangle against triangle, the same for all: frozen, so that later gains can be measured against it
//! contest      methods play a motion, turn by turn; answers are compared, then times
//! experiments  the paper's, and ours: which motion, which methods, what is claimed
//! soak         not a contest: a world of ours that lives long, compared with worlds built fresh
//! time         how long, as people read it
//! ```

pub mod contest;
pub mod decision;
pub mod experiments;
pub mod machine;
pub mod method;
pub mod methods;
pub mod motion;
pub mod record;
pub mod soak;
pub mod time;
