//! Workers: processes that check one line after the other.
//!
//! A worker reads lines of JSON from its standard input and writes a row for each. So a file that
//! kills it, or that is too slow, costs one row; another worker takes its place. Its memory is
//! limited by the system, where that has such limits.

use super::row::{Line, Row};
use crate::check::arguments::Arguments;
use anyhow::Context;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Bytes that a worker holds beside the data of a check: its code, and its stack.
const BESIDE: u64 = 96 << 20;
/// How much of what a worker says on standard error is kept.
const SAID: usize = 2000;

/// Checks the lines that another process writes to standard input.
pub(super) fn work(arguments: &Arguments) -> anyhow::Result<()> {
    limit_memory(arguments.many.share(arguments.max_memory));
    let mut out = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let line: Line = serde_json::from_str(&line?)?;
        begin_peak();
        let mut row = Row::of(arguments, &line);
        row.peak_bytes = peak();
        serde_json::to_writer(&mut out, &row)?;
        writeln!(out)?;
        out.flush()?;
    }
    Ok(())
}

/// Has the system refuse memory beyond a limit, and what lies beside it.
#[cfg(unix)]
fn limit_memory(limit: u64) {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let mut of_space = getrlimit(Resource::As);
    let limit = limit.saturating_add(BESIDE);
    of_space.current = Some(of_space.maximum.map_or(limit, |most| most.min(limit)));
    // Without it large files are still refused, as in any check.
    let _ = setrlimit(Resource::As, of_space);
}

#[cfg(not(unix))]
fn limit_memory(_: u64) {}

/// Begins a new peak of memory, on Linux.
fn begin_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The most memory since the peak began.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|it| it.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = peak.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// A worker, as the process that has begun it sees it.
pub(super) struct Worker {
    child: Child,
    lines: ChildStdin,
    rows: Receiver<String>,
    said: JoinHandle<String>,
}

/// Why a worker gave no row.
enum Lost {
    /// Time is up.
    Slow,
    /// Its process has ended.
    Ended,
}

impl Worker {
    fn begin() -> anyhow::Result<Self> {
        let program = std::env::current_exe().context("cannot find this program")?;
        let mut child = Command::new(program)
            .args(std::env::args_os().skip(1))
            .arg("--as-worker")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .context("cannot begin a process for a job")?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(lines), Some(out), Some(mut errors)) = pipes else {
            anyhow::bail!("a process for a job has no pipes");
        };
        let (send, rows) = channel();
        thread::spawn(move || {
            for row in BufReader::new(out).lines().map_while(Result::ok) {
                if send.send(row).is_err() {
                    break;
                }
            }
        });
        let said = thread::spawn(move || {
            let mut said = Vec::new();
            let _ = errors.by_ref().take(SAID as u64).read_to_end(&mut said);
            // The rest is read and dropped, so that the worker never waits.
            let _ = io::copy(&mut errors, &mut io::sink());
            String::from_utf8_lossy(&said).into_owned()
        });
        Ok(Self {
            child,
            lines,
            rows,
            said,
        })
    }

    fn ask(&mut self, line: &Line, within: Option<Duration>) -> Result<String, Lost> {
        let mut asked = serde_json::to_vec(line).map_err(|_| Lost::Ended)?;
        asked.push(b'\n');
        let sent = self
            .lines
            .write_all(&asked)
            .and_then(|()| self.lines.flush());
        sent.map_err(|_| Lost::Ended)?;
        match within {
            Some(within) => self.rows.recv_timeout(within).map_err(|error| match error {
                RecvTimeoutError::Timeout => Lost::Slow,
                RecvTimeoutError::Disconnected => Lost::Ended,
            }),
            None => self.rows.recv().map_err(|_| Lost::Ended),
        }
    }

    /// Ends a worker, and says how it has ended.
    fn end(mut self) -> String {
        drop(self.lines);
        let how = self.child.wait();
        let said = self.said.join().unwrap_or_default();
        let said = said.lines().filter(|it| !it.trim().is_empty());
        let said: Vec<&str> = said.take(2).collect();
        let how = how.map_or_else(|error| error.to_string(), ended);
        if said.is_empty() {
            how
        } else {
            format!("{how}: {}", said.join(" "))
        }
    }
}

/// How a process has ended, in words.
fn ended(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = signal_hook::low_level::signal_name(signal).unwrap_or("unknown");
        return format!("signal {signal} ({name}) ended its process");
    }
    format!("its process ended early ({status})")
}

/// A place for workers, of which at most one lives at a time.
#[derive(Default)]
pub(super) struct Place(Option<Worker>);

impl Place {
    /// Has a worker check a line. Fails only if no worker can be begun.
    pub(super) fn check(&mut self, line: &Line, within: Option<Duration>) -> anyhow::Result<Row> {
        // One that has ended since its last row was ended by somebody else, not by this line.
        let alive = |mut worker: Worker| match worker.child.try_wait() {
            Ok(None) => Some(worker),
            _ => None,
        };
        let mut worker = match self.0.take().and_then(alive) {
            Some(worker) => worker,
            None => Worker::begin()?,
        };
        Ok(match worker.ask(line, within) {
            Ok(row) => match serde_json::from_str(&row) {
                Ok(row) => {
                    self.0 = Some(worker);
                    row
                }
                Err(_) => Row::failed(line, format!("no row came back; {}", worker.end())),
            },
            Err(Lost::Slow) => {
                let _ = worker.child.kill();
                drop(worker.end());
                let seconds = within.unwrap_or_default().as_secs_f64();
                Row::failed(line, format!("took longer than --timeout {seconds}"))
            }
            Err(Lost::Ended) => Row::failed(line, worker.end()),
        })
    }

    /// Ends the worker that lives, if any.
    pub(super) fn end(self) {
        if let Some(worker) = self.0 {
            worker.end();
        }
    }
}
