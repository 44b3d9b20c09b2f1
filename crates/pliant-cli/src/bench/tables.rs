//! Tables of measurements, for a terminal.

use crate::report::counted;
use crate::table::{grouped, table};
use pliant_bench::record::{
    Claim, ContestRecord, ExperimentRecord, Machine, MethodRecord, Verdict,
};
use pliant_bench::time::duration;
use std::fmt::Write;

/// Processor, system and versions in one line.
pub(super) fn machine_line(machine: &Machine) -> String {
    let versions: Vec<String> = machine
        .versions
        .iter()
        .map(|(name, version)| format!("{name} {version}"))
        .collect();
    let Machine {
        processor,
        cores,
        system,
        profile,
        ..
    } = machine;
    format!(
        "{processor}, {cores} cores, {system}, {profile} build, {}\n",
        versions.join(", ")
    )
}

/// Tables of all contests of an experiment, and its claims.
pub(super) fn experiment(record: &ExperimentRecord) -> String {
    let mut text = String::new();
    let small = if record.small {
        " (small form: times mean nothing)"
    } else {
        ""
    };
    let _ = writeln!(
        text,
        "== {}{small}, medians of {}\n",
        record.experiment,
        counted(record.rounds as u64, "round", "rounds")
    );
    for record in &record.contests {
        contest(&mut text, record);
    }
    for Claim {
        claim,
        verdict,
        figure,
    } in &record.claims
    {
        let _ = writeln!(text, "{}{claim}: {figure}", mark(*verdict));
    }
    let _ = writeln!(text);
    text
}

fn mark(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds               ",
        Verdict::HoldsWeaker => "holds weaker        ",
        Verdict::DoesNotHoldToday => "does not hold today ",
        Verdict::Measured => "measured            ",
    }
}

fn contest(text: &mut String, record: &ContestRecord) {
    let most = record.pairs.iter().max().copied().unwrap_or(0);
    let _ = writeln!(
        text,
        "{}: {} of {} triangles, {}, query {}, at most {} pairs; ratios to {}",
        record.name,
        counted(record.bodies as u64, "body", "bodies"),
        grouped(record.triangles as u64),
        counted(record.steps.len() as u64, "step", "steps"),
        record.query,
        grouped(most as u64),
        record.reference,
    );
    let mut header = vec!["mean time a step".to_owned()];
    for window in &record.windows {
        header.extend([window.name.clone(), "times faster".to_owned()]);
    }
    header.push("boxes".to_owned());
    header.push("box tests".to_owned());
    header.push("decisions".to_owned());
    let mut rows = table(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for method in &record.methods {
        rows.add_row(row(method, record));
    }
    let _ = writeln!(text, "{}\n", rows.trim_fmt());
}

fn row(method: &MethodRecord, record: &ContestRecord) -> Vec<String> {
    let mut row = vec![method.name.clone()];
    match &method.wrong {
        Some(wrong) => {
            row.push(format!(
                "wrong from step {} on: {} missing, {} too many",
                wrong.step, wrong.missing, wrong.extra
            ));
            row.resize(1 + 2 * record.windows.len(), String::new());
        }
        None => {
            for window in &method.windows {
                row.push(duration(window.mean_ms));
                row.push(window.speedup.map_or_else(String::new, |spread| {
                    format!(
                        "{:.2} ({:.2} to {:.2})",
                        spread.median, spread.least, spread.most
                    )
                }));
            }
        }
    }
    let mean = |figure: fn(&pliant_bench::method::Counters) -> u64| {
        grouped(
            method.counters.iter().map(figure).sum::<u64>() / method.counters.len().max(1) as u64,
        )
    };
    row.extend([
        mean(|counters| counters.boxes),
        mean(|counters| counters.box_tests),
        mean(|counters| counters.decisions),
    ]);
    row
}
