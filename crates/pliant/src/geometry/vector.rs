//! Three-component vectors; a component is one number, or a SIMD register of numbers.
//!
//! Sums go from the first component to the last, and no multiply-add is fused: the bounds on
//! rounding rely on that.

use super::Real;
use std::ops::{Add, Mul, Sub};

/// Three components: one vector, or one vector for each lane of a register.
pub(crate) type Vector<V> = [V; 3];

#[inline(always)]
pub(crate) fn plus<V: Copy + Add<Output = V>>(p: Vector<V>, q: Vector<V>) -> Vector<V> {
    [p[0] + q[0], p[1] + q[1], p[2] + q[2]]
}

#[inline(always)]
pub(crate) fn minus<V: Copy + Sub<Output = V>>(p: Vector<V>, q: Vector<V>) -> Vector<V> {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

#[inline(always)]
pub(crate) fn times<V: Copy + Mul<Output = V>>(by: V, p: Vector<V>) -> Vector<V> {
    [by * p[0], by * p[1], by * p[2]]
}

#[inline(always)]
pub(crate) fn dot<V: Copy + Add<Output = V> + Mul<Output = V>>(p: Vector<V>, q: Vector<V>) -> V {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

#[inline(always)]
pub(crate) fn square_of<V: Copy + Add<Output = V> + Mul<Output = V>>(p: Vector<V>) -> V {
    dot(p, p)
}

#[inline(always)]
pub(crate) fn cross<V: Copy + Sub<Output = V> + Mul<Output = V>>(
    p: Vector<V>,
    q: Vector<V>,
) -> Vector<V> {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

/// Difference of two points in double precision. The fourth number of each is padding.
#[inline(always)]
pub(crate) fn difference<S: Real>(p: &[S; 4], q: &[S; 4]) -> Vector<f64> {
    minus(position(p), position(q))
}

#[inline(always)]
fn position<S: Real>([x, y, z, _]: &[S; 4]) -> Vector<f64> {
    [x.to_f64(), y.to_f64(), z.to_f64()]
}
