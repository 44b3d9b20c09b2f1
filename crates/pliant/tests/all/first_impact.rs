//! The first impact is the exactly earliest, ties are broken by order, and free steps are long.

use crate::common::{Lcg, sheet};
use crate::impacts::{Known, Lists};
use pliant::{Degree, Impact, Options, Scalar, Selection, World};
use pliant_oracle::{Elements, FirstContact, first_contact};
use std::num::{NonZeroU32, NonZeroUsize};

const ALL: Selection = Selection::Everything;

/// Configurations of all degrees and several leaf sizes, with one thread and three in turns.
fn configurations() -> impl Iterator<Item = Options> {
    let degrees = [Degree::Two, Degree::Four, Degree::Eight];
    let all = degrees
        .into_iter()
        .flat_map(|degree| [1, 2, 4, 8, 20].map(|leaf| (degree, leaf)));
    all.enumerate().map(|(turn, (degree, leaf))| {
        let mut options = Options::default();
        options.degree = degree;
        options.leaf_size = NonZeroU32::new(leaf).unwrap();
        options.threads = NonZeroUsize::new(1 + turn % 2 * 2).unwrap();
        options
    })
}

/// Elements of an impact as the oracle takes them: their corners at the start and at the end.
fn motion_of<S: Scalar>(
    world: &World<S>,
    known: &[Known<S>],
    impact: &Impact,
) -> (Elements, pliant_oracle::Moving) {
    let at = |body: pliant::BodyId, vertex: u32| {
        let body = known.iter().find(|it| it.id == body).unwrap();
        let [start, end] = [
            &body.positions,
            body.end.as_ref().unwrap_or(&body.positions),
        ];
        [start, end].map(|shape| shape[vertex as usize].map(Scalar::to_f64))
    };
    let (elements, corners) = match impact {
        Impact::VertexTriangle(impact) => {
            let pair = impact.pair;
            let triangles = world.triangles(pair.triangle_body).unwrap();
            let [a, b, c] = triangles[pair.triangle as usize].map(|it| at(pair.triangle_body, it));
            let vertex = at(pair.vertex_body, pair.vertex);
            (Elements::VertexTriangle, [vertex, a, b, c])
        }
        Impact::EdgeEdge(impact) => {
            let pair = impact.pair;
            let ends = |body, edge: u32| {
                let edges = world.edges(body).unwrap();
                edges[edge as usize].map(|it| at(body, it))
            };
            let [[a, b], [c, d]] = [
                ends(pair.body_a, pair.edge_a),
                ends(pair.body_b, pair.edge_b),
            ];
            (Elements::EdgeEdge, [a, b, c, d])
        }
    };
    (
        elements,
        [0, 1].map(|end| corners.map(|corner| corner[end])),
    )
}

/// The first of all impacts, by the reference's lists and the oracle's exact times.
fn first_of_all<S: Scalar>(world: &World<S>, known: &[Known<S>]) -> Option<(Impact, FirstContact)> {
    let lists = Lists::of_all(known, 0.0).sorted();
    let vertices = lists
        .vertex_triangle
        .into_iter()
        .map(Impact::VertexTriangle);
    let edges = lists.edge_edge.into_iter().map(Impact::EdgeEdge);
    let all: Vec<Impact> = vertices.chain(edges).collect();
    let least = all.iter().map(Impact::high).reduce(f64::min)?;
    let earliest = all.into_iter().filter(|impact| impact.high() == least);
    let timed = earliest.map(|impact| {
        let (elements, motion) = motion_of(world, known, &impact);
        (impact, first_contact(elements, &motion).unwrap())
    });
    timed.reduce(|first, next| {
        if next.1.compare_with(&first.1).is_lt() {
            next
        } else {
            first
        }
    })
}

/// The elements of an impact: whether they are edges, and their numbers.
fn pair_of(impact: Impact) -> (bool, [u32; 4]) {
    match impact {
        Impact::VertexTriangle(impact) => (false, impact.pair.into()),
        Impact::EdgeEdge(impact) => (true, impact.pair.into()),
    }
}

/// Compares the first impact of every configuration, kind and width with the exactly earliest.
///
/// The free step is at least 0.9 of its time.
fn check<S: Scalar>(bodies: &[(Vec<[u32; 3]>, Vec<[S; 3]>, Vec<[S; 3]>)], what: &str) -> f64 {
    let mut time = 1.0;
    let mut expected = None;
    for options in configurations() {
        let mut world = World::<S>::with_options(options);
        let mut known = Vec::new();
        for (triangles, positions, end) in bodies {
            let id = world.add(triangles, positions).unwrap();
            world.set_motion(id, end).unwrap();
            known.push(Known {
                id,
                triangles: triangles.clone(),
                positions: positions.clone(),
                end: Some(end.clone()),
            });
        }
        let (expected, _) = expected.get_or_insert_with(|| {
            let first = first_of_all(&world, &known).unwrap();
            time = first.0.high();
            (pair_of(first.0), first)
        });
        for width in [1e-6, 0.0, 1.0] {
            let first = world.first_impact(ALL, width).unwrap().unwrap();
            assert_eq!(pair_of(first), *expected, "{what}, {options:?}");
            let [low, high] = [first.low(), first.high()];
            assert!(low < time && high >= time && high - low <= width.max(f64::EPSILON));
            let query = world.vertex_triangle_impacts(ALL).width(width).first();
            let of_kind = query.unwrap().map(|it| pair_of(Impact::VertexTriangle(it)));
            assert!(
                expected.0 || of_kind == Some(*expected),
                "{what}, {options:?}"
            );
            let query = world.edge_edge_impacts(ALL).width(width).first();
            let of_kind = query.unwrap().map(|it| pair_of(Impact::EdgeEdge(it)));
            assert!(
                !expected.0 || of_kind == Some(*expected),
                "{what}, {options:?}"
            );
        }
        let step = world.collision_free_step(ALL, 0.0).unwrap();
        assert!(
            step < time && step >= 0.9 * time,
            "{what}: {step} of {time}, {options:?}"
        );
    }
    time
}

/// A triangle that opens while it falls, so that its inside meets a vertex exactly at d.
///
/// Its determinant has a double root besides.
fn opening(d: f64) -> [[[f64; 3]; 3]; 2] {
    let start = [[d, 0.0, 0.0], [0.0, d, 0.0], [-d, -d, -d]];
    let by = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 1.0]];
    let moved = |i: usize| [0, 1, 2].map(|axis: usize| start[i][axis] + by[i][axis]);
    [start, [0, 1, 2].map(moved)]
}

#[test]
fn a_contact_that_is_late_hides_none_that_is_early() {
    let (early, late) = (2f64.powi(-14), 2f64.powi(-11));
    let one = |[start, end]: [[[f64; 3]; 3]; 2]| (vec![[0, 1, 2]], start.to_vec(), end.to_vec());
    let high = [
        [100.25, 100.25, 0.0],
        [100.25, 100.5, -9.0],
        [100.5, 100.25, -9.0],
    ];
    let floor = [
        [100.0, 100.0, late],
        [101.0, 100.0, late],
        [100.0, 101.0, late],
    ];
    let fallen = floor.map(|[x, y, z]| [x, y, z - 1.0]);
    let spike = [[0.0, 0.0, 0.0], [0.25, 0.0, 100.0], [0.0, 0.25, 100.0]];
    let bodies = [
        one([high; 2]),
        one([floor, fallen]),
        one([spike; 2]),
        one(opening(early)),
    ];
    assert_eq!(check(&bodies, "late and early"), early);
}

#[test]
fn of_equal_triangles_the_first_is_named() {
    let vertex = [[1.0, 4.0, 2.0]; 3].to_vec();
    let to = [[0.0, 2.0, -3.0]; 3].to_vec();
    let start = vec![[-2.0, -4.0, 4.0], [3.0, -4.0, -4.0], [-3.0, -4.0, 0.0]];
    let end = vec![[4.0, -4.0, 3.0], [0.0, 4.0, -3.0], [-1.0, 0.0, -1.0]];
    for options in configurations() {
        let mut world = World::<f64>::with_options(options);
        let point = world.add(&[[0, 0, 0]], &vertex).unwrap();
        let nine = world.add(&[[0, 1, 2]; 9], &start).unwrap();
        world.set_motion(point, &to).unwrap();
        world.set_motion(nine, &end).unwrap();
        let first = world.first_impact(Selection::Between(point, nine), 0.0);
        let Some(Impact::VertexTriangle(first)) = first.unwrap() else {
            panic!("a vertex meets a triangle")
        };
        assert_eq!(first.pair.triangle, 0, "{options:?}");
    }
}

/// Small scenes side by side, each with a contact at a known time.
///
/// Times are equal, in one cell of the search, or far apart.
fn planted(seed: u32) -> Vec<(Vec<[u32; 3]>, Vec<[f64; 3]>, Vec<[f64; 3]>)> {
    let mut random = Lcg(u64::from(seed));
    let exponent = 4 + random.below(12) as i32;
    let earliest = f64::from(1 + random.below(64)) / 64.0 * 2f64.powi(-exponent);
    let mut bodies = vec![(Vec::new(), Vec::new(), Vec::new()); 4];
    let mut put = |body: u32, start: [[f64; 3]; 3], end: [[f64; 3]; 3]| {
        let (triangles, from, to): &mut (Vec<[u32; 3]>, Vec<_>, Vec<_>) =
            &mut bodies[body as usize];
        let first = from.len() as u32;
        triangles.push([first, first + 1, first + 2]);
        from.extend(start);
        to.extend(end);
    };
    for place in 0..6 + random.below(12) {
        // All of this is exact: times are multiples of 2^-45.
        let time = match random.below(5) {
            0 | 1 => earliest,
            2 => earliest + f64::from(random.below(4)) * 2f64.powi(-45),
            3 => earliest * f64::from(2 + random.below(6)),
            _ => (earliest * 50.0).min(0.75),
        };
        let aside = 100.0 * f64::from(place);
        let size = 2f64.powi(random.below(7) as i32 - 3);
        let at = |[x, y, z]: [f64; 3]| [size * x + aside, size * y, size * z];
        let [a, b] = [random.below(4), random.below(4)];
        let spike = [[0.0, 0.0, 0.0], [0.25, 0.0, 9.0], [0.0, 0.25, 9.0]].map(at);
        match random.below(3) {
            0 => {
                put(a, spike, spike);
                let [start, end] = opening(time);
                put(b, start.map(at), end.map(at));
            }
            1 => {
                // A floor comes up to the spike.
                let floor = [[-1.0, -1.0, -time], [2.0, -1.0, -time], [-1.0, 2.0, -time]];
                let end = floor.map(|[x, y, z]| [x, y, z + 1.0]);
                put(a, spike, spike);
                put(b, floor.map(at), end.map(at));
            }
            _ => {
                // An edge comes down on another across it.
                let below = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -9.0]];
                let above = [[0.0, -1.0, time], [0.0, 1.0, time], [0.0, 0.0, 9.0]];
                let end = above.map(|[x, y, z]| [x, y, z - 1.0]);
                put(a, below.map(at), below.map(at));
                put(b, above.map(at), end.map(at));
            }
        }
    }
    bodies.retain(|(triangles, ..)| !triangles.is_empty());
    // Numbers of triangles are shuffled, so that their order is not the order in space.
    for (triangles, ..) in &mut bodies {
        for from in (1..triangles.len()).rev() {
            triangles.swap(from, random.below(from as u32 + 1) as usize);
        }
    }
    bodies
}

#[test]
fn the_first_is_the_exactly_earliest_wherever_others_are() {
    for seed in 0..40 {
        check(&planted(seed), &format!("seed {seed}"));
    }
}

/// A sheet turned inside out through a plane, where nearly all of it meets at one time.
///
/// Rotated, it meets at nearly one time. Neither is listed nor timed as a whole.
#[test]
fn what_meets_all_at_once_is_neither_listed_nor_timed() {
    let side = 12;
    let mut random = Lcg(5);
    let triangles = sheet(side).0;
    let flat: Vec<[f64; 3]> = (0..side * side)
        .map(|at| {
            let [column, row] = [at % side, at / side].map(f64::from);
            [column - 5.5, row, f64::from(random.unit())]
        })
        .collect();
    let world_of = |motion: &dyn Fn([f64; 3]) -> [f64; 3], turned: bool| {
        let placed = |[x, y, z]: [f64; 3]| {
            if turned {
                [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z]
            } else {
                [x, y, z]
            }
        };
        let start: Vec<_> = flat.iter().copied().map(placed).collect();
        let end: Vec<_> = flat.iter().map(|&p| placed(motion(p))).collect();
        let mut world = World::<f64>::new();
        let id = world.add(&triangles, &start).unwrap();
        world.set_motion(id, &end).unwrap();
        let known = Known {
            id,
            triangles: triangles.clone(),
            positions: start,
            end: Some(end),
        };
        (world, [known])
    };
    for (turned, by) in [(false, -1.0), (false, -2.0), (true, -1.0)] {
        let (mut world, known) = world_of(&|[x, y, z]| [by * x, y, z], turned);
        let first = world.first_impact(ALL, 1e-6).unwrap().unwrap();
        let (memory, taken) = (world.memory_usage(), world.statistics().pairs);
        let (expected, time) = first_of_all(&world, &known).unwrap();
        assert_eq!(pair_of(first), pair_of(expected));
        let step = world.collision_free_step(ALL, 0.0).unwrap();
        assert!(time.compare(step).is_gt() && step >= 0.9 * first.low());
        // Few were the earliest for a while, of the thousands that met then. About as much memory
        // is held as where nothing meets.
        let edges = world.edge_edge_impacts(ALL).all().unwrap();
        let as_early = edges.iter().filter(|it| it.high == first.high()).count();
        let apart = |[x, y, z]: [f64; 3]| [by * x, y, z + 100.0 * x];
        let (mut twin, _) = world_of(&apart, turned);
        twin.first_impact(ALL, 1e-6).unwrap();
        let of_twin = twin.memory_usage();
        println!(
            "{as_early} as early, {taken} taken; {memory} bytes, {of_twin} where they are apart"
        );
        assert!(as_early > 1000 && taken < 40);
        assert!(memory < of_twin + 8 * as_early);
    }
}

type Corner = [f64; 3];

/// Weighted sum of three corners.
fn sum_of(corners: [Corner; 3], times: [f64; 3]) -> Corner {
    [0, 1, 2].map(|i: usize| (0..3).map(|k| times[k] * corners[k][i]).sum())
}

/// The free step beside a vertex that follows a turning triangle at a small distance.
///
/// The vertex is `units` units in the last place of the largest coordinate away from the triangle's
/// plane. A contact elsewhere at a known time bounds the step. Returns the least distance up to
/// that time, in units, and the step as a part of that time.
fn beside(random: &mut Lcg, units: f64) -> (f64, f64) {
    // Coordinates are from 2^10 to 2^11, so a unit is 2^-42. All numbers here are exact.
    let unit = 2f64.powi(-42);
    let mut number = || {
        let [high, low] = [(); 2].map(|()| f64::from(random.below(1 << 23)));
        1100.0
            + ((high * 2f64.powi(23) + low) * 2f64.powi(-37) / (4.0 * unit)).floor() * (4.0 * unit)
    };
    let mut shape = || [(); 3].map(|()| [(); 3].map(|()| number()));
    let ends = [shape(), shape()];
    let vertices = ends.map(|[a, b, c]| sum_of([a, b, c], [0.25, 0.25, 0.5]));
    let normal = |t: f64| {
        let [a, b, c] =
            [0, 1, 2].map(|k: usize| sum_of([ends[0][k], ends[1][k], [0.0; 3]], [1.0 - t, t, 0.0]));
        let [e, f] = [b, c].map(|p| sum_of([p, a, a], [1.0, -1.0, 0.0]));
        [
            e[1] * f[2] - e[2] * f[1],
            e[2] * f[0] - e[0] * f[2],
            e[0] * f[1] - e[1] * f[0],
        ]
    };
    let slope = |t: f64| {
        let n = normal(t);
        n[2] / n.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let least = (0..=64).map(|at| slope(0.75 / 64.0 * f64::from(at)).abs());
    let least = least.fold(f64::INFINITY, f64::min);
    let mut world = World::<f64>::new();
    let mut put = |start: [Corner; 3], end: [Corner; 3]| {
        let body = world.add(&[[0, 1, 2]], &start).unwrap();
        world.set_motion(body, &end).unwrap();
    };
    put(ends[0], ends[1]);
    let [from, to] = vertices.map(|[x, y, z]| [[x, y, z + units * unit]; 3]);
    put(from, to);
    let floor = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    put(floor, floor);
    let falling = [[0.0, 0.0, 3.0], [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]];
    put(falling, falling.map(|[x, y, z]| [x, y, z - 4.0]));
    let first = world.first_impact(ALL, 0.0).unwrap().unwrap();
    let step = world.collision_free_step(ALL, 0.0).unwrap();
    // The triangle may become flat before; then the first contact is not at the known time.
    let is_falling = first.high() == 0.75;
    (
        if is_falling { units * least } else { 0.0 },
        step / first.high(),
    )
}

/// Points nine units apart or more shorten no step.
///
/// Rounding moves two points towards each other by at most five units on each axis.
#[test]
fn steps_are_long_where_all_is_nine_units_apart_and_may_be_short_where_it_is_one() {
    let mut random = Lcg(9);
    let [mut long, mut short] = [0; 2];
    for _ in 0..400 {
        let (distance, part) = beside(&mut random, 24.0);
        if distance > 9.5 {
            assert!(part >= 0.9, "{distance} {part}");
            long += 1;
        }
        let (distance, part) = beside(&mut random, 1.0);
        assert!(distance <= 1.0);
        short += u32::from(distance > 0.0 && part < 0.9);
    }
    println!("{long} long, {short} short");
    assert!(long > 50 && short > 0);
}
