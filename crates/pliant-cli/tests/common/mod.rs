//! Runs the program and reads what it said.

#![allow(dead_code, reason = "each test uses its part")]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};

/// What a run of the program left behind.
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

    /// The number of pairs in each frame.
    pub(crate) fn counts(&self) -> Vec<u64> {
        let json = self.json();
        json["frames"]
            .as_array()
            .unwrap()
            .iter()
            .map(|frame| frame["count"].as_u64().unwrap())
            .collect()
    }

    /// Fails unless the program ended with code 2 and exactly one line, in which all of `words` occur.
    pub(crate) fn assert_refused(&self, words: &[&str]) {
        assert_eq!(self.code, 2, "{}{}", self.out, self.err);
        assert_eq!(self.err.trim_end().lines().count(), 1, "{}", self.err);
        for word in words {
            assert!(self.err.contains(word), "{word:?} is not in: {}", self.err);
        }
    }
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

/// Runs `pliant` with standard output, and perhaps standard error, closed or full; returns the exit code and what it said on
/// standard error.
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
