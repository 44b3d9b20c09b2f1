//! Connectivity: validated triangles, numbered in tree order. It never moves.
//!
//! The tree orders the triangles so that those below any node are neighbours in memory, and the vertices are numbered in the
//! order in which these triangles first use them. So the vertices below a node are one run of numbers, plus the few on its
//! border that an earlier node used first (`tree::VertexSets`). Vertices that no triangle uses come last: they are checked
//! with the others and are in no box.

use crate::ErrorKind;

/// More triangles than this would let a node id overflow 32 bits.
const MAX_TRIANGLES: usize = 1 << 28;

/// The triangles of a body in tree order, and the way back to the caller's numbers.
#[derive(Debug)]
pub(crate) struct Mesh {
    corners: Vec<[u32; 3]>,
    triangle_ids: Vec<u32>,
    vertex_ids: Vec<u32>,
    /// Vertices 0..used are corners of some triangle.
    used: usize,
}

const UNSEEN: u32 = u32::MAX;

/// Refuses what no body can be made of.
pub(crate) fn validate(triangles: &[[u32; 3]], vertices: usize) -> Result<(), ErrorKind> {
    if triangles.is_empty() {
        return Err(ErrorKind::NoTriangles);
    }
    if triangles.len() > MAX_TRIANGLES {
        return Err(ErrorKind::TooLarge {
            what: "triangles",
            count: triangles.len(),
            limit: MAX_TRIANGLES,
        });
    }
    if vertices > UNSEEN as usize {
        return Err(ErrorKind::TooLarge {
            what: "vertices",
            count: vertices,
            limit: UNSEEN as usize,
        });
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
            return Err(ErrorKind::VertexOutOfRange {
                triangle,
                vertex,
                vertices,
            });
        }
    }
    Ok(())
}

impl Mesh {
    /// The mesh of validated triangles, with triangle `order[t]` of the caller as triangle `t` of the tree.
    pub(crate) fn in_order(triangles: &[[u32; 3]], vertices: usize, order: Vec<u32>) -> Self {
        let mut place = vec![UNSEEN; vertices];
        let mut vertex_ids = Vec::with_capacity(vertices);
        let mut renumber = |vertex: u32| {
            let place = &mut place[vertex as usize];
            if *place == UNSEEN {
                *place = vertex_ids.len() as u32;
                vertex_ids.push(vertex);
            }
            *place
        };
        let corners = order
            .iter()
            .map(|&triangle| triangles[triangle as usize].map(&mut renumber))
            .collect();
        let used = vertex_ids.len();
        vertex_ids.extend((0..vertices as u32).filter(|&vertex| place[vertex as usize] == UNSEEN));
        Self {
            corners,
            triangle_ids: order,
            vertex_ids,
            used,
        }
    }

    /// The triangles as the caller gave them.
    pub(crate) fn in_callers_order(&self) -> Vec<[u32; 3]> {
        let mut triangles = vec![[0; 3]; self.corners.len()];
        for (corners, &id) in self.corners.iter().zip(&self.triangle_ids) {
            triangles[id as usize] = corners.map(|vertex| self.vertex_ids[vertex as usize]);
        }
        triangles
    }

    /// Corners of each triangle, both in tree order.
    pub(crate) fn corners(&self) -> &[[u32; 3]] {
        &self.corners
    }

    /// The caller's number of each triangle.
    pub(crate) fn triangle_ids(&self) -> &[u32] {
        &self.triangle_ids
    }

    /// The caller's number of each vertex.
    pub(crate) fn vertex_ids(&self) -> &[u32] {
        &self.vertex_ids
    }

    /// How many vertices are corners of some triangle; they come first.
    pub(crate) fn used_vertices(&self) -> usize {
        self.used
    }

    /// Whether two triangles have a vertex of the mesh in common.
    #[inline]
    pub(crate) fn share_a_vertex(&self, a: u32, b: u32) -> bool {
        share_a_vertex(self.corners[a as usize], self.corners[b as usize])
    }
}

/// Whether two triangles of one mesh have a vertex in common.
#[inline]
pub(crate) fn share_a_vertex(a: [u32; 3], b: [u32; 3]) -> bool {
    // No early exit: nine comparisons without a branch are cheaper than one branch that goes wrong.
    let mut shared = false;
    for corner in a {
        for other in b {
            shared |= corner == other;
        }
    }
    shared
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_there_and_back() {
        let triangles = [[4, 1, 2], [2, 1, 0], [6, 6, 4]];
        assert_eq!(validate(&triangles, 8), Ok(()));
        let mesh = Mesh::in_order(&triangles, 8, vec![2, 0, 1]);
        assert_eq!(mesh.corners(), [[0, 0, 1], [1, 2, 3], [3, 2, 4]]);
        assert_eq!(mesh.vertex_ids(), [6, 4, 1, 2, 0, 3, 5, 7]);
        assert_eq!(mesh.used_vertices(), 5);
        assert_eq!(mesh.in_callers_order(), triangles);
        assert!(
            mesh.share_a_vertex(0, 1) && mesh.share_a_vertex(1, 2) && !mesh.share_a_vertex(0, 2)
        );
    }

    #[test]
    fn names_the_triangle_and_the_vertex() {
        assert_eq!(validate(&[], 3), Err(ErrorKind::NoTriangles));
        let error = ErrorKind::VertexOutOfRange {
            triangle: 1,
            vertex: 3,
            vertices: 3,
        };
        assert_eq!(validate(&[[0, 1, 2], [0, 3, 9]], 3), Err(error));
        let too_many = validate(&[[0, 1, 2]], UNSEEN as usize + 1).unwrap_err();
        assert!(matches!(
            too_many,
            ErrorKind::TooLarge {
                what: "vertices",
                ..
            }
        ));
    }
}
