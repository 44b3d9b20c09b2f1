//! No number makes a function panic, or never end: NaN, infinities, the ends of the range.

use pliant_exact::distance::{
    Primitives, are_points_within, are_triangles_within, are_within_distance,
};
use pliant_exact::distance::{SomePoints, closest, closest_triangles, point_in_common};
use pliant_exact::motion::{
    Grid, Moving, distant_until, first_contact, impact, starts_surely_within,
};
use pliant_exact::{Point, Precision, are_boxes_within, contact_kind, intersect, is_degenerate};
use pliant_exact::{adjacent_contact, crossing_edges, intersection, reference, side_of_plane};
use pliant_oracle::Random;

const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    3.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    -1e-310,
    3.4e38,
    1e-30,
    0.1,
];

#[test]
fn any_numbers_are_answered() {
    let mut random = Random::new(61);
    let mut in_time = 0;
    for _ in 0..150 {
        let mut number = || NUMBERS[random.below(NUMBERS.len() as u32) as usize];
        let mut point = || -> Point { [number(), number(), number()] };
        let [a, b] = [[point(), point(), point()], [point(), point(), point()]];
        let [start, end] = [(); 2].map(|()| [point(), point(), point(), point()]);
        let distance = number();
        is_degenerate(a);
        side_of_plane(a, b[0]);
        are_boxes_within(&[a[0], a[1]], &[b[0], b[1]], distance);
        reference::intersect(&a, &b);
        reference::contact_kind(&a, &b);
        are_points_within(&a[0], &b[0], distance);
        point_in_common(&a, &b);
        for precision in [Precision::Single, Precision::Double] {
            intersect(precision, &a, &b, &mut 0);
            contact_kind(precision, &a, &b);
            for numbers in [
                [[0, 1, 2], [0, 3, 4]],
                [[0, 1, 2], [0, 1, 3]],
                [[0, 0, 1], [1, 2, 3]],
            ] {
                adjacent_contact(precision, numbers, &a, &b, &mut 0);
            }
            intersection(precision, &a, &b);
            crossing_edges(precision, &a, &b);
            are_triangles_within(precision, &a, &b, distance);
            let known = SomePoints {
                which: 3,
                along: [0.0; 2],
                apart: distance,
            };
            closest_triangles(precision, &a, &b, known);
        }
        for (elements, are_edges) in [
            (Primitives::VertexTriangle(start), false),
            (Primitives::EdgeEdge(start), true),
        ] {
            closest(&elements);
            are_within_distance(&elements, distance);
            let moving = Moving {
                are_edges,
                corners: [start, end],
            };
            for width in [distance, 1e-6] {
                let (cell, _) = impact(&moving, Grid::new(width));
                in_time += u32::from(cell.is_some_and(|[low, high]| low <= high && high <= 1.0));
            }
            starts_surely_within(&moving, distance);
            distant_until(&moving, distance, 1.0);
            let [of_start, of_end] = [first_contact(&moving), first_contact(&moving)];
            if let (Some(first), Some(other)) = (of_start, of_end) {
                assert!(first.compare(&other).is_eq());
                first.is_at_most(distance);
                first.surely_precedes(&moving, 1.0, true);
            }
        }
    }
    assert!(in_time > 10, "{in_time}");
}
