//! Vector operations that the scenes need.

/// A point or a direction: x, y, z.
pub(crate) type Vec3 = [f64; 3];

#[inline]
pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
pub(crate) fn scale(a: Vec3, by: f64) -> Vec3 {
    [a[0] * by, a[1] * by, a[2] * by]
}

#[inline]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Unit vector along `a`, which must not be zero.
pub(crate) fn normalised(a: Vec3) -> Vec3 {
    scale(a, 1.0 / dot(a, a).sqrt())
}

/// Linear interpolation from `a` (part = 0) to `b` (part = 1).
pub(crate) fn between(a: Vec3, b: Vec3, part: f64) -> Vec3 {
    std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * part)
}

/// Two unit vectors orthogonal to the unit vector `axis` and to each other.
pub(crate) fn upright(axis: Vec3) -> (Vec3, Vec3) {
    // The coordinate axis least along `axis`, so that the cross product is far from zero.
    let least = (0..3)
        .min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs()))
        .unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let first = normalised(cross(axis, other));
    (first, cross(axis, first))
}

#[cfg(test)]
mod tests {
    use super::{dot, upright};
    use crate::rng::Rng;

    #[test]
    fn upright_vectors_are_a_frame() {
        let mut rng = Rng::new(7, 0, 0);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
        for axis in (0..100).map(|_| rng.direction()).chain(axes) {
            let (a, b) = upright(axis);
            for (product, expected) in [
                (dot(a, a), 1.0),
                (dot(b, b), 1.0),
                (dot(a, b), 0.0),
                (dot(a, axis), 0.0),
                (dot(b, axis), 0.0),
            ] {
                assert!((product - expected).abs() < 1e-14, "{axis:?}");
            }
        }
    }
}
