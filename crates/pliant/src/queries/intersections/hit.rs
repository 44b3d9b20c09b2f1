//! Pairs of triangles, as callers get them.

use crate::ids::BodyId;
use crate::sort::{Hit, Numbered};

/// Two triangles that intersect, of two bodies or of one.
///
/// Pairs are ordered by their fields. The smaller (body, triangle) is first; but of two bodies that the query names, the one that is
/// named first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// The first body.
    pub body_a: BodyId,
    /// Its triangle, as the caller numbers it.
    pub triangle_a: u32,
    /// The second body; the first again in a body that meets itself.
    pub body_b: BodyId,
    /// Its triangle, as the caller numbers it.
    pub triangle_b: u32,
}

impl Pair {
    /// The two triangles without their bodies, for queries in which these are known.
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
