//! Experiments: which motion, which methods, and which claims.
//!
//! An experiment is a plan: contests, made one after the other because their motions are large, and
//! claims that follow from all of them. Each has a small form, for tests.

mod all;
mod bodies;
#[cfg(feature = "peers")]
mod change;
#[cfg(feature = "peers")]
mod close;
#[cfg(feature = "peers")]
mod cloth;
#[cfg(feature = "peers")]
mod degenerate;
mod degrees;
#[cfg(feature = "peers")]
mod experiment_1;
#[cfg(feature = "peers")]
mod experiment_3;
mod levels;
mod lines;
#[cfg(feature = "peers")]
mod near;
#[cfg(feature = "peers")]
mod peers;
#[cfg(feature = "peers")]
mod response;
mod shapes;
mod splits;
mod table_1;
pub mod titles;
mod when;

pub use all::EXPERIMENTS;

use crate::contest::{Contender, Contest, Query};
use crate::decision::exact;
use crate::method::Method;
use crate::methods::{BruteForce, BucketTree, Frame, Ours, Smith, Sweep, VanDenBergen};
#[cfg(feature = "peers")]
use crate::methods::{Obvhs, Parry};
use crate::motion::Motion;
use crate::record::{Claim, ContestRecord, ExperimentRecord, Verdict, Window};
use pliant::{Degree, Options, Update};
use pliant_scenes::Scene;

/// Size of an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Full size: as in the paper, or larger.
    Full,
    /// Small size, which takes seconds, for tests: it says nothing about speed.
    Small,
}

/// A contest to come. Its motion is computed when its turn comes.
pub struct Planned {
    /// Steps of one round, over all methods: a unit of progress.
    pub steps_a_round: u64,
    make: Box<dyn FnOnce() -> Contest>,
}

impl Planned {
    /// A contest of `methods` methods over `steps` steps.
    fn new(methods: usize, steps: usize, make: impl FnOnce() -> Contest + 'static) -> Self {
        Self {
            steps_a_round: (methods * steps) as u64,
            make: Box::new(make),
        }
    }
}

/// An experiment: contests and claims.
pub struct Experiment {
    /// Name on the command line.
    pub name: &'static str,
    /// Description in one line.
    pub about: &'static str,
    plan: fn(Form) -> Vec<Planned>,
    claims: fn(&[ContestRecord]) -> Vec<Claim>,
}

impl Experiment {
    /// Number of steps played by all methods together: the length of a progress bar.
    pub fn length(&self, form: Form, rounds: usize) -> u64 {
        (self.plan)(form)
            .iter()
            .map(|planned| planned.steps_a_round * (rounds as u64 + 1))
            .sum()
    }

    /// Motions of the contests, one after the other, computed when asked for. For pictures.
    pub fn motions(&self, form: Form) -> impl Iterator<Item = Motion> {
        (self.plan)(form)
            .into_iter()
            .map(|planned| (planned.make)().motion)
    }

    /// Plays all contests. Calls `progress` with the name of the contest and the number of steps
    /// played.
    pub fn run(
        &self,
        form: Form,
        rounds: usize,
        progress: &mut dyn FnMut(&str, u64),
    ) -> ExperimentRecord {
        let contests: Vec<ContestRecord> = (self.plan)(form)
            .into_iter()
            .map(|planned| {
                let contest = (planned.make)();
                let name = contest.name.clone();
                contest.play(rounds, &mut |steps| progress(&name, steps))
            })
            .collect();
        let claims = (self.claims)(&contests);
        ExperimentRecord {
            experiment: self.name.to_owned(),
            small: form == Form::Small,
            rounds,
            contests,
            claims,
        }
    }
}

// Names of methods in tables.

const DEFAULT: &str = "pliant";
const HYBRID: &str = "pliant, paper: hybrid";
const TOP_DOWN: &str = "pliant, paper: top-down";
const BOTTOM_UP: &str = "pliant, paper: bottom-up";
const BERGEN_LOCAL: &str = "van den Bergen, local frame";
const BERGEN_WORLD: &str = "van den Bergen, world frame";
const BERGEN_LOCAL_8: &str = "van den Bergen, local frame, 8-ary";
const BERGEN_WORLD_8: &str = "van den Bergen, world frame, 8-ary";
const SMITH: &str = "Smith et al., depth 5";
const BUCKETS_3: &str = "BucketTree, depth 3";
const BUCKETS_4: &str = "BucketTree, depth 4";
const BUCKETS_5: &str = "BucketTree, depth 5";
const FLAT_SWEEP: &str = "flat sweep";
const BRUTE_FORCE: &str = "brute force over boxes";
#[cfg(feature = "peers")]
const PARRY: &str = "parry3d";
#[cfg(feature = "peers")]
const OBVHS_1: &str = "obvhs, 1 a leaf";
#[cfg(feature = "peers")]
const OBVHS_4: &str = "obvhs, 4 a leaf";

/// The library in a configuration.
fn ours(label: &str, change: impl FnOnce(&mut Options)) -> Contender {
    let mut options = if label == DEFAULT {
        Options::default()
    } else {
        Options::paper()
    };
    change(&mut options);
    Contender::new(label, Ours::<f32>::new(label, options))
}

/// A method by its name in tables.
fn contender(label: &'static str) -> Contender {
    let bergen = |frame, degree| Contender::new(label, VanDenBergen::new(frame, degree, exact));
    match label {
        TOP_DOWN => ours(label, |options| options.update = Update::TopDown),
        BOTTOM_UP => ours(label, |options| options.update = Update::BottomUp),
        BERGEN_LOCAL => bergen(Frame::Local, Degree::Two),
        BERGEN_WORLD => bergen(Frame::World, Degree::Two),
        BERGEN_LOCAL_8 => bergen(Frame::Local, Degree::Eight),
        BERGEN_WORLD_8 => bergen(Frame::World, Degree::Eight),
        SMITH => Contender::new(label, Smith::new(5, false, exact)),
        BUCKETS_3 => Contender::new(label, BucketTree::new(3, exact)),
        BUCKETS_4 => Contender::new(label, BucketTree::new(4, exact)),
        BUCKETS_5 => Contender::new(label, BucketTree::new(5, exact)),
        FLAT_SWEEP => Contender::new(label, Sweep::new(exact)),
        BRUTE_FORCE => Contender::new(label, BruteForce::new(exact)),
        #[cfg(feature = "peers")]
        PARRY => Contender::new(label, Parry::new(exact)),
        #[cfg(feature = "peers")]
        OBVHS_1 => Contender::new(label, Obvhs::new(1, exact)),
        #[cfg(feature = "peers")]
        OBVHS_4 => Contender::new(label, Obvhs::new(4, exact)),
        _ => ours(label, |_| ()),
    }
}

fn contenders(labels: &[&'static str]) -> Vec<Contender> {
    labels.iter().map(|label| contender(label)).collect()
}

/// The truth: no tree, and not ours.
fn truth() -> Box<dyn Method> {
    Box::new(Sweep::new(exact))
}

/// A scene by its name, which must exist.
fn scene(name: &str, triangles: usize) -> Scene {
    Scene::new(name, Some(triangles), Scene::DEFAULT_SEED).expect("the size is one of the scene's")
}

/// Steps `stride`, 2 `stride`, ... up to `last`.
fn every(stride: u32, last: u32) -> Vec<u32> {
    (stride..=last).step_by(stride as usize).collect()
}

fn window(name: &str, first: u32, last: u32) -> Window {
    Window {
        name: name.to_owned(),
        first,
        last,
    }
}

/// Name of the window that [`whole`] makes.
const STEPS: &str = "all";

/// One window of all steps, if there are any.
fn whole(steps: &[u32]) -> Vec<Window> {
    let ends = steps.first().zip(steps.last()).into_iter();
    ends.map(|(&first, &last)| window(STEPS, first, last))
        .collect()
}

/// Windows of a scene of 200 steps.
fn windows() -> Vec<Window> {
    vec![
        window("easy", 1, 50),
        window("hard", 151, 200),
        window("all", 1, 200),
    ]
}

/// A contest on a scene.
fn on_scene(
    name: &str,
    scene: &Scene,
    steps: &[u32],
    query: Query,
    methods: Vec<Contender>,
) -> Contest {
    Contest {
        name: name.to_owned(),
        motion: Motion::of_scene(scene, steps.iter().copied()),
        query,
        truth: truth(),
        methods,
        windows: windows(),
        cold: false,
    }
}

/// A claim that a factor is at least `wanted`. Down to `least` it holds weaker.
fn factor_claim(claim: &str, factor: f64, wanted: f64, least: f64, figure: String) -> Claim {
    let verdict = match factor {
        factor if factor >= wanted => Verdict::Holds,
        factor if factor >= least => Verdict::HoldsWeaker,
        _ => Verdict::DoesNotHoldToday,
    };
    Claim {
        claim: claim.to_owned(),
        verdict,
        figure,
    }
}
