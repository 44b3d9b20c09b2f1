//! The box of one triangle, straight from where its vertices lie.
//!
//! The boxes of all triangles are most of what methods without a persistent tree do in a step, so this is written with care:
//! corners are not copied first (three points put together and at once read in other pieces make a processor wait), and `if`
//! picks the smaller number, one instruction, where `f32::min` spends two more on NaN.

use super::aabb::Aabb;

/// The box of a triangle given by its vertices.
#[inline]
pub(super) fn triangle_box(corners: [u32; 3], positions: &[[f32; 3]]) -> Aabb {
    let smaller = |a: f32, b: f32| if a < b { a } else { b };
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let [a, b, c] = corners.map(|vertex| &positions[vertex as usize]);
    Aabb {
        lo: std::array::from_fn(|axis| smaller(smaller(a[axis], b[axis]), c[axis])),
        hi: std::array::from_fn(|axis| larger(larger(a[axis], b[axis]), c[axis])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_box_of_the_corners() {
        let positions = [
            [1.0, -2.0, 3.0],
            [0.5, 7.0, 3.0],
            [-1.0, 0.0, 2.0],
            [9.0; 3],
        ];
        for corners in [[0, 1, 2], [2, 0, 1], [1, 1, 3], [0, 0, 0]] {
            let points = corners.map(|vertex: u32| positions[vertex as usize]);
            assert_eq!(triangle_box(corners, &positions), Aabb::of(&points));
        }
    }
}
