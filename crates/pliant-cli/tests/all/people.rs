//! The program as people meet it: quiet when asked, plain outside terminals, helpful about errors.

use crate::common::{Said, pliant};
use serde_json::json;
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
    let groups = "v 0 0 0\nv 1 0 0\nv 0 1 0\no arm\nf 1 2 3\ng hand\nf 1 2 3\no leg\nf 1 2 3\n";
    fs::write(folder.path().join("groups.obj"), groups).unwrap();
    fs::write(folder.path().join("empty.obj"), "").unwrap();
    // Two triangles whose edges coincide in the first frame, and part in the second.
    for (name, x) in [("seam_1.obj", 0), ("seam_2.obj", 1)] {
        let text =
            format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv {x} 0 0\nv 0 -1 0\nf 1 2 3\nf 4 5 6\n");
        fs::write(folder.path().join(name), text).unwrap();
    }
    fs::write(folder.path().join("two.pc2"), positions(2)).unwrap();
    fs::write(folder.path().join("three.pc2"), positions(3)).unwrap();
    fs::write(
        folder.path().join("words.stl"),
        "facet normal 0 0 1\n".repeat(9),
    )
    .unwrap();
    let data = "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    for (name, change) in [
        ("still.gltf", None),
        ("moves.gltf", Some(("/scenes/0/nodes", json!([0])))),
        ("old.gltf", Some(("/asset/version", json!("1.0")))),
        ("nowhere.gltf", Some(("/scenes/0/nodes", json!([99])))),
        ("alone.gltf", Some(("/buffers/0/uri", json!("gone.bin")))),
        (
            "web.gltf",
            Some(("/buffers/0/uri", json!("https://a/b.bin"))),
        ),
        ("plain.gltf", Some(("/buffers/0/uri", json!("data:,a")))),
        (
            "cut.gltf",
            Some(("/buffers/0/uri", json!("data:;base64,AAAA"))),
        ),
        (
            "draco.gltf",
            Some(("/extensionsRequired", json!(["KHR_draco_mesh_compression"]))),
        ),
    ] {
        let mut scene = json!({
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0, "name": "arm"}, {"mesh": 0, "name": "leg"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": data}],
            "extensionsRequired": [],
        });
        if name == "moves.gltf" {
            // One body, for one second: the fourth number of the buffer is 1, and the first six are
            // two places.
            let number = |offset: u32, kind: &str| {
                json!({
                    "bufferView": 0, "byteOffset": offset,
                    "componentType": 5126, "count": 2, "type": kind
                })
            };
            let accessors = scene["accessors"].as_array_mut().unwrap();
            accessors.extend([number(8, "SCALAR"), number(0, "VEC3")]);
            let channel = json!({"sampler": 0, "target": {"node": 0, "path": "translation"}});
            let sampler = json!({"input": 1, "output": 2});
            scene["animations"] = json!([{"channels": [channel], "samplers": [sampler]}]);
            scene["nodes"].as_array_mut().unwrap().pop();
        }
        if let Some((pointer, value)) = change {
            *scene.pointer_mut(pointer).unwrap() = value;
        }
        fs::write(folder.path().join(name), scene.to_string()).unwrap();
    }
    pliant(folder.path(), arguments)
}

/// A PC2 file of one frame.
fn positions(vertices: u32) -> Vec<u8> {
    let mut file = b"POINTCACHE2\0\x01\0\0\0".to_vec();
    file.extend([vertices, 0, 0, 1].map(u32::to_le_bytes).concat());
    file.resize(file.len() + 12 * vertices as usize, 0);
    file
}

/// Lines of arguments that are refused, and words that the message has.
fn says_next(lines: &[(&str, &str)]) {
    for (line, next) in lines {
        let said = in_folder(&line.split_whitespace().collect::<Vec<_>>());
        println!("$ pliant {line}\n{}", said.err);
        assert_eq!(said.code, 2, "{line}: {}", said.out);
        assert!(said.err.contains(next), "{line}: {}", said.err);
        // Without arguments, the help is shown.
        let is_help = line.is_empty();
        assert!(
            is_help || said.err.lines().count() == 1,
            "{line}: {}",
            said.err
        );
        assert!(
            is_help || said.err.starts_with("pliant: "),
            "{line}: {}",
            said.err
        );
    }
}

#[test]
fn every_error_says_what_to_do_next() {
    says_next(&[
        ("", "Usage: pliant <COMMAND>"),
        ("chek a.obj", "similar subcommand exists: 'check'"),
        ("run sphere", "shuffle, remesh; choose one of these\n"),
        ("run --steps 500", "leave it out"),
        ("run --stride 300", "choose a smaller one"),
        ("run --triangles 100", "nearest possible numbers"),
        ("run --degree 3", "[possible values: 2, 4, 8]"),
        ("run --update topdown", "'top-down'"),
        (
            "run --level 3 --update top-down",
            "leave it out, or choose --update hybrid",
        ),
        ("run --threads 0", "write a whole number, 1 or more, or all"),
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
            "the baseline is frame 3, but these files have one frame, 0; choose",
        ),
        ("check a.obj --ignore c,d", "bodies: 0 = \"a.obj\""),
        (
            "check a.obj --ignore a.obj#1,a.obj#2",
            "choose one of these, \
             or make the pieces of every file bodies with `--split components`",
        ),
        (
            "check a.obj --group x=a.obj#2",
            "or make the pieces of every file bodies with `--split components`",
        ),
        (
            "check a.obj --split components --ignore a.obj#1,a.obj#2",
            "bodies: 0 = \"a.obj#1\"; choose one of these\n",
        ),
        ("check a.obj --ignore c", "write A,B"),
        ("check a.obj --group x", "write NAME=BODY,BODY"),
        ("check a.obj --group a.obj=a.obj", "choose another name"),
        ("check a.obj --max-memory 1GB", "write GiB"),
        (
            "check a.obj --max-memory 10",
            "a frame needs at least 24 bytes of memory, 10 bytes are allowed; allow more memory \
             with `--max-memory`, or split the mesh\n",
        ),
        (
            "check a.obj --max-memory 100",
            "100 bytes are allowed; allow more memory with `--max-memory`, or use `--no-weld`\n",
        ),
        (
            "convert seam_*.obj x.npz --weld 1e-6",
            "what is written has one mesh: use `--no-weld`, or `--weld` with more than that\n",
        ),
        (
            "check a.obj --baseline x",
            "name a file that `pliant check --format json` wrote",
        ),
        ("check a.obj --baseline -1", "write the number of a frame"),
        (
            "check a.obj --png a.png --frame -1",
            "write the number of a frame",
        ),
        (
            "check a.obj --png a.png --frame 9",
            "the first is 0, the last 0",
        ),
        (
            "check a.obj --group x=",
            "the group \"x\" has no bodies; write NAME=BODY,BODY\n",
        ),
        ("check a.obj --group =a.obj", "write NAME=BODY,BODY"),
        (
            "check a.obj --group x=a.obj --group x=a.obj",
            "name all its bodies at once",
        ),
        (
            "check a.obj --group x=y",
            "bodies: 0 = \"a.obj\"; choose one of these",
        ),
        (
            "check a.obj --split pieces",
            "[possible values: components, groups]",
        ),
        (
            "check a.obj --threads 0",
            "write a whole number, 1 or more, or all",
        ),
        ("check a.obj --hits x.obj", "must end in .vtp or .vtu"),
        ("check a.obj --hits no/x.vtp", "make its folder first"),
    ]);
}

#[test]
fn every_error_of_other_commands_says_what_to_do_next() {
    says_next(&[
        ("bench experiment-2", "all and cores; choose one of these\n"),
        ("bench splits --json no/x.json", "make its folder first"),
        ("bench splits --json .", "name a file in it"),
        ("completions ksh", "[possible values: bash"),
        ("man a.obj", "choose another name"),
    ]);
}

#[test]
fn every_error_about_groups_says_what_to_do_next() {
    says_next(&[
        (
            "check groups.obj --ignore groups.obj#arm,groups.obj#leg",
            "choose one of these, or make the groups of OBJ files bodies with `--split groups`",
        ),
        (
            "check groups.obj --split groups --ignore groups.obj#arm,groups.obj#head",
            "1 = \"groups.obj#arm/hand\", 2 = \"groups.obj#leg\"; choose one of these\n",
        ),
        (
            "check groups.obj#head",
            "groups.obj: has no body \"head\"; it has: arm, arm/hand, leg; choose one of these\n",
        ),
        (
            "check groups.obj#arm --split components",
            "name the whole file, or write the group to a file of its own with `pliant convert` \
             and split that\n",
        ),
        (
            "check groups.obj#arm groups.obj#arm/hand",
            "the group \"arm/hand\" of groups.obj is named by two arguments, \"groups.obj#arm\" \
             and \"groups.obj#arm/hand\"; leave out one of the two\n",
        ),
        ("check s_*.obj#b", "leave out what begins with the #"),
        ("check no.obj#b", "from the current folder"),
        (
            "convert groups.obj#head x.obj",
            "it has: arm, arm/hand, leg; choose one of these\n",
        ),
    ]);
}

#[test]
fn every_error_of_a_format_or_a_conversion_says_what_to_do_next() {
    says_next(&[
        ("check a.obj#b", "leave out what begins with the #"),
        (
            "check words.stl",
            "expected \"solid\", found \"facet\"; mend it",
        ),
        ("check two.pc2", "'mesh.obj+two.pc2'"),
        ("check a.obj+two.pc2", "export all of them from one mesh"),
        (
            "check s_*.obj+three.pc2",
            "a pattern cannot stand here; name one file",
        ),
        ("check a.obj+no.pc2", "from the current folder"),
        (
            "check old.gltf",
            "only version 2 can be read, so convert it",
        ),
        (
            "check nowhere.gltf",
            "scene 0: node 99 does not exist; mend it, or export it again",
        ),
        (
            "check alone.gltf",
            "gone.bin, buffer 0: no such file; the glTF file keeps data there",
        ),
        ("check web.gltf", "export it as .glb"),
        ("check plain.gltf", "export the file as .glb"),
        ("check cut.gltf", "copy it or export it again"),
        ("check draco.gltf", "export it without compression"),
        (
            "check still.gltf#head",
            "it has: arm, leg; choose one of these",
        ),
        ("check still.gltf --clip Run", "leave out `--clip`\n"),
        (
            "check moves.gltf --clip Run",
            "it has: 0; choose one of these with `--clip`\n",
        ),
        (
            "check moves.gltf --fps 1e300",
            "its clip lasts 1 s, more than 16777216 frames at 1e300 a second; ask",
        ),
        (
            "check moves.gltf --fps 1e300",
            " a second; ask for fewer with `--fps`\n",
        ),
        (
            "check moves.gltf+three.pc2",
            "has 31 frames; the mesh beside positions must have one; write it to a file with \
             `pliant convert --frames 0`\n",
        ),
        ("check still.gltf --fps 0", "write a number above 0"),
        ("check still.gltf --fps -1", "write a number above 0"),
        ("convert still.gltf x.obj", "name one: 'still.gltf#arm'"),
        (
            "convert still.gltf#arm x.obj --clip Run",
            "leave out `--clip`",
        ),
        (
            "convert still.gltf#arm a.obj",
            "a.obj: exists already; choose another name, or use `--force` to write over it\n",
        ),
        ("convert still.gltf#arm no/x.obj", "make it first"),
        ("convert still.gltf#arm x.glb", "these can: a mesh (.obj"),
        (
            "convert s_*.obj x.obj",
            "this format holds one frame a file, but 3 are to be written; name a file a frame \
             ('name_%04d.obj'), or choose one with `--frames`\n",
        ),
        (
            "convert s_*.obj x.obj --frames 9",
            "there are frames 0 to 2",
        ),
        (
            "convert s_*.obj x.obj --frames 3..1",
            "write the first frame, and the one behind the last",
        ),
        (
            "convert s_*.obj x.obj --frames -1",
            "write frames as 10..20",
        ),
        ("convert a.obj x.pc2", "'mesh.obj+x.pc2'"),
        ("convert a.obj x.stl+y.pc2", "is written as .obj or .ply"),
    ]);
}

#[test]
fn where_nothing_can_be_written_another_place_is_advised() {
    // Nobody may make files there.
    let nowhere = Path::new("/sys");
    if !cfg!(target_os = "linux") || !nowhere.is_dir() {
        eprintln!("skipped: no place known where files cannot be written");
        return;
    }
    let said = in_folder(&["convert", "a.obj", "/sys/x.obj"]);
    said.assert_refused(&[
        "/sys/x.obj: cannot be written",
        "choose a place where you may write",
    ]);
}

#[test]
fn quiet_is_quiet() {
    for line in [
        "run --steps 2 --quiet",
        "run --steps 2 -q --format json",
        "check a.obj --quiet",
        "convert a.obj b.stl --quiet",
        "bench degrees --small --rounds 1 --quiet",
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
