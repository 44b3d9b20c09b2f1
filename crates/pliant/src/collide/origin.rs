//! Floating origin: the point that the boxes of an `f64` world are relative to.
//!
//! It follows the bodies, because the digits of an `f32` are best spent on their shapes.

use crate::bodies::{Bodies, Body};
use crate::geometry::{Bounds, Origin};
use crate::kernels::Coordinate;

/// Floating origin of a world.
#[derive(Debug, Default)]
pub(crate) struct FloatingOrigin {
    /// Coordinates of the origin; zero for `f32`.
    pub(crate) point: Origin,
    /// Shapes taken over since the extent of all bodies was last computed.
    moves: usize,
}

impl FloatingOrigin {
    /// Notes that a body has a new shape.
    pub(crate) fn note_movement(&mut self) {
        self.moves += 1;
    }

    /// Moves to the bodies if they have moved away; all boxes are then stale. Returns whether it
    /// moved.
    ///
    /// Amortised O(1) per new shape: it takes O(n) for n bodies, but only after n new shapes.
    pub(crate) fn settle<S: Coordinate>(&mut self, bodies: &mut Bodies<S>) -> bool {
        if S::BOXES_ARE_EXACT || self.moves < bodies.len() {
            return false;
        }
        self.moves = 0;
        let mut extent = Bounds::EMPTY;
        for bounds in bodies.all().map(Body::bounds) {
            extent.include(bounds.lo);
            extent.include(bounds.hi);
        }
        let (lo, hi) = (extent.lo.map(S::to_f64), extent.hi.map(S::to_f64));
        let centre: [f64; 3] = std::array::from_fn(|axis| f64::midpoint(lo[axis], hi[axis]));
        let largest = |values: [f64; 3]| values.into_iter().fold(0.0, f64::max);
        let radius = largest(std::array::from_fn(|axis| (hi[axis] - lo[axis]) / 2.0));
        let away = largest(std::array::from_fn(|axis| {
            (centre[axis] - self.point[axis]).abs()
        }));
        // Within two radii a box loses at most two of its 24 bits. The slack keeps a moving world
        // from settling every step.
        let moves = away > 2.0 * radius;
        if moves {
            let [x, y, z] = centre;
            self.point = [x, y, z, 0.0];
            bodies.all_mut().for_each(Body::origin_moved);
        }
        moves
    }
}
