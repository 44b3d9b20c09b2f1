//! Clearance: nothing touches while every vertex moves less, and moving more can be enough.

use crate::common::{Lcg, sheet};
use pliant::reference::{self, Moving};
use pliant::{BodyId, Selection, World};

type Points = Vec<[f64; 3]>;

/// Two rough sheets, one above the other and partly close, with the positions of their vertices.
fn sheets(random: &mut Lcg) -> (World<f64>, Vec<[u32; 3]>, Vec<(BodyId, Points)>) {
    let (triangles, _) = sheet(6);
    let mut world = World::new();
    let mut bodies = Vec::new();
    for height in [0.0, 0.25] {
        let points: Points = (0..36)
            .map(|at| {
                let rough = |random: &mut Lcg| 0.2 * f64::from(random.unit());
                let [x, y, z] = [(); 3].map(|()| rough(random));
                [f64::from(at % 6) + x, f64::from(at / 6) + y, height + z]
            })
            .collect();
        let body = world.add(&triangles, &points).unwrap();
        bodies.push((body, points));
    }
    (world, triangles, bodies)
}

/// Whether any two elements touch that have no vertex in common.
fn touches(triangles: &[[u32; 3]], bodies: &[(BodyId, Points)]) -> bool {
    let moving: Vec<Moving<f64>> = bodies
        .iter()
        .map(|(_, positions)| Moving::at(triangles, positions))
        .collect();
    let (a, b) = (&moving[0], &moving[1]);
    let lists = [
        reference::close_vertex_triangle_pairs(a, b, 0.0),
        reference::close_vertex_triangle_pairs(b, a, 0.0),
        reference::close_edge_edge_pairs(a, b, 0.0),
        reference::self_close_vertex_triangle_pairs(a, 0.0),
        reference::self_close_vertex_triangle_pairs(b, 0.0),
        reference::self_close_edge_edge_pairs(a, 0.0),
        reference::self_close_edge_edge_pairs(b, 0.0),
    ];
    lists.into_iter().any(|list| !list.unwrap().is_empty())
}

#[test]
fn nothing_touches_below_it_and_something_can_above() {
    let random = &mut Lcg(7);
    let mut worlds = 0;
    while worlds < 12 {
        let (mut world, triangles, bodies) = sheets(random);
        if touches(&triangles, &bodies) {
            continue;
        }
        worlds += 1;
        let cut_off = [0.3, 3.0][worlds % 2];
        let clearance = world.clearance(Selection::Everything, cut_off).unwrap();
        assert_eq!(clearance.len(), 2);

        // What a body's rest shape says is close may touch as well.
        let (body, points) = &bodies[0];
        world.set_rest_positions(*body, Some(points)).unwrap();
        let again = world.clearance(Selection::Everything, cut_off).unwrap();
        assert_eq!(again, clearance);
        world.set_rest_positions(*body, None).unwrap();

        // Against the definition: half of the least distance in the lists of close pairs.
        let every = Selection::Everything;
        let close = world.close_vertex_triangle_pairs(every, cut_off);
        let close = close.all().unwrap().to_vec();
        let edges = world.edges(bodies[0].0).unwrap().to_vec();
        let mut corners: Vec<(f64, BodyId, u32)> = Vec::new();
        for hit in &close {
            let (d, pair) = (hit.distance, hit.pair);
            corners.push((d, pair.vertex_body, pair.vertex));
            let of_triangle = triangles[pair.triangle as usize];
            corners.extend(of_triangle.map(|vertex| (d, pair.triangle_body, vertex)));
        }
        for hit in world.close_edge_edge_pairs(every, cut_off).all().unwrap() {
            for (body, edge) in [
                (hit.pair.body_a, hit.pair.edge_a),
                (hit.pair.body_b, hit.pair.edge_b),
            ] {
                corners.extend(edges[edge as usize].map(|vertex| (hit.distance, body, vertex)));
            }
        }
        for (body, points) in &bodies {
            for vertex in 0..points.len() as u32 {
                let own = corners.iter().filter(|it| (it.1, it.2) == (*body, vertex));
                let least = own.map(|it| it.0).fold(cut_off, f64::min) / 2.0;
                let found = clearance[body][vertex as usize];
                assert!(
                    found <= least && found >= least * (1.0 - 1e-6),
                    "{found} {least}"
                );
            }
        }

        for _ in 0..10 {
            let moved: Vec<(BodyId, Points)> = bodies
                .iter()
                .map(|(body, points)| {
                    let limits = &clearance[body];
                    let step = |(at, limit): (&[f64; 3], &f64)| {
                        let way = [(); 3].map(|()| f64::from(random.unit()) - 0.5);
                        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
                        let far = 0.999_999 * limit / length;
                        std::array::from_fn(|axis| at[axis] + far * way[axis])
                    };
                    (*body, points.iter().zip(limits).map(step).collect())
                })
                .collect();
            assert!(!touches(&triangles, &moved));
        }

        // The vertex of the closest pair goes twice as far, towards its triangle, and is there.
        let closest = close
            .iter()
            .min_by(|a, b| a.distance.total_cmp(&b.distance));
        let closest = closest.expect("the sheets are close");
        let mut bodies = bodies;
        let direction = closest.direction.expect("nothing touches");
        let of_vertex = bodies
            .iter_mut()
            .find(|body| body.0 == closest.pair.vertex_body);
        let (body, points) = of_vertex.unwrap();
        let vertex = closest.pair.vertex as usize;
        let limit = clearance[body][vertex];
        for axis in 0..3 {
            points[vertex][axis] -= 2.0 * limit * direction[axis];
        }
        world.set_positions(*body, points).unwrap();
        let near = world.close_vertex_triangle_pairs(every, 2e-6 * closest.distance);
        let is_there = near
            .all()
            .unwrap()
            .iter()
            .any(|hit| hit.pair == closest.pair);
        // It is not there if an edge of the vertex was closer to something.
        let is_bound_by_it = limit > closest.distance / 2.0 * (1.0 - 1e-6);
        assert_eq!(is_there, is_bound_by_it);
        let again = world.clearance(every, cut_off).unwrap();
        assert!(again[&closest.pair.vertex_body][vertex] <= 1e-6 * closest.distance || !is_there);
    }
}

/// Thickness is taken off distances: nothing comes nearer than it is thick.
#[test]
fn clearance_is_what_is_left_of_thickness() {
    let (mut world, triangles, bodies) = sheets(&mut Lcg(11));
    let [(a, _), (b, _)] = [&bodies[0], &bodies[1]];
    let of = Selection::Between(*a, *b);
    let thick = [0.0625, 0.03125];
    let plain = world.clearance(of, 2.0).unwrap();
    world.set_thickness(*a, thick[0]).unwrap();
    world.set_thickness(*b, thick[1]).unwrap();
    let found = world.clearance(of, 2.0).unwrap();
    let mut left = [0; 2];
    for body in [a, b] {
        for (found, plain) in found[body].iter().zip(&plain[body]) {
            let expected = (plain - f64::midpoint(thick[0], thick[1])).max(0.0);
            assert!(
                (found - expected).abs() <= 1e-6 * plain,
                "{found} {expected}"
            );
            left[usize::from(*found > 0.0)] += 1;
        }
    }
    assert!(left.iter().all(|&count| count > 5), "{left:?}");

    // One thick vertex makes its own elements thick, and no others.
    let mut of_vertices = vec![0.0; 36];
    of_vertices[14] = 0.0625;
    world.set_thickness(*a, 0.0).unwrap();
    world.set_vertex_thickness(*b, &of_vertices).unwrap();
    let found = world.clearance(of, 2.0).unwrap();
    for (vertex, (found, plain)) in (0..).zip(found[b].iter().zip(&plain[b])) {
        let is_beside = triangles
            .iter()
            .any(|it| it.contains(&14) && it.contains(&vertex));
        assert!(found <= plain && (is_beside || found == plain), "{vertex}");
    }
    assert!(found[b][14] < plain[b][14]);
}

#[test]
fn what_is_refused_is_what_queries_refuse() {
    let (mut world, _, bodies) = sheets(&mut Lcg(1));
    let [a, b] = [bodies[0].0, bodies[1].0];
    for cut_off in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(world.clearance(Selection::World, cut_off).is_err());
    }
    assert!(world.clearance(Selection::Between(a, a), 1.0).is_err());
    world.remove(b).unwrap();
    assert!(world.clearance(Selection::Between(a, b), 1.0).is_err());
    let zero = world.clearance(Selection::Within(a), 0.0).unwrap();
    assert!(zero[&a].iter().all(|&x| x == 0.0));
}
