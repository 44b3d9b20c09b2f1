//! Box of one triangle, computed directly from its vertices.
//!
//! Methods without a persistent tree spend most of a step on such boxes, hence two details. Corners
//! are not copied first: three points written together and read at once in other pieces stall a
//! processor. The smaller number is picked by `if`, one instruction; `f32::min` spends two more on
//! NaN.

use super::aabb::Aabb;

/// Box of a triangle, given by its vertices.
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
