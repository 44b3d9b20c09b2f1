//! Points side by side in memory, laid out so that one is read as four numbers at once.

use super::{Bounds, Real};
use crate::held::{self, Held};
use crate::ids::TreeVertex;

/// Points in a row that have bounds of their own.
pub(crate) const IN_A_ROW: usize = 32;

/// The bounds of some points: lo and hi, each with padding behind it.
pub(crate) type RowBounds<S> = [[S; 4]; 2];

/// Points of three coordinates and padding, so that each fills a register of four; and the bounds of every [`IN_A_ROW`], from which
/// the boxes of upper nodes, whose points are long runs, are made. `kernels::gather` fills both.
#[derive(Clone, Debug)]
pub(crate) struct Points<S> {
    pub(crate) points: Vec<[S; 4]>,
    pub(crate) bounds: Vec<RowBounds<S>>,
}

impl<S: Real> Points<S> {
    /// Room for points that are yet to come.
    pub(crate) fn with_len(len: usize) -> Self {
        Self {
            points: vec![[S::default(); 4]; len],
            bounds: vec![[[S::default(); 4]; 2]; len.div_ceil(IN_A_ROW)],
        }
    }

    /// Points in the order in which they come: what `kernels::gather` must give.
    pub(crate) fn of(points: impl ExactSizeIterator<Item = [S; 3]>) -> Self {
        let mut all = Self::with_len(0);
        all.refill(points);
        all
    }

    /// As many points as come, in memory that is there.
    pub(crate) fn refill(&mut self, points: impl Iterator<Item = [S; 3]>) {
        let padded = |[x, y, z]: [S; 3]| [x, y, z, z];
        self.points.clear();
        self.points.extend(points.map(padded));
        self.bounds.clear();
        self.bounds.extend(self.points.chunks(IN_A_ROW).map(|row| {
            let mut bounds = Bounds::EMPTY;
            row.iter()
                .for_each(|&[x, y, z, _]| bounds.include([x, y, z]));
            [padded(bounds.lo), padded(bounds.hi)]
        }));
    }

    #[inline]
    pub(crate) fn get(&self, vertex: TreeVertex) -> [S; 3] {
        let [x, y, z, _] = *self.padded(vertex);
        [x, y, z]
    }
}

impl<S> Points<S> {
    /// A point and padding.
    #[inline(always)]
    pub(crate) fn padded(&self, vertex: TreeVertex) -> &[S; 4] {
        &self.points[vertex.index()]
    }
}

impl<S> Held for Points<S> {
    fn held(&self) -> usize {
        held::list(&self.points) + held::list(&self.bounds)
    }
}
