//! Affine maps: translation, rotation, scale, and their product as a matrix of three rows.

/// An affine map x to A x + b: the columns of A, then b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine(pub(super) [[f64; 3]; 4]);

/// A quaternion: x, y, z, w.
pub(super) type Quaternion = [f64; 4];

/// A scale, then a rotation, then a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Trs {
    pub(super) translation: [f64; 3],
    pub(super) rotation: Quaternion,
    pub(super) scale: [f64; 3],
}

impl Affine {
    pub(super) const IDENTITY: Self = Self([
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 0.0],
    ]);

    /// Converts a column-major 4 x 4 matrix, as in files; the fourth row is ignored.
    pub(super) fn from_columns(m: &[f64; 16]) -> Self {
        Self([0, 4, 8, 12].map(|at| [m[at], m[at + 1], m[at + 2]]))
    }

    pub(super) fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let [linear @ .., offset] = &self.0;
        let mut sum = *offset;
        for (column, x) in linear.iter().zip(point) {
            for (sum, c) in sum.iter_mut().zip(column) {
                *sum += c * x;
            }
        }
        sum
    }

    /// Composition: first `first`, then `self`.
    pub(super) fn after(&self, first: &Self) -> Self {
        let [x, y, z, offset] = first.0;
        let turn = |v: [f64; 3]| {
            let [a, b, c, _] = &self.0;
            [0, 1, 2].map(|row| a[row] * v[0] + b[row] * v[1] + c[row] * v[2])
        };
        Self([turn(x), turn(y), turn(z), self.apply(offset)])
    }
}

impl Trs {
    pub(super) const IDENTITY: Self = Self {
        translation: [0.0; 3],
        rotation: [0.0, 0.0, 0.0, 1.0],
        scale: [1.0; 3],
    };

    /// The matrix of the map. Normalises the rotation, which files have in at most 32 bits.
    pub(super) fn matrix(&self) -> Affine {
        let [x, y, z, w] = normalised(self.rotation);
        let [sx, sy, sz] = self.scale;
        Affine([
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y + z * w),
                2.0 * (x * z - y * w),
            ]
            .map(|c| c * sx),
            [
                2.0 * (x * y - z * w),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z + x * w),
            ]
            .map(|c| c * sy),
            [
                2.0 * (x * z + y * w),
                2.0 * (y * z - x * w),
                1.0 - 2.0 * (x * x + y * y),
            ]
            .map(|c| c * sz),
            self.translation,
        ])
    }
}

/// The quaternion at length 1; NaN where it has no direction.
pub(super) fn normalised(q: Quaternion) -> Quaternion {
    let largest = q.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    // Squares of other numbers overflow or underflow.
    let q = if (1e-100..1e100).contains(&largest) {
        q
    } else {
        q.map(|x| x / largest)
    };
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

/// Spherical linear interpolation from `a` (t = 0) to `b` (t = 1), the short way.
pub(super) fn slerp(a: Quaternion, b: Quaternion, t: f64) -> Quaternion {
    let (a, mut b) = (normalised(a), normalised(b));
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    if dot < 0.0 {
        b = b.map(|x| -x);
    }
    let length = |each: fn(f64, f64) -> f64| {
        let squares = a.iter().zip(b).map(|(&a, b)| each(a, b) * each(a, b));
        squares.sum::<f64>().sqrt()
    };
    // Half the sides of a triangle on the circle. Exact for the smallest angles, unlike the arc
    // cosine.
    let half = libm::atan2(length(|a, b| a - b), length(|a, b| a + b));
    let whole = libm::sin(2.0 * half);
    // Where sines no longer differ from their angles, the chord is the arc.
    let [of_a, of_b] = if half < 1e-8 {
        [1.0 - t, t]
    } else {
        [
            libm::sin((1.0 - t) * 2.0 * half) / whole,
            libm::sin(t * 2.0 * half) / whole,
        ]
    };
    let mut q = [0.0; 4];
    for (q, (a, b)) in q.iter_mut().zip(a.iter().zip(b)) {
        *q = of_a * a + of_b * b;
    }
    normalised(q)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: &[f64], b: &[f64]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14)
    }

    #[test]
    fn scale_then_rotation_then_translation() {
        let quarter = std::f64::consts::FRAC_PI_4;
        let trs = Trs {
            translation: [1.0, 2.0, 3.0],
            // A quarter turn round z, at twice unit length.
            rotation: [0.0, 0.0, 2.0 * quarter.sin(), 2.0 * quarter.cos()],
            scale: [-2.0, 3.0, 0.5],
        };
        let placed = trs.matrix().apply([1.0, 1.0, 1.0]);
        assert!(near(&placed, &[1.0 - 3.0, 2.0 - 2.0, 3.5]), "{placed:?}");
        assert_eq!(Trs::IDENTITY.matrix(), Affine::IDENTITY);
    }

    #[test]
    fn the_first_map_is_applied_first() {
        let one = Trs {
            translation: [1.0, 0.0, 0.0],
            scale: [2.0; 3],
            ..Trs::IDENTITY
        };
        let other = Trs {
            rotation: [0.5; 4],
            ..Trs::IDENTITY
        };
        let [one, other] = [one, other].map(|trs| trs.matrix());
        let both = other.after(&one).apply([1.0, 2.0, 3.0]);
        assert!(near(&both, &other.apply(one.apply([1.0, 2.0, 3.0]))));
        assert!(near(&both, &[6.0, 3.0, 4.0]), "{both:?}");
    }

    #[test]
    fn slerp_keeps_its_speed_and_goes_the_short_way() {
        let about_z = |angle: f64| [0.0, 0.0, (angle / 2.0).sin(), (angle / 2.0).cos()];
        for (from, to) in [
            (0.0, 1.0),
            (0.3, -2.0),
            (0.0, 1e-7),
            (1.0, 1.0 + 1e-12),
            (0.0, 3.0),
        ] {
            for t in [0.0, 0.25, 0.5, 1.0] {
                let between = about_z(from + t * (to - from));
                assert!(
                    near(&slerp(about_z(from), about_z(to), t), &between),
                    "{from} {to} {t}"
                );
                let other_way = slerp(about_z(from), about_z(to).map(|x: f64| -x), t);
                assert!(near(&other_way, &between), "{from} {to} {t}");
            }
        }
    }
}
