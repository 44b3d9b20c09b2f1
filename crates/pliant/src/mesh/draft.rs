//! Draft of an edit: every step is checked, and the mesh is unchanged until all steps are good.
//!
//! Cost: in proportion to the triangles and vertices that the steps name, and the triangles at
//! these vertices. The size of the mesh does not matter.

use super::topology::{EMPTY, check_counts};
use super::{Bits, Changed, Topology, TrianglesAt};
use crate::ErrorKind;
use crate::edit::Step;
use std::collections::{BTreeMap, BTreeSet};

/// Overlay of changes over a mesh: the mesh after some steps of an edit.
pub(crate) struct Draft<'m, S> {
    topology: &'m Topology,
    at: &'m TrianglesAt,
    /// Vertices that are empty before the edit.
    empty: &'m Bits,
    /// Returns the position that a vertex has before the edit.
    position_of: &'m dyn Fn(u32) -> [S; 3],
    /// How many numbers of triangles and of vertices there are by now.
    triangles: usize,
    vertices: usize,
    /// Corners of the triangles that steps have set.
    corners: BTreeMap<u32, [u32; 3]>,
    /// Pairs of a vertex and a triangle that steps gave it as a corner.
    came: BTreeSet<[u32; 2]>,
    /// Positions of vertices that are new, or placed again.
    positions: BTreeMap<u32, [S; 3]>,
    /// For vertices made by splits: the vertex before the edit that they descend from.
    split_from: BTreeMap<u32, u32>,
    /// Vertices that were merged into others.
    merged: BTreeSet<u32>,
    /// Vertices that were added or placed and have had no triangle yet.
    alone: BTreeSet<u32>,
    /// How many triangles are not empty.
    live: usize,
}

/// Result of a draft: all changes that the edit makes.
#[derive(Debug)]
pub(crate) struct Outcome<S> {
    /// Triangles whose corners change, ascending.
    pub(crate) changed: Vec<Changed>,
    /// How many numbers of triangles and of vertices there are after the edit.
    pub(crate) triangles: usize,
    pub(crate) vertices: usize,
    /// Vertices that were empty or did not exist, with their positions, ascending.
    pub(crate) new_vertices: Vec<(u32, [S; 3])>,
    /// For new vertices made by splits: the vertex before the edit that they descend from, if there
    /// is one.
    pub(crate) split_from: BTreeMap<u32, u32>,
    /// Vertices that no triangle uses any more, in order.
    pub(crate) emptied: Vec<u32>,
}

impl<'m, S: Copy> Draft<'m, S> {
    pub(crate) fn new(
        topology: &'m Topology,
        at: &'m TrianglesAt,
        empty: &'m Bits,
        position_of: &'m dyn Fn(u32) -> [S; 3],
    ) -> Self {
        Self {
            topology,
            at,
            empty,
            position_of,
            triangles: topology.triangles().len(),
            vertices: topology.vertex_count(),
            corners: BTreeMap::new(),
            came: BTreeSet::new(),
            positions: BTreeMap::new(),
            split_from: BTreeMap::new(),
            merged: BTreeSet::new(),
            alone: BTreeSet::new(),
            live: topology.live_count(),
        }
    }

    /// Applies a step, or refuses it.
    pub(crate) fn take(&mut self, step: &Step<S>) -> Result<(), ErrorKind> {
        match step {
            Step::AddVertices(positions) => {
                for &position in positions {
                    self.add_vertex(position)?;
                }
            }
            &Step::PlaceVertex(vertex, position) => {
                self.check_number(vertex)?;
                if !self.is_empty(vertex) {
                    return Err(ErrorKind::VertexInUse { vertex });
                }
                self.place(vertex, position);
            }
            Step::SplitVertex(vertex, triangles) => {
                self.check_vertex(*vertex)?;
                let new = self.add_vertex(self.position(*vertex))?;
                if let Some(from) = self.before_splits(*vertex) {
                    self.split_from.insert(new, from);
                }
                for &triangle in triangles {
                    let corners = self.live_corners(triangle)?;
                    if !corners.contains(vertex) {
                        return Err(ErrorKind::NotACorner {
                            triangle,
                            vertex: *vertex,
                        });
                    }
                    self.set(triangle, renamed(corners, *vertex, new));
                }
            }
            &Step::MergeVertices(kept, gone) => {
                self.check_vertex(kept)?;
                self.check_vertex(gone)?;
                if kept != gone {
                    let triangles: Vec<u32> = self.triangles_at(gone).collect();
                    for triangle in triangles {
                        self.set(triangle, renamed(self.corners(triangle), gone, kept));
                    }
                    self.merged.insert(gone);
                    self.alone.remove(&gone);
                }
            }
            Step::AddTriangles(all) => {
                for &corners in all {
                    let triangle = self.triangles as u32;
                    check_counts(self.triangles + 1, self.vertices)?;
                    self.check_corners(triangle, corners)?;
                    self.triangles += 1;
                    self.set(triangle, corners);
                }
            }
            &Step::SetTriangle(triangle, corners) => {
                self.check_triangle(triangle)?;
                self.check_corners(triangle, corners)?;
                self.set(triangle, corners);
            }
            Step::RemoveTriangles(triangles) => {
                for &triangle in triangles {
                    self.live_corners(triangle)?;
                    self.set(triangle, EMPTY);
                }
            }
        }
        Ok(())
    }

    /// Returns the changes of all steps; refuses if no triangle is left.
    pub(crate) fn finish(self) -> Result<Outcome<S>, ErrorKind> {
        if self.live == 0 {
            return Err(ErrorKind::NoTriangles);
        }
        let mut emptied = self.merged.clone();
        let mut changed = Vec::with_capacity(self.corners.len());
        for (&triangle, &new) in &self.corners {
            let old = self.corners_before(triangle);
            if old != new {
                changed.push((triangle, [old, new]));
                emptied.extend(old.into_iter().filter(|&vertex| vertex != u32::MAX));
            }
        }
        emptied.retain(|vertex| {
            !self.alone.contains(vertex) && self.triangles_at(*vertex).next().is_none()
        });
        Ok(Outcome {
            changed,
            triangles: self.triangles,
            vertices: self.vertices,
            new_vertices: self.positions.into_iter().collect(),
            split_from: self.split_from,
            emptied: emptied.into_iter().collect(),
        })
    }

    /// Adds a vertex behind all others; refuses if there are too many.
    fn add_vertex(&mut self, position: [S; 3]) -> Result<u32, ErrorKind> {
        check_counts(self.triangles, self.vertices + 1)?;
        let vertex = self.vertices as u32;
        self.vertices += 1;
        self.place(vertex, position);
        Ok(vertex)
    }

    /// Gives a number of a vertex a position, and with that a vertex.
    fn place(&mut self, vertex: u32, position: [S; 3]) {
        self.positions.insert(vertex, position);
        self.merged.remove(&vertex);
        self.alone.insert(vertex);
        self.split_from.remove(&vertex);
    }

    /// Returns the vertex before the edit that `vertex` is, or was split from; none if the edit
    /// added it.
    fn before_splits(&self, vertex: u32) -> Option<u32> {
        if self.positions.contains_key(&vertex) {
            return self.split_from.get(&vertex).copied();
        }
        Some(vertex)
    }

    /// Returns the position of a vertex by now.
    fn position(&self, vertex: u32) -> [S; 3] {
        let placed = self.positions.get(&vertex).copied();
        placed.unwrap_or_else(|| (self.position_of)(vertex))
    }

    /// Returns the corners of a triangle before the edit; [`EMPTY`] if it did not exist.
    fn corners_before(&self, triangle: u32) -> [u32; 3] {
        let before = self.topology.triangles().get(triangle as usize);
        before.copied().unwrap_or(EMPTY)
    }

    /// Returns the corners of a triangle by now.
    fn corners(&self, triangle: u32) -> [u32; 3] {
        let changed = self.corners.get(&triangle).copied();
        changed.unwrap_or_else(|| self.corners_before(triangle))
    }

    /// Sets the corners of a triangle; [`EMPTY`] removes it.
    fn set(&mut self, triangle: u32, corners: [u32; 3]) {
        self.live -= usize::from(self.corners(triangle) != EMPTY);
        self.live += usize::from(corners != EMPTY);
        if corners != EMPTY {
            for vertex in corners {
                self.came.insert([vertex, triangle]);
                self.alone.remove(&vertex);
            }
        }
        self.corners.insert(triangle, corners);
    }

    /// Returns the triangles that have a vertex by now, some of them more than once.
    fn triangles_at(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let before = self.at.of(vertex);
        let came = self.came.range([vertex, 0]..=[vertex, u32::MAX]);
        let all = before.chain(came.map(|&[_, triangle]| triangle));
        all.filter(move |&triangle| self.corners(triangle).contains(&vertex))
    }

    /// Whether a number of a vertex is empty by now.
    fn is_empty(&self, vertex: u32) -> bool {
        self.merged.contains(&vertex)
            || self.empty.has(vertex) && !self.positions.contains_key(&vertex)
    }

    /// Refuses a number of a vertex that does not exist.
    fn check_number(&self, vertex: u32) -> Result<(), ErrorKind> {
        let vertices = self.vertices;
        if vertex as usize >= vertices {
            return Err(ErrorKind::NoSuchVertex { vertex, vertices });
        }
        Ok(())
    }

    /// Refuses a number that does not exist or is empty.
    fn check_vertex(&self, vertex: u32) -> Result<(), ErrorKind> {
        self.check_number(vertex)?;
        if self.is_empty(vertex) {
            return Err(ErrorKind::EmptyVertex { vertex });
        }
        Ok(())
    }

    /// Refuses a number of a triangle that does not exist.
    fn check_triangle(&self, triangle: u32) -> Result<(), ErrorKind> {
        let triangles = self.triangles;
        if triangle as usize >= triangles {
            return Err(ErrorKind::NoSuchTriangle {
                triangle,
                triangles,
            });
        }
        Ok(())
    }

    /// Returns the corners of a triangle; refuses a number that does not exist or is empty.
    fn live_corners(&self, triangle: u32) -> Result<[u32; 3], ErrorKind> {
        self.check_triangle(triangle)?;
        let corners = self.corners(triangle);
        if corners == EMPTY {
            return Err(ErrorKind::EmptyTriangle { triangle });
        }
        Ok(corners)
    }

    /// Refuses corners that are no vertices.
    fn check_corners(&self, triangle: u32, corners: [u32; 3]) -> Result<(), ErrorKind> {
        for vertex in corners {
            if vertex as usize >= self.vertices {
                return Err(ErrorKind::VertexOutOfRange {
                    triangle: triangle as usize,
                    vertex,
                    vertices: self.vertices,
                });
            }
            self.check_vertex(vertex)?;
        }
        Ok(())
    }
}

/// Replaces one vertex among corners by another.
fn renamed(corners: [u32; 3], from: u32, to: u32) -> [u32; 3] {
    corners.map(|vertex| if vertex == from { to } else { vertex })
}
