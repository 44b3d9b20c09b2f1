//! Crossing edges: every configuration gives those that the reference finds, edge by edge.
//!
//! On closed surfaces in general position each curve of intersection is closed, so the numbers of
//! crossing edges and of pairs of triangles go together.

use crate::common::{Lcg, covering_configurations, world_of};
use pliant::{BodyId, CrossingEdge, ErrorKind, Scalar, Selection, World, reference};
use pliant_scenes::Scene;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

type Mesh<S> = (Vec<[u32; 3]>, Vec<[S; 3]>);

/// Triangles on a small lattice, which share vertices, lie in common planes and have no area.
fn heap(vertices: u32, triangles: u32, size: u32, random: &mut Lcg) -> Mesh<f64> {
    let triangles = (0..triangles).map(|_| [0, 1, 2].map(|_| random.below(vertices)));
    let triangles = triangles.collect();
    let positions = (0..vertices).map(|_| [0, 1, 2].map(|_| f64::from(random.below(size))));
    (triangles, positions.collect())
}

/// All crossing edges of bodies with each other and themselves, by the reference.
fn expected<S: Scalar>(bodies: &[Mesh<S>]) -> Vec<[u32; 4]> {
    let mut all = Vec::new();
    for (a, (edges_of, at)) in (0..).zip(bodies) {
        for (b, (triangles_of, there)) in (0..).zip(bodies) {
            let pairs = reference::crossing_edges(edges_of, at, triangles_of, there).unwrap();
            all.extend(pairs.iter().map(|&[edge, triangle]| [a, edge, b, triangle]));
        }
    }
    all.sort_unstable();
    all
}

fn rows(crossing: &[CrossingEdge]) -> Vec<[u32; 4]> {
    crossing.iter().map(|&it| it.into()).collect()
}

/// Compares every way to ask with the expected crossing edges.
fn check<S: Scalar>(world: &mut World<S>, expected: &[[u32; 4]]) {
    let of = Selection::Everything;
    assert_eq!(rows(world.crossing_edges(of).all().unwrap()), expected);
    let between = |row: &&[u32; 4]| [row[0], row[2]] == [0, 1] || [row[0], row[2]] == [1, 0];
    let of_two: Vec<_> = expected.iter().filter(between).copied().collect();
    let two = Selection::Between(BodyId(1), BodyId(0));
    assert_eq!(rows(world.crossing_edges(two).all().unwrap()), of_two);
    let itself = |row: &&[u32; 4]| [row[0], row[2]] == [1, 1];
    let of_one: Vec<_> = expected.iter().filter(itself).copied().collect();
    let one = Selection::Within(BodyId(1));
    assert_eq!(rows(world.crossing_edges(one).all().unwrap()), of_one);
    let first = world.crossing_edges(of).first().unwrap();
    assert_eq!(first.is_some(), !expected.is_empty());
    assert!(first.is_none_or(|first| expected.contains(&first.into())));
    let mut seen: Vec<[u32; 4]> = Vec::new();
    let visited = world.crossing_edges(of).visit(|it| {
        seen.push(it.into());
        ControlFlow::<()>::Continue(())
    });
    assert!(visited.unwrap().is_continue());
    assert_eq!(world.statistics().pairs, expected.len() as u64);
    seen.sort_unstable();
    assert_eq!(seen, expected);
    if let Some(fewer) = expected.len().checked_sub(1) {
        assert!(world.crossing_edges(of).at_most(fewer).all().is_err());
    }
}

#[test]
fn heaps_have_the_crossing_edges_of_the_reference() {
    let mut random = Lcg(7);
    let mut count = 0;
    let configurations = covering_configurations().into_iter().cycle();
    for (round, mut options) in (0..60).zip(configurations) {
        options.threads = NonZeroUsize::new([1, 3][round % 2]).unwrap();
        let size = [3, 5, 9, 40][round % 4];
        let bodies = [12, 20].map(|vertices| heap(vertices, 2 * vertices, size, &mut random));
        let truth = expected(&bodies);
        count += truth.len();
        let [a, b] = &bodies;
        let mut world = world_of(options, &[(&a.0[..], a.1.clone()), (&b.0[..], b.1.clone())]).0;
        check(&mut world, &truth);
        let narrow =
            bodies.map(|(t, p)| (t, p.iter().map(|p| p.map(|x| 0.1 * x as f32)).collect()));
        let [a, b]: &[Mesh<f32>; 2] = &narrow;
        let mut world = world_of(options, &[(&a.0[..], a.1.clone()), (&b.0[..], b.1.clone())]).0;
        check(&mut world, &expected(&narrow));
    }
    assert!(count > 5_000, "{count}");
}

#[test]
fn closed_surfaces_have_as_many_crossing_edges_as_crossing_triangles() {
    let scene = Scene::new("spheres", Some(1_280), Scene::DEFAULT_SEED).unwrap();
    let mut counts = Vec::new();
    for step in (40..240).step_by(20) {
        let mut world = World::<f32>::new();
        for body in 0..scene.body_count() {
            let mut shape = Vec::new();
            scene.positions(body, step, &mut shape);
            // Folds, as neighbours change places.
            let [a, b, _] = scene.triangles(body)[77].map(|vertex| vertex as usize);
            shape.swap(a, b);
            world.add(scene.triangles(body), &shape).unwrap();
        }
        let of = Selection::Everything;
        let pairs = world.intersections(of).all().unwrap().len();
        let adjacent = world.adjacent_intersections(of).all().unwrap();
        let crossing = adjacent.len();
        let edges = world.crossing_edges(of).all().unwrap().len();
        // A segment ends in two crossing edges, each of which is of two triangles. At a vertex that
        // both triangles share it ends in that.
        assert_eq!(2 * edges, 2 * pairs + crossing);
        counts.push([pairs, crossing, edges]);
    }
    assert!(counts.iter().any(|&[pairs, ..]| pairs > 100), "{counts:?}");
    assert!(
        counts.iter().any(|&[_, adjacent, _]| adjacent > 0),
        "{counts:?}"
    );
}

/// Triangles that share a vertex and a line. The list is refused, and a visit ends, before the
/// crossing edges of all pairs fill the memory.
#[test]
fn very_many_crossing_edges_at_one_vertex_are_refused() {
    const COUNT: u32 = 30_000;
    let mut positions = vec![[0.0; 3]];
    for i in 0..COUNT {
        let part = f64::from(i) / f64::from(COUNT);
        let (sine, cosine) = (std::f64::consts::PI * part).sin_cos();
        positions.extend([1.0, -1.0].map(|side| [1.0 + part, side * cosine, side * sine]));
    }
    let triangles = (0..COUNT).map(|i| [0, 1 + 2 * i, 2 + 2 * i]);
    let mut world = World::<f64>::new();
    let of = Selection::Within(
        world
            .add(&triangles.collect::<Vec<_>>(), &positions)
            .unwrap(),
    );
    let before = world.memory_usage();
    let refused = world.crossing_edges(of).at_most(1_000).all();
    assert_eq!(
        refused.unwrap_err().kind,
        ErrorKind::TooManyHits { limit: 1_000 }
    );
    let mut seen = 0;
    let stopped = world.crossing_edges(of).visit(|crossing| {
        seen += 1;
        assert!(crossing.edge >= 2 * COUNT, "an edge at the shared vertex");
        if seen < 100_000 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    assert!(stopped.unwrap().is_break());
    let kept = world.memory_usage() - before;
    assert!(kept < 40 << 20, "{kept}");
}
