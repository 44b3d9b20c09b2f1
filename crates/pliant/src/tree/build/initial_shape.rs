//! Initial shape partition of the paper (3.2): each node's box is cut at a point.
//!
//! The cut goes along the longest side (degree 2), the two longest (4) or all three (8). Each
//! triangle goes where its midpoint lies; empty sub-volumes get no child. The point is the centre
//! of the box, which the paper prefers, or the mean of the midpoints. A surface meets about four
//! octants of a cube, so about half of eight lanes stay empty. `Balanced` fills them.

use super::{Pieces, Split};
use crate::geometry::{Bounds, Real};
use crate::held;
use crate::threads::Budget;
use std::borrow::Cow;

/// Point at which a node is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CutAt {
    /// Centre of the node's box.
    Centre,
    /// Mean of the midpoints of the node's triangles.
    Mean,
}

/// Rule that divides triangles by the sub-volumes of their box.
pub(crate) struct InitialShape<'a, S: Copy> {
    triangles: Cow<'a, [[u32; 3]]>,
    positions: Cow<'a, [[S; 3]]>,
    cut: CutAt,
    /// How many sides are cut: the degree is 2 to this power.
    sides: usize,
    /// Triangles of the current node that were looked at.
    seen: usize,
    /// Box of these triangles.
    bounds: Bounds<S>,
    /// Sum of their midpoints.
    sum: [f64; 3],
    /// Sub-volume of each triangle, in a second pass.
    volumes: Vec<(u8, u32)>,
}

/// Triangles between two checks of the budget.
const AT_ONCE: usize = 1024;

impl<'a, S: Real> InitialShape<'a, S> {
    /// Takes triangles and positions in the caller's order.
    pub(crate) fn new(
        triangles: Cow<'a, [[u32; 3]]>,
        positions: Cow<'a, [[S; 3]]>,
        cut: CutAt,
        degree: usize,
    ) -> Self {
        Self {
            triangles,
            positions,
            cut,
            sides: degree.ilog2() as usize,
            seen: 0,
            bounds: Bounds::EMPTY,
            sum: [0.0; 3],
            volumes: Vec::new(),
        }
    }

    fn corners(&self, triangle: u32) -> [[S; 3]; 3] {
        self.triangles[triangle as usize].map(|vertex| self.positions[vertex as usize])
    }

    fn midpoint(&self, triangle: u32) -> [f64; 3] {
        midpoint(self.corners(triangle))
    }
}

/// Mean of three corners in `f64`, where neither three coordinates of `f32::MAX` nor 2^28 midpoints
/// overflow.
pub(crate) fn midpoint<S: Real>([a, b, c]: [[S; 3]; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| (a[axis].to_f64() + b[axis].to_f64() + c[axis].to_f64()) / 3.0)
}

impl<S: Real> Split for InitialShape<'_, S> {
    fn held(&self) -> usize {
        size_of_val(&*self.triangles) + size_of_val(&*self.positions) + held::list(&self.volumes)
    }

    fn split(&mut self, triangles: &mut [u32], pieces: &mut Pieces, budget: &mut Budget) -> bool {
        let count = triangles.len();
        while self.seen < count {
            if budget.is_spent() {
                return false;
            }
            let some = self.seen..count.min(self.seen + AT_ONCE);
            budget.spend(some.len());
            self.seen = some.end;
            for &triangle in &triangles[some] {
                let corners = self.corners(triangle);
                let bounds = &mut self.bounds;
                corners.iter().for_each(|&corner| bounds.include(corner));
                let midpoint = midpoint(corners);
                self.sum = std::array::from_fn(|axis| self.sum[axis] + midpoint[axis]);
            }
        }
        let [lo, hi] = [self.bounds.lo, self.bounds.hi].map(|corner| corner.map(S::to_f64));
        let point = match self.cut {
            CutAt::Centre => std::array::from_fn(|axis| f64::midpoint(lo[axis], hi[axis])),
            CutAt::Mean => self.sum.map(|sum| sum / count as f64),
        };
        let axes = super::axes_by_length(lo, hi);
        let axes = &axes[..self.sides];

        while self.volumes.len() < count {
            if budget.is_spent() {
                return false;
            }
            let some = self.volumes.len()..count.min(self.volumes.len() + AT_ONCE);
            budget.spend(some.len());
            for &triangle in &triangles[some] {
                let midpoint = self.midpoint(triangle);
                let volume = axes.iter().fold(0, |volume, &axis| {
                    volume << 1 | u8::from(midpoint[axis] >= point[axis])
                });
                self.volumes.push((volume, triangle));
            }
        }

        // Counting sort by sub-volume; stable, so that the order depends on nothing else.
        let mut counts = [0_usize; 8];
        for &(volume, _) in &self.volumes {
            counts[volume as usize] += 1;
        }
        let mut places = [0; 8];
        for volume in 1..8 {
            places[volume] = places[volume - 1] + counts[volume - 1];
        }
        for (volume, triangle) in self.volumes.drain(..) {
            let place = &mut places[volume as usize];
            triangles[*place] = triangle;
            *place += 1;
        }
        (self.seen, self.bounds, self.sum) = (0, Bounds::EMPTY, [0.0; 3]);
        pieces.extend(counts.into_iter().filter(|&count| count > 0));
        true
    }
}
