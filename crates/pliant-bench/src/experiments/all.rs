//! List of the experiments of this build: the one place to add one.

use super::{Experiment, bodies, degrees, levels, shapes, splits, table_1, when};
#[cfg(feature = "peers")]
use super::{change, close, cloth, degenerate, experiment_1, experiment_3, near, peers};

/// Experiments of this build, in the order of [`titles::TITLES`](super::titles::TITLES).
///
/// Without the feature `peers`, only experiments that need no other library.
pub const EXPERIMENTS: &[Experiment] = &[
    #[cfg(feature = "peers")]
    experiment_1::EXPERIMENT,
    table_1::EXPERIMENT,
    #[cfg(feature = "peers")]
    experiment_3::EXPERIMENT,
    degrees::EXPERIMENT,
    splits::EXPERIMENT,
    levels::EXPERIMENT,
    bodies::EXPERIMENT,
    #[cfg(feature = "peers")]
    cloth::EXPERIMENT,
    #[cfg(feature = "peers")]
    degenerate::EXPERIMENT,
    shapes::EXPERIMENT,
    #[cfg(feature = "peers")]
    peers::EXPERIMENT,
    #[cfg(feature = "peers")]
    near::EXPERIMENT,
    #[cfg(feature = "peers")]
    close::EXPERIMENT,
    when::EXPERIMENT,
    #[cfg(feature = "peers")]
    change::EXPERIMENT,
];
