//! Options of one query: selections, limits, interruption, lent threads, and preparation ahead.

mod common;

use common::sheet;
use pliant::{BodyId, ErrorKind, Options, Pair, Scheduler, Selection, Statistics, Update, World};
use pliant_scenes::Scene;
use std::num::{NonZeroU32, NonZeroUsize};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A cloth deep in itself, moved there from its first shape.
fn cloth(options: Options, triangles: usize) -> (World<f32>, BodyId) {
    let scene = Scene::new("cloth", Some(triangles), Scene::DEFAULT_SEED).unwrap();
    let mut world = World::with_options(options);
    let mut positions = Vec::new();
    scene.positions(0, 1, &mut positions);
    let body = world.add(scene.triangles(0), &positions).unwrap();
    scene.positions(0, 50, &mut positions);
    world.set_positions(body, &positions).unwrap();
    (world, body)
}

/// Two spheres deep in each other, and a third sphere apart.
fn spheres(options: Options) -> (World<f32>, Vec<BodyId>) {
    let scene = Scene::new("spheres", Some(1_280), Scene::DEFAULT_SEED).unwrap();
    let mut world = World::with_options(options);
    let mut positions = Vec::new();
    let bodies = [0, 1, 0].map(|body| {
        scene.positions(body, 1, &mut positions);
        world.add(scene.triangles(body), &positions).unwrap()
    });
    for (place, id) in bodies.into_iter().enumerate() {
        scene.positions(place % 2, 200, &mut positions);
        let shift = if place == 2 { 9.0 } else { 0.0 };
        positions.iter_mut().for_each(|p| p[0] += shift);
        world.set_positions(id, &positions).unwrap();
    }
    (world, bodies.to_vec())
}

#[test]
fn preparing_does_what_the_query_would_do_first() {
    let boxes = |work: &Statistics| {
        [
            work.boxes_bottom_up,
            work.boxes_top_down,
            work.triangle_boxes,
        ]
    };
    for update in [Update::BottomUp, Update::TopDown, Update::HYBRID] {
        let mut options = Options::default();
        options.update = update;
        let (mut asked, body) = cloth(options, 2_888);
        let of = Selection::Within(body);
        let expected = asked.intersections(of).all().unwrap().to_vec();
        let (mut prepared, _) = cloth(options, 2_888);
        prepared.intersections(of).prepare().unwrap();
        assert_eq!(prepared.intersections(of).all().unwrap(), expected);
        assert_eq!(prepared.statistics(), asked.statistics(), "{update:?}");
        // The query itself has nothing left to do: all boxes of a body that meets itself are
        // prepared.
        prepared.intersections(of).all().unwrap();
        assert_eq!(boxes(prepared.statistics()), [0; 3], "{update:?}");
        if update == Update::HYBRID {
            assert_eq!(asked.statistics().boxes_top_down, 0);
        }
    }
}

#[test]
fn a_last_answer_that_no_longer_holds_is_counted() {
    let mut world = World::<f32>::new();
    let lower = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 4.0]];
    let body = world.add(&[[0, 1, 2]], &lower).unwrap();
    let upper = |z: f32| lower.map(|[x, y, height]| [x, y, height + z]);
    let other = world.add(&[[0, 1, 2]], &upper(0.0)).unwrap();
    for of in [
        Selection::World,
        Selection::Everything,
        Selection::Between(body, other),
    ] {
        world.set_positions(other, &upper(0.0)).unwrap();
        assert!(world.intersections(of).first().unwrap().is_some());
        // Now parallel, with boxes that still overlap: asked again in vain, then by the traversal.
        world.set_positions(other, &upper(1.0)).unwrap();
        assert_eq!(world.intersections(of).first().unwrap(), None);
        // In vain three times: the pair itself, its leaf, its leaf's siblings.
        assert_eq!(world.statistics().candidate_pairs, 3 + 1, "{of:?}");
    }
}

/// Intersections of the world, of everything, and of each body with itself and with others.
fn answers(world: &mut World<f32>, bodies: &[BodyId]) -> Vec<Vec<Pair>> {
    let mut of = vec![Selection::World, Selection::Everything];
    of.extend(bodies.iter().map(|&body| Selection::Within(body)));
    of.push(Selection::Between(bodies[0], bodies[1]));
    let ask = |of| world.intersections(of).all().unwrap().to_vec();
    of.into_iter().map(ask).collect()
}

/// A query is interrupted at every place where it looks, one after the other.
///
/// Afterwards the world answers as if nothing had happened.
#[test]
fn a_query_that_was_interrupted_anywhere_leaves_a_good_world() {
    for threads in [1, 3] {
        for (update, leaf_size) in [
            (Update::HYBRID, 8),
            (Update::BottomUp, 3),
            (Update::TopDown, 1),
        ] {
            let mut options = Options::default();
            options.threads = NonZeroUsize::new(threads).unwrap();
            options.update = update;
            options.leaf_size = NonZeroU32::new(leaf_size).unwrap();
            let expected = {
                let (mut world, bodies) = spheres(options);
                answers(&mut world, &bodies)
            };
            let mut allowed = 0;
            loop {
                let (mut world, bodies) = spheres(options);
                // Some boxes are valid when it begins.
                let between = Selection::Between(bodies[1], bodies[0]);
                world.intersections(between).first().unwrap();
                let looks = AtomicUsize::new(0);
                let question = || looks.fetch_add(1, Ordering::Relaxed) >= allowed;
                let everything = world.intersections(Selection::Everything);
                let answer = everything.interrupt_if(&question).all();
                let is_whole = answer.is_ok();
                if let Err(refused) = answer {
                    assert_eq!(refused.kind, ErrorKind::Interrupted);
                    assert_eq!(refused.body, None);
                }
                world.validate().unwrap();
                assert!(answers(&mut world, &bodies) == expected, "{allowed}");
                world.validate().unwrap();
                if is_whole {
                    break;
                }
                // At first every look is tried, then fewer of them.
                allowed += 1 + allowed / 12;
            }
            assert!(allowed > 30, "{allowed} looks are no test");
        }
    }
}

#[test]
fn visits_first_hits_and_preparation_can_be_interrupted() {
    let (mut world, bodies) = spheres(Options::default());
    let always = || true;
    let interrupted = |error: pliant::Error| error.kind == ErrorKind::Interrupted;
    for of in [Selection::World, Selection::Within(bodies[0])] {
        let query = |world: &mut World<f32>| world.intersections(of).interrupt_if(&always).first();
        assert!(query(&mut world).is_err_and(interrupted));
        let query = world.intersections(of).interrupt_if(&always);
        assert!(query.prepare().is_err_and(interrupted));
        let query = world.intersections(of).interrupt_if(&always);
        let visited = query.visit(|_| ControlFlow::Break(()));
        assert!(visited.is_err_and(interrupted));
    }
    // Interrupted after a first answer, too, which would be tried again first.
    let never = || false;
    let first = world
        .intersections(Selection::World)
        .interrupt_if(&never)
        .first();
    assert!(first.unwrap().is_some());
}

/// Every pair that a visitor saw before an interruption is a hit, and none is shown twice.
#[test]
fn what_an_interrupted_visitor_was_shown_was_true() {
    for threads in [1, 3] {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        let (mut world, _) = spheres(options);
        let expected = world
            .intersections(Selection::Everything)
            .all()
            .unwrap()
            .to_vec();
        for allowed in (0..400).step_by(7) {
            let (mut world, _) = spheres(options);
            // Tasks have found something before, so their lists are not empty.
            world.intersections(Selection::Everything).all().unwrap();
            let looks = AtomicUsize::new(0);
            let question = || looks.fetch_add(1, Ordering::Relaxed) >= allowed;
            let mut shown = Vec::new();
            let everything = world.intersections(Selection::Everything);
            let _ = everything.interrupt_if(&question).visit(|pair| {
                shown.push(pair);
                ControlFlow::<()>::Continue(())
            });
            let count = shown.len();
            shown.sort_unstable();
            shown.dedup();
            assert_eq!(shown.len(), count, "{allowed}");
            assert!(
                shown
                    .iter()
                    .all(|pair| expected.binary_search(pair).is_ok())
            );
        }
    }
}

/// Two flat sheets, one on the other: most close pairs there touch, and are measured exactly.
fn sheets_that_touch(side: u32) -> World<f32> {
    let (triangles, flat) = sheet(side);
    let mut world = World::new();
    for _ in 0..2 {
        world.add(&triangles, &flat).unwrap();
    }
    world
}

/// Close pairs that an interrupted visitor saw were measured, and the world answers as before.
#[test]
fn close_pairs_that_touch_can_be_interrupted() {
    let of = Selection::World;
    let mut world = sheets_that_touch(6);
    let expected = world.close_edge_edge_pairs(of, 0.1).all().unwrap().to_vec();
    assert!(expected.len() > 500 && expected.iter().all(|hit| hit.distance == 0.0));
    let mut interrupted = 0;
    for allowed in (0..4000).step_by(97) {
        let looks = AtomicUsize::new(0);
        let question = || looks.fetch_add(1, Ordering::Relaxed) >= allowed;
        let mut shown = Vec::new();
        let close = world.close_edge_edge_pairs(of, 0.1);
        let visited = close.interrupt_if(&question).visit(|hit| {
            shown.push(hit);
            ControlFlow::<()>::Continue(())
        });
        interrupted += u32::from(visited.is_err());
        assert!(visited.is_err() || shown.len() == expected.len());
        assert!(shown.iter().all(|hit| expected.contains(hit)), "{allowed}");
        looks.store(0, Ordering::Relaxed);
        let listed = world
            .close_edge_edge_pairs(of, 0.1)
            .interrupt_if(&question)
            .all();
        assert!(listed.is_err_and(|error| error.kind == ErrorKind::Interrupted) || visited.is_ok());
        assert_eq!(
            world.close_edge_edge_pairs(of, 0.1).all().unwrap(),
            expected
        );
    }
    assert!(interrupted > 5, "{interrupted}");
}

/// A world, and a question to it whose query can be interrupted.
struct Asked {
    name: &'static str,
    world: World<f32>,
    ask: fn(&mut World<f32>, &(dyn Fn() -> bool + Sync)) -> Result<usize, pliant::Error>,
    /// The least number of hits.
    hits: usize,
}

/// Queries that take long in different ways.
///
/// A first query of a large body with itself, one all of whose decisions are exact, long lists,
/// many bodies.
fn what_takes_long() -> Vec<Asked> {
    let all = |world: &mut World<f32>, look: &(dyn Fn() -> bool + Sync)| {
        let found = world.intersections(Selection::World).interrupt_if(look);
        found.all().map(<[Pair]>::len)
    };
    let cloth = Asked {
        name: "a cloth",
        world: cloth(Options::default(), 47_432).0,
        ask: |world, look| {
            let within = Selection::Within(BodyId(0));
            let found = world.intersections(within).interrupt_if(look);
            found.all().map(<[Pair]>::len)
        },
        hits: 3_600,
    };

    // Two flat sheets in one plane: signs are exact zeros, and nearly all candidates are hits.
    let mut flat = World::new();
    let (triangles, corners) = sheet(73);
    flat.add(&triangles, &corners).unwrap();
    let shifted = corners.iter().map(|[x, y, z]| [x + 0.001, y - 0.002, *z]);
    let shifted: Vec<_> = shifted.collect();
    flat.add(&triangles, &shifted).unwrap();
    let flat = Asked {
        name: "flat sheets",
        world: flat,
        ask: all,
        hits: 30_000,
    };

    let mut in_one_place = World::new();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let soup: Vec<[u32; 3]> = (0..563).map(|_| [0, 1, 2]).collect();
    let _ = [0, 1].map(|_| in_one_place.add(&soup, &corners).unwrap());
    let in_one_place = Asked {
        name: "one place",
        world: in_one_place,
        ask: all,
        hits: soup.len() * soup.len(),
    };

    let touching = Asked {
        name: "close pairs that touch",
        world: sheets_that_touch(24),
        ask: |world, look| {
            let close = world.close_edge_edge_pairs(Selection::World, 1e-6);
            close.interrupt_if(look).all().map(<[_]>::len)
        },
        hits: 6_000,
    };

    let mut many_bodies = World::new();
    for at in 0..232 {
        let x = at as f32 * 0.001;
        let corners = [[x, 0.0, 0.0], [x + 9.0, 0.0, 1.0], [x, 9.0, 0.0]];
        many_bodies.add(&[[0, 1, 2]], &corners).unwrap();
    }
    let many_bodies = Asked {
        name: "many bodies",
        world: many_bodies,
        ask: |world, look| {
            // All boxes overlap, and nothing is found before every pair has been asked.
            let first = world.intersections(Selection::World).interrupt_if(look);
            first.first().map(|first| usize::from(first.is_some()))
        },
        hits: 0,
    };
    vec![cloth, flat, in_one_place, touching, many_bodies]
}

impl Asked {
    /// Work counted until a query was interrupted after `allowed` looks, and the number of looks.
    ///
    /// One unit of work takes some tens of nanoseconds.
    fn work_at(&self, allowed: usize) -> (u64, usize) {
        let mut world = self.world.clone();
        let looks = AtomicUsize::new(0);
        let look = || looks.fetch_add(1, Ordering::Relaxed) >= allowed;
        match (self.ask)(&mut world, &look) {
            Ok(hits) => assert!(hits >= self.hits, "{}: {hits}", self.name),
            Err(refused) => assert_eq!(refused.kind, ErrorKind::Interrupted),
        }
        let work = world.statistics();
        let boxes = work.boxes_bottom_up + work.boxes_top_down + work.triangle_boxes;
        let decided = work.candidate_pairs + work.pairs + 10 * work.exact_decisions;
        let work = boxes + 2 * (work.node_pairs + work.body_pairs) + decided;
        (work, looks.into_inner())
    }

    /// Fails if more than `most` units of work lie between two looks.
    ///
    /// Counters are added to in batches. A batch was done since the looks at which the counters
    /// stood still, and is divided by the number of those looks. Spans with little work are
    /// skipped, however many looks they have.
    fn assert_between_looks(&self, most: u64) {
        let (total, looks) = self.work_at(usize::MAX);
        let mut spans = vec![([0, looks], [self.work_at(0).0, total])];
        let (mut worst, mut tried) = (0, 0);
        while let Some(([from, to], [before, after])) = spans.pop() {
            if after - before <= most {
                continue;
            }
            if to - from > 1 {
                let middle = from.midpoint(to);
                let (work, _) = self.work_at(middle);
                spans.push(([from, middle], [before, work]));
                spans.push(([middle, to], [work, after]));
                tried += 1;
                continue;
            }
            let (mut other, mut same) = (0, from);
            while other < same {
                let middle = other.midpoint(same);
                if self.work_at(middle).0 == before {
                    same = middle;
                } else {
                    other = middle + 1;
                }
                tried += 1;
            }
            let each = (after - before) / (to - same) as u64;
            worst = worst.max(each);
            assert!(
                each <= most,
                "{}: {each} from look {same} to {to}",
                self.name
            );
        }
        println!(
            "{}: {total} in {looks} looks, at most {worst}; ended {tried} times",
            self.name
        );
        assert!(
            looks > 20 && total > 2 * most,
            "{}: {total}, {looks}",
            self.name
        );
    }
}

/// The bound on work between two looks, in the units of [`Asked::work_at`].
const MOST_BETWEEN_LOOKS: u64 = 20_000;

/// Between two looks a query does no more than some milliseconds of work, which is counted.
#[test]
fn looks_are_never_far_apart() {
    for asked in what_takes_long() {
        asked.assert_between_looks(MOST_BETWEEN_LOOKS);
    }
}

#[test]
fn a_pool_that_is_lent_gives_the_same_answers_from_inside_and_outside() {
    let (mut alone, bodies) = spheres(Options::default());
    let expected = answers(&mut alone, &bodies);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
    let pool = Arc::new(pool.unwrap());
    for threads in [1, 2, 4, 9] {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        let mut world = World::with_pool(options, Arc::clone(&pool));
        for &body in &bodies {
            let first = alone.positions(body).unwrap();
            world.add(alone.triangles(body).unwrap(), &first).unwrap();
        }
        assert!(answers(&mut world, &bodies) == expected, "{threads}");
        // A copy shares the pool too.
        let lent = Arc::strong_count(&pool);
        let mut copy = world.clone();
        assert_eq!(Arc::strong_count(&pool) > lent, threads > 1, "{threads}");
        assert!(answers(&mut copy, &bodies) == expected, "{threads}, copied");
        for &body in &bodies {
            let positions = alone.positions(body).unwrap();
            world.set_positions(body, &positions).unwrap();
        }
        let inside = pool.install(|| answers(&mut world, &bodies));
        assert!(inside == expected, "{threads}, inside");
    }
    // Several worlds share the pool at once.
    let ask = |_| {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(3).unwrap();
        let mut world = World::with_pool(options, Arc::clone(&pool));
        for &body in &bodies {
            let positions = alone.positions(body).unwrap();
            world
                .add(alone.triangles(body).unwrap(), &positions)
                .unwrap();
        }
        assert!(answers(&mut world, &bodies) == expected);
    };
    std::thread::scope(|scope| {
        let all: Vec<_> = (0..4).map(|n| scope.spawn(move || ask(n))).collect();
        all.into_iter().for_each(|one| one.join().unwrap());
    });
}

/// Runs all tasks but the first, from the last, and counts them.
#[derive(Default)]
struct Backwards(AtomicUsize);

impl Scheduler for Backwards {
    fn run(&self, tasks: usize, task: &(dyn Fn(usize) + Sync)) {
        self.0.fetch_add(tasks, Ordering::Relaxed);
        (1..tasks).rev().for_each(task);
    }
}

#[test]
fn a_scheduler_of_the_application_gives_the_same_answers() {
    let (mut alone, bodies) = spheres(Options::default());
    let expected = answers(&mut alone, &bodies);
    for threads in [1, 2, 9] {
        let scheduler = Arc::new(Backwards::default());
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        let shared: Arc<dyn Scheduler> = scheduler.clone();
        let mut world = World::with_scheduler(options, shared);
        for &body in &bodies {
            let first = alone.positions(body).unwrap();
            world.add(alone.triangles(body).unwrap(), &first).unwrap();
        }
        assert!(answers(&mut world, &bodies) == expected, "{threads}");
        let given = scheduler.0.load(Ordering::Relaxed);
        assert_eq!(given > 0, threads > 1, "{threads}");
        let mut copy = world.clone();
        assert!(answers(&mut copy, &bodies) == expected, "{threads}, copied");
        let more = scheduler.0.load(Ordering::Relaxed);
        assert_eq!(more > given, threads > 1, "{threads}, copied");
    }
}
