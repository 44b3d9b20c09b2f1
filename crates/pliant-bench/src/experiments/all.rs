//! All experiments: the one place to add one.

use super::{
    Experiment, bodies, change, close, cloth, degenerate, degrees, experiment_1, experiment_3,
    levels, near, peers, splits, table_1, when,
};

/// All experiments, in the order in which `all` runs them.
pub const EXPERIMENTS: [Experiment; 14] = [
    experiment_1::EXPERIMENT,
    table_1::EXPERIMENT,
    experiment_3::EXPERIMENT,
    degrees::EXPERIMENT,
    splits::EXPERIMENT,
    levels::EXPERIMENT,
    bodies::EXPERIMENT,
    cloth::EXPERIMENT,
    degenerate::EXPERIMENT,
    peers::EXPERIMENT,
    near::EXPERIMENT,
    close::EXPERIMENT,
    when::EXPERIMENT,
    change::EXPERIMENT,
];
