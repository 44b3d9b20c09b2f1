//! Pieces of a mesh: its connected components by union-find, or given sets of triangles.
//!
//! Triangles that share a vertex are of one connected piece. They are numbered in the order of
//! their first triangles. Memory: eight bytes a vertex while pieces are found; then four a triangle
//! and twelve a piece. Given sets take as much. So a mesh of 100,000 single triangles is no danger.

use crate::union_find::{find, join};

/// Sentinel for no piece. Never a number of a vertex, triangle or piece.
pub(crate) const NONE: u32 = u32::MAX;

/// Pieces of one mesh.
#[derive(Debug, Default)]
pub(crate) struct Pieces {
    /// Piece of each triangle, or [`NONE`].
    pub(crate) of_triangles: Vec<u32>,
    pub(crate) all: Vec<Piece>,
}

/// Facts about one piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    /// Number of vertices of its triangles.
    pub(crate) vertices: u32,
    pub(crate) triangles: u32,
    pub(crate) first_triangle: u32,
}

impl Pieces {
    /// Finds the connected components. Every corner is below `vertices`. Amortised O(t log v) for t
    /// triangles and v vertices.
    pub(crate) fn of(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let mut parents: Vec<u32> = (0..vertices as u32).collect();
        for &[a, b, c] in triangles {
            join(&mut parents, a, b);
            join(&mut parents, b, c);
        }
        let mut piece_of_vertex = vec![NONE; vertices];
        let mut pieces = Self {
            of_triangles: Vec::with_capacity(triangles.len()),
            all: Vec::new(),
        };
        for (&[a, b, c], triangle) in triangles.iter().zip(0..) {
            let root = find(&mut parents, a);
            let mut number = piece_of_vertex[root as usize];
            if number == NONE {
                number = pieces.all.len() as u32;
                pieces.all.push(Piece {
                    vertices: 0,
                    triangles: 0,
                    first_triangle: triangle,
                });
            }
            let piece = &mut pieces.all[number as usize];
            piece.triangles += 1;
            for vertex in [root, a, b, c] {
                let of_vertex = &mut piece_of_vertex[vertex as usize];
                piece.vertices += u32::from(*of_vertex == NONE);
                *of_vertex = number;
            }
            pieces.of_triangles.push(number);
        }
        pieces
    }

    /// Makes `count` pieces from the piece of each triangle, or [`NONE`]. Every corner is below
    /// `vertices`.
    pub(crate) fn named(
        of_triangles: Vec<u32>,
        count: usize,
        triangles: &[[u32; 3]],
        vertices: usize,
    ) -> Self {
        let none = Piece {
            vertices: 0,
            triangles: 0,
            first_triangle: 0,
        };
        let mut all = vec![none; count];
        // In the order of pieces a vertex counts once, unless its last use was by the same piece.
        let mut order: Vec<u32> = (0..of_triangles.len() as u32).collect();
        order.retain(|&triangle| of_triangles[triangle as usize] != NONE);
        order.sort_unstable_by_key(|&triangle| (of_triangles[triangle as usize], triangle));
        let mut last_use = vec![NONE; vertices];
        for triangle in order {
            let number = of_triangles[triangle as usize];
            let piece = &mut all[number as usize];
            if piece.triangles == 0 {
                piece.first_triangle = triangle;
            }
            piece.triangles += 1;
            for vertex in triangles[triangle as usize] {
                let last = &mut last_use[vertex as usize];
                piece.vertices += u32::from(*last != number);
                *last = number;
            }
        }
        Self { of_triangles, all }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    #[test]
    fn pieces_are_numbered_by_their_lowest_triangle() {
        // Two triangles that share an edge, between one that shares no vertex, and a point.
        let pieces = Pieces::of(&[[7, 8, 9], [3, 2, 1], [2, 1, 0], [5, 5, 5]], 12);
        assert_eq!(pieces.of_triangles, [0, 1, 1, 2]);
        let facts = |piece: &Piece| (piece.vertices, piece.triangles, piece.first_triangle);
        let all: Vec<_> = pieces.all.iter().map(facts).collect();
        assert_eq!(all, [(3, 1, 0), (4, 2, 1), (1, 1, 3)]);
    }

    #[test]
    fn a_common_vertex_is_enough() {
        let pieces = Pieces::of(&[[0, 1, 2], [3, 4, 5], [5, 6, 0]], 7);
        assert_eq!(pieces.of_triangles, [0, 0, 0]);
        assert_eq!(pieces.all[0].vertices, 7);
    }

    proptest! {
        #[test]
        fn named_pieces_are_counted(
            triangles in prop::collection::vec(([0..9_u32, 0..9, 0..9], 0..5_u32), 1..25),
        ) {
            let (triangles, numbers): (Vec<_>, Vec<_>) = triangles.into_iter().unzip();
            // 4 stands for no piece.
            let numbers = numbers.into_iter().map(|n| if n == 4 { NONE } else { n });
            let numbers: Vec<u32> = numbers.collect();
            let pieces = Pieces::named(numbers.clone(), 4, &triangles, 9);
            prop_assert_eq!(&pieces.of_triangles, &numbers);
            for (number, piece) in (0..).zip(&pieces.all) {
                let own = (0..numbers.len()).filter(|&t| numbers[t] == number);
                let own: Vec<usize> = own.collect();
                let vertices: BTreeSet<u32> = own.iter().flat_map(|&t| triangles[t]).collect();
                prop_assert_eq!(piece.vertices as usize, vertices.len());
                prop_assert_eq!(piece.triangles as usize, own.len());
                prop_assert_eq!(piece.first_triangle as usize, own.first().copied().unwrap_or(0));
            }
        }

        /// Compares with growing a piece from a triangle until nothing more touches it.
        #[test]
        fn pieces_are_what_can_be_reached(
            triangles in prop::collection::vec([0..40_u32, 0..40, 0..40], 1..25),
        ) {
            let pieces = Pieces::of(&triangles, 40);
            prop_assert_eq!(pieces.of_triangles.len(), triangles.len());
            for start in 0..triangles.len() {
                let mut reached: BTreeSet<u32> = triangles[start].into();
                let touched = |reached: &BTreeSet<u32>| -> Vec<usize> {
                    let touches = |t: &[u32; 3]| t.iter().any(|vertex| reached.contains(vertex));
                    (0..triangles.len()).filter(|&t| touches(&triangles[t])).collect()
                };
                loop {
                    let before = reached.len();
                    for t in touched(&reached) {
                        reached.extend(triangles[t]);
                    }
                    if reached.len() == before {
                        break;
                    }
                }
                let mine = touched(&reached);
                let number = pieces.of_triangles[start];
                let same = (0..triangles.len()).filter(|&t| pieces.of_triangles[t] == number);
                let same: Vec<_> = same.collect();
                prop_assert_eq!(&mine, &same);
                let piece = pieces.all[number as usize];
                let facts = [piece.vertices, piece.triangles, piece.first_triangle];
                let facts = facts.map(|fact| fact as usize);
                prop_assert_eq!(facts, [reached.len(), mine.len(), mine[0]]);
            }
            let firsts: Vec<_> = pieces.all.iter().map(|piece| piece.first_triangle).collect();
            prop_assert!(firsts.is_sorted());
        }
    }
}
