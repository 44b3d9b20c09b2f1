//! Calling threads that flush subnormal numbers to zero, as audio code and physics engines set it.
//!
//! Such threads also read subnormal numbers as zero. Answers are the same for coordinates that are
//! zero or at least 2^-126 (`f32`) or 2^-969 (`f64`) in magnitude. Results of filter, exact
//! arithmetic and boxes are not subnormal, or their loss is allowed for. Smaller coordinates are
//! zero in such a thread before any of our code runs.

use pliant::{
    Error, ErrorKind, Scalar, Selection, World, edge_edge_distances, edge_edge_impacts, reference,
    triangle_contacts, vertex_triangle_distances, vertex_triangle_impacts,
};
use pliant_oracle::{Class, Random, Triangle, fits_f32, intersect, subnormals_flushed};

/// Whether every coordinate is zero or at least 2^exponent in magnitude.
fn all_from(exponent: i32, pair: &[Triangle; 2]) -> bool {
    let mut coordinates = pair.as_flattened().as_flattened().iter();
    coordinates.all(|&x| x == 0.0 || x.abs() >= 2f64.powi(exponent))
}

/// Answers of a world and of the reference for each pair. The world moves from pair to pair.
fn answers<S: Scalar>(pairs: &[[[[S; 3]; 3]; 2]]) -> Vec<[bool; 2]> {
    let mut world = World::new();
    let start = [[S::default(); 3]; 3];
    let bodies = [(); 2].map(|()| world.add(&[[0, 1, 2]], &start).unwrap());
    let answer = |[a, b]: &[[[S; 3]; 3]; 2]| {
        world.set_positions(bodies[0], a).unwrap();
        world.set_positions(bodies[1], b).unwrap();
        let found = world.intersections(Selection::World).all().unwrap().len();
        let exact = reference::intersection_pairs(&[[0, 1, 2]], a, &[[0, 1, 2]], b).unwrap();
        [found == 1, exact.len() == 1]
    };
    pairs.iter().map(answer).collect()
}

/// Compares answers of a thread that flushes with the oracle, which runs in an ordinary thread.
fn check<S: Scalar>(pairs: &[[Triangle; 2]], narrowed: impl Fn(f64) -> S) {
    let input: Vec<_> = pairs
        .iter()
        .map(|pair| pair.map(|triangle| triangle.map(|p| p.map(&narrowed))))
        .collect();
    let Some(found) = subnormals_flushed(|| answers(&input)) else {
        eprintln!("skipped: there is no way to flush subnormals on this processor");
        return;
    };
    for (pair, found) in pairs.iter().zip(found) {
        assert_eq!(found, [intersect(&pair[0], &pair[1]); 2], "{pair:?}");
    }
}

#[test]
fn answers_stay_right() {
    let mut random = Random::new(8);
    for class in Class::ALL {
        let pairs: Vec<_> = (0..1_000).map(|_| class.pair(&mut random)).collect();
        let single = |pair: &&[Triangle; 2]| fits_f32(pair) && all_from(-126, pair);
        let singles: Vec<_> = pairs.iter().filter(single).copied().collect();
        check(&singles, |x| x as f32);
        let doubles: Vec<_> = pairs
            .iter()
            .filter(|pair| all_from(-969, pair))
            .copied()
            .collect();
        assert!(doubles.len() > 100, "{class:?}");
        check(&doubles, |x| x);
    }
}

/// Products of two and three differences, and single coordinates, leave the normal range.
#[test]
fn answers_stay_right_at_the_ends_of_the_range() {
    let mut random = Random::new(9);
    for exponent in [
        -126, -130, -288, -289, -306, -340, -459, -485, -511, -537, -700, -960,
    ] {
        let scale = 2f64.powi(exponent);
        let mut pair = |round: u32| {
            let class = [Class::Lattice, Class::Coplanar, Class::Segments][round as usize % 3];
            class.pair(&mut random).map(|triangle| {
                triangle.map(|p| match round % 2 {
                    0 => p.map(|x| x * scale),
                    // One axis of ordinary size lifts the product of the others.
                    _ => [p[0] * scale, p[1], p[2] * scale],
                })
            })
        };
        let pairs: Vec<_> = (0..600)
            .map(&mut pair)
            .filter(|pair| all_from(-969, pair))
            .collect();
        assert!(pairs.len() > 300);
        check(&pairs, |x| x);
        if exponent == -126 {
            let fits = |pair: &&[Triangle; 2]| fits_f32(pair) && all_from(-126, pair);
            let singles: Vec<_> = pairs.iter().filter(fits).copied().collect();
            assert!(singles.len() > 300);
            check(&singles, |x| x as f32);
        }
    }
}

#[test]
fn what_such_a_thread_would_lose_is_refused() {
    let triangles = [[0, 1, 2]];
    let good = [
        [0.0, 1.0, 2.0],
        [3.0, -4.0, 5.0],
        [f64::MIN_POSITIVE * 2f64.powi(53), 0.0, 0.0],
    ];
    let mut bad = good;
    bad[1][2] = 5e-324;
    let mut world = World::new();
    let body = world.add(&triangles, &good).unwrap();
    let Some((moved, added, same)) = subnormals_flushed(|| {
        (
            world.set_positions(body, &bad),
            world.add(&triangles, &bad),
            world.set_positions(body, &good),
        )
    }) else {
        return;
    };
    let kind = ErrorKind::NeedsSubnormals { vertex: 1 };
    assert_eq!(
        moved,
        Err(Error {
            body: Some(body),
            kind: kind.clone()
        })
    );
    assert_eq!(added, Err(Error { body: None, kind }));
    assert_eq!(same, Ok(()));
    // A thread that keeps subnormal numbers accepts them.
    world.set_positions(body, &bad).unwrap();
}

#[test]
fn single_pairs_that_such_a_thread_would_lose_are_refused() {
    let good = [
        [0.0, 1.0, 2.0],
        [3.0, -4.0, 5.0],
        [f64::MIN_POSITIVE, 2.0, 0.0],
    ];
    let pair = |tiny: f64| [good[0], good[1], good[2], [0.0, tiny, 0.0]];
    let bad = [pair(1.0), pair(5e-324)];
    let six = bad.map(|[a, b, c, d]| [a, b, c, a, b, d]);
    let asked = || {
        [
            vertex_triangle_distances(&bad).err(),
            edge_edge_distances(&bad).err(),
            vertex_triangle_impacts(&bad, &bad, 1e-6).err(),
            edge_edge_impacts(&bad, &bad, 1e-6).err(),
            triangle_contacts(&six).err(),
        ]
    };
    assert_eq!(asked(), [None, None, None, None, None]);
    let Some(refused) = subnormals_flushed(asked) else {
        return;
    };
    for refused in refused {
        let refused = refused.unwrap();
        let ErrorKind::BadCorner { pair, corner, .. } = refused.kind else {
            panic!("{refused}");
        };
        // The smallest normal number is too small there, too.
        assert_eq!((pair, corner), (0, 2), "{refused}");
        assert!(refused.to_string().contains("flushes"), "{refused}");
    }
}

/// A distance below the smallest normal number is returned as that number, and not as zero.
#[test]
fn what_nearly_touches_is_not_said_to_touch() {
    // The plane x + 1000 y + 1000 z = 1 is 1 / 1414 from 0. Coordinates are in units of 2^-1020,
    // from the point at 2^-968 on each axis.
    let unit = 4.0 * f64::MIN_POSITIVE;
    let at = |all: [[f64; 3]; 3]| all.map(|it| it.map(|x| 2f64.powi(-968) + x * unit));
    let corner = at([[0.0; 3], [-2000.0, 0.0, 0.0], [0.0, -2000.0, 0.0]]);
    let over_it = at([[1.0, 0.0, 0.0], [-999.0, 1.0, 0.0], [-999.0, 0.0, 1.0]]);
    let ask = || {
        let mut world = World::<f64>::new();
        let [a, b] = [corner, over_it].map(|shape| world.add(&[[0, 1, 2]], &shape).unwrap());
        world.distance(a, b, 1.0).unwrap().unwrap()
    };
    let exact = ask();
    assert!((exact.distance / unit - 1.0 / 2_000_001_f64.sqrt()).abs() < 1e-6);
    if let Some(found) = subnormals_flushed(ask) {
        assert_eq!(found.distance, f64::MIN_POSITIVE);
        assert_eq!(found.direction, exact.direction);
    }
}
