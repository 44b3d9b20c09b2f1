//! Impacts between two frames: vertices and triangles, and edges, that are apart and meet on the
//! way.
//!
//! Every vertex moves on a straight line. Contacts of the first frame itself are only counted. The
//! first impact is kept, and all where they are listed. Times are known to [`WIDTH`] of the way.
//! Ties for the first are compared again to the last bit, then by kind and number.

use crate::found::{MOST_COUNTED, Stop};
use crate::sequence::Sequence;
use crate::with_world;
use pliant::{BodyId, EdgeEdge, Scalar, VertexTriangle, World};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::ControlFlow;

/// Largest width of an impact's time interval, in units of the way between two frames.
pub(crate) const WIDTH: f64 = 1e-6;

/// Most equally early impacts that are compared again, which bounds memory. Of more, those with the
/// lowest numbers are.
const MOST_COMPARED: usize = 1 << 16;

/// Impacts on the way from a frame to the next that is checked.
///
/// Time is 0 in the frame and 1 in the next; in between every vertex moves on a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// Number of the frame.
    pub frame: usize,
    /// Number of the next checked frame.
    pub until: usize,
    /// Bodies whose mesh differs in the next frame, ascending.
    ///
    /// If there are any, nothing moves on straight lines. Then nothing was searched, and the other
    /// fields say nothing.
    pub changed: Vec<u32>,
    /// Number of impacts; at most one if only the first was asked for.
    ///
    /// An impact is a pair of elements, apart in the frame, that meet on the way or at its end.
    pub count: usize,
    /// Number of pairs of elements that meet in the frame already.
    pub at_start: usize,
    /// The first impact; of equal times a vertex and a triangle is before two edges, then the lower
    /// numbers.
    pub first: Option<FirstImpact>,
    /// Impacts of vertices and triangles, sorted: body and vertex, body and triangle. Empty if not
    /// listed.
    pub vertex_triangle: Vec<Impact<4>>,
    /// Impacts of edges, sorted: body and two vertices, for either edge. Empty if not listed.
    ///
    /// The smaller vertex is first in an edge, and the smaller edge in a pair.
    pub edge_edge: Vec<Impact<6>>,
    /// Whether these are all impacts; false if only the first was asked for.
    pub complete: bool,
}

/// Impact of two elements, with an interval of its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact<const N: usize> {
    /// The pair of elements.
    pub pair: [u32; N],
    /// Lower bound of the time: they are apart up to here.
    pub low: f64,
    /// Upper bound of the time: they have met. At most a millionth after `low`.
    pub high: f64,
}

/// First impact between two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstImpact {
    /// A vertex and a triangle: body, vertex, body, triangle.
    VertexTriangle(Impact<4>),
    /// Two edges: body, vertex, vertex, body, vertex, vertex.
    EdgeEdge(Impact<6>),
}

impl FirstImpact {
    /// Upper bound of the time of impact, from 0 to 1.
    pub fn time(&self) -> f64 {
        match self {
            Self::VertexTriangle(impact) => impact.high,
            Self::EdgeEdge(impact) => impact.high,
        }
    }
}

impl Interval {
    /// An interval that was not searched.
    pub(crate) fn none(frame: usize, until: usize, changed: Vec<u32>) -> Self {
        Self {
            frame,
            until,
            changed,
            count: 0,
            at_start: 0,
            first: None,
            vertex_triangle: Vec::new(),
            edge_edge: Vec::new(),
            complete: true,
        }
    }
}

/// A pair of elements as the library finds it, of sources or of bodies.
///
/// Body and vertex, body and triangle; or body and edge, twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ElementPair {
    VertexTriangle([u32; 4]),
    EdgeEdge([u32; 4]),
}

impl From<VertexTriangle> for ElementPair {
    fn from(pair: VertexTriangle) -> Self {
        Self::VertexTriangle(pair.into())
    }
}

impl From<EdgeEdge> for ElementPair {
    fn from(pair: EdgeEdge) -> Self {
        Self::EdgeEdge(pair.into())
    }
}

impl From<pliant::Impact> for ElementPair {
    fn from(impact: pliant::Impact) -> Self {
        match impact {
            pliant::Impact::VertexTriangle(impact) => impact.pair.into(),
            pliant::Impact::EdgeEdge(impact) => impact.pair.into(),
        }
    }
}

/// Collects impacts as they are found.
pub(crate) struct ImpactTaker {
    found: Interval,
    listed: bool,
    /// Most impacts that are listed.
    most: usize,
    /// Time interval of the earliest impacts.
    cell: [f64; 2],
    /// Impacts in `cell`.
    earliest: Vec<ElementPair>,
}

impl ImpactTaker {
    pub(crate) fn new(frame: usize, until: usize, first: bool, listed: bool, most: usize) -> Self {
        let mut found = Interval::none(frame, until, Vec::new());
        found.complete = !first;
        Self {
            found,
            listed,
            most,
            cell: [f64::INFINITY; 2],
            earliest: Vec::new(),
        }
    }

    /// Takes two elements that are apart up to `low` and have met at `high`.
    pub(crate) fn take(&mut self, pair: ElementPair, [low, high]: [f64; 2]) -> ControlFlow<Stop> {
        let found = &mut self.found;
        if found.count + found.at_start >= MOST_COUNTED {
            return ControlFlow::Break(Stop::Endless);
        }
        if high == 0.0 {
            found.at_start += 1;
            return ControlFlow::Continue(());
        }
        found.count += 1;
        if high <= self.cell[1] {
            if high < self.cell[1] {
                self.cell = [low, high];
                self.earliest.clear();
            }
            self.earliest.push(pair);
            if self.earliest.len() >= 2 * MOST_COMPARED {
                self.earliest.sort_unstable();
                self.earliest.truncate(MOST_COMPARED);
            }
        }
        if !self.listed || !found.complete {
            return ControlFlow::Continue(());
        }
        let (vertices, edges) = (&mut found.vertex_triangle, &mut found.edge_edge);
        let has_room = match pair {
            ElementPair::VertexTriangle(_) => vertices.try_reserve(1).is_ok(),
            ElementPair::EdgeEdge(_) => edges.try_reserve(1).is_ok(),
        };
        let listed = vertices.len() + edges.len();
        if !has_room || listed >= self.most {
            return ControlFlow::Break(Stop::Full(listed));
        }
        match pair {
            ElementPair::VertexTriangle(pair) => vertices.push(Impact { pair, low, high }),
            // The edges' vertices are looked up at the end.
            ElementPair::EdgeEdge([body_a, a, body_b, b]) => edges.push(Impact {
                pair: [body_a, a, a, body_b, b, b],
                low,
                high,
            }),
        }
        ControlFlow::Continue(())
    }

    /// The impacts found. The sequence still has its motion; `source_of` returns the source of a
    /// body.
    pub(crate) fn end(
        self,
        sequence: &Sequence,
        source_of: impl Fn(u32) -> usize,
    ) -> Result<Interval, pliant::Error> {
        let Self {
            mut found,
            listed,
            cell: [low, high],
            mut earliest,
            ..
        } = self;
        with_world!(&sequence.world, world => {
            let edge = |body: u32, edge: u32| -> Result<[u32; 3], pliant::Error> {
                let [a, b] = world.edges(BodyId(source_of(body) as u32))?[edge as usize];
                Ok([body, a, b])
            };
            let edges = |[body_a, a, body_b, b]: [u32; 4]| -> Result<[u32; 6], pliant::Error> {
                let ([body_a, a, b], [body_b, c, d]) = (edge(body_a, a)?, edge(body_b, b)?);
                Ok([body_a, a, b, body_b, c, d])
            };
            for impact in &mut found.edge_edge {
                let [body_a, a, _, body_b, b, _] = impact.pair;
                impact.pair = edges([body_a, a, body_b, b])?;
            }
            earliest.sort_unstable();
            earliest.truncate(MOST_COMPARED);
            let first = match earliest[..] {
                [] | [_] => earliest.first().copied(),
                _ => {
                    let times = times(world, &source_of, &earliest)?;
                    let first = times.iter().zip(&earliest);
                    first.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, &pair)| pair)
                }
            };
            found.first = match first {
                None => None,
                Some(ElementPair::VertexTriangle(pair)) => {
                    Some(FirstImpact::VertexTriangle(Impact { pair, low, high }))
                }
                Some(ElementPair::EdgeEdge(pair)) => {
                    let pair = edges(pair)?;
                    Some(FirstImpact::EdgeEdge(Impact { pair, low, high }))
                }
            };
        });
        if !found.complete {
            found.count = found.count.min(1);
            match found.first.filter(|_| listed) {
                None => {}
                Some(FirstImpact::VertexTriangle(impact)) => found.vertex_triangle.push(impact),
                Some(FirstImpact::EdgeEdge(impact)) => found.edge_edge.push(impact),
            }
        }
        found
            .vertex_triangle
            .sort_unstable_by_key(|impact| impact.pair);
        found.edge_edge.sort_unstable_by_key(|impact| impact.pair);
        Ok(found)
    }
}

/// Times of impact of pairs of bodies, to the last bit, in the order of `pairs`.
fn times<S: Scalar>(
    world: &World<S>,
    source_of: &impl Fn(u32) -> usize,
    pairs: &[ElementPair],
) -> Result<Vec<f64>, pliant::Error> {
    // Start and end positions of each source.
    let mut shapes: BTreeMap<u32, [Vec<[S; 3]>; 2]> = BTreeMap::new();
    let mut corners: [[Vec<[[S; 3]; 4]>; 2]; 2] = Default::default();
    for pair in pairs {
        let (ElementPair::VertexTriangle([body_a, _, body_b, _])
        | ElementPair::EdgeEdge([body_a, _, body_b, _])) = *pair;
        let sources = [body_a, body_b].map(|body| source_of(body) as u32);
        for source in sources {
            if let Entry::Vacant(new) = shapes.entry(source) {
                let start = world.positions(BodyId(source))?;
                let end = world.end_positions(BodyId(source))?;
                let end = end.unwrap_or_else(|| start.clone());
                new.insert([start, end]);
            }
        }
        let [a, b] = sources.map(|source| &shapes[&source]);
        let [id_a, id_b] = sources.map(BodyId);
        let (kind, vertices) = match *pair {
            ElementPair::VertexTriangle([_, vertex, _, triangle]) => {
                let [p, q, r] = world.triangles(id_b)?[triangle as usize];
                (0, [(a, vertex), (b, p), (b, q), (b, r)])
            }
            ElementPair::EdgeEdge([_, one, _, other]) => {
                let [p, q] = world.edges(id_a)?[one as usize];
                let [r, s] = world.edges(id_b)?[other as usize];
                (1, [(a, p), (a, q), (b, r), (b, s)])
            }
        };
        for end in 0..2 {
            corners[kind][end].push(vertices.map(|(shape, vertex)| shape[end][vertex as usize]));
        }
    }
    let [[start, end], [start_of_edges, end_of_edges]] = &corners;
    let vertices = pliant::vertex_triangle_impacts(start, end, 0.0)?;
    let edges = pliant::edge_edge_impacts(start_of_edges, end_of_edges, 0.0)?;
    let [mut vertices, mut edges] = [vertices, edges].map(Vec::into_iter);
    let time =
        |cell: Option<Option<[f64; 2]>>| cell.flatten().map_or(f64::INFINITY, |[_, high]| high);
    let times = pairs.iter().map(|pair| match pair {
        ElementPair::VertexTriangle(_) => time(vertices.next()),
        ElementPair::EdgeEdge(_) => time(edges.next()),
    });
    Ok(times.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_very_many_equally_early_ones_the_lowest_are_compared() {
        let mut taker = ImpactTaker::new(0, 1, false, false, 0);
        let count = 5 * MOST_COMPARED as u32;
        let pair = |number: u32| ElementPair::EdgeEdge([0, number, 1, 0]);
        // A later one first, then an order in which the lowest are neither first nor last.
        assert!(taker.take(pair(0), [0.75, 1.0]).is_continue());
        for number in 0..count {
            let number = (number * 7 + count / 2) % count;
            assert!(taker.take(pair(number), [0.5, 0.75]).is_continue());
            assert!(taker.earliest.len() < 2 * MOST_COMPARED);
        }
        taker.earliest.sort_unstable();
        let lowest = (0..MOST_COMPARED as u32).map(pair);
        assert!(
            taker
                .earliest
                .iter()
                .copied()
                .take(MOST_COMPARED)
                .eq(lowest)
        );
        assert_eq!(taker.found.count, count as usize + 1);
        assert!(taker.found.edge_edge.is_empty());
    }

    #[test]
    fn no_more_is_counted_than_anybody_waits_for() {
        let mut taker = ImpactTaker::new(0, 1, false, false, 0);
        taker.found.at_start = MOST_COUNTED - 1;
        let pair = ElementPair::VertexTriangle([0; 4]);
        assert!(taker.take(pair, [0.0, 0.5]).is_continue());
        assert_eq!(
            taker.take(pair, [0.0; 2]),
            ControlFlow::Break(Stop::Endless)
        );
    }
}
