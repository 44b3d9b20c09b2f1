//! Candidate search, the broad phase of contact solvers: pairs of elements whose boxes are near.
//!
//! Elements are a vertex and a triangle, or two edges, now or during a motion. A margin r round
//! each finds pairs within 2 r of each other (Li et al. 2020, Incremental Potential Contact). The
//! tree has a set of boxes that hold positions and ends of motions, grown by r. Every vertex and
//! edge belongs to one triangle (`mesh::Elements`), so a pair comes up in one pair of leaves,
//! adjacent leaves included. `near` has the boxes of the elements of leaves, `kernels::gaps`
//! compares eight at a time, and few are left to exact arithmetic.

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

/// Kind of query: pairs of elements whose boxes are within a margin of each other. `E` is the
/// caller's hit.
///
/// The box of an element is the hull of its corners, at both ends of the motion if its body has
/// one. Two elements are a candidate if two conditions hold, in real arithmetic on the numbers
/// given:
///
/// - on every axis the gap of their boxes is at most 2 r, and
/// - they have no vertex in common.
///
/// As a leaf's box holds the elements that belong to it, leaves that hold a candidate are found. A
/// pair of elements comes up once, in the one pair of runs of up to eight triangles that its two
/// belong to.
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

/// Appends the pairs of two masks that are candidates, and counts them.
///
/// `near` marks pairs that are possibly near each other, `sure` pairs that surely are. `meet`, if
/// there are groups or removed triangles, says whether a pair counts. `holds` decides exactly, and
/// is asked only about the unsure.
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

/// Clears the bits of `mask` that are in `part` and for which `keeps` returns false.
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

/// Margin round elements: the gap of boxes that is near enough.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    /// Largest gap of a candidate's boxes, 2 r. It may be infinite.
    gap: f64,
    /// Distance by which boxes of nodes are grown: at least half of `gap`, or so much that any two
    /// boxes overlap.
    grown_by: f32,
    /// By how much thickness counts.
    counts_thickness: f64,
}

impl Margin {
    /// Margin of `radius` round each element, finite and at least 0.
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
            counts_thickness: 1.0,
        }
    }

    /// The margin, with a factor on thickness, which is 0 if that does not count.
    pub(crate) fn counting_thickness(self, by: f64) -> Self {
        Self {
            counts_thickness: by,
            ..self
        }
    }

    /// Distance by which boxes of nodes are grown.
    pub(crate) fn grown_by(self) -> f32 {
        self.grown_by
    }

    /// Needs of candidates: runs of triangles, whose elements are compared, along their motions.
    fn needs(self, which: Which) -> Needs {
        Needs {
            box_set: OF_MOTIONS,
            leaves: Shown::Runs(which),
            grows_by: Some(self.grown_by),
            counts_thickness: self.counts_thickness,
            reach: Some(Reach::End),
            culls_by_capsules: false,
            leaves_out: false,
        }
    }

    fn limits<S: Real>(self, leaves: &LeafTest<S>, most: f32) -> Limits {
        Limits::new::<S>(leaves.thickness.bounds(self.gap), f64::from(most))
    }

    /// Whether the boxes of two elements, one of either side, are within the margin: exactly.
    #[cold]
    fn holds<S: Coordinate>(
        self,
        leaves: &LeafTest<S>,
        sides: [usize; 2],
        a: &[TreeVertex],
        b: &[TreeVertex],
    ) -> bool {
        let elements = [(sides[0], a), (sides[1], b)];
        let near = leaves.thickness.length(self.gap, elements);
        let [a, b] = elements.map(|(side, corners)| {
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
        a.are_within(&b, near)
    }
}
