//! Which triangles meet at a vertex: lists through the corners of triangles, so that a triangle comes and goes in as many steps as there are
//! triangles at its corners.

use super::topology::EMPTY;
use crate::held::held;

/// The end of a list.
const END: u32 = u32::MAX;

/// A corner is known by three times the number of its triangle, and its place in it. Triangles and vertices as the caller numbers them.
#[derive(Clone, Debug)]
pub(crate) struct TrianglesAt {
    /// For each vertex a corner that is there.
    first: Vec<u32>,
    /// For each corner another one at the same vertex.
    next: Vec<u32>,
}

impl TrianglesAt {
    /// Cost: linear.
    pub(crate) fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let mut all = Self {
            first: vec![END; vertices],
            next: vec![END; 3 * triangles.len()],
        };
        // From the last on, so that each list begins with the first.
        for (triangle, &corners) in triangles.iter().enumerate().rev() {
            all.link(triangle as u32, corners);
        }
        all
    }

    /// The triangles at a vertex; one that has it more than once, as often.
    pub(crate) fn of(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let corner = |corner: u32| Some(corner).filter(|&corner| corner != END);
        let first = self.first.get(vertex as usize).copied().and_then(corner);
        std::iter::successors(first, move |&at| corner(self.next[at as usize]))
            .map(|corner| corner / 3)
    }

    /// There are so many vertices and numbers of triangles.
    pub(crate) fn resize(&mut self, vertices: usize, triangles: usize) {
        self.first.resize(vertices, END);
        self.next.resize(3 * triangles, END);
    }

    /// A triangle comes, which was not there.
    pub(crate) fn link(&mut self, triangle: u32, corners: [u32; 3]) {
        for (corner, vertex) in corners_of(triangle, corners) {
            let first = &mut self.first[vertex as usize];
            self.next[corner as usize] = *first;
            *first = corner;
        }
    }

    /// A triangle goes, which was there.
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

/// The corners of a triangle and the vertices there; none of an empty number.
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
