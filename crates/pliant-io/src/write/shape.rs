//! Shape of the data to write: a mesh, and the number of its frames.

use std::collections::BTreeMap;

use crate::error::Reason;
use crate::positions::Precision;

/// The mesh, number of frames and precision of a body to write.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Triangles; every index is below [`vertex_count`](Self::vertex_count).
    pub triangles: Vec<[u32; 3]>,
    /// Polygon of each triangle; None where every polygon is a triangle.
    pub faces: Option<Vec<u32>>,
    /// Corners of the polygons that are no fans, by their number in [`faces`](Self::faces).
    ///
    /// A fan's triangles all contain the first corner.
    pub outlines: BTreeMap<u32, Vec<u32>>,
    /// Number of vertices of a frame.
    pub vertex_count: usize,
    /// Number of frames that will be written.
    pub frame_count: usize,
    /// Type of the coordinates.
    pub precision: Precision,
}

impl Shape {
    /// Returns an error if the parts do not agree.
    pub(super) fn check(&self) -> Result<(), Reason> {
        let malformed = |why: String| Err(Reason::Malformed(why));
        let vertices = self.vertex_count;
        let is_beyond = |corner: &&u32| **corner as usize >= vertices;
        if self.frame_count == 0 {
            return Err(Reason::NoFrames);
        }
        if self.triangles.is_empty() {
            return Err(Reason::NoFaces);
        }
        for (number, triangle) in self.triangles.iter().enumerate() {
            if let Some(vertex) = triangle.iter().find(is_beyond) {
                return malformed(format!(
                    "triangle {number} uses vertex {vertex}; the shape has {vertices} vertices"
                ));
            }
        }
        if u32::try_from(self.vertex_count).is_err() || u32::try_from(self.triangles.len()).is_err()
        {
            return Err(Reason::TooMany {
                what: "vertices or triangles",
            });
        }
        for (number, outline) in &self.outlines {
            if let Some(vertex) = outline.iter().find(is_beyond) {
                return malformed(format!(
                    "polygon {number} uses vertex {vertex}; the shape has {vertices} vertices"
                ));
            }
        }
        let triangles = self.triangles.len();
        if let Some(faces) = &self.faces
            && faces.len() != triangles
        {
            return malformed(format!(
                "`faces` has {} entries for {triangles} triangles; it needs one for each",
                faces.len()
            ));
        }
        Ok(())
    }

    /// Calls `each` with the corners of every polygon: from its fan, or from its outline.
    pub(super) fn each_polygon<E>(
        &self,
        mut each: impl FnMut(&[u32]) -> Result<(), E>,
    ) -> Result<(), E> {
        let Some(faces) = &self.faces else {
            return self.triangles.iter().try_for_each(|corners| each(corners));
        };
        let mut polygon = Vec::new();
        let mut begin = 0;
        for same in faces.chunk_by(|a, b| a == b) {
            let fan = &self.triangles[begin..begin + same.len()];
            begin += same.len();
            if let Some(outline) = self.outlines.get(&same[0]) {
                each(outline)?;
                continue;
            }
            polygon.clear();
            polygon.extend(fan[0]);
            polygon.extend(fan[1..].iter().map(|corners| corners[2]));
            each(&polygon)?;
        }
        Ok(())
    }
}
