//! Metamorphic tests: changes of the input that must not change an answer; no reference is asked.
//!
//! Changes are the order of bodies, triangles, corners and vertices, and every affine change of the
//! coordinates that is exact. A world is compared with itself, in `f32` and `f64`. Inputs are
//! scenes and triangle soups over few places, with many touching, coplanar, equal and degenerate
//! triangles.

use crate::common::{Lcg, TrianglesOf, is_thorough};
use pliant::{Options, Scalar, Selection, World};
use pliant_oracle::{Class, Random, Triangle, fits_f32};
use pliant_scenes::Scene;
use std::collections::BTreeSet;

/// A body with coordinates that both types hold exactly.
#[derive(Clone)]
struct Body {
    triangles: Vec<[u32; 3]>,
    positions: Vec<[f64; 3]>,
}

/// Pairs of (body, triangle), the smaller one first.
type Pairs = BTreeSet<[(usize, usize); 2]>;

fn pair(mut sides: [(usize, usize); 2]) -> [(usize, usize); 2] {
    sides.sort_unstable();
    sides
}

/// All pairs of all bodies, each body with itself included.
fn pairs<S: Scalar>(options: Options, bodies: &[Body], narrow: impl Fn(f64) -> S) -> Pairs {
    let mut world = World::with_options(options);
    let mut ids = Vec::new();
    for Body {
        triangles,
        positions,
    } in bodies
    {
        let positions: Vec<_> = positions.iter().map(|p| p.map(&narrow)).collect();
        let kept =
            |(p, q): (&[f64; 3], &[S; 3])| p.map(f64::to_bits) == q.map(|x| x.to_f64().to_bits());
        assert!(
            bodies[ids.len()].positions.iter().zip(&positions).all(kept),
            "the change is not exact in this type"
        );
        ids.push(world.add(triangles, &positions).unwrap());
    }
    let number = |id| ids.iter().position(|&other| other == id).unwrap();
    let mut found: Pairs = world
        .intersections(Selection::World)
        .all()
        .unwrap()
        .iter()
        .map(|p| {
            pair([
                (number(p.body_a), p.triangle_a as usize),
                (number(p.body_b), p.triangle_b as usize),
            ])
        })
        .collect();
    for (body, &id) in ids.iter().enumerate() {
        let itself = world.triangles_of(Selection::Within(id));
        found.extend(
            itself
                .iter()
                .map(|p| pair(p.map(|triangle| (body, triangle as usize)))),
        );
    }
    for (a, &id_a) in ids.iter().enumerate() {
        for (b, &id_b) in ids.iter().enumerate() {
            if a != b {
                // By name, in either order, two bodies have the same pairs, no more and no less.
                let between = world.triangles_of(Selection::Between(id_a, id_b));
                let side = |p: &[u32; 2]| pair([(a, p[0] as usize), (b, p[1] as usize)]);
                assert!(between.iter().all(|p| found.contains(&side(p))));
                let of_both = |[p, q]: &&[(usize, usize); 2]| [p.0, q.0] == [a.min(b), a.max(b)];
                assert_eq!(between.len(), found.iter().filter(of_both).count());
            }
        }
    }
    found
}

/// The pairs, which are asserted to be equal in both types and two configurations.
fn answer(bodies: &[Body], in_f32: bool) -> Pairs {
    let expected = pairs(Options::default(), bodies, |x| x);
    assert!(pairs(Options::paper(), bodies, |x| x) == expected);
    if in_f32 {
        assert!(pairs(Options::default(), bodies, |x| x as f32) == expected);
        assert!(pairs(Options::paper(), bodies, |x| x as f32) == expected);
    }
    expected
}

/// The pairs of changed bodies, in either configuration and in either type.
///
/// If not thorough, in two of their four combinations, which change from turn to turn.
fn in_turn(bodies: &[Body], in_f32: bool, turn: usize) -> Pairs {
    if is_thorough() {
        return answer(bodies, in_f32);
    }
    let mut both = [Options::default(), Options::paper()];
    both.rotate_left(turn % 2);
    let expected = pairs(both[0], bodies, |x| x);
    let found = if in_f32 {
        pairs(both[1], bodies, |x| x as f32)
    } else {
        pairs(both[1], bodies, |x| x)
    };
    assert!(found == expected, "{both:?}");
    expected
}

/// The first turn: it differs from bodies to bodies, so that no change always has the same turn.
fn first_turn(bodies: &[Body]) -> usize {
    bodies.iter().map(|body| body.triangles.len()).sum()
}

/// A random permutation of 0, 1, ..., count - 1.
fn shuffled(count: usize, random: &mut Lcg) -> Vec<usize> {
    let mut order: Vec<_> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, random.below(i as u32 + 1) as usize);
    }
    order
}

/// Bodies, triangles, corners and vertices in another order.
///
/// Also returns where each (body, triangle) of the result was before.
fn reordered(bodies: &[Body], random: &mut Lcg) -> (Vec<Body>, Vec<(usize, Vec<usize>)>) {
    let mut result = Vec::new();
    let mut before = Vec::new();
    for body in shuffled(bodies.len(), random) {
        let Body {
            triangles,
            positions,
        } = &bodies[body];
        let vertices = shuffled(positions.len(), random);
        let mut number = vec![0; positions.len()];
        for (new, &old) in vertices.iter().enumerate() {
            number[old] = new as u32;
        }
        let order = shuffled(triangles.len(), random);
        let corners = |&triangle: &usize| {
            let mut corners = triangles[triangle].map(|vertex| number[vertex as usize]);
            corners.rotate_left(random.below(3) as usize);
            if random.below(2) == 0 {
                corners.swap(0, 1);
            }
            corners
        };
        result.push(Body {
            triangles: order.iter().map(corners).collect(),
            positions: vertices.iter().map(|&vertex| positions[vertex]).collect(),
        });
        before.push((body, order));
    }
    (result, before)
}

fn moved(bodies: &[Body], change: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<Body> {
    let body = |body: &Body| Body {
        triangles: body.triangles.clone(),
        positions: body.positions.iter().map(|&p| change(p)).collect(),
    };
    bodies.iter().map(body).collect()
}

fn check_order(bodies: &[Body], in_f32: bool, random: &mut Lcg) -> usize {
    let expected = answer(bodies, in_f32);
    for turn in 0..3 {
        let (others, before) = reordered(bodies, random);
        let found = in_turn(&others, in_f32, first_turn(bodies) + turn);
        let back = |(body, triangle): (usize, usize)| {
            let (old_body, triangles) = &before[body];
            (*old_body, triangles[triangle])
        };
        let found: Pairs = found
            .into_iter()
            .map(|sides| pair(sides.map(back)))
            .collect();
        assert!(
            found == expected,
            "{:?}",
            found.symmetric_difference(&expected)
        );
    }
    expected.len()
}

/// `x` times a power of two that a single factor may be unable to hold.
fn times(x: f64, exponent: i32) -> f64 {
    x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

/// Scales and mirrors the bodies in many ways; none changes the answer.
///
/// `least` and `most` are the extreme powers of two at which all coordinates stay exact as `f32`.
/// `far_below` are powers for `f64` alone.
fn check_changes(bodies: &[Body], least: i32, most: i32, far_below: &[i32]) {
    let expected = answer(bodies, true);
    let mut turn = first_turn(bodies);
    let mut check = |change: &dyn Fn([f64; 3]) -> [f64; 3], in_f32: bool, what: &str| {
        turn += 1;
        let found = in_turn(&moved(bodies, change), in_f32, turn);
        assert!(
            found == expected,
            "{what}: {:?}",
            found.symmetric_difference(&expected)
        );
    };
    for exponent in [least, least / 2, -1, 1, most / 2, most] {
        check(&|p| p.map(|x| times(x, exponent)), true, "scaled");
    }
    for &exponent in far_below {
        check(&|p| p.map(|x| times(x, exponent)), false, "scaled in f64");
    }
    // Each axis has a factor of its own.
    check(
        &|[x, y, z]| [times(x, least), y, times(z, most)],
        true,
        "stretched",
    );
    check(
        &|[x, y, z]| [times(x, -1000), y, times(z, most)],
        false,
        "stretched in f64",
    );
    for axis in 0..3 {
        let mirror = |mut p: [f64; 3]| {
            p[axis] = -p[axis];
            p
        };
        check(&mirror, true, "mirrored");
    }
    check(&|p| p.map(|x| -x), true, "turned inside out");
    check(&|[x, y, z]| [y, x, z], true, "mirrored");
    check(&|[x, y, z]| [y, z, x], true, "axes turned");
    check(&|[x, y, z]| [-y, x, z], true, "turned");
}

/// Translates and shears the bodies by exact amounts; none changes the answer.
///
/// Coordinates are multiples of `unit` and below 64,000 units.
fn check_grid_changes(bodies: &[Body], unit: f64) {
    let expected = answer(bodies, true);
    let mut turn = first_turn(bodies);
    let mut check = |change: &dyn Fn([f64; 3]) -> [f64; 3], in_f32: bool, what: &str| {
        turn += 1;
        let found = in_turn(&moved(bodies, change), in_f32, turn);
        assert!(
            found == expected,
            "{what}: {:?}",
            found.symmetric_difference(&expected)
        );
    };
    let by = |t: [f64; 3]| move |p: [f64; 3]| [0, 1, 2].map(|axis| p[axis] + unit * t[axis]);
    check(&by([65_536.0, -4_194_304.0, 12_345.0]), true, "moved");
    check(&by([-1e6, 3.0, 1e6]), true, "moved");
    check(
        &by([2f64.powi(50), 1.0, -2f64.powi(49) - 1.0]),
        false,
        "moved far in f64",
    );
    check(&|[x, y, z]| [x + y, y, z - 2.0 * x], true, "sheared");
}

/// A soup of triangles over few places; `flat`: in one oblique plane.
fn soup(random: &mut Lcg, flat: bool) -> Body {
    let vertices = 6 + random.below(20);
    let range = 2 + random.below(5);
    let mut place = || f64::from(random.below(2 * range + 1)) - f64::from(range);
    let positions = (0..vertices)
        .map(|_| {
            let [x, y, z] = [place(), place(), place()];
            if flat { [x, y, 2.0 * x - y] } else { [x, y, z] }
        })
        .collect();
    let triangles = (0..4 + random.below(40))
        .map(|_| [(); 3].map(|()| random.below(vertices)))
        .collect();
    Body {
        triangles,
        positions,
    }
}

fn soups() -> impl Iterator<Item = Vec<Body>> {
    let mut random = Lcg(17);
    (0..16).map(move |round| {
        let bodies = 1 + random.below(3);
        (0..bodies)
            .map(|_| soup(&mut random, round % 3 == 0))
            .collect()
    })
}

/// Pairs of triangles that nearly touch, are nearly coplanar, or are slivers.
///
/// Many a sign is decided by the last bit. If `single`, coordinates are `f32`, else they use all
/// digits of `f64`.
fn hard(single: bool) -> Vec<Body> {
    let mut random = Random::new(19);
    let classes = [Class::NearlyCoplanar, Class::NearlyTouching, Class::Slivers];
    let mut pairs: Vec<[Triangle; 2]> = Vec::new();
    while pairs.len() < 150 {
        let pair = classes[pairs.len() % 3].pair(&mut random);
        pairs.extend((fits_f32(&pair) == single).then_some(pair));
    }
    let body = |side: usize| Body {
        triangles: (0..150).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        positions: pairs.iter().flat_map(|pair| pair[side]).collect(),
    };
    vec![body(0), body(1)]
}

/// A scene at one step, with coordinates rounded to multiples of 2^-12.
fn scene(name: &str, triangles: usize, step: u32) -> Vec<Body> {
    let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).unwrap();
    let mut positions = Vec::new();
    (0..scene.body_count())
        .map(|body| {
            scene.positions(body, step, &mut positions);
            let rounded = |x: f32| (f64::from(x) * 4096.0).round() / 4096.0 + 0.0;
            Body {
                triangles: scene.triangles(body).to_vec(),
                positions: positions.iter().map(|p| p.map(rounded)).collect(),
            }
        })
        .collect()
}

fn scenes() -> [Vec<Body>; 2] {
    [scene("spheres", 320, 200), scene("cloth", 648, 50)]
}

#[test]
fn order_does_not_matter() {
    let mut random = Lcg(23);
    let found: usize = soups()
        .map(|bodies| check_order(&bodies, true, &mut random))
        .sum();
    assert!(found > 3_000, "{found}");
    for bodies in scenes() {
        assert!(check_order(&bodies, true, &mut random) > 50);
    }
    for single in [true, false] {
        assert!(check_order(&hard(single), single, &mut random) > 1_000);
    }
}

#[test]
fn scale_and_mirrors_do_not_matter() {
    // The smallest f32 is 2^-149. Coordinates are integers of four bits, or multiples of 2^-12
    // below 2^10.
    check_changes(&hard(true), -60, 60, &[-900, -300]);
    soups().for_each(|bodies| check_changes(&bodies, -149, 123, &[-1074, -600, -350, -288, -200]));
    scenes()
        .iter()
        .for_each(|bodies| check_changes(bodies, -137, 117, &[-1000]));
}

#[test]
fn exact_translations_and_shears_do_not_matter() {
    soups().for_each(|bodies| check_grid_changes(&bodies, 1.0));
    scenes()
        .iter()
        .for_each(|bodies| check_grid_changes(bodies, 2f64.powi(-12)));
}
