//! Brute force, the sweep, and peers that are compiled, against the library's reference.
//!
//! The reference has no tree and no box, and decides by exact signs.

use pliant::reference;
use pliant_bench::decision;
use pliant_bench::method::{Counters, Method, Pair};
use pliant_bench::methods::{BruteForce, Sweep};
#[cfg(feature = "peers")]
use pliant_bench::methods::{Obvhs, Parry};
use pliant_bench::motion::{BodyMesh, Shape};
use pliant_scenes::Scene;

fn every_method() -> Vec<Box<dyn Method>> {
    every_method_with(decision::exact)
}

fn every_method_with(decision: decision::Decision) -> Vec<Box<dyn Method>> {
    vec![
        Box::new(BruteForce::new(decision)),
        Box::new(Sweep::new(decision)),
        #[cfg(feature = "peers")]
        Box::new(Parry::new(decision)),
        #[cfg(feature = "peers")]
        Box::new(Obvhs::new(1, decision)),
        #[cfg(feature = "peers")]
        Box::new(Obvhs::new(4, decision)),
        #[cfg(feature = "peers")]
        Box::new(Obvhs::new(20, decision)),
    ]
}

/// Positions of every body.
type Frame = Vec<Vec<[f32; 3]>>;

/// Bodies in motion. Trees are built on the first frame.
struct Play {
    triangles: Vec<Vec<[u32; 3]>>,
    frames: Vec<Frame>,
}

impl Play {
    fn of_scene(name: &str, triangles: usize, steps: &[u32]) -> Self {
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
        let bodies = 0..scene.body_count();
        let place = |body, step| {
            let mut positions = Vec::new();
            scene.positions(body, step, &mut positions);
            positions
        };
        let frame = |&step: &u32| bodies.clone().map(|body| place(body, step)).collect();
        Self {
            frames: steps.iter().map(frame).collect(),
            triangles: bodies
                .clone()
                .map(|body| scene.triangles(body).to_vec())
                .collect(),
        }
    }

    /// Pairs of different bodies, by the reference.
    fn between(&self, frame: &Frame) -> Vec<Pair> {
        let triangles = &self.triangles;
        let mut all = Vec::new();
        for a in 0..frame.len() {
            for b in a + 1..frame.len() {
                let pairs = reference::intersection_pairs(
                    &triangles[a],
                    &frame[a],
                    &triangles[b],
                    &frame[b],
                )
                .unwrap();
                all.extend(pairs.iter().map(|&[i, j]| [a as u32, i, b as u32, j]));
            }
        }
        all.sort_unstable();
        all
    }

    /// Pairs of each body with itself, by the reference.
    fn within(&self, frame: &Frame) -> Vec<Pair> {
        let mut all = Vec::new();
        for (body, positions) in frame.iter().enumerate() {
            let pairs =
                reference::self_intersection_pairs(&self.triangles[body], positions).unwrap();
            all.extend(pairs.iter().map(|&[i, j]| [body as u32, i, body as u32, j]));
        }
        all
    }

    fn build(&self, method: &mut dyn Method) {
        let meshes: Vec<BodyMesh<'_>> = self
            .triangles
            .iter()
            .zip(shapes(&self.frames[0]))
            .map(|(triangles, shape)| BodyMesh { triangles, shape })
            .collect();
        method.build(&meshes);
    }

    /// Plays all frames with every method. Returns the number of pairs between bodies and within
    /// them.
    fn check(&self) -> [usize; 2] {
        let mut methods = every_method();
        for method in &mut methods {
            self.build(&mut **method);
        }
        let mut counts = [0, 0];
        for (number, frame) in self.frames.iter().enumerate() {
            let (between, within) = (self.between(frame), self.within(frame));
            counts[0] += between.len();
            counts[1] += within.len();
            for method in &mut methods {
                let about = format!("{} at frame {number}", method.name());
                method.step(&shapes(frame));
                assert_eq!(method.all_pairs(), between, "{about}");
                let first = method.first_pair();
                assert_eq!(first.is_some(), !between.is_empty(), "{about}");
                assert!(first.is_none_or(|pair| between.contains(&pair)), "{about}");
                assert_eq!(method.self_pairs().unwrap(), within, "{about}");
                assert_eq!(method.all_pairs(), between, "{about}, asked again");
            }
        }
        counts
    }
}

fn shapes(frame: &Frame) -> Vec<Shape<'_>> {
    let shape = |world| Shape {
        world,
        rigid: None,
        end: None,
    };
    frame.iter().map(|positions| shape(positions)).collect()
}

#[test]
fn spheres_that_jump() {
    let play = Play::of_scene("spheres", 320, &[1, 2, 100, 101, 200, 1, 150, 60]);
    let [between, _] = play.check();
    assert!(between > 300, "{between}");
}

#[test]
fn a_crowd() {
    let play = Play::of_scene("crowd", 80, &[1, 40, 200]);
    assert_eq!(play.triangles.len(), 27);
    let [between, _] = play.check();
    assert!(between > 50, "{between}");
}

#[test]
fn a_cloth_with_itself() {
    let play = Play::of_scene("cloth", 648, &[1, 30, 50, 10, 45]);
    let [between, within] = play.check();
    assert_eq!(between, 0);
    assert!(within > 100, "{within}");
}

/// Pseudorandom whole numbers below a bound.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 32) % bound
    }

    /// Triangle soups on a small lattice: coplanar, touching, degenerate and equal triangles
    /// everywhere.
    ///
    /// In the last frame the bodies are far from each other.
    fn soups(&mut self, triangles: u64, side: u64) -> Play {
        let vertices = triangles + 2;
        let mut three = |bound| [(); 3].map(|()| self.below(bound) as u32);
        let mut soup = |count: u64, bound| (0..count).map(|_| three(bound)).collect::<Vec<_>>();
        Play {
            triangles: (0..3).map(|_| soup(triangles, vertices)).collect(),
            frames: [0, 0, 0, 100]
                .map(|distance| {
                    [0, 1, 2].map(|body| {
                        let place = |x| x as f32 - 1.0 + (body * distance) as f32;
                        let points = soup(vertices, side);
                        points.iter().map(|point| point.map(place)).collect()
                    })
                })
                .map(Vec::from)
                .to_vec(),
        }
    }
}

#[test]
fn soups_of_degenerate_and_coplanar_triangles() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut counts = [0, 0];
    for triangles in [1, 2, 3, 4, 5, 9, 30] {
        for side in [1, 2, 5, 40] {
            let of_play = random.soups(triangles, side).check();
            counts[0] += of_play[0];
            counts[1] += of_play[1];
        }
    }
    assert!(counts.iter().all(|&count| count > 1_000), "{counts:?}");
}

#[test]
fn nothing_meets_then_one_triangle_does() {
    let apart = vec![
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        vec![[9.0, 9.0, 9.0], [8.0, 9.0, 9.0], [9.0, 8.0, 9.0]],
    ];
    let mut meeting = apart.clone();
    meeting[1][2] = [0.0, 0.0, 0.0];
    let play = Play {
        triangles: vec![vec![[0, 1, 2]]; 2],
        frames: vec![apart.clone(), meeting, apart],
    };
    assert_eq!(play.check(), [1, 0]);
}

#[test]
fn no_body_and_one_body() {
    for mut method in every_method() {
        method.build(&[]);
        method.step(&[]);
        assert!(method.all_pairs().is_empty());
        assert_eq!(method.first_pair(), None);
        assert_eq!(method.self_pairs(), Some(&[][..]));
    }
    let mut one = Play::of_scene("spheres", 20, &[1, 200]);
    one.triangles.truncate(1);
    for frame in &mut one.frames {
        frame.truncate(1);
    }
    assert_eq!(one.check()[0], 0);
}

#[test]
fn all_decide_the_pairs_of_overlapping_triangle_boxes_and_no_others() {
    let spheres = Play::of_scene("spheres", 320, &[1, 200]);
    let cloth = Play::of_scene("cloth", 648, &[1, 50]);
    let ask_all = |method: &mut dyn Method| drop(method.all_pairs().to_vec());
    let ask_self = |method: &mut dyn Method| drop(method.self_pairs().map(<[Pair]>::to_vec));
    let asks: [(&Play, fn(&mut dyn Method)); 2] = [(&spheres, ask_all), (&cloth, ask_self)];
    for (play, ask) in asks {
        let count = |mut method: Box<dyn Method>| {
            play.build(&mut *method);
            method.step(&shapes(&play.frames[1]));
            ask(&mut *method);
            let counters = method.take_counters();
            assert_eq!(method.take_counters(), Counters::default());
            counters
        };
        let of_methods: Vec<Counters> = every_method().into_iter().map(count).collect();
        let [brute_force, sweep, ..] = of_methods[..] else {
            panic!("both are always there");
        };
        assert!(brute_force.decisions > 100);
        for counters in &of_methods {
            assert_eq!(counters.decisions, brute_force.decisions);
            assert!(counters.boxes > 0);
        }
        assert!(sweep.box_tests < brute_force.box_tests, "{of_methods:?}");
        if let [_, _, _, one_a_leaf, four_a_leaf, _] = of_methods[..] {
            assert!(one_a_leaf.box_tests < sweep.box_tests, "{of_methods:?}");
            assert!(four_a_leaf.boxes * 2 < one_a_leaf.boxes, "{of_methods:?}");
        }
    }
}

#[test]
fn brute_force_is_confined_to_the_overlap_of_the_bodies() {
    let play = Play::of_scene("spheres", 320, &[1, 100]);
    let mut method = BruteForce::new(decision::exact);
    play.build(&mut method);
    method.step(&shapes(&play.frames[1]));
    method.all_pairs();
    let Counters {
        boxes, box_tests, ..
    } = method.take_counters();
    assert_eq!(boxes, 640);
    assert!((1..320 * 320 / 4).contains(&box_tests), "{box_tests}");
}

#[test]
fn the_first_pair_ends_the_search() {
    let play = Play::of_scene("spheres", 320, &[1, 200]);
    for mut method in every_method() {
        play.build(&mut *method);
        method.step(&shapes(&play.frames[1]));
        method.all_pairs();
        let all = method.take_counters().decisions;
        method.first_pair();
        let first = method.take_counters().decisions;
        assert!(first * 3 < all, "{}: {first} of {all}", method.name());
    }
}

#[test]
fn the_decision_is_the_one_given() {
    let play = Play::of_scene("spheres", 320, &[1, 200]);
    let never: decision::Decision = |_, _| false;
    for mut method in every_method_with(never) {
        play.build(&mut *method);
        method.step(&shapes(&play.frames[1]));
        assert!(method.all_pairs().is_empty());
        assert!(method.take_counters().decisions > 0);
    }
}
