//! Settings of a check: ranges of frames, names, and refusals.

use pliant_check::{Baseline, Check, Error, Frames, Group, Settings, Split};
use pliant_io::OpenOptions;
use std::fs;
use std::sync::atomic::{AtomicU32, Ordering};
use tempfile::TempDir;

/// Three bodies that all meet in frame 0 and move apart: two sequences of six frames, and one that
/// stands still.
fn folder() -> (TempDir, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for frame in 0..6 {
        for (name, x) in [("a", frame), ("b", 3 * frame)] {
            let text = format!("v {x} 0 -1\nv {x} 0 1\nv {x} 2 1\nf 1 2 3\n");
            fs::write(path.join(format!("{name}{frame}.obj")), text).unwrap();
        }
    }
    fs::write(path.join("c.obj"), "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n").unwrap();
    let names = ["a*.obj", "b*.obj", "c.obj"];
    let arguments = names.map(|name| path.join(name).display().to_string());
    (folder, arguments.into())
}

fn counts(arguments: &[String], settings: &Settings) -> Result<Vec<(usize, usize)>, Error> {
    let mut check = Check::open(arguments, &OpenOptions::default(), settings)?;
    let mut counts = Vec::new();
    while let Some(found) = check.next_frame()? {
        counts.push((found.frame, found.count));
    }
    Ok(counts)
}

#[test]
fn frames_are_those_of_the_range_whatever_the_baseline() {
    let (_folder, arguments) = folder();
    let all = counts(&arguments, &Settings::default()).unwrap();
    assert_eq!(all, [(0, 3), (1, 2), (2, 1), (3, 1), (4, 1), (5, 0)]);
    for start in 0..6 {
        for step in 1..4 {
            let frames: Vec<_> = (start..6).step_by(step).collect();
            let settings = |baseline: Option<usize>| Settings {
                frames: Some(Frames {
                    start,
                    step,
                    count: frames.len(),
                }),
                baseline: baseline.map(Baseline::Frame),
                ..Settings::default()
            };
            let some: Vec<_> = frames.iter().map(|&frame| all[frame]).collect();
            assert_eq!(counts(&arguments, &settings(None)).unwrap(), some);
            // All frames from `start` on, however many there are.
            let mut open_end = settings(None);
            let range = open_end.frames.as_mut().unwrap();
            range.count = usize::MAX;
            assert_eq!(counts(&arguments, &open_end).unwrap(), some);
            let reading = OpenOptions::default();
            let mut check = Check::open(&arguments, &reading, &open_end).unwrap();
            assert!(check.frames().eq(frames.iter().copied()));
            check.next_frame().unwrap();
            assert!(check.frames().eq(frames.iter().copied().skip(1)));
            // Frame 1 has all pairs in which `c` takes part.
            for baseline in [1, 5] {
                let some = some.iter().map(|&(frame, count)| match baseline {
                    1 if frame == 0 => (frame, 1),
                    1 => (frame, 0),
                    _ => (frame, count),
                });
                let some: Vec<_> = some.collect();
                assert_eq!(counts(&arguments, &settings(Some(baseline))).unwrap(), some);
            }
        }
    }
    let behind = Frames {
        start: 6,
        step: 1,
        count: usize::MAX,
    };
    let settings = Settings {
        frames: Some(behind),
        ..Settings::default()
    };
    let refused = counts(&arguments, &settings).unwrap_err();
    assert!(matches!(
        refused,
        Error::NoSuchFrame {
            frame: 6,
            last: 5,
            ..
        }
    ));
    let none = Frames {
        start: 9,
        step: 1,
        count: 0,
    };
    let settings = Settings {
        frames: Some(none),
        ..Settings::default()
    };
    assert_eq!(counts(&arguments, &settings).unwrap(), []);
}

/// An interruption at any moment loses nothing: the next call checks the same frame.
#[test]
fn an_interrupted_frame_can_be_asked_for_again() {
    let (_folder, arguments) = folder();
    for (baseline, first) in [
        (None, false),
        (None, true),
        (Some(5), false),
        (Some(5), true),
    ] {
        let settings = Settings {
            baseline: baseline.map(Baseline::Frame),
            first,
            ..Settings::default()
        };
        let expected = counts(&arguments, &settings).unwrap();
        let open = || Check::open(&arguments, &OpenOptions::default(), &settings).unwrap();
        let mut interrupted = 0;
        for looks in 0..100 {
            let mut check = open();
            let looked = AtomicU32::new(0);
            let stop = || looked.fetch_add(1, Ordering::Relaxed) >= looks;
            let mut found = Vec::new();
            loop {
                let frame = match check.next_frame_unless(Some(&stop)) {
                    Err(Error::Interrupted { frame }) => {
                        assert!(frame == found.len() || baseline == Some(frame));
                        interrupted += 1;
                        check.next_frame()
                    }
                    other => other,
                };
                let Some(frame) = frame.unwrap() else { break };
                found.push((frame.frame, frame.count));
            }
            assert_eq!(found, expected, "{looks}");
        }
        assert!(interrupted > 100, "{interrupted}");
    }
}

#[test]
fn positions_are_those_of_the_frame_checked_last() {
    let (_folder, arguments) = folder();
    let settings = Settings {
        baseline: Some(Baseline::Frame(4)),
        ..Settings::default()
    };
    let mut check = Check::open(&arguments, &OpenOptions::default(), &settings).unwrap();
    while let Some(found) = check.next_frame().unwrap() {
        let x = |source: usize| check.sources()[source].positions().get(0)[0];
        let frame = found.frame as f64;
        assert_eq!([x(0), x(1), x(2)], [frame, 3.0 * frame, 0.0]);
    }
}

#[test]
fn each_frame_may_be_asked_for_something_else() {
    let (_folder, arguments) = folder();
    let reading = OpenOptions::default();
    let mut check = Check::open(&arguments, &reading, &Settings::default()).unwrap();
    let all: Vec<_> = std::iter::from_fn(|| check.next_frame().unwrap()).collect();
    let mut check = Check::open(&arguments, &reading, &Settings::default()).unwrap();
    for (first, listed, all) in [
        (false, false, &all[0]),
        (true, true, &all[1]),
        (true, false, &all[2]),
        (false, true, &all[3]),
    ] {
        check.ask(first, listed);
        let found = check.next_frame().unwrap().unwrap();
        let count = if first { 1 } else { all.count };
        assert_eq!((found.count, found.complete), (count, !first));
        let pairs = if listed { count } else { 0 };
        assert_eq!(found.pairs.len(), pairs);
        assert!(found.pairs.iter().all(|pair| all.pairs.contains(pair)));
    }
}

#[test]
fn bodies_of_both_precisions_meet_in_double_precision() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    let stl = format!("solid a\nfacet\nouter loop\n{corners}endloop\nendfacet\nendsolid\n");
    fs::write(path("single.stl"), stl).unwrap();
    // Single precision cannot tell the two heights apart.
    for (name, low) in [("above.obj", "1e-60"), ("below.obj", "-1e-60")] {
        let text = format!("v 0.25 0.25 {low}\nv 0.25 0.5 1\nv 0.5 0.25 1\nf 1 2 3\n");
        fs::write(path(name), text).unwrap();
    }
    for (name, count) in [("above.obj", 0), ("below.obj", 1)] {
        for arguments in [
            [path("single.stl"), path(name)],
            [path(name), path("single.stl")],
        ] {
            let found = counts(&arguments, &Settings::default()).unwrap();
            assert_eq!(found, [(0, count)], "{arguments:?}");
        }
    }
}

#[test]
fn frames_that_there_are_not_are_refused() {
    let (_folder, arguments) = folder();
    let refused = |settings: &Settings| counts(&arguments, settings).unwrap_err().to_string();
    let baseline = Settings {
        baseline: Some(Baseline::Frame(6)),
        ..Settings::default()
    };
    assert_eq!(
        refused(&baseline),
        "the baseline is frame 6, but these files have frames 0 to 5"
    );
    for (start, step, count) in [(6, 1, 1), (0, 1, 7), (1, 5, 2), (1, usize::MAX, 3)] {
        let frames = Some(Frames { start, step, count });
        let line = refused(&Settings {
            frames,
            ..Settings::default()
        });
        assert!(line.contains("have frames 0 to 5"), "{line}");
    }
    let nothing = counts(&[], &Settings::default()).unwrap_err();
    assert!(matches!(nothing, Error::NoSources), "{nothing}");
}

fn with_names(groups: &[(&str, &[&str])], ignore: &[[&str; 2]], split: bool) -> Settings {
    let group = |&(name, bodies): &(&str, &[&str])| Group {
        name: name.to_owned(),
        bodies: bodies.iter().map(|&body| body.to_owned()).collect(),
    };
    Settings {
        groups: groups.iter().map(group).collect(),
        ignore: ignore.iter().map(|two| two.map(str::to_owned)).collect(),
        split: split.then_some(Split::Components),
        ..Settings::default()
    }
}

#[test]
fn a_name_stands_for_every_body_it_can() {
    let (_folder, arguments) = folder();
    let [a, b, c] = [0, 1, 2].map(|place: usize| arguments[place].as_str());
    let piece = format!("{a}#1");
    let first_frame = |settings: &Settings| counts(&arguments, settings).unwrap()[0].1;
    for (groups, ignore, split, left) in [
        (&[][..], &[["0", "1"]][..], false, 2),
        (&[], &[[b, a]], false, 2),
        (&[], &[[a, b], ["2", b]], false, 1),
        (&[], &[[a, a]], false, 3),
        (&[("g", &[a, "1"][..])], &[["g", "g"]], false, 2),
        (&[("g", &[a, "1"])], &[["g", c]], false, 1),
        (&[("g", &["0", "1", "2", "0"])], &[["g", "g"]], false, 0),
        (&[("g", &[a, b, c])], &[["g", "g"]], true, 0),
        (&[], &[[&piece, b]], true, 2),
        (&[], &[[a, "1"]], true, 2),
    ] {
        let settings = with_names(groups, ignore, split);
        assert_eq!(first_frame(&settings), left, "{groups:?} {ignore:?}");
    }
    // The same path twice is one name for two bodies.
    let twice = [a, a, c].map(str::to_owned);
    let left = counts(&twice, &with_names(&[], &[[a, c]], false)).unwrap();
    assert_eq!(left[0], (0, 1));
}

#[test]
fn names_of_nobody_are_refused_with_those_that_there_are() {
    let (_folder, arguments) = folder();
    let piece = format!("{}#1", arguments[0]);
    let beyond = format!("{}#2", arguments[0]);
    let group: &[&str] = &["1"];
    for (groups, ignore, split, words) in [
        (
            &[][..],
            &[["hat", "0"]][..],
            false,
            "no body or group is called \"hat\"; bodies: 0 = ",
        ),
        (&[], &[["0", "3"]], false, "\"3\""),
        (&[], &[["0", "-1"]], false, "\"-1\""),
        (&[], &[["0", ""]], false, "\"\""),
        (&[], &[["0", &piece]], false, "#1"),
        (&[], &[["0", &beyond]], true, "#2"),
        (&[("g", group)], &[["0", "G"]], false, "; groups: \"g\""),
        (&[("g", &["g"])], &[], false, "no body is called \"g\""),
        (
            &[("g", group), ("g", group)],
            &[],
            false,
            "a group of this name is there already",
        ),
        (&[("2", group)], &[], false, "the body of that number"),
        (&[("7", group)], &[], false, "the body of that number"),
        (&[(&arguments[2], group)], &[], false, "a body is called so"),
        (&[("", group)], &[], false, "name is empty"),
        (&[("g", &[])], &[], false, "the group \"g\" has no bodies"),
    ] {
        let refused = counts(&arguments, &with_names(groups, ignore, split)).unwrap_err();
        let line = refused.to_string();
        assert!(
            line.contains(words) && line.lines().count() == 1,
            "{words}: {line}"
        );
    }
}

#[test]
fn the_names_of_many_bodies_are_not_all_listed() {
    let (_folder, arguments) = folder();
    let many = vec![arguments[2].clone(); 50];
    let line = counts(&many, &with_names(&[], &[["hat", "0"]], false)).unwrap_err();
    assert!(line.to_string().ends_with("and 30 more"), "{line}");
}

#[test]
fn after_an_error_nothing_follows() {
    let (folder, arguments) = folder();
    fs::write(folder.path().join("b2.obj"), "no mesh").unwrap();
    // The damaged frame is skipped on the way to a baseline behind it.
    for (baseline, counts) in [(None, &[3, 2][..]), (Some(3), &[2, 1]), (Some(2), &[])] {
        let settings = Settings {
            baseline: baseline.map(Baseline::Frame),
            ..Settings::default()
        };
        let mut check = Check::open(&arguments, &OpenOptions::default(), &settings).unwrap();
        for &count in counts {
            assert_eq!(check.next_frame().unwrap().unwrap().count, count);
        }
        let refused = check.next_frame().unwrap_err();
        let refused = refused.to_string();
        assert!(refused.contains("b2.obj"), "{refused}");
        for _ in 0..2 {
            let after = check.next_frame().unwrap_err();
            let frame = counts.len();
            assert_eq!(
                after.to_string(),
                format!("the check ended at frame {frame}, and nothing follows: {refused}")
            );
        }
    }
}

#[test]
fn lists_have_a_limit_that_of_the_baseline_too() {
    let (_folder, arguments) = folder();
    for (baseline, listed) in [(None, true), (Some(0), false)] {
        let settings = |max_list| Settings {
            max_list,
            listed,
            baseline: baseline.map(Baseline::Frame),
            ..Settings::default()
        };
        assert!(counts(&arguments, &settings(48)).is_ok());
        let full = counts(&arguments, &settings(47)).unwrap_err();
        assert!(
            matches!(full, Error::TooManyPairs { frame: 0, most: 2 }),
            "{full}"
        );
    }
    for (max_list, is_enough) in [(3 * 32, true), (3 * 32 - 1, false)] {
        let crossing = Settings {
            max_list,
            listed: false,
            crossing: true,
            ..Settings::default()
        };
        assert_eq!(counts(&arguments, &crossing).is_ok(), is_enough);
    }
    let counted = Settings {
        max_list: 0,
        listed: false,
        ..Settings::default()
    };
    assert!(counts(&arguments, &counted).is_ok());
}

#[test]
fn where_pairs_are_closest_is_listed_if_that_is_asked() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let arguments = [
        write("skin.obj", "v -1 -1 0\nv 9 -1 0\nv -1 9 0\nf 1 2 3\n"),
        // The first is above the plane, the second passes through it.
        write(
            "shirt.obj",
            "v 1 1 0.25\nv 1 2 4\nv 2 1 4\nv 3 3 -1\nv 3 4 4\nv 4 3 4\nf 1 2 3\nf 4 5 6\n",
        ),
    ];
    let find = |within, closest_points, listed, first| {
        let settings = Settings {
            within: Some(within),
            closest_points,
            listed,
            first,
            ..Settings::default()
        };
        let mut check = Check::open(&arguments, &OpenOptions::default(), &settings)?;
        Ok::<_, Error>(check.next_frame()?.unwrap())
    };
    let found = find(0.25, true, true, false).unwrap();
    assert_eq!(found.pairs, [[0, 0, 1, 0], [0, 0, 1, 1]]);
    assert_eq!((found.distance, found.gaps.len()), (Some(0.0), 1));
    let gap = &found.gaps[0];
    assert_eq!((gap.pair, gap.distance), ([0, 0, 1, 0], 0.25));
    let expected = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.25]];
    let both = gap
        .points
        .as_flattened()
        .iter()
        .zip(expected.as_flattened());
    assert!(
        both.into_iter().all(|(x, y)| (x - y).abs() < 1e-12),
        "{gap:?}"
    );
    // Only for listed pairs, if asked for; and not for a nearest pair at distance 0.
    for [closest_points, listed, first] in [
        [false, true, false],
        [true, false, false],
        [true, true, true],
    ] {
        let found = find(0.25, closest_points, listed, first).unwrap();
        assert_eq!((found.distance, found.gaps), (Some(0.0), Vec::new()));
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = find(bad, false, true, false);
        assert!(matches!(refused, Err(Error::Distance(_))), "{bad}");
    }
}
