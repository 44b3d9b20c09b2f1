//! Impacts between frames: exact times, borders of groups, triangles without area, changing meshes,
//! limits, interruptions, refusals.

use pliant_check::{
    Baseline, Check, Error, FirstImpact, Frames, Impact, Interval, Settings, Split,
};
use pliant_io::OpenOptions;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use tempfile::TempDir;

fn folder(files: &[(&str, String)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn open(folder: &Path, bodies: &[&str], settings: &Settings) -> Result<Check, Error> {
    let arguments = bodies
        .iter()
        .map(|name| folder.join(name).display().to_string());
    Check::open(
        &arguments.collect::<Vec<_>>(),
        &OpenOptions::default(),
        settings,
    )
}

/// All intervals of a check.
fn intervals(folder: &Path, bodies: &[&str], settings: &Settings) -> Vec<Interval> {
    let mut check = open(folder, bodies, settings).unwrap();
    let mut all = Vec::new();
    while check.next_frame().unwrap().is_some() {
        all.extend(check.next_interval().unwrap());
    }
    all
}

fn swept() -> Settings {
    Settings {
        swept: true,
        ..Settings::default()
    }
}

/// A large triangle in the plane z = 0.
fn floor() -> String {
    "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n".to_owned()
}

/// A triangle whose lowest corner is at this height, and the others five above it.
fn leaf(height: f64) -> String {
    let above = height + 5.0;
    format!("v 0 0 {height}\nv 1 0 {above}\nv 0 1 {above}\nf 1 2 3\n")
}

fn leaves(heights: &[f64]) -> Vec<(String, String)> {
    let leaves = heights.iter().enumerate();
    leaves
        .map(|(frame, &height)| (format!("leaf_{frame}.obj"), leaf(height)))
        .collect()
}

fn with_floor(heights: &[f64]) -> TempDir {
    let leaves = leaves(heights);
    let mut files: Vec<(&str, String)> = leaves
        .iter()
        .map(|(name, text)| (name.as_str(), text.clone()))
        .collect();
    files.push(("floor.obj", floor()));
    folder(&files)
}

#[test]
fn times_are_exact_and_what_touches_in_a_frame_is_news_once() {
    // The leaf jumps, touches the floor from above exactly in frame 2, and goes on.
    let folder = with_floor(&[3.0, 1.0, 0.0, -3.0]);
    let found = intervals(folder.path(), &["leaf_*.obj", "floor.obj"], &swept());
    let facts = |it: &Interval| (it.frame, it.until, it.count, it.at_start);
    let facts: Vec<_> = found.iter().map(facts).collect();
    // The leaf's edges meet no edge of the floor, and its lowest corner is the one vertex on the
    // floor in frame 2.
    assert_eq!(facts, [(0, 1, 0, 0), (1, 2, 1, 0), (2, 3, 0, 1)]);
    let low = 1.0 - 0.5_f64.powi(20);
    let impact = Impact {
        pair: [0, 0, 1, 0],
        low,
        high: 1.0,
    };
    assert_eq!(found[1].vertex_triangle, [impact]);
    assert_eq!(found[1].first, Some(FirstImpact::VertexTriangle(impact)));
    assert_eq!((&found[0].first, &found[2].first), (&None, &None));
}

#[test]
fn the_first_is_the_first_to_the_last_bit() {
    // Each corner is a little lower than the one before: all meet the floor within a millionth of
    // the way.
    let corners = |by: f64| {
        let heights = [0.0, 1e-9, 2e-9].map(|lower| 3.0 - by - lower);
        let [a, b, c] = heights;
        format!("v 0 0 {a}\nv 1 0 {b}\nv 0 1 {c}\nf 1 2 3\n")
    };
    let folder = folder(&[
        ("leaf_0.obj", corners(0.0)),
        ("leaf_1.obj", corners(10.0)),
        ("floor.obj", floor()),
    ]);
    let bodies = ["leaf_*.obj", "floor.obj"];
    for (first, listed, split) in [
        (false, true, None),
        (false, false, None),
        (true, true, None),
        // Pieces need all impacts, since the world alone does not know pieces.
        (true, true, Some(Split::Components)),
    ] {
        let settings = Settings {
            first,
            listed,
            split,
            ..swept()
        };
        let found = intervals(folder.path(), &bodies, &settings);
        assert!(
            matches!(
                &found[0].first,
                Some(FirstImpact::VertexTriangle(Impact { pair: [0, 2, 1, 0], low, high }))
                    if *low < 0.3 && 0.3 < *high && high - low <= 1e-6
            ),
            "{found:?}"
        );
        assert_eq!(found[0].count, if first { 1 } else { 3 });
        let all = &found[0].vertex_triangle;
        assert!(all.iter().all(|it| it.high == all[0].high));
    }
}

#[test]
fn intervals_go_from_a_frame_that_is_checked_to_the_next() {
    let folder = with_floor(&[3.0, -7.0, 2.0, 1.0, -8.0]);
    let of = |start, step, count| {
        let frames = Some(Frames { start, step, count });
        let settings = Settings { frames, ..swept() };
        let found = intervals(folder.path(), &["leaf_*.obj", "floor.obj"], &settings);
        let facts = found.iter().map(|it| {
            let time = it.first.map(|first| (first.time() * 1e4).round());
            (it.frame, it.until, it.count, time)
        });
        facts.collect::<Vec<_>>()
    };
    // The lowest corner meets the plane first. Where the leaf passes through, all three corners do.
    let all = [
        (0, 1, 3, Some(3000.0)),
        (1, 2, 3, Some(2222.0)),
        (2, 3, 0, None),
        (3, 4, 3, Some(1111.0)),
    ];
    assert_eq!(of(0, 1, 5), all);
    // Skipped frames are not on the way.
    assert_eq!(of(0, 2, 3), [(0, 2, 0, None), (2, 4, 3, Some(2000.0))]);
    assert_eq!(of(1, 3, 2), [(1, 4, 0, None)]);
}

/// Two triangles of two groups with a common edge, at height z.
fn two_groups(z: f64) -> String {
    format!("v 0 0 {z}\nv 2 0 {z}\nv 0 2 {z}\nv 2 2 {z}\ng a\nf 1 2 3\ng b\nf 4 3 2\n")
}

#[test]
fn what_lies_between_two_bodies_is_of_both() {
    // The common edge sinks through the tip of a needle, which meets no other part of the two.
    let needle = "v 0.75 1.25 0\nv 0.75 1.25 -9\nv 1.25 0.75 -9\nv 1.25 0.75 0\nf 1 2 3\nf 1 3 4\n";
    let folder = folder(&[
        ("cloth_0.obj", two_groups(1.0)),
        ("cloth_1.obj", two_groups(-1.0)),
        ("needle.obj", needle.to_owned()),
    ]);
    let of = |ignore: &[&str]| {
        let ignore = ignore
            .iter()
            .map(|name| [format!("cloth_*.obj#{name}"), "needle.obj".to_owned()]);
        let settings = Settings {
            split: Some(Split::Groups),
            ignore: ignore.collect(),
            ..swept()
        };
        let found = intervals(folder.path(), &["cloth_*.obj", "needle.obj"], &settings);
        let [found] = &found[..] else {
            panic!("{found:?}")
        };
        let vertices: Vec<_> = found.vertex_triangle.iter().map(|it| it.pair).collect();
        let edges: Vec<_> = found.edge_edge.iter().map(|it| it.pair).collect();
        (vertices, edges)
    };
    // Bodies 0 and 1 are the groups. Body 2 is needle.obj, whose vertices 0 and 3 lie below the
    // edge from 1 to 2.
    let (vertices, edges) = of(&[]);
    assert_eq!(
        vertices,
        [[2, 0, 0, 0], [2, 0, 1, 1], [2, 3, 0, 0], [2, 3, 1, 1]]
    );
    assert!(!edges.is_empty() && edges.iter().all(|edge| edge[..3] == [0, 1, 2]));
    // If one of the two may not meet the needle, the edge counts for the other.
    let (vertices, of_b) = of(&["a"]);
    assert_eq!(vertices, [[2, 0, 1, 1], [2, 3, 1, 1]]);
    let all: Vec<_> = edges
        .iter()
        .map(|&[_, a, b, other, c, d]| [1, a, b, other, c, d])
        .collect();
    assert_eq!(of_b, all);
    assert_eq!(of(&["a", "b"]), (vec![], vec![]));
}

#[test]
fn triangles_without_area_are_left_out_with_what_is_theirs_alone() {
    // A segment as a triangle, which shares its upper end with a leaf; and a leaf that is flat in
    // the first frame only.
    let text = |z: f64, width: f64| {
        let above = z + 5.0;
        format!(
            "v 0 0 {z}\nv 1 0 {above}\nv 0 1 {above}\nv 0 0 {}\nf 1 2 3\nf 1 4 4\n\
             v 3 0 {z}\nv 3 {width} {z}\nv 3 {width} {z}\nf 5 6 7\n",
            z - 0.5
        )
    };
    let folder = folder(&[
        ("leaf_0.obj", text(1.0, 0.0)),
        (
            "leaf_1.obj",
            text(-1.0, 0.0).replace(
                "v 3 0 -1\nv 3 0 -1\nv 3 0 -1",
                "v 3 0 -1\nv 4 0 -1\nv 3 1 -1",
            ),
        ),
        ("floor.obj", floor()),
    ]);
    let vertices = |skip_degenerate| -> Vec<[u32; 4]> {
        let settings = Settings {
            skip_degenerate,
            ..swept()
        };
        let found = intervals(folder.path(), &["leaf_*.obj", "floor.obj"], &settings);
        found[0].vertex_triangle.iter().map(|it| it.pair).collect()
    };
    let of =
        |vertices: &[u32]| -> Vec<[u32; 4]> { vertices.iter().map(|&it| [0, it, 1, 0]).collect() };
    assert_eq!(vertices(false), of(&[0, 3, 4, 5, 6]));
    assert_eq!(vertices(true), of(&[0, 4, 5, 6]));
}

#[test]
fn where_a_mesh_changes_nothing_moves() {
    let other = |height| leaf(height) + "f 3 2 1\n";
    let folder = folder(&[
        ("leaf_0.obj", leaf(1.0)),
        ("leaf_1.obj", leaf(-1.0)),
        ("leaf_2.obj", other(-9.0)),
        ("leaf_3.obj", other(9.0)),
        ("leaf_4.obj", leaf(4.0)),
        ("leaf_5.obj", leaf(-9.0)),
        ("floor.obj", floor()),
    ]);
    let bodies = ["floor.obj", "leaf_*.obj"];
    let found = intervals(folder.path(), &bodies, &swept());
    let facts = |it: &Interval| (it.frame, it.changed.clone(), it.count > 0);
    let facts: Vec<_> = found.iter().map(facts).collect();
    let changed = vec![1];
    assert_eq!(
        facts,
        [
            (0, vec![], true),
            (1, changed.clone(), false),
            (2, vec![], true),
            (3, changed, false),
            (4, vec![], true)
        ]
    );
    // Frames have equal results without motions, whether intervals are asked for or not.
    let frames = |settings: &Settings, asked: bool| {
        let mut check = open(folder.path(), &bodies, settings).unwrap();
        let mut all = Vec::new();
        while let Some(found) = check.next_frame().unwrap() {
            all.push(found);
            if asked {
                check.next_interval().unwrap();
            }
        }
        all
    };
    let expected = frames(&Settings::default(), false);
    assert_eq!(
        expected.iter().map(|it| it.count).collect::<Vec<_>>(),
        [0, 1, 0, 0, 0, 0]
    );
    assert_eq!(frames(&swept(), true), expected);
    assert_eq!(frames(&swept(), false), expected);
}

#[test]
fn an_interrupted_interval_can_be_asked_for_again() {
    let folder = with_floor(&[3.0, -7.0, 1.0]);
    let bodies = ["leaf_*.obj", "floor.obj"];
    for first in [false, true] {
        let settings = Settings { first, ..swept() };
        let expected = intervals(folder.path(), &bodies, &settings);
        let mut check = open(folder.path(), &bodies, &settings).unwrap();
        let mut found = Vec::new();
        let mut interrupted = 0;
        while check.next_frame().unwrap().is_some() {
            for patience in 0.. {
                let asked = AtomicU32::new(0);
                let stop = || asked.fetch_add(1, Ordering::Relaxed) >= patience;
                match check.next_interval_unless(Some(&stop)) {
                    Ok(interval) => {
                        found.extend(interval);
                        break;
                    }
                    Err(Error::Interrupted { frame }) => {
                        assert_eq!(frame, found.len());
                        interrupted += 1;
                    }
                    Err(other) => panic!("{other}"),
                }
            }
        }
        assert_eq!(found, expected);
        assert!(interrupted >= 2, "{interrupted}");
    }
}

#[test]
fn lists_have_a_limit() {
    let folder = with_floor(&[3.0, -7.0]);
    let bodies = ["leaf_*.obj", "floor.obj"];
    let of = |max_list, listed| {
        let settings = Settings {
            max_list,
            listed,
            ..swept()
        };
        let mut check = open(folder.path(), &bodies, &settings).unwrap();
        check.next_frame().unwrap();
        let found = check.next_interval();
        if found.is_err() {
            assert!(matches!(
                check.next_frame(),
                Err(Error::AfterError { frame: 1, .. })
            ));
        }
        found.map(|it| it.unwrap().count)
    };
    // Three impacts, one for each corner.
    assert_eq!(of(120, true).unwrap(), 3);
    assert_eq!(of(0, false).unwrap(), 3);
    let error = of(119, true).unwrap_err();
    assert!(matches!(
        error,
        Error::TooManyImpacts {
            frame: 0,
            until: 1,
            most: 2
        }
    ));
    assert_eq!(
        error.to_string(),
        "from frame 0 to frame 1: more than 2 pairs of elements meet, the most that a list holds \
         in the memory that is allowed"
    );
}

#[test]
fn what_has_no_way_is_refused() {
    let folder = with_floor(&[3.0, -7.0]);
    let bodies = ["leaf_*.obj", "floor.obj"];
    let refused =
        |bodies: &[&str], settings: &Settings| open(folder.path(), bodies, settings).err().unwrap();
    assert!(matches!(
        refused(&["floor.obj"], &swept()),
        Error::SweptOneFrame { count: 1 }
    ));
    let one = Frames {
        start: 1,
        step: 1,
        count: 1,
    };
    let settings = Settings {
        frames: Some(one),
        ..swept()
    };
    assert!(matches!(
        refused(&bodies, &settings),
        Error::SweptOneFrame { count: 1 }
    ));
    let none = Frames { count: 0, ..one };
    let settings = Settings {
        frames: Some(none),
        ..swept()
    };
    assert_eq!(
        refused(&bodies, &settings).to_string(),
        "what meets on the way from frame to frame needs at least two frames, and none is to be \
         checked"
    );
    let settings = Settings {
        within: Some(1.0),
        ..swept()
    };
    assert!(matches!(refused(&bodies, &settings), Error::SweptWithin));
    let settings = Settings {
        baseline: Some(Baseline::Frame(0)),
        ..swept()
    };
    assert!(matches!(refused(&bodies, &settings), Error::SweptBaseline));
    // No interval without the setting.
    let mut check = open(folder.path(), &bodies, &Settings::default()).unwrap();
    check.next_frame().unwrap();
    assert!(check.next_interval().unwrap().is_none());
}
