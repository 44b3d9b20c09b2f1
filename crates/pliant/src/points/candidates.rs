//! Pairs of a point and a triangle that may be its nearest: bounds of their distances, and which is
//! the nearest.

use super::packets::Packet;
use super::reach::Reach;
use crate::geometry::{Aabb, Shape, padded};
use crate::ids::{BlockId, BodyId, TreeTriangle};
use crate::kernels::closest::{FourCorners, bound_eight, bound_eight_closely, certain_parts};
use crate::kernels::{Coordinate, Instructions, dispatch, least_of, priorities};
use crate::traversal::View;
use pliant_exact::Feature;
use pliant_exact::distance::nearest_triangle;

/// The nearest triangle of a point so far.
#[derive(Clone, Debug)]
pub(crate) struct Nearest {
    /// Upper bound of the distance up to which triangles count.
    pub(crate) limit: f64,
    pub(crate) found: Option<Found>,
    /// Triangle that was found the last time, if it was asked.
    pub(crate) hint: Option<Hint>,
}

impl Nearest {
    /// None yet, and only what is within a distance counts.
    pub(crate) fn within(limit: f64) -> Self {
        Self {
            limit,
            found: None,
            hint: None,
        }
    }
}

/// The triangle of a body that was nearest to a point the last time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hint {
    pub(crate) place: TreeTriangle,
    /// How far it was, roughly.
    pub(crate) distance: f64,
}

/// A triangle that may be the nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) body: BodyId,
    pub(crate) place: TreeTriangle,
    /// By the caller's number.
    pub(crate) triangle: u32,
    pub(crate) corners: [[f64; 3]; 3],
    /// Lower bound of its distance.
    pub(crate) least: f64,
}

/// Pairs of one job.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    /// Numbers of points and triangles.
    pairs: Vec<(u32, TreeTriangle)>,
    /// Lower bounds of their distances.
    least: Vec<f64>,
    counts: Vec<u32>,
    /// The only pairs of their points, with lower bounds.
    decided: Vec<((u32, TreeTriangle), f64)>,
    /// Points with several triangles that may be the nearest, and these.
    rivals: Vec<(u32, Found)>,
    /// Parts of these that have the closest point, where that is certain.
    parts: Vec<Option<[[u64; 3]; 2]>>,
}

impl Candidates {
    fn push<S: Coordinate>(&mut self, view: View<S>, point: u32, triangle: TreeTriangle) {
        if !view.read.is_gone(triangle) {
            self.pairs.push((point, triangle));
        }
    }

    /// Lists the points that have a hint, with it.
    pub(super) fn hinted<S: Coordinate>(&mut self, view: View<S>, nearest: &[Nearest]) {
        self.pairs.clear();
        let triangles = view.read.tree.leaves.all_triangles();
        for (point, its) in (0..).zip(nearest) {
            if let Some(hint) = its.hint
                && triangles.contains(&hint.place.index())
            {
                self.push(view, point, hint.place);
            }
        }
    }

    /// Lists points with one triangle of the leaf near each.
    pub(super) fn near<S: Coordinate>(
        &mut self,
        instructions: Instructions,
        view: View<S>,
        reach: &Reach,
        boxes: &[(u32, Aabb)],
    ) {
        self.pairs.clear();
        let leaves = &view.read.tree.leaves;
        let of_blocks = view.boxes.blocks();
        dispatch!(instructions, i => {
            for (leaf, number) in reach.leaves() {
                let (point, its_box) = &boxes[number as usize];
                if view.read.removed.is_some() || !leaves.have_blocks() {
                    let triangles = leaves.triangles(leaf).map(|it| TreeTriangle(it as u32));
                    triangles.for_each(|triangle| self.push(view, *point, triangle));
                    continue;
                }
                let block = BlockId(leaves.blocks(leaf).start);
                let lane = least_of(priorities(i, of_blocks.of(block), its_box));
                self.push(view, *point, leaves.first_triangle(leaf).plus(lane as u32));
            }
        });
    }

    /// Lists the points with triangles whose boxes are within the limit.
    pub(super) fn met<S: Coordinate>(&mut self, view: View<S>, reach: &Reach, packets: &[Packet]) {
        self.pairs.clear();
        for met in &reach.met {
            let first = packets[met.packet as usize].first;
            for (lane, triangle) in met.pairs() {
                self.push(view, first + lane, triangle);
            }
        }
    }

    /// Bounds the distances of all pairs: closely in double precision, else in single.
    pub(super) fn bound<S: Coordinate>(
        &mut self,
        instructions: Instructions,
        (view, points): (View<S>, &[[S; 4]]),
        closely: bool,
        nearest: &mut [Nearest],
    ) {
        self.least.clear();
        let shape = view.read.source.shape();
        dispatch!(instructions, i => {
            for some in self.pairs.chunks(8) {
                let corners = eight_of(shape, points, some);
                let [least, most] = if closely {
                    bound_eight_closely(i, &corners)
                } else {
                    bound_eight(i, &corners).map(|lanes| lanes.map(f64::from))
                };
                for (lane, &(point, _)) in some.iter().enumerate() {
                    let limit = &mut nearest[point as usize].limit;
                    *limit = limit.min(most[lane]);
                    self.least.push(least[lane]);
                }
            }
        });
    }

    /// Drops the pairs that are surely not the nearest of a point.
    pub(super) fn drop_far(&mut self, nearest: &[Nearest]) {
        let mut kept = 0;
        for place in 0..self.pairs.len() {
            let (point, triangle) = self.pairs[place];
            if self.least[place] <= nearest[point as usize].limit {
                self.pairs[kept] = (point, triangle);
                self.least[kept] = self.least[place];
                kept += 1;
            }
        }
        self.pairs.truncate(kept);
        self.least.truncate(kept);
    }

    /// Sets aside the only pairs of points, which need not be compared.
    pub(super) fn set_aside(&mut self, nearest: &[Nearest]) {
        self.counts.clear();
        self.counts.resize(nearest.len(), 0_u32);
        for &(point, _) in &self.pairs {
            self.counts[point as usize] += 1;
        }
        self.decided.clear();
        let mut kept = 0;
        for place in 0..self.pairs.len() {
            let (pair, least) = (self.pairs[place], self.least[place]);
            let point = pair.0 as usize;
            if self.counts[point] == 1 && nearest[point].found.is_none() {
                self.decided.push((pair, least));
            } else {
                self.pairs[kept] = pair;
                kept += 1;
            }
        }
        self.pairs.truncate(kept);
    }

    /// Keeps the nearest triangle of each point.
    pub(super) fn keep_nearest<S: Coordinate>(
        &mut self,
        instructions: Instructions,
        view: View<S>,
        points: &[[S; 4]],
        nearest: &mut [Nearest],
    ) {
        let shape = view.read.source.shape();
        let found = |(point, triangle): (u32, TreeTriangle), least: f64| {
            let found = Found {
                body: view.read.body,
                place: triangle,
                triangle: view.read.order.caller_triangle(triangle).0,
                corners: shape.corners(triangle),
                least,
            };
            (point, found)
        };
        // Most points have one triangle left.
        self.rivals.clear();
        let undecided = self.pairs.iter().copied().zip(self.least.iter().copied());
        for (pair, least) in self.decided.iter().copied().chain(undecided) {
            let (point, new) = found(pair, least);
            let Nearest { limit, found, .. } = &mut nearest[point as usize];
            if let Some(old) = found.filter(|old| old.least <= *limit) {
                self.rivals.push((point, old));
                self.rivals.push((point, new));
            }
            *found = Some(new);
        }
        self.rivals
            .sort_unstable_by_key(|(point, it)| (*point, it.body, it.triangle));
        self.rivals
            .dedup_by_key(|(point, it)| (*point, it.body, it.triangle));
        self.parts.clear();
        dispatch!(instructions, i => {
            for some in self.rivals.chunks(4) {
                let mut four = [[[0.0; 4]; 4]; 4];
                for (four, (point, it)) in four.iter_mut().zip(some) {
                    let [a, b, c] = it.corners.map(padded);
                    *four = [points[*point as usize].map(S::to_f64), a, b, c];
                }
                let parts = certain_parts(i, &four.each_ref().map(<[_; 4]>::each_ref));
                let of_some = some.iter().zip(parts);
                self.parts.extend(of_some.map(|((_, it), on)| Some(part(&it.corners, on?))));
            }
        });
        let mut parts = &self.parts[..];
        for of_point in self.rivals.chunk_by(|a, b| a.0 == b.0) {
            let (its, others) = parts.split_at(of_point.len());
            parts = others;
            let point = of_point[0].0 as usize;
            // Triangles that share the part that is nearest are equally near.
            let is_shared =
                its[0].is_some_and(|it| it != INSIDE) && its.iter().all(|it| *it == its[0]);
            let first = if is_shared {
                0
            } else {
                let corners: Vec<_> = of_point.iter().map(|(_, it)| it.corners).collect();
                let [x, y, z, _] = points[point].map(S::to_f64);
                nearest_triangle(&[x, y, z], &corners)
            };
            nearest[point].found = Some(of_point[first].1);
        }
    }
}

/// Stands for the inside of any triangle, which no other shares.
const INSIDE: [[u64; 3]; 2] = [[u64::MAX; 3]; 2];

/// Corners that span a part of a triangle, the same for every triangle that has it.
fn part(triangle: &[[f64; 3]; 3], on: Feature) -> [[u64; 3]; 2] {
    // As bits, since a thread that flushes subnormal numbers compares no others. Zero has two
    // signs.
    let bits = |k: usize| {
        let bits = |x: f64| if x == 0.0 { 0 } else { x.to_bits() };
        triangle[k].map(bits)
    };
    match on {
        Feature::Corner(k) => [bits(k); 2],
        Feature::Edge(k) => {
            let (a, b) = (bits(k), bits((k + 1) % 3));
            [a.min(b), a.max(b)]
        }
        Feature::Inside => INSIDE,
    }
}

/// Corners of up to eight pairs; the last is repeated.
#[inline(always)]
fn eight_of<'q, S: Coordinate>(
    shape: &Shape<'q, S>,
    points: &'q [[S; 4]],
    pairs: &[(u32, TreeTriangle)],
) -> [FourCorners<'q, S>; 8] {
    let corners = |&(point, triangle): &(u32, TreeTriangle)| {
        let [a, b, c] = shape.triangles[triangle.index()];
        let at = |vertex| shape.positions.padded(vertex);
        [&points[point as usize], at(a), at(b), at(c)]
    };
    let last = corners(&pairs[pairs.len() - 1]);
    let mut eight = [last; 8];
    for (lane, pair) in pairs.iter().enumerate() {
        eight[lane] = corners(pair);
    }
    eight
}
