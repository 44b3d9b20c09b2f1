//! Fans of very many triangles round one vertex: elements near each other are found, in work that
//! is linear.

use crate::common::{Lcg, covering_configurations};
use pliant::reference::{self, Moving};
use pliant::{EdgeEdge, Impact, Scalar, Selection, VertexTriangle, World};

/// Two fans whose middles are one edge, and a third that shares vertices of a rim. A mesh with it
/// has three vertices with very many triangles.
fn mesh(count: u32) -> Vec<[u32; 3]> {
    let rim = |at: u32| 3 + at % count;
    let around = |middle: u32| (0..count).map(move |at| [middle, rim(at), rim(at + 1)]);
    let on_edge = (0..count).map(|at| [0, 1, rim(at)]);
    let third = (0..count / 2).map(|at| [rim(2 * at), 2, rim(2 * at + 1)]);
    around(0).chain(on_edge).chain(third).collect()
}

/// Middles near each other, and rims that go round them at random distances.
fn shape<S: Scalar>(random: &mut Lcg, count: u32, of: fn(f32) -> S) -> Vec<[S; 3]> {
    let mut near =
        |[x, y, z]: [f32; 3], size: f32| [x, y, z].map(|x| of(x + size * (random.unit() - 0.5)));
    let middles = [[0.0, 0.0, 0.4], [0.1, 0.0, 0.9], [0.0, 0.2, -0.7]].map(|at| near(at, 0.1));
    let rim = (0..count).map(|at| {
        let (sin, cos) = (at as f32 * std::f32::consts::TAU / count as f32).sin_cos();
        near([cos, sin, 0.3 * (5.0 * sin).sin()], 0.4)
    });
    middles.into_iter().chain(rim).collect()
}

/// Numbers of two elements.
type Pairs = Vec<[u32; 2]>;

/// Lists by the reference at a radius: candidates, close pairs within twice that, impacts; of
/// vertices and triangles, and of edges.
fn expected<S: Scalar>(known: &Moving<S>, radius: f64) -> [[Pairs; 2]; 3] {
    let timed = |list: Vec<([u32; 2], [f64; 2])>| list.into_iter().map(|it| it.0).collect();
    let lists = [
        [
            reference::self_vertex_triangle_pairs(known, radius).unwrap(),
            reference::self_edge_edge_pairs(known, radius).unwrap(),
        ],
        [
            reference::self_close_vertex_triangle_pairs(known, 2.0 * radius).unwrap(),
            reference::self_close_edge_edge_pairs(known, 2.0 * radius).unwrap(),
        ],
        [
            timed(reference::self_vertex_triangle_impacts(known, 1.0).unwrap()),
            timed(reference::self_edge_edge_impacts(known, 1.0).unwrap()),
        ],
    ];
    let are_many = |which: usize| lists[which].iter().all(|list| list.len() > 40);
    assert!(are_many(0) && (radius == 0.0 || are_many(1)));
    assert!(known.end.is_none() || are_many(2));
    lists
}

/// Lists as `expected` has them, by a world.
fn found<S: Scalar>(world: &mut World<S>, of: Selection, radius: f64) -> [[Pairs; 2]; 3] {
    let of_vertices = |pair: VertexTriangle| [pair.vertex, pair.triangle];
    let of_edges = |pair: EdgeEdge| [pair.edge_a, pair.edge_b];
    macro_rules! list {
        ($query:expr, $hit:ident => $pair:expr) => {
            $query.all().unwrap().iter().map(|$hit| $pair).collect()
        };
    }
    let distance = 2.0 * radius;
    [
        [
            list!(world.vertex_triangle_candidates(of, radius), hit => of_vertices(*hit)),
            list!(world.edge_edge_candidates(of, radius), hit => of_edges(*hit)),
        ],
        [
            list!(world.close_vertex_triangle_pairs(of, distance), hit => of_vertices(hit.pair)),
            list!(world.close_edge_edge_pairs(of, distance), hit => of_edges(hit.pair)),
        ],
        [
            list!(world.vertex_triangle_impacts(of), hit => of_vertices(hit.pair)),
            list!(world.edge_edge_impacts(of), hit => of_edges(hit.pair)),
        ],
    ]
}

fn check<S: Scalar>(of: fn(f32) -> S) {
    const COUNT: u32 = 132;
    const RADII: [f64; 2] = [0.0, 0.01];
    let random = &mut Lcg(9);
    let triangles = mesh(COUNT);
    let shapes: Vec<Vec<[S; 3]>> = (0..3).map(|_| shape(random, COUNT, of)).collect();
    // The first shape stands still, the others move on to the next.
    let end = |step: usize| (step > 0).then(|| &shapes[(step + 1) % 3][..]);
    let known = (0..3).map(|step| Moving {
        end: end(step),
        ..Moving::at(&triangles, &shapes[step])
    });
    let known = known.map(|known| RADII.map(|radius| expected(&known, radius)));
    let known: Vec<_> = known.collect();
    // The middle of a fan torn in two, and vertices of rims merged.
    let half: Vec<u32> = (0..COUNT / 2).collect();
    let mut edited: Option<[[Pairs; 2]; 3]> = None;
    for options in covering_configurations() {
        let mut world = World::<S>::with_options(options);
        let body = world.add(&triangles, &shapes[0]).unwrap();
        for step in 0..3 {
            world.set_positions(body, &shapes[step]).unwrap();
            if let Some(end) = end(step) {
                world.set_motion(body, end).unwrap();
            }
            for (radius, known) in RADII.into_iter().zip(&known[step]) {
                let found = found(&mut world, Selection::Within(body), radius);
                assert!(found == *known, "step {step}, {radius}, {options:?}");
                world.validate().unwrap();
            }
        }
        let mut edit = world.edit(body).unwrap();
        edit.split_vertex(0, &half);
        edit.merge_vertices(10, 50);
        world.apply(&edit).unwrap();
        let moved = |shape: &Vec<[S; 3]>| [&shape[..], &shape[1..2]].concat();
        let [positions, end] = [1, 2].map(|step: usize| moved(&shapes[step]));
        world.set_positions(body, &positions).unwrap();
        world.set_motion(body, &end).unwrap();
        let found = found(&mut world, Selection::Within(body), RADII[1]);
        let known = edited.get_or_insert_with(|| {
            let known = Moving {
                end: Some(&end),
                ..Moving::at(world.triangles(body).unwrap(), &positions)
            };
            expected(&known, RADII[1])
        });
        // Edges keep their numbers in an edit.
        for ([found, of_edges], [known, of_known_edges]) in found.iter().zip(known) {
            assert!(
                found == known && of_edges.len() == of_known_edges.len(),
                "{options:?}"
            );
        }
        world.validate().unwrap();
    }
}

#[test]
fn elements_of_fans_are_found_f32() {
    check::<f32>(|x| x);
}

#[test]
fn elements_of_fans_are_found_f64() {
    check::<f64>(f64::from);
}

/// Work is linear: the triangles of a lid, and a mesh that lies in one point.
#[test]
fn triangles_round_one_vertex_cost_no_more_than_others() {
    const COUNT: u32 = 40_000;
    let rim = |at: u32| {
        let angle = f64::from(at) * std::f64::consts::TAU / f64::from(COUNT);
        let (sin, cos) = angle.sin_cos();
        [cos, sin, 0.1 * (7.0 * angle).sin()].map(|x| x as f32)
    };
    let lid: Vec<[u32; 3]> = (0..COUNT)
        .map(|at| [0, 1 + at, 1 + (at + 1) % COUNT])
        .collect();
    let mut corners = vec![[0.0, 0.0, 1.0]];
    corners.extend((0..COUNT).map(rim));
    let point = vec![[0_u32; 3]; COUNT as usize];
    for (triangles, positions) in [(&lid, &corners[..]), (&point, &corners[..1])] {
        let mut world = World::<f32>::new();
        let body = world.add(triangles, positions).unwrap();
        let of = Selection::Within(body);
        // Quadratic work would be 12 million pairs of leaves.
        let check = |world: &World<f32>, found: usize| {
            let work = *world.statistics();
            assert!(
                work.node_pairs < 4 * u64::from(COUNT) && found < 10,
                "{found}, {work:?}"
            );
        };
        let found = world.intersections(of).all().unwrap().len();
        check(&world, found);
        let found = world
            .vertex_triangle_candidates(of, 0.0)
            .all()
            .unwrap()
            .len();
        check(&world, found);
        let found = world.edge_edge_candidates(of, 0.0).all().unwrap().len();
        check(&world, found);
        let found = world
            .close_vertex_triangle_pairs(of, 1e-7)
            .all()
            .unwrap()
            .len();
        check(&world, found);
        let found = world.close_edge_edge_pairs(of, 1e-7).all().unwrap().len();
        check(&world, found);
        world.set_motion(body, positions).unwrap();
        assert!(world.first_impact(of, 0.0).unwrap().is_none());
        check(&world, 0);
    }
}

/// Where everything meets at the start, the first is found by order, without times of the rest.
#[test]
fn what_meets_at_the_start_is_told_by_order() {
    let side = 40;
    let (triangles, flat) = crate::common::sheet(side);
    let moved: Vec<_> = flat
        .iter()
        .map(|[x, y, z]| [x + 0.01, y + 0.007, *z])
        .collect();
    let up: Vec<_> = moved.iter().map(|[x, y, z]| [*x, *y, z + 1.0]).collect();
    for threads in [1, 3] {
        let mut options = pliant::Options::default();
        options.threads = std::num::NonZeroUsize::new(threads).unwrap();
        let mut world = World::<f32>::with_options(options);
        let a = world.add(&triangles, &flat).unwrap();
        let b = world.add(&triangles, &moved).unwrap();
        world.set_motion(b, &up).unwrap();
        let of = Selection::Between(a, b);
        let first = world.first_impact(of, 0.0).unwrap().unwrap();
        let decided = world.statistics().scalar_decisions;
        let all = world.vertex_triangle_impacts(of).all().unwrap();
        let expected = all.iter().find(|it| it.high == 0.0).copied();
        assert_eq!(Some(first), expected.map(Impact::from));
        assert!(
            threads > 1 || 10 * decided < all.len() as u64,
            "{decided} of {}",
            all.len()
        );
    }
}
