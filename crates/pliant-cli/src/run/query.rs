//! Queries of `pliant run`.

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
