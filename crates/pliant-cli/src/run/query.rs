//! What is asked of a scene.

use clap::ValueEnum;

/// Which pairs are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Query {
    All,
    First,
    #[value(name = "self")]
    Itself,
    Everything,
}
