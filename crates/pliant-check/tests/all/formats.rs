//! Equal answers for equal meshes in any format: bodies of glTF files against the same bodies as
//! sequences.

use pliant_check::{Baseline, Check, Error, Found, Frames, Group, Settings, Split};
use pliant_io::{Body, OpenOptions, Shape, WriteOptions, Writer};
use std::path::Path;
use tempfile::TempDir;

/// A scene of four bodies: three that a clip moves, and one that stands still.
const SCENE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../pliant-io/tests/fixtures/hierarchy.gltf"
);
const BODIES: u32 = 4;

fn reading() -> OpenOptions {
    OpenOptions {
        weld: false,
        clip: Some("turn".to_owned()),
        fps: 10.0,
        ..OpenOptions::default()
    }
}

/// Writes each body of the scene as a sequence of its own.
fn sequences() -> (TempDir, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let bodies = pliant_io::open_all(SCENE, &reading()).unwrap();
    let write = |(number, body)| write(folder.path(), number, body);
    let names = bodies.into_iter().enumerate().map(write).collect();
    (folder, names)
}

fn write(folder: &Path, number: usize, mut body: Body) -> String {
    let name = folder.join(format!("{number}.npz")).display().to_string();
    let shape = Shape {
        triangles: body.triangles().to_vec(),
        faces: None,
        outlines: std::collections::BTreeMap::new(),
        vertex_count: body.vertex_count(),
        frame_count: body.frame_count(),
        precision: body.precision(),
    };
    let mut writer = Writer::create(&name, shape, WriteOptions::default()).unwrap();
    while let Some(positions) = body.next_frame().unwrap() {
        writer.frame(positions).unwrap();
    }
    writer.finish().unwrap();
    name
}

fn all(mut check: Check) -> Vec<Found> {
    std::iter::from_fn(|| check.next_frame().unwrap()).collect()
}

#[test]
fn bodies_of_a_scene_are_checked_like_sequences() {
    let (_folder, sequences) = sequences();
    let as_they_are = OpenOptions {
        weld: false,
        ..OpenOptions::default()
    };
    let two = |a: u32, b: u32| [a.to_string(), b.to_string()];
    let every = Settings {
        itself: true,
        ..Settings::default()
    };
    let frame_count = Check::open(&sequences, &as_they_are, &every)
        .unwrap()
        .frame_count();
    let frames = Frames {
        start: frame_count - 2,
        step: 1,
        count: 2,
    };
    let mut asked = vec![
        every.clone(),
        Settings {
            baseline: Some(Baseline::Frame(frame_count / 2)),
            ..every.clone()
        },
        Settings {
            baseline: Some(Baseline::Frame(frame_count - 1)),
            frames: Some(frames),
            ..every.clone()
        },
        Settings {
            baseline: Some(Baseline::Frame(1)),
            frames: Some(frames),
            split: Some(Split::Components),
            ..every.clone()
        },
        Settings {
            split: Some(Split::Components),
            ignore: vec![two(0, 1)],
            ..every.clone()
        },
    ];
    asked.extend((0..BODIES).map(|body| Settings {
        ignore: vec![two(body, (body + 1) % BODIES)],
        ..every.clone()
    }));
    let mut answers = Vec::new();
    for settings in asked {
        let scene = Check::open(&[SCENE.to_owned()], &reading(), &settings).unwrap();
        let same = Check::open(&sequences, &as_they_are, &settings).unwrap();
        assert_eq!(scene.body_count(), same.body_count());
        let found = all(scene);
        assert_eq!(found, all(same), "{settings:?}");
        answers.push(found.iter().map(|found| found.count).collect::<Vec<_>>());
    }
    // The settings make a difference.
    assert!(
        answers[0].iter().any(|&count| count > 0) && answers[0] != answers[1],
        "{answers:?}"
    );
}

#[test]
fn names_of_a_scene_and_of_its_bodies() {
    let check = |groups: &[(&str, &[&str])], ignore: [&str; 2], split| {
        let group = |&(name, bodies): &(&str, &[&str])| Group {
            name: name.to_owned(),
            bodies: bodies.iter().map(|body| format!("{SCENE}{body}")).collect(),
        };
        let settings = Settings {
            itself: true,
            groups: groups.iter().map(group).collect(),
            ignore: vec![ignore.map(str::to_owned)],
            split,
            ..Settings::default()
        };
        Check::open(&[SCENE.to_owned()], &reading(), &settings).map(all)
    };
    let by_number = |a: u32, b: u32| check(&[], [&a.to_string(), &b.to_string()], None).unwrap();
    let [arm, ground] = ["arm (node 3)", "ground"].map(|body| format!("{SCENE}#{body}"));
    assert_eq!(check(&[], [&arm, &ground], None).unwrap(), by_number(1, 3));
    let group: (&str, &[&str]) = ("g", &["#arm (node 3)"]);
    assert_eq!(
        check(&[group], ["g", &ground], None).unwrap(),
        by_number(1, 3)
    );
    // The file stands for all its bodies, alone and in a group, and for all their pieces.
    for split in [None, Some(Split::Components)] {
        for (groups, ignore) in [(&[][..], [SCENE; 2]), (&[("g", &[""][..])], ["g"; 2])] {
            let left = check(groups, ignore, split).unwrap();
            assert!(left.iter().all(|found| found.count == 0), "{left:?}");
        }
    }
    let pieces = check(&[], [&format!("{ground}#1"), &arm], Some(Split::Components));
    assert!(pieces.is_ok());
    let refused = check(&[], [&format!("{SCENE}#1"), &arm], Some(Split::Components));
    assert!(
        matches!(refused, Err(Error::NoSuchName { .. })),
        "the scene has no pieces, its bodies have"
    );
}

#[test]
fn a_clip_of_what_has_none_is_refused() {
    let (_folder, sequences) = sequences();
    let refused = Check::open(&sequences, &reading(), &Settings::default()).err();
    assert!(matches!(refused, Some(Error::NoClip)), "{refused:?}");
    // One body with the clip is enough.
    let both = [SCENE.to_owned(), sequences[3].clone()];
    assert_eq!(
        Check::open(&both, &reading(), &Settings::default())
            .unwrap()
            .body_count(),
        5
    );
    // A file of the same format without any clip stands still.
    let folder = tempfile::tempdir().unwrap();
    let still = folder.path().join("still.gltf").display().to_string();
    let data = "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let text = format!(
        r#"{{"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"{data}"}}]}}"#
    );
    std::fs::write(&still, text).unwrap();
    let alone = Check::open(
        std::slice::from_ref(&still),
        &reading(),
        &Settings::default(),
    );
    assert!(matches!(alone.err(), Some(Error::NoClip)));
    let both = Check::open(&[still, SCENE.to_owned()], &reading(), &Settings::default());
    assert_eq!(both.unwrap().body_count(), 5);
}
