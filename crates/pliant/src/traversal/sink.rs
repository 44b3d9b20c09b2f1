//! Where hits go: to a visitor, who may stop at any, or to a collector, which wants all.

use std::ops::ControlFlow;

/// Is shown every hit once, some at a time, until it breaks with the place of the one at which it stops, which may be the first.
pub(crate) type Visitor<'s, H> = &'s mut dyn FnMut(&[H]) -> ControlFlow<usize>;

/// Is shown every hit once, some at a time, by any thread and in any order, until it breaks because there are too many; then it
/// always does.
pub(crate) type Collector<'s, H> = &'s (dyn Fn(&[H]) -> ControlFlow<()> + Sync);

/// Where hits go.
pub(crate) enum Sink<'s, H> {
    Visitor(Visitor<'s, H>),
    Collector(Collector<'s, H>),
}

impl<'s, H> Sink<'s, H> {
    /// The collector, which wants all there is.
    pub(crate) fn collector(&self) -> Option<Collector<'s, H>> {
        match self {
            Self::Collector(collector) => Some(*collector),
            Self::Visitor(_) => None,
        }
    }
}
