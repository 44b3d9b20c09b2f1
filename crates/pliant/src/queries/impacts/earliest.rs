//! Earliest contact of a motion, shared by all tasks of a search.
//!
//! Each contact found is compared with it immediately, and not stored.//!
//! It is the least in one order: by exact time, then vertices and triangles before edges, then by
//! the caller's numbers. So it does not depend on the order in which contacts come. Its time bounds
//! the search, and may become smaller at any moment. A contact is skipped if it is surely later,
//! or if it is surely not earlier and loses the tie-break.

use super::hit::Impact;
use pliant_exact::motion::{Certain, Contact, Decided, Grid, Moving, first_contact, quick};
use std::cmp::Ordering::Less;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{PoisonError, RwLock};

/// Width of the cells of times that bound the search: 2^-40.
const WIDTH: f64 = f64::from_bits((1023 - 40) << 52);

/// The earliest contact so far, or the first time at which elements come as near as a distance.
#[derive(Debug)]
pub(crate) struct Earliest {
    /// Whether contacts at the start are left out.
    after_start: bool,
    /// Time to which the motion is looked at. Later contacts may not be the first.
    reach: f64,
    /// Bits of a time that bounds the search. Numbers that are not negative are ordered as their
    /// bits.
    until: AtomicU64,
    first: RwLock<Option<First>>,
}

/// Two elements that meet, and their exact time.
#[derive(Debug)]
pub(crate) struct First {
    pub(crate) impact: Impact,
    pub(crate) contact: Contact,
}

impl First {
    /// The impact with its cell of a grid.
    pub(crate) fn in_cell_of(self, grid: Grid) -> Impact {
        self.impact.with_cell(self.contact.cell(grid))
    }
}

impl Earliest {
    pub(crate) fn new(after_start: bool, reach: f64) -> Self {
        Self {
            after_start,
            reach,
            until: AtomicU64::new(f64::INFINITY.to_bits()),
            first: RwLock::default(),
        }
    }

    /// Time after which nothing is of interest.
    pub(crate) fn until(&self) -> f64 {
        self.known().min(self.reach)
    }

    /// Time of the earliest contact, or a little later. Infinite if none is known.
    pub(crate) fn known(&self) -> f64 {
        f64::from_bits(self.until.load(Ordering::Relaxed))
    }

    /// Elements that are known to meet at the start. Nothing is earlier, so only what comes before
    /// them in order is of interest.
    pub(crate) fn known_at_start(&self) -> Option<Impact> {
        if self.known() > 0.0 {
            return None;
        }
        let first = self.first.read().unwrap_or_else(PoisonError::into_inner);
        first.as_ref().map(|known| known.impact)
    }

    pub(crate) fn first(self) -> Option<First> {
        self.first
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Records a time at which elements come near, if none is earlier.
    pub(super) fn take_time(&self, time: f64) {
        if time <= self.reach {
            self.until.fetch_min(time.to_bits(), Ordering::Relaxed);
        }
    }

    /// Offers two elements, which are recorded if they meet and come before all others. Returns
    /// whether, and how that was decided.
    pub(super) fn offer(&self, moving: &Moving, impact: Impact) -> (bool, Decided) {
        let grid = Grid::new(WIDTH);
        let until = self.until();
        let cell = match quick(moving, grid, until) {
            Certain::Never => return (false, Decided::InFloatingPoint),
            Certain::Within(cell) => Some(cell),
            Certain::Nothing => None,
        };
        let is_of_no_interest =
            |[_, high]: [f64; 2]| high > until || self.after_start && high == 0.0;
        if cell.is_some_and(is_of_no_interest) {
            return (false, Decided::InFloatingPoint);
        }
        if cell.is_none_or(|[_, high]| high == until) && self.surely_precedes(moving, impact) {
            return (false, Decided::InIntegers);
        }
        let contact = match cell {
            Some([_, 0.0]) => Some(Contact::AtStart),
            _ => first_contact(moving),
        };
        let is_taken = contact.is_some_and(|contact| self.take(First { impact, contact }));
        (is_taken, Decided::InIntegers)
    }

    /// Whether the known contact surely comes before two elements, without their own time being
    /// computed.
    fn surely_precedes(&self, moving: &Moving, impact: Impact) -> bool {
        let first = self.first.read().unwrap_or_else(PoisonError::into_inner);
        first.as_ref().is_some_and(|known| {
            let may_tie = known.impact.order() < impact.order();
            known.contact.surely_precedes(moving, self.known(), may_tie)
        })
    }

    fn take(&self, new: First) -> bool {
        let is_at_start = matches!(new.contact, Contact::AtStart);
        if self.after_start && is_at_start || !new.contact.is_at_most(self.reach) {
            return false;
        }
        let mut first = self.first.write().unwrap_or_else(PoisonError::into_inner);
        let is_earlier = first.as_ref().is_none_or(|known| {
            let by_time = new.contact.compare(&known.contact);
            let in_order = || new.impact.order().cmp(&known.impact.order());
            by_time.then_with(in_order) == Less
        });
        if is_earlier {
            let [_, high] = new.contact.cell(Grid::new(WIDTH));
            self.until.store(high.to_bits(), Ordering::Relaxed);
            *first = Some(new);
        }
        is_earlier
    }
}
