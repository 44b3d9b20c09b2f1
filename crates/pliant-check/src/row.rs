//! A pair of triangles, as answers have it.

/// Body, triangle, body, triangle; the smaller (body, triangle) first.
pub type Row = [u32; 4];
