//! Groups of OBJ files, as they are read and as bodies of their own.

use std::collections::BTreeMap;

use crate::common::{Folder, all_frames};
use pliant_io::{OpenOptions, Reason, open};

/// Two squares side by side, with vertices of their own along the common edge, and an unnamed
/// triangle.
///
/// The right square is a concave polygon.
const TEXT: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 1.1 0.1 0\nv 1 1 0\n\
    f 1 3 4\no left\nf 1 2 3\no right\ng 1\nf 6 7 8 5\n";

#[test]
fn a_group_is_a_body() {
    let folder = Folder::new();
    folder.write("two.obj", TEXT);
    let options = OpenOptions::default();
    let whole = open(&folder.argument("two.obj"), &options).unwrap();
    assert!(!whole.is_part());
    assert_eq!(whole.welded(), 2);
    let groups = whole.groups().unwrap();
    assert_eq!(groups.names, ["default", "left", "right/1"]);
    assert_eq!(groups.of_triangles, [0, 1, 2, 2]);
    let outline = vec![5, 6, 2, 1];
    assert_eq!(whole.outlines(), BTreeMap::from([(2, outline.clone())]));

    let argument = folder.argument("two.obj#right");
    let mut right = open(&argument, &options).unwrap();
    assert!(right.is_part());
    assert_eq!((right.name(), right.argument()), (&*argument, &*argument));
    assert_eq!(right.triangles(), &whole.triangles()[2..]);
    assert_eq!(right.faces(), Some(&[0, 0][..]));
    assert_eq!(right.outlines(), BTreeMap::from([(0, outline)]));
    assert_eq!(all_frames(&mut right).unwrap()[0].len(), 8);
    let left = open(&folder.argument("two.obj#left"), &options).unwrap();
    assert_eq!(left.triangles(), &whole.triangles()[1..2]);
    assert_eq!(left.faces(), Some(&[0][..]));
    assert!(left.outlines().is_empty());
}

#[test]
fn a_group_of_a_sequence_is_that_of_its_first_file() {
    let folder = Folder::new();
    for frame in 0..3 {
        // Only the first file names anything.
        let text = if frame == 0 {
            TEXT.to_owned()
        } else {
            TEXT.replace("o left", "o other")
        };
        folder.write(&format!("walk_{frame}.obj"), text);
    }
    let options = OpenOptions::default();
    let mut left = open(&folder.argument("walk_*.obj#left"), &options).unwrap();
    assert_eq!((left.frame_count(), left.triangles().len()), (3, 1));
    assert_eq!(all_frames(&mut left).unwrap().len(), 3);
    // The mesh of a group does not change, even if that is allowed.
    folder.write("walk_2.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    let mut left = open(&folder.argument("walk_*.obj#left"), &options).unwrap();
    left.let_mesh_change();
    let error = all_frames(&mut left).unwrap_err();
    assert!(
        matches!(error.reason(), Reason::FacesDiffer { .. }),
        "{error}"
    );
}

#[test]
fn other_files_have_none() {
    let folder = Folder::new();
    folder.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    folder.write("two.obj", TEXT);
    // A single solid without a name.
    let soup = "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n\
        endloop\nendfacet\nendsolid\n";
    folder.write("a.stl", soup);
    let options = OpenOptions::default();
    for name in ["plain.obj", "a.stl"] {
        let body = open(&folder.argument(name), &options).unwrap();
        let groups = body.groups().unwrap();
        assert!(groups.names.is_empty() && groups.of_triangles.is_empty());
        let refused = open(&folder.argument(&format!("{name}#o")), &options).unwrap_err();
        assert!(refused.to_string().contains("holds one body"), "{refused}");
    }
    for (name, words) in [
        (
            "two.obj#",
            "has no body \"\"; it has: default, left, right/1",
        ),
        ("gone.obj#left", "no such file"),
        ("gone_*.obj#left", "no file matches"),
    ] {
        let refused = open(&folder.argument(name), &options).unwrap_err();
        assert!(refused.to_string().contains(words), "{refused}");
    }
}

#[test]
fn positions_beside_a_mesh_move_its_groups() {
    let folder = Folder::new();
    folder.write("two.obj", TEXT);
    let mut cache = b"POINTCACHE2\0\x01\0\0\0".to_vec();
    cache.extend([8_u32, 0, 0, 2].map(u32::to_le_bytes).concat());
    for x in 0..2 * 8 * 3 {
        cache.extend((x as f32).to_le_bytes());
    }
    folder.write("two.pc2", cache);
    let options = OpenOptions {
        weld: false,
        ..OpenOptions::default()
    };
    let argument = format!(
        "{}+{}",
        folder.argument("two.obj"),
        folder.argument("two.pc2")
    );
    let body = open(&argument, &options).unwrap();
    assert_eq!(body.groups().unwrap().names, ["default", "left", "right/1"]);
}

#[test]
fn a_file_that_is_another_one_now_has_no_groups_to_tell() {
    let folder = Folder::new();
    folder.write("two.obj", TEXT);
    let body = open(&folder.argument("two.obj"), &OpenOptions::default()).unwrap();
    folder.write("two.obj", TEXT.to_owned() + "f 1 2 3\n");
    let error = body.groups().unwrap_err();
    assert!(matches!(error.reason(), Reason::Changed), "{error}");
}

#[test]
fn names_are_within_the_memory_that_a_frame_may_take() {
    let folder = Folder::new();
    let group = |n: u32| format!("g {n}\nf 1 2 3\n");
    let names = (0..1000).map(group).collect::<Vec<_>>().concat();
    folder.write(
        "many.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\n".to_owned() + &names,
    );
    let within = |max_memory| {
        let options = OpenOptions {
            max_memory,
            ..OpenOptions::default()
        };
        open(&folder.argument("many.obj"), &options)
    };
    let body = within(60_000).unwrap();
    let error = body.groups().unwrap_err();
    assert!(matches!(error.reason(), Reason::TooLarge { .. }), "{error}");
    assert_eq!(within(1 << 20).unwrap().groups().unwrap().names.len(), 1000);
}
