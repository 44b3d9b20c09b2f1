//! Runs of the program, and their output.

#![allow(dead_code, reason = "each test uses its part")]

pub(crate) mod npz;

use serde_json::Value;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Output and exit code of a run.
pub(crate) struct Said {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Said {
    /// Standard output as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out)
            .unwrap_or_else(|error| panic!("{error}: {}{}", self.out, self.err))
    }

    /// Standard output as JSON, without places, boxes of bodies, and what lies inside, which have
    /// tests of their own.
    pub(crate) fn json_without_places(&self) -> Value {
        let mut json = self.json();
        let members = json.as_object_mut().unwrap();
        for bodies in ["bodies", "sources"] {
            let bodies = members.get_mut(bodies).and_then(Value::as_array_mut);
            for body in bodies.into_iter().flatten() {
                assert!(body.as_object_mut().unwrap().remove("box").is_some());
            }
        }
        let has_places = members.remove("places").is_some();
        for frame in members["frames"].as_array_mut().unwrap() {
            let frame = frame.as_object_mut().unwrap();
            frame.remove("inside");
            frame.remove("not_closed");
            let places = frame.remove("places");
            assert_eq!(places.is_some(), has_places, "{}", self.out);
        }
        json
    }

    /// Number of pairs in each frame.
    pub(crate) fn counts(&self) -> Vec<u64> {
        let json = self.json();
        json["frames"]
            .as_array()
            .unwrap()
            .iter()
            .map(|frame| frame["count"].as_u64().unwrap())
            .collect()
    }

    /// Fails unless the program ended with code 2 and one line, in which all of `words` occur.
    pub(crate) fn assert_refused(&self, words: &[&str]) {
        assert_eq!(self.code, 2, "{}{}", self.out, self.err);
        assert_eq!(self.err.trim_end().lines().count(), 1, "{}", self.err);
        for word in words {
            assert!(self.err.contains(word), "{word:?} is not in: {}", self.err);
        }
    }
}

/// A temporary folder of text files.
pub(crate) fn folder(files: &[(&str, String)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Runs `pliant check` in a folder.
pub(crate) fn check(folder: &Path, arguments: &[&str]) -> Said {
    pliant(folder, &[&["check"], arguments].concat())
}

/// Runs `pliant` in a folder.
pub(crate) fn pliant(folder: &Path, arguments: &[&str]) -> Said {
    let output = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    Said {
        code: output.status.code().expect("the program was not killed"),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Time after which a program must have hung, however busy the machine is.
const LIMIT: Duration = Duration::from_secs(600);

/// A run of the program, and its peak memory in bytes, where the system reports it.
pub(crate) struct Measured {
    pub(crate) said: Said,
    pub(crate) peak: Option<u64>,
}

/// Runs `pliant` in a folder and measures it. Fails if it does not end.
pub(crate) fn measured(folder: &Path, arguments: &[&str]) -> Measured {
    // Files instead of pipes: a full pipe would block the program.
    let kept = tempfile::tempdir().unwrap();
    let [out, err] = ["out", "err"].map(|name| kept.path().join(name));
    let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(File::create(&out).unwrap())
        .stderr(File::create(&err).unwrap())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let mut peak = None;
    let status = loop {
        peak = peak_so_far(child.id()).or(peak);
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begin.elapsed() > LIMIT {
            child.kill().unwrap();
            panic!("{arguments:?} did not come to an end");
        }
        std::thread::sleep(Duration::from_micros(500));
    };
    let said = Said {
        code: status.code().expect("the program was not killed"),
        out: fs::read_to_string(out).unwrap(),
        err: fs::read_to_string(err).unwrap(),
    };
    Measured { said, peak }
}

/// Peak memory of a process so far, in bytes. Linux reports it while the process lives.
fn peak_so_far(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes << 10)
}

/// Runs `pliant` with standard output, and perhaps standard error, closed or full.
///
/// Returns the exit code and the text on standard error.
#[cfg(unix)]
pub(crate) fn pliant_into(
    folder: &Path,
    arguments: &[&str],
    out: Stdio,
    err: Stdio,
) -> (i32, String) {
    let child = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .current_dir(folder)
        .args(arguments)
        .stdout(out)
        .stderr(err)
        .spawn();
    let output = child.unwrap().wait_with_output().unwrap();
    (
        output.status.code().expect("the program was not killed"),
        String::from_utf8(output.stderr).unwrap(),
    )
}

/// The `kinds` of a frame: how many pairs cross, overlap and touch.
pub(crate) fn kinds([crossing, overlapping, touching]: [usize; 3]) -> Value {
    serde_json::json!({"crossing": crossing, "overlapping": overlapping, "touching": touching})
}
