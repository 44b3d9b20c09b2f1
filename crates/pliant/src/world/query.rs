//! Query as a builder: whom it is about, how much is wanted, and what may end it early.

use crate::collide::{Ask, Request};
use crate::error::{Error, ErrorKind};
use crate::selection::Selection;
use crate::threads::Question;
use std::fmt;
use std::ops::ControlFlow;

/// Query of a [`World`](crate::World) that waits to be told how much is wanted.
///
/// That is [`all`](Self::all) hits, the [`first`](Self::first), or a [`visit`](Self::visit) to one
/// after the other.
///
/// # Errors
///
/// Whatever is wanted, these are the errors, after which the world stays usable:
///
/// - [`NoSuchBody`](crate::ErrorKind::NoSuchBody) if the selection names a body that is not there;
/// - [`SameBody`](crate::ErrorKind::SameBody) if it names one body as two;
/// - [`Interrupted`](crate::ErrorKind::Interrupted) if [`interrupt_if`](Self::interrupt_if) said
///   so;
/// - [`TooManyHits`](crate::ErrorKind::TooManyHits) if a list would be longer than
///   [`at_most`](Self::at_most) allows;
/// - [`BadWidth`](crate::ErrorKind::BadWidth) for impacts, if the width is negative, infinite or
///   NaN;
/// - [`BadMargin`](crate::ErrorKind::BadMargin) for candidates, if the radius is negative, infinite
///   or NaN;
/// - [`BadDistance`](crate::ErrorKind::BadDistance) for close pairs, if the distance is.
#[must_use = "a query does nothing until it is asked for all, for the first, or to visit"]
pub struct Query<'w, H> {
    asked: &'w mut dyn Ask<H>,
    pub(super) request: Request<'w>,
}

impl<'w, H: Copy> Query<'w, H> {
    pub(super) fn new(asked: &'w mut dyn Ask<H>, of: Selection) -> Self {
        Self {
            asked,
            request: Request::new(of),
        }
    }

    /// Sets the margin round each element, or the distance.
    pub(super) fn within(mut self, length: f64) -> Self {
        self.request.within = length;
        self
    }

    /// Has labels and rest shapes leave nothing out.
    pub(super) fn leaving_nothing_out(mut self) -> Self {
        self.request.leaves_out = false;
        self
    }

    /// Refuses a list of more hits than this, instead of filling the memory.
    ///
    /// While hits are found, no more than these are held, and some thousands a thread.
    pub fn at_most(mut self, hits: usize) -> Self {
        self.request.most = hits;
        self
    }

    /// Ends the query early, with an error, when `question` says so.
    ///
    /// Every thread that works on the query asks, at least every 10 milliseconds and mostly much
    /// more often. So a question should cost little: a flag that is read, a clock. Four things may
    /// take longer between two looks:
    ///
    /// - memory for a list of millions is asked of the system in one piece;
    /// - a list of hundreds of thousands of pairs of bodies is sorted in one piece;
    /// - labels of a mesh that was edited are sorted in one piece;
    /// - one pair of moving elements may take some ten milliseconds, where its coordinates are a
    ///   thousand powers of two apart.
    ///
    /// The next query makes the boxes of all bodies anew; nothing else is lost.
    ///
    /// ```
    /// # use pliant::{ErrorKind, Selection, World};
    /// use std::sync::atomic::{AtomicBool, Ordering};
    ///
    /// # let mut world = World::<f32>::new();
    /// # let cloth = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let stop = AtomicBool::new(true);
    /// let stopped = || stop.load(Ordering::Relaxed);
    /// let answer = world.intersections(Selection::Within(cloth)).interrupt_if(&stopped).all();
    /// assert_eq!(answer.unwrap_err().kind, ErrorKind::Interrupted);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn interrupt_if(mut self, question: &'w (dyn Fn() -> bool + Sync)) -> Self {
        self.request.question = Some(question);
        self
    }

    /// Ends the query early as [`interrupt_if`](Self::interrupt_if), if there is a question.
    pub(crate) fn interrupt(mut self, question: Option<Question<'w>>) -> Self {
        self.request.question = question;
        self
    }

    /// Returns all hits, sorted: equal for every option, history and number of threads.
    ///
    /// The slice is valid until the next call.
    ///
    /// Cost: the broad phase of a query of the whole world is O(b + overlaps), for b bodies that
    /// move a little. For bodies whose boxes overlap, the cost grows with the region where they are
    /// close. Sorting is O(hits).
    ///
    /// # Errors
    ///
    /// See [`Query`].
    pub fn all(self) -> Result<&'w [H], Error> {
        self.asked.all(&self.request)
    }

    /// Replaces a list by all hits, in job order: not sorted, in the order of
    /// [`visit`](Self::visit).
    ///
    /// That order is equal for any number of threads and any instruction set. With other options,
    /// or another history, it may differ. It is for callers that sum over many hits in whatever
    /// order; [`HitRows`](crate::HitRows) groups them. Several threads may be slower than
    /// [`all`](Self::all), which they share better. The list keeps its memory; if the query fails,
    /// it is empty.
    ///
    /// # Errors
    ///
    /// See [`Query`].
    pub fn unsorted(self, list: &mut Vec<H>) -> Result<(), Error> {
        list.clear();
        let most = self.request.most;
        let mut are_too_many = false;
        let done = self.asked.visit(&self.request, &mut |found| {
            are_too_many = found.len() > most - list.len();
            if are_too_many {
                return ControlFlow::Break(0);
            }
            list.extend_from_slice(found);
            ControlFlow::Continue(())
        });
        let limit = most;
        let done = if are_too_many {
            Err(ErrorKind::TooManyHits { limit }.of_query())
        } else {
            done
        };
        if done.is_err() {
            list.clear();
        }
        done
    }

    /// Returns some hit, if there is one: much cheaper than all where there are many.
    ///
    /// Whether there is one never depends on options or history; which one may. Of impacts it is
    /// the one with the least exact time, and of several at one time the first in order.
    ///
    /// # Errors
    ///
    /// See [`Query`].
    pub fn first(self) -> Result<Option<H>, Error> {
        self.asked.first(&self.request)
    }

    /// Shows `visit` every hit once, until it breaks. Returns the value that it broke with.
    ///
    /// The order is deterministic, not sorted.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// use std::ops::ControlFlow;
    ///
    /// # let mut world = World::<f32>::new();
    /// # for z in [0.0, 0.5] {
    /// #     let corners = [[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z], [0.0, 0.0, z + 1.0]];
    /// #     world.add(&[[0, 1, 2], [0, 1, 3]], &corners)?;
    /// # }
    /// let mut budget = 2;
    /// let exhausted = world.intersections(Selection::World).visit(|pair| {
    ///     println!("triangle {} of {}", pair.triangle_a, pair.body_a);
    ///     println!("meets triangle {} of {}", pair.triangle_b, pair.body_b);
    ///     budget -= 1;
    ///     if budget == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    /// })?;
    /// # assert!(exhausted.is_break());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// See [`Query`]. Hits that were shown before an interruption are true.
    pub fn visit<B>(
        self,
        mut visit: impl FnMut(H) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let mut answer = ControlFlow::Continue(());
        self.asked.visit(&self.request, &mut |found| {
            for (place, &hit) in found.iter().enumerate() {
                if let ControlFlow::Break(value) = visit(hit) {
                    answer = ControlFlow::Break(value);
                    return ControlFlow::Break(place);
                }
            }
            ControlFlow::Continue(())
        })?;
        Ok(answer)
    }

    /// Shows `visit` every hit once, some at a time, until it breaks. Returns the value that it
    /// broke with.
    ///
    /// This is for callers that count or filter many: no list of all is made. The order, and how
    /// many come at a time, are deterministic.
    ///
    /// # Errors
    ///
    /// See [`Query`]. Hits that were shown before an interruption are true.
    pub fn visit_some<B>(
        self,
        mut visit: impl FnMut(&[H]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let mut answer = ControlFlow::Continue(());
        self.asked.visit(&self.request, &mut |found| {
            if !found.is_empty()
                && let ControlFlow::Break(value) = visit(found)
            {
                answer = ControlFlow::Break(value);
                return ControlFlow::Break(0);
            }
            ControlFlow::Continue(())
        })?;
        Ok(answer)
    }

    /// Prepares the query: does early what it would do first, and asks nothing.
    ///
    /// It finds the bodies that may meet and refits the upper levels of their trees; in a body that
    /// meets itself, all levels. Right answers never need it. It is for callers that time this
    /// part, or have time to spare.
    ///
    /// # Errors
    ///
    /// See [`Query`].
    pub fn prepare(self) -> Result<(), Error> {
        self.asked.prepare(&self.request)
    }
}

impl<H> fmt::Debug for Query<'_, H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Query")
            .field("of", &self.request.of)
            .finish_non_exhaustive()
    }
}
