//! Edits of a mesh: a list of steps as the caller asks for them, and what applying it has changed.

use crate::ids::BodyId;
use std::ops::Range;

/// Edit of one body's mesh: a list of steps, applied all at once or not at all.
///
/// [`World::edit`](crate::World::edit) begins one without steps;
/// [`World::apply`](crate::World::apply) makes the changes. Each step goes on from the mesh that
/// the steps before it leave.
///
/// Numbers stay. A triangle or vertex that goes leaves its number empty. A new one is numbered
/// behind all others, so its number is known at once. An empty number is used again where a step
/// names it.
///
/// A vertex that loses its last triangle by the edit goes at the end of the edit; one that never
/// had any stays. A vertex that is merged into another is empty at once. A later step may place it
/// again; then it is there after the edit.
///
/// An edit belongs to the world that began it. No other world applies it, not even a clone.
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
    /// Number of the world, unique in the process.
    pub(crate) world: u64,
    pub(crate) body: BodyId,
    /// Version of the mesh that the numbers belong to.
    pub(crate) mesh: u64,
    vertices: u32,
    triangles: u32,
    pub(crate) steps: Vec<Step<S>>,
}

/// Step of an edit, as it was asked for.
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

    /// The body that this edit is for.
    pub fn body(&self) -> BodyId {
        self.body
    }

    /// Count of vertex numbers after the steps so far, empty ones included.
    pub fn vertex_count(&self) -> usize {
        self.vertices as usize
    }

    /// Count of triangle numbers after the steps so far, empty ones included.
    pub fn triangle_count(&self) -> usize {
        self.triangles as usize
    }

    /// Adds a vertex at a position, in the unit of the body's positions. Returns its number.
    pub fn add_vertex(&mut self, position: [S; 3]) -> u32 {
        self.add_vertices(&[position]).start
    }

    /// Adds vertices at positions, shape (k, 3). Returns their numbers.
    pub fn add_vertices(&mut self, positions: &[[S; 3]]) -> Range<u32> {
        self.steps.push(Step::AddVertices(positions.to_vec()));
        let first = self.vertices;
        self.vertices = first.saturating_add(positions.len() as u32);
        first..self.vertices
    }

    /// Places a vertex under an empty number, which is so used again.
    ///
    /// [`World::apply`](crate::World::apply) refuses a number that is not empty.
    pub fn place_vertex(&mut self, vertex: u32, position: [S; 3]) {
        self.steps.push(Step::PlaceVertex(vertex, position));
    }

    /// Splits a vertex: adds a new one in the same place, and gives it to some triangles instead.
    ///
    /// These must have `vertex` for a corner; they have the new one from now on. Returns the number
    /// of the new vertex, which is in the same group.
    pub fn split_vertex(&mut self, vertex: u32, triangles: &[u32]) -> u32 {
        let step = Step::SplitVertex(vertex, triangles.to_vec());
        self.steps.push(step);
        let new = self.vertices;
        self.vertices = new.saturating_add(1);
        new
    }

    /// Merges two vertices: all triangles that have `gone` have `kept` from now on.
    ///
    /// `kept` stays where it is, and the number `gone` is empty.
    pub fn merge_vertices(&mut self, kept: u32, gone: u32) {
        self.steps.push(Step::MergeVertices(kept, gone));
    }

    /// Adds a triangle with these corners. Returns its number.
    pub fn add_triangle(&mut self, corners: [u32; 3]) -> u32 {
        self.add_triangles(&[corners]).start
    }

    /// Adds triangles, shape (k, 3). Returns their numbers.
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

    /// Removes a triangle, which leaves its number empty.
    pub fn remove_triangle(&mut self, triangle: u32) {
        self.remove_triangles(&[triangle]);
    }

    /// Removes triangles, which leave their numbers empty.
    pub fn remove_triangles(&mut self, triangles: &[u32]) {
        self.steps.push(Step::RemoveTriangles(triangles.to_vec()));
    }
}

/// Changes that an edit has made, by number; every list is ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edited {
    /// Triangles that are new: their numbers were empty, or did not exist.
    pub new_triangles: Vec<u32>,
    /// Triangles that have other corners than before.
    pub changed_triangles: Vec<u32>,
    /// Triangles that were removed: their numbers are empty now.
    pub removed_triangles: Vec<u32>,
    /// Vertices that are new: their numbers were empty, or did not exist, or were emptied and
    /// placed again.
    pub new_vertices: Vec<u32>,
    /// Vertices that were removed: their numbers are empty now.
    pub removed_vertices: Vec<u32>,
}
