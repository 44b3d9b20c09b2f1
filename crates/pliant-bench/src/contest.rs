//! Contests of methods on one motion, in turns: first their answers are compared, then their times.
//!
//! - Round 0 is not timed. Every method plays all steps. If its pairs are not the truth's, it is
//!   out.
//! - In every later round, each method plays all steps in a row, as a simulation would. Each round
//!   begins with another method.
//! - In a step, shapes are written freshly into the buffers that methods read, so vertices are in
//!   the cache where they fit. Then the update and the query are timed, each alone.
//!
//! The figure of a step is the median of its rounds. Ratios are taken round by round, and then
//! their median: a machine that is slow for a second is slow for both.

use crate::method::{Counters, Method, Pair};
use crate::motion::{Motion, Placed, Shape};
use crate::record::{ContestRecord, MethodRecord, Spread, Window, WindowFigures, Wrong, median};
use pliant_scenes::{ChangingMesh, Event};
use std::collections::BTreeSet;
use std::time::Instant;

/// The query of every step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// All pairs of triangles of different bodies.
    All,
    /// Some pair of triangles of different bodies.
    First,
    /// All pairs of each body with itself.
    Itself,
    /// Vertices near triangles and edges near edges, of all bodies and of each with itself.
    Near,
    /// Vertices and triangles, and edges and edges, that meet on their way.
    When,
    /// All pairs of triangles of different bodies and of each body with itself.
    Everything,
    /// How far the first two bodies are apart.
    Distance,
}

impl Query {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::First => "first",
            Self::Itself => "self",
            Self::Near => "near",
            Self::When => "when",
            Self::Everything => "everything",
            Self::Distance => "distance",
        }
    }
}

/// A method that takes part in a contest, under a short name.
pub struct Contender {
    /// Name in tables; [`Method::name`] adds the parameters.
    pub label: String,
    /// The method.
    pub method: Box<dyn Method>,
    /// A truth of its own, for a method that is asked another query than the others. Its time is
    /// shown beside theirs.
    pub truth: Option<Box<dyn Method>>,
}

impl Contender {
    /// A method under a short name.
    pub fn new(label: &str, method: impl Method + 'static) -> Self {
        Self {
            label: label.to_owned(),
            method: Box::new(method),
            truth: None,
        }
    }

    /// Compares the method with a truth of its own.
    #[must_use]
    pub fn compared_with(mut self, truth: impl Method + 'static) -> Self {
        self.truth = Some(Box::new(truth));
        self
    }
}

/// Methods on one motion, with one query.
pub struct Contest {
    /// Name of the contest.
    pub name: String,
    /// Motion that is played.
    pub motion: Motion,
    /// Query of every step.
    pub query: Query,
    /// Method whose answers are taken for true: simple, and not ours.
    pub truth: Box<dyn Method>,
    /// Methods that take part. Ratios refer to the first.
    pub methods: Vec<Contender>,
    /// Ranges of steps over which figures are combined.
    pub windows: Vec<Window>,
    /// Whether caches are cleared before every step, by reading memory until nothing of the last
    /// step can be there.
    pub cold: bool,
}

/// Bytes read to clear the caches: more than the caches of today's processors hold.
const LARGER_THAN_CACHE: usize = 512 << 20;

/// Times of one method in one round: (update, query) in milliseconds at each step.
type Round = Vec<(f64, f64)>;

impl Contest {
    /// Number of steps to play by all methods, for progress.
    pub fn length(&self, rounds: usize) -> u64 {
        ((rounds + 1) * self.methods.len() * self.motion.steps.len()) as u64
    }

    /// Compares the answers, then plays `rounds` timed rounds. Calls `progress` after every step
    /// with the number of steps played.
    pub fn play(mut self, rounds: usize, progress: &mut dyn FnMut(u64)) -> ContestRecord {
        // A window without steps (the small forms have few) has no figures.
        self.windows.retain(|window| {
            self.motion
                .steps
                .iter()
                .any(|step| (window.first..=window.last).contains(step))
        });
        let mut shapes: Vec<Placed> = self
            .motion
            .bodies
            .iter()
            .map(|body| body.first.clone())
            .collect();
        let build_ms = self.build();
        let mut wrong: Vec<Option<Wrong>> = vec![None; self.methods.len()];
        let mut counters: Vec<Vec<Counters>> = vec![Vec::new(); self.methods.len()];
        let mut pairs = Vec::new();
        let mut meshes = self.motion.changing_meshes();
        for (place, (&step, frame)) in self
            .motion
            .steps
            .iter()
            .zip(&self.motion.frames)
            .enumerate()
        {
            let events = self.motion.events(place);
            apply(&mut meshes, events);
            let step_of = |method: &mut Box<dyn Method>, shapes: &[Placed]| {
                if !events.is_empty() {
                    method.change(events, &views(shapes), &meshes);
                }
                method.step(&views(shapes));
                method.untimed();
            };
            let all = |method: &mut Box<dyn Method>| match self.query {
                Query::Itself => method.self_pairs().map(<[Pair]>::to_vec),
                Query::Near | Query::When | Query::Everything => {
                    method.candidates().map(<[Pair]>::to_vec)
                }
                _ => Some(method.all_pairs().to_vec()),
            };
            write(&mut shapes, frame);
            step_of(&mut self.truth, &shapes);
            let distance = self.truth.distance();
            let truth = all(&mut self.truth).unwrap_or_default();
            pairs.push(truth.len() + usize::from(distance.is_some()));
            for ((contender, wrong), counters) in
                self.methods.iter_mut().zip(&mut wrong).zip(&mut counters)
            {
                let Contender {
                    method, truth: own, ..
                } = contender;
                step_of(method, &shapes);
                let answer = match (self.query, own) {
                    (Query::First, _) => first_is_right(method.first_pair(), &truth),
                    (Query::Distance, _) => is_as_far(method.distance(), distance),
                    (_, Some(own)) => {
                        step_of(own, &shapes);
                        let own = all(own).unwrap_or_default();
                        compare(&all(method).unwrap_or_default(), &own)
                    }
                    _ => compare(&all(method).unwrap_or_default(), &truth),
                };
                counters.push(method.take_counters());
                if let Err((missing, extra)) = answer {
                    let wrong = wrong.get_or_insert(Wrong {
                        step,
                        missing: 0,
                        extra: 0,
                    });
                    wrong.missing += missing;
                    wrong.extra += extra;
                }
                progress(1);
            }
        }

        let mut played: Vec<Vec<Round>> = vec![Vec::new(); self.methods.len()];
        let contestants: Vec<usize> = (0..self.methods.len())
            .filter(|&place| wrong[place].is_none())
            .collect();
        for round in 0..rounds {
            for turn in 0..contestants.len() {
                let place = contestants[(turn + round) % contestants.len()];
                let times = self.play_round(place, &mut shapes, progress);
                played[place].push(times);
            }
        }
        self.record(&build_ms, wrong, counters, pairs, &played)
    }

    /// Builds every method; returns the milliseconds of each.
    fn build(&mut self) -> Vec<f64> {
        let build = |method: &mut Box<dyn Method>, motion: &Motion| {
            let start = Instant::now();
            method.build(&motion.meshes());
            milliseconds(start, Instant::now())
        };
        build(&mut self.truth, &self.motion);
        for truth in self.methods.iter_mut().filter_map(|it| it.truth.as_mut()) {
            build(truth, &self.motion);
        }
        let build_ms: Vec<f64> = self
            .methods
            .iter_mut()
            .map(|entry| build(&mut entry.method, &self.motion))
            .collect();

        // Counts of building are not work of a step.
        for entry in &mut self.methods {
            entry.method.take_counters();
        }
        build_ms
    }

    fn play_round(
        &mut self,
        place: usize,
        shapes: &mut [Placed],
        progress: &mut dyn FnMut(u64),
    ) -> Round {
        let method = &mut self.methods[place].method;
        let mut times = Vec::with_capacity(self.motion.frames.len());
        let other = vec![1_u64; if self.cold { LARGER_THAN_CACHE / 8 } else { 0 }];
        if !self.motion.events.is_empty() {
            method.build(&self.motion.meshes());
        }
        let mut meshes = self.motion.changing_meshes();
        for (place, frame) in self.motion.frames.iter().enumerate() {
            let events = self.motion.events(place);
            apply(&mut meshes, events);
            write(shapes, frame);
            std::hint::black_box(other.iter().step_by(8).sum::<u64>());
            let shapes = views(shapes);
            let start = Instant::now();
            if !events.is_empty() {
                method.change(events, &shapes, &meshes);
            }
            method.step(&shapes);
            let updated = Instant::now();
            method.untimed();
            let asked = Instant::now();
            match self.query {
                Query::All => _ = std::hint::black_box(method.all_pairs()),
                Query::First => _ = std::hint::black_box(method.first_pair()),
                Query::Itself => _ = std::hint::black_box(method.self_pairs()),
                Query::Near | Query::When | Query::Everything => {
                    _ = std::hint::black_box(method.candidates());
                }
                Query::Distance => _ = std::hint::black_box(method.distance()),
            }
            let end = Instant::now();
            times.push((milliseconds(start, updated), milliseconds(asked, end)));
            progress(1);
        }
        times
    }

    fn record(
        &self,
        build_ms: &[f64],
        wrong: Vec<Option<Wrong>>,
        counters: Vec<Vec<Counters>>,
        pairs: Vec<usize>,
        played: &[Vec<Round>],
    ) -> ContestRecord {
        let steps = &self.motion.steps;
        let step_median = |rounds: &[Round], figure: fn((f64, f64)) -> f64, step: usize| {
            median(
                &rounds
                    .iter()
                    .map(|round| figure(round[step]))
                    .collect::<Vec<_>>(),
            )
        };
        let methods = self
            .methods
            .iter()
            .enumerate()
            .zip(wrong)
            .zip(counters)
            .map(|(((place, entry), wrong), counters)| {
                let rounds = &played[place];
                let list = |figure: fn((f64, f64)) -> f64| -> Vec<f64> {
                    if rounds.is_empty() {
                        Vec::new()
                    } else {
                        (0..steps.len())
                            .map(|step| step_median(rounds, figure, step))
                            .collect()
                    }
                };
                let both = list(|(update, query)| update + query);
                let figures = |window: &Window| {
                    let inside: Vec<usize> = (0..steps.len())
                        .filter(|&step| (window.first..=window.last).contains(&steps[step]))
                        .collect();
                    let of_window: Vec<f64> = inside.iter().map(|&step| both[step]).collect();
                    let sum = |round: &Round| {
                        inside
                            .iter()
                            .map(|&step| round[step].0 + round[step].1)
                            .sum::<f64>()
                    };
                    let ratios = played[0]
                        .iter()
                        .zip(rounds)
                        .map(|(reference, own)| sum(reference) / sum(own))
                        .collect();
                    WindowFigures {
                        median_ms: median(&of_window),
                        mean_ms: of_window.iter().sum::<f64>() / of_window.len() as f64,
                        worst_ms: of_window.iter().copied().fold(0.0, f64::max),
                        speedup: (!played[0].is_empty()).then(|| Spread::of(ratios)),
                    }
                };
                MethodRecord {
                    name: entry.label.clone(),
                    parameters: entry.method.name(),
                    wrong,
                    build_ms: build_ms[place],
                    windows: if both.is_empty() {
                        Vec::new()
                    } else {
                        self.windows.iter().map(figures).collect()
                    },
                    update_ms: list(|(update, _)| update),
                    query_ms: list(|(_, query)| query),
                    counters,
                }
            });
        ContestRecord {
            name: self.name.clone(),
            motion: self.motion.name.clone(),
            bodies: self.motion.bodies.len(),
            triangles: self
                .motion
                .bodies
                .first()
                .map_or(0, |body| body.triangles.len()),
            query: self.query.name().to_owned(),
            steps: steps.clone(),
            pairs,
            truth: self.truth.name(),
            reference: self
                .methods
                .first()
                .map_or_else(String::new, |entry| entry.label.clone()),
            windows: self.windows.clone(),
            methods: methods.collect(),
        }
    }
}

/// Writes the shapes of a step into the buffers that methods read.
fn write(shapes: &mut [Placed], frame: &[Placed]) {
    for (shape, placed) in shapes.iter_mut().zip(frame) {
        shape.copy_from(placed);
    }
}

/// Applies the changes of meshes before a step.
fn apply(meshes: &mut [ChangingMesh], events: &[Event]) {
    for event in events {
        match event {
            Event::Edit { body, changes } => meshes[*body].change(changes),
            Event::Fuse { kept, gone } => {
                let gone = std::mem::take(&mut meshes[*gone]);
                meshes[*kept].append(&gone);
            }
        }
    }
}

fn views(shapes: &[Placed]) -> Vec<Shape<'_>> {
    shapes.iter().map(Placed::shape).collect()
}

/// Milliseconds between two instants, in whole nanoseconds as the clock ticks: records stay
/// readable.
fn milliseconds(from: Instant, to: Instant) -> f64 {
    (to - from).as_nanos() as f64 / 1e6
}

/// Compares an answer with the truth. `Err` counts missing pairs and extra pairs.
fn compare(answer: &[Pair], truth: &[Pair]) -> Result<(), (usize, usize)> {
    if answer == truth {
        return Ok(());
    }
    let sets = [truth, answer].map(|pairs| pairs.iter().collect::<BTreeSet<_>>());
    let missing = sets[0].difference(&sets[1]).count();
    let extra = sets[1].difference(&sets[0]).count();
    // No difference: equal pairs, but unsorted or with duplicates.
    Err((missing, extra.max(usize::from(missing == 0))))
}

/// Compares distances. One that was computed in `f32` is right within a thousandth.
fn is_as_far(found: Option<f64>, truth: Option<f64>) -> Result<(), (usize, usize)> {
    match (found, truth) {
        (Some(found), Some(truth)) if (found - truth).abs() <= truth * 1e-3 => Ok(()),
        _ => Err((1, 0)),
    }
}

fn first_is_right(first: Option<Pair>, truth: &[Pair]) -> Result<(), (usize, usize)> {
    match first {
        None if truth.is_empty() => Ok(()),
        None => Err((1, 0)),
        Some(pair) if truth.binary_search(&pair).is_ok() => Ok(()),
        Some(_) => Err((usize::from(!truth.is_empty()), 1)),
    }
}
