//! The world as users hold it: a state behind what is compiled once.

use super::scalar::Scalar;
use super::state::State;
use super::verbs::Verbs;
use crate::options::Options;
use crate::threads::Threads;
use std::fmt;
use std::sync::Arc;

/// Bodies that change their shape, and the questions which of their triangles intersect, which of
/// their vertices, edges and triangles are near each other, and which meet on their way.
///
/// `S` is the type of the coordinates, `f32` or `f64`. Moving a body is [`set_positions`](Self::set_positions); there is
/// nothing else to call: every query brings up to date what it touches, and none can answer for old positions.
///
/// A call that is refused returns an [`Error`](crate::Error) and leaves the world as it was.
pub struct World<S: Scalar> {
    pub(super) verbs: Box<dyn Verbs<S>>,
}

/// Bodies, shapes, trees, filters, ignored pairs, loose boxes and options; ids stay, and those of removed bodies are not used again.
/// Boxes are made anew, and counters begin at zero. A pool that was lent is shared, other threads are made anew.
///
/// Cost: O(n), no tree is built.
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

/// A new world.
impl<S: Scalar> World<S> {
    /// An empty world with the options that measured best.
    pub fn new() -> Self {
        Self::with_options(Options::default())
    }

    /// An empty world, with threads of its own if [`Options::threads`] asks for more than one.
    pub fn with_options(options: Options) -> Self {
        let threads = Threads::private(options.threads);
        Self {
            verbs: S::state(options, threads),
        }
    }

    /// An empty world whose queries are shared with the threads of a pool that the application has anyway, so that no others are
    /// made: the calling thread and as many of the pool's as make [`Options::threads`] together.
    ///
    /// Queries may be asked from any thread, those of the pool included. As with everything that waits inside of a rayon pool, such a
    /// thread may begin other work of the pool while it waits for the end of a query.
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

    /// The options of this world.
    pub fn options(&self) -> &Options {
        &self.state().common.options
    }

    /// What is in it.
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
