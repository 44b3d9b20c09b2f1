//! Libraries of today, and lower bounds on time, on the scenes of the project's aims.
//!
//! Ratios refer to the fastest of parry3d and obvhs (1 and 4 triangles a leaf) in the same contest.
//! *Tree order* is the order of vertices that `World::vertex_order` returns, in which a simulation
//! can store them. Every method is given vertices in that order then.

use super::{
    DEFAULT, Experiment, Form, OBVHS_1, OBVHS_4, PARRY, Planned, contender, every, factor_claim,
    on_scene, scene, titles, window,
};
use crate::contest::{Contender, Contest, Query};
use crate::decision::exact;
use crate::methods::{Floor, Ours, Sweep};
use crate::motion::Motion;
use crate::record::{Claim, ContestRecord, Verdict, Window};
use pliant::{Options, Update, World};

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::PEERS.name,
    about: titles::PEERS.about,
    plan,
    claims,
};

const F64: &str = "pliant, f64";
const TWO_THREADS: &str = "pliant, two threads";
const COMPLETE: &str = "pliant, every box every step";
const PASS: &str = "floor: one pass";
const FLOOR: &str = "floor: pass, true pairs, sort";

const PEERS: [&str; 3] = [PARRY, OBVHS_1, OBVHS_4];

/// A contest to come.
struct Line {
    name: &'static str,
    scene: &'static str,
    /// Triangles a body, in full and in small form.
    triangles: [usize; 2],
    steps: Vec<u32>,
    query: Query,
    tree_order: bool,
    cold: bool,
    /// Methods beside the default and the peers.
    others: &'static [&'static str],
    windows: Vec<Window>,
}

const SPHERES: &str = "two spheres";
const SPHERES_IN_TREE_ORDER: &str = "two spheres, tree order";
const SPHERES_COLD: &str = "two spheres, nothing in cache";
const FIRST: &str = "two spheres, first pair";
const FIRST_IN_TREE_ORDER: &str = "two spheres, first pair, tree order";
const CROWD: &str = "27 spheres";
const CLOTH: &str = "cloth with itself";
const LARGE: &str = "two spheres of 327,680";
const LARGEST: &str = "two spheres of 1,310,720";

const EASY: &str = "easy";
const HARD: &str = "hard";
const DEEPEST: &str = "step 200";
const CONTACT: &str = "from contact";

fn lines() -> Vec<Line> {
    let spheres = |name, others| Line {
        name,
        scene: "spheres",
        triangles: [20_480, 320],
        steps: every(1, 200),
        query: Query::All,
        tree_order: false,
        cold: false,
        others,
        windows: vec![
            window(EASY, 1, 50),
            window(HARD, 150, 200),
            window(DEEPEST, 200, 200),
        ],
    };
    let first = |name, tree_order| Line {
        query: Query::First,
        steps: (60..=200).collect(),
        tree_order,
        windows: vec![window(CONTACT, 60, 200)],
        ..spheres(name, &[])
    };
    vec![
        spheres(SPHERES, &[F64, COMPLETE, PASS, FLOOR]),
        Line {
            tree_order: true,
            ..spheres(SPHERES_IN_TREE_ORDER, &[F64, PASS, FLOOR])
        },
        Line {
            cold: true,
            steps: every(10, 200),
            ..spheres(SPHERES_COLD, &[PASS, FLOOR])
        },
        first(FIRST, false),
        first(FIRST_IN_TREE_ORDER, true),
        Line {
            scene: "crowd",
            triangles: [5_120, 320],
            steps: (150..=200).collect(),
            windows: vec![window(HARD, 150, 200)],
            ..spheres(CROWD, &[F64, TWO_THREADS, PASS, FLOOR])
        },
        Line {
            scene: "cloth",
            triangles: [79_202, 648],
            steps: (35..=50).collect(),
            query: Query::Itself,
            windows: vec![window(HARD, 35, 50)],
            ..spheres(CLOTH, &[F64, TWO_THREADS, COMPLETE, PASS, FLOOR])
        },
        Line {
            triangles: [327_680, 1_280],
            steps: (150..=200).step_by(5).collect(),
            ..spheres(LARGE, &[F64, TWO_THREADS, PASS, FLOOR])
        },
        Line {
            triangles: [1_310_720, 5_120],
            steps: (150..=200).step_by(10).collect(),
            ..spheres(LARGEST, &[TWO_THREADS, PASS, FLOOR])
        },
    ]
}

fn plan(form: Form) -> Vec<Planned> {
    lines()
        .into_iter()
        .map(|mut line| {
            if form == Form::Small {
                let last = line.steps.last().copied();
                line.steps = last
                    .into_iter()
                    .chain(line.steps.iter().copied().step_by(30))
                    .collect();
                line.steps.sort_unstable();
                line.steps.dedup();
                line.cold = false;
            }
            let methods = 1 + PEERS.len() + line.others.len();
            Planned::new(methods, line.steps.len(), move || line.contest(form))
        })
        .collect()
}

impl Line {
    fn contest(self, form: Form) -> Contest {
        let triangles = self.triangles[usize::from(form == Form::Small)];
        let steps = self.steps.len();
        let methods: Vec<Contender> = [DEFAULT]
            .iter()
            .chain(&PEERS)
            .chain(self.others)
            .map(|label| method(label, steps, self.query))
            .collect();
        let mut contest = Contest {
            windows: self.windows,
            cold: self.cold,
            ..on_scene(
                self.name,
                &scene(self.scene, triangles),
                &self.steps,
                self.query,
                methods,
            )
        };
        if self.tree_order {
            contest.motion = in_tree_order(contest.motion);
        }
        contest
    }
}

/// A method by its name in tables, of this experiment alone or of all.
fn method(label: &'static str, steps: usize, query: Query) -> Contender {
    let floor = |decides| {
        let itself = query == Query::Itself;
        Contender::new(label, Floor::new(Sweep::new(exact), steps, itself, decides))
    };
    match label {
        F64 => Contender::new(label, Ours::<f64>::new(label, Options::default())),
        TWO_THREADS => {
            let mut options = Options::default();
            options.threads = std::num::NonZeroUsize::MIN.saturating_add(1);
            Contender::new(label, Ours::<f32>::new(label, options))
        }
        COMPLETE => {
            let mut options = Options::default();
            options.update = Update::BottomUp;
            Contender::new(label, Ours::<f32>::new(label, options).always())
        }
        PASS => floor(false),
        FLOOR => floor(true),
        _ => contender(label),
    }
}

/// The motion with vertices in the library's order.
fn in_tree_order(motion: Motion) -> Motion {
    let mut world = World::<f32>::new();
    let orders: Vec<Vec<u32>> = motion
        .bodies
        .iter()
        .map(|body| {
            let id = world
                .add(&body.triangles, &body.first.world)
                .expect("a scene's bodies are good");
            world.vertex_order(id).expect("it was added").to_vec()
        })
        .collect();
    motion.renumbered(&orders)
}

/// Factors over the fastest peer that the default has to reach.
const TARGETS: [(&str, &str, f64); 14] = [
    (SPHERES, EASY, 5.0),
    (SPHERES_IN_TREE_ORDER, EASY, 12.0),
    (FIRST, CONTACT, 5.0),
    (FIRST_IN_TREE_ORDER, CONTACT, 12.0),
    (SPHERES, HARD, 4.0),
    (SPHERES, DEEPEST, 4.0),
    (SPHERES_IN_TREE_ORDER, HARD, 4.0),
    (SPHERES_IN_TREE_ORDER, DEEPEST, 4.0),
    (CROWD, HARD, 4.0),
    (CLOTH, HARD, 4.0),
    (LARGE, HARD, 4.0),
    (LARGE, DEEPEST, 4.0),
    (LARGEST, HARD, 4.0),
    (LARGEST, DEEPEST, 4.0),
];

/// Bound on the time of one method over another, in a window.
enum Bound {
    AtMost(f64),
    AtLeast(f64),
}
use Bound::{AtLeast, AtMost};

const RATIOS: [(&str, &str, &str, &str, Bound); 18] = [
    (SPHERES, EASY, DEFAULT, PASS, AtMost(8.0)),
    (SPHERES_IN_TREE_ORDER, EASY, DEFAULT, PASS, AtMost(8.0)),
    (SPHERES, HARD, DEFAULT, FLOOR, AtMost(6.0)),
    (SPHERES_IN_TREE_ORDER, HARD, DEFAULT, FLOOR, AtMost(6.0)),
    (CROWD, HARD, DEFAULT, FLOOR, AtMost(6.0)),
    (CLOTH, HARD, DEFAULT, FLOOR, AtMost(6.0)),
    (LARGE, HARD, DEFAULT, FLOOR, AtMost(6.0)),
    (LARGEST, HARD, DEFAULT, FLOOR, AtMost(6.0)),
    (CROWD, HARD, DEFAULT, TWO_THREADS, AtLeast(1.7)),
    (CLOTH, HARD, DEFAULT, TWO_THREADS, AtLeast(1.7)),
    (LARGE, HARD, DEFAULT, TWO_THREADS, AtLeast(1.7)),
    (LARGEST, HARD, DEFAULT, TWO_THREADS, AtLeast(1.7)),
    (SPHERES, HARD, F64, DEFAULT, AtMost(1.6)),
    (CROWD, HARD, F64, DEFAULT, AtMost(1.6)),
    (CLOTH, HARD, F64, DEFAULT, AtMost(1.6)),
    (LARGE, HARD, F64, DEFAULT, AtMost(1.6)),
    (SPHERES, EASY, COMPLETE, DEFAULT, AtLeast(5.0)),
    (SPHERES, HARD, COMPLETE, DEFAULT, AtLeast(1.0)),
];

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let contest = |name| contests.iter().find(|contest| contest.name == name);
    let mut claims = Vec::new();
    let lines = TARGETS
        .into_iter()
        .map(|(name, window, wanted)| (name, window, Some(wanted)))
        .chain([(SPHERES_COLD, EASY, None), (SPHERES_COLD, HARD, None)]);
    for (name, window, wanted) in lines {
        let fastest = contest(name).and_then(|contest| contest.fastest(DEFAULT, &PEERS, window));
        let Some((factor, peer)) = fastest else {
            continue;
        };
        let figure = format!("{factor:.2} times, the fastest is {peer}");
        claims.push(match wanted {
            Some(wanted) => factor_claim(
                &format!("{name}, {window}: {wanted} times faster than the fastest peer"),
                factor,
                wanted,
                // An aim is reached or missed, nothing between.
                wanted,
                figure,
            ),
            None => Claim {
                claim: format!("{name}, {window}: against the fastest peer"),
                verdict: Verdict::Measured,
                figure,
            },
        });
    }
    for (name, window, slow, fast, bound) in RATIOS {
        let ratio =
            contest(name).map_or(f64::NAN, |contest| contest.times_faster(fast, slow, window));
        if ratio.is_nan() {
            continue;
        }
        let (bound, holds) = match bound {
            AtMost(most) => (format!("at most {most}"), ratio <= most),
            AtLeast(least) => (format!("at least {least}"), ratio >= least),
        };
        claims.push(Claim {
            claim: format!("{name}, {window}: time of {slow} over {fast}, {bound}"),
            verdict: Verdict::of(holds),
            figure: format!("{ratio:.2}"),
        });
    }
    claims
}
