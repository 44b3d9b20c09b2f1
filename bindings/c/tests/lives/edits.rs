//! Meshes that change, and lists that are followed through that, by C and by Rust.

use crate::{Random, column, rows, rows_of};
use pliant::{
    BodyId, Changes, EdgeEdge, Edited, Fused, Pair, Piece, Scalar, Selection, VertexTriangle, World,
};
use pliant_c::*;
use std::ptr::{null, null_mut};
use std::slice;

/// Lists that are followed: triangles that intersect; vertices and triangles, and edges, that are
/// near each other.
pub(crate) struct Followed {
    c: [*mut PliantChanges; 3],
    triangles: Changes<Pair>,
    vertices: Changes<VertexTriangle>,
    edges: Changes<EdgeEdge>,
}

impl Followed {
    pub(crate) fn new() -> Self {
        let c = [0, 1, 2].map(|elements| {
            let mut changes = null_mut();
            // SAFETY: all arguments are there.
            unsafe {
                assert_eq!(
                    pliant_changes_new(elements, &raw mut changes, null_mut()),
                    0
                );
            };
            changes
        });
        Self {
            c,
            triangles: Changes::new(),
            vertices: Changes::new(),
            edges: Changes::new(),
        }
    }

    /// Compares what began and ended since the last call.
    pub(crate) fn update<S: Scalar>(&mut self, rust: &mut World<S>) {
        let of = Selection::Everything;
        let list = rust.intersections(of).all().unwrap().to_vec();
        let rows: Vec<[u32; 4]> = list.iter().map(|&it| it.into()).collect();
        Self::compare(self.c[0], &rows, self.triangles.update(&list));
        let list = rust.vertex_triangle_candidates(of, 0.25);
        let list = list.all().unwrap().to_vec();
        let rows: Vec<[u32; 4]> = list.iter().map(|&it| it.into()).collect();
        Self::compare(self.c[1], &rows, self.vertices.update(&list));
        let list = rust.edge_edge_candidates(of, 0.25).all().unwrap().to_vec();
        let rows: Vec<[u32; 4]> = list.iter().map(|&it| it.into()).collect();
        Self::compare(self.c[2], &rows, self.edges.update(&list));
    }

    fn compare(c: *mut PliantChanges, rows: &[[u32; 4]], expected: pliant::Changed) {
        let mut changed = PliantChanged {
            count: 9,
            numbers: null(),
            began_count: 9,
            began: null(),
            ended_count: 9,
            ended: null(),
            ended_numbers: null(),
        };
        let start = rows.as_ptr().cast();
        // SAFETY: all arguments are there.
        let status =
            unsafe { pliant_changes_update(c, start, rows.len(), &raw mut changed, null_mut()) };
        assert_eq!(status, 0);
        assert_eq!(column(changed.numbers, changed.count, 1), expected.numbers);
        let began: Vec<u64> = expected.began.iter().map(|&it| it as u64).collect();
        assert_eq!(column(changed.began, changed.began_count, 1), began);
        let row = |[(body_a, a), (body_b, b)]: [(BodyId, u32); 2]| [body_a.0, a, body_b.0, b];
        let ended: Vec<u32> = expected
            .ended
            .iter()
            .flat_map(|it| row(it.things))
            .collect();
        assert_eq!(column(changed.ended, changed.ended_count, 4), ended);
        let numbers: Vec<u64> = expected.ended.iter().map(|it| it.number).collect();
        assert_eq!(
            column(changed.ended_numbers, changed.ended_count, 1),
            numbers
        );
    }

    /// Notes an edit of a body that had these edges.
    fn edited<S: Scalar>(
        &mut self,
        rust: &World<S>,
        (body, before): (BodyId, &[[u32; 2]]),
        (told, expected): (&PliantEdited, &Edited),
    ) {
        self.triangles.edited(body, expected);
        self.vertices.edited(body, expected);
        let after = rust.edges(body).unwrap();
        self.edges.follow(|_, of, edge| {
            let ends = before.get(edge as usize);
            let is_same = of != body || ends.is_some() && ends == after.get(edge as usize);
            is_same.then_some((of, edge))
        });
        let (start, end) = (before.as_ptr().cast(), after.as_ptr().cast());
        let [triangles, vertices, edges] = self.c;
        let (m, n) = (before.len(), after.len());
        // SAFETY: all arguments are there.
        unsafe {
            for changes in [triangles, vertices] {
                let noted = pliant_changes_edited(changes, body.0, told, null_mut());
                assert_eq!(noted, 0);
            }
            let noted = pliant_changes_edges_edited(edges, body.0, start, m, end, n, null_mut());
            assert_eq!(noted, 0);
        }
    }
}

impl Drop for Followed {
    fn drop(&mut self) {
        for changes in self.c {
            // SAFETY: they were made, and no call is inside.
            unsafe { pliant_changes_free(changes) };
        }
    }
}

fn compare(told: &PliantEdited, expected: &Edited) {
    assert_eq!(rows_of(&told.new_triangles, 1), expected.new_triangles);
    assert_eq!(
        rows_of(&told.changed_triangles, 1),
        expected.changed_triangles
    );
    assert_eq!(
        rows_of(&told.removed_triangles, 1),
        expected.removed_triangles
    );
    assert_eq!(rows_of(&told.new_vertices, 1), expected.new_vertices);
    assert_eq!(
        rows_of(&told.removed_vertices, 1),
        expected.removed_vertices
    );
}

/// An edit of random steps. It may be refused, by both for one reason.
pub(crate) fn edit<S: Scalar>(
    (c, rust): (*mut PliantWorld, &mut World<S>),
    (body, random): (BodyId, &mut Random),
    followed: &mut Followed,
    cast: fn(f64) -> S,
) {
    let mut own = rust.edit(body).unwrap();
    let mut edit = null_mut();
    let mut edited = PliantEdited::default();
    let before = rust.edges(body).unwrap().to_vec();
    // SAFETY: the world and all arguments are there.
    unsafe {
        assert_eq!(pliant_world_edit(c, body.0, &raw mut edit, null_mut()), 0);
        for _ in 0..=random.below(3) {
            let [m, n] = [own.triangle_count() as u64, own.vertex_count() as u64];
            let [t, v, w] = [m, n, n].map(|range| random.below(range) as u32);
            let point = random.positions(1).remove(0).map(cast);
            let corners = [(); 3].map(|()| random.below(n) as u32);
            let mut first = u32::MAX;
            let status = match random.below(7) {
                0 => {
                    assert_eq!(own.add_vertices(&[point; 2]).start, n as u32);
                    let points = [point; 2];
                    let (rows, out) = (rows(&points), &raw mut first);
                    let status = pliant_edit_add_vertices(edit, rows, out, null_mut());
                    assert_eq!(first, n as u32);
                    status
                }
                1 => {
                    own.place_vertex(v, point);
                    pliant_edit_place_vertex(edit, v, rows(&[point]), null_mut())
                }
                2 => {
                    let new = own.split_vertex(v, &[t]);
                    let (list, out) = (&raw const t, &raw mut first);
                    let status = pliant_edit_split_vertex(edit, v, list, 1, out, null_mut());
                    assert_eq!(first, new);
                    status
                }
                3 => {
                    own.merge_vertices(v, w);
                    pliant_edit_merge_vertices(edit, v, w, null_mut())
                }
                4 => {
                    let new = own.add_triangles(&[corners]).start;
                    let faces = PliantFaces {
                        data: corners.as_ptr().cast(),
                        count: 1,
                        row: 0,
                        column: 0,
                        bytes: 4,
                        is_signed: 0,
                    };
                    let status = pliant_edit_add_triangles(edit, faces, &raw mut first, null_mut());
                    assert_eq!(first, new);
                    status
                }
                5 => {
                    own.set_triangle(t, corners);
                    pliant_edit_set_triangle(edit, t, corners.as_ptr(), null_mut())
                }
                _ => {
                    own.remove_triangles(&[t]);
                    pliant_edit_remove_triangles(edit, &raw const t, 1, null_mut())
                }
            };
            assert_eq!(status, 0);
        }
        let (mut of, mut m, mut n) = (9, 9, 9);
        let (to, triangles, vertices) = (&raw mut of, &raw mut m, &raw mut n);
        assert_eq!(
            pliant_edit_counts(edit, to, triangles, vertices, null_mut()),
            0
        );
        assert_eq!(
            (of, m, n),
            (body.0, own.triangle_count(), own.vertex_count())
        );
        let done = rust.apply(&own);
        let status = pliant_world_apply(c, edit, &raw mut edited, null_mut());
        pliant_edit_free(edit);
        match done {
            Err(_) => assert!(status > 0),
            Ok(expected) => {
                assert_eq!(status, 0);
                compare(&edited, &expected);
                followed.edited(rust, (body, &before), (&edited, &expected));
            }
        }
    }
}

/// Welds a body.
pub(crate) fn weld<S: Scalar>(
    (c, rust): (*mut PliantWorld, &mut World<S>),
    body: BodyId,
    followed: &mut Followed,
) {
    let before = rust.edges(body).unwrap().to_vec();
    let mut edited = PliantEdited::default();
    // SAFETY: the world and all arguments are there.
    let status = unsafe { pliant_world_weld(c, body.0, 0.5, null(), &raw mut edited, null_mut()) };
    let expected = rust.weld(body, 0.5).unwrap();
    assert_eq!(status, 0);
    compare(&edited, &expected);
    followed.edited(rust, (body, &before), (&edited, &expected));
}

/// Splits a body; returns the new bodies.
pub(crate) fn split<S: Scalar>(
    (c, rust): (*mut PliantWorld, &mut World<S>),
    body: BodyId,
    followed: &mut Followed,
) -> Vec<BodyId> {
    let expected: Vec<Piece> = rust.split(body).unwrap();
    let (mut pieces, mut count) = (null(), 9);
    // SAFETY: the world and all arguments are there.
    let pieces = unsafe {
        let status = pliant_world_split(c, body.0, &raw mut pieces, &raw mut count, null_mut());
        assert_eq!((status, count), (0, expected.len()));
        for changes in followed.c {
            assert_eq!(
                pliant_changes_split(changes, body.0, pieces, count, null_mut()),
                0
            );
        }
        match count {
            0 => &[],
            _ => slice::from_raw_parts(pieces, count),
        }
    };
    for (told, expected) in pieces.iter().zip(&expected) {
        assert_eq!(told.body, expected.body.0);
        assert_eq!(rows_of(&told.triangles, 1), expected.triangles);
        assert_eq!(rows_of(&told.vertices, 1), expected.vertices);
    }
    followed.triangles.split(body, &expected);
    followed.vertices.split(body, &expected);
    followed.edges.split(body, &expected);
    expected.iter().map(|it| it.body).collect()
}

/// Fuses two bodies.
pub(crate) fn fuse<S: Scalar>(
    (c, rust): (*mut PliantWorld, &mut World<S>),
    [a, b]: [BodyId; 2],
    followed: &mut Followed,
) {
    let expected: Fused = rust.fuse(a, b).unwrap();
    let list = PliantList::default();
    let mut fused = PliantFused {
        triangles: list,
        vertices: list,
    };
    // SAFETY: the world and all arguments are there.
    unsafe {
        assert_eq!(
            pliant_world_fuse(c, a.0, b.0, &raw mut fused, null_mut()),
            0
        );
        for changes in followed.c {
            assert_eq!(
                pliant_changes_fused(changes, a.0, b.0, &raw const fused, null_mut()),
                0
            );
        }
    }
    assert_eq!(rows_of(&fused.triangles, 1), expected.triangles);
    assert_eq!(rows_of(&fused.vertices, 1), expected.vertices);
    followed.triangles.fused(a, b, &expected);
    followed.vertices.fused(a, b, &expected);
    followed.edges.fused(a, b, &expected);
}
