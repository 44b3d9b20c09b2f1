//! Candidates within a margin: vertices and triangles, and edges and edges, whose boxes are near each other, now or on the way.
//!
//! The box of an element is the hull of its corners, at both ends of the motion if its body has one. Two elements are a candidate if on
//! every axis the gap of their boxes is at most 2 r, in real arithmetic on the numbers given, and they have no vertex in common. So r is
//! a margin round each element, and two are found that are within 2 r of each other (Li et al. 2020, Incremental Potential Contact).
//!
//! The tree has boxes of the same hulls, grown by r, in a set of its own. Every vertex and every edge belongs to one triangle
//! (`mesh::Elements`), in whose leaf it is looked for; as a leaf's box holds what belongs to it, leaves that hold a candidate are found,
//! adjacent ones included. So an element pair comes up once, in the one pair of runs of up to eight triangles that its two belong to.
//! `near` has the boxes of what belongs to a run, `kernels::gaps` compares them eight at a time, and few are left to exact arithmetic.

mod edge_edge;
mod hit;
mod vertex_triangle;

use super::{Found, LeafTest, Needs, OF_MOTIONS, Reach, Shown, Which};
use crate::geometry::{Bounds, Real};
use crate::ids::TreeVertex;
use crate::kernels::Coordinate;
use crate::kernels::gaps::Limits;
pub(crate) use edge_edge::EdgeEdgeCandidates;
pub use hit::{EdgeEdge, VertexTriangle};
use std::marker::PhantomData;
pub(crate) use vertex_triangle::VertexTriangleCandidates;

/// Two elements whose boxes are within a margin of each other; `E` is what the caller gets of them.
#[derive(Debug)]
pub(crate) struct Candidates<E, S> {
    margin: Margin,
    of: PhantomData<(E, S)>,
}

impl<E, S> Candidates<E, S> {
    pub(crate) fn within(margin: Margin) -> Self {
        let of = PhantomData;
        Self { margin, of }
    }
}

/// Keeps those of some pairs of elements that are candidates, and counts them. Bits of two masks say which are possibly near each other
/// and which surely. `meet`, if there are groups, says whether theirs let them; `holds` decides exactly, and is asked only about others.
#[inline(always)]
fn keep(
    [mut near, sure]: [u64; 2],
    pair: impl Fn(u32) -> [u32; 2],
    meet: Option<impl Fn([u32; 2]) -> bool>,
    holds: impl Fn([u32; 2]) -> bool,
    found: &mut Found<[u32; 2], ()>,
) {
    let statistics = &mut found.statistics;
    statistics.candidate_pairs += u64::from(near.count_ones());
    if let Some(meet) = meet {
        near = only(near, near, |bit| meet(pair(bit)));
    }
    let undecided = near & !sure;
    if undecided != 0 {
        statistics.exact_decisions += u64::from(undecided.count_ones());
        near = only(near, undecided, |bit| holds(pair(bit)));
    }
    found.hits.room().push_bits(near, pair);
}

/// A mask without those bits of a part of it of which `keeps` does not say so.
fn only(mut mask: u64, mut part: u64, keeps: impl Fn(u32) -> bool) -> u64 {
    while part != 0 {
        let bit = part.trailing_zeros();
        if !keeps(bit) {
            mask &= !(1 << bit);
        }
        part &= part - 1;
    }
    mask
}

/// How near is near.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    /// The gap of boxes that is small enough; perhaps infinite.
    gap: f64,
    /// By how much boxes of nodes are grown: at least half of that, unless no two boxes are further apart.
    grown_by: f32,
}

impl Margin {
    /// `radius` is finite and at least 0.
    pub(crate) fn new(radius: f64) -> Self {
        let nearest = (radius as f32).min(f32::MAX);
        let grown_by = if f64::from(nearest) < radius {
            nearest.next_up().min(f32::MAX)
        } else {
            nearest
        };
        Self {
            gap: 2.0 * radius,
            grown_by,
        }
    }

    /// By how much boxes of nodes are grown.
    pub(crate) fn grown_by(self) -> f32 {
        self.grown_by
    }

    /// Runs of triangles, whose elements are looked at, along their motions.
    fn needs(self, which: Which) -> Needs {
        Needs {
            box_set: OF_MOTIONS,
            leaves: Shown::Runs(which),
            grows_by: Some(self.grown_by),
            reach: Some(Reach::End),
        }
    }

    fn limits<S: Real>(self, most: f32) -> Limits {
        Limits::new::<S>(self.gap, f64::from(most))
    }

    /// Whether two elements, one of either side, are as near as that: exactly.
    #[cold]
    fn holds<S: Coordinate>(
        self,
        leaves: &LeafTest<S>,
        sides: [usize; 2],
        a: &[TreeVertex],
        b: &[TreeVertex],
    ) -> bool {
        let [a, b] = [(sides[0], a), (sides[1], b)].map(|(side, corners)| {
            let mut bounds = Bounds::EMPTY;
            for &corner in corners {
                let now = leaves.shapes[side].positions;
                bounds.include(now.get(corner).map(Real::to_f64));
                if let Some(end) = leaves.ends[side] {
                    bounds.include(end.get(corner).map(Real::to_f64));
                }
            }
            bounds
        });
        a.are_within(&b, self.gap)
    }
}
