//! Two runs of one command print the same bytes, except times.

use crate::common::{Said, pliant};
use std::fs;
use std::path::Path;

/// JSON members that are times, as lists of one number a step.
const TIMES: [&str; 2] = ["\"update_ms\":", "\"query_ms\":"];

/// The text with its lists of times emptied; they must be there.
fn without_times(text: &str) -> String {
    let mut text = text.to_owned();
    for name in TIMES {
        let start = text
            .find(name)
            .unwrap_or_else(|| panic!("no {name} in {text}"))
            + name.len();
        let end = start + text[start..].find(']').unwrap();
        let list = text[start..end].trim_start();
        assert!(
            list.starts_with('[') && list[1..].chars().all(|c| "0123456789.e-, \n".contains(c))
        );
        text.replace_range(start..=end, "[]");
    }
    text
}

/// Runs a command twice. Fails unless both runs print the same, and something.
fn twice(folder: &Path, arguments: &[&str], keep: impl Fn(&str) -> String) -> String {
    let [one, two]: [Said; 2] = [(); 2].map(|()| pliant(folder, arguments));
    assert_eq!((one.code, &one.err), (two.code, &two.err), "{arguments:?}");
    assert_eq!(keep(&one.out), keep(&two.out), "{arguments:?}");
    assert!(
        one.code < 2 && one.out.len() > 50,
        "{arguments:?}: {}",
        one.err
    );
    one.out
}

#[test]
fn a_run_says_the_same_twice() {
    for (scene, more) in [
        ("spheres", &[][..]),
        ("crowd", &["--precision", "f64", "--degree", "4"]),
        ("gather", &["--broad", "sweep", "--query", "first"]),
        (
            "cloth",
            &["--partition", "connectivity", "--update", "top-down"],
        ),
    ] {
        let triangles = if scene == "cloth" { "648" } else { "320" };
        let arguments = [
            "run",
            scene,
            "--triangles",
            triangles,
            "--stride",
            "10",
            "--format",
            "json",
        ];
        let said = twice(Path::new("."), &[&arguments, more].concat(), without_times);
        assert!(said.contains("\"first_contact\""));
    }
}

/// A grid of `side` by `side` vertices as an OBJ file, bent so that it meets itself and others.
fn bent(side: usize, phase: f64) -> String {
    let vertex = |i: usize| {
        let z = ((i * 7919 + 13) % 101) as f64 / 50.0 + phase;
        format!("v {} {} {z}\n", i % side, i / side)
    };
    // Vertices are counted from 1.
    let face = |i: usize| {
        let corner = i / (side - 1) * side + i % (side - 1) + 1;
        let above = corner + side;
        format!("f {corner} {} {} {above}\n", corner + 1, above + 1)
    };
    let vertices = (0..side * side).map(vertex);
    vertices
        .chain((0..(side - 1) * (side - 1)).map(face))
        .collect()
}

#[test]
fn a_check_says_the_same_twice() {
    let folder = tempfile::tempdir().unwrap();
    for frame in 0..3 {
        let path = folder.path();
        fs::write(path.join(format!("a_{frame}.obj")), bent(20, 0.0)).unwrap();
        fs::write(
            path.join(format!("b_{frame}.obj")),
            bent(15, f64::from(frame)),
        )
        .unwrap();
    }
    for more in [
        &["a_0.obj"][..],
        &["a_*.obj", "b_*.obj"],
        &["a_*.obj", "b_*.obj", "--self"],
        &["a_*.obj", "b_*.obj", "--first"],
        &["a_*.obj", "b_*.obj", "--count"],
    ] {
        for format in ["json", "table"] {
            let arguments = [&["check", "--format", format], more].concat();
            // Nothing in it is a time: every byte is the same.
            let said = twice(folder.path(), &arguments, str::to_owned);
            assert!(format == "table" || said.contains("\"frame\":0"), "{said}");
        }
    }
}
