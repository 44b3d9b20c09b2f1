//! Vertices that hits join: triangles join their corners, pairs join their triangles.
//!
//! Vertices of triangles that are hit have *slots*, numbered as they come, which union-find joins. It takes four bytes a vertex and a triangle
//! of sources that are hit, for ever, and 12 a vertex that is hit, until they are forgotten.

use crate::pieces::NONE;
use crate::row::Row;
use crate::union_find::{find, join};

/// Where triangles are. Sources and their triangles are numbered as in pairs.
pub trait Meshes {
    /// How many vertices a source has, and how many triangles.
    fn sizes(&self, source: u32) -> [usize; 2];
    /// The vertices of a triangle.
    fn corners(&self, source: u32, triangle: u32) -> [u32; 3];
    /// Where a vertex is.
    fn position(&self, source: u32, vertex: u32) -> [f64; 3];
    /// What a triangle is a part of in answers: the source, where that is not split.
    fn body(&self, source: u32, _triangle: u32) -> u32 {
        source
    }
}

/// The vertices of triangles that are hit.
#[derive(Debug, Default)]
pub(crate) struct Joined {
    sources: Vec<Slots>,
    /// Source and vertex of each slot.
    vertices: Vec<[u32; 2]>,
    leaders: Vec<u32>,
    /// Source and triangle.
    triangles: Vec<[u32; 2]>,
}

/// Of one source.
#[derive(Debug, Default)]
struct Slots {
    /// For each vertex its slot, or none.
    of_vertices: Vec<u32>,
    /// For each triangle that of its first corner, once it was seen.
    of_triangles: Vec<u32>,
}

impl Joined {
    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        for [source, vertex] in self.vertices.drain(..) {
            self.sources[source as usize].of_vertices[vertex as usize] = NONE;
        }
        for [source, triangle] in self.triangles.drain(..) {
            self.sources[source as usize].of_triangles[triangle as usize] = NONE;
        }
        self.leaders.clear();
    }

    /// Joins a pair of triangles of sources, and says the slot of the first corner of the first; `None` for one that the meshes have not.
    pub(crate) fn join(&mut self, meshes: &impl Meshes, of_sources: Row) -> Option<u32> {
        let [source_a, a, source_b, b] = of_sources;
        let of_a = self.take(meshes, source_a, a)?;
        let of_b = self.take(meshes, source_b, b)?;
        join(&mut self.leaders, of_a, of_b);
        Some(of_a)
    }

    /// The slot of a triangle's first corner, joined with those of the others.
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
        // Everything in them was taken back at the end of the frame before, whatever mesh that had.
        if slots.of_triangles.len() < triangles {
            slots.of_triangles.resize(triangles, NONE);
        }
        if slots.of_vertices.len() < vertices {
            slots.of_vertices.resize(vertices, NONE);
        }
        let of_corners = corners.map(|vertex| {
            let slot = &mut slots.of_vertices[vertex as usize];
            if *slot == NONE {
                *slot = self.leaders.len() as u32;
                self.leaders.push(*slot);
                self.vertices.push([source, vertex]);
            }
            *slot
        });
        slots.of_triangles[triangle as usize] = of_corners[0];
        self.triangles.push([source, triangle]);
        join(&mut self.leaders, of_corners[0], of_corners[1]);
        join(&mut self.leaders, of_corners[1], of_corners[2]);
        Some(of_corners[0])
    }

    /// Source and vertex of each slot.
    pub(crate) fn vertices(&self) -> &[[u32; 2]] {
        &self.vertices
    }

    /// Source and number of each triangle.
    pub(crate) fn triangles(&self) -> &[[u32; 2]] {
        &self.triangles
    }

    /// The slot of a vertex that is hit.
    pub(crate) fn slot(&self, source: u32, vertex: u32) -> Option<u32> {
        let slots = self.sources.get(source as usize)?;
        let slot = slots.of_vertices.get(vertex as usize)?;
        Some(*slot).filter(|&slot| slot != NONE)
    }

    /// The slot of the first corner of a triangle that is hit.
    pub(crate) fn slot_of_triangle(&self, source: u32, triangle: u32) -> u32 {
        self.sources[source as usize].of_triangles[triangle as usize]
    }

    /// The smallest of all slots that are joined with one.
    pub(crate) fn leader(&mut self, slot: u32) -> u32 {
        find(&mut self.leaders, slot)
    }
}
