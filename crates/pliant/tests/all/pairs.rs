//! Single pairs without a world: the answers that a world gives for each of them.

use crate::common::Lcg;
use pliant::{
    ContactKind, ErrorKind, PairDistance, Selection, World, edge_edge_distances, triangle_contacts,
    vertex_triangle_distances,
};

/// Coordinates on a small lattice, so that many pairs touch, and others anywhere.
fn corner(random: &mut Lcg, is_lattice: bool) -> [f64; 3] {
    [(); 3].map(|()| {
        if is_lattice {
            f64::from(random.below(4))
        } else {
            f64::from(random.unit())
        }
    })
}

fn pairs<const C: usize>(random: &mut Lcg, count: usize) -> Vec<[[f64; 3]; C]> {
    let pair = |place: usize| [(); C].map(|()| corner(random, place.is_multiple_of(2)));
    (0..count).map(pair).collect()
}

#[test]
fn distances_are_those_of_a_world() {
    let random = &mut Lcg(17);
    for pair in pairs::<4>(random, 300).chunks(7) {
        let vertices = vertex_triangle_distances(pair).unwrap();
        let edges = edge_edge_distances(pair).unwrap();
        for (place, &[p, a, b, c]) in pair.iter().enumerate() {
            let world = &mut World::<f64>::new();
            let vertex = world.add(&[[0, 0, 0]], &[p]).unwrap();
            let triangle = world.add(&[[0, 1, 2]], &[a, b, c]).unwrap();
            let of = Selection::Between(vertex, triangle);
            let close = world.close_vertex_triangle_pairs(of, 100.0).all().unwrap();
            let close = close
                .iter()
                .find(|it| it.pair.vertex_body == vertex)
                .unwrap();
            let [u, v, w] = close.barycentric;
            let expected = PairDistance {
                distance: close.distance,
                direction: close.direction,
                weights: [1.0, u, v, w],
                features: close.features(),
            };
            assert_eq!(vertices[place], expected);

            let world = &mut World::<f64>::new();
            let one = world.add(&[[0, 1, 1]], &[p, a]).unwrap();
            let other = world.add(&[[0, 1, 1]], &[b, c]).unwrap();
            let of = Selection::Between(one, other);
            let close = world
                .close_edge_edge_pairs(of, 100.0)
                .first()
                .unwrap()
                .unwrap();
            let ([q, r], [s, t]) = (close.barycentric_a, close.barycentric_b);
            let expected = PairDistance {
                distance: close.distance,
                direction: close.direction,
                weights: [q, r, s, t],
                features: close.features(),
            };
            assert_eq!(edges[place], expected);
        }
    }
}

#[test]
fn contacts_are_those_of_a_world() {
    let random = &mut Lcg(4);
    let mut all = pairs::<6>(random, 2_000);
    // A tenth lie in one plane.
    let flat = all.iter_mut().step_by(10).flatten();
    flat.for_each(|corner| corner[2] = 0.5);
    let mut counts = [0; 4];
    for (pair, found) in all.iter().zip(triangle_contacts(&all).unwrap()) {
        let world = &mut World::<f64>::new();
        let [one, other] =
            [0, 3].map(|first| world.add(&[[0, 1, 2]], &pair[first..first + 3]).unwrap());
        let of = Selection::Between(one, other);
        let expected = world.contacts(of).first().unwrap().map(|it| it.kind);
        assert_eq!(found, expected);
        counts[found.map_or(0, |kind| 1 + kind as usize)] += 1;
    }
    assert!(counts.iter().all(|&count| count > 10), "{counts:?}");
    let single = all.iter().map(|pair| pair.map(|it| it.map(|x| x as f32)));
    let single: Vec<[[f32; 3]; 6]> = single.collect();
    let kinds = triangle_contacts(&single).unwrap();
    assert!(kinds.contains(&Some(ContactKind::Overlapping)));
}

#[test]
fn bad_corners_are_named() {
    let mut pairs = vec![[[0.0; 3]; 4]; 9];
    assert!(vertex_triangle_distances::<f64>(&[]).unwrap().is_empty());
    assert_eq!(edge_edge_distances(&pairs).unwrap()[8].distance, 0.0);
    for bad in [f64::NAN, f64::INFINITY, 1e39] {
        pairs[6][2][1] = bad;
        let mut triangles = vec![[[0.0; 3]; 6]; 9];
        triangles[6][2][1] = bad;
        for refused in [
            vertex_triangle_distances(&pairs).map(drop),
            edge_edge_distances(&pairs).map(drop),
            triangle_contacts(&triangles).map(drop),
        ] {
            let kind = refused.unwrap_err().kind;
            assert!(matches!(
                kind,
                ErrorKind::BadCorner {
                    pair: 6,
                    corner: 2,
                    ..
                }
            ));
        }
    }
}
