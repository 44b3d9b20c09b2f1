//! Questions of a world: lists, first hits and visits, all by one query and one form of answer.

use crate::arrays::{give, read};
use crate::hits::{Columns, PliantHits, Row};
use crate::status::{BAD_OPTION, PliantError, PliantStatus, Refused};
use crate::world::{Inside, PliantWorld, inside, with_world};
use pliant::{BodyId, ContactKind, Error, ErrorKind, Query, Selection};
use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

/// `pliant_query`: whom a question is about, how much is wanted, and what may end it early.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PliantQuery {
    /// Whom it is about.
    pub of: PliantSelection,
    /// Which hits are wanted, and in which order.
    pub how: u8,
    /// Most hits of a list; 0 for any number.
    pub at_most: u64,
    /// Shows hits instead of listing them, until it returns another number than 0.
    pub visit: Option<unsafe extern "C" fn(*mut c_void, *const PliantHits) -> c_int>,
    /// Ends the question early by returning another number than 0.
    pub interrupt: Option<unsafe extern "C" fn(*mut c_void) -> c_int>,
    /// Given to both.
    pub user: *mut c_void,
}

impl PliantQuery {
    /// All hits of everything, sorted.
    pub const ALL: Self = Self {
        of: PliantSelection {
            kind: 0,
            a: 0,
            b: 0,
        },
        how: ALL,
        at_most: 0,
        visit: None,
        interrupt: None,
        user: std::ptr::null_mut(),
    };
}

/// All hits, sorted.
const ALL: u8 = 0;
/// All hits in job order.
const UNSORTED: u8 = 1;
/// Some hit.
const FIRST: u8 = 2;
/// All hits in job order, and rows of them.
const ROWS: u8 = 3;
/// No hits: the work ahead.
const PREPARE: u8 = 4;

/// The caller's function that ends a call early, with its pointer.
#[derive(Clone, Copy)]
pub(crate) struct Interrupt {
    ask: Option<unsafe extern "C" fn(*mut c_void) -> c_int>,
    user: *mut c_void,
}

// SAFETY: the header says that any thread of the world may call it, several at a time.
unsafe impl Sync for Interrupt {}

impl Interrupt {
    /// Whether the caller ends the call.
    pub(crate) fn ends(&self) -> bool {
        // SAFETY: the caller gave this function for this.
        self.ask.is_some_and(|ask| unsafe { ask(self.user) } != 0)
    }
}

impl PliantQuery {
    fn interrupt(&self) -> Interrupt {
        Interrupt {
            ask: self.interrupt,
            user: self.user,
        }
    }

    /// A query of one answer: whom it is about, and what may end it.
    ///
    /// # Safety
    ///
    /// It is NULL, or as the header says.
    pub(crate) unsafe fn of_one_answer(
        query: *const Self,
    ) -> Result<(Selection, Interrupt), Refused> {
        // SAFETY: as above.
        let (of, until) = unsafe { (read(query), Self::interrupt_alone(query)?) };
        Ok((of.unwrap_or(Self::ALL).of.checked()?, until))
    }

    /// A query of which nothing is read but what may end it.
    ///
    /// # Safety
    ///
    /// It is NULL, or as the header says.
    pub(crate) unsafe fn interrupt_alone(query: *const Self) -> Result<Interrupt, Refused> {
        // SAFETY: as above.
        let asked = unsafe { read(query) }.unwrap_or(Self::ALL);
        if asked.how != ALL || asked.at_most != 0 || asked.visit.is_some() {
            let words = "query.how, at_most and visit are for lists; this has one answer: give 0";
            return Err(Refused::new(BAD_OPTION, words));
        }
        Ok(asked.interrupt())
    }
}

/// Answers a query of one kind with what is asked for, into columns of its own. Returns hits that
/// rows are wanted of.
fn answer<H: Row>(
    asked: &PliantQuery,
    query: Query<'_, H>,
    (list, shown): (&mut Columns, &mut Columns),
) -> Result<Option<Vec<H>>, Refused> {
    let most = match asked.at_most {
        0 => usize::MAX,
        most => usize::try_from(most).unwrap_or(usize::MAX),
    };
    let query = query.at_most(most);
    list.take::<H>(&[]);
    if asked.visit.is_some() && asked.at_most != 0 {
        let words = "query.at_most is for lists; a visitor ends the question itself";
        return Err(Refused::new(BAD_OPTION, words));
    }
    match (asked.how, asked.visit) {
        (ALL, Some(visit)) => {
            let _ = query.visit_some(|some| {
                shown.take(some);
                let view = shown.view();
                // SAFETY: the caller gave this function for this.
                match unsafe { visit(asked.user, &raw const view) } {
                    0 => ControlFlow::Continue(()),
                    _ => ControlFlow::Break(()),
                }
            })?;
        }
        (ALL, None) => list.take(query.all()?),
        (UNSORTED, None) => {
            // The order of visits, without a list of hits beside the columns.
            let done = query.visit_some(|some| {
                if some.len() > most - list.count() {
                    return ControlFlow::Break(ErrorKind::TooManyHits { limit: most });
                }
                list.add(some);
                ControlFlow::Continue(())
            });
            let failed = match done {
                Ok(ControlFlow::Continue(())) => return Ok(None),
                Ok(ControlFlow::Break(kind)) => Error { body: None, kind },
                Err(refused) => refused,
            };
            list.take::<H>(&[]);
            return Err(failed.into());
        }
        (ROWS, None) => {
            let mut all = Vec::new();
            query.unsorted(&mut all)?;
            list.take(&all);
            return Ok(Some(all));
        }
        (FIRST, None) => list.take(query.first()?.as_slice()),
        (PREPARE, None) => query.prepare()?,
        (how, None) => {
            let words = format_args!("query.how is {how}; give one of PLIANT_ALL to _PREPARE");
            return Err(Refused::new(BAD_OPTION, words));
        }
        (how, Some(_)) => {
            let words = format_args!("query.how is {how} with a visitor; give PLIANT_ALL");
            return Err(Refused::new(BAD_OPTION, words));
        }
    }
    Ok(None)
}

/// Asks a question, by its place among the lists and how the world is asked it.
macro_rules! ask {
    (
        $place:literal, ($world:ident, $query:ident, $hits:ident, $error:ident),
        |$of:ident, $inside:ident| $ask:expr
    ) => {{
        let work = |inside: &mut Inside| {
            // SAFETY: as the header says.
            let asked = unsafe { read($query) }.unwrap_or(PliantQuery::ALL);
            let $of: Selection = asked.of.checked()?;
            let interrupt = asked.interrupt();
            let question = || interrupt.ends();
            let list = &mut inside.lists[$place];
            with_world!(&mut inside.world, $inside => {
                let query = $ask;
                let query = match asked.interrupt {
                    Some(_) => query.interrupt_if(&question),
                    None => query,
                };
                if let Some(hits) = answer(&asked, query, (list, &mut inside.shown))? {
                    list.rows.update($inside, &hits)?;
                }
            });
            // SAFETY: as the header says.
            unsafe { give($hits, inside.lists[$place].view()) };
            Ok(())
        };
        // SAFETY: as the header says.
        unsafe { inside($world, $error, work) }
    }};
}

/// Functions of questions that take nothing, or a number.
macro_rules! questions {
    ($($place:literal, $name:ident, $method:ident $(, $number:ident)?;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`.")]
            ///
            /// # Safety
            ///
            /// Pointers are NULL, or as the header says.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                world: *mut PliantWorld,
                query: *const PliantQuery,
                $($number: f64,)?
                hits: *mut PliantHits,
                error: *mut PliantError,
            ) -> PliantStatus {
                ask!($place, (world, query, hits, error), |of, world| {
                    world.$method(of $(, $number)?)
                })
            }
        )*
    };
}

questions! {
    0, pliant_world_intersections, intersections;
    1, pliant_world_crossing_edges, crossing_edges;
    2, pliant_world_vertex_triangle_candidates, vertex_triangle_candidates, radius;
    3, pliant_world_edge_edge_candidates, edge_edge_candidates, radius;
    4, pliant_world_close_vertex_triangle_pairs, close_vertex_triangle_pairs, distance;
    5, pliant_world_close_edge_edge_pairs, close_edge_edge_pairs, distance;
    6, pliant_world_close_triangle_pairs, close_triangle_pairs, distance;
}

/// Functions of questions about contacts, of one kind or of all.
macro_rules! contacts {
    ($($place:literal, $name:ident, $method:ident;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`.")]
            ///
            /// # Safety
            ///
            /// Pointers are NULL, or as the header says.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                world: *mut PliantWorld,
                query: *const PliantQuery,
                only: u8,
                hits: *mut PliantHits,
                error: *mut PliantError,
            ) -> PliantStatus {
                ask!($place, (world, query, hits, error), |of, world| match kind(only)? {
                    None => world.$method(of),
                    Some(kind) => world.$method(of).only(kind),
                })
            }
        )*
    };
}

contacts! {
    7, pliant_world_contacts, contacts;
    8, pliant_world_adjacent_intersections, adjacent_intersections;
}

/// The only kind of contacts that is asked for.
fn kind(only: u8) -> Result<Option<ContactKind>, Refused> {
    match only {
        0 => Ok(None),
        1 => Ok(Some(ContactKind::Touching)),
        2 => Ok(Some(ContactKind::Overlapping)),
        3 => Ok(Some(ContactKind::Crossing)),
        other => Err(Refused::new(
            BAD_OPTION,
            format_args!("only is {other}; give one of PLIANT_APART, which is all, to _CROSSING"),
        )),
    }
}

/// Functions of questions about impacts.
macro_rules! impacts {
    ($($place:literal, $name:ident, $method:ident;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`.")]
            ///
            /// # Safety
            ///
            /// Pointers are NULL, or as the header says.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                world: *mut PliantWorld,
                query: *const PliantQuery,
                width: f64,
                hits: *mut PliantHits,
                error: *mut PliantError,
            ) -> PliantStatus {
                ask!($place, (world, query, hits, error), |of, world| {
                    world.$method(of).width(width)
                })
            }
        )*
    };
}

impacts! {
    9, pliant_world_vertex_triangle_impacts, vertex_triangle_impacts;
    10, pliant_world_edge_edge_impacts, edge_edge_impacts;
}

/// `pliant_selection`: whom a question is about.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantSelection {
    /// Which selection.
    pub kind: u32,
    /// The body, or the first of two.
    pub a: u32,
    /// The second of two.
    pub b: u32,
}

impl PliantSelection {
    pub(crate) fn checked(self) -> Result<Selection, Refused> {
        let (a, b) = (BodyId(self.a), BodyId(self.b));
        match self.kind {
            0 => Ok(Selection::Everything),
            1 => Ok(Selection::World),
            2 => Ok(Selection::Between(a, b)),
            3 => Ok(Selection::Within(a)),
            other => Err(Refused::new(
                BAD_OPTION,
                format_args!("of.kind is {other}; give one of PLIANT_EVERYTHING to _WITHIN"),
            )),
        }
    }
}
