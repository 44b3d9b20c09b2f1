//! Points padded to four numbers each, so that a register reads one at once.

use super::{Bounds, Real};
use crate::held::held;
use crate::ids::TreeVertex;

/// Points in a row. Each row has bounds of its own; a box over a long run is made from these.
pub(crate) const IN_A_ROW: usize = 32;

/// Bounds of a row of points: lower and upper corner, each padded.
pub(crate) type RowBounds<S> = [[S; 4]; 2];

/// Points of three coordinates and padding, with the bounds of every [`IN_A_ROW`] of them.
///
/// One point fills a register of four. Boxes of upper nodes, whose points are long runs, are made
/// from the bounds of rows. `kernels::gather` fills both lists.
#[derive(Clone, Debug)]
pub(crate) struct Points<S> {
    pub(crate) points: Vec<[S; 4]>,
    pub(crate) bounds: Vec<RowBounds<S>>,
}

impl<S: Real> Points<S> {
    /// Allocates `len` points and their rows, to be filled in later.
    pub(crate) fn with_len(len: usize) -> Self {
        Self {
            points: vec![[S::default(); 4]; len],
            bounds: vec![[[S::default(); 4]; 2]; len.div_ceil(IN_A_ROW)],
        }
    }

    /// Collects points in the order of the iterator: the reference for `kernels::gather`.
    pub(crate) fn of(points: impl ExactSizeIterator<Item = [S; 3]>) -> Self {
        let mut all = Self::with_len(0);
        all.refill(points);
        all
    }

    /// Replaces all points; reuses the memory.
    pub(crate) fn refill(&mut self, points: impl Iterator<Item = [S; 3]>) {
        self.points.clear();
        self.points.extend(points.map(padded));
        self.bounds.clear();
        let rows = self.points.chunks(IN_A_ROW);
        self.bounds.extend(rows.map(bounds_of_row));
    }

    /// Appends a point.
    pub(crate) fn push(&mut self, point: [S; 3]) {
        self.points.push(padded(point));
        self.bound_last_row();
    }

    /// Removes the last point.
    pub(crate) fn pop(&mut self) {
        self.points.pop();
        self.bound_last_row();
    }

    /// Moves a point, and updates the bounds of its row.
    pub(crate) fn set(&mut self, vertex: TreeVertex, point: [S; 3]) {
        self.points[vertex.index()] = padded(point);
        self.bound_row(vertex.index() / IN_A_ROW);
    }

    /// Fits the number of rows to the points, and recomputes the bounds of the last row.
    fn bound_last_row(&mut self) {
        let rows = self.points.len().div_ceil(IN_A_ROW);
        self.bounds.resize(rows, [[S::default(); 4]; 2]);
        if let Some(last) = rows.checked_sub(1) {
            self.bound_row(last);
        }
    }

    /// Recomputes the bounds of a row.
    fn bound_row(&mut self, row: usize) {
        let first = row * IN_A_ROW;
        let end = self.points.len().min(first + IN_A_ROW);
        self.bounds[row] = bounds_of_row(&self.points[first..end]);
    }

    /// Returns a point.
    #[inline]
    pub(crate) fn get(&self, vertex: TreeVertex) -> [S; 3] {
        let [x, y, z, _] = *self.padded(vertex);
        [x, y, z]
    }
}

fn bounds_of_row<S: Real>(row: &[[S; 4]]) -> RowBounds<S> {
    let mut bounds = Bounds::EMPTY;
    row.iter()
        .for_each(|&[x, y, z, _]| bounds.include([x, y, z]));
    [bounds.lo, bounds.hi].map(padded)
}

/// A point with its padding.
#[inline(always)]
pub(crate) fn padded<S: Copy>([x, y, z]: [S; 3]) -> [S; 4] {
    [x, y, z, z]
}

impl<S> Points<S> {
    /// Returns a point with its padding.
    #[inline(always)]
    pub(crate) fn padded(&self, vertex: TreeVertex) -> &[S; 4] {
        &self.points[vertex.index()]
    }
}

held!(Points<S>: points[], bounds[]);
