//! The edge of the program: a panic, which is a bug of ours or of a library's, ends as everything else that goes wrong does, in one line
//! and exit code 2. A signal that ends it (Ctrl-C) leaves no half of a file behind; one that says that a file is too large ends nothing, for
//! writing then fails, which is said.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// Where the last panic was, which only the hook is told.
static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// From now on a panic prints nothing by itself, on any thread.
pub(crate) fn be_silent() {
    std::panic::set_hook(Box::new(|panic| {
        if let (Some(place), Ok(mut last)) = (panic.location(), PLACE.lock()) {
            *last = Some(format!("{}:{}", place.file(), place.line()));
        }
    }));
}

/// From now on Ctrl-C, and all other signals by which a program is asked to end, take away what is not whole yet and then do what they
/// always do: whoever started the program, a loop of a shell above all, learns that a signal ended it.
#[cfg(unix)]
pub(crate) fn clean_up_after_signals() {
    use signal_hook::consts::{
        SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ,
    };
    // A handler that does nothing: then the system says of a write what it otherwise ends the program for.
    let _ = signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default());
    let unless_ignored = [SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU];
    let mut ending = vec![SIGINT, SIGTERM];
    ending.extend(unless_ignored.into_iter().filter(|&it| !is_ignored(it)));
    // Where that is refused, signals do what they always do, and nothing else.
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

/// Whether whoever started the program has it ignore a signal, as `nohup` does with the end of a terminal. Where the system does not say
/// so, that one is left alone: it would end a program that is to go on.
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

/// Elsewhere a file that is not whole stays behind.
#[cfg(not(unix))]
pub(crate) fn clean_up_after_signals() {}

/// What some work ends in; if that is a panic, an error that says so.
pub(crate) fn caught<T>(work: impl FnOnce() -> anyhow::Result<T>) -> anyhow::Result<T> {
    // Nothing that the work had in hand is used again: the program ends.
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let place = PLACE.lock().ok().and_then(|mut last| last.take());
        let place = place.map_or_else(String::new, |place| format!(" ({place})"));
        let said = said(panic.as_ref()).lines().collect::<Vec<_>>().join(" ");
        Err(anyhow::anyhow!(
            "a bug of pliant, please report it with the files: {said}{place}"
        ))
    })
}

/// What a panic said.
fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref().copied())
        .unwrap_or("no reason was given")
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
        assert!(error(|| std::panic::panic_any(7)).contains("no reason"));
        assert_eq!(caught(|| Ok(5)).unwrap(), 5);
        assert_eq!(error(|| anyhow::bail!("refused")), "refused");
    }

    /// A panic on another thread arrives here, too, if that hands it on.
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
