//! Worlds as they are, by C and by Rust.

use crate::{column, rows_of};
use pliant::{BodyId, Scalar, World};
use pliant_c::*;
use std::ptr::null_mut;

/// A function that gives a list of a body.
type List = unsafe extern "C" fn(*const PliantWorld, u32, *mut PliantList, *mut PliantError) -> i32;

/// A function that copies a shape of a body, if there is one.
type Shape = unsafe extern "C" fn(
    *const PliantWorld,
    u32,
    *mut f64,
    usize,
    *mut u8,
    *mut PliantError,
) -> i32;

/// Everything that both worlds have.
pub(crate) fn compare<S: Scalar>(c: *mut PliantWorld, rust: &World<S>) {
    let flags = |all: Vec<bool>| all.into_iter().map(u32::from).collect::<Vec<_>>();
    let ids: Vec<u32> = rust.bodies().map(|it| it.0).collect();
    let ignored: Vec<u32> = rust.ignored().iter().flatten().map(|it| it.0).collect();
    let (mut bodies, mut pairs) = (PliantList::default(), PliantList::default());
    let (mut bytes, mut work) = (0, PliantStatistics::default());
    // SAFETY: the world and all arguments are there.
    unsafe {
        assert_eq!(pliant_world_validate(c, null_mut()), 0);
        assert_eq!(pliant_world_bodies(c, &raw mut bodies, null_mut()), 0);
        assert_eq!(pliant_world_ignored(c, &raw mut pairs, null_mut()), 0);
        assert_eq!(pliant_world_memory_usage(c, &raw mut bytes, null_mut()), 0);
        assert_eq!(pliant_world_statistics(c, &raw mut work, null_mut()), 0);
    }
    assert_eq!(rows_of(&bodies, 1), ids);
    assert_eq!(rows_of(&pairs, 2), ignored);
    assert!(bytes > 0);
    for id in ids {
        let body = BodyId(id);
        let list = |function: List, columns: usize, expected: Vec<u32>| {
            let mut list = PliantList::default();
            // SAFETY: the world and all arguments are there.
            let status = unsafe { function(c, id, &raw mut list, null_mut()) };
            assert_eq!((status, rows_of(&list, columns)), (0, expected));
        };
        list(
            pliant_world_triangles,
            3,
            rust.triangles(body).unwrap().as_flattened().to_vec(),
        );
        list(
            pliant_world_edges,
            2,
            rust.edges(body).unwrap().as_flattened().to_vec(),
        );
        list(
            pliant_world_vertex_order,
            1,
            rust.vertex_order(body).unwrap().to_vec(),
        );
        list(pliant_world_components, 1, rust.components(body).unwrap());
        list(
            pliant_world_vertex_groups,
            1,
            rust.vertex_groups(body).unwrap(),
        );
        list(
            pliant_world_live_triangles,
            1,
            flags(rust.live_triangles(body).unwrap()),
        );
        list(
            pliant_world_live_vertices,
            1,
            flags(rust.live_vertices(body).unwrap()),
        );
        shapes(c, rust, body);
        settings(c, rust, body);
        tree(c, rust, body);
    }
}

fn bits<S: Scalar>(rows: &[[S; 3]]) -> Vec<u64> {
    rows.as_flattened()
        .iter()
        .map(|x| x.to_f64().to_bits())
        .collect()
}

fn shapes<S: Scalar>(c: *mut PliantWorld, rust: &World<S>, body: BodyId) {
    let count = rust.vertex_count(body).unwrap();
    let bits_of = |out: &[f64]| out.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let shape = |function: Shape, expected: Option<Vec<[S; 3]>>| {
        let (mut out, mut has) = (vec![7.0; 3 * count], 9);
        // SAFETY: the world and all arguments are there.
        let status =
            unsafe { function(c, body.0, out.as_mut_ptr(), count, &raw mut has, null_mut()) };
        assert_eq!((status, has), (0, u8::from(expected.is_some())));
        match expected {
            Some(rows) => assert_eq!(bits_of(&out), bits(&rows)),
            None => assert!(out.iter().all(|&x| x == 7.0)),
        }
    };
    shape(
        pliant_world_end_positions,
        rust.end_positions(body).unwrap(),
    );
    let rest = rust.rest_positions(body).unwrap();
    shape(pliant_world_rest_positions, rest.map(<[_]>::to_vec));
    let (mut out, mut thick) = (vec![7.0; 3 * count], vec![7.0; count]);
    let (mut triangles, mut vertices) = (0, 0);
    // SAFETY: the world and all arguments are there.
    unsafe {
        assert_eq!(
            pliant_world_positions(c, body.0, out.as_mut_ptr(), count, null_mut()),
            0
        );
        assert_eq!(
            pliant_world_thickness(c, body.0, thick.as_mut_ptr(), count, null_mut()),
            0
        );
        let (m, n) = (&raw mut triangles, &raw mut vertices);
        assert_eq!(pliant_world_counts(c, body.0, m, n, null_mut()), 0);
    }
    assert_eq!(bits_of(&out), bits(&rust.positions(body).unwrap()));
    assert_eq!(thick, rust.thickness(body).unwrap());
    assert_eq!(
        (triangles, vertices),
        (rust.triangle_count(body).unwrap(), count)
    );
}

fn settings<S: Scalar>(c: *mut PliantWorld, rust: &World<S>, body: BodyId) {
    let (mut membership, mut mask, mut environment) = (9, 9, 9);
    let (mut revision, mut corners, mut has) = (9, [[7.0; 3]; 2], 9);
    let (mut labels, mut near) = (PliantList::default(), PliantList::default());
    // SAFETY: the world and all arguments are there.
    unsafe {
        let (a, b) = (&raw mut membership, &raw mut mask);
        assert_eq!(pliant_world_filter(c, body.0, a, b, null_mut()), 0);
        assert_eq!(
            pliant_world_environment(c, body.0, &raw mut environment, null_mut()),
            0
        );
        assert_eq!(
            pliant_world_mesh_revision(c, body.0, &raw mut revision, null_mut()),
            0
        );
        let out = corners.as_mut_ptr().cast();
        assert_eq!(
            pliant_world_loose_box(c, body.0, out, &raw mut has, null_mut()),
            0
        );
        let (a, b) = (&raw mut labels, &raw mut near);
        assert_eq!(pliant_world_labels(c, body.0, a, b, null_mut()), 0);
    }
    assert_eq!((membership, mask), rust.filter(body).unwrap());
    assert_eq!(environment, rust.environment(body).unwrap());
    assert_eq!(revision, rust.mesh_revision(body).unwrap());
    let loose = rust.loose_box(body).unwrap();
    let expected = loose.map(|(lower, upper)| [lower, upper].map(|it| it.map(S::to_f64)));
    assert_eq!(
        (corners, has),
        (
            expected.unwrap_or([[7.0; 3]; 2]),
            u8::from(expected.is_some())
        )
    );
    let expected = rust.labels(body).unwrap();
    assert_eq!(
        rows_of(&labels, 1),
        expected.map_or(&[][..], |it| it.of_triangles)
    );
    let pairs = expected.and_then(|it| it.neighbours).unwrap_or_default();
    assert_eq!(rows_of(&near, 2), pairs.as_flattened());
    assert_eq!(
        near.numbers.is_null(),
        expected.is_none_or(|it| it.neighbours.is_none())
    );
}

fn tree<S: Scalar>(c: *mut PliantWorld, rust: &World<S>, body: BodyId) {
    let mut shape = PliantTreeShape {
        depth: 9,
        nodes: 9,
        leaves: 9,
    };
    let mut quality = 9.0;
    // SAFETY: the world and all arguments are there.
    unsafe {
        assert_eq!(
            pliant_world_tree_quality(c, body.0, &raw mut quality, null_mut()),
            0
        );
        assert_eq!(
            pliant_world_tree_shape(c, body.0, &raw mut shape, null_mut()),
            0
        );
    }
    // Each world was asked another number of questions, which say it.
    assert!(quality > 0.0 && quality < 9.0);
    let expected = rust.tree_shape(body).unwrap();
    let PliantTreeShape {
        depth,
        nodes,
        leaves,
    } = shape;
    assert_eq!(
        (depth, nodes, leaves),
        (expected.depth, expected.nodes, expected.leaves)
    );
    for level in 0..=depth {
        let mut parts = PliantList::default();
        let mut boxes = PliantBoxes {
            count: 9,
            corners: null_mut(),
            valid: null_mut(),
        };
        // SAFETY: the world and all arguments are there.
        unsafe {
            assert_eq!(
                pliant_world_tree_cut(c, body.0, level, &raw mut parts, null_mut()),
                0
            );
            assert_eq!(
                pliant_world_tree_boxes(c, body.0, level, &raw mut boxes, null_mut()),
                0
            );
        }
        assert_eq!(rows_of(&parts, 1), rust.tree_cut(body, level).unwrap());
        let expected = rust.tree_boxes(body, level).unwrap();
        let corners = expected.iter().flat_map(|it| [it.lower, it.upper]);
        let corners: Vec<f64> = corners.flatten().map(S::to_f64).collect();
        assert_eq!(column(boxes.corners, boxes.count, 6), corners);
        let valid: Vec<u8> = expected.iter().map(|it| u8::from(it.valid)).collect();
        assert_eq!(column(boxes.valid, boxes.count, 1), valid);
    }
}
