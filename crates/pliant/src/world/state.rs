//! State of a world: bodies, options, and the buffers of each kind of query.

use super::kept::Kinds;
use crate::bodies::{Bodies, Body};
use crate::collide::{BodyPairs, Common, Distances, FloatingOrigin, Witnesses};
use crate::error::{Error, ErrorKind};
use crate::ids::BodyId;
use crate::kernels::{Coordinate, Instructions};
use crate::options::Options;
use crate::points::Hints;
use crate::statistics::Statistics;
use crate::threads::{Executor, Grain, Interrupt, Threads};
use crate::traversal::Scratch;
use std::sync::atomic::{AtomicU64, Ordering};

/// Count of all worlds that the process has made.
static WORLDS: AtomicU64 = AtomicU64::new(0);

/// State of a world.
pub(crate) struct State<S: Coordinate> {
    pub(super) common: Common<S>,
    pub(super) kinds: Kinds<S>,
    pub(super) witnesses: Witnesses,
    pub(super) distances: Distances,
    pub(super) hints: Hints,
    /// Shape that is not a body's yet: `write_positions` lends it, `advance_motion` writes it.
    pub(super) lent: Vec<[S; 3]>,
    /// Number of this world, unique in the process.
    pub(super) number: u64,
}

/// Makes an error about a body.
pub(super) fn about(body: BodyId) -> impl Fn(ErrorKind) -> Error {
    move |kind| Error {
        body: Some(body),
        kind,
    }
}

impl<S: Coordinate> State<S> {
    pub(super) fn new(options: Options, threads: Threads) -> Self {
        Self {
            common: Common {
                options,
                instructions: Instructions::widest(),
                threads,
                bodies: Bodies::default(),
                body_pairs: BodyPairs::new(options.broad_phase),
                origin: FloatingOrigin::default(),
                scratch: Scratch::default(),
                statistics: Statistics::default(),
                done_early: Statistics::default(),
            },
            kinds: Kinds::default(),
            witnesses: Witnesses::default(),
            distances: Distances::default(),
            hints: Hints::default(),
            lent: Vec::new(),
            number: WORLDS.fetch_add(1, Ordering::Relaxed),
        }
    }

    pub(super) fn body(&self, id: BodyId) -> Result<&Body<S>, Error> {
        self.common.bodies.get(id)
    }

    /// Changes a body, with the world's threads. If that is refused, the error names the body,
    /// which stays as it was.
    pub(super) fn change(
        &mut self,
        id: BodyId,
        change: impl FnOnce(&mut Body<S>, Instructions, Executor) -> Result<(), ErrorKind>,
    ) -> Result<(), Error> {
        let Common {
            instructions,
            threads,
            bodies,
            ..
        } = &mut self.common;
        let executor = Executor {
            threads: threads.here(),
            interrupt: &Interrupt::default(),
        };
        let body = bodies.get_mut(id)?;
        change(body, *instructions, executor).map_err(about(id))
    }

    /// Forgets the last answers about a body that is removed, or whose triangles have a new order.
    pub(super) fn forget_answers(&mut self, id: BodyId) {
        self.witnesses.forget(id);
        self.distances.last.forget(id);
        self.hints.forget(id);
    }

    /// Validates a new shape of a body and takes it over.
    pub(super) fn move_body(&mut self, id: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        self.change(id, |body, instructions, executor| {
            body.set_positions(positions, (instructions, executor))
        })?;
        self.common.note_movement();
        self.mend(id)
    }

    /// Has all threads share `parts` pieces without work.
    pub(super) fn run_empty_parts(&mut self, parts: u32) {
        let interrupt = Interrupt::default();
        let executor = self.common.executor(&interrupt);
        let mut jobs = vec![(); executor.count()];
        for _ in 0..parts {
            executor.run(&mut jobs, u64::MAX, |_, ()| {});
        }
    }

    /// Validates new shapes of bodies, and takes all of them over or none.
    pub(super) fn move_bodies(&mut self, shapes: &[(BodyId, &[[S; 3]])]) -> Result<(), Error> {
        let bodies = &self.common.bodies;
        let mut wanted = Vec::with_capacity(shapes.len());
        for (number, &(id, positions)) in shapes.iter().enumerate() {
            wanted.push((bodies.place(id)?, number, positions));
        }
        wanted.sort_unstable_by_key(|&(place, ..)| place);
        if let Some(twice) = wanted.windows(2).find(|two| two[0].0 == two[1].0) {
            return Err(about(shapes[twice[0].1].0)(ErrorKind::SameBody));
        }
        let instructions = self.common.instructions;
        let executor = Executor {
            threads: self.common.threads.here(),
            interrupt: &Interrupt::default(),
        };
        let places = wanted.iter().map(|&(place, ..)| place);
        let bodies = wanted.iter().zip(self.common.bodies.some_mut(places));
        let mut jobs: Vec<_> = bodies
            .map(|(&(_, number, positions), body)| (number, body, positions, None))
            .collect();
        let points = jobs.iter().map(|(_, _, positions, _)| positions.len());
        let nanoseconds = Grain::POINTS.time(points.sum()) + Grain::BODIES.time(jobs.len());
        let points = |(_, _, positions, _): &(_, _, &[[S; 3]], _)| positions.len();
        executor.run_uneven(&mut jobs, points, nanoseconds, |job, executor| {
            let (_, body, positions, staged) = job;
            *staged = Some(body.check_positions(positions, (instructions, executor)));
        });
        jobs.sort_unstable_by_key(|&(number, ..)| number);
        for (number, _, _, staged) in &mut jobs {
            if let Some(Err(kind)) = staged.take_if(|staged| staged.is_err()) {
                return Err(about(shapes[*number].0)(kind));
            }
        }
        executor.run_uneven(&mut jobs, points, nanoseconds, |job, executor| {
            let (_, body, positions, staged) = job;
            if let Some(Ok(staged)) = staged {
                body.accept_positions(staged, positions, (instructions, executor));
            }
        });
        self.common.note_movement();
        shapes.iter().try_for_each(|&(id, _)| self.mend(id))
    }

    /// Ends the motion of every body that has one. The error is of the first body whose motion
    /// cannot be ended.
    pub(super) fn end_motions<E>(
        &mut self,
        mut end: impl FnMut(&mut Body<S>, Instructions, Executor) -> Result<(), E>,
    ) -> Result<(), (BodyId, E)> {
        let Common {
            options,
            instructions,
            threads,
            bodies,
            ..
        } = &mut self.common;
        let executor = Executor {
            threads: threads.here(),
            interrupt: &Interrupt::default(),
        };
        let mut ended = Ok(());
        for rank in 0..bodies.len() {
            let body = bodies.at_mut(bodies.places()[rank]);
            if !body.is_moving() {
                continue;
            }
            match end(body, *instructions, executor) {
                Ok(()) if options.mending && body.mend(options) => {
                    self.witnesses.forget(body.id());
                    self.distances.last.forget(body.id());
                    self.hints.forget(body.id());
                }
                Ok(()) => {}
                Err(kind) => ended = ended.and(Err((body.id(), kind))),
            }
        }
        self.common.note_movement();
        ended
    }

    /// Mends the tree of a body that has a new shape, if trees mend themselves.
    fn mend(&mut self, id: BodyId) -> Result<(), Error> {
        let options = self.common.options;
        if options.mending && self.common.bodies.get_mut(id)?.mend(&options) {
            self.forget_answers(id);
        }
        Ok(())
    }
}
