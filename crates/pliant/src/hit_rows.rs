//! Hits in compressed rows (CSR): a row for every vertex, edge or triangle that is first in a hit.
//!
//! Vertex block descent and the assembly of matrices go through the hits of one element at a time.
//! One pass counts the hits of each row, a second puts their places in the list behind each other.
//! The list may have any order; within a row places ascend.

use crate::error::{Error, ErrorKind};
use crate::ids::BodyId;
use crate::queries::{
    AdjacentContact, CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, Contact, CrossingEdge,
    EdgeEdge, EdgeEdgeImpact, Pair, VertexTriangle, VertexTriangleImpact,
};
use crate::world::{Scalar, World};

/// Rows of a list of hits, one for each element that may be the first of a hit: CSR.
///
/// Rows of one body follow each other by number, bodies in the order of their ids. Row i has the
/// places in the list from `offsets()[i]` to `offsets()[i + 1]` of [`places`](Self::places).
///
/// ```
/// # use pliant::{HitRows, Selection, World};
/// # let mut world = World::<f64>::new();
/// # let at = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
/// # let a = world.add(&[[0, 1, 2]], &at(0.0))?;
/// # let b = world.add(&[[0, 1, 2]], &at(0.1))?;
/// let mut hits = Vec::new();
/// world.close_vertex_triangle_pairs(Selection::World, 0.2).unsorted(&mut hits)?;
/// let mut rows = HitRows::new();
/// rows.update(&world, &hits)?;
/// let of_vertex: f64 = rows.row(b, 2).iter().map(|&place| hits[place as usize].distance).sum();
/// assert_eq!((of_vertex, rows.offsets().len()), (0.1, 3 + 3 + 1));
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HitRows {
    /// First row of every body, in the order of ids.
    starts: Vec<(BodyId, usize)>,
    offsets: Vec<u32>,
    places: Vec<u32>,
}

/// Hit whose first element names a row of [`HitRows`]. It is implemented by all hits.
pub trait InRows: sealed::First + Copy {}

mod sealed {
    use super::{BodyId, Error, Scalar, World};

    /// First element of a hit.
    pub trait First {
        /// Body and number of the first element.
        fn first(&self) -> (BodyId, u32);
        /// How many elements of this kind a body has.
        fn count<S: Scalar>(world: &World<S>, body: BodyId) -> Result<usize, Error>;
    }
}

/// Implements [`InRows`] for hits: their first body and element, and the count of such elements.
macro_rules! in_rows {
    ($count:expr; $($hit:ident[$($place:ident)?]: $body:ident, $element:ident;)+) => {$(
        impl sealed::First for $hit {
            #[inline]
            fn first(&self) -> (BodyId, u32) {
                let hit = self$(.$place)?;
                (hit.$body, hit.$element)
            }

            fn count<S: Scalar>(world: &World<S>, body: BodyId) -> Result<usize, Error> {
                let count: fn(&World<S>, BodyId) -> Result<usize, Error> = $count;
                count(world, body)
            }
        }

        impl InRows for $hit {}
    )+};
}

in_rows! { World::vertex_count;
    VertexTriangle[]: vertex_body, vertex;
    CloseVertexTriangle[pair]: vertex_body, vertex;
    VertexTriangleImpact[pair]: vertex_body, vertex;
}
in_rows! { |world, body| Ok(world.edges(body)?.len());
    EdgeEdge[]: body_a, edge_a;
    CloseEdgeEdge[pair]: body_a, edge_a;
    EdgeEdgeImpact[pair]: body_a, edge_a;
    CrossingEdge[]: edge_body, edge;
}
in_rows! { World::triangle_count;
    Pair[]: body_a, triangle_a;
    Contact[pair]: body_a, triangle_a;
    CloseTriangles[pair]: body_a, triangle_a;
    AdjacentContact[pair]: body_a, triangle_a;
}

impl HitRows {
    /// Without any rows.
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes the rows of a list of hits, and forgets all before. If it is refused, there are none.
    ///
    /// Every body of the world has rows. Memory is kept from call to call. Cost: O(hits + rows).
    ///
    /// # Errors
    ///
    /// If the list is of another world or another mesh:
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`NoSuchHit`](crate::ErrorKind::NoSuchHit).
    /// [`TooManyHits`](crate::ErrorKind::TooManyHits) above 2^32 - 1 hits.
    pub fn update<S: Scalar, H: InRows>(
        &mut self,
        world: &World<S>,
        hits: &[H],
    ) -> Result<(), Error> {
        let done = self.count(world, hits);
        if done.is_err() {
            *self = Self::default();
            return done;
        }
        self.places.clear();
        self.places.resize(hits.len(), 0);
        // Offsets are the ends of rows now. Each hit, from the last on, moves one down.
        let mut last = None;
        for (place, hit) in (0..hits.len() as u32).zip(hits).rev() {
            let (body, element) = hit.first();
            let start = match last {
                Some((known, start)) if known == body => start,
                _ => self.start(body).unwrap_or_default(),
            };
            last = Some((body, start));
            let end = &mut self.offsets[start + element as usize];
            *end -= 1;
            self.places[*end as usize] = place;
        }
        Ok(())
    }

    /// Counts the hits of every row, and sets offsets to the ends of rows.
    fn count<S: Scalar, H: InRows>(&mut self, world: &World<S>, hits: &[H]) -> Result<(), Error> {
        if u32::try_from(hits.len()).is_err() {
            let limit = u32::MAX as usize;
            return Err(ErrorKind::TooManyHits { limit }.of_query());
        }
        self.starts.clear();
        let mut rows = 0;
        for body in world.bodies() {
            self.starts.push((body, rows));
            rows += H::count(world, body)?;
        }
        self.offsets.clear();
        self.offsets.resize(rows + 1, 0);
        let mut last = None;
        for (hit, of_list) in hits.iter().enumerate() {
            let (body, element) = of_list.first();
            let refused = |kind| {
                let body = Some(body);
                Error { body, kind }
            };
            let rows = match last.take() {
                Some((known, rows)) if known == body => rows,
                _ => self.rows_of(body).ok_or(refused(ErrorKind::NoSuchBody))?,
            };
            if rows.len() <= element as usize {
                return Err(refused(ErrorKind::NoSuchHit { hit }));
            }
            self.offsets[rows.start + element as usize] += 1;
            last = Some((body, rows));
        }
        let mut sum = 0;
        for count in &mut self.offsets {
            sum += *count;
            *count = sum;
        }
        Ok(())
    }

    /// Rows of a body.
    fn rows_of(&self, body: BodyId) -> Option<std::ops::Range<usize>> {
        let at = self
            .starts
            .binary_search_by_key(&body, |&(id, _)| id)
            .ok()?;
        let rows = self.offsets.len() - 1;
        let end = self.starts.get(at + 1).map_or(rows, |&(_, start)| start);
        Some(self.starts[at].1..end)
    }

    /// First row of a body; `None` if it is not there.
    pub fn start(&self, body: BodyId) -> Option<usize> {
        Some(self.rows_of(body)?.start)
    }

    /// Offsets of the rows in [`places`](Self::places): one more than there are rows, or none.
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// Places in the list of all hits, row by row; within a row they ascend.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Places in the list of the hits of an element: empty if there is none such.
    pub fn row(&self, body: BodyId, element: u32) -> &[u32] {
        let rows = self.rows_of(body).unwrap_or_default();
        if rows.len() <= element as usize {
            return &[];
        }
        let row = rows.start + element as usize;
        &self.places[self.offsets[row] as usize..self.offsets[row + 1] as usize]
    }
}
