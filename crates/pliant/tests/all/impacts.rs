//! Impacts: every configuration gives the list of the plain reference, with the same intervals.
//!
//! Random lives of worlds are compared. The first impact is the exactly earliest. Free steps are
//! free of collision, and are long enough.

use crate::common::{Lcg, every_configuration, share, sheet};
use pliant::reference::{self, Moving};
use pliant::{
    BodyId, EdgeEdge, EdgeEdgeImpact, ErrorKind, Impact, Options, Scalar, Selection,
    VertexTriangle, VertexTriangleImpact, World,
};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

/// The test's own copy of a body.
#[derive(Clone, Debug)]
pub(crate) struct Known<S> {
    pub(crate) id: BodyId,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) positions: Vec<[S; 3]>,
    pub(crate) end: Option<Vec<[S; 3]>>,
}

impl<S> Known<S> {
    fn moving(&self) -> Moving<'_, S> {
        Moving {
            end: self.end.as_deref(),
            ..Moving::at(&self.triangles, &self.positions)
        }
    }
}

/// Impacts of vertices with triangles, and of edges with edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Lists {
    pub(crate) vertex_triangle: Vec<VertexTriangleImpact>,
    pub(crate) edge_edge: Vec<EdgeEdgeImpact>,
}

impl Lists {
    fn of_vertices<S>(&mut self, a: &Known<S>, b: &Known<S>, impacts: Vec<reference::Timed>) {
        let row = |([vertex, triangle], [low, high]): reference::Timed| VertexTriangleImpact {
            pair: VertexTriangle {
                vertex_body: a.id,
                vertex,
                triangle_body: b.id,
                triangle,
            },
            low,
            high,
        };
        self.vertex_triangle.extend(impacts.into_iter().map(row));
    }

    fn of_edges<S>(&mut self, a: &Known<S>, b: &Known<S>, impacts: Vec<reference::Timed>) {
        let row = |([edge_a, edge_b], [low, high]): reference::Timed| EdgeEdgeImpact {
            pair: EdgeEdge {
                body_a: a.id,
                edge_a,
                body_b: b.id,
                edge_b,
            },
            low,
            high,
        };
        self.edge_edge.extend(impacts.into_iter().map(row));
    }

    fn two<S: Scalar>(&mut self, a: &Known<S>, b: &Known<S>, width: f64) {
        for (of, with) in [(a, b), (b, a)] {
            let found = reference::vertex_triangle_impacts(&of.moving(), &with.moving(), width);
            self.of_vertices(of, with, found.unwrap());
        }
        let found = reference::edge_edge_impacts(&a.moving(), &b.moving(), width);
        self.of_edges(a, b, found.unwrap());
    }

    fn one<S: Scalar>(&mut self, body: &Known<S>, width: f64) {
        let found = reference::self_vertex_triangle_impacts(&body.moving(), width);
        self.of_vertices(body, body, found.unwrap());
        let found = reference::self_edge_edge_impacts(&body.moving(), width);
        self.of_edges(body, body, found.unwrap());
    }

    /// All impacts by the reference: each body with itself and with every other.
    pub(crate) fn of_all<S: Scalar>(known: &[Known<S>], width: f64) -> Self {
        let mut all = Self::default();
        for (at, a) in known.iter().enumerate() {
            all.one(a, width);
            for b in &known[at + 1..] {
                all.two(a, b, width);
            }
        }
        all
    }

    fn extend(&mut self, other: &Self) {
        self.vertex_triangle.extend(&other.vertex_triangle);
        self.edge_edge.extend(&other.edge_edge);
    }

    /// Turns pairs of edges round: the second body comes first.
    fn turned(mut self) -> Self {
        for EdgeEdgeImpact { pair, .. } in &mut self.edge_edge {
            *pair = EdgeEdge {
                body_a: pair.body_b,
                edge_a: pair.edge_b,
                body_b: pair.body_a,
                edge_b: pair.edge_a,
            };
        }
        self
    }

    pub(crate) fn sorted(mut self) -> Self {
        self.vertex_triangle.sort_by_key(|impact| impact.pair);
        self.edge_edge.sort_by_key(|impact| impact.pair);
        self
    }

    /// The least upper end of an interval, next to the first exact time.
    ///
    /// Several impacts may have it, and need not be equally early.
    fn first(&self) -> Option<f64> {
        let vertices = self.vertex_triangle.iter().map(|impact| impact.high);
        let edges = self.edge_edge.iter().map(|impact| impact.high);
        vertices.chain(edges).reduce(f64::min)
    }
}

/// The world's lists; asserts that *visit_some*, *at_most* and an interruption agree with *all*.
fn ask<S: Scalar>(world: &mut World<S>, of: Selection, width: f64) -> Lists {
    macro_rules! asked {
        ($ask:ident) => {{
            let all = world.$ask(of).width(width).all().unwrap().to_vec();
            let mut shown = Vec::new();
            let visited = world.$ask(of).width(width).visit_some(|some| {
                shown.extend_from_slice(some);
                ControlFlow::<()>::Continue(())
            });
            assert!(visited.unwrap().is_continue());
            shown.sort_by_key(|impact| impact.pair);
            assert_eq!(shown, all);
            if let Some(fewer) = all.len().checked_sub(1) {
                let refused = world.$ask(of).at_most(fewer).all().unwrap_err();
                assert_eq!(refused.kind, ErrorKind::TooManyHits { limit: fewer });
                let stopped = || true;
                let refused = world.$ask(of).interrupt_if(&stopped).all();
                assert_eq!(refused.unwrap_err().kind, ErrorKind::Interrupted);
            }
            let first = world.$ask(of).width(width).first().unwrap();
            assert_eq!(first.is_some(), !all.is_empty());
            if let Some(first) = first {
                assert!(all.contains(&first), "{first:?}");
                assert!(all.iter().all(|other| other.high >= first.high));
                // Intervals one number wide tell most times apart.
                let fine = world.$ask(of).width(0.0).all().unwrap().to_vec();
                let of_first = fine.iter().find(|other| other.pair == first.pair).unwrap();
                let earlier = fine.iter().find(|other| {
                    (other.high, other.pair) < (of_first.high, of_first.pair)
                        && other.low != of_first.low
                });
                assert_eq!(earlier, None, "{first:?}");
            }
            all
        }};
    }
    let lists = Lists {
        vertex_triangle: asked!(vertex_triangle_impacts),
        edge_edge: asked!(edge_edge_impacts),
    };
    world.validate().unwrap();
    lists
}

/// Asks every selection, and compares with the reference.
fn check<S: Scalar>(world: &mut World<S>, known: &[Known<S>], width: f64, when: &str) {
    let options = *world.options();
    let (mut all, mut between) = (Lists::default(), Lists::default());
    for (at, a) in known.iter().enumerate() {
        let mut own = Lists::default();
        own.one(a, width);
        all.extend(&own);
        let found = ask(world, Selection::Within(a.id), width);
        assert_eq!(found, own.sorted(), "{when}, {options:?}");
        for b in &known[at + 1..] {
            let mut two = Lists::default();
            two.two(a, b, width);
            between.extend(&two);
            all.extend(&two);
            for (of, two) in [([a, b], two.clone()), ([b, a], two.turned())] {
                let of = Selection::Between(of[0].id, of[1].id);
                let (found, two) = (ask(world, of, width), two.sorted());
                assert_eq!(found, two, "{when}, {of:?}, {options:?}");
            }
        }
    }
    let found = ask(world, Selection::World, width);
    assert_eq!(found, between.sorted(), "{when}, {options:?}");
    let all = all.sorted();
    assert_eq!(
        ask(world, Selection::Everything, width),
        all,
        "{when}, {options:?}"
    );
    let first = world.first_impact(Selection::Everything, width).unwrap();
    assert_eq!(first.map(|impact| impact.high()), all.first());
}

/// Whether nothing meets after the start, by the reference.
fn is_free<S: Scalar>(known: &[Known<S>]) -> bool {
    let all = Lists::of_all(known, 1.0);
    let vertices = all.vertex_triangle.iter().map(|impact| impact.high);
    let edges = all.edge_edge.iter().map(|impact| impact.high);
    vertices.chain(edges).all(|high| high == 0.0)
}

/// Time of the first contact after the start, rounded up, by the reference.
fn first_after_start<S: Scalar>(known: &[Known<S>]) -> Option<f64> {
    let all = Lists::of_all(known, 0.0);
    let vertices = all.vertex_triangle.iter().map(|impact| impact.high);
    let edges = all.edge_edge.iter().map(|impact| impact.high);
    let later = vertices.chain(edges).filter(|&high| high > 0.0);
    later.reduce(f64::min)
}

/// Checks that a free step is free of contact on straight ways to the rounded shape, and long.
fn check_step<S: Scalar>(world: &mut World<S>, known: &[Known<S>]) {
    let step = world
        .collision_free_step(Selection::Everything, 0.0)
        .unwrap();
    world.validate().unwrap();
    assert!((0.0..=1.0).contains(&step));
    let mut advanced = world.clone();
    advanced.advance_motion(step).unwrap();
    let there: Vec<Known<S>> = known
        .iter()
        .map(|body| Known {
            end: Some(advanced.positions(body.id).unwrap()),
            ..body.clone()
        })
        .collect();
    assert!(is_free(&there), "{step}");
    match first_after_start(known) {
        None => assert_eq!(step, 1.0),
        Some(first) => assert!(step < first && step >= 0.9 * first, "{step} {first}"),
    }
}

/// Meshes with adjacency of every kind.
fn mesh(random: &mut Lcg) -> (Vec<[u32; 3]>, usize) {
    match random.below(4) {
        0 => {
            let side = 2 + random.below(4);
            (sheet(side).0, (side * side) as usize + 1)
        }
        1 => {
            let rim = 3 + random.below(6);
            let fan = (1..rim).map(|at| [0, at, at + 1]);
            (fan.clone().chain(fan.take(2)).collect(), rim as usize + 1)
        }
        2 => {
            let degenerate = vec![[0, 1, 1], [2, 2, 2], [3, 4, 5], [5, 5, 0], [0, 1, 2]];
            (degenerate, 6)
        }
        _ => {
            let triangles = 1 + random.below(12);
            let vertices = 3 + random.below(20);
            let mut corner = || random.below(vertices);
            let soup = (0..triangles)
                .map(|_| [corner(), corner(), corner()])
                .collect();
            (soup, vertices as usize)
        }
    }
}

/// Life of a world whose bodies move, on a lattice or not, far from the origin or near.
fn live<S: Scalar>(options: Options, seed: u32, from_f64: fn(f64) -> S) {
    let mut random = Lcg(u64::from(seed));
    let mut world = World::<S>::with_options(options);
    let is_lattice = seed.is_multiple_of(3);
    let far = [0.0, 1000.0][seed as usize / 3 % 2];
    let coordinate = |random: &mut Lcg, size: f64| {
        let x = if is_lattice {
            f64::from(random.below(5)) - 2.0
        } else {
            (f64::from(random.below(1 << 20)) / f64::from(1 << 19) - 1.0) * size
        };
        from_f64(x + far)
    };
    let mut known = Vec::new();
    for _ in 0..2 + random.below(2) {
        let (triangles, vertices) = mesh(&mut random);
        let positions: Vec<[S; 3]> = (0..vertices)
            .map(|_| [0; 3].map(|_| coordinate(&mut random, 2.0)))
            .collect();
        let id = world.add(&triangles, &positions).unwrap();
        known.push(Known {
            id,
            triangles,
            positions,
            end: None,
        });
    }
    for step in 0..3 {
        for body in &mut known {
            // Some vertices stand still in every motion.
            let is_small = random.below(2) == 0;
            let still = random.below(3);
            let end: Vec<[S; 3]> = body
                .positions
                .iter()
                .map(|&at| {
                    if random.below(3) < still {
                        return at;
                    }
                    let to = [0; 3].map(|_| coordinate(&mut random, 2.0));
                    if is_small && !is_lattice {
                        [0, 1, 2].map(|i| {
                            let [a, b] = [at[i].to_f64(), to[i].to_f64()];
                            from_f64(a + (b - a) / 16.0)
                        })
                    } else {
                        to
                    }
                })
                .collect();
            if random.below(5) == 0 {
                body.end = None;
                world.set_positions(body.id, &body.positions).unwrap();
            } else {
                world.set_motion(body.id, &end).unwrap();
                body.end = Some(end);
            }
        }
        let width = [1e-6, 1e-6, 0.0, 1.0][random.below(4) as usize];
        check(
            &mut world,
            &known,
            width,
            &format!("seed {seed}, step {step}"),
        );
        check_step(&mut world, &known);
        // Goes on to the end of the motion, or part of the way.
        if random.below(2) == 0 {
            world.finish_motion();
        } else {
            world.advance_motion(0.5).unwrap();
        }
        for body in &mut known {
            body.positions = world.positions(body.id).unwrap();
            body.end = None;
        }
    }
}

fn lives<S: Scalar>(first_seed: u32, of: fn(f64) -> S) {
    let configurations: Vec<Options> = every_configuration();
    for life in 0..share(40, 2) as u32 {
        let mut options = configurations[life as usize * 7 % configurations.len()];
        if life % 4 == 3 {
            options.threads = NonZeroUsize::new(3).unwrap();
        }
        live::<S>(options, first_seed + life, of);
    }
}

#[test]
fn every_configuration_gives_the_impacts_of_the_reference_f32() {
    lives::<f32>(1000, |x| x as f32);
}

#[test]
fn every_configuration_gives_the_impacts_of_the_reference_f64() {
    lives::<f64>(0, |x| x);
}

/// A vertex that reaches a triangle exactly at the end of a motion, at sizes 2^-60 to 2^60.
#[test]
fn what_touches_exactly_at_the_end_is_found_at_every_size() {
    for exponent in -60..=60 {
        let size = 2f64.powi(exponent);
        for round in 0..64 {
            let mut random = Lcg(round);
            let mut unit = || size * (f64::from(random.below(1 << 30)) / f64::from(1 << 30));
            let (a, b, c) = (
                [0.0; 3],
                [4.0 * size, 0.0, unit()],
                [0.0, 4.0 * size, unit()],
            );
            // A point of the triangle that is exact: a plus parts of sides, whose numbers have few
            // digits.
            let [u, v] = [0.25, 0.5];
            let at: [f64; 3] = std::array::from_fn(|i| u * b[i] + v * c[i]);
            let is_exact =
                |i: usize| pliant_oracle::sign_of_sum(&[u * b[i], v * c[i], -at[i]]) == 0;
            if !(0..3).all(is_exact) {
                continue;
            }
            let from = [at[0] + unit(), at[1] - unit(), at[2] + size + unit()];
            let start = [[from, a, b, c]];
            let end = [[at, a, b, c]];
            let found = pliant::vertex_triangle_impacts(&start, &end, 1e-6).unwrap()[0];
            let [low, high] = found.expect("it touches");
            assert!(low < 1.0 && high == 1.0);
            // One floating-point number short of it, nothing meets.
            let short = [[[at[0], at[1], at[2].next_up()], a, b, c]];
            assert_eq!(
                pliant::vertex_triangle_impacts(&start, &short, 1e-6).unwrap()[0],
                None
            );
        }
    }
}

#[test]
fn exchanged_reversed_scaled_and_translated_motions_give_the_same() {
    let mut random = Lcg(5);
    let mut met = 0;
    for _ in 0..4_000 {
        let lattice = random.below(2) == 0;
        let mut x = || {
            let x = f64::from(random.below(1 << 20)) / f64::from(1 << 20);
            if lattice { (x * 5.0).floor() } else { x }
        };
        let start: [[f64; 3]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| x()));
        let end: [[f64; 3]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| x()));
        let edges = |start: [[f64; 3]; 4], end: [[f64; 3]; 4]| {
            pliant::edge_edge_impacts(&[start], &[end], 1e-9).unwrap()[0]
        };
        let vertex = |start: [[f64; 3]; 4], end: [[f64; 3]; 4]| {
            pliant::vertex_triangle_impacts(&[start], &[end], 1e-9).unwrap()[0]
        };
        let [e, v] = [edges(start, end), vertex(start, end)];
        met += usize::from(e.is_some()) + usize::from(v.is_some());
        let swapped = |[a, b, c, d]: [[f64; 3]; 4]| [c, d, b, a];
        assert_eq!(edges(swapped(start), swapped(end)), e);
        let turned = |[p, a, b, c]: [[f64; 3]; 4]| [p, c, a, b];
        assert_eq!(vertex(turned(start), turned(end)), v);
        assert_eq!(edges(end, start).is_some(), e.is_some());
        assert_eq!(vertex(end, start).is_some(), v.is_some());
        for exponent in [-100, -20, 70] {
            let scaled =
                |corners: [[f64; 3]; 4]| corners.map(|p| p.map(|x| x * 2f64.powi(exponent)));
            assert_eq!(edges(scaled(start), scaled(end)), e);
            assert_eq!(vertex(scaled(start), scaled(end)), v);
        }
        // Exact, as all coordinates are multiples of 2^-20.
        let moved = |corners: [[f64; 3]; 4]| corners.map(|p| p.map(|x| x + 4096.0));
        assert_eq!(edges(moved(start), moved(end)), e);
        assert_eq!(vertex(moved(start), moved(end)), v);
    }
    assert!(met > 800, "{met}");
}

/// A vertex that falls on a triangle stops at the distance that is asked for.
#[test]
fn steps_keep_a_distance() {
    for (round, distance) in [0.0, 1e-3, 0.1, 0.25].into_iter().enumerate() {
        let mut world = World::<f64>::new();
        let floor = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
        world.add(&[[0, 1, 2]], &floor).unwrap();
        let leaf = [[0.0, 0.0, 1.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]];
        let body = world.add(&[[0, 1, 2]], &leaf).unwrap();
        let end = leaf.map(|[x, y, z]| [x + 0.1, y, z - 4.0]);
        world.set_motion(body, &end).unwrap();
        let step = world
            .collision_free_step(Selection::Everything, distance)
            .unwrap();
        let largest = (1.0 - distance) / 4.0;
        assert!(
            step < largest && step >= 0.9 * largest,
            "{round}: {step} of {largest}"
        );
        world.advance_motion(step).unwrap();
        let apart = world.distance(BodyId(0), body, f64::INFINITY).unwrap();
        assert!(apart.unwrap().distance > distance);
        // Along the floor it may go all the way.
        let now = world.positions(body).unwrap();
        let along: Vec<[f64; 3]> = now.iter().map(|&[x, y, z]| [x + 2.0, y, z]).collect();
        world.set_motion(body, &along).unwrap();
        assert_eq!(
            world
                .collision_free_step(Selection::Everything, distance)
                .unwrap(),
            1.0
        );
        // If it is already nearer than a larger distance, it is only kept from contact.
        let down: Vec<[f64; 3]> = now.iter().map(|&[x, y, z]| [x, y, z - 8.0]).collect();
        world.set_motion(body, &down).unwrap();
        let height = now[0][2];
        let step = world
            .collision_free_step(Selection::Everything, 0.9)
            .unwrap();
        assert!(
            step * 8.0 < height && step * 8.0 >= 0.9 * height,
            "{step} {height}"
        );
    }
    let refused = World::<f64>::new().collision_free_step(Selection::World, -1.0);
    assert_eq!(
        refused.unwrap_err().kind,
        ErrorKind::BadDistance { distance: -1.0 }
    );
}

/// A body far away does not make the others be looked at more closely.
#[test]
fn a_body_far_away_costs_others_nothing() {
    let mut world = World::<f32>::new();
    let (triangles, low) = sheet(16);
    let moved = |shape: &[[f32; 3]], by: [f32; 3]| -> Vec<[f32; 3]> {
        let moved = shape
            .iter()
            .map(|it| std::array::from_fn(|axis| it[axis] + by[axis]));
        moved.collect()
    };
    let high = moved(&low, [0.0, 0.0, 0.5]);
    let down = moved(&high, [0.02, 0.0, -0.6]);
    world.add(&triangles, &low).unwrap();
    let body = world.add(&triangles, &high).unwrap();
    world.set_motion(body, &down).unwrap();
    let ask = |world: &mut World<f32>, distance: f64| {
        let step = world.collision_free_step(Selection::World, distance);
        let work = *world.statistics();
        (step.unwrap(), [work.node_pairs, work.candidate_pairs])
    };
    let before = [0.0, 0.1].map(|distance| ask(&mut world, distance));
    let far = moved(&high, [3e8, 0.0, 0.0]);
    let further = moved(&far, [0.0, -0.2, 0.0]);
    let body = world.add(&triangles, &far).unwrap();
    world.set_motion(body, &further).unwrap();
    let after = [0.0, 0.1].map(|distance| ask(&mut world, distance));
    assert_eq!(before, after);
    assert!(before.iter().all(|(_, [_, candidates])| *candidates > 0));
}

/// A crumpling sheet that is advanced by free steps alone never meets itself nor a ball.
///
/// Several times within each step are looked at. If a distance is asked for, it is kept.
#[test]
fn worlds_that_take_free_steps_never_intersect() {
    for (seed, distance) in [(1, 0.0), (2, 0.0), (3, 0.02)] {
        let mut random = Lcg(seed);
        let mut world = World::<f32>::new();
        let side = 9;
        let triangles = sheet(side).0;
        let flat = |z: f32| -> Vec<[f32; 3]> {
            (0..side * side)
                .map(|at| [(at % side) as f32 * 0.25, (at / side) as f32 * 0.25, z])
                .collect()
        };
        let bodies = [0.0, 0.5].map(|z| world.add(&triangles, &flat(z)).unwrap());
        let mut twin = World::<f64>::new();
        for body in bodies {
            let wide = world.positions(body).unwrap();
            let wide: Vec<_> = wide.iter().map(|p| p.map(f64::from)).collect();
            twin.add(&triangles, &wide).unwrap();
        }
        let mut shortened = 0;
        for _ in 0..60 {
            for body in bodies {
                let now = world.positions(body).unwrap();
                let mut push = || random.below(2001) as f32 / 1000.0 - 1.0;
                let end: Vec<[f32; 3]> =
                    now.iter().map(|&p| p.map(|x| x + 0.12 * push())).collect();
                world.set_motion(body, &end).unwrap();
            }
            let step = world
                .collision_free_step(Selection::Everything, distance)
                .unwrap();
            shortened += u32::from(step < 1.0);
            let before = bodies.map(|body| world.positions(body).unwrap());
            world.advance_motion(step).unwrap();
            // Times on the straight way to the new shape; these are exact in double precision.
            for part in [0.25, 0.5, 0.75, 1.0] {
                for (place, &body) in bodies.iter().enumerate() {
                    let after = world.positions(body).unwrap();
                    let ways = before[place].iter().zip(&after);
                    let between: Vec<[f64; 3]> = ways
                        .map(|(from, to)| {
                            [0, 1, 2].map(|i| {
                                let [from, to] = [from[i], to[i]].map(f64::from);
                                from + part * (to - from)
                            })
                        })
                        .collect();
                    twin.set_positions(body, &between).unwrap();
                }
                let found = twin.intersections(Selection::Everything).first();
                assert_eq!(found.unwrap(), None);
            }
            if distance > 0.0 {
                let between = world.distance(bodies[0], bodies[1], f64::INFINITY).unwrap();
                assert!(between.unwrap().distance > distance);
            }
        }
        assert!(shortened > 20, "{shortened}");
    }
}

/// Refused calls change nothing.
#[test]
fn refusals() {
    let mut world = World::<f64>::new();
    let body = world
        .add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        .unwrap();
    for width in [f64::NAN, f64::INFINITY, -1e-300] {
        let refused = world
            .edge_edge_impacts(Selection::World)
            .width(width)
            .all()
            .unwrap_err();
        assert!(matches!(refused.kind, ErrorKind::BadWidth { .. }));
        assert!(world.first_impact(Selection::World, width).is_err());
        assert!(pliant::edge_edge_impacts::<f64>(&[], &[], width).is_err());
    }
    let other = BodyId(7);
    let refused = world.collision_free_step(Selection::Between(body, other), 0.0);
    assert_eq!(refused.unwrap_err().kind, ErrorKind::NoSuchBody);
    let corners = [[[0.0; 3]; 4]; 2];
    let refused = pliant::vertex_triangle_impacts(&corners, &corners[..1], 1e-6).unwrap_err();
    assert_eq!(
        refused.kind,
        ErrorKind::DifferentCounts { start: 2, end: 1 }
    );
    let mut bad = corners;
    bad[1][2][0] = 1e39;
    let refused = pliant::vertex_triangle_impacts(&corners, &bad, 1e-6).unwrap_err();
    let expected = ErrorKind::BadCorner {
        pair: 1,
        corner: 2,
        position: [1e39, 0.0, 0.0],
    };
    assert_eq!(refused.kind, expected);
    let first = world.first_impact(Selection::Everything, 1e-6).unwrap();
    assert_eq!(first.map(|impact: Impact| impact.low()), None);
}

/// Queries of single pairs look for an interruption between pairs.
///
/// They look between any two pairs that take long, and now and then among the others.
#[test]
fn single_pairs_are_interrupted_between_pairs() {
    let triangle = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let pair = |z: f64| {
        let [a, b, c] = triangle;
        [[1.0, 1.0, z], a, b, c]
    };
    // Every third pair meets, and such pairs are decided one by one.
    let heights = (0..60).map(|at| if at % 3 == 0 { -1.0 } else { 1.0 });
    let start = [pair(1.0); 60];
    let end: Vec<_> = heights.map(pair).collect();
    let asked = AtomicU32::new(0);
    let ask = |until: u32, start: &[[[f64; 3]; 4]], end: &[[[f64; 3]; 4]]| {
        asked.store(0, Ordering::Relaxed);
        let question = || asked.fetch_add(1, Ordering::Relaxed) >= until;
        let answer = pliant::pair_impacts(false, start, end, 1e-6, Some(&question));
        (answer, asked.load(Ordering::Relaxed))
    };
    let all = pliant::vertex_triangle_impacts(&start, &end, 1e-6);
    assert_eq!(ask(u32::MAX, &start, &end), (all, 21));
    for until in 0..21 {
        let (answer, asked) = ask(until, &start, &end);
        assert_eq!(
            (answer.unwrap_err().kind, asked),
            (ErrorKind::Interrupted, until + 1)
        );
    }
    // No pair of a hundred thousand meets.
    let far = vec![pair(1.0); 100_000];
    let (answer, asked) = ask(u32::MAX, &far, &far);
    assert!(answer.unwrap().iter().all(Option::is_none) && asked > 10);
}
