//! Every configuration gives the pairs of the plain reference: the heart of the suite.
//!
//! Each configuration is asked every query at every step. Every pair of values of two choices is
//! tried, in few configurations; with `THOROUGH=1` all configurations are. Each scene is a test of
//! its own in either precision, so that two cores have work to the end.

use crate::common::{
    CHOICES, Motion, TrianglesOf, covering, covering_configurations, covers_every_pair,
    every_configuration, share, sheet, widened, world_of,
};
use pliant::{ErrorKind, Options, Pair, Scalar, Selection, World, reference};
use pliant_scenes::thin;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Pairs of one frame by the reference: of every two bodies, and of each with itself.
struct Truth {
    between: Vec<Vec<[u32; 2]>>,
    itself: Vec<Vec<[u32; 2]>>,
}

fn pairs_of_bodies(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |a| (a + 1..count).map(move |b| (a, b)))
}

fn truth(bodies: &[Motion], frame: usize) -> Truth {
    let between = pairs_of_bodies(bodies.len())
        .map(|(a, b)| {
            let (a, b) = (&bodies[a], &bodies[b]);
            reference::intersection_pairs(
                &a.triangles,
                &a.frames[frame],
                &b.triangles,
                &b.frames[frame],
            )
            .unwrap()
        })
        .collect();
    let itself = bodies
        .iter()
        .map(|body| {
            reference::self_intersection_pairs(&body.triangles, &body.frames[frame]).unwrap()
        })
        .collect();
    Truth { between, itself }
}

/// Plays all frames in one world and compares every query with the reference.
fn check<S: Scalar>(
    options: Options,
    bodies: &[Motion],
    truths: &[Truth],
    convert: impl Fn(&[[f32; 3]]) -> Vec<[S; 3]>,
) {
    let start: Vec<_> = bodies
        .iter()
        .map(|body| (&body.triangles[..], convert(&body.frames[0])))
        .collect();
    let (mut world, ids) = world_of(options, &start);
    for (frame, truth) in truths.iter().enumerate() {
        for (body, &id) in bodies.iter().zip(&ids) {
            world
                .set_positions(id, &convert(&body.frames[frame]))
                .unwrap();
        }
        if frame % 2 == 1 {
            world.intersections(Selection::World).prepare().unwrap();
        }

        let mut expected = Vec::new();
        for ((a, b), pairs) in pairs_of_bodies(ids.len()).zip(&truth.between) {
            let pair = |&[triangle_a, triangle_b]: &[u32; 2]| Pair {
                body_a: ids[a],
                triangle_a,
                body_b: ids[b],
                triangle_b,
            };
            expected.extend(pairs.iter().map(pair));
        }
        expected.sort();
        check_world(&mut world, &expected);

        for ((a, b), pairs) in pairs_of_bodies(ids.len()).zip(&truth.between) {
            assert_eq!(
                &world.triangles_of(Selection::Between(ids[a], ids[b])),
                pairs,
                "{options:?}"
            );
            let first = world.first_of(Selection::Between(ids[b], ids[a]));
            assert_eq!(first.is_some(), !pairs.is_empty());
            assert!(first.is_none_or(|[of_b, of_a]| pairs.contains(&[of_a, of_b])));
        }
        for (pairs, &id) in truth.itself.iter().zip(&ids) {
            assert_eq!(
                &world.triangles_of(Selection::Within(id)),
                pairs,
                "{options:?}"
            );
            assert_eq!(world.statistics().pairs, pairs.len() as u64);
            let first = world.first_of(Selection::Within(id));
            assert_eq!(first.is_some(), !pairs.is_empty());
            assert!(first.is_none_or(|pair| pairs.contains(&pair)));
        }
        world.validate().unwrap();
    }
}

fn check_world<S: Scalar>(world: &mut World<S>, expected: &[Pair]) {
    assert_eq!(
        world.intersections(Selection::World).all().unwrap(),
        expected
    );
    assert_eq!(world.statistics().pairs, expected.len() as u64);
    assert!(world.statistics().candidate_pairs >= expected.len() as u64);
    let first = world.intersections(Selection::World).first().unwrap();
    assert_eq!(first.is_some(), !expected.is_empty());
    assert!(first.is_none_or(|pair| expected.contains(&pair)));
    // With each body against itself: the same pairs and these, in one sorted list.
    let mut everything = expected.to_vec();
    for id in world.bodies().collect::<Vec<_>>() {
        let within = world.intersections(Selection::Within(id)).all().unwrap();
        everything.extend_from_slice(within);
    }
    everything.sort_unstable();
    let found = world.intersections(Selection::Everything).all().unwrap();
    assert!(found == everything);
    let first = world.intersections(Selection::Everything).first().unwrap();
    assert_eq!(first.is_some(), !everything.is_empty());
    assert!(first.is_none_or(|pair| everything.contains(&pair)));
    // A visitor sees each pair once, and the visit stops when it says so.
    let mut seen = Vec::new();
    let flow = world.intersections(Selection::World).visit(|pair| {
        seen.push(pair);
        if seen.len() == 3 {
            ControlFlow::Break(pair)
        } else {
            ControlFlow::Continue(())
        }
    });
    assert_eq!(seen.len(), expected.len().min(3));
    assert_eq!(flow.unwrap().break_value(), seen.get(2).copied());
    // A list of exactly the limit is returned, and a longer one is refused.
    let results = [expected.len(), expected.len().saturating_sub(1)].map(|hits| {
        let query = world.intersections(Selection::World).at_most(hits);
        query.all().map(<[_]>::len)
    });
    assert_eq!(results[0], Ok(expected.len()));
    if let Some(limit) = expected.len().checked_sub(1) {
        let refused = results[1].as_ref().unwrap_err();
        assert_eq!(refused.kind, ErrorKind::TooManyHits { limit });
    }
    assert!(seen.iter().all(|pair| expected.contains(pair)));
}

fn check_all<S: Scalar>(bodies: &[Motion], convert: fn(&[[f32; 3]]) -> Vec<[S; 3]>) {
    let frames = bodies[0].frames.len();
    let truths: Vec<_> = (0..frames).map(|frame| truth(bodies, frame)).collect();
    for options in covering_configurations() {
        check(options, bodies, &truths, convert);
    }
}

/// Triangle soup over few places, with shared, touching, coplanar, repeated and degenerate
/// triangles.
fn soup(frames: usize) -> impl Strategy<Value = Motion> {
    (3_u32..20, 1_usize..40, 1_i16..9).prop_flat_map(move |(vertices, triangles, range)| {
        let place = prop::array::uniform3((-range..=range).prop_map(f32::from));
        let frame = prop::collection::vec(place, vertices as usize);
        let triangle = prop::array::uniform3(0..vertices);
        (
            prop::collection::vec(triangle, triangles),
            prop::collection::vec(frame, frames),
        )
            .prop_map(|(triangles, frames)| Motion { triangles, frames })
    })
}

/// A sheet in general position, crumpled anew in every frame.
fn crumpled(frames: usize) -> impl Strategy<Value = Motion> {
    (2_u32..7).prop_flat_map(move |side| {
        let (triangles, flat) = sheet(side);
        let place = prop::array::uniform3(-0.4_f32..0.4);
        let frame = prop::collection::vec(place, flat.len()).prop_map(move |moves| {
            let moved = moves
                .iter()
                .zip(&flat)
                .map(|(by, place)| std::array::from_fn(|axis| place[axis] + by[axis]));
            moved.collect::<Vec<[f32; 3]>>()
        });
        prop::collection::vec(frame, frames).prop_map(move |frames| Motion {
            triangles: triangles.clone(),
            frames,
        })
    })
}

proptest! {
    // Each case is a few dozen worlds.
    #![proptest_config(ProptestConfig { cases: share(24, 2) as u32, ..ProptestConfig::default() })]

    #[test]
    fn soups_f32(bodies in prop::collection::vec(soup(3), 1..4)) {
        check_all::<f32>(&bodies, <[_]>::to_vec);
    }

    #[test]
    fn soups_f64(bodies in prop::collection::vec(soup(3), 1..4)) {
        check_all::<f64>(&bodies, widened);
    }

    #[test]
    fn crumpled_sheets_f32(bodies in prop::collection::vec(crumpled(3), 1..4)) {
        check_all::<f32>(&bodies, <[_]>::to_vec);
    }

    #[test]
    fn crumpled_sheets_f64(bodies in prop::collection::vec(crumpled(3), 1..4)) {
        check_all::<f64>(&bodies, widened);
    }
}

/// A scene with several levels at every degree, from far apart to deep within each other.
fn scene(name: &str, triangles: usize, steps: [u32; 3]) -> Vec<Motion> {
    let seed = pliant_scenes::Scene::DEFAULT_SEED;
    let scene = pliant_scenes::Scene::new(name, Some(triangles), seed).unwrap();
    let mut positions = Vec::new();
    let bodies = (0..scene.body_count()).map(|body| {
        let mut frame = |step| {
            scene.positions(body, step, &mut positions);
            positions.clone()
        };
        Motion {
            triangles: scene.triangles(body).to_vec(),
            frames: steps.iter().map(|&step| frame(step)).collect(),
        }
    });
    bodies.collect()
}

#[test]
fn spheres_f32() {
    check_all::<f32>(&scene("spheres", 320, [40, 90, 200]), <[_]>::to_vec);
}

#[test]
fn spheres_f64() {
    check_all::<f64>(&scene("spheres", 320, [40, 90, 200]), widened);
}

#[test]
fn cloth_f32() {
    check_all::<f32>(&scene("cloth", 648, [10, 35, 50]), <[_]>::to_vec);
}

#[test]
fn cloth_f64() {
    check_all::<f64>(&scene("cloth", 648, [10, 35, 50]), widened);
}

/// Fans, strips and tubes of long thin triangles, and a sheet of good ones, turned in every frame.
fn thin_bodies() -> Vec<Motion> {
    let bodies = [
        thin::fan(120),
        thin::strip(120),
        thin::tube(60),
        thin::waves(8),
    ];
    let moved = |(number, (triangles, positions)): (u32, thin::Mesh)| {
        let angle = |frame| 0.4 + f64::from(number) * 0.7 + f64::from(frame) * 0.3;
        let frames = (0..3).map(|frame| thin::turned(&positions, angle(frame)));
        Motion {
            triangles,
            frames: frames.collect(),
        }
    };
    (0..).zip(bodies).map(moved).collect()
}

#[test]
fn thin_triangles_f32() {
    check_all::<f32>(&thin_bodies(), <[_]>::to_vec);
}

#[test]
fn thin_triangles_f64() {
    check_all::<f64>(&thin_bodies(), widened);
}

#[test]
fn every_pair_of_values_is_tried() {
    let chosen = covering(&CHOICES);
    assert!(covers_every_pair(&CHOICES, &chosen));
    // The two largest choices have 24 pairs of values, the lower bound. One configuration less does
    // not cover.
    assert!((24..=30).contains(&chosen.len()), "{}", chosen.len());
    assert!(!covers_every_pair(&CHOICES, &chosen[1..]));
    // In the list of all, no configuration occurs twice.
    let every: BTreeSet<String> = every_configuration()
        .iter()
        .map(|options| format!("{options:?}"))
        .collect();
    assert_eq!(every.len(), 3 * 4 * 4 * 6 * 2);
}
