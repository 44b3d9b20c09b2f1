//! Candidates of a simulation step (vertices near triangles, edges near edges), beside libraries of
//! today with grown boxes.
//!
//! All bodies and each with itself are asked, as a solver does. *Margin m* is m mean edge lengths:
//! the largest gap of two elements, each grown by half of it. *Swept* is margin 0 along the stated
//! part of the way to the next step.

use super::lines::{Line, planned};
use super::{
    DEFAULT, Experiment, Form, OBVHS_1, OBVHS_4, PARRY, Planned, STEPS, factor_claim, titles,
};
use crate::contest::{Contender, Contest, Query};
use crate::methods::{NearObvhs, NearParry, NearSweep, Ours};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::{Options, Update};

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::NEAR.name,
    about: titles::NEAR.about,
    plan,
    claims,
};

const F64: &str = "pliant, f64";
const TWO_THREADS: &str = "pliant, two threads";
const COMPLETE: &str = "pliant, every box every step";
const METHODS: [&str; 7] = [DEFAULT, F64, TWO_THREADS, COMPLETE, PARRY, OBVHS_1, OBVHS_4];
const PEERS: [&str; 3] = [PARRY, OBVHS_1, OBVHS_4];

/// Margin or motion of a query.
#[derive(Clone, Copy, Debug)]
enum Asked {
    /// Margin in mean edge lengths.
    Margin(f64),
    /// Motion over this part of the way to the next step.
    Swept(f32),
}

const SPHERES: &str = "two spheres, margin 0.1";
const SPHERES_WIDE: &str = "two spheres, margin 0.5";
const SPHERES_SWEPT: &str = "two spheres, swept tenth";
const CROWD: &str = "27 spheres, margin 0.1";
const CLOTH: &str = "cloth, margin 0.1";
const CLOTH_WIDE: &str = "cloth, margin 0.5";
const CLOTH_SWEPT: &str = "cloth, swept tenth";

fn plan(form: Form) -> Vec<Planned> {
    let lines = vec![
        Line::spheres(SPHERES, Asked::Margin(0.1)),
        Line::spheres(SPHERES_WIDE, Asked::Margin(0.5)),
        Line::spheres(SPHERES_SWEPT, Asked::Swept(0.1)),
        Line::crowd(CROWD, Asked::Margin(0.1)),
        Line::cloth(CLOTH, Asked::Margin(0.1)),
        Line::cloth(CLOTH_WIDE, Asked::Margin(0.5)),
        Line::cloth(CLOTH_SWEPT, Asked::Swept(0.1)),
    ];
    planned(lines, form, |_| METHODS.len(), contest)
}

fn contest(line: &Line<Asked>, form: Form) -> Contest {
    let (scene, motion) = line.played(form);
    let (motion, radius) = match line.asked {
        Asked::Margin(lengths) => {
            let radius = lengths / 2.0 * motion.mean_side();
            (motion, radius)
        }
        Asked::Swept(part) => (motion.on_the_way(&scene, part), 0.0),
    };
    let methods = METHODS.map(|label| method(label, radius));
    line.contest(motion, Query::Near, NearSweep::new(radius), methods)
}

fn method(label: &'static str, radius: f64) -> Contender {
    let mut options = Options::default();
    match label {
        F64 => Contender::new(label, Ours::<f64>::new(label, options).within(radius)),
        PARRY => Contender::new(label, NearParry::new(radius)),
        OBVHS_1 => Contender::new(label, NearObvhs::new(1, radius)),
        OBVHS_4 => Contender::new(label, NearObvhs::new(4, radius)),
        TWO_THREADS => {
            options.threads = std::num::NonZeroUsize::MIN.saturating_add(1);
            Contender::new(label, Ours::<f32>::new(label, options).within(radius))
        }
        COMPLETE => {
            options.update = Update::BottomUp;
            Contender::new(label, Ours::<f32>::new(label, options).within(radius))
        }
        _ => Contender::new(label, Ours::<f32>::new(label, options).within(radius)),
    }
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for contest in contests {
        let name = &contest.name;
        if let Some((factor, peer)) = contest.fastest(DEFAULT, &PEERS, STEPS) {
            let claim = format!("{name}: 4 times faster than the fastest peer with grown boxes");
            let figure = format!("{factor:.2} times, the fastest is {peer}");
            claims.push(factor_claim(&claim, factor, 4.0, 4.0, figure));
        }
        let threads = contest.times_faster(TWO_THREADS, DEFAULT, STEPS);
        if threads.is_finite() {
            let claim = format!("{name}: two threads 1.6 times faster than one");
            claims.push(factor_claim(
                &claim,
                threads,
                1.6,
                1.6,
                format!("{threads:.2}"),
            ));
        }
        let complete = contest.times_faster(DEFAULT, COMPLETE, STEPS);
        if complete.is_finite() {
            claims.push(Claim {
                claim: format!("{name}: time of {COMPLETE} over the default"),
                verdict: Verdict::Measured,
                figure: format!("{complete:.2}"),
            });
        }
    }
    claims
}
