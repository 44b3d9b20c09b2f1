//! Inside and outside, closest points and depth, by C and by Rust.

use crate::{column, faces, numbers, rows, rows_of};
use pliant::{BodyId, ClosestPoint, Error, InsideRule, Located, Scalar, Selection, Side, World};
use pliant_c::*;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

/// The answer that a function writes, unless it refuses.
fn told<T>(ask: impl FnOnce(*mut T) -> i32) -> Result<T, i32> {
    let mut out = MaybeUninit::uninit();
    match ask(out.as_mut_ptr()) {
        // SAFETY: the call has succeeded, so it has written.
        0 => Ok(unsafe { out.assume_init() }),
        status => Err(status),
    }
}

/// Answer of Rust, unless C has refused with a status of its errors, and Rust has, too.
fn expected<T>(rust: Result<T, Error>, refused: Option<i32>) -> Option<T> {
    let is_for_errors = refused.is_none_or(|status| [13, 29].contains(&status));
    assert!(is_for_errors && rust.is_err() == refused.is_some());
    rust.ok()
}

fn check_located(c: Result<PliantLocated, i32>, rust: Result<Vec<Located>, Error>) {
    let Some(expected) = expected(rust, c.as_ref().err().copied()) else {
        return;
    };
    let told = c.unwrap();
    let side = |it: &Located| match it.side {
        Side::Outside => 0,
        Side::On => 1,
        Side::Inside => 2,
    };
    let sides: Vec<u8> = expected.iter().map(side).collect();
    assert_eq!(column(told.sides, told.count, 1), sides);
    let windings: Vec<i32> = expected.iter().map(|it| it.winding).collect();
    assert_eq!(column(told.windings, told.count, 1), windings);
}

fn check_closest(c: Result<PliantClosest, i32>, rust: Result<Vec<Option<ClosestPoint>>, Error>) {
    let Some(expected) = expected(rust, c.as_ref().err().copied()) else {
        return;
    };
    let told = c.unwrap();
    assert_eq!(told.count, expected.len());
    let found = column(told.found, told.count, 1);
    let bodies = column(told.bodies, told.count, 1);
    let triangles = column(told.triangles, told.count, 1);
    let features = column(told.features, told.count, 1);
    let distances = column(told.distances, told.count, 1);
    let of_three = [told.points, told.weights, told.directions].map(|all| {
        let all = column(all, told.count, 3);
        all.as_chunks::<3>().0.to_vec()
    });
    for (place, expected) in expected.into_iter().enumerate() {
        let numbers = (bodies[place], triangles[place], features[place]);
        let vectors = of_three.each_ref().map(|all| all[place]);
        assert_eq!(found[place], u8::from(expected.is_some()));
        let Some(it) = expected else {
            assert_eq!(numbers, (u32::MAX, u32::MAX, 255));
            assert!(distances[place] == f64::INFINITY);
            assert!(vectors.as_flattened().iter().all(|x| x.is_nan()));
            continue;
        };
        assert_eq!(numbers, (it.body.0, it.triangle, it.feature.into()));
        assert_eq!(distances[place], it.distance);
        let direction = it.direction.unwrap_or_default();
        assert_eq!(vectors, [it.point, it.barycentric, direction]);
    }
}

/// Contents of a selection, and all bodies by themselves.
pub(crate) fn compare<S: Scalar>(c: *mut PliantWorld, rust: &mut World<S>, of: Selection) {
    let query = PliantQuery {
        of: numbers(of),
        ..PliantQuery::ALL
    };
    // SAFETY: the world and all arguments are there.
    let contained: PliantContainment =
        told(|out| unsafe { pliant_world_contained(c, &raw const query, out, null_mut()) })
            .unwrap();
    let expected = rust.contained(of).unwrap();
    let row = |it: &pliant::Contained| [it.body.0, it.component, it.inside.0];
    let all: Vec<u32> = expected.all.iter().flat_map(row).collect();
    let open: Vec<u32> = expected.open.iter().map(|it| it.0).collect();
    assert_eq!(rows_of(&contained.all, 3), all);
    assert_eq!(rows_of(&contained.open, 1), open);
    for body in rust.bodies().collect::<Vec<_>>() {
        // SAFETY: the world and all arguments are there.
        let edges: PliantWatertight =
            told(|out| unsafe { pliant_world_watertight(c, body.0, out, null_mut()) }).unwrap();
        let expected = rust.watertight(body).unwrap();
        assert_eq!(rows_of(&edges.open, 2), expected.open.as_flattened());
        assert_eq!(rows_of(&edges.turned, 2), expected.turned.as_flattened());
        assert_eq!(rows_of(&edges.doubled, 2), expected.doubled.as_flattened());
    }
}

/// Where a body's vertices are in another, and how deep.
pub(crate) fn compare_bodies<S: Scalar>(
    c: *mut PliantWorld,
    rust: &mut World<S>,
    a: BodyId,
    b: BodyId,
) {
    let at = rust.positions(a).unwrap();
    let points = rows(&at);
    let (none, error) = (null(), null_mut());
    let rules = [
        InsideRule::NonZero,
        InsideRule::Positive,
        InsideRule::Parity,
    ];
    for (number, rule) in (0..).zip(rules) {
        // SAFETY: the world and all arguments are there.
        let (of_points, of_vertices) = unsafe {
            (
                told(|out| pliant_world_points_inside(c, points, b.0, number, none, out, error)),
                told(|out| pliant_world_inside(c, a.0, b.0, number, none, out, error)),
            )
        };
        check_located(of_points, rust.points_inside(&at, b, rule));
        check_located(of_vertices, rust.inside(a, b, rule));
    }
    for cut_off in [1.5, f64::INFINITY] {
        for of in [Some(b), None] {
            let body = of.map_or(u32::MAX, |it| it.0);
            // SAFETY: the world and all arguments are there.
            let closest = told(|out| unsafe {
                pliant_world_closest_points(c, points, body, cut_off, none, out, error)
            });
            check_closest(closest, rust.closest_points(&at, of, cut_off));
        }
        // SAFETY: the world and all arguments are there.
        let closest = told(|out| unsafe {
            pliant_world_signed_closest_points(c, points, b.0, cut_off, none, out, error)
        });
        check_closest(closest, rust.signed_closest_points(&at, b, cut_off));
    }
    // SAFETY: the world and all arguments are there.
    let depth: Result<PliantDepth, i32> =
        told(|out| unsafe { pliant_world_depth(c, a.0, b.0, none, out, error) });
    if let Some(expected) = expected(rust.depth(a, b), depth.as_ref().err().copied()) {
        let depth = depth.unwrap();
        assert_eq!(
            column(depth.of_vertices, depth.count, 1),
            expected.of_vertices
        );
        assert_eq!(depth.vertex, expected.vertex.unwrap_or(u32::MAX));
        assert_eq!(depth.at_least, expected.at_least);
        assert_eq!(depth.at_most, expected.at_most);
    }
}

/// Adds a closed body, in whose inside there is much, and compares another with it.
pub(crate) fn compare_with_a_solid<S: Scalar>(
    (c, rust): (*mut PliantWorld, &mut World<S>),
    other: BodyId,
    cast: fn(f64) -> S,
) {
    let at = [[0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]].map(|it| it.map(cast));
    let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let solid = rust.add(&triangles, &at).unwrap();
    let wide = triangles.map(|it| it.map(i64::from));
    let mut body = 0;
    let out = &raw mut body;
    // SAFETY: the world and all arguments are there.
    let status = unsafe { pliant_world_add(c, faces(&wide), rows(&at), out, null_mut()) };
    assert_eq!((status, body), (0, solid.0));
    compare(c, rust, Selection::Everything);
    compare_bodies(c, rust, other, solid);
}
