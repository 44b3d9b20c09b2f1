//! Close pairs of triangles, and distances of bodies: every configuration agrees with the
//! reference.
//!
//! Meanwhile bodies move, turn back, come and go.

use crate::common::{Lcg, every_configuration, is_thorough, share, sheet};
use pliant::{
    BodyId, CloseTriangles, ErrorKind, Options, Pair, Scalar, Selection, World, reference,
};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

/// The test's own copy of a body.
struct Known<S> {
    id: BodyId,
    triangles: Vec<[u32; 3]>,
    positions: Vec<[S; 3]>,
}

/// The reference of one step: bodies as they are, and what it has said of them.
///
/// It measures exactly, all with all, which takes most of the time of these tests. So it is asked
/// nothing twice, nor what follows: a longer distance has the pairs of a shorter one.
struct Truth<'b, S> {
    bodies: &'b [Known<S>],
    /// The places of two bodies, the smaller first, the bits of a distance, and the pairs.
    said: BTreeMap<([usize; 2], u64), Vec<[u32; 2]>>,
}

impl<'b, S: Scalar> Truth<'b, S> {
    fn new(bodies: &'b [Known<S>]) -> Self {
        let said = BTreeMap::new();
        Self { bodies, said }
    }

    /// Pairs of triangles within a distance, of two bodies or of one with itself.
    fn expected(&mut self, [a, b]: [usize; 2], distance: f64) -> Vec<Pair> {
        let both = [a.min(b), a.max(b)];
        let of = both.map(|place| &self.bodies[place]);
        let pairs = self
            .said
            .entry((both, distance.to_bits()))
            .or_insert_with(|| {
                let pairs = if a == b {
                    reference::self_close_triangle_pairs(
                        &of[0].triangles,
                        &of[0].positions,
                        distance,
                    )
                } else {
                    let [a, b] = of.map(|body| (&body.triangles, &body.positions));
                    reference::close_triangle_pairs(a.0, a.1, b.0, b.1, distance)
                };
                pairs.unwrap()
            });
        let pair = |&[s, t]: &[u32; 2]| {
            let [triangle_a, triangle_b] = if a > b { [t, s] } else { [s, t] };
            let [body_a, body_b] = [a, b].map(|place| self.bodies[place].id);
            Pair {
                body_a,
                triangle_a,
                body_b,
                triangle_b,
            }
        };
        let mut pairs: Vec<Pair> = pairs.iter().map(pair).collect();
        pairs.sort_unstable();
        pairs
    }

    /// Whether two bodies have no pairs within a distance.
    fn is_empty(&mut self, [a, b]: [usize; 2], distance: f64) -> bool {
        let both = [a.min(b), a.max(b)];
        // Bits of distances are in the order of distances, none of which is negative.
        let shorter = self.said.range((both, 0)..=(both, distance.to_bits()));
        let longer = self
            .said
            .range((both, distance.to_bits())..=(both, u64::MAX));
        if shorter.map(|it| it.1).any(|pairs| !pairs.is_empty()) {
            return false;
        }
        longer.map(|it| it.1).any(Vec::is_empty) || self.expected([a, b], distance).is_empty()
    }
}

/// The list of all close pairs; asserts that *first* and *visit_some* agree with it.
fn ask<S: Scalar>(world: &mut World<S>, of: Selection, distance: f64) -> Vec<CloseTriangles> {
    let all = world
        .close_triangle_pairs(of, distance)
        .all()
        .unwrap()
        .to_vec();
    let first = world.close_triangle_pairs(of, distance).first().unwrap();
    assert_eq!(first.is_some(), !all.is_empty());
    assert!(first.is_none_or(|first| all.contains(&first)));
    let mut shown = Vec::new();
    let visit = world.close_triangle_pairs(of, distance);
    let _ = visit
        .visit_some(|some| {
            shown.extend_from_slice(some);
            ControlFlow::<()>::Continue(())
        })
        .unwrap();
    shown.sort_unstable_by_key(|close| close.pair);
    assert_eq!(shown, all);
    if !all.is_empty() {
        let fewer = world
            .close_triangle_pairs(of, distance)
            .at_most(all.len() - 1);
        let limit = all.len() - 1;
        assert_eq!(
            fewer.all().unwrap_err().kind,
            ErrorKind::TooManyHits { limit }
        );
    }
    all
}

/// Checks that the figures of a pair agree with each other.
fn check_figures<S: Scalar>(close: &CloseTriangles, bodies: &[Known<S>]) {
    let mut points = [[0.0; 3]; 2];
    for (point, (body, triangle, counts)) in points.iter_mut().zip([
        (
            close.pair.body_a,
            close.pair.triangle_a,
            close.barycentric_a,
        ),
        (
            close.pair.body_b,
            close.pair.triangle_b,
            close.barycentric_b,
        ),
    ]) {
        let body = bodies.iter().find(|known| known.id == body).unwrap();
        for (vertex, count) in body.triangles[triangle as usize].into_iter().zip(counts) {
            for axis in 0..3 {
                point[axis] += count * body.positions[vertex as usize][axis].to_f64();
            }
        }
    }
    let [a, b] = points;
    for axis in 0..3 {
        assert!((a[axis] - close.point_a[axis]).abs() < 1e-12, "{close:?}");
        assert!((b[axis] - close.point_b[axis]).abs() < 1e-12, "{close:?}");
        let along = close.direction.map_or(0.0, |direction| direction[axis]);
        let way = a[axis] - b[axis];
        assert!((way - close.distance * along).abs() < 1e-7, "{close:?}");
    }
    assert_eq!(close.direction.is_none(), close.distance == 0.0);
}

/// Checks the promise of a distance: nothing is nearer, and something is as near.
fn check_distance<S: Scalar>(
    found: Option<CloseTriangles>,
    of: [usize; 2],
    cut_off: f64,
    truth: &mut Truth<S>,
) {
    let Some(found) = found else {
        assert!(truth.is_empty(of, cut_off.min(1e9)));
        return;
    };
    let ids = of.map(|place| truth.bodies[place].id);
    assert_eq!([found.pair.body_a, found.pair.body_b], ids);
    check_figures(&found, truth.bodies);
    let slack = 2f64.powi(-30);
    let (below, above) = (
        found.distance * (1.0 - slack),
        found.distance * (1.0 + slack),
    );
    assert!(found.distance <= cut_off * (1.0 + slack));
    let near = truth.expected(of, above);
    assert!(near.contains(&found.pair), "{found:?} {near:?}");
    if found.distance > 0.0 {
        assert!(truth.is_empty(of, below), "{found:?}");
    }
}

/// A sheet at a random place, between flat and very rough.
fn shape<S: Scalar>(random: &mut Lcg, flat: &[[f32; 3]], of: fn(f64) -> S) -> Vec<[S; 3]> {
    let at: [f64; 3] = std::array::from_fn(|_| 0.7 * f64::from(random.below(4)));
    let rough = f64::from(random.below(3)) * 0.3;
    flat.iter()
        .map(|p| {
            std::array::from_fn(|axis| {
                of(at[axis] + f64::from(p[axis]) + rough * f64::from(random.unit()))
            })
        })
        .collect()
}

/// Checks that the nearest body is the one at the least distance.
fn check_nearest<S: Scalar>(world: &mut World<S>, bodies: &[Known<S>]) {
    let id = bodies[0].id;
    let [mut least, mut to] = [f64::INFINITY, 0.0];
    for other in &bodies[1..] {
        let found = world
            .distance(id, other.id, f64::INFINITY)
            .unwrap()
            .unwrap();
        if found.distance < least {
            [least, to] = [found.distance, f64::from(other.id.0)];
        }
    }
    let nearest = world.nearest_body(id, f64::INFINITY).unwrap().unwrap();
    assert!(
        (nearest.distance - least).abs() <= least * 2f64.powi(-29),
        "{nearest:?} {least} {to}"
    );
    assert!(world.nearest_body(id, least * 0.99).unwrap().is_none() || least == 0.0);
}

fn live<S: Scalar>(options: Options, seed: u64, steps: u32, of: fn(f64) -> S) -> [usize; 3] {
    let random = &mut Lcg(seed);
    let mut world = World::<S>::with_options(options);
    let mut bodies: Vec<Known<S>> = Vec::new();
    let mut seen = [0; 3];
    for step in 0..steps {
        while bodies.len() < 3 || bodies.len() == 3 && step % 7 == 6 {
            let (triangles, flat) = sheet(3 + random.below(3));
            let positions = shape(random, &flat, of);
            let id = world.add(&triangles, &positions).unwrap();
            bodies.push(Known {
                id,
                triangles,
                positions,
            });
        }
        if bodies.len() > 3 {
            let gone = bodies.remove(random.below(4) as usize);
            world.remove(gone.id).unwrap();
        }
        let which = random.below(3) as usize;
        let moved = &mut bodies[which];
        if random.below(2) == 0 {
            let by: [f64; 3] = std::array::from_fn(|_| 0.4 * f64::from(random.unit()) - 0.2);
            for point in &mut moved.positions {
                *point = std::array::from_fn(|axis| of(point[axis].to_f64() + by[axis]));
            }
        } else {
            let flat: Vec<[f32; 3]> = moved
                .positions
                .iter()
                .map(|_| [random.unit() * 2.0, random.unit(), random.unit()])
                .collect();
            moved.positions = shape(random, &flat, of);
        }
        world.set_positions(moved.id, &moved.positions).unwrap();
        if step % 5 == 4 {
            world.rebuild(moved.id).unwrap();
        }
        let ids = [bodies[0].id, bodies[1].id];
        let truth = &mut Truth::new(&bodies);
        for distance in [0.0, 0.15] {
            let mut of_world = Vec::new();
            for [i, j] in [[0, 1], [0, 2], [1, 2]] {
                of_world.extend(truth.expected([i, j], distance));
            }
            of_world.sort_unstable();
            let found = ask(&mut world, Selection::World, distance);
            assert!(
                found
                    .iter()
                    .map(|close| close.pair)
                    .eq(of_world.iter().copied())
            );
            let within = ask(&mut world, Selection::Within(ids[0]), distance);
            let itself = truth.expected([0, 0], distance);
            assert!(within.iter().map(|close| close.pair).eq(itself));
            let between = ask(&mut world, Selection::Between(ids[1], ids[0]), distance);
            let of_two = truth.expected([1, 0], distance);
            assert!(between.iter().map(|close| close.pair).eq(of_two));
            let everything = ask(&mut world, Selection::Everything, distance);
            assert!(everything.len() >= found.len() + within.len());
            for close in &everything {
                assert!(close.distance <= distance * (1.0 + 2f64.powi(-30)));
                check_figures(close, &bodies);
            }
            seen[0] += everything.len();
        }
        for of in [[0, 1], [1, 0], [1, 2]] {
            let [a, b] = of.map(|place| bodies[place].id);
            let far = world.distance(a, b, f64::INFINITY).unwrap();
            check_distance(far, of, f64::INFINITY, truth);
            let far = far.unwrap();
            seen[1] += usize::from(far.distance > 0.0);
            seen[2] += usize::from(far.distance == 0.0);
            for cut_off in [0.0, 0.3, far.distance * 0.999, far.distance * 1.001] {
                let near = world.distance(a, b, cut_off).unwrap();
                assert_eq!(near.is_some(), !truth.is_empty(of, cut_off));
                check_distance(near, of, cut_off, truth);
            }
        }
        check_nearest(&mut world, &bodies);
        world.validate().unwrap();
    }
    seen
}

#[test]
fn every_configuration_says_what_the_reference_does() {
    let mut seen = [0; 3];
    let all = every_configuration().into_iter().enumerate();
    for (at, options) in all.step_by(if is_thorough() { 23 } else { 61 }) {
        let seed = at as u64;
        let of_one = if at % 2 == 0 {
            live::<f32>(options, seed, 5, |x| x as f32)
        } else {
            live::<f64>(options, seed, 5, |x| x + 1e3)
        };
        seen = std::array::from_fn(|i| seen[i] + of_one[i]);
    }
    let at_least = [share(4_000, 3), share(100, 3), share(10, 3)];
    assert!((0..3).all(|i| seen[i] > at_least[i]), "{seen:?}");
}

#[test]
fn threads_and_long_lives_do_not_change_anything() {
    for threads in [1, 3] {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        live::<f32>(options, 77, share(20, 3) as u32, |x| x as f32);
        live::<f64>(options, 78, share(20, 3) as u32, |x| x);
    }
}

#[test]
fn what_is_no_distance_is_refused() {
    let mut world = World::<f32>::new();
    let (triangles, positions) = sheet(3);
    let body = world.add(&triangles, &positions).unwrap();
    let other = world.add(&triangles, &positions).unwrap();
    for distance in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        let bad = |kind: ErrorKind| matches!(kind, ErrorKind::BadDistance { .. });
        assert!(bad(world.distance(body, other, distance).unwrap_err().kind));
        assert!(bad(world.nearest_body(body, distance).unwrap_err().kind));
        let close = world.close_triangle_pairs(Selection::World, distance);
        assert!(bad(close.all().unwrap_err().kind));
    }
    let same = world.distance(body, body, 1.0).unwrap_err();
    assert_eq!(same.kind, ErrorKind::SameBody);
    world.remove(other).unwrap();
    for gone in [
        world.distance(body, other, 1.0),
        world.nearest_body(other, 1.0),
    ] {
        let gone = gone.unwrap_err();
        assert_eq!((gone.body, gone.kind), (Some(other), ErrorKind::NoSuchBody));
    }
    assert!(world.nearest_body(body, f64::INFINITY).unwrap().is_none());
}

#[test]
fn filters_are_for_the_nearest_body_only() {
    let mut world = World::<f64>::new();
    let triangle = [[0, 1, 2]];
    let at = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    let [a, b, c] = [0.0, 1.0, 5.0].map(|z| world.add(&triangle, &at(z)).unwrap());
    assert_eq!(world.nearest_body(a, 9.0).unwrap().unwrap().pair.body_b, b);
    world.ignore(a, b).unwrap();
    let nearest = world.nearest_body(a, 9.0).unwrap().unwrap();
    assert_eq!((nearest.pair.body_b, nearest.distance), (c, 5.0));
    assert_eq!(world.distance(a, b, 9.0).unwrap().unwrap().distance, 1.0);
    world.set_filter(c, 2, 2).unwrap();
    world.set_filter(a, 1, 1).unwrap();
    assert!(world.nearest_body(a, 9.0).unwrap().is_none());

    world.set_environment(b, 3).unwrap();
    assert_eq!(world.distance(b, c, 9.0).unwrap().unwrap().distance, 4.0);
    assert!(world.nearest_body(b, 9.0).unwrap().is_none());
    world.set_environment(c, 3).unwrap();
    assert_eq!(world.nearest_body(b, 9.0).unwrap().unwrap().pair.body_b, c);
}

/// Corners of a triangle on one side of the plane x + 2 y + 2 z = u, the first of them at 0.
///
/// The unit is u, the smallest positive number.
const CORNER: [[f64; 3]; 3] = [[0.0; 3], [-9.0, 0.0, 0.0], [0.0, -9.0, 0.0]];
/// Corners of a triangle in that plane over 0, at a distance of u / 3.
const OVER_IT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]];

/// Only triangles that touch have distance 0, even if a distance is below the smallest number.
#[test]
fn only_what_touches_is_at_distance_0() {
    let u = f64::from_bits(1);
    let at = |all: [[f64; 3]; 3], by: f64| all.map(|it| it.map(|x| x * by));
    // A third of u, two, four and five thirds; and a size at which results are not subnormal.
    for (by, told) in [
        (1.0, u),
        (2.0, u),
        (4.0, u),
        (5.0, 2.0 * u),
        (2f64.powi(60), 0.0),
    ] {
        let mut world = World::<f64>::new();
        let corner = world.add(&[[0, 1, 2]], &at(CORNER, by * u)).unwrap();
        let over_it = world.add(&[[0, 1, 2]], &at(OVER_IT, by * u)).unwrap();
        let found = world.distance(corner, over_it, 1.0).unwrap().unwrap();
        let is_told = |distance: f64| {
            let exact = by / 3.0 * u;
            let right = if told == 0.0 { exact } else { told };
            distance == right || told == 0.0 && (distance - exact).abs() <= exact * 1e-9
        };
        assert!(is_told(found.distance), "{by}: {found:?}");
        let direction = found.direction.unwrap();
        let normal = [-1.0 / 3.0, -2.0 / 3.0, -2.0 / 3.0];
        assert!((0..3).all(|axis| (direction[axis] - normal[axis]).abs() < 1e-14));
        let of = Selection::World;
        let close = world.close_vertex_triangle_pairs(of, 1.0).all().unwrap();
        let close = close
            .iter()
            .find(|it| (it.pair.vertex_body, it.pair.vertex) == (corner, 0));
        assert!(close.is_some_and(|it| is_told(it.distance) && it.direction.is_some()));
        let close = world.close_triangle_pairs(of, 1.0).all().unwrap();
        assert!(close.len() == 1 && is_told(close[0].distance));
        // A limit is compared with the exact distance, whatever number is returned.
        assert!(
            world
                .close_triangle_pairs(of, 0.0)
                .all()
                .unwrap()
                .is_empty()
        );
        let is_within_u = !world.close_triangle_pairs(of, u).all().unwrap().is_empty();
        assert_eq!(is_within_u, by <= 3.0, "{by}");
        assert_eq!(
            world.distance(corner, over_it, u).unwrap().is_some(),
            by <= 3.0
        );

        // A body that touches is the nearest, though another was found first.
        let nearest = world.nearest_body(corner, 1.0).unwrap().unwrap();
        assert_eq!(nearest.pair.body_b, over_it);
        let touching = at([[0.0; 3], [-9.0, 0.0, 0.0], [0.0, 0.0, -9.0]], by * u);
        let touching = world.add(&[[0, 1, 2]], &touching).unwrap();
        for (of, other) in [(corner, touching), (touching, corner)] {
            let nearest = world.nearest_body(of, 1.0).unwrap().unwrap();
            assert_eq!((nearest.pair.body_b, nearest.distance), (other, 0.0));
            assert_eq!(nearest.direction, None);
        }
        let clearance = world.clearance(of, 1.0).unwrap();
        assert_eq!(clearance[&corner][0], 0.0);
    }
}
