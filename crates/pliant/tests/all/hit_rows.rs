//! Lists in job order, and in compressed rows: the hits of sorted lists.

use crate::common::{Lcg, covering_configurations, sheet};
use pliant::{
    BodyId, EdgeEdge, ErrorKind, HitRows, InRows, Instructions, Options, Query, Selection,
    VertexTriangle, World,
};
use std::num::NonZeroUsize;

/// Crumpled sheets through each other.
fn sheets(options: Options, instructions: Instructions) -> World<f32> {
    let random = &mut Lcg(29);
    let mut world = World::with_options(options);
    world.use_instructions(instructions);
    for body in 0..5 {
        let (triangles, flat) = sheet(20 - 3 * body);
        let crumple = |[x, y, z]: [f32; 3]| [x, y, z].map(|x| x + 0.1 * random.unit());
        let shape: Vec<[f32; 3]> = flat.into_iter().map(crumple).collect();
        world.add(&triangles, &shape).unwrap();
    }
    world
}

#[test]
fn job_order_is_the_same_for_any_threads_and_instructions() {
    for options in covering_configurations() {
        let mut lists: Option<(Vec<VertexTriangle>, Vec<EdgeEdge>)> = None;
        for threads in [1, 3] {
            for instructions in Instructions::all() {
                let mut options = options;
                options.threads = NonZeroUsize::new(threads).unwrap();
                let world = &mut sheets(options, instructions);
                let of = Selection::Everything;
                let mut found = (Vec::new(), Vec::new());
                world
                    .vertex_triangle_candidates(of, 0.01)
                    .unsorted(&mut found.0)
                    .unwrap();
                world
                    .edge_edge_candidates(of, 0.01)
                    .unsorted(&mut found.1)
                    .unwrap();
                let mut sorted = found.clone();
                sorted.0.sort_unstable();
                sorted.1.sort_unstable();
                let all = world.vertex_triangle_candidates(of, 0.01).all().unwrap();
                assert!(all.len() > 10_000 && sorted.0 == all);
                assert!(sorted.1 == world.edge_edge_candidates(of, 0.01).all().unwrap());
                assert!(
                    *lists.get_or_insert_with(|| found.clone()) == found,
                    "{options:?}"
                );
            }
        }
    }
}

/// Checks the rows of a list against a search of all hits.
fn check_rows<H: InRows>(
    world: &World<f32>,
    hits: &[H],
    (first, count): (fn(&H) -> (BodyId, u32), fn(&World<f32>, BodyId) -> usize),
    rows: &mut HitRows,
) {
    rows.update(world, hits).unwrap();
    assert_eq!(rows.places().len(), hits.len());
    let mut row = 0;
    for body in world.bodies() {
        assert_eq!(rows.start(body), Some(row));
        for element in 0..count(world, body) as u32 {
            let of_row = rows.row(body, element);
            let [start, end] = [row, row + 1].map(|at| rows.offsets()[at] as usize);
            assert_eq!(of_row, &rows.places()[start..end]);
            assert!(of_row.is_sorted_by(|a, b| a < b));
            for &place in of_row {
                assert_eq!(first(&hits[place as usize]), (body, element));
            }
            row += 1;
        }
        assert!(rows.row(body, count(world, body) as u32).is_empty());
    }
    assert_eq!(rows.offsets().len(), row + 1);
}

#[test]
fn rows_have_all_hits_of_their_element() {
    let world = &mut sheets(Options::default(), Instructions::all()[0]);
    let gone = world.bodies().nth(2).unwrap();
    world.remove(gone).unwrap();
    let (of, rows) = (Selection::Everything, &mut HitRows::new());
    let vertices = |world: &World<f32>, body| world.vertex_count(body).unwrap();
    let edges = |world: &World<f32>, body| world.edges(body).unwrap().len();
    let triangles = |world: &World<f32>, body| world.triangle_count(body).unwrap();

    let mut hits = Vec::new();
    world
        .vertex_triangle_candidates(of, 0.01)
        .unsorted(&mut hits)
        .unwrap();
    assert!(hits.len() > 1000);
    let first = |hit: &VertexTriangle| (hit.vertex_body, hit.vertex);
    check_rows(world, &hits, (first, vertices), rows);
    let mut hits = Vec::new();
    world
        .close_edge_edge_pairs(of, 0.01)
        .unsorted(&mut hits)
        .unwrap();
    assert!(hits.len() > 1000);
    let first = |hit: &pliant::CloseEdgeEdge| (hit.pair.body_a, hit.pair.edge_a);
    check_rows(world, &hits, (first, edges), rows);
    let pairs = world.intersections(of).all().unwrap().to_vec();
    let first = |hit: &pliant::Pair| (hit.body_a, hit.triangle_a);
    check_rows(world, &pairs, (first, triangles), rows);
    check_rows(world, &pairs[..0], (first, triangles), rows);
    assert!(rows.row(gone, 0).is_empty() && rows.start(gone).is_none());

    // Of another mesh, or another world.
    let mut other = pairs[3];
    other.triangle_a = u32::MAX;
    let refused = rows.update(world, &[pairs[0], other]).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::NoSuchHit { hit: 1 });
    assert_eq!(
        (refused.body, &*rows),
        (Some(other.body_a), &HitRows::new())
    );
    other.body_a = gone;
    let refused = rows.update(world, &[other]).unwrap_err();
    assert_eq!(
        (refused.body, refused.kind),
        (Some(gone), ErrorKind::NoSuchBody)
    );
    assert!(rows.row(other.body_b, 0).is_empty());
}

#[test]
fn limits_and_interruptions_leave_an_empty_list() {
    let world = &mut sheets(Options::default(), Instructions::all()[0]);
    let ask = |world: &mut World<f32>, limit: usize, stop: bool, list: &mut Vec<_>| {
        let stopped = || stop;
        let query: Query<pliant::Pair> = world.intersections(Selection::Everything);
        query.at_most(limit).interrupt_if(&stopped).unsorted(list)
    };
    let mut list = Vec::new();
    ask(world, usize::MAX, false, &mut list).unwrap();
    let count = list.len();
    assert!(count > 1000);
    ask(world, count, false, &mut list).unwrap();
    assert_eq!(list.len(), count);
    let refused = ask(world, count - 1, false, &mut list).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::TooManyHits { limit: count - 1 });
    assert!(list.is_empty());
    let refused = ask(world, count, true, &mut list).unwrap_err();
    assert_eq!((refused.kind, list.len()), (ErrorKind::Interrupted, 0));
}
