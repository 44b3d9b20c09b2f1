//! One question about many shapes of the same bodies, frame by frame, on several threads.
//!
//! Each thread has a copy of the world, its trees included, and takes the next frame that nobody
//! has taken. Frames are copied one at a time, so a batch is never in memory twice. Invariant: an
//! answer depends on its frame alone, since sorted lists do not depend on earlier questions.

use crate::answers::{Any, Column, class};
use crate::arrays::{self, Coordinates};
use crate::columns::Resources;
use crate::error::{Refused, Result, refused};
use crate::options::{self, Threads};
use crate::queries::{self, Hit, Kind, Made, Prepare, Question, Want, copied};
use crate::selection::Body;
use crate::signals::interruptible;
use crate::state::{Shared, State};
use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use pliant::BodyId;
use pyo3::prelude::*;
use std::any;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Shapes of bodies, frame by frame: arrays (frames, n, 3) of callers.
pub(crate) struct Frames {
    bodies: Vec<(BodyId, Py<PyUntypedArray>)>,
    count: usize,
    threads: usize,
}

impl Frames {
    /// Takes a dict of arrays by bodies, or pairs of a body and its array.
    pub(crate) fn of(world: &Shared, given: &Any<'_>, threads: Threads) -> Result<Self> {
        let threads = options::with_threads(threads)?.threads.get();
        let own = world.alone()?.options().threads;
        if threads > 1 && own.get() > 1 {
            return Err(refused!(BadOption:
                "threads is {threads}, and the world has threads={own} of its own, which a copy \
                 for each thread would have too; make the world with threads=1"));
        }
        let items = match given.getattr_opt("items")? {
            Some(items) => items.call0()?,
            None => given.clone(),
        };
        let mut bodies: Vec<(BodyId, Py<PyUntypedArray>)> = Vec::new();
        let mut count = None;
        for item in items.try_iter()? {
            let (Body(body), positions): (Body, Any<'_>) = item?.extract()?;
            let about = |refused: Refused| refused.of_body(Some(body));
            let array = arrays::frames(&positions).map_err(about)?;
            let frames = array.shape()[0];
            let expected = *count.get_or_insert(frames);
            if bodies.iter().any(|(other, _)| *other == body) {
                return Err(about(refused!(SameBody: "its frames are given twice")));
            }
            if frames != expected {
                return Err(about(refused!(WrongLength:
                    "{frames} frames, but the first body has {expected}; a body that stays as it \
                     is needs none")));
            }
            bodies.push((body, array.unbind()));
        }
        let count = count.ok_or_else(|| refused!(BadArray: "no body has frames"))?;
        Ok(Self {
            bodies,
            count,
            threads,
        })
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Gives the bodies of a world their shapes of a frame.
    fn shape(&self, state: &mut State, frame: usize) -> Result<()> {
        Python::attach(|py| {
            for (body, array) in &self.bodies {
                let given = array.bind(py).get_item(frame)?;
                let given = given.cast_into().map_err(PyErr::from)?;
                let about = |refused: Refused| refused.of_body(Some(*body));
                let given = Coordinates::of_array(&given, "positions").map_err(about)?;
                let copied = state.copy(*body, &given)?;
                state.set_positions(*body, copied.get()?)?;
            }
            Ok(())
        })
    }
}

/// Asks a world about each frame: the answers in order, or the refusal of the first bad frame.
///
/// The shapes of the world itself stay.
pub(crate) fn each_frame<T: Send>(
    py: Python<'_>,
    world: &Shared,
    frames: &Frames,
    ask: impl Fn(&mut State, &(dyn Fn() -> bool + Sync)) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let next = AtomicUsize::new(0);
    // Frames are taken in order, so all before a refused one are answered or refused themselves.
    let work = |mut state: State, question: &(dyn Fn() -> bool + Sync)| {
        let mut answers = Vec::new();
        loop {
            let frame = next.fetch_add(1, Ordering::Relaxed);
            if frame >= frames.count || question() {
                return answers;
            }
            let shaped = frames.shape(&mut state, frame);
            let answer = shaped.and_then(|()| ask(&mut state, question));
            let answer = answer.map_err(|it| it.about(format_args!("frame {frame}")));
            let is_refused = answer.is_err();
            answers.push((frame, answer.map_err(|it| it.with("frame", frame))));
            if is_refused {
                next.store(frames.count, Ordering::Relaxed);
            }
        }
    };
    let answers = world.with(py, |state| {
        interruptible(|question| {
            let work = &work;
            let answers = thread::scope(|scope| {
                let mut others = Vec::new();
                for _ in 1..frames.threads.min(frames.count) {
                    let copy = state.another();
                    let other = thread::Builder::new();
                    match other.spawn_scoped(scope, move || work(copy, question)) {
                        Ok(other) => others.push(other),
                        // The system has no more; fewer do the same.
                        Err(_) => break,
                    }
                }
                let mut answers = work(state.another(), question);
                for other in others {
                    match other.join() {
                        Ok(more) => answers.extend(more),
                        Err(panic) => std::panic::resume_unwind(panic),
                    }
                }
                answers
            });
            Ok::<_, Refused>(answers)
        })
    });
    let mut answers = answers?;
    answers.sort_unstable_by_key(|(frame, _)| *frame);
    answers.into_iter().map(|(_, answer)| answer).collect()
}

/// How much is wanted of each frame.
#[derive(Clone, Copy)]
enum Answer {
    Rows,
    First,
    Counts,
    Any,
}

const ANSWERS: [(&str, Answer); 4] = [
    ("rows", Answer::Rows),
    ("first", Answer::First),
    ("counts", Answer::Counts),
    ("any", Answer::Any),
];

/// Hits of a frame, a `Vec` of some type.
type Listed = Box<dyn any::Any + Send>;

/// The hits of one frame, sorted: all of them, or the first.
///
/// That is the lowest one, since which hit a search finds first depends on earlier questions.
#[derive(Clone, Copy)]
struct List {
    only_first: bool,
}

impl Want for List {
    type Answer = (Listed, usize);

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<(Listed, usize)> {
        let mut hits = query.all()?;
        if self.only_first {
            hits = &hits[..hits.len().min(1)];
        }
        Ok((Box::new(hits.to_vec()), hits.len()))
    }
}

/// Joins lists of one type of hits.
struct Join;

impl Want for Join {
    type Answer = fn(Vec<Listed>, usize) -> PyResult<Made>;

    fn of<H: Hit>(self, _: pliant::Query<'_, H>, _: Resources<'_>) -> Result<Self::Answer> {
        Ok(|lists, threads| {
            let mut all = Vec::new();
            for list in lists {
                let Ok(hits) = list.downcast::<Vec<H>>() else {
                    unreachable!("a question has hits of one type");
                };
                all.extend(*hits);
            }
            let columns = Python::attach(|py| copied(py, &all, threads))?;
            Ok(Box::new(move |py| H::many(columns, py)))
        })
    }
}

/// The number of hits.
#[derive(Clone, Copy)]
struct Count;

impl Want for Count {
    type Answer = usize;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<usize> {
        // Sorting costs less than handing hits over bit by bit.
        Ok(query.all()?.len())
    }
}

/// Whether there is a hit.
#[derive(Clone, Copy)]
struct IsAny;

impl Want for IsAny {
    type Answer = bool;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<bool> {
        Ok(query.first()?.is_some())
    }
}

impl<K: Kind> Question<K> {
    /// Asks about each frame.
    pub(crate) fn of_frames<'py>(
        &self,
        py: Python<'py>,
        frames: &Any<'py>,
        answer: &str,
        threads: Threads,
    ) -> Result<Any<'py>> {
        let answer = options::named("answer", answer, &ANSWERS)?;
        let frames = Frames::of(&self.world, frames, threads)?;
        // Trees are built once, and copied.
        self.ask(py, Prepare)?;
        Ok(match answer {
            Answer::Counts => {
                let counts = self.each_frame(py, &frames, Count)?.into_iter();
                let Ok(counts) = Column(counts.map(|it| it as i64).collect()).into_pyobject(py);
                counts.into_any()
            }
            Answer::Any => {
                let Ok(any) = Column(self.each_frame(py, &frames, IsAny)?).into_pyobject(py);
                any.into_any()
            }
            Answer::Rows | Answer::First => {
                let only_first = matches!(answer, Answer::First);
                let found = self.each_frame(py, &frames, List { only_first })?;
                let mut offsets = vec![0];
                let lists = found.into_iter().map(|(list, count)| {
                    offsets.push(offsets[offsets.len() - 1] + count as i64);
                    list
                });
                let lists = lists.collect();
                let join = self.ask(py, Join)?;
                let hits = py.detach(|| join(lists, frames.threads))?(py)?;
                class!(py, "FrameHits").call1((hits, Column(offsets)))?
            }
        })
    }

    fn each_frame<W: Want + Copy + Sync>(
        &self,
        py: Python<'_>,
        frames: &Frames,
        want: W,
    ) -> Result<Vec<W::Answer>> {
        let (kind, of) = (self.kind, self.of.0);
        each_frame(py, &self.world, frames, |state, question| {
            queries::answer(state, question, (kind, of), want)
        })
    }
}
