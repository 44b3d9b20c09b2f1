//! Boxes of a level are tight around the triangles below, and say whether they are valid.

use pliant::{BodyId, Degree, Options, Partition, Selection, Update, World};
use std::num::NonZeroU32;

/// A zigzag strip, `up` above the plane.
fn strip(up: f32) -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
    let triangles = (0..300).map(|i| [i, i + 1, i + 2]).collect();
    let positions = (0..302)
        .map(|i| [i as f32, (i % 2) as f32, up + (i * 7 % 5) as f32])
        .collect();
    (triangles, positions)
}

/// Number of different nodes in all levels, and of those that are made.
///
/// A leaf is in every level below it with the same triangles, so the same run is counted once.
fn nodes_and_made(world: &World<f32>, body: BodyId) -> [usize; 2] {
    let mut seen = std::collections::BTreeMap::new();
    for level in 0..=world.tree_shape(body).unwrap().depth {
        let parts = world.tree_cut(body, level).unwrap();
        let boxes = world.tree_boxes(body, level).unwrap();
        for (part, node) in boxes.iter().enumerate() {
            let below: Vec<usize> = (0..parts.len())
                .filter(|&triangle| parts[triangle] == part as u32)
                .collect();
            seen.insert(below, node.valid);
        }
    }
    [seen.len(), seen.values().filter(|&&made| made).count()]
}

#[test]
fn corners_are_those_of_the_triangles_of_the_part() {
    let (triangles, positions) = strip(0.0);
    for degree in [Degree::Two, Degree::Four, Degree::Eight] {
        for partition in [Partition::Centre, Partition::Balanced] {
            let mut options = Options::default();
            (options.degree, options.partition) = (degree, partition);
            let mut world = World::<f32>::with_options(options);
            let body = world.add(&triangles, &positions).unwrap();
            let moved: Vec<_> = positions.iter().map(|&[x, y, z]| [z, x, y - z]).collect();
            world.set_positions(body, &moved).unwrap();
            assert_eq!(world.positions(body).unwrap(), moved);
            assert_eq!(world.triangles(body).unwrap(), triangles);
            for level in 0..=world.tree_shape(body).unwrap().depth + 1 {
                let parts = world.tree_cut(body, level).unwrap();
                let boxes = world.tree_boxes(body, level).unwrap();
                assert_eq!(boxes.len(), *parts.iter().max().unwrap() as usize + 1);
                for (part, node) in boxes.iter().enumerate() {
                    let corners = || {
                        (0..parts.len())
                            .filter(|&triangle| parts[triangle] == part as u32)
                            .flat_map(|triangle| triangles[triangle])
                            .map(|vertex| moved[vertex as usize])
                    };
                    for axis in 0..3 {
                        let along = || corners().map(|position| position[axis]);
                        assert_eq!(node.lower[axis], along().fold(f32::MAX, f32::min));
                        assert_eq!(node.upper[axis], along().fold(f32::MIN, f32::max));
                    }
                }
            }
        }
    }
}

#[test]
fn made_are_the_boxes_that_the_statistics_count() {
    let (triangles, flat) = strip(0.0);
    let thorn = [[151.1, 0.1, -9.0], [151.1, 0.1, 9.0], [151.2, 0.1, 9.0]];
    for update in [
        Update::BottomUp,
        Update::TopDown,
        Update::HYBRID,
        Update::Hybrid {
            level: Some(1),
            levels_at_once: NonZeroU32::new(2).unwrap(),
        },
    ] {
        let mut options = Options::paper();
        (options.degree, options.update) = (Degree::Two, update);
        let mut world = World::<f32>::with_options(options);
        let body = world.add(&triangles, &flat).unwrap();
        let needle = world.add(&[[0, 1, 2]], &thorn).unwrap();
        let nodes = world.tree_shape(body).unwrap().nodes;
        assert_eq!(nodes_and_made(&world, body), [nodes, 0]);
        for step in 1..4 {
            // Both move; a box that was made for the shape before is not made for this one.
            world
                .set_positions(body, &strip(0.01 * step as f32).1)
                .unwrap();
            assert_eq!(nodes_and_made(&world, body), [nodes, 0]);
            world.set_positions(needle, &thorn).unwrap();
            assert!(
                !world
                    .intersections(Selection::World)
                    .all()
                    .unwrap()
                    .is_empty()
            );
            let statistics = *world.statistics();
            let made = [body, needle].map(|body| nodes_and_made(&world, body)[1] as u64);
            assert_eq!(
                made.iter().sum::<u64>(),
                statistics.boxes_bottom_up + statistics.boxes_top_down,
                "{update:?}"
            );
            if update != Update::BottomUp {
                assert!(made[0] < nodes as u64);
            }
        }
    }
}

#[test]
fn a_body_that_is_not_there_is_refused() {
    let mut world = World::<f32>::new();
    let (triangles, positions) = strip(0.0);
    let body = world.add(&triangles, &positions).unwrap();
    world.remove(body).unwrap();
    let refused = world.tree_boxes(body, 0).unwrap_err();
    assert_eq!(refused.body, Some(body));
    assert_eq!(world.positions(body), Err(refused.clone()));
    assert_eq!(world.triangles(body), Err(refused));
}
