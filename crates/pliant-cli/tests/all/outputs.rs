//! Output files of commands: no name loses anybody's work, and every file is whole.

use crate::common::{check, folder, pliant};
use std::fmt::Write;
use std::fs;
use std::path::Path;

const MESH: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.3 0.2 1\nv 0.2 0.3 1\nf 1 2 3\nf 4 5 6\n";

/// Every way to write a file: a command that ends in a file name, and the names of all files
/// written.
const WAYS: [(&[&str], &[&str]); 7] = [
    (&["check", "a.obj", "--report", "out.html"], &["out.html"]),
    (&["check", "a.obj", "--png", "out.png"], &["out.png"]),
    (&["check", "a.obj", "--hits", "out.vtp"], &["out.vtp"]),
    (
        &["check", "a_*.obj", "--hits", "out.vtu"],
        &["out_0.vtu", "out_1.vtu", "out.pvd"],
    ),
    (&["run", "--steps", "1", "--png", "out.png"], &["out.png"]),
    (
        &[
            "bench", "degrees", "--small", "--rounds", "1", "--json", "out.json",
        ],
        &["out.json"],
    ),
    (
        &[
            "bench", "degrees", "--small", "--rounds", "1", "--report", "out.html",
        ],
        &["out.html"],
    ),
];

fn meshes() -> tempfile::TempDir {
    folder(&["a.obj", "a_0.obj", "a_1.obj"].map(|name| (name, MESH.to_owned())))
}

/// Names in a folder, except the meshes.
fn left(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.filter(|name| !name.starts_with('a')).collect();
    names.sort();
    names
}

#[test]
fn what_pliant_did_not_write_stays_unless_it_is_forced() {
    for (command, names) in WAYS {
        for name in names {
            let folder = meshes();
            let path = folder.path();
            let mine = "notes of mine\n".repeat(1000);
            fs::write(path.join(name), &mine).unwrap();
            let said = pliant(path, command);
            said.assert_refused(&["cannot write", name, "`--force`"]);
            assert_eq!(fs::read_to_string(path.join(name)).unwrap(), mine);
            assert_eq!(left(path), [*name], "nothing else is left of {command:?}");

            let forced = pliant(path, &[command, &["--force"]].concat());
            assert!(forced.code < 2, "{}", forced.err);
            assert_ne!(fs::read(path.join(name)).unwrap(), mine.as_bytes());
            // A file of its own is overwritten without being asked twice.
            let again = pliant(path, command);
            assert!(again.code < 2, "{command:?}: {}", again.err);
            let mut expected: Vec<_> = names.to_vec();
            expected.sort_unstable();
            assert_eq!(left(path), expected);
        }
    }
}

#[test]
fn charts_are_not_written_over_what_is_there() {
    let folder = meshes();
    let path = folder.path();
    let command = [
        "bench", "degrees", "--small", "--rounds", "1", "--quiet", "--svg", "charts",
    ];
    assert_eq!(pliant(path, &command).code, 0);
    assert_eq!(pliant(path, &command).code, 0);
    let chart = fs::read_dir(path.join("charts")).unwrap().next().unwrap();
    let chart = chart.unwrap().path();
    fs::write(&chart, "mine").unwrap();
    pliant(path, &command).assert_refused(&["cannot write", "`--force`"]);
    assert_eq!(fs::read(&chart).unwrap(), b"mine");
}

/// A link is replaced, never its target: the mesh that is checked, above all.
#[cfg(unix)]
#[test]
fn links_are_replaced_and_never_followed() {
    use std::os::unix::fs::symlink;
    let links: [fn(&Path, &Path) -> std::io::Result<()>; 2] = [
        |from, to| symlink(from, to),
        |from, to| fs::hard_link(from, to),
    ];
    for (command, names) in WAYS {
        let name = names[0];
        for link in links {
            let folder = meshes();
            let path = folder.path();
            link(&path.join("a.obj"), &path.join(name)).unwrap();
            pliant(path, command).assert_refused(&["cannot write", name, "`--force`"]);
            let forced = pliant(path, &[command, &["--force"]].concat());
            assert!(forced.code < 2, "{}", forced.err);
            assert_eq!(fs::read_to_string(path.join("a.obj")).unwrap(), MESH);
            let now = path.join(name).symlink_metadata().unwrap();
            assert!(now.is_file(), "{command:?}");
            assert_ne!(fs::read(path.join(name)).unwrap(), MESH.as_bytes());
        }
        // A dangling link bears no mark.
        let folder = meshes();
        let path = folder.path();
        symlink(path.join("nowhere"), path.join(name)).unwrap();
        pliant(path, command).assert_refused(&["cannot write", "`--force`"]);
        assert!(!path.join("nowhere").exists());
    }
}

/// Pipes, which would be waited for if nobody reads, and folders are refused.
#[cfg(unix)]
#[test]
fn pipes_devices_and_folders_are_refused_at_once() {
    for (command, names) in WAYS {
        let name = names[0];
        let folder = meshes();
        let path = folder.path().join(name);
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        if !made.is_ok_and(|made| made.success()) {
            eprintln!("skipped: no pipes can be made here");
            return;
        }
        for force in [&[][..], &["--force"]] {
            let said = pliant(folder.path(), &[command, force].concat());
            said.assert_refused(&["cannot write", name, "a pipe or a device"]);
        }
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        for force in [&[][..], &["--force"]] {
            let said = pliant(folder.path(), &[command, force].concat());
            said.assert_refused(&["cannot write", name, "directory"]);
        }
        fs::remove_dir(&path).unwrap();
    }
    let folder = meshes();
    if Path::new("/dev/full").exists() {
        std::os::unix::fs::symlink("/dev/full", folder.path().join("full.html")).unwrap();
        let said = check(folder.path(), &["a.obj", "--report", "full.html"]);
        said.assert_refused(&["cannot write", "`--force`"]);
    }
}

/// Output of the program where at most 8 KB may be written to a file, as on a full disk.
///
/// The signal of that limit may be ignored or not. `None` without a shell that sets the limit.
#[cfg(target_os = "linux")]
fn on_a_full_disk(folder: &Path, command: &[&str]) -> Option<crate::common::Said> {
    let [said, ignored] = ["", "trap '' XFSZ; "].map(|trap| {
        let script = format!(
            "{trap}ulimit -f 8; exec '{}' {}",
            env!("CARGO_BIN_EXE_pliant"),
            command.join(" ")
        );
        let mut shell = std::process::Command::new("bash");
        let said = shell.args(["-c", &script]).current_dir(folder).output();
        let said = said.ok()?;
        assert!(said.status.code().is_some(), "{trap}{}", said.status);
        Some(crate::common::Said {
            code: said.status.code().unwrap(),
            out: String::from_utf8(said.stdout).unwrap(),
            err: String::from_utf8(said.stderr).unwrap(),
        })
    });
    let (Some(said), Some(ignored)) = (said, ignored) else {
        eprintln!("skipped: no shell that limits the size of files");
        return None;
    };
    assert_eq!(said.code, ignored.code);
    for said in [&said, &ignored] {
        assert!(said.err.contains("File too large"), "{}", said.err);
        assert!(!said.err.contains(".pliant-"), "{}", said.err);
    }
    Some(said)
}

/// The earlier file stays, and nothing else is left.
#[cfg(target_os = "linux")]
#[test]
fn on_a_full_disk_the_old_file_stays_whole() {
    let folder = meshes();
    let path = folder.path();
    let command = ["check", "a.obj", "--report", "out.html"];
    assert_eq!(pliant(path, &command).code, 1);
    let whole = fs::read(path.join("out.html")).unwrap();
    let Some(said) = on_a_full_disk(path, &command) else {
        return;
    };
    said.assert_refused(&["cannot write out.html"]);
    assert_eq!(fs::read(path.join("out.html")).unwrap(), whole);
    assert_eq!(left(path), ["out.html"]);
}

/// A full disk, in every format. Archives write once more when they are dropped.
#[cfg(target_os = "linux")]
#[test]
fn converting_onto_a_full_disk_is_one_line() {
    let folder = meshes();
    let path = folder.path();
    let mut large = String::new();
    for vertex in 0..5_000 {
        writeln!(large, "v {vertex} {} 0.5", vertex % 7).unwrap();
    }
    large += &"f 1 2 3\n".repeat(5_000);
    fs::write(path.join("a_large.obj"), large).unwrap();
    for name in ["x.npz", "x.ply", "x.stl", "x.obj", "a.obj+x.pc2"] {
        let Some(said) = on_a_full_disk(path, &["convert", "a_large.obj", name, "--force"]) else {
            return;
        };
        said.assert_refused(&["cannot be written"]);
        assert_eq!(
            fs::read_to_string(path.join("a.obj")).unwrap(),
            MESH,
            "{name}"
        );
        assert!(left(path).is_empty(), "{name}: {:?}", left(path));
    }
}

/// A program that is busy writing, for many seconds.
#[cfg(unix)]
fn writing(path: &Path, before: &str) -> std::process::Child {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let script = format!(
        "{before}exec '{}' convert a.obj+a.pc2 out.npz --force",
        env!("CARGO_BIN_EXE_pliant")
    );
    let program = Command::new("sh")
        .args(["-c", &script])
        .current_dir(path)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Reached only if it hangs.
    let until = Instant::now() + Duration::from_secs(600);
    while !left(path).iter().any(|name| name.starts_with(".pliant-")) {
        assert!(Instant::now() < until, "it never began to write");
        std::thread::sleep(Duration::from_millis(1));
    }
    program
}

/// Whether a program started here ignores a signal from the beginning, except Ctrl-C, which this
/// one heeds.
#[cfg(unix)]
fn is_ignored_here(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.map(|bits| u64::from_str_radix(bits.trim(), 16).unwrap());
    let unsure = signal == signal_hook::consts::SIGHUP;
    signal != signal_hook::consts::SIGINT
        && ignored.map_or(unsure, |bits| bits >> (signal - 1) & 1 == 1)
}

#[cfg(unix)]
fn send(signal: &str, program: &std::process::Child) {
    let mut kill = std::process::Command::new("kill");
    let sent = kill
        .args(["-s", signal, &program.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

/// Signals that end the program leave the earlier file and no partial one, and the caller learns of
/// them.
///
/// Ctrl-C, a closed terminal, or a request to end.
#[cfg(unix)]
#[test]
fn a_signal_leaves_nothing_behind() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU};
    use std::os::unix::process::ExitStatusExt;

    let folder = meshes();
    let path = folder.path();
    // Ten million frames of six vertices in a sparse file: many seconds of writing.
    let frames = 10_000_000_u32;
    let mut header = b"POINTCACHE2\0".to_vec();
    header.extend(
        [1_u32, 6, 0x0, 0x3f80_0000, frames]
            .map(u32::to_le_bytes)
            .as_flattened(),
    );
    fs::write(path.join("a.pc2"), &header).unwrap();
    let file = fs::OpenOptions::new().write(true).open(path.join("a.pc2"));
    let length = header.len() as u64 + u64::from(frames) * 6 * 12;
    file.unwrap().set_len(length).unwrap();
    fs::write(path.join("out.npz"), "mine").unwrap();

    for (signal, number) in [
        ("HUP", SIGHUP),
        ("INT", SIGINT),
        ("QUIT", SIGQUIT),
        ("TERM", SIGTERM),
        ("USR1", SIGUSR1),
        ("USR2", SIGUSR2),
        ("XCPU", SIGXCPU),
    ] {
        if is_ignored_here(number) {
            eprintln!("skipped: whoever runs this test has it ignore SIG{signal}");
            continue;
        }
        // No core dump, for the signals that cause one.
        let mut program = writing(path, "ulimit -c 0; ");
        send(signal, &program);
        let status = program.wait().unwrap();
        assert_eq!(status.signal(), Some(number), "{signal}: {status}");
        assert_eq!(left(path), ["out.npz"], "{signal}");
        assert_eq!(fs::read(path.join("out.npz")).unwrap(), b"mine");
    }
    // A signal that the caller has it ignore does not end it; the next one does.
    if cfg!(target_os = "linux") {
        for ignored in ["HUP", "QUIT", "USR1"] {
            let mut program = writing(path, &format!("trap '' {ignored}; "));
            send(ignored, &program);
            send("TERM", &program);
            let status = program.wait().unwrap();
            assert_eq!(status.signal(), Some(15), "{ignored}: {status}");
            assert_eq!(left(path), ["out.npz"], "{ignored}");
        }
    }
}
