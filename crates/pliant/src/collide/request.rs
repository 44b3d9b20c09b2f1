//! Parameters of a query, and the trait that answers it.

use crate::error::{Error, ErrorKind};
use crate::queries::{ContactKind, Margin};
use crate::selection::Selection;
use crate::threads::Question;
use crate::traversal::Visitor;
use pliant_exact::motion::Grid;

/// Default width of intervals of times.
const WIDTH: f64 = 1e-6;

/// Parameters of a query.
#[derive(Clone, Copy)]
pub(crate) struct Request<'q> {
    pub(crate) of: Selection,
    /// Most hits that a list may have.
    pub(crate) most: usize,
    pub(crate) question: Option<Question<'q>>,
    /// Margin round each element for candidates, largest distance for close pairs; else 0.
    pub(crate) within: f64,
    /// Whether labels and rest shapes leave out pairs of one body, of kinds that look at them.
    pub(crate) leaves_out: bool,
    /// Width that intervals of times may have, for impacts; other kinds ignore it.
    pub(crate) width: f64,
    /// Only kind of contact that is asked for, if not all are.
    pub(crate) only: Option<ContactKind>,
}

impl Request<'_> {
    /// Request for all hits of a selection, with defaults for everything else.
    pub(crate) fn new(of: Selection) -> Self {
        Self {
            of,
            most: usize::MAX,
            question: None,
            within: 0.0,
            leaves_out: true,
            width: WIDTH,
            only: None,
        }
    }

    /// Margin that is asked for; fails if it is negative or not finite.
    pub(crate) fn margin(&self) -> Result<Margin, Error> {
        let radius = self.within;
        checked(radius, ErrorKind::BadMargin { radius }).map(Margin::new)
    }

    /// Grid of times that is asked for; fails if its width is negative or not finite.
    pub(crate) fn grid(&self) -> Result<Grid, Error> {
        let width = self.width;
        checked(width, ErrorKind::BadWidth { width }).map(Grid::new)
    }

    /// Distance that is asked for; fails if it is negative or not finite.
    pub(crate) fn distance(&self) -> Result<f64, Error> {
        let distance = self.within;
        checked(distance, ErrorKind::BadDistance { distance })
    }
}

/// Checks that a number is finite and at least 0.
fn checked(number: f64, wrong: ErrorKind) -> Result<f64, Error> {
    if number.is_finite() && number >= 0.0 {
        return Ok(number);
    }
    Err(wrong.of_query())
}

/// Answers queries of one kind.
pub(crate) trait Ask<H> {
    fn all(&mut self, request: &Request) -> Result<&[H], Error>;
    fn first(&mut self, request: &Request) -> Result<Option<H>, Error>;
    fn visit(&mut self, request: &Request, visitor: Visitor<H>) -> Result<(), Error>;
    fn prepare(&mut self, request: &Request) -> Result<(), Error>;
}
