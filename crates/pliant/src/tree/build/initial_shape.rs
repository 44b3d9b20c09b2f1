//! The paper's initial shape tree (3.2): a part's box is cut at a point, along its longest side (degree 2), its two longest
//! (4) or all three (8), and each triangle goes where its midpoint lies. Empty sub-volumes get no child.
//!
//! The point is the centre of the box, which the paper prefers, or the mean of the triangles' midpoints. A surface meets
//! about four octants of a cube, so on surfaces about half of eight lanes stay empty; `Balanced` fills them.

use super::Split;
use crate::geometry::{Bounds, Real};
use crate::held;
use std::borrow::Cow;

/// Where a part is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CutAt {
    /// At the centre of the part's box.
    Centre,
    /// At the mean of the part's midpoints.
    Mean,
}

pub(crate) struct InitialShape<'a, S: Copy> {
    triangles: Cow<'a, [[u32; 3]]>,
    positions: Cow<'a, [[S; 3]]>,
    cut: CutAt,
    /// How many sides are cut: the degree is 2 to this power.
    sides: usize,
    scratch: Vec<(u8, u32)>,
}

impl<'a, S: Real> InitialShape<'a, S> {
    /// Triangles and positions in the caller's order.
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
            scratch: Vec::new(),
        }
    }

    fn corners(&self, triangle: u32) -> [[S; 3]; 3] {
        self.triangles[triangle as usize].map(|vertex| self.positions[vertex as usize])
    }

    fn midpoint(&self, triangle: u32) -> [f64; 3] {
        midpoint(self.corners(triangle))
    }
}

/// The mean of three corners. In `f64`, where neither three coordinates of `f32::MAX` nor 2^28 midpoints can overflow.
pub(super) fn midpoint<S: Real>([a, b, c]: [[S; 3]; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| (a[axis].to_f64() + b[axis].to_f64() + c[axis].to_f64()) / 3.0)
}

impl<S: Real> Split for InitialShape<'_, S> {
    fn held(&self) -> usize {
        size_of_val(&*self.triangles) + size_of_val(&*self.positions) + held::list(&self.scratch)
    }

    fn split(&mut self, triangles: &mut [u32], pieces: &mut Vec<usize>) {
        let mut bounds = Bounds::EMPTY;
        let mut sum = [0.0; 3];
        for &triangle in &*triangles {
            let corners = self.corners(triangle);
            corners.iter().for_each(|&corner| bounds.include(corner));
            let midpoint = midpoint(corners);
            sum = std::array::from_fn(|axis| sum[axis] + midpoint[axis]);
        }
        let (lo, hi) = (bounds.lo.map(S::to_f64), bounds.hi.map(S::to_f64));
        let point = match self.cut {
            CutAt::Centre => std::array::from_fn(|axis| f64::midpoint(lo[axis], hi[axis])),
            CutAt::Mean => sum.map(|sum| sum / triangles.len() as f64),
        };
        let axes = super::axes_by_length(lo, hi);
        let axes = &axes[..self.sides];

        // Counting sort by sub-volume; stable, so that the order depends on nothing else.
        let mut counts = [0_usize; 8];
        self.scratch.clear();
        for &triangle in &*triangles {
            let midpoint = self.midpoint(triangle);
            let volume = axes.iter().fold(0, |volume, &axis| {
                volume << 1 | u8::from(midpoint[axis] >= point[axis])
            });
            counts[volume as usize] += 1;
            self.scratch.push((volume, triangle));
        }
        let mut places = [0; 8];
        for volume in 1..8 {
            places[volume] = places[volume - 1] + counts[volume - 1];
        }
        for &(volume, triangle) in &self.scratch {
            let place = &mut places[volume as usize];
            triangles[*place] = triangle;
            *place += 1;
        }
        pieces.extend(counts.into_iter().filter(|&count| count > 0));
    }
}
