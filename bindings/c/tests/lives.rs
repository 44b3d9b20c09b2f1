//! Lives of worlds, driven through the functions of C and through Rust in step: the same answers.

use pliant::{BodyId, ContactKind, Pair, Scalar, Selection, World};
use pliant_c::*;
use std::ptr::null_mut;
use std::slice;

/// Numbers that look random.
struct Random(u64);

impl Random {
    fn below(&mut self, range: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % range
    }

    fn positions(&mut self, count: usize) -> Vec<[f64; 3]> {
        // On a lattice many touch.
        let lattice = self.below(2) == 0;
        let x = |random: &mut Self| {
            if lattice {
                random.below(6) as f64
            } else {
                random.below(6000) as f64 / 1024.0
            }
        };
        (0..count).map(|_| [(); 3].map(|()| x(self))).collect()
    }
}

/// Points in rows.
fn rows<S>(positions: &[[S; 3]]) -> PliantPoints {
    PliantPoints {
        data: positions.as_ptr().cast(),
        count: positions.len(),
        row: 0,
        column: 0,
        scalar: i32::from(size_of::<S>() == 8),
    }
}

/// Triangles in rows of indices of 8 bytes with a sign.
fn faces(triangles: &[[i64; 3]]) -> PliantFaces {
    PliantFaces {
        data: triangles.as_ptr().cast(),
        count: triangles.len(),
        row: 0,
        column: 0,
        bytes: 8,
        is_signed: 1,
    }
}

/// A column of hits, as bits.
fn column<T: Copy>(start: *const T, count: usize, of: usize) -> Vec<T> {
    if start.is_null() {
        assert_eq!(count, 0);
        return Vec::new();
    }
    // SAFETY: the library says that these are there.
    unsafe { slice::from_raw_parts(start, count * of) }.to_vec()
}

/// The pairs of hits, and their rows of other columns as text.
type Lines = Vec<String>;

/// A visitor that sums counts.
unsafe extern "C" fn visit(user: *mut std::ffi::c_void, some: *const PliantHits) -> i32 {
    // SAFETY: this is what the query has for its user, and the hits are there.
    unsafe { *user.cast::<usize>() += (*some).count };
    0
}

/// Asks a question of C, as a list, a visit, in job order and for a first hit.
fn asked(
    ask: &dyn Fn(&PliantQuery, &mut PliantHits) -> i32,
    of: PliantSelection,
    write: &dyn Fn(&PliantHits) -> Lines,
) -> Lines {
    let query = PliantQuery {
        of,
        ..PliantQuery::ALL
    };
    let mut hits = PliantHits::NONE;
    assert_eq!(ask(&query, &mut hits), 0);
    let lines = write(&hits);
    let mut count = 0_usize;
    let visitor = PliantQuery {
        visit: Some(visit),
        user: (&raw mut count).cast(),
        ..query
    };
    assert_eq!(ask(&visitor, &mut hits), 0);
    assert_eq!((count, hits.count), (lines.len(), 0));
    let unsorted = PliantQuery { how: 1, ..query };
    assert_eq!(ask(&unsorted, &mut hits), 0);
    let mut all = write(&hits);
    let mut sorted = lines.clone();
    all.sort();
    sorted.sort();
    assert_eq!(all, sorted);
    let first = PliantQuery { how: 2, ..query };
    assert_eq!(ask(&first, &mut hits), 0);
    let first = write(&hits);
    assert_eq!(first.len(), lines.len().min(1));
    assert!(first.iter().all(|line| lines.contains(line)));
    if lines.len() > 1 {
        let fewer = PliantQuery {
            at_most: lines.len() as u64 - 1,
            ..query
        };
        assert_eq!(ask(&fewer, &mut hits), 30);
    }
    lines
}

fn pairs(hits: &PliantHits) -> Lines {
    let all = column(hits.pairs, hits.count, 4);
    all.chunks(4).map(|pair| format!("{pair:?}")).collect()
}

fn with_kinds(hits: &PliantHits) -> Lines {
    let kinds = column(hits.kinds, hits.count, 1);
    let both = pairs(hits).into_iter().zip(kinds);
    both.map(|(pair, kind)| format!("{pair} {kind}")).collect()
}

fn close(weights: usize) -> impl Fn(&PliantHits) -> Lines {
    move |hits| {
        let count = hits.count;
        let distances = column(hits.distances, count, 1);
        let directions = column(hits.directions, count, 3);
        let all = column(hits.weights, count, weights);
        let row = |(place, pair): (usize, String)| {
            let distance = distances[place];
            let direction = &directions[3 * place..][..3];
            let weights = &all[weights * place..][..weights];
            format!("{pair} {distance:?} {direction:?} {weights:?}")
        };
        pairs(hits).into_iter().enumerate().map(row).collect()
    }
}

fn timed(hits: &PliantHits) -> Lines {
    let (low, high) = (
        column(hits.low, hits.count, 1),
        column(hits.high, hits.count, 1),
    );
    let row = |(place, pair): (usize, String)| format!("{pair} {:?} {:?}", low[place], high[place]);
    pairs(hits).into_iter().enumerate().map(row).collect()
}

/// All answers of both worlds.
#[expect(clippy::too_many_lines, reason = "one row a question")]
fn compare<S: Scalar>(c: *mut PliantWorld, rust: &mut World<S>, of: Selection) {
    let selection = match of {
        Selection::Everything => PliantSelection {
            kind: 0,
            a: 0,
            b: 0,
        },
        Selection::World => PliantSelection {
            kind: 1,
            a: 0,
            b: 0,
        },
        Selection::Between(a, b) => PliantSelection {
            kind: 2,
            a: a.0,
            b: b.0,
        },
        Selection::Within(a) => PliantSelection {
            kind: 3,
            a: a.0,
            b: 0,
        },
    };
    macro_rules! ask {
        ($function:ident ($($with:expr)?), $write:expr, |$hit:ident| $row:expr, $query:expr) => {{
            // SAFETY: the world and all arguments are there.
            let ask = |query: &PliantQuery, hits: &mut PliantHits| unsafe {
                $function(c, query, $($with,)? hits, null_mut())
            };
            let expected: Lines = $query.all().unwrap().iter().map(|$hit| $row).collect();
            assert_eq!(asked(&ask, selection, &$write), expected);
        }};
    }
    let row = |pair: [u32; 4]| format!("{pair:?}");
    let to = |direction: Option<[f64; 3]>| direction.unwrap_or_default();
    let contact = |pair: Pair, kind: ContactKind| {
        let kind = match kind {
            ContactKind::Touching => 1,
            ContactKind::Overlapping => 2,
            ContactKind::Crossing => 3,
        };
        format!("{} {kind}", row(pair.into()))
    };
    ask!(
        pliant_world_intersections(),
        pairs,
        |it| row((*it).into()),
        rust.intersections(of)
    );
    ask!(
        pliant_world_contacts(0),
        with_kinds,
        |it| contact(it.pair, it.kind),
        rust.contacts(of)
    );
    ask!(
        pliant_world_contacts(3),
        with_kinds,
        |it| contact(it.pair, it.kind),
        rust.contacts(of).only(ContactKind::Crossing)
    );
    ask!(
        pliant_world_adjacent_intersections(0),
        with_kinds,
        |it| contact(it.pair, it.kind),
        rust.adjacent_intersections(of)
    );
    ask!(
        pliant_world_crossing_edges(),
        pairs,
        |it| row((*it).into()),
        rust.crossing_edges(of)
    );
    let radius = 0.25;
    ask!(
        pliant_world_vertex_triangle_candidates(radius),
        pairs,
        |it| row((*it).into()),
        rust.vertex_triangle_candidates(of, radius)
    );
    ask!(
        pliant_world_edge_edge_candidates(radius),
        pairs,
        |it| row((*it).into()),
        rust.edge_edge_candidates(of, radius)
    );
    ask!(
        pliant_world_close_vertex_triangle_pairs(radius),
        close(4),
        |it| {
            let [u, v, w] = it.barycentric;
            format!(
                "{} {:?} {:?} {:?}",
                row(it.pair.into()),
                it.distance,
                to(it.direction),
                [1.0, u, v, w]
            )
        },
        rust.close_vertex_triangle_pairs(of, radius)
    );
    ask!(
        pliant_world_close_edge_edge_pairs(radius),
        close(4),
        |it| {
            let weights = [it.barycentric_a, it.barycentric_b].concat();
            format!(
                "{} {:?} {:?} {weights:?}",
                row(it.pair.into()),
                it.distance,
                to(it.direction)
            )
        },
        rust.close_edge_edge_pairs(of, radius)
    );
    ask!(
        pliant_world_close_triangle_pairs(radius),
        close(6),
        |it| {
            let weights = [it.barycentric_a, it.barycentric_b].concat();
            format!(
                "{} {:?} {:?} {weights:?}",
                row(it.pair.into()),
                it.distance,
                to(it.direction)
            )
        },
        rust.close_triangle_pairs(of, radius)
    );
    ask!(
        pliant_world_vertex_triangle_impacts(1e-6),
        timed,
        |it| { format!("{} {:?} {:?}", row(it.pair.into()), it.low, it.high) },
        rust.vertex_triangle_impacts(of)
    );
    ask!(
        pliant_world_edge_edge_impacts(1e-6),
        timed,
        |it| { format!("{} {:?} {:?}", row(it.pair.into()), it.low, it.high) },
        rust.edge_edge_impacts(of)
    );
    let (mut step, expected) = (f64::NAN, rust.collision_free_step(of, 0.125).unwrap());
    // SAFETY: the world and all arguments are there.
    let status = unsafe {
        let query = PliantQuery {
            of: selection,
            ..PliantQuery::ALL
        };
        pliant_world_collision_free_step(c, &raw const query, 0.125, &raw mut step, null_mut())
    };
    assert_eq!((status, step), (0, expected));
}

#[expect(clippy::too_many_lines, reason = "one arm a call")]
fn life<S: Scalar>(seed: u64, cast: fn(f64) -> S) {
    let random = &mut Random(seed);
    let mut rust = World::<S>::new();
    let mut options = PliantOptions::default();
    let mut c = null_mut();
    // SAFETY: all arguments are there.
    unsafe {
        options.scalar = i32::from(size_of::<S>() == 8);
        options.threads = 1 + random.below(2) as u32;
        options.partition = random.below(4) as u32;
        options.update = random.below(3) as u32;
        assert_eq!(
            pliant_world_new(&raw const options, &raw mut c, null_mut()),
            0
        );
    }
    let mut bodies: Vec<(BodyId, usize)> = Vec::new();
    for _ in 0..12 {
        let shape = |random: &mut Random, count| -> Vec<[S; 3]> {
            let all = random.positions(count).into_iter();
            all.map(|it| it.map(cast)).collect()
        };
        let which = random.below(bodies.len().max(1) as u64) as usize;
        let what = if bodies.len() < 2 { 0 } else { random.below(9) };
        // SAFETY: the world and all arguments are there.
        let status = unsafe {
            match what {
                0 if bodies.len() < 4 => {
                    let vertices = 3 + random.below(8);
                    let triangles: Vec<[i64; 3]> = (0..=random.below(9))
                        .map(|_| [(); 3].map(|()| random.below(vertices) as i64))
                        .collect();
                    let positions = shape(random, vertices as usize);
                    let narrow = triangles
                        .iter()
                        .map(|it| it.map(|x| u32::try_from(x).unwrap()));
                    let id = rust.add(&narrow.collect::<Vec<_>>(), &positions).unwrap();
                    bodies.push((id, positions.len()));
                    let mut body = u32::MAX;
                    let (faces, rows) = (faces(&triangles), rows(&positions));
                    let status = pliant_world_add(c, faces, rows, &raw mut body, null_mut());
                    assert_eq!(body, id.0);
                    status
                }
                1 if bodies.len() > 2 => {
                    let (id, _) = bodies.swap_remove(which);
                    rust.remove(id).unwrap();
                    pliant_world_remove(c, id.0, null_mut())
                }
                2 => {
                    let (id, count) = bodies[which];
                    let end = shape(random, count);
                    rust.set_motion(id, &end).unwrap();
                    pliant_world_set_motion(c, id.0, rows(&end), null_mut())
                }
                3 => {
                    let t = random.below(5) as f64 / 4.0;
                    rust.advance_motion(t).unwrap();
                    pliant_world_advance_motion(c, t, null_mut())
                }
                4 => {
                    let (id, count) = bodies[which];
                    let groups: Vec<u32> = (0..count).map(|_| random.below(3) as u32).collect();
                    rust.set_vertex_groups(id, &groups).unwrap();
                    pliant_world_set_vertex_groups(c, id.0, groups.as_ptr(), count, null_mut())
                }
                5 => {
                    let (id, count) = bodies[which];
                    let thick: Vec<f64> =
                        (0..count).map(|_| random.below(3) as f64 / 8.0).collect();
                    rust.set_vertex_thickness(id, &thick).unwrap();
                    pliant_world_set_vertex_thickness(c, id.0, thick.as_ptr(), count, null_mut())
                }
                6 => {
                    let (id, count) = bodies[which];
                    let rest = shape(random, count);
                    rust.set_rest_positions(id, Some(&rest)).unwrap();
                    let rest = rows(&rest);
                    pliant_world_set_rest_positions(c, id.0, &raw const rest, null_mut())
                }
                7 => {
                    let (id, _) = bodies[which];
                    let (mask, environment) = (random.below(4) as u32, random.below(2) as u32);
                    rust.set_filter(id, 3, mask).unwrap();
                    rust.set_environment(id, environment).unwrap();
                    rust.ignore(id, bodies[0].0).unwrap();
                    assert_eq!(pliant_world_set_filter(c, id.0, 3, mask, null_mut()), 0);
                    assert_eq!(pliant_world_ignore(c, id.0, bodies[0].0.0, null_mut()), 0);
                    pliant_world_set_environment(c, id.0, environment, null_mut())
                }
                _ => {
                    let (id, count) = bodies[which];
                    let positions = shape(random, count);
                    rust.set_positions(id, &positions).unwrap();
                    pliant_world_set_positions(c, id.0, rows(&positions), null_mut())
                }
            }
        };
        assert_eq!(status, 0);
        let ids = [0, 1].map(|place| bodies.get(place).map(|it| it.0));
        compare(c, &mut rust, Selection::Everything);
        compare(c, &mut rust, Selection::World);
        if let [Some(a), Some(b)] = ids {
            compare(c, &mut rust, Selection::Between(b, a));
            compare(c, &mut rust, Selection::Within(a));
            let mut copy = null_mut();
            let (mut triangles, mut vertices) = (0, 0);
            let count = bodies[0].1;
            let mut there = vec![[f64::NAN; 3]; count];
            // SAFETY: the world and all arguments are there.
            unsafe {
                assert_eq!(pliant_world_clone(c, &raw mut copy, null_mut()), 0);
                compare(copy, &mut rust, Selection::Everything);
                let (m, n) = (&raw mut triangles, &raw mut vertices);
                assert_eq!(pliant_world_counts(copy, a.0, m, n, null_mut()), 0);
                let out = there.as_mut_ptr().cast();
                assert_eq!(pliant_world_positions(copy, a.0, out, count, null_mut()), 0);
                pliant_world_free(copy);
            }
            assert_eq!(triangles, rust.triangle_count(a).unwrap());
            assert_eq!(vertices, rust.vertex_count(a).unwrap());
            let expected = rust.positions(a).unwrap().into_iter();
            assert!(
                there
                    .into_iter()
                    .eq(expected.map(|it| it.map(Scalar::to_f64)))
            );
        }
    }
    // SAFETY: it was made, and no call is inside.
    unsafe { pliant_world_free(c) };
}

#[test]
fn worlds_in_c_answer_as_worlds_in_rust() {
    for seed in 0..20 {
        life::<f32>(seed, |x| x as f32);
        life::<f64>(seed, |x| x);
    }
}
