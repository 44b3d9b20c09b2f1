//! Bodies that a list of hits names: their meshes and present positions, read once.

use super::handle::World;
use super::scalar::Scalar;
use crate::bodies::BodyMesh;
use crate::error::{Error, ErrorKind};
use crate::ids::BodyId;
use std::borrow::Cow;

/// Mesh of a body, and its positions by the caller's numbers.
type Shaped<'w, S> = (&'w BodyMesh<S>, Cow<'w, [[S; 3]]>);

/// Meshes and positions of the bodies that hits name, in order of their ids.
pub(crate) struct NamedBodies<'w, S: Scalar> {
    ids: Vec<BodyId>,
    shapes: Vec<Shaped<'w, S>>,
}

impl<'w, S: Scalar> NamedBodies<'w, S> {
    /// Reads the bodies of these ids, each once. O(n) for each body.
    pub(crate) fn of(
        world: &'w World<S>,
        named: impl Iterator<Item = BodyId>,
    ) -> Result<Self, Error> {
        let mut ids: Vec<BodyId> = Vec::new();
        // Lists mostly name a body many times in a row.
        for id in named {
            if !ids.iter().rev().take(2).any(|&last| last == id) {
                ids.push(id);
            }
        }
        ids.sort_unstable();
        ids.dedup();
        let shape = |&id: &BodyId| {
            let body = world.state().body(id)?;
            Ok((body.mesh(), body.positions()))
        };
        let shapes = ids.iter().map(shape).collect::<Result<_, Error>>()?;
        Ok(Self { ids, shapes })
    }

    fn shape(&self, body: BodyId) -> &Shaped<'w, S> {
        &self.shapes[self.ids.partition_point(|&id| id < body)]
    }

    /// Vertices of a triangle.
    pub(crate) fn corners(&self, body: BodyId, triangle: u32) -> Result<[u32; 3], Error> {
        let triangles = self.shape(body).0.triangles();
        let kind = match triangles.get(triangle as usize) {
            None => ErrorKind::NoSuchTriangle {
                triangle,
                triangles: triangles.len(),
            },
            Some(&[u32::MAX, ..]) => ErrorKind::EmptyTriangle { triangle },
            Some(&corners) => return Ok(corners),
        };
        Err(refused(body, kind))
    }

    /// Vertices of an edge.
    pub(crate) fn ends(&self, body: BodyId, edge: u32) -> Result<[u32; 2], Error> {
        let edges = self.shape(body).0.edges();
        edges.get(edge as usize).copied().ok_or_else(|| {
            let edges = edges.len();
            refused(body, ErrorKind::NoSuchEdge { edge, edges })
        })
    }

    /// Numbers of the edges of a triangle, from each corner to the next. None where the two are one
    /// vertex.
    pub(crate) fn sides(&self, body: BodyId, triangle: u32) -> [Option<u32>; 3] {
        self.shape(body).0.sides(triangle)
    }

    /// Positions of vertices.
    pub(crate) fn points<const COUNT: usize>(
        &self,
        body: BodyId,
        vertices: [u32; COUNT],
    ) -> Result<[[f64; 3]; COUNT], Error> {
        let (mesh, positions) = self.shape(body);
        let mut points = [[0.0; 3]; COUNT];
        for (point, vertex) in points.iter_mut().zip(vertices) {
            let Some(position) = positions.get(vertex as usize) else {
                let vertices = positions.len();
                let kind = ErrorKind::NoSuchVertex { vertex, vertices };
                return Err(refused(body, kind));
            };
            if mesh.is_empty(vertex) {
                return Err(refused(body, ErrorKind::EmptyVertex { vertex }));
            }
            *point = position.map(Scalar::to_f64);
        }
        Ok(points)
    }
}

fn refused(body: BodyId, kind: ErrorKind) -> Error {
    let body = Some(body);
    Error { body, kind }
}
