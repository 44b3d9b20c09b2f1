//! Owners of vertices and edges: the bodies of the triangles that have them.
//!
//! A vertex or an edge between two groups of a source belongs to both. Triangles that do not count
//! give no ownership.

use crate::pieces::NONE;

/// Owners of the vertices, edges and triangles of a source.
pub(crate) struct Owners {
    vertices: Lists,
    edges: Lists,
    /// Body of each triangle, or [`NONE`].
    triangles: Vec<u32>,
}

/// Ascending lists of bodies, one for each element, as compressed sparse rows (CSR).
struct Lists {
    /// Start of each element's list, and at the end the length of all: a prefix sum.
    starts: Vec<u32>,
    bodies: Vec<u32>,
}

impl Owners {
    /// Owners of the elements of a mesh. `edges` are sorted, the smaller vertex first in each.
    ///
    /// `body` returns the body of a triangle, or `None` if the triangle does not count. O(t log t)
    /// for t triangles.
    pub(crate) fn of(
        triangles: &[[u32; 3]],
        vertices: usize,
        edges: &[[u32; 2]],
        body: impl Fn(u32) -> Option<u32>,
    ) -> Self {
        let (mut of_vertices, mut of_edges) = (Vec::new(), Vec::new());
        let mut of_triangles = Vec::with_capacity(triangles.len());
        for (&[a, b, c], triangle) in triangles.iter().zip(0..) {
            let body = body(triangle);
            of_triangles.push(body.unwrap_or(NONE));
            let Some(body) = body else {
                continue;
            };
            of_vertices.extend([a, b, c].map(|vertex| [vertex, body]));
            let sides = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
            let numbers = sides
                .iter()
                .filter_map(|side| edges.binary_search(side).ok());
            of_edges.extend(numbers.map(|edge| [edge as u32, body]));
        }
        Self {
            vertices: Lists::of(vertices, of_vertices),
            edges: Lists::of(edges.len(), of_edges),
            triangles: of_triangles,
        }
    }

    pub(crate) fn of_vertex(&self, vertex: u32) -> &[u32] {
        self.vertices.get(vertex)
    }

    pub(crate) fn of_edge(&self, edge: u32) -> &[u32] {
        self.edges.get(edge)
    }

    pub(crate) fn of_triangle(&self, triangle: u32) -> &[u32] {
        match self.triangles.get(triangle as usize) {
            Some(body) if *body != NONE => std::slice::from_ref(body),
            _ => &[],
        }
    }
}

impl Lists {
    /// Builds the lists of `count` elements from pairs of element and body.
    fn of(count: usize, mut pairs: Vec<[u32; 2]>) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = Vec::with_capacity(count + 1);
        let mut at = 0;
        for thing in 0..=count as u32 {
            while pairs.get(at).is_some_and(|&[other, _]| other < thing) {
                at += 1;
            }
            starts.push(at as u32);
        }
        let bodies = pairs.into_iter().map(|[_, body]| body).collect();
        Self { starts, bodies }
    }

    fn get(&self, thing: u32) -> &[u32] {
        let range = self
            .starts
            .get(thing as usize)
            .zip(self.starts.get(thing as usize + 1));
        range.map_or(&[], |(&start, &end)| {
            &self.bodies[start as usize..end as usize]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_between_two_bodies_is_of_both() {
        // Two triangles side by side, one that does not count, and an unused vertex.
        let triangles = [[0, 1, 2], [3, 2, 1], [3, 2, 4]];
        let edges = [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3], [2, 4], [3, 4]];
        let of = |triangle| [Some(7), Some(5), None][triangle as usize];
        let elements = Owners::of(&triangles, 6, &edges, of);
        let vertices: Vec<&[u32]> = (0..7).map(|it| elements.of_vertex(it)).collect();
        assert_eq!(vertices, [&[7][..], &[5, 7], &[5, 7], &[5], &[], &[], &[]]);
        let edges: Vec<&[u32]> = (0..8).map(|it| elements.of_edge(it)).collect();
        assert_eq!(edges, [&[7][..], &[7], &[5, 7], &[5], &[5], &[], &[], &[]]);
        let triangles: Vec<&[u32]> = (0..4).map(|it| elements.of_triangle(it)).collect();
        assert_eq!(triangles, [&[7][..], &[5], &[], &[]]);
    }
}
