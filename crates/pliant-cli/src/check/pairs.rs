//! What intersects in one frame: all that will be printed is kept, and no more.
//!
//! A small file can hold a great many intersecting pairs: their number is up to the square of the number of triangles. Where only
//! their number is asked for, none is kept; where they are listed, the list has a limit.

use super::Arguments;
use anyhow::bail;
use pliant::{Pair, Scalar, World};
use std::ops::ControlFlow;

/// Body, triangle, body, triangle; the smaller (body, triangle) first.
pub(super) type Row = [u32; 4];

/// The pairs of a frame.
pub(super) struct Pairs {
    pub(super) count: usize,
    pub(super) smallest: Option<Row>,
    /// Sorted; empty where they are not listed.
    pub(super) list: Vec<Row>,
    listed: bool,
    most: usize,
}

/// The list would be longer than it may be.
struct Full;

impl Pairs {
    /// None yet. `listed`: keep all of them, in `max_memory` bytes.
    pub(super) fn new(listed: bool, max_memory: u64) -> Self {
        Self {
            count: 0,
            smallest: None,
            list: Vec::new(),
            listed,
            most: usize::try_from(max_memory / size_of::<Row>() as u64).unwrap_or(usize::MAX),
        }
    }

    /// Replaces the pairs by those of `world`; at most one of them if only the first is asked for.
    pub(super) fn find<S: Scalar>(
        &mut self,
        arguments: &Arguments,
        world: &mut World<S>,
    ) -> anyhow::Result<()> {
        (self.count, self.smallest) = (0, None);
        self.list.clear();
        if let ControlFlow::Break(Full) = self.visit(arguments, world)? {
            bail!(
                "more than {} pairs intersect, and their list needs more memory than is allowed; allow more with `--max-memory`, or ask for less with `--count` or `--first`",
                self.most
            );
        }
        self.list.sort_unstable();
        Ok(())
    }

    fn visit<S: Scalar>(
        &mut self,
        arguments: &Arguments,
        world: &mut World<S>,
    ) -> anyhow::Result<ControlFlow<Full>> {
        let bodies: Vec<_> = world.bodies().collect();
        let itself = arguments.itself || bodies.len() == 1;
        if arguments.first {
            let mut first = world.first_intersection().map(row);
            for body in bodies.into_iter().filter(|_| itself) {
                if first.is_none() {
                    let pair = world.first_self_intersection(body)?;
                    first = pair.map(|[a, b]| [body.0, a, body.0, b]);
                }
            }
            return Ok(first.map_or(ControlFlow::Continue(()), |row| self.add(row)));
        }
        let mut flow = world.visit_intersections(|pair| self.add(row(pair)));
        for body in bodies.into_iter().filter(|_| itself) {
            if flow.is_continue() {
                flow = world
                    .visit_self_intersections(body, |[a, b]| self.add([body.0, a, body.0, b]))?;
            }
        }
        Ok(flow)
    }

    fn add(&mut self, row: Row) -> ControlFlow<Full> {
        self.count += 1;
        self.smallest = Some(self.smallest.map_or(row, |smallest| smallest.min(row)));
        if self.listed {
            if self.list.len() >= self.most || self.list.try_reserve(1).is_err() {
                return ControlFlow::Break(Full);
            }
            self.list.push(row);
        }
        ControlFlow::Continue(())
    }
}

fn row(pair: Pair) -> Row {
    [
        pair.body_a.0,
        pair.triangle_a,
        pair.body_b.0,
        pair.triangle_b,
    ]
}
