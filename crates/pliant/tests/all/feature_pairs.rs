//! Contacts of close elements, each once, against a model in whole numbers.

use crate::common::{Lcg, sheet};
use pliant::{
    BodyId, ClosestFeatures, ErrorKind, FeaturePair, FeaturePairs, Options, Scalar, Selection,
    World,
};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;

type Point = [i64; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: Point, b: Point) -> i64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [[1, 2], [2, 0], [0, 1]].map(|[j, k]| a[j] * b[k] - a[k] * b[j])
}

/// A feature as its kind (0 vertex, 1 edge, 2 face), body and number, with its corners.
type Named = ((u8, BodyId, u32), Vec<Point>);

/// Square of the distance of two features, over and under, if their insides are nearest there.
fn square([(_, a), (_, b)]: [&Named; 2]) -> Option<[i64; 2]> {
    match (&a[..], &b[..]) {
        ([p], [q]) => Some([dot(minus(*p, *q), minus(*p, *q)), 1]),
        ([p], [q, r]) | ([q, r], [p]) => {
            let (e, t) = (minus(*r, *q), minus(*p, *q));
            let area = cross(t, e);
            (0 < dot(t, e) && dot(t, e) < dot(e, e)).then(|| [dot(area, area), dot(e, e)])
        }
        ([p], [a, b, c]) => {
            let n = cross(minus(*b, *a), minus(*c, *a));
            let is_inside = [[a, b], [b, c], [c, a]]
                .iter()
                .all(|[from, to]| dot(cross(minus(**to, **from), minus(*p, **from)), n) > 0);
            let height = dot(n, minus(*p, *a));
            is_inside.then(|| [height * height, dot(n, n)])
        }
        ([p, q], [r, s]) => {
            let (e, f, t) = (minus(*q, *p), minus(*s, *r), minus(*p, *r));
            let n = cross(e, f);
            let along = [-dot(cross(t, f), n), -dot(cross(t, e), n)];
            let is_inside = along.iter().all(|&x| 0 < x && x < dot(n, n));
            is_inside.then(|| [dot(n, t) * dot(n, t), dot(n, n)])
        }
        _ => None,
    }
}

/// The lowest of the nearest features of two elements: its place in the order of kinds, and both.
type Name = (u8, [(BodyId, u32); 2]);

fn lowest(a: &[Named], b: &[Named]) -> Name {
    let mut best: Option<([i64; 2], Name)> = None;
    for one in a {
        for other in b {
            let [one, other] = if one.0 <= other.0 {
                [one, other]
            } else {
                [other, one]
            };
            let Some(new) = square([one, other]) else {
                continue;
            };
            let [(kind_a, body_a, a), (kind_b, body_b, b)] = [one.0, other.0];
            let kind = match (kind_a, kind_b) {
                (0, kind) => [0, 1, 3][kind as usize],
                _ => 2,
            };
            let name = (kind, [(body_a, a), (body_b, b)]);
            let is_better = best.is_none_or(|(old, known)| {
                let [new, old] = [new[0] * old[1], old[0] * new[1]];
                new < old || new == old && name < known
            });
            if is_better {
                best = Some((new, name));
            }
        }
    }
    best.unwrap().1
}

/// A body as the model knows it.
struct Known {
    id: BodyId,
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    points: Vec<Point>,
}

impl Known {
    fn vertex(&self, vertex: u32) -> Named {
        ((0, self.id, vertex), vec![self.points[vertex as usize]])
    }

    fn edge(&self, edge: u32) -> Vec<Named> {
        let ends = self.edges[edge as usize];
        let inside = ends.map(|end| self.points[end as usize]).to_vec();
        let ends = ends.into_iter().map(|end| self.vertex(end));
        ends.chain([((1, self.id, edge), inside)]).collect()
    }

    fn triangle(&self, triangle: u32) -> Vec<Named> {
        let corners = self.triangles[triangle as usize];
        let face = corners.map(|corner| self.points[corner as usize]).to_vec();
        let mut all = vec![((2, self.id, triangle), face)];
        for (edge, ends) in (0..).zip(&self.edges) {
            if ends.iter().all(|end| corners.contains(end)) {
                all.extend(self.edge(edge));
            }
        }
        all.extend(corners.map(|corner| self.vertex(corner)));
        all
    }
}

fn name_of(row: &FeaturePair) -> Name {
    let kind = match row.features {
        ClosestFeatures::VertexVertex => 0,
        ClosestFeatures::VertexEdge => 1,
        ClosestFeatures::EdgeEdge => 2,
        ClosestFeatures::VertexFace => 3,
    };
    let [a, b] = row.numbers;
    (kind, [(row.bodies[0], a), (row.bodies[1], b)])
}

/// Checks that a row says the same thing in all its ways.
fn check_row(row: &FeaturePair, all: &[Known]) {
    let body = |id: BodyId| all.iter().find(|known| known.id == id).unwrap();
    let mut points = [[0.0; 3]; 2];
    let [first, second] = row.places();
    for (which, places) in [first.clone(), second.clone()].into_iter().enumerate() {
        let known = body(row.bodies[which]);
        let vertices = &row.vertices[places.clone()];
        let expected = match vertices.len() {
            1 => vec![row.numbers[which]],
            2 => known.edges[row.numbers[which] as usize].to_vec(),
            _ => known.triangles[row.numbers[which] as usize].to_vec(),
        };
        assert_eq!(vertices, expected, "{row:?}");
        let weights = &row.weights[places];
        assert!(weights.iter().all(|&weight| weight >= 0.0), "{row:?}");
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{row:?}");
        for (&vertex, weight) in vertices.iter().zip(weights) {
            let at = known.points[vertex as usize];
            (0..3).for_each(|axis| points[which][axis] += weight * at[axis] as f64);
        }
    }
    assert!(row.vertices[second.end..].iter().all(|&it| it == u32::MAX));
    let way = [0, 1, 2].map(|axis| points[0][axis] - points[1][axis]);
    let apart = row
        .direction
        .map_or([0.0; 3], |it| it.map(|x| x * row.distance));
    for axis in 0..3 {
        assert!((way[axis] - apart[axis]).abs() < 1e-8, "{row:?} {way:?}");
    }
}

/// Meshes with vertices, edges and triangles that many elements share, and some degenerate.
fn mesh(random: &mut Lcg) -> (Vec<[u32; 3]>, u32) {
    match random.below(4) {
        0 => {
            let side = 2 + random.below(3);
            (sheet(side).0, side * side)
        }
        1 => {
            let rim = 3 + random.below(8);
            ((1..rim).map(|at| [0, at, at + 1]).collect(), rim + 1)
        }
        // A chain of edges, and points.
        2 => {
            let chain = (0..5).map(|at| [at, at + 1, at + 1]);
            (chain.chain([[6; 3], [7; 3]]).collect(), 8)
        }
        _ => {
            let triangles = 1 + random.below(12);
            let vertices = 3 + random.below(9);
            let corner = |random: &mut Lcg| random.below(vertices);
            let all = (0..triangles).map(|_| [(); 3].map(|()| corner(random)));
            (all.collect(), vertices)
        }
    }
}

fn live<S: Scalar>(seed: u64, of: fn(f64) -> S) -> [usize; 4] {
    let random = &mut Lcg(seed);
    let mut options = Options::default();
    options.threads = NonZeroUsize::new(1 + seed as usize % 3).unwrap();
    let mut world = World::<S>::with_options(options);
    let mut all: Vec<Known> = Vec::new();
    for _ in 0..2 + random.below(2) {
        let (triangles, vertices) = mesh(random);
        let points: Vec<Point> = (0..vertices)
            .map(|_| [(); 3].map(|()| i64::from(random.below(6))))
            .collect();
        let positions: Vec<_> = points.iter().map(|at| at.map(|x| of(x as f64))).collect();
        let id = world.add(&triangles, &positions).unwrap();
        all.push(Known {
            id,
            edges: world.edges(id).unwrap().to_vec(),
            triangles,
            points,
        });
    }
    let body = |id: BodyId| all.iter().find(|known| known.id == id).unwrap();
    let (ask, distance) = (Selection::Everything, [1.0, 1.5, 2.0][seed as usize % 3]);
    let vertices = world.close_vertex_triangle_pairs(ask, distance).all();
    let vertices = vertices.unwrap().to_vec();
    let edges = world
        .close_edge_edge_pairs(ask, distance)
        .all()
        .unwrap()
        .to_vec();
    let mut expected: BTreeMap<Name, u32> = BTreeMap::new();
    for close in &vertices {
        let vertex = body(close.pair.vertex_body).vertex(close.pair.vertex);
        let triangle = body(close.pair.triangle_body).triangle(close.pair.triangle);
        *expected.entry(lowest(&[vertex], &triangle)).or_default() += 1;
    }
    for close in &edges {
        let a = body(close.pair.body_a).edge(close.pair.edge_a);
        let b = body(close.pair.body_b).edge(close.pair.edge_b);
        *expected.entry(lowest(&a, &b)).or_default() += 1;
    }
    let mut contacts = FeaturePairs::new();
    contacts.update(&world, &vertices, &edges).unwrap();
    let found = contacts
        .all()
        .iter()
        .map(|row| (name_of(row), row.multiplicity));
    assert!(found.eq(expected), "seed {seed}");
    let mut kinds = [0; 4];
    for row in contacts.all() {
        kinds[usize::from(name_of(row).0)] += 1;
        check_row(row, &all);
    }
    kinds
}

#[test]
fn each_contact_is_there_once_f32() {
    let kinds = (0..300).map(|seed| live::<f32>(seed, |x| x as f32));
    let kinds = kinds.fold([0; 4], |all, some| [0, 1, 2, 3].map(|k| all[k] + some[k]));
    assert!(kinds.iter().all(|&count| count > 300), "{kinds:?}");
}

#[test]
fn each_contact_is_there_once_f64() {
    for seed in 300..500 {
        live::<f64>(seed, |x| x);
    }
}

/// In no order and with nothing rounded away: a vertex that moves by the smallest step off a border
/// has another feature.
#[test]
fn features_change_with_the_last_bit() {
    let square = [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let mut world = World::<f64>::new();
    world.add(&[[0, 1, 2], [0, 2, 3]], &square).unwrap();
    let tip = world.add(&[[0; 3]], &[[0.0; 3]]).unwrap();
    let mut contacts = FeaturePairs::new();
    let one = 1.0_f64;
    for (x, features, multiplicity) in [
        (one, ClosestFeatures::VertexEdge, 2),
        (one.next_up(), ClosestFeatures::VertexFace, 1),
        (one.next_down(), ClosestFeatures::VertexFace, 1),
    ] {
        world.set_positions(tip, &[[x, one, 0.25]]).unwrap();
        let all = world.close_vertex_triangle_pairs(Selection::World, 0.3);
        let all = all.all().unwrap().to_vec();
        assert_eq!(all.len(), 2);
        contacts.update(&world, &all, &[]).unwrap();
        // The other triangle has its nearest point on the side.
        let rows: Vec<_> = contacts.all().iter().map(|row| row.features).collect();
        assert!(rows.contains(&features), "{rows:?}");
        assert_eq!(contacts.all()[0].multiplicity, multiplicity);
    }
}

#[test]
fn lists_of_other_meshes_are_refused() {
    let mut world = World::<f32>::new();
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let above = corners.map(|[x, y, z]| [x, y, z + 0.1]);
    let a = world.add(&[[0, 1, 2]], &corners).unwrap();
    let b = world.add(&[[0, 1, 2]], &above).unwrap();
    let vertices = world.close_vertex_triangle_pairs(Selection::World, 0.5);
    let vertices = vertices.all().unwrap().to_vec();
    let edges = world.close_edge_edge_pairs(Selection::World, 0.5);
    let edges = edges.all().unwrap().to_vec();
    let mut contacts = FeaturePairs::new();
    contacts.update(&world, &vertices, &edges).unwrap();
    assert_eq!(contacts.len(), 3);
    world.set_mesh(b, &[[0; 3]], &[[0.0; 3]]).unwrap();
    let refused = contacts.update(&world, &vertices, &[]).unwrap_err();
    assert!(
        matches!(refused.kind, ErrorKind::NoSuchVertex { .. }),
        "{refused}"
    );
    let refused = contacts.update(&world, &[], &edges).unwrap_err();
    assert!(
        matches!(refused.kind, ErrorKind::NoSuchEdge { .. }),
        "{refused}"
    );
    assert!(refused.body == Some(b) && contacts.is_empty());
    world.remove(a).unwrap();
    let refused = contacts.update(&world, &vertices, &edges).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::NoSuchBody);
}
