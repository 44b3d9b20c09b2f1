//! Keyword arguments of a world, with the names and values of the program's flags.

use crate::error::{Result, refused};
use pliant::{BroadPhase, Degree, Options, Partition, Update};
use pyo3::prelude::*;
use std::num::NonZeroU32;

/// Names and their values.
type Names<T> = [(&'static str, T)];

const PARTITIONS: &Names<Partition> = &[
    ("centre", Partition::Centre),
    ("mean", Partition::Mean),
    ("balanced", Partition::Balanced),
    ("connectivity", Partition::Connectivity),
];

const UPDATES: &Names<Update> = &[
    ("bottom-up", Update::BottomUp),
    ("top-down", Update::TopDown),
    ("hybrid", Update::HYBRID),
];

const BROAD_PHASES: &Names<BroadPhase> = &[
    ("brute", BroadPhase::BruteForce),
    ("sweep", BroadPhase::SweepAndPrune),
    ("tree", BroadPhase::Tree),
    ("auto", BroadPhase::Auto),
];

/// How many threads: a number, or "all" for one a core.
#[derive(Clone, Debug, FromPyObject, IntoPyObject)]
pub(crate) enum Threads {
    Count(i64),
    Named(String),
}

/// Options as they were given, the keyword arguments that make another world like it.
#[derive(Clone, Debug, IntoPyObject)]
pub(crate) struct Keywords {
    pub(crate) degree: i64,
    pub(crate) partition: String,
    pub(crate) leaf_size: i64,
    pub(crate) update: String,
    pub(crate) level: Option<i64>,
    pub(crate) broad: String,
    pub(crate) threads: Threads,
    pub(crate) mending: bool,
}

impl Keywords {
    /// Converts to options of the library; refuses other values, and lists the valid ones.
    pub(crate) fn to_options(&self) -> Result<Options> {
        let mut options = Options::default();
        options.degree = match self.degree {
            2 => Degree::Two,
            4 => Degree::Four,
            8 => Degree::Eight,
            other => return Err(refused!(BadOption: "degree is {other}; it can be 2, 4 or 8")),
        };
        options.partition = named("partition", &self.partition, PARTITIONS)?;
        options.leaf_size = at_least_one("leaf_size", self.leaf_size)?;
        options.update = named("update", &self.update, UPDATES)?;
        if let Some(given) = self.level {
            let Update::Hybrid { level, .. } = &mut options.update else {
                return Err(refused!(BadOption:
                    "level is the hybrid update's; it goes with update=\"hybrid\""));
            };
            let wanted = u32::try_from(given).ok();
            *level = Some(wanted.ok_or_else(
                || refused!(BadOption: "level is {given}; the root is 0, and below it 1"),
            )?);
        }
        options.broad_phase = named("broad", &self.broad, BROAD_PHASES)?;
        options.threads = with_threads(self.threads.clone())?.threads;
        options.mending = self.mending;
        Ok(options)
    }
}

/// The default options with the number of threads that a call was given.
pub(crate) fn with_threads(threads: Threads) -> Result<Options> {
    let mut options = Options::default();
    match threads {
        Threads::Named(name) if name == "all" => return Ok(Options::all_threads()),
        Threads::Named(name) => {
            return Err(refused!(BadOption: "threads is {name:?}; it can be a number or \"all\""));
        }
        Threads::Count(count) => {
            options.threads = at_least_one("threads", count)?.try_into().map_err(
                |_| refused!(BadOption: "threads is larger than this machine can count"),
            )?;
        }
    }
    Ok(options)
}

fn at_least_one(name: &str, given: i64) -> Result<NonZeroU32> {
    let number = u32::try_from(given).ok().and_then(NonZeroU32::new);
    number.ok_or_else(
        || refused!(BadOption: "{name} is {given}; it must be at least 1, and below 2^32"),
    )
}

/// The value of a name; refuses others, and lists the names.
pub(crate) fn named<T: Copy>(option: &str, given: &str, names: &Names<T>) -> Result<T> {
    let found = names.iter().find(|(name, _)| *name == given);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<_> = names.iter().map(|(name, _)| format!("{name:?}")).collect();
        let names = names.join(", ");
        refused!(BadOption: "{option} is {given:?}; it can be one of {names}")
    })
}
