//! `pliant bench`: compares methods side by side, and tests the paper's claims.

mod cores;
mod report;
mod tables;

use crate::outcome::Outcome;
use crate::output::{self, MARK, Overwrite};
use crate::terminal::{print_all, progress};
use anyhow::bail;
use clap::Args;
use indicatif::ProgressStyle;
use pliant_bench::experiments::titles::{TITLES, Title};
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
    #[arg(
        long,
        value_name = "R",
        default_value = "5",
        value_parser = clap::value_parser!(u16).range(1..)
    )]
    rounds: u16,
    /// A small form that takes seconds, to see what there is; its times mean nothing
    #[arg(long)]
    small: bool,
    /// Write everything that was measured to a file, as benchmarks/record.schema.json describes it;
    /// of cores, cores.schema.json
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a page about it: one file that needs no network, with charts of every contest, and its
    /// bodies in motion
    #[arg(long, value_name = "FILE.html", value_parser = crate::report::page_name)]
    report: Option<PathBuf>,
    /// Write every chart as SVG into a folder
    #[arg(long, value_name = "FOLDER")]
    svg: Option<PathBuf>,
    /// Print nothing on standard output, and show no progress; for --json
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    over: Overwrite,
}

/// Beginning of every record, by which the program recognises its own files.
const RECORD: &str = r#"{"format":1,"machine":{"processor":"#;

const EXAMPLES: &str = "\
Examples:
  pliant bench splits --small --rounds 1           a glimpse, in seconds
  pliant bench table-1                             the paper's table 1
  pliant bench degrees --rounds 9                  medians of more rounds
  pliant bench levels --quiet --json record.json   where it is quiet: a record";

/// Whether an experiment needs other libraries that this program was built without.
fn is_missing(title: &Title) -> bool {
    EXPERIMENTS
        .iter()
        .all(|experiment| experiment.name != title.name)
}

fn experiments_help() -> String {
    let line = |mark, name, about| format!("{mark} {name:<14}{about}\n");
    let mut lines = String::new();
    for title in &TITLES {
        let mark = if is_missing(title) { '*' } else { ' ' };
        lines += &line(mark, title.name, title.about);
    }
    let any_missing = TITLES.iter().any(is_missing);
    let mark = if any_missing { '*' } else { ' ' };
    lines += &line(mark, "all", "everything");
    lines += &line(' ', cores::NAME, cores::ABOUT);
    if any_missing {
        lines += "\n* with other libraries, which this program was built without; with them:\n";
        lines += "  cargo run --release --features peers -- bench peers\n";
    }
    format!("Experiments:\n{lines}\n{EXAMPLES}")
}

/// Runs the chosen experiments and prints their results.
pub(crate) fn bench(arguments: &Arguments) -> anyhow::Result<Outcome> {
    if arguments.name == cores::NAME {
        return cores::cores(&cores::Asked {
            file: arguments.json.as_deref(),
            rounds: usize::from(arguments.rounds),
            is_small: arguments.small,
            is_quiet: arguments.quiet,
            over: arguments.over,
        });
    }
    let asked: Vec<&Title> = TITLES
        .iter()
        .filter(|title| arguments.name == "all" || arguments.name == title.name)
        .collect();
    if asked.is_empty() {
        let names: Vec<_> = TITLES.iter().map(|title| title.name).collect();
        bail!(
            "there is no experiment \"{}\"; there are {}, all and cores; choose one of these",
            shown(&arguments.name),
            names.join(", ")
        );
    }
    if asked.iter().any(|title| is_missing(title)) {
        bail!(
            "other libraries take part in {0}, which this program was built without; build it with \
             them: `cargo run --release --features peers -- bench {0}`",
            arguments.name
        );
    }
    let chosen: Vec<&Experiment> = EXPERIMENTS
        .iter()
        .filter(|experiment| asked.iter().any(|title| title.name == experiment.name))
        .collect();
    let over = arguments.over;
    if let Some(file) = &arguments.json {
        // Checked before hours are spent.
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
            // After each experiment, so that nothing is lost if a later one fails.
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
