//! Worlds: how they are made, copied and freed. One call at a time is inside.

use crate::arrays::read;
use crate::hits::Columns;
use crate::objects::{hand_out, take_back};
use crate::options::PliantOptions;
use crate::points::{F32, F64};
use crate::status::{BAD_SCALAR, BUSY, NULL, PANIC, PliantError, PliantStatus, Refused, call};
use pliant::World;
use std::any::Any;
use std::cell::UnsafeCell;
use std::sync::atomic::{AtomicU8, Ordering};

/// A world of either precision.
#[derive(Clone)]
pub(crate) enum AnyWorld {
    F32(World<f32>),
    F64(World<f64>),
}

/// Evaluates an expression with the [`World`] of an [`AnyWorld`], for either precision.
macro_rules! with_world {
    ($any:expr, $world:ident => $work:expr) => {
        match $any {
            $crate::world::AnyWorld::F32($world) => $work,
            $crate::world::AnyWorld::F64($world) => $work,
        }
    };
}
pub(crate) use with_world;

/// Kinds of questions that have a list each.
pub(crate) const QUESTIONS: usize = 11;

/// The world and its answers, which a call that is inside may change.
pub(crate) struct Inside {
    pub(crate) world: AnyWorld,
    /// Options that it was made with.
    pub(crate) options: PliantOptions,
    /// The last list of each question.
    pub(crate) lists: [Columns; QUESTIONS],
    /// Hits that a visitor is shown.
    pub(crate) shown: Columns,
    /// Answers of other functions that the caller still reads.
    pub(crate) views: Views,
}

/// Answers that the caller reads until the same function is called again: one of each type.
#[derive(Default)]
pub(crate) struct Views(Vec<Box<dyn Any>>);

impl Views {
    /// The one of a type, which is empty at first.
    pub(crate) fn of<T: Default + 'static>(&mut self) -> &mut T {
        let place = self.0.iter().position(|it| it.is::<T>());
        let place = place.unwrap_or_else(|| {
            self.0.push(Box::new(T::default()));
            self.0.len() - 1
        });
        let found = self.0[place].downcast_mut();
        found.expect("it was looked for by its type")
    }
}

/// `pliant_world`.
pub struct PliantWorld {
    /// [`FREE`], or why no call may begin.
    state: AtomicU8,
    inside: UnsafeCell<Inside>,
}

/// State of a world: no call is inside.
const FREE: u8 = 0;
/// State of a world: a call is inside.
const TAKEN: u8 = 1;
/// State of a world: a call ended in a panic.
const BROKEN: u8 = 2;

impl PliantWorld {
    fn new(world: AnyWorld, options: PliantOptions) -> Self {
        Self {
            state: AtomicU8::new(FREE),
            inside: UnsafeCell::new(Inside {
                world,
                options,
                lists: Default::default(),
                shown: Columns::default(),
                views: Views::default(),
            }),
        }
    }
}

/// A call that is inside a world. A panic leaves the world broken.
struct Taken<'w> {
    world: &'w PliantWorld,
    leaves: u8,
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        self.world.state.store(self.leaves, Ordering::Release);
    }
}

/// Runs a call with what is inside a world, unless it is NULL, another call is inside, or one broke
/// it.
///
/// # Safety
///
/// `world` is NULL, or a world that was made and not freed. `error` is NULL, or may be written.
pub(crate) unsafe fn inside(
    world: *const PliantWorld,
    error: *mut PliantError,
    work: impl FnOnce(&mut Inside) -> Result<(), Refused>,
) -> PliantStatus {
    let work = || {
        // SAFETY: as above; a world is only ever shared.
        let Some(world) = (unsafe { world.as_ref() }) else {
            return Err(Refused::new(
                NULL,
                "world is NULL; give one of pliant_world_new",
            ));
        };
        let (free, taken) = (Ordering::Relaxed, Ordering::Acquire);
        if let Err(state) = world.state.compare_exchange(FREE, TAKEN, taken, free) {
            return Err(if state == BROKEN {
                let words = "the world is broken by an earlier fault; free it, and make another";
                Refused::new(PANIC, words)
            } else {
                let words = "another call is inside this world; wait for it, and call none of one";
                Refused::new(BUSY, words)
            });
        }
        let leaves = BROKEN;
        let mut taken = Taken { world, leaves };
        // SAFETY: no other call is inside, so this is the only reference.
        let done = work(unsafe { &mut *world.inside.get() });
        taken.leaves = FREE;
        done
    };
    // SAFETY: as above.
    unsafe { call(error, work) }
}

/// Functions of worlds: name, arguments, and the call that is inside.
macro_rules! calls {
    ($(fn $name:ident($($argument:ident: $type:ty),* $(,)?) |$inside:ident| $work:block)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`.")]
            ///
            /// # Safety
            ///
            /// Pointers are NULL, or as the header says.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                world: *const $crate::world::PliantWorld,
                $($argument: $type,)*
                error: *mut $crate::status::PliantError,
            ) -> $crate::status::PliantStatus {
                let work = |$inside: &mut $crate::world::Inside| $work;
                // SAFETY: as the header says.
                unsafe { $crate::world::inside(world, error, work) }
            }
        )*
    };
}
pub(crate) use calls;

/// `pliant_world_new`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_new(
    options: *const PliantOptions,
    world: *mut *mut PliantWorld,
    error: *mut PliantError,
) -> PliantStatus {
    let make = || {
        // SAFETY: as the header says.
        let options = unsafe { read(options) }.unwrap_or_default();
        let made = match options.scalar {
            // SAFETY: as the header says of the pool.
            F32 => AnyWorld::F32(unsafe { options.world()? }),
            // SAFETY: as the header says of the pool.
            F64 => AnyWorld::F64(unsafe { options.world()? }),
            other => {
                return Err(Refused::new(
                    BAD_SCALAR,
                    format_args!("options.scalar is {other}; give PLIANT_F32 or PLIANT_F64"),
                ));
            }
        };
        Ok(PliantWorld::new(made, options))
    };
    // SAFETY: as the header says.
    unsafe { call(error, || hand_out(world, "world", make)) }
}

calls! {
    fn pliant_world_clone(copy: *mut *mut PliantWorld) |inside| {
        let make = || Ok(PliantWorld::new(inside.world.clone(), inside.options));
        // SAFETY: as the header says.
        unsafe { hand_out(copy, "copy", make) }
    }
}

/// `pliant_world_free`.
///
/// # Safety
///
/// The world is NULL, or was made, is not freed, and no call is inside.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_free(world: *mut PliantWorld) {
    // SAFETY: as above.
    unsafe { take_back(world) };
}
