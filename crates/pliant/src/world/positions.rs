//! The positions of one body: as the caller orders vertices, in tree order, or both.
//!
//! Two ways lead to a new shape, and either leaves the old one as it is if something is wrong with the new. A body that nobody looked
//! at since its last shape is *copied* while it is checked, which is one pass as fast as memory. A body that was looked at will be
//! looked at again: it is only checked, and then *taken straight into tree order*, without a copy between. But where there are
//! several threads a small one is copied as well: shapes come one after the other, and threads bring them into order side by side.

use crate::exec::Threads;
use crate::geometry::{Bounds, POINTS_JOB, POINTS_SHARED, Points, Scalar};
use crate::kernels::Level;
use crate::kernels::take_over::{check, take_over};
use std::borrow::Cow;

pub(super) struct Positions<S> {
    len: usize,
    /// Nothing in a body that was looked at in every shape so far.
    callers: Vec<[S; 3]>,
    /// Where the next shape is written, so that a bad one never replaces a good one; nothing until one is copied.
    spare: Vec<[S; 3]>,
    trees: Points<S>,
    /// Which of the two hold the shape of now; one at least.
    is_callers: bool,
    is_trees: bool,
    /// Whether a query looked at this shape in tree order.
    looked_at: bool,
}

impl<S: Scalar> Positions<S> {
    /// Of a new body, as the caller orders them.
    pub(super) fn new(positions: &[[S; 3]]) -> Self {
        Self {
            len: positions.len(),
            callers: positions.to_vec(),
            spare: Vec::new(),
            trees: Points::with_len(positions.len()),
            is_callers: true,
            is_trees: false,
            looked_at: false,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// The bounds of a new shape, as long as the old; none if a coordinate is out of range. Nothing else has changed then, nor before
    /// it is [accepted](Self::accept).
    pub(super) fn look_at(
        &mut self,
        level: Level,
        threads: &Threads,
        new: &[[S; 3]],
    ) -> Option<Bounds<S>> {
        let place = if self.goes_straight(threads) {
            None
        } else {
            self.spare.resize(new.len(), [S::default(); 3]);
            Some(&mut self.spare[..])
        };
        let look = |new: &[[S; 3]], place: Option<&mut [[S; 3]]>| match place {
            Some(place) => take_over(level, new, place),
            None => check(level, new),
        };
        if new.len() <= POINTS_SHARED || !threads.are_many() {
            return look(new, place);
        }
        let mut places = place.map(|place| place.chunks_mut(POINTS_JOB));
        let parts = new.chunks(POINTS_JOB);
        let mut jobs: Vec<_> = parts
            .map(|new| (new, places.as_mut().and_then(Iterator::next), None))
            .collect();
        threads.run(&mut jobs, |_, (new, place, bounds)| {
            *bounds = look(new, place.as_deref_mut());
        });
        let mut parts = jobs.iter().map(|&(_, _, bounds)| bounds);
        parts.try_fold(Bounds::EMPTY, |all, part| Some(all.union(&part?)))
    }

    /// Whether the next shape is taken straight into tree order.
    fn goes_straight(&self, threads: &Threads) -> bool {
        self.looked_at && (self.len > POINTS_SHARED || !threads.are_many())
    }

    /// The new shape that was looked at last is that of now.
    pub(super) fn accept(
        &mut self,
        level: Level,
        threads: &Threads,
        new: &[[S; 3]],
        order: &[u32],
    ) {
        let straight = self.goes_straight(threads);
        self.looked_at = false;
        if straight {
            self.trees.gather(level, threads, new, order);
        } else {
            std::mem::swap(&mut self.callers, &mut self.spare);
        }
        (self.is_callers, self.is_trees) = (!straight, straight);
    }

    /// Brings the shape into tree order, which all that makes boxes and decides pairs needs.
    pub(super) fn bring_into_tree_order(&mut self, level: Level, threads: &Threads, order: &[u32]) {
        self.looked_at = true;
        if !self.is_trees {
            self.trees.gather(level, threads, &self.callers, order);
            self.is_trees = true;
            // As long as no shape was copied, none may ever be: then one of them is all that is kept.
            if self.spare.is_empty() {
                self.callers = Vec::new();
                self.is_callers = false;
            }
        }
    }

    /// In tree order; was brought into it.
    #[inline]
    pub(super) fn in_tree_order(&self) -> &Points<S> {
        debug_assert!(self.is_trees);
        &self.trees
    }

    /// As the caller orders vertices.
    pub(super) fn in_callers_order(&self, order: &[u32]) -> Cow<'_, [[S; 3]]> {
        if self.is_callers {
            return Cow::Borrowed(&self.callers);
        }
        let mut callers = vec![[S::default(); 3]; self.len()];
        for (place, &vertex) in order.iter().enumerate() {
            callers[vertex as usize] = self.trees.get(place as u32);
        }
        Cow::Owned(callers)
    }

    /// One of them, by its number in tree order.
    #[inline]
    pub(super) fn get(&self, vertex: u32, order: &[u32]) -> [S; 3] {
        if self.is_trees {
            self.trees.get(vertex)
        } else {
            self.callers[order[vertex as usize] as usize]
        }
    }

    /// Tree order is going to be another than `order`.
    pub(super) fn forget_tree_order(&mut self, order: &[u32]) {
        if let Cow::Owned(callers) = self.in_callers_order(order) {
            self.callers = callers;
        }
        (self.is_callers, self.is_trees) = (true, false);
    }
}
