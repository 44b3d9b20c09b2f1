//! Möller's triangle-triangle intersection test, as the paper uses it, to count its wrong answers.
//!
//! From Tomas Möller, *A Fast Triangle-Triangle Intersection Test*, Journal of Graphics Tools 2(2),
//! 1997. In the division-free form of his published program, in f32 and with its tolerance.
//!
//! 1. Signed distances n . q + d of one triangle's corners from the plane of the other. Magnitudes
//!    below [`TOLERANCE`] count as zero. All on one side: no intersection.
//!    The same follows with the triangles exchanged.
//! 2. The line of the two planes has the direction of the product of the normals. Each triangle
//!    cuts an interval out of it, computed from corners and distances. It is measured on the
//!    coordinate in which the direction is largest. Ends are fractions; multiplying both intervals
//!    by all four denominators compares them without a division.
//! 3. All distances zero: the triangles are taken for coplanar, and projected along the largest
//!    component of the normal vector. Edges are tested against edges, then a corner of either
//!    against the other triangle.
//!
//! The test is not exact:
//!
//! - Distances are not normalised: each is multiplied by twice the area of the triangle. So the
//!   tolerance is another length for every triangle, and another answer for every scale. Small
//!   triangles are always taken for coplanar. In the projection, all that lie above each other
//!   meet.
//! - n . q + d loses the digits that the distance from the origin costs.
//! - Ends of intervals are products of a coordinate and four distances, which are volumes. With
//!   triangles of size 1,000 they overflow in f32. Infinite ends meet where they should not, and
//!   NaN meets nothing. Without the tolerance they would underflow for small or nearly coplanar
//!   triangles, and meet everything.
//! - In one plane, parallel edges never meet, and a corner on an edge is not inside. Another pair
//!   of edges makes up for it, unless a triangle is degenerate. A degenerate triangle is in one
//!   plane with everything.

use super::Triangle;

/// Limit below which the product of a distance and twice an area counts as zero.
const TOLERANCE: f32 = 1e-6;

type Vector = [f32; 3];

/// Whether two triangles intersect, by the published rules.
pub fn intersect(v: &Triangle, u: &Triangle) -> bool {
    let plane_v = Plane::of(v);
    let of_u = u.map(|corner| plane_v.distance(corner));
    if one_side(of_u) {
        return false;
    }
    let plane_u = Plane::of(u);
    let of_v = v.map(|corner| plane_u.distance(corner));
    if one_side(of_v) {
        return false;
    }
    let axis = largest(cross(plane_v.normal, plane_u.normal));
    let along = |triangle: &Triangle| triangle.map(|corner| corner[axis]);
    let (Some(cut_v), Some(cut_u)) = (Cut::of(along(v), of_v), Cut::of(along(u), of_u)) else {
        return meet_in_one_plane(v, u, plane_v.normal);
    };
    let [v0, v1] = cut_v.ends(&cut_u);
    let [u0, u1] = cut_u.ends(&cut_v);
    v0 <= u1 && u0 <= v1
}

struct Plane {
    normal: Vector,
    offset: f32,
}

impl Plane {
    fn of([a, b, c]: &Triangle) -> Self {
        let normal = cross(difference(*b, *a), difference(*c, *a));
        Self {
            normal,
            offset: -dot(normal, *a),
        }
    }

    /// Signed distance, multiplied by twice the area of the triangle.
    fn distance(&self, point: Vector) -> f32 {
        let distance = dot(self.normal, point) + self.offset;
        if distance.abs() < TOLERANCE {
            0.0
        } else {
            distance
        }
    }
}

/// Whether all distances have one sign, and none is zero.
///
/// The products cannot underflow: distances are zero or at least [`TOLERANCE`].
fn one_side([d0, d1, d2]: [f32; 3]) -> bool {
    d0 * d1 > 0.0 && d0 * d2 > 0.0
}

/// Interval that a triangle cuts out of the line of the two planes.
///
/// It goes from `origin + slopes[0] / denominators[0]` to `origin + slopes[1] / denominators[1]`.
struct Cut {
    origin: f32,
    slopes: [f32; 2],
    denominators: [f32; 2],
}

impl Cut {
    /// Interval from the coordinates of the corners along the line, and their distances from the
    /// other plane.
    ///
    /// `None` if the triangle lies in that plane.
    fn of(along: [f32; 3], distances: [f32; 3]) -> Option<Self> {
        let [d0, d1, d2] = distances;
        // The corner alone on its side, or on the plane with the others to either side of it.
        let alone = if d0 * d1 > 0.0 {
            2
        } else if d0 * d2 > 0.0 {
            1
        } else if d1 * d2 > 0.0 || d0 != 0.0 {
            0
        } else if d1 != 0.0 {
            1
        } else if d2 != 0.0 {
            2
        } else {
            return None;
        };
        let others = [(alone + 1) % 3, (alone + 2) % 3];
        Some(Self {
            origin: along[alone],
            slopes: others.map(|other| (along[other] - along[alone]) * distances[alone]),
            denominators: others.map(|other| distances[alone] - distances[other]),
        })
    }

    /// Ends multiplied by all four denominators, the smaller first.
    fn ends(&self, other: &Self) -> [f32; 2] {
        let [x0, x1] = self.denominators;
        let theirs = other.denominators[0] * other.denominators[1];
        let origin = self.origin * (x0 * x1 * theirs);
        let start = origin + self.slopes[0] * x1 * theirs;
        let end = origin + self.slopes[1] * x0 * theirs;
        [start.min(end), start.max(end)]
    }
}

type Point2 = [f32; 2];

fn meet_in_one_plane(v: &Triangle, u: &Triangle, normal: Vector) -> bool {
    let (x, y) = match largest(normal) {
        0 => (1, 2),
        1 => (0, 2),
        _ => (0, 1),
    };
    let project = |triangle: &Triangle| triangle.map(|corner| [corner[x], corner[y]]);
    let (v, u) = (project(v), project(u));
    let edge = |triangle: &[Point2; 3], i: usize| [triangle[i], triangle[(i + 1) % 3]];
    (0..3).any(|i| (0..3).any(|j| edges_meet(edge(&v, i), edge(&u, j))))
        || inside(v[0], &u)
        || inside(u[0], &v)
}

/// Edges cross if either is cut at a parameter from zero to one. Parallel edges do not.
fn edges_meet([p0, p1]: [Point2; 2], [q0, q1]: [Point2; 2]) -> bool {
    let (p, q, between) = (minus(p1, p0), minus(q1, q0), minus(q0, p0));
    let denominator = area(p, q);
    let from_zero_to_one = |numerator: f32| {
        if denominator > 0.0 {
            0.0 <= numerator && numerator <= denominator
        } else {
            denominator <= numerator && numerator <= 0.0
        }
    };
    denominator != 0.0 && from_zero_to_one(area(between, q)) && from_zero_to_one(area(between, p))
}

/// Strictly on one side of all three edges.
fn inside(point: Point2, triangle: &[Point2; 3]) -> bool {
    let [d0, d1, d2] = [0, 1, 2].map(|i| {
        let (start, end) = (triangle[i], triangle[(i + 1) % 3]);
        area(minus(end, start), minus(point, start))
    });
    d0 * d1 > 0.0 && d0 * d2 > 0.0
}

fn minus(a: Point2, b: Point2) -> Point2 {
    [a[0] - b[0], a[1] - b[1]]
}

fn area(a: Point2, b: Point2) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

fn difference(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn cross([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Vector {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

fn dot([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> f32 {
    ax * bx + ay * by + az * bz
}

/// The axis of the component of largest magnitude, the first of equals.
fn largest(vector: Vector) -> usize {
    (1..3).fold(0, |best, axis| {
        if vector[axis].abs() > vector[best].abs() {
            axis
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::exact;
    use super::*;

    /// Pairs that are said to intersect and do not, and pairs that are missed.
    fn wrong_answers(pairs: impl IntoIterator<Item = [Triangle; 2]>) -> [usize; 2] {
        let mut wrong = [0, 0];
        for [a, b] in pairs {
            let (said, true_answer) = (intersect(&a, &b), exact(&a, &b));
            wrong[0] += usize::from(said && !true_answer);
            wrong[1] += usize::from(!said && true_answer);
        }
        wrong
    }

    /// Triangles with corners anywhere in a cube, a quarter of the pairs intersecting.
    fn generic(count: usize, side: f32) -> Vec<[Triangle; 2]> {
        let mut state = 0x2545_f491_u32;
        let mut coordinate = || {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            (state >> 8) as f32 / (1 << 24) as f32 * side
        };
        (0..count)
            .map(|_| [(); 2].map(|()| [(); 3].map(|()| [(); 3].map(|()| coordinate()))))
            .collect()
    }

    /// The halves of the unit square against the same, shifted by eighths and `above` them.
    fn layers(above: f32) -> Vec<[Triangle; 2]> {
        let halves = [
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        ];
        let mut pairs = Vec::new();
        for i in -12..=12_i16 {
            for j in -12..=12_i16 {
                let shift = [f32::from(i) / 8.0, f32::from(j) / 8.0];
                for a in halves {
                    for b in halves {
                        pairs.push([
                            a.map(|[x, y]| [x, y, 0.5]),
                            b.map(|[x, y]| [x + shift[0], y + shift[1], 0.5 + above]),
                        ]);
                    }
                }
            }
        }
        pairs
    }

    #[test]
    fn triangles_of_size_one_in_general_position_are_right() {
        let pairs = generic(200_000, 1.0);
        let intersecting = pairs.iter().filter(|[a, b]| exact(a, b)).count();
        assert_eq!(intersecting, 55_781);
        // No tolerance: not one of 200,000.
        assert_eq!(wrong_answers(pairs), [0, 0]);
    }

    #[test]
    fn small_triangles_are_taken_for_coplanar() {
        // Multiplying all coordinates by a power of two changes no true answer.
        assert_eq!(wrong_answers(generic(200_000, 1.0 / 16.0)), [2_592, 558]);
        // What is left is the projection: whatever overlaps there is said to meet.
        assert_eq!(wrong_answers(generic(200_000, 1.0 / 128.0)), [89_498, 0]);
    }

    #[test]
    fn large_triangles_overflow() {
        assert_eq!(wrong_answers(generic(200_000, 256.0)), [0, 0]);
        assert_eq!(wrong_answers(generic(200_000, 4096.0)), [16_301, 26_650]);
    }

    #[test]
    fn layers_closer_than_the_tolerance_are_one_plane() {
        let right = [0, 0];
        assert_eq!(wrong_answers(layers(0.0)), right);
        assert_eq!(wrong_answers(layers(0.5_f32.powi(19))), right);
        // Two to the power of -20 is below the tolerance: all 740 that meet in the projection.
        assert_eq!(wrong_answers(layers(0.5_f32.powi(20))), [740, 0]);
    }

    #[test]
    fn segments_on_one_line_are_missed() {
        let segment = |start: f32| {
            [
                [start, 0.0, 0.0],
                [start + 2.0, 0.0, 0.0],
                [start, 0.0, 0.0],
            ]
        };
        assert_eq!(wrong_answers([[segment(0.0), segment(1.0)]]), [0, 1]);
    }
}
