//! Curves of a real mesh with itself: they pass the edges that big integers say.

use pliant::{BodyId, CurveEnd, Curves, Feature, Pair, Selection, World};
use pliant_check::{Check, Frames, Settings};
use pliant_io::OpenOptions;
use pliant_oracle::{ContactKind, contact_kind};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// An edge, by its vertices, through a triangle.
type Crossing = ([u32; 2], u32);

/// All edges that cross triangles, by boxes along x and then in integers.
fn expected(triangles: &[[u32; 3]], positions: &[[f64; 3]]) -> BTreeSet<Crossing> {
    let corners = |of: &[u32]| -> Vec<[f64; 3]> {
        of.iter()
            .map(|&vertex| positions[vertex as usize])
            .collect()
    };
    let range = |of: &[u32], axis: usize| {
        let along = corners(of).into_iter().map(|corner| corner[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        (low, along.fold(f64::NEG_INFINITY, f64::max))
    };
    let edges: BTreeSet<[u32; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[p, q]| [p.min(q), p.max(q)])
        .collect();
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| {
        let low = |triangle: usize| range(&triangles[triangle], 0).0;
        low(a).total_cmp(&low(b))
    });
    let ranges: Vec<[(f64, f64); 3]> = order
        .iter()
        .map(|&triangle| [0, 1, 2].map(|axis| range(&triangles[triangle], axis)))
        .collect();
    let widest = ranges.iter().map(|[(low, high), ..]| high - low);
    let widest = widest.fold(0.0, f64::max);
    let mut found = BTreeSet::new();
    for edge in edges {
        let of_edge = [0, 1, 2].map(|axis| range(&edge, axis));
        let first = ranges.partition_point(|[(low, _), ..]| *low < of_edge[0].0 - widest);
        for (place, of_triangle) in ranges.iter().enumerate().skip(first) {
            if of_triangle[0].0 > of_edge[0].1 {
                break;
            }
            let overlap = (0..3).all(|axis| {
                of_triangle[axis].0 <= of_edge[axis].1 && of_edge[axis].0 <= of_triangle[axis].1
            });
            let triangle = triangles[order[place]];
            if !overlap || edge.iter().any(|end| triangle.contains(end)) {
                continue;
            }
            let [p, q] = edge.map(|vertex| positions[vertex as usize]);
            let corners = triangle.map(|vertex| positions[vertex as usize]);
            if contact_kind(&[p, q, q], &corners) == ContactKind::Crossing {
                found.insert((edge, order[place] as u32));
            }
        }
    }
    found
}

#[test]
fn curves_of_a_real_mesh_pass_the_edges_that_integers_say() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/human-morph.npz");
    if !data.exists() {
        eprintln!("skipped: there is no shared/data beside the checkout");
        return;
    }
    let settings = Settings {
        itself: true,
        listed: false,
        frames: Some(Frames {
            start: 0,
            step: 25,
            count: 3,
        }),
        ..Settings::default()
    };
    let path = data.display().to_string();
    let mut check = Check::open(&[path], &OpenOptions::default(), &settings).unwrap();
    let mut lengths = BTreeMap::new();
    while let Some(found) = check.next_frame().unwrap() {
        let source = &check.sources()[0];
        let triangles = source.triangles().to_vec();
        let vertices = triangles.as_flattened().iter().max().unwrap() + 1;
        let positions: Vec<[f64; 3]> = (0..vertices).map(|it| source.positions().get(it)).collect();
        let mut world = World::<f64>::new();
        let body = world.add(&triangles, &positions).unwrap();
        let of = Selection::Within(body);
        let mut pairs = world.intersections(of).all().unwrap().to_vec();
        let adjacent = world.adjacent_intersections(of).all().unwrap();
        pairs.extend(adjacent.iter().map(|&it| Pair::from(it)));
        let mut curves = Curves::new();
        curves.update(&world, &pairs).unwrap();

        let truth = expected(&triangles, &positions);
        let edges = world.edges(BodyId(0)).unwrap().to_vec();
        let crossing = world.crossing_edges(of).all().unwrap().iter();
        let crossing: BTreeSet<Crossing> = crossing
            .map(|it| (edges[it.edge as usize], it.triangle))
            .collect();
        assert_eq!(crossing, truth);
        let mut passed = BTreeSet::new();
        for curve in curves.iter() {
            for step in curve.steps() {
                let sides = curve.sides(step);
                for end in curve.ends_of(step) {
                    let (side, edge) = match end.on {
                        [Feature::Edge(edge), Feature::Inside] => (0, edge),
                        [Feature::Inside, Feature::Edge(edge)] => (1, edge),
                        _ => continue,
                    };
                    let (_, _, corners) = sides[side];
                    let [p, q] = [corners[edge], corners[(edge + 1) % 3]];
                    passed.insert(([p.min(q), p.max(q)], sides[1 - side].1));
                }
            }
            let ends = curve.ends().into_iter().flatten();
            assert!(ends.into_iter().all(|end| end != CurveEnd::Branching));
        }
        assert_eq!(passed, truth, "frame {}", found.frame);
        let length: f64 = curves.iter().map(|curve| curve.length()).sum();
        lengths.insert(found.frame, (truth.len(), length));
    }
    assert!(lengths[&50].0 > 400, "{lengths:?}");
}
