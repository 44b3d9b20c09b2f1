//! Many checks in one call: a row for each line, whatever its files do, and going on.

use crate::common::{Said, check, folder, pliant};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Two triangles that cross: two edges of one go through the other.
const CROSSING: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n";
/// One triangle, somewhere else.
const AWAY: &str = "v 9 9 9\nv 10 9 9\nv 9 10 9\nf 1 2 3\n";
/// A tetrahedron of this size round the origin.
fn tetrahedron(size: f64) -> String {
    let corners = [
        [-1.0; 3],
        [3.0, -1.0, -1.0],
        [-1.0, 3.0, -1.0],
        [-1.0, -1.0, 3.0],
    ];
    let vertex = |[x, y, z]: [f64; 3]| format!("v {} {} {}\n", x * size, y * size, z * size);
    let vertices: String = corners.map(vertex).concat();
    vertices + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
}

/// A folder of good files, and of files that are not.
fn files() -> tempfile::TempDir {
    let claims = [
        "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000",
        "property float x\nproperty float y\nproperty float z",
        "element face 1000000000\nproperty list uchar int vertex_indices\nend_header\n",
    ];
    folder(&[
        ("crossing.obj", CROSSING.to_owned()),
        ("away.obj", AWAY.to_owned()),
        ("large.obj", tetrahedron(4.0)),
        ("small.obj", tetrahedron(1.0)),
        ("nan.obj", AWAY.replace("10 9 9", "nan 9 9")),
        ("cut.obj", AWAY[..AWAY.len() - 4].to_owned()),
        ("claims.ply", claims.join("\n")),
        (
            "list",
            "crossing.obj\naway.obj\n\nnan.obj\ncut.obj\nclaims.ply\nmissing.obj\n\
             large.obj\tsmall.obj\ncrossing.obj\taway.obj\n"
                .to_owned(),
        ),
    ])
}

/// Rows by line, without what differs from run to run.
fn rows(path: &Path) -> Vec<Value> {
    let text = fs::read_to_string(path).unwrap();
    let mut rows: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    for row in &mut rows {
        let row = row.as_object_mut().unwrap();
        assert_eq!(row.len(), 14);
        for name in ["ms", "peak_bytes"] {
            row.remove(name).expect("each row has it");
        }
    }
    rows.sort_by_key(|row| row["line"].as_u64());
    rows
}

fn list(folder: &Path, arguments: &[&str]) -> Said {
    check(
        folder,
        &[
            &["--files-from", "list", "--out", "out", "--jobs=2"],
            arguments,
        ]
        .concat(),
    )
}

#[test]
fn each_line_has_a_row_and_a_bad_file_is_one() {
    let folder = files();
    let path = folder.path();
    let said = list(path, &[]);
    said.assert_refused(&[
        "3 lines clear",
        "1 with something",
        "4 errors",
        "out says which",
    ]);
    let rows = rows(&path.join("out"));
    let lines: Vec<_> = rows
        .iter()
        .map(|row| row["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [1, 2, 4, 5, 6, 7, 8, 9]);
    // The hash is the one that `sha256sum` prints.
    assert_eq!(
        rows[1],
        json!({
            "line": 2, "bodies": ["away.obj"], "bytes": 34,
            "sha256": "8b328e28efa5ae2913c7c9c806fa56d1ca3200705e130b2162ecaebe6a6b0664",
            "triangles": 1, "pairs": 0, "crossing_edges": 0, "adjacent": 0, "touching": 0,
            "degenerate": 0, "inside": 0, "error": null
        })
    );
    assert_eq!(
        (&rows[0]["pairs"], &rows[0]["crossing_edges"]),
        (&json!(1), &json!(2))
    );
    assert_eq!(rows[6]["inside"], 1);
    assert_eq!(rows[7]["pairs"], 0);
    for (row, words) in rows[2..6]
        .iter()
        .zip(["NaN", "line 4", "GiB", "no such file"])
    {
        assert!(row["error"].as_str().unwrap().contains(words), "{row}");
        assert!(row["pairs"].is_null());
    }
}

#[test]
fn exit_codes_say_what_the_rows_say() {
    let folder = files();
    let path = folder.path();
    let run = |text: &str, arguments: &[&str]| {
        fs::write(path.join("list"), text).unwrap();
        let said = list(path, &[&["--force"], arguments].concat());
        (said.code, said.err)
    };
    let (code, said) = run("away.obj\n", &[]);
    assert_eq!((code, said.contains("1 lines clear")), (0, true), "{said}");
    assert_eq!(run("away.obj\n", &["--quiet"]), (0, String::new()));
    assert_eq!(run("away.obj\ncrossing.obj", &["-q"]).0, 1);
    assert_eq!(run("large.obj\tsmall.obj\n", &["-q"]).0, 0);
    assert_eq!(run("large.obj\tsmall.obj\n", &["-q", "--solid"]).0, 1);
    assert_eq!(run("crossing.obj\nnan.obj\n", &["-q"]).0, 2);
    assert_eq!(run("", &["-q"]).0, 0);
    // What checks have as flags, they have here.
    assert_eq!(run("large.obj\tsmall.obj\n", &["-q", "--within", "9"]).0, 1);
}

/// Left early anywhere, in the middle of a row, and gone on with: the same rows.
#[test]
fn going_on_gives_the_same_rows() {
    let folder = files();
    let path = folder.path();
    let out = path.join("out");
    list(path, &[]);
    let (text, whole) = (fs::read(&out).unwrap(), rows(&out));
    for end in (0..text.len()).step_by(97) {
        fs::write(&out, &text[..end]).unwrap();
        // The rows that were there count, too.
        list(path, &["--resume"]).assert_refused(&["3 lines clear", "4 errors"]);
        assert_eq!(rows(&out), whole);
        if end > 970 {
            break;
        }
    }
    // All shards together are the whole.
    let mut shards = Vec::new();
    for shard in ["0/3", "1/3", "2/3"] {
        list(path, &["--shard", shard, "--force"]);
        let its = rows(&out);
        assert!(its.len() < whole.len());
        shards.extend(its);
    }
    shards.sort_by_key(|row| row["line"].as_u64());
    assert_eq!(shards, whole);
}

#[test]
fn nothing_is_written_over_or_mixed_up() {
    let folder = files();
    let path = folder.path();
    list(path, &[]);
    let before = fs::read(path.join("out")).unwrap();
    list(path, &[]).assert_refused(&["a file is there", "--resume", "--force"]);
    fs::write(path.join("list"), "away.obj\nsmall.obj\n").unwrap();
    list(path, &["--resume"]).assert_refused(&["other bodies for line 1"]);
    assert_eq!(fs::read(path.join("out")).unwrap(), before);
    fs::write(path.join("out"), "something else\n").unwrap();
    list(path, &["--resume"]).assert_refused(&["out, line 1: no row of"]);
    pliant(path, &["summary", "out"]).assert_refused(&["out, line 1: no row of"]);
    check(path, &["--files-from", "none", "--out", "new"]).assert_refused(&["the list none"]);
    let refused: [(&[&str], &str); 7] = [
        (&["--files-from", "list"], "--out"),
        (
            &["--files-from", "list", "--out", "new", "away.obj"],
            "cannot be used with",
        ),
        (
            &["--files-from", "list", "--out", "new", "--format", "lines"],
            "--format jsonl",
        ),
        (
            &["--files-from", "list", "--out", "new", "--shard", "2/2"],
            "from 0",
        ),
        (
            &["--files-from", "list", "--out", "new", "--timeout", "-1"],
            "seconds",
        ),
        (&["away.obj", "--format", "jsonl"], "--files-from"),
        (&["away.obj", "--timeout", "3"], "--files-from"),
    ];
    for (arguments, words) in refused {
        check(path, arguments).assert_refused(&[words]);
    }
    assert!(!path.join("new").exists());
}

/// Whatever is not the beginning of a row is somebody's.
#[test]
fn no_other_file_is_cut_or_lost() {
    let folder = files();
    let path = folder.path();
    for text in ["precious", "a.obj\tb.obj", "{\"lines\": 3}"] {
        fs::write(path.join("out"), text).unwrap();
        list(path, &["--resume"]).assert_refused(&["ends with no row"]);
        assert_eq!(fs::read_to_string(path.join("out")).unwrap(), text);
    }
    for start in ["", "{", "{\"line\":1,\"bod"] {
        fs::write(path.join("out"), start).unwrap();
        assert_eq!(list(path, &["--resume"]).code, 2);
        assert_eq!(rows(&path.join("out")).len(), 8);
    }
    let text = fs::read_to_string(path.join("list")).unwrap();
    let said = check(
        path,
        &["--files-from", "list", "--out", "./list", "--force"],
    );
    said.assert_refused(&["it is the list"]);
    assert_eq!(fs::read_to_string(path.join("list")).unwrap(), text);
    check(path, &["--files-from", ".", "--out", "new"]).assert_refused(&["it is a folder"]);
    check(path, &["--files-from", "list", "--out", "-"]).assert_refused(&["name one"]);
    assert!(!path.join("new").exists() && !path.join("-").exists());
    // Twice in one output, a line would count twice.
    let row = fs::read_to_string(path.join("out")).unwrap();
    let row = row.lines().next().unwrap();
    fs::write(path.join("out"), format!("{row}\n{row}\n")).unwrap();
    list(path, &["--resume"]).assert_refused(&["two rows for line"]);
    // Another check has it.
    let held = fs::File::open(path.join("out")).unwrap();
    held.lock().unwrap();
    list(path, &["--force"]).assert_refused(&["another check writes to it"]);
}

#[test]
fn limits_are_of_all_jobs_together() {
    let folder = files();
    let path = folder.path();
    fs::write(path.join("list"), "small.obj\n").unwrap();
    let run = |memory: &str, jobs: &str| {
        let limits = ["--force", "--max-memory", memory, "--jobs", jobs];
        check(
            path,
            &[&["--files-from", "list", "--out", "out"], &limits[..]].concat(),
        )
    };
    let error = |memory: &str, jobs: &str| {
        run(memory, jobs);
        rows(&path.join("out"))[0]["error"].clone()
    };
    assert_eq!(error("1M", "1"), Value::Null);
    let said = error("1K", "8");
    assert!(
        said.as_str().unwrap().contains("32 bytes are allowed"),
        "{said}"
    );
    run("1M", "0").assert_refused(&["1..=1024"]);
}

#[test]
fn a_summary_says_how_many_of_what() {
    let folder = files();
    let path = folder.path();
    list(path, &[]);
    let said = pliant(path, &["summary", "out"]);
    assert_eq!(said.code, 0, "{}", said.err);
    for words in [
        "8 checks",
        "2  have no pairs, and nothing inside anything",
        "1  have pairs, 1 in all",
        "1  have components inside bodies, 1 in all",
        "4  have an error, and no answer",
        "1    no such file (as line 7)",
        "A check takes",
    ] {
        assert!(
            said.out.contains(words),
            "{words:?} is not in: {}",
            said.out
        );
    }
    assert_eq!(said.err, "");
    // Shards are summed up. A part of a row is none, which is said.
    let text = fs::read_to_string(path.join("out")).unwrap();
    fs::write(path.join("cut"), &text[..text.len() - 9]).unwrap();
    let cut = pliant(path, &["summary", "cut"]);
    assert!(cut.out.starts_with("7 checks"), "{}", cut.out);
    assert!(
        cut.err.contains("cut ends in the middle of a row"),
        "{}",
        cut.err
    );
    let twice = pliant(path, &["summary", "out", "out"]);
    assert!(
        twice.out.contains("2    no such file (as line 7)"),
        "{}",
        twice.out
    );
}

/// Counts of a summary, without times.
#[cfg(feature = "parquet")]
fn summary(folder: &Path, name: &str) -> String {
    let said = pliant(folder, &["summary", name]);
    assert_eq!(said.code, 0, "{}", said.err);
    let lines = said
        .out
        .lines()
        .filter(|it| !it.starts_with("A check takes"));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
#[cfg(feature = "parquet")]
fn a_table_has_the_rows_of_lines() {
    let folder = files();
    let path = folder.path();
    let parquet = |arguments: &[&str]| {
        let said = [
            "--files-from",
            "list",
            "--out",
            "t",
            "--jobs=2",
            "--format",
            "parquet",
        ];
        check(path, &[&said, arguments].concat())
    };
    let lines = list(path, &[]);
    assert_eq!(
        parquet(&[]).err.replace("; t says", "; out says"),
        lines.err
    );
    assert!(fs::read(path.join("t")).unwrap().starts_with(b"PAR1"));
    assert!(!path.join("t.rows").exists());
    assert_eq!(summary(path, "t"), summary(path, "out"));
    parquet(&[]).assert_refused(&["a file is there"]);
    // Gone on with, from the table and from the lines that wait beside it.
    let more = fs::read_to_string(path.join("list")).unwrap() + "small.obj\n";
    fs::write(path.join("list"), more).unwrap();
    parquet(&["--resume"]).assert_refused(&["4 lines clear"]);
    list(path, &["--resume"]);
    assert_eq!(summary(path, "t"), summary(path, "out"));
    let text = fs::read(path.join("out")).unwrap();
    fs::write(path.join("t.rows"), &text[..text.len() / 2]).unwrap();
    parquet(&[]).assert_refused(&["a file is there"]);
    fs::remove_file(path.join("t")).unwrap();
    parquet(&[]).assert_refused(&["t.rows: a file is there"]);
    parquet(&["--resume"]).assert_refused(&["4 lines clear"]);
    assert_eq!(summary(path, "t"), summary(path, "out"));
}

#[test]
#[cfg(not(feature = "parquet"))]
fn a_program_without_tables_says_so() {
    let folder = files();
    let path = folder.path();
    list(path, &["--format", "parquet"]).assert_refused(&["--features parquet"]);
    fs::write(path.join("t"), "PAR1...PAR1").unwrap();
    pliant(path, &["summary", "t"]).assert_refused(&["--features parquet"]);
    assert!(!path.join("out").exists());
}

/// A check that takes too long, and one whose process is killed, are rows like others.
#[cfg(unix)]
mod ended {
    use super::{check, files, list, rows};
    use std::fmt::Write as _;
    use std::fs;
    use std::io::Write as _;
    use std::process::{Command, Stdio};
    use std::thread::yield_now;

    /// More pairs than anybody waits for.
    fn endless() -> String {
        let mut text = String::new();
        for triangle in 0..30_000 {
            let x = f64::from(triangle) * 1e-6;
            writeln!(text, "v {x} 0 0\nv {x} 1 {x}\nv 1 {x} 1\nf -3 -2 -1").unwrap();
        }
        text
    }

    #[test]
    fn what_takes_too_long_is_given_up() {
        let folder = files();
        let path = folder.path();
        fs::write(path.join("endless.obj"), endless()).unwrap();
        fs::write(path.join("list"), "endless.obj\nendless.obj\n").unwrap();
        let said = list(path, &["--timeout", "0.001"]);
        said.assert_refused(&["2 errors"]);
        for row in rows(&path.join("out")) {
            assert_eq!(row["error"], "took longer than --timeout 0.001");
        }
        // Others have their time.
        fs::write(path.join("list"), "away.obj\n").unwrap();
        assert_eq!(list(path, &["--timeout", "0", "--force"]).code, 0);
    }

    /// A list that is read once, and a program whose arguments end in `--`.
    #[test]
    fn lists_may_be_pipes() {
        let folder = files();
        let path = folder.path();
        for name in ["-", "/dev/stdin"] {
            let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
                .current_dir(path)
                .args([
                    "check",
                    "--files-from",
                    name,
                    "--out",
                    "out",
                    "--force",
                    "-q",
                    "--",
                ])
                .stdin(Stdio::piped())
                .spawn()
                .unwrap();
            let mut lines = child.stdin.take().unwrap();
            writeln!(lines, "crossing.obj\naway.obj").unwrap();
            drop(lines);
            assert_eq!(child.wait().unwrap().code(), Some(1));
            assert_eq!(rows(&path.join("out")).len(), 2);
        }
    }

    /// A signal to all, as Ctrl-C, is no fault of the files; and nobody is left behind.
    #[test]
    #[cfg(target_os = "linux")]
    fn an_end_from_outside_is_no_row() {
        use std::os::unix::process::CommandExt;
        let folder = files();
        let path = folder.path();
        fs::write(path.join("endless.obj"), endless()).unwrap();
        fs::write(path.join("list"), "endless.obj\n".repeat(50)).unwrap();
        for (signal, number) in [("-INT", 2), ("-TERM", 15), ("-HUP", 1), ("-KILL", 9)] {
            if is_ignored(number) {
                eprintln!("skipped: whoever began the tests ignores {signal}, and so does a child");
                continue;
            }
            let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
                .current_dir(path)
                .args([
                    "check",
                    "--files-from",
                    "list",
                    "--out",
                    "out",
                    "--force",
                    "--jobs",
                    "3",
                ])
                .process_group(0)
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            let all = loop {
                let all = workers(child.id());
                if all.len() == 3 && all.iter().all(|worker| is_a_group(worker)) {
                    break all;
                }
                yield_now();
            };
            let group = format!("-{}", child.id());
            let kill = Command::new("kill").args([signal, "--", &group]).status();
            assert!(kill.unwrap().success());
            assert_eq!(child.wait().unwrap().code(), None);
            assert_eq!(rows(&path.join("out")).len(), 0);
            for worker in all {
                while lives(&worker) {
                    yield_now();
                }
            }
        }
    }

    /// Whether this process ignores a signal, as one does that a shell began in the background.
    #[cfg(target_os = "linux")]
    fn is_ignored(signal: u32) -> bool {
        let status = fs::read_to_string("/proc/self/status").unwrap();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = u64::from_str_radix(ignored.unwrap().trim(), 16).unwrap();
        ignored >> (signal - 1) & 1 == 1
    }

    /// Whether a process leads a group of its own, as a worker does as soon as it runs.
    #[cfg(target_os = "linux")]
    fn is_a_group(process: &str) -> bool {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        let behind_name = stat.rsplit(") ").next().unwrap_or_default();
        behind_name.split(' ').nth(2) == Some(process)
    }

    /// Whether a process runs: one that has ended stays where nobody asks for its end.
    #[cfg(target_os = "linux")]
    fn lives(process: &str) -> bool {
        let stat = fs::read_to_string(format!("/proc/{process}/stat"));
        stat.is_ok_and(|stat| !stat.contains(") Z "))
    }

    /// Processes that a process has begun.
    #[cfg(target_os = "linux")]
    fn workers(of: u32) -> Vec<String> {
        let tasks = fs::read_dir(format!("/proc/{of}/task")).unwrap().flatten();
        let of_task = tasks.map(|task| fs::read_to_string(task.path().join("children")));
        let all: String = of_task.map(Result::unwrap_or_default).collect();
        all.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_process_that_is_killed_costs_one_row() {
        let folder = files();
        let path = folder.path();
        fs::write(path.join("endless.obj"), endless()).unwrap();
        let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
            .current_dir(path)
            .args(["check", "--files-from", "-", "--out", "out", "--jobs", "1"])
            .stdin(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = child.stdin.take().unwrap();
        writeln!(lines, "endless.obj").unwrap();
        let first = loop {
            match workers(child.id()).pop() {
                None => yield_now(),
                Some(worker) => break worker,
            }
        };
        let kill = |worker: &str| Command::new("kill").args(["-9", worker]).status().unwrap();
        assert!(kill(&first).success());
        writeln!(lines, "crossing.obj\naway.obj").unwrap();
        drop(lines);
        assert_eq!(child.wait().unwrap().code(), Some(2));
        let rows = rows(&path.join("out"));
        assert_eq!(rows[0]["error"], "signal 9 (SIGKILL) ended its process");
        assert_eq!(rows[1]["pairs"], 1);
        assert_eq!(rows[2]["pairs"], 0);
        // The line is checked again if it is taken out of the output.
        let text = fs::read_to_string(path.join("out")).unwrap();
        let others: Vec<_> = text.lines().filter(|it| !it.contains("SIGKILL")).collect();
        fs::write(path.join("out"), others.join("\n") + "\n").unwrap();
        fs::write(path.join("list"), "away.obj\ncrossing.obj\naway.obj\n").unwrap();
        let going_on = check(path, &["--files-from", "list", "--out", "out", "--resume"]);
        assert_eq!(going_on.code, 1, "{}", going_on.err);
    }
}
