//! Union-find over vertices of intersecting triangles: a triangle joins its corners, a pair its
//! triangles.
//!
//! A triangle with a pair is a *hit*. Its vertices get *slots*, numbered as they come, on which
//! union-find works. Memory: four bytes for each vertex and triangle of a source with hits, kept.
//! Also 12 bytes for each vertex of a hit, until cleared.

use crate::pieces::NONE;
use crate::row::Row;
use crate::union_find::{find, join};

/// Access to meshes and positions. Sources and their triangles are numbered as in pairs.
pub trait Meshes {
    /// Number of vertices and number of triangles of a source.
    fn sizes(&self, source: u32) -> [usize; 2];
    /// Vertices of a triangle.
    fn corners(&self, source: u32, triangle: u32) -> [u32; 3];
    /// Position of a vertex.
    fn position(&self, source: u32, vertex: u32) -> [f64; 3];
    /// Body of a triangle in answers: the source, if that is not split.
    fn body(&self, source: u32, _triangle: u32) -> u32 {
        source
    }
}

/// Vertices of hits, joined into connected sets.
#[derive(Debug, Default)]
pub(crate) struct Joined {
    sources: Vec<Slots>,
    /// Source and vertex of each slot.
    vertices: Vec<[u32; 2]>,
    parents: Vec<u32>,
    /// Source and triangle of each hit.
    triangles: Vec<[u32; 2]>,
}

/// Slots of one source.
#[derive(Debug, Default)]
struct Slots {
    /// Slot of each vertex, or [`NONE`].
    of_vertices: Vec<u32>,
    /// Slot of the first corner of each hit, else [`NONE`].
    of_triangles: Vec<u32>,
}

impl Joined {
    /// Forgets all hits.
    pub(crate) fn clear(&mut self) {
        for [source, vertex] in self.vertices.drain(..) {
            self.sources[source as usize].of_vertices[vertex as usize] = NONE;
        }
        for [source, triangle] in self.triangles.drain(..) {
            self.sources[source as usize].of_triangles[triangle as usize] = NONE;
        }
        self.parents.clear();
    }

    /// Joins a pair of triangles of sources and returns the slot of the first triangle's first
    /// corner.
    ///
    /// `None` if the meshes lack a triangle or vertex of the pair.
    pub(crate) fn join(&mut self, meshes: &impl Meshes, of_sources: Row) -> Option<u32> {
        let [source_a, a, source_b, b] = of_sources;
        let of_a = self.take(meshes, source_a, a)?;
        let of_b = self.take(meshes, source_b, b)?;
        join(&mut self.parents, of_a, of_b);
        Some(of_a)
    }

    /// Joins the corners of a triangle and returns the slot of the first.
    fn take(&mut self, meshes: &impl Meshes, source: u32, triangle: u32) -> Option<u32> {
        let place = source as usize;
        if place >= self.sources.len() {
            self.sources.resize_with(place + 1, Slots::default);
        }
        let slots = &mut self.sources[place];
        let known = slots.of_triangles.get(triangle as usize);
        if let Some(&slot) = known.filter(|&&slot| slot != NONE) {
            return Some(slot);
        }
        let [vertices, triangles] = meshes.sizes(source);
        if triangle as usize >= triangles {
            return None;
        }
        let corners = meshes.corners(source, triangle);
        if corners.iter().any(|&vertex| vertex as usize >= vertices) {
            return None;
        }
        // All entries are `NONE` since the last clear, whatever mesh the source had.
        if slots.of_triangles.len() < triangles {
            slots.of_triangles.resize(triangles, NONE);
        }
        if slots.of_vertices.len() < vertices {
            slots.of_vertices.resize(vertices, NONE);
        }
        let of_corners = corners.map(|vertex| {
            let slot = &mut slots.of_vertices[vertex as usize];
            if *slot == NONE {
                *slot = self.parents.len() as u32;
                self.parents.push(*slot);
                self.vertices.push([source, vertex]);
            }
            *slot
        });
        slots.of_triangles[triangle as usize] = of_corners[0];
        self.triangles.push([source, triangle]);
        join(&mut self.parents, of_corners[0], of_corners[1]);
        join(&mut self.parents, of_corners[1], of_corners[2]);
        Some(of_corners[0])
    }

    /// Source and vertex of each slot.
    pub(crate) fn vertices(&self) -> &[[u32; 2]] {
        &self.vertices
    }

    /// Source and triangle of each hit.
    pub(crate) fn triangles(&self) -> &[[u32; 2]] {
        &self.triangles
    }

    /// Slot of a vertex; `None` if it is of no hit.
    pub(crate) fn slot(&self, source: u32, vertex: u32) -> Option<u32> {
        let slots = self.sources.get(source as usize)?;
        let slot = slots.of_vertices.get(vertex as usize)?;
        Some(*slot).filter(|&slot| slot != NONE)
    }

    /// Slot of the first corner of a hit.
    pub(crate) fn slot_of_triangle(&self, source: u32, triangle: u32) -> u32 {
        self.sources[source as usize].of_triangles[triangle as usize]
    }

    /// Root of the set of a slot: its smallest slot.
    pub(crate) fn root(&mut self, slot: u32) -> u32 {
        find(&mut self.parents, slot)
    }
}
