//! Every kind of query in the registry, tested without knowing any of them.
//!
//! Lists are the same in every configuration, on one thread and several, in a world with a history
//! and in a fresh one. First hits and visited hits are in the lists. Bad questions are refused.

use crate::common::covering_configurations;
use crate::common::kinds::{AnyKind, Wanted, every_kind};
use pliant::{BodyId, ErrorKind, Options, Scalar, Selection, World};
use pliant_scenes::Scene;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// The margin and distance of all questions.
const LENGTH: f64 = 1.0 / 128.0;

/// The end of every motion, as a part of the way to the next step.
const PART: f32 = 1.0 / 16.0;

/// The positions of all bodies at one step.
type Shapes<S> = Vec<Vec<[S; 3]>>;

/// The shapes of a scene at some steps, and for each the shapes at the end of its motion.
///
/// Two neighbouring vertices of the first body have changed places, so triangles there are folded.
fn steps<S>(scene: &Scene, steps: &[u32], of: fn(f32) -> S) -> Vec<[Shapes<S>; 2]> {
    let at = |step: u32| -> Shapes<f32> {
        let mut shapes = vec![Vec::new(); scene.body_count()];
        for (body, shape) in shapes.iter_mut().enumerate() {
            scene.positions(body, step, shape);
        }
        let [a, b, _] = scene.triangles(0)[0].map(|vertex| vertex as usize);
        shapes[0].swap(a, b);
        shapes
    };
    let all: Vec<_> = steps.iter().map(|&step| at(step)).collect();
    let next = all.iter().cycle().skip(1);
    let shape = |shape: &Vec<[f32; 3]>| shape.iter().map(|p| p.map(of)).collect();
    let step = |(now, next): (&Shapes<f32>, &Shapes<f32>)| {
        let mut end = now.clone();
        let points = end.iter_mut().flatten().zip(next.iter().flatten());
        for (x, to) in points.flat_map(|(p, to)| p.iter_mut().zip(to)) {
            *x += PART * (to - *x);
        }
        [now, &end].map(|shapes| shapes.iter().map(shape).collect())
    };
    all.iter().zip(next).map(step).collect()
}

/// The bodies of a scene, in these shapes.
fn world_of<S: Scalar>(
    scene: &Scene,
    options: Options,
    shapes: &Shapes<S>,
) -> (World<S>, Vec<BodyId>) {
    let mut world = World::with_options(options);
    let bodies = shapes.iter().enumerate();
    let add = |(body, shape): (usize, &Vec<_>)| world.add(scene.triangles(body), shape).unwrap();
    let ids = bodies.map(add).collect();
    (world, ids)
}

/// Sets the motion of all bodies, or of the first alone, so that the others stand still.
fn set_motions<S: Scalar>(world: &mut World<S>, ids: &[BodyId], ends: &Shapes<S>, all: bool) {
    let count = if all { ids.len() } else { 1 };
    for (&id, end) in ids.iter().zip(ends).take(count) {
        world.set_motion(id, end).unwrap();
    }
}

/// Lists of every kind, as text.
fn lists<S: Scalar>(
    kinds: &[AnyKind<S>],
    world: &mut World<S>,
    of: &[Selection],
) -> Vec<Vec<String>> {
    let mut list = |kind: &AnyKind<S>, of| kind.texts(world, (of, LENGTH), Wanted::All).unwrap();
    let pairs = kinds
        .iter()
        .flat_map(|kind| of.iter().map(move |&of| (kind, of)));
    pairs.map(|(kind, of)| list(kind, of)).collect()
}

fn check<S: Scalar>(scene: &Scene, at: &[u32], of: fn(f32) -> S) {
    let kinds = every_kind::<S>();
    let steps = steps(scene, at, of);
    let selections = |ids: &[BodyId]| match *ids {
        [a, .., b] => vec![Selection::Everything, Selection::Between(b, a)],
        [a] => vec![Selection::Everything, Selection::Within(a)],
        [] => vec![],
    };
    let expected = steps.iter().enumerate().map(|(step, [shapes, ends])| {
        let (mut fresh, ids) = world_of(scene, Options::default(), shapes);
        set_motions(&mut fresh, &ids, ends, step % 2 == 0);
        lists(&kinds, &mut fresh, &selections(&ids))
    });
    let expected: Vec<_> = expected.collect();
    let of_one = selections(&world_of(scene, Options::default(), &steps[0][0]).1);
    for (place, kind) in kinds.iter().enumerate() {
        let lists = expected.iter().map(|all| &all[place * of_one.len()]);
        assert!(
            lists.into_iter().any(|list| !list.is_empty()),
            "{}",
            kind.name
        );
    }
    for (number, mut options) in covering_configurations().into_iter().enumerate() {
        options.threads = NonZeroUsize::new([1, 3][number % 2]).unwrap();
        let (mut world, ids) = world_of(scene, options, &steps[0][0]);
        for (step, [shapes, ends]) in steps.iter().enumerate() {
            for (&id, shape) in ids.iter().zip(shapes) {
                world.set_positions(id, shape).unwrap();
            }
            set_motions(&mut world, &ids, ends, step % 2 == 0);
            let mut expected = expected[step].iter();
            for kind in &kinds {
                for &of in &of_one {
                    let expected = expected.next().unwrap();
                    let what = || format!("{} of {of:?}, step {step}, {options:?}", kind.name);
                    let of = (of, LENGTH);
                    // Some boxes are made before, and the order of the four ways differs.
                    let mut wanted = [Wanted::First, Wanted::Prepare, Wanted::Visit, Wanted::All];
                    wanted.rotate_left((number + step) % 4);
                    for wanted in wanted {
                        let mut found = kind.texts(&mut world, of, wanted).unwrap();
                        let is_right = match wanted {
                            Wanted::All => found == *expected,
                            Wanted::First => match &found[..] {
                                [first] => expected.contains(first),
                                none => none.is_empty() && expected.is_empty(),
                            },
                            Wanted::Visit => {
                                let mut expected = expected.clone();
                                found.sort_unstable();
                                expected.sort_unstable();
                                found == expected
                            }
                            Wanted::Prepare => found.is_empty(),
                        };
                        assert!(is_right, "{wanted:?} of {}", what());
                    }
                }
            }
        }
        world.validate().unwrap();
    }
}

fn scene(name: &str, triangles: usize) -> Scene {
    Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap()
}

#[test]
fn lists_of_two_bodies_are_the_same_however_and_whenever_they_are_asked_for() {
    check::<f32>(&scene("spheres", 320), &[90, 200, 40], |x| x);
}

#[test]
fn lists_of_many_bodies_are_the_same_however_and_whenever_they_are_asked_for() {
    check::<f64>(&scene("gather", 20), &[200, 135], f64::from);
}

#[test]
fn lists_of_one_body_are_the_same_however_and_whenever_they_are_asked_for() {
    check::<f32>(&scene("cloth", 288), &[10, 50, 35], |x| x);
}

#[test]
fn every_kind_refuses_what_is_no_question() {
    let mut world = World::<f64>::new();
    let ids = [0.0, 1.0].map(|z| {
        let corners = [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        world.add(&[[0, 1, 2]], &corners).unwrap()
    });
    let [a, gone] = ids;
    world.remove(gone).unwrap();
    for kind in every_kind::<f64>() {
        for wanted in [Wanted::All, Wanted::First, Wanted::Visit, Wanted::Prepare] {
            let mut refusal = |of, length| {
                let answer = kind.texts(&mut world, (of, length), wanted);
                answer.err().map(|error| error.kind)
            };
            let name = kind.name;
            let same = refusal(Selection::Between(a, a), 0.5);
            assert_eq!(same, Some(ErrorKind::SameBody), "{name}");
            for of in [Selection::Within(gone), Selection::Between(a, gone)] {
                let nobody = refusal(of, 0.5);
                assert_eq!(nobody, Some(ErrorKind::NoSuchBody), "{name}");
            }
            for length in [-1.0, f64::INFINITY, f64::NAN] {
                let is_refused = refusal(Selection::World, length).is_some();
                assert_eq!(is_refused, kind.takes_length, "{name} within {length}");
            }
        }
    }
}

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let inside = |path: PathBuf| {
        if path.is_dir() {
            files(&path)
        } else {
            vec![path]
        }
    };
    paths.flat_map(inside).collect()
}

#[test]
fn every_method_that_asks_for_hits_is_listed() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/world");
    let mut methods = Vec::new();
    for text in files(&source)
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
    {
        for function in text.split("pub fn ").skip(1) {
            let (name, rest) = function.split_once('(').unwrap();
            let head = rest.split_once('{').unwrap().0;
            if head.contains("-> Query<") {
                methods.push(name.to_owned());
            }
        }
    }
    let mut listed: Vec<_> = every_kind::<f32>().iter().map(|kind| kind.name).collect();
    methods.sort_unstable();
    listed.sort_unstable();
    assert_eq!(methods, listed);
}
