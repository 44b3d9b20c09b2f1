//! Triangle-box overlap by the separating axis test: thirteen axes (Akenine-Möller 2001).
//!
//! Computed in f64 from f32 coordinates, with a thousand times the room that rounding needs. So a
//! triangle that meets the box is always kept; one that narrowly misses it may be kept too. The
//! three axes of the box are left out: the boxes were compared before.

use crate::decision::Triangle;
use crate::methods::aabb::Aabb;

/// Room for rounding, relative to the size of the operands. Rounding is a few times 2^-53.
const ROOM: f64 = 1.0 / (1_u64 << 42) as f64;

/// Whether a triangle whose box overlaps `region` meets it.
pub(super) fn meets(corners: &Triangle, region: &Aabb) -> bool {
    let (lo, hi) = (region.lo.map(f64::from), region.hi.map(f64::from));
    let half: [f64; 3] = std::array::from_fn(|axis| 0.5 * (hi[axis] - lo[axis]));
    let points = corners.map(|corner| -> [f64; 3] {
        std::array::from_fn(|axis| f64::from(corner[axis]) - 0.5 * (lo[axis] + hi[axis]))
    });
    let edge = |i: usize| -> [f64; 3] {
        let (from, to) = (points[i], points[(i + 1) % 3]);
        std::array::from_fn(|axis| to[axis] - from[axis])
    };
    let size = |vector: [f64; 3]| vector.into_iter().map(f64::abs).fold(0.0, f64::max);
    let reach = points.into_iter().map(size).fold(size(half), f64::max);

    // Whether they are apart on `direction`, a product of edges of at most length `long`.
    let apart = |direction: [f64; 3], long: f64| {
        let along = points.map(|point| dot(direction, point));
        let radius = dot(direction.map(f64::abs), half) + ROOM * long * reach;
        let [a, b, c] = along;
        a.min(b).min(c) > radius || a.max(b).max(c) < -radius
    };
    let normal = cross(edge(0), edge(1));
    // Before cancellation, the parts of a cross product are at most 8 reach^2. For an edge and an
    // axis: 2 reach.
    let by_normal = apart(normal, 24.0 * reach * reach);
    let by_edges = || {
        (0..3).any(|i| {
            let [x, y, z] = edge(i);
            [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
                .into_iter()
                .any(|direction| apart(direction, 6.0 * reach))
        })
    };
    !by_normal && !by_edges()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: Aabb = Aabb {
        lo: [-1.0; 3],
        hi: [1.0; 3],
    };

    #[test]
    fn corners_of_the_cube_are_cut_off() {
        // In the plane x + y + z = 3 + above, around its middle.
        let triangle = |above: f32| {
            let third = 1.0 + above / 3.0;
            [[2.0, -1.0, -1.0], [-1.0, 2.0, -1.0], [-1.0, -1.0, 2.0]].map(|d| d.map(|x| third + x))
        };
        assert!(meets(&triangle(0.0), &CUBE));
        assert!(meets(&triangle(-0.01), &CUBE));
        assert!(!meets(&triangle(0.01), &CUBE));
    }

    #[test]
    fn edges_of_the_cube_are_passed_by() {
        // A thin triangle past the edge x = y = 1, and one that touches it.
        let triangle = |off: f32| {
            [
                [2.0 + off, 0.0, 0.0],
                [0.0, 2.0 + off, 0.0],
                [2.0, 2.0, 0.1],
            ]
        };
        assert!(meets(&triangle(0.0), &CUBE));
        assert!(!meets(&triangle(0.01), &CUBE));
        let needle = |off: f32| {
            [
                [2.0 + off, 0.0, 0.0],
                [0.0, 2.0 + off, 0.1],
                [0.0, 2.0 + off, 0.2],
            ]
        };
        assert!(meets(&needle(0.0), &CUBE));
        assert!(!meets(&needle(0.01), &CUBE));
    }

    #[test]
    fn degenerate_triangles_are_points_and_segments() {
        assert!(meets(&[[1.0; 3]; 3], &CUBE));
        assert!(meets(&[[1.0, -1.0, 0.3]; 3], &CUBE));
        let segment = |x: f32| [[x, 0.0, 0.0], [0.0, x, 0.0], [0.0, x, 0.0]];
        assert!(meets(&segment(2.0), &CUBE));
        assert!(!meets(&segment(2.01), &CUBE));
    }

    #[test]
    fn a_triangle_that_holds_a_point_of_the_box_meets_it() {
        // Random triangles through random points of a box far from the origin.
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
        };
        let region = Aabb {
            lo: [1000.0, -0.25, 3.0],
            hi: [1000.5, 0.25, 3.0],
        };
        for _ in 0..10_000 {
            // A corner on the face of the box, so that it only touches.
            let x = if random() > 0.0 { 1000.0 } else { 1000.5 };
            let corner = [x, 0.25 * random(), 3.0];
            let other = |far: [f32; 3]| std::array::from_fn(|axis| corner[axis] + far[axis]);
            let triangle = [
                corner,
                other([random(), random(), random()]),
                other([random(), random(), random()]),
            ];
            assert!(meets(&triangle, &region));
        }
    }

    #[test]
    fn a_plane_that_touches_a_corner_is_not_lost_to_rounding() {
        let mut state = 2_u64;
        let mut random = |below: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 33) % below) as f32
        };
        let region = Aabb {
            lo: [-3.0, -1.0, -9.0],
            hi: [5.0, 3.0, 7.0],
        };
        for _ in 0..10_000 {
            // Two directions perpendicular to a normal that points away from the box, in integers.
            let [a, b, c] = std::array::from_fn(|_| 1.0 + random(1_000));
            let (d, e) = ([b, -a, 0.0], [0.0, c, -b]);
            let mut offset = || -> [f32; 3] {
                let (s, t) = (random(2_000) - 1_000.0, random(2_000) - 1_000.0);
                std::array::from_fn(|axis| s * d[axis] + t * e[axis])
            };
            let (first, second) = (offset(), offset());
            let third = std::array::from_fn(|axis| -(first[axis] + second[axis]));
            // The middle of the triangle is the corner of the box; all coordinates are exact.
            let triangle = [first, second, third]
                .map(|offset| std::array::from_fn(|axis| region.hi[axis] + offset[axis]));
            assert!(meets(&triangle, &region));
        }
    }
}
