//! Pairs of triangles as callers get them.

use crate::ids::BodyId;
use crate::sort::{Hit, Numbered};

/// Two triangles that intersect, of two bodies or of one.
///
/// Ordered by its fields. The smaller (body, triangle) is first. But if the query names two bodies,
/// the one named first is first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// Body of the first triangle.
    pub body_a: BodyId,
    /// First triangle, with the caller's number.
    pub triangle_a: u32,
    /// Body of the second triangle. It equals `body_a` in a body that meets itself.
    pub body_b: BodyId,
    /// Second triangle, with the caller's number.
    pub triangle_b: u32,
}

impl Pair {
    /// The two triangles without their bodies, for queries in which the bodies are known.
    pub fn triangles(&self) -> [u32; 2] {
        [self.triangle_a, self.triangle_b]
    }
}

/// As a row of numbers: body, triangle, body, triangle.
impl From<Pair> for [u32; 4] {
    fn from(pair: Pair) -> Self {
        pair.numbers()
    }
}

/// From a row of numbers: body, triangle, body, triangle.
impl From<[u32; 4]> for Pair {
    fn from(row: [u32; 4]) -> Self {
        Self::of_numbers(row)
    }
}

impl Numbered for Pair {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        [
            self.body_a.0,
            self.triangle_a,
            self.body_b.0,
            self.triangle_b,
        ]
    }
}

impl Hit for Pair {
    #[inline]
    fn of_numbers([body_a, triangle_a, body_b, triangle_b]: [u32; 4]) -> Self {
        Self {
            body_a: BodyId(body_a),
            triangle_a,
            body_b: BodyId(body_b),
            triangle_b,
        }
    }
}
