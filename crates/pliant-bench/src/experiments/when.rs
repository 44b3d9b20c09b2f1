//! When vertices meet triangles and edges meet edges on their way to the next step, beside what it costs to find those that could, and beside
//! the question that needs no way: which triangles intersect now.
//!
//! Everything is asked of all bodies and of each with itself, as a simulator does; *whole* is the way to the next step, *tenth* its first tenth.
//! What a candidate costs is the time of all impacts less that of showing all candidates to a visitor who counts them, over their number.

use super::{DEFAULT, Experiment, Form, Planned, STEPS, every, scene, whole};
use crate::contest::{Contender, Contest, Query};
use crate::decision::exact;
use crate::methods::{Everywhere, NearSweep, Ours, Precision};
use crate::motion::Motion;
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::Options;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: "when",
    about: "what meets on its way, over candidates and intersections",
    plan,
    claims,
};

/// All impacts; candidates counted; the first impact; all intersections now: in either precision.
const SINGLE: [&str; 4] = [
    DEFAULT,
    "pliant, candidates",
    "pliant, first impact",
    "pliant, intersections",
];
const DOUBLE: [&str; 4] = [
    "pliant, f64",
    "pliant, f64, candidates",
    "pliant, f64, first impact",
    "pliant, f64, intersections",
];

struct Line {
    name: &'static str,
    scene: &'static str,
    /// Triangles a body, in full and in small form.
    triangles: [usize; 2],
    steps: Vec<u32>,
    /// How much of the way to the next step.
    part: f32,
}

fn lines() -> Vec<Line> {
    let spheres = |name, part| Line {
        name,
        scene: "spheres",
        triangles: [20_480, 320],
        steps: every(20, 180),
        part,
    };
    let crowd = |name, part| Line {
        scene: "crowd",
        triangles: [5_120, 320],
        steps: every(40, 160),
        ..spheres(name, part)
    };
    let cloth = |name, part| Line {
        scene: "cloth",
        triangles: [79_202, 648],
        steps: (35..=49).step_by(2).collect(),
        ..spheres(name, part)
    };
    vec![
        spheres("two spheres, whole", 1.0),
        spheres("two spheres, tenth", 0.1),
        crowd("27 spheres, whole", 1.0),
        crowd("27 spheres, tenth", 0.1),
        cloth("cloth, whole", 1.0),
        cloth("cloth, tenth", 0.1),
    ]
}

fn plan(form: Form) -> Vec<Planned> {
    lines()
        .into_iter()
        .map(|mut line| {
            if form == Form::Small {
                line.steps.drain(..line.steps.len() - 2);
            }
            let methods = SINGLE.len() + DOUBLE.len();
            Planned::new(methods, line.steps.len(), move || line.contest(form))
        })
        .collect()
}

impl Line {
    fn contest(self, form: Form) -> Contest {
        let scene = scene(self.scene, self.triangles[usize::from(form == Form::Small)]);
        let motion = Motion::of_scene(&scene, self.steps.iter().copied());
        // In a tenth of a step of few triangles nothing meets.
        let part = if form == Form::Small { 1.0 } else { self.part };
        let motion = motion.on_the_way(&scene, part);
        let mut methods = Vec::from(contenders::<f32>(SINGLE));
        methods.extend(contenders::<f64>(DOUBLE));
        Contest {
            name: self.name.to_owned(),
            motion,
            query: Query::When,
            truth: Box::new(NearSweep::meeting()),
            methods,
            windows: whole(&self.steps),
            cold: false,
        }
    }
}

fn contenders<S: Precision>(labels: [&'static str; 4]) -> [Contender; 4] {
    let ours = |label| Ours::<S>::new(label, Options::default());
    let [impacts, candidates, first, intersections] = labels;
    [
        Contender::new(impacts, ours(impacts).impacts()),
        Contender::new(candidates, ours(candidates).counting(0.0))
            .compared_with(NearSweep::new(0.0).counted()),
        Contender::new(first, ours(first).first_impact())
            .compared_with(NearSweep::meeting().earliest()),
        Contender::new(intersections, ours(intersections).intersections())
            .compared_with(Everywhere::new(exact)),
    ]
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    let mut at_most = |claim: String, found: f64, limit: f64, figure: String| {
        let verdict = if found <= limit {
            Verdict::Holds
        } else {
            Verdict::DoesNotHoldToday
        };
        claims.push(Claim {
            claim,
            verdict,
            figure,
        });
    };
    for contest in contests {
        let name = &contest.name;
        for [impacts, candidates, first, intersections] in [SINGLE, DOUBLE] {
            if let Some(each) = nanoseconds_a_candidate(contest, impacts, candidates) {
                let claim = format!("{name}: a candidate of {impacts} takes at most 40 ns");
                at_most(claim, each, 40.0, format!("{each:.1} ns"));
            }
            let over = contest.times_faster(intersections, first, STEPS);
            if over.is_finite() {
                let claim = format!("{name}: time of {first} over {intersections}, at most 4");
                at_most(claim, over, 4.0, format!("{over:.2}"));
            }
        }
    }
    claims
}

/// What deciding costs, hits included: nothing if somebody was wrong or had nothing to do.
fn nanoseconds_a_candidate(
    contest: &ContestRecord,
    impacts: &str,
    candidates: &str,
) -> Option<f64> {
    let method = |label: &str| contest.methods.iter().find(|it| it.name == label);
    let (all, shown) = (method(impacts)?, method(candidates)?);
    let steps = contest.steps.len() as f64;
    let [all_ms, shown_ms] = [all.windows.first()?, shown.windows.first()?].map(|it| it.mean_ms);
    let decided: u64 = shown.counters.iter().map(|it| it.decisions).sum();
    (decided > 0).then(|| (all_ms - shown_ms) * steps * 1e6 / decided as f64)
}
