//! Places against their definition, pair by pair and frame by frame, for pairs in any order.
//!
//! Places of a check are the places of the pairs that it returns.

use pliant_check::{
    Baseline, Check, Found, Frames, Life, Lives, Meshes, Place, Places, Row, Settings, Split,
};
use pliant_exact::{Precision, intersection};
use pliant_io::OpenOptions;
use proptest::prelude::*;
use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Meshes whose vertices have arbitrary positions.
#[derive(Clone, Debug, PartialEq)]
struct Soup(Vec<Vec<[u32; 3]>>);

const VERTICES: u32 = 24;

impl Meshes for Soup {
    fn sizes(&self, source: u32) -> [usize; 2] {
        [VERTICES as usize, self.0[source as usize].len()]
    }

    fn corners(&self, source: u32, triangle: u32) -> [u32; 3] {
        self.0[source as usize][triangle as usize]
    }

    fn position(&self, source: u32, vertex: u32) -> [f64; 3] {
        let [source, vertex] = [source, vertex].map(f64::from);
        [vertex, 10.0 * source - vertex, (vertex * 7.0) % 5.0]
    }

    fn body(&self, source: u32, triangle: u32) -> u32 {
        // Two bodies a source.
        2 * source + triangle % 2
    }
}

/// Source and triangle of both ends of a pair.
fn ends(&[source_a, a, source_b, b]: &Row) -> [[u32; 2]; 2] {
    [[source_a, a], [source_b, b]]
}

fn touch(meshes: &Soup, one: [u32; 2], other: [u32; 2]) -> bool {
    let [corners, others] = [one, other].map(|[source, triangle]| meshes.corners(source, triangle));
    one[0] == other[0] && corners.iter().any(|vertex| others.contains(vertex))
}

fn any_touch(meshes: &Soup, some: &[Row], others: &[Row]) -> bool {
    let of_some = some.iter().flat_map(ends);
    of_some.into_iter().any(|one| {
        let mut of_others = others.iter().flat_map(ends);
        of_others.any(|other| touch(meshes, one, other))
    })
}

/// Expected places by the definition: the number and the pairs of each.
fn expected(
    meshes: &Soup,
    pairs: &BTreeSet<Row>,
    before: &[(usize, Vec<Row>)],
    changed: &[usize],
    next: &mut usize,
) -> Vec<(usize, Vec<Row>)> {
    let mut places: Vec<Vec<Row>> = Vec::new();
    for &pair in pairs {
        let joins = |place: &Vec<Row>| any_touch(meshes, &[pair], place);
        let (mut joined, others): (Vec<_>, Vec<_>) = places.into_iter().partition(joins);
        joined.push(vec![pair]);
        places = others;
        places.push(joined.concat());
    }
    places.iter_mut().for_each(|place| place.sort_unstable());
    places.sort_by_key(|place| (Reverse(place.len()), place[0]));
    let kept = |end: &[u32; 2]| !changed.contains(&(end[0] as usize));
    let mut taken = BTreeSet::new();
    let numbers: Vec<Option<usize>> = places
        .iter()
        .map(|place| {
            let mut shared: Vec<usize> = before
                .iter()
                .filter(|(_, old)| {
                    let olds: Vec<[u32; 2]> = old.iter().flat_map(ends).filter(kept).collect();
                    let mut news = place.iter().flat_map(ends);
                    news.any(|new| olds.iter().any(|&old| touch(meshes, new, old)))
                })
                .map(|&(number, _)| number)
                .collect();
            shared.sort_unstable();
            let number = shared.into_iter().find(|number| !taken.contains(number));
            taken.extend(number);
            number
        })
        .collect();
    let mut new: Vec<usize> = (0..places.len())
        .filter(|&it| numbers[it].is_none())
        .collect();
    new.sort_by_key(|&it| places[it][0]);
    let mut named: Vec<(usize, Vec<Row>)> = numbers
        .iter()
        .zip(places)
        .map(|(number, place)| (number.unwrap_or(usize::MAX), place))
        .collect();
    for it in new {
        named[it].0 = *next;
        *next += 1;
    }
    named
}

fn check_place(meshes: &Soup, place: &Place, pairs: &[Row]) {
    assert_eq!((place.count, place.first_pair), (pairs.len(), pairs[0]));
    let triangles: BTreeSet<[u32; 2]> = pairs.iter().flat_map(ends).collect();
    let mut bodies: Vec<(u32, u32)> = triangles
        .iter()
        .map(|&[source, triangle]| (meshes.body(source, triangle), triangle))
        .collect();
    bodies.sort_unstable();
    let said: Vec<_> = place
        .bodies
        .iter()
        .map(|it| (it.body, it.triangles, it.first_triangle))
        .collect();
    let counted: Vec<_> = bodies
        .chunk_by(|one, other| one.0 == other.0)
        .map(|same| (same[0].0, same.len(), same[0].1))
        .collect();
    assert_eq!(said, counted);
    let corners_of = |&[source, triangle]: &[u32; 2]| {
        let corners = meshes.corners(source, triangle);
        corners.map(|vertex| meshes.position(source, vertex))
    };
    // Where pairs meet; else where their triangles are.
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut length = 0.0;
    let mut segments: Vec<[[f64; 3]; 2]> = Vec::new();
    for pair in pairs {
        let [a, b] = ends(pair).map(|end| corners_of(&end));
        let both = intersection(Precision::Double, &a, &b);
        let points: Vec<[f64; 3]> = both.ends().map(|end| end.point).collect();
        if let [p, q] = points[..]
            && !both.is_flat()
        {
            let is_new = |[r, s]: &[[f64; 3]; 2]| [*r, *s] != [p, q] && [*s, *r] != [p, q];
            if segments.iter().all(is_new) {
                let squares = (0..3).map(|axis| (q[axis] - p[axis]).powi(2));
                length += squares.sum::<f64>().sqrt();
                segments.push([p, q]);
            }
        }
        if points.is_empty() {
            corners.extend([a, b].concat());
        }
        corners.extend(points);
    }
    assert!((place.length - length).abs() < 1e-9 * (1.0 + length));
    for axis in 0..3 {
        let along = || corners.iter().map(|corner| corner[axis]);
        assert_eq!(place.lower[axis], along().fold(f64::INFINITY, f64::min));
        assert_eq!(place.upper[axis], along().fold(f64::NEG_INFINITY, f64::max));
    }
}

prop_compose! {
    fn meshes()(
        triangles in prop::collection::vec(
            prop::collection::vec(prop::array::uniform3(0..VERTICES), 1..14),
            2,
        ),
    ) -> Soup {
        Soup(triangles)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn places_are_what_their_definition_says(
        meshes in prop::collection::vec(meshes(), 1..3),
        frames in prop::collection::vec((any::<prop::sample::Index>(), prop::collection::vec(
            (0..2_u32, any::<prop::sample::Index>(), 0..2_u32, any::<prop::sample::Index>()), 0..9,
        )), 1..6),
    ) {
        let (mut places, mut lives) = (Places::new(), Lives::new());
        let (mut before, mut next) = (Vec::new(), 0);
        let mut shown: Option<&Soup> = None;
        let mut all: Vec<Life> = Vec::new();
        for (frame, (mesh, drawn)) in frames.iter().enumerate() {
            let meshes = mesh.get(&meshes);
            let mut rows: Vec<Row> = drawn.iter().map(|(source_a, a, source_b, b)| {
                let triangle = |source: u32, index: &prop::sample::Index| {
                    [source, index.index(meshes.0[source as usize].len()) as u32]
                };
                let (one, other) = (triangle(*source_a, a), triangle(*source_b, b));
                let [[source_a, a], [source_b, b]] = [one.min(other), one.max(other)];
                [source_a, a, source_b, b]
            }).collect();
            let pairs: BTreeSet<Row> = rows.iter().copied().collect();
            let mut seen = BTreeSet::new();
            rows.retain(|&row| seen.insert(row));
            let changed: Vec<usize> = (0..2)
                .filter(|&source| shown.is_some_and(|shown| shown.0[source] != meshes.0[source]))
                .collect();
            shown = Some(meshes);
            let named = expected(meshes, &pairs, &before, &changed, &mut next);

            // Pairs of an interrupted frame are forgotten.
            places.begin();
            rows.iter().take(2).for_each(|&row| places.take(meshes, row, row));
            places.take(meshes, [0, 99, 1, 0], [0, 99, 1, 0]);
            places.begin();
            rows.iter().for_each(|&row| places.take(meshes, row, row));
            places.forget(&changed);
            let found = places.end(meshes);
            prop_assert_eq!(found.len(), named.len());
            for (place, (number, pairs)) in found.iter().zip(&named) {
                prop_assert_eq!(place.number, *number);
                check_place(meshes, place, pairs);
            }
            lives.take(frame, &found);
            for place in found {
                // A number that is missing in a frame is never used again.
                match all.iter_mut().find(|life| life.worst.number == place.number) {
                    None => all.push(Life {
                        first_frame: frame,
                        last_frame: frame,
                        worst_frame: frame,
                        worst: place,
                    }),
                    Some(life) => {
                        prop_assert_eq!(life.last_frame + 1, frame);
                        life.last_frame = frame;
                        if place.count > life.worst.count {
                            (life.worst_frame, life.worst) = (frame, place);
                        }
                    }
                }
            }
            before = named;
        }
        all.sort_by_key(|life| (Reverse(life.worst.count), life.worst.number));
        prop_assert_eq!((lives.count(), lives.largest()), (all.len(), all));
    }
}

#[test]
fn of_very_many_places_the_largest_are_kept() {
    let place = |number: usize| Place {
        number,
        count: 1 + (number * 7919) % 5003,
        first_pair: [0, 0, 0, 1],
        bodies: Vec::new(),
        lower: [0.0; 3],
        upper: [1.0, 3.0, 2.0],
        length: 1.0,
        depth: None,
    };
    let mut lives = Lives::new();
    for frame in 0..50 {
        let places: Vec<Place> = (0..100).map(|it| place(100 * frame + it)).collect();
        lives.take(frame, &places);
    }
    let largest = lives.largest();
    assert_eq!((lives.count(), largest.len()), (5000, 1000));
    let mut counts: Vec<usize> = (0..5000).map(|number| place(number).count).collect();
    counts.sort_unstable_by_key(|&count| Reverse(count));
    let kept: Vec<usize> = largest.iter().map(|life| life.worst.count).collect();
    assert_eq!(kept, counts[..1000]);
    assert_eq!((place(0).size(), place(0).centre()), (3.0, [0.5, 1.5, 1.0]));
}

/// Writes a strip of 40 triangles, and a needle through it at each `x`.
fn strip(folder: &Path, name: &str, needles: &[f64]) {
    let mut text = String::new();
    for x in 0..=20 {
        writeln!(text, "v {x} 0 0\nv {x} 1 0").unwrap();
    }
    for x in 0..20 {
        let [a, b, c, d] = [1, 2, 3, 4].map(|corner| 2 * x + corner);
        writeln!(text, "f {a} {c} {b}\nf {b} {c} {d}").unwrap();
    }
    fs::write(folder.join(format!("strip{name}.obj")), text).unwrap();
    let mut text = String::new();
    for (x, first) in needles.iter().zip((1..).step_by(3)) {
        let [y, z] = [0.3, 0.2].map(|wide| x + wide);
        writeln!(text, "v {x} 0.2 -1\nv {y} 0.2 1\nv {z} 0.3 1").unwrap();
        writeln!(text, "f {} {} {}", first, first + 1, first + 2).unwrap();
    }
    fs::write(folder.join(format!("needles{name}.obj")), text).unwrap();
}

fn find(folder: &Path, names: &[&str], settings: Settings) -> (Vec<Found>, usize) {
    let arguments: Vec<String> = names
        .iter()
        .map(|name| folder.join(name).display().to_string())
        .collect();
    let settings = Settings {
        places: true,
        ..settings
    };
    let mut check = Check::open(&arguments, &OpenOptions::default(), &settings).unwrap();
    let mut all = Vec::new();
    while let Some(found) = check.next_frame().unwrap() {
        all.push(found);
    }
    (all, check.places().0)
}

/// Numbers of the places in each frame, largest place first.
fn numbers(found: &[Found]) -> Vec<Vec<usize>> {
    let of_frame = |found: &Found| {
        let places = found.places.as_ref().unwrap();
        let pairs: usize = places.iter().map(|place| place.count).sum();
        assert_eq!(pairs, found.count_of_all());
        places.iter().map(|place| place.number).collect()
    };
    found.iter().map(of_frame).collect()
}

#[test]
fn a_place_lives_as_long_as_it_shares_a_neighbour_and_longer_steps_end_it() {
    let folder = tempfile::tempdir().unwrap();
    // One needle walks along the strip, another stands. They are one place once the first arrives.
    for (frame, x) in [2.4, 3.4, 4.4, 14.4].into_iter().enumerate() {
        strip(folder.path(), &format!("_{frame}"), &[x, 15.4]);
    }
    let all = ["strip_*.obj", "needles_*.obj"];
    let (found, count) = find(folder.path(), &all, Settings::default());
    assert_eq!(
        numbers(&found),
        [vec![0, 1], vec![0, 1], vec![0, 1], vec![0]]
    );
    assert_eq!(count, 2);
    let merged = &found[3].places.as_ref().unwrap()[0];
    assert_eq!(merged.bodies.len(), 2);
    assert_eq!(merged.bodies[1].triangles, 2);

    // In every second frame the first needle has gone too far, but the place lives on by the
    // needle's triangle.
    let settings = Settings {
        frames: Some(Frames {
            start: 0,
            step: 2,
            count: 2,
        }),
        ..Settings::default()
    };
    assert_eq!(
        numbers(&find(folder.path(), &all, settings).0),
        [[0, 1], [0, 1]]
    );

    // A baseline leaves out the pairs of frame 0, one of each needle.
    let settings = Settings {
        baseline: Some(Baseline::Frame(0)),
        ..Settings::default()
    };
    let (found, _) = find(folder.path(), &all, settings);
    assert_eq!(
        found[0].places.as_ref().map(Vec::len),
        Some(0),
        "all left out"
    );
    assert!(numbers(&found).iter().flatten().count() > 0);

    // Pieces have numbers of their own, and ignored ones no places.
    let settings = Settings {
        split: Some(Split::Components),
        ignore: vec![["needles_*.obj#2".to_owned(), "strip_*.obj".to_owned()]],
        ..Settings::default()
    };
    let folder_name = folder.path().display();
    let settings = Settings {
        ignore: settings
            .ignore
            .iter()
            .map(|two| two.each_ref().map(|name| format!("{folder_name}/{name}")))
            .collect(),
        ..settings
    };
    let (found, _) = find(folder.path(), &all, settings);
    for found in &found {
        let places = found.places.as_ref().unwrap();
        let bodies: Vec<u32> = places[0].bodies.iter().map(|it| it.body).collect();
        assert_eq!((places.len(), bodies), (1, vec![0, 1]));
    }

    // Frames that ask for the first pair have no places.
    let settings = Settings {
        first: true,
        ..Settings::default()
    };
    let (found, count) = find(folder.path(), &all, settings);
    assert!(found.iter().all(|found| found.places.is_none()) && count == 0);
}

#[test]
fn places_go_on_through_bodies_that_keep_their_mesh() {
    let folder = tempfile::tempdir().unwrap();
    // In frame 1 the needles change their mesh, by one far from the strip. In frame 2 both change.
    strip(folder.path(), "_0", &[2.4]);
    strip(folder.path(), "_1", &[2.4, 90.0]);
    strip(folder.path(), "_2", &[2.4]);
    let text = fs::read_to_string(folder.path().join("strip_2.obj")).unwrap();
    fs::write(folder.path().join("strip_2.obj"), text + "v 50 50 50\n").unwrap();
    let all = ["strip_*.obj", "needles_*.obj"];
    let (found, _) = find(folder.path(), &all, Settings::default());
    let changed: Vec<_> = found.iter().map(|found| found.changed.clone()).collect();
    assert_eq!(changed, [vec![], vec![1], vec![0, 1]]);
    assert_eq!(numbers(&found), [[0], [0], [1]]);
}

/// Equal places for any number of threads, on real meshes if they are available.
#[test]
fn places_of_real_meshes_do_not_depend_on_threads() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !data.exists() {
        eprintln!("skipped: there is no shared/data beside the checkout");
        return;
    }
    for (name, frames) in [
        ("human-morph.npz", 6),
        ("cloth-funnel/227.ply", 1),
        ("cloth-funnel/228.ply", 1),
    ] {
        let all = [1, 2, 3].map(|threads| {
            let mut settings = Settings {
                itself: true,
                listed: false,
                frames: Some(Frames {
                    start: 0,
                    step: 10,
                    count: frames,
                }),
                ..Settings::default()
            };
            settings.options.threads = threads.try_into().unwrap();
            find(&data, &[name], settings)
        });
        assert_eq!(all[0], all[1]);
        assert_eq!(all[0], all[2]);
        for found in &all[0].0 {
            let places = found.places.as_ref().unwrap();
            assert!(!places.is_empty());
            let pairs: usize = places.iter().map(|place| place.count).sum();
            assert_eq!(pairs, found.count_of_all());
        }
    }
}
