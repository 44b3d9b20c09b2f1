//! Impacts as callers get them: two elements that meet during a motion, and when first.

use crate::queries::{EdgeEdge, VertexTriangle};
use crate::sort::Numbered;

/// A vertex and a triangle, of which it is no corner, that meet during a motion.
///
/// Time is 0 at the start of the motion and 1 at its end. The two are apart at all times from 0 to
/// `low`, both included, and meet at some time after `low` that is not after `high`. Elements that
/// already meet at the start have 0 for both. The two numbers depend only on the exact time of the
/// first contact and on the width asked for: see [`Query::width`](crate::Query::width).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexTriangleImpact {
    /// The vertex and the triangle.
    pub pair: VertexTriangle,
    /// Lower bound of the time of first contact: the two are apart up to here.
    pub low: f64,
    /// Upper bound of the time of first contact, a part of the motion from 0 to 1.
    pub high: f64,
}

impl Numbered for VertexTriangleImpact {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        self.pair.numbers()
    }
}

/// Two edges, which have no end in common, that meet during a motion.
///
/// `low` and `high` are defined as in [`VertexTriangleImpact`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeEdgeImpact {
    /// The two edges.
    pub pair: EdgeEdge,
    /// Lower bound of the time of first contact: the two are apart up to here.
    pub low: f64,
    /// Upper bound of the time of first contact, a part of the motion from 0 to 1.
    pub high: f64,
}

impl Numbered for EdgeEdgeImpact {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        self.pair.numbers()
    }
}

/// Two elements of either kind that meet during a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Impact {
    /// A vertex and a triangle.
    VertexTriangle(VertexTriangleImpact),
    /// Two edges.
    EdgeEdge(EdgeEdgeImpact),
}

impl Impact {
    /// Lower bound of the time of first contact: the two are apart up to here.
    pub fn low(&self) -> f64 {
        match self {
            Self::VertexTriangle(impact) => impact.low,
            Self::EdgeEdge(impact) => impact.low,
        }
    }

    /// Key of the order among impacts at one time: vertices and triangles before edges, each by
    /// their numbers.
    pub(crate) fn order(&self) -> (bool, [u32; 4]) {
        match self {
            Self::VertexTriangle(impact) => (false, impact.numbers()),
            Self::EdgeEdge(impact) => (true, impact.numbers()),
        }
    }

    /// The impact with other times.
    pub(crate) fn with_cell(self, [low, high]: [f64; 2]) -> Self {
        match self {
            Self::VertexTriangle(impact) => Self::VertexTriangle(VertexTriangleImpact {
                low,
                high,
                ..impact
            }),
            Self::EdgeEdge(impact) => Self::EdgeEdge(EdgeEdgeImpact {
                low,
                high,
                ..impact
            }),
        }
    }

    /// Upper bound of the time of first contact, a part of the motion from 0 to 1.
    pub fn high(&self) -> f64 {
        match self {
            Self::VertexTriangle(impact) => impact.high,
            Self::EdgeEdge(impact) => impact.high,
        }
    }
}

impl VertexTriangleImpact {
    /// The impact of a vertex and a triangle, if it is one.
    pub(crate) fn of(impact: Impact) -> Option<Self> {
        match impact {
            Impact::VertexTriangle(impact) => Some(impact),
            Impact::EdgeEdge(_) => None,
        }
    }
}

impl EdgeEdgeImpact {
    /// The impact of two edges, if it is one.
    pub(crate) fn of(impact: Impact) -> Option<Self> {
        match impact {
            Impact::VertexTriangle(_) => None,
            Impact::EdgeEdge(impact) => Some(impact),
        }
    }
}

impl From<VertexTriangleImpact> for Impact {
    fn from(impact: VertexTriangleImpact) -> Self {
        Self::VertexTriangle(impact)
    }
}

impl From<EdgeEdgeImpact> for Impact {
    fn from(impact: EdgeEdgeImpact) -> Self {
        Self::EdgeEdge(impact)
    }
}
