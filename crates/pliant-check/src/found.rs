//! What intersects in one frame: all that was asked for is kept, and no more.
//!
//! A small file can hold a great many intersecting pairs: their number is up to the square of the number of triangles. Where only
//! their number is asked for, none is kept; where they are listed, the list has a limit.

use crate::places::Place;
use crate::row::Row;
use pliant::ContactKind;
use std::ops::ControlFlow;

/// The pairs of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The frame.
    pub frame: usize,
    /// The bodies that have another mesh than in the frame found before, or, of the first, than at the beginning; ascending. What is
    /// known of them now says [`Check::body`](crate::Check::body).
    pub changed: Vec<u32>,
    /// How many pairs; at most one if only the first was asked for.
    pub count: usize,
    /// How many of each kind, where all pairs that intersect were asked for.
    pub kinds: Option<Kinds>,
    /// The smallest of them; where only one pair was asked for, that pair.
    pub smallest: Option<Row>,
    /// How far apart the nearest of them is, at most as far as was asked for. `None` where there is no pair, or no distance was
    /// asked for.
    pub distance: Option<f64>,
    /// All of them, sorted; none where they are not listed.
    pub pairs: Vec<Row>,
    /// Where those of `pairs` that do not intersect are closest, in the same order; none if
    /// [`closest_points`](crate::Settings::closest_points) were not asked for.
    pub gaps: Vec<Gap>,
    /// How many were left out because they intersect in the baseline frame. `None` where there is no such frame, and where the
    /// search stopped at the first new pair.
    pub left_out: Option<usize>,
    /// How many were left out because their places only touch; `None` if that was not asked for:
    /// [`crossing`](crate::Settings::crossing).
    pub only_touching: Option<usize>,
    /// How many pairs have a triangle without area: of these, or, where such are left out, how many were for that.
    pub degenerate: usize,
    /// Whether these are all; not if only the first was asked for.
    pub complete: bool,
    /// The places of these pairs, most pairs first, if they were asked for and all pairs were.
    pub places: Option<Vec<Place>>,
}

/// How many pairs intersect how: [`ContactKind`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kinds {
    /// They go through each other.
    pub crossing: usize,
    /// They lie in one plane and have an area in common.
    pub overlapping: usize,
    /// They touch, and no more.
    pub touching: usize,
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

/// What is known of two triangles besides that they are a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) enum How {
    /// They intersect; in which way, if that is asked.
    Intersecting(Option<ContactKind>),
    /// They are so close.
    Close(Closeness),
}

/// Between two triangles that are close to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Which they are.
    pub pair: Row,
    /// How far apart they are; more than 0.
    pub distance: f64,
    /// A point of the one and a point of the other that are as close as that.
    pub points: [[f64; 3]; 2],
}

/// How close two triangles are, where that is asked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closeness {
    pub(crate) distance: f64,
    pub(crate) points: [[f64; 3]; 2],
}

/// Why a search stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    /// The first pair was found.
    First,
    /// The list would be longer than it may be.
    Full,
    /// There are more than are counted.
    Endless,
}

/// So many pairs are counted. A small file can hold more (each of 100,000 copies of a triangle meets every other), but none that
/// anybody would look at, and to find them all would take hours.
pub(crate) const MOST_COUNTED: usize = 1 << 31;

/// Takes pairs as they are found.
pub(crate) struct Taker<'a> {
    found: Found,
    listed: bool,
    /// The most that are listed.
    most: usize,
    /// Sorted; pairs that are left out.
    baseline: Option<&'a [Row]>,
    /// Whether pairs with a triangle without area are left out.
    skip_degenerate: bool,
    /// Whether it is listed, too, where pairs are closest.
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

    /// From now on leaves out pairs with a triangle without area, if `skip`.
    pub(crate) fn skip_degenerate(mut self, skip: bool) -> Self {
        self.skip_degenerate = skip;
        self
    }

    /// From now on lists where pairs are closest, if `list` and they are listed.
    pub(crate) fn list_gaps(mut self, list: bool) -> Self {
        self.lists_gaps = list;
        self
    }

    /// From now on counts pairs by their kinds, if `count`.
    pub(crate) fn count_kinds(mut self, count: bool) -> Self {
        self.found.kinds = count.then(Kinds::default);
        self
    }

    /// Takes a pair, or leaves it out. `degenerate`: whether a triangle of it has no area. `comparable`: whether its bodies have the meshes
    /// that the baseline is about.
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
                // Of one pair that is asked for, the nearest: it is known when all were seen.
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
                return ControlFlow::Break(Stop::Full);
            }
            found.pairs.push(row);
            if let Some(Closeness { distance, points }) = closeness
                && self.lists_gaps
                && distance > 0.0
            {
                if found.gaps.try_reserve(1).is_err() {
                    return ControlFlow::Break(Stop::Full);
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
        // What else is left out is not known.
        found.left_out = None;
        ControlFlow::Break(Stop::First)
    }

    /// Says how many pairs it is not shown, for their places only touch.
    pub(crate) fn leave_touching(&mut self, count: usize) {
        self.found.only_touching = Some(count);
    }

    /// Whether pairs are counted by their kinds.
    pub(crate) fn counts_kinds(&self) -> bool {
        self.found.kinds.is_some()
    }

    /// The most pairs that may be kept.
    pub(crate) fn most(&self) -> usize {
        self.most
    }

    /// How many pairs it has taken.
    pub(crate) fn count(&self) -> usize {
        self.found.count
    }

    /// The frame whose pairs it takes.
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
