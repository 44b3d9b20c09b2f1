//! Curves: on closed bodies they are closed, end where the mesh says, and enclose an area.

use crate::common::Lcg;
use pliant::{BodyId, Curve, CurveEnd, Curves, ErrorKind, Feature, Pair, Scalar, Selection, World};
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

type Mesh = (Vec<[u32; 3]>, Vec<[f64; 3]>);

/// A closed strip of quads, `around` by `along`, that is closed the other way too, on a torus of
/// radii 1 and 0.4.
fn torus(around: u32, along: u32) -> Mesh {
    let at = |i: u32, j: u32| (i % around) * along + j % along;
    let mut triangles = Vec::new();
    let mut positions = Vec::new();
    for i in 0..around {
        for j in 0..along {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
            let (u, v) = (
                TAU * f64::from(i) / f64::from(around),
                TAU * f64::from(j) / f64::from(along),
            );
            let wide = 1.0 + 0.4 * v.cos();
            positions.push([wide * u.cos(), wide * u.sin(), 0.4 * v.sin()]);
        }
    }
    (triangles, positions)
}

/// A ball of radius 1: rings of `around` vertices between two poles.
fn ball(rings: u32, around: u32) -> Mesh {
    let at = |i: u32, j: u32| 1 + i * around + j % around;
    let last = 1 + rings * around;
    let mut triangles = Vec::new();
    let mut positions = vec![[0.0, 0.0, -1.0]];
    for i in 0..rings {
        let up = PI * (f64::from(i + 1) / f64::from(rings + 1) - 0.5);
        for j in 0..around {
            let turn = TAU * (f64::from(j) + 0.5 * f64::from(i)) / f64::from(around);
            let wide = up.cos();
            positions.push([wide * turn.cos(), wide * turn.sin(), up.sin()]);
            if i == 0 {
                triangles.push([0, at(0, j + 1), at(0, j)]);
            } else {
                let [a, b] = [at(i - 1, j), at(i - 1, j + 1)];
                triangles.extend([[a, b, at(i, j)], [b, at(i, j + 1), at(i, j)]]);
            }
            if i + 1 == rings {
                triangles.push([at(i, j), at(i, j + 1), last]);
            }
        }
    }
    positions.push([0.0, 0.0, 1.0]);
    (triangles, positions)
}

/// A square in the plane z = height, facing up.
fn floor(height: f64) -> Mesh {
    let corner = |x: f64, y: f64| [x, y, height];
    let positions = vec![
        corner(-9.0, -8.0),
        corner(9.0, -9.0),
        corner(9.0, 9.0),
        corner(-9.0, 9.0),
    ];
    (vec![[0, 1, 2], [0, 2, 3]], positions)
}

/// An axis-parallel cube.
fn cube(lower: [f64; 3], side: f64) -> Mesh {
    let corner = |i: u32| [0, 1, 2].map(|axis| lower[axis] + side * f64::from(i >> axis & 1));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    (triangles.collect(), (0..8).map(corner).collect())
}

fn world(bodies: &[Mesh]) -> World<f64> {
    let mut world = World::new();
    for (triangles, positions) in bodies {
        world.add(triangles, positions).unwrap();
    }
    world
}

/// All pairs that meet, those that share a vertex too.
fn pairs<S: Scalar>(world: &mut World<S>, of: Selection) -> Vec<Pair> {
    let mut pairs = world.intersections(of).all().unwrap().to_vec();
    let adjacent = world.adjacent_intersections(of).all().unwrap();
    pairs.extend(adjacent.iter().map(|it| it.pair));
    pairs
}

fn curves_of<S: Scalar>(world: &World<S>, pairs: &[Pair]) -> Curves {
    let mut curves = Curves::new();
    curves.update(world, pairs).unwrap();
    curves
}

/// An edge, by its ends, through a triangle.
type Crossing = (BodyId, [u32; 2], BodyId, u32);

/// The edge that goes through a triangle where a step begins or ends; none at a shared vertex.
fn crossing(curve: &Curve<'_>, step: usize, end: usize) -> Option<(Crossing, usize)> {
    let step = &curve.steps()[step];
    let on = curve.ends_of(step)[end].on;
    let sides = curve.sides(step);
    let edge = |side: usize, i: usize| {
        let (body, _, vertices) = sides[side];
        let mut ends = [vertices[i], vertices[(i + 1) % 3]];
        ends.sort_unstable();
        let (other, triangle, _) = sides[1 - side];
        ((body, ends, other, triangle), side)
    };
    match on {
        [Feature::Edge(i), Feature::Inside] => Some(edge(0, i)),
        [Feature::Inside, Feature::Edge(i)] => Some(edge(1, i)),
        [Feature::Corner(_), Feature::Corner(_)] => None,
        other => panic!("not in general position: {other:?}"),
    }
}

/// Checks what holds in general position of bodies whose triangles are oriented alike. Returns the
/// numbers of closed and of open curves.
fn check_general(world: &mut World<f64>, of: Selection) -> [usize; 2] {
    let pairs = pairs(world, of);
    let curves = curves_of(world, &pairs);
    let segments = curves.segments();
    assert!(curves.touching().is_empty());
    let mut taken = Vec::new();
    let mut crossed = BTreeSet::new();
    let mut counts = [0; 2];
    for curve in curves.iter() {
        let steps = curve.steps();
        taken.extend(steps.iter().map(|step| step.segment));
        assert!(!curve.turns_over());
        let lowest = steps.iter().min_by_key(|step| step.segment).unwrap();
        assert!(!lowest.is_reversed && !lowest.is_swapped);
        let mut length = 0.0;
        for (number, step) in steps.iter().enumerate() {
            let segment = segments.get(step.segment).unwrap();
            let [p, q] = curve.ends_of(step).map(|end| end.point);
            let way: [f64; 3] = std::array::from_fn(|axis| q[axis] - p[axis]);
            length += way.iter().map(|x| x * x).sum::<f64>().sqrt();
            let [m, n] = segment.normals;
            let [m, n] = if step.is_swapped { [n, m] } else { [m, n] };
            let along = (0..3).map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                way[i] * (m[j] * n[k] - m[k] * n[j])
            });
            assert!(along.sum::<f64>() > -1e-12);
            crossed.extend(
                [0, 1]
                    .map(|end| crossing(&curve, number, end))
                    .into_iter()
                    .flatten(),
            );
            if number + 1 < steps.len() || curve.is_closed() {
                let next = (number + 1) % steps.len();
                let [here, there] = [crossing(&curve, number, 1), crossing(&curve, next, 0)];
                assert_eq!(here, there);
                // Across the edge of one side; the other side stays.
                let (_, crossing_side) = here.unwrap();
                let [before, after] = [step, &steps[next]].map(|step| curve.sides(step));
                assert_eq!(before[1 - crossing_side], after[1 - crossing_side]);
                assert_ne!(before[crossing_side].1, after[crossing_side].1);
            }
        }
        assert!((curve.length() - length).abs() < 1e-9);
        let is_closed = curve.is_closed();
        assert_eq!(
            curve.points().count(),
            steps.len() + usize::from(!is_closed)
        );
        for end in curve.ends().into_iter().flatten() {
            assert_eq!(end, CurveEnd::SharedVertex);
        }
        counts[usize::from(!is_closed)] += 1;
    }
    taken.sort_unstable();
    assert!(taken.into_iter().eq(0..pairs.len()), "each segment once");
    // The places are all crossing edges, each once.
    let mut expected = Vec::new();
    let all = world.crossing_edges(of).all().unwrap().to_vec();
    for it in all {
        let ends = world.edges(it.edge_body).unwrap()[it.edge as usize];
        expected.push((it.edge_body, ends, it.triangle_body, it.triangle));
    }
    expected.sort_unstable();
    let mut crossed: Vec<Crossing> = crossed.into_iter().map(|(it, _)| it).collect();
    crossed.dedup();
    assert_eq!(crossed, expected);
    counts
}

#[test]
fn ten_thousand_closed_pairs_meet_in_closed_curves() {
    let mut random = Lcg(5);
    let mut counts = [0; 2];
    let mut of_bodies = [0; 2];
    for _ in 0..25 {
        let meshes = [ball(5, 7), torus(9, 6)];
        let mut world = world(&meshes);
        for _ in 0..400 {
            let wild = 0.6 * random.unit().powi(3);
            for (body, (_, rest)) in meshes.iter().enumerate() {
                let [x, y, z] = [0, 1, 2].map(|_| 1.2 * f64::from(random.unit()) - 0.6);
                let moved = rest.iter().map(|point| {
                    let [p, q, r] = point.map(|x| x + f64::from(wild * (random.unit() - 0.5)));
                    [q + x, r + y, p + z]
                });
                let moved: Vec<[f64; 3]> = moved.collect();
                world.set_positions(BodyId(body as u32), &moved).unwrap();
            }
            let between = Selection::Between(BodyId(0), BodyId(1));
            let [closed, open] = check_general(&mut world, between);
            assert_eq!(open, 0);
            of_bodies[0] += closed;
            let [closed, open] = check_general(&mut world, Selection::Everything);
            counts[0] += closed;
            counts[1] += open;
        }
    }
    assert!(
        of_bodies[0] > 10_000 && counts[0] > 15_000 && counts[1] > 500,
        "{of_bodies:?} {counts:?}"
    );
}

/// Area of a mesh below the plane z = height.
fn area_below((triangles, positions): &Mesh, height: f64) -> f64 {
    let of_triangle = |corners: &[u32; 3]| {
        let corners = corners.map(|vertex| positions[vertex as usize]);
        let mut below: Vec<[f64; 3]> = Vec::new();
        for i in 0..3 {
            let (p, q) = (corners[i], corners[(i + 1) % 3]);
            if p[2] < height {
                below.push(p);
            }
            if (p[2] < height) != (q[2] < height) {
                let t = (height - p[2]) / (q[2] - p[2]);
                below.push([0, 1, 2].map(|axis| p[axis] + t * (q[axis] - p[axis])));
            }
        }
        let mut twice = [0.0; 3];
        for i in 1..below.len().max(2) - 1 {
            let [p, q] = [below[i], below[i + 1]];
            let [p, q] = [p, q].map(|x| [0, 1, 2].map(|axis| x[axis] - below[0][axis]));
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                twice[k] += p[i] * q[j] - p[j] * q[i];
            }
        }
        twice.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
    };
    triangles.iter().map(of_triangle).sum()
}

#[test]
fn areas_are_what_a_plane_cuts_off() {
    for step in 1..40 {
        let height = -1.0 + 0.05 * f64::from(step) + 1e-3;
        let of_ball = ball(9, 12);
        let below = area_below(&of_ball, height);
        let above = area_below(&of_ball, 2.0) - below;
        let mut world = world(&[of_ball, floor(height)]);
        let of = Selection::Everything;
        let pairs = pairs(&mut world, of);
        let curves = curves_of(&world, &pairs);
        assert_eq!(curves.len(), 1);
        let curve = curves.iter().next().unwrap();
        let [on_ball, on_floor] = curve.enclosed_areas(&world).unwrap();
        let expected = if below < above { below } else { -above };
        assert!((on_ball.unwrap() - expected).abs() < 1e-9, "{height}");
        let mut disc = 0.0;
        let points: Vec<_> = curve.points().collect();
        for (p, q) in points.iter().zip(points.iter().cycle().skip(1)) {
            disc += (p[0] * q[1] - p[1] * q[0]) / 2.0;
        }
        // Clockwise from above.
        assert!(
            disc < 0.0 && (on_floor.unwrap() - disc).abs() < 1e-9,
            "{height}"
        );
    }
}

/// All vertices of the floor are outside of a curve round most of it; and triangles stand twice.
#[test]
fn areas_where_no_vertex_is_enclosed_and_where_triangles_stand_twice() {
    let mut box_of_floor = cube([-7.9, -7.8, -1.0], 15.7);
    let areas = |body: &Mesh| {
        let mut world = world(&[body.clone(), floor(0.1)]);
        let all = pairs(&mut world, Selection::World);
        let curves = curves_of(&world, &all);
        let curve = curves.iter().next().unwrap();
        (curves.len(), curve.enclosed_areas(&world).unwrap())
    };
    let (count, [on_cube, on_floor]) = areas(&box_of_floor);
    assert_eq!(count, 1);
    let whole = area_below(&floor(0.1), 1.0);
    let inside = 15.7 * 15.7;
    assert!(whole < 2.0 * inside, "the smaller part is outside");
    // On the right is what is in the cube, so the rest is on the left.
    assert!((on_floor.unwrap() - (whole - inside)).abs() < 1e-9);
    let below = inside + 4.0 * 15.7 * 1.1;
    assert!((on_cube.unwrap() - below).abs() < 1e-9);
    let twice = box_of_floor.0.clone();
    box_of_floor.0.extend(twice);
    let (_, [on_cube, _]) = areas(&box_of_floor);
    assert_eq!(on_cube, None);
}

#[test]
fn a_mesh_that_has_changed_since_has_no_area() {
    let mut world = world(&[ball(5, 7), floor(0.1)]);
    let all = pairs(&mut world, Selection::Everything);
    let curves = curves_of(&world, &all);
    let curve = curves.iter().next().unwrap();
    assert!(curve.enclosed_areas(&world).unwrap()[0].is_some());
    let (triangles, positions) = floor(0.5);
    world.set_mesh(BodyId(0), &triangles, &positions).unwrap();
    assert_eq!(curve.enclosed_areas(&world).unwrap()[0], None);
    world.remove(BodyId(0)).unwrap();
    let error = curve.enclosed_areas(&world).unwrap_err();
    assert_eq!(
        (error.body, error.kind),
        (Some(BodyId(0)), ErrorKind::NoSuchBody)
    );
}

#[test]
fn a_curve_around_the_tube_of_a_torus_encloses_nothing() {
    let of_torus = torus(24, 12);
    let mut world = world(&[of_torus.clone(), floor(0.0123)]);
    let all = pairs(&mut world, Selection::Everything);
    let curves = curves_of(&world, &all);
    assert_eq!(curves.len(), 2);
    for curve in curves.iter() {
        let [on_torus, on_floor] = curve.enclosed_areas(&world).unwrap();
        assert_eq!(on_torus, None);
        assert!(on_floor.is_some());
    }
    // Upright, so that a plane cuts off a bulge.
    let upright: Mesh = (
        of_torus.0,
        of_torus.1.iter().map(|&[x, y, z]| [y, z, x]).collect(),
    );
    let height = -1.2511;
    let mut world = self::world(&[upright.clone(), floor(height)]);
    let all = pairs(&mut world, Selection::Everything);
    let curves = curves_of(&world, &all);
    assert_eq!(curves.len(), 1);
    let curve = curves.iter().next().unwrap();
    let [on_torus, _] = curve.enclosed_areas(&world).unwrap();
    assert!((on_torus.unwrap() - area_below(&upright, height)).abs() < 1e-9);
}

/// Cubes of a lattice: through vertices, along edges, in common planes.
#[test]
fn passages_that_are_degenerate_follow_the_rule() {
    let told = |bodies: &[Mesh]| {
        let mut world = world(bodies);
        let pairs = pairs(&mut world, Selection::Everything);
        let curves = curves_of(&world, &pairs);
        let segments = curves.segments();
        let ends: Vec<_> = curves.iter().map(|it| (it.ends(), it.length())).collect();
        let polygons = segments.iter().filter(|it| it.ends.len() > 2).count();
        (ends, curves.touching().len(), polygons)
    };
    let unit = cube([0.0; 3], 1.0);
    let with = |lower, side| told(&[unit.clone(), cube(lower, side)]);
    // A corner inside: through the diagonals of faces, edge by edge.
    assert_eq!(with([0.5; 3], 1.0), (vec![(None, 3.0)], 0, 0));
    // On a face, at its diagonal and elsewhere; through it, and up to it from inside.
    let loop_of_2 = vec![(None, 2.0)];
    for (lower, polygons) in [
        ([0.25, 0.25, 1.0], 2),
        ([0.5, 0.25, 1.0], 3),
        ([0.25, 0.25, -0.5], 2),
        ([0.25, 0.25, 0.5], 2),
    ] {
        assert_eq!(with(lower, 0.5), (loop_of_2.clone(), 0, polygons));
    }
    // At a corner, and along an edge.
    assert_eq!(with([1.0; 3], 1.0), (vec![], 1, 0));
    let open = Some([CurveEnd::Border; 2]);
    assert_eq!(with([1.0, 1.0, 0.0], 1.0), (vec![(open, 1.0)], 0, 0));
    // One on the other: at each vertex many edges end, and no rule orders them.
    let (ends, points, polygons) = with([0.0; 3], 1.0);
    assert_eq!((ends.len(), points, polygons), (12, 0, 12));
    assert!(
        ends.iter()
            .all(|(ends, _)| *ends == Some([CurveEnd::Branching; 2]))
    );
}

#[test]
fn pairs_that_are_not_there_are_refused_and_nothing_is_left() {
    let mut world = world(&[cube([0.0; 3], 1.0), cube([0.5; 3], 1.0)]);
    let good = pairs(&mut world, Selection::Everything);
    let mut curves = curves_of(&world, &good);
    assert_eq!((curves.len(), curves.segments().len()), (1, good.len()));
    let mut bad = good.clone();
    bad[1].triangle_b = 12;
    let error = curves.update(&world, &bad).unwrap_err();
    assert_eq!(error.body, Some(bad[1].body_b));
    let expected = ErrorKind::NoSuchTriangle {
        triangle: 12,
        triangles: 12,
    };
    assert_eq!(error.kind, expected);
    assert!(curves.is_empty() && curves.segments().is_empty());
    bad[1].body_b = BodyId(7);
    let error = curves.update(&world, &bad).unwrap_err();
    assert_eq!(
        (error.body, error.kind),
        (Some(BodyId(7)), ErrorKind::NoSuchBody)
    );
    // Pairs that do not meet have no ends.
    bad.truncate(1);
    bad[0].triangle_a = 0;
    bad[0].triangle_b = 11;
    curves.update(&world, &bad).unwrap();
    assert!(curves.is_empty() && curves.segments().get(0).unwrap().ends.is_empty());
    assert!(curves.segments().get(1).is_none());
}
