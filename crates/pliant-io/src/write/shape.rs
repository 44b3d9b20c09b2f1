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
        let malformed = |why: &str| Err(Reason::Malformed(why.into()));
        if self.frame_count == 0 {
            return Err(Reason::NoFrames);
        }
        if self.triangles.is_empty() {
            return Err(Reason::NoFaces);
        }
        let mut corners = self.triangles.as_flattened().iter();
        if corners.any(|&corner| corner as usize >= self.vertex_count) {
            return malformed("a triangle to be written has a vertex that does not exist");
        }
        if u32::try_from(self.vertex_count).is_err() || u32::try_from(self.triangles.len()).is_err()
        {
            return Err(Reason::TooMany {
                what: "vertices or triangles",
            });
        }
        let mut corners = self.outlines.values().flatten();
        if corners.any(|&corner| corner as usize >= self.vertex_count) {
            return malformed("a polygon to be written has a vertex that does not exist");
        }
        let faces = self.faces.as_ref();
        if faces.is_some_and(|faces| faces.len() != self.triangles.len()) {
            return malformed("to be written are not as many faces as triangles");
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
