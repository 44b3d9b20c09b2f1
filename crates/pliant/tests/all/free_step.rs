//! Free steps report how they begin: the first contact at the start, and whether anything moves.

use crate::common::{Lcg, every_configuration, sheet};
use pliant::{
    BodyId, EdgeEdge, ErrorKind, InContact, Options, Pair, Selection, VertexTriangle, World,
};
use std::sync::atomic::{AtomicU32, Ordering};

const FLOOR: [[f64; 3]; 3] = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];

/// A floor that stands still, and a triangle.
fn floor_and(triangle: [[f64; 3]; 3]) -> (World<f64>, [BodyId; 2]) {
    let mut world = World::new();
    let bodies = [FLOOR, triangle].map(|it| world.add(&[[0, 1, 2]], &it).unwrap());
    (world, bodies)
}

fn raised(triangle: [[f64; 3]; 3], by: f64) -> [[f64; 3]; 3] {
    triangle.map(|[x, y, z]| [x, y, z + by])
}

#[test]
fn a_step_of_bodies_without_a_motion_says_that_nothing_moves() {
    let leaf = [[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]];
    let (mut world, [floor, body]) = floor_and(leaf);
    let of_all = [
        Selection::World,
        Selection::Everything,
        Selection::Between(floor, body),
        Selection::Within(body),
    ];
    for of in of_all {
        let step = world.free_step(of, 0.5).unwrap();
        assert_eq!(
            (step.t, step.moves, step.begins_in_contact),
            (1.0, false, None)
        );
    }
    world.set_motion(body, &raised(leaf, 1.0)).unwrap();
    for of in of_all {
        assert!(world.free_step(of, 0.0).unwrap().moves);
    }
    // The motion of another body does not count.
    assert!(
        !world
            .free_step(Selection::Within(floor), 0.0)
            .unwrap()
            .moves
    );
    // A motion to the same shape is a motion; a new shape ends it.
    world.set_motion(body, &leaf).unwrap();
    assert!(world.free_step(Selection::World, 0.0).unwrap().moves);
    world.set_positions(body, &leaf).unwrap();
    assert!(!world.free_step(Selection::World, 0.0).unwrap().moves);
    assert!(
        !World::<f32>::new()
            .free_step(Selection::Everything, 0.0)
            .unwrap()
            .moves
    );
}

#[test]
fn a_step_that_begins_in_contact_names_the_first_pair() {
    let vertex = |pair: [BodyId; 2]| {
        InContact::VertexTriangle(VertexTriangle {
            vertex_body: pair[0],
            vertex: 0,
            triangle_body: pair[1],
            triangle: 0,
        })
    };
    // It is through the floor, with no vertex near it and no edges near each other. Each way out is
    // a contact.
    let through = [[0.0, 0.0, -1.0], [1.0, 0.0, 2.0], [-1.0, 0.0, 2.0]];
    let (mut world, bodies) = floor_and(through);
    let of = Selection::Everything;
    assert_eq!(world.free_step(of, 0.0).unwrap().t, 1.0);
    world.set_motion(bodies[1], &raised(through, 4.0)).unwrap();
    let step = world.free_step(of, 0.0).unwrap();
    let triangles = InContact::Triangles(Pair {
        body_a: bodies[0],
        triangle_a: 0,
        body_b: bodies[1],
        triangle_b: 0,
    });
    assert!(step.t > 0.2 && step.t < 0.25, "{step:?}");
    assert_eq!(step.begins_in_contact, Some(triangles));
    assert_eq!(Ok(step.t), world.collision_free_step(of, 0.0));

    // It touches the floor and may go through, which the step does not look at.
    let touching = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let (mut world, bodies) = floor_and(touching);
    world
        .set_motion(bodies[1], &raised(touching, -0.5))
        .unwrap();
    let step = world.free_step(of, 0.0).unwrap();
    assert_eq!((step.t, step.begins_in_contact), (1.0, Some(triangles)));

    // Triangles that share a vertex are in no list of intersections; a vertex of the one touches
    // the other.
    let mut world = World::<f64>::new();
    let folded = [&FLOOR[..], &[[0.0, 0.0, 0.0], [0.0, 1.0, 1.0]]].concat();
    let body = world.add(&[[0, 1, 2], [0, 3, 4]], &folded).unwrap();
    let begins = world.free_step(of, 0.0).unwrap().begins_in_contact;
    let expected = VertexTriangle {
        vertex_body: body,
        vertex: 3,
        triangle_body: body,
        triangle: 0,
    };
    assert_eq!(begins, Some(InContact::VertexTriangle(expected)));

    // Nearer than the distance, and exactly at the distance, which counts as near.
    let near = raised(touching, 0.25);
    let (mut world, [floor, leaf]) = floor_and(near);
    world.set_motion(leaf, &raised(near, 1.0)).unwrap();
    let mut begins = |distance| world.free_step(of, distance).unwrap().begins_in_contact;
    assert_eq!(begins(0.25), Some(vertex([leaf, floor])));
    assert_eq!(begins(0.25_f64.next_down()), None);

    // A contact of edges alone.
    let mut world = World::<f64>::new();
    let blade = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -5.0]];
    let other = [[0.0, -1.0, 0.1], [0.0, 1.0, 0.1], [0.0, 0.0, 5.0]];
    let [a, b] = [blade, other].map(|it| world.add(&[[0, 1, 2]], &it).unwrap());
    let edges = InContact::EdgeEdge(EdgeEdge {
        body_a: a,
        edge_a: 0,
        body_b: b,
        edge_b: 0,
    });
    assert_eq!(
        world.free_step(of, 0.1).unwrap().begins_in_contact,
        Some(edges)
    );
    assert_eq!(world.free_step(of, 0.09).unwrap().begins_in_contact, None);
}

#[test]
fn what_is_glued_together_or_kept_apart_begins_in_no_contact() {
    let through = [[0.0, 0.0, -1.0], [1.0, 0.0, 2.0], [-1.0, 0.0, 2.0]];
    let (mut world, [floor, leaf]) = floor_and(through);
    let of = Selection::World;
    world.set_vertex_groups(floor, &[3; 3]).unwrap();
    for (groups, is_glued) in [
        ([3; 3], true),
        ([3, 3, 4], false),
        ([4; 3], false),
        ([0; 3], false),
    ] {
        world.set_vertex_groups(leaf, &groups).unwrap();
        let begins = world.free_step(of, 0.0).unwrap().begins_in_contact;
        assert_eq!(begins.is_none(), is_glued, "{groups:?}");
    }
    world.ignore(floor, leaf).unwrap();
    assert_eq!(world.free_step(of, 0.0).unwrap().begins_in_contact, None);
    let named = world
        .free_step(Selection::Between(floor, leaf), 0.0)
        .unwrap();
    assert!(named.begins_in_contact.is_some());
}

/// The first contact in the lists that anybody can ask for.
fn first_of_lists(world: &mut World<f32>, of: Selection, distance: f64) -> Option<InContact> {
    if let Some(&pair) = world.intersections(of).all().unwrap().first() {
        return Some(InContact::Triangles(pair));
    }
    let close = world.close_vertex_triangle_pairs(of, distance);
    if let Some(close) = close.all().unwrap().first() {
        return Some(InContact::VertexTriangle(close.pair));
    }
    let close = world.close_edge_edge_pairs(of, distance).all().unwrap();
    close.first().map(|close| InContact::EdgeEdge(close.pair))
}

/// The first pair is that of the lists for every option.
///
/// Sheets touch, go through each other and through themselves.
#[test]
fn the_first_pair_is_that_of_the_lists_for_every_option() {
    let (triangles, flat) = sheet(5);
    let mut random = Lcg(47);
    let mut begun = [0; 4];
    let configurations = every_configuration();
    for round in 0..60 {
        let options: Vec<Options> = (0..3)
            .map(|_| configurations[random.below(configurations.len() as u32) as usize])
            .collect();
        let noise = [0.0, 0.05, 0.4][round % 3];
        let mut shape = |z: f32| -> Vec<[f32; 3]> {
            let mut push = || noise * (random.unit() - 0.5);
            flat.iter()
                .map(|&[x, y, _]| [x + push(), y + push(), z + push()])
                .collect()
        };
        let height = [0.0, 0.02, 0.3, 1.0][round % 4];
        let (starts, ends) = ([shape(0.0), shape(height)], [shape(0.1), shape(0.2)]);
        let distance = [0.0, 0.01, 0.1][round / 3 % 3];
        let mut answers = Vec::new();
        for options in options {
            let mut world = World::with_options(options);
            for (start, end) in starts.iter().zip(&ends) {
                let body = world.add(&triangles, start).unwrap();
                world.set_motion(body, end).unwrap();
            }
            let [a, b] = [BodyId(0), BodyId(1)];
            for of in [
                Selection::World,
                Selection::Everything,
                Selection::Between(b, a),
                Selection::Within(a),
            ] {
                let step = world.free_step(of, distance).unwrap();
                assert_eq!(
                    step.begins_in_contact,
                    first_of_lists(&mut world, of, distance)
                );
                assert_eq!(Ok(step.t), world.collision_free_step(of, distance));
                begun[match step.begins_in_contact {
                    None => 0,
                    Some(InContact::VertexTriangle(_)) => 1,
                    Some(InContact::EdgeEdge(_)) => 2,
                    Some(InContact::Triangles(_)) => 3,
                }] += 1;
                answers.push((of, step));
            }
        }
        for (of, step) in &answers[4..] {
            let (_, first) = answers.iter().find(|(it, _)| it == of).unwrap();
            assert_eq!(first, step);
        }
    }
    assert!(begun.iter().all(|&count| count > 2), "{begun:?}");
}

#[test]
fn what_is_refused_and_what_is_interrupted() {
    let leaf = [[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]];
    let (mut world, [floor, body]) = floor_and(leaf);
    world.set_motion(body, &raised(leaf, -4.0)).unwrap();
    for distance in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = world.free_step(Selection::World, distance).unwrap_err();
        assert!(matches!(refused.kind, ErrorKind::BadDistance { .. }));
    }
    for (of, kind) in [
        (Selection::Between(floor, BodyId(7)), ErrorKind::NoSuchBody),
        (Selection::Within(BodyId(7)), ErrorKind::NoSuchBody),
        (Selection::Between(floor, floor), ErrorKind::SameBody),
    ] {
        assert_eq!(world.free_step(of, 0.0).unwrap_err().kind, kind);
    }
    // Interrupted at any look, it leaves the world as if nothing had been asked.
    let expected = world.free_step(Selection::World, 0.1);
    let mut looks = 0;
    loop {
        let left = AtomicU32::new(looks);
        let is_late = || left.fetch_sub(1, Ordering::Relaxed) == 0;
        let answer = world
            .interruptible(&is_late)
            .free_step(Selection::World, 0.1);
        if answer == expected {
            break;
        }
        assert_eq!(answer.unwrap_err().kind, ErrorKind::Interrupted);
        assert_eq!(world.free_step(Selection::World, 0.1), expected);
        looks += 1;
    }
    assert!(looks > 3, "{looks}");
}

/// A step keeps the distance and the thickness of both, as if all of it were the distance.
#[test]
fn steps_keep_thickness_as_a_distance() {
    let random = &mut Lcg(23);
    let mut kept = [0; 2];
    for round in 0..40 {
        let (triangles, flat) = sheet(4);
        let rough = |random: &mut Lcg, height: f64| -> Vec<[f64; 3]> {
            let place = |[x, y, _]: &[f32; 3], z: f64| [f64::from(*x), f64::from(*y), height + z];
            let all = flat.iter();
            all.map(|at| place(at, 0.1 * f64::from(random.unit())))
                .collect()
        };
        let heights = [0.0, 0.5, 1.0];
        let shapes = heights.map(|height| rough(random, height));
        let ends = heights.map(|height| rough(random, 0.5 + (height - 0.5) * 0.2));
        let mut world = World::<f64>::new();
        let bodies = [0, 1, 2].map(|body| world.add(&triangles, &shapes[body]).unwrap());
        for (body, end) in bodies.iter().zip(&ends) {
            world.set_motion(*body, end).unwrap();
        }
        let [a, b, c] = bodies;
        let distance = [0.0, 0.0625][round % 2];
        let thick = [0.03125, 0.125, 0.0];
        let mut plain = world.clone();
        for (body, thick) in bodies.into_iter().zip(thick) {
            world.set_thickness(body, thick).unwrap();
        }
        for (of, both) in [
            (Selection::Between(a, b), thick[0] + thick[1]),
            (Selection::Between(b, c), thick[1]),
            (Selection::Between(a, c), thick[0]),
        ] {
            let step = world.free_step(of, distance).unwrap();
            assert_eq!(
                step,
                plain.free_step(of, distance + both).unwrap(),
                "{of:?}"
            );
            kept[usize::from(step.t < 1.0)] += 1;
        }
        // Elements without distance and thickness are kept from contact, beside others.
        world.set_thickness(a, 0.0).unwrap();
        let of_two = [(a, b), (b, c), (a, c)].map(|(a, b)| {
            let of = Selection::Between(a, b);
            world.collision_free_step(of, distance).unwrap()
        });
        let least = of_two.into_iter().fold(1.0, f64::min);
        let all = world
            .collision_free_step(Selection::World, distance)
            .unwrap();
        assert!((all - least).abs() <= 1e-9, "{of_two:?} {all}");
    }
    assert!(kept[1] > 50, "{kept:?}");
}
