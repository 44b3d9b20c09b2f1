//! Changes of meshes, and the events of a scene.

/// A change of the mesh of a body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// Appends this many vertices, numbered behind all others.
    AddVertices(usize),
    /// Reuses the empty number of a vertex.
    PlaceVertex(u32),
    /// Splits a vertex: appends a copy of it, which replaces it in some triangles.
    SplitVertex {
        /// The vertex that is split.
        vertex: u32,
        /// Triangles that get the copy.
        triangles: Vec<u32>,
    },
    /// Merges two vertices.
    MergeVertices {
        /// The vertex that stays.
        kept: u32,
        /// The vertex that goes.
        gone: u32,
    },
    /// Appends triangles, numbered behind all others.
    AddTriangles(Vec<[u32; 3]>),
    /// Replaces the corners of a triangle, or reuses an empty number.
    SetTriangle {
        /// Number of the triangle.
        triangle: u32,
        /// New corners.
        corners: [u32; 3],
    },
    /// Removes triangles, and the vertices that no other triangle has.
    RemoveTriangles(Vec<u32>),
}

/// An event at the beginning of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// The mesh of a body changes.
    Edit {
        /// Number of the body.
        body: usize,
        /// The changes, in order. [`ChangingScene::positions`](crate::ChangingScene::positions)
        /// gives the positions of new vertices at the step.
        changes: Vec<Change>,
    },
    /// One body is appended to another, in order, and ceases to exist.
    Fuse {
        /// The body that stays.
        kept: usize,
        /// The body that is appended.
        gone: usize,
    },
}
