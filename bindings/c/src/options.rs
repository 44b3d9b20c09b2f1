//! Options of worlds, and whose threads work for them: their own, a pool's, or the caller's.

use crate::arrays::give;
use crate::objects::{hand_out, take_back};
use crate::points::{F64, PliantScalar};
use crate::status::{BAD_OPTION, OTHER, PliantError, PliantStatus, Refused, call};
use pliant::{BroadPhase, Degree, Options, Partition, Scalar, Scheduler, Update, World};
use std::any::Any;
use std::ffi::c_void;
use std::num::{NonZeroU32, NonZeroUsize};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::{null, null_mut};
use std::sync::{Arc, Mutex, PoisonError};

/// `pliant_options`: how a world works; no option changes an answer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PliantOptions {
    /// Precision of positions.
    pub scalar: PliantScalar,
    /// Threads that share the work, at most.
    pub threads: u32,
    /// Most children of a node: 2, 4 or 8.
    pub degree: u32,
    /// How triangles are divided.
    pub partition: u32,
    /// Most triangles in a leaf.
    pub leaf_size: u32,
    /// When boxes are made.
    pub update: u32,
    /// How pairs of bodies are found.
    pub broad_phase: u32,
    /// Whether trees mend themselves: 0 or 1.
    pub mending: u8,
    /// Threads that worlds share, or NULL.
    pub pool: *const PliantPool,
    /// Runs tasks on threads of the caller's.
    pub parallel_for: Option<ParallelFor>,
    /// Given to it.
    pub parallel_user: *mut c_void,
}

/// Runs `task(context, number)` for every number below a count, and returns when all have ended.
pub type ParallelFor = unsafe extern "C" fn(
    user: *mut c_void,
    tasks: usize,
    task: unsafe extern "C" fn(context: *const c_void, number: usize),
    context: *const c_void,
);

/// `pliant_options_default`.
///
/// # Safety
///
/// `options` is NULL, or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_options_default(options: *mut PliantOptions) {
    // SAFETY: as above.
    unsafe { give(options, PliantOptions::default()) };
}

impl Default for PliantOptions {
    fn default() -> Self {
        Self {
            scalar: F64,
            threads: 1,
            degree: 8,
            partition: 2,
            leaf_size: 8,
            update: 2,
            broad_phase: 0,
            mending: 0,
            pool: null(),
            parallel_for: None,
            parallel_user: null_mut(),
        }
    }
}

impl PliantOptions {
    pub(crate) fn checked(&self) -> Result<Options, Refused> {
        let bad = |name: &str, value: u32, are: &str| {
            Refused::new(
                BAD_OPTION,
                format_args!("options.{name} is {value}; give {are}"),
            )
        };
        let mut options = Options::default();
        let many = "at least 1";
        options.threads = NonZeroUsize::new(self.threads as usize)
            .ok_or_else(|| bad("threads", self.threads, many))?;
        options.leaf_size = NonZeroU32::new(self.leaf_size)
            .ok_or_else(|| bad("leaf_size", self.leaf_size, many))?;
        options.degree = match self.degree {
            2 => Degree::Two,
            4 => Degree::Four,
            8 => Degree::Eight,
            other => return Err(bad("degree", other, "2, 4 or 8")),
        };
        options.partition = match self.partition {
            0 => Partition::Centre,
            1 => Partition::Mean,
            2 => Partition::Balanced,
            3 => Partition::Connectivity,
            other => {
                return Err(bad(
                    "partition",
                    other,
                    "one of PLIANT_CENTRE to _CONNECTIVITY",
                ));
            }
        };
        options.update = match self.update {
            0 => Update::BottomUp,
            1 => Update::TopDown,
            2 => Update::HYBRID,
            other => return Err(bad("update", other, "one of PLIANT_BOTTOM_UP to _HYBRID")),
        };
        options.broad_phase = match self.broad_phase {
            0 => BroadPhase::Auto,
            1 => BroadPhase::BruteForce,
            2 => BroadPhase::SweepAndPrune,
            3 => BroadPhase::Tree,
            other => return Err(bad("broad_phase", other, "one of PLIANT_AUTO to _TREE")),
        };
        options.mending = match self.mending {
            0 => false,
            1 => true,
            other => return Err(bad("mending", other.into(), "0 or 1")),
        };
        Ok(options)
    }

    /// Makes an empty world of these options.
    ///
    /// # Safety
    ///
    /// The pool is NULL, or was made and not freed.
    pub(crate) unsafe fn world<S: Scalar>(&self) -> Result<World<S>, Refused> {
        let options = self.checked()?;
        // SAFETY: as above.
        match (unsafe { self.pool.as_ref() }, self.parallel_for) {
            (None, None) => Ok(World::with_options(options)),
            (Some(pool), None) => Ok(World::with_pool(options, Arc::clone(&pool.0))),
            (None, Some(run)) => {
                let user = self.parallel_user;
                Ok(World::with_scheduler(
                    options,
                    Arc::new(Caller { run, user }),
                ))
            }
            (Some(_), Some(_)) => Err(Refused::new(
                BAD_OPTION,
                "options.pool and options.parallel_for are given; one of them must be NULL",
            )),
        }
    }
}

/// `pliant_pool`.
pub struct PliantPool(Arc<rayon::ThreadPool>);

/// `pliant_pool_new`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_pool_new(
    threads: u32,
    pool: *mut *mut PliantPool,
    error: *mut PliantError,
) -> PliantStatus {
    let make = || {
        if threads == 0 {
            let words = "threads is 0; give a pool at least 1";
            return Err(Refused::new(BAD_OPTION, words));
        }
        let made = rayon::ThreadPoolBuilder::new().num_threads(threads as usize);
        let made = made.thread_name(|thread| format!("pliant {}", thread + 1));
        let made = made.build().map_err(|why| Refused::new(OTHER, why))?;
        Ok(PliantPool(Arc::new(made)))
    };
    // SAFETY: as the header says.
    unsafe { call(error, || hand_out(pool, "pool", make)) }
}

/// `pliant_pool_free`.
///
/// # Safety
///
/// The pool is NULL, or was made and is not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_pool_free(pool: *mut PliantPool) {
    // SAFETY: as above.
    unsafe { take_back(pool) };
}

/// The caller's function that runs tasks.
struct Caller {
    run: ParallelFor,
    user: *mut c_void,
}

// SAFETY: the header says that any thread that works with the world may call it.
unsafe impl Send for Caller {}
// SAFETY: as above.
unsafe impl Sync for Caller {}

/// Tasks on their way through the caller's function, and the first panic of one.
struct Tasks<'t> {
    task: &'t (dyn Fn(usize) + Sync),
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

impl Scheduler for Caller {
    fn run(&self, tasks: usize, task: &(dyn Fn(usize) + Sync)) {
        /// No panic may pass through functions of C.
        unsafe extern "C" fn begin(context: *const c_void, number: usize) {
            // SAFETY: this is what `run` gives, which waits for all tasks.
            let tasks = unsafe { &*context.cast::<Tasks>() };
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| (tasks.task)(number))) {
                let mut first = tasks.panic.lock().unwrap_or_else(PoisonError::into_inner);
                first.get_or_insert(panic);
            }
        }
        let panic = Mutex::new(None);
        let context = Tasks { task, panic };
        // SAFETY: the caller gave this function for this.
        unsafe { (self.run)(self.user, tasks, begin, (&raw const context).cast()) };
        let panic = context.panic.into_inner();
        if let Some(panic) = panic.unwrap_or_else(PoisonError::into_inner) {
            resume_unwind(panic);
        }
    }
}
