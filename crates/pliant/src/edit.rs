//! Edits of a mesh: what is to become other, and what has.

use crate::ids::BodyId;
use std::ops::Range;

/// Changes of one body's mesh, to be made all at once or not at all.
///
/// [`World::edit`](crate::World::edit) gives one that has no steps yet; [`World::apply`](crate::World::apply) makes the changes. Each step
/// goes on from the mesh that the steps before it leave. Numbers stay: a triangle or a vertex that goes leaves its number empty, and what
/// comes is numbered behind all others, so that its numbers are known at once. An empty number is used again where a step names it.
///
/// A vertex that loses its last triangle by the edit goes at its end; one that never had any stays. One that is merged into another is
/// empty at once, and may be placed again by a later step: then it is there after the edit.
///
/// An edit is of the world that began it: no other makes its changes, not even a clone.
///
/// ```
/// use pliant::World;
///
/// // Two triangles, torn from each other along the side that they share.
/// let mut world = World::<f32>::new();
/// let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let body = world.add(&[[0, 1, 2], [0, 2, 3]], &square)?;
/// let mut edit = world.edit(body)?;
/// let a = edit.split_vertex(0, &[1]);
/// let b = edit.split_vertex(2, &[1]);
/// let edited = world.apply(&edit)?;
/// assert_eq!(edited.new_vertices, [a, b]);
/// assert_eq!(world.triangles(body)?, [[0, 1, 2], [a, b, 3]]);
/// assert_eq!(world.vertex_count(body)?, 6);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Edit<S> {
    /// Which world, among all of the process.
    pub(crate) world: u64,
    pub(crate) body: BodyId,
    /// Which mesh the numbers are of.
    pub(crate) mesh: u64,
    vertices: u32,
    triangles: u32,
    pub(crate) steps: Vec<Step<S>>,
}

/// One change, as it was asked for.
#[derive(Clone, Debug)]
pub(crate) enum Step<S> {
    AddVertices(Vec<[S; 3]>),
    PlaceVertex(u32, [S; 3]),
    SplitVertex(u32, Vec<u32>),
    MergeVertices(u32, u32),
    AddTriangles(Vec<[u32; 3]>),
    SetTriangle(u32, [u32; 3]),
    RemoveTriangles(Vec<u32>),
}

impl<S: Copy> Edit<S> {
    pub(crate) fn new(
        (world, body, mesh): (u64, BodyId, u64),
        [vertices, triangles]: [usize; 2],
    ) -> Self {
        Self {
            world,
            body,
            mesh,
            vertices: vertices as u32,
            triangles: triangles as u32,
            steps: Vec::new(),
        }
    }

    /// The body whose mesh it is.
    pub fn body(&self) -> BodyId {
        self.body
    }

    /// How many numbers of vertices there are after the steps so far.
    pub fn vertex_count(&self) -> usize {
        self.vertices as usize
    }

    /// How many numbers of triangles there are after the steps so far.
    pub fn triangle_count(&self) -> usize {
        self.triangles as usize
    }

    /// Adds a vertex; returns its number.
    pub fn add_vertex(&mut self, position: [S; 3]) -> u32 {
        self.add_vertices(&[position]).start
    }

    /// Adds vertices; returns their numbers.
    pub fn add_vertices(&mut self, positions: &[[S; 3]]) -> Range<u32> {
        self.steps.push(Step::AddVertices(positions.to_vec()));
        let first = self.vertices;
        self.vertices = first.saturating_add(positions.len() as u32);
        first..self.vertices
    }

    /// Uses an empty number of a vertex again.
    pub fn place_vertex(&mut self, vertex: u32, position: [S; 3]) {
        self.steps.push(Step::PlaceVertex(vertex, position));
    }

    /// Adds a vertex in the place where another is, which these triangles have for a corner from now on instead of the other. Returns
    /// its number. It has the group of the other.
    pub fn split_vertex(&mut self, vertex: u32, triangles: &[u32]) -> u32 {
        let step = Step::SplitVertex(vertex, triangles.to_vec());
        self.steps.push(step);
        let new = self.vertices;
        self.vertices = new.saturating_add(1);
        new
    }

    /// All triangles that have the vertex `gone` have `kept` instead from now on, which stays where it is; `gone` goes.
    pub fn merge_vertices(&mut self, kept: u32, gone: u32) {
        self.steps.push(Step::MergeVertices(kept, gone));
    }

    /// Adds a triangle; returns its number.
    pub fn add_triangle(&mut self, corners: [u32; 3]) -> u32 {
        self.add_triangles(&[corners]).start
    }

    /// Adds triangles, shape (k, 3); returns their numbers.
    pub fn add_triangles(&mut self, corners: &[[u32; 3]]) -> Range<u32> {
        self.steps.push(Step::AddTriangles(corners.to_vec()));
        let first = self.triangles;
        self.triangles = first.saturating_add(corners.len() as u32);
        first..self.triangles
    }

    /// Gives a triangle other corners, or uses an empty number again.
    pub fn set_triangle(&mut self, triangle: u32, corners: [u32; 3]) {
        self.steps.push(Step::SetTriangle(triangle, corners));
    }

    /// Takes a triangle out.
    pub fn remove_triangle(&mut self, triangle: u32) {
        self.remove_triangles(&[triangle]);
    }

    /// Takes triangles out.
    pub fn remove_triangles(&mut self, triangles: &[u32]) {
        self.steps.push(Step::RemoveTriangles(triangles.to_vec()));
    }
}

/// What an edit has changed, by number; every list ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edited {
    /// Triangles that were empty, or not there.
    pub new_triangles: Vec<u32>,
    /// Triangles that have other corners.
    pub changed_triangles: Vec<u32>,
    /// Triangles that are empty now.
    pub removed_triangles: Vec<u32>,
    /// Vertices that were empty, or not there, or that went and came again.
    pub new_vertices: Vec<u32>,
    /// Vertices that are empty now.
    pub removed_vertices: Vec<u32>,
}
