//! Every pair of triangles, or of elements, one after the other: what the references of all kinds go through.
//!
//! Which pairs a kind looks for is said by its own `reference`, in its folder of `world/kinds`.

use crate::error::Error;
use crate::geometry::{Bounds, Real};
use crate::mesh::share_a_vertex;
use pliant_exact::Triangle;
use std::collections::BTreeSet;

/// The triangles of a body, and where its vertices are.
pub(crate) type Mesh<'m, S> = (&'m [[u32; 3]], &'m [[S; 3]]);

/// The pairs of triangles of two bodies of which `find` finds something, and what.
///
/// If there is no other body, the pairs of one: the smaller triangle, then the larger one.
/// There, triangles that share a vertex are no pair.
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

/// The pairs alone.
pub(crate) fn without<T>(pairs: Vec<([u32; 2], T)>) -> Vec<[u32; 2]> {
    pairs.into_iter().map(|(pair, _)| pair).collect()
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

impl<S> Moving<'_, S> {
    fn validate(&self) -> Result<(), Error>
    where
        S: Real,
    {
        corners(self.triangles, self.positions)?;
        if let Some(end) = self.end {
            corners(self.triangles, end)?;
        }
        Ok(())
    }

    /// The box of some vertices, at both ends of the motion.
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

    /// The box of some vertices where they are.
    pub(crate) fn box_now(&self, vertices: &[u32]) -> Bounds<f64>
    where
        S: Real,
    {
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

/// Which elements are looked at in pairs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ElementPairs {
    VerticesAndTriangles,
    EdgesAndEdges,
}

impl ElementPairs {
    /// The pairs of two bodies for which `test` holds; or of one, if there is no other.
    pub(crate) fn that<S: Real>(
        self,
        a: &Moving<S>,
        other: Option<&Moving<S>>,
        test: impl Fn(Part<S>, Part<S>) -> bool,
    ) -> Result<Vec<[u32; 2]>, Error> {
        let found = self.all(a, other, |a, b| test(a, b).then_some(()))?;
        Ok(without(found))
    }

    /// The pairs of which `find` finds something, and what. Of edges of one body, the smaller edge
    /// is the first.
    pub(crate) fn all<S: Real, T>(
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

/// Some vertices of a body.
pub(crate) type Part<'p, 'm, S> = (&'p Moving<'m, S>, &'p [u32]);

/// Whether two elements, by their vertices, may be near each other: they have no vertex in common, and their groups let them.
fn may_meet<S: Real>((a, of_a): Part<S>, (b, of_b): Part<S>, itself: bool) -> bool {
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
