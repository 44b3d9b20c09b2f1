//! Questions of a world: lists, first hits and visits, all by one query and one form of answer.

use crate::hits::{Columns, PliantHits, Row};
use crate::status::{BAD_OPTION, PliantError, PliantStatus, Refused};
use crate::world::{Inside, PliantSelection, PliantWorld, give, inside, with_world};
use pliant::{ContactKind, Query, Selection};
use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

/// `pliant_query`: whom a question is about, how much is wanted, and what may end it early.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PliantQuery {
    /// Whom it is about.
    pub of: PliantSelection,
    /// 1 for some hit, 0 for all.
    pub first: u8,
    /// 1 for job order, 0 for sorted.
    pub unsorted: u8,
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
        first: 0,
        unsorted: 0,
        at_most: 0,
        visit: None,
        interrupt: None,
        user: std::ptr::null_mut(),
    };
}

/// The caller's pointer, which threads hand to the caller's function.
#[derive(Clone, Copy)]
struct User(*mut c_void);

// SAFETY: the header says that any thread may call `interrupt`, several at a time.
unsafe impl Sync for User {}

impl User {
    fn get(&self) -> *mut c_void {
        self.0
    }
}

/// Answers a query of one kind with what is asked for, into columns of its own.
fn answer<H: Row>(
    asked: &PliantQuery,
    query: Query<'_, H>,
    (list, shown): (&mut Columns, &mut Columns),
) -> Result<(), Refused> {
    if asked.first > 1 || asked.unsorted > 1 {
        let words = "query.first and query.unsorted are 0 or 1";
        return Err(Refused::new(BAD_OPTION, words));
    }
    let query = match asked.at_most {
        0 => query,
        most => query.at_most(usize::try_from(most).unwrap_or(usize::MAX)),
    };
    if let Some(visit) = asked.visit {
        list.take::<H>(&[]);
        let _ = query.visit_some(|some| {
            shown.take(some);
            let view = shown.view();
            // SAFETY: the caller gave this function for this.
            match unsafe { visit(asked.user, &raw const view) } {
                0 => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        })?;
    } else if asked.first == 1 {
        list.take::<H>(&[]);
        list.take(query.first()?.as_slice());
    } else if asked.unsorted == 1 {
        list.take::<H>(&[]);
        let mut all = Vec::new();
        query.unsorted(&mut all)?;
        list.take(&all);
    } else {
        list.take::<H>(&[]);
        list.take(query.all()?);
    }
    Ok(())
}

/// Asks a question, by its place among the lists and how the world is asked it.
macro_rules! ask {
    (
        $place:literal, ($world:ident, $query:ident, $hits:ident, $error:ident),
        |$of:ident, $inside:ident| $ask:expr
    ) => {{
        let work = |inside: &mut Inside| {
            // SAFETY: as the header says.
            let asked = unsafe { $query.as_ref() }.copied().unwrap_or(PliantQuery::ALL);
            let $of: Selection = asked.of.checked()?;
            let user = User(asked.user);
            let interrupt = asked.interrupt;
            let question = || {
                // SAFETY: the caller gave this function for this.
                interrupt.is_some_and(|interrupt| unsafe { interrupt(user.get()) } != 0)
            };
            let lists = (&mut inside.lists[$place], &mut inside.shown);
            with_world!(&mut inside.world, $inside => {
                let query = $ask;
                let query = match interrupt {
                    Some(_) => query.interrupt_if(&question),
                    None => query,
                };
                answer(&asked, query, lists)?;
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

/// `pliant_world_collision_free_step`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_collision_free_step(
    world: *mut PliantWorld,
    of: PliantSelection,
    min_distance: f64,
    step: *mut f64,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        let of = of.checked()?;
        let free = with_world!(&mut inside.world, world => {
            world.collision_free_step(of, min_distance)?
        });
        // SAFETY: as the header says.
        unsafe { give(step, free) };
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}
