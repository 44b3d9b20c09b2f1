//! Groups of OBJ files as bodies, against worlds made by hand, and refusals.
//!
//! By hand, every group is a body of its own. Pairs that share a vertex of the file are removed
//! afterwards.

use pliant::{Selection, World};
use pliant_check::{Baseline, Check, Error, Row, Settings, Split};
use pliant_io::OpenOptions;
use proptest::prelude::*;
use std::fmt::Write;
use std::fs;
use std::path::Path;

const FRAMES: usize = 2;
const VERTICES: u32 = 12;

/// Each group's name, and the lines that begin it in a file.
const GROUPS: [(&str, &str); 4] = [
    ("default", "o\ng"),
    ("a", "o a"),
    ("a/b", "o a\ng b"),
    ("c", "o\ng c"),
];

/// Groups of a file that arguments name; empty for the whole file.
const NAMED: [&[&str]; 5] = [
    &[],
    &["c", "a"],
    &["a/b"],
    &["default", "a/b", "c"],
    &["a", "default"],
];

/// A random triangle soup with shared vertices, in random groups.
#[derive(Clone, Debug)]
struct SourceMade {
    triangles: Vec<[u32; 3]>,
    groups: Vec<usize>,
    frames: Vec<Vec<[u8; 3]>>,
    /// Index in [`NAMED`].
    named: usize,
}

/// An expected body.
struct BodyMade {
    name: String,
    source: usize,
    triangles: Vec<u32>,
}

fn source() -> impl Strategy<Value = SourceMade> {
    let triangle = prop::array::uniform3(0..VERTICES);
    let positions = prop::collection::vec(prop::array::uniform3(0..9_u8), VERTICES as usize);
    (
        prop::collection::vec((triangle, 0..GROUPS.len()), 1..14),
        prop::collection::vec(positions, FRAMES),
        0..NAMED.len(),
    )
        .prop_map(|(triangles, frames, named)| {
            let (triangles, groups) = triangles.into_iter().unzip();
            SourceMade {
                triangles,
                groups,
                frames,
                named,
            }
        })
}

impl SourceMade {
    fn positions(&self, frame: usize) -> Vec<[f64; 3]> {
        let positions = self.frames[frame].iter();
        positions.map(|corner| corner.map(f64::from)).collect()
    }

    fn write(&self, folder: &Path, name: &str) {
        for frame in 0..FRAMES {
            let mut text = String::new();
            for [x, y, z] in self.positions(frame) {
                writeln!(text, "v {x} {y} {z}").unwrap();
            }
            for (corners, &group) in self.triangles.iter().zip(&self.groups) {
                let [a, b, c] = corners.map(|corner| corner + 1);
                writeln!(text, "{}\nf {a} {b} {c}", GROUPS[group].1).unwrap();
            }
            fs::write(folder.join(format!("{name}_{frame}.obj")), text).unwrap();
        }
    }

    /// Groups that exist, in the order of their lowest triangles.
    fn groups(&self) -> Vec<usize> {
        let mut groups = Vec::new();
        for &group in &self.groups {
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
        groups
    }

    /// Groups that arguments name and that exist.
    fn named(&self) -> Vec<&'static str> {
        let is_there = |name: &&str| self.groups().iter().any(|&g| is_meant(GROUPS[g].0, name));
        NAMED[self.named].iter().copied().filter(is_there).collect()
    }

    /// Expected bodies: the name, `None` for a whole file, and the groups of each.
    fn bodies(&self, split: bool) -> Vec<(Option<&'static str>, Vec<usize>)> {
        let (groups, named) = (self.groups(), self.named());
        let of = |name: &str| -> Vec<usize> {
            let all = groups.iter().copied();
            all.filter(|&g| is_meant(GROUPS[g].0, name)).collect()
        };
        if split && groups != [0] {
            let takes_part =
                |g: &&usize| named.is_empty() || named.iter().any(|name| of(name).contains(g));
            let each = groups.iter().filter(takes_part);
            return each.map(|&g| (Some(GROUPS[g].0), vec![g])).collect();
        }
        if named.is_empty() {
            return vec![(None, groups.clone())];
        }
        named.iter().map(|name| (Some(*name), of(name))).collect()
    }
}

fn is_meant(name: &str, by: &str) -> bool {
    name == by || name.starts_with(&format!("{by}/"))
}

/// All pairs of a frame, including pairs of bodies with themselves.
fn by_hand(sources: &[SourceMade], bodies: &[BodyMade], frame: usize) -> Vec<Row> {
    let mut world = World::<f64>::new();
    for body in bodies {
        let source = &sources[body.source];
        let triangles = body.triangles.iter().map(|&t| source.triangles[t as usize]);
        let triangles: Vec<_> = triangles.collect();
        world.add(&triangles, &source.positions(frame)).unwrap();
    }
    let named = |body: u32, t: u32| [body, bodies[body as usize].triangles[t as usize]];
    let mut rows: Vec<Row> = Vec::new();
    let within = world.bodies().map(Selection::Within).collect::<Vec<_>>();
    for asked in within.into_iter().chain([Selection::World]) {
        for pair in world.intersections(asked).all().unwrap() {
            let [[a, t], [b, u]] = [
                named(pair.body_a.0, pair.triangle_a),
                named(pair.body_b.0, pair.triangle_b),
            ];
            rows.push([a, t, b, u]);
        }
    }
    rows.retain(|&[a, t, b, u]| {
        let [source, other] = [a, b].map(|body| bodies[body as usize].source);
        let [t, u] = [t, u].map(|t| sources[source].triangles.get(t as usize));
        let share = || t.is_some_and(|t| t.iter().any(|v| u.is_some_and(|u| u.contains(v))));
        source != other || !share()
    });
    rows.sort_unstable();
    rows
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn groups_are_bodies(
        sources in prop::collection::vec(source(), 1..3),
        split: bool,
        itself: bool,
        baseline in prop::option::of(0..FRAMES),
        rule in prop::option::of((0..8_usize, 0..8_usize)),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let (mut arguments, mut bodies) = (Vec::new(), Vec::new());
        for (number, source) in sources.iter().enumerate() {
            let name = format!("s{number}");
            source.write(folder.path(), &name);
            let file = folder.path().join(name + "_*.obj").display().to_string();
            // A file without groups has none to ask for.
            let named = if source.groups() == [0] { Vec::new() } else { source.named() };
            arguments.extend(named.iter().map(|name| format!("{file}#{name}")));
            if named.is_empty() {
                arguments.push(file.clone());
            }
            let plain = SourceMade { named: 0, ..source.clone() };
            let made = if source.groups() == [0] { &plain } else { source };
            for (name, groups) in made.bodies(split) {
                let triangles = (0..).zip(&source.groups).filter(|(_, g)| groups.contains(g));
                bodies.push(BodyMade {
                    name: name.map_or_else(|| file.clone(), |name| format!("{file}#{name}")),
                    source: number,
                    triangles: triangles.map(|(triangle, _)| triangle).collect(),
                });
            }
        }
        let rule = rule.map(|(a, b)| [a, b].map(|n| bodies[n % bodies.len()].name.clone()));
        let meets = |[a, _, b, _]: &Row| rule.as_ref().is_none_or(|[one, other]| {
            let is = |body: &u32, name: &str| {
                let own = &bodies[*body as usize].name;
                // The name of a whole file stands for its body.
                is_meant(own, name)
            };
            !(is(a, one) && is(b, other) || is(b, one) && is(a, other))
        });
        let is_asked = |row: &&Row| (row[0] != row[2] || itself || bodies.len() == 1) && meets(row);
        let expected = |frame| -> Vec<Row> {
            by_hand(&sources, &bodies, frame).iter().filter(is_asked).copied().collect()
        };
        let known = baseline.map_or_else(Vec::new, expected);
        let settings = Settings {
            itself,
            split: split.then_some(Split::Groups),
            ignore: rule.clone().into_iter().collect(),
            baseline: baseline.map(Baseline::Frame),
            ..Settings::default()
        };
        let reading = OpenOptions { weld: false, ..OpenOptions::default() };
        let mut check = Check::open(&arguments, &reading, &settings).unwrap();
        prop_assert_eq!(check.body_count(), bodies.len());
        for (facts, made) in check.bodies().zip(&bodies) {
            prop_assert_eq!(&facts.name, &made.name);
            prop_assert_eq!(facts.source, made.source);
            prop_assert_eq!(facts.triangles, made.triangles.len());
            prop_assert_eq!(facts.first_triangle, made.triangles[0] as usize);
        }
        for frame in 0..FRAMES {
            let found = check.next_frame().unwrap().unwrap();
            let (old, new): (Vec<Row>, Vec<Row>) =
                expected(frame).into_iter().partition(|row| known.binary_search(row).is_ok());
            prop_assert_eq!(found.pairs, new);
            prop_assert_eq!(found.left_out, baseline.map(|_| old.len()));
        }
        prop_assert!(check.next_frame().unwrap().is_none());
    }
}

/// Two triangles of two groups with a common edge, one welded to them along a seam, and one across
/// all.
const SEAMS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\n\
    v -0.6 0.5 -1\nv 1.8 0.4 -1\nv 1 0.5 1\n\
    g left\nf 1 2 3\ng top\nf 1 3 4\ng right\nf 5 7 6\ng 1\nf 8 9 10\n";

#[test]
fn a_seam_between_groups_is_no_hit_however_they_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("seams.obj");
    fs::write(&file, SEAMS).unwrap();
    let file = file.display().to_string();
    // Another spelling of the same file.
    let other = folder.path().join(".").join("seams.obj");
    let other = format!("{}//seams.obj", other.parent().unwrap().display());
    let found = |arguments: &[String], split| {
        let settings = Settings {
            split,
            ..Settings::default()
        };
        let mut check = Check::open(arguments, &OpenOptions::default(), &settings).unwrap();
        let pairs = check.next_frame().unwrap().unwrap().pairs;
        let names: Vec<_> = check.bodies().map(|body| body.name).collect();
        let named = pairs.iter().map(|&[a, t, b, u]| {
            let name = |body: u32| names[body as usize].rsplit('#').next().unwrap().to_owned();
            (name(a), t, name(b), u)
        });
        (
            names.len(),
            check.sources().len(),
            named.collect::<Vec<_>>(),
        )
    };
    let pair = |a: &str, t, b: &str, u| (a.to_owned(), t, b.to_owned(), u);
    let all = vec![
        pair("left", 0, "1", 3),
        pair("top", 1, "1", 3),
        pair("right", 2, "1", 3),
    ];
    assert_eq!(
        found(std::slice::from_ref(&file), Some(Split::Groups)),
        (4, 1, all.clone())
    );
    let each = ["left", "top", "right", "1"];
    let one_way = each.map(|name| format!("{file}#{name}"));
    assert_eq!(found(&one_way, None), (4, 1, all.clone()));
    assert_eq!(found(&one_way, Some(Split::Groups)), (4, 1, all.clone()));
    let mixed = [
        format!("{file}#left"),
        format!("{other}#top"),
        format!("{other}#right"),
    ];
    assert_eq!(found(&mixed, None), (3, 1, vec![]));
    // Bodies have the order of the arguments.
    let last_first = [format!("{file}#1"), format!("{file}#left")];
    assert_eq!(
        found(&last_first, None),
        (2, 1, vec![pair("1", 3, "left", 0)])
    );
    assert_eq!(found(&one_way[..1], None), (1, 1, vec![]));
}

#[test]
fn a_baseline_may_come_from_groups_named_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("seams.obj");
    fs::write(&file, SEAMS.replace("g top", "o left\ng top")).unwrap();
    let file = file.display().to_string();
    let old = folder.path().join("old.json");
    let body = |name: &str| format!(r#"{{"name":"{file}#{name}","triangles":1}}"#);
    let bodies = ["left", "left/right", "left/top", "left/1"]
        .map(body)
        .join(",");
    let text = format!(
        r#"{{"format":1,"bodies":[{bodies}],
        "frames":[{{"count":2,"pairs":[[0,0,3,3],[1,2,3,3]]}}]}}"#
    );
    fs::write(&old, text).unwrap();
    let settings = Settings {
        split: Some(Split::Groups),
        baseline: Some(Baseline::File(old)),
        ..Settings::default()
    };
    let mut check = Check::open(&[file], &OpenOptions::default(), &settings).unwrap();
    let found = check.next_frame().unwrap().unwrap();
    assert_eq!((found.left_out, found.pairs), (Some(2), vec![[1, 1, 3, 3]]));
}

#[test]
fn what_cannot_be_told_apart_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("seams.obj"), SEAMS.replace("g top", "o left\ng top")).unwrap();
    fs::write(path("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let refused = |names: &[&str], split| {
        let arguments: Vec<_> = names.iter().map(|name| path(name)).collect();
        let settings = Settings {
            split,
            ..Settings::default()
        };
        let checked = Check::open(&arguments, &OpenOptions::default(), &settings);
        checked.map(|_| ()).unwrap_err()
    };
    for (names, split) in [
        (&["seams.obj#left/1"][..], Some(Split::Components)),
        (&["plain.obj", "seams.obj#left"], Some(Split::Components)),
    ] {
        let error = refused(names, split);
        assert!(matches!(error, Error::PiecesOfGroup { .. }), "{error}");
    }
    for split in [None, Some(Split::Groups)] {
        for names in [
            ["seams.obj#left", "seams.obj#left"],
            ["seams.obj#left/top", "seams.obj#left"],
        ] {
            let error = refused(&names, split);
            assert!(matches!(error, Error::NamedTwice { .. }), "{error}");
        }
        let error = refused(&["seams.obj#left", "seams.obj#right"], split).to_string();
        let words = "has no body \"right\"; it has: left, left/top, left/right, left/1";
        assert!(error.contains(words), "{error}");
        let error = refused(&["plain.obj#left"], split).to_string();
        assert!(error.contains("holds one body"), "{error}");
    }
}

#[test]
fn groups_are_those_of_the_first_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("s_1.obj"), SEAMS).unwrap();
    fs::write(path("s_2.obj"), SEAMS.replace("g ", "o other_")).unwrap();
    fs::write(path("s_3.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    for (argument, split) in [("s_*.obj#1", None), ("s_*.obj", Some(Split::Groups))] {
        let settings = Settings {
            split,
            ..Settings::default()
        };
        let mut check = Check::open(&[path(argument)], &OpenOptions::default(), &settings).unwrap();
        for _ in 0..2 {
            check.next_frame().unwrap().unwrap();
        }
        let error = check.next_frame().unwrap_err();
        assert!(
            matches!(error, Error::PiecesChanged { frame: 2, by_name, .. }
                if by_name == split.is_none()),
            "{error}"
        );
    }
    // A source that is one body may change its mesh beside a source that is split.
    fs::write(path("t_1.ply.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    fs::write(
        path("t_2.ply.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n",
    )
    .unwrap();
    fs::remove_file(path("s_3.obj")).unwrap();
    let settings = Settings {
        split: Some(Split::Groups),
        ..Settings::default()
    };
    let arguments = [path("s_*.obj"), path("t_*.obj")];
    let mut check = Check::open(&arguments, &OpenOptions::default(), &settings).unwrap();
    assert_eq!(check.next_frame().unwrap().unwrap().changed, [0_u32; 0]);
    assert_eq!(check.next_frame().unwrap().unwrap().changed, [4]);
}
