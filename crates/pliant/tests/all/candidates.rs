//! Candidates within a margin, and close pairs: every configuration gives the reference's lists.
//!
//! Candidates are asked for at rest and in motion, at every step of random lives of worlds. Bodies
//! move, turn back, stop on the way, are pinned, kept apart and given other meshes.

use crate::common::{Lcg, every_configuration, share, sheet};
use pliant::reference::{self, Moving};
use pliant::{
    BodyId, CloseEdgeEdge, CloseVertexTriangle, ClosestFeatures, EdgeEdge, ErrorKind, Labels,
    Options, Pair, Scalar, Selection, VertexTriangle, World,
};
use pliant_exact::Length;
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

/// The test's own copy of a body.
#[derive(Clone, Debug)]
struct Known<S> {
    id: BodyId,
    triangles: Vec<[u32; 3]>,
    positions: Vec<[S; 3]>,
    end: Option<Vec<[S; 3]>>,
    groups: Option<Vec<u32>>,
    rest: Option<Vec<[S; 3]>>,
    thickness: Option<Vec<f64>>,
    labels: Option<OwnLabels>,
}

/// Labels of triangles, and which of them are neighbours.
type OwnLabels = (Vec<u32>, Option<Vec<[u32; 2]>>);

impl<S> Known<S> {
    fn labels(&self) -> Option<Labels<'_>> {
        let labels = self.labels.as_ref();
        labels.map(|(of_triangles, neighbours)| Labels {
            of_triangles,
            neighbours: neighbours.as_deref(),
        })
    }

    fn moving(&self) -> Moving<'_, S> {
        Moving {
            triangles: &self.triangles,
            positions: &self.positions,
            end: self.end.as_deref(),
            groups: self.groups.as_deref(),
            rest: self.rest.as_deref(),
            thickness: self.thickness.as_deref(),
            labels: self.labels(),
        }
    }
}

/// A question to ask of every selection.
#[derive(Clone, Copy, Debug)]
enum Question {
    /// Candidates of a margin.
    Near(f64),
    /// Pairs at most this far apart.
    Close(f64),
}

use Question::{Close, Near};

/// Pairs of vertices with triangles, and of edges with edges.
#[derive(Clone, Debug, Default, PartialEq)]
struct Lists {
    vertex_triangle: Vec<VertexTriangle>,
    edge_edge: Vec<EdgeEdge>,
}

impl Lists {
    fn two<S: Scalar>(&mut self, a: &Known<S>, b: &Known<S>, asked: Question) {
        for (of, with) in [(a, b), (b, a)] {
            let (of_them, with_them) = (of.moving(), with.moving());
            let pairs = match asked {
                Near(radius) => reference::vertex_triangle_pairs(&of_them, &with_them, radius),
                Close(distance) => {
                    reference::close_vertex_triangle_pairs(&of_them, &with_them, distance)
                }
            };
            let row = |[vertex, triangle]: [u32; 2]| VertexTriangle {
                vertex_body: of.id,
                vertex,
                triangle_body: with.id,
                triangle,
            };
            self.vertex_triangle
                .extend(pairs.unwrap().into_iter().map(row));
        }
        let pairs = match asked {
            Near(radius) => reference::edge_edge_pairs(&a.moving(), &b.moving(), radius),
            Close(distance) => reference::close_edge_edge_pairs(&a.moving(), &b.moving(), distance),
        };
        let row = |[edge_a, edge_b]: [u32; 2]| EdgeEdge {
            body_a: a.id,
            edge_a,
            body_b: b.id,
            edge_b,
        };
        self.edge_edge.extend(pairs.unwrap().into_iter().map(row));
    }

    fn one<S: Scalar>(&mut self, body: &Known<S>, asked: Question) {
        let id = body.id;
        let pairs = match asked {
            Near(radius) => reference::self_vertex_triangle_pairs(&body.moving(), radius),
            Close(distance) => {
                reference::self_close_vertex_triangle_pairs(&body.moving(), distance)
            }
        };
        let row = |[vertex, triangle]: [u32; 2]| VertexTriangle {
            vertex_body: id,
            vertex,
            triangle_body: id,
            triangle,
        };
        self.vertex_triangle
            .extend(pairs.unwrap().into_iter().map(row));
        let pairs = match asked {
            Near(radius) => reference::self_edge_edge_pairs(&body.moving(), radius),
            Close(distance) => reference::self_close_edge_edge_pairs(&body.moving(), distance),
        };
        let row = |[edge_a, edge_b]: [u32; 2]| EdgeEdge {
            body_a: id,
            edge_a,
            body_b: id,
            edge_b,
        };
        self.edge_edge.extend(pairs.unwrap().into_iter().map(row));
    }

    fn extend(&mut self, other: &Self) {
        self.vertex_triangle.extend(&other.vertex_triangle);
        self.edge_edge.extend(&other.edge_edge);
    }

    /// Turns pairs of edges round: the second body comes first.
    fn turned(mut self) -> Self {
        for pair in &mut self.edge_edge {
            *pair = EdgeEdge {
                body_a: pair.body_b,
                edge_a: pair.edge_b,
                body_b: pair.body_a,
                edge_b: pair.edge_a,
            };
        }
        self
    }

    fn sorted(mut self) -> Self {
        self.vertex_triangle.sort_unstable();
        self.edge_edge.sort_unstable();
        self
    }
}

/// The world's lists; asserts that *first*, *visit_some* and *at_most* agree with *all*.
fn ask<S: Scalar>(
    world: &mut World<S>,
    known: &[Known<S>],
    of: Selection,
    asked: Question,
) -> Lists {
    macro_rules! asked {
        ($ask:ident, $with:expr, $key:expr) => {{
            let all = world.$ask(of, $with).all().unwrap().to_vec();
            let first = world.$ask(of, $with).first().unwrap();
            assert_eq!(first.is_some(), !all.is_empty());
            assert!(first.is_none_or(|first| all.contains(&first)));
            let mut shown = Vec::new();
            let visited = world.$ask(of, $with).visit_some(|some| {
                assert!(!some.is_empty());
                shown.extend_from_slice(some);
                ControlFlow::<()>::Continue(())
            });
            assert!(visited.unwrap().is_continue());
            shown.sort_unstable_by_key($key);
            assert_eq!(shown, all);
            if let Some(fewer) = all.len().checked_sub(1) {
                let refused = world.$ask(of, $with).at_most(fewer).all().unwrap_err();
                assert_eq!(refused.kind, ErrorKind::TooManyHits { limit: fewer });
                assert_eq!(world.$ask(of, $with).at_most(all.len()).all().unwrap(), all);
                let stopped = || true;
                let refused = world.$ask(of, $with).interrupt_if(&stopped).all();
                assert_eq!(refused.unwrap_err().kind, ErrorKind::Interrupted);
            }
            all
        }};
    }
    let lists = match asked {
        Near(radius) => Lists {
            vertex_triangle: asked!(vertex_triangle_candidates, radius, |&hit| hit),
            edge_edge: asked!(edge_edge_candidates, radius, |&hit| hit),
        },
        Close(distance) => {
            let vertex_triangle = asked!(close_vertex_triangle_pairs, distance, |hit| hit.pair);
            let edge_edge = asked!(close_edge_edge_pairs, distance, |hit| hit.pair);
            let thick = known
                .iter()
                .flat_map(|body| body.thickness.iter().flatten());
            let distance = distance + 2.0 * thick.copied().fold(0.0, f64::max);
            for hit in &vertex_triangle {
                check_vertex_triangle(known, hit, distance);
            }
            for hit in &edge_edge {
                let edge = |body, edge: u32| world.edges(body).unwrap()[edge as usize];
                let of_a = edge(hit.pair.body_a, hit.pair.edge_a);
                let of_b = edge(hit.pair.body_b, hit.pair.edge_b);
                check_edge_edge(known, hit, [of_a, of_b], distance);
            }
            Lists {
                vertex_triangle: vertex_triangle.iter().map(|hit| hit.pair).collect(),
                edge_edge: edge_edge.iter().map(|hit| hit.pair).collect(),
            }
        }
    };
    world.validate().unwrap();
    assert!(lists.edge_edge.is_sorted_by(|a, b| a < b));
    as_the_reference(world, known, lists)
}

/// Lists with the reference's numbers of edges, which are sorted.
///
/// A body's edges keep their numbers when it gets another mesh.
fn as_the_reference<S: Scalar>(
    world: &mut World<S>,
    known: &[Known<S>],
    mut lists: Lists,
) -> Lists {
    let mut numbers = BTreeMap::new();
    for body in known {
        let of_them = reference::edges(&body.triangles);
        let are_some = |ends: &&[u32; 2]| **ends != [u32::MAX; 2];
        let ends = world.edges(body.id).unwrap();
        assert_eq!(ends.iter().filter(are_some).count(), of_them.len());
        for (edge, ends) in (0..).zip(ends).filter(|(_, ends)| are_some(ends)) {
            let number = of_them.binary_search(ends).unwrap();
            numbers.insert((body.id, edge), number as u32);
        }
    }
    for pair in &mut lists.edge_edge {
        let a = (pair.body_a, numbers[&(pair.body_a, pair.edge_a)]);
        let b = (pair.body_b, numbers[&(pair.body_b, pair.edge_b)]);
        let both = if a.0 == b.0 {
            [a.min(b), a.max(b)]
        } else {
            [a, b]
        };
        [(pair.body_a, pair.edge_a), (pair.body_b, pair.edge_b)] = both;
    }
    lists.sorted()
}

fn of_body<S>(known: &[Known<S>], id: BodyId) -> &Known<S> {
    known.iter().find(|body| body.id == id).unwrap()
}

fn check_vertex_triangle<S: Scalar>(known: &[Known<S>], hit: &CloseVertexTriangle, most: f64) {
    let of_vertex = of_body(known, hit.pair.vertex_body);
    let of_triangle = of_body(known, hit.pair.triangle_body);
    let corners = of_triangle.triangles[hit.pair.triangle as usize];
    let vertex = (1.0, of_vertex.positions[hit.pair.vertex as usize]);
    let corner = |place: usize| {
        let position = of_triangle.positions[corners[place] as usize];
        (-hit.barycentric[place], position)
    };
    let sum = [vertex, corner(0), corner(1), corner(2)];
    check_figures(&sum, hit.distance, hit.direction, most);
}

fn check_edge_edge<S: Scalar>(
    known: &[Known<S>],
    hit: &CloseEdgeEdge,
    [of_a, of_b]: [[u32; 2]; 2],
    most: f64,
) {
    let at = |body: BodyId, vertex: u32| of_body(known, body).positions[vertex as usize];
    let [a, b] = [0, 1].map(|place| {
        let a = at(hit.pair.body_a, of_a[place]);
        let b = at(hit.pair.body_b, of_b[place]);
        [
            (hit.barycentric_a[place], a),
            (-hit.barycentric_b[place], b),
        ]
    });
    check_figures(&[a, b].concat(), hit.distance, hit.direction, most);
}

/// Checks that the weighted sum of corners has the distance and the direction of the hit.
fn check_figures<S: Scalar>(
    sum: &[(f64, [S; 3])],
    distance: f64,
    direction: Option<[f64; 3]>,
    most: f64,
) {
    assert!(distance <= most * (1.0 + 1e-9), "{distance} of {most}");
    assert!(sum.iter().all(|(part, _)| part.abs() <= 1.0));
    let at = |axis: usize| sum.iter().map(move |(part, at)| part * at[axis].to_f64());
    let way = [0, 1, 2].map(|axis| at(axis).sum::<f64>());
    let size = (0..3)
        .flat_map(at)
        .fold(0.0, |size: f64, x| size.max(x.abs()));
    if !(1e-100..=1e100).contains(&size) {
        return;
    }
    let slack = 1e-9 * distance + 1e-14 * size;
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((length - distance).abs() <= slack, "{way:?} {distance}");
    match direction {
        None => assert!(distance == 0.0),
        Some(direction) => {
            for axis in 0..3 {
                let off = direction[axis] * distance - way[axis];
                assert!(off.abs() <= slack, "{way:?} {direction:?} {distance}");
            }
        }
    }
}

/// Asks every selection, and compares with the reference.
fn check<S: Scalar>(
    world: &mut World<S>,
    known: &[Known<S>],
    apart: &[[BodyId; 2]],
    asked: Question,
    when: &str,
) {
    let options = *world.options();
    let meet = |a: BodyId, b: BodyId| !apart.contains(&[a.min(b), a.max(b)]);
    let (mut all, mut between) = (Lists::default(), Lists::default());
    for (at, a) in known.iter().enumerate() {
        let mut own = Lists::default();
        own.one(a, asked);
        let own = own.sorted();
        assert_eq!(
            ask(world, known, Selection::Within(a.id), asked),
            own,
            "{when}, {options:?}"
        );
        if meet(a.id, a.id) {
            all.extend(&own);
        }
        if let Close(distance) = asked {
            check_triangles(world, a, distance, when);
        }
        for b in &known[at + 1..] {
            let mut two = Lists::default();
            two.two(a, b, asked);
            if meet(a.id, b.id) {
                between.extend(&two);
                all.extend(&two);
            }
            for (of, two) in [([a, b], two.clone()), ([b, a], two.turned())] {
                let of = Selection::Between(of[0].id, of[1].id);
                assert_eq!(
                    ask(world, known, of, asked),
                    two.sorted(),
                    "{when}, {of:?}, {options:?}"
                );
            }
        }
    }
    assert_eq!(
        ask(world, known, Selection::World, asked),
        between.sorted(),
        "{when}, {options:?}"
    );
    assert_eq!(
        ask(world, known, Selection::Everything, asked),
        all.sorted(),
        "{when}, {options:?}"
    );
}

/// Asks for the intersections of a body with itself, and compares with the reference.
fn check_intersections<S: Scalar>(world: &mut World<S>, body: &Known<S>, when: &str) {
    let all = reference::self_intersection_pairs(&body.triangles, &body.positions);
    let mut all = all.unwrap();
    reference::leave_out(&body.moving(), &mut all);
    let of = Selection::Within(body.id);
    let first = world.intersections(of).first().unwrap();
    assert_eq!(first.is_some(), !all.is_empty(), "{when}");
    assert!(first.is_none_or(|first| all.contains(&first.triangles())));
    let found = world.intersections(of).all().unwrap().iter();
    assert!(found.map(Pair::triangles).eq(all.iter().copied()), "{when}");
    let found = world.contacts(of).all().unwrap().iter();
    assert!(found.map(|it| it.pair.triangles()).eq(all), "{when}");
}

/// Asks for the close triangles of a body with itself, and compares with the reference.
fn check_triangles<S: Scalar>(world: &mut World<S>, body: &Known<S>, distance: f64, when: &str) {
    let thick = |triangle: [u32; 3]| {
        let of = |vertex: u32| {
            body.thickness
                .as_ref()
                .map_or(0.0, |all| all[vertex as usize])
        };
        triangle.map(of).into_iter().fold(0.0, f64::max)
    };
    // Whether two triangles are surely close, and whether they possibly are.
    let close = |positions: &[[S; 3]], pair: [[u32; 3]; 2]| -> [bool; 2] {
        let [a, b] = pair.map(thick);
        let [least, most] = Length::sum([distance, a, b]).bounds();
        let are_within = |length: f64| {
            let found = reference::self_close_triangle_pairs(&pair, positions, length);
            !found.unwrap().is_empty()
        };
        let possibly = are_within(most);
        [possibly && (least == most || are_within(least)), possibly]
    };
    let (mut sure, mut possible) = (BTreeSet::new(), BTreeSet::new());
    for (i, &a) in (0..).zip(&body.triangles) {
        for (j, &b) in (0..).zip(&body.triangles).skip(i as usize + 1) {
            let [are_close, may_be_close] = close(&body.positions, [a, b]);
            if !may_be_close {
                continue;
            }
            let rest = body.rest.as_deref();
            let at_rest = rest.map_or([false; 2], |rest| close(rest, [a, b]));
            if are_close && !at_rest[1] {
                sure.insert([i, j]);
            }
            if !at_rest[0] {
                possible.insert([i, j]);
            }
        }
    }
    let stay = |pairs: BTreeSet<[u32; 2]>| {
        let mut pairs = pairs.into_iter().collect();
        reference::leave_out(&body.moving(), &mut pairs);
        pairs.into_iter().collect::<BTreeSet<_>>()
    };
    let [sure, possible] = [sure, possible].map(stay);
    let of = Selection::Within(body.id);
    let found = world.close_triangle_pairs(of, distance).all().unwrap();
    let found: BTreeSet<_> = found.iter().map(|close| close.pair.triangles()).collect();
    assert!(
        sure.is_subset(&found) && found.is_subset(&possible),
        "{when}"
    );
}

/// Meshes with adjacency of every kind.
fn mesh(random: &mut Lcg) -> (Vec<[u32; 3]>, usize) {
    match random.below(6) {
        // A sheet, with a vertex that nothing uses.
        0 => {
            let side = 2 + random.below(5);
            (sheet(side).0, (side * side) as usize + 1)
        }
        // A fan, with duplicates of triangles.
        1 => {
            let rim = 3 + random.below(12);
            let fan = (1..rim).map(|at| [0, at, at + 1]);
            (fan.clone().chain(fan.take(2)).collect(), rim as usize + 1)
        }
        // Many triangles at one edge.
        2 => {
            let leaves = 1 + random.below(12);
            (
                (0..leaves).map(|at| [at + 2, 0, 1]).collect(),
                leaves as usize + 2,
            )
        }
        // Segments and points among others.
        3 => {
            let degenerate = vec![[0, 1, 1], [2, 2, 2], [3, 4, 5], [5, 5, 0], [0, 1, 2]];
            (degenerate, 6)
        }
        // A soup: triangles that share no vertex.
        4 => {
            let triangles = 1 + random.below(20);
            let soup = (0..triangles).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]);
            (soup.collect(), 3 * triangles as usize)
        }
        // A tangle: random corners over few vertices.
        _ => {
            let vertices = 3 + random.below(9);
            let corner = |random: &mut Lcg| random.below(vertices);
            let triangles = (0..=random.below(24)).map(|_| [(); 3].map(|()| corner(random)));
            (triangles.collect(), vertices as usize)
        }
    }
}

#[expect(clippy::too_many_lines, reason = "one arm a call of the library")]
fn lives<S: Scalar>(
    seeds: std::ops::Range<u64>,
    (threads, close_every): (usize, u32),
    here: f64,
    of: fn(f64) -> S,
    cast: fn(f64) -> S,
) {
    let configurations = every_configuration();
    let lives = share(seeds.clone().count(), 3);
    for seed in seeds.take(lives) {
        let random = &mut Lcg(seed);
        let mut options: Options =
            configurations[random.below(configurations.len() as u32) as usize];
        options.threads = NonZeroUsize::new(threads).unwrap();
        let mut world = World::<S>::with_options(options);
        // On a lattice many gaps are the margin to the last bit; elsewhere few are.
        let unit = [1.0, 0.125, 0.1, 1e-3][random.below(4) as usize];
        let is_lattice = random.below(2) == 0;
        let place = |random: &mut Lcg| {
            [(); 3].map(|()| {
                let x = if is_lattice {
                    f64::from(random.below(9))
                } else {
                    f64::from(random.unit()) * 9.0
                };
                of(here + unit * x)
            })
        };
        let shape = |random: &mut Lcg, vertices: usize| -> Vec<[S; 3]> {
            (0..vertices).map(|_| place(random)).collect()
        };
        let mut known: Vec<Known<S>> = Vec::new();
        let mut apart: Vec<[BodyId; 2]> = Vec::new();
        for step in 0..14 {
            let some = random.below(known.len().max(1) as u32) as usize;
            match random.below(15) {
                _ if known.is_empty() => {}
                0..=3 => {
                    let body = &mut known[some];
                    let mut end = body.positions.clone();
                    match random.below(4) {
                        0 => end = shape(random, end.len()),
                        1 => end[0] = place(random),
                        2 => end.iter_mut().for_each(|p| p[1] = of(p[1].to_f64() + unit)),
                        _ => {}
                    }
                    world.set_motion(body.id, &end).unwrap();
                    assert_eq!(world.end_positions(body.id).unwrap().as_ref(), Some(&end));
                    body.end = Some(end);
                }
                4 => {
                    world.finish_motion();
                    for body in &mut known {
                        body.positions = body.end.take().unwrap_or(body.positions.clone());
                    }
                }
                5 => {
                    let t = [0.0, 0.25, f64::from(random.unit()), 1.0][random.below(4) as usize];
                    world.advance_motion(t).unwrap();
                    for body in &mut known {
                        let Some(end) = body.end.take() else {
                            continue;
                        };
                        let now = body.positions.as_flattened_mut().iter_mut();
                        for (x, end) in now.zip(end.as_flattened()) {
                            let (from, to) = (x.to_f64(), end.to_f64());
                            let there = from + t * (to - from);
                            *x = cast(there.min(from.max(to)).max(from.min(to)));
                            if t == 1.0 {
                                *x = *end;
                            }
                        }
                    }
                }
                6 => {
                    let body = &mut known[some];
                    body.positions = shape(random, body.positions.len());
                    world.set_positions(body.id, &body.positions).unwrap();
                    body.end = None;
                }
                7 => {
                    let body = &mut known[some];
                    let of_vertex = |_| random.below(3);
                    let groups: Vec<u32> = (0..body.positions.len()).map(of_vertex).collect();
                    world.set_vertex_groups(body.id, &groups).unwrap();
                    assert_eq!(world.vertex_groups(body.id).unwrap(), groups);
                    body.groups = Some(groups);
                }
                8 => {
                    let body = &mut known[some];
                    let (triangles, vertices) = mesh(random);
                    let positions = shape(random, vertices);
                    let is_other =
                        (&triangles, vertices) != (&body.triangles, body.positions.len());
                    world.set_mesh(body.id, &triangles, &positions).unwrap();
                    let groups = body.groups.take().filter(|_| !is_other);
                    let rest = body.rest.take().filter(|_| !is_other);
                    let labels = body.labels.take().filter(|_| !is_other);
                    let mut thickness = body.thickness.take();
                    if let Some(all) = thickness.as_mut().filter(|_| is_other) {
                        // Other vertices are as thick as the thickest was.
                        *all = vec![all.iter().copied().fold(0.0, f64::max); vertices];
                    }
                    let id = body.id;
                    *body = Known {
                        id,
                        triangles,
                        positions,
                        end: None,
                        groups,
                        rest,
                        thickness,
                        labels,
                    };
                }
                9 => {
                    let pair = [
                        known[some].id,
                        known[random.below(known.len() as u32) as usize].id,
                    ];
                    world.ignore(pair[0], pair[1]).unwrap();
                    apart.push([pair[0].min(pair[1]), pair[0].max(pair[1])]);
                }
                12 => {
                    // All are as thick, or each is for itself.
                    let body = &mut known[some];
                    let mut thick = || match random.below(4) {
                        0 => 0.0,
                        1 => unit / 2.0,
                        2 => f64::from(random.unit()) * unit,
                        _ => [5e-324, 1e-300, 3.0 * unit, 0.1 * unit][random.below(4) as usize],
                    };
                    let one = thick();
                    let mut all = vec![one; body.positions.len()];
                    if thick() > 0.0 {
                        world.set_thickness(body.id, one).unwrap();
                    } else {
                        all.iter_mut().for_each(|it| *it = thick());
                        world.set_vertex_thickness(body.id, &all).unwrap();
                    }
                    assert_eq!(world.thickness(body.id).unwrap(), all);
                    body.thickness = Some(all);
                }
                13 => {
                    let body = &mut known[some];
                    let count = body.triangles.len();
                    body.labels = (random.below(4) > 0).then(|| {
                        let labels = 1 + random.below(9);
                        let label = |random: &mut Lcg| match random.below(8) {
                            0 => Labels::NONE,
                            _ => 5 * random.below(labels),
                        };
                        let of_triangles = (0..count).map(|_| label(random)).collect();
                        let pairs = 0..random.below(2 * labels);
                        let pairs = pairs.map(|_| [(); 2].map(|()| label(random)));
                        let pairs: Vec<_> = pairs.collect();
                        (of_triangles, (random.below(2) > 0).then_some(pairs))
                    });
                    world.set_labels(body.id, body.labels()).unwrap();
                    assert_eq!(world.labels(body.id), Ok(body.labels()));
                }
                11 => {
                    // Some vertices rest where they are, others elsewhere.
                    let body = &mut known[some];
                    let is_one = random.below(4) > 0;
                    body.rest = is_one.then(|| {
                        let mut rest = body.positions.clone();
                        for at in &mut rest {
                            if random.below(2) == 0 {
                                *at = place(random);
                            }
                        }
                        rest
                    });
                    let rest = body.rest.as_deref();
                    world.set_rest_positions(body.id, rest).unwrap();
                    assert_eq!(world.rest_positions(body.id), Ok(rest));
                }
                10 => {
                    world.rebuild(known[some].id).unwrap();
                    world = world.clone();
                }
                _ => {
                    // Refused calls change nothing.
                    let body = &known[some];
                    let mut end = body.positions.clone();
                    end[0][2] = of(f64::NAN);
                    let refused = world.set_motion(body.id, &end).unwrap_err();
                    assert!(matches!(
                        refused.kind,
                        ErrorKind::BadPosition { vertex: 0, .. }
                    ));
                    assert!(world.set_motion(body.id, &end[1..]).is_err());
                    assert!(world.set_vertex_groups(body.id, &[1]).is_err() || end.len() == 1);
                    for bad in [-1.0, f64::NAN, f64::INFINITY] {
                        let refused = world.set_thickness(body.id, bad).unwrap_err();
                        let kind = refused.kind;
                        assert!(matches!(kind, ErrorKind::BadThickness { vertex: 0, .. }));
                    }
                    assert!(world.set_vertex_thickness(body.id, &[0.0]).is_err() || end.len() == 1);
                    for rest in [&end[..], &end[1..]] {
                        assert!(world.set_rest_positions(body.id, Some(rest)).is_err());
                    }
                    for t in [-0.1, 1.5, f64::NAN] {
                        assert!(matches!(
                            world.advance_motion(t).unwrap_err().kind,
                            ErrorKind::BadTime { .. }
                        ));
                    }
                    for radius in [-1.0, f64::NAN, f64::INFINITY] {
                        let refused = world
                            .edge_edge_candidates(Selection::World, radius)
                            .all()
                            .unwrap_err();
                        assert!(matches!(refused.kind, ErrorKind::BadMargin { .. }));
                        let refused = world.close_edge_edge_pairs(Selection::World, radius).all();
                        let kind = refused.unwrap_err().kind;
                        assert!(matches!(kind, ErrorKind::BadDistance { .. }));
                    }
                }
            }
            if known.len() < 3 && (known.is_empty() || random.below(3) == 0) {
                let (triangles, vertices) = mesh(random);
                let positions = shape(random, vertices);
                let id = world.add(&triangles, &positions).unwrap();
                let (end, groups, rest, thickness, labels) = (None, None, None, None, None);
                known.push(Known {
                    id,
                    triangles,
                    positions,
                    end,
                    groups,
                    rest,
                    thickness,
                    labels,
                });
            }
            // Half of a multiple of the unit is a tie on the lattice. The extreme margins reach
            // everything, or only what touches.
            let radius = match random.below(6) {
                0 => 0.0,
                1 => unit,
                2 => unit / 2.0,
                3 => (unit / 2.0).next_down(),
                4 => f64::from(random.unit()) * unit,
                _ => [f64::MAX, 1e38, 5e-324, 1e-300][random.below(4) as usize],
            };
            let mut questions = vec![Near(radius)];
            // Pairs that touch, or are at the ends of the range, are measured in integers, which
            // takes long.
            if step % close_every == 0 && radius <= 4.0 * unit {
                questions.push(Close(radius));
            }
            for asked in questions {
                let when = format!("seed {seed}, step {step}, {asked:?}");
                check(&mut world, &known, &apart, asked, &when);
            }
            if let Some(body) = known.get(some) {
                // Motions do not change intersections.
                let when = format!("seed {seed}, step {step}");
                check_intersections(&mut world, body, &when);
            }
        }
    }
}

#[test]
fn every_list_is_that_of_the_reference_f32() {
    lives::<f32>(0..60, (1, 3), 0.0, |x| x as f32, |x| x as f32);
}

#[test]
fn every_list_is_that_of_the_reference_f64() {
    lives::<f64>(60..120, (1, 3), 0.0, |x| x, |x| x);
}

#[test]
fn every_list_is_that_of_the_reference_far_away_with_threads() {
    lives::<f32>(120..140, (3, 3), 1000.0, |x| x as f32, |x| x as f32);
    lives::<f64>(140..180, (3, 3), 1e7, |x| x, |x| x);
}

#[test]
fn coordinates_as_small_as_there_are() {
    lives::<f64>(230..245, (1, 6), 0.0, |x| x * 1e-300, |x| x);
    lives::<f32>(245..260, (1, 6), 0.0, |x| (x * 1e-41) as f32, |x| x as f32);
}

#[test]
fn coordinates_as_large_as_there_are() {
    lives::<f64>(
        200..215,
        (1, 6),
        3e38,
        |x| x.clamp(0.0, f32::MAX.into()),
        |x| x,
    );
    lives::<f32>(
        215..230,
        (1, 6),
        0.0,
        |x| (x * 1e37).clamp(-3e38, 3e38) as f32,
        |x| x as f32,
    );
    lives::<f64>(
        260..275,
        (1, 6),
        0.0,
        |x| ((x - 4.0) * 4e37).clamp(-3e38, 3e38),
        |x| x,
    );
}

#[test]
fn everything_is_close_within_the_largest_distances() {
    let random = &mut Lcg(3);
    for round in 0..6 {
        let mut world = World::<f64>::new();
        let scale = [1.0, 1e37][round % 2];
        let known: Vec<Known<f64>> = (0..2)
            .map(|_| {
                let (triangles, vertices) = mesh(random);
                let place = |_| [(); 3].map(|()| (f64::from(random.unit()) - 0.5) * 30.0 * scale);
                let positions: Vec<_> = (0..vertices).map(place).collect();
                let id = world.add(&triangles, &positions).unwrap();
                Known {
                    id,
                    triangles,
                    positions,
                    end: None,
                    groups: None,
                    rest: None,
                    thickness: None,
                    labels: None,
                }
            })
            .collect();
        let mut counts = Vec::new();
        for distance in [1e39, 2e39, f64::MAX] {
            check(&mut world, &known, &[], Close(distance), "the largest");
            let close = world.close_edge_edge_pairs(Selection::World, distance);
            counts.push(close.all().unwrap().len());
        }
        let edges = known
            .iter()
            .map(|body| reference::edges(&body.triangles).len());
        assert_eq!(counts, [edges.product::<usize>(); 3]);
    }
}

/// The closest features are named rightly, for triangles and edges.
///
/// A triangle has a place near each of its seven parts: corners, edges and face.
#[test]
fn the_closest_features_are_named() {
    let random = &mut Lcg(5);
    let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let mut world = World::<f64>::new();
    let triangle = world.add(&[[0, 1, 2]], &corners).unwrap();
    let other = world.add(&[[0, 1, 1]], &[[9.0; 3], [9.5; 3]]).unwrap();
    for _ in 0..2_000 {
        let mut unit = || 0.01 + 0.98 * f64::from(random.unit());
        let (s, t) = (unit(), unit());
        for (at, features) in [
            ([-s, -t, 0.0], ClosestFeatures::VertexVertex),
            ([4.0 + s, -t * s, 0.5], ClosestFeatures::VertexVertex),
            ([4.0 * s, -t, 0.1], ClosestFeatures::VertexEdge),
            ([-t, 4.0 * s, 0.2], ClosestFeatures::VertexEdge),
            (
                [4.0 * s + t, 4.0 - 4.0 * s + t, 0.3],
                ClosestFeatures::VertexEdge,
            ),
            ([2.0 * s, 2.0 * t, t], ClosestFeatures::VertexFace),
        ] {
            let far = at.map(|x| 3.0 * x + 20.0);
            world.set_positions(other, &[at, far]).unwrap();
            let close = world.close_vertex_triangle_pairs(Selection::World, 3.0);
            let found = close.all().unwrap();
            let found = found
                .iter()
                .find(|hit| hit.pair.vertex_body == other && hit.pair.vertex == 0);
            assert_eq!(found.unwrap().features(), features, "{at:?} {found:?}");
        }
        for (ends, features) in [
            (
                [[4.0 * s, t, 1.0], [4.0 * s, -t, 1.0]],
                ClosestFeatures::EdgeEdge,
            ),
            (
                [[4.0 * s, -t, 0.0], [4.0 * s, -9.0, t]],
                ClosestFeatures::VertexEdge,
            ),
            (
                [[-s, -t, 0.0], [-9.0, -9.0, s]],
                ClosestFeatures::VertexVertex,
            ),
        ] {
            world.set_positions(other, &ends).unwrap();
            let close = world.close_edge_edge_pairs(Selection::Between(triangle, other), 3.0);
            // Edge 0 has the corners 0 and 1.
            let found = close.all().unwrap().iter().find(|hit| hit.pair.edge_a == 0);
            assert_eq!(found.unwrap().features(), features, "{ends:?} {found:?}");
        }
    }
}

/// Answers name edges as the caller numbers them, through rebuilds, edits and motions.
#[test]
fn edges_have_the_callers_numbers() {
    let (triangles, flat) = sheet(6);
    let folded: Vec<[f32; 3]> = flat
        .iter()
        .map(|[x, y, _]| [*x, *y, 0.1 * (9.0 * x).sin()])
        .collect();
    let mut plain = World::<f32>::new();
    let mut world = World::<f32>::new();
    let [a, b] = [&mut plain, &mut world].map(|world| world.add(&triangles, &folded).unwrap());
    let sorted = plain.edges(a).unwrap().to_vec();
    // Backwards, and every second one turned round.
    let own: Vec<[u32; 2]> = sorted
        .iter()
        .rev()
        .zip(0..)
        .map(|(&[p, q], at)| if at % 2 == 0 { [p, q] } else { [q, p] })
        .collect();
    // Before and after they were asked for, and twice.
    let asked = world
        .edge_edge_candidates(Selection::Within(b), 0.01)
        .all()
        .unwrap()
        .len();
    world.set_edges(b, &sorted).unwrap();
    world.set_edges(b, &own).unwrap();
    assert!(world.edges(b).unwrap().iter().eq(sorted.iter().rev()));
    let ends = |world: &mut World<f32>, body| -> BTreeSet<[[u32; 2]; 2]> {
        let found = world
            .edge_edge_candidates(Selection::Within(body), 0.01)
            .all()
            .unwrap();
        let found: Vec<_> = found.iter().map(|it| [it.edge_a, it.edge_b]).collect();
        assert!(found.is_sorted());
        let edges = world.edges(body).unwrap();
        let named = found.iter().map(|pair| {
            let mut pair = pair.map(|edge| edges[edge as usize]);
            pair.sort_unstable();
            pair
        });
        named.collect()
    };
    let expected = ends(&mut plain, a);
    assert!(asked == expected.len() && asked > 100);
    assert_eq!(ends(&mut world, b), expected);
    world.rebuild(b).unwrap();
    assert!(world.edges(b).unwrap().iter().eq(sorted.iter().rev()));
    assert_eq!(ends(&mut world, b), expected);
    let last = own.len() as u32 - 1;
    for (edges, kind) in [
        (
            &own[1..],
            ErrorKind::MissingEdge {
                ends: sorted[last as usize],
            },
        ),
        (
            &[&own[..], &own[..1]].concat()[..],
            ErrorKind::NotAnEdge {
                edge: last + 1,
                ends: sorted[last as usize],
            },
        ),
        (
            &[&own[..], &[[0, 35]]].concat()[..],
            ErrorKind::NotAnEdge {
                edge: last + 1,
                ends: [0, 35],
            },
        ),
    ] {
        let refused = world.set_edges(b, edges).unwrap_err();
        assert_eq!((refused.body, refused.kind), (Some(b), kind));
    }
    // Edits keep the numbers.
    let mut edit = world.edit(b).unwrap();
    edit.remove_triangle(0);
    world.apply(&edit).unwrap();
    let left = world.edges(b).unwrap();
    assert!(
        left.iter()
            .zip(sorted.iter().rev())
            .all(|(left, own)| left == own || *left == [u32::MAX; 2])
    );
    assert_eq!(
        world.set_edges(b, &own).unwrap_err().kind,
        ErrorKind::EditedMesh
    );
}

/// Found by fuzzing: coordinates of 1e22 beside ones of 1e-22 in one body.
#[test]
fn pairs_are_close_beside_what_is_very_far() {
    let (huge, tiny) = (2f64.powi(74), -(2f64.powi(-70)));
    let corners = [
        [2f64.powi(46), huge, huge],
        [2f64.powi(-109), 2f64.powi(42), 0.0],
        [tiny, tiny, 2f64.powi(-50)],
        [tiny, 2f64.powi(-18), 64.0],
        [64.0, 64.0, 64.0],
        [64.0, 64.0, 64.0],
        [64.0, 64.0, tiny],
        [tiny, -(2f64.powi(44)), 0.0],
        [0.0, 0.0, 64.0],
        [tiny; 3],
        [2f64.powi(46), huge, huge],
        [2f64.powi(-109), 2f64.powi(42), 0.0],
    ];
    let triangles = [
        [5, 1, 2],
        [3, 3, 3],
        [3, 3, 7],
        [3, 3, 9],
        [3, 7, 5],
        [3, 5, 11],
        [0, 0, 0],
    ];
    let moving = Moving::at(&triangles, &corners);
    for options in every_configuration().into_iter().step_by(7) {
        let mut world = World::<f64>::with_options(options);
        let body = world.add(&triangles, &corners).unwrap();
        let of = Selection::Within(body);
        for distance in [15.9375, 64.0, 1.0, 1e-10] {
            let found = world
                .close_vertex_triangle_pairs(of, distance)
                .all()
                .unwrap();
            let found: Vec<_> = found
                .iter()
                .map(|it| [it.pair.vertex, it.pair.triangle])
                .collect();
            let expected = reference::self_close_vertex_triangle_pairs(&moving, distance);
            assert_eq!(found, expected.unwrap(), "{options:?} {distance}");
        }
    }
}
