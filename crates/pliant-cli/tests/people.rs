//! The program as people meet it: quiet when asked, plain where there is no terminal, helpful when it is used wrongly.

mod common;

use common::{Said, pliant};
use std::fs;
use std::path::Path;
use std::process::Command;

fn in_folder(arguments: &[&str]) -> Said {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "a.obj", "s_1.obj", "s_2.obj", "s_3.obj", "t_1.obj", "t_2.obj",
    ] {
        fs::write(
            folder.path().join(name),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        )
        .unwrap();
    }
    fs::write(folder.path().join("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    fs::write(folder.path().join("empty.obj"), "").unwrap();
    pliant(folder.path(), arguments)
}

#[test]
fn every_error_says_what_to_do_next() {
    for (line, next) in [
        ("", "Usage: pliant <COMMAND>"),
        ("chek a.obj", "similar subcommand exists: 'check'"),
        ("run sphere", "there are spheres, crowd"),
        ("run --steps 500", "leave it out"),
        ("run --stride 300", "choose a smaller one"),
        ("run --triangles 100", "nearest possible numbers"),
        ("run --degree 3", "[possible values: 2, 4, 8]"),
        ("run --update topdown", "'top-down'"),
        (
            "run --level 3 --update top-down",
            "goes with --update hybrid",
        ),
        ("run --threads 0", "write a whole number, 1 or more"),
        ("run --leaf-size x", "write a whole number, 1 or more"),
        ("run --seed -1", "write a whole number from 0"),
        ("check", "<BODY>..."),
        ("check nosuch.obj", "from the current folder"),
        ("check no_*.obj", "`ls`"),
        ("check [x", "write [[]"),
        ("check .", "name a file"),
        ("check empty.obj", "export it again"),
        ("check bad.obj", "export it again"),
        ("check s_*.obj t_*.obj", "export the same frames"),
        (
            "check a.obj --baseline 3",
            "frames of these files are 0 to 0",
        ),
        ("check a.obj --ignore c,d", "bodies: 0 = \"a.obj\""),
        ("check a.obj --ignore c", "write A,B"),
        ("check a.obj --group x", "write NAME=BODY,BODY"),
        ("check a.obj --group a.obj=a.obj", "choose another name"),
        ("check a.obj --max-memory 1GB", "write GiB"),
        (
            "check a.obj --max-memory 10",
            "allow more with `--max-memory`",
        ),
        ("check a.obj --threads 0", "write a whole number, 1 or more"),
        ("check a.obj --hits x.obj", "must end in .vtp or .vtu"),
        ("check a.obj --hits no/x.vtp", "make its folder first"),
        ("bench experiment-2", "there are experiment-1"),
        ("bench cloth --json no/x.json", "make its folder first"),
        ("bench cloth --json .", "name a file in it"),
        ("completions ksh", "[possible values: bash"),
        ("man a.obj", "choose another name"),
    ] {
        let said = in_folder(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(said.code, 2, "{line}: {}", said.out);
        assert!(said.err.contains(next), "{line}: {}", said.err);
    }
}

#[test]
fn quiet_is_quiet() {
    for line in [
        "run --steps 2 --quiet",
        "run --steps 2 -q --format json",
        "check a.obj --quiet",
        "convert a.obj b.stl --quiet",
        "bench cloth --small --rounds 1 --quiet",
    ] {
        let said = in_folder(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(
            (said.code, said.out.as_str(), said.err.as_str()),
            (0, "", ""),
            "{line}"
        );
    }
    let said = in_folder(&["run", "nosuch", "--quiet"]);
    said.assert_refused(&["nosuch"]);
}

#[test]
fn colours_only_where_they_are_wanted() {
    let escapes = |arguments: &[&str], variables: &[(&str, &str)]| {
        let output = Command::new(env!("CARGO_BIN_EXE_pliant"))
            .args(arguments)
            .env_remove("NO_COLOR")
            .env_remove("CLICOLOR")
            .env_remove("CLICOLOR_FORCE")
            .envs(variables.iter().copied())
            .output()
            .unwrap();
        [output.stdout, output.stderr].concat().contains(&0x1b)
    };
    for arguments in [
        &["--help"][..],
        &["check", "--help"],
        &["nosuch"],
        &["check", "nosuch.obj"],
        &["run", "--steps", "1"],
    ] {
        assert!(!escapes(arguments, &[]), "{arguments:?} into a pipe");
    }
    // A pipe that is asked to be a terminal shows that there are colours to leave out.
    assert!(escapes(&["--help"], &[("CLICOLOR_FORCE", "1")]));
    assert!(escapes(&["nosuch"], &[("CLICOLOR_FORCE", "1")]));
    for forbidden in [
        &[("NO_COLOR", "1"), ("CLICOLOR_FORCE", "0")][..],
        &[("CLICOLOR", "0")],
    ] {
        assert!(!escapes(&["--help"], forbidden), "{forbidden:?}");
    }
}

#[test]
fn times_have_units() {
    let said = in_folder(&["run", "--triangles", "80", "--stride", "50"]);
    let times: Vec<&str> = said
        .out
        .lines()
        .filter(|line| {
            ["update", "query", "both"].contains(&line.split_whitespace().next().unwrap_or(""))
        })
        .collect();
    assert_eq!(times.len(), 3, "{}", said.out);
    for line in times {
        let units = line
            .split_whitespace()
            .filter(|word| ["ns", "µs", "ms", "s"].contains(word));
        assert_eq!(units.count(), 2, "{line}");
    }
}

#[test]
fn completions_and_manual_pages_are_written() {
    for (shell, word) in [
        ("bash", "complete -F"),
        ("zsh", "#compdef pliant"),
        ("fish", "complete -c pliant"),
        ("powershell", "Register-ArgumentCompleter"),
        ("elvish", "edit:completion"),
    ] {
        let said = in_folder(&["completions", shell]);
        assert_eq!((said.code, said.err.as_str()), (0, ""));
        assert!(said.out.contains(word), "{shell}: {word}");
    }
    let folder = tempfile::tempdir().unwrap();
    let said = pliant(folder.path(), &["man", "share/man1"]);
    assert_eq!(
        (said.code, said.out.as_str(), said.err.as_str()),
        (0, "", "")
    );
    let read =
        |name: &str| fs::read_to_string(folder.path().join("share/man1").join(name)).unwrap();
    for verb in ["run", "check", "bench", "completions", "man"] {
        let page = read(&format!("pliant-{verb}.1"));
        assert!(page.contains(".SH SYNOPSIS"), "{verb}");
    }
    assert_eq!(pliant(Path::new("."), &["man"]).out, read("pliant.1"));
}
