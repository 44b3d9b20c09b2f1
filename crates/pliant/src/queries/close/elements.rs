//! Close pairs of elements: vertices and triangles, or edges, that are at most a distance apart.

use super::closest::{exactly, half};
use super::measured::{ElementPair, Measurable, measure_all};
use crate::geometry::{Points, Real};
use crate::ids::TreeVertex;
use crate::kernels::closest::{FourCorners, decide_eight, of_elements, rounded_outward};
use crate::kernels::{Coordinate, Instructions, Simd, dispatch};
use crate::queries::{
    Batch, CallerIds, EdgeEdgeCandidates, FoundBy, Kind, LabelPairs, LeafTest, Margin,
    NearElements, Needs, Thicknesses, VertexTriangleCandidates,
};
use pliant_exact::Length;
use pliant_exact::distance::are_within_distance;

/// Kind of query: candidates of the kind `K` that are at most `distance` apart.
#[derive(Debug)]
pub(crate) struct Close<K> {
    candidates: K,
    distance: f64,
    leaves_out: bool,
}

impl<K> Close<K> {
    /// Close pairs within a distance, finite and at least 0. `candidates` makes the kind of
    /// candidates for a margin. With `leaves_out`, a body's labels and rest shape leave pairs out.
    pub(crate) fn within(
        distance: f64,
        leaves_out: bool,
        candidates: impl Fn(Margin) -> K,
    ) -> Self {
        Self {
            candidates: candidates(Margin::new(half(distance))),
            distance,
            leaves_out,
        }
    }
}

/// Kind of candidates of two elements, which have four corners together.
pub(crate) trait ElementCandidates:
    Kind<TreeHit = [u32; 2], Buffers = (), Hit: ElementPair>
{
    /// The four corners of a candidate, each with its side: vertex, triangle; or both ends of
    /// either edge.
    fn vertices(leaves: &LeafTest<Self::Scalar>, hit: [u32; 2])
    -> Option<[(usize, TreeVertex); 4]>;

    /// Whether labels leave out a candidate.
    fn are_left_out(leaves: &LeafTest<Self::Scalar>, labels: &LabelPairs, hit: [u32; 2]) -> bool;

    /// Positions of the four corners of a candidate in the present shapes.
    #[inline(always)]
    fn corners<'q>(
        leaves: &LeafTest<'q, Self::Scalar>,
        hit: [u32; 2],
    ) -> Option<FourCorners<'q, Self::Scalar>> {
        let positions = leaves.shapes.map(|shape| shape.positions);
        Some(corners_at(Self::vertices(leaves, hit)?, positions))
    }

    /// Positions of the four corners in the caller's order.
    #[inline(always)]
    fn callers_corners<'q>(
        leaves: &LeafTest<'q, Self::Scalar>,
        hit: [u32; 2],
    ) -> Option<FourCorners<'q, Self::Scalar>> {
        Self::corners(leaves, hit)
    }
}

/// The distance at which two elements are near, by their corners, from that of elements without
/// thickness.
#[inline]
pub(in crate::queries) fn length(
    thickness: Thicknesses,
    distance: f64,
    are_edges: bool,
    corners: [(usize, TreeVertex); 4],
) -> Length {
    let [(first, _), .., (second, _)] = corners;
    let vertices = corners.map(|(_, vertex)| vertex);
    let (a, b) = vertices.split_at(if are_edges { 2 } else { 1 });
    thickness.length(distance, [(first, a), (second, b)])
}

/// Positions of four corners, each with its side, by the positions of both bodies.
#[inline(always)]
pub(in crate::queries) fn corners_at<S>(
    [a, b, c, d]: [(usize, TreeVertex); 4],
    positions: [&Points<S>; 2],
) -> FourCorners<'_, S> {
    let at = |(side, vertex): (usize, TreeVertex)| positions[side].padded(vertex);
    [at(a), at(b), at(c), at(d)]
}

/// Whether a pair that single precision left undecided is at most this far apart. Counts exact
/// decisions.
#[cold]
fn is_close<S: Real>(
    instructions: Instructions,
    are_edges: bool,
    pair: &FourCorners<S>,
    distance: Length,
    exact_decisions: &mut u64,
) -> bool {
    let found = dispatch!(instructions, i => of_elements(i, are_edges, &[*pair; 4]));
    let [least, most] = distance.bounds();
    if (found.most[0] <= least) | (found.least[0] > most) {
        return found.most[0] <= least;
    }
    *exact_decisions += 1;
    are_within_distance(&exactly(are_edges, pair), distance)
}

impl<K: ElementCandidates> Kind for Close<K>
where
    K::Hit: for<'c> Measurable<Corners<'c, K::Scalar> = FourCorners<'c, K::Scalar>>,
{
    type Scalar = K::Scalar;
    type Hit = K::Hit;
    type Shown = <K::Hit as Measurable>::Close;
    type TreeHit = [u32; 2];
    type Buffers = ();

    fn needs(&self) -> Needs {
        Needs {
            culls_by_capsules: true,
            leaves_out: self.leaves_out,
            ..self.candidates.needs()
        }
    }

    fn test(&self, leaves: &LeafTest<K::Scalar>, batch: Batch, found: &mut FoundBy<Self>) {
        let before = found.hits.len();
        let pairs_before = found.statistics.pairs;
        self.candidates.test(leaves, batch, found);
        if let Some(labels) = leaves.labels {
            let stays = |&hit: &[u32; 2]| !K::are_left_out(leaves, labels, hit);
            found.hits.retain_from(before, stays);
        }
        let exact = &mut found.statistics.exact_decisions;
        let new = found.hits.tail_mut(before);
        let positions = leaves.shapes.map(|shape| shape.positions);
        let mut keep = |new: &mut [[u32; 2]], positions: [&Points<K::Scalar>; 2], close| {
            let shape = (positions, close);
            dispatch!(leaves.instructions, i => self.keep(i, leaves, shape, new, exact))
        };
        let mut kept = keep(new, positions, true);
        if let Some(rest) = leaves.rest {
            kept = keep(&mut new[..kept], [rest; 2], false);
        }
        found.hits.truncate(before + kept);
        found.statistics.pairs = pairs_before + kept as u64;
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, hit: [u32; 2]) -> K::Hit {
        self.candidates.to_caller(ids, hit)
    }

    fn show(&self, leaves: &LeafTest<K::Scalar>, hits: &[[u32; 2]], shown: &mut Vec<Self::Shown>) {
        let pair = |hit| self.to_caller(&leaves.ids, hit);
        let what = (pair, |hit| K::callers_corners(leaves, hit));
        let (how, interrupt) = (leaves.instructions, leaves.interrupt);
        let take = |close| shown.push(close);
        dispatch!(how, i => measure_all::<_, K::Scalar, _, _>(i, hits, interrupt, what, take));
    }
}

impl<K: ElementCandidates> Close<K> {
    /// Moves the candidates that are close at some positions to the front, in order; or the ones
    /// that are not. Returns how many they are.
    #[inline(always)]
    fn keep<I: Simd>(
        &self,
        i: I,
        leaves: &LeafTest<K::Scalar>,
        (positions, keeps_close): ([&Points<K::Scalar>; 2], bool),
        candidates: &mut [[u32; 2]],
        exact: &mut u64,
    ) -> usize {
        let are_edges = <K::Hit as ElementPair>::ARE_EDGES;
        let is_thick = leaves.thickness.are_any();
        let corners = |hit| Some(corners_at(K::vertices(leaves, hit)?, positions));
        // The distance at which a pair is close.
        let distance = |hit| match K::vertices(leaves, hit) {
            Some(vertices) if is_thick => {
                length(leaves.thickness, self.distance, are_edges, vertices)
            }
            _ => self.distance.into(),
        };
        let [below, above] = rounded_outward([self.distance; 2]);
        let mut limits = [[below; 8], [above; 8]];
        let mut kept = 0;
        for start in (0..candidates.len()).step_by(8) {
            let count = (candidates.len() - start).min(8);
            let mut some = [candidates[start]; 8];
            some[..count].copy_from_slice(&candidates[start..start + count]);
            let Some(first) = corners(some[0]) else {
                return kept;
            };
            let mut pairs = [first; 8];
            for lane in 1..8 {
                pairs[lane] = corners(some[lane]).unwrap_or(first);
            }
            if is_thick {
                for (lane, &hit) in some.iter().enumerate() {
                    let [below, above] = rounded_outward(distance(hit).bounds());
                    (limits[0][lane], limits[1][lane]) = (below, above);
                }
            }
            let [mut close, far] = decide_eight(i, are_edges, &pairs, &limits);
            // Undecided pairs, of which there are hardly ever any.
            let mut rest = !(close | far) & ((1 << count) - 1);
            while rest != 0 {
                if leaves.interrupt.is_set() {
                    return kept;
                }
                let lane = rest.trailing_zeros();
                let (how, pair) = (leaves.instructions, &pairs[lane as usize]);
                let distance = distance(some[lane as usize]);
                close |= u64::from(is_close(how, are_edges, pair, distance, exact)) << lane;
                rest &= rest - 1;
            }
            for (lane, &candidate) in some[..count].iter().enumerate() {
                candidates[kept] = candidate;
                kept += usize::from((close >> lane & 1 != 0) == keeps_close);
            }
        }
        kept
    }
}

impl<S: Coordinate> ElementCandidates for VertexTriangleCandidates<S> {
    #[inline(always)]
    fn vertices(leaves: &LeafTest<S>, hit: [u32; 2]) -> Option<[(usize, TreeVertex); 4]> {
        let (side, vertex, triangle) = Self::sides_of(hit);
        let other = 1 - side;
        let [a, b, c] = leaves.shapes[other].triangles[triangle.index()];
        Some([(side, vertex), (other, a), (other, b), (other, c)])
    }

    fn are_left_out(leaves: &LeafTest<S>, labels: &LabelPairs, hit: [u32; 2]) -> bool {
        let (_, vertex, triangle) = Self::sides_of(hit);
        labels.leave_out_vertex(leaves.ids.orders[0], vertex, triangle)
    }
}

impl<S: Coordinate> ElementCandidates for EdgeEdgeCandidates<S> {
    #[inline(always)]
    fn vertices(leaves: &LeafTest<S>, hit: [u32; 2]) -> Option<[(usize, TreeVertex); 4]> {
        let [[a0, a1], [b0, b1]] = Self::ends(leaves, hit)?;
        Some([(0, a0), (0, a1), (1, b0), (1, b1)])
    }

    fn are_left_out(leaves: &LeafTest<S>, labels: &LabelPairs, [a, b]: [u32; 2]) -> bool {
        let [Some(of_a), Some(of_b)] = leaves.elements else {
            return false;
        };
        let ends = |of: NearElements, edge: u32| {
            let number = of.edges.caller_edges()[edge as usize];
            of.edges.callers()[number as usize]
        };
        labels.leave_out_edges([ends(of_a, a), ends(of_b, b)])
    }

    fn callers_corners<'q>(leaves: &LeafTest<'q, S>, hit: [u32; 2]) -> Option<FourCorners<'q, S>> {
        let mut ends = Self::ends(leaves, hit)?;
        for (ends, order) in ends.iter_mut().zip(leaves.ids.orders) {
            ends.sort_unstable_by_key(|&end| order.caller_vertex(end).0);
        }
        let [of_a, of_b] = leaves.shapes.map(|shape| shape.positions);
        let [a0, a1] = ends[0].map(|end| of_a.padded(end));
        let [b0, b1] = ends[1].map(|end| of_b.padded(end));
        Some(if Self::is_swapped(&leaves.ids, hit) {
            [b0, b1, a0, a1]
        } else {
            [a0, a1, b0, b1]
        })
    }
}

impl<S: Coordinate> EdgeEdgeCandidates<S> {
    /// Ends of both edges.
    #[inline(always)]
    fn ends(leaves: &LeafTest<S>, [a, b]: [u32; 2]) -> Option<[[TreeVertex; 2]; 2]> {
        let [of_a, of_b] = leaves.elements;
        let [of_a, of_b] = [of_a?.edges.ends(), of_b?.edges.ends()];
        Some([of_a[a as usize], of_b[b as usize]])
    }
}
