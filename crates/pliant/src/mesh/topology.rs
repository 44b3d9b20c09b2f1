//! Topology of a mesh as the caller gave it: triangles by their corners, in the caller's numbers.
//!
//! Numbers stay as they are: a removed triangle leaves its number empty.

use crate::ErrorKind;
use crate::held::held;
use crate::ids::{CallerTriangle, CallerVertex};

/// Most triangles of a mesh: with more, numbers of nodes would not fit 32 bits.
const MAX_TRIANGLES: usize = 1 << 28;
/// Most vertices of a mesh: with more, no 32-bit number would be left as a sentinel.
const MAX_VERTICES: usize = u32::MAX as usize;

/// Corners of an empty number: the sentinel for no triangle.
pub(crate) const EMPTY: [u32; 3] = [u32::MAX; 3];

/// Validated triangles of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    triangles: Vec<[u32; 3]>,
    /// How many vertices there are, used or not.
    vertices: u32,
    /// How many numbers have a triangle.
    live: u32,
}

/// Refuses more triangles or vertices than a mesh can have.
pub(super) fn check_counts(triangles: usize, vertices: usize) -> Result<(), ErrorKind> {
    let limits = [
        ("triangles", triangles, MAX_TRIANGLES),
        ("vertices", vertices, MAX_VERTICES),
    ];
    match limits.into_iter().find(|(_, count, limit)| count > limit) {
        Some((what, count, limit)) => Err(ErrorKind::TooLarge { what, count, limit }),
        None => Ok(()),
    }
}

/// Refuses a mesh of which no body can be made: no triangles, too many, or a corner out of range.
/// O(m).
pub(crate) fn validate(triangles: &[[u32; 3]], vertices: usize) -> Result<(), ErrorKind> {
    if triangles.is_empty() {
        return Err(ErrorKind::NoTriangles);
    }
    check_counts(triangles.len(), vertices)?;
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

impl Topology {
    /// Copies validated triangles.
    pub(crate) fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        Self {
            triangles: triangles.to_vec(),
            vertices: vertices as u32,
            live: triangles.len() as u32,
        }
    }

    /// Returns how many triangles there are; empty numbers are not counted.
    pub(crate) fn live_count(&self) -> usize {
        self.live as usize
    }

    /// Whether a number has a triangle.
    #[inline]
    pub(crate) fn is_live(&self, triangle: u32) -> bool {
        let corners = self.triangles.get(triangle as usize);
        corners.is_some_and(|&corners| corners != EMPTY)
    }

    /// Sets the corners of a number; [`EMPTY`] removes its triangle. Numbers up to it exist from
    /// now on.
    pub(crate) fn set(&mut self, triangle: u32, corners: [u32; 3]) {
        let triangle = triangle as usize;
        if triangle >= self.triangles.len() {
            self.triangles.resize(triangle + 1, EMPTY);
        }
        let place = &mut self.triangles[triangle];
        self.live -= u32::from(*place != EMPTY);
        self.live += u32::from(corners != EMPTY);
        *place = corners;
    }

    /// Sets how many vertices there are.
    pub(crate) fn set_vertex_count(&mut self, vertices: usize) {
        self.vertices = vertices as u32;
    }

    /// Sets how many numbers of triangles there are. Numbers that are cut off are empty before; new
    /// ones are empty.
    pub(crate) fn set_triangle_count(&mut self, triangles: usize) {
        self.triangles.resize(triangles, EMPTY);
    }

    /// Returns the corners of all numbers, as the caller gave them; [`EMPTY`] where there is no
    /// triangle.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns how many vertices there are, used or not.
    pub(crate) fn vertex_count(&self) -> usize {
        self.vertices as usize
    }

    /// Returns the corners of a number; [`EMPTY`] if there is no triangle.
    #[inline]
    pub(crate) fn corners(&self, triangle: CallerTriangle) -> [CallerVertex; 3] {
        self.triangles[triangle.index()].map(CallerVertex)
    }
}

/// Whether two triangles of one mesh have a vertex in common.
#[inline]
pub(crate) fn share_a_vertex<V: Copy + PartialEq>(a: [V; 3], b: [V; 3]) -> bool {
    // No early exit: nine comparisons are cheaper than one mispredicted branch.
    let mut shared = false;
    for corner in a {
        for other in b {
            shared |= corner == other;
        }
    }
    shared
}

held!(Topology: triangles[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_the_triangle_and_the_vertex() {
        assert_eq!(validate(&[], 3), Err(ErrorKind::NoTriangles));
        let error = ErrorKind::VertexOutOfRange {
            triangle: 1,
            vertex: 3,
            vertices: 3,
        };
        assert_eq!(validate(&[[0, 1, 2], [0, 3, 9]], 3), Err(error));
        let too_many = validate(&[[0, 1, 2]], MAX_VERTICES + 1).unwrap_err();
        assert!(matches!(
            too_many,
            ErrorKind::TooLarge {
                what: "vertices",
                ..
            }
        ));
    }
}
