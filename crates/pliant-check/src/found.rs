//! Pairs of one frame, kept only as far as they were asked for.
//!
//! A small file can hold very many intersecting pairs: up to the square of its number of triangles.
//! Pairs that are only counted are not kept. A list has a limit.

use crate::places::Place;
use crate::row::Row;
use crate::solid::Inside;
use pliant::ContactKind;
use std::borrow::Cow;
use std::ops::ControlFlow;

/// Pairs of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Number of the frame.
    pub frame: usize,
    /// Bodies whose mesh differs from the frame returned before, ascending.
    ///
    /// For the first frame returned, from the first frame of the source.
    /// [`Check::body`](crate::Check::body) has their new facts.
    pub changed: Vec<u32>,
    /// Number of pairs; at most one if only the first was asked for.
    pub count: usize,
    /// Numbers of pairs of each kind, if all intersecting pairs were asked for.
    pub kinds: Option<Kinds>,
    /// The smallest pair; the only one, if only the first was asked for.
    pub smallest: Option<Row>,
    /// Distance of the nearest pair, at most the distance asked for. `None` without a pair, or if
    /// no distance was asked for.
    pub distance: Option<f64>,
    /// All pairs, sorted; empty if they are not listed.
    pub pairs: Vec<Row>,
    /// Closest points of the pairs in `pairs` that do not intersect, in the same order.
    ///
    /// Empty if [`closest_points`](crate::Settings::closest_points) is not set.
    pub gaps: Vec<Gap>,
    /// Pairs of triangles of one source that share a vertex and meet beyond it. `None` if they were
    /// not asked for.
    pub adjacent: Option<Adjacent>,
    /// Edges that cross triangles, for every two bodies with any, in order of the bodies. `None` if
    /// [`crossing_edges`](crate::Settings::crossing_edges) is not set, or only the first pair was
    /// asked for.
    pub crossing_edges: Option<Vec<CrossingEdges>>,
    /// Components of bodies that lie inside other bodies. `None` if
    /// [`inside`](crate::Settings::inside) is not set, or there is one body.
    pub inside: Option<Inside>,
    /// Number of pairs left out because the baseline has them. `None` without a baseline, or if the
    /// search stopped at the first new pair.
    pub left_out: Option<usize>,
    /// Number of pairs left out because their places only touch. `None` if
    /// [`crossing`](crate::Settings::crossing) is not set.
    pub only_touching: Option<usize>,
    /// Number of pairs with a triangle without area: among these, or left out if such pairs are.
    pub degenerate: usize,
    /// Whether these are all pairs; false if only the first was asked for.
    pub complete: bool,
    /// Places of these pairs, most pairs first; `None` if they, or all pairs, were not asked for.
    pub places: Option<Vec<Place>>,
}

/// Pairs of one source that share a vertex of it, after welding, and meet beyond what they share.
///
/// They are counted apart: [`Found::count`] has none of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Adjacent {
    /// Number of pairs; at most one if only the first was asked for.
    pub count: usize,
    /// Numbers of pairs of each kind.
    pub kinds: Kinds,
    /// Number of triangles that stand twice: a triangle before them has the same three vertices.
    pub twice: usize,
    /// The smallest pair.
    pub smallest: Option<Row>,
    /// All pairs, sorted; empty if they are not listed.
    pub pairs: Vec<Row>,
    /// Number of pairs left out because the baseline has them. `None` as in [`Found`].
    pub left_out: Option<usize>,
    /// Number of pairs left out because they only touch. `None` if
    /// [`crossing`](crate::Settings::crossing) is not set.
    pub only_touching: Option<usize>,
    /// Number of pairs with a triangle without area: among these, or left out if such pairs are.
    pub degenerate: usize,
}

/// Edges of one body that cross triangles of another, or of itself.
///
/// The open edge meets the open triangle, and not in its plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrossingEdges {
    /// Body of the edges. An edge between two bodies of a source is of both.
    pub edge_body: u32,
    /// Body of the triangles.
    pub triangle_body: u32,
    /// Number of edges that cross any triangle.
    pub edges: usize,
    /// Number of pairs of an edge and a triangle that it crosses.
    pub pairs: usize,
}

impl CrossingEdges {
    pub(crate) fn none(edge_body: u32, triangle_body: u32) -> Self {
        Self {
            edge_body,
            triangle_body,
            edges: 0,
            pairs: 0,
        }
    }
}

impl Found {
    /// Number of all pairs, those that share a vertex too.
    pub fn count_of_all(&self) -> usize {
        self.count + self.adjacent.as_ref().map_or(0, |adjacent| adjacent.count)
    }

    /// All pairs that are listed, those that share a vertex too, sorted.
    pub fn all_pairs(&self) -> Cow<'_, [Row]> {
        match &self.adjacent {
            Some(adjacent) if !adjacent.pairs.is_empty() => {
                let mut all = [&self.pairs[..], &adjacent.pairs].concat();
                all.sort_unstable();
                Cow::Owned(all)
            }
            _ => Cow::Borrowed(&self.pairs),
        }
    }
}

/// Numbers of intersecting pairs by [`ContactKind`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kinds {
    /// Pairs that cross: each passes through the other.
    pub crossing: usize,
    /// Pairs in one plane with an area in common.
    pub overlapping: usize,
    /// Pairs that only touch.
    pub touching: usize,
}

impl std::ops::AddAssign for Kinds {
    fn add_assign(&mut self, more: Self) {
        self.crossing += more.crossing;
        self.overlapping += more.overlapping;
        self.touching += more.touching;
    }
}

impl Kinds {
    fn count(&mut self, kind: ContactKind) {
        *match kind {
            ContactKind::Crossing => &mut self.crossing,
            ContactKind::Overlapping => &mut self.overlapping,
            ContactKind::Touching => &mut self.touching,
        } += 1;
    }
}

/// Relation of the two triangles of a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) enum How {
    /// Intersecting, with the kind of contact if that is asked.
    Intersecting(Option<ContactKind>),
    /// Within the distance asked for.
    Close(Closeness),
}

/// Closest points of two triangles that do not intersect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The pair.
    pub pair: Row,
    /// Distance of the triangles; more than 0.
    pub distance: f64,
    /// A closest point of each triangle.
    pub points: [[f64; 3]; 2],
}

/// Distance and closest points of two triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closeness {
    pub(crate) distance: f64,
    pub(crate) points: [[f64; 3]; 2],
}

/// Why a search stopped early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    /// The first pair was found.
    First,
    /// The list holds this many, and reached its limit or found no more memory.
    Full(usize),
    /// More pairs than are counted.
    Endless,
}

/// Most pairs that are counted in a frame.
///
/// A small file can hold more: each of 100,000 copies of a triangle meets every other. Nobody would
/// look at them, and finding them all would take hours.
pub(crate) const MOST_COUNTED: usize = 1 << 31;

/// Collects the pairs of a frame as they are found.
pub(crate) struct Taker<'a> {
    found: Found,
    listed: bool,
    /// Most pairs that are listed.
    most: usize,
    /// Known pairs, sorted, which are left out.
    baseline: Option<&'a [Row]>,
    /// Whether pairs with a triangle without area are left out.
    skip_degenerate: bool,
    /// Whether closest points are listed too.
    lists_gaps: bool,
}

impl<'a> Taker<'a> {
    pub(crate) fn new(
        frame: usize,
        first: bool,
        listed: bool,
        most: usize,
        baseline: Option<&'a [Row]>,
    ) -> Self {
        let found = Found {
            frame,
            changed: Vec::new(),
            count: 0,
            kinds: None,
            smallest: None,
            distance: None,
            pairs: Vec::new(),
            gaps: Vec::new(),
            adjacent: None,
            crossing_edges: None,
            inside: None,
            left_out: baseline.map(|_| 0),
            only_touching: None,
            degenerate: 0,
            complete: !first,
            places: None,
        };
        Self {
            found,
            listed,
            most,
            baseline,
            skip_degenerate: false,
            lists_gaps: false,
        }
    }

    /// Sets whether pairs with a triangle without area are left out.
    pub(crate) fn skip_degenerate(mut self, skip: bool) -> Self {
        self.skip_degenerate = skip;
        self
    }

    /// Sets whether the closest points of listed pairs are listed too.
    pub(crate) fn list_gaps(mut self, list: bool) -> Self {
        self.lists_gaps = list;
        self
    }

    /// Sets whether pairs are counted by kind.
    pub(crate) fn count_kinds(mut self, count: bool) -> Self {
        self.found.kinds = count.then(Kinds::default);
        self
    }

    /// Takes a pair, or leaves it out.
    ///
    /// `degenerate`: whether a triangle of it has no area. `comparable`: whether its bodies have
    /// the meshes of the baseline.
    pub(crate) fn take(
        &mut self,
        row: Row,
        how: How,
        degenerate: bool,
        comparable: bool,
    ) -> ControlFlow<Stop> {
        let found = &mut self.found;
        let closeness = match how {
            How::Close(closeness) => Some(closeness),
            How::Intersecting(_) => None,
        };
        if degenerate && self.skip_degenerate {
            found.degenerate += 1;
            return ControlFlow::Continue(());
        }
        if let (Some(baseline), Some(left_out)) = (self.baseline, &mut found.left_out)
            && comparable
            && baseline.binary_search(&row).is_ok()
        {
            *left_out += 1;
            return ControlFlow::Continue(());
        }
        if let Some(Closeness { distance, .. }) = closeness {
            if !found.complete {
                // The nearest pair is known only after all were seen.
                let nearest = found.distance.zip(found.smallest);
                if nearest.is_some_and(|nearest| nearest <= (distance, row)) {
                    return ControlFlow::Continue(());
                }
                found.count = 0;
                found.smallest = None;
                found.pairs.clear();
                found.gaps.clear();
                if !self.skip_degenerate {
                    found.degenerate = 0;
                }
            }
            found.distance = Some(found.distance.map_or(distance, |least| least.min(distance)));
        }
        if found.count >= MOST_COUNTED {
            return ControlFlow::Break(Stop::Endless);
        }
        found.count += 1;
        found.degenerate += usize::from(degenerate);
        if let (Some(kinds), How::Intersecting(Some(kind))) = (&mut found.kinds, how) {
            kinds.count(kind);
        }
        found.smallest = Some(found.smallest.map_or(row, |smallest| smallest.min(row)));
        if self.listed {
            if found.pairs.len() >= self.most || found.pairs.try_reserve(1).is_err() {
                return ControlFlow::Break(Stop::Full(found.pairs.len()));
            }
            found.pairs.push(row);
            if let Some(Closeness { distance, points }) = closeness
                && self.lists_gaps
                && distance > 0.0
            {
                if found.gaps.try_reserve(1).is_err() {
                    return ControlFlow::Break(Stop::Full(found.pairs.len()));
                }
                found.gaps.push(Gap {
                    pair: row,
                    distance,
                    points,
                });
            }
        }
        if found.complete || closeness.is_some() {
            return ControlFlow::Continue(());
        }
        // The search stops here, so the number of left-out pairs is unknown.
        found.left_out = None;
        ControlFlow::Break(Stop::First)
    }

    /// Ends the search for pairs that share a vertex, of which `twice` triangles stand twice.
    pub(crate) fn end_adjacent(self, twice: usize) -> Adjacent {
        let found = self.end();
        Adjacent {
            count: found.count,
            kinds: found.kinds.unwrap_or_default(),
            twice,
            smallest: found.smallest,
            pairs: found.pairs,
            left_out: found.left_out,
            only_touching: found.only_touching,
            degenerate: found.degenerate,
        }
    }

    /// Notes the number of pairs that are not shown, since their places only touch.
    pub(crate) fn leave_touching(&mut self, count: usize) {
        self.found.only_touching = Some(count);
    }

    /// Whether pairs are counted by kind.
    pub(crate) fn counts_kinds(&self) -> bool {
        self.found.kinds.is_some()
    }

    /// Most pairs that may be kept.
    pub(crate) fn most(&self) -> usize {
        self.most
    }

    /// Number of pairs taken.
    pub(crate) fn count(&self) -> usize {
        self.found.count
    }

    /// Number of the frame.
    pub(crate) fn frame(&self) -> usize {
        self.found.frame
    }

    pub(crate) fn end(self) -> Found {
        let mut found = self.found;
        found.pairs.sort_unstable();
        found.gaps.sort_unstable_by_key(|gap| gap.pair);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_pairs_are_counted_than_anybody_waits_for() {
        let mut taker = Taker::new(0, false, false, usize::MAX, None);
        taker.found.count = MOST_COUNTED - 1;
        assert_eq!(
            taker.take([0, 1, 0, 2], How::Intersecting(None), false, true),
            ControlFlow::Continue(())
        );
        let stopped = taker.take([0, 1, 0, 3], How::Intersecting(None), false, true);
        assert_eq!(stopped, ControlFlow::Break(Stop::Endless));
        assert_eq!(taker.end().count, MOST_COUNTED);
    }
}
