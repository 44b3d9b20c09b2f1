//! Whether the gap of two boxes is at most a distance on every axis, in real arithmetic.
//!
//! On an axis the gap of two intervals is the larger of lo_a - hi_b and lo_b - hi_a, negative where
//! they overlap. `Length` compares both with the distance.

use super::{Length, Point};

/// Whether two boxes, each by its lower and its upper corner, are at most `distance` apart on every
/// axis.
///
/// Exact, in real arithmetic on the numbers given. The distance is at least 0 and may be infinite.
///
/// ```
/// use pliant_exact::are_boxes_within;
///
/// let [a, b] = [[[0.0; 3], [1.0; 3]], [[1.1, 0.0, 0.0], [2.0; 3]]];
/// // As doubles, 1.1 - 1 is more than 0.1.
/// assert!(!are_boxes_within(&a, &b, 0.1) && are_boxes_within(&a, &b, 0.100_000_000_000_000_1));
/// ```
#[inline]
pub fn are_boxes_within(a: &[Point; 2], b: &[Point; 2], distance: impl Into<Length>) -> bool {
    let [[lo_a, hi_a], [lo_b, hi_b]] = [a, b];
    let distance = distance.into();
    (0..3).all(|axis| {
        distance.holds_difference(lo_a[axis], hi_b[axis])
            && distance.holds_difference(lo_b[axis], hi_a[axis])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, sign_of_sum};

    #[test]
    fn ties_are_decided_to_the_last_bit() {
        let mut random = Random::new(21);
        let (mut ties, mut outside) = (0, 0);
        for round in 0..40_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            let [[a, ..], [b, ..]] = class.pair(&mut random);
            for (lo, hi) in a.into_iter().zip(b) {
                let near = lo - hi;
                let distances = [
                    near.abs(),
                    near.abs().next_up(),
                    near.abs().next_down(),
                    0.0,
                    1e-3,
                    f64::INFINITY,
                ];
                for distance in distances {
                    let expected =
                        distance == f64::INFINITY || sign_of_sum(&[lo, -hi, -distance]) <= 0;
                    assert_eq!(
                        Length::from(distance).holds_difference(lo, hi),
                        expected,
                        "{lo} {hi} {distance}"
                    );
                    ties += u32::from(near == distance);
                    outside += u32::from(near == distance && !expected);
                }
            }
        }
        assert!(ties > 10_000 && outside > 1000, "{ties} {outside}");
    }
}
