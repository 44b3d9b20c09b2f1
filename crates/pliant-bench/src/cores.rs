//! Many cores: what a step gains from more threads, measured and predicted.
//!
//! Idea: jobs of a step are recorded on one thread, split as they would be for many threads, and
//! replayed on any number of workers. Each job goes to the worker that is free first (greedy list
//! scheduling, Graham 1969). Each time workers wait for each other, the measured cost of a wait is
//! added. So one core predicts the gain on sixteen, as far as memory and caches keep up.

use crate::record::Machine;
use pliant::{BodyId, Options, RecordedPart, Selection, World};
use pliant_scenes::Scene;
use serde::Serialize;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Workers of a replay.
pub const WORKERS: [usize; 5] = [2, 4, 8, 16, 64];
/// Workers for which it is said what holds them back.
pub const MANY: usize = 16;
/// Threads for which work is cut while it is recorded.
const RECORDED: usize = 64;
/// Margin of candidates, in mean lengths of an edge.
const MARGIN: f64 = 0.1;
/// Time for which cores are kept busy before anything is measured.
const AWAKE: Duration = Duration::from_secs(3);
/// Parts without work whose waits are timed.
const WAITS: u32 = 2_000;

/// Scene, triangles a body, and steps: `spheres`, `crowd`, `cloth`, or `gather` with its bodies.
const SCENES: [(&str, usize, std::ops::Range<u32>); 9] = [
    ("spheres", 20, 190..196),
    ("spheres", 320, 190..196),
    ("spheres", 1_280, 190..196),
    ("spheres", 20_480, 190..196),
    ("spheres", 327_680, 190..194),
    ("cloth", 79_202, 40..46),
    ("cloth", 1_280_000, 40..42),
    ("crowd", 5_120, 190..196),
    ("gather", 20, 190..194),
];
/// Bodies of `gather`.
const TINY: usize = 10_000;

/// A question to a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Question {
    /// Triangles that intersect.
    Intersections,
    /// Vertices near triangles and edges near edges.
    Candidates,
    /// Close pairs within the margin, measured.
    Close,
    /// Triangles that intersect, and how.
    Contacts,
    /// Elements that meet on the way to the next step.
    Impacts,
    /// The first of these.
    FirstImpact,
    /// How far everything may go.
    FreeStep,
}

/// Number of combinations of a scene and a question that are measured.
pub const COUNT: usize = SCENES.len() * QUESTIONS.len();

/// All questions.
const QUESTIONS: [Question; 7] = [
    Question::Intersections,
    Question::Candidates,
    Question::Close,
    Question::Contacts,
    Question::Impacts,
    Question::FirstImpact,
    Question::FreeStep,
];

/// One scene and question, positions and lists included.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// Scene and size.
    pub scene: String,
    /// Question that was asked.
    pub question: Question,
    /// Milliseconds a step on one thread: the median of its rounds.
    pub one_thread_ms: f64,
    /// Milliseconds of a step in jobs and between them, by the record.
    pub work_ms: f64,
    /// Milliseconds that are left with any number of workers: what is serial, and the longest jobs.
    pub span_ms: f64,
    /// Part of the work that no job has.
    pub serial_share: f64,
    /// Parts of a step that several workers share.
    pub parts: usize,
    /// Times faster that the replay predicts, for [`WORKERS`].
    pub predicted: Vec<f64>,
    /// Limits of [`MANY`] workers, as shares of the time that the replay predicts for them.
    pub held_back: HeldBack,
    /// Threads, and times faster that was measured with them.
    pub measured: Vec<(usize, f64)>,
}

/// Shares of the time of a step on [`MANY`] workers that more of them would not take away.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct HeldBack {
    /// Work between jobs.
    pub serial: f64,
    /// Waits for the last job of a part, and threads that its work does not pay for.
    pub uneven: f64,
    /// Costs of handing parts to threads.
    pub waits: f64,
}

/// Record of all scenes and questions, as `benchmarks/cores.schema.json` describes it.
#[derive(Serialize)]
pub struct Record<'a> {
    format: u32,
    cores_of: &'a Machine,
    wait_ms: f64,
    workers: [usize; WORKERS.len()],
    measured: &'a [Measured],
}

impl<'a> Record<'a> {
    /// Record of what was measured on a machine, with the cost of a wait.
    pub fn of(cores_of: &'a Machine, wait_ms: f64, measured: &'a [Measured]) -> Self {
        Self {
            format: 1,
            cores_of,
            wait_ms,
            workers: WORKERS,
            measured,
        }
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Keeps all cores busy for a while. Cores that have slept, of virtual machines above all, are slow
/// at first, and slower to answer each other.
pub fn wake_cores() {
    let start = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..cores() {
            scope.spawn(|| {
                while start.elapsed() < AWAKE {
                    std::hint::spin_loop();
                }
            });
        }
    });
}

/// Milliseconds that a part without work costs two threads: the median of some runs.
pub fn wait_ms() -> f64 {
    let mut world = world_of(2);
    median((0..=10).map(|_| {
        let start = Instant::now();
        world.run_empty_parts(WAITS);
        milliseconds(start.elapsed()) / f64::from(WAITS)
    }))
}

fn median(times: impl Iterator<Item = f64>) -> f64 {
    let mut times: Vec<f64> = times.collect();
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Measures all scenes and questions, or small ones, and replays them with a cost of a wait.
/// `show` is given each as it is known.
#[expect(
    clippy::missing_panics_doc,
    reason = "scenes and their shapes are fixed, and worlds take them"
)]
pub fn measure(
    wait_ms: f64,
    is_small: bool,
    rounds: usize,
    show: &mut dyn FnMut(&Measured),
) -> Vec<Measured> {
    let cores = cores();
    let counts = (0..).map(|power| 1 << power);
    let counts: Vec<usize> = counts.take_while(|&count| count <= cores).collect();
    let mut all = Vec::new();
    for (name, triangles, steps) in SCENES {
        let tiny = if is_small { 50 } else { TINY };
        let triangles = match (is_small, name) {
            (false, _) => triangles,
            (true, "cloth") => 1_250,
            (true, _) => triangles.min(1_280),
        };
        let seed = Scene::DEFAULT_SEED;
        let scene = match name {
            "gather" => Scene::gather(tiny, triangles, seed),
            _ => Scene::new(name, Some(triangles), seed),
        };
        let scene = scene.expect("a scene that there is");
        let played = Played::new(&scene, steps);
        for question in QUESTIONS {
            let times = played.times(question, &counts, rounds);
            let one = times[0];
            let parts = played.record(question);
            let steps = played.steps() as f64;
            let sum = |of: &dyn Fn(&RecordedPart) -> u64| {
                1e-6 * parts.iter().map(of).sum::<u64>() as f64 / steps
            };
            let serial = sum(&|part| part.serial);
            let work = serial + sum(&|part| part.jobs.iter().sum());
            let longest = sum(&|part| part.jobs.iter().copied().max().unwrap_or_default());
            let replayed = |workers| {
                let mut times = [0.0; 3];
                for part in &parts {
                    let of_part = replay(part, workers, 1e6 * wait_ms);
                    let sums = times.iter_mut().zip(of_part);
                    sums.for_each(|(sum, time)| *sum += 1e-6 * time / steps);
                }
                times
            };
            let [_, shared, waits] = replayed(MANY);
            let time = serial + shared + waits;
            let held_back = HeldBack {
                serial: serial / time,
                uneven: (shared - (work - serial) / MANY as f64) / time,
                waits: waits / time,
            };
            let faster = times.iter().map(|time| one / time);
            let measured = counts.iter().copied().zip(faster).skip(1);
            let measured = Measured {
                scene: format!("{name} {} x {triangles}", scene.body_count()),
                question,
                one_thread_ms: one,
                work_ms: work,
                span_ms: serial + longest,
                serial_share: serial / work,
                parts: parts.iter().filter(|part| part.most_threads > 1).count() / played.steps(),
                predicted: WORKERS
                    .map(|workers| work / replayed(workers).iter().sum::<f64>())
                    .to_vec(),
                held_back,
                measured: measured.collect(),
            };
            show(&measured);
            all.push(measured);
        }
    }
    all
}

/// Nanoseconds that a part takes a number of workers: of serial work, of jobs, of waits.
fn replay(part: &RecordedPart, workers: usize, wait: f64) -> [f64; 3] {
    let workers = workers.min(part.most_threads).max(1);
    let mut ends = vec![0; workers];
    for job in &part.jobs {
        let first = ends.iter_mut().min().expect("at least one worker");
        *first += job;
    }
    let last = ends.into_iter().max().unwrap_or_default();
    [part.serial as f64, last as f64, wait * (workers - 1) as f64]
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

fn world_of(threads: usize) -> World<f32> {
    let mut options = Options::default();
    options.threads = NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN);
    World::with_options(options)
}

/// Meshes of bodies, their shapes at some steps, and the shapes of the step behind.
struct Played {
    meshes: Vec<Vec<[u32; 3]>>,
    /// By steps, then by bodies.
    shapes: Vec<Vec<Vec<[f32; 3]>>>,
    mean_edge: f64,
}

impl Played {
    fn new(scene: &Scene, steps: std::ops::Range<u32>) -> Self {
        let bodies = 0..scene.body_count();
        let meshes: Vec<_> = bodies
            .clone()
            .map(|body| scene.triangles(body).to_vec())
            .collect();
        let shape = |body, step| {
            let mut shape = Vec::new();
            scene.positions(body, step, &mut shape);
            shape
        };
        let shapes = (steps.start..=steps.end)
            .map(|step| bodies.clone().map(|body| shape(body, step)).collect());
        let shapes: Vec<Vec<_>> = shapes.collect();
        let mean_edge = mean_edge(&meshes, &shapes[0]);
        Self {
            meshes,
            shapes,
            mean_edge,
        }
    }

    fn steps(&self) -> usize {
        self.shapes.len() - 1
    }

    /// Milliseconds a step with each number of threads: medians over rounds, in which they take
    /// turns.
    fn times(&self, question: Question, counts: &[usize], rounds: usize) -> Vec<f64> {
        let worlds = counts.iter().map(|&threads| self.built(world_of(threads)));
        let mut worlds: Vec<_> = worlds.collect();
        let mut rounds: Vec<Vec<f64>> = (0..=rounds)
            .map(|_| {
                let times = worlds.iter_mut().map(|(world, bodies)| {
                    let start = Instant::now();
                    self.play(world, bodies, question);
                    milliseconds(start.elapsed()) / self.steps() as f64
                });
                times.collect()
            })
            .collect();
        // The first round fills buffers.
        rounds.remove(0);
        let of_one = |which| median(rounds.iter().map(|times| times[which]));
        (0..counts.len()).map(of_one).collect()
    }

    /// Jobs of all steps.
    fn record(&self, question: Question) -> Vec<RecordedPart> {
        let (mut world, bodies) = self.built(world_of(1));
        let start = Instant::now();
        let clock = Arc::new(move || start.elapsed().as_nanos() as u64);
        let threads = NonZeroUsize::new(RECORDED).unwrap_or(NonZeroUsize::MIN);
        world.record_jobs(threads, clock);
        self.play(&mut world, &bodies, question);
        world.take_record();
        self.play(&mut world, &bodies, question);
        world.take_record()
    }

    fn built(&self, mut world: World<f32>) -> (World<f32>, Vec<BodyId>) {
        let meshes = self.meshes.iter().zip(&self.shapes[0]);
        let added = meshes.map(|(triangles, shape)| world.add(triangles, shape));
        let bodies = added
            .map(|body| body.expect("a scene is a world"))
            .collect();
        (world, bodies)
    }

    /// Moves all bodies and asks, at every step.
    fn play(&self, world: &mut World<f32>, bodies: &[BodyId], question: Question) {
        for step in 0..self.steps() {
            let shapes = |step: usize| {
                let shapes: &Vec<Vec<_>> = &self.shapes[step];
                bodies.iter().copied().zip(shapes.iter().map(Vec::as_slice))
            };
            let now: Vec<_> = shapes(step).collect();
            world.set_positions_of(&now).expect("shapes of a scene");
            let moves = [Question::Impacts, Question::FirstImpact, Question::FreeStep];
            if moves.contains(&question) {
                for (id, end) in shapes(step + 1) {
                    world.set_motion(id, end).expect("shapes of a scene");
                }
            }
            ask(world, question, MARGIN * self.mean_edge);
        }
    }
}

/// Asks everything of everybody.
fn ask(world: &mut World<f32>, question: Question, margin: f64) {
    let of = Selection::Everything;
    let count = match question {
        Question::Intersections => world.intersections(of).all().map(<[_]>::len),
        Question::Contacts => world.contacts(of).all().map(<[_]>::len),
        Question::Candidates => world
            .vertex_triangle_candidates(of, margin / 2.0)
            .all()
            .map(<[_]>::len)
            .and_then(|count| {
                let edges = world.edge_edge_candidates(of, margin / 2.0).all();
                edges.map(|edges| count + edges.len())
            }),
        Question::Close => world
            .close_vertex_triangle_pairs(of, margin)
            .all()
            .map(<[_]>::len)
            .and_then(|count| {
                let edges = world.close_edge_edge_pairs(of, margin).all();
                edges.map(|edges| count + edges.len())
            }),
        Question::Impacts => world
            .vertex_triangle_impacts(of)
            .all()
            .map(<[_]>::len)
            .and_then(|count| {
                let edges = world.edge_edge_impacts(of).all();
                edges.map(|edges| count + edges.len())
            }),
        Question::FirstImpact => world
            .first_impact(of, 1e-6)
            .map(|found| usize::from(found.is_some())),
        Question::FreeStep => world.collision_free_step(of, 0.0).map(|_| 0),
    };
    std::hint::black_box(count).expect("nothing interrupts it");
}

/// Mean length of the first sides of triangles.
fn mean_edge(meshes: &[Vec<[u32; 3]>], shapes: &[Vec<[f32; 3]>]) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for (triangles, shape) in meshes.iter().zip(shapes) {
        for &[a, b, _] in triangles {
            let [a, b] = [a, b].map(|vertex| shape[vertex as usize].map(f64::from));
            let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
            sum += squares.sum::<f64>().sqrt();
            count += 1;
        }
    }
    sum / f64::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_replay_gives_jobs_to_who_is_free_first() {
        let part = RecordedPart {
            serial: 5,
            jobs: vec![4, 1, 1, 1, 3],
            most_threads: 2,
        };
        let times = [1, 2, 16].map(|workers| replay(&part, workers, 0.5));
        let expected = [[5.0, 10.0, 0.0], [5.0, 6.0, 0.5], [5.0, 6.0, 0.5]];
        assert_eq!(times, expected);
    }
}
