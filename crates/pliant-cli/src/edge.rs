//! Panics and signals, caught at the edge of the program.
//!
//! A panic, a bug here or in a library, ends like any other error: in one line and exit code 2. A
//! signal that ends the program, such as Ctrl-C, leaves no partial file behind. SIGXFSZ, sent when
//! a file exceeds a size limit, ends nothing: the write fails, and that error is reported.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// Source location of the last panic, which only the panic hook is told.
static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Silences the output of panics on all threads, and keeps their location instead.
pub(crate) fn be_silent() {
    std::panic::set_hook(Box::new(|panic| {
        if let (Some(place), Ok(mut last)) = (panic.location(), PLACE.lock()) {
            *last = Some(format!("{}:{}", place.file(), place.line()));
        }
    }));
}

/// Removes unfinished files when a signal asks the program to end.
///
/// Then the signal's default action follows. So the parent, such as a loop of a shell, learns that
/// a signal ended the program.
#[cfg(unix)]
pub(crate) fn clean_up_after_signals() {
    use signal_hook::consts::{
        SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ,
    };
    // An empty handler: the system then fails the write instead of ending the program.
    let _ = signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default());
    let unless_ignored = [SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU];
    let mut ending = vec![SIGINT, SIGTERM];
    ending.extend(unless_ignored.into_iter().filter(|&it| !is_ignored(it)));
    // If registration fails, signals keep their default action.
    let Ok(mut signals) = signal_hook::iterator::Signals::new(ending) else {
        return;
    };
    std::thread::spawn(move || {
        for signal in &mut signals {
            pliant_io::remove_staged_files();
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    });
}

/// Whether the parent has this program ignore a signal, as `nohup` does with SIGHUP.
///
/// Where the system does not say so, SIGHUP counts as ignored: a handler would end a program that
/// is meant to go on.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mut lines = status.lines();
    let ignored = lines.find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    match ignored {
        Some(bits) => bits >> (signal - 1) & 1 == 1,
        None => signal == signal_hook::consts::SIGHUP,
    }
}

/// Does nothing: on other systems an unfinished file stays behind.
#[cfg(not(unix))]
pub(crate) fn clean_up_after_signals() {}

/// Runs some work, and turns a panic into an error.
pub(crate) fn caught<T>(work: impl FnOnce() -> anyhow::Result<T>) -> anyhow::Result<T> {
    // Unwind safe: nothing that the work held is used again, since the program ends.
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let place = PLACE.lock().ok().and_then(|mut last| last.take());
        let place = place.map_or_else(String::new, |place| format!(" ({place})"));
        let said = said(panic.as_ref()).lines().collect::<Vec<_>>().join(" ");
        Err(anyhow::anyhow!(
            "a bug of pliant, please report it with the files: {said}{place}"
        ))
    })
}

/// Message of a panic.
fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref().copied())
        .unwrap_or("the panic has no message")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_one_line() {
        let error = |work: fn() -> anyhow::Result<u32>| caught(work).unwrap_err().to_string();
        let said = error(|| panic!("two\nlines of {}", "a library"));
        assert!(said.contains("a bug of pliant"), "{said}");
        assert!(said.contains("two lines of a library"), "{said}");
        assert!(!said.contains('\n'), "{said}");
        assert!(error(|| std::panic::panic_any(7)).contains("no message"));
        assert_eq!(caught(|| Ok(5)).unwrap(), 5);
        assert_eq!(error(|| anyhow::bail!("refused")), "refused");
    }

    /// A panic of another thread is caught, too, if it is resumed here.
    #[test]
    fn threads_hand_their_panics_on() {
        let said = caught(|| -> anyhow::Result<()> {
            let thread = std::thread::spawn(|| panic!("far away"));
            match thread.join() {
                Ok(()) => Ok(()),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        });
        assert!(said.unwrap_err().to_string().contains("far away"));
    }
}
