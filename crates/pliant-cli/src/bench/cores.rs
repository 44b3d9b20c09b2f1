//! `pliant bench cores`: what more threads give, as a table and as JSON.

use super::tables;
use crate::outcome::Outcome;
use crate::output::{self, Overwrite};
use crate::table::table;
use crate::terminal::{print_all, progress};
use pliant_bench::cores::{
    COUNT, HeldBack, MANY, Measured, Record, WORKERS, measure, wait_ms, wake_cores,
};
use pliant_bench::machine::this_machine;
use std::path::Path;

/// Name and description, as of an experiment.
pub(super) const NAME: &str = "cores";
pub(super) const ABOUT: &str = "more threads: measured, and predicted by a replay of jobs";

/// Beginning of every record, by which the program recognises its own files.
const RECORD: &str = r#"{"format":1,"cores_of":{"processor":"#;

/// Options of the command that concern it.
pub(super) struct Asked<'a> {
    pub(super) file: Option<&'a Path>,
    pub(super) rounds: usize,
    pub(super) is_small: bool,
    pub(super) is_quiet: bool,
    pub(super) over: Overwrite,
}

/// Measures all scenes and questions, and prints their table.
pub(super) fn cores(asked: &Asked) -> anyhow::Result<Outcome> {
    if let Some(file) = asked.file {
        output::prepare(file, RECORD, asked.over)?;
    }
    let machine = this_machine();
    let mut header = vec!["scene", "question", "ms on 1", "serial", "parts", "span ms"];
    let predicted = WORKERS.map(|workers| format!("x{workers} by replay"));
    header.extend(predicted.iter().map(String::as_str));
    let held_back = format!("x{MANY}: serial, uneven, waits");
    header.extend([&held_back, "measured"]);
    let mut rows = table(&header);
    let bar = progress(COUNT as u64, asked.is_quiet);
    if !asked.is_small {
        wake_cores();
    }
    let wait_ms = wait_ms();
    let all = measure(wait_ms, asked.is_small, asked.rounds, &mut |one| {
        rows.add_row(row(one));
        bar.inc(1);
    });
    bar.finish_and_clear();
    if !asked.is_quiet {
        let wait = format!(
            "A part without work costs two threads {:.1} us.",
            1e3 * wait_ms
        );
        print_all(&format!(
            "{}\n{wait}\n{rows}\n",
            tables::machine_line(&machine)
        ))?;
    }
    if let Some(file) = asked.file {
        let record = Record::of(&machine, wait_ms, &all);
        let text = serde_json::to_string(&record)?;
        output::write(file, RECORD, asked.over, |out| writeln!(out, "{text}"))?;
    }
    Ok(Outcome::Clear)
}

/// A question as the JSON names it.
fn name_of(one: &Measured) -> String {
    format!("{}", serde_json::json!(one.question)).replace('"', "")
}

fn row(one: &Measured) -> Vec<String> {
    let times = |times: f64| format!("{times:.2}");
    let mut row = vec![
        one.scene.clone(),
        name_of(one),
        format!("{:.3}", one.one_thread_ms),
        format!("{:.0} %", 100.0 * one.serial_share),
        one.parts.to_string(),
        format!("{:.3}", one.span_ms),
    ];
    row.extend(one.predicted.iter().copied().map(times));
    let HeldBack {
        serial,
        uneven,
        waits,
    } = one.held_back;
    let shares = [serial, uneven, waits].map(|share| format!("{:.0}", 100.0 * share));
    row.push(format!("{} %", shares.join(", ")));
    let measured = one.measured.iter();
    let measured = measured.map(|&(threads, faster)| format!("x{threads} {faster:.2}"));
    row.push(measured.collect::<Vec<_>>().join(", "));
    row
}
