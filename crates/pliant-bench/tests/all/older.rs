//! Older methods against the reference: every variant, on scenes, turned and far away, on tiny
//! bodies.

use pliant::{Degree, reference};
use pliant_bench::decision::exact;
use pliant_bench::method::{Counters, Method, Pair};
use pliant_bench::methods::{BucketTree, Frame, Smith, VanDenBergen};
use pliant_bench::motion::{Motion, MotionBody, Placed, Pose, Shape};
use pliant_scenes::Scene;

const DEGREES: [Degree; 3] = [Degree::Two, Degree::Four, Degree::Eight];

fn methods() -> Vec<Box<dyn Method>> {
    let mut all: Vec<Box<dyn Method>> = Vec::new();
    for degree in DEGREES {
        for frame in [Frame::Local, Frame::World] {
            all.push(Box::new(VanDenBergen::new(frame, degree, exact)));
        }
    }
    for depth in [0, 1, 4, 7] {
        for clip in [false, true] {
            all.push(Box::new(Smith::new(depth, clip, exact)));
        }
    }
    for depth in [1, 3, 5] {
        all.push(Box::new(BucketTree::new(depth, exact)));
    }
    all
}

fn shapes(frame: &[Placed]) -> Vec<Shape<'_>> {
    frame.iter().map(Placed::shape).collect()
}

/// Pairs between bodies by the reference: no tree, and no boxes except boxes of whole bodies.
fn pairs_between(motion: &Motion, frame: &[Placed]) -> Vec<Pair> {
    let extent = |body: usize, axis: usize| {
        let values = frame[body].world.iter().map(|position| position[axis]);
        let lo = values.clone().fold(f32::INFINITY, f32::min);
        (lo, values.fold(f32::NEG_INFINITY, f32::max))
    };
    let apart = |a: usize, b: usize| {
        (0..3).any(|axis| {
            let ((a_lo, a_hi), (b_lo, b_hi)) = (extent(a, axis), extent(b, axis));
            a_hi < b_lo || b_hi < a_lo
        })
    };
    let mut pairs = Vec::new();
    for a in 0..frame.len() {
        for b in (a + 1..frame.len()).filter(|&b| !apart(a, b)) {
            let found = reference::intersection_pairs(
                &motion.bodies[a].triangles,
                &frame[a].world,
                &motion.bodies[b].triangles,
                &frame[b].world,
            );
            let rows = found.unwrap().into_iter();
            pairs.extend(rows.map(|[s, t]| [a as u32, s, b as u32, t]));
        }
    }
    pairs.sort_unstable();
    pairs
}

fn pairs_within(motion: &Motion, frame: &[Placed]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (number, (body, placed)) in (0..).zip(motion.bodies.iter().zip(frame)) {
        let found = reference::self_intersection_pairs(&body.triangles, &placed.world).unwrap();
        pairs.extend(found.into_iter().map(|[s, t]| [number, s, number, t]));
    }
    pairs
}

/// Query of a motion.
#[derive(Clone, Copy, PartialEq)]
enum Ask {
    Between,
    Within,
}

/// Plays a motion with every method. Returns the total number of pairs.
fn play(motion: &Motion, ask: Ask) -> usize {
    let mut methods = methods();
    for method in &mut methods {
        method.build(&motion.meshes());
    }
    let mut met = 0;
    for (step, frame) in motion.steps.iter().zip(&motion.frames) {
        let expected = match ask {
            Ask::Between => pairs_between(motion, frame),
            Ask::Within => pairs_within(motion, frame),
        };
        met += expected.len();
        for method in &mut methods {
            let at = format!("{}, {} at step {step}", method.name(), motion.name);
            method.step(&shapes(frame));
            match ask {
                Ask::Between => {
                    assert!(method.all_pairs() == expected, "{at}");
                    match method.first_pair() {
                        Some(pair) => assert!(expected.binary_search(&pair).is_ok(), "{at}"),
                        None => assert!(expected.is_empty(), "{at}"),
                    }
                    assert!(method.all_pairs() == expected, "{at}, again");
                }
                Ask::Within => match method.self_pairs() {
                    Some(pairs) => assert!(pairs == expected, "{at}"),
                    None => assert!(method.name().starts_with("Smith"), "{at}"),
                },
            }
        }
    }
    met
}

fn scene(name: &str, triangles: usize) -> Scene {
    Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap()
}

#[test]
fn scenes_with_jumps() {
    // Forward, back, far, and not at all.
    let steps = [1, 62, 63, 200, 2, 120, 120, 199];
    for (name, triangles) in [
        ("spheres", 320),
        ("crowd", 80),
        ("arms", 80),
        ("gather", 80),
    ] {
        let motion = Motion::of_scene(&scene(name, triangles), steps);
        assert!(
            motion
                .frames
                .iter()
                .flatten()
                .all(|body| body.rigid.is_some())
        );
        assert!(play(&motion, Ask::Between) > 100, "{name}");
    }
}

#[test]
fn bodies_and_themselves() {
    let cloth = Motion::of_scene(&scene("cloth", 800), [1, 40, 50, 3]);
    assert!(play(&cloth, Ask::Within) > 100);
    // No arms reach through their own body here. In one step the vertices are shuffled, so that all
    // is one knot.
    let mut arms = Motion::of_scene(&scene("arms", 80), [5, 180]);
    arms.bodies.truncate(2);
    for frame in &mut arms.frames {
        frame.truncate(2);
    }
    let mut knot = arms.frames[0].clone();
    for body in &mut knot {
        let count = body.world.len();
        let mixed =
            |positions: &[[f32; 3]]| (0..count).map(|i| positions[i * 17 % count]).collect();
        body.world = mixed(&body.world);
        body.rigid = body.rigid.take().map(|(pose, local)| (pose, mixed(&local)));
    }
    arms.frames.push(knot);
    arms.steps.push(0);
    assert!(play(&arms, Ask::Within) > 100);
}

/// Pseudorandom numbers (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number from -1 to 1.
    fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> [f64; 3] {
        std::array::from_fn(|_| size * self.signed())
    }

    /// Rotation matrix of a random quaternion.
    fn rotation(&mut self) -> [[f64; 3]; 3] {
        loop {
            let q: [f64; 4] = std::array::from_fn(|_| self.signed());
            let square: f64 = q.iter().map(|x| x * x).sum();
            if !(0.1..=1.0).contains(&square) {
                continue;
            }
            let [w, x, y, z] = q.map(|x| x / square.sqrt());
            return [
                [
                    1.0 - 2.0 * (y * y + z * z),
                    2.0 * (x * y - w * z),
                    2.0 * (x * z + w * y),
                ],
                [
                    2.0 * (x * y + w * z),
                    1.0 - 2.0 * (x * x + z * z),
                    2.0 * (y * z - w * x),
                ],
                [
                    2.0 * (x * z - w * y),
                    2.0 * (y * z + w * x),
                    1.0 - 2.0 * (x * x + y * y),
                ],
            ];
        }
    }
}

/// Composition of two poses: first `inner`, then `outer`.
fn after(outer: &Pose, inner: &Pose) -> Pose {
    let product = |row: [f64; 3], column: usize| -> f64 {
        (0..3).map(|i| row[i] * inner.rotation[i][column]).sum()
    };
    Pose {
        rotation: outer
            .rotation
            .map(|row| [0, 1, 2].map(|column| product(row, column))),
        translation: outer.place(inner.translation),
    }
}

/// A body whose points in its own frame are `points`, as a scene would round them.
fn placed(pose: Pose, points: &[[f64; 3]]) -> Placed {
    let rounded = |point: [f64; 3]| point.map(|x| x as f32);
    Placed {
        world: points
            .iter()
            .map(|&point| rounded(pose.place(point)))
            .collect(),
        rigid: Some((pose, points.iter().map(|&point| rounded(point)).collect())),
        end: None,
    }
}

/// The whole scene turned and carried away, anew at each step.
fn carried(mut motion: Motion, far: f64, random: &mut Random) -> Motion {
    let mut carry = |frame: &mut [Placed]| {
        let outer = Pose {
            rotation: random.rotation(),
            translation: random.vector(far),
        };
        for body in frame {
            let (pose, local) = body.rigid.take().unwrap();
            let points: Vec<_> = local.iter().map(|point| point.map(f64::from)).collect();
            *body = placed(after(&outer, &pose), &points);
        }
    };
    for frame in &mut motion.frames {
        carry(frame);
    }
    motion.name = format!("{} carried by {far:e}", motion.name);
    motion
}

#[test]
fn turned_and_far_away() {
    let mut random = Random(1);
    for far in [0.0, 1.0, 1e4] {
        for (name, triangles) in [("spheres", 320), ("gather", 80)] {
            let motion = Motion::of_scene(&scene(name, triangles), [1, 70, 200, 140]);
            let motion = carried(motion, far, &mut random);
            assert!(play(&motion, Ask::Between) > 100, "{}", motion.name);
        }
        let arms = Motion::of_scene(&scene("arms", 80), [7]);
        play(&carried(arms, far, &mut random), Ask::Within);
    }
}

fn of_bodies(name: &str, bodies: Vec<(Vec<[u32; 3]>, Placed)>) -> Motion {
    let (triangles, frame): (Vec<_>, Vec<_>) = bodies.into_iter().unzip();
    Motion {
        name: name.to_owned(),
        bodies: triangles
            .into_iter()
            .zip(&frame)
            .map(|(triangles, first)| MotionBody {
                triangles,
                first: first.clone(),
            })
            .collect(),
        steps: vec![1],
        frames: vec![frame],
        events: Vec::new(),
    }
}

#[test]
fn bodies_that_are_hardly_any() {
    let world = |positions: &[[f32; 3]]| Placed {
        world: positions.to_vec(),
        ..Placed::default()
    };
    let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let one = (vec![[0, 1, 2]], world(&corner));
    let point = (vec![[0, 1, 2]], world(&[[0.25, 0.25, 0.0]; 3]));
    let pile = (vec![[0, 1, 2]; 50], world(&corner));
    let far = (vec![[0, 1, 2]], world(&corner.map(|p| p.map(|x| x + 1e4))));
    // Each triangle has vertices of its own, so that the pile meets itself.
    let loose: Vec<[u32; 3]> = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let heap = (loose, world(&corner.repeat(20)));
    let motion = of_bodies("hardly any", vec![one, point, pile, far, heap]);
    // One and point: 1; one and pile: 50; one and heap: 20; and so on.
    assert_eq!(play(&motion, Ask::Between), 1 + 50 + 20 + 50 + 20 + 50 * 20);
    assert_eq!(play(&motion, Ask::Within), 20 * 19 / 2);
}

#[test]
fn a_body_without_a_pose_is_where_it_is() {
    let steps = [1, 100, 200];
    let bare = {
        let mut motion = Motion::of_scene(&scene("spheres", 1_280), steps);
        let all = motion.frames.iter_mut().flatten();
        all.chain(motion.bodies.iter_mut().map(|body| &mut body.first))
            .for_each(|body| body.rigid = None);
        motion
    };
    let mut told = bare.clone();
    let all = told.frames.iter_mut().flatten();
    all.chain(told.bodies.iter_mut().map(|body| &mut body.first))
        .for_each(|body| body.rigid = Some((Pose::IDENTITY, body.world.clone())));

    for degree in DEGREES {
        let run = |frame: Frame, motion: &Motion| -> Vec<(Vec<Pair>, Counters)> {
            let mut method = VanDenBergen::new(frame, degree, exact);
            method.build(&motion.meshes());
            let frames = motion.frames.iter().map(|frame| {
                method.step(&shapes(frame));
                (method.all_pairs().to_vec(), method.take_counters())
            });
            frames.collect()
        };
        assert_eq!(run(Frame::Local, &bare), run(Frame::Local, &told));
        let world = run(Frame::World, &bare);
        assert_eq!(world, run(Frame::World, &told));
        // Six axes of one frame are three: the same trees and tests, except for boxes that touch in
        // the wider margin.
        for ((local_pairs, local), (pairs, work)) in run(Frame::Local, &bare).iter().zip(&world) {
            assert_eq!(local_pairs, pairs);
            assert_eq!(local.boxes, work.boxes);
            let more = local.box_tests - work.box_tests;
            assert!(more <= work.box_tests / 200, "{more} of {}", work.box_tests);
        }
    }
}

/// Counters depend on the trees and the present shape, not on earlier shapes.
#[test]
fn counters_have_no_memory() {
    let motion = Motion::of_scene(&scene("spheres", 1_280), [3, 180, 90, 200]);
    for (mut patient, mut hasty) in methods().into_iter().zip(methods()) {
        patient.build(&motion.meshes());
        hasty.build(&motion.meshes());
        for frame in &motion.frames {
            patient.take_counters();
            patient.step(&shapes(frame));
            patient.all_pairs();
        }
        hasty.step(&shapes(motion.frames.last().unwrap()));
        hasty.all_pairs();
        let (work, same) = (patient.take_counters(), hasty.take_counters());
        assert_eq!(work, same, "{}", patient.name());
        assert!(work.boxes > 0 && work.box_tests > 0 && work.decisions > 0);
        assert_eq!(patient.take_counters(), Counters::default());
    }
}

#[test]
fn a_refit_is_complete() {
    let motion = Motion::of_scene(&scene("spheres", 1_280), [1]);
    let mut method = VanDenBergen::new(Frame::Local, Degree::Two, exact);
    method.build(&motion.meshes());
    method.step(&shapes(&motion.frames[0]));
    assert_eq!(method.take_counters().boxes, 2 * (2 * 1_280 - 1));
}

#[test]
fn the_first_pair_is_found_early() {
    let motion = Motion::of_scene(&scene("spheres", 5_120), [200]);
    for mut method in methods() {
        method.build(&motion.meshes());
        method.step(&shapes(&motion.frames[0]));
        method.take_counters();
        method.all_pairs();
        let all = method.take_counters();
        assert!(method.first_pair().is_some());
        let first = method.take_counters();
        assert!(
            first.decisions < all.decisions / 2 && first.box_tests < all.box_tests,
            "{}: {first:?} of {all:?}",
            method.name()
        );
    }
}

/// Triangles that share one vertex are found, in any frame.
///
/// In the world the vertex is shared to the bit. In the local frames the boxes touch there except
/// for rounding, the most that rounding can do.
#[test]
fn what_touches_is_found_in_any_frame() {
    let mut random = Random(2);
    for case in 0..20_000 {
        let far = [0.0, 1.0, 100.0, 1e4][case % 4];
        let axis = case / 4 % 3;
        let a = Pose {
            rotation: random.rotation(),
            translation: random.vector(far),
        };
        let meeting = a.place(random.vector(1.0)).map(|x| x as f32);
        // Any point that is rounded to it.
        let near_meeting = |random: &mut Random| -> [f64; 3] {
            std::array::from_fn(|axis| {
                let spacing = f64::from(meeting[axis].next_up()) - f64::from(meeting[axis]);
                f64::from(meeting[axis]) + 0.49 * spacing * random.signed()
            })
        };
        // A corner at the meeting point. The other two are on its lower side along `axis` of the
        // frame.
        let corner = |pose: &Pose, sign: f64, random: &mut Random| {
            let at = back(pose, near_meeting(random));
            let other = |random: &mut Random| {
                let mut off = random.vector(1.0);
                off[axis] = -sign * (off[axis].abs() + 0.01);
                std::array::from_fn(|i| at[i] + off[i])
            };
            [at, other(random), other(random)]
        };
        let below = placed(a, &corner(&a, 1.0, &mut random));
        // On the other side a triangle in a parallel frame elsewhere, or a point in any other
        // frame. The boxes of both are as tight in the first frame as in their own.
        let mut b = Pose {
            rotation: a.rotation,
            translation: random.vector(far),
        };
        if case / 12 % 2 == 0 {
            // Both frames far from the origin, but not from each other.
            let near = random.vector(1.0);
            b.translation = std::array::from_fn(|axis| a.translation[axis] + near[axis]);
        }
        let above = if case % 2 == 0 {
            placed(b, &corner(&b, -1.0, &mut random))
        } else {
            b.rotation = random.rotation();
            placed(b, &[back(&b, near_meeting(&mut random)); 3])
        };
        assert_eq!(below.world[0], above.world[0], "they meet in the world");
        for bodies in [[&below, &above], [&above, &below]] {
            let bodies = bodies.map(|body| (vec![[0, 1, 2]], body.clone()));
            let motion = of_bodies("touching", bodies.to_vec());
            let mut method = VanDenBergen::new(Frame::Local, Degree::Two, exact);
            method.build(&motion.meshes());
            method.step(&shapes(&motion.frames[0]));
            assert_eq!(method.all_pairs(), [[0, 0, 1, 0]], "case {case}");
        }
    }
}

/// Local point of a frame at a place in the world.
fn back(pose: &Pose, place: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|column| {
        (0..3)
            .map(|row| pose.rotation[row][column] * (place[row] - pose.translation[row]))
            .sum()
    })
}

/// The margin is for rounding and no more: bodies a ten-thousandth of their size apart are not
/// decided.
#[test]
fn what_is_apart_by_more_than_rounding_is_not_decided() {
    let mut random = Random(3);
    for _ in 0..1_000 {
        let pose = Pose {
            rotation: random.rotation(),
            translation: random.vector(1.0),
        };
        let flat = |x: f64| [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]];
        let body = |x: f64| (vec![[0, 1, 2]], placed(pose, &flat(x)));
        let motion = of_bodies("apart", vec![body(0.0), body(1e-4)]);
        let mut method = VanDenBergen::new(Frame::Local, Degree::Two, exact);
        method.build(&motion.meshes());
        method.step(&shapes(&motion.frames[0]));
        assert!(method.all_pairs().is_empty());
        assert_eq!(method.take_counters().decisions, 0);
    }
}

/// In the first replay the methods learn how much memory they need.
#[test]
fn a_second_replay_allocates_nothing() {
    let motion = Motion::of_scene(&scene("crowd", 320), [1, 150, 40]);
    let frames: Vec<Vec<Shape>> = motion.frames.iter().map(|frame| shapes(frame)).collect();
    for mut method in methods() {
        method.build(&motion.meshes());
        let mut play = || {
            for shapes in &frames {
                method.step(shapes);
                assert!(!method.all_pairs().is_empty());
                assert!(method.first_pair().is_some());
                let _ = method.self_pairs();
            }
        };
        play();
        let allocations = allocation_counter::measure(&mut play);
        assert_eq!(allocations.count_total, 0, "{}", method.name());
    }
}

#[test]
fn names_say_every_parameter() {
    let names: Vec<String> = methods().iter().map(|method| method.name()).collect();
    let mut distinct = names.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), names.len());
    assert_eq!(names[0], "van den Bergen (local frame, binary)");
    assert_eq!(names[5], "van den Bergen (world frame, 8-ary)");
    assert_eq!(names[13], "Smith et al. (depth 7, cells by box, clip)");
    assert_eq!(names[14], "BucketTree (depth 1, by centroid)");
}
