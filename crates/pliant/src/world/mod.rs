//! The world: bodies, their shapes, and the one place where the phases meet.
//!
//! `body` takes shapes over, whose `positions` are in the caller's order or in the tree's; `step` runs the phases for one query,
//! `crowd` for many pairs of bodies at once; `queries` and `parts` are what users ask, `picture` what a body looks like, `witness`
//! the last first pair; `forest` is where the degree of the trees turns from a value into a type; `validate` looks at every
//! invariant.

mod body;
mod crowd;
mod forest;
mod parts;
mod picture;
mod positions;
mod queries;
mod step;
mod validate;
mod witness;

use crate::broad_phase::BroadPhase;
use crate::error::{Error, ErrorKind};
use crate::exec::Threads;
use crate::geometry::{Aabb, Bounds, Origin, Scalar};
use crate::kernels::{self, Level};
use crate::options::Options;
use crate::pairs::Pair;
use crate::sort::Keys;
use crate::statistics::Statistics;
use crate::traversal::Scratch;
use body::Body;
pub(crate) use body::validate as validate_body;
use crowd::Crowd;
use forest::{Forest, with_trees};
pub use picture::NodeBox;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use witness::Witnesses;

/// A body of a world: a number in order of adding, never used again in that world.
///
/// An id means nothing in another world; there it is refused, or is another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(pub u32);

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "body {}", self.0)
    }
}

/// The tree of a body in numbers; the structure only, which no movement changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeShape {
    /// The level of the deepest leaf, where the root is level 0: the n of the paper's n / 2.
    pub depth: u32,
    /// All nodes, leaves and root included: the boxes of a complete update.
    pub nodes: usize,
    /// Nodes that hold triangles.
    pub leaves: usize,
}

/// Bodies that change their shape, and the questions which of their triangles intersect.
///
/// `S` is the type of the coordinates, `f32` or `f64`. Moving a body is [`set_positions`](Self::set_positions); there is
/// nothing else to call: every query brings up to date what it touches, and none can answer for old positions.
///
/// A call that is refused returns an [`Error`] and leaves the world as it was.
pub struct World<S> {
    options: Options,
    /// The instructions that kernels use.
    level: Level,
    threads: Threads,
    /// In no order that matters: a removed body's place is taken by the last.
    bodies: Vec<Body<S>>,
    places: BTreeMap<BodyId, usize>,
    /// The trees of the bodies, in the same places.
    forest: Forest,
    next_id: Option<u32>,
    /// Pairs of bodies that do not meet in queries of the whole world, each pair in both orders.
    ignored: BTreeSet<(BodyId, BodyId)>,
    broad_phase: BroadPhase,
    /// Boxes are relative to this point; zero for `f32`.
    origin: Origin,
    /// Shapes taken over since the origin was last looked at.
    moves: usize,
    /// What `write_positions` lends.
    lent: Vec<[S; 3]>,
    scratch: Scratch,
    crowd: Crowd,
    witnesses: Witnesses,
    boxes: Vec<Aabb>,
    /// Bodies that may meet, by their places, in the order of their ids; as the broad phase found them.
    body_pairs: Vec<[usize; 2]>,
    /// Whether nothing has happened since that could change them.
    body_pairs_hold: bool,
    pairs: Vec<Pair>,
    pairs_of_bodies: Vec<[u32; 2]>,
    keys: Keys,
    statistics: Statistics,
    /// Work done by `update` since the last query.
    done_early: Statistics,
}

impl<S: Scalar> World<S> {
    /// An empty world with the options that measured best.
    pub fn new() -> Self {
        Self::with_options(Options::default())
    }

    /// An empty world.
    pub fn with_options(options: Options) -> Self {
        Self {
            options,
            level: kernels::widest(),
            threads: Threads::new(options.threads),
            bodies: Vec::new(),
            places: BTreeMap::new(),
            forest: Forest::new(options.degree),
            next_id: Some(0),
            ignored: BTreeSet::new(),
            broad_phase: BroadPhase::new(options.broad_phase),
            origin: [0.0; 4],
            moves: 0,
            lent: Vec::new(),
            scratch: Scratch::default(),
            crowd: Crowd::default(),
            witnesses: Witnesses::default(),
            boxes: Vec::new(),
            body_pairs: Vec::new(),
            body_pairs_hold: false,
            pairs: Vec::new(),
            pairs_of_bodies: Vec::new(),
            keys: Keys::default(),
            statistics: Statistics::default(),
            done_early: Statistics::default(),
        }
    }

    /// Makes the kernels use a level of instructions, for tests that all of them give the same answers.
    #[doc(hidden)]
    pub fn use_instructions(&mut self, level: Level) {
        self.level = level;
    }

    /// The options of this world.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Adds a body: triangles as corner indices into positions, shape (m, 3) and (n, 3).
    ///
    /// Builds its tree on these positions, which need not be special; a rest pose is best. Corners may repeat: a degenerate
    /// triangle is the segment or point that it is. Vertices that no triangle uses are allowed, and checked like the others.
    ///
    /// Cost: O(m log m) for the balanced partition; for the others O(m) a level of the tree.
    ///
    /// # Errors
    ///
    /// [`NoTriangles`](ErrorKind::NoTriangles), [`VertexOutOfRange`](ErrorKind::VertexOutOfRange),
    /// [`BadPosition`](ErrorKind::BadPosition), [`NeedsSubnormals`](ErrorKind::NeedsSubnormals),
    /// [`TooLarge`](ErrorKind::TooLarge) above 2^28 triangles or 2^32 - 1 vertices, and
    /// [`TooManyBodies`](ErrorKind::TooManyBodies) after 2^32 bodies.
    #[doc(alias = "insert")]
    pub fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error> {
        let refused = |kind| Error { body: None, kind };
        let id = BodyId(
            self.next_id
                .ok_or_else(|| refused(ErrorKind::TooManyBodies))?,
        );
        body::validate(triangles, positions).map_err(refused)?;
        let mesh = self
            .forest
            .plant(self.bodies.len(), triangles, positions, &self.options);
        self.places.insert(id, self.bodies.len());
        self.bodies.push(Body::new(id, mesh, positions));
        self.next_id = id.0.checked_add(1);
        self.note_movement();
        Ok(id)
    }

    /// Removes a body. Its id will not be used again.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody).
    pub fn remove(&mut self, body: BodyId) -> Result<(), Error> {
        let place = self.place(body)?;
        self.places.remove(&body);
        self.bodies.swap_remove(place);
        self.forest.swap_remove(place);
        self.broad_phase.swap_remove(place, self.bodies.len());
        if let Some(moved) = self.bodies.get(place) {
            self.places.insert(moved.id(), place);
        }
        let others: Vec<_> = self
            .ignored
            .range((body, BodyId(0))..=(body, BodyId(u32::MAX)))
            .copied()
            .collect();
        for (_, other) in others {
            self.ignored.remove(&(body, other));
            self.ignored.remove(&(other, body));
        }
        self.witnesses.forget(body);
        self.body_pairs_hold = false;
        Ok(())
    }

    /// The bodies of this world, in the order in which they were added.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = BodyId> {
        self.places.keys().copied()
    }

    /// Gives a body a new shape: one position for each of its vertices, shape (n, 3), in the order in which it was added.
    ///
    /// The positions are checked, and taken over only if all are good; the body keeps its old shape if not. One pass that copies them;
    /// or, if a query looked at the shape before, and the body is large or there is one thread, one that checks and one that takes
    /// them straight into the order of the tree.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody), [`WrongLength`](ErrorKind::WrongLength),
    /// [`BadPosition`](ErrorKind::BadPosition) for the first coordinate of any vertex, used or not, that is NaN, infinite or above
    /// `f32::MAX` in magnitude, [`OutsideLooseBox`](ErrorKind::OutsideLooseBox),
    /// [`NeedsSubnormals`](ErrorKind::NeedsSubnormals) in a thread that flushes subnormal numbers.
    #[doc(alias = "update_vertices")]
    #[doc(alias = "refit")]
    pub fn set_positions(&mut self, body: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        let place = self.place(body)?;
        self.bodies[place]
            .take_over(self.level, &self.threads, positions)
            .map_err(|kind| Error {
                body: Some(body),
                kind,
            })?;
        self.note_movement();
        Ok(())
    }

    /// Like [`set_positions`](Self::set_positions), but `write` fills a buffer of the world's, shape (n, 3), in the order in
    /// which the vertices were added, so that the caller needs none of its own. The buffer comes filled with NaN: every
    /// vertex must be written. The same checked pass then takes the shape over, into the order of the tree.
    ///
    /// # Errors
    ///
    /// Those of [`set_positions`](Self::set_positions); a coordinate that is NaN, which an unwritten one is, is
    /// [`NotWritten`](ErrorKind::NotWritten). If `write` panics, the body keeps its shape.
    pub fn write_positions(
        &mut self,
        body: BodyId,
        write: impl FnOnce(&mut [[S; 3]]),
    ) -> Result<(), Error> {
        let place = self.place(body)?;
        let body_there = &mut self.bodies[place];
        self.lent.clear();
        self.lent.resize(body_there.vertex_count(), [S::NAN; 3]);
        write(&mut self.lent);
        body_there
            .take_over(self.level, &self.threads, &self.lent)
            .map_err(|kind| {
                let kind = match kind {
                    ErrorKind::BadPosition { vertex, position }
                        if position.iter().any(|x| x.is_nan()) =>
                    {
                        ErrorKind::NotWritten { vertex }
                    }
                    other => other,
                };
                Error {
                    body: Some(body),
                    kind,
                }
            })?;
        self.note_movement();
        Ok(())
    }

    /// Builds the tree of a body anew, on the shape it has now. Id, filters and loose box stay. Worth it when a shape has
    /// become very different from the one it was built on; never needed for right answers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody).
    pub fn rebuild(&mut self, body: BodyId) -> Result<(), Error> {
        let place = self.place(body)?;
        let body_there = &mut self.bodies[place];
        let mesh = self.forest.plant(
            place,
            &body_there.triangles(),
            &body_there.positions(),
            &self.options,
        );
        body_there.reorder(mesh);
        self.witnesses.forget(body);
        Ok(())
    }

    /// Says which bodies a body meets in queries of the whole world. Two bodies meet if the membership of each has a bit in
    /// common with the mask of the other. At first both are all ones. A query that names its bodies does not look at them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody).
    #[doc(alias = "collision_groups")]
    pub fn set_filter(&mut self, body: BodyId, membership: u32, mask: u32) -> Result<(), Error> {
        let place = self.place(body)?;
        self.bodies[place].set_filter(membership, mask);
        self.body_pairs_hold = false;
        Ok(())
    }

    /// From now on two bodies do not meet in queries of the whole world. A query that names them does not look at this.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody), [`SameBody`](ErrorKind::SameBody).
    pub fn ignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.two_bodies(a, b)?;
        self.ignored.extend([(a, b), (b, a)]);
        self.body_pairs_hold = false;
        Ok(())
    }

    /// Takes [`ignore`](Self::ignore) back.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody), [`SameBody`](ErrorKind::SameBody).
    pub fn unignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.two_bodies(a, b)?;
        self.ignored.remove(&(a, b));
        self.ignored.remove(&(b, a));
        self.body_pairs_hold = false;
        Ok(())
    }

    /// Gives a body a box, lower and upper corner, that holds it in every pose to come; `None` takes it away.
    ///
    /// The broad phase then works with this box, which stands still, and looks at the exact box only where loose boxes
    /// overlap. Until it is taken away, a position outside it is refused. Worth it for many bodies that move on their spot.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody), [`BadLooseBox`](ErrorKind::BadLooseBox) if a corner is not finite, is above `f32::MAX`
    /// in magnitude, or the lower one is above the upper one on some axis, and
    /// [`OutsideLooseBox`](ErrorKind::OutsideLooseBox) if the body is not inside now.
    pub fn set_loose_box(
        &mut self,
        body: BodyId,
        corners: Option<([S; 3], [S; 3])>,
    ) -> Result<(), Error> {
        let place = self.place(body)?;
        let loose = corners.map(|(lo, hi)| Bounds { lo, hi });
        self.bodies[place]
            .set_loose_box(loose)
            .map_err(|kind| Error {
                body: Some(body),
                kind,
            })?;
        self.note_movement();
        Ok(())
    }

    /// How many triangles a body has.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody).
    pub fn triangle_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.bodies[self.place(body)?].triangle_count())
    }

    /// How many vertices a body has: the length that its positions must have.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody).
    pub fn vertex_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.bodies[self.place(body)?].vertex_count())
    }

    /// The tree of a body in numbers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](ErrorKind::NoSuchBody).
    pub fn tree_shape(&self, body: BodyId) -> Result<TreeShape, Error> {
        let place = self.place(body)?;
        with_trees!(&self.forest, trees => {
            let tree = &trees[place];
            Ok(TreeShape { depth: tree.depth, nodes: tree.node_count(), leaves: tree.leaves.len() })
        })
    }

    /// Where a body stands in the lists.
    fn place(&self, body: BodyId) -> Result<usize, Error> {
        self.places.get(&body).copied().ok_or(Error {
            body: Some(body),
            kind: ErrorKind::NoSuchBody,
        })
    }

    /// Where two different bodies stand in the lists.
    fn two_bodies(&self, a: BodyId, b: BodyId) -> Result<[usize; 2], Error> {
        let places = [self.place(a)?, self.place(b)?];
        if a == b {
            return Err(Error {
                body: Some(a),
                kind: ErrorKind::SameBody,
            });
        }
        Ok(places)
    }

    /// A body has a new shape or box.
    fn note_movement(&mut self) {
        self.moves += 1;
        self.body_pairs_hold = false;
    }
}

impl<S: Scalar> Default for World<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S> fmt::Debug for World<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("options", &self.options)
            .field("bodies", &self.bodies.len())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_bodies_run_out_with_an_error() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0_f32]];
        let mut world = World::new();
        world.next_id = Some(u32::MAX);
        let last = world.add(&[[0, 1, 2]], &triangle);
        assert_eq!(last, Ok(BodyId(u32::MAX)));
        let refused = world.add(&[[0, 1, 2]], &triangle).unwrap_err();
        assert_eq!(
            (refused.body, refused.kind),
            (None, ErrorKind::TooManyBodies)
        );
        assert_eq!(world.triangle_count(BodyId(u32::MAX)), Ok(1));
    }
}
