//! A shape of a body: as the caller orders vertices, in tree order, or both.
//!
//! Two ways lead to a new shape, and either leaves the old one as it is if something is wrong with
//! the new. A body that nobody looked at since its last shape is *copied* while it is checked,
//! which is one pass as fast as memory. A body that was looked at will be looked at again: it is
//! only checked, and then *taken straight into tree order*, without a copy between. But where there
//! are several threads a small one is copied as well: shapes come one after the other, and threads
//! bring them into order side by side.
//!
//! So a new shape is staged first, which changes nothing that can be seen, and then committed.

use super::checks::{all_inside, none_is_lost, out_of_range};
use crate::error::ErrorKind;
use crate::geometry::{Bounds, IN_A_ROW, Origin, Points, Real, Shape};
use crate::held::held;
use crate::ids::{CallerVertex, TreeVertex};
use crate::kernels::{Coordinate, Instructions, check, copy_checked, gather};
use crate::mesh::{Moved, Order};
use crate::threads::Executor;
use std::borrow::Cow;

/// Points in a job: some microseconds of work; a whole number of rows.
const JOB: usize = 64 * IN_A_ROW;
/// At most this many points are not worth waking a thread.
const SHARED: usize = 4 * JOB;

/// A body of at most this many triangles, or vertices, takes memory when somebody looks at it:
/// among many small ones most are never looked at. Larger ones take it when they are added, because
/// a query may not go on for long before it asks whether to stop.
pub(crate) const SMALL: usize = 1 << 8;

/// A shape of a body: the one that it has now, or the one at the end of a motion.
pub(crate) struct BodyShape<S> {
    len: usize,
    /// The shape, if it is in the caller's order. Nothing in a body that was looked at in every
    /// shape so far.
    callers: Vec<[S; 3]>,
    /// Where the next shape is copied to, so that a bad one never replaces a good one; nothing
    /// until one is copied.
    spare: Vec<[S; 3]>,
    /// The shape, if it is in tree order; nothing as long as a small body was not looked at.
    trees: Points<S>,
    order: InOrder,
    /// The extent of the vertices that triangles use.
    bounds: Bounds<S>,
    /// Counts changes of shape, and of the origin that boxes are relative to. Boxes of other
    /// versions are stale.
    version: u64,
}

/// A new shape for a body, before it is checked.
pub(crate) struct NewShape<'n, S> {
    /// As the caller orders vertices; the rows of empty vertices are those of others.
    pub(crate) positions: &'n [[S; 3]],
    pub(crate) order: &'n Order,
    /// Whether triangles use all vertices that are not empty.
    pub(crate) are_all_used: bool,
}

/// The order in which a shape is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InOrder {
    /// As the caller orders vertices: nobody looked at it since it came.
    Callers,
    /// In tree order, into which it was taken at once; nobody looked at it yet.
    TreesUnseen,
    /// In tree order; a query looked at it.
    Trees,
    /// In both; a query looked at it.
    Both,
}

/// A new shape that was checked and waits to be committed.
struct Staged<S> {
    /// Of all its vertices, used or not.
    bounds: Bounds<S>,
    is_copied: bool,
}

impl<S: Coordinate> BodyShape<S> {
    /// The first shape of a body, as the caller orders vertices; its mesh is in this order.
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

    /// Gives the shape another version: boxes that were made so far are stale.
    pub(crate) fn set_version(&mut self, version: u64) {
        self.version = version;
    }

    /// Gives the shape the next version.
    pub(crate) fn begin_version(&mut self) {
        self.version += 1;
    }

    /// The shape as everything that makes boxes sees it; it was brought into tree order.
    pub(crate) fn view<'s>(&'s self, order: &'s Order, origin: Origin) -> Shape<'s, S> {
        self.view_of(self.in_tree_order(), order, origin)
    }

    /// The shape as everything that makes boxes sees it, with its positions in tree order.
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

    /// The exact extent of the vertices that triangles use.
    #[inline]
    pub(crate) fn bounds(&self) -> Bounds<S> {
        self.bounds
    }

    /// Checks a new shape and takes it over, unless it leaves a box that holds it in every pose; or
    /// leaves all as it is and says what was wrong.
    pub(crate) fn take(
        &mut self,
        new: &NewShape<S>,
        loose: Option<Bounds<S>>,
        (instructions, executor): (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        let positions = new.positions;
        if positions.len() != self.len {
            return Err(ErrorKind::WrongLength {
                what: "positions",
                expected: self.len,
                found: positions.len(),
            });
        }
        let Some(staged) = self.stage(instructions, executor, positions) else {
            // Which vertex it was is found out only if there was one.
            return Err(out_of_range(positions));
        };
        let all = staged.bounds;
        if let Some(loose) = loose.filter(|loose| !(loose.holds(all.lo) && loose.holds(all.hi))) {
            all_inside(&loose, positions, |_| false)?;
        }
        none_is_lost(positions)?;
        let order = new.order.vertex_order();
        self.commit(&staged, instructions, executor, positions, order);
        self.bounds = if new.are_all_used {
            all
        } else {
            let used = order[..new.order.used_vertices()].iter();
            bounds_of(used.map(|&vertex| positions[vertex as usize]))
        };
        Ok(())
    }

    /// Takes a vertex into the bounds, which no triangle used so far.
    pub(crate) fn include(&mut self, vertex: TreeVertex, order: &Order) {
        self.bounds.include(self.get(vertex, order.vertex_order()));
    }

    /// Checks a new shape, as long as the old, and copies it aside if that is the way it will go;
    /// `None` if a coordinate is out of range.
    fn stage(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        new: &[[S; 3]],
    ) -> Option<Staged<S>> {
        let is_large = self.len > SHARED;
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
        let bounds = if is_large && executor.are_many() {
            let mut copies = copy.map(|copy| copy.chunks_mut(JOB));
            let parts = new.chunks(JOB);
            let mut jobs: Vec<_> = parts
                .map(|new| (new, copies.as_mut().and_then(Iterator::next), None))
                .collect();
            executor.run(&mut jobs, |_, (new, copy, bounds)| {
                *bounds = look(new, copy.as_deref_mut());
            });
            let mut parts = jobs.iter().map(|&(_, _, bounds)| bounds);
            parts.try_fold(Bounds::EMPTY, |all, part| Some(all.union(&part?)))?
        } else {
            look(new, copy)?
        };
        Some(Staged { bounds, is_copied })
    }

    /// The new shape that was staged is that of now.
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

    /// Brings the shape into tree order, which all that makes boxes and decides candidates needs,
    /// because a query is going to look at it. Returns false, and nothing has changed, if it was
    /// interrupted.
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

    /// In tree order; was brought into it.
    #[inline]
    pub(crate) fn in_tree_order(&self) -> &Points<S> {
        debug_assert_ne!(self.order, InOrder::Callers);
        &self.trees
    }

    /// As the caller orders vertices.
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

    /// All in tree order, whether they were brought into it or not.
    pub(crate) fn sorted(&self, order: &Order) -> Points<S> {
        let order = order.vertex_order();
        let vertices = (0..order.len() as u32).map(TreeVertex);
        Points::of(vertices.map(|vertex| self.get(vertex, order)))
    }

    /// One of them.
    #[inline]
    pub(crate) fn get(&self, vertex: TreeVertex, order: &[u32]) -> [S; 3] {
        if self.order == InOrder::Callers {
            self.callers[order[vertex.index()] as usize]
        } else {
            self.trees.get(vertex)
        }
    }

    /// Vertices come behind all others, in either order.
    pub(crate) fn push(&mut self, new: &[[S; 3]]) {
        if matches!(self.order, InOrder::Callers | InOrder::Both) {
            self.callers.extend_from_slice(new);
        }
        if self.order != InOrder::Callers {
            new.iter().for_each(|&position| self.trees.push(position));
        }
        self.len += new.len();
    }

    /// Places a vertex that was empty. One that went and came within one edit still has triangles
    /// that were taken out, whose boxes were made: these are stale then.
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

    /// Numbers in tree order are others.
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

    /// A vertex has a number at the end of tree order too: what is at the other stays where it is
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

/// Takes the points that `order` names.
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
        .chunks_mut(JOB)
        .zip(bounds.chunks_mut(JOB / IN_A_ROW))
        .zip(order.chunks(JOB));
    if order.len() > SHARED && executor.are_many() {
        let mut jobs: Vec<_> = parts.collect();
        executor.run(&mut jobs, |_, ((points, bounds), order)| {
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
