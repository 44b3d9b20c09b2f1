//! What is close: vertices and triangles, and edges and edges, that are at most so far apart, measured, beside candidates at the same margin;
//! and how far two bodies are apart that deform at every step, beside parry3d.
//!
//! Close pairs are asked of all bodies and of each with itself, as a solver does. *Margin m* is m mean lengths of an edge: elements are close
//! that are at most so far apart, and candidates are those whose boxes are.

use super::{DEFAULT, Experiment, Form, Planned, STEPS, every, factor_claim, scene, whole};
use crate::contest::{Contender, Contest, Query};
use crate::methods::{AllBoxes, FarParry, NearSweep, Ours};
use crate::motion::Motion;
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::Options;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: "close",
    about: "close pairs over candidates, and distances, with parry3d",
    plan,
    claims,
};

const CANDIDATES: &str = "pliant, candidates";
const F64: &str = "pliant, f64";
const F64_CANDIDATES: &str = "pliant, f64, candidates";
const METHODS: [&str; 4] = [DEFAULT, CANDIDATES, F64, F64_CANDIDATES];

const BY_QUERY: &str = "parry3d, its distance";
const BY_LEAF_PAIRS: &str = "parry3d, leaf pairs";
const OF_BODIES: [&str; 4] = [DEFAULT, F64, BY_QUERY, BY_LEAF_PAIRS];
const PEERS: [&str; 2] = [BY_QUERY, BY_LEAF_PAIRS];

const DISTANCE: &str = "distance";

struct Line {
    name: &'static str,
    scene: &'static str,
    /// Triangles a body, in full and in small form.
    triangles: [usize; 2],
    steps: Vec<u32>,
    /// In mean lengths of an edge; none where bodies are asked how far they are apart.
    margin: Option<f64>,
}

fn lines() -> Vec<Line> {
    let spheres = |name, margin| Line {
        name,
        scene: "spheres",
        triangles: [20_480, 320],
        steps: every(40, 160),
        margin: Some(margin),
    };
    let crowd = |name, margin| Line {
        scene: "crowd",
        triangles: [5_120, 320],
        ..spheres(name, margin)
    };
    let cloth = |name, margin| Line {
        scene: "cloth",
        triangles: [79_202, 648],
        steps: (35..=49).step_by(4).collect(),
        ..spheres(name, margin)
    };
    let apart = |name, triangles| Line {
        triangles: [triangles, 320],
        steps: (1..=50).collect(),
        margin: None,
        ..spheres(name, 0.0)
    };
    vec![
        spheres("two spheres, margin 0.1", 0.1),
        spheres("two spheres, margin 0.5", 0.5),
        crowd("27 spheres, margin 0.1", 0.1),
        crowd("27 spheres, margin 0.5", 0.5),
        cloth("cloth, margin 0.1", 0.1),
        cloth("cloth, margin 0.5", 0.5),
        apart("distance of two spheres of 1,280", 1_280),
        apart("distance of two spheres of 20,480", 20_480),
    ]
}

fn plan(form: Form) -> Vec<Planned> {
    lines()
        .into_iter()
        .map(|mut line| {
            if form == Form::Small {
                line.steps.drain(..line.steps.len() - 2);
            }
            let methods = line.margin.map_or(OF_BODIES.len(), |_| METHODS.len());
            Planned::new(methods, line.steps.len(), move || line.contest(form))
        })
        .collect()
}

impl Line {
    fn contest(self, form: Form) -> Contest {
        let scene = scene(self.scene, self.triangles[usize::from(form == Form::Small)]);
        let motion = Motion::of_scene(&scene, self.steps.iter().copied());
        let windows = whole(&self.steps);
        let name = self.name.to_owned();
        let Some(margin) = self.margin else {
            return Contest {
                name,
                motion,
                query: Query::Distance,
                truth: Box::new(AllBoxes::default()),
                methods: OF_BODIES.map(of_bodies).into(),
                windows,
                cold: false,
            };
        };
        let distance = margin * motion.mean_side();
        Contest {
            name,
            motion,
            query: Query::Near,
            truth: Box::new(NearSweep::closer_than(distance)),
            methods: METHODS.map(|label| method(label, distance)).into(),
            windows,
            cold: false,
        }
    }
}

fn method(label: &'static str, distance: f64) -> Contender {
    let radius = distance / 2.0;
    let options = Options::default();
    match label {
        CANDIDATES => Contender::new(label, Ours::<f32>::new(label, options).within(radius))
            .compared_with(NearSweep::new(radius)),
        F64_CANDIDATES => Contender::new(label, Ours::<f64>::new(label, options).within(radius))
            .compared_with(NearSweep::new(radius)),
        F64 => Contender::new(
            label,
            Ours::<f64>::new(label, options).closer_than(distance),
        ),
        _ => Contender::new(
            label,
            Ours::<f32>::new(label, options).closer_than(distance),
        ),
    }
}

fn of_bodies(label: &'static str) -> Contender {
    let options = Options::default();
    match label {
        BY_QUERY => Contender::new(label, FarParry::by_query()),
        BY_LEAF_PAIRS => Contender::new(label, FarParry::by_leaf_pairs()),
        F64 => Contender::new(label, Ours::<f64>::new(label, options)),
        _ => Contender::new(label, Ours::<f32>::new(label, options)),
    }
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for contest in contests {
        let name = &contest.name;
        if contest.query == DISTANCE {
            let fastest = PEERS
                .into_iter()
                .map(|peer| (contest.times_faster(DEFAULT, peer, STEPS), peer))
                .filter(|(factor, _)| factor.is_finite())
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((factor, peer)) = fastest {
                let claim = format!("{name}: 10 times faster than parry3d in its faster way");
                let figure = format!("{factor:.2} times, the faster is {peer}");
                claims.push(factor_claim(&claim, factor, 10.0, 10.0, figure));
            }
            continue;
        }
        for (close, candidates) in [(DEFAULT, CANDIDATES), (F64, F64_CANDIDATES)] {
            let over = contest.times_faster(candidates, close, STEPS);
            if over.is_finite() {
                let claim =
                    format!("{name}: time of {close}, close pairs, over candidates, at most 1.5");
                let verdict = if over <= 1.5 {
                    Verdict::Holds
                } else {
                    Verdict::DoesNotHoldToday
                };
                claims.push(Claim {
                    claim,
                    verdict,
                    figure: format!("{over:.2}"),
                });
            }
        }
    }
    claims
}
