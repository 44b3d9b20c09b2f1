//! Close pairs (vertex-triangle and edge-edge, measured) beside candidates at the same margin;
//! distances of bodies beside parry3d.
//!
//! Close pairs are asked of all bodies and of each with itself, as a solver does. *Margin m* is m
//! mean edge lengths: the largest distance of close pairs, and of the boxes of candidates. The two
//! bodies whose distance is asked deform at every step.

use super::lines::{Line, planned};
use super::{DEFAULT, Experiment, Form, Planned, STEPS, every, factor_claim, titles};
use crate::contest::{Contender, Contest, Query};
use crate::methods::{AllBoxes, FarParry, NearSweep, Ours};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::Options;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::CLOSE.name,
    about: titles::CLOSE.about,
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

/// Margin in mean edge lengths; `None` where the distance of two bodies is asked.
type Margin = Option<f64>;

fn lines() -> Vec<Line<Margin>> {
    let spheres = |name, margin| Line::spheres(name, Some(margin)).at(every(40, 160));
    let crowd = |name, margin| Line::crowd(name, Some(margin));
    let cloth = |name, margin| Line::cloth(name, Some(margin)).at((35..=49).step_by(4));
    let apart = |name, triangles| Line::spheres(name, None).of(triangles).at(1..=50);
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
    let methods = |margin: &Margin| margin.map_or(OF_BODIES.len(), |_| METHODS.len());
    planned(lines(), form, methods, contest)
}

fn contest(line: &Line<Margin>, form: Form) -> Contest {
    let (_, motion) = line.played(form);
    let Some(margin) = line.asked else {
        let methods = OF_BODIES.map(of_bodies);
        return line.contest(motion, Query::Distance, AllBoxes::default(), methods);
    };
    let distance = margin * motion.mean_side();
    let methods = METHODS.map(|label| method(label, distance));
    line.contest(
        motion,
        Query::Near,
        NearSweep::closer_than(distance),
        methods,
    )
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
            if let Some((factor, peer)) = contest.fastest(DEFAULT, &PEERS, STEPS) {
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
                claims.push(Claim {
                    claim,
                    verdict: Verdict::of(over <= 1.5),
                    figure: format!("{over:.2}"),
                });
            }
        }
    }
    claims
}
