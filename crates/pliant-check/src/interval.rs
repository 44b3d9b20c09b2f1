//! What meets on the way from one frame to the next: vertices and triangles, and edges, that are apart in the one and meet before the other
//! is there, every corner on a straight line.
//!
//! What meets in the frame already is known of it, and is only counted. Of the others the first is kept, and all where they are listed.
//! Times are known to a millionth of the way. Those of the first that are equal in that are compared once more, to the last bit of a
//! double; of equal ones then vertices and triangles are before edges, each in order. Of very many, those with the lowest numbers are compared.

use crate::found::{MOST_COUNTED, Stop};
use crate::sequence::Sequence;
use crate::with_world;
use pliant::{BodyId, EdgeEdge, Scalar, VertexTriangle, World};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::ControlFlow;

/// How wide the interval of a time is at most.
pub(crate) const WIDTH: f64 = 1e-6;

/// So many that are equally early are compared.
const MOST_COMPARED: usize = 1 << 16;

/// What meets on the way from a frame to the next that is checked.
///
/// Time is 0 in the frame and 1 in the next; in between every vertex moves on a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// The frame.
    pub frame: usize,
    /// The next that is checked.
    pub until: usize,
    /// The bodies that have another mesh there, ascending. Where there are any nothing moves on straight lines, nothing was looked for, and the rest
    /// of this says nothing.
    pub changed: Vec<u32>,
    /// How many pairs of elements are apart in the frame and meet on the way, the end included; at most one if only the first was asked for.
    pub count: usize,
    /// How many others meet in the frame already.
    pub at_start: usize,
    /// The one of them that meets first.
    pub first: Option<FirstImpact>,
    /// All vertices and triangles of them, sorted: body and vertex, body and triangle. None where they are not listed.
    pub vertex_triangle: Vec<Impact<4>>,
    /// All edges of them, sorted: body and two vertices, twice, the smaller first in an edge and of the two. None where they are not listed.
    pub edge_edge: Vec<Impact<6>>,
    /// Whether these are all; not if only the first was asked for.
    pub complete: bool,
}

/// Two elements that meet on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact<const N: usize> {
    /// Which they are.
    pub pair: [u32; N],
    /// They are apart up to here.
    pub low: f64,
    /// They have met when it is that late; at most a millionth after `low`.
    pub high: f64,
}

/// What meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstImpact {
    /// A vertex and a triangle: body, vertex, body, triangle.
    VertexTriangle(Impact<4>),
    /// Two edges: body, vertex, vertex, body, vertex, vertex.
    EdgeEdge(Impact<6>),
}

impl FirstImpact {
    /// When they have met, at the latest.
    pub fn time(&self) -> f64 {
        match self {
            Self::VertexTriangle(impact) => impact.high,
            Self::EdgeEdge(impact) => impact.high,
        }
    }
}

impl Interval {
    /// An interval in which nothing was looked for.
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

/// Two elements, as the library finds them. Of sources or of bodies: body and vertex, body and triangle; or body and edge, twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Elements {
    VertexTriangle([u32; 4]),
    EdgeEdge([u32; 4]),
}

impl From<VertexTriangle> for Elements {
    fn from(pair: VertexTriangle) -> Self {
        Self::VertexTriangle(pair.into())
    }
}

impl From<EdgeEdge> for Elements {
    fn from(pair: EdgeEdge) -> Self {
        Self::EdgeEdge(pair.into())
    }
}

impl From<pliant::Impact> for Elements {
    fn from(impact: pliant::Impact) -> Self {
        match impact {
            pliant::Impact::VertexTriangle(impact) => impact.pair.into(),
            pliant::Impact::EdgeEdge(impact) => impact.pair.into(),
        }
    }
}

/// Takes what meets as it is found.
pub(crate) struct ImpactTaker {
    found: Interval,
    listed: bool,
    /// The most that are listed.
    most: usize,
    /// The interval of the earliest.
    cell: [f64; 2],
    /// Those that meet in it.
    earliest: Vec<Elements>,
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

    /// Takes two elements of bodies that are apart up to `low` and have met at `high`.
    pub(crate) fn take(&mut self, pair: Elements, [low, high]: [f64; 2]) -> ControlFlow<Stop> {
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
            Elements::VertexTriangle(_) => vertices.try_reserve(1).is_ok(),
            Elements::EdgeEdge(_) => edges.try_reserve(1).is_ok(),
        };
        if !has_room || vertices.len() + edges.len() >= self.most {
            return ControlFlow::Break(Stop::Full);
        }
        match pair {
            Elements::VertexTriangle(pair) => vertices.push(Impact { pair, low, high }),
            // Their vertices are looked up at the end.
            Elements::EdgeEdge([body_a, a, body_b, b]) => edges.push(Impact {
                pair: [body_a, a, a, body_b, b, b],
                low,
                high,
            }),
        }
        ControlFlow::Continue(())
    }

    /// What was found of a sequence that is moving; `source_of` is the source of a body.
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
                Some(Elements::VertexTriangle(pair)) => {
                    Some(FirstImpact::VertexTriangle(Impact { pair, low, high }))
                }
                Some(Elements::EdgeEdge(pair)) => {
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

/// When elements of bodies first meet, to the last bit, in the same order.
fn times<S: Scalar>(
    world: &World<S>,
    source_of: &impl Fn(u32) -> usize,
    pairs: &[Elements],
) -> Result<Vec<f64>, pliant::Error> {
    // Of each source where it is and where it goes.
    let mut shapes: BTreeMap<u32, [Vec<[S; 3]>; 2]> = BTreeMap::new();
    let mut corners: [[Vec<[[S; 3]; 4]>; 2]; 2] = Default::default();
    for pair in pairs {
        let (Elements::VertexTriangle([body_a, _, body_b, _])
        | Elements::EdgeEdge([body_a, _, body_b, _])) = *pair;
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
            Elements::VertexTriangle([_, vertex, _, triangle]) => {
                let [p, q, r] = world.triangles(id_b)?[triangle as usize];
                (0, [(a, vertex), (b, p), (b, q), (b, r)])
            }
            Elements::EdgeEdge([_, one, _, other]) => {
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
        Elements::VertexTriangle(_) => time(vertices.next()),
        Elements::EdgeEdge(_) => time(edges.next()),
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
        let pair = |number: u32| Elements::EdgeEdge([0, number, 1, 0]);
        // A later one first, then all in an order in which the lowest are neither first nor last.
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
        let pair = Elements::VertexTriangle([0; 4]);
        assert!(taker.take(pair, [0.0, 0.5]).is_continue());
        assert_eq!(
            taker.take(pair, [0.0; 2]),
            ControlFlow::Break(Stop::Endless)
        );
    }
}
