//! Impacts: continuous collision of elements that meet during a motion, and when first.
//!
//! Candidates are decided as soon as a batch of them is found, and never listed. Separating
//! directions (`kernels::apart`) reject eight at a time in single precision, which leaves few. Each
//! of these is decided in double precision where rounding cannot matter, else in integers
//! (`pliant_exact::motion`). The time of a pair is a cell of a grid of times. That cell is a
//! function of the exact time alone, so every way to it gives the same bits.

mod earliest;
mod hit;

use super::close::{ElementCandidates, ElementPair, corners_at, length, primitives};
use super::{
    Batch, CallerIds, EdgeEdge, Found, FoundBy, Kind, LeafTest, Needs, Reach, VertexTriangle,
    shows_hits,
};
use crate::geometry::Real;
use crate::kernels::apart::{MovingCorners, apart};
use crate::kernels::{Buffer, Simd, dispatch};
use crate::statistics::Statistics;
pub(crate) use earliest::{Earliest, First};
pub use hit::{EdgeEdgeImpact, Impact, VertexTriangleImpact};
use pliant_exact::Length;
use pliant_exact::distance::are_within_distance;
use pliant_exact::motion::{Decided, Grid, Moving, distant_until, impact, starts_surely_within};

/// Kind of query: candidates of the kind `K` that meet during a motion.
#[derive(Debug)]
pub(crate) struct Impacts<K> {
    candidates: K,
    grid: Grid,
    reach: Reach,
    /// Distance that counts as contact; 0 for contact itself.
    distance: f64,
    /// Whether only the earliest is searched. It is kept in `earliest`, and no hits are found.
    is_first: bool,
    /// Whether any contact will do as well as the earliest.
    is_any: bool,
    earliest: Earliest,
}

/// Two elements that meet, in tree order, and the cell of the grid in which they first do.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TimedHit {
    pub(crate) pair: [u32; 2],
    pub(crate) cell: [f64; 2],
}

/// Pair of elements that may meet.
pub(crate) trait MayMeet: ElementPair {
    type Impact: Copy + std::fmt::Debug + Send + Sync + Into<Impact>;

    /// The impact of this pair in a cell of the grid.
    fn impact(self, cell: [f64; 2]) -> Self::Impact;
}

macro_rules! may_meet {
    ($pair:ty => $impact:ident) => {
        impl MayMeet for $pair {
            type Impact = $impact;

            #[inline]
            fn impact(self, [low, high]: [f64; 2]) -> $impact {
                let pair = self;
                $impact { pair, low, high }
            }
        }
    };
}

may_meet!(VertexTriangle => VertexTriangleImpact);
may_meet!(EdgeEdge => EdgeEdgeImpact);

impl<K> Impacts<K> {
    /// Impacts of candidates, whose margin is zero.
    pub(crate) fn of(candidates: K, grid: Grid, reach: Reach) -> Self {
        Self {
            distance: 0.0,
            candidates,
            grid,
            reach,
            is_first: false,
            is_any: false,
            earliest: Earliest::new(false, 1.0),
        }
    }

    /// Searches for coming as near as a distance instead of contact. [`approach`] finds it.
    ///
    /// Candidates have half of [`LIMIT`] times the distance for a margin, and count thickness as
    /// much. Elements that are as near at the start are tested for contact after it.
    pub(crate) fn or_near(self, distance: f64) -> Self {
        Self { distance, ..self }
    }

    /// Searches for nothing but what may be earlier than `earliest`, which is updated.
    pub(crate) fn earlier_than(self, earliest: Earliest) -> Self {
        Self {
            is_first: true,
            earliest,
            ..self
        }
    }

    /// Searches for any contact after the start of the motion, or at any time with a distance.
    pub(crate) fn any(self) -> Self {
        let earliest = Earliest::new(true, 1.0);
        Self {
            is_any: true,
            ..self.earlier_than(earliest)
        }
    }

    pub(crate) fn into_earliest(self) -> Earliest {
        self.earliest
    }
}

impl<K: ElementCandidates<Hit: MayMeet>> Kind for Impacts<K> {
    type Scalar = K::Scalar;
    type Hit = <K::Hit as MayMeet>::Impact;
    type TreeHit = TimedHit;
    /// Candidates of the batch.
    type Buffers = FoundBy<K>;

    shows_hits!();

    fn needs(&self) -> Needs {
        Needs {
            reach: Some(self.reach),
            culls_by_capsules: true,
            ..self.candidates.needs()
        }
    }

    fn test(&self, leaves: &LeafTest<K::Scalar>, batch: Batch, found: &mut FoundBy<Self>) {
        if self.is_any && self.earliest.known() <= 1.0 {
            return;
        }
        let Found {
            hits,
            statistics,
            buffers: candidates,
        } = found;
        candidates.hits.clear();
        candidates.statistics = Statistics::default();
        self.candidates.test(leaves, batch, candidates);
        // Pairs and exact decisions are counted of impacts, not of candidates.
        statistics.candidate_pairs += candidates.statistics.candidate_pairs;
        if let Some(known) = self.earliest.known_at_start() {
            let to_caller = |&pair: &[u32; 2]| self.candidates.to_caller(&leaves.ids, pair);
            let impact = |pair: &[u32; 2]| to_caller(pair).impact([0.0; 2]).into();
            candidates
                .hits
                .retain(|pair| Impact::order(&impact(pair)) < known.order());
        }
        let until = self.earliest.until();
        let used = candidates.hits.len();
        let eights = candidates.hits.eights();
        dispatch!(leaves.instructions, i => {
            for (place, eight) in eights.iter().enumerate() {
                let count = (used - 8 * place).min(8);
                let decided = self.decide(i, leaves, &eight[..count], until, hits, statistics);
                if decided.is_none() {
                    return;
                }
            }
        });
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, hit: TimedHit) -> Self::Hit {
        self.candidates.to_caller(ids, hit.pair).impact(hit.cell)
    }
}

impl<K: ElementCandidates<Hit: MayMeet>> Impacts<K> {
    /// Decides up to eight candidates, at least one. None if interrupted.
    #[inline(always)]
    fn decide<I: Simd>(
        &self,
        i: I,
        leaves: &LeafTest<K::Scalar>,
        candidates: &[[u32; 2]],
        until: f64,
        hits: &mut Buffer<TimedHit>,
        statistics: &mut Statistics,
    ) -> Option<()> {
        let first = moving_corners::<K>(leaves, candidates[0])?;
        let mut corners = [[first[0]; 8]; 8];
        for lane in 0..8 {
            let of_lane = match candidates.get(lane) {
                Some(&candidate) if lane > 0 => moving_corners::<K>(leaves, candidate)?,
                _ => first,
            };
            for corner in 0..8 {
                corners[corner][lane] = of_lane[corner];
            }
        }
        let until_at_least = (until as f32).next_up().min(1.0);
        let [_, limit] = leaves.thickness.bounds(self.distance * LIMIT);
        let limit = if limit == 0.0 {
            0.0
        } else {
            (limit as f32).next_up()
        };
        let is_thick = leaves.thickness.are_any();
        let are_edges = <K::Hit as ElementPair>::ARE_EDGES;
        let are_apart = apart(i, are_edges, &corners, until_at_least, limit);
        let mut rest = !are_apart & (0xff >> (8 - candidates.len()));
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize % 8;
            rest &= rest - 1;
            if leaves.interrupt.is_set() {
                return None;
            }
            let moving = moving::<K>(&corners, lane);
            let pair = candidates[lane];
            let distance: Length = if is_thick {
                let once = leaves.thickness.counted_once();
                length(once, self.distance, are_edges, K::vertices(leaves, pair)?)
            } else {
                self.distance.into()
            };
            let (cell, decided) = if distance.bounds()[1] > 0.0 {
                approach(&moving, distance, until)
            } else if self.is_first {
                let hit = self.candidates.to_caller(&leaves.ids, pair);
                let (is_taken, decided) = self.earliest.offer(&moving, hit.impact([0.0; 2]).into());
                statistics.pairs += u64::from(is_taken);
                (None, decided)
            } else {
                impact(&moving, self.grid)
            };
            statistics.scalar_decisions += 1;
            statistics.exact_decisions += u64::from(decided == Decided::InIntegers);
            let Some(cell) = cell else { continue };
            statistics.pairs += 1;
            if self.is_first {
                self.earliest.take_time(cell[0]);
            } else {
                hits.push(TimedHit { pair, cell });
            }
        }
        Some(())
    }
}

/// Factor on the distance: pairs that lanes find further apart than this are further than
/// [`distant_until`] counts as near.
pub(crate) const LIMIT: f64 = 1.002;

/// Time up to which two elements stay further apart than `distance`, twice. None if that is all the
/// time.
///
/// For elements that are near at the start, it is a time up to which they do not meet, if they meet
/// later. Times after `of_interest` may be left out.
#[cold]
fn approach(moving: &Moving, distance: Length, of_interest: f64) -> (Option<[f64; 2]>, Decided) {
    let [least, most] = distance.bounds();
    let until = distant_until(moving, most, of_interest);
    let [start, _] = moving.corners;
    let start = primitives(moving.are_edges, start);
    let is_near = || starts_surely_within(moving, least) || are_within_distance(&start, distance);
    if until > 0.0 || !is_near() {
        return (
            (until < 1.0).then_some([until; 2]),
            Decided::InFloatingPoint,
        );
    }
    let (cell, decided) = impact(moving, Grid::new(0.0));
    let later = cell.filter(|[_, high]| *high > 0.0);
    (later.map(|[low, _]| [low; 2]), decided)
}

/// Corners of a candidate at the start of the motion and at its end.
#[inline(always)]
fn moving_corners<'q, K: ElementCandidates>(
    leaves: &LeafTest<'q, K::Scalar>,
    candidate: [u32; 2],
) -> Option<[&'q [K::Scalar; 4]; 8]> {
    let start = leaves.shapes.map(|shape| shape.positions);
    let end = [
        leaves.motions[0].unwrap_or(start[0]),
        leaves.motions[1].unwrap_or(start[1]),
    ];
    let vertices = K::vertices(leaves, candidate)?;
    let [a, b, c, d] = corners_at(vertices, start);
    let [e, f, g, h] = corners_at(vertices, end);
    Some([a, b, c, d, e, f, g, h])
}

/// One pair of eight, for exact arithmetic.
fn moving<K: ElementCandidates<Hit: MayMeet>>(
    corners: &MovingCorners<K::Scalar>,
    lane: usize,
) -> Moving {
    let mut of_pair = [[[0.0; 3]; 4]; 2];
    for corner in 0..8 {
        let [x, y, z, _] = *corners[corner][lane];
        of_pair[corner / 4][corner % 4] = [x, y, z].map(Real::to_f64);
    }
    Moving {
        are_edges: <K::Hit as ElementPair>::ARE_EDGES,
        corners: of_pair,
    }
}
