//! A mesh to which events are applied, for users that rebuild whatever they change.

use super::change::Change;
use std::collections::BTreeSet;

/// Triangles over vertices; numbers of either may be empty.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ChangingMesh {
    /// Corners by number; [`EMPTY`](Self::EMPTY) where there is no triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Count of vertex numbers, empty ones included.
    pub vertices: usize,
}

impl ChangingMesh {
    /// Corners of an empty number.
    pub const EMPTY: [u32; 3] = [u32::MAX; 3];

    /// A mesh of triangles over `vertices` vertices.
    pub fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        Self {
            triangles: triangles.to_vec(),
            vertices,
        }
    }

    /// Applies changes of a scene with the numbers of this mesh.
    ///
    /// Takes O(changes); merging vertices takes O(triangles).
    ///
    /// # Panics
    ///
    /// If a number does not exist.
    pub fn change(&mut self, changes: &[Change]) {
        for change in changes {
            match change {
                Change::AddVertices(count) => self.vertices += count,
                Change::PlaceVertex(_) => {}
                Change::SplitVertex { vertex, triangles } => {
                    let new = self.vertices as u32;
                    self.vertices += 1;
                    for &triangle in triangles {
                        rename(&mut self.triangles[triangle as usize], *vertex, new);
                    }
                }
                Change::MergeVertices { kept, gone } => {
                    for corners in &mut self.triangles {
                        rename(corners, *gone, *kept);
                    }
                }
                Change::AddTriangles(triangles) => self.triangles.extend(triangles),
                Change::SetTriangle { triangle, corners } => {
                    self.triangles[*triangle as usize] = *corners;
                }
                Change::RemoveTriangles(triangles) => {
                    for &triangle in triangles {
                        self.triangles[triangle as usize] = Self::EMPTY;
                    }
                }
            }
        }
    }

    /// Appends another mesh to this one.
    pub fn append(&mut self, other: &Self) {
        let by = self.vertices as u32;
        let moved = |corners: &[u32; 3]| {
            if *corners == Self::EMPTY {
                Self::EMPTY
            } else {
                corners.map(|vertex| by + vertex)
            }
        };
        self.triangles.extend(other.triangles.iter().map(moved));
        self.vertices += other.vertices;
    }

    /// The mesh without empty numbers: triangles, their old numbers, and the old numbers of
    /// vertices.
    ///
    /// Takes O(n log n).
    pub fn compact(&self) -> (Vec<[u32; 3]>, Vec<u32>, Vec<u32>) {
        let live = (0..).zip(&self.triangles);
        let live = live.filter(|(_, corners)| **corners != Self::EMPTY);
        let (numbers, triangles): (Vec<u32>, Vec<[u32; 3]>) = live.unzip();
        let used: BTreeSet<u32> = triangles.as_flattened().iter().copied().collect();
        let vertices: Vec<u32> = used.into_iter().collect();
        let mut places = vec![0; self.vertices];
        for (place, &vertex) in (0..).zip(&vertices) {
            places[vertex as usize] = place;
        }
        let renamed = |corners: [u32; 3]| corners.map(|vertex| places[vertex as usize]);
        let triangles = triangles.into_iter().map(renamed).collect();
        (triangles, numbers, vertices)
    }
}

fn rename(corners: &mut [u32; 3], from: u32, to: u32) {
    *corners = corners.map(|vertex| if vertex == from { to } else { vertex });
}
