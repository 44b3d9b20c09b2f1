//! Solids of tetrahedra, whose contacts are known without any sign of orientation.
//!
//! Cubes of the integer grid are cut into six tetrahedra each (Freudenthal). Tetrahedra of the grid
//! of twice the size are unions of tetrahedra of the small one. So surfaces of sets of either grid
//! never cross: their triangles are unions of triangles of the small grid. Whatever passes through
//! anything does so at edges and vertices.

use super::only_touch;
use crate::joined::Meshes;
use pliant::{ContactKind, Selection, World};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

type Point = [i32; 3];

/// Bodies, each a source of its own.
struct Bodies(Vec<(Vec<[f64; 3]>, Vec<[u32; 3]>)>);

impl Meshes for Bodies {
    fn sizes(&self, source: u32) -> [usize; 2] {
        let (positions, triangles) = &self.0[source as usize];
        [positions.len(), triangles.len()]
    }

    fn corners(&self, source: u32, triangle: u32) -> [u32; 3] {
        self.0[source as usize].1[triangle as usize]
    }

    fn position(&self, source: u32, vertex: u32) -> [f64; 3] {
        self.0[source as usize].0[vertex as usize]
    }
}

impl Bodies {
    /// All pairs, with their kinds and whether their places only touch.
    fn told(&self) -> Vec<([u32; 4], ContactKind, bool)> {
        let mut world = World::<f64>::new();
        for (positions, triangles) in &self.0 {
            world.add(triangles, positions).expect("a body");
        }
        let of = Selection::Everything;
        let contacts = world.contacts(of).all().expect("contacts");
        let pairs: Vec<_> = contacts
            .iter()
            .map(|it| (it.pair.into(), it.kind))
            .collect();
        let left_out = only_touch(self, &pairs);
        let told = pairs.into_iter().zip(left_out);
        told.map(|((row, kind), left_out)| (row, kind, left_out))
            .collect()
    }

    /// Whether all pairs are left out. There must be some, and they must agree.
    fn only_touch(&self) -> bool {
        let told = self.told();
        assert!(!told.is_empty());
        let left_out = told.iter().filter(|&&(_, _, it)| it).count();
        assert!(left_out == 0 || left_out == told.len());
        left_out > 0
    }
}

/// A solid of tetrahedra: a union of boxes, each cut off by a plane of the grid.
#[derive(Clone, Debug)]
struct Solid {
    /// Side of a cube, in units of the small grid.
    size: i32,
    boxes: Vec<Cut>,
}

/// A box in cubes: lower and upper corner, and a plane. The plane is two axes and the least
/// difference of their coordinates.
type Cut = (Point, Point, (usize, usize), i32);

const CELLS: i32 = 6;

/// Corners of the six tetrahedra of a cube, which begins at `lowest`.
fn tetrahedra(lowest: Point, size: i32) -> Vec<[Point; 4]> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let of = |order: [usize; 3]| {
        let mut corners = [lowest; 4];
        for step in 0..3 {
            corners[step + 1] = corners[step];
            corners[step + 1][order[step]] += size;
        }
        corners
    };
    orders.map(of).into()
}

fn cubes(size: i32) -> impl Iterator<Item = Point> {
    let steps = move || (0..CELLS / size).map(move |it| it * size);
    steps().flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])))
}

impl Solid {
    /// Whether the solid has a tetrahedron of the small grid, by four times its centre.
    fn has(&self, tetrahedron: &[Point; 4]) -> bool {
        let centre: Point = std::array::from_fn(|axis| tetrahedron.iter().map(|it| it[axis]).sum());
        self.boxes.iter().any(|&(lower, upper, (a, b), least)| {
            (0..3).all(|axis| {
                let scaled = 4 * self.size;
                (scaled * lower[axis]..scaled * upper[axis]).contains(&centre[axis])
            }) && centre[a] - centre[b] >= 4 * self.size * least
        })
    }

    /// Triangles of the solid's surface, turned outwards, in cubes of its own size.
    fn surface(&self) -> Vec<[Point; 3]> {
        let own = Self {
            size: 1,
            boxes: self.boxes.clone(),
        };
        let smaller = |point: Point| point.map(|x| x / self.size);
        let mut faces: BTreeMap<[Point; 3], (u32, [Point; 3])> = BTreeMap::new();
        for tetrahedron in cubes(self.size).flat_map(|it| tetrahedra(it, self.size)) {
            if own.has(&tetrahedron.map(smaller)) {
                for (face, turned) in faces_of(&tetrahedron) {
                    faces.entry(face).or_insert((0, turned)).0 += 1;
                }
            }
        }
        let outside = faces.into_values().filter(|&(count, _)| count == 1);
        outside.map(|(_, face)| face).collect()
    }
}

/// Faces of a tetrahedron: corners sorted, and turned outwards.
fn faces_of(tetrahedron: &[Point; 4]) -> Vec<([Point; 3], [Point; 3])> {
    let faces = (0..4).map(|without| {
        let corners: Vec<Point> = (0..4)
            .filter(|&it| it != without)
            .map(|it| tetrahedron[it])
            .collect();
        let mut face = [corners[0], corners[1], corners[2]];
        if volume(face, tetrahedron[without]) > 0 {
            face.swap(0, 1);
        }
        let mut sorted = face;
        sorted.sort_unstable();
        (sorted, face)
    });
    faces.collect()
}

fn volume([a, b, c]: [Point; 3], d: Point) -> i32 {
    let from = |p: Point| -> Point { std::array::from_fn(|axis| p[axis] - a[axis]) };
    let [u, v, w] = [b, c, d].map(from);
    (u[1] * v[2] - u[2] * v[1]) * w[0]
        + (u[2] * v[0] - u[0] * v[2]) * w[1]
        + (u[0] * v[1] - u[1] * v[0]) * w[2]
}

/// Whether every edge has two faces, and the faces at every vertex are one fan.
fn is_manifold(surface: &[[Point; 3]]) -> bool {
    let mut at_edges: BTreeMap<[Point; 2], u32> = BTreeMap::new();
    let mut fans: BTreeMap<Point, Vec<BTreeSet<Point>>> = BTreeMap::new();
    for &[a, b, c] in surface {
        for (p, q, r) in [(a, b, c), (b, c, a), (c, a, b)] {
            *at_edges.entry([p.min(q), p.max(q)]).or_default() += 1;
            let fan = fans.entry(p).or_default();
            let mut joined = BTreeSet::from([q, r]);
            fan.retain(|part| {
                let apart = part.is_disjoint(&joined);
                if !apart {
                    joined.extend(part);
                }
                apart
            });
            fan.push(joined);
        }
    }
    at_edges.values().all(|&it| it == 2) && fans.values().all(|it| it.len() == 1)
}

/// A face, an edge or a vertex of the small grid.
type Simplex = BTreeSet<Point>;

/// Common edges of two surfaces with the number of their contact, and the sides of each contact.
///
/// Sides of a contact: whether the first surface is outside the second solid, and inside it; then
/// the reverse.
fn contacts(solids: [&Solid; 2]) -> (BTreeMap<Simplex, usize>, Vec<[bool; 4]>) {
    let mut faces: BTreeMap<Simplex, Vec<[bool; 2]>> = BTreeMap::new();
    for tetrahedron in cubes(1).flat_map(|it| tetrahedra(it, 1)) {
        let inside = solids.map(|solid| solid.has(&tetrahedron));
        for (face, _) in faces_of(&tetrahedron) {
            faces.entry(face.into()).or_default().push(inside);
        }
    }
    // Beyond the end of the grid there is nothing.
    for inside in faces.values_mut() {
        inside.resize(2, [false; 2]);
    }
    let is_on = |inside: &[[bool; 2]], solid: usize| inside[0][solid] != inside[1][solid];
    let parts = |face: &Simplex| {
        let corners: Vec<Point> = face.iter().copied().collect();
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        [
            vec![a],
            vec![b],
            vec![c],
            vec![a, b],
            vec![b, c],
            vec![a, c],
            vec![a, b, c],
        ]
        .map(|it| it.into_iter().collect::<Simplex>())
    };
    let mut on: [BTreeSet<Simplex>; 2] = Default::default();
    for (face, inside) in &faces {
        for solid in 0..2 {
            if is_on(inside, solid) {
                on[solid].extend(parts(face));
            }
        }
    }
    let common: Vec<Simplex> = on[0].intersection(&on[1]).cloned().collect();
    let mut contact: BTreeMap<Point, usize> = BTreeMap::new();
    for (number, simplex) in common.iter().enumerate() {
        let known: BTreeSet<usize> = simplex
            .iter()
            .filter_map(|it| contact.get(it).copied())
            .collect();
        for vertex in simplex {
            contact.insert(*vertex, number);
        }
        for other in contact.values_mut().filter(|it| known.contains(it)) {
            *other = number;
        }
    }
    let mut seen = vec![[false; 4]; common.len()];
    let edges: BTreeSet<&Simplex> = common.iter().filter(|it| it.len() == 2).collect();
    for (face, inside) in &faces {
        for solid in 0..2 {
            let other = 1 - solid;
            if is_on(inside, solid) && !is_on(inside, other) {
                for edge in parts(face).iter().filter(|it| edges.contains(it)) {
                    let number = contact[edge.first().expect("an edge")];
                    seen[number][2 * solid + usize::from(inside[0][other])] = true;
                }
            }
        }
    }
    let of_edges = edges.into_iter().map(|edge| {
        let number = contact[edge.first().expect("an edge")];
        (edge.clone(), number)
    });
    (of_edges.collect(), seen)
}

fn is_in_triangle(point: Point, [a, b, c]: [Point; 3]) -> bool {
    let minus = |p: Point, q: Point| -> Point { std::array::from_fn(|axis| p[axis] - q[axis]) };
    let cross = |u: Point, v: Point| -> Point {
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            u[j] * v[k] - u[k] * v[j]
        })
    };
    let dot = |u: Point, v: Point| -> i32 { (0..3).map(|axis| u[axis] * v[axis]).sum() };
    let normal = cross(minus(b, a), minus(c, a));
    dot(normal, minus(point, a)) == 0
        && [(a, b), (b, c), (c, a)]
            .iter()
            .all(|&(p, q)| dot(normal, cross(minus(q, p), minus(point, p))) >= 0)
}

fn solid() -> impl Strategy<Value = Solid> {
    (1..3).prop_flat_map(|size| {
        let cells = CELLS / size;
        let interval = (0..cells).prop_flat_map(move |low| (Just(low), low + 1..=cells));
        let intervals = [interval.clone(), interval.clone(), interval];
        let axes = prop::sample::select(vec![(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)]);
        let cut = (intervals, axes, -3..2)
            .prop_map(|(it, axes, least)| (it.map(|it| it.0), it.map(|it| it.1), axes, least));
        prop::collection::vec(cut, 1..4).prop_map(move |boxes| Solid { size, boxes })
    })
}

/// Numbers of cases of each outcome, so that a test can require some of both.
#[derive(Debug, Default)]
struct Seen {
    passing: u32,
    touching: u32,
}

#[test]
fn a_place_is_left_out_only_if_nothing_passes() {
    let mut seen = Seen::default();
    let map = prop::array::uniform9(-2_i32..3);
    let cases = (solid(), solid(), map, any::<u64>(), any::<bool>());
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for _ in 0..1500 {
        let tree = cases.new_tree(&mut runner).expect("a case");
        let (a, b, map, flips, together) = proptest::strategy::ValueTree::current(&tree);
        look_at([&a, &b], map, flips, together, &mut seen);
    }
    println!("{seen:?}");
    assert!(seen.passing > 100 && seen.touching > 100, "{seen:?}");
}

#[test]
fn a_pin_in_its_hole_only_touches() {
    let whole = |lower: Point, upper: Point| (lower, upper, (0, 1), -CELLS);
    let solid = |boxes: &[Cut]| Solid {
        size: 1,
        boxes: boxes.to_vec(),
    };
    let hub = solid(&[
        whole([1, 1, 2], [4, 2, 3]),
        whole([1, 3, 2], [4, 4, 3]),
        whole([1, 1, 2], [2, 4, 3]),
        whole([3, 1, 2], [4, 4, 3]),
    ]);
    let pin = whole([2, 2, 1], [3, 3, 4]);
    let key = whole([3, 2, 2], [4, 3, 3]);
    let mut seen = Seen::default();
    for (other, [touching, passing]) in [(solid(&[pin]), [1, 0]), (solid(&[pin, key]), [1, 1])] {
        look_at(
            [&hub, &other],
            [1, 0, 0, 0, 1, 0, 0, 0, 1],
            0,
            false,
            &mut seen,
        );
        assert_eq!([seen.touching, seen.passing], [touching, passing]);
    }
}

/// Compares two solids with the tetrahedra.
///
/// `map`: a linear map of the whole. `flips`: triangles that turn the other way. `together`: both
/// solids in one body.
fn look_at(solids: [&Solid; 2], map: [i32; 9], mut flips: u64, together: bool, seen: &mut Seen) {
    let surfaces = solids.map(Solid::surface);
    let det = volume(
        [[0; 3], [map[0], map[1], map[2]], [map[3], map[4], map[5]]],
        [map[6], map[7], map[8]],
    );
    if det == 0 || surfaces.iter().any(|it| it.is_empty() || !is_manifold(it)) {
        return;
    }
    let mut bodies: Vec<(Vec<[f64; 3]>, Vec<[u32; 3]>)> = Vec::new();
    let mut firsts = [0; 2];
    for (place, surface) in surfaces.iter().enumerate() {
        if bodies.is_empty() || !together {
            bodies.push(Default::default());
        }
        let (positions, triangles) = bodies.last_mut().expect("one");
        firsts[place] = triangles.len() as u32;
        let mut numbers: BTreeMap<Point, u32> = BTreeMap::new();
        for face in surface {
            let mut corners = face.map(|p| {
                *numbers.entry(p).or_insert_with(|| {
                    let row =
                        |r: usize| f64::from((0..3).map(|c| map[3 * r + c] * p[c]).sum::<i32>());
                    positions.push([row(0), row(1), row(2)]);
                    positions.len() as u32 - 1
                })
            });
            flips = flips.rotate_left(1);
            if flips.is_multiple_of(4) {
                corners.swap(1, 2);
            }
            triangles.push(corners);
        }
    }
    let told = Bodies(bodies).told();
    assert!(
        told.iter()
            .all(|&(_, kind, _)| kind != ContactKind::Crossing)
    );
    let (of_edges, sides) = contacts(solids);
    let passes = |number: usize| {
        let [a_outside, a_inside, b_outside, b_inside] = sides[number];
        a_outside && a_inside || b_outside && b_inside
    };
    let number_of_b = u32::from(!together);
    let between: Vec<_> = told
        .iter()
        .filter(|(row, _, _)| {
            let of_b = |body: u32, triangle: u32| {
                if together {
                    triangle >= firsts[1]
                } else {
                    body == number_of_b
                }
            };
            of_b(row[0], row[1]) != of_b(row[2], row[3])
        })
        .collect();
    // A manifold of tetrahedra touches itself only at common vertices, whose pairs are left out.
    assert_eq!(between.len(), told.len());
    for (edge, _) in of_edges.iter().filter(|&(_, &number)| passes(number)) {
        let holds = |solid: usize, triangle: u32| {
            let face = surfaces[solid][(triangle - firsts[solid]) as usize];
            edge.iter().all(|&it| is_in_triangle(it, face))
        };
        let mut there = 0;
        for ([_, a, _, b], _, left_out) in &between {
            if holds(0, *a) && holds(1, *b) {
                there += 1;
                assert!(!left_out, "{solids:?} at {edge:?}");
            }
        }
        assert!(there > 0);
    }
    let all: BTreeSet<[bool; 4]> = of_edges.values().map(|&it| sides[it]).collect();
    let any_passes = of_edges.values().any(|&it| passes(it));
    if all.len() == 1 && !any_passes {
        assert!(
            between.iter().all(|&&(_, _, left_out)| left_out),
            "{solids:?}"
        );
        seen.touching += 1;
    }
    seen.passing += u32::from(any_passes);
}

/// A sheet over a grid of points, two triangles a square.
fn sheet(
    columns: std::ops::RangeInclusive<i32>,
    at: impl Fn(i32, i32) -> [f64; 3],
) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    const ROWS: u32 = 9;
    let width = columns.clone().count() as u32;
    let points = (0..=ROWS as i32).flat_map(|y| columns.clone().map(move |x| (x, y)));
    let positions = points.map(|(x, y)| at(x, y)).collect();
    let squares = (0..ROWS).flat_map(|y| (0..width - 1).map(move |x| y * width + x));
    let triangles =
        squares.flat_map(|a| [[a, a + 1, a + width], [a + 1, a + width + 1, a + width]]);
    (positions, triangles.collect())
}

fn bumpy(x: i32, y: i32) -> [f64; 3] {
    [
        f64::from(x),
        f64::from(y),
        f64::from((7 * x * x + 5 * x * y + 3 * y * y) % 11) / 8.0,
    ]
}

#[test]
fn a_cut_through_a_sheet_only_touches() {
    let (left, right) = (sheet(-5..=0, bumpy), sheet(0..=5, bumpy));
    assert!(Bodies(vec![left, right]).only_touch());
}

#[test]
fn a_layer_only_touches_and_one_that_comes_out_behind_passes() {
    let below = sheet(-5..=5, bumpy);
    assert!(Bodies(vec![below.clone(), below.clone()]).only_touch());
    let leaves = |from: f64, to: f64| {
        move |x: i32, y: i32| {
            let [a, b, c] = bumpy(x, y);
            let lifted = if x < -2 {
                from
            } else if x > 2 {
                to
            } else {
                0.0
            };
            [a, b, c + lifted]
        }
    };
    let both_above = sheet(-5..=5, leaves(1.0, 2.0));
    assert!(Bodies(vec![below.clone(), both_above]).only_touch());
    let through = sheet(-5..=5, leaves(1.0, -2.0));
    let told = Bodies(vec![below, through]).told();
    assert!(
        told.iter()
            .all(|&(_, kind, _)| kind != ContactKind::Crossing)
    );
    assert!(told.iter().all(|&(_, _, left_out)| !left_out));
}

/// Bodies of one triangle or a few, given by their corners.
fn few(bodies: &[&[[[i32; 3]; 3]]]) -> Bodies {
    let body = |triangles: &&[[[i32; 3]; 3]]| {
        let mut numbers: BTreeMap<Point, u32> = BTreeMap::new();
        let mut positions = Vec::new();
        let corners = triangles.iter().map(|triangle| {
            triangle.map(|point| {
                *numbers.entry(point).or_insert_with(|| {
                    positions.push(point.map(f64::from));
                    positions.len() as u32 - 1
                })
            })
        });
        let corners = corners.collect();
        (positions, corners)
    };
    Bodies(bodies.iter().map(body).collect())
}

/// Floor in the plane z = 0, around the origin.
const FLOOR: [[[i32; 3]; 3]; 2] = [
    [[-9, -9, 0], [9, -9, 0], [9, 9, 0]],
    [[-9, -9, 0], [9, 9, 0], [-9, 9, 0]],
];

#[test]
fn what_stands_or_ends_on_a_surface_only_touches() {
    let pin = [[[1, 0, 0], [2, 0, 3], [1, 1, 3]]];
    assert!(few(&[&FLOOR, &pin]).only_touch());
    let wall = [[[1, 0, 0], [5, 2, 0], [1, 1, 3]]];
    assert!(few(&[&FLOOR, &wall]).only_touch());
    // Each of two walls is on one side of the floor. As one body, they are one patch on both sides.
    let below = [[[1, 0, 0], [5, 2, 0], [1, 1, -3]]];
    assert!(few(&[&FLOOR, &wall, &below]).only_touch());
    let through = [wall[0], [below[0][1], below[0][0], below[0][2]]];
    assert!(!few(&[&FLOOR, &through]).only_touch());
    // The same holds where the common edge is an edge of the floor too.
    let diagonal = |z: i32| [[1, 1, 0], [5, 5, 0], [1, 3, z]];
    assert!(few(&[&FLOOR, &[diagonal(3)]]).only_touch());
    assert!(!few(&[&FLOOR, &[diagonal(3), diagonal(-3)]]).only_touch());
    // Along the rim of the floor nothing is passed through.
    let rim = |z: i32| [[-3, -9, 0], [3, -9, 0], [0, -9, z]];
    assert!(few(&[&FLOOR, &[rim(3), rim(-3)]]).only_touch());
}

#[test]
fn where_it_is_not_clear_what_a_side_is_a_place_stays() {
    let page = |x: i32, z: i32| [[1, 0, 0], [1, 5, 0], [x, 2, z]];
    let touches = [[[1, 1, 0], [1, 2, 0], [3, 1, -1]]];
    assert!(few(&[&[page(5, 3), page(-5, 3)], &touches]).only_touch());
    // Three triangles at one edge.
    assert!(!few(&[&[page(5, 3), page(-5, 3), page(0, 7)], &touches]).only_touch());
    // Folded onto the other.
    assert!(!few(&[&[page(5, 3), page(9, 6)], &touches]).only_touch());
    // Without area.
    assert!(!few(&[&[page(5, 3), page(1, 0)], &touches]).only_touch());
    let point = [[[1, 1, 0], [1, 1, 0], [1, 1, 0]]];
    assert!(!few(&[&FLOOR, &point]).only_touch());
}

#[test]
fn a_strip_with_one_side_stays() {
    // A square that goes around an axis and makes half a turn on the way (a Möbius strip).
    let corner = |step: i32, side: f64| {
        let around = f64::from(step) / 12.0 * std::f64::consts::TAU;
        let (sin, cos) = around.sin_cos();
        let (rise, lean) = (around / 2.0).sin_cos();
        [
            (4.0 + side * lean) * cos,
            (4.0 + side * lean) * sin,
            side * rise,
        ]
    };
    let strip = |steps: u32| {
        let positions: Vec<_> = (0..steps as i32)
            .flat_map(|it| [corner(it, -1.0), corner(it, 1.0)])
            .collect();
        let mut triangles: Vec<[u32; 3]> = (0..2 * (steps - 1))
            .map(|it| [it, it + 1, it + 2])
            .collect();
        if steps == 12 {
            // After the last step the sides are exchanged.
            triangles.extend([[22, 23, 1], [23, 1, 0]]);
        }
        (positions, triangles)
    };
    for (steps, only_touches) in [(11, true), (12, false)] {
        let (positions, triangles) = strip(steps);
        // The second strip lies on all of the first.
        let bodies = Bodies(vec![
            (positions.clone(), triangles.clone()),
            (positions, triangles),
        ]);
        assert_eq!(bodies.only_touch(), only_touches, "{steps}");
    }
}
