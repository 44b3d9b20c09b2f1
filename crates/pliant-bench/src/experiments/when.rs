//! Impacts on the way to the next step, beside the candidates for them, and beside intersections
//! now.
//!
//! All bodies and each with itself are asked, as a simulator does. *Whole* is the way to the next
//! step, *tenth* its first tenth. The cost of a candidate is the time of all impacts minus the time
//! of a visitor who counts candidates, over their number.

use super::lines::{Line, planned};
use super::{DEFAULT, Experiment, Form, Planned, STEPS, titles};
use crate::contest::{Contender, Contest, Query};
use crate::decision::exact;
use crate::methods::{Everywhere, NearSweep, Ours, Precision};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::Options;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::WHEN.name,
    about: titles::WHEN.about,
    plan,
    claims,
};

/// Queries: all impacts, counted candidates, first impact, intersections now. In single precision.
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

fn plan(form: Form) -> Vec<Planned> {
    // Each with the part of the way to the next step.
    let lines = vec![
        Line::spheres("two spheres, whole", 1.0),
        Line::spheres("two spheres, tenth", 0.1),
        Line::crowd("27 spheres, whole", 1.0),
        Line::crowd("27 spheres, tenth", 0.1),
        Line::cloth("cloth, whole", 1.0),
        Line::cloth("cloth, tenth", 0.1),
    ];
    planned(lines, form, |_| SINGLE.len() + DOUBLE.len(), contest)
}

fn contest(line: &Line<f32>, form: Form) -> Contest {
    let (scene, motion) = line.played(form);
    // In a tenth of a step nothing meets if there are few triangles.
    let part = if form == Form::Small { 1.0 } else { line.asked };
    let motion = motion.on_the_way(&scene, part);
    let mut methods = Vec::from(contenders::<f32>(SINGLE));
    methods.extend(contenders::<f64>(DOUBLE));
    line.contest(motion, Query::When, NearSweep::meeting(), methods)
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
        claims.push(Claim {
            claim,
            verdict: Verdict::of(found <= limit),
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

/// Cost of deciding a candidate, hits included. `None` if a method was wrong or had nothing to do.
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
