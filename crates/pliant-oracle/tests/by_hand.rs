//! The oracle on triangles whose answer is obvious.

use pliant_oracle::{
    Class, Random, Triangle, fits_f32, intersect, orientation, orientation_2d, sign_of_sum,
};

/// A triangle in the plane z = 0.
const A: Triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

/// Asserts the answer for every order of corners and triangles, at every scale.
fn assert_meet(a: &Triangle, b: &Triangle, expected: bool) {
    for order in [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [1, 0, 2],
        [0, 2, 1],
        [2, 1, 0],
    ] {
        // 2^-1074, 2^-1000, 1, 2^120.
        for scale in [5e-324, 2f64.powi(-1000), 1.0, 2f64.powi(120)] {
            let a = order.map(|i| a[i].map(|x| x * scale));
            let b = b.map(|p| p.map(|x| x * scale));
            assert_eq!(intersect(&a, &b), expected, "{a:?} {b:?}");
            assert_eq!(intersect(&b, &a), expected, "{a:?} {b:?}");
        }
    }
}

#[test]
fn touching_is_meeting() {
    for b in [
        // A corner on the face, on an edge, on a corner; an edge through the face, across an edge.
        [[1.0, 1.0, 0.0], [1.0, 1.0, 5.0], [2.0, 1.0, 5.0]],
        [[2.0, 0.0, 0.0], [2.0, 0.0, 5.0], [3.0, -1.0, 5.0]],
        [[0.0, 4.0, 0.0], [0.0, 9.0, 5.0], [0.0, 9.0, 6.0]],
        [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [7.0, 7.0, 0.0]],
        [[1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -9.0, -9.0]],
        // In the plane: one inside the other, edges across, a common edge, a common corner, itself.
        [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]],
        [[-1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [2.0, 9.0, 0.0]],
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, -4.0, 0.0]],
        [[4.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, -1.0, 0.0]],
        A,
        // Segments and points.
        [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
        [[4.0, 0.0, 0.0], [8.0, 0.0, 0.0], [6.0, 0.0, 0.0]],
        [[2.0, 2.0, 0.0]; 3],
        [[0.0; 3]; 3],
    ] {
        assert_meet(&A, &b, true);
    }
}

#[test]
fn a_gap_is_none() {
    for b in [
        // Above; beside; the line of the edge passes outside; in the plane but beyond the slanted
        // edge.
        [[1.0, 1.0, 1.0], [1.0, 2.0, 1.0], [2.0, 1.0, 1.0]],
        [[5.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0]],
        [[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [4.0, 4.0, 0.0]],
        [[3.0, 2.0, 0.0], [2.0, 3.0, 0.0], [4.0, 4.0, 0.0]],
        // Segments: in the line of an edge, skew, parallel; points off the face, off the edge.
        [[5.0, 0.0, 0.0], [8.0, 0.0, 0.0], [6.0, 0.0, 0.0]],
        [[-1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, 0.0]],
        [[0.0, -1.0, 0.0], [4.0, -1.0, 0.0], [4.0, -1.0, 0.0]],
        [[1.0, 1.0, 1.0]; 3],
        [[3.0, 2.0, 0.0]; 3],
    ] {
        assert_meet(&A, &b, false);
    }
}

#[test]
fn two_segments_and_two_points() {
    let x = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    let across = |z: f64| [[0.0, -1.0, z], [0.0, 1.0, z], [0.0, 1.0, z]];
    assert_meet(&x, &across(0.0), true);
    assert_meet(&x, &across(1.0), false);
    assert_meet(&[[1.0; 3]; 3], &[[1.0; 3]; 3], true);
    assert_meet(&[[1.0; 3]; 3], &[[1.0, 1.0, 2.0]; 3], false);
}

#[test]
fn the_smallest_gap_is_seen_beside_the_largest_numbers() {
    let max = f64::from(f32::MAX);
    let wide = |z: f64| [[-max, -max, z], [max, -max, z], [0.0, max, z]];
    assert!(!intersect(&wide(0.0), &wide(5e-324)));
    assert!(intersect(&wide(5e-324), &wide(5e-324)));
    // A corner one smallest number above, and one below.
    let pin = |z: f64| [[0.0, 0.0, z], [0.0, 1.0, max], [1.0, 0.0, max]];
    assert!(!intersect(&wide(0.0), &pin(5e-324)));
    assert!(intersect(&wide(0.0), &pin(0.0)));
    assert!(intersect(&wide(0.0), &pin(-5e-324)));
}

#[test]
fn orientations() {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(orientation(&o, &x, &y, &z), 1);
    assert_eq!(orientation(&o, &y, &x, &z), -1);
    assert_eq!(orientation(&o, &x, &y, &[1e38, -1e38, 0.0]), 0);
    assert_eq!(orientation(&o, &x, &y, &[1e38, -1e38, -5e-324]), -1);
    assert_eq!(orientation_2d([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]), 1);
    assert_eq!(orientation_2d([3.0, 3.0], [1e30, 1e30], [2.0, 2.0]), 0);
    assert_eq!(
        orientation_2d([3.0, 3.0], [1e30, 1e30], [2.0, 2.0f64.next_down()]),
        -1
    );
}

#[test]
fn sums() {
    assert_eq!(sign_of_sum(&[]), 0);
    assert_eq!(sign_of_sum(&[1e38, 5e-324, -1e38]), 1);
    assert_eq!(sign_of_sum(&[1e38, -5e-324, -1e38]), -1);
    assert_eq!(sign_of_sum(&[0.5, 0.25, -0.75]), 0);
    // Rounded, the sum of the first two is not 0.3; the exact sum is not either.
    assert_eq!(sign_of_sum(&[0.1, 0.2, -0.3]), 1);
}

#[test]
fn every_class_is_in_range_and_hard() {
    for class in Class::ALL {
        let mut random = Random::new(1);
        let (mut meeting, mut single) = (0, 0);
        for _ in 0..1000 {
            let pair = class.pair(&mut random);
            let [a, b] = &pair;
            assert!(
                pair.as_flattened()
                    .as_flattened()
                    .iter()
                    .all(|x| x.abs() <= f32::MAX.into())
            );
            meeting += u32::from(intersect(a, b));
            single += u32::from(fits_f32(&pair));
        }
        println!("{class:?}: {meeting} of 1000 meet, {single} are f32");
        assert!(
            (100..=950).contains(&meeting),
            "{class:?}: {meeting} of 1000 meet"
        );
    }
}
