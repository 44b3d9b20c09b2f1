//! The number of threads changes only time: not the pairs, their order or the counters.

use crate::common::TrianglesOf;
use pliant::{BroadPhase, Degree, Options, Pair, Partition, Selection, Statistics, Update, World};
use pliant_scenes::Scene;
use std::num::{NonZeroU32, NonZeroUsize};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Pairs in the order that a visitor saw: of bodies with each other, and of one with itself.
type Visited = (Vec<Pair>, Vec<[u32; 2]>);
/// Visited pairs, all pairs of the same two queries, the first pair, and counters of each query.
type Seen = (Visited, Visited, Option<Pair>, Vec<Statistics>);

fn play(scene: &Scene, steps: &[u32], mut options: Options, threads: usize) -> Vec<Seen> {
    options.threads = NonZeroUsize::new(threads).unwrap();
    let mut world = World::<f32>::with_options(options);
    let mut positions = Vec::new();
    let mut bodies = Vec::new();
    for body in 0..scene.body_count() {
        scene.positions(body, 1, &mut positions);
        bodies.push(world.add(scene.triangles(body), &positions).unwrap());
    }
    let mut move_to = |world: &mut World<f32>, step: u32| {
        for (body, &id) in bodies.iter().enumerate() {
            scene.positions(body, step, &mut positions);
            world.set_positions(id, &positions).unwrap();
        }
    };
    let mut see = |world: &mut World<f32>, step: u32| {
        let mut statistics = Vec::new();
        move_to(world, step);
        let (mut between, mut itself) = (Vec::new(), Vec::new());
        let _ = world.intersections(Selection::World).visit(|pair| {
            between.push(pair);
            ControlFlow::<()>::Continue(())
        });
        statistics.push(*world.statistics());
        let _ = world
            .intersections(Selection::Within(bodies[0]))
            .visit(|pair| {
                itself.push(pair.triangles());
                ControlFlow::<()>::Continue(())
            });
        statistics.push(*world.statistics());
        let first = world.intersections(Selection::World).first().unwrap();
        statistics.push(*world.statistics());
        // Every box is stale.
        move_to(world, step);
        let all = world
            .intersections(Selection::World)
            .all()
            .unwrap()
            .to_vec();
        statistics.push(*world.statistics());
        let all_of_itself = world.triangles_of(Selection::Within(bodies[0]));
        statistics.push(*world.statistics());
        ((between, itself), (all, all_of_itself), first, statistics)
    };
    steps.iter().map(|&step| see(&mut world, step)).collect()
}

/// Options with different trees and updates.
fn all_options() -> [Options; 4] {
    let two_at_once = Update::Hybrid {
        level: Some(1),
        levels_at_once: NonZeroU32::new(2).unwrap(),
    };
    let mut connectivity = Options::paper();
    connectivity.partition = Partition::Connectivity;
    let mut binary = Options::default();
    (binary.degree, binary.update) = (Degree::Two, two_at_once);
    let mut complete = Options::default();
    complete.update = Update::BottomUp;
    [Options::default(), complete, connectivity, binary]
}

#[test]
fn pairs_order_and_counters_do_not_depend_on_threads() {
    for (name, triangles, steps) in [("spheres", 5120, [120, 200]), ("cloth", 5000, [40, 50])] {
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
        for options in all_options() {
            let alone = play(&scene, &steps, options, 1);
            let pairs = alone.iter().map(|seen| seen.1.0.len() + seen.1.1.len());
            assert!(pairs.sum::<usize>() > 100, "{name} has contacts");
            for threads in [2, 3, 7] {
                assert!(
                    play(&scene, &steps, options, threads) == alone,
                    "{name}, {threads} threads, {options:?}"
                );
            }
        }
    }
}

/// All pairs of many bodies, and the counters of each query.
///
/// Some steps have one body fewer than before, or a much larger one.
fn play_crowd(scene: &Scene, large: &Scene, options: Options) -> Vec<(Vec<Pair>, Statistics)> {
    let mut world = World::<f32>::with_options(options);
    let mut positions = Vec::new();
    let mut add = |world: &mut World<f32>, scene: &Scene, body: usize| {
        scene.positions(body, 1, &mut positions);
        world.add(scene.triangles(body), &positions).unwrap()
    };
    let mut bodies: Vec<_> = (0..scene.body_count())
        .map(|body| add(&mut world, scene, body))
        .collect();
    let mut positions = Vec::new();
    let mut see = |world: &mut World<f32>, bodies: &[pliant::BodyId], step: u32| {
        for (body, &id) in bodies.iter().enumerate() {
            scene.positions(body, step, &mut positions);
            world.set_positions(id, &positions).unwrap();
        }
        // At every twentieth step each body against itself, too.
        let of = if step.is_multiple_of(20) {
            Selection::Everything
        } else {
            Selection::World
        };
        let pairs = world.intersections(of).all().unwrap().to_vec();
        (pairs, *world.statistics())
    };
    let mut seen = vec![see(&mut world, &bodies, 150), see(&mut world, &bodies, 160)];
    world.remove(bodies.pop().unwrap()).unwrap();
    seen.push(see(&mut world, &bodies, 170));
    let large = add(&mut world, large, 0);
    seen.push(see(&mut world, &bodies, 180));
    assert!(seen[3].0.iter().any(|pair| pair.body_b == large));
    seen.push(see(&mut world, &bodies, 200));
    seen
}

#[test]
fn many_bodies_at_once_are_as_one_after_the_other() {
    let seed = Scene::DEFAULT_SEED;
    let large = Scene::new("spheres", Some(20_480), seed).unwrap();
    for name in ["crowd", "arms"] {
        let scene = Scene::new(name, Some(1_280), seed).unwrap();
        for mut options in all_options() {
            let alone = play_crowd(&scene, &large, options);
            for (pairs, statistics) in &alone {
                assert!(pairs.is_sorted() && statistics.body_pairs > 50);
                assert_eq!(pairs.len() as u64, statistics.pairs);
            }
            for threads in [2, 3, 7] {
                options.threads = NonZeroUsize::new(threads).unwrap();
                assert!(
                    play_crowd(&scene, &large, options) == alone,
                    "{name}, {threads} threads, {options:?}"
                );
            }
        }
    }
}

/// Jobs and the threads that share them, of a step of a scene, as a record has them: no clock.
fn shared_parts(scene: &Scene, step: u32) -> Vec<(usize, usize)> {
    let mut world = World::<f32>::new();
    let ticks = AtomicU64::new(0);
    let clock = Arc::new(move || ticks.fetch_add(1, Ordering::Relaxed));
    world.record_jobs(NonZeroUsize::new(16).unwrap(), clock);
    let mut shape = Vec::new();
    let mut bodies = Vec::new();
    for body in 0..scene.body_count() {
        scene.positions(body, step, &mut shape);
        bodies.push(world.add(scene.triangles(body), &shape).unwrap());
    }
    // The first query says how much there is to do.
    for shift in [0, 1] {
        for (body, &id) in bodies.iter().enumerate() {
            scene.positions(body, step + shift, &mut shape);
            world.set_positions(id, &shape).unwrap();
        }
        world.take_record();
        world.intersections(Selection::Everything).all().unwrap();
    }
    let parts = world.take_record().into_iter();
    let shared = parts.filter(|part| part.most_threads > 1);
    shared
        .map(|part| (part.jobs.len(), part.most_threads))
        .collect()
}

#[test]
fn a_query_takes_as_many_threads_as_its_work_pays() {
    let parts = |name, triangles, step| {
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
        shared_parts(&scene, step)
    };
    // Some microseconds of work, up to 30: nobody is woken.
    for triangles in [20, 80, 320] {
        assert_eq!(parts("spheres", triangles, 190), [], "{triangles}");
    }
    // Much work: eight threads or more.
    for (name, triangles, step) in [("spheres", 20_480, 190), ("cloth", 20_000, 40)] {
        let parts = parts(name, triangles, step);
        let most = parts.iter().map(|&(_, threads)| threads).max();
        assert!(most >= Some(8), "{name}: {parts:?}");
        // Nobody is woken for less than a job.
        assert!(
            parts.iter().all(|&(jobs, threads)| threads <= jobs),
            "{name}: {parts:?}"
        );
    }
}

#[test]
fn many_shapes_at_once_are_as_one_after_the_other() {
    let scene = Scene::new("crowd", Some(320), Scene::DEFAULT_SEED).unwrap();
    let shape = |body, step| {
        let mut shape = Vec::new();
        scene.positions(body, step, &mut shape);
        shape
    };
    for threads in [1, 3] {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        let mut worlds = [0, 1].map(|_| World::<f32>::with_options(options));
        let mut bodies = Vec::new();
        for body in 0..scene.body_count() {
            let [a, b] = worlds
                .each_mut()
                .map(|world| world.add(scene.triangles(body), &shape(body, 1)).unwrap());
            assert_eq!(a, b);
            bodies.push(a);
        }
        let mut found = Vec::new();
        for step in [60, 100, 140] {
            let shapes: Vec<_> = (0..bodies.len()).map(|body| shape(body, step)).collect();
            let [at_once, one_by_one] = &mut worlds;
            let listed = bodies.iter().zip(&shapes);
            let mut listed: Vec<_> = listed.map(|(&id, shape)| (id, &shape[..])).collect();
            // In any order.
            listed.reverse();
            at_once.set_positions_of(&listed).unwrap();
            for (id, shape) in &listed {
                one_by_one.set_positions(*id, shape).unwrap();
            }
            let answers = worlds.each_mut().map(|world| {
                let found = world.intersections(Selection::Everything).all();
                found.unwrap().to_vec()
            });
            assert_eq!(answers[0], answers[1]);
            found = answers[0].clone();

            // All or none, and the error is of the first that is refused.
            let world = &mut worlds[0];
            let broken = vec![[f32::NAN; 3]; shapes[0].len()];
            for wrong in [
                [(bodies[3], &shapes[2][..]), (bodies[0], &broken)],
                [(bodies[0], &shapes[1][..]), (bodies[0], &shapes[1])],
                [(bodies[2], &shapes[1][..]), (bodies[0], &shapes[1][1..])],
            ] {
                let error = world.set_positions_of(&wrong).unwrap_err();
                assert_eq!(error.body, Some(bodies[0]), "{error}");
            }
            let again = world.intersections(Selection::Everything).all();
            assert_eq!(again.unwrap(), found);
        }
        assert!(!found.is_empty());
    }
}

/// More pairs of bodies than two threads take at once.
#[test]
fn very_many_pairs_of_bodies_are_taken_some_at_a_time() {
    let scene = Scene::gather(2_000, 20, Scene::DEFAULT_SEED).unwrap();
    let answers = [1, 2, 3].map(|threads| {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        let mut world = World::<f32>::with_options(options);
        let mut shape = Vec::new();
        for body in 0..scene.body_count() {
            scene.positions(body, 192, &mut shape);
            world.add(scene.triangles(body), &shape).unwrap();
        }
        let of = Selection::Everything;
        let found = world.intersections(of).all().unwrap().to_vec();
        let statistics = *world.statistics();
        let contacts = world.contacts(of).all().unwrap().len();
        let near = world.vertex_triangle_candidates(of, 0.01).all().unwrap();
        assert!(statistics.body_pairs > 3 << 12 && !found.is_empty());
        (found, statistics, contacts, near.to_vec())
    });
    assert!(answers.iter().all(|answer| *answer == answers[0]));
}

/// Boxes of bodies are then missing: a broad phase that kept what it made of them would find a body
/// with itself.
#[test]
fn an_interrupt_while_boxes_are_taken_leaves_no_trace() {
    let scene = Scene::gather(60, 20, Scene::DEFAULT_SEED);
    let scene = scene.unwrap();
    let crossing = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let through = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]];
    let corners = [crossing, through].concat();
    for broad_phase in [BroadPhase::SweepAndPrune, BroadPhase::Tree] {
        for threads in [1, 2, 3] {
            let mut options = Options::default();
            options.threads = NonZeroUsize::new(threads).unwrap();
            options.broad_phase = broad_phase;
            let mut world = World::<f32>::with_options(options);
            let mut shape = Vec::new();
            for body in 0..scene.body_count() {
                scene.positions(body, 190, &mut shape);
                world.add(scene.triangles(body), &shape).unwrap();
            }
            world.intersections(Selection::World).all().unwrap();
            let last = world.add(&[[0, 1, 2], [3, 4, 5]], &corners).unwrap();
            let query = world.intersections(Selection::World);
            assert!(query.interrupt_if(&|| true).all().is_err());
            for of in [Selection::World, Selection::Everything] {
                let found = world.intersections(of).all().unwrap();
                let of_itself = |pair: &&Pair| pair.body_a == last && pair.body_b == last;
                let expected = usize::from(of == Selection::Everything);
                assert_eq!(found.iter().filter(of_itself).count(), expected);
                assert!(found.windows(2).all(|two| two[0] < two[1]));
            }
        }
    }
}
