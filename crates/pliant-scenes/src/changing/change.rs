//! What happens to meshes.

/// Something that happens to the mesh of a body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// So many vertices come, numbered behind all others.
    AddVertices(usize),
    /// An empty number of a vertex is used again.
    PlaceVertex(u32),
    /// A vertex comes where another is, which these triangles have for a corner from now on.
    SplitVertex {
        /// The other.
        vertex: u32,
        /// Those that leave it.
        triangles: Vec<u32>,
    },
    /// Two vertices become one.
    MergeVertices {
        /// The one that stays.
        kept: u32,
        /// The one that goes.
        gone: u32,
    },
    /// Triangles come, numbered behind all others.
    AddTriangles(Vec<[u32; 3]>),
    /// A triangle has other corners, or an empty number is used again.
    SetTriangle {
        /// Its number.
        triangle: u32,
        /// Its corners.
        corners: [u32; 3],
    },
    /// Triangles go, and with them the vertices that no other triangle has.
    RemoveTriangles(Vec<u32>),
}

/// Something that happens at the beginning of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// The mesh of a body changes.
    Edit {
        /// Its number.
        body: usize,
        /// In this order. Vertices that come are where [`ChangingScene::positions`](crate::ChangingScene::positions) says for the step.
        changes: Vec<Change>,
    },
    /// What one body has comes behind what another has, in order, and that body is no more.
    Fuse {
        /// The body that stays.
        kept: usize,
        /// The other.
        gone: usize,
    },
}
