//! Vectors: differences, dot and cross products, of whatever can be added and multiplied.

use super::Point;
use super::integer::Integer;
use super::ring::Ring;

/// Three integers of one unit.
pub(super) type Vector = [Integer; 3];

/// A point in units of 2^unit, which its coordinates are multiples of.
pub(super) fn in_units(point: &Point, unit: i32) -> Vector {
    point.map(|x| Integer::new(x, unit))
}

#[inline]
pub(super) fn minus<T: Ring>(p: &[T; 3], q: &[T; 3]) -> [T; 3] {
    [0, 1, 2].map(|i| p[i].minus(&q[i]))
}

#[inline]
pub(super) fn cross<T: Ring>(p: &[T; 3], q: &[T; 3]) -> [T; 3] {
    [0, 1, 2].map(|axis| cross_on(axis, p, q))
}

/// One component of a cross product.
#[inline]
pub(super) fn cross_on<T: Ring>(axis: usize, p: &[T; 3], q: &[T; 3]) -> T {
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    p[j].times(&q[k]).minus(&p[k].times(&q[j]))
}

#[inline]
pub(super) fn dot<T: Ring>(p: &[T; 3], q: &[T; 3]) -> T {
    let [x, y, z] = [0, 1, 2].map(|i| p[i].times(&q[i]));
    x.plus(&y).plus(&z)
}

/// The determinant of three vectors: (p x q) . r.
#[inline]
pub(super) fn determinant<T: Ring>(p: &[T; 3], q: &[T; 3], r: &[T; 3]) -> T {
    dot(&cross(p, q), r)
}
