//! The handle that users hold: a boxed state behind a trait that is compiled once.

use super::scalar::Scalar;
use super::state::State;
use super::verbs::Verbs;
use crate::options::Options;
use crate::threads::{Scheduler, Threads};
use std::fmt;
use std::sync::Arc;

/// World of bodies that change their shape, and the place where all questions are asked.
///
/// Questions are: which triangles intersect, which vertices, edges and triangles are near each
/// other, and which of them meet on their way.
///
/// `S` is the type of the coordinates, `f32` or `f64`. Every length is in the unit of the
/// positions. In shapes of arrays, n counts the vertices of a body and m its triangles. A call for
/// which no cost is said takes O(log b) for b bodies.
///
/// Moving a body is [`set_positions`](Self::set_positions), and there is nothing else to call.
/// Every query brings up to date what it touches, and none can answer for old positions. A call
/// that is refused returns an [`Error`](crate::Error) and leaves the world as it was.
///
/// Methods are listed in the order in which one meets them:
///
/// - **New**: [`new`](Self::new), [`with_options`](Self::with_options),
///   [`with_pool`](Self::with_pool), [`with_scheduler`](Self::with_scheduler);
/// - **Bodies**: [`add`](Self::add), [`set_positions`](Self::set_positions),
///   [`remove`](Self::remove);
/// - **Questions**, from [`intersections`](Self::intersections) to [`clearance`](Self::clearance);
/// - **Motions**: [`set_motion`](Self::set_motion), [`advance_motion`](Self::advance_motion),
///   [`free_step`](Self::free_step);
/// - **Change**: [`edit`](Self::edit), [`apply`](Self::apply), [`set_mesh`](Self::set_mesh),
///   [`split`](Self::split), [`fuse`](Self::fuse), [`weld`](Self::weld);
/// - **Settings**: [`set_filter`](Self::set_filter), [`ignore`](Self::ignore),
///   [`set_environment`](Self::set_environment), [`set_vertex_groups`](Self::set_vertex_groups),
///   [`set_rest_positions`](Self::set_rest_positions), [`set_labels`](Self::set_labels),
///   [`set_thickness`](Self::set_thickness), [`set_loose_box`](Self::set_loose_box);
/// - **Looking inside**: [`triangles`](Self::triangles), [`positions`](Self::positions),
///   [`tree_boxes`](Self::tree_boxes), [`statistics`](Self::statistics).
pub struct World<S: Scalar> {
    pub(super) verbs: Box<dyn Verbs<S>>,
}

/// Copies bodies, shapes, trees, filters, ignored pairs, loose boxes and options.
///
/// Ids stay, and ids of removed bodies are not used again. Boxes are made anew, and counters begin
/// at zero. A pool or scheduler of the application is shared; threads of the world's own are
/// made anew.
///
/// Cost: O(n + m) for all bodies; no tree is built.
///
/// ```
/// let mut world = pliant::World::<f32>::new();
/// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
/// let before = world.clone();
/// world.set_positions(body, &[[5.0; 3], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0]])?;
/// assert_eq!(before.positions(body)?[0], [0.0; 3]);
/// # Ok::<(), pliant::Error>(())
/// ```
impl<S: Scalar> Clone for World<S> {
    fn clone(&self) -> Self {
        Self {
            verbs: self.verbs.copy(),
        }
    }
}

/// # New: an empty world
impl<S: Scalar> World<S> {
    /// Makes an empty world with the default options, which measured best.
    pub fn new() -> Self {
        Self::with_options(Options::default())
    }

    /// Makes an empty world with these options.
    ///
    /// It starts threads of its own if [`Options::threads`] asks for more than one.
    pub fn with_options(options: Options) -> Self {
        let threads = Threads::private(options.threads);
        Self {
            verbs: S::state(options, threads),
        }
    }

    /// Makes an empty world whose queries share the threads of a rayon pool that the application
    /// has anyway.
    ///
    /// No other threads are made. The calling thread and some of the pool's make
    /// [`Options::threads`] together.
    ///
    /// Queries may be asked from any thread, also from a thread of the pool. As with everything
    /// that waits inside a rayon pool, such a thread may begin other work of the pool while it
    /// waits.
    ///
    /// ```
    /// use pliant::{Options, World};
    /// use std::num::NonZeroUsize;
    /// use std::sync::Arc;
    ///
    /// let pool = Arc::new(rayon::ThreadPoolBuilder::new().num_threads(3).build()?);
    /// let mut options = Options::default();
    /// options.threads = NonZeroUsize::new(4).expect("4 is not 0");
    /// let world = World::<f32>::with_pool(options, Arc::clone(&pool));
    /// # drop(world);
    /// # Ok::<(), rayon::ThreadPoolBuildError>(())
    /// ```
    pub fn with_pool(options: Options, pool: Arc<rayon::ThreadPool>) -> Self {
        let threads = Threads::lent(options.threads, pool);
        Self {
            verbs: S::state(options, threads),
        }
    }

    /// Makes an empty world whose queries share the threads of a scheduler that the application has
    /// anyway: TBB, OpenMP, or its own.
    ///
    /// No other threads are made. At most [`Options::threads`] tasks are given to it at a time. As
    /// with a pool, a thread that waits there may begin other work of the application.
    ///
    /// ```
    /// use pliant::{Options, Scheduler, World};
    /// use std::sync::Arc;
    ///
    /// struct Own;
    ///
    /// impl Scheduler for Own {
    ///     fn run(&self, tasks: usize, task: &(dyn Fn(usize) + Sync)) {
    ///         std::thread::scope(|scope| {
    ///             for number in 0..tasks {
    ///                 scope.spawn(move || task(number));
    ///             }
    ///         });
    ///     }
    /// }
    ///
    /// let world = World::<f32>::with_scheduler(Options::all_threads(), Arc::new(Own));
    /// # drop(world);
    /// ```
    pub fn with_scheduler(options: Options, scheduler: Arc<dyn Scheduler>) -> Self {
        let threads = Threads::scheduled(options.threads, scheduler);
        Self {
            verbs: S::state(options, threads),
        }
    }

    /// Options that this world was made with.
    pub fn options(&self) -> &Options {
        &self.state().common.options
    }

    /// The state behind the trait.
    pub(super) fn state(&self) -> &State<S> {
        self.verbs.state()
    }

    pub(super) fn state_mut(&mut self) -> &mut State<S> {
        self.verbs.state_mut()
    }
}

impl<S: Scalar> Default for World<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar> fmt::Debug for World<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("options", self.options())
            .field("bodies", &self.bodies().len())
            .finish_non_exhaustive()
    }
}
