//! Long thin triangles, whose boxes are mostly empty: whether a mesh has many.

use crate::geometry::Real;
use crate::geometry::vector::{Vector, dot, minus};

/// Square of the longest edge over twice the area from which a triangle is long and thin.
const THIN: f64 = 32.0;
/// Part of all squares of longest edges that long thin triangles need to have.
const MANY: f64 = 0.1;

/// Whether long thin triangles make up much of the sizes of all boxes. Turning changes nothing.
pub(crate) fn has_many_thin<S: Real>(triangles: &[[u32; 3]], positions: &[[S; 3]]) -> bool {
    let (mut all, mut thin) = (0.0, 0.0);
    for &[p, q, r] in triangles {
        let (a, b) = (way(positions, p, q), way(positions, p, r));
        let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
        let longest = aa.max(bb).max(aa - 2.0 * ab + bb);
        // Twice the area, squared; rounding does not matter here.
        let square = aa * bb - ab * ab;
        all += longest;
        if longest * longest > THIN * THIN * square {
            thin += longest;
        }
    }
    thin > MANY * all
}

fn way<S: Real>(positions: &[[S; 3]], from: u32, to: u32) -> Vector<f64> {
    let [from, to] = [from, to].map(|vertex| positions[vertex as usize].map(Real::to_f64));
    minus(to, from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A right triangle whose legs have these lengths.
    fn right(long: f64, short: f64, triangles: &mut Vec<[u32; 3]>, positions: &mut Vec<[f64; 3]>) {
        let first = positions.len() as u32;
        triangles.push([first, first + 1, first + 2]);
        positions.extend([[0.0; 3], [0.0, long, 0.0], [short, 0.0, 0.0]]);
    }

    #[test]
    fn the_limits_are_where_they_are_said_to_be() {
        let has_many = |thin: (f64, f64), good: f64| {
            let (mut triangles, mut positions) = Default::default();
            right(thin.0, thin.1, &mut triangles, &mut positions);
            right(good, good, &mut triangles, &mut positions);
            has_many_thin(&triangles, &positions)
        };
        // The square of the longest edge over twice the area is 31 + 1 / 31, or 33 + 1 / 33.
        assert!(!has_many((31.0, 1.0), 1.0) && has_many((33.0, 1.0), 1.0));
        // Squares of longest edges: 1,090 beside ten times 981, and ten times 979.
        assert!(!has_many((33.0, 1.0), 70.1) && has_many((33.0, 1.0), 69.9));
        assert!(!has_many_thin::<f64>(&[], &[]));
    }
}
