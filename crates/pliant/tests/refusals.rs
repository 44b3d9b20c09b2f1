//! Every refusal names what was wrong, and leaves the world as it was.

mod common;

use common::sheet;
use pliant::{BodyId, Error, ErrorKind, World};
use std::ops::ControlFlow;

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
            expected: 16,
            found: 15
        })
    );
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
    assert_eq!(
        world.self_intersection_pairs(body).unwrap(),
        [[0_u32; 2]; 0]
    );
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
        assert_eq!(world.remove(stranger).unwrap_err(), error);
        assert_eq!(world.rebuild(stranger).unwrap_err(), error);
        assert_eq!(world.set_filter(stranger, 0, 0).unwrap_err(), error);
        assert_eq!(world.set_loose_box(stranger, None).unwrap_err(), error);
        assert_eq!(world.ignore(stranger, body).unwrap_err(), error);
        assert_eq!(world.unignore(body, stranger).unwrap_err(), error);
        assert_eq!(world.triangle_count(stranger).unwrap_err(), error);
        assert_eq!(world.vertex_count(stranger).unwrap_err(), error);
        assert_eq!(world.tree_shape(stranger).unwrap_err(), error);
        assert_eq!(world.update_body(stranger).unwrap_err(), error);
        assert_eq!(
            world
                .intersection_pairs_between(body, stranger)
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .first_intersection_between(stranger, body)
                .unwrap_err(),
            error
        );
        assert_eq!(
            world
                .visit_intersections_between(stranger, body, |_| ControlFlow::Break(()))
                .unwrap_err(),
            error
        );
        assert_eq!(world.self_intersection_pairs(stranger).unwrap_err(), error);
        assert_eq!(world.first_self_intersection(stranger).unwrap_err(), error);
        assert_eq!(
            world
                .visit_self_intersections(stranger, |_| ControlFlow::Break(()))
                .unwrap_err(),
            error
        );
    }
    let same = Error {
        body: Some(body),
        kind: ErrorKind::SameBody,
    };
    assert_eq!(
        world.intersection_pairs_between(body, body).unwrap_err(),
        same
    );
    assert_eq!(world.ignore(body, body).unwrap_err(), same);
}

#[test]
fn an_empty_world_has_no_pairs() {
    let mut world = World::<f32>::default();
    world.update();
    assert_eq!(world.intersection_pairs(), []);
    assert_eq!(world.first_intersection(), None);
    world.validate().unwrap();
}
