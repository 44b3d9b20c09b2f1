//! Components, split, fuse and weld: several bodies from one, and one from several.
//!
//! All of it is said with calls that any user has.

use super::handle::World;
use super::scalar::Scalar;
use crate::edit::Edited;
use crate::error::{Error, ErrorKind};
use crate::ids::BodyId;
use crate::labels::Labels;
use crate::mesh::{self, Nearness};
use crate::threads::{Interrupt, Question};
use pliant_exact::distance::are_points_within;
use std::ops::Range;

/// Piece: a body that was a component of another, from [`World::split`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Id of the new body.
    pub body: BodyId,
    /// Number that each of its triangles had in the other body; ascending.
    pub triangles: Vec<u32>,
    /// Number that each of its vertices had in the other body; ascending.
    pub vertices: Vec<u32>,
}

/// New numbers of what came from another body, from [`World::fuse`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fused {
    /// New number of each triangle of the body that is no more; [`u32::MAX`] for numbers that were
    /// empty.
    pub triangles: Vec<u32>,
    /// New number of each of its vertices; [`u32::MAX`] for numbers that were empty.
    pub vertices: Vec<u32>,
}

/// # Change: components, split, fuse, weld
impl<S: Scalar> World<S> {
    /// Labels the connected components of a body's mesh: a number for each triangle, shape (m,).
    ///
    /// Two triangles are in one component if they share a vertex, or are linked through others that
    /// do. Components are numbered from 0 in the order of their first triangles; an empty number
    /// has [`u32::MAX`].
    ///
    /// Cost: O(m + n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "connected_components")]
    pub fn components(&self, body: BodyId) -> Result<Vec<u32>, Error> {
        self.find_components(body)
    }

    /// Splits a body: each component but the largest becomes a body of its own.
    ///
    /// The largest stays what it is, with all its numbers: the one with the most triangles, and of
    /// several the first. Returns the new bodies in the order of their first triangles. If all is
    /// one component there are none, and nothing has changed.
    ///
    /// Pieces inherit filter, environment, loose box, vertex groups, rest shape, labels, thickness,
    /// and whom the body [ignores](Self::ignore). If it ignores itself, the pieces ignore each
    /// other and it. So [`Everything`](crate::Selection::Everything) finds what it found, unless
    /// rest shape or labels left it out: they say nothing of two bodies. A motion of the body ends,
    /// as by [`apply`](Self::apply). Vertices that no triangle uses stay with it.
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let at = |x: f32| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    /// let body = world.add(&[[0, 1, 2], [3, 4, 5]], &[at(0.0), at(5.0)].concat())?;
    /// let pieces = world.split(body)?;
    /// assert_eq!(pieces[0].triangles, [1]);
    /// assert_eq!(pieces[0].vertices, [3, 4, 5]);
    /// assert_eq!(world.positions(pieces[0].body)?, at(5.0));
    /// assert_eq!(world.live_triangles(body)?, [true, false]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(m + n), and building the trees of the pieces.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`TooManyBodies`](crate::ErrorKind::TooManyBodies); then nothing has changed.
    pub fn split(&mut self, body: BodyId) -> Result<Vec<Piece>, Error> {
        self.split_apart(body)
    }

    /// Fuses two bodies: puts triangles and vertices of `b` behind those that `a` has, and removes
    /// `b`.
    ///
    /// Returns the numbers that they have now. Body `a` keeps its numbers, its filter and whom it
    /// [ignores](Self::ignore); vertices keep their groups and thickness. If either has a rest
    /// shape, it has one, in which the other rests as it is. If both had a loose box, it then has
    /// one around both; else it has none. Motions of either end, as by [`apply`](Self::apply).
    /// Triangles keep their [labels](Self::set_labels). If both have some, and only one says which
    /// are neighbours, `b` loses its own. Nothing is welded: see [`weld`](Self::weld).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let at = |x: f32| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    /// let a = world.add(&[[0, 1, 2]], &at(0.0))?;
    /// let b = world.add(&[[0, 1, 2]], &at(5.0))?;
    /// let fused = world.fuse(a, b)?;
    /// assert_eq!(fused.triangles, [1]);
    /// assert_eq!(fused.vertices, [3, 4, 5]);
    /// assert_eq!(world.bodies().len(), 1);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: building a tree for what comes; for both, if `b` has more than a sixteenth of the
    /// triangles of `a`.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody),
    /// [`TooLarge`](crate::ErrorKind::TooLarge); then nothing has changed.
    #[doc(alias = "merge")]
    pub fn fuse(&mut self, a: BodyId, b: BodyId) -> Result<Fused, Error> {
        self.fuse_with(a, b)
    }

    /// Welds boundary edges of a body that coincide: their vertices become one.
    ///
    /// A boundary edge belongs to exactly one triangle. Two of them coincide where each end of one
    /// is at most `tolerance` from an end of the other. The tolerance is in the unit of the
    /// positions, and this is decided exactly. Of vertices that become one, the lowest stays where
    /// it is and the others go.
    ///
    /// Vertices that coincide are not welded where no edges do, nor are two corners of one
    /// triangle. Returns what has changed; nothing, if nothing coincides.
    ///
    /// ```
    /// use pliant::World;
    ///
    /// // Two triangles, each with vertices of its own.
    /// let mut world = World::<f32>::new();
    /// let lower = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    /// let upper = [[0.0; 3], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let body = world.add(&[[0, 1, 2], [3, 4, 5]], &[lower, upper].concat())?;
    /// let edited = world.weld(body, 0.0)?;
    /// assert_eq!(edited.removed_vertices, [3, 4]);
    /// assert_eq!(world.triangles(body)?, [[0, 1, 2], [0, 2, 5]]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(m log m), however many are within the tolerance. If not all of these may become one,
    /// it is repeated for each edge that they come to.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`BadDistance`](crate::ErrorKind::BadDistance)
    /// if the tolerance is negative, infinite or NaN.
    #[doc(alias = "stitch")]
    pub fn weld(&mut self, body: BodyId, tolerance: f64) -> Result<Edited, Error> {
        self.weld_unless(body, tolerance, None)
    }

    /// [`World::components`].
    pub(super) fn find_components(&self, body: BodyId) -> Result<Vec<u32>, Error> {
        let triangles = self.triangles(body)?;
        Ok(mesh::components(triangles, self.vertex_count(body)?).0)
    }

    /// [`World::split`].
    pub(super) fn split_apart(&mut self, body: BodyId) -> Result<Vec<Piece>, Error> {
        let triangles = self.triangles(body)?;
        let (component_of, count) = mesh::components(triangles, self.vertex_count(body)?);
        let mut pieces: Vec<Piece> = (0..count).map(|_| Piece::empty(body)).collect();
        for (triangle, &component) in (0..).zip(&component_of) {
            if let Some(piece) = pieces.get_mut(component as usize) {
                piece.triangles.push(triangle);
            }
        }
        let size = |component: &usize| pieces[*component].triangles.len();
        let Some(largest) = (0..count).rev().max_by_key(size) else {
            return Ok(Vec::new());
        };
        pieces.remove(largest);
        if pieces.is_empty() {
            return Ok(pieces);
        }
        self.check_ids_for(pieces.len())?;
        let inherited = Inherited::of(self, body)?;
        let ids_before = self.bodies().len();
        if let Err(refused) = self.take_out(body, &mut pieces) {
            let added: Vec<BodyId> = self.bodies().skip(ids_before).collect();
            added.into_iter().try_for_each(|piece| self.remove(piece))?;
            return Err(refused);
        }
        let new: Vec<BodyId> = pieces.iter().map(|piece| piece.body).collect();
        inherited.give(self, body, &new)?;
        Ok(pieces)
    }

    /// Makes bodies of some components, whose triangles are known, and takes them out of the body.
    fn take_out(&mut self, body: BodyId, pieces: &mut [Piece]) -> Result<(), Error> {
        let triangles = self.triangles(body)?.to_vec();
        let positions = self.positions(body)?;
        let groups = self.vertex_groups(body)?;
        let rest = self.rest_positions(body)?.map(<[_]>::to_vec);
        let thickness = self.thickness(body)?;
        let labels = self.labels(body)?;
        let neighbours = labels.and_then(|it| it.neighbours).map(<[_]>::to_vec);
        let labels = labels.map(|labels| labels.of_triangles.to_vec());
        let mut edit = self.edit(body)?;
        let mut number_of = vec![u32::MAX; positions.len()];
        for piece in pieces {
            edit.remove_triangles(&piece.triangles);
            let corners = piece.triangles.iter().map(|&it| triangles[it as usize]);
            let corners: Vec<[u32; 3]> = corners.collect();
            piece.vertices = corners.as_flattened().to_vec();
            piece.vertices.sort_unstable();
            piece.vertices.dedup();
            for (number, &vertex) in (0..).zip(&piece.vertices) {
                number_of[vertex as usize] = number;
            }
            let renamed = |corners: [u32; 3]| corners.map(|vertex| number_of[vertex as usize]);
            let corners: Vec<[u32; 3]> = corners.into_iter().map(renamed).collect();
            let of_piece = piece.vertices.iter().map(|&it| positions[it as usize]);
            piece.body = self.add(&corners, &of_piece.collect::<Vec<_>>())?;
            let of_piece = piece.vertices.iter().map(|&it| groups[it as usize]);
            self.set_vertex_groups(piece.body, &of_piece.collect::<Vec<_>>())?;
            let of_piece = piece.vertices.iter().map(|&it| thickness[it as usize]);
            self.set_vertex_thickness(piece.body, &of_piece.collect::<Vec<_>>())?;
            if let Some(rest) = &rest {
                let of_piece = piece.vertices.iter().map(|&it| rest[it as usize]);
                self.set_rest_positions(piece.body, Some(&of_piece.collect::<Vec<_>>()))?;
            }
            if let Some(labels) = &labels {
                let of_piece = piece.triangles.iter();
                let of_piece = Labels {
                    of_triangles: &of_piece.map(|&it| labels[it as usize]).collect::<Vec<_>>(),
                    neighbours: neighbours.as_deref(),
                };
                self.set_labels(piece.body, Some(of_piece))?;
            }
        }
        self.apply(&edit).map(drop)
    }

    /// [`World::fuse`].
    pub(super) fn fuse_with(&mut self, a: BodyId, b: BodyId) -> Result<Fused, Error> {
        let mut edit = self.edit(a)?;
        let (triangles, positions) = (self.triangles(b)?, self.positions(b)?);
        if a == b {
            return Err(Error {
                body: Some(a),
                kind: ErrorKind::SameBody,
            });
        }
        let are_vertices = self.live_vertices(b)?;
        let vertices = numbered(
            &are_vertices,
            edit.add_vertices(&kept(&positions, &are_vertices)),
        );
        let are_triangles = self.live_triangles(b)?;
        let renamed = |corners: [u32; 3]| corners.map(|vertex| vertices[vertex as usize]);
        let coming = kept(triangles, &are_triangles).into_iter().map(renamed);
        let coming = edit.add_triangles(&coming.collect::<Vec<_>>());
        let fused = Fused {
            triangles: numbered(&are_triangles, coming),
            vertices,
        };
        let mut groups = self.vertex_groups(a)?;
        let of_b = self.vertex_groups(b)?;
        let loose = [self.loose_box(a)?, self.loose_box(b)?];
        let rest = match [self.rest_positions(a)?, self.rest_positions(b)?] {
            [None, None] => None,
            [of_a, of_b] => {
                let mut rest = of_a.map_or_else(|| self.positions(a), |it| Ok(it.to_vec()))?;
                rest.extend(kept(of_b.unwrap_or(&positions), &are_vertices));
                Some(rest)
            }
        };
        let labels = fused_labels(
            [self.labels(a)?, self.labels(b)?],
            self.triangles(a)?.len(),
            &are_triangles,
        );
        let mut thickness = self.thickness(a)?;
        thickness.extend(kept(&self.thickness(b)?, &are_vertices));
        let have_groups = groups.iter().chain(&of_b).any(|&group| group != 0);

        self.set_loose_box(a, None)?;
        if let Err(refused) = self.apply(&edit) {
            self.set_loose_box(a, loose[0])?;
            return Err(refused);
        }
        if let [Some(one), Some(other)] = loose {
            self.set_loose_box(a, Some(hull([one, other])))?;
        }
        if have_groups {
            groups.extend(kept(&of_b, &are_vertices));
            self.set_vertex_groups(a, &groups)?;
        }
        self.set_vertex_thickness(a, &thickness)?;
        if rest.is_some() {
            self.set_rest_positions(a, rest.as_deref())?;
        }
        if let Some((of_triangles, neighbours)) = &labels {
            let (of_triangles, neighbours) = (&of_triangles[..], neighbours.as_deref());
            let labels = Labels {
                of_triangles,
                neighbours,
            };
            self.set_labels(a, Some(labels))?;
        }
        self.remove(b)?;
        Ok(fused)
    }

    /// [`World::weld`], unless it is ended early.
    pub(super) fn weld_unless(
        &mut self,
        body: BodyId,
        tolerance: f64,
        question: Option<Question>,
    ) -> Result<Edited, Error> {
        let mut edit = self.edit(body)?;
        if !tolerance.is_finite() || tolerance < 0.0 {
            return Err(Error {
                body: Some(body),
                kind: ErrorKind::BadDistance {
                    distance: tolerance,
                },
            });
        }
        let positions = self.positions(body)?;
        let near = Nearness {
            position: &|vertex| positions[vertex as usize].map(Scalar::to_f64),
            tolerance,
            are_near: &|p, q| are_points_within(&p, &q, tolerance),
        };
        let interrupt = Interrupt::new(question);
        let triangles = self.triangles(body)?;
        let pairs = mesh::coinciding(triangles, positions.len(), &near, &|| interrupt.is_set());
        for [kept, gone] in pairs.ok_or(ErrorKind::Interrupted.of_query())? {
            edit.merge_vertices(kept, gone);
        }
        self.apply(&edit)
    }

    /// Refuses to make `count` more bodies if there are not as many ids left.
    fn check_ids_for(&self, count: usize) -> Result<(), Error> {
        let left = self
            .next_id()
            .map_or(0, |next| u64::from(u32::MAX - next) + 1);
        if left < count as u64 {
            return Err(Error {
                body: None,
                kind: ErrorKind::TooManyBodies,
            });
        }
        Ok(())
    }
}

impl Piece {
    fn empty(body: BodyId) -> Self {
        Self {
            body,
            triangles: Vec::new(),
            vertices: Vec::new(),
        }
    }
}

/// Properties that the pieces of a body inherit from it.
struct Inherited<S> {
    filter: (u32, u32),
    environment: u32,
    loose: Option<([S; 3], [S; 3])>,
    /// Bodies that it does not meet.
    ignored: Vec<BodyId>,
}

impl<S: Scalar> Inherited<S> {
    fn of(world: &World<S>, body: BodyId) -> Result<Self, Error> {
        let ignored = world.ignored();
        let with_body = ignored.into_iter().filter(|pair| pair.contains(&body));
        Ok(Self {
            filter: world.filter(body)?,
            environment: world.environment(body)?,
            loose: world.loose_box(body)?,
            ignored: with_body
                .map(|[a, b]| if a == body { b } else { a })
                .collect(),
        })
    }

    fn give(&self, world: &mut World<S>, body: BodyId, new: &[BodyId]) -> Result<(), Error> {
        for (place, &piece) in new.iter().enumerate() {
            world.set_filter(piece, self.filter.0, self.filter.1)?;
            world.set_environment(piece, self.environment)?;
            world.set_loose_box(piece, self.loose)?;
            for &other in &self.ignored {
                world.ignore(piece, other)?;
                if other == body {
                    for &sibling in &new[..=place] {
                        world.ignore(piece, sibling)?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Labels of a body with a count of triangles, then of another's that are there, and neighbours.
///
/// If both have labels, and only one says which are neighbours, the other body loses its own.
fn fused_labels(
    [of_a, of_b]: [Option<Labels>; 2],
    triangles: usize,
    are_there: &[bool],
) -> Option<(Vec<u32>, Option<Vec<[u32; 2]>>)> {
    let mut of_b = of_b;
    if let [Some(a), Some(b)] = [of_a, of_b]
        && a.neighbours.is_some() != b.neighbours.is_some()
    {
        of_b = None;
    }
    of_a.or(of_b)?;
    let of_triangles = |labels: Option<Labels>, count| {
        labels.map_or_else(|| vec![Labels::NONE; count], |it| it.of_triangles.to_vec())
    };
    let mut all = of_triangles(of_a, triangles);
    all.extend(kept(&of_triangles(of_b, are_there.len()), are_there));
    let neighbours = [of_a, of_b].into_iter().flatten();
    let neighbours = neighbours.map(|labels| labels.neighbours.map(<[_]>::to_vec));
    let neighbours = neighbours.collect::<Option<Vec<_>>>();
    Some((all, neighbours.map(|lists| lists.concat())))
}

/// Keeps the things whose flag is set.
fn kept<T: Copy>(things: &[T], are_there: &[bool]) -> Vec<T> {
    let both = things.iter().zip(are_there);
    both.filter(|(_, is)| **is)
        .map(|(&thing, _)| thing)
        .collect()
}

/// Numbers the things whose flag is set, in order; [`u32::MAX`] for the others.
fn numbered(are_there: &[bool], mut numbers: Range<u32>) -> Vec<u32> {
    let mut number = |&is: &bool| if is { numbers.next() } else { None };
    let numbers = are_there.iter().map(|is| number(is).unwrap_or(u32::MAX));
    numbers.collect()
}

/// Smallest box around two.
fn hull<S: Scalar>([one, other]: [([S; 3], [S; 3]); 2]) -> ([S; 3], [S; 3]) {
    let lower = |axis: usize| {
        if other.0[axis] < one.0[axis] {
            other.0[axis]
        } else {
            one.0[axis]
        }
    };
    let upper = |axis: usize| {
        if other.1[axis] > one.1[axis] {
            other.1[axis]
        } else {
            one.1[axis]
        }
    };
    (std::array::from_fn(lower), std::array::from_fn(upper))
}
