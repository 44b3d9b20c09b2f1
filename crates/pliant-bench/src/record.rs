//! What an experiment leaves behind, as it is written to JSON. `benchmarks/record.schema.json` describes it; a test holds both
//! against each other.

use crate::method::Counters;
use serde::{Deserialize, Serialize};

/// A whole run of one or several experiments.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Of this format: 1.
    pub format: u32,
    /// Where and with what.
    pub machine: Machine,
    /// In the order in which they were run.
    pub experiments: Vec<ExperimentRecord>,
}

/// Where and with what it was measured.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// The processor, as it calls itself.
    pub processor: String,
    /// Its cores, as the system sees them.
    pub cores: usize,
    /// Operating system.
    pub system: String,
    /// The profile it was compiled with: `release` or `debug`.
    pub profile: String,
    /// Libraries and their versions, the compiler's among them.
    pub versions: std::collections::BTreeMap<String, String>,
}

/// One experiment.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentRecord {
    /// As on the command line.
    pub experiment: String,
    /// In small form: for tests, not for conclusions.
    pub small: bool,
    /// How often every method played every step, not counting the round that compares answers.
    pub rounds: usize,
    /// What was played.
    pub contests: Vec<ContestRecord>,
    /// What follows.
    pub claims: Vec<Claim>,
}

/// Methods on one motion with one query.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContestRecord {
    /// What is asked of which motion.
    pub name: String,
    /// The motion.
    pub motion: String,
    /// Bodies.
    pub bodies: usize,
    /// Triangles of a body.
    pub triangles: usize,
    /// `all`, `first`, `self`, `near`, `when` or `distance`.
    pub query: String,
    /// The numbers of the steps played.
    pub steps: Vec<u32>,
    /// Intersecting pairs at each step (of the truth, also where only the first is asked for).
    pub pairs: Vec<usize>,
    /// The method that `pairs` are from.
    pub truth: String,
    /// The method that ratios are to.
    pub reference: String,
    /// Parts of the steps for which figures are drawn together.
    pub windows: Vec<Window>,
    /// The methods.
    pub methods: Vec<MethodRecord>,
}

/// Some steps of a contest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// What they are called.
    pub name: String,
    /// The first step.
    pub first: u32,
    /// The last step.
    pub last: u32,
}

/// One method in a contest.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodRecord {
    /// A short name.
    pub name: String,
    /// The method's own name, with every parameter.
    pub parameters: String,
    /// If its pairs are not the truth's: where first, and how often. It is then not timed, and the lists below are empty.
    pub wrong: Option<Wrong>,
    /// Building, once.
    pub build_ms: f64,
    /// Taking over the shapes, at each step: the median of all rounds.
    pub update_ms: Vec<f64>,
    /// The query, at each step: the median of all rounds.
    pub query_ms: Vec<f64>,
    /// Figures for each window, in order.
    pub windows: Vec<WindowFigures>,
    /// The method's account of its work in one round, at each step.
    pub counters: Vec<Counters>,
}

/// Update and query together, over the steps of a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindowFigures {
    /// The median of the steps' medians.
    pub median_ms: f64,
    /// The mean of the steps' medians.
    pub mean_ms: f64,
    /// The slowest step's median.
    pub worst_ms: f64,
    /// The reference's time over this method's: how many times faster this one is. For each round the ratio of the sums over
    /// the window; here the median of the rounds. Missing if the reference is wrong.
    pub speedup: Option<Spread>,
}

/// A median and what it is the median of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The smallest.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

/// Where a method's answers are not the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wrong {
    /// The first such step.
    pub step: u32,
    /// Pairs that are true and missing, over all steps.
    pub missing: usize,
    /// Pairs that are not true, over all steps.
    pub extra: usize,
}

/// A statement, and what we found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// What the paper, or we, say.
    pub claim: String,
    /// How it stands.
    pub verdict: Verdict,
    /// Our figure.
    pub figure: String,
}

/// How a claim stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// As it was said.
    Holds,
    /// In the same direction, but less.
    HoldsWeaker,
    /// Not on this machine, with this code.
    DoesNotHoldToday,
    /// A figure without a claim.
    Measured,
}

impl Verdict {
    /// Of a claim that holds or does not.
    pub(crate) fn of(holds: bool) -> Self {
        if holds {
            Self::Holds
        } else {
            Self::DoesNotHoldToday
        }
    }
}

impl Spread {
    /// Of at least one value.
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

/// The median; NaN of none.
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
    /// A method's record by name.
    pub fn method(&self, name: &str) -> Option<&MethodRecord> {
        self.methods.iter().find(|method| method.name == name)
    }

    /// A figure of a method in a window, both by name.
    pub fn window(&self, method: &str, window: &str) -> Option<&WindowFigures> {
        let place = self.windows.iter().position(|known| known.name == window)?;
        self.method(method)?.windows.get(place)
    }

    /// How many times faster `fast` is than `slow` over a window, by mean times; NaN if one is missing.
    pub fn times_faster(&self, fast: &str, slow: &str, window: &str) -> f64 {
        match (self.window(fast, window), self.window(slow, window)) {
            (Some(fast), Some(slow)) => slow.mean_ms / fast.mean_ms,
            _ => f64::NAN,
        }
    }

    /// The fastest of some peers over a window, and how many times faster `ours` is; none if all
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
