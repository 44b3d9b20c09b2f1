//! Thickness of vertices, edges and triangles: the largest of an element's corners.
//!
//! Two elements of thickness s and t are near each other if they are at most d + s + t apart, in
//! real arithmetic. Boxes of a body are grown by its largest thickness, so what is near is found;
//! the test of leaves then looks at the elements.

use crate::held::held;
use crate::ids::TreeVertex;
use crate::mesh::Order;
use pliant_exact::Length;

/// Thickness of a body's vertices, in tree order.
#[derive(Clone, Debug)]
pub(crate) struct Thickness {
    vertices: Vec<f64>,
    /// Least and largest thickness of a vertex.
    ends: [f64; 2],
}

impl Thickness {
    /// Thickness of vertices in the caller's order, brought into tree order.
    pub(crate) fn new(of_vertices: &[f64], order: &Order) -> Self {
        let in_order = order.vertex_order().iter();
        let least = of_vertices.iter().copied().fold(f64::INFINITY, f64::min);
        Self {
            vertices: in_order
                .map(|&vertex| of_vertices[vertex as usize])
                .collect(),
            ends: [least, most(of_vertices.iter().copied())],
        }
    }

    /// Largest thickness of some vertices.
    fn of(&self, vertices: &[TreeVertex]) -> f64 {
        most(vertices.iter().map(|vertex| self.vertices[vertex.index()]))
    }
}

/// Largest of some thicknesses.
pub(crate) fn most(all: impl IntoIterator<Item = f64>) -> f64 {
    all.into_iter().fold(0.0, f64::max)
}

/// Thickness of the elements of two bodies, or of one twice.
#[derive(Clone, Copy)]
pub(crate) struct Thicknesses<'q> {
    /// None for a body without.
    pub(crate) sides: [Option<&'q Thickness>; 2],
    /// By how much it counts: 0 for kinds that do not look at it.
    pub(crate) counts: f64,
}

impl Thicknesses<'_> {
    /// Whether any element has a thickness that counts.
    #[inline(always)]
    pub(in crate::queries) fn are_any(&self) -> bool {
        self.counts > 0.0 && self.sides.iter().any(Option::is_some)
    }

    /// These, counted once.
    pub(in crate::queries) fn counted_once(self) -> Self {
        Self {
            counts: 1.0,
            ..self
        }
    }

    /// The distance at which two elements are near, from that of elements without thickness.
    pub(in crate::queries) fn length(
        &self,
        distance: f64,
        elements: [(usize, &[TreeVertex]); 2],
    ) -> Length {
        let [a, b] = elements.map(|(side, corners)| {
            let of_side = self.sides[side];
            of_side.map_or(0.0, |of_side| self.counts * of_side.of(corners))
        });
        Length::sum([distance, a, b])
    }

    /// Bounds of that distance for any two elements, one of each side.
    pub(in crate::queries) fn bounds(&self, distance: f64) -> [f64; 2] {
        if !self.are_any() {
            return [distance; 2];
        }
        let bound = |which: usize| {
            let of = |side: Option<&Thickness>| side.map_or(0.0, |it| self.counts * it.ends[which]);
            let [a, b] = self.sides.map(of);
            Length::sum([distance, a, b]).bounds()[which]
        };
        [bound(0), bound(1)]
    }
}

held!(Thickness: vertices[]);
