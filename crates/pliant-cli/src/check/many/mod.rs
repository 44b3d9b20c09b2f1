//! `pliant check --files-from`: one check after the other, in processes that may die.
//!
//! A thread for each job hands lines of the list to its worker and writes the rows that come back.
//! Whatever a file does, its line has one row, and the others have theirs.

mod list;
mod out;
mod row;
mod worker;

pub(crate) use out::Rows;
pub(crate) use row::Row;

use super::arguments::{Arguments, Format};
use super::list_arguments::Shard;
use crate::outcome::Outcome;
use crate::table::grouped;
use crate::terminal::{complain, progress};
use anyhow::bail;
use indicatif::ProgressStyle;
use out::{Out, Tally};
use pliant_io::shown;
use std::path::Path;
use std::sync::Mutex;
use std::thread;

/// Checks the lines of a list, if one was named.
pub(super) fn check(arguments: &Arguments) -> Option<anyhow::Result<Outcome>> {
    let many = &arguments.many;
    let list = many.files_from.as_deref()?;
    Some(match &many.out {
        _ if many.as_worker => worker::work(arguments).map(|()| Outcome::Clear),
        Some(out) => check_all(arguments, list, out),
        None => Err(anyhow::anyhow!("name where rows are written with `--out`")),
    })
}

fn check_all(arguments: &Arguments, list: &Path, path: &Path) -> anyhow::Result<Outcome> {
    let many = &arguments.many;
    if !matches!(arguments.format, Format::Table | Format::Jsonl) {
        bail!("--files-from writes rows, one JSON object a line; use `--format jsonl`");
    }
    let shard = many.shard.unwrap_or(Shard::ALL);
    let lines = Mutex::new(list::lines(list, shard)?);
    let out = Out::open(path, many.resume, arguments)?;
    let mut total = 0;
    // A list on standard input is read once, and its length is not known before.
    if list != Path::new("-") {
        for line in list::lines(list, shard)? {
            let (Ok(its) | Err((its, _))) = line?;
            out.has(&its)?;
            total += 1;
        }
    }
    let bar = progress(total, arguments.quiet).with_style(ProgressStyle::with_template(
        "{wide_bar} {pos}/{len} checks, {eta} to go",
    )?);
    let written = Mutex::new(out);
    let work = || -> anyhow::Result<()> {
        let mut place = worker::Place::default();
        loop {
            let Some(line) = lock(&lines).next().transpose()? else {
                place.end();
                return Ok(());
            };
            let (Ok(its) | Err((its, _))) = &line;
            let has_row = lock(&written).has(its)?;
            if !has_row {
                let row = match &line {
                    Ok(line) => place.check(line, many.timeout())?,
                    Err((line, error)) => Row::failed(line, error.as_str()),
                };
                lock(&written).write(&row)?;
            }
            bar.inc(1);
        }
    };
    let ended: Vec<anyhow::Result<()>> = thread::scope(|scope| {
        let jobs: Vec<_> = (0..many.jobs()).map(|_| scope.spawn(work)).collect();
        let join = |job: thread::ScopedJoinHandle<'_, _>| {
            job.join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        jobs.into_iter().map(join).collect()
    });
    bar.finish_and_clear();
    ended.into_iter().collect::<anyhow::Result<()>>()?;
    let Tally {
        clear,
        meeting,
        failed,
    } = lock(&written).tally;
    let meets = meeting > 0;
    let [clear, meeting, failures] = [clear, meeting, failed].map(grouped);
    let said = format!("{clear} lines clear, {meeting} with something, {failures} errors");
    if failed > 0 {
        bail!(
            "{said}; {} says which, and `pliant summary` how many of what",
            shown(path)
        );
    }
    if !arguments.quiet {
        complain(&format!("note: {said}; `pliant summary` has more"));
    }
    Ok(if meets {
        Outcome::Intersects
    } else {
        Outcome::Clear
    })
}

/// Locks what no thread leaves half changed, even if one panics.
fn lock<T>(shared: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    shared
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}
