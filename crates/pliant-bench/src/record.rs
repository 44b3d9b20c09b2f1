//! Records of experiments, as they are written to JSON.
//!
//! `benchmarks/record.schema.json` describes the format; a test compares the two.

use crate::method::Counters;
use serde::{Deserialize, Serialize};

/// A run of one or several experiments.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Version of the format: 1.
    pub format: u32,
    /// Machine and build of the run.
    pub machine: Machine,
    /// Experiments in the order in which they were run.
    pub experiments: Vec<ExperimentRecord>,
}

/// Machine and build of measurements.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Name of the processor, as it reports it.
    pub processor: String,
    /// Number of cores, as the system counts them.
    pub cores: usize,
    /// Name and version of the operating system.
    pub system: String,
    /// Build profile: `release` or `debug`.
    pub profile: String,
    /// Versions of libraries and of the compiler, by name.
    pub versions: std::collections::BTreeMap<String, String>,
}

/// One experiment.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentRecord {
    /// Name on the command line.
    pub experiment: String,
    /// Whether it has the small form, which is for tests, not for conclusions.
    pub small: bool,
    /// Number of timed plays of every step by every method. The round that compares answers is not
    /// counted.
    pub rounds: usize,
    /// Contests of the experiment.
    pub contests: Vec<ContestRecord>,
    /// Claims, tested on the contests.
    pub claims: Vec<Claim>,
}

/// Methods on one motion with one query.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContestRecord {
    /// Name of the contest: query and motion.
    pub name: String,
    /// Name of the motion.
    pub motion: String,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of triangles of a body.
    pub triangles: usize,
    /// Query: `all`, `first`, `self`, `near`, `when` or `distance`.
    pub query: String,
    /// Numbers of the steps played.
    pub steps: Vec<u32>,
    /// Intersecting pairs at each step, as the truth has them, also for a query for the first pair.
    pub pairs: Vec<usize>,
    /// Method that `pairs` are from.
    pub truth: String,
    /// Method that ratios refer to.
    pub reference: String,
    /// Ranges of steps over which figures are combined.
    pub windows: Vec<Window>,
    /// Records of the methods.
    pub methods: Vec<MethodRecord>,
}

/// A range of steps of a contest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Name of the range.
    pub name: String,
    /// First step.
    pub first: u32,
    /// Last step, inclusive.
    pub last: u32,
}

/// One method in a contest.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodRecord {
    /// Short name, as in tables.
    pub name: String,
    /// Own name of the method, with every parameter.
    pub parameters: String,
    /// Errors, if its pairs are not the truth's. The method is then not timed, and the lists below
    /// are empty.
    pub wrong: Option<Wrong>,
    /// Time to build, once, in milliseconds.
    pub build_ms: f64,
    /// Time to take the shapes at each step, in milliseconds: the median of all rounds.
    pub update_ms: Vec<f64>,
    /// Time of the query at each step, in milliseconds: the median of all rounds.
    pub query_ms: Vec<f64>,
    /// Figures for each window, in order.
    pub windows: Vec<WindowFigures>,
    /// Counters at each step, from one round.
    pub counters: Vec<Counters>,
}

/// Times of update and query together, over the steps of a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindowFigures {
    /// Median of the steps' medians, in milliseconds.
    pub median_ms: f64,
    /// Mean of the steps' medians, in milliseconds.
    pub mean_ms: f64,
    /// Largest of the steps' medians, in milliseconds.
    pub worst_ms: f64,
    /// Time of the reference over the time of this method: how many times faster this one is.
    ///
    /// Each round has the ratio of the sums over the window; this is the median of the rounds.
    /// `None` if the reference is wrong.
    pub speedup: Option<Spread>,
}

/// Median, minimum and maximum of some values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// Minimum.
    pub least: f64,
    /// Maximum.
    pub most: f64,
}

/// Difference of a method's answers from the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wrong {
    /// First step with a difference.
    pub step: u32,
    /// True pairs that are missing, over all steps.
    pub missing: usize,
    /// Untrue pairs, over all steps.
    pub extra: usize,
}

/// A claim, and our finding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Statement of the paper, or of ours.
    pub claim: String,
    /// Finding.
    pub verdict: Verdict,
    /// Our figure, in words.
    pub figure: String,
}

/// Finding about a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// True as stated.
    Holds,
    /// True in direction, but by less.
    HoldsWeaker,
    /// False on this machine, with this code.
    DoesNotHoldToday,
    /// A figure without a claim.
    Measured,
}

impl Verdict {
    /// Verdict on a claim that either holds or does not.
    pub(crate) fn of(holds: bool) -> Self {
        if holds {
            Self::Holds
        } else {
            Self::DoesNotHoldToday
        }
    }
}

impl Spread {
    /// Median, minimum and maximum of values; NaN without values.
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let (least, most) = (
            values.first().copied().unwrap_or(f64::NAN),
            values.last().copied().unwrap_or(f64::NAN),
        );
        Self {
            median: median_of_sorted(&values),
            least,
            most,
        }
    }
}

/// Median of values; NaN without values.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    median_of_sorted(&sorted)
}

fn median_of_sorted(sorted: &[f64]) -> f64 {
    match sorted.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => sorted[odd / 2],
        even => f64::midpoint(sorted[even / 2 - 1], sorted[even / 2]),
    }
}

impl ContestRecord {
    /// Record of a method, by its short name.
    pub fn method(&self, name: &str) -> Option<&MethodRecord> {
        self.methods.iter().find(|method| method.name == name)
    }

    /// Figures of a method in a window, both by name.
    pub fn window(&self, method: &str, window: &str) -> Option<&WindowFigures> {
        let place = self.windows.iter().position(|known| known.name == window)?;
        self.method(method)?.windows.get(place)
    }

    /// Factor by which `fast` is faster than `slow` over a window, by mean times; NaN if one is
    /// missing.
    pub fn times_faster(&self, fast: &str, slow: &str, window: &str) -> f64 {
        match (self.window(fast, window), self.window(slow, window)) {
            (Some(fast), Some(slow)) => slow.mean_ms / fast.mean_ms,
            _ => f64::NAN,
        }
    }

    /// Fastest of some peers over a window, and the factor by which `ours` is faster. `None` if all
    /// are missing.
    #[cfg(feature = "peers")]
    pub(crate) fn fastest<'a>(
        &self,
        ours: &str,
        peers: &[&'a str],
        window: &str,
    ) -> Option<(f64, &'a str)> {
        let factors = peers
            .iter()
            .map(|&peer| (self.times_faster(ours, peer, window), peer));
        let known = factors.filter(|(factor, _)| factor.is_finite());
        known.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
