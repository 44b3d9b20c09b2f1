//! `pliant bench`: methods side by side, and what the paper claims about them.

mod report;
mod tables;

use crate::outcome::Outcome;
use crate::output::{self, MARK, Overwrite};
use crate::terminal::{print_all, progress};
use anyhow::bail;
use clap::Args;
use indicatif::ProgressStyle;
use pliant_bench::experiments::{EXPERIMENTS, Experiment, Form};
use pliant_bench::machine::this_machine;
use pliant_bench::record::Record;
use pliant_io::shown;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = experiments_help())]
pub(crate) struct Arguments {
    /// The experiment, or `all`
    name: String,
    /// How often every method plays every step; figures are medians
    #[arg(long, value_name = "R", default_value = "5", value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// A small form that takes seconds, to see what there is; its times mean nothing
    #[arg(long)]
    small: bool,
    /// Write everything that was measured to a file, as benchmarks/record.schema.json describes it
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a page about it, one file that needs no network: charts of every contest, and its bodies in motion
    #[arg(long, value_name = "FILE.html", value_parser = crate::report::page_name)]
    report: Option<PathBuf>,
    /// Write every chart as SVG into a folder
    #[arg(long, value_name = "FOLDER")]
    svg: Option<PathBuf>,
    /// Nothing on standard output, and no progress; for --json
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    over: Overwrite,
}

/// How every record begins.
const RECORD: &str = r#"{"format":1,"machine":{"processor":"#;

const EXAMPLES: &str = "\
Examples:
  pliant bench cloth --small --rounds 1        what there is to see, in seconds
  pliant bench experiment-1                    the paper's figure 3
  pliant bench peers --rounds 9                medians of more rounds
  pliant bench all --quiet --json record.json  on a quiet machine, as a record";

fn experiments_help() -> String {
    let lines = EXPERIMENTS
        .iter()
        .map(|experiment| format!("  {:<14}{}\n", experiment.name, experiment.about));
    format!(
        "Experiments:\n{}  {:<14}everything\n\n{EXAMPLES}",
        lines.collect::<String>(),
        "all"
    )
}

/// Runs experiments and prints what was found.
pub(crate) fn bench(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let chosen: Vec<&Experiment> = EXPERIMENTS
        .iter()
        .filter(|experiment| arguments.name == "all" || arguments.name == experiment.name)
        .collect();
    if chosen.is_empty() {
        let names: Vec<_> = EXPERIMENTS
            .iter()
            .map(|experiment| experiment.name)
            .collect();
        bail!(
            "there is no experiment \"{}\"; there are {} and all",
            shown(&arguments.name),
            names.join(", ")
        );
    }
    let over = arguments.over;
    if let Some(file) = &arguments.json {
        // Before hours are spent: can it be written?
        output::prepare(file, RECORD, over)?;
    }
    if let Some(page) = &arguments.report {
        output::prepare(page, MARK, over)?;
    }
    let form = if arguments.small {
        Form::Small
    } else {
        Form::Full
    };
    let rounds = usize::from(arguments.rounds);
    let machine = this_machine();
    let print = |text: &str| {
        if arguments.quiet {
            Ok(())
        } else {
            print_all(text)
        }
    };
    print(&format!("{}\n", tables::machine_line(&machine)))?;

    let length = chosen
        .iter()
        .map(|experiment| experiment.length(form, rounds))
        .sum();
    let bar = progress(length, arguments.quiet).with_style(ProgressStyle::with_template(
        "{msg} {wide_bar} {percent} %, {elapsed} gone, {eta} to go",
    )?);
    let mut record = Record {
        format: 1,
        machine,
        experiments: Vec::new(),
    };
    for experiment in &chosen {
        let done = experiment.run(form, rounds, &mut |contest, steps| {
            bar.set_message(contest.to_owned());
            bar.inc(steps);
        });
        bar.suspend(|| print(&tables::experiment(&done)))?;
        if let Some(folder) = &arguments.svg {
            report::write_charts(folder, &done, over)?;
        }
        record.experiments.push(done);
        if let Some(file) = &arguments.json {
            // After each experiment: what was measured is not lost if a later one fails.
            let text = serde_json::to_string(&record)?;
            output::write(file, RECORD, over, |out| writeln!(out, "{text}"))?;
        }
    }
    bar.finish_and_clear();
    if let Some(page) = &arguments.report {
        report::write(page, &record, &chosen, form, over)?;
    }
    Ok(Outcome::Clear)
}
