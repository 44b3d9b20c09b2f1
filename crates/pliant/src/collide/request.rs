//! What a query is asked with, and who answers it.

use crate::error::{Error, ErrorKind};
use crate::queries::{ContactKind, Margin};
use crate::selection::Selection;
use crate::threads::Question;
use crate::traversal::Visitor;
use pliant_exact::motion::Grid;

/// How wide intervals of times may be, if nothing is said.
const WIDTH: f64 = 1e-6;

/// What a query is asked with.
#[derive(Clone, Copy)]
pub(crate) struct Request<'q> {
    pub(crate) of: Selection,
    /// The most hits that a list may have.
    pub(crate) most: usize,
    pub(crate) question: Option<Question<'q>>,
    /// Of candidates, the margin round each element; of close pairs, how far they may be apart; else 0.
    pub(crate) within: f64,
    /// Of impacts, how wide the intervals of times may be; else nothing.
    pub(crate) width: f64,
    /// Of contacts, the one kind that is asked for; else nothing.
    pub(crate) only: Option<ContactKind>,
}

impl Request<'_> {
    /// Of all hits, with nothing said but of whom.
    pub(crate) fn new(of: Selection) -> Self {
        Self {
            of,
            most: usize::MAX,
            question: None,
            within: 0.0,
            width: WIDTH,
            only: None,
        }
    }

    /// The margin that is asked for.
    pub(crate) fn margin(&self) -> Result<Margin, Error> {
        let radius = self.within;
        checked(radius, ErrorKind::BadMargin { radius }).map(Margin::new)
    }

    /// The grid of times that is asked for.
    pub(crate) fn grid(&self) -> Result<Grid, Error> {
        let width = self.width;
        checked(width, ErrorKind::BadWidth { width }).map(Grid::new)
    }

    /// The distance that is asked for.
    pub(crate) fn distance(&self) -> Result<f64, Error> {
        let distance = self.within;
        checked(distance, ErrorKind::BadDistance { distance })
    }
}

/// A number that is finite and at least 0; else what is wrong.
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
