//! Counted work, not time: how many boxes each update makes, which is the paper's point.

use crate::common::TrianglesOf;
use pliant::{Degree, Options, Partition, Scalar, Selection, Statistics, Update, World};
use pliant_scenes::{Scene, thin};
use std::num::NonZeroU32;

/// Work of the first 50 steps of the two spheres, and the number of boxes in one complete update.
///
/// As in the paper's implementation, both bodies are updated in every step, whether or not their
/// boxes overlap.
fn first_50_steps(options: Options) -> (Statistics, u64) {
    let scene = Scene::new("spheres", None, Scene::DEFAULT_SEED).unwrap();
    let mut positions = Vec::new();
    let mut world = World::<f32>::with_options(options);
    let bodies = [0, 1].map(|body| {
        scene.positions(body, 1, &mut positions);
        world.add(scene.triangles(body), &positions).unwrap()
    });
    // A body is updated if its box overlaps another's. The needle has a box round everything: one
    // triangle that does not move.
    let needle = [[-9.0; 3], [9.0; 3], [9.0; 3]];
    let needle = world.add(&[[0, 1, 2]], &needle).unwrap();
    world.intersections(Selection::World).prepare().unwrap();
    // Boxes made so far are counted here, and not in the steps.
    world
        .intersections(Selection::Within(needle))
        .all()
        .unwrap();
    let mut work = Statistics::default();
    for step in 1..=50 {
        for (body, &id) in bodies.iter().enumerate() {
            scene.positions(body, step, &mut positions);
            world.set_positions(id, &positions).unwrap();
        }
        world.intersections(Selection::World).prepare().unwrap();
        assert!(
            world
                .triangles_of(Selection::Between(bodies[0], bodies[1]))
                .is_empty()
        );
        work += *world.statistics();
    }
    (
        work,
        bodies
            .iter()
            .map(|&body| world.tree_shape(body).unwrap().nodes as u64)
            .sum(),
    )
}

#[test]
fn in_easy_steps_the_hybrid_makes_a_small_part_of_the_boxes() {
    for mut options in [Options::paper(), Options::default()] {
        let mut boxes = |update| {
            options.update = update;
            let (work, complete) = first_50_steps(options);
            (work.boxes_bottom_up + work.boxes_top_down, complete)
        };
        let (bottom_up, complete) = boxes(Update::BottomUp);
        let (hybrid, _) = boxes(Update::HYBRID);
        let (top_down, _) = boxes(Update::TopDown);
        eprintln!(
            "{:?}: of {complete} boxes, 50 steps: \
             bottom-up {bottom_up}, hybrid {hybrid}, top-down {top_down}",
            options.partition
        );
        assert_eq!(
            bottom_up,
            50 * complete,
            "bottom-up makes every box in every step, and none twice"
        );
        assert!(hybrid * 10 < bottom_up, "{hybrid} of {bottom_up}");
        assert!(top_down < hybrid);
    }
}

#[test]
fn levels_at_once_make_the_same_pairs_with_other_boxes() {
    let mut options = Options::paper();
    let (one, _) = first_50_steps(options);
    options.update = Update::Hybrid {
        level: None,
        levels_at_once: NonZeroU32::new(2).unwrap(),
    };
    let (two, _) = first_50_steps(options);
    assert_eq!(one.node_pairs, two.node_pairs);
    assert_eq!(one.boxes_bottom_up, two.boxes_bottom_up);
    assert!(two.boxes_top_down >= one.boxes_top_down);
}

/// Long thin triangles, turned against the axes, whose boxes hold mostly air.
#[test]
fn thin_triangles_have_few_candidates() {
    let bodies = [thin::fan(2_000), thin::strip(4_000), thin::tube(2_000)];
    let (good, waves) = thin::waves(100);
    for (number, (triangles, positions)) in bodies.iter().enumerate() {
        let mut world = World::<f32>::new();
        let body = world.add(triangles, positions).unwrap();
        let flat = world.add(&good, &waves).unwrap();
        let other = world.add(triangles, positions).unwrap();
        for angle in [0.4, 1.3, 2.9] {
            for (body, angle) in [(body, angle), (other, -2.0 * angle)] {
                let turned = thin::turned(positions, angle);
                world.set_positions(body, &turned).unwrap();
            }
            for of in [
                Selection::Between(body, flat),
                Selection::Between(body, other),
                Selection::Within(body),
            ] {
                let pairs = world.triangles_of(of).len() as u64;
                let candidates = world.statistics().candidate_pairs;
                eprintln!("{number}, {of:?}: {candidates} candidates, {pairs} pairs");
                let limit = 4 * pairs + 8 * triangles.len() as u64;
                assert!(candidates < limit, "{number}, {of:?}: {candidates}");
            }
        }
        world.validate().unwrap();
    }
}

/// A folding sheet far from the origin, where an f32 has no digits left for its shape.
#[test]
fn f64_boxes_are_as_tight_far_from_the_origin() {
    let scene = Scene::new("cloth", Some(19_602), Scene::DEFAULT_SEED).unwrap();
    let candidates_at = |shift: f64| {
        let mut single = Vec::new();
        let mut shape = |step| {
            scene.positions(0, step, &mut single);
            single
                .iter()
                .map(|position| position.map(|x| f64::from(x) + shift))
                .collect::<Vec<[f64; 3]>>()
        };
        let mut world = World::new();
        let body = world.add(scene.triangles(0), &shape(1)).unwrap();
        let mut candidates = 0;
        for step in [10, 30, 50] {
            world.set_positions(body, &shape(step)).unwrap();
            world.triangles_of(Selection::Within(body));
            candidates += world.statistics().candidate_pairs;
        }
        world.validate().unwrap();
        candidates
    };
    let (near, far) = (candidates_at(0.0), candidates_at(1e7));
    eprintln!("candidates: {near} at the origin, {far} at 10^7");
    assert!(far as f64 <= 1.1 * near as f64, "{far} against {near}");
    assert!(near > 10_000);
}

/// Deep trees are built, updated and traversed without recursion.
///
/// The stack is so small that any recursion by level would overflow it.
#[test]
fn a_deep_tree_needs_no_stack() {
    // Triangles at 2^0, 2^-1, 2^-2, ...: the box centre parts one from the rest each time.
    let scale = |i: i32| 2f64.powi(-i) as f32;
    let positions: Vec<[f32; 3]> = (0..140)
        .flat_map(|i| {
            [
                [scale(i), 0.0, 0.0],
                [scale(i), scale(i + 3), 0.0],
                [scale(i), 0.0, scale(i + 3)],
            ]
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..140).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let deep = move || {
        let mut options = Options::paper();
        options.degree = Degree::Two;
        for (partition, depths) in [(Partition::Centre, 90..140), (Partition::Mean, 25..40)] {
            options.partition = partition;
            let mut world = World::<f32>::with_options(options);
            let ids = [(); 2].map(|()| world.add(&triangles, &positions).unwrap());
            let found = world.tree_shape(ids[0]).unwrap().depth;
            assert!(depths.contains(&found), "{partition:?}: {found}");
            assert_eq!(
                world.triangles_of(Selection::Between(ids[0], ids[1])).len(),
                140
            );
            world.validate().unwrap();
        }
    };
    std::thread::Builder::new()
        .stack_size(64 << 10)
        .spawn(deep)
        .unwrap()
        .join()
        .unwrap();
}

/// Triangles that no rule can tell apart are divided evenly, so that the tree stays shallow.
#[test]
fn triangles_in_one_place_make_a_shallow_tree() {
    let place = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0_f32]];
    let triangles = vec![[0, 1, 2]; 1000];
    for partition in [Partition::Centre, Partition::Mean, Partition::Balanced] {
        for (degree, depth) in [(Degree::Two, 10), (Degree::Four, 5), (Degree::Eight, 4)] {
            let mut options = Options::paper();
            (options.partition, options.degree) = (partition, degree);
            let mut world = World::with_options(options);
            let body = world.add(&triangles, &place).unwrap();
            assert_eq!(world.tree_shape(body).unwrap().depth, depth, "{options:?}");
            assert!(
                world.triangles_of(Selection::Within(body)).is_empty(),
                "they share their vertices"
            );
        }
    }
}

/// A box is cut along its longest side, or its two longest.
///
/// So a row of triangles along any axis is halved along the row, not across its thickness.
#[test]
fn the_longest_sides_are_cut() {
    for axis in 0..3 {
        for (degree, depth) in [(Degree::Two, 6), (Degree::Four, 6), (Degree::Eight, 6)] {
            // 64 triangles in a row of 64 cells, zigzagging a little in the two other directions.
            let mut positions = Vec::new();
            for i in 0..64 {
                for (along, up, side) in [(0.3, 0.0, 0.0), (0.7, 0.0, 0.1), (0.5, 0.1, 0.0)] {
                    let mut position = [
                        up + 0.01 * (i % 2) as f32,
                        side + 0.01 * (i / 2 % 2) as f32,
                        0.0,
                    ];
                    position[2] = i as f32 + along;
                    position.rotate_left(axis);
                    positions.push(position);
                }
            }
            let triangles: Vec<[u32; 3]> = (0..64).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let mut options = Options::paper();
            options.degree = degree;
            let mut world = World::with_options(options);
            let body = world.add(&triangles, &positions).unwrap();
            // Halving the row takes six levels; a degree above two also splits the zigzag on the
            // way.
            let found = world.tree_shape(body).unwrap().depth;
            assert!(
                if degree == Degree::Two {
                    found == depth
                } else {
                    found <= depth
                },
                "axis {axis}, {degree:?}: {found}"
            );
        }
    }
}

/// Meshes that lie in one place have a pair for every two triangles.
///
/// The first pair is found after a few, a visitor stops the work, and memory does not grow with the
/// number of pairs.
#[test]
fn the_first_of_very_many_pairs_is_found_at_once() {
    let (count, place) = (
        100_000_u32,
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0_f32]],
    );
    let triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let positions: Vec<[f32; 3]> = (0..count).flat_map(|_| place).collect();
    for mut options in [Options::paper(), Options::default()] {
        for leaf_size in [1, 8, 1000] {
            options.leaf_size = leaf_size.try_into().unwrap();
            let mut world = World::with_options(options);
            let [a, b] = [(); 2].map(|()| world.add(&triangles, &positions).unwrap());
            let work = allocation_counter::measure(|| {
                assert!(world.first_of(Selection::Between(a, b)).is_some());
                assert!(
                    world.statistics().candidate_pairs <= 64,
                    "{:?}",
                    world.statistics()
                );
                assert!(
                    world.statistics().node_pairs < 10_000,
                    "{:?}",
                    world.statistics()
                );
                assert!(world.first_of(Selection::Within(a)).is_some());
            });
            assert!(work.bytes_max < 16 << 20, "{options:?}: {work:?}");
            let mut seen = 0;
            let stopped = world.intersections(Selection::Within(b)).visit(|_| {
                seen += 1;
                if seen == 50_000 {
                    std::ops::ControlFlow::Break(())
                } else {
                    std::ops::ControlFlow::Continue(())
                }
            });
            assert!(stopped.unwrap().is_break());
            // Work ahead of the visitor is bounded: 4,096 pairs of blocks of eight triangles.
            assert!(world.statistics().candidate_pairs < 50_000 + 4096 * 64 + 100_000);
        }
    }
}

/// Thousands of bodies are removed, in the order in which they came or the other way round.
#[test]
fn thousands_of_bodies_go() {
    let place = |i: u32| {
        [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0]]
            .map(|[x, y, z]| [x + (i % 100) as f32, y + (i / 100) as f32, z])
    };
    for newest_first in [false, true] {
        let mut world = World::<f32>::new();
        let mut ids: Vec<_> = (0..20_000)
            .map(|i| world.add(&[[0, 1, 2]], &place(i)).unwrap())
            .collect();
        let of = Selection::World;
        assert!(world.intersections(of).all().unwrap().is_empty());
        if newest_first {
            ids.reverse();
        }
        for id in ids {
            world.remove(id).unwrap();
        }
        assert_eq!(world.intersections(of).all().unwrap(), []);
    }
}

/// Ten million triangles: half a minute and some gigabytes.
///
/// `cargo test --release -p pliant --test all work:: -- --ignored --nocapture`
#[test]
#[ignore = "large"]
fn ten_million_triangles() {
    fn build<S: Scalar>(options: Options, convert: impl Fn([f32; 3]) -> [S; 3]) {
        let side = 2237;
        let positions: Vec<[S; 3]> = (0..side * side)
            .map(|i| (i % side, i / side))
            .map(|(x, y)| convert([x as f32, y as f32, ((x * 31 + y * 17) % 97) as f32 / 97.0]))
            .collect();
        let corners = (0..(side - 1) * (side - 1)).map(|i| i / (side - 1) * side + i % (side - 1));
        let triangles: Vec<[u32; 3]> = corners
            .flat_map(|i| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]])
            .collect();
        assert!(triangles.len() >= 9_999_000);
        let start = std::time::Instant::now();
        let mut world = World::with_options(options);
        let body = world.add(&triangles, &positions).unwrap();
        let built = std::time::Instant::now();
        assert!(world.triangles_of(Selection::Within(body)).is_empty());
        eprintln!(
            "{:?}: built in {:.1?}, asked in {:.1?}",
            options.partition,
            built - start,
            built.elapsed()
        );
    }
    let stack = std::thread::Builder::new().stack_size(64 << 10);
    let all = || {
        build::<f32>(Options::paper(), |position| position);
        build::<f32>(Options::default(), |position| position);
        build::<f64>(Options::default(), |position| position.map(f64::from));
    };
    stack.spawn(all).unwrap().join().unwrap();
}

/// Two fans that cross, as one body and as two bodies.
#[test]
fn fans_of_one_body_meet_each_other() {
    const COUNT: u32 = 2_000;
    let fan = |apex: [f32; 3], lift: f32| -> Vec<[f32; 3]> {
        let rim = |t: u32| {
            let (sin, cos) = (t as f32 * std::f32::consts::TAU / COUNT as f32).sin_cos();
            [cos, sin, lift * cos]
        };
        std::iter::once(apex).chain((0..COUNT).map(rim)).collect()
    };
    let triangles = |first: u32| -> Vec<[u32; 3]> {
        (0..COUNT)
            .map(|t| [0, 1 + t, 1 + (t + 1) % COUNT].map(|vertex| first + vertex))
            .collect()
    };
    let shapes = [fan([0.0, 0.0, 0.7], 0.3), fan([0.1, 0.0, -0.2], -0.4)];
    let mut world = World::<f32>::new();
    let [a, b] = [0, 1].map(|which| world.add(&triangles(0), &shapes[which]).unwrap());
    let apart = world.triangles_of(Selection::Between(a, b));
    assert!(apart.len() > 100, "{}", apart.len());

    let both = [triangles(0), triangles(COUNT + 1)].concat();
    let one = world.add(&both, &shapes.concat()).unwrap();
    let together = world.triangles_of(Selection::Within(one));
    let expected: Vec<_> = apart.iter().map(|&[a, b]| [a, COUNT + b]).collect();
    assert_eq!(together, expected);
}
