//! What a reader fills: the vertices and polygons of one frame, checked as they come.
//!
//! The first frame of a body fixes its precision, its faces and its number of vertices; the later
//! ones are held to them. Readers need not know which they read.

use std::path::PathBuf;

use crate::error::{Fault, Place, Reason};
use crate::polygons::Polygons;
use crate::positions::{Positions, Precision, Vertices};

/// One frame, reused for all frames of a body.
#[derive(Debug)]
pub(crate) struct Frame {
    vertices: Vertices,
    polygons: Polygons,
    first: Option<First>,
}

/// What later frames are held to.
#[derive(Debug)]
struct First {
    file: PathBuf,
    vertices: usize,
}

/// The proof that a reader came to the end of its frame and that the frame is whole; made by
/// [`Frame::complete`] alone.
#[derive(Debug)]
#[must_use]
pub(crate) struct Complete(());

impl Frame {
    /// `limit`: the bytes that the positions, and the connectivity, may take.
    pub(crate) fn new(limit: u64) -> Self {
        Self {
            vertices: Vertices::new(limit),
            polygons: Polygons::new(limit),
            first: None,
        }
    }

    /// Begins a frame whose file has coordinates of `precision` and announces `count` vertices (0:
    /// it does not say).
    pub(crate) fn begin(&mut self, precision: Precision, count: u64) -> Result<(), Reason> {
        match &self.first {
            None => self.vertices.set_precision(precision),
            Some(first) if precision > self.vertices.precision() => {
                let than = first.file.clone();
                return Err(Reason::Precision { than });
            }
            Some(_) => {}
        }
        self.polygons.rewind();
        self.vertices.clear(count)
    }

    /// Takes the next vertex.
    pub(crate) fn vertex(&mut self, position: [f64; 3]) -> Result<(), Reason> {
        self.vertices.push(position)
    }

    /// Takes the next polygon, corners counted from zero, their range checked when the frame is
    /// complete; `place` is where it is written.
    pub(crate) fn face(
        &mut self,
        corners: &[u32],
        place: impl FnOnce() -> Place,
    ) -> Result<(), Reason> {
        let face = self.polygons.next_face();
        match (self.polygons.push(corners, place)?, &self.first) {
            (false, Some(first)) => {
                let than = first.file.clone();
                Err(Reason::FacesDiffer { face, than })
            }
            _ => Ok(()),
        }
    }

    /// Says that the polygons of this frame are those already read.
    pub(crate) fn same_faces(&mut self) {
        self.polygons.repeat();
    }

    /// Ends a frame. `first_index` is the file's number of its first vertex: 0, in OBJ 1.
    pub(crate) fn complete(&mut self, first_index: i64) -> Result<Complete, Fault> {
        let vertices = self.vertices.len();
        let (faces, expected) = self.polygons.counts();
        if vertices == 0 {
            return Err(Reason::NoVertices.into());
        }
        if faces == 0 {
            return Err(Reason::NoFaces.into());
        }
        // Before the range of indices: where vertices are missing, "too few vertices" says more
        // than "index out of range".
        if let Some(First {
            file,
            vertices: before,
        }) = &self.first
        {
            let than = file.clone();
            if vertices != *before {
                let (vertices, expected) = (vertices as u64, *before as u64);
                return Err(Reason::VertexCount {
                    vertices,
                    expected,
                    than,
                }
                .into());
            }
            if faces != expected {
                return Err(Reason::FaceCount {
                    faces,
                    expected,
                    than,
                }
                .into());
            }
        }
        self.polygons.check_range(vertices, first_index)?;
        Ok(Complete(()))
    }

    /// Holds all later frames to this one, which came from `file`.
    pub(crate) fn becomes_first(&mut self, file: PathBuf) {
        let vertices = self.vertices.len();
        self.first = Some(First { file, vertices });
        self.polygons.compare_from_now_on();
    }

    /// The number of the next vertex: how many there are so far.
    pub(crate) fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// The number of the next face of this frame.
    pub(crate) fn next_face(&self) -> u64 {
        self.polygons.next_face()
    }

    pub(crate) fn positions(&self) -> Positions<'_> {
        self.vertices.positions()
    }

    pub(crate) fn precision(&self) -> Precision {
        self.vertices.precision()
    }

    pub(crate) fn polygons(&self) -> &Polygons {
        &self.polygons
    }
}
