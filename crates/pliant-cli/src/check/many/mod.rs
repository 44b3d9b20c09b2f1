//! `pliant check --files-from`: one check after the other, in processes that may die.
//!
//! A thread for each job hands lines of the list to its worker and writes the rows that come back.
//! Whatever a file does, its line has one row, and the others have theirs.

pub(crate) mod files;
mod list;
mod out;
#[cfg_attr(not(feature = "parquet"), path = "without_parquet.rs")]
mod parquet;
mod row;
mod worker;

pub(crate) use row::Row;

use super::arguments::{Arguments, Format};
use super::list_arguments::Shard;
use crate::outcome::Outcome;
use crate::table::grouped;
use crate::terminal::{complain, progress};
use anyhow::{anyhow, bail};
use indicatif::{ProgressBar, ProgressStyle};
use list::{Line, Lines};
use out::{Done, Out, Tally};
use pliant_io::shown;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, ScopedJoinHandle};

/// Checks the lines of a list, if one was named.
pub(super) fn check(arguments: &Arguments) -> Option<anyhow::Result<Outcome>> {
    let list = arguments.many.files_from.as_deref()?;
    if worker::is_worker() {
        return Some(worker::work(arguments).map(|()| Outcome::Clear));
    }
    let path = arguments.many.out.as_deref();
    let path = path.ok_or_else(|| anyhow!("name where rows are written with `--out`"));
    Some(path.and_then(|path| {
        let tally = match arguments.format {
            Format::Table | Format::Jsonl => check_all(arguments, list, path)?,
            Format::Parquet => {
                files::begin(path, arguments.many.resume, arguments.pictures.over)?;
                let tally = check_all(arguments, list, &files::beside(path))?;
                files::end(path)?;
                tally
            }
            _ => bail!(
                "--files-from writes rows, one JSON object a line; use `--format jsonl`, or \
                 parquet"
            ),
        };
        said(arguments, path, tally)
    }))
}

/// The work that jobs share.
struct Shared<'a> {
    arguments: &'a Arguments,
    lines: Mutex<Lines>,
    /// Lines that had rows before.
    done: Done,
    out: Mutex<Out>,
    bar: ProgressBar,
    /// Whether a job has failed, so that the others end, too.
    has_failed: AtomicBool,
}

fn check_all(arguments: &Arguments, list: &Path, path: &Path) -> anyhow::Result<Tally> {
    let many = &arguments.many;
    let shard = many.shard.unwrap_or(Shard::ALL);
    let lines = Mutex::new(Lines::of(list, shard)?);
    let (out, done) = Out::open(path, list, many.resume, arguments)?;
    let mut total = None;
    if list::is_file(list) {
        let mut rest = 0;
        for line in Lines::of(list, shard)? {
            rest += u64::from(!done.has(&line?)?);
        }
        total = Some(rest);
    }
    let style = match total {
        Some(_) => "{wide_bar} {pos}/{len} checks, {eta} to go",
        None => "{spinner} {pos} checks",
    };
    let bar = progress(total.unwrap_or(0), arguments.quiet);
    let shared = Shared {
        arguments,
        lines,
        done,
        out: Mutex::new(out),
        bar: bar.with_style(ProgressStyle::with_template(style)?),
        has_failed: AtomicBool::new(false),
    };
    let ended: Vec<anyhow::Result<()>> = thread::scope(|scope| {
        let job = |_| scope.spawn(|| shared.job());
        let jobs: Vec<_> = (0..many.jobs()).map(job).collect();
        let join = |job: ScopedJoinHandle<'_, _>| {
            job.join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        jobs.into_iter().map(join).collect()
    });
    shared.bar.finish_and_clear();
    ended.into_iter().collect::<anyhow::Result<()>>()?;
    Ok(lock(&shared.out).tally)
}

impl Shared<'_> {
    /// Checks one line after the other, until there are none, or a job fails.
    fn job(&self) -> anyhow::Result<()> {
        let mut place = worker::Place::default();
        let ended = self.all_lines(&mut place);
        if ended.is_err() {
            self.has_failed.store(true, Ordering::Relaxed);
        }
        place.end();
        ended
    }

    fn all_lines(&self, place: &mut worker::Place) -> anyhow::Result<()> {
        while let Some(line) = self.next_line()? {
            let row = match line.error {
                None => place.check(&line, self.arguments.many.timeout())?,
                Some(error) => Row::failed(&line, error),
            };
            lock(&self.out).write(&row)?;
            self.bar.inc(1);
        }
        Ok(())
    }

    /// The next line without a row.
    ///
    /// The list is compared with the output in order, so that of another list no line is checked
    /// behind the first that differs.
    fn next_line(&self) -> anyhow::Result<Option<Line>> {
        let mut lines = lock(&self.lines);
        while !self.has_failed.load(Ordering::Relaxed) {
            let Some(line) = lines.next().transpose()? else {
                break;
            };
            let has_row = self.done.has(&line);
            if has_row.is_err() {
                self.has_failed.store(true, Ordering::Relaxed);
            }
            if !has_row? {
                return Ok(Some(line));
            }
        }
        Ok(None)
    }
}

/// Says how many rows are of which kind.
fn said(arguments: &Arguments, path: &Path, tally: Tally) -> anyhow::Result<Outcome> {
    let [clear, meeting, failed] = [tally.clear, tally.meeting, tally.failed].map(grouped);
    let said = format!("{clear} lines clear, {meeting} with something, {failed} errors");
    if tally.failed > 0 {
        bail!(
            "{said}; {} says which, and `pliant summary` how many of what",
            shown(path)
        );
    }
    if !arguments.quiet {
        complain(&format!("note: {said}; `pliant summary` has more"));
    }
    Ok(if tally.meeting > 0 {
        Outcome::Intersects
    } else {
        Outcome::Clear
    })
}

/// Locks what no thread leaves half changed, even if one panics.
fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
