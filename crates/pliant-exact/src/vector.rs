//! Vectors of integers, and of doubles: differences, dot and cross products.

use super::Point;
use super::integer::Integer;

/// Three integers of one unit.
pub(super) type Vector = [Integer; 3];

/// A point in units of 2^unit, which its coordinates are multiples of.
pub(super) fn in_units(point: &Point, unit: i32) -> Vector {
    point.map(|x| Integer::new(x, unit))
}

pub(super) fn minus(p: &Vector, q: &Vector) -> Vector {
    std::array::from_fn(|i| p[i].minus(&q[i]))
}

pub(super) fn cross(p: &Vector, q: &Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        p[j].times(&q[k]).minus(&p[k].times(&q[j]))
    })
}

pub(super) fn dot(p: &Vector, q: &Vector) -> Integer {
    let [x, y, z] = std::array::from_fn(|i| p[i].times(&q[i]));
    x.plus(&y).plus(&z)
}

/// The same of doubles, rounded.
pub(super) mod rounded {
    use super::Point;

    #[inline]
    pub(in super::super) fn minus(p: &Point, q: &Point) -> Point {
        [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
    }

    #[inline]
    pub(in super::super) fn cross(p: &Point, q: &Point) -> Point {
        [
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        ]
    }

    #[inline]
    pub(in super::super) fn dot(p: &Point, q: &Point) -> f64 {
        p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
    }
}
