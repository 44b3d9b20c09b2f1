//! Workers: processes that check one line after the other.
//!
//! A worker reads lines of JSON from its standard input and writes a row for each. So a file that
//! kills it, or that is too slow, costs one row; another worker takes its place. Its memory is
//! limited by the system, where that has such limits. It is in a process group of its own, so that
//! Ctrl-C ends no check that would then count as failed. When its standard input ends, it ends.

use super::list::Line;
use super::row::Row;
use crate::check::arguments::Arguments;
use anyhow::{Context, anyhow};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Tells a process that it is a worker.
const IS_WORKER: &str = "PLIANT_IS_WORKER";
/// Bytes that a worker holds beside the data of a check: the library's, and its threads' stacks.
#[cfg(unix)]
const BESIDE: u64 = 64 << 20;
/// How much of what a worker says on standard error is kept.
const SAID: u64 = 2000;

/// Whether this process is a worker.
pub(super) fn is_worker() -> bool {
    std::env::var_os(IS_WORKER).is_some()
}

/// Checks the lines that another process writes to standard input.
pub(super) fn work(arguments: &Arguments) -> anyhow::Result<()> {
    limit_memory(arguments.many.per_job(arguments.max_memory));
    let (send, lines) = channel();
    thread::spawn(move || {
        for line in io::stdin().lock().lines().map_while(Result::ok) {
            if send.send(line).is_err() {
                break;
            }
        }
        // Nobody waits for a row any more, and a check may take hours.
        std::process::exit(0);
    });
    let mut out = io::stdout().lock();
    for line in lines {
        let line: Line = serde_json::from_str(&line)?;
        begin_peak();
        let mut row = Row::of(arguments, &line);
        row.peak_bytes = peak();
        serde_json::to_writer(&mut out, &row)?;
        writeln!(out)?;
        out.flush()?;
    }
    Ok(())
}

/// Has the system refuse memory beyond a limit, and some beside it.
#[cfg(unix)]
fn limit_memory(limit: u64) {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let mut of_data = getrlimit(Resource::Data);
    let limit = limit.saturating_add(BESIDE);
    of_data.current = Some(of_data.maximum.map_or(limit, |most| most.min(limit)));
    // Without it large files are still refused, as in any check.
    let _ = setrlimit(Resource::Data, of_data);
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
        // The program that runs, even if another stands in its place now.
        let running = Path::new("/proc/self/exe");
        let program = if running.exists() {
            running.to_owned()
        } else {
            std::env::current_exe().context("cannot find this program")?
        };
        let mut command = Command::new(program);
        command
            .args(std::env::args_os().skip(1))
            .env(IS_WORKER, "1")
            .env_remove("RUST_BACKTRACE")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let begun = command.spawn();
        let mut child =
            begun.map_err(|error| anyhow!("cannot begin a process for a job: {error}"))?;
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
            let _ = errors.by_ref().take(SAID).read_to_end(&mut said);
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

    /// Ends a worker, and says how it has ended: alike for every run, without numbers of processes.
    fn end(mut self) -> String {
        drop(self.lines);
        let how = self.child.wait();
        let said = self.said.join().unwrap_or_default();
        if said.contains("memory allocation of") {
            return "it needed more memory than its share of --max-memory, which all jobs have \
                    together"
                .to_owned();
        }
        if said.contains("has overflowed its stack") {
            return "it needed more stack than there is".to_owned();
        }
        how.map_or_else(|error| error.to_string(), ended)
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
