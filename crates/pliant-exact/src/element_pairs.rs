//! The fifteen pairs of elements of two triangles: each corner and the other triangle, each edge
//! and each edge.
//!
//! The distance of two triangles that do not intersect is the least distance of these pairs, for
//! any triangles. Let two convex sets be closest. Then neither point is inside a face unless the
//! other is a corner, or may be moved until it is one. The latter is so between parallel faces or
//! edges.

/// The number of pairs.
pub const ELEMENT_PAIRS: usize = 15;
/// The number of the first pair of edges; the pairs before are of a corner and a triangle.
pub const FIRST_OF_EDGES: usize = 6;

/// The elements of a pair of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Elements {
    /// A corner of the first triangle, and the second.
    CornerOfFirst(usize),
    /// A corner of the second triangle, and the first.
    CornerOfSecond(usize),
    /// An edge of either: that from the corner with its number to the next.
    Edges([usize; 2]),
}

/// The elements of a pair by its number.
#[inline]
fn elements(which: usize) -> Elements {
    match which {
        0..3 => Elements::CornerOfFirst(which),
        3..6 => Elements::CornerOfSecond(which - 3),
        _ => Elements::Edges([(which - 6) / 3 % 3, (which - 6) % 3]),
    }
}

const NEXT: [usize; 3] = [1, 2, 0];

/// Four corners of a pair: a corner and the other triangle, or the ends of two edges, one of each
/// triangle. `which` is below [`ELEMENT_PAIRS`].
#[inline]
pub fn four_corners<T: Copy>(which: usize, a: &[T; 3], b: &[T; 3]) -> [T; 4] {
    match elements(which) {
        Elements::CornerOfFirst(i) => [a[i], b[0], b[1], b[2]],
        Elements::CornerOfSecond(i) => [b[i], a[0], a[1], a[2]],
        Elements::Edges([i, j]) => [a[i], a[NEXT[i]], b[j], b[NEXT[j]]],
    }
}

/// Whether the first element of a pair is of the second triangle.
#[inline]
pub fn is_swapped(which: usize) -> bool {
    matches!(elements(which), Elements::CornerOfSecond(_))
}

/// The weights of the corners of either triangle in points that are some way along the elements of
/// a pair.
///
/// In a triangle a, b, c the point is a + x (b - a) + y (c - a). On two edges it is the part x of
/// the first and y of the second.
pub fn barycentric(which: usize, [x, y]: [f64; 2]) -> [[f64; 3]; 2] {
    match elements(which) {
        // A corner is an end of an edge.
        Elements::CornerOfFirst(i) => [on_edge(i, 0.0), in_triangle([x, y])],
        Elements::CornerOfSecond(i) => [in_triangle([x, y]), on_edge(i, 0.0)],
        Elements::Edges([i, j]) => [on_edge(i, x), on_edge(j, y)],
    }
}

/// The weights of the corners of a triangle a, b, c in the point a + x (b - a) + y (c - a).
pub(super) fn in_triangle([x, y]: [f64; 2]) -> [f64; 3] {
    [(1.0 - x - y).max(0.0), x, y]
}

/// The weights of the corners of a triangle in the point that is the part `along` of an edge.
pub fn on_edge(edge: usize, along: f64) -> [f64; 3] {
    let mut counts = [0.0; 3];
    counts[edge] = 1.0 - along;
    counts[NEXT[edge]] = along;
    counts
}
