//! No sequence of calls gives an answer for old positions.
//!
//! Worlds that live are compared with worlds built fresh.

use crate::common::{Lcg, TrianglesOf, covering_configurations, every_configuration, sheet};
use pliant::{BodyId, Options, Pair, Scalar, Selection, World};

/// The test's own copy of a body, enough to build it anew.
#[derive(Clone)]
struct Known<S> {
    id: BodyId,
    triangles: Vec<[u32; 3]>,
    /// The flat sheet from which all its shapes are made.
    flat: Vec<[f32; 3]>,
    positions: Vec<[S; 3]>,
    membership: u32,
    mask: u32,
    environment: u32,
}

/// Answers of a world to all selections.
#[derive(Debug, PartialEq)]
struct Answers {
    between_all: Vec<Pair>,
    /// All pairs of different bodies, and each body with itself unless a filter forbids it.
    everything: Vec<Pair>,
    /// Pairs of each body with itself.
    within: Vec<(BodyId, Vec<[u32; 2]>)>,
    /// Two bodies by name, in either order, whatever filters say.
    of_two: Vec<[BodyId; 2]>,
    pairs_of_two: Vec<Vec<[u32; 2]>>,
}

/// Asks for everything about these bodies, and about two of them by name.
///
/// Asserts that *first* is one of *all*.
fn ask<S: Scalar>(world: &mut World<S>, ids: &[BodyId], two: [usize; 2]) -> Answers {
    let first = world.intersections(Selection::World).first().unwrap();
    let between_all = world
        .intersections(Selection::World)
        .all()
        .unwrap()
        .to_vec();
    assert!(first.map_or(between_all.is_empty(), |pair| between_all.contains(&pair)));
    let first = world.intersections(Selection::Everything).first().unwrap();
    let everything = world
        .intersections(Selection::Everything)
        .all()
        .unwrap()
        .to_vec();
    assert!(first.map_or(everything.is_empty(), |pair| everything.contains(&pair)));
    let within = ids.iter().map(|&id| {
        let first = world.first_of(Selection::Within(id));
        let all = world.triangles_of(Selection::Within(id));
        assert!(first.map_or(all.is_empty(), |pair| all.contains(&pair)));
        (id, all)
    });
    let within = within.collect();
    let [a, b] = two.map(|place| ids[place]);
    let of_two: Vec<_> = if a == b {
        Vec::new()
    } else {
        vec![[a, b], [b, a]]
    };
    let pairs_of_two = of_two.iter().map(|&[a, b]| {
        let first = world.first_of(Selection::Between(a, b));
        let all = world.triangles_of(Selection::Between(a, b));
        assert!(first.map_or(all.is_empty(), |pair| all.contains(&pair)));
        all
    });
    let pairs_of_two = pairs_of_two.collect();
    Answers {
        between_all,
        everything,
        within,
        of_two,
        pairs_of_two,
    }
}

/// Answers of a world built fresh, with the ids of the world that lives.
fn fresh_answers<S: Scalar>(
    options: Options,
    known: &[Known<S>],
    ignored: &[(BodyId, BodyId)],
    two: [usize; 2],
) -> Answers {
    let mut world = World::with_options(options);
    for body in known {
        let id = world.add(&body.triangles, &body.positions).unwrap();
        world.set_filter(id, body.membership, body.mask).unwrap();
        world.set_environment(id, body.environment).unwrap();
    }
    let id_of = |id: BodyId| {
        known
            .iter()
            .position(|body| body.id == id)
            .map(|place| BodyId(place as u32))
    };
    for &(a, b) in ignored {
        if let (Some(a), Some(b)) = (id_of(a), id_of(b)) {
            world.ignore(a, b).unwrap();
        }
    }
    let ids: Vec<_> = world.bodies().collect();
    let mut answers = ask(&mut world, &ids, two);
    let known_id = |id: &mut BodyId| *id = known[id.0 as usize].id;
    for pair in answers
        .between_all
        .iter_mut()
        .chain(&mut answers.everything)
    {
        known_id(&mut pair.body_a);
        known_id(&mut pair.body_b);
    }
    answers.within.iter_mut().for_each(|(id, _)| known_id(id));
    answers
        .of_two
        .as_flattened_mut()
        .iter_mut()
        .for_each(known_id);
    answers
}

fn is_ignored(ignored: &[(BodyId, BodyId)], a: BodyId, b: BodyId) -> bool {
    ignored.contains(&(a, b)) || ignored.contains(&(b, a))
}

/// Asserts that a world that lives answers as a fresh one, twice without movement between.
fn assert_fresh<S: Scalar>(
    world: &mut World<S>,
    known: &[Known<S>],
    ignored: &[(BodyId, BodyId)],
    two: [usize; 2],
    when: &str,
) {
    let options = *world.options();
    let expected = fresh_answers(options, known, ignored, two);
    let ids: Vec<_> = known.iter().map(|body| body.id).collect();
    for body in known {
        let filter = (body.membership, body.mask);
        assert_eq!(world.filter(body.id), Ok(filter), "{when}");
        assert_eq!(world.environment(body.id), Ok(body.environment), "{when}");
    }
    let alive = |id: &BodyId| known.iter().any(|body| body.id == *id);
    // A fresh world could forget a filter as well: nobody meets who must not.
    let of = |id: BodyId| known.iter().find(|body| body.id == id).unwrap();
    for pair in &expected.everything {
        let (a, b) = (of(pair.body_a), of(pair.body_b));
        assert!(a.membership & b.mask != 0 && b.membership & a.mask != 0);
        assert!(a.environment == b.environment && !is_ignored(ignored, a.id, b.id));
    }
    let pairs = ignored.iter().map(|&(a, b)| [a.min(b), a.max(b)]);
    let mut pairs: Vec<_> = pairs.filter(|pair| pair.iter().all(alive)).collect();
    pairs.sort_unstable();
    pairs.dedup();
    assert_eq!(world.ignored(), pairs, "{when}");
    for time in ["", ", again, without movement"] {
        assert_eq!(ask(world, &ids, two), expected, "{when}{time}, {options:?}");
    }
    world.validate().unwrap();
}

/// A small crumpled sheet somewhere near the origin.
fn crumpled_near(random: &mut Lcg, flat: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let shift = [(); 3].map(|()| random.unit() * 2.0);
    flat.iter()
        .map(|place| std::array::from_fn(|axis| place[axis] + shift[axis] + random.unit() * 0.3))
        .collect()
}

#[expect(clippy::too_many_lines, reason = "one arm a call of the library")]
fn check_lives<S: Scalar>(seeds: std::ops::Range<u64>, shift: f64, convert: fn(f64) -> S) {
    let configurations = every_configuration();
    for seed in seeds {
        let mut random = Lcg(seed);
        let options = configurations[random.below(configurations.len() as u32) as usize];
        let (triangles, flat) = sheet(3 + random.below(4));
        // Now and then everything is far away, and comes back. In `f64` the origin of the boxes
        // follows.
        let mut here = 0.0;
        let place = |positions: &[[f32; 3]], here: f64| -> Vec<[S; 3]> {
            positions
                .iter()
                .map(|position| position.map(|x| convert(f64::from(x) + here)))
                .collect()
        };
        let mut world = World::<S>::with_options(options);
        let mut known: Vec<Known<S>> = Vec::new();
        let mut ignored: Vec<(BodyId, BodyId)> = Vec::new();
        for _ in 0..60 {
            let some = (!known.is_empty()).then(|| random.below(known.len() as u32) as usize);
            match (random.below(19), some) {
                (13, _) => here = if here == 0.0 { shift } else { 0.0 },
                // The world goes on as its copy, and changes to the original do not reach the copy.
                (15, _) => {
                    let copy = world.clone();
                    for body in &known {
                        // A loose box may not hold the flat sheet.
                        let _ = world.set_positions(body.id, &place(&body.flat, here));
                        world.set_filter(body.id, 0, 0).unwrap();
                        if random.below(2) == 0 {
                            world.remove(body.id).unwrap();
                        }
                    }
                    world.intersections(Selection::Everything).all().unwrap();
                    world.validate().unwrap();
                    world = copy;
                }
                (0..=1, _) | (_, None) => {
                    let positions = place(&crumpled_near(&mut random, &flat), here);
                    let id = world.add(&triangles, &positions).unwrap();
                    assert!(
                        known.iter().all(|body| body.id < id),
                        "ids are never used again"
                    );
                    let all = u32::MAX;
                    known.push(Known {
                        id,
                        triangles: triangles.clone(),
                        flat: flat.clone(),
                        positions,
                        membership: all,
                        mask: all,
                        environment: 0,
                    });
                }
                (2, Some(some)) => {
                    let removed = known.remove(some).id;
                    world.remove(removed).unwrap();
                    assert!(
                        world.set_positions(removed, &place(&flat, here)).is_err(),
                        "a removed id is refused"
                    );
                }
                // One body moves, perhaps twice.
                (3..=6, Some(some)) => {
                    for _ in 0..=random.below(2) {
                        let flat = &known[some].flat;
                        let positions = place(&crumpled_near(&mut random, flat), here);
                        if random.below(2) == 0 {
                            world.set_positions(known[some].id, &positions).unwrap();
                        } else {
                            world
                                .write_positions(known[some].id, |buffer| {
                                    buffer.copy_from_slice(&positions);
                                })
                                .unwrap();
                        }
                        known[some].positions = positions;
                    }
                }
                (7, Some(some)) => world.rebuild(known[some].id).unwrap(),
                // A body gets another mesh, or its own again.
                (16..=17, Some(some)) => {
                    let body = &mut known[some];
                    let (mut triangles, flat) = sheet(2 + random.below(5));
                    triangles.truncate(1 + random.below(2 * triangles.len() as u32) as usize);
                    if random.below(4) == 0 {
                        triangles.rotate_left(1);
                    }
                    let positions = place(&crumpled_near(&mut random, &flat), here);
                    let out_of_range = [[0, 1, positions.len() as u32]];
                    assert!(world.set_mesh(body.id, &out_of_range, &positions).is_err());
                    let bad = vec![[convert(f64::NAN); 3]; positions.len()];
                    assert!(world.set_mesh(body.id, &triangles, &bad).is_err());
                    world.set_mesh(body.id, &triangles, &positions).unwrap();
                    (body.triangles, body.flat, body.positions) = (triangles, flat, positions);
                }
                (8, Some(some)) => {
                    let (membership, mask) = (1 << random.below(3), 7 ^ (1 << random.below(3)));
                    (known[some].membership, known[some].mask) = (membership, mask);
                    world.set_filter(known[some].id, membership, mask).unwrap();
                }
                (18, Some(some)) => {
                    known[some].environment = random.below(3);
                    let (id, environment) = (known[some].id, known[some].environment);
                    world.set_environment(id, environment).unwrap();
                }
                (9, Some(some)) => {
                    let other = random.below(known.len() as u32) as usize;
                    let pair = (known[some].id, known[other].id);
                    if ignored.contains(&pair) {
                        world.unignore(pair.1, pair.0).unwrap();
                        ignored.retain(|&(a, b)| (a, b) != pair && (b, a) != pair);
                    } else {
                        // The two may be the same body.
                        world.ignore(pair.0, pair.1).unwrap();
                        ignored.push(pair);
                    }
                }
                (10, Some(some)) => {
                    let loose = (random.below(2) == 0)
                        .then_some(([convert(-0.5 - shift); 3], [convert(4.0 + shift); 3]));
                    world.set_loose_box(known[some].id, loose).unwrap();
                }
                // Refused calls change nothing.
                (11, Some(some)) => {
                    let Known { id, flat, .. } = &known[some];
                    let id = *id;
                    let mut bad = place(&crumpled_near(&mut random, flat), here);
                    let vertex = random.below(bad.len() as u32) as usize;
                    bad[vertex][1] = convert(
                        [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][random.below(3) as usize],
                    );
                    assert!(world.set_positions(id, &bad).is_err());
                    assert!(
                        world
                            .write_positions(id, |buffer| buffer[1..].fill([convert(0.0); 3]))
                            .is_err()
                    );
                    assert!(world.set_positions(id, &place(flat, here)[1..]).is_err());
                    assert!(world.add(&[[0, 1, 99_999]], &place(flat, here)).is_err());
                    assert!(
                        world
                            .set_loose_box(
                                id,
                                Some((
                                    [convert(50.0 + 2.0 * shift); 3],
                                    [convert(51.0 + 2.0 * shift); 3]
                                ))
                            )
                            .is_err()
                    );
                }
                (12, Some(some)) => {
                    // A query of one body leaves the others as they were.
                    world
                        .intersections(Selection::Within(known[some].id))
                        .prepare()
                        .unwrap();
                    world.triangles_of(Selection::Within(known[some].id));
                }
                (_, Some(_)) => world.intersections(Selection::World).prepare().unwrap(),
            }
            if random.below(3) > 0 && !known.is_empty() {
                let two = [(); 2].map(|()| random.below(known.len() as u32) as usize);
                assert_fresh(&mut world, &known, &ignored, two, &format!("seed {seed}"));
            }
        }
    }
}

#[test]
fn a_world_that_lives_answers_like_one_built_fresh_f32() {
    check_lives::<f32>(0..40, 0.0, |x| x as f32);
    check_lives::<f32>(40..60, 100.0, |x| x as f32);
}

#[test]
fn a_world_that_lives_answers_like_one_built_fresh_f64() {
    check_lives::<f64>(60..80, 0.0, |x| x);
    check_lives::<f64>(80..120, 1e7, |x| x);
}

/// Boxes that were made relative to one origin are not valid relative to another.
#[test]
fn f64_boxes_follow_the_origin() {
    let at = |s: f64, t: f64| {
        [
            [s, 0.0, -t],
            [s + 1.0, 0.0, t],
            [s + 1.0, 1.0, t],
            [s, 1.0, -t],
        ]
    };
    let square = [[0, 1, 2], [0, 2, 3]];
    let mut world = World::new();
    let still = world.add(&square, &at(1e7, 0.0)).unwrap();
    let moving = world.add(&square, &at(0.0, 1.0)).unwrap();
    world.triangles_of(Selection::Within(still));
    for _ in 0..2 {
        world.set_positions(moving, &at(1e7, 1.0)).unwrap();
    }
    assert_eq!(
        world.intersections(Selection::World).all().unwrap().len(),
        4
    );
    world.validate().unwrap();
}

#[test]
fn a_body_that_did_not_move_costs_nothing() {
    let (triangles, positions) = sheet(20);
    for options in covering_configurations() {
        let mut world = World::with_options(options);
        let tilted: Vec<_> = positions
            .iter()
            .map(|[x, y, _]| [*x, *y, x - 0.45])
            .collect();
        let still = world.add(&triangles, &positions).unwrap();
        let moving = world.add(&triangles, &tilted).unwrap();
        assert!(
            !world
                .intersections(Selection::World)
                .all()
                .unwrap()
                .is_empty()
        );

        world.intersections(Selection::World).all().unwrap();
        let none = *world.statistics();
        assert_eq!(
            (
                none.boxes_bottom_up,
                none.boxes_top_down,
                none.triangle_boxes
            ),
            (0, 0, 0),
            "{options:?}"
        );

        for (body, positions) in [(still, &positions), (moving, &tilted)] {
            world.set_positions(body, positions).unwrap();
        }
        world.intersections(Selection::World).all().unwrap();
        let both = *world.statistics();

        world.set_positions(moving, &tilted).unwrap();
        world.intersections(Selection::World).all().unwrap();
        let one = *world.statistics();
        let boxes = |s: pliant::Statistics| s.boxes_bottom_up + s.boxes_top_down + s.triangle_boxes;
        assert!(boxes(one) > 0 && boxes(one) < boxes(both), "{options:?}");

        // Boxes that `prepare` makes early are not made again, and are counted.
        world.set_positions(moving, &tilted).unwrap();
        world.intersections(Selection::World).prepare().unwrap();
        world
            .intersections(Selection::Between(still, moving))
            .prepare()
            .unwrap();
        world.intersections(Selection::World).all().unwrap();
        assert_eq!(*world.statistics(), one, "{options:?}");
    }
}

/// Every situation in which boxes may be stale, by name, one after another.
#[expect(clippy::too_many_lines, reason = "one paragraph a name")]
fn check_by_name<S: Scalar>(convert: fn(f32) -> S) {
    // Sheets that cross: one flat, the others on edge, at different places along it.
    let (triangles, flat) = sheet(5);
    let on_edge = |x: f32| -> Vec<[S; 3]> {
        let upright = |&[u, v, _]: &[f32; 3]| [x + v / 8.0, u, v - 0.4].map(convert);
        flat.iter().map(upright).collect()
    };
    // A sheet folded over, so that it meets itself, and crosses the flat one.
    let folded: Vec<[S; 3]> = flat
        .iter()
        .map(|&[u, v, _]| {
            [
                0.3 - (u - 0.5).abs() / 2.0,
                v,
                0.1 - u / 4.0 + (u - 0.5).abs() / 3.0,
            ]
            .map(convert)
        })
        .collect();
    let flat: Vec<[S; 3]> = flat.iter().map(|p| p.map(convert)).collect();
    // 29 has no factor in common with the number of values of any choice, so each value occurs.
    for options in every_configuration().into_iter().step_by(29) {
        let mut world = World::with_options(options);
        let mut known: Vec<Known<S>> = [flat.clone(), on_edge(0.2), on_edge(0.7), on_edge(5.0)]
            .into_iter()
            .map(|positions| Known {
                id: world.add(&triangles, &positions).unwrap(),
                triangles: triangles.clone(),
                flat: Vec::new(),
                positions,
                membership: u32::MAX,
                mask: u32::MAX,
                environment: 0,
            })
            .collect();
        let check = |world: &mut World<S>, known: &[Known<S>], when| {
            assert_fresh(world, known, &[], [0, 1], when);
        };
        check(&mut world, &known, "two queries without movement between");

        known[1].positions = on_edge(0.45);
        world
            .set_positions(known[1].id, &known[1].positions)
            .unwrap();
        check(&mut world, &known, "movement of one body only");

        world.set_positions(known[2].id, &on_edge(9.0)).unwrap();
        known[2].positions.clone_from(&folded);
        world.set_positions(known[2].id, &folded).unwrap();
        check(&mut world, &known, "a body moved twice before a query");

        // There and back, with no question in between, or a question about another body.
        world.set_positions(known[0].id, &on_edge(9.0)).unwrap();
        world.triangles_of(Selection::Within(known[2].id));
        world.set_positions(known[0].id, &flat).unwrap();
        check(&mut world, &known, "a body that came back");

        let around = [-1.0, 2.0].map(|x| [convert(x); 3]);
        for place in [0, 1] {
            world
                .set_loose_box(known[place].id, Some(around.into()))
                .unwrap();
        }
        check(&mut world, &known, "loose boxes");
        known[1].positions = on_edge(0.1);
        world
            .set_positions(known[1].id, &known[1].positions)
            .unwrap();
        check(&mut world, &known, "movement in a loose box");
        assert!(world.set_positions(known[1].id, &on_edge(5.0)).is_err());
        check(&mut world, &known, "movement out of a loose box, refused");
        known[1].positions = on_edge(5.0);
        world.set_loose_box(known[1].id, None).unwrap();
        world
            .set_positions(known[1].id, &known[1].positions)
            .unwrap();
        check(&mut world, &known, "no loose box any more");

        // Each of these takes pairs away or gives them back: earlier results must not be kept.
        let count =
            |world: &mut World<S>| world.intersections(Selection::World).all().unwrap().len();
        let all = count(&mut world);
        (known[2].membership, known[0].mask) = (2, 1);
        world.set_filter(known[2].id, 2, u32::MAX).unwrap();
        world.set_filter(known[0].id, u32::MAX, 1).unwrap();
        check(&mut world, &known, "filters");
        assert!(count(&mut world) < all, "filters");
        known[0].mask = 2;
        (known[1].membership, known[3].membership) = (2, 2);
        for place in [1, 3] {
            world.set_filter(known[place].id, 2, u32::MAX).unwrap();
        }
        world.set_filter(known[0].id, u32::MAX, 2).unwrap();
        check(&mut world, &known, "filters that let through again");
        assert_eq!(count(&mut world), all, "filters that let through again");
        let two = (known[2].id, known[0].id);
        world.ignore(two.0, two.1).unwrap();
        assert_fresh(&mut world, &known, &[two], [2, 0], "ignored");
        assert!(count(&mut world) < all, "ignored");
        world.unignore(two.1, two.0).unwrap();
        check(&mut world, &known, "not ignored any more");
        assert_eq!(count(&mut world), all, "not ignored any more");

        // The last body takes the place of one that goes.
        let gone = known.remove(0).id;
        world.remove(gone).unwrap();
        check(&mut world, &known, "queries after removal");
        assert!(world.intersections(Selection::Within(gone)).all().is_err());
        known[2].positions.clone_from(&folded);
        world.set_positions(known[2].id, &folded).unwrap();
        check(&mut world, &known, "movement after removal");
        world.rebuild(known[2].id).unwrap();
        check(&mut world, &known, "rebuilt");
        let id = world.add(&triangles, &flat).unwrap();
        assert_ne!(id, gone);
        known.push(Known {
            id,
            positions: flat.clone(),
            membership: u32::MAX,
            ..known[2].clone()
        });
        check(&mut world, &known, "added after removal");
    }
}

#[test]
fn every_way_to_be_stale_that_has_a_name() {
    check_by_name::<f32>(|x| x);
    check_by_name::<f64>(f64::from);
}
