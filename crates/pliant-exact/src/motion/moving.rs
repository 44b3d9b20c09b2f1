//! Two elements on their way: a vertex and a triangle, or two edges, on straight lines.

use super::super::Point;

/// Two elements that move: their corners at the start and at the end.
///
/// Coordinates of both are in one unit, and [in range](crate::is_in_range).
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// Whether they are two edges, by the ends of either; else they are a vertex and the corners of
    /// a triangle.
    pub are_edges: bool,
    /// Corners at the start and at the end of the motion; in between they are on straight lines.
    pub corners: [[Point; 4]; 2],
}

impl Moving {
    /// Whether a corner of the one is at the start where one of the other is: common where surfaces
    /// are not joined along a seam.
    ///
    /// Compared bit by bit, so that it does not depend on how subnormal numbers are treated. A zero
    /// of the other sign is left to the decision.
    #[inline]
    pub fn begins_with_a_corner_in_common(&self) -> bool {
        let [start, _] = self.corners;
        let [a, b, c, d] = start.map(|corner| corner.map(f64::to_bits));
        if self.are_edges {
            a == c || a == d || b == c || b == d
        } else {
            a == b || a == c || a == d
        }
    }
}
