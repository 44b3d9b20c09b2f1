//! Boxes of all nodes of a tree in lanes: the one place where the degree is matched on.
//!
//! The boxes of a wide node lie side by side, as many as the degree. Whoever reads or writes boxes
//! of nodes matches on the degree here, once a batch.

use crate::geometry::Aabb;
use crate::ids::{NodeId, WideNodeId};
use crate::kernels::{BoxLanes, Instructions, dispatch, near_mask};

/// Boxes of every wide node's nodes, for one of three degrees.
#[derive(Debug)]
pub(crate) enum NodeLanes {
    Two(Vec<BoxLanes<2>>),
    Four(Vec<BoxLanes<4>>),
    Eight(Vec<BoxLanes<8>>),
}

/// Compiles an expression for every degree; in it, `$boxes` is the list of that degree.
macro_rules! of_degree {
    // Two trees of one degree.
    ([$a:expr, $b:expr], $boxes:ident => $body:expr) => {
        match ($a, $b) {
            ($crate::tree::NodeLanes::Two(a), $crate::tree::NodeLanes::Two(b)) => {
                let $boxes = [a.as_slice(), b.as_slice()];
                $body
            }
            ($crate::tree::NodeLanes::Four(a), $crate::tree::NodeLanes::Four(b)) => {
                let $boxes = [a.as_slice(), b.as_slice()];
                $body
            }
            ($crate::tree::NodeLanes::Eight(a), $crate::tree::NodeLanes::Eight(b)) => {
                let $boxes = [a.as_slice(), b.as_slice()];
                $body
            }
            _ => unreachable!("trees of one world have one degree"),
        }
    };
    ($lanes:expr, $boxes:ident => $body:expr) => {
        match $lanes {
            $crate::tree::NodeLanes::Two($boxes) => $body,
            $crate::tree::NodeLanes::Four($boxes) => $body,
            $crate::tree::NodeLanes::Eight($boxes) => $body,
        }
    };
}
pub(crate) use of_degree;

impl NodeLanes {
    /// Allocates lanes for `count` wide nodes, all empty.
    pub(super) fn new(degree: usize, count: usize) -> Self {
        match degree {
            2 => Self::Two(vec![BoxLanes::EMPTY; count]),
            4 => Self::Four(vec![BoxLanes::EMPTY; count]),
            _ => Self::Eight(vec![BoxLanes::EMPTY; count]),
        }
    }

    /// Returns the box of one node.
    #[inline]
    pub(crate) fn one(&self, node: NodeId) -> Aabb {
        let (wide_node, lane) = node.wide_node_and_lane();
        of_degree!(self, boxes => boxes[wide_node.index()].get(lane))
    }

    /// Calls `show` with each lane of a wide node and the longest side of its box; NaN for unused
    /// lanes.
    #[inline]
    pub(crate) fn longest_sides(&self, wide_node: WideNodeId, mut show: impl FnMut(usize, f32)) {
        of_degree!(self, boxes => {
            let longest = boxes[wide_node.index()].longest_sides();
            longest.into_iter().enumerate().for_each(|(lane, side)| show(lane, side));
        });
    }

    /// Calls `kernels::near_mask` with two wide nodes.
    pub(crate) fn near_mask(
        both: [&Self; 2],
        wide_nodes: [WideNodeId; 2],
        lens: [usize; 2],
        limit: f64,
        instructions: Instructions,
    ) -> u64 {
        let [a, b] = wide_nodes.map(WideNodeId::index);
        of_degree!([both[0], both[1]], boxes => {
            dispatch!(instructions, i => near_mask(i, &boxes[0][a], &boxes[1][b], lens, limit))
        })
    }
}
