//! Every refusal names what was wrong, and leaves the world as it was.

use crate::common::{TrianglesOf, every_configuration, sheet};
use pliant::{
    BodyId, Error, ErrorKind, Options, Pair, Scalar, Selection, Update, World, reference,
};
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

fn world() -> (World<f32>, BodyId, Vec<[f32; 3]>) {
    let (triangles, positions) = sheet(4);
    let mut world = World::new();
    let body = world.add(&triangles, &positions).unwrap();
    (world, body, positions)
}

#[test]
fn bodies_that_cannot_be_made() {
    let mut world = World::<f64>::new();
    let refused = |kind| Err(Error { body: None, kind });
    let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(world.add(&[], &corner), refused(ErrorKind::NoTriangles));
    let error = ErrorKind::VertexOutOfRange {
        triangle: 1,
        vertex: 3,
        vertices: 3,
    };
    assert_eq!(world.add(&[[0, 1, 2], [0, 3, 1]], &corner), refused(error));
    let large = f64::from(f32::MAX) * 1.000_001;
    let mut bad = corner;
    bad[2][0] = large;
    let error = ErrorKind::BadPosition {
        vertex: 2,
        position: [large, 1.0, 0.0],
    };
    assert_eq!(world.add(&[[0, 1, 2]], &bad), refused(error));
    assert_eq!(world.bodies().len(), 0);

    // The next body has the first id: none was lost.
    bad[2][0] = f64::from(f32::MAX);
    assert_eq!(
        world.add(&[[0, 1, 2], [1, 1, 1]], &bad),
        Ok(BodyId(0)),
        "f32::MAX is in range, and degenerate is allowed"
    );
}

/// The limit is checked before any triangle is read.
#[test]
#[ignore = "3 GB of address space, untouched"]
fn more_triangles_than_numbers() {
    let (limit, count) = (1 << 28, (1 << 28) + 1);
    let error = World::<f32>::new()
        .add(&vec![[0; 3]; count], &[[0.0; 3]])
        .unwrap_err();
    let what = "triangles";
    assert_eq!(error.kind, ErrorKind::TooLarge { what, count, limit });
}

#[test]
fn shapes_that_are_not_taken_over() {
    let (mut world, body, positions) = world();
    let refused = |kind| {
        Err(Error {
            body: Some(body),
            kind,
        })
    };
    assert_eq!(
        world.set_positions(body, &positions[..15]),
        refused(ErrorKind::WrongLength {
            what: "positions",
            expected: 16,
            found: 15
        })
    );
    let error = world.set_vertex_groups(body, &[1; 15]).unwrap_err();
    let message =
        "body 0: 15 groups for 16 vertices; give one for each vertex, empty ones included";
    assert_eq!(error.to_string(), message);
    let mut bad = positions.clone();
    (bad[9][2], bad[11][0]) = (f32::NEG_INFINITY, f32::INFINITY);
    let error = world.set_positions(body, &bad).unwrap_err();
    let message = error.to_string();
    assert!(
        matches!(error.kind, ErrorKind::BadPosition { vertex: 9, .. }),
        "{message}"
    );
    assert!(message.starts_with("body 0: vertex 9 is at ["), "{message}");

    let unwritten = world.write_positions(body, |buffer| buffer[..7].fill([0.0; 3]));
    assert_eq!(unwritten, refused(ErrorKind::NotWritten { vertex: 7 }));
    assert_eq!(world.triangles_of(Selection::Within(body)), [[0_u32; 2]; 0]);
}

#[test]
fn an_unused_vertex_is_checked_too() {
    let mut world = World::<f32>::new();
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [9.0; 3]];
    let body = world.add(&[[0, 1, 2]], &positions).unwrap();
    world
        .set_loose_box(body, Some(([0.0; 3], [9.0; 3])))
        .unwrap();
    let mut bad = positions;
    bad[3] = [0.0, f32::NAN, 0.0];
    let error = world.set_positions(body, &bad).unwrap_err();
    assert!(
        matches!(error.kind, ErrorKind::BadPosition { vertex: 3, .. }),
        "{error}"
    );
    bad[3] = [9.5, 0.0, 0.0];
    let error = world.set_positions(body, &bad).unwrap_err();
    assert_eq!(
        error.kind,
        ErrorKind::OutsideLooseBox {
            vertex: 3,
            position: [9.5, 0.0, 0.0]
        }
    );
}

#[test]
fn loose_boxes() {
    let (mut world, body, positions) = world();
    let refused = |kind| {
        Err(Error {
            body: Some(body),
            kind,
        })
    };
    for (lo, hi) in [
        ([f32::NAN; 3], [1.0; 3]),
        ([-1.0; 3], [f32::INFINITY; 3]),
        ([2.0; 3], [1.0; 3]),
    ] {
        assert_eq!(
            world.set_loose_box(body, Some((lo, hi))),
            refused(ErrorKind::BadLooseBox)
        );
    }
    let outside = world.set_loose_box(body, Some(([0.0, 0.0, -1.0], [0.9, 1.0, 1.0])));
    assert_eq!(
        outside,
        refused(ErrorKind::OutsideLooseBox {
            vertex: 3,
            position: [1.0, 0.0, 0.0]
        })
    );

    world
        .set_loose_box(body, Some(([0.0; 3], [1.0; 3])))
        .unwrap();
    let mut risen = positions.clone();
    risen[5][2] = 1.5;
    let expected = ErrorKind::OutsideLooseBox {
        vertex: 5,
        position: risen[5].map(f64::from),
    };
    assert_eq!(world.set_positions(body, &risen), refused(expected));
    world.set_loose_box(body, None).unwrap();
    world.set_positions(body, &risen).unwrap();
}

#[test]
fn bodies_that_are_not_there() {
    let (mut world, body, positions) = world();
    let gone = world.add(&[[0, 1, 2]], &positions).unwrap();
    world.remove(gone).unwrap();
    for stranger in [gone, BodyId(7), BodyId(u32::MAX)] {
        let kind = ErrorKind::NoSuchBody;
        let error = Error {
            body: Some(stranger),
            kind,
        };
        assert_eq!(
            world.set_positions(stranger, &positions).unwrap_err(),
            error
        );
        assert_eq!(
            world
                .write_positions(stranger, |_| panic!("not called"))
                .unwrap_err(),
            error
        );
        let set = world.set_mesh(stranger, &[[0, 1, 2]], &positions);
        assert_eq!(set.unwrap_err(), error);
        assert_eq!(world.remove(stranger).unwrap_err(), error);
        assert_eq!(world.rebuild(stranger).unwrap_err(), error);
        assert_eq!(world.set_filter(stranger, 0, 0).unwrap_err(), error);
        assert_eq!(world.set_environment(stranger, 0).unwrap_err(), error);
        assert_eq!(world.environment(stranger).unwrap_err(), error);
        assert_eq!(world.set_loose_box(stranger, None).unwrap_err(), error);
        assert_eq!(world.ignore(stranger, body).unwrap_err(), error);
        assert_eq!(world.unignore(body, stranger).unwrap_err(), error);
        assert_eq!(world.triangle_count(stranger).unwrap_err(), error);
        assert_eq!(world.vertex_count(stranger).unwrap_err(), error);
        assert_eq!(world.tree_shape(stranger).unwrap_err(), error);
        assert_eq!(
            world
                .intersections(Selection::Within(stranger))
                .prepare()
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .intersections(Selection::Between(body, stranger))
                .all()
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .intersections(Selection::Between(stranger, body))
                .first()
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .intersections(Selection::Between(stranger, body))
                .visit(|_| ControlFlow::Break(()))
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .intersections(Selection::Within(stranger))
                .all()
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .intersections(Selection::Within(stranger))
                .first()
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .intersections(Selection::Within(stranger))
                .visit(|_| ControlFlow::Break(()))
                .unwrap_err(),
            error
        );
    }
    let same = Error {
        body: Some(body),
        kind: ErrorKind::SameBody,
    };
    assert_eq!(
        world
            .intersections(Selection::Between(body, body))
            .all()
            .unwrap_err(),
        same
    );
    assert_eq!(
        world
            .intersections(Selection::Between(body, body))
            .first()
            .unwrap_err(),
        same
    );
}

#[test]
fn an_empty_world_has_no_pairs() {
    let mut world = World::<f32>::default();
    world.intersections(Selection::World).prepare().unwrap();
    assert_eq!(world.intersections(Selection::World).all().unwrap(), []);
    assert_eq!(world.intersections(Selection::World).first().unwrap(), None);
    world.validate().unwrap();
}

/// All answers of a world.
#[derive(Clone, Debug, PartialEq)]
struct Answers {
    bodies: Vec<(BodyId, usize, usize)>,
    pairs: Vec<Pair>,
    any: bool,
    itself: Vec<Vec<[u32; 2]>>,
    parts: Vec<Vec<u32>>,
}

fn answers<S: Scalar>(world: &mut World<S>) -> Answers {
    world.validate().unwrap();
    let ids: Vec<_> = world.bodies().collect();
    Answers {
        bodies: ids
            .iter()
            .map(|&id| {
                (
                    id,
                    world.triangle_count(id).unwrap(),
                    world.vertex_count(id).unwrap(),
                )
            })
            .collect(),
        pairs: world
            .intersections(Selection::World)
            .all()
            .unwrap()
            .to_vec(),
        any: world
            .intersections(Selection::World)
            .first()
            .unwrap()
            .is_some(),
        itself: ids
            .iter()
            .map(|&id| world.triangles_of(Selection::Within(id)))
            .collect(),
        parts: ids
            .iter()
            .map(|&id| world.tree_cut(id, u32::MAX).unwrap())
            .collect(),
    }
}

/// A call that must be refused, with its description.
type Bad<S> = (
    &'static str,
    Box<dyn Fn(&mut World<S>, BodyId) -> Result<(), Error>>,
);

/// Every call with arguments, with every bad argument that it can get. The body has 16 vertices.
#[expect(clippy::too_many_lines, reason = "one entry a bad call")]
fn bad_calls<S: Scalar>(convert: fn(f64) -> S) -> Vec<Bad<S>> {
    let (triangles, flat) = sheet(4);
    let good: Vec<[S; 3]> = flat
        .iter()
        .map(|p| p.map(|x| convert(f64::from(x))))
        .collect();
    let mut calls: Vec<Bad<S>> = Vec::new();
    let bad_values = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 3.5e38, -1e300];
    for value in bad_values {
        for (vertex, axis) in [(0, 0), (7, 1), (15, 2)] {
            let mut bad = good.clone();
            bad[vertex][axis] = convert(value);
            let (shape, again) = (bad.clone(), bad.clone());
            let corners = triangles.clone();
            calls.push((
                "add",
                Box::new(move |world, _| world.add(&corners, &bad).map(drop)),
            ));
            calls.push((
                "set_positions",
                Box::new(move |world, id| world.set_positions(id, &shape)),
            ));
            calls.push((
                "write_positions",
                Box::new(move |world, id| {
                    world.write_positions(id, |buffer| buffer.copy_from_slice(&again))
                }),
            ));
        }
        for high in [false, true] {
            let mut corners = [[convert(-100.0); 3], [convert(100.0); 3]];
            corners[usize::from(high)][1] = convert(value);
            let [lo, hi] = corners;
            calls.push((
                "set_loose_box",
                Box::new(move |world, id| world.set_loose_box(id, Some((lo, hi)))),
            ));
        }
    }
    for length in [0, 1, 15, 17, 1000] {
        let wrong = vec![[convert(0.0); 3]; length];
        calls.push((
            "set_positions",
            Box::new(move |world, id| world.set_positions(id, &wrong)),
        ));
    }
    for written in [0..0, 0..15, 1..16] {
        calls.push((
            "write_positions",
            Box::new(move |world, id| {
                world.write_positions(id, |buffer| buffer[written.clone()].fill([convert(0.0); 3]))
            }),
        ));
    }
    let lists: [(&[[u32; 3]], usize); 5] = [
        (&[], 0),
        (&[], 16),
        (&[[0, 1, 2]], 0),
        (&[[0, 1, 16]], 16),
        (&[[0, 1, 2], [0, u32::MAX, 1]], 16),
    ];
    for (triangles, vertices) in lists {
        let triangles = triangles.to_vec();
        let positions = good[..vertices].to_vec();
        calls.push((
            "add",
            Box::new(move |world, _| world.add(&triangles, &positions).map(drop)),
        ));
    }
    for corners in [
        ([1.0; 3], [0.0; 3]),
        ([0.0; 3], [0.5; 3]),
        ([2.0; 3], [3.0; 3]),
    ] {
        let corners = (corners.0.map(convert), corners.1.map(convert));
        calls.push((
            "set_loose_box",
            Box::new(move |world, id| world.set_loose_box(id, Some(corners))),
        ));
    }
    calls.extend([
        (
            "pairs between",
            Box::new(|world: &mut World<S>, id| {
                world
                    .intersections(Selection::Between(id, id))
                    .all()
                    .map(drop)
            }) as _,
        ),
        (
            "first between",
            Box::new(|world: &mut World<S>, id| {
                world
                    .intersections(Selection::Between(id, id))
                    .first()
                    .map(drop)
            }) as _,
        ),
        (
            "visit between",
            Box::new(|world: &mut World<S>, id| {
                world
                    .intersections(Selection::Between(id, id))
                    .visit(|_| ControlFlow::Break(()))
                    .map(drop)
            }) as _,
        ),
    ]);
    calls
}

fn refused_calls_change_nothing<S: Scalar>(convert: fn(f64) -> S) {
    let (triangles, flat) = sheet(4);
    let shape = |tilt: f32| -> Vec<[S; 3]> {
        let place = |&[x, y, _]: &[f32; 3]| [x, y, tilt * (x - 0.4)].map(|x| convert(f64::from(x)));
        flat.iter().map(place).collect()
    };
    // A body that meets itself: every triangle twice, over vertices of its own.
    let doubled: Vec<[u32; 3]> = triangles
        .iter()
        .flat_map(|&corners| [corners, corners.map(|vertex| vertex + 16)])
        .collect();
    let calls = bad_calls(convert);
    for options in every_configuration().into_iter().step_by(53) {
        let mut world = World::with_options(options);
        world.add(&triangles, &shape(0.0)).unwrap();
        let body = world.add(&triangles, &shape(1.0)).unwrap();
        world
            .add(&doubled, &[shape(0.5), shape(0.5)].concat())
            .unwrap();
        let before = answers(&mut world);
        assert!(before.pairs.len() > 10 && !before.itself[2].is_empty());
        for (place, (name, call)) in calls.iter().enumerate() {
            // Refused twice in a row: with valid boxes, and when boxes have to be made anew.
            for moved in [false, true] {
                if moved {
                    world.set_positions(body, &shape(1.0)).unwrap();
                }
                let error = call(&mut world, body).expect_err(name);
                assert_eq!(
                    call(&mut world, body).as_ref().map_err(ToString::to_string),
                    Err(error.to_string()),
                    "{name}"
                );
                let about = if *name == "add" { None } else { Some(body) };
                assert_eq!(error.body, about, "{name}: {error}");
                assert_eq!(
                    answers(&mut world),
                    before,
                    "bad call {place}, {name}: {error}"
                );
            }
        }
        // No id was lost.
        assert_eq!(world.add(&triangles, &shape(9.0)), Ok(BodyId(3)));
    }
}

#[test]
fn no_refused_call_changes_an_answer() {
    refused_calls_change_nothing::<f32>(|x| x as f32);
    refused_calls_change_nothing::<f64>(|x| x);
}

/// An id means no other body once its own is gone, nor does an id of a larger world.
#[test]
fn ids_of_removed_bodies_stay_refused() {
    let (triangles, positions) = sheet(3);
    let mut world = World::<f32>::new();
    let mut gone = Vec::new();
    for round in 0..40 {
        let ids: Vec<_> = (0..3)
            .map(|_| world.add(&triangles, &positions).unwrap())
            .collect();
        assert!(ids.iter().all(|id| !gone.contains(id)));
        let removed = ids[round % 3];
        world.remove(removed).unwrap();
        gone.push(removed);
        for &id in &gone {
            let error = Error {
                body: Some(id),
                kind: ErrorKind::NoSuchBody,
            };
            assert_eq!(
                world.intersections(Selection::Within(id)).all(),
                Err(error.clone())
            );
            assert_eq!(world.tree_cut(id, 0), Err(error.clone()));
            assert_eq!(world.remove(id), Err(error));
        }
        let pairs = world.intersections(Selection::World).all().unwrap();
        assert!(
            pairs
                .iter()
                .all(|pair| !gone.contains(&pair.body_a) && !gone.contains(&pair.body_b))
        );
    }
    assert_eq!(world.bodies().len(), 80);
}

/// Options have no bad values: the largest and the smallest of each give right answers.
#[test]
fn the_ends_of_every_option() {
    let (triangles, flat) = sheet(9);
    let crumpled: Vec<[f32; 3]> = flat
        .iter()
        .map(|&[x, y, _]| [x, y, (x * 40.0).sin() * (y * 31.0).cos() * 0.3])
        .collect();
    let expected = reference::intersection_pairs(&triangles, &flat, &triangles, &crumpled).unwrap();
    let within = reference::self_intersection_pairs(&triangles, &crumpled).unwrap();
    assert!(expected.len() > 10);
    let ends = [NonZeroU32::MIN, NonZeroU32::MAX];
    for options in every_configuration().into_iter().step_by(97) {
        for leaf_size in ends {
            for levels_at_once in ends {
                for level in [None, Some(0), Some(u32::MAX)] {
                    let mut options: Options = options;
                    options.leaf_size = leaf_size;
                    options.update = Update::Hybrid {
                        level,
                        levels_at_once,
                    };
                    let mut world = World::with_options(options);
                    let a = world.add(&triangles, &flat).unwrap();
                    let b = world.add(&triangles, &crumpled).unwrap();
                    assert_eq!(
                        world.triangles_of(Selection::Between(a, b)),
                        expected,
                        "{options:?}"
                    );
                    assert_eq!(
                        world.triangles_of(Selection::Within(b)),
                        within,
                        "{options:?}"
                    );
                    let depth = world.tree_shape(b).unwrap().depth;
                    assert_eq!(world.tree_cut(b, u32::MAX), world.tree_cut(b, depth));
                    world.validate().unwrap();
                }
            }
        }
    }
}

/// Bodies that are hard on a tree: all in one point, at the ends of the range, tiny numbers.
fn check_nasty_shapes<S: Scalar>(convert: fn(f64) -> S) {
    let largest = f64::from(f32::MAX);
    let tiny = f64::from(f32::from_bits(1));
    let all_over = |place: fn(usize, f64) -> [f64; 3], scale: f64| -> Vec<[S; 3]> {
        (0..24).map(|i| place(i, scale).map(convert)).collect()
    };
    let zigzag = |i: usize, scale: f64| [i % 3, i / 3 % 3, i % 2].map(|x| (x as f64 - 1.0) * scale);
    let shapes = [
        all_over(|_, _| [0.0; 3], 0.0),
        all_over(|_, scale| [scale; 3], largest),
        all_over(zigzag, largest),
        all_over(zigzag, tiny),
        all_over(zigzag, 1e-30),
        all_over(
            |i, scale| [if i % 5 == 0 { scale } else { 0.0 }, i as f64, -0.0],
            largest,
        ),
        all_over(
            |i, _| [if i % 2 == 0 { 0.0 } else { -0.0 }, i as f64 * 1e-40, 1e30],
            0.0,
        ),
    ];
    let strip: Vec<[u32; 3]> = (0..22).map(|i| [i, i + 1, i + 2]).collect();
    let soup: Vec<[u32; 3]> = (0..40)
        .map(|i| [i * 7 % 24, i * 5 % 24, i * 11 % 24])
        .collect();
    let one: Vec<[u32; 3]> = vec![[23, 23, 23]; 30];
    for triangles in [&strip, &soup, &one] {
        let between = |a, b| reference::intersection_pairs(triangles, a, triangles, b).unwrap();
        let expected: Vec<Vec<_>> = shapes
            .iter()
            .map(|a| shapes.iter().map(|b| between(a, b)).collect())
            .collect();
        let within: Vec<_> = shapes
            .iter()
            .map(|a| reference::self_intersection_pairs(triangles, a).unwrap())
            .collect();
        for options in every_configuration().into_iter().step_by(61) {
            let mut world = World::<S>::with_options(options);
            let a = world.add(triangles, &shapes[0]).unwrap();
            let b = world.add(triangles, &shapes[1]).unwrap();
            for ((shape_a, expected), within) in shapes.iter().zip(&expected).zip(&within) {
                world.set_positions(a, shape_a).unwrap();
                for (shape_b, expected) in shapes.iter().zip(expected) {
                    world.set_positions(b, shape_b).unwrap();
                    assert_eq!(
                        world.intersections(Selection::World).all().unwrap().len(),
                        expected.len()
                    );
                    assert_eq!(&world.triangles_of(Selection::Between(a, b)), expected);
                    world.validate().unwrap();
                }
                world.rebuild(a).unwrap();
                assert_eq!(&world.triangles_of(Selection::Within(a)), within);
            }
        }
    }
}

#[test]
fn shapes_that_are_hard_on_a_tree() {
    check_nasty_shapes::<f32>(|x| x as f32);
    check_nasty_shapes::<f64>(|x| x);
}

/// The reference refuses exactly what a world refuses.
#[test]
fn the_reference_refuses_the_same() {
    let flat = [[0.0_f64; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bad = [[f64::NAN; 3]; 3];
    let triangle = [[0, 1, 2]];
    let cases: [(&[[u32; 3]], &[[f64; 3]]); 4] = [
        (&[], &flat),
        (&triangle, &[]),
        (&triangle, &bad),
        (&[[0, 1, u32::MAX]], &flat),
    ];
    for (triangles, positions) in cases {
        // Compared as text, since a NaN in an error does not equal itself.
        let text = |refused: Result<Vec<[u32; 2]>, Error>| refused.unwrap_err().to_string();
        let error = World::new()
            .add(triangles, positions)
            .unwrap_err()
            .to_string();
        let within = reference::self_intersection_pairs(triangles, positions);
        let first = reference::intersection_pairs(triangles, positions, &triangle, &flat);
        let second = reference::intersection_pairs(&triangle, &flat, triangles, positions);
        assert_eq!(
            [within, first, second].map(text),
            [(); 3].map(|()| error.clone())
        );
    }
}

/// Two sheets that cross.
fn crossing() -> (World<f32>, [BodyId; 2]) {
    let (triangles, flat) = sheet(6);
    let tilted: Vec<[f32; 3]> = flat.iter().map(|&[x, y, _]| [x, y, x - 0.45]).collect();
    let mut world = World::new();
    let bodies = [flat, tilted].map(|shape| world.add(&triangles, &shape).unwrap());
    (world, bodies)
}

/// Unwinds without printing a message.
fn panic_of_the_callers() -> ! {
    resume_unwind(Box::new("the caller's"))
}

/// A panic in the caller's code, in the middle of a call, loses nothing.
#[test]
fn a_caller_that_panics() {
    let (mut world, [a, b]) = crossing();
    let before = answers(&mut world);
    let written = catch_unwind(AssertUnwindSafe(|| {
        world.write_positions(a, |_| panic_of_the_callers()).is_ok()
    }));
    assert!(written.is_err());
    assert_eq!(answers(&mut world), before);
    world.set_positions(a, &[[0.5; 3]; 36]).unwrap();
    world.set_positions(a, &sheet(6).1).unwrap();
    let visited = catch_unwind(AssertUnwindSafe(|| {
        world
            .intersections(Selection::Between(a, b))
            .visit(|_| -> ControlFlow<()> { panic_of_the_callers() })
            .is_ok()
    }));
    assert!(visited.is_err());
    assert_eq!(answers(&mut world), before);
}

#[test]
fn a_visitor_of_the_whole_world_that_panics() {
    let (mut world, _) = crossing();
    let before = answers(&mut world);
    let visited = catch_unwind(AssertUnwindSafe(|| {
        world
            .intersections(Selection::World)
            .visit(|_| -> ControlFlow<()> { panic_of_the_callers() })
            .is_ok()
    }));
    assert!(visited.is_err());
    assert_eq!(answers(&mut world), before);
}
