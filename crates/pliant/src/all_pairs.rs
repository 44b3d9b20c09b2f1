//! Brute force: every pair of triangles or of elements, one after the other.
//!
//! The references of all kinds go through here. Each says in its own `reference.rs`, in its folder
//! of `world/kinds`, which pairs it looks for.

use crate::error::Error;
use crate::geometry::{Bounds, Real};
use crate::labels::Labels;
use crate::mesh::share_a_vertex;
use pliant_exact::Triangle;
use std::collections::{BTreeMap, BTreeSet};

/// Mesh: the triangles of a body, and the positions of its vertices.
pub(crate) type Mesh<'m, S> = (&'m [[u32; 3]], &'m [[S; 3]]);

/// Pairs of triangles of two bodies for which `find` finds something, with what it found.
///
/// Without another body they are pairs of one body: the smaller triangle, then the larger one.
/// There, triangles that share a vertex are left out.
pub(crate) fn triangles_that<S: Real, T>(
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

/// Pairs of triangles of a body that share a vertex, the smaller triangle first, for which `find`
/// finds something, with what it found. `find` gets the vertices and the corners of both.
pub(crate) fn adjacent_triangles<S: Real, T>(
    (triangles, positions): Mesh<S>,
    find: impl Fn([[u32; 3]; 2], &Triangle, &Triangle) -> Option<T>,
) -> Result<Vec<([u32; 2], T)>, Error> {
    let corners = corners(triangles, positions)?;
    let mut pairs = Vec::new();
    for i in 0..triangles.len() {
        for j in i + 1..triangles.len() {
            let both = [triangles[i], triangles[j]];
            if share_a_vertex(both[0], both[1]) {
                let found = find(both, &corners[i], &corners[j]);
                pairs.extend(found.map(|found| ([i as u32, j as u32], found)));
            }
        }
    }
    Ok(pairs)
}

/// Pairs (edge of a, triangle of b) for which `is_found` holds, sorted.
pub(crate) fn edges_and_triangles<S: Real>(
    (triangles_a, positions_a): Mesh<S>,
    (triangles_b, positions_b): Mesh<S>,
    is_found: impl Fn(&[[f64; 3]; 2], &Triangle) -> bool,
) -> Result<Vec<[u32; 2]>, Error> {
    corners(triangles_a, positions_a)?;
    let all_b = corners(triangles_b, positions_b)?;
    let mut pairs = Vec::new();
    for (i, ends) in (0..).zip(edges(triangles_a)) {
        let edge = ends.map(|vertex| positions_a[vertex as usize].map(Real::to_f64));
        for (j, triangle) in (0..).zip(&all_b) {
            if is_found(&edge, triangle) {
                pairs.push([i, j]);
            }
        }
    }
    Ok(pairs)
}

/// The pairs without what was found of each.
pub(crate) fn without<T>(pairs: Vec<([u32; 2], T)>) -> Vec<[u32; 2]> {
    pairs.into_iter().map(|(pair, _)| pair).collect()
}

/// A body and its motion, as references take it.
#[derive(Clone, Copy, Debug)]
pub struct Moving<'m, S> {
    /// Triangles, shape (m, 3).
    pub triangles: &'m [[u32; 3]],
    /// Positions of the vertices at the start of the motion, shape (n, 3).
    pub positions: &'m [[S; 3]],
    /// Positions at the end of the motion, shape (n, 3); `None` if the body stands still.
    pub end: Option<&'m [[S; 3]]>,
    /// Groups of the vertices, shape (n,); vertices of one group do not meet, except in group 0.
    /// `None`: all meet.
    pub groups: Option<&'m [u32]>,
    /// Positions in the rest shape, shape (n, 3), if the body has one: see
    /// [`World::set_rest_positions`](crate::World::set_rest_positions).
    pub rest: Option<&'m [[S; 3]]>,
    /// Thickness of the vertices, shape (n,), if the body has any: see
    /// [`World::set_thickness`](crate::World::set_thickness).
    pub thickness: Option<&'m [f64]>,
    /// Labels of the triangles, if the body has any: see
    /// [`World::set_labels`](crate::World::set_labels).
    pub labels: Option<Labels<'m>>,
}

impl<'m, S> Moving<'m, S> {
    /// A body at these positions that stands still, with nothing else.
    pub fn at(triangles: &'m [[u32; 3]], positions: &'m [[S; 3]]) -> Self {
        Self {
            triangles,
            positions,
            end: None,
            groups: None,
            rest: None,
            thickness: None,
            labels: None,
        }
    }

    fn validate(&self) -> Result<(), Error>
    where
        S: Real,
    {
        corners(self.triangles, self.positions)?;
        for positions in [self.end, self.rest].into_iter().flatten() {
            corners(self.triangles, positions)?;
        }
        Ok(())
    }

    /// Box of some vertices, over both ends of the motion.
    pub(crate) fn box_of(&self, vertices: &[u32]) -> Bounds<f64>
    where
        S: Real,
    {
        let mut bounds = Bounds::EMPTY;
        for positions in [Some(self.positions), self.end].into_iter().flatten() {
            for &vertex in vertices {
                bounds.include(positions[vertex as usize].map(Real::to_f64));
            }
        }
        bounds
    }

    /// Vertices that triangles use, by number.
    fn vertices(&self) -> Vec<(u32, Vec<u32>)> {
        let used: BTreeSet<u32> = self.triangles.as_flattened().iter().copied().collect();
        used.into_iter().map(|it| (it, vec![it])).collect()
    }

    /// The largest thickness of some vertices.
    pub(crate) fn thickness_of(&self, vertices: &[u32]) -> f64 {
        let of = |&vertex: &u32| self.thickness.map_or(0.0, |all| all[vertex as usize]);
        vertices.iter().map(of).fold(0.0, f64::max)
    }

    fn group(&self, vertex: u32) -> u32 {
        self.groups.map_or(0, |groups| groups[vertex as usize])
    }
}

/// Removes pairs of triangles of one body that its labels leave out: see
/// [`World::set_labels`](crate::World::set_labels).
pub fn leave_out<S>(body: &Moving<S>, pairs: &mut Vec<[u32; 2]>) {
    let parts = Parts::of(body);
    pairs.retain(|pair| {
        let [a, b] = pair.map(|triangle| parts.of_triangle(triangle));
        !parts.leave_out(&a, &b)
    });
}

/// Labels of a body, by the elements that have them.
struct Parts<'m> {
    triangles: &'m [[u32; 3]],
    labels: Option<Labels<'m>>,
    /// Pairs of neighbours, in both orders.
    neighbours: BTreeSet<[u32; 2]>,
}

impl<'m> Parts<'m> {
    fn of<S>(body: &Moving<'m, S>) -> Self {
        let mut at: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        let mut neighbours = BTreeSet::new();
        if let Some(labels) = body.labels {
            for (corners, &label) in body.triangles.iter().zip(labels.of_triangles) {
                for &corner in corners {
                    at.entry(corner).or_default().insert(label);
                }
            }
            match labels.neighbours {
                Some(given) => neighbours.extend(given.iter().flat_map(|&[a, b]| [[a, b], [b, a]])),
                None => neighbours
                    .extend(at.values().flat_map(|all| {
                        all.iter().flat_map(|&a| all.iter().map(move |&b| [a, b]))
                    })),
            }
        }
        Self {
            triangles: body.triangles,
            labels: body.labels,
            neighbours,
        }
    }

    /// Label of a triangle, if it has one.
    fn of_triangle(&self, triangle: u32) -> Vec<u32> {
        let all = self.labels.iter();
        all.map(|labels| labels.of_triangles[triangle as usize])
            .collect()
    }

    /// Labels of all triangles that have these vertices.
    fn at(&self, vertices: &[u32]) -> Vec<u32> {
        let all = (0..self.triangles.len() as u32).filter(|&triangle| {
            let corners = &self.triangles[triangle as usize];
            vertices.iter().all(|vertex| corners.contains(vertex))
        });
        all.flat_map(|triangle| self.of_triangle(triangle))
            .collect()
    }

    /// Whether two elements with these labels are left out.
    fn leave_out(&self, a: &[u32], b: &[u32]) -> bool {
        let are_near = |a: u32, b: u32| a == b || self.neighbours.contains(&[a, b]);
        let leave_out = |a: u32, b: u32| ![a, b].contains(&Labels::NONE) && are_near(a, b);
        self.labels.is_some() && a.iter().all(|&a| b.iter().all(|&b| leave_out(a, b)))
    }
}

/// Edges of triangles, the smaller vertex first, each once, sorted.
///
/// [`World::edges`](crate::World::edges) numbers them in this order. Cost: O(m log m).
pub fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let of_triangle = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let both = triangles
        .iter()
        .flat_map(of_triangle)
        .filter(|[a, b]| a != b);
    let edges: BTreeSet<_> = both.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.into_iter().collect()
}

/// Kind of elements whose pairs are looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ElementPairs {
    VerticesAndTriangles,
    EdgesAndEdges,
}

impl ElementPairs {
    /// Pairs of two bodies for which `test` holds; pairs of one body if there is no other.
    pub(crate) fn that<S: Real>(
        self,
        a: &Moving<S>,
        other: Option<&Moving<S>>,
        test: impl Fn(Element<S>, Element<S>) -> bool,
    ) -> Result<Vec<[u32; 2]>, Error> {
        let found = self.all(a, other, |a, b| test(a, b).then_some(()))?;
        Ok(without(found))
    }

    /// The pairs of elements of one body without those that its labels leave out.
    pub(crate) fn that_stay<S: Real>(
        self,
        body: &Moving<S>,
        pairs: Vec<[u32; 2]>,
    ) -> Vec<[u32; 2]> {
        let parts = Parts::of(body);
        let edges = edges(body.triangles);
        let stays = |&[a, b]: &[u32; 2]| {
            let [of_a, of_b] = match self {
                Self::VerticesAndTriangles => [parts.at(&[a]), parts.of_triangle(b)],
                Self::EdgesAndEdges => [a, b].map(|edge| parts.at(&edges[edge as usize])),
            };
            !parts.leave_out(&of_a, &of_b)
        };
        pairs.into_iter().filter(stays).collect()
    }

    /// Pairs for which `find` finds something, with what it found. Of two edges of one body the
    /// smaller is the first.
    pub(crate) fn all<S: Real, T>(
        self,
        a: &Moving<S>,
        other: Option<&Moving<S>>,
        find: impl Fn(Element<S>, Element<S>) -> Option<T>,
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

/// Elements by their vertices, each with its number.
fn numbered<const C: usize>(elements: &[[u32; C]]) -> Vec<(u32, Vec<u32>)> {
    (0..).zip(elements.iter().map(|it| it.to_vec())).collect()
}

/// Element of a body, by its vertices.
pub(crate) type Element<'p, 'm, S> = (&'p Moving<'m, S>, &'p [u32]);

/// Whether two elements may be near each other: they share no vertex, and their groups let them.
fn may_meet<S: Real>((a, of_a): Element<S>, (b, of_b): Element<S>, itself: bool) -> bool {
    let pairs = || of_a.iter().flat_map(|&i| of_b.iter().map(move |&j| (i, j)));
    let are_kept_apart = pairs().all(|(i, j)| a.group(i) != 0 && a.group(i) == b.group(j));
    let share = itself && pairs().any(|(i, j)| i == j);
    !share && !are_kept_apart
}

fn corners<S: Real>(triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<Vec<Triangle>, Error> {
    crate::bodies::validate(triangles, positions).map_err(|kind| Error { body: None, kind })?;
    let corner = |vertex: u32| positions[vertex as usize].map(Real::to_f64);
    Ok(triangles
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect())
}
