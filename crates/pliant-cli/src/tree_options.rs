//! Flags for the library's options of trees, updates, the broad phase and threads.

use clap::{Args, ValueEnum};
use pliant::Options;
use std::num::{NonZeroU32, NonZeroUsize};
use std::str::FromStr;

/// Flags that set [`Options`].
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Trees and threads (no choice changes an answer)")]
pub(crate) struct TreeOptions {
    /// The most children of a node
    #[arg(long, value_name = "N", default_value = "8", value_parser = ["2", "4", "8"])]
    degree: String,
    /// How triangles are divided into a tree. centre: at the centre of a node's box. mean: at the
    /// mean of the triangles' midpoints. connectivity: along the mesh, into connected pieces.
    /// balanced: into equal parts, which is not in the paper
    #[arg(long, value_enum, default_value_t = Partition::Balanced)]
    partition: Partition,
    /// The most triangles in a leaf; 1 in the paper
    #[arg(long, value_name = "K", default_value = "8", value_parser = at_least_one::<NonZeroU32>)]
    leaf_size: NonZeroU32,
    /// Which boxes are made when. bottom-up: all before a query. top-down: each when the query
    /// reaches it. hybrid: some levels before, the rest when reached
    #[arg(long, value_enum, default_value_t = Update::Hybrid)]
    update: Update,
    /// The level down to which the hybrid makes boxes bottom-up; the root is 0 [default: n/2, where
    /// n is the level of the deepest leaf]
    #[arg(long, value_name = "L")]
    level: Option<u32>,
    /// How bodies that may meet are found. brute: every pair of boxes. sweep: sweep and prune.
    /// tree: a tree of bodies. auto: by the number of bodies
    #[arg(long, value_enum, default_value_t = Broad::Auto)]
    broad: Broad,
    /// How many threads share the work of a query, at most; all: one for each core. Work that is
    /// small takes fewer
    #[arg(long, value_name = "T", default_value = "all", value_parser = threads)]
    threads: NonZeroUsize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Partition {
    Centre,
    Mean,
    Balanced,
    Connectivity,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Update {
    BottomUp,
    TopDown,
    Hybrid,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Broad {
    Brute,
    Sweep,
    Tree,
    Auto,
}

impl TreeOptions {
    /// Converts the flags to the library's options.
    pub(crate) fn to_options(&self) -> anyhow::Result<Options> {
        if self.level.is_some() && self.update != Update::Hybrid {
            anyhow::bail!(
                "--level is for the hybrid update alone; leave it out, or choose --update hybrid"
            );
        }
        let mut options = Options::default();
        options.degree = match self.degree.as_str() {
            "2" => pliant::Degree::Two,
            "4" => pliant::Degree::Four,
            _ => pliant::Degree::Eight,
        };
        options.partition = match self.partition {
            Partition::Centre => pliant::Partition::Centre,
            Partition::Mean => pliant::Partition::Mean,
            Partition::Balanced => pliant::Partition::Balanced,
            Partition::Connectivity => pliant::Partition::Connectivity,
        };
        options.leaf_size = self.leaf_size;
        options.update = match self.update {
            Update::BottomUp => pliant::Update::BottomUp,
            Update::TopDown => pliant::Update::TopDown,
            Update::Hybrid => pliant::Update::Hybrid {
                level: self.level,
                levels_at_once: NonZeroU32::MIN,
            },
        };
        options.broad_phase = match self.broad {
            Broad::Brute => pliant::BroadPhase::BruteForce,
            Broad::Sweep => pliant::BroadPhase::SweepAndPrune,
            Broad::Tree => pliant::BroadPhase::Tree,
            Broad::Auto => pliant::BroadPhase::Auto,
        };
        options.threads = self.threads;
        Ok(options)
    }

    /// Flags and their values by name, for JSON.
    pub(crate) fn named(&self) -> serde_json::Map<String, serde_json::Value> {
        let serde_json::Value::Object(named) = serde_json::json!({
            "degree": self.degree.parse::<u32>().unwrap_or_default(),
            "partition": value_name(self.partition),
            "leaf_size": self.leaf_size,
            "update": value_name(self.update),
            "level": self.level,
            "broad": value_name(self.broad),
            "threads": self.threads,
        }) else {
            unreachable!("an object was written");
        };
        named
    }

    /// Summary of the flags in one line, for people.
    pub(crate) fn describe(&self) -> String {
        let update = match (self.update, self.level) {
            (Update::Hybrid, Some(level)) => format!("hybrid at level {level}"),
            (Update::Hybrid, None) => "hybrid".to_owned(),
            (other, _) => value_name(other),
        };
        let partition = value_name(self.partition);
        let leaf = match self.leaf_size.get() {
            1 => "1 triangle".to_owned(),
            most => format!("up to {most} triangles"),
        };
        let threads = match self.threads.get() {
            1 => String::new(),
            count => format!(", {count} threads"),
        };
        format!(
            "degree {}, partition {partition}, {leaf} a leaf, update {update}{threads}",
            self.degree
        )
    }
}

/// Parses a count of at least one.
pub(crate) fn at_least_one<N: FromStr>(text: &str) -> Result<N, String> {
    text.parse()
        .map_err(|_| "write a whole number, 1 or more".to_owned())
}

/// Parses a number of threads, which `all` is too: one for each core.
pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    match text {
        "all" => Ok(Options::all_threads().threads),
        _ => at_least_one(text).map_err(|cure| format!("{cure}, or all")),
    }
}

/// Name of a value, as it is written on the command line.
pub(crate) fn value_name(value: impl ValueEnum + Copy) -> String {
    value
        .to_possible_value()
        .map_or_else(String::new, |value| value.get_name().to_owned())
}
