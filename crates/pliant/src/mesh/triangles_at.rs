//! Triangles at each vertex: linked lists through the corners of triangles.
//!
//! A triangle is linked in O(1), and unlinked in O(d), with d triangles at its corners.

use super::topology::EMPTY;
use crate::held::held;

/// Sentinel: the end of a list.
const END: u32 = u32::MAX;

/// Lists of the corners at each vertex, in the caller's numbers.
///
/// Corner i of triangle t has the number 3 t + i.
#[derive(Clone, Debug)]
pub(crate) struct TrianglesAt {
    /// For each vertex the first corner of its list.
    first: Vec<u32>,
    /// For each corner the next one at the same vertex.
    next: Vec<u32>,
}

impl TrianglesAt {
    /// Links all triangles. O(m + n) for m triangles and n vertices.
    pub(crate) fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let mut all = Self {
            first: vec![END; vertices],
            next: vec![END; 3 * triangles.len()],
        };
        // From the last triangle on, so that each list begins with the first.
        for (triangle, &corners) in triangles.iter().enumerate().rev() {
            all.link(triangle as u32, corners);
        }
        all
    }

    /// Returns the triangles at a vertex; one that has it at several corners comes as often.
    pub(crate) fn of(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let corner = |corner: u32| Some(corner).filter(|&corner| corner != END);
        let first = self.first.get(vertex as usize).copied().and_then(corner);
        std::iter::successors(first, move |&at| corner(self.next[at as usize]))
            .map(|corner| corner / 3)
    }

    /// Sets how many vertices and numbers of triangles there are.
    pub(crate) fn resize(&mut self, vertices: usize, triangles: usize) {
        self.first.resize(vertices, END);
        self.next.resize(3 * triangles, END);
    }

    /// Links a triangle that is in no list yet. O(1).
    pub(crate) fn link(&mut self, triangle: u32, corners: [u32; 3]) {
        for (corner, vertex) in corners_of(triangle, corners) {
            let first = &mut self.first[vertex as usize];
            self.next[corner as usize] = *first;
            *first = corner;
        }
    }

    /// Unlinks a triangle. O(d), with d triangles at its corners.
    pub(crate) fn unlink(&mut self, triangle: u32, corners: [u32; 3]) {
        for (corner, vertex) in corners_of(triangle, corners) {
            let after = self.next[corner as usize];
            let mut at = self.first[vertex as usize];
            if at == corner {
                self.first[vertex as usize] = after;
                continue;
            }
            while self.next[at as usize] != corner {
                at = self.next[at as usize];
            }
            self.next[at as usize] = after;
        }
    }
}

/// Corners of a triangle, by number, and the vertex at each; none of an empty number.
fn corners_of(triangle: u32, corners: [u32; 3]) -> impl Iterator<Item = (u32, u32)> {
    let is_live = corners != EMPTY;
    (3 * triangle..).zip(corners).filter(move |_| is_live)
}

held!(TrianglesAt: first[], next[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_come_and_go() {
        let mut triangles = vec![[0, 1, 2], [2, 1, 3], [4, 4, 1], EMPTY];
        let mut at = TrianglesAt::new(&triangles, 6);
        let check = |at: &TrianglesAt, triangles: &[[u32; 3]]| {
            for vertex in 0..6 {
                let mut found: Vec<u32> = at.of(vertex).collect();
                found.sort_unstable();
                let corners = (0..).zip(triangles);
                let expected = corners.flat_map(|(triangle, corners)| {
                    let here = corners.iter().filter(move |&&corner| corner == vertex);
                    here.map(move |_| triangle)
                });
                assert!(expected.eq(found), "{vertex}");
            }
        };
        check(&at, &triangles);
        for (triangle, corners) in [
            (1, EMPTY),
            (3, [5, 4, 1]),
            (2, [1, 1, 1]),
            (0, EMPTY),
            (1, [1, 2, 5]),
        ] {
            at.unlink(triangle, triangles[triangle as usize]);
            triangles[triangle as usize] = corners;
            at.link(triangle, corners);
            check(&at, &triangles);
        }
    }
}
