//! Inside, closest points, depth and containment, against exact judges of other formulations.
//!
//! Surfaces have their vertices on coarse lattices, so that they cross and touch themselves. Points
//! are on vertices, on edges, in walls and straight below them.

use crate::common::{Lcg, covering_configurations, share};
use pliant::{
    BodyId, ContactKind, Contained, Curve, Curves, ErrorKind, Feature, InsideRule, Located,
    Options, Scalar, Selection, Side, World,
};
use pliant_exact::distance::nearest_triangle;
use pliant_oracle::{compare_distance, winding_number};
use std::cmp::Ordering;
use std::num::NonZeroUsize;

type Mesh<S> = (Vec<[u32; 3]>, Vec<[S; 3]>);
type Triangle = [[f64; 3]; 3];

/// A box whose sides are grids, from one corner to the other, turned outward.
fn grid_box(side: u32, lo: [f64; 3], hi: [f64; 3]) -> Mesh<f64> {
    let mut numbers = std::collections::BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut vertex = |at: [u32; 3]| {
        *numbers.entry(at).or_insert_with(|| {
            let part = |k: usize| f64::from(at[k]) / f64::from(side);
            positions.push([0, 1, 2].map(|k| lo[k] + part(k) * (hi[k] - lo[k])));
            positions.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        for (end, turned) in [(0, true), (side, false)] {
            for (u, v) in (0..side).flat_map(|u| (0..side).map(move |v| (u, v))) {
                let mut at = |u: u32, v: u32| {
                    let mut at = [end; 3];
                    (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (u, v);
                    vertex(at)
                };
                let [a, b, c, d] = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
                for [p, q, r] in [[a, b, c], [a, c, d]] {
                    triangles.push(if turned { [p, r, q] } else { [p, q, r] });
                }
            }
        }
    }
    (triangles, positions)
}

/// A tube along a closed curve that winds twice and crosses itself; its profile is an eight.
fn twisted(steps: u32) -> Mesh<f64> {
    let turn = std::f64::consts::TAU / f64::from(steps);
    let ring = 8;
    let position = |k: u32| {
        let (u, v) = (
            2.0 * turn * f64::from(k / ring),
            std::f64::consts::TAU * f64::from(k % ring) / 8.0,
        );
        let (x, z) = (1.5 * v.sin(), (2.0 * v).sin());
        let r = 2.0 + x * (0.5 * u).cos() - z * (0.5 * u).sin();
        // On a lattice, so that much is in one plane.
        [r * u.cos(), r * u.sin(), x * (0.5 * u).sin() + z].map(|x| (x * 4.0).round() / 4.0)
    };
    let at = |i: u32, j: u32| i % steps * ring + j % ring;
    let quad = |k: u32| {
        let (i, j) = (k / ring, k % ring);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..steps * ring).flat_map(quad).collect();
    (triangles, (0..steps * ring).map(position).collect())
}

fn surface<S: Scalar>(triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Vec<Triangle> {
    let live = triangles.iter().filter(|corners| corners[0] != u32::MAX);
    let corner = |it: u32| positions[it as usize].map(Scalar::to_f64);
    live.map(|corners| corners.map(corner)).collect()
}

/// Points about a surface: on a lattice, in its corners, edges and faces, and a hair off.
fn points_about(random: &mut Lcg, surface: &[Triangle], count: usize) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for _ in 0..count / 4 {
        points.push([0; 3].map(|_: i32| f64::from(random.below(17)) / 2.0 - 4.0));
        let [a, b, c] = surface[random.below(surface.len() as u32) as usize];
        let mix = |x: f64, y: f64| [0, 1, 2].map(|k| a[k] + x * (b[k] - a[k]) + y * (c[k] - a[k]));
        let part = [(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.25, 0.25)][random.below(4) as usize];
        let on = mix(part.0, part.1);
        points.push(on);
        points.push(on.map(|x| x + f64::from(f32::EPSILON) * (f64::from(random.below(9)) - 4.0)));
        points.push([0; 3].map(|_: i32| 8.0 * f64::from(random.unit()) - 4.0));
    }
    points
        .iter()
        .map(|point| point.map(|x| f64::from(x as f32)))
        .collect()
}

fn located(windings: &[Option<i32>], rule: InsideRule) -> Vec<Located> {
    let of = |winding: &Option<i32>| {
        let Some(number) = *winding else {
            return Located {
                side: Side::On,
                winding: 0,
            };
        };
        let winding = if rule == InsideRule::Parity {
            number.rem_euclid(2)
        } else {
            number
        };
        let is_in = if rule == InsideRule::Positive {
            winding > 0
        } else {
            winding != 0
        };
        let side = if is_in { Side::Inside } else { Side::Outside };
        Located { side, winding }
    };
    windings.iter().map(of).collect()
}

fn to<S: Scalar + From<f32>>(points: &[[f64; 3]]) -> Vec<[S; 3]> {
    points
        .iter()
        .map(|point| point.map(|x| S::from(x as f32)))
        .collect()
}

/// The nearest triangle by brute force, of the caller's numbers.
fn nearest<S: Scalar>(triangles: &[[u32; 3]], positions: &[[S; 3]], point: [f64; 3]) -> u32 {
    let live = (0..triangles.len()).filter(|&it| triangles[it][0] != u32::MAX);
    let live: Vec<usize> = live.collect();
    live[nearest_triangle(&point, &surface(triangles, positions))] as u32
}

/// Lives of a body in every configuration: it moves, is edited, and its tree is rebuilt. Points are
/// many, few, or new each time.
fn live<S: Scalar + From<f32>>(seed: u64, mesh: &Mesh<f64>, steps: usize) -> [usize; 3] {
    let mut random = Lcg(seed);
    let (triangles, at_first) = (&mesh.0, to::<S>(&mesh.1));
    let configurations = covering_configurations();
    let world = |options: &Options| {
        let mut options = *options;
        options.threads = NonZeroUsize::new(1 + usize::from(options.leaf_size.get() > 1)).unwrap();
        let mut world = World::with_options(options);
        let body = world.add(triangles, &at_first).unwrap();
        (world, body)
    };
    let mut worlds: Vec<(World<S>, BodyId)> = configurations.iter().map(world).collect();
    let mut counts = [0; 3];
    for step in 0..steps {
        let vertices = worlds[0].0.vertex_count(worlds[0].1).unwrap();
        let mut moved = worlds[0].0.positions(worlds[0].1).unwrap();
        for _ in 0..vertices / 4 {
            let vertex = random.below(vertices as u32) as usize;
            let axis = random.below(3) as usize;
            let by = (random.below(5) as f32 - 2.0) / 4.0;
            moved[vertex][axis] = moved[vertex][axis] + S::from(by);
        }
        let split = random.below(triangles.len() as u32);
        for (world, body) in &mut worlds {
            world.set_positions(*body, &moved).unwrap();
            if step % 3 == 1 && world.triangles(*body).unwrap()[split as usize][0] != u32::MAX {
                let [a, b, c] = world.triangles(*body).unwrap()[split as usize];
                let mut edit = world.edit(*body).unwrap();
                let middle = edit.add_vertex(moved[a as usize]);
                edit.remove_triangles(&[split]);
                edit.add_triangles(&[[a, b, middle], [b, c, middle], [c, a, middle]]);
                world.apply(&edit).unwrap();
            }
            if step % 4 == 3 {
                world.rebuild(*body).unwrap();
            }
        }
        let (first, body) = &worlds[0];
        let (triangles, positions) = (
            first.triangles(*body).unwrap().to_vec(),
            first.positions(*body).unwrap(),
        );
        let all = surface(&triangles, &positions);
        let count = [64, 4, 200][step % 3];
        let points = points_about(&mut random, &all, count);
        let windings: Vec<_> = points.iter().map(|&it| winding_number(it, &all)).collect();
        counts[0] += windings.iter().filter(|it| it.is_none()).count();
        counts[1] += windings
            .iter()
            .filter(|it| it.is_some_and(|it| it != 0))
            .count();
        counts[2] += windings
            .iter()
            .filter(|it| it.is_some_and(|it| it.abs() > 1))
            .count();
        let nearest: Vec<u32> = points
            .iter()
            .map(|&it| nearest(&triangles, &positions, it))
            .collect();
        let cut_off = [0.25, 0.5, 1.0][step % 3];
        let is_near = |(&point, &triangle): (&[f64; 3], &u32)| {
            let corners = triangles[triangle as usize];
            let corners = corners.map(|it| positions[it as usize].map(Scalar::to_f64));
            compare_distance(&[point], &corners, cut_off) != Ordering::Greater
        };
        let is_near: Vec<bool> = points.iter().zip(&nearest).map(is_near).collect();
        // What one configuration found is not judged again where another finds the same.
        let mut judged = Vec::new();
        let asked = to::<S>(&points);
        for (options, (world, body)) in configurations.iter().zip(&mut worlds) {
            for rule in [
                InsideRule::NonZero,
                InsideRule::Positive,
                InsideRule::Parity,
            ] {
                let found = world.points_inside(&asked, *body, rule).unwrap();
                assert_eq!(found, located(&windings, rule), "{options:?}");
            }
            let found = world
                .signed_closest_points(&asked, *body, f64::INFINITY)
                .unwrap();
            for (place, found) in found.iter().enumerate() {
                let found = found.expect("nothing is further");
                assert_eq!(
                    found.triangle, nearest[place],
                    "{options:?} {:?}",
                    points[place]
                );
                let is_in = windings[place].is_some_and(|it| it != 0);
                assert_eq!(found.distance < 0.0, is_in);
                assert_eq!(found.distance == 0.0, windings[place].is_none());
                if judged.get(place) != Some(&found) {
                    check_distance(found, points[place], &triangles, &positions);
                }
            }
            judged = found.into_iter().flatten().collect();
            let near = world.closest_points(&asked, Some(*body), cut_off).unwrap();
            assert!(near.iter().map(Option::is_some).eq(is_near.iter().copied()));
        }
    }
    counts
}

/// The figures of a closest point agree with each other, and with an oracle.
fn check_distance<S: Scalar>(
    found: pliant::ClosestPoint,
    point: [f64; 3],
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) {
    let corners =
        triangles[found.triangle as usize].map(|it| positions[it as usize].map(Scalar::to_f64));
    let distance = found.distance.abs();
    let within = |x: f64| compare_distance(&[point], &corners, x);
    assert_ne!(within(distance * (1.0 + 1e-9)), Ordering::Greater);
    assert_ne!(within(distance * (1.0 - 1e-9)), Ordering::Less);
    let way = [0, 1, 2].map(|k| point[k] - found.point[k]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!(
        (length - distance).abs() <= 1e-9 * distance + 1e-12,
        "{found:?}"
    );
    let part = match found.feature {
        Feature::Corner(k) => vec![corners[k]],
        Feature::Edge(k) => vec![corners[k], corners[(k + 1) % 3]],
        Feature::Inside => corners.to_vec(),
    };
    for x in [distance * (1.0 + 1e-9), distance * (1.0 - 1e-9)] {
        assert_eq!(compare_distance(&[point], &part, x), within(x), "{found:?}");
    }
}

#[test]
fn every_configuration_agrees_with_the_oracles() {
    let steps = share(4, 1).max(3);
    let mut all = [0; 3];
    let meshes = [grid_box(3, [-2.0; 3], [2.0; 3]), twisted(12)];
    for (seed, mesh) in (1..).zip(&meshes) {
        for counts in [
            live::<f32>(seed, mesh, steps),
            live::<f64>(seed + 10, mesh, steps),
        ] {
            (0..3).for_each(|k| all[k] += counts[k]);
        }
    }
    let [on, inside, twice] = all;
    assert!(on > 100 && inside > 100 && twice > 10, "{all:?}");
}

/// Points rounded from p + h n, where h is from 2^-40 to 2^40 units in the last place.
#[test]
fn a_hair_off_the_surface_nothing_is_undecided() {
    let (triangles, positions) = twisted(9);
    let positions: Vec<[f64; 3]> = positions.iter().map(|p| p.map(|x| x * 0.3 + 0.1)).collect();
    let mut world = World::<f64>::new();
    let body = world.add(&triangles, &positions).unwrap();
    let all = surface(&triangles, &positions);
    let mut points = Vec::new();
    for (face, [a, b, c]) in all.iter().enumerate().step_by(5) {
        let e = [0, 1, 2].map(|k| b[k] - a[k]);
        let f = [0, 1, 2].map(|k| c[k] - a[k]);
        let n =
            [0, 1, 2].map(|k| e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3]);
        let parts = [(1.0 / 3.0, 1.0 / 3.0), (0.5, 0.0), (0.0, 0.0)];
        let (x, y) = parts[face % 3];
        for power in (-40..=40).step_by(4) {
            let h = f64::powi(2.0, power - 52) * if power % 8 == 0 { 1.0 } else { -1.0 };
            points.push([0, 1, 2].map(|k| a[k] + x * e[k] + y * f[k] + h * n[k]));
        }
    }
    let windings: Vec<_> = points.iter().map(|&it| winding_number(it, &all)).collect();
    let found = world
        .points_inside(&points, body, InsideRule::NonZero)
        .unwrap();
    assert_eq!(found, located(&windings, InsideRule::NonZero));
    let signed = world
        .signed_closest_points(&points, body, f64::INFINITY)
        .unwrap();
    for (found, winding) in signed.iter().zip(&windings) {
        let distance = found.expect("nothing is further").distance;
        let sign = i32::from(distance > 0.0) - i32::from(distance < 0.0);
        let expected = winding.map_or(0, |it| if it != 0 { -1 } else { 1 });
        assert_eq!(sign, expected);
    }
}

#[test]
fn vertices_of_a_body_are_points() {
    let mut world = World::<f64>::new();
    let (triangles, positions) = grid_box(4, [-2.0; 3], [2.0; 3]);
    let large = world.add(&triangles, &positions).unwrap();
    let shifted: Vec<[f64; 3]> = positions.iter().map(|p| p.map(|x| x + 1.0)).collect();
    let small = world.add(&triangles, &shifted).unwrap();
    let mut edit = world.edit(small).unwrap();
    edit.remove_triangles(&[0, 1]);
    world.apply(&edit).unwrap();
    let found = world.inside(small, large, InsideRule::NonZero).unwrap();
    let expected = world
        .points_inside(&shifted, large, InsideRule::NonZero)
        .unwrap();
    let live = world.live_vertices(small).unwrap();
    for (vertex, found) in found.iter().enumerate() {
        let expected = if live[vertex] {
            expected[vertex]
        } else {
            Located::default()
        };
        assert_eq!(*found, expected, "{vertex}");
    }
    assert!(found.iter().any(|it| it.side == Side::On));
    assert!(found.iter().any(|it| it.side == Side::Inside));
}

#[test]
fn of_all_bodies_the_first_of_the_nearest() {
    let mut world = World::<f32>::new();
    let corners = |z: f32| [[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z]];
    let bodies: Vec<BodyId> = [3.0, -1.0, 1.0, 1.0]
        .iter()
        .map(|&z| world.add(&[[0, 1, 2], [2, 1, 0]], &corners(z)).unwrap())
        .collect();
    let found = world
        .closest_points(&[[1.0, 1.0, 0.0], [1.0, 1.0, 2.5]], None, 9.0)
        .unwrap();
    let first = found
        .iter()
        .map(|it| it.map(|it| (it.body, it.triangle, it.distance)));
    let expected = [Some((bodies[1], 0, 1.0)), Some((bodies[0], 0, 0.5))];
    assert!(first.eq(expected));
    world.remove(bodies[1]).unwrap();
    let found = world.closest_points(&[[1.0, 1.0, 0.0]], None, 1.0).unwrap();
    assert_eq!(found[0].map(|it| it.body), Some(bodies[2]));
    let none = world
        .closest_points(&[[1.0, 1.0, 0.0]], None, 0.999)
        .unwrap();
    assert_eq!(none, [None]);
    assert_eq!(
        World::<f32>::new()
            .closest_points(&[[0.0; 3]], None, 1.0)
            .unwrap(),
        [None]
    );
}

/// An overlap of exactly 1.5, tessellated coarse, middle and fine.
#[test]
fn brackets_hold_the_depth() {
    let mut widths = Vec::new();
    for side in [1, 3, 12] {
        let mut world = World::<f64>::new();
        let (triangles, positions) = grid_box(side, [0.0; 3], [4.0; 3]);
        let a = world.add(&triangles, &positions).unwrap();
        let (triangles, positions) = grid_box(side, [2.5, -4.0, -4.0], [12.5, 8.0, 8.0]);
        let b = world.add(&triangles, &positions).unwrap();
        let depth = world.depth(a, b).unwrap();
        assert!(
            depth.at_least <= 1.5 && 1.5 <= depth.at_most,
            "{side}: {depth:?}"
        );
        assert_eq!(depth.at_least, 1.5);
        let deepest = depth.vertex.unwrap() as usize;
        assert_eq!(depth.of_vertices[deepest], 1.5);
        widths.push(depth.at_most - depth.at_least);
        let apart = positions
            .iter()
            .map(|[x, y, z]| [x + 20.0, *y, *z])
            .collect::<Vec<_>>();
        world.set_positions(b, &apart).unwrap();
        let none = world.depth(a, b).unwrap();
        assert_eq!((none.vertex, none.at_least, none.at_most), (None, 0.0, 0.0));
    }
    assert!(
        widths[0] > widths[1] && widths[1] > widths[2] && widths[2] < 0.3,
        "{widths:?}"
    );
}

/// A triangle goes through a body with no vertex inside: only the upper bound tells.
#[test]
fn what_pierces_has_a_depth_without_a_vertex() {
    let mut world = World::<f64>::new();
    let (triangles, positions) = grid_box(2, [-1.0; 3], [1.0; 3]);
    let body = world.add(&triangles, &positions).unwrap();
    let spike = [[-9.0, 0.0, 0.0], [9.0, 0.1, 0.0], [9.0, -0.1, 0.0]];
    let spike = world.add(&[[0, 1, 2]], &spike).unwrap();
    let depth = world.depth(spike, body).unwrap();
    assert_eq!((depth.vertex, depth.at_least), (None, 0.0));
    assert!(depth.at_most >= 1.0);
}

#[test]
fn what_lies_inside_is_listed() {
    let mut world = World::<f64>::new();
    let add = |world: &mut World<f64>, lo: f64, hi: f64| {
        let (triangles, positions) = grid_box(2, [lo; 3], [hi; 3]);
        world.add(&triangles, &positions).unwrap()
    };
    let large = add(&mut world, 0.0, 8.0);
    let middle = add(&mut world, 1.0, 5.0);
    let small = add(&mut world, 2.0, 3.0);
    // It touches a wall from within, the next crosses it, and one is the same again.
    let touching = add(&mut world, 6.0, 8.0);
    let crossing = add(&mut world, 5.5, 9.0);
    let same = add(&mut world, 0.0, 8.0);
    let tent = [
        [1.0, 7.0, 1.0],
        [1.5, 7.0, 1.0],
        [1.0, 7.5, 1.0],
        [1.0, 7.0, 1.5],
    ];
    let open = world.add(&[[0, 1, 3], [1, 2, 3]], &tent).unwrap();
    let found = world.contained(Selection::World).unwrap();
    let of = |body: BodyId, inside: BodyId| Contained {
        body,
        component: 0,
        inside,
    };
    let mut expected = [
        of(middle, large),
        of(small, large),
        of(small, middle),
        of(touching, crossing),
        of(open, large),
        of(middle, same),
        of(small, same),
        of(open, same),
    ];
    expected.sort_unstable();
    // The faces of the touching one overlap the wall of the large one.
    assert_eq!(found.all, expected);
    assert_eq!(found.open, [open]);
    assert_eq!(
        world
            .contained(Selection::Between(small, large))
            .unwrap()
            .all,
        [of(small, large)]
    );
    assert_eq!(world.contained(Selection::Within(large)).unwrap().all, []);
    world.ignore(small, large).unwrap();
    assert!(
        !world
            .contained(Selection::World)
            .unwrap()
            .all
            .contains(&of(small, large))
    );
    // Only a corner touches: it is inside still.
    let (triangles, mut positions) = grid_box(1, [3.5; 3], [4.0; 3]);
    positions[0] = [1.0, 4.0, 4.5];
    let pointed = world.add(&triangles, &positions).unwrap();
    let found = world
        .contained(Selection::Between(pointed, middle))
        .unwrap();
    assert_eq!(found.all, [of(pointed, middle)]);
}

/// Two components of one body: one is inside, the other is not.
#[test]
fn components_are_told_apart() {
    let mut world = World::<f64>::new();
    let (triangles, positions) = grid_box(2, [0.0; 3], [4.0; 3]);
    let large = world.add(&triangles, &positions).unwrap();
    let (mut triangles, mut positions) = grid_box(1, [9.0; 3], [10.0; 3]);
    let (more, at) = grid_box(1, [1.0; 3], [2.0; 3]);
    let first = positions.len() as u32;
    triangles.extend(more.iter().map(|corners| corners.map(|it| it + first)));
    positions.extend(at);
    let body = world.add(&triangles, &positions).unwrap();
    let found = world.contained(Selection::Everything).unwrap();
    assert_eq!(
        found.all,
        [Contained {
            body,
            component: 1,
            inside: large
        }]
    );
}

/// The clash of two bodies, by the table of the guide.
fn clash(a: &Mesh<f64>, b: &Mesh<f64>, clearance: f64) -> &'static str {
    let mut world = World::<f64>::new();
    let [a, b] = [a, b].map(|(triangles, positions)| world.add(triangles, positions).unwrap());
    let mut are_all_on = |a: BodyId, b: BodyId| {
        let sides = world.inside(a, b, InsideRule::NonZero).unwrap();
        sides.iter().all(|it| it.side == Side::On)
    };
    let between = Selection::Between(a, b);
    if are_all_on(a, b) && are_all_on(b, a) {
        return "duplication";
    }
    if !world.contained(between).unwrap().all.is_empty() {
        return "envelope";
    }
    let contacts = world.contacts(between).all().unwrap().to_vec();
    if contacts.iter().any(|it| it.kind == ContactKind::Crossing) {
        let mut curves = Curves::new();
        curves.update(&world, &contacts).unwrap();
        let closed = curves.iter().filter(Curve::is_closed).count();
        return if closed > 1 { "piercing" } else { "protrusion" };
    }
    if !contacts.is_empty() {
        return "touching";
    }
    match world.distance(a, b, clearance).unwrap() {
        Some(_) => "encroaching",
        None => "none",
    }
}

#[test]
fn the_six_clashes_follow_from_the_questions() {
    let large = grid_box(2, [0.0; 3], [4.0; 3]);
    for (lo, hi, expected) in [
        ([3.1, 3.2, 3.3], [5.0, 5.0, 5.0], "protrusion"),
        ([1.0, 1.0, 1.0], [2.0, 2.0, 2.0], "envelope"),
        ([-1.0, 1.1, 1.2], [5.0, 1.7, 1.8], "piercing"),
        ([4.0, 1.0, 1.0], [5.0, 2.0, 2.0], "touching"),
        ([4.2, 1.0, 1.0], [5.0, 2.0, 2.0], "encroaching"),
        ([0.0, 0.0, 0.0], [4.0, 4.0, 4.0], "duplication"),
        ([4.5, 1.0, 1.0], [5.0, 2.0, 2.0], "none"),
    ] {
        let other = grid_box(1, lo, hi);
        assert_eq!(clash(&large, &other, 0.25), expected, "{lo:?} {hi:?}");
        assert_eq!(clash(&other, &large, 0.25), expected, "{lo:?} {hi:?}");
    }
}

#[test]
fn what_has_no_inside_is_refused_by_name() {
    let mut world = World::<f32>::new();
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let closed = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let good = world.add(&closed, &corners).unwrap();
    let open = world.add(&closed[..3], &corners).unwrap();
    let turned = world
        .add(&[closed[0], [1, 0, 3], closed[2], closed[3]], &corners)
        .unwrap();
    let ask = |world: &mut World<f32>, body: BodyId, rule: InsideRule, point: [f32; 3]| {
        world
            .points_inside(&[[0.1; 3], point], body, rule)
            .map_err(|it| (it.body, it.kind))
    };
    let (non_zero, parity) = (InsideRule::NonZero, InsideRule::Parity);
    let not_closed = |edges: &[[u32; 2]]| ErrorKind::NotClosed {
        edges: edges.to_vec(),
        count: edges.len(),
    };
    let found = ask(&mut world, open, non_zero, [0.0; 3]).unwrap_err();
    assert_eq!(found, (Some(open), not_closed(&[[0, 2], [0, 3], [2, 3]])));
    assert_eq!(
        ask(&mut world, open, parity, [0.0; 3]).unwrap_err().0,
        Some(open)
    );
    let found = ask(&mut world, turned, non_zero, [0.0; 3]).unwrap_err();
    assert_eq!(found, (Some(turned), not_closed(&[[0, 1], [0, 3], [1, 3]])));
    let found = ask(&mut world, turned, parity, [5.0; 3]).unwrap();
    let sides: Vec<Side> = found.iter().map(|it| it.side).collect();
    assert_eq!(sides, [Side::Inside, Side::Outside]);
    let bad = ask(&mut world, good, non_zero, [0.0, f32::NAN, 0.0]).unwrap_err();
    assert!(matches!(bad, (None, ErrorKind::BadPoint { point: 1, .. })));
    let same = world.inside(good, good, non_zero).unwrap_err();
    assert_eq!((same.body, same.kind), (Some(good), ErrorKind::SameBody));
    world.remove(good).unwrap();
    let gone = ask(&mut world, good, non_zero, [0.0; 3]).unwrap_err();
    assert_eq!(gone, (Some(good), ErrorKind::NoSuchBody));
    for cut_off in [-1.0, f64::NAN] {
        let refused = world
            .closest_points(&[[0.0; 3]], None, cut_off)
            .unwrap_err();
        assert!(matches!(refused.kind, ErrorKind::BadDistance { .. }));
    }
    // Nothing is asked, and nothing answered.
    assert_eq!(world.closest_points(&[], Some(open), 1.0).unwrap(), []);
}
