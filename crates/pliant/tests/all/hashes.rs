//! Committed hashes of every answer on each scene, the same for every choice that must not matter.
//!
//! The lists are sorted pairs; candidates, near each other and on the way; close pairs, distances
//! and impacts, with all figures. Closest points are in the order of the points. A pair that
//! changes is noticed, be it on purpose, in another configuration or on another machine. A new
//! choice, such as a number of threads or an instruction set, is one more line in `axes`.

use crate::common::{TrianglesOf, combinations, covering, covers_every_pair, is_thorough};
use pliant::{
    BodyId, BroadPhase, Degree, InsideRule, Instructions, Options, Partition, Scalar, Selection,
    Update, World, reference,
};
use pliant_oracle::subnormals_flushed;
use pliant_scenes::{Asks, Scene};
use std::fmt::Debug;
use std::num::{NonZeroU32, NonZeroUsize};

/// Scene, triangles a body, steps, hash over the pairs of all these steps, and number of pairs.
const COMMITTED: [(&str, usize, &[u32], u64, usize); 5] = [
    ("spheres", 320, &[40, 90, 200], 0x87a1_37e6_0c71_9b8d, 406),
    ("crowd", 80, &[1, 100, 200], 0x97ee_0d4f_548d_5c48, 146),
    ("arms", 80, &[1, 100, 200], 0xdeff_8926_bad2_518a, 188),
    ("gather", 80, &[1, 135, 200], 0x417e_9085_24c3_a036, 3455),
    ("cloth", 648, &[10, 35, 50], 0x6717_87db_787a_24d6, 675),
];

/// Hash and number of candidates, at each step of [`COMMITTED`] and on the way to the next.
const NEAR: [(&str, u64, usize); 5] = [
    ("spheres", 0x1ed0_a3e5_438d_9473, 4340),
    ("crowd", 0xdb8d_f352_4d2f_c04d, 2351),
    ("arms", 0x55c0_e0ca_74e4_f0b8, 7739),
    ("gather", 0xba1b_8cf6_a022_31eb, 35_378),
    ("cloth", 0xbdca_73b3_a372_aebc, 14_851),
];

/// Hash and number of close pairs at each step of [`COMMITTED`], and hash over figures.
///
/// Figures describe the close pairs, or are distances of bodies.
const CLOSE: [(&str, (u64, usize, u64)); 5] = [
    (
        "spheres",
        (0x8b1f_19e5_81f1_a584, 709, 0xf9cb_335b_ac5c_5036),
    ),
    ("crowd", (0x4d0c_8806_a155_ff5a, 266, 0x84f9_bb76_92cf_3605)),
    ("arms", (0x02be_fe74_4aed_b3cf, 309, 0x94b3_429d_4d03_52bb)),
    (
        "gather",
        (0xe313_0e7b_eec6_0772, 4946, 0x1e04_3bd0_ba90_0331),
    ),
    (
        "cloth",
        (0xbf77_d0fe_876c_fbec, 4418, 0xc579_0c36_9c16_7499),
    ),
];

/// Hash and number of impacts on the way from each step of [`COMMITTED`] to the next.
///
/// The hash includes their times, and how far everything may go.
const MEET: [(&str, u64, usize); 5] = [
    ("spheres", 0x3e8d_9f30_a3f9_238c, 229),
    ("crowd", 0x2699_b706_3327_26f1, 54),
    ("arms", 0xdec8_b3e9_1017_2297, 83),
    ("gather", 0xcd59_bed8_3da8_83c7, 3093),
    ("cloth", 0x316e_7e60_cb8e_6042, 167),
];

/// Hash and number of closest points at each step of [`COMMITTED`], with all figures.
///
/// The hash includes winding numbers and depths in closed bodies, and what is contained.
const POINTS: [(&str, u64, usize); 5] = [
    ("spheres", 0x8cc8_c59d_0880_31c5, 657),
    ("crowd", 0xae1f_33da_f56a_6b50, 132),
    ("arms", 0x9b7f_9619_3b15_f84a, 129),
    ("gather", 0x25c0_b225_4853_ca70, 141),
    ("cloth", 0xf15d_1281_380f_cc5f, 1083),
];

/// The distance of close pairs.
const DISTANCE: f64 = 1.0 / 64.0;

/// The number of bodies after the first whose distances from it are asked for.
const OTHERS: usize = 6;

/// The margin round each element.
const RADIUS: f64 = 1.0 / 128.0;
/// The end of motions for candidates, as a part of the way to the next step.
const PART: f32 = 1.0 / 64.0;
/// The end of motions for impacts, as a part of the way to the next step.
const LONGER_PART: f32 = 1.0 / 16.0;

/// One combination of choices.
#[derive(Clone, Default)]
struct Case {
    options: Options,
    doubles: bool,
    /// Whether the calling thread flushes subnormal numbers.
    flushed: bool,
    /// Instructions of the kernels; if `None`, the widest that pay.
    instructions: Option<Instructions>,
    name: String,
}

type Change = (&'static str, fn(&mut Case));

fn instructions(case: &mut Case, instructions: Instructions, doubles: bool) {
    (case.instructions, case.doubles) = (Some(instructions), doubles);
}

/// All values of each choice.
///
/// Every two values of two choices are tried together; if tests are thorough, every combination.
fn axes() -> Vec<Vec<Change>> {
    vec![
        vec![
            ("degree 2", |c| c.options.degree = Degree::Two),
            ("degree 4", |c| c.options.degree = Degree::Four),
            ("degree 8", |c| c.options.degree = Degree::Eight),
        ],
        vec![
            ("centre", |c| c.options.partition = Partition::Centre),
            ("mean", |c| c.options.partition = Partition::Mean),
            ("balanced", |c| c.options.partition = Partition::Balanced),
            ("connectivity", |c| {
                c.options.partition = Partition::Connectivity;
            }),
        ],
        vec![
            ("bottom-up", |c| c.options.update = Update::BottomUp),
            ("top-down", |c| c.options.update = Update::TopDown),
            ("hybrid", |c| c.options.update = Update::HYBRID),
            ("hybrid 1, 2 at once", |c| c.options.update = hybrid(1, 2)),
        ],
        vec![
            ("1 a leaf", |c| c.options.leaf_size = NonZeroU32::MIN),
            ("8 a leaf", |c| c.options.leaf_size = number(8)),
            ("11 a leaf", |c| c.options.leaf_size = number(11)),
        ],
        vec![
            ("f32", |c| c.doubles = false),
            ("f64", |c| c.doubles = true),
        ],
    ]
}

/// Choices that are independent of the others, each tried once.
const ALONE: [Change; 14] = [
    ("2 threads, f32", |c| c.options.threads = threads(2)),
    ("7 threads, f32", |c| c.options.threads = threads(7)),
    ("7 threads, f64", |c| {
        (c.options.threads, c.doubles) = (threads(7), true);
    }),
    ("7 threads, bottom-up", |c| {
        (c.options.threads, c.options.update) = (threads(7), Update::BottomUp);
    }),
    ("7 threads, paper", |c| {
        c.options = Options::paper();
        c.options.threads = threads(7);
    }),
    ("baseline, f32", |c| {
        instructions(c, Instructions::baseline(), false);
    }),
    ("baseline, f64", |c| {
        instructions(c, Instructions::baseline(), true);
    }),
    ("widest, f32", |c| {
        instructions(c, Instructions::widest(), false);
    }),
    ("widest, f64", |c| {
        instructions(c, Instructions::widest(), true);
    }),
    ("brute force", |c| {
        c.options.broad_phase = BroadPhase::BruteForce;
    }),
    ("sweep and prune", |c| {
        c.options.broad_phase = BroadPhase::SweepAndPrune;
    }),
    ("a tree of bodies", |c| {
        c.options.broad_phase = BroadPhase::Tree;
    }),
    ("flushed, f32", |c| c.flushed = true),
    ("flushed, f64", |c| {
        (c.flushed, c.doubles) = (true, true);
    }),
];

fn number(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).unwrap()
}

fn threads(n: usize) -> NonZeroUsize {
    NonZeroUsize::new(n).unwrap()
}

fn hybrid(level: u32, at_once: u32) -> Update {
    Update::Hybrid {
        level: Some(level),
        levels_at_once: number(at_once),
    }
}

/// Number of values of each choice.
fn sizes() -> Vec<usize> {
    axes().iter().map(Vec::len).collect()
}

/// Cases of these combinations, and a case for each choice that is tried alone.
fn cases(combinations: &[Vec<usize>]) -> Vec<Case> {
    let changed = |mut case: Case, (name, change): &Change| {
        change(&mut case);
        case.name = format!("{} {name}", case.name);
        case
    };
    let axes = axes();
    let together = combinations.iter().map(|ways| {
        let chosen = axes.iter().zip(ways).map(|(axis, &way)| &axis[way]);
        chosen.fold(Case::default(), changed)
    });
    let alone = ALONE.iter().map(|change| changed(Case::default(), change));
    together.chain(alone).collect()
}

/// FNV-1a hash, 64 bits, over the bytes of each number, the lowest byte first.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn add(&mut self, numbers: &[u32]) {
        for byte in numbers.iter().flat_map(|number| number.to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds the bits of figures.
    fn add_figures(&mut self, figures: &[f64]) {
        for bits in figures.iter().map(|figure| figure.to_bits()) {
            self.add(&[bits as u32, (bits >> 32) as u32]);
        }
    }
}

/// Positions of all bodies at one step; all bodies have the same triangles.
type Shapes = Vec<Vec<[f32; 3]>>;

fn shapes(scene: &Scene, step: u32) -> Shapes {
    (0..scene.body_count())
        .map(|body| {
            let mut positions = Vec::new();
            scene.positions(body, step, &mut positions);
            positions
        })
        .collect()
}

fn widened<S>(positions: &[[f32; 3]], widen: fn(f32) -> S) -> Vec<[S; 3]> {
    positions.iter().map(|p| p.map(widen)).collect()
}

/// A world of a scene's bodies in their first shape, in which trees are built and bodies meet.
fn world_of<S: Scalar>(
    case: &Case,
    scene: &Scene,
    first: &Shapes,
    widen: fn(f32) -> S,
) -> (World<S>, Vec<BodyId>) {
    let mut world = World::with_options(case.options);
    if let Some(instructions) = case.instructions {
        world.use_instructions(instructions);
    }
    let add = |(body, positions): (usize, &Vec<[f32; 3]>)| {
        let positions = widened(positions, widen);
        world.add(scene.triangles(body), &positions).unwrap()
    };
    let bodies = first.iter().enumerate().map(add).collect();
    (world, bodies)
}

/// Gives all bodies their shapes.
fn set_all<S: Scalar>(
    world: &mut World<S>,
    bodies: &[BodyId],
    shapes: &Shapes,
    widen: fn(f32) -> S,
) {
    for (&body, positions) in bodies.iter().zip(shapes) {
        let positions = widened(positions, widen);
        world.set_positions(body, &positions).unwrap();
    }
}

/// Shapes on the way from one step to another.
fn toward(from: &Shapes, to: &Shapes, part: f32) -> Shapes {
    let point = |(from, to): (&[f32; 3], &[f32; 3])| {
        std::array::from_fn(|axis| from[axis] + part * (to[axis] - from[axis]))
    };
    let body = |(from, to): (&Vec<_>, &Vec<_>)| from.iter().zip(to).map(point).collect();
    from.iter().zip(to).map(body).collect()
}

/// Hash and number of candidates at all steps and on the way to the next. `widen` is exact.
fn near_hash<S: Scalar>(
    case: &Case,
    scene: &Scene,
    steps: &[Shapes],
    widen: fn(f32) -> S,
) -> (u64, usize) {
    let (mut world, bodies) = world_of(case, scene, &steps[0], widen);
    let (mut fnv, mut count) = (Fnv::default(), 0);
    for (step, shapes) in steps.iter().enumerate() {
        set_all(&mut world, &bodies, shapes, widen);
        let next = &steps[(step + 1) % steps.len()];
        for on_the_way in [false, true] {
            if on_the_way {
                for (&body, end) in bodies.iter().zip(&toward(shapes, next, PART)) {
                    world.set_motion(body, &widened(end, widen)).unwrap();
                }
            }
            let radius = if on_the_way { 0.0 } else { RADIUS };
            let everything = Selection::Everything;
            let near = world.vertex_triangle_candidates(everything, radius);
            for row in near.all().unwrap() {
                fnv.add(&<[u32; 4]>::from(*row));
                count += 1;
            }
            let near = world.edge_edge_candidates(everything, radius);
            for row in near.all().unwrap() {
                fnv.add(&<[u32; 4]>::from(*row));
                count += 1;
            }
        }
    }
    (fnv.0, count)
}

/// Hashes and number of close pairs with figures, and of distances. `widen` is exact.
///
/// Pairs are close in the present shape, whatever motion a body has. Distances are rounded to
/// 2^-20, because any of several triangles that are about equally near may be found.
fn close_hash<S: Scalar>(
    case: &Case,
    scene: &Scene,
    steps: &[Shapes],
    widen: fn(f32) -> S,
) -> (u64, usize, u64) {
    let (mut world, bodies) = world_of(case, scene, &steps[0], widen);
    let (mut pairs, mut count, mut figures) = (Fnv::default(), 0, Fnv::default());
    let everything = Selection::Everything;
    for (step, shapes) in steps.iter().enumerate() {
        set_all(&mut world, &bodies, shapes, widen);
        if step == 1 {
            let end = toward(shapes, &steps[0], PART);
            world
                .set_motion(bodies[0], &widened(&end[0], widen))
                .unwrap();
        }
        let close = world.close_vertex_triangle_pairs(everything, DISTANCE);
        for close in close.all().unwrap() {
            pairs.add(&<[u32; 4]>::from(close.pair));
            figures.add_figures(&[close.distance]);
            figures.add_figures(&close.direction.unwrap_or_default());
            figures.add_figures(&close.barycentric);
            count += 1;
        }
        let close = world.close_edge_edge_pairs(everything, DISTANCE);
        for close in close.all().unwrap() {
            pairs.add(&<[u32; 4]>::from(close.pair));
            figures.add_figures(&[close.distance]);
            figures.add_figures(&close.direction.unwrap_or_default());
            figures.add_figures(&close.barycentric_a);
            figures.add_figures(&close.barycentric_b);
            count += 1;
        }
        let close = world.close_triangle_pairs(everything, DISTANCE);
        for close in close.all().unwrap() {
            pairs.add(&<[u32; 4]>::from(close.pair));
            figures.add_figures(&[close.distance]);
            figures.add_figures(&close.direction.unwrap_or_default());
            figures.add_figures(&close.barycentric_a);
            figures.add_figures(&close.barycentric_b);
            figures.add_figures(&close.point_a);
            figures.add_figures(&close.point_b);
            count += 1;
        }
        let rounded = |distance: f64| (distance * f64::from(1 << 20)).round();
        for &other in bodies.iter().skip(1).take(OTHERS) {
            let distance = world.distance(bodies[0], other, f64::INFINITY);
            let nearest = distance.unwrap().expect("nothing is further apart");
            figures.add_figures(&[rounded(nearest.distance)]);
        }
        let nearest = world.nearest_body(bodies[0], 8.0 * DISTANCE).unwrap();
        figures.add_figures(&[nearest.map_or(-1.0, |nearest| rounded(nearest.distance))]);
    }
    (pairs.0, count, figures.0)
}

/// Hash and number of impacts with times to the last bit, and of free steps. `widen` is exact.
fn meet_hash<S: Scalar>(
    case: &Case,
    scene: &Scene,
    steps: &[Shapes],
    widen: fn(f32) -> S,
) -> (u64, usize) {
    let (mut world, bodies) = world_of(case, scene, &steps[0], widen);
    let (mut fnv, mut count) = (Fnv::default(), 0);
    let everything = Selection::Everything;
    for (step, shapes) in steps.iter().enumerate() {
        let end = toward(shapes, &steps[(step + 1) % steps.len()], LONGER_PART);
        for ((&body, positions), end) in bodies.iter().zip(shapes).zip(&end) {
            world
                .set_positions(body, &widened(positions, widen))
                .unwrap();
            world.set_motion(body, &widened(end, widen)).unwrap();
        }
        for impact in world.vertex_triangle_impacts(everything).all().unwrap() {
            fnv.add(&<[u32; 4]>::from(impact.pair));
            fnv.add_figures(&[impact.low, impact.high]);
            count += 1;
        }
        for impact in world.edge_edge_impacts(everything).all().unwrap() {
            fnv.add(&<[u32; 4]>::from(impact.pair));
            fnv.add_figures(&[impact.low, impact.high]);
            count += 1;
        }
        let first = world.first_impact(everything, 0.0).unwrap();
        fnv.add_figures(&first.map_or([2.0; 2], |first| [first.low(), first.high()]));
        fnv.add_figures(&[world.collision_free_step(everything, 0.0).unwrap()]);
    }
    (fnv.0, count)
}

/// Hash and number of closest points of all steps. `widen` is exact.
///
/// The points are vertices of the first body, a part of the way to the next step.
fn points_hash<S: Scalar>(
    case: &Case,
    scene: &Scene,
    steps: &[Shapes],
    widen: fn(f32) -> S,
) -> (u64, usize) {
    let (mut world, bodies) = world_of(case, scene, &steps[0], widen);
    let (mut fnv, mut count) = (Fnv::default(), 0);
    let far = 16.0 * DISTANCE;
    for (step, shapes) in steps.iter().enumerate() {
        set_all(&mut world, &bodies, shapes, widen);
        let end = toward(shapes, &steps[(step + 1) % steps.len()], LONGER_PART);
        let points = widened(&end[0], widen);
        let mut found = world.closest_points(&points, None, far).unwrap();
        for &other in bodies.iter().skip(1).take(OTHERS) {
            if !world.watertight(other).unwrap().is_closed() {
                found.extend(world.closest_points(&points, Some(other), far).unwrap());
                continue;
            }
            found.extend(world.signed_closest_points(&points, other, far).unwrap());
            let windings = world
                .points_inside(&points, other, InsideRule::NonZero)
                .unwrap();
            for located in windings {
                fnv.add(&[located.winding.cast_unsigned(), located.side as u32]);
            }
            let depth = world.depth(bodies[0], other).unwrap();
            fnv.add_figures(&depth.of_vertices);
            fnv.add_figures(&[depth.at_most]);
        }
        for closest in found.into_iter().flatten() {
            let feature = u8::from(closest.feature).into();
            fnv.add(&[closest.body.0, closest.triangle, feature]);
            fnv.add_figures(&[closest.distance]);
            fnv.add_figures(&closest.point);
            fnv.add_figures(&closest.barycentric);
            fnv.add_figures(&closest.direction.unwrap_or_default());
            count += 1;
        }
        let contained = world.contained(Selection::World).unwrap();
        for it in contained.all {
            fnv.add(&[it.body.0, it.component, it.inside.0]);
        }
    }
    (fnv.0, count)
}

/// Hash and number of pairs of all steps. `widen` is exact.
fn hash<S: Scalar>(
    case: &Case,
    scene: &Scene,
    steps: &[Shapes],
    widen: fn(f32) -> S,
) -> (u64, usize) {
    let (mut world, bodies) = world_of(case, scene, &steps[0], widen);
    let (mut fnv, mut count) = (Fnv::default(), 0);
    for (step, shapes) in steps.iter().enumerate() {
        set_all(&mut world, &bodies, shapes, widen);
        fnv.add(&[step as u32]);
        match scene.asks() {
            Asks::BetweenBodies => {
                for pair in world.intersections(Selection::World).all().unwrap() {
                    fnv.add(&[
                        pair.body_a.0,
                        pair.triangle_a,
                        pair.body_b.0,
                        pair.triangle_b,
                    ]);
                    count += 1;
                }
            }
            Asks::Itself => {
                for pair in world.triangles_of(Selection::Within(bodies[0])) {
                    fnv.add(&pair);
                    count += 1;
                }
            }
        }
    }
    (fnv.0, count)
}

/// Asks in every case that is tried, and compares with the committed values.
fn are_the_committed_ones<T: PartialEq + Debug + Send>(
    name: &str,
    committed: &T,
    narrow: impl Fn(&Case, &Scene, &[Shapes]) -> T + Sync,
    wide: impl Fn(&Case, &Scene, &[Shapes]) -> T + Sync,
) {
    let of_scene = COMMITTED.iter().find(|scene| scene.0 == name);
    let &(_, triangles, steps, ..) = of_scene.unwrap();
    let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
    let steps: Vec<Shapes> = steps.iter().map(|&step| shapes(&scene, step)).collect();
    let tried = if is_thorough() {
        combinations(&sizes())
    } else {
        covering(&sizes())
    };
    for case in cases(&tried) {
        let ask = || {
            if case.doubles {
                wide(&case, &scene, &steps)
            } else {
                narrow(&case, &scene, &steps)
            }
        };
        let found = if case.flushed {
            // Where a thread cannot be made to flush, an ordinary thread is used.
            subnormals_flushed(ask).unwrap_or_else(ask)
        } else {
            ask()
        };
        assert!(found == *committed, "{name},{}: {found:#x?}", case.name);
    }
}

/// Declares one test a scene against committed values, so that all cores have work to the end.
macro_rules! of_each_scene {
    ($($test:ident: $committed:ident, $hash:ident;)*) => {
        $(of_each_scene! { $test: $committed, $hash; spheres crowd arms gather cloth })*
    };
    ($test:ident: $committed:ident, $hash:ident; $($scene:ident)*) => {
        mod $test {
            $(#[test]
            fn $scene() {
                let name = stringify!($scene);
                let committed = super::$committed(name);
                super::are_the_committed_ones(
                    name,
                    &committed,
                    |case, scene, steps| super::$hash(case, scene, steps, |x| x),
                    |case, scene, steps| super::$hash(case, scene, steps, f64::from),
                );
            })*

            #[test]
            fn every_scene_has_a_test() {
                let names = super::COMMITTED.map(|scene| scene.0);
                assert_eq!(names, [$(stringify!($scene)),*]);
            }
        }
    };
}

of_each_scene! {
    pairs_are_the_committed_ones: committed_pairs, hash;
    what_is_near_is_the_committed: committed_near, near_hash;
    what_is_close_is_the_committed_with_all_figures: committed_close, close_hash;
    what_meets_is_the_committed: committed_meeting, meet_hash;
    points_find_the_committed: committed_points, points_hash;
}

fn committed_pairs(name: &str) -> (u64, usize) {
    let scene = COMMITTED.iter().find(|scene| scene.0 == name).unwrap();
    (scene.3, scene.4)
}

fn committed_near(name: &str) -> (u64, usize) {
    let scene = NEAR.iter().find(|scene| scene.0 == name).unwrap();
    (scene.1, scene.2)
}

fn committed_close(name: &str) -> (u64, usize, u64) {
    CLOSE.iter().find(|scene| scene.0 == name).unwrap().1
}

fn committed_meeting(name: &str) -> (u64, usize) {
    let scene = MEET.iter().find(|scene| scene.0 == name).unwrap();
    (scene.1, scene.2)
}

fn committed_points(name: &str) -> (u64, usize) {
    let scene = POINTS.iter().find(|scene| scene.0 == name).unwrap();
    (scene.1, scene.2)
}

/// The reference, which uses no tree; scenes of many bodies take too long for it.
#[test]
fn the_committed_pairs_are_those_of_the_reference() {
    for (name, triangles, steps, hash_committed, count_committed) in COMMITTED {
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
        if scene.body_count() > 2 {
            continue;
        }
        let (mut fnv, mut count) = (Fnv::default(), 0);
        for (step, &number) in steps.iter().enumerate() {
            let shapes = shapes(&scene, number);
            fnv.add(&[step as u32]);
            if scene.asks() == Asks::BetweenBodies {
                let [a, b] = [0, 1].map(|body| (scene.triangles(body), &shapes[body][..]));
                for [i, j] in reference::intersection_pairs(a.0, a.1, b.0, b.1).unwrap() {
                    fnv.add(&[0, i, 1, j]);
                    count += 1;
                }
            } else {
                let triangles = scene.triangles(0);
                for pair in reference::self_intersection_pairs(triangles, &shapes[0]).unwrap() {
                    fnv.add(&pair);
                    count += 1;
                }
            }
        }
        assert_eq!((fnv.0, count), (hash_committed, count_committed), "{name}");
    }
}

#[test]
fn the_committed_candidates_are_those_of_the_reference() {
    for (name, hash_committed, count_committed) in NEAR {
        let of_scene = COMMITTED.iter().find(|scene| scene.0 == name);
        let &(_, triangles, steps, ..) = of_scene.unwrap();
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
        if scene.body_count() > 2 {
            continue;
        }
        let steps: Vec<Shapes> = steps.iter().map(|&step| shapes(&scene, step)).collect();
        let (mut fnv, mut count) = (Fnv::default(), 0);
        for (step, shapes) in steps.iter().enumerate() {
            let ends = toward(shapes, &steps[(step + 1) % steps.len()], PART);
            for (ends, radius) in [(None, RADIUS), (Some(&ends), 0.0)] {
                let bodies: Vec<_> = (0..shapes.len())
                    .map(|body| reference::Moving {
                        end: ends.map(|ends| &ends[body][..]),
                        ..reference::Moving::at(scene.triangles(body), &shapes[body])
                    })
                    .collect();
                let mut rows: [Vec<[u32; 4]>; 2] = Default::default();
                for (a, body) in (0..).zip(&bodies) {
                    let near = [
                        reference::self_vertex_triangle_pairs(body, radius),
                        reference::self_edge_edge_pairs(body, radius),
                    ];
                    for (rows, near) in rows.iter_mut().zip(near) {
                        rows.extend(near.unwrap().into_iter().map(|[i, j]| [a, i, a, j]));
                    }
                    for (b, other) in (0..).zip(&bodies).filter(|&(b, _)| a != b) {
                        let near = reference::vertex_triangle_pairs(body, other, radius);
                        rows[0].extend(near.unwrap().into_iter().map(|[i, j]| [a, i, b, j]));
                        if a < b {
                            let near = reference::edge_edge_pairs(body, other, radius);
                            rows[1].extend(near.unwrap().into_iter().map(|[i, j]| [a, i, b, j]));
                        }
                    }
                }
                for mut rows in rows {
                    rows.sort_unstable();
                    count += rows.len();
                    rows.iter().for_each(|row| fnv.add(row));
                }
            }
        }
        assert_eq!((fnv.0, count), (hash_committed, count_committed), "{name}");
    }
}

#[test]
fn the_committed_close_pairs_are_those_of_the_reference() {
    for (name, (hash_committed, count_committed, _)) in CLOSE {
        let of_scene = COMMITTED.iter().find(|scene| scene.0 == name);
        let &(_, triangles, steps, ..) = of_scene.unwrap();
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
        if scene.body_count() > 2 {
            continue;
        }
        let (mut fnv, mut count) = (Fnv::default(), 0);
        for &step in steps {
            let shapes = shapes(&scene, step);
            let bodies: Vec<_> = (0..shapes.len())
                .map(|body| reference::Moving::at(scene.triangles(body), &shapes[body]))
                .collect();
            let mut rows: [Vec<[u32; 4]>; 3] = Default::default();
            let mut add = |kind: usize, [a, b]: [u32; 2], pairs: Vec<[u32; 2]>| {
                rows[kind].extend(pairs.into_iter().map(|[i, j]| [a, i, b, j]));
            };
            for (a, body) in (0..).zip(&bodies) {
                let close = reference::self_close_vertex_triangle_pairs(body, DISTANCE);
                add(0, [a, a], close.unwrap());
                let close = reference::self_close_edge_edge_pairs(body, DISTANCE);
                add(1, [a, a], close.unwrap());
                let (triangles, positions) = (body.triangles, body.positions);
                let close = reference::self_close_triangle_pairs(triangles, positions, DISTANCE);
                add(2, [a, a], close.unwrap());
                for (b, other) in (0..).zip(&bodies).filter(|&(b, _)| a != b) {
                    let close = reference::close_vertex_triangle_pairs(body, other, DISTANCE);
                    add(0, [a, b], close.unwrap());
                    if a < b {
                        let close = reference::close_edge_edge_pairs(body, other, DISTANCE);
                        add(1, [a, b], close.unwrap());
                        let close = reference::close_triangle_pairs(
                            triangles,
                            positions,
                            other.triangles,
                            other.positions,
                            DISTANCE,
                        );
                        add(2, [a, b], close.unwrap());
                    }
                }
            }
            for mut rows in rows {
                rows.sort_unstable();
                count += rows.len();
                rows.iter().for_each(|row| fnv.add(row));
            }
        }
        assert_eq!((fnv.0, count), (hash_committed, count_committed), "{name}");
    }
}

#[test]
fn a_case_is_every_combination() {
    let some = covering(&sizes());
    assert!(covers_every_pair(&sizes(), &some));
    assert_eq!(cases(&some).len(), some.len() + ALONE.len());
    let cases = cases(&combinations(&sizes()));
    assert_eq!(cases.len(), 3 * 4 * 4 * 3 * 2 + ALONE.len());
    let named = |name: &str| cases.iter().filter(|c| c.name.contains(name)).count();
    assert_eq!((named("f64"), named("degree 4")), (148, 96));
    assert!(
        cases
            .iter()
            .all(|case| case.doubles == case.name.ends_with("f64"))
    );
}
