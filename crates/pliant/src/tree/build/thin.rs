//! Long thin triangles, whose boxes hold mostly air: whether a mesh has many.

use crate::geometry::Real;

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

fn way<S: Real>(positions: &[[S; 3]], from: u32, to: u32) -> [f64; 3] {
    let [from, to] = [positions[from as usize], positions[to as usize]];
    [0, 1, 2].map(|axis| to[axis].to_f64() - from[axis].to_f64())
}

fn dot(p: [f64; 3], q: [f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}
