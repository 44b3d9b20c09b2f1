//! Soak test: a long-lived world in memory that stays flat. See `pliant_bench::soak`.
//!
//! ```sh
//! cargo run --release -p pliant-bench --example soak -- --steps 10000 --seconds 2400
//! ```
//!
//! It runs twice, with 32-bit and with 64-bit coordinates, each for half of the time at most. After
//! every tenth of the steps there is a parade, where the world always holds the same bodies, and
//! memory is counted. The exit code is 1 if an answer was wrong, or if memory grew too much, as
//! said below. The heap is compared from the second parade to the last, the resident set with its
//! maximum in the first half.

use clap::Parser;
use pliant::{Options, Scalar};
use pliant_bench::soak::{Soak, Tally, Wrong};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Plays a long-lived world, compared with fresh worlds at random steps; counts memory.
#[derive(Parser)]
struct Arguments {
    /// Steps for each type of coordinates.
    #[arg(long, default_value_t = 10_000)]
    steps: u64,
    /// Time after which to stop, whatever has been done by then.
    #[arg(long, default_value_t = 600)]
    seconds: u64,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Number of parades, at which memory is looked at.
const PARADES: u64 = 10;
/// Allowed growth of the live heap, relative.
///
/// Nodes of the maps fall differently, and no list is longer than at a parade.
const HEAP_SLACK: f64 = 0.01;
/// Allowed growth of the resident set in the second half, relative.
///
/// Until then the allocator keeps more and more of its memory, as long as longer passing lists
/// still come.
const RESIDENT_SLACK: f64 = 0.1;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let Arguments {
        steps,
        seconds,
        seed,
    } = arguments;
    println!("seed {seed}, {steps} steps each, at most {seconds} seconds\n");
    let begin = Instant::now();
    let end = begin + Duration::from_secs(seconds);
    let middle = begin + Duration::from_secs(seconds) / 2;
    let played = play("f32", Soak::single(Options::default(), seed), steps, middle)
        .and_then(|()| play("f64", Soak::double(Options::default(), seed), steps, end));
    match played {
        Ok(()) => {
            println!(
                "\nevery answer as of a fresh world, memory flat; {} seconds",
                begin.elapsed().as_secs()
            );
            ExitCode::SUCCESS
        }
        Err(what) => {
            eprintln!("seed {seed}, {what}");
            ExitCode::FAILURE
        }
    }
}

/// Memory after a parade.
struct Memory {
    heap: i64,
    blocks: i64,
    /// Bytes of the resident set, where the system reports it.
    resident: Option<u64>,
}

fn play<S: Scalar>(name: &str, mut soak: Soak<S>, steps: u64, until: Instant) -> Result<(), Wrong> {
    println!(
        "{name:<4} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8} {:>9} \
         {:>12} {:>12} {:>12} {:>11} {:>9}   {:>11} {:>7} {:>9}",
        "steps",
        "added",
        "removed",
        "moved",
        "edited",
        "refused",
        "compared",
        "equal pairs",
        "equal near",
        "equal close",
        "equal met",
        "distances",
        "heap, bytes",
        "blocks",
        "resident"
    );
    let (mut heap, mut blocks) = (0, 0);
    let mut seen = Vec::new();
    for parade in 0..=PARADES {
        let mut played = Ok(());
        let goal = steps * parade / PARADES;
        let counted = allocation_counter::measure(|| {
            while played.is_ok() && soak.tally().steps < goal && Instant::now() < until {
                played = soak.step();
            }
            played = std::mem::replace(&mut played, Ok(())).and_then(|()| soak.parade());
        });
        played?;
        heap += counted.bytes_current;
        blocks += counted.count_current;
        let memory = Memory {
            heap,
            blocks,
            resident: resident(),
        };
        line(&soak.tally(), &memory);
        seen.push(memory);
        if Instant::now() >= until {
            println!("     stopped by the clock");
            break;
        }
    }
    let [bodies, triangles] = soak.size();
    println!("     at a parade: {bodies} bodies, {triangles} triangles");
    // The first parade comes before the first step, when lists are not yet as long as in a heap
    // that moves.
    if let [_, early, .., late] = &seen[..] {
        let first_half = seen[..=seen.len() / 2].iter();
        let most = first_half.filter_map(|memory| memory.resident).max();
        grown(
            "the live heap",
            early.heap as f64,
            late.heap as f64,
            HEAP_SLACK,
        )?;
        grown(
            "the number of blocks",
            early.blocks as f64,
            late.blocks as f64,
            HEAP_SLACK,
        )?;
        if let (Some(most), Some(late)) = (most, late.resident) {
            grown("the resident set", most as f64, late as f64, RESIDENT_SLACK)?;
        }
    }
    Ok(())
}

fn line(tally: &Tally, memory: &Memory) {
    let resident = memory.resident.map_or_else(
        || "unknown".to_owned(),
        |bytes| format!("{:.1} MB", bytes as f64 / 1e6),
    );
    println!(
        "{:>13} {:>8} {:>8} {:>9} {:>8} {:>8} {:>9} \
         {:>12} {:>12} {:>12} {:>11} {:>9}   {:>11} {:>7} {:>9}",
        tally.steps,
        tally.added,
        tally.removed,
        tally.moved,
        tally.edited,
        tally.refused,
        tally.compared,
        tally.pairs,
        tally.near,
        tally.close,
        tally.met,
        tally.distances,
        memory.heap,
        memory.blocks,
        resident
    );
}

fn grown(what: &str, early: f64, late: f64, slack: f64) -> Result<(), Wrong> {
    if late > early * (1.0 + slack) {
        return Err(Wrong(format!("{what} grew from {early} to {late}")));
    }
    Ok(())
}

/// Resident set of this process, where there is a /proc.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
