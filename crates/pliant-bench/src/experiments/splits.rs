//! Partitions of the initial tree: centre, mean, mesh connectivity, and balanced, which the paper
//! does not have.
//!
//! "There is no significant difference between these two ways of choosing the values for the split
//! planes" (paper, 3.2). "The average collision detection time per time step is typically between
//! zero to 10 percent better for the mesh connectivity trees" (4).

use super::{
    DEFAULT, Experiment, Form, HYBRID, Planned, contender, every, on_scene, ours, scene, titles,
};
use crate::contest::{Contender, Query};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::Partition;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::SPLITS.name,
    about: titles::SPLITS.about,
    plan,
    claims,
};

const MEAN: &str = "pliant, paper: mean";
const CONNECTIVITY: &str = "pliant, paper: connectivity";
const BALANCED: &str = "pliant, paper: balanced";

fn methods() -> Vec<Contender> {
    let partition = |label: &str, partition| ours(label, |options| options.partition = partition);
    vec![
        contender(HYBRID),
        partition(MEAN, Partition::Mean),
        partition(CONNECTIVITY, Partition::Connectivity),
        partition(BALANCED, Partition::Balanced),
        contender(DEFAULT),
    ]
}

fn plan(form: Form) -> Vec<Planned> {
    let scenes = [
        ("spheres", 20_480, 320, 200, Query::All),
        ("arms", 5120, 1280, 200, Query::All),
        ("cloth", 79_202, 648, 50, Query::Itself),
    ];
    scenes
        .into_iter()
        .map(|(name, full, small, last, query)| {
            let (triangles, steps) = if form == Form::Full {
                (full, every(last / 50, last))
            } else {
                (small, every(last / 2, last))
            };
            Planned::new(methods().len(), steps.len(), move || {
                on_scene(
                    &format!("splits on {name}"),
                    &scene(name, triangles),
                    &steps,
                    query,
                    methods(),
                )
            })
        })
        .collect()
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for contest in contests {
        let mean = contest.times_faster(MEAN, HYBRID, "all");
        claims.push(Claim {
            claim: format!(
                "{}: no significant difference between box centre and mean",
                contest.name
            ),
            verdict: match (mean - 1.0).abs() {
                d if d <= 0.1 => Verdict::Holds,
                d if d <= 0.25 => Verdict::HoldsWeaker,
                _ => Verdict::DoesNotHoldToday,
            },
            figure: format!("the mean is {mean:.2} times faster"),
        });
        let connectivity = contest.times_faster(CONNECTIVITY, HYBRID, "all");
        claims.push(Claim {
            claim: format!(
                "{}: connectivity trees are 0 to 10 % better than initial shape trees",
                contest.name
            ),
            verdict: match connectivity {
                factor if factor >= 1.0 => Verdict::Holds,
                factor if factor >= 0.9 => Verdict::HoldsWeaker,
                _ => Verdict::DoesNotHoldToday,
            },
            figure: format!("{connectivity:.2} times faster"),
        });
        for label in [BALANCED, DEFAULT] {
            let factor = contest.times_faster(label, HYBRID, "all");
            claims.push(Claim {
                claim: format!("{}: {label} against the paper's tree", contest.name),
                verdict: Verdict::Measured,
                figure: format!("{factor:.2} times faster"),
            });
        }
    }
    claims
}
