//! Lives of worlds, driven through the functions of C and through Rust in step: the same answers.

mod answers;
mod edits;
mod inside;
mod looks;

use pliant::{
    BodyId, ContactKind, Labels, Options, Pair, Partition, Scalar, Selection, Update, World,
};
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

/// The numbers of a list, whose rows have several.
fn rows_of(list: &PliantList, columns: usize) -> Vec<u32> {
    column(list.numbers, list.count, columns)
}

/// A selection as C has it.
fn numbers(of: Selection) -> PliantSelection {
    let (kind, a, b) = match of {
        Selection::Everything => (0, 0, 0),
        Selection::World => (1, 0, 0),
        Selection::Between(a, b) => (2, a.0, b.0),
        Selection::Within(a) => (3, a.0, 0),
    };
    PliantSelection { kind, a, b }
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
    let rows = PliantQuery { how: 3, ..query };
    assert_eq!(ask(&rows, &mut hits), 0);
    assert_eq!(write(&hits), all);
    check_rows(&hits);
    let mut sorted = lines.clone();
    all.sort();
    sorted.sort();
    assert_eq!(all, sorted);
    let prepare = PliantQuery { how: 4, ..query };
    assert_eq!(ask(&prepare, &mut hits), 0);
    assert_eq!((hits.count, hits.rows.count), (0, 0));
    let first = PliantQuery { how: 2, ..query };
    assert_eq!(ask(&first, &mut hits), 0);
    let first = write(&hits);
    assert_eq!(first.len(), lines.len().min(1));
    assert!(first.iter().all(|line| lines.contains(line)));
    for how in [0, 1, 3] {
        let at_most = lines.len() as u64 - u64::from(lines.len() > 1);
        let fewer = PliantQuery {
            how,
            at_most,
            ..query
        };
        let status = if lines.len() > 1 { 30 } else { 0 };
        assert_eq!(ask(&fewer, &mut hits), status);
        let most = PliantQuery {
            at_most: 1 + lines.len() as u64,
            ..fewer
        };
        assert_eq!(ask(&most, &mut hits), 0);
        assert_eq!(hits.count, lines.len());
    }
    lines
}

/// Every hit is once in the row of its first element, and places in a row ascend.
fn check_rows(hits: &PliantHits) {
    let PliantRows {
        count,
        offsets,
        places,
        body_count,
        bodies,
        starts,
    } = hits.rows;
    let pairs = column(hits.pairs, hits.count, 4);
    let (bodies, mut starts) = (column(bodies, body_count, 1), column(starts, body_count, 1));
    let (offsets, places) = (column(offsets, count + 1, 1), column(places, hits.count, 1));
    starts.push(count);
    let mut seen = 0;
    for (body, range) in bodies.into_iter().zip(starts.windows(2)) {
        for (element, row) in (0..).zip(range[0]..range[1]) {
            let row = &places[offsets[row] as usize..offsets[row + 1] as usize];
            assert!(row.is_sorted_by(|a, b| a < b));
            for &place in row {
                assert_eq!(pairs[4 * place as usize..][..2], [body, element]);
                seen += 1;
            }
        }
    }
    assert_eq!(seen, hits.count);
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
    let selection = numbers(of);
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
}

/// A life of two worlds, with a thread more or less, or a pool or scheduler of the caller's.
fn life<S: Scalar>(seed: u64, cast: fn(f64) -> S) {
    let random = &mut Random(seed);
    let (mut c, mut pool) = (null_mut(), null_mut());
    let mut options = PliantOptions {
        scalar: i32::from(size_of::<S>() == 8),
        threads: 1 + random.below(3) as u32,
        partition: random.below(4) as u32,
        update: random.below(3) as u32,
        ..PliantOptions::default()
    };
    let mut own = Options::default();
    own.partition = [
        Partition::Centre,
        Partition::Mean,
        Partition::Balanced,
        Partition::Connectivity,
    ][options.partition as usize];
    own.update = [Update::BottomUp, Update::TopDown, Update::HYBRID][options.update as usize];
    let mut rust = World::<S>::with_options(own);
    // SAFETY: all arguments are there.
    unsafe {
        match random.below(3) {
            0 => {
                assert_eq!(pliant_pool_new(2, &raw mut pool, null_mut()), 0);
                options.pool = pool;
            }
            1 => options.parallel_for = Some(backwards),
            _ => {}
        }
        assert_eq!(
            pliant_world_new(&raw const options, &raw mut c, null_mut()),
            0
        );
        // The world keeps what it needs of it.
        pliant_pool_free(pool);
    }
    let mut bodies: Vec<BodyId> = Vec::new();
    let mut followed = edits::Followed::new();
    for _ in 0..14 {
        step((c, &mut rust), &mut bodies, random, &mut followed, cast);
        let ids = [0, 1].map(|place| bodies.get(place).copied());
        compare(c, &mut rust, Selection::Everything);
        answers::compare(c, &mut rust, Selection::Everything);
        inside::compare(c, &mut rust, Selection::Everything);
        compare(c, &mut rust, Selection::World);
        followed.update(&mut rust);
        if let [Some(a), Some(b)] = ids {
            compare(c, &mut rust, Selection::Between(b, a));
            answers::compare(c, &mut rust, Selection::Within(a));
            answers::compare_bodies(c, &mut rust, a, b);
            inside::compare(c, &mut rust, Selection::Between(b, a));
            inside::compare_bodies(c, &mut rust, a, b);
            let mut copy = null_mut();
            // SAFETY: the world and all arguments are there.
            unsafe {
                assert_eq!(pliant_world_clone(c, &raw mut copy, null_mut()), 0);
                let mut own = rust.clone();
                compare(copy, &mut own, Selection::Everything);
                looks::compare(copy, &own);
                inside::compare_with_a_solid((copy, &mut own), a, cast);
                pliant_world_free(copy);
            }
        }
        looks::compare(c, &rust);
    }
    // SAFETY: it was made, and no call is inside.
    unsafe { pliant_world_free(c) };
}

/// A scheduler that does all but the first task, from the last.
unsafe extern "C" fn backwards(
    _: *mut std::ffi::c_void,
    tasks: usize,
    task: unsafe extern "C" fn(*const std::ffi::c_void, usize),
    context: *const std::ffi::c_void,
) {
    for number in (1..tasks).rev() {
        // SAFETY: as the header says.
        unsafe { task(context, number) };
    }
}

/// A call that changes both worlds.
#[expect(clippy::too_many_lines, reason = "one arm a call")]
fn step<S: Scalar>(
    (c, rust): (*mut PliantWorld, &mut World<S>),
    bodies: &mut Vec<BodyId>,
    random: &mut Random,
    followed: &mut edits::Followed,
    cast: fn(f64) -> S,
) {
    let shape = |random: &mut Random, count| -> Vec<[S; 3]> {
        let all = random.positions(count).into_iter();
        all.map(|it| it.map(cast)).collect()
    };
    let what = if bodies.len() < 2 {
        0
    } else {
        random.below(18)
    };
    let which = random.below(bodies.len().max(1) as u64) as usize;
    let id = bodies.get(which).copied().unwrap_or(BodyId(0));
    let count = rust.vertex_count(id).unwrap_or(0);
    // SAFETY: the world and all arguments are there.
    let status = unsafe {
        match what {
            0 if bodies.len() < 4 => {
                let vertices = 3 + random.below(8);
                let triangles: Vec<[i64; 3]> = (0..=random.below(9))
                    .map(|_| [(); 3].map(|()| random.below(vertices) as i64))
                    .collect();
                let positions = shape(random, vertices as usize);
                let narrow = triangles.iter();
                let narrow = narrow.map(|it| it.map(|x| u32::try_from(x).unwrap()));
                let id = rust.add(&narrow.collect::<Vec<_>>(), &positions).unwrap();
                bodies.push(id);
                let mut body = u32::MAX;
                let (faces, rows) = (faces(&triangles), rows(&positions));
                let status = pliant_world_add(c, faces, rows, &raw mut body, null_mut());
                assert_eq!(body, id.0);
                status
            }
            1 if bodies.len() > 2 => {
                bodies.swap_remove(which);
                rust.remove(id).unwrap();
                pliant_world_remove(c, id.0, null_mut())
            }
            2 => {
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
                let groups: Vec<u32> = (0..count).map(|_| random.below(3) as u32).collect();
                rust.set_vertex_groups(id, &groups).unwrap();
                pliant_world_set_vertex_groups(c, id.0, groups.as_ptr(), count, null_mut())
            }
            5 => {
                let thick: Vec<f64> = (0..count).map(|_| random.below(3) as f64 / 8.0).collect();
                rust.set_vertex_thickness(id, &thick).unwrap();
                pliant_world_set_vertex_thickness(c, id.0, thick.as_ptr(), count, null_mut())
            }
            6 => {
                let rest = (random.below(2) == 0).then(|| shape(random, count));
                rust.set_rest_positions(id, rest.as_deref()).unwrap();
                let rest = rest.as_deref().map(rows);
                let start = rest.as_ref().map_or(std::ptr::null(), std::ptr::from_ref);
                pliant_world_set_rest_positions(c, id.0, start, null_mut())
            }
            7 => {
                let (mask, environment) = (random.below(4) as u32, random.below(2) as u32);
                rust.set_filter(id, 3, mask).unwrap();
                rust.set_environment(id, environment).unwrap();
                rust.ignore(id, bodies[0]).unwrap();
                rust.unignore(bodies[0], bodies[1]).unwrap();
                assert_eq!(pliant_world_set_filter(c, id.0, 3, mask, null_mut()), 0);
                assert_eq!(pliant_world_ignore(c, id.0, bodies[0].0, null_mut()), 0);
                let [a, b] = [bodies[0].0, bodies[1].0];
                assert_eq!(pliant_world_unignore(c, a, b, null_mut()), 0);
                pliant_world_set_environment(c, id.0, environment, null_mut())
            }
            8 => {
                let labels: Vec<u32> = (0..rust.triangle_count(id).unwrap())
                    .map(|_| random.below(4) as u32)
                    .collect();
                let near = (random.below(2) == 0).then_some([[0, 1]]);
                let neighbours = near.as_ref().map(|it| &it[..]);
                let of_triangles = &labels;
                rust.set_labels(
                    id,
                    Some(Labels {
                        of_triangles,
                        neighbours,
                    }),
                )
                .unwrap();
                let start = neighbours.map_or(std::ptr::null(), |it| it.as_ptr().cast());
                let (all, m, k) = (
                    labels.as_ptr(),
                    labels.len(),
                    neighbours.map_or(0, <[_]>::len),
                );
                pliant_world_set_labels(c, id.0, all, m, start, k, null_mut())
            }
            9 => {
                rust.set_thickness(id, 0.25).unwrap();
                pliant_world_set_thickness(c, id.0, 0.25, null_mut())
            }
            10 => {
                let corners = (random.below(2) == 0).then_some([[-9.0; 3], [9.0; 3]]);
                let narrow = corners.map(|[a, b]: [[f64; 3]; 2]| (a.map(cast), b.map(cast)));
                let start = corners
                    .as_ref()
                    .map_or(std::ptr::null(), |it| it.as_ptr().cast());
                let status = pliant_world_set_loose_box(c, id.0, start, null_mut());
                // A motion may end outside, or an empty vertex be nowhere.
                assert_eq!(rust.set_loose_box(id, narrow).is_ok(), status == 0);
                0
            }
            11 => {
                rust.rebuild(id).unwrap();
                rust.finish_motion();
                assert_eq!(pliant_world_finish_motion(c, null_mut()), 0);
                pliant_world_rebuild(c, id.0, null_mut())
            }
            12 => {
                let [a, b] = [bodies[0], bodies[1]];
                let shapes = [a, b].map(|it| shape(random, rust.vertex_count(it).unwrap()));
                rust.set_positions_of(&[(a, &shapes[0]), (b, &shapes[1])])
                    .unwrap();
                let (ids, points) = ([a.0, b.0], shapes.each_ref().map(|it| rows(it)));
                let (ids, points) = (ids.as_ptr(), points.as_ptr());
                pliant_world_set_positions_of(c, ids, points, 2, null_mut())
            }
            13 => {
                edits::weld((c, rust), id, followed);
                0
            }
            14 if bodies.len() < 6 => {
                bodies.extend(edits::split((c, rust), id, followed));
                0
            }
            15 if bodies.len() > 2 => {
                let gone = bodies.swap_remove(which);
                edits::fuse((c, rust), [bodies[0], gone], followed);
                0
            }
            16 | 17 => {
                edits::edit((c, rust), (id, random), followed, cast);
                0
            }
            _ => {
                let positions = shape(random, count);
                rust.set_positions(id, &positions).unwrap();
                pliant_world_set_positions(c, id.0, rows(&positions), null_mut())
            }
        }
    };
    assert_eq!(status, 0);
}

#[test]
fn worlds_in_c_answer_as_worlds_in_rust() {
    for seed in 0..20 {
        life::<f32>(seed, |x| x as f32);
        life::<f64>(seed, |x| x);
    }
}

/// A value one byte behind an address that is aligned.
#[repr(C, packed)]
struct Misaligned<T> {
    before: u8,
    value: T,
}

#[expect(clippy::unnecessary_box_returns, reason = "its address must stay")]
fn misaligned<T>(value: T) -> Box<Misaligned<T>> {
    Box::new(Misaligned { before: 0, value })
}

/// Arrays that are taken as slices would be refused by checks of Rust. Structures that are read as
/// aligned would end the test where the processor minds, which x86-64 does not.
#[test]
fn arrays_and_structures_need_no_alignment() {
    let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let positions = misaligned(flat);
    let triangles = misaligned([[0_i64, 1, 2]]);
    let points = PliantPoints {
        data: (&raw const positions.value).cast(),
        ..rows(&flat)
    };
    let faces = PliantFaces {
        data: (&raw const triangles.value).cast(),
        ..faces(&[[0, 1, 2]])
    };
    let options = misaligned(PliantOptions::default());
    let query = misaligned(PliantQuery::ALL);
    let of = misaligned([0_u32, 1]);
    let shapes = misaligned([points; 2]);
    let (mut hits, mut body) = (misaligned(PliantHits::NONE), misaligned(9));
    let (mut changed, mut world) = (misaligned(PliantEdited::default()), null_mut());
    // SAFETY: all arguments are there.
    unsafe {
        let (options, query) = (&raw const options.value, &raw const query.value);
        assert_eq!(pliant_world_new(options, &raw mut world, null_mut()), 0);
        for number in 0..2 {
            let out = &raw mut body.value;
            assert_eq!(pliant_world_add(world, faces, points, out, null_mut()), 0);
            assert_eq!({ body.value }, number);
        }
        let (of, shapes) = (&raw const of.value, &raw const shapes.value);
        let (of, shapes) = (of.cast(), shapes.cast());
        let status = pliant_world_set_positions_of(world, of, shapes, 2, null_mut());
        assert_eq!(status, 0);
        let rest = shapes.cast();
        assert_eq!(
            pliant_world_set_rest_positions(world, 0, rest, null_mut()),
            0
        );
        let out = &raw mut hits.value;
        assert_eq!(pliant_world_intersections(world, query, out, null_mut()), 0);
        assert_eq!({ hits.value }.count, 1);
        let out = &raw mut changed.value;
        assert_eq!(pliant_world_weld(world, 0, 0.0, query, out, null_mut()), 0);
        pliant_world_free(world);
        let corners: [PliantPoints; 4] = [points; 4];
        let corners = misaligned(corners);
        let mut distances = misaligned([9.0; 3]);
        let (all, out) = (&raw const corners.value, &raw mut distances.value);
        let (none, nothing) = (null_mut(), null_mut());
        let status =
            pliant_edge_edge_distances(all.cast(), out.cast(), none, none, nothing, null_mut());
        assert_eq!((status, { distances.value }), (0, [0.0; 3]));
        let mut changes = null_mut();
        let mut told = misaligned(PliantChanged {
            count: 9,
            numbers: null_mut(),
            began_count: 9,
            began: null_mut(),
            ended_count: 9,
            ended: null_mut(),
            ended_numbers: null_mut(),
        });
        assert_eq!(pliant_changes_new(0, &raw mut changes, null_mut()), 0);
        let out = &raw mut told.value;
        let status = pliant_changes_update(changes, of.cast(), 0, out, null_mut());
        assert_eq!((status, { told.value }.count), (0, 0));
        let edited = &raw const changed.value;
        assert_eq!(pliant_changes_edited(changes, 0, edited, null_mut()), 0);
        pliant_changes_free(changes);
    }
    assert_eq!(options.before + query.before, 0);
}
