//! Answers of most kinds: a request becomes a kind, which is asked for all hits, the first, or a
//! visit.

use crate::error::Error;
use crate::traversal::Visitor;
use std::ops::ControlFlow;

/// Implements queries for a hit type.
///
/// Given are the field of `Kinds` with the buffers, its method that makes a list, and how a request
/// becomes a kind.
macro_rules! ask {
    ($hit:ty, $kept:ident.$all:ident, |$request:ident| $kind:expr) => {
        impl<S: Coordinate> Ask<$hit> for State<S> {
            fn all(&mut self, $request: &Request) -> Result<&[$hit], Error> {
                let kind = &$kind;
                self.kinds.$kept.$all(kind, &mut self.common, $request)
            }

            fn first(&mut self, request: &Request) -> Result<Option<$hit>, Error> {
                first_seen(|visitor| Ask::<$hit>::visit(self, request, visitor))
            }

            fn visit(&mut self, $request: &Request, visitor: Visitor<$hit>) -> Result<(), Error> {
                let kind = &$kind;
                self.kinds
                    .$kept
                    .visit(kind, &mut self.common, $request, visitor)
            }

            fn prepare(&mut self, $request: &Request) -> Result<(), Error> {
                let needs = $kind.needs();
                self.common.prepare(needs, $request)
            }
        }
    };
}

/// Returns the first hit that a visit shows.
pub(super) fn first_seen<H: Copy>(
    visit: impl FnOnce(Visitor<H>) -> Result<(), Error>,
) -> Result<Option<H>, Error> {
    let mut found = None;
    visit(&mut |hits| {
        found = hits.first().copied();
        if found.is_some() {
            ControlFlow::Break(0)
        } else {
            ControlFlow::Continue(())
        }
    })?;
    Ok(found)
}
