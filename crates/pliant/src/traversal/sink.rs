//! Sinks of hits: a visitor, which may stop at any hit, or a collector, which wants all.

use std::ops::ControlFlow;

/// Sequential sink: is shown every hit once, in slices. Breaks with the place in the slice of the
/// hit at which it stops, which may be the first.
pub(crate) type Visitor<'s, H> = &'s mut dyn FnMut(&[H]) -> ControlFlow<usize>;

/// Concurrent sink: is shown every hit once, in slices, by any thread and in any order. Breaks when
/// there are too many hits, and from then on always.
pub(crate) type Collector<'s, H> = &'s (dyn Fn(&[H]) -> ControlFlow<()> + Sync);

/// Sink of a query's hits: internal hits (`H`) to a collector, public ones (`V`) to a visitor.
pub(crate) enum Sink<'s, H, V> {
    Visitor(Visitor<'s, V>),
    Collector(Collector<'s, H>),
}

impl<'s, H, V> Sink<'s, H, V> {
    /// The collector, which wants all there is.
    pub(crate) fn collector(&self) -> Option<Collector<'s, H>> {
        match self {
            Self::Collector(collector) => Some(*collector),
            Self::Visitor(_) => None,
        }
    }
}
