//! Slow and obviously right: every pair of triangles, or of elements, no tree, no box of several, no filter, exact signs.
//!
//! Every configuration of [`World`](crate::World) must give these pairs. O(m^2) or O(m_a m_b) exact decisions.

use crate::Scalar;
use crate::contacts::ContactKind;
use crate::error::Error;
use crate::geometry::Bounds;
use crate::mesh::share_a_vertex;
use pliant_exact::Triangle;
use pliant_exact::distance::{Primitives, are_within_distance};
use pliant_exact::motion::{self, Grid, first_contact};
use pliant_exact::reference::{contact_kind, intersect};
use std::collections::BTreeSet;

/// The pairs (triangle of a, triangle of b) that intersect, sorted.
///
/// # Errors
///
/// [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange), [`BadPosition`](crate::ErrorKind::BadPosition) and the others of
/// [`World::add`](crate::World::add).
pub fn intersection_pairs<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let (a, b) = ((triangles_a, positions_a), (triangles_b, positions_b));
    triangles_that(a, Some(b), |a, b| intersect(a, b).then_some(())).map(without)
}

/// The pairs (smaller triangle, larger triangle) of one body that intersect and share no vertex, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_intersection_pairs<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let body = (triangles, positions);
    triangles_that(body, None, |a, b| intersect(a, b).then_some(())).map(without)
}

/// The pairs (triangle of a, triangle of b) that intersect, and how, sorted by pair.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn contacts<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
) -> Result<Vec<([u32; 2], ContactKind)>, Error> {
    let (a, b) = ((triangles_a, positions_a), (triangles_b, positions_b));
    triangles_that(a, Some(b), kind_of_contact)
}

/// The pairs (smaller triangle, larger triangle) of one body that intersect and share no vertex, and how, sorted by pair.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_contacts<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<([u32; 2], ContactKind)>, Error> {
    triangles_that((triangles, positions), None, kind_of_contact)
}

fn kind_of_contact(a: &Triangle, b: &Triangle) -> Option<ContactKind> {
    intersect(a, b).then(|| contact_kind(a, b))
}

/// The pairs (triangle of a, triangle of b) that are at most so far apart, sorted, as
/// [`World::close_triangle_pairs`](crate::World::close_triangle_pairs) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn close_triangle_pairs<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    let (a, b) = ((triangles_a, positions_a), (triangles_b, positions_b));
    triangles_that(a, Some(b), |a, b| are_close(a, b, distance).then_some(())).map(without)
}

/// The pairs (smaller triangle, larger triangle) of one body that share no vertex and are at most so far apart, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_close_triangle_pairs<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    let body = (triangles, positions);
    triangles_that(body, None, |a, b| are_close(a, b, distance).then_some(())).map(without)
}

/// The triangles of a body, and where its vertices are.
type Mesh<'m, S> = (&'m [[u32; 3]], &'m [[S; 3]]);

/// The pairs of triangles of two bodies of which `find` finds something, and what.
///
/// If there is no other body, the pairs of one: the smaller triangle, then the larger one.
/// There, triangles that share a vertex are no pair.
fn triangles_that<S: Scalar, T>(
    (triangles_a, positions_a): Mesh<S>,
    other: Option<Mesh<S>>,
    find: impl Fn(&Triangle, &Triangle) -> Option<T>,
) -> Result<Vec<([u32; 2], T)>, Error> {
    let (triangles_b, positions_b) = other.unwrap_or((triangles_a, positions_a));
    let all_a = corners(triangles_a, positions_a)?;
    let all_b = corners(triangles_b, positions_b)?;
    let is_one_body = other.is_none();
    let mut pairs = Vec::new();
    for (i, a) in all_a.iter().enumerate() {
        for (j, b) in all_b.iter().enumerate() {
            if is_one_body && (j <= i || share_a_vertex(triangles_a[i], triangles_b[j])) {
                continue;
            }
            pairs.extend(find(a, b).map(|found| ([i as u32, j as u32], found)));
        }
    }
    Ok(pairs)
}

/// The pairs alone.
fn without<T>(pairs: Vec<([u32; 2], T)>) -> Vec<[u32; 2]> {
    pairs.into_iter().map(|(pair, _)| pair).collect()
}

/// Whether two triangles intersect, or any of their elements are at most so far apart.
fn are_close(a: &Triangle, b: &Triangle, distance: f64) -> bool {
    // What is further apart on one axis is further apart.
    let box_of = |corners: &Triangle| {
        let mut bounds = Bounds::EMPTY;
        corners.iter().for_each(|&corner| bounds.include(corner));
        bounds
    };
    box_of(a).are_within(&box_of(b), distance)
        && (intersect(a, b) || {
            let corner = |i: usize, [p, q]: [&Triangle; 2]| {
                Primitives::VertexTriangle([p[i], q[0], q[1], q[2]])
            };
            let edges = |i: usize, j: usize| {
                Primitives::EdgeEdge([a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]])
            };
            (0..3).any(|i| {
                are_within_distance(&corner(i, [a, b]), distance)
                    || are_within_distance(&corner(i, [b, a]), distance)
                    || (0..3).any(|j| are_within_distance(&edges(i, j), distance))
            })
        })
}

/// A body, and where it is going.
#[derive(Clone, Copy, Debug)]
pub struct Moving<'m, S> {
    /// Its triangles.
    pub triangles: &'m [[u32; 3]],
    /// Where its vertices are.
    pub positions: &'m [[S; 3]],
    /// Where they are at the end of a motion.
    pub end: Option<&'m [[S; 3]]>,
    /// Vertices of one group do not meet, but for group 0; none: all meet.
    pub groups: Option<&'m [u32]>,
}

impl<S: Scalar> Moving<'_, S> {
    fn validate(&self) -> Result<(), Error> {
        corners(self.triangles, self.positions)?;
        if let Some(end) = self.end {
            corners(self.triangles, end)?;
        }
        Ok(())
    }

    /// The box of some vertices, at both ends of the motion.
    fn box_of(&self, vertices: &[u32]) -> Bounds<f64> {
        let mut bounds = Bounds::EMPTY;
        for positions in [Some(self.positions), self.end].into_iter().flatten() {
            for &vertex in vertices {
                bounds.include(positions[vertex as usize].map(Scalar::to_f64));
            }
        }
        bounds
    }

    /// The box of some vertices where they are.
    fn box_now(&self, vertices: &[u32]) -> Bounds<f64> {
        let still = Self { end: None, ..*self };
        still.box_of(vertices)
    }

    /// The vertices that triangles use, by their numbers.
    fn vertices(&self) -> Vec<(u32, Vec<u32>)> {
        let used: BTreeSet<u32> = self.triangles.as_flattened().iter().copied().collect();
        used.into_iter().map(|it| (it, vec![it])).collect()
    }

    fn group(&self, vertex: u32) -> u32 {
        self.groups.map_or(0, |groups| groups[vertex as usize])
    }
}

/// The edges of triangles, the smaller vertex first, each once, sorted: as [`World::edges`](crate::World::edges) numbers them.
pub fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let of_triangle = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let both = triangles
        .iter()
        .flat_map(of_triangle)
        .filter(|[a, b]| a != b);
    let edges: BTreeSet<_> = both.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.into_iter().collect()
}

/// The candidates (vertex of a, triangle of b), sorted, as
/// [`World::vertex_triangle_candidates`](crate::World::vertex_triangle_candidates) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn vertex_triangle_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(a, Some(b), near(radius))
}

/// The candidates (vertex, triangle) of one body with itself, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_vertex_triangle_pairs<S: Scalar>(
    body: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(body, None, near(radius))
}

/// The pairs (vertex of a, triangle of b) that are at most so far apart, sorted, as
/// [`World::close_vertex_triangle_pairs`](crate::World::close_vertex_triangle_pairs) means them. Where bodies are going does not count.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn close_vertex_triangle_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(a, Some(b), close(distance))
}

/// The pairs (vertex, triangle) of one body that are at most so far apart, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_close_vertex_triangle_pairs<S: Scalar>(
    body: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(body, None, close(distance))
}

/// Two elements by their numbers, and the interval of times of their first contact.
pub type Timed = ([u32; 2], [f64; 2]);

/// The pairs (vertex of a, triangle of b) that meet on the way, sorted, as
/// [`World::vertex_triangle_impacts`](crate::World::vertex_triangle_impacts) means them. The width is finite, and at least 0.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn vertex_triangle_impacts<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    ElementPairs::VerticesAndTriangles.that_meet(a, Some(b), width)
}

/// The pairs (vertex, triangle) of one body that meet on the way, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_vertex_triangle_impacts<S: Scalar>(
    body: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    ElementPairs::VerticesAndTriangles.that_meet(body, None, width)
}

/// The pairs (edge of a, edge of b) that meet on the way, sorted, as
/// [`World::edge_edge_impacts`](crate::World::edge_edge_impacts) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn edge_edge_impacts<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    ElementPairs::EdgesAndEdges.that_meet(a, Some(b), width)
}

/// The pairs (smaller edge, larger edge) of one body that meet on the way, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_edge_edge_impacts<S: Scalar>(
    body: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    ElementPairs::EdgesAndEdges.that_meet(body, None, width)
}

/// Which elements are looked at in pairs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ElementPairs {
    VerticesAndTriangles,
    EdgesAndEdges,
}

impl ElementPairs {
    /// The pairs of two bodies for which `test` holds; or of one, if there is no other.
    fn that<S: Scalar>(
        self,
        a: &Moving<S>,
        other: Option<&Moving<S>>,
        test: impl Fn(Part<S>, Part<S>) -> bool,
    ) -> Result<Vec<[u32; 2]>, Error> {
        let found = self.all(a, other, |a, b| test(a, b).then_some(()))?;
        Ok(without(found))
    }

    /// The pairs that meet on the way, with the intervals of their first contact.
    fn that_meet<S: Scalar>(
        self,
        a: &Moving<S>,
        other: Option<&Moving<S>>,
        width: f64,
    ) -> Result<Vec<Timed>, Error> {
        let grid = Grid::new(width);
        self.all(a, other, |a, b| {
            let contact = first_contact(&elements_in_motion(a, b)?)?;
            Some(contact.cell(grid))
        })
    }

    /// The pairs of which `find` finds something, and what. Of edges of one body, the smaller edge
    /// is the first.
    fn all<S: Scalar, T>(
        self,
        a: &Moving<S>,
        other: Option<&Moving<S>>,
        find: impl Fn(Part<S>, Part<S>) -> Option<T>,
    ) -> Result<Vec<([u32; 2], T)>, Error> {
        let b = other.unwrap_or(a);
        a.validate()?;
        b.validate()?;
        let is_one_body = other.is_none();
        let (of_a, of_b) = match self {
            Self::VerticesAndTriangles => (a.vertices(), numbered(b.triangles)),
            Self::EdgesAndEdges => (numbered(&edges(a.triangles)), numbered(&edges(b.triangles))),
        };
        let mut pairs = Vec::new();
        for (i, one) in &of_a {
            for (j, another) in &of_b {
                let is_twice = is_one_body && self == Self::EdgesAndEdges && i >= j;
                let (one, another) = ((a, &one[..]), (b, &another[..]));
                if !is_twice && may_meet(one, another, is_one_body) {
                    pairs.extend(find(one, another).map(|found| ([*i, *j], found)));
                }
            }
        }
        Ok(pairs)
    }
}

/// Elements by their vertices, with their numbers.
fn numbered<const C: usize>(elements: &[[u32; C]]) -> Vec<(u32, Vec<u32>)> {
    (0..).zip(elements.iter().map(|it| it.to_vec())).collect()
}

/// Two elements as the exact decision takes them, if their boxes overlap.
fn elements_in_motion<S: Scalar>((a, of_a): Part<S>, (b, of_b): Part<S>) -> Option<motion::Moving> {
    if !a.box_of(of_a).are_within(&b.box_of(of_b), 0.0) {
        return None;
    }
    let both = || {
        let of_both = of_a.iter().map(|&vertex| (a, vertex));
        of_both.chain(of_b.iter().map(|&vertex| (b, vertex)))
    };
    let start = both().map(|(body, vertex)| body.positions[vertex as usize]);
    let end = both().map(|(body, vertex)| body.end.unwrap_or(body.positions)[vertex as usize]);
    let four = |corners: Vec<[S; 3]>| -> Option<[[f64; 3]; 4]> {
        let corners: [[S; 3]; 4] = corners.try_into().ok()?;
        Some(corners.map(|corner| corner.map(Scalar::to_f64)))
    };
    Some(motion::Moving {
        are_edges: of_a.len() == 2,
        corners: [four(start.collect())?, four(end.collect())?],
    })
}

/// Some vertices of a body.
type Part<'p, 'm, S> = (&'p Moving<'m, S>, &'p [u32]);

/// Whether the boxes of two elements are near each other, at both ends of their motions.
fn near<S: Scalar>(radius: f64) -> impl Fn(Part<S>, Part<S>) -> bool {
    move |(a, of_a), (b, of_b)| a.box_of(of_a).are_within(&b.box_of(of_b), 2.0 * radius)
}

/// Whether two elements are at most so far apart, now.
fn close<S: Scalar>(distance: f64) -> impl Fn(Part<S>, Part<S>) -> bool {
    move |(a, of_a), (b, of_b)| {
        // What is further apart on one axis is further apart.
        if !a.box_now(of_a).are_within(&b.box_now(of_b), distance) {
            return false;
        }
        let corner =
            |body: &Moving<S>, vertex: u32| body.positions[vertex as usize].map(Scalar::to_f64);
        let elements = match (of_a, of_b) {
            (&[vertex], &[i, j, k]) => {
                let [i, j, k] = [i, j, k].map(|vertex| corner(b, vertex));
                Primitives::VertexTriangle([corner(a, vertex), i, j, k])
            }
            (&[i, j], &[k, l]) => {
                Primitives::EdgeEdge([corner(a, i), corner(a, j), corner(b, k), corner(b, l)])
            }
            _ => return false,
        };
        are_within_distance(&elements, distance)
    }
}

/// The candidates (edge of a, edge of b), sorted, as [`World::edge_edge_candidates`](crate::World::edge_edge_candidates) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn edge_edge_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(a, Some(b), near(radius))
}

/// The candidates (smaller edge, larger edge) of one body with itself, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_edge_edge_pairs<S: Scalar>(
    body: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(body, None, near(radius))
}

/// The pairs (edge of a, edge of b) that are at most so far apart, sorted, as
/// [`World::close_edge_edge_pairs`](crate::World::close_edge_edge_pairs) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn close_edge_edge_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(a, Some(b), close(distance))
}

/// The pairs (smaller edge, larger edge) of one body that are at most so far apart, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_close_edge_edge_pairs<S: Scalar>(
    body: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(body, None, close(distance))
}

/// Whether two elements, by their vertices, may be near each other: they have no vertex in common, and their groups let them.
fn may_meet<S: Scalar>((a, of_a): Part<S>, (b, of_b): Part<S>, itself: bool) -> bool {
    let pairs = || of_a.iter().flat_map(|&i| of_b.iter().map(move |&j| (i, j)));
    let are_kept_apart = pairs().all(|(i, j)| a.group(i) != 0 && a.group(i) == b.group(j));
    let share = itself && pairs().any(|(i, j)| i == j);
    !share && !are_kept_apart
}

fn corners<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<Triangle>, Error> {
    crate::bodies::validate(triangles, positions).map_err(|kind| Error { body: None, kind })?;
    let corner = |vertex: u32| positions[vertex as usize].map(Scalar::to_f64);
    Ok(triangles
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect())
}
