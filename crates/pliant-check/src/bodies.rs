//! What an answer calls a body: a source as a whole, or a connected piece of it.
//!
//! Pieces are names for triangles, not bodies of the world: there each source stays one body, whose pairs with itself are also
//! the pairs between its pieces. So a source in 100,000 pieces takes no more memory, and no more time, than one in one piece.
//! Triangles keep the numbers that they have in their source.

use crate::Row;
use crate::pieces::{Piece, Pieces};
use crate::settings::Split;
use pliant_io::Body as Source;
use std::ops::Range;

/// A body of an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BodyFacts {
    /// The name of its source, and where that is split, `#` and the number of the piece, from 1.
    pub name: String,
    /// The number of its source.
    pub source: usize,
    /// How many vertices it has; of a piece, those that its triangles use.
    pub vertices: usize,
    /// How many triangles it has.
    pub triangles: usize,
    /// Its lowest triangle, as numbered in the source.
    pub first_triangle: usize,
}

/// The bodies of all sources, numbered through.
#[derive(Debug)]
pub(crate) struct Bodies {
    /// None where sources are bodies.
    pieces: Option<Vec<Pieces>>,
    /// For each source the number of its first body, and at the end the number of bodies.
    starts: Vec<u32>,
}

impl Bodies {
    pub(crate) fn of(sources: &[Source], split: Option<Split>) -> Self {
        let pieces_of = |source: &Source| Pieces::of(source.triangles(), source.vertex_count());
        let pieces: Option<Vec<_>> = split.map(|split| match split {
            Split::Components => sources.iter().map(pieces_of).collect(),
        });
        let mut starts = vec![0];
        let mut count = 0;
        for source in 0..sources.len() {
            count += pieces
                .as_ref()
                .map_or(1, |pieces| pieces[source].all.len() as u32);
            starts.push(count);
        }
        Self { pieces, starts }
    }

    pub(crate) fn count(&self) -> u32 {
        self.starts.last().copied().unwrap_or(0)
    }

    pub(crate) fn are_pieces(&self) -> bool {
        self.pieces.is_some()
    }

    /// The bodies of a source.
    pub(crate) fn of_source(&self, source: usize) -> Range<u32> {
        self.starts[source]..self.starts[source + 1]
    }

    pub(crate) fn source_of(&self, body: u32) -> usize {
        self.starts.partition_point(|&start| start <= body) - 1
    }

    /// The body that a triangle of a source is of.
    pub(crate) fn of_triangle(&self, source: u32, triangle: u32) -> u32 {
        match &self.pieces {
            None => source,
            Some(pieces) => {
                let piece = pieces[source as usize].of_triangles[triangle as usize];
                self.starts[source as usize] + piece
            }
        }
    }

    /// A pair of triangles of sources, as a pair of triangles of bodies: the smaller first.
    pub(crate) fn row(&self, [source_a, a, source_b, b]: Row) -> Row {
        if self.pieces.is_none() {
            return [source_a, a, source_b, b];
        }
        let [one, other] =
            [(source_a, a), (source_b, b)].map(|(source, t)| (self.of_triangle(source, t), t));
        let ((body_a, a), (body_b, b)) = (one.min(other), one.max(other));
        [body_a, a, body_b, b]
    }

    pub(crate) fn facts(&self, sources: &[Source], body: u32) -> BodyFacts {
        let number = self.source_of(body);
        let source = &sources[number];
        let Some(pieces) = &self.pieces else {
            return BodyFacts {
                name: source.name().to_owned(),
                source: number,
                vertices: source.vertex_count(),
                triangles: source.triangles().len(),
                first_triangle: 0,
            };
        };
        let piece = (body - self.starts[number]) as usize;
        let Piece {
            vertices,
            triangles,
            first_triangle,
        } = pieces[number].all[piece];
        BodyFacts {
            name: format!("{}#{}", source.name(), piece + 1),
            source: number,
            vertices: vertices as usize,
            triangles: triangles as usize,
            first_triangle: first_triangle as usize,
        }
    }
}
