//! Pairs of triangles in answers.

/// A pair of triangles: body, triangle, body, triangle. The smaller (body, triangle) is first.
pub type Row = [u32; 4];
