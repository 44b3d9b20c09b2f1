//! Arguments of `pliant check --files-from`: the list, where rows go, jobs, shards and limits.

use clap::{Args, ValueHint};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;
use std::thread;
use std::time::Duration;

/// Arguments for many checks in one call.
#[derive(Args, Debug)]
pub(crate) struct Many {
    /// Many checks: LIST has a line for each, one BODY or several with tabs between them; - reads
    /// standard input. OUT gets a row for each as it ends, in any order. A file that is broken, too
    /// large or too slow, or that kills the process, is a row with an error
    #[arg(
        long,
        value_name = "LIST",
        value_hint = ValueHint::FilePath,
        requires = "out",
        conflicts_with_all = [
            "bodies", "swept", "hits", "report", "png", "baseline", "rest", "labels", "count",
            "threads"
        ]
    )]
    pub(super) files_from: Option<PathBuf>,
    /// With --files-from, how many checks run at a time, each in a process of its own [default: one
    /// for each core]
    #[arg(
        long,
        value_name = "N",
        requires = "files_from",
        value_parser = clap::value_parser!(u16).range(1..=1024)
    )]
    jobs: Option<u16>,
    /// With --files-from, only every N-th line: 0/4, 1/4, 2/4 and 3/4 together are all
    #[arg(long, value_name = "I/N", requires = "files_from")]
    pub(super) shard: Option<Shard>,
    /// With --files-from, the most seconds that a check may take, up to 1e9; 0 for any time
    #[arg(
        long,
        value_name = "S",
        default_value = "300",
        requires = "files_from",
        allow_negative_numbers = true,
        value_parser = seconds
    )]
    timeout: f64,
    /// With --files-from, go on with an OUT that was left early: lines with rows are not checked
    /// again
    #[arg(long, requires = "files_from")]
    pub(super) resume: bool,
    /// With --files-from, where rows are written, a JSON object a line; `pliant summary OUT` reads
    /// them
    #[arg(long, value_name = "OUT", requires = "files_from", value_hint = ValueHint::FilePath)]
    pub(super) out: Option<PathBuf>,
}

impl Many {
    pub(super) fn jobs(&self) -> usize {
        let cores = || thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.jobs.map_or_else(cores, usize::from)
    }

    /// How much of an amount of memory for all jobs each may have.
    pub(super) fn per_job(&self, memory: u64) -> u64 {
        memory / self.jobs() as u64
    }

    /// How much of an amount of memory a frame may take.
    ///
    /// A check holds two frames and some more of each beside them.
    pub(super) fn per_frame(&self, memory: u64) -> u64 {
        if self.files_from.is_some() {
            self.per_job(memory) / 4
        } else {
            memory
        }
    }

    pub(super) fn timeout(&self) -> Option<Duration> {
        (self.timeout > 0.0).then(|| Duration::from_secs_f64(self.timeout))
    }
}

/// Lines of a list that are one of `of` equal parts, from 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shard {
    number: u64,
    of: u64,
}

impl Shard {
    pub(super) const ALL: Self = Self { number: 0, of: 1 };

    pub(super) fn has(self, line: u64) -> bool {
        (line - 1) % self.of == self.number
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('/').and_then(|(number, of)| {
            let shard = Self {
                number: number.parse().ok()?,
                of: of.parse().ok()?,
            };
            (shard.number < shard.of).then_some(shard)
        });
        parsed.ok_or_else(|| "write the shard, from 0, and their number: 0/4 to 3/4".to_owned())
    }
}

/// Parses a number of seconds: at least 0 and finite.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok();
    seconds
        .filter(|&it: &f64| (0.0..=1e9).contains(&it))
        .ok_or_else(|| "write a number of seconds up to 1e9, or 0 for any time: 60".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_all_lines() {
        for of in 1..5_u64 {
            for line in 1..20 {
                let shards =
                    (0..of).filter(|it| format!("{it}/{of}").parse::<Shard>().unwrap().has(line));
                assert_eq!(shards.count(), 1);
            }
        }
        for text in ["", "1", "4/4", "0/0", "-1/2", "a/b", "1/2/3"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
