//! `pliant summary`: how many of what the rows of `pliant check --files-from` say.

use crate::check::many::{Row, files};
use crate::outcome::Outcome;
use crate::table::grouped;
use crate::terminal::{complain, print_all};
use clap::{Args, ValueHint};
use pliant_io::shown;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Rows that `pliant check --files-from` wrote; of several shards all
    #[arg(value_name = "OUT", required = true, value_hint = ValueHint::FilePath)]
    outputs: Vec<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  pliant summary rows.jsonl
  pliant summary 0.jsonl 1.jsonl 2.jsonl

Exit code 0: the rows were read. 2: they could not be.";

/// How many different errors are listed.
const ERRORS: usize = 10;

/// Names of the counts of a row.
const COUNTED: [&str; 6] = [
    "pairs",
    "crossing edges",
    "pairs that share a vertex",
    "pairs that touch",
    "pairs without area",
    "components inside bodies",
];

/// Sum of a count, and how many rows have it above 0.
#[derive(Default)]
struct Sum {
    rows: u64,
    all: u64,
}

/// Prints how many rows have what.
pub(crate) fn print(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let (mut rows, mut clear, mut bytes, mut triangles) = (0, 0, 0, 0);
    let mut sums: [Sum; COUNTED.len()] = Default::default();
    let mut errors: BTreeMap<String, (u64, u64)> = BTreeMap::new();
    let mut times: Vec<(f64, u64)> = Vec::new();
    for path in &arguments.outputs {
        for row in files::open(path)? {
            let row = row?;
            rows += 1;
            triangles += row.triangles.unwrap_or(0);
            bytes += row.bytes.unwrap_or(0);
            times.extend(row.ms.map(|ms| (ms, row.line)));
            if let Some(error) = &row.error {
                let (count, _) = errors.entry(kind_of(&row, error)).or_insert((0, row.line));
                *count += 1;
                continue;
            }
            clear += u64::from(!row.meets(true));
            for (count, sum) in counts(&row).into_iter().zip(&mut sums) {
                let count = count.unwrap_or(0);
                sum.rows += u64::from(count > 0);
                sum.all += count;
            }
        }
        if files::is_cut(path) {
            complain(&format!(
                "note: {} ends in the middle of a row",
                shown(path)
            ));
        }
    }
    let line = |count: u64, what: &str| format!("{:>12}  {what}", grouped(count));
    let mut lines = vec![format!(
        "{} checks, {} bytes, {} triangles",
        grouped(rows),
        grouped(bytes),
        grouped(triangles)
    )];
    lines.push(line(clear, "have no pairs, and nothing inside anything"));
    for (name, Sum { rows, all }) in COUNTED.iter().zip(&sums).filter(|(_, it)| it.rows > 0) {
        lines.push(line(
            *rows,
            &format!("have {name}, {} in all", grouped(*all)),
        ));
    }
    let failed = errors.values().map(|(count, _)| count).sum();
    lines.push(line(failed, "have an error, and no answer"));
    let mut errors: Vec<(String, (u64, u64))> = errors.into_iter().collect();
    errors.sort_by_key(|(_, (count, _))| Reverse(*count));
    for (error, (count, first)) in errors.iter().take(ERRORS) {
        lines.push(line(*count, &format!("  {error} (as line {first})")));
    }
    if let Some(others) = errors.get(ERRORS..).filter(|others| !others.is_empty()) {
        let count = others.iter().map(|(_, (count, _))| count).sum();
        lines.push(line(count, &format!("  {} other errors", others.len())));
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    if let (Some((median, _)), Some((most, line))) = (times.get(times.len() / 2), times.last()) {
        lines.push(format!(
            "A check takes {median:.1} ms in the median, and at most {most:.1} ms: line {line}"
        ));
    }
    lines.push(String::new());
    let text = lines.join("\n");
    print_all(&text)?;
    Ok(Outcome::Clear)
}

/// Counts of a row, in the order of [`COUNTED`].
fn counts(row: &Row) -> [Option<u64>; COUNTED.len()] {
    [
        row.pairs,
        row.crossing_edges,
        row.adjacent,
        row.touching,
        row.degenerate,
        row.inside,
    ]
}

/// An error without the names that it begins with, and without advice.
fn kind_of(row: &Row, error: &str) -> String {
    let mut kind = error;
    for body in &row.bodies {
        for part in body.split(['#', '+']) {
            if let Some((_, behind)) = kind.split_once(&format!("{part}: ")) {
                kind = behind;
            }
        }
    }
    kind.split("; ").next().unwrap_or(kind).to_owned()
}
