//! The query that `pliant run` asks at each step, and how its answers are counted.

use clap::ValueEnum;

/// Selection of pairs that a run asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Query {
    All,
    First,
    #[value(name = "self")]
    Itself,
    Everything,
}
