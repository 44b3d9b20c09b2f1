//! Shape of a body: positions in the caller's order, in tree order, or both.
//!
//! A new shape is staged first, which changes nothing that can be seen, and then committed; an
//! error leaves the old shape. A body that no query looked at since its last shape is *copied*
//! while it is checked, one pass as fast as memory. A body that was looked at will be looked at
//! again: it is checked, and then *gathered straight into tree order*, without a copy. With several
//! threads a small body is copied as well: shapes come one by one, and threads bring them into
//! order side by side.

use super::checks::{all_inside, length, none_is_lost, out_of_range};
use crate::error::ErrorKind;
use crate::geometry::{Bounds, IN_A_ROW, Origin, Points, Real, Shape};
use crate::held::held;
use crate::ids::{CallerVertex, TreeVertex};
use crate::kernels::{Coordinate, Instructions, check, copy_checked, gather};
use crate::mesh::{Moved, Order};
use crate::threads::{Executor, Grain};
use pliant_exact::DEBUG;
use std::borrow::Cow;

/// A shape of at most this many vertices is copied while it is taken over, where there are several
/// threads.
const COPIED: usize = 4 * Grain::POINTS.items;

/// The most triangles, or vertices, of a body whose memory is reserved only when a query looks at
/// it.
///
/// Among many small bodies most are never looked at. Larger ones reserve it when they are added,
/// because a query may not run long without a look at the interruption.
pub(crate) const SMALL: usize = 1 << 8;

/// Shape of a body: the present one, or the one at the end of a motion.
pub(crate) struct BodyShape<S> {
    len: usize,
    /// Positions in the caller's order, if the shape is in it. Empty in a body that was looked at
    /// in every shape so far.
    callers: Vec<[S; 3]>,
    /// Memory to which the next shape is copied, so that a bad one never replaces a good one. Empty
    /// until one is copied.
    spare: Vec<[S; 3]>,
    /// Positions in tree order, if the shape is in it. Empty as long as a small body was not looked
    /// at.
    trees: Points<S>,
    order: InOrder,
    /// Bounds of the vertices that triangles use.
    bounds: Bounds<S>,
    /// Version: counts changes of shape, and of the origin that boxes are relative to. Boxes of
    /// other versions are stale.
    version: u64,
}

/// New shape for a body, before it is checked.
pub(crate) struct NewShape<'n, S> {
    /// Positions in the caller's order. Rows of empty vertices repeat other vertices.
    pub(crate) positions: &'n [[S; 3]],
    pub(crate) order: &'n Order,
    /// Whether triangles use all vertices that are not empty.
    pub(crate) are_all_used: bool,
}

/// Order in which a shape is stored, and whether a query looked at it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InOrder {
    /// Stored in the caller's order: no query looked at it since it came.
    Callers,
    /// Stored in tree order, into which it was gathered at once. No query looked at it yet.
    TreesUnseen,
    /// Stored in tree order; a query looked at it.
    Trees,
    /// Stored in both orders; a query looked at it.
    Both,
}

/// New shape that was checked and waits to be committed.
pub(crate) struct Staged<S> {
    /// Bounds of all its vertices, used or not.
    bounds: Bounds<S>,
    is_copied: bool,
}

impl<S: Coordinate> BodyShape<S> {
    /// First shape of a body, in the caller's order. Its mesh is in `order`.
    pub(crate) fn new(positions: &[[S; 3]], order: &Order) -> Self {
        let used = order.vertex_order()[..order.used_vertices()].iter();
        let bounds = bounds_of(used.map(|&vertex| positions[vertex as usize]));
        Self::of(positions, bounds, 1)
    }

    /// Copies the shape of a body whose mesh is in this order.
    pub(crate) fn copy(&self, order: &Order) -> Self {
        Self::of(&self.in_callers_order(order), self.bounds, self.version)
    }

    fn of(positions: &[[S; 3]], bounds: Bounds<S>, version: u64) -> Self {
        Self {
            len: positions.len(),
            callers: positions.to_vec(),
            spare: Vec::new(),
            trees: Points::with_len(if positions.len() > SMALL {
                positions.len()
            } else {
                0
            }),
            order: InOrder::Callers,
            bounds,
            version,
        }
    }

    pub(crate) fn version(&self) -> u64 {
        self.version
    }

    /// Sets the version, which makes earlier boxes stale.
    pub(crate) fn set_version(&mut self, version: u64) {
        self.version = version;
    }

    /// Begins the next version, which makes earlier boxes stale.
    pub(crate) fn begin_version(&mut self) {
        self.version += 1;
    }

    /// View of the shape for everything that makes boxes. The shape must be in tree order.
    pub(crate) fn view<'s>(&'s self, order: &'s Order, origin: Origin) -> Shape<'s, S> {
        self.view_of(self.in_tree_order(), order, origin)
    }

    /// View of the shape for everything that makes boxes, with its positions in tree order.
    pub(crate) fn view_of<'s>(
        &self,
        positions: &'s Points<S>,
        order: &'s Order,
        origin: Origin,
    ) -> Shape<'s, S> {
        Shape {
            positions,
            triangles: order.all_corners(),
            origin,
            version: self.version,
        }
    }

    /// Exact bounds of the vertices that triangles use.
    #[inline]
    pub(crate) fn bounds(&self) -> Bounds<S> {
        self.bounds
    }

    /// Checks a new shape, and copies it aside if it is going to be copied.
    ///
    /// The shape must not leave the loose box, if there is one. Nothing that can be seen changes.
    /// O(n).
    pub(crate) fn check(
        &mut self,
        new: &NewShape<S>,
        loose: Option<Bounds<S>>,
        (instructions, executor): (Instructions, Executor),
    ) -> Result<Staged<S>, ErrorKind> {
        let positions = new.positions;
        length("positions", self.len, positions.len())?;
        let Some(staged) = self.stage(instructions, executor, positions) else {
            // Which vertex it was is found only if there was one.
            return Err(out_of_range(positions));
        };
        let all = staged.bounds;
        if let Some(loose) = loose.filter(|loose| !(loose.holds(all.lo) && loose.holds(all.hi))) {
            all_inside(&loose, positions, |_| false)?;
        }
        none_is_lost(positions)?;
        Ok(staged)
    }

    /// Takes a new shape over that was checked.
    pub(crate) fn accept(
        &mut self,
        staged: &Staged<S>,
        new: &NewShape<S>,
        (instructions, executor): (Instructions, Executor),
    ) {
        let positions = new.positions;
        let order = new.order.vertex_order();
        self.commit(staged, instructions, executor, positions, order);
        self.bounds = if new.are_all_used {
            staged.bounds
        } else {
            let used = order[..new.order.used_vertices()].iter();
            bounds_of(used.map(|&vertex| positions[vertex as usize]))
        };
    }

    /// Takes a new shape over, or leaves the old as it is and says what is wrong with the new.
    pub(crate) fn take(
        &mut self,
        new: &NewShape<S>,
        loose: Option<Bounds<S>>,
        threads: (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        let staged = self.check(new, loose, threads)?;
        self.accept(&staged, new, threads);
        Ok(())
    }

    /// Extends the bounds by a vertex that no triangle used so far.
    pub(crate) fn include(&mut self, vertex: TreeVertex, order: &Order) {
        self.bounds.include(self.get(vertex, order.vertex_order()));
    }

    /// Checks a new shape, as long as the old, and copies it aside if copying is its way. `None` if
    /// a coordinate is out of range.
    fn stage(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        new: &[[S; 3]],
    ) -> Option<Staged<S>> {
        let is_large = self.len > COPIED;
        let was_seen = matches!(self.order, InOrder::Trees | InOrder::Both);
        let is_copied = !(was_seen && (is_large || !executor.are_many()));
        let copy = is_copied.then(|| {
            self.spare.resize(new.len(), [S::default(); 3]);
            &mut self.spare[..]
        });
        let look = |new: &[[S; 3]], copy: Option<&mut [[S; 3]]>| match copy {
            Some(copy) => copy_checked(instructions, new, copy),
            None => check(instructions, new),
        };
        let nanoseconds = Grain::POINTS.time(new.len());
        let bounds = if executor.pays(nanoseconds) {
            let mut copies = copy.map(|copy| copy.chunks_mut(Grain::POINTS.items));
            let parts = new.chunks(Grain::POINTS.items);
            let mut jobs: Vec<_> = parts
                .map(|new| (new, copies.as_mut().and_then(Iterator::next), None))
                .collect();
            executor.run(&mut jobs, nanoseconds, |_, (new, copy, bounds)| {
                *bounds = look(new, copy.as_deref_mut());
            });
            let mut parts = jobs.iter().map(|&(_, _, bounds)| bounds);
            parts.try_fold(Bounds::EMPTY, |all, part| Some(all.union(&part?)))?
        } else {
            look(new, copy)?
        };
        Some(Staged { bounds, is_copied })
    }

    /// Makes the staged shape the present one.
    fn commit(
        &mut self,
        staged: &Staged<S>,
        instructions: Instructions,
        executor: Executor,
        new: &[[S; 3]],
        order: &[u32],
    ) {
        if staged.is_copied {
            std::mem::swap(&mut self.callers, &mut self.spare);
            self.order = InOrder::Callers;
        } else {
            gather_all(instructions, executor, new, order, &mut self.trees);
            self.order = InOrder::TreesUnseen;
        }
    }

    /// Brings the shape into tree order, which boxes and decisions need, because a query is going
    /// to look at it. O(n).
    ///
    /// Returns false, with nothing changed, if interrupted.
    pub(crate) fn bring_into_tree_order(
        &mut self,
        (instructions, executor): (Instructions, Executor),
        order: &Order,
    ) -> bool {
        self.order = match self.order {
            InOrder::TreesUnseen | InOrder::Trees => InOrder::Trees,
            InOrder::Both => InOrder::Both,
            InOrder::Callers => {
                let (from, order) = (&self.callers, order.vertex_order());
                gather_all(instructions, executor, from, order, &mut self.trees);
                if executor.is_interrupted() {
                    return false;
                }
                // As long as no shape was copied, none may ever be: then one order is all that is
                // kept.
                if self.spare.is_empty() {
                    self.callers = Vec::new();
                    InOrder::Trees
                } else {
                    InOrder::Both
                }
            }
        };
        true
    }

    /// Positions in tree order. The shape must be in it.
    #[inline]
    pub(crate) fn in_tree_order(&self) -> &Points<S> {
        assert!(!DEBUG || self.order != InOrder::Callers);
        &self.trees
    }

    /// Positions in the caller's order. O(n) if only tree order is stored.
    pub(crate) fn in_callers_order(&self, order: &Order) -> Cow<'_, [[S; 3]]> {
        if matches!(self.order, InOrder::Callers | InOrder::Both) {
            return Cow::Borrowed(&self.callers);
        }
        let mut callers = vec![[S::default(); 3]; self.len];
        let have_orphans = order.orphans().count() > 0;
        for (place, &vertex) in (0..).zip(order.vertex_order()) {
            if !(have_orphans && order.orphans().has(place)) {
                callers[vertex as usize] = self.trees.get(TreeVertex(place));
            }
        }
        Cow::Owned(callers)
    }

    /// Positions in tree order, whether or not the shape is in it. O(n).
    pub(crate) fn sorted(&self, order: &Order) -> Points<S> {
        let order = order.vertex_order();
        let vertices = (0..order.len() as u32).map(TreeVertex);
        Points::of(vertices.map(|vertex| self.get(vertex, order)))
    }

    /// Position of one vertex, in whatever order the shape is.
    #[inline]
    pub(crate) fn get(&self, vertex: TreeVertex, order: &[u32]) -> [S; 3] {
        if self.order == InOrder::Callers {
            self.callers[order[vertex.index()] as usize]
        } else {
            self.trees.get(vertex)
        }
    }

    /// Appends vertices behind all others, in either order.
    pub(crate) fn push(&mut self, new: &[[S; 3]]) {
        if matches!(self.order, InOrder::Callers | InOrder::Both) {
            self.callers.extend_from_slice(new);
        }
        if self.order != InOrder::Callers {
            new.iter().for_each(|&position| self.trees.push(position));
        }
        self.len += new.len();
    }

    /// Places a vertex that was empty.
    ///
    /// A vertex that went and came within one edit still has removed triangles, whose boxes were
    /// made. These become stale.
    pub(crate) fn place(
        &mut self,
        vertex: CallerVertex,
        number: TreeVertex,
        position: [S; 3],
        order: &Order,
    ) {
        self.version += u64::from(number.index() < order.used_vertices());
        if matches!(self.order, InOrder::Callers | InOrder::Both) {
            self.callers[vertex.index()] = position;
        }
        if self.order != InOrder::Callers {
            self.trees.set(number, position);
        }
    }

    /// Follows a change of numbers in tree order.
    pub(crate) fn follow(&mut self, moved: &Moved) {
        if self.order == InOrder::Callers {
            return;
        }
        match *moved {
            Moved::Exchanged([a, b]) => {
                let [at_a, at_b] = [a, b].map(|vertex| self.trees.get(vertex));
                self.trees.set(a, at_b);
                self.trees.set(b, at_a);
            }
            Moved::LastGone => self.trees.pop(),
        }
    }

    /// Gives a vertex another number at the end of tree order. The position at its old number stays
    /// until the next shape.
    pub(crate) fn follow_to_the_end(&mut self, slot: TreeVertex) {
        if self.order != InOrder::Callers {
            self.trees.push(self.trees.get(slot));
        }
    }

    /// Leaves tree order, which is going to be another than `order`.
    pub(crate) fn forget_tree_order(&mut self, order: &Order) {
        if let Cow::Owned(callers) = self.in_callers_order(order) {
            self.callers = callers;
        }
        self.order = InOrder::Callers;
    }
}

fn bounds_of<S: Real>(positions: impl Iterator<Item = [S; 3]>) -> Bounds<S> {
    let mut bounds = Bounds::EMPTY;
    positions.for_each(|position| bounds.include(position));
    bounds
}

/// Gathers the points that `order` names, with several threads if there are many points.
fn gather_all<S: Coordinate>(
    instructions: Instructions,
    executor: Executor,
    from: &[[S; 3]],
    order: &[u32],
    to: &mut Points<S>,
) {
    if to.points.len() != order.len() {
        *to = Points::with_len(order.len());
    }
    let Points { points, bounds } = to;
    let parts = points
        .chunks_mut(Grain::POINTS.items)
        .zip(bounds.chunks_mut(Grain::POINTS.items / IN_A_ROW))
        .zip(order.chunks(Grain::POINTS.items));
    let nanoseconds = Grain::POINTS.time(order.len());
    if executor.pays(nanoseconds) {
        let mut jobs: Vec<_> = parts.collect();
        executor.run(&mut jobs, nanoseconds, |_, ((points, bounds), order)| {
            gather(instructions, from, order, points, bounds);
        });
        return;
    }
    for ((points, bounds), order) in parts {
        if executor.is_interrupted() {
            return;
        }
        gather(instructions, from, order, points, bounds);
    }
}

held!(BodyShape<S>: callers[], spare[], trees);
