//! Hits in columns, for every kind of question.

use crate::arrays::start;
use crate::pairs::{number_of, number_of_contact};
use pliant::{
    AdjacentContact, CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, Contact, CrossingEdge,
    EdgeEdge, EdgeEdgeImpact, Error, HitRows, InRows, Pair, Scalar, VertexTriangle,
    VertexTriangleImpact, World,
};
use std::ptr::null;

/// `pliant_hits`: columns of some hits, of which a question has some. The others are NULL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantHits {
    /// Number of hits.
    pub count: usize,
    /// Body, element, body, element: 4 numbers a hit.
    pub pairs: *const u32,
    /// Kinds of contacts, or features of close elements.
    pub kinds: *const u8,
    /// Distances.
    pub distances: *const f64,
    /// Directions, 3 numbers a hit.
    pub directions: *const f64,
    /// Weights of closest points.
    pub weights: *const f64,
    /// Closest points, 6 numbers a hit.
    pub points: *const f64,
    /// Times up to which elements are apart.
    pub low: *const f64,
    /// Times at which they have met.
    pub high: *const f64,
    /// Rows of the hits, if they are asked for.
    pub rows: PliantRows,
}

/// `pliant_rows`: rows of hits, one for each element that may be the first of a pair.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantRows {
    /// Number of rows.
    pub count: usize,
    /// Where each row begins among the places, and where the last ends.
    pub offsets: *const u32,
    /// Places of hits in their columns.
    pub places: *const u32,
    /// Number of bodies.
    pub body_count: usize,
    /// Bodies in the order of their rows.
    pub bodies: *const u32,
    /// First row of each.
    pub starts: *const usize,
}

impl PliantRows {
    const NONE: Self = Self {
        count: 0,
        offsets: null(),
        places: null(),
        body_count: 0,
        bodies: null(),
        starts: null(),
    };
}

/// Rows of hits, kept from call to call.
#[derive(Default)]
pub(crate) struct Rows {
    of_hits: HitRows,
    bodies: Vec<u32>,
    starts: Vec<usize>,
}

impl Rows {
    pub(crate) fn update<S: Scalar, H: InRows>(
        &mut self,
        world: &World<S>,
        hits: &[H],
    ) -> Result<(), Error> {
        self.clear();
        self.of_hits.update(world, hits)?;
        for body in world.bodies() {
            self.bodies.push(body.0);
            self.starts.extend(self.of_hits.start(body));
        }
        Ok(())
    }

    fn clear(&mut self) {
        self.bodies.clear();
        self.starts.clear();
    }

    fn view(&self) -> PliantRows {
        if self.bodies.is_empty() {
            return PliantRows::NONE;
        }
        PliantRows {
            count: self.of_hits.offsets().len() - 1,
            offsets: start(self.of_hits.offsets()),
            places: start(self.of_hits.places()),
            body_count: self.bodies.len(),
            bodies: start(&self.bodies),
            starts: start(&self.starts),
        }
    }
}

impl PliantHits {
    /// No hits.
    pub const NONE: Self = Self {
        count: 0,
        pairs: null(),
        kinds: null(),
        distances: null(),
        directions: null(),
        weights: null(),
        points: null(),
        low: null(),
        high: null(),
        rows: PliantRows::NONE,
    };
}

/// Columns of hits, kept from call to call.
#[derive(Default)]
pub(crate) struct Columns {
    count: usize,
    pairs: Vec<[u32; 4]>,
    pub(crate) kinds: Vec<u8>,
    distances: Vec<f64>,
    directions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    points: Vec<[f64; 6]>,
    low: Vec<f64>,
    high: Vec<f64>,
    pub(crate) rows: Rows,
}

/// A hit that has columns.
pub(crate) trait Row: Copy + InRows {
    fn put(&self, columns: &mut Columns);
}

impl Columns {
    /// Takes some hits, in place of all before.
    pub(crate) fn take<H: Row>(&mut self, hits: &[H]) {
        self.count = 0;
        self.rows.clear();
        self.pairs.clear();
        self.kinds.clear();
        self.directions.clear();
        self.points.clear();
        for list in [
            &mut self.distances,
            &mut self.weights,
            &mut self.low,
            &mut self.high,
        ] {
            list.clear();
        }
        self.add(hits);
    }

    /// Takes some hits more.
    pub(crate) fn add<H: Row>(&mut self, hits: &[H]) {
        self.count += hits.len();
        for hit in hits {
            hit.put(self);
        }
    }

    /// Number of hits.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The columns as the caller reads them.
    pub(crate) fn view(&self) -> PliantHits {
        PliantHits {
            count: self.count,
            pairs: start(&self.pairs),
            kinds: start(&self.kinds),
            distances: start(&self.distances),
            directions: start(&self.directions),
            weights: start(&self.weights),
            points: start(&self.points),
            low: start(&self.low),
            high: start(&self.high),
            rows: self.rows.view(),
        }
    }

    fn close(&mut self, pair: [u32; 4], distance: f64, direction: Option<[f64; 3]>) {
        self.pairs.push(pair);
        self.distances.push(distance);
        self.directions.push(direction.unwrap_or_default());
    }

    fn impact(&mut self, pair: [u32; 4], low: f64, high: f64) {
        self.pairs.push(pair);
        self.low.push(low);
        self.high.push(high);
    }
}

/// Hits that are pairs alone.
macro_rules! pairs_alone {
    ($($hit:ty),*) => {
        $(impl Row for $hit {
            fn put(&self, columns: &mut Columns) {
                columns.pairs.push((*self).into());
            }
        })*
    };
}

pairs_alone!(Pair, CrossingEdge, VertexTriangle, EdgeEdge);

impl Row for Contact {
    fn put(&self, columns: &mut Columns) {
        columns.pairs.push(self.pair.into());
        columns.kinds.push(number_of_contact(Some(self.kind)));
    }
}

impl Row for AdjacentContact {
    fn put(&self, columns: &mut Columns) {
        columns.pairs.push(self.pair.into());
        columns.kinds.push(number_of_contact(Some(self.kind)));
    }
}

impl Row for CloseVertexTriangle {
    fn put(&self, columns: &mut Columns) {
        columns.close(self.pair.into(), self.distance, self.direction);
        columns.kinds.push(number_of(self.features()));
        columns.weights.push(1.0);
        columns.weights.extend(self.barycentric);
    }
}

impl Row for CloseEdgeEdge {
    fn put(&self, columns: &mut Columns) {
        columns.close(self.pair.into(), self.distance, self.direction);
        columns.kinds.push(number_of(self.features()));
        let weights = self.barycentric_a.into_iter().chain(self.barycentric_b);
        columns.weights.extend(weights);
    }
}

impl Row for CloseTriangles {
    fn put(&self, columns: &mut Columns) {
        columns.close(self.pair.into(), self.distance, self.direction);
        let weights = self.barycentric_a.into_iter().chain(self.barycentric_b);
        columns.weights.extend(weights);
        let ([a, b, c], [d, e, f]) = (self.point_a, self.point_b);
        columns.points.push([a, b, c, d, e, f]);
    }
}

impl Row for VertexTriangleImpact {
    fn put(&self, columns: &mut Columns) {
        columns.impact(self.pair.into(), self.low, self.high);
    }
}

impl Row for EdgeEdgeImpact {
    fn put(&self, columns: &mut Columns) {
        columns.impact(self.pair.into(), self.low, self.high);
    }
}
