//! Edited worlds answer as worlds built fresh from what is left, by the numbers that stayed.
//!
//! The two are compared after every edit.

use crate::common::{Lcg, every_configuration, share, sheet};
use pliant::{
    AdjacentContact, BodyId, ContactKind, CrossingEdge, EdgeEdge, Edit, Edited, Labels, Options,
    Pair, Scalar, Selection, VertexTriangle, World,
};
use std::collections::{BTreeMap, BTreeSet};

/// The test's own copy of a body; numbers that are empty are `None`.
#[derive(Clone, Debug)]
struct Known<S> {
    id: BodyId,
    triangles: Vec<Option<[u32; 3]>>,
    positions: Vec<Option<[S; 3]>>,
    groups: Vec<u32>,
    rest: Option<Vec<[S; 3]>>,
    end: Option<Vec<[S; 3]>>,
    /// The number of every edge, once it was asked for.
    edges: BTreeMap<[u32; 2], u32>,
    /// Vertices that an edit has placed.
    placed: BTreeSet<u32>,
    /// Placed vertices that have had no triangle since.
    alone: BTreeSet<u32>,
}

/// A body without empty numbers, and the numbers that its elements have in the edited body.
struct Compact<S> {
    triangles: Vec<[u32; 3]>,
    positions: Vec<[S; 3]>,
    groups: Vec<u32>,
    rest: Option<Vec<[S; 3]>>,
    end: Option<Vec<[S; 3]>>,
    known_triangles: Vec<u32>,
    known_vertices: Vec<u32>,
}

impl<S: Number> Known<S> {
    fn new(id: BodyId, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Self {
        Self {
            id,
            triangles: triangles.iter().copied().map(Some).collect(),
            positions: positions.iter().copied().map(Some).collect(),
            groups: vec![0; positions.len()],
            rest: None,
            end: None,
            edges: BTreeMap::new(),
            placed: BTreeSet::new(),
            alone: BTreeSet::new(),
        }
    }

    /// Gives the last vertex a group, and a place in the rest shape if there is one.
    fn push_values(&mut self, group: u32, place: [S; 3]) {
        self.groups.push(group);
        if let Some(rest) = &mut self.rest {
            rest.push(place);
        }
    }

    fn compact(&self) -> Compact<S> {
        let of_list = |are_there: Vec<bool>| -> Vec<u32> {
            let all = (0..).zip(are_there);
            all.filter(|&(_, there)| there).map(|(at, _)| at).collect()
        };
        let known_triangles = of_list(self.triangles.iter().map(Option::is_some).collect());
        let known_vertices = of_list(self.positions.iter().map(Option::is_some).collect());
        let number = |vertex: u32| known_vertices.partition_point(|&it| it < vertex) as u32;
        let corners = |&at: &u32| self.triangles[at as usize].unwrap().map(number);
        let of_vertices =
            |all: &[[S; 3]]| known_vertices.iter().map(|&it| all[it as usize]).collect();
        Compact {
            triangles: known_triangles.iter().map(corners).collect(),
            positions: self.positions.iter().copied().flatten().collect(),
            groups: known_vertices
                .iter()
                .map(|&it| self.groups[it as usize])
                .collect(),
            rest: self.rest.as_deref().map(of_vertices),
            end: self.end.as_deref().map(of_vertices),
            known_triangles,
            known_vertices,
        }
    }

    /// Positions as a caller gives them; rows of empty vertices hold anything, NaN included.
    fn rows(&self, random: &mut Lcg) -> Vec<[S; 3]> {
        let nowhere = [f64::NAN, f64::INFINITY, 3.0][random.below(3) as usize];
        let nowhere = [S::of(nowhere); 3];
        self.positions
            .iter()
            .map(|it| it.unwrap_or(nowhere))
            .collect()
    }

    fn live_triangles(&self) -> Vec<u32> {
        let all = (0..).zip(&self.triangles);
        all.filter(|(_, corners)| corners.is_some())
            .map(|(at, _)| at)
            .collect()
    }

    fn is_used(&self, vertex: u32) -> bool {
        self.triangles
            .iter()
            .flatten()
            .any(|corners| corners.contains(&vertex))
    }
}

/// Scalars that can be made from `f64`.
trait Number: Scalar {
    fn of(x: f64) -> Self;
}

impl Number for f32 {
    fn of(x: f64) -> Self {
        x as Self
    }
}

impl Number for f64 {
    fn of(x: f64) -> Self {
        x
    }
}

/// All answers of a world, in the test's own numbers, with edges as their ends.
#[derive(Debug, Default, PartialEq)]
struct Answers {
    intersections: BTreeSet<[u32; 4]>,
    adjacent: BTreeSet<([u32; 4], ContactKind)>,
    crossing_edges: BTreeSet<[u32; 5]>,
    vertex_triangle: BTreeSet<[u32; 4]>,
    edge_edge: BTreeSet<[u32; 6]>,
    close_vertex_triangle: BTreeSet<[u32; 4]>,
    close_edge_edge: BTreeSet<[u32; 6]>,
    close_triangles: BTreeSet<[u32; 4]>,
    vertex_triangle_impacts: BTreeMap<[u32; 4], [u64; 2]>,
    edge_edge_impacts: BTreeMap<[u32; 6], [u64; 2]>,
}

impl Answers {
    /// Fails with the hits that are missing and the hits that are too many.
    fn assert_are(&self, all: &Self) {
        macro_rules! compare {
            ($($list:ident),*) => {$(
                let (found, expected) = (&self.$list, &all.$list);
                if found != expected {
                    let missing = expected.iter().filter(|it| !found.iter().any(|x| x == *it));
                    let more = found.iter().filter(|it| !expected.iter().any(|x| x == *it));
                    let differences = (missing.collect::<Vec<_>>(), more.collect::<Vec<_>>());
                    panic!("{}: missing, and too many: {differences:?}", stringify!($list));
                }
            )*};
        }
        compare!(
            intersections,
            adjacent,
            crossing_edges,
            vertex_triangle,
            edge_edge,
            close_vertex_triangle,
            close_edge_edge,
            close_triangles,
            vertex_triangle_impacts,
            edge_edge_impacts
        );
    }
}

/// Asks a world everything, and translates the numbers of its bodies by `names`.
fn ask<S: Number>(
    world: &mut World<S>,
    names: &dyn Fn(BodyId, Name) -> u32,
    radius: f64,
) -> Answers {
    let all_edges: Vec<Vec<[u32; 2]>> = world
        .bodies()
        .collect::<Vec<_>>()
        .into_iter()
        .map(|body| world.edges(body).unwrap().to_vec())
        .collect();
    let triangle = |body, number| names(body, Name::Triangle(number));
    let vertex = |body, number| names(body, Name::Vertex(number));
    let of_triangles = |pair: [u32; 4]| {
        let [a, s, b, t] = pair;
        [a, triangle(BodyId(a), s), b, triangle(BodyId(b), t)]
    };
    let of_vertex = |pair: VertexTriangle| {
        let (a, b) = (pair.vertex_body, pair.triangle_body);
        [a.0, vertex(a, pair.vertex), b.0, triangle(b, pair.triangle)]
    };
    let of_edges = |pair: EdgeEdge| {
        let edge = |body: BodyId, edge: u32| {
            let mut ends = all_edges[body.0 as usize][edge as usize].map(|it| vertex(body, it));
            ends.sort_unstable();
            [body.0, ends[0], ends[1]]
        };
        let [a, b] = [
            edge(pair.body_a, pair.edge_a),
            edge(pair.body_b, pair.edge_b),
        ];
        let [[a, b, c], [d, e, f]] = [a.min(b), a.max(b)];
        [a, b, c, d, e, f]
    };
    let of = Selection::Everything;
    let mut answers = Answers::default();
    let found = world.intersections(of).all().unwrap();
    let count = found.len();
    answers.intersections = found
        .iter()
        .map(|&pair| of_triangles(pair.into()))
        .collect();
    assert_eq!(answers.intersections.len(), count);
    assert!(found.is_sorted());
    let first = world.intersections(of).first().unwrap();
    assert_eq!(first.is_some(), count > 0);
    if let Some(first) = first {
        assert!(answers.intersections.contains(&of_triangles(first.into())));
    }
    let found = world.adjacent_intersections(of).all().unwrap();
    assert!(found.is_sorted_by(|a, b| a < b));
    let row = |it: &AdjacentContact| (of_triangles(it.pair.into()), it.kind);
    answers.adjacent = found.iter().map(row).collect();
    let found = world.crossing_edges(of).all().unwrap();
    assert!(found.is_sorted_by(|a, b| a < b));
    let row = |it: &CrossingEdge| {
        let ends = all_edges[it.edge_body.0 as usize][it.edge as usize];
        let mut ends = ends.map(|end| vertex(it.edge_body, end));
        ends.sort_unstable();
        let (body, other) = (it.edge_body.0, it.triangle_body);
        [
            body,
            ends[0],
            ends[1],
            other.0,
            triangle(other, it.triangle),
        ]
    };
    answers.crossing_edges = found.iter().map(row).collect();
    let found = world.vertex_triangle_candidates(of, radius).all().unwrap();
    assert!(found.is_sorted_by(|a, b| a < b));
    answers.vertex_triangle = found.iter().map(|&pair| of_vertex(pair)).collect();
    let found = world.edge_edge_candidates(of, radius).all().unwrap();
    assert!(found.is_sorted_by(|a, b| a < b));
    answers.edge_edge = found.iter().map(|&pair| of_edges(pair)).collect();
    let found = world.close_vertex_triangle_pairs(of, radius).all().unwrap();
    answers.close_vertex_triangle = found.iter().map(|close| of_vertex(close.pair)).collect();
    let found = world.close_edge_edge_pairs(of, radius).all().unwrap();
    answers.close_edge_edge = found.iter().map(|close| of_edges(close.pair)).collect();
    let found = world
        .close_triangle_pairs(Selection::World, radius)
        .all()
        .unwrap();
    answers.close_triangles = found
        .iter()
        .map(|close| of_triangles(close.pair.into()))
        .collect();
    let found = world.vertex_triangle_impacts(of).all().unwrap();
    let timed = |low: f64, high: f64| [low.to_bits(), high.to_bits()];
    let row = found
        .iter()
        .map(|it| (of_vertex(it.pair), timed(it.low, it.high)));
    answers.vertex_triangle_impacts = row.collect();
    let found = world.edge_edge_impacts(of).all().unwrap();
    let row = found
        .iter()
        .map(|it| (of_edges(it.pair), timed(it.low, it.high)));
    answers.edge_edge_impacts = row.collect();
    answers
}

/// A number of a triangle or vertex as a body of a world gives it.
enum Name {
    Triangle(u32),
    Vertex(u32),
}

/// Compares a world with one built fresh.
fn check<S: Number>(world: &mut World<S>, known: &mut [Known<S>], options: Options, radius: f64) {
    world.validate().unwrap();
    let compact: Vec<Compact<S>> = known.iter().map(Known::compact).collect();
    let mut fresh = World::with_options(options);
    for (body, known) in compact.iter().zip(&*known) {
        let id = fresh.add(&body.triangles, &body.positions).unwrap();
        if let Some(labels) = world.labels(known.id).unwrap() {
            let all = body.known_triangles.iter();
            let all: Vec<u32> = all.map(|&it| labels.of_triangles[it as usize]).collect();
            let of_triangles = &all;
            let labels = Labels {
                of_triangles,
                ..labels
            };
            fresh.set_labels(id, Some(labels)).unwrap();
        }
        fresh.set_vertex_groups(id, &body.groups).unwrap();
        fresh.set_rest_positions(id, body.rest.as_deref()).unwrap();
        if let Some(end) = &body.end {
            fresh.set_motion(id, end).unwrap();
        }
    }
    for body in &mut *known {
        let id = body.id;
        let triangles = world.triangles(id).unwrap();
        let empty = [u32::MAX; 3];
        let expected = body.triangles.iter().map(|it| it.unwrap_or(empty));
        assert!(triangles.iter().copied().eq(expected));
        let live = body.triangles.iter().map(Option::is_some);
        assert!(live.eq(world.live_triangles(id).unwrap()));
        let live = body.positions.iter().map(Option::is_some);
        assert!(live.eq(world.live_vertices(id).unwrap()));
        for (found, expected) in world.positions(id).unwrap().iter().zip(&body.positions) {
            match expected {
                Some(expected) => assert_eq!(found, expected),
                None => assert!(found.iter().all(|x| x.to_f64().is_nan())),
            }
        }
        assert_eq!(world.vertex_groups(id).unwrap(), body.groups);
        let rest = world.rest_positions(id).unwrap();
        assert_eq!(rest.is_some(), body.rest.is_some());
        let rows = rest.iter().flat_map(|rest| rest.iter());
        for ((found, expected), position) in
            rows.zip(body.rest.iter().flatten()).zip(&body.positions)
        {
            assert!(position.is_none() || found == expected);
        }
        // Every edge that exists has a number, and an edge that stays has kept its number.
        let edges = (0..).zip(world.edges(id).unwrap());
        let numbers = edges.filter(|(_, ends)| **ends != [u32::MAX; 2]);
        let numbers: BTreeMap<[u32; 2], u32> = numbers.map(|(at, &ends)| (ends, at)).collect();
        let sides = body.triangles.iter().flatten();
        let sides = sides.flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let sides = sides
            .filter(|[a, b]| a != b)
            .map(|[a, b]| [a.min(b), a.max(b)]);
        let expected: BTreeSet<[u32; 2]> = sides.collect();
        assert!(numbers.keys().eq(&expected));
        for (ends, number) in &numbers {
            assert_eq!(body.edges.get(ends).unwrap_or(number), number, "{ends:?}");
        }
        body.edges = numbers;
    }
    let ids: Vec<BodyId> = known.iter().map(|body| body.id).collect();
    let expected = ask(
        &mut fresh,
        &|body, name| match name {
            Name::Triangle(number) => compact[body.0 as usize].known_triangles[number as usize],
            Name::Vertex(number) => compact[body.0 as usize].known_vertices[number as usize],
        },
        radius,
    );
    let as_they_are = |_, name| match name {
        Name::Triangle(number) | Name::Vertex(number) => number,
    };
    ask(world, &as_they_are, radius).assert_are(&expected);
    world.validate().unwrap();
    let [a, b] = [ids[0], ids[1]];
    let distances = [&mut *world, &mut fresh].map(|world| {
        let nearest = world.distance(a, b, 100.0).unwrap();
        nearest.map(|it| it.distance)
    });
    match distances {
        [Some(found), Some(expected)] => {
            assert!((found - expected).abs() <= 1e-6 * expected, "{distances:?}");
        }
        [found, expected] => assert_eq!(found, expected),
    }
}

/// Makes one random step, both in the edit and in the test's own copy.
#[expect(clippy::too_many_lines, reason = "one arm a step of the library")]
fn step<S: Number>(edit: &mut Edit<S>, known: &mut Known<S>, random: &mut Lcg) {
    let mut alone = std::mem::take(&mut known.alone);
    alone.retain(|&vertex| !known.is_used(vertex));
    known.alone = alone;
    let live = known.live_triangles();
    let some = |random: &mut Lcg| live[random.below(live.len() as u32) as usize];
    let position = |random: &mut Lcg| {
        let [x, y, z] = [random.unit(), random.unit(), random.unit()];
        [x, y, z * 0.2].map(|x| S::of(f64::from(x)))
    };
    let vertex = |known: &Known<S>, random: &mut Lcg| loop {
        let vertex = random.below(known.positions.len() as u32);
        if known.positions[vertex as usize].is_some() {
            break vertex;
        }
    };
    match random.below(9) {
        0 if live.len() > 4 => {
            let triangle = some(random);
            edit.remove_triangle(triangle);
            known.triangles[triangle as usize] = None;
        }
        1 => {
            // One triangle becomes three.
            let triangle = some(random);
            let [a, b, c] = known.triangles[triangle as usize].unwrap();
            let position = position(random);
            let new = edit.add_vertex(position);
            assert_eq!(new as usize, known.positions.len());
            known.positions.push(Some(position));
            known.push_values(0, position);
            edit.set_triangle(triangle, [a, b, new]);
            known.triangles[triangle as usize] = Some([a, b, new]);
            let corners = [[b, c, new], [c, a, new]];
            let added = edit.add_triangles(&corners);
            assert_eq!(added.start as usize, known.triangles.len());
            known.triangles.extend(corners.map(Some));
        }
        2 | 3 => {
            // A vertex is split: some of its triangles get another.
            let triangle = some(random);
            let vertex = known.triangles[triangle as usize].unwrap()[random.below(3) as usize];
            let of_vertex = |&at: &u32| known.triangles[at as usize].unwrap().contains(&vertex);
            let mut leaving: Vec<u32> = live.iter().copied().filter(of_vertex).collect();
            leaving.truncate(1 + random.below(3) as usize);
            let new = edit.split_vertex(vertex, &leaving);
            known.positions.push(known.positions[vertex as usize]);
            let place = known.rest.as_ref().map(|rest| rest[vertex as usize]);
            known.push_values(known.groups[vertex as usize], place.unwrap_or_default());
            for triangle in leaving {
                let corners = known.triangles[triangle as usize].as_mut().unwrap();
                *corners = corners.map(|it| if it == vertex { new } else { it });
            }
        }
        4 => {
            // The two ends of an edge become one vertex.
            let [kept, gone, _] = known.triangles[some(random) as usize].unwrap();
            edit.merge_vertices(kept, gone);
            for corners in known.triangles.iter_mut().flatten() {
                *corners = corners.map(|it| if it == gone { kept } else { it });
            }
            if kept != gone {
                known.positions[gone as usize] = None;
                known.placed.remove(&gone);
                known.alone.remove(&gone);
            }
        }
        5 => {
            let corners = [0; 3].map(|_| vertex(known, random));
            let added = edit.add_triangle(corners);
            assert_eq!(added as usize, known.triangles.len());
            known.triangles.push(Some(corners));
        }
        6 => {
            let triangle = random.below(known.triangles.len() as u32);
            let corners = [0; 3].map(|_| vertex(known, random));
            edit.set_triangle(triangle, corners);
            known.triangles[triangle as usize] = Some(corners);
        }
        7 => {
            let empty = |it: &u32| known.positions[*it as usize].is_none();
            let vertices = 0..known.positions.len() as u32;
            if let Some(vertex) = vertices.into_iter().find(empty) {
                let position = position(random);
                edit.place_vertex(vertex, position);
                known.placed.insert(vertex);
                known.positions[vertex as usize] = Some(position);
                known.groups[vertex as usize] = 0;
                if let Some(rest) = &mut known.rest {
                    rest[vertex as usize] = position;
                }
                known.alone.insert(vertex);
                if random.below(3) == 0 {
                    return;
                }
                let [a, b, _] = known.triangles[some(random) as usize].unwrap();
                edit.add_triangle([a, b, vertex]);
                known.triangles.push(Some([a, b, vertex]));
            }
        }
        _ => {
            let positions = [position(random), position(random)];
            edit.add_vertices(&positions);
            known.positions.extend(positions.map(Some));
            let new = positions.into_iter();
            new.for_each(|position| known.push_values(0, position));
        }
    }
}

/// The result of an edit, from the mesh before and after its steps.
///
/// Vertices that lost their last triangle are empty afterwards.
fn finish<S: Number>(before: &Known<S>, known: &mut Known<S>) -> Edited {
    for vertex in 0..known.positions.len() as u32 {
        let was_used = before.is_used(vertex) && !known.alone.contains(&vertex);
        if was_used && !known.is_used(vertex) {
            known.positions[vertex as usize] = None;
        }
    }
    known.alone.clear();
    known.end = None;
    let placed = std::mem::take(&mut known.placed);
    let mut edited = Edited::default();
    let old = before
        .triangles
        .iter()
        .copied()
        .chain(std::iter::repeat(None));
    for (at, (&new, old)) in (0..).zip(known.triangles.iter().zip(old)) {
        let list = match (old, new) {
            (None, Some(_)) => &mut edited.new_triangles,
            (Some(_), None) => &mut edited.removed_triangles,
            _ if old != new => &mut edited.changed_triangles,
            _ => continue,
        };
        list.push(at);
    }
    let old = before
        .positions
        .iter()
        .copied()
        .chain(std::iter::repeat(None));
    for (at, (&new, old)) in (0..).zip(known.positions.iter().zip(old)) {
        match (old, new) {
            (None, Some(_)) => edited.new_vertices.push(at),
            (Some(_), None) => edited.removed_vertices.push(at),
            (Some(_), Some(_)) if placed.contains(&at) => edited.new_vertices.push(at),
            _ => {}
        }
    }
    edited
}

/// Gives a body a slightly different mesh without empty numbers.
fn other_mesh<S: Number>(world: &mut World<S>, known: &mut Known<S>, random: &mut Lcg) {
    let id = known.id;
    let compact = known.compact();
    let (mut triangles, mut positions) = (compact.triangles, compact.positions);
    for _ in 0..random.below(6) {
        let at = random.below(triangles.len() as u32) as usize;
        match random.below(3) {
            0 if triangles.len() > 4 => drop(triangles.pop()),
            1 => triangles[at].rotate_left(1),
            _ => {
                positions.push([S::of(0.5), S::of(0.5), S::of(0.1)]);
                triangles.push([0, triangles[at][1], positions.len() as u32 - 1]);
            }
        }
    }
    world.set_mesh(id, &triangles, &positions).unwrap();
    let old = &mut *known;
    let numbers = 0..old.triangles.len().max(triangles.len());
    let has_changed = |&at: &usize| {
        let before = old.triangles.get(at).copied().flatten();
        before != triangles.get(at).copied()
    };
    let changed = numbers.filter(has_changed).count();
    let is_other = changed > 0 || positions.len() != old.positions.len();
    let is_edited =
        8 * changed <= old.live_triangles().len() && positions.len() >= old.positions.len();
    let mut new = Known::new(id, &triangles, &positions);
    if !is_other {
        new.groups = std::mem::take(&mut old.groups);
        new.rest = old.rest.take();
    }
    // Edges that stay keep their numbers where the mesh is edited.
    if is_edited {
        new.edges = std::mem::take(&mut old.edges);
    }
    *known = new;
}

/// Life of a world of two bodies that are edited again and again. Returns the number of edits.
fn life<S: Number>(options: Options, seed: u64, edits: usize) -> usize {
    let mut random = Lcg(seed);
    let mut world = World::<S>::with_options(options);
    let mut known: Vec<Known<S>> = (0..2)
        .map(|body| {
            let (triangles, flat) = sheet(5 + random.below(7));
            let wave = |[x, y, _]: [f32; 3]| [x, y, 0.1 * (7.0 * x * y + body as f32).sin()];
            let positions = flat.iter().map(|&it| wave(it).map(|x| S::of(f64::from(x))));
            let positions: Vec<[S; 3]> = positions.collect();
            let id = world.add(&triangles, &positions).unwrap();
            Known::new(id, &triangles, &positions)
        })
        .collect();
    let radius = 0.01;
    let mut done = 0;
    while done < edits {
        let which = random.below(2) as usize;
        let id = known[which].id;
        match random.below(12) {
            0 | 1 => {
                let body = &mut known[which];
                for position in body.positions.iter_mut().flatten() {
                    let moved =
                        position.map(|x| S::of(x.to_f64() + f64::from(random.unit() - 0.5) * 0.04));
                    *position = moved;
                }
                body.end = None;
                let rows = body.rows(&mut random);
                world.set_positions(id, &rows).unwrap();
            }
            2 => {
                let body = &mut known[which];
                let mut end = body.rows(&mut random);
                for (row, position) in end.iter_mut().zip(&body.positions) {
                    if position.is_some() {
                        let away = f64::from(random.unit() - 0.5) * 0.1;
                        *row = row.map(|x| S::of(x.to_f64() + away));
                    }
                }
                world.set_motion(id, &end).unwrap();
                body.end = Some(end);
            }
            3 if random.below(4) == 0 => world.rebuild(id).unwrap(),
            4 if random.below(3) == 0 => {
                let body = &mut known[which];
                for group in &mut body.groups {
                    *group = random.below(8).saturating_sub(5);
                }
                world.set_vertex_groups(id, &body.groups).unwrap();
            }
            6 if random.below(3) == 0 => {
                let body = &mut known[which];
                let rows = body.rows(&mut random);
                body.rest = (random.below(3) > 0).then_some(rows);
                let rest = body.rest.as_deref();
                world.set_rest_positions(id, rest).unwrap();
            }
            7 if random.below(3) == 0 => {
                let count = world.triangles(id).unwrap().len();
                let mut label = || match random.below(5) {
                    0 => Labels::NONE,
                    label => label,
                };
                let of_triangles: Vec<u32> = (0..count).map(|_| label()).collect();
                let pairs = [[label(), label()]];
                let neighbours = (label() > 2).then_some(&pairs[..]);
                let labels = Labels {
                    of_triangles: &of_triangles,
                    neighbours,
                };
                world
                    .set_labels(id, (label() != 1).then_some(labels))
                    .unwrap();
            }
            5 if random.below(3) == 0 => {
                other_mesh(&mut world, &mut known[which], &mut random);
            }
            _ => {
                let before = known[which].clone();
                let mut edit = world.edit(id).unwrap();
                for _ in 0..=random.below(3) {
                    step(&mut edit, &mut known[which], &mut random);
                }
                let expected = finish(&before, &mut known[which]);
                let edited = world.apply(&edit).unwrap();
                assert_eq!(edited, expected);
                let has_new_numbers = known[which].triangles.len() > before.triangles.len();
                if expected == Edited::default() && !has_new_numbers {
                    // Nothing has changed: a motion goes on.
                    known[which].end = before.end;
                }
                done += 1;
            }
        }
        if random.below(40) == 0 {
            world = world.clone();
        }
        check(&mut world, &mut known, options, radius);
    }
    done
}

#[test]
fn edited_worlds_equal_fresh_ones() {
    let all = every_configuration();
    let edits: usize = std::env::var("EDITS").map_or(share(600, 2), |edits| edits.parse().unwrap());
    let mut done = 0;
    for (seed, options) in (0..).zip(all.iter().cycle().step_by(37)) {
        done += life::<f32>(*options, seed, 10);
        done += life::<f64>(*options, seed + 500_000, 10);
        if done >= edits {
            break;
        }
    }
    println!("{done} edits");
}

/// Vertices without a triangle may exist from the start, until an edit gives them one.
#[test]
fn a_triangle_of_vertices_that_none_had_is_met() {
    let far = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [9.0, 0.0, 0.0],
        [9.0, 1.0, 0.0],
        [9.0, 0.0, 1.0],
    ];
    let through = [[8.0, 0.25, 0.25], [10.0, 0.25, 0.25], [8.0, 0.25, 0.5]];
    for options in every_configuration() {
        let mut world = World::<f64>::with_options(options);
        let body = world.add(&[[0, 1, 2]], &far).unwrap();
        world.add(&[[0, 1, 2]], &through).unwrap();
        assert_eq!(world.intersections(Selection::World).all().unwrap(), []);
        let mut edit = world.edit(body).unwrap();
        let triangle = edit.add_triangle([3, 4, 5]);
        world.apply(&edit).unwrap();
        let pairs = world.intersections(Selection::World).all().unwrap();
        let pairs: Vec<_> = pairs.iter().map(Pair::triangles).collect();
        assert_eq!(pairs, [[triangle, 0]]);
    }
}

/// A mesh that is set has no empty number, even if it is the mesh that an edit left.
#[test]
fn a_mesh_that_is_set_has_all_its_vertices() {
    let shape = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [5.0; 3],
        [7.0; 3],
    ];
    let mut world = World::<f32>::new();
    let body = world.add(&[[0, 1, 2]], &shape).unwrap();
    let mut edit = world.edit(body).unwrap();
    edit.merge_vertices(0, 3);
    assert_eq!(world.apply(&edit).unwrap().removed_vertices, [3]);
    assert_eq!(
        world.live_vertices(body).unwrap(),
        [true, true, true, false, true]
    );
    world.set_mesh(body, &[[0, 1, 2]], &shape).unwrap();
    assert_eq!(world.live_vertices(body).unwrap(), [true; 5]);
    assert_eq!(world.positions(body).unwrap()[3], [5.0; 3]);
    // A triangle comes and goes, and the mesh is set to the one that is left.
    let mut edit = world.edit(body).unwrap();
    let added = edit.add_triangle([0, 1, 4]);
    world.apply(&edit).unwrap();
    let mut edit = world.edit(body).unwrap();
    edit.remove_triangle(added);
    world.apply(&edit).unwrap();
    world.set_mesh(body, &[[0, 1, 2]], &shape).unwrap();
    assert_eq!(world.triangle_count(body).unwrap(), 1);
    world.validate().unwrap();
}

/// A vertex is as thick as the one that it was split from, or else as the thickest.
#[test]
fn new_vertices_have_a_thickness() {
    let (triangles, positions) = sheet(3);
    let mut world = World::<f32>::new();
    let body = world.add(&triangles, &positions).unwrap();
    let mut thickness: Vec<f64> = (0..9).map(|vertex| f64::from(vertex) / 64.0).collect();
    world.set_vertex_thickness(body, &thickness).unwrap();
    let mut edit = world.edit(body).unwrap();
    edit.split_vertex(1, &[0]);
    edit.add_vertex([0.5, 0.5, 0.25]);
    world.apply(&edit).unwrap();
    thickness.extend([thickness[1], thickness[8]]);
    assert_eq!(world.thickness(body), Ok(thickness));
}

/// The triangle that was nearest the last time is removed, and is not the nearest any more.
#[test]
fn what_is_removed_is_at_no_distance() {
    let (triangles, flat) = sheet(12);
    let mut above: Vec<[f32; 3]> = flat.iter().map(|[x, y, _]| [*x, *y, 1.0]).collect();
    above[0][2] = 0.5;
    for options in every_configuration().into_iter().step_by(7) {
        let mut world = World::<f32>::with_options(options);
        let [a, b] = [&flat, &above].map(|at| world.add(&triangles, at).unwrap());
        let distance = |world: &mut World<f32>| {
            let nearest = world.distance(a, b, 9.0).unwrap();
            nearest.map(|nearest| nearest.distance)
        };
        assert_eq!(distance(&mut world), Some(0.5));
        let at_corner = triangles.iter().position(|corners| corners.contains(&0));
        let mut edit = world.edit(b).unwrap();
        edit.remove_triangle(at_corner.unwrap() as u32);
        world.apply(&edit).unwrap();
        assert_eq!(distance(&mut world), Some(1.0), "{options:?}");
    }
}

/// Boxes of a motion that an edit ended are not taken for boxes of the next motion.
#[test]
fn the_motion_after_an_edit_is_another() {
    let shape = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let there = shape.map(|[x, y, _]| [x, y, 9.0]);
    let away = shape.map(|[x, y, _]| [x, y, -9.0]);
    for options in every_configuration() {
        let mut world = World::<f32>::with_options(options);
        let body = world.add(&[[0, 1, 2]], &shape).unwrap();
        let sheets = [5.0, -5.0]
            .map(|z| shape.map(|[x, y, _]| [x, y, z]))
            .concat();
        let other = world.add(&[[0, 1, 2], [3, 4, 5]], &sheets).unwrap();
        let of = Selection::Between(body, other);
        let met = |world: &mut World<f32>| -> BTreeSet<u32> {
            let met = world.vertex_triangle_impacts(of).all().unwrap();
            let met = met.iter().filter(|it| it.pair.vertex_body == body);
            met.map(|it| it.pair.triangle).collect()
        };
        world.set_motion(body, &away).unwrap();
        assert_eq!(met(&mut world), BTreeSet::from([1]));
        let mut edit = world.edit(body).unwrap();
        edit.add_vertex([0.5, 0.5, 0.0]);
        world.apply(&edit).unwrap();
        let end = [there[0], there[1], there[2], [0.5, 0.5, 9.0]];
        world.set_motion(body, &end).unwrap();
        world.validate().unwrap();
        assert_eq!(met(&mut world), BTreeSet::from([0]));
    }
}

/// Removes, splits or adds at random, so that edges come and go.
fn some_edit(world: &mut World<f32>, body: BodyId, random: &mut Lcg) {
    let live = world.live_triangles(body).unwrap();
    let live: Vec<u32> = (0..).zip(live).filter(|it| it.1).map(|it| it.0).collect();
    let mut some = || live[random.below(live.len() as u32) as usize];
    let (one, other) = (some(), some());
    let corners = world.triangles(body).unwrap()[one as usize];
    let mut edit = world.edit(body).unwrap();
    match other % 3 {
        0 => edit.remove_triangle(one),
        1 => drop(edit.split_vertex(corners[0], &[one])),
        _ => {
            let vertex = edit.add_vertex([other as f32, 0.5, 1.0]);
            edit.set_triangle(one, [corners[0], corners[1], vertex]);
        }
    }
    world.apply(&edit).unwrap();
}

/// Edges keep their numbers once somebody has asked for them.
///
/// A world may be copied, its trees may be built anew or mend themselves, and it may be written
/// down and read.
#[test]
fn numbers_of_edges_stay_in_copies_and_whatever_becomes_of_trees() {
    let (triangles, positions) = sheet(8);
    let mut random = Lcg(6);
    for is_asked in [true, false] {
        let mut world = World::<f32>::new();
        let body = world.add(&triangles, &positions).unwrap();
        if is_asked {
            world.edges(body).unwrap();
        }
        let mut rebuilt = world.clone();
        rebuilt.rebuild(body).unwrap();
        let mut worlds = vec![world.clone(), rebuilt.clone(), rebuilt, world];
        for round in 0..30 {
            let seed = random.below(u32::MAX);
            for world in &mut worlds {
                some_edit(world, body, &mut Lcg(seed.into()));
            }
            if round % 5 == 4 {
                let copy = worlds[0].clone();
                worlds[0] = copy;
                worlds[1].rebuild(body).unwrap();
            }
            if round % 3 == 2 {
                let all: Vec<_> = worlds.iter().map(|it| it.edges(body).unwrap()).collect();
                assert!(
                    all.iter().all(|edges| *edges == all[0]),
                    "{is_asked}, {round}"
                );
            }
        }
        worlds.iter().for_each(|world| world.validate().unwrap());
    }
}

/// Edge numbers that were written down give another world the same rows, now and after more edits.
#[test]
fn numbers_of_edges_are_taken_over() {
    let (triangles, positions) = sheet(6);
    for round in 0..40 {
        let mut random = Lcg(round);
        let mut world = World::<f32>::new();
        let body = world.add(&triangles, &positions).unwrap();
        assert_eq!(world.numbered_edges(body), Ok(None));
        world.edges(body).unwrap();
        for _ in 0..random.below(12) {
            some_edit(&mut world, body, &mut random);
        }
        let numbers = world.numbered_edges(body).unwrap().unwrap().to_vec();
        assert_eq!(numbers, world.edges(body).unwrap());

        // As a reader does it: empty triangles get any corners, and are removed again.
        let (now, mut rows) = (
            world.triangles(body).unwrap(),
            world.positions(body).unwrap(),
        );
        let live = world.live_triangles(body).unwrap();
        let some = now[live.iter().position(|&it| it).unwrap()];
        let fill = |(it, is_live): (&[u32; 3], &bool)| if *is_live { *it } else { some };
        let filled: Vec<_> = now.iter().zip(&live).map(fill).collect();
        let empty: Vec<u32> = (0..)
            .zip(world.live_vertices(body).unwrap())
            .filter(|it| !it.1)
            .map(|it| it.0)
            .collect();
        for &vertex in &empty {
            rows[vertex as usize] = rows[some[0] as usize];
        }
        let mut other = World::<f32>::new();
        other.add(&filled, &rows).unwrap();
        let mut edit = other.edit(body).unwrap();
        let gone = (0..).zip(&live).filter(|it| !it.1).map(|it| it.0);
        edit.remove_triangles(&gone.collect::<Vec<u32>>());
        for vertex in empty {
            edit.merge_vertices(some[0], vertex);
        }
        other.apply(&edit).unwrap();

        // Other numbers are refused, and so are numbers for edges that already have some.
        let first = numbers.iter().position(|it| *it != [u32::MAX; 2]).unwrap();
        let mut another = numbers.clone();
        another[first] = [0, 0];
        let mut missing = numbers.clone();
        missing[first] = [u32::MAX; 2];
        let twice = [&numbers[..], &[numbers[first]]].concat();
        for bad in [another, missing, twice, vec![]] {
            assert_eq!(other.clone().number_edges(body, &bad), Ok(false));
        }
        assert_eq!(other.number_edges(body, &numbers), Ok(true));
        assert_eq!(other.number_edges(body, &numbers), Ok(false));
        other.validate().unwrap();
        for _ in 0..6 {
            let seed = u64::from(random.below(u32::MAX));
            for world in [&mut world, &mut other] {
                some_edit(world, body, &mut Lcg(seed));
            }
            assert_eq!(world.edges(body), other.edges(body));
            let of = Selection::Within(body);
            assert_eq!(
                world.edge_edge_candidates(of, 0.1).all(),
                other.edge_edge_candidates(of, 0.1).all()
            );
            other.validate().unwrap();
        }
    }
}
