//! No sequence of calls gives an answer for old positions: worlds that live are compared with worlds built fresh.

mod common;

use common::{Lcg, every_configuration, sheet};
use pliant::{BodyId, Options, Pair, Scalar, World};

/// What a test knows of a body: enough to build it anew.
#[derive(Clone)]
struct Known<S> {
    id: BodyId,
    triangles: Vec<[u32; 3]>,
    positions: Vec<[S; 3]>,
    membership: u32,
    mask: u32,
}

/// The pairs of a world that was never anything else, with the ids of the one that lives.
fn fresh_pairs<S: Scalar>(
    options: Options,
    known: &[Known<S>],
    ignored: &[(BodyId, BodyId)],
) -> Vec<Pair> {
    let mut world = World::with_options(options);
    for body in known {
        let id = world.add(&body.triangles, &body.positions).unwrap();
        world.set_filter(id, body.membership, body.mask).unwrap();
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
    let known_id = |id: BodyId| known[id.0 as usize].id;
    let pairs = world.intersection_pairs().iter();
    pairs
        .map(|pair| Pair {
            body_a: known_id(pair.body_a),
            body_b: known_id(pair.body_b),
            ..*pair
        })
        .collect()
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
        // Now and then everything is far away, and comes back: in f64 the origin of the boxes follows.
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
            match (random.below(15), some) {
                (13, _) => here = if here == 0.0 { shift } else { 0.0 },
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
                        positions,
                        membership: all,
                        mask: all,
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
                        let positions = place(&crumpled_near(&mut random, &flat), here);
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
                (8, Some(some)) => {
                    let (membership, mask) = (1 << random.below(3), 7 ^ (1 << random.below(3)));
                    (known[some].membership, known[some].mask) = (membership, mask);
                    world.set_filter(known[some].id, membership, mask).unwrap();
                }
                (9, Some(some)) => {
                    let other = random.below(known.len() as u32) as usize;
                    let pair = (known[some].id, known[other].id);
                    if ignored.contains(&pair) {
                        world.unignore(pair.1, pair.0).unwrap();
                        ignored.retain(|&(a, b)| (a, b) != pair && (b, a) != pair);
                    } else {
                        assert_eq!(world.ignore(pair.0, pair.1).is_err(), some == other);
                        ignored.extend((some != other).then_some(pair));
                    }
                }
                (10, Some(some)) => {
                    let loose = (random.below(2) == 0)
                        .then_some(([convert(-0.5 - shift); 3], [convert(4.0 + shift); 3]));
                    world.set_loose_box(known[some].id, loose).unwrap();
                }
                // Refused calls change nothing.
                (11, Some(some)) => {
                    let id = known[some].id;
                    let mut bad = place(&crumpled_near(&mut random, &flat), here);
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
                    assert!(world.set_positions(id, &place(&flat, here)[1..]).is_err());
                    assert!(world.add(&[[0, 1, 99_999]], &place(&flat, here)).is_err());
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
                    world.update_body(known[some].id).unwrap();
                    world.self_intersection_pairs(known[some].id).unwrap();
                }
                (_, Some(_)) => world.update(),
            }
            if random.below(3) > 0 {
                let expected = fresh_pairs(options, &known, &ignored);
                assert_eq!(
                    world.intersection_pairs(),
                    expected,
                    "seed {seed}, {options:?}"
                );
                assert_eq!(
                    world.intersection_pairs(),
                    expected,
                    "again, without movement"
                );
                world.validate().unwrap();
            }
        }
    }
}

#[test]
fn a_world_that_lives_answers_like_one_built_fresh() {
    check_lives::<f32>(0..40, 0.0, |x| x as f32);
    check_lives::<f32>(40..60, 100.0, |x| x as f32);
    check_lives::<f64>(60..80, 0.0, |x| x);
    check_lives::<f64>(80..120, 1e7, |x| x);
}

/// Boxes that were made relative to one origin are not true relative to another.
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
    world.self_intersection_pairs(still).unwrap();
    for _ in 0..2 {
        world.set_positions(moving, &at(1e7, 1.0)).unwrap();
    }
    assert_eq!(world.intersection_pairs().len(), 4);
    world.validate().unwrap();
}

#[test]
fn a_body_that_did_not_move_costs_nothing() {
    let (triangles, positions) = sheet(20);
    for options in every_configuration() {
        let mut world = World::with_options(options);
        let tilted: Vec<_> = positions
            .iter()
            .map(|[x, y, _]| [*x, *y, x - 0.45])
            .collect();
        let still = world.add(&triangles, &positions).unwrap();
        let moving = world.add(&triangles, &tilted).unwrap();
        assert!(!world.intersection_pairs().is_empty());
        let both = *world.statistics();

        world.intersection_pairs();
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

        world.set_positions(moving, &tilted).unwrap();
        world.intersection_pairs();
        let one = *world.statistics();
        let boxes = |s: pliant::Statistics| s.boxes_bottom_up + s.boxes_top_down + s.triangle_boxes;
        assert!(boxes(one) > 0 && boxes(one) < boxes(both), "{options:?}");

        // What `update` does early is not done again, and is accounted for.
        world.set_positions(moving, &tilted).unwrap();
        world.update();
        world.update_body(still).unwrap();
        world.intersection_pairs();
        assert_eq!(*world.statistics(), one, "{options:?}");
    }
}
