//! No sequence of calls gives an answer for old positions: worlds that live are compared with worlds built fresh.

mod common;

use common::{Lcg, every_configuration, sheet};
use pliant::{BodyId, Options, Pair, World};

/// What a test knows of a body: enough to build it anew.
#[derive(Clone)]
struct Known {
    id: BodyId,
    triangles: Vec<[u32; 3]>,
    positions: Vec<[f32; 3]>,
    membership: u32,
    mask: u32,
    loose: Option<([f32; 3], [f32; 3])>,
}

/// The pairs of a world that was never anything else, with the ids of the one that lives.
fn fresh_pairs(options: Options, known: &[Known], ignored: &[(BodyId, BodyId)]) -> Vec<Pair> {
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
fn crumpled(random: &mut Lcg, flat: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let shift = [(); 3].map(|()| random.unit() * 2.0);
    flat.iter()
        .map(|place| std::array::from_fn(|axis| place[axis] + shift[axis] + random.unit() * 0.3))
        .collect()
}

#[test]
#[expect(clippy::too_many_lines, reason = "one arm a call of the library")]
fn a_world_that_lives_answers_like_one_built_fresh() {
    let configurations = every_configuration();
    for seed in 0..60 {
        let mut random = Lcg(seed);
        let options = configurations[random.below(configurations.len() as u32) as usize];
        let (triangles, flat) = sheet(3 + random.below(4));
        let mut world = World::with_options(options);
        let mut known: Vec<Known> = Vec::new();
        let mut ignored = Vec::new();
        for _ in 0..60 {
            let some = (!known.is_empty()).then(|| random.below(known.len() as u32) as usize);
            match (random.below(14), some) {
                (0..=1, _) | (_, None) => {
                    let positions = crumpled(&mut random, &flat);
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
                        loose: None,
                    });
                }
                (2, Some(some)) => {
                    let removed = known.remove(some).id;
                    world.remove(removed).unwrap();
                    assert!(
                        world.set_positions(removed, &flat).is_err(),
                        "a removed id is refused"
                    );
                }
                // One body moves, perhaps twice.
                (3..=6, Some(some)) => {
                    for _ in 0..=random.below(2) {
                        let positions = crumpled(&mut random, &flat);
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
                    let loose = (random.below(2) == 0).then_some(([-0.5; 3], [4.0; 3]));
                    known[some].loose = loose;
                    world.set_loose_box(known[some].id, loose).unwrap();
                }
                // Refused calls change nothing.
                (11, Some(some)) => {
                    let id = known[some].id;
                    let mut bad = crumpled(&mut random, &flat);
                    let vertex = random.below(bad.len() as u32) as usize;
                    bad[vertex][1] =
                        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][random.below(3) as usize];
                    assert!(world.set_positions(id, &bad).is_err());
                    assert!(
                        world
                            .write_positions(id, |buffer| buffer[1..].fill([0.0; 3]))
                            .is_err()
                    );
                    assert!(world.set_positions(id, &flat[1..]).is_err());
                    assert!(world.add(&[[0, 1, 99_999]], &flat).is_err());
                    assert!(
                        world
                            .set_loose_box(id, Some(([50.0; 3], [51.0; 3])))
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
