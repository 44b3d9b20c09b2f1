//! Where hits go: to a visitor, who may stop at any, or to a collector, which wants all.

use std::ops::ControlFlow;

/// Is shown every hit once, some at a time, until it breaks with the place of the one at which it stops, which may be the first.
pub(crate) type Visitor<'s, H> = &'s mut dyn FnMut(&[H]) -> ControlFlow<usize>;

/// Is shown every hit once, some at a time, by any thread and in any order, until it breaks because there are too many; then it
/// always does.
pub(crate) type Collector<'s, H> = &'s (dyn Fn(&[H]) -> ControlFlow<()> + Sync);

/// Where hits go: as they are to a collector, as they are shown to a visitor.
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
