//! Random checks against worlds made by hand.
//!
//! By hand, every piece is a body of its own, every frame a world of its own, and every rule is
//! tested on every pair.

use pliant::{Pair, Selection, World};
use pliant_check::{
    Baseline, Check, Error, FirstImpact, Found, Frames, Group, Row, Settings, Split,
};
use pliant_io::OpenOptions;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A random source of pieces. A piece is a few triangles that share corners, in a small cube in
/// every frame.
#[derive(Clone, Debug)]
struct SourceMade {
    /// Piece of each triangle, in the order of the file.
    order: Vec<usize>,
    /// Position by frame, piece and corner.
    frames: Vec<Vec<[[u8; 3]; 7]>>,
}

const FRAMES: usize = 3;

impl SourceMade {
    /// Triangles of all pieces, each of which goes around its seven corners.
    ///
    /// Each triangle shares two corners with the one before. So a piece is connected, but its first
    /// and fourth triangle share none.
    fn triangles(&self) -> Vec<[usize; 3]> {
        let mut next = BTreeMap::new();
        let triangle = |&piece: &usize| {
            let nth: &mut usize = next.entry(piece).or_insert(0);
            *nth += 1;
            [*nth, *nth + 1, *nth + 2].map(|corner| 7 * piece + corner % 7)
        };
        self.order.iter().map(triangle).collect()
    }

    fn positions(&self, frame: usize) -> Vec<[f64; 3]> {
        let corners = self.frames[frame].as_flattened();
        corners.iter().map(|corner| corner.map(f64::from)).collect()
    }

    fn write(&self, folder: &Path, name: &str) {
        for frame in 0..FRAMES {
            let mut text = String::new();
            for [x, y, z] in self.positions(frame) {
                writeln!(text, "v {x} {y} {z}").unwrap();
            }
            for corners in self.triangles() {
                let [a, b, c] = corners.map(|corner| corner + 1);
                writeln!(text, "f {a} {b} {c}").unwrap();
            }
            fs::write(folder.join(format!("{name}_{frame}.obj")), text).unwrap();
        }
    }

    /// Triangles of each piece, ordered by the lowest triangle.
    fn pieces(&self) -> Vec<Vec<usize>> {
        let mut pieces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (triangle, &piece) in self.order.iter().enumerate() {
            pieces.entry(piece).or_default().push(triangle);
        }
        let mut pieces: Vec<_> = pieces.into_values().collect();
        pieces.sort();
        pieces
    }
}

/// All pairs of a frame with their distances, including pairs of bodies with themselves.
fn by_hand(
    sources: &[SourceMade],
    split: bool,
    frame: usize,
    within: Option<f64>,
) -> Vec<(Row, f64)> {
    let mut world = World::<f64>::new();
    // Triangles of each body of the world, as the source numbers them.
    let mut bodies = Vec::new();
    for source in sources {
        let all = source.triangles();
        let whole = vec![(0..all.len()).collect()];
        for piece in if split { source.pieces() } else { whole } {
            let triangles = piece.iter().map(|&t| all[t].map(|corner| corner as u32));
            let triangles: Vec<_> = triangles.collect();
            world.add(&triangles, &source.positions(frame)).unwrap();
            bodies.push(piece);
        }
    }
    let named = |body: u32, triangle: u32| [body, bodies[body as usize][triangle as usize] as u32];
    let mut rows: Vec<(Row, f64)> = Vec::new();
    let row = |pair: Pair| {
        let [[a, t], [b, u]] = [
            named(pair.body_a.0, pair.triangle_a),
            named(pair.body_b.0, pair.triangle_b),
        ];
        [a, t, b, u]
    };
    if let Some(within) = within {
        for close in world
            .close_triangle_pairs(Selection::World, within)
            .all()
            .unwrap()
        {
            rows.push((row(close.pair), close.distance));
        }
        rows.sort_unstable_by_key(|&(row, _)| row);
        return rows;
    }
    for &pair in world.intersections(Selection::World).all().unwrap() {
        rows.push((row(pair), 0.0));
    }
    for id in world.bodies().collect::<Vec<_>>() {
        for &pair in world.intersections(Selection::Within(id)).all().unwrap() {
            let [[a, t], [b, u]] = pair.triangles().map(|triangle| named(id.0, triangle));
            rows.push(([a, t, b, u], 0.0));
        }
    }
    rows.sort_unstable_by_key(|&(row, _)| row);
    rows
}

/// A pair of elements: 0 and body, vertex, body, triangle; or 1 and body, vertex, vertex, twice.
type Elements = (u8, Vec<u32>);

/// Time of impact: as an interval, and to the last bit.
type Times = ([f64; 2], f64);

/// All impacts between elements of any bodies, from one frame to another.
fn on_the_way_by_hand(
    sources: &[SourceMade],
    split: bool,
    [from, to]: [usize; 2],
) -> BTreeMap<Elements, Times> {
    let mut world = World::<f64>::new();
    let mut bodies = Vec::new();
    for source in sources {
        let all = source.triangles();
        let whole = vec![(0..all.len()).collect()];
        for piece in if split { source.pieces() } else { whole } {
            let triangles = piece.iter().map(|&t| all[t].map(|corner| corner as u32));
            let triangles: Vec<_> = triangles.collect();
            let id = world.add(&triangles, &source.positions(from)).unwrap();
            world.set_motion(id, &source.positions(to)).unwrap();
            bodies.push(piece);
        }
    }
    let ids: Vec<_> = world.bodies().collect();
    let within = ids.iter().map(|&id| Selection::Within(id));
    let mut met: BTreeMap<Elements, Vec<[f64; 2]>> = BTreeMap::new();
    for of in within.chain([Selection::World]) {
        // A check's intervals are a millionth wide.
        for width in [1e-6, 0.0] {
            let impacts = world.vertex_triangle_impacts(of).width(width);
            for it in impacts.all().unwrap() {
                let [a, v, b, t]: [u32; 4] = it.pair.into();
                let t = bodies[b as usize][t as usize] as u32;
                met.entry((0, vec![a, v, b, t]))
                    .or_default()
                    .push([it.low, it.high]);
            }
            let impacts = world.edge_edge_impacts(of).width(width);
            for it in impacts.all().unwrap().to_vec() {
                let [a, e, b, f]: [u32; 4] = it.pair.into();
                let edges = [(a, e), (b, f)].map(|(body, edge)| {
                    let [p, q] = world.edges(ids[body as usize]).unwrap()[edge as usize];
                    [body, p, q]
                });
                let [one, other] = edges;
                let pair = [one.min(other), one.max(other)].concat();
                met.entry((1, pair)).or_default().push([it.low, it.high]);
            }
        }
    }
    let met = met.into_iter();
    met.map(|(pair, cells)| {
        let [wide, narrow] = cells[..] else {
            panic!("{cells:?}")
        };
        (pair, (wide, narrow[1]))
    })
    .collect()
}

fn all_frames(mut check: Check) -> Vec<Found> {
    let mut all = Vec::new();
    while let Some(found) = check.next_frame().unwrap() {
        all.push(found);
    }
    assert!(check.next_frame().unwrap().is_none());
    all
}

fn source() -> impl Strategy<Value = SourceMade> {
    let corner = prop::array::uniform3(0..9_u8);
    let piece = prop::array::uniform7(corner);
    let frames = prop::collection::vec(prop::collection::vec(piece, 4), FRAMES);
    (prop::collection::vec(0..4_usize, 1..16), frames)
        .prop_map(|(order, frames)| SourceMade { order, frames })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(800))]

    #[test]
    fn what_is_asked_is_what_is_found(
        sources in prop::collection::vec(source(), 1..4),
        split: bool,
        itself: bool,
        within in prop::option::weighted(0.5, 0..5_u8),
        first: bool,
        listed: bool,
        baseline in prop::option::of(0..FRAMES),
        rules in prop::collection::vec((0..30_u32, 0..30_u32, any::<bool>()), 0..4),
        members in prop::collection::vec(0..30_u32, 1..5),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut arguments = Vec::new();
        for (number, source) in sources.iter().enumerate() {
            let name = format!("s{number}");
            source.write(folder.path(), &name);
            arguments.push(folder.path().join(name + "_*.obj").display().to_string());
        }
        let count_of = |source: &SourceMade| if split { source.pieces().len() } else { 1 };
        let count = sources.iter().map(count_of).sum::<usize>() as u32;

        // A rule names two bodies by number, or a body and the group.
        let members: Vec<u32> = members.iter().map(|member| member % count).collect();
        let rules: Vec<(Vec<u32>, Vec<u32>, [String; 2])> = rules.iter().map(|&(a, b, group)| {
            let a = a % count;
            if group {
                let twice = b % 3 == 0;
                let name = if twice { "group".to_owned() } else { a.to_string() };
                let some = if twice { members.clone() } else { vec![a] };
                (some, members.clone(), [name, "group".to_owned()])
            } else {
                let b = b % count;
                (vec![a], vec![b], [a.to_string(), b.to_string()])
            }
        }).collect();
        let meets = |[a, _, b, _]: &Row| !rules.iter().any(|(some, others, _)| {
            some.contains(a) && others.contains(b) || some.contains(b) && others.contains(a)
        });
        let within = within.map(|quarters| f64::from(quarters) / 4.0);
        let is_asked = |(row, _): &&(Row, f64)| {
            (row[0] != row[2] || itself || count == 1) && meets(row)
        };
        let with_distances = |frame| -> Vec<(Row, f64)> {
            by_hand(&sources, split, frame, within).iter().filter(is_asked).copied().collect()
        };
        let expected = |frame| -> Vec<Row> {
            with_distances(frame).into_iter().map(|(row, _)| row).collect()
        };
        let known = baseline.map_or_else(Vec::new, expected);

        let settings = Settings {
            itself,
            within,
            first,
            listed,
            split: split.then_some(Split::Components),
            groups: vec![Group {
                name: "group".to_owned(),
                bodies: members.iter().map(u32::to_string).collect(),
            }],
            ignore: rules.iter().map(|(_, _, names)| names.clone()).collect(),
            baseline: baseline.map(Baseline::Frame),
            ..Settings::default()
        };
        // Every piece has its own vertices, and coinciding edges must stay two.
        let reading = OpenOptions { weld: false, ..OpenOptions::default() };
        let check = Check::open(&arguments, &reading, &settings);
        if within.is_some() && (itself || count == 1) {
            prop_assert!(matches!(check, Err(Error::WithinItself)));
            return Ok(());
        }
        let check = check.unwrap();
        prop_assert_eq!(check.body_count(), count as usize);
        let found = all_frames(check);
        prop_assert_eq!(found.len(), FRAMES);
        for found in found {
            let (old, new): (Vec<Row>, Vec<Row>) =
                expected(found.frame).into_iter().partition(|row| known.binary_search(row).is_ok());
            prop_assert_eq!(found.complete, !first);
            // The order of a pair's triangles may change how its distance is rounded.
            let distances = with_distances(found.frame);
            let distance_of = |row| distances.iter().find(|(it, _)| *it == row).map(|&(_, it)| it);
            let least = new.iter().filter_map(|&row| distance_of(row)).reduce(f64::min);
            let about = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() <= f64::powi(0.5, 28) * b,
                (a, b) => a == b,
            };
            prop_assert!(about(found.distance, least.filter(|_| within.is_some())));
            if let (true, Some(_), Some(row)) = (first, within, found.smallest) {
                prop_assert!(about(distance_of(row), least));
            }
            if first {
                prop_assert_eq!(found.count, new.len().min(1));
                prop_assert!(found.smallest.is_none_or(|row| new.contains(&row)));
                prop_assert_eq!(found.smallest.is_some(), !new.is_empty());
                // The nearest is known when all were seen.
                let all_were_seen = baseline.is_some() && (new.is_empty() || within.is_some());
                prop_assert_eq!(found.left_out, all_were_seen.then_some(old.len()));
            } else {
                prop_assert_eq!(found.count, new.len());
                prop_assert_eq!(found.smallest, new.first().copied());
                prop_assert_eq!(found.left_out, baseline.map(|_| old.len()));
            }
            if listed && !first {
                prop_assert_eq!(found.pairs, new);
            } else {
                prop_assert_eq!(found.pairs.len(), if listed { found.count } else { 0 });
            }
        }
    }

    /// Places that only touch are pairs of the same check without crossings, and no other pair is
    /// lost.
    #[test]
    fn what_crosses_is_not_left_out(
        mut sources in prop::collection::vec(source(), 1..4),
        split: bool,
        itself: bool,
        baseline in prop::option::of(0..FRAMES),
        ignored in prop::option::of((0..30_u32, 0..30_u32)),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut arguments = Vec::new();
        for (number, source) in sources.iter_mut().enumerate() {
            // So small a cube that much of it touches.
            let corners = source.frames.iter_mut().flatten().flatten().flatten();
            corners.for_each(|x| *x %= 3);
            let name = format!("s{number}");
            source.write(folder.path(), &name);
            arguments.push(folder.path().join(name + "_*.obj").display().to_string());
        }
        let count_of = |source: &SourceMade| if split { source.pieces().len() } else { 1 };
        let count = sources.iter().map(count_of).sum::<usize>() as u32;
        let named = |&(a, b): &(u32, u32)| [a, b].map(|it| (it % count).to_string());
        let checked = |crossing, listed, first| {
            let settings = Settings {
                itself,
                crossing,
                listed,
                first,
                split: split.then_some(Split::Components),
                ignore: ignored.iter().map(named).collect(),
                baseline: baseline.map(Baseline::Frame),
                ..Settings::default()
            };
            let reading = OpenOptions { weld: false, ..OpenOptions::default() };
            all_frames(Check::open(&arguments, &reading, &settings).unwrap())
        };
        let (all, crossing) = (checked(false, true, false), checked(true, true, false));
        let (counted, first) = (checked(true, false, false), checked(true, true, true));
        for (place, (all, crossing)) in all.iter().zip(&crossing).enumerate() {
            prop_assert_eq!(all.only_touching, None);
            let only_touching = crossing.only_touching.unwrap();
            prop_assert!(crossing.pairs.iter().all(|row| all.pairs.binary_search(row).is_ok()));
            let [without, with] = [all, crossing].map(|it| it.count + it.left_out.unwrap_or(0));
            prop_assert_eq!(without, with + only_touching);
            prop_assert_eq!(all.kinds.unwrap().crossing, crossing.kinds.unwrap().crossing);
            prop_assert_eq!(counted[place].count, crossing.count);
            prop_assert_eq!(counted[place].only_touching, Some(only_touching));
            prop_assert_eq!(first[place].count, crossing.count.min(1));
            prop_assert!(first[place].smallest.is_none_or(|row| crossing.pairs.contains(&row)));
        }
    }

    #[test]
    fn what_is_asked_of_the_way_is_what_is_found(
        sources in prop::collection::vec(source(), 1..4),
        split: bool,
        itself: bool,
        first: bool,
        listed: bool,
        start in 0..2_usize,
        step in 1..3_usize,
        rules in prop::collection::vec((0..30_u32, 0..30_u32), 0..3),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut arguments = Vec::new();
        for (number, source) in sources.iter().enumerate() {
            let name = format!("s{number}");
            source.write(folder.path(), &name);
            arguments.push(folder.path().join(name + "_*.obj").display().to_string());
        }
        let count_of = |source: &SourceMade| if split { source.pieces().len() } else { 1 };
        let count = sources.iter().map(count_of).sum::<usize>() as u32;
        let rules: Vec<[u32; 2]> = rules.iter().map(|&(a, b)| [a % count, b % count]).collect();
        let frames: Vec<usize> = (start..FRAMES).step_by(step).collect();
        let settings = Settings {
            itself,
            first,
            listed,
            swept: true,
            split: split.then_some(Split::Components),
            ignore: rules.iter().map(|rule| rule.map(|body| body.to_string())).collect(),
            frames: Some(Frames { start, step, count: frames.len() }),
            ..Settings::default()
        };
        let reading = OpenOptions { weld: false, ..OpenOptions::default() };
        let check = Check::open(&arguments, &reading, &settings);
        if frames.len() < 2 {
            let is_refused = matches!(check, Err(Error::SweptOneFrame { .. }));
            prop_assert!(is_refused);
            return Ok(());
        }
        let mut check = check.unwrap();
        prop_assert!(check.next_interval().unwrap().is_none());
        for (place, &frame) in frames.iter().enumerate() {
            prop_assert_eq!(check.next_frame().unwrap().unwrap().frame, frame);
            let Some(interval) = check.next_interval().unwrap() else {
                prop_assert_eq!(place, frames.len() - 1);
                continue;
            };
            prop_assert!(check.next_interval().unwrap().is_none());
            let until = frames[place + 1];
            prop_assert_eq!([interval.frame, interval.until], [frame, until]);
            prop_assert_eq!((interval.complete, &interval.changed), (!first, &vec![]));
            let mut expected = on_the_way_by_hand(&sources, split, [frame, until]);
            expected.retain(|(_, pair), _| {
                let (a, b) = (pair[0], pair[pair.len() / 2]);
                let is_ignored = rules.contains(&[a, b]) || rules.contains(&[b, a]);
                (a != b || itself || count == 1) && !is_ignored
            });
            let all = expected.len();
            expected.retain(|_, ([_, high], _)| *high > 0.0);
            prop_assert_eq!(interval.at_start, all - expected.len());
            let earliest = expected.iter().min_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b));
            let earliest = earliest.map(|(pair, &(cell, _))| (pair.clone(), cell));
            let found = interval.first.map(|first| match first {
                FirstImpact::VertexTriangle(it) => ((0, it.pair.to_vec()), [it.low, it.high]),
                FirstImpact::EdgeEdge(it) => ((1, it.pair.to_vec()), [it.low, it.high]),
            });
            prop_assert_eq!(&found, &earliest);
            let vertices = interval.vertex_triangle.iter();
            let vertices = vertices.map(|it| ((0, it.pair.to_vec()), [it.low, it.high]));
            let edges = interval.edge_edge.iter();
            let edges = edges.map(|it| ((1, it.pair.to_vec()), [it.low, it.high]));
            let lists: Vec<_> = vertices.chain(edges).collect();
            if first {
                prop_assert_eq!(interval.count, expected.len().min(1));
                let one: Vec<_> = earliest.into_iter().filter(|_| listed).collect();
                prop_assert_eq!(lists, one);
            } else {
                prop_assert_eq!(interval.count, expected.len());
                let all = expected.into_iter().map(|(pair, (cell, _))| (pair, cell));
                let all: Vec<_> = all.filter(|_| listed).collect();
                prop_assert_eq!(lists, all);
            }
        }
        prop_assert!(check.next_frame().unwrap().is_none());
        prop_assert!(check.next_interval().unwrap().is_none());
    }
}
