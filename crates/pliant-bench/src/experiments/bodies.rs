//! Broad phases, from 10 to 10,000 bodies: brute force, sweep and prune, and where they cross.
//!
//! "For simulations with up to approximately 100 bodies, the naive brute force technique ...
//! performs very well" (paper, 3.4). The tree of bodies, which is not in the paper, takes part.

use super::{Experiment, Form, Planned, ours, titles, truth, window};
use crate::contest::{Contender, Contest, Query};
use crate::motion::Motion;
use crate::record::{Claim, ContestRecord, Verdict};
use crate::time::duration;
use pliant::BroadPhase;
use pliant_scenes::Scene;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::BODIES.name,
    about: titles::BODIES.about,
    plan,
    claims,
};

const BRUTE: &str = "pliant, paper: brute force";
const SWEEP: &str = "pliant, paper: sweep and prune";
const TREE: &str = "pliant, paper: tree of bodies";

/// Triangles a body: few, so that the broad phase dominates.
const TRIANGLES: usize = 20;

fn methods() -> Vec<Contender> {
    let broad = |label: &str, broad_phase| ours(label, |options| options.broad_phase = broad_phase);
    vec![
        broad(BRUTE, BroadPhase::BruteForce),
        broad(SWEEP, BroadPhase::SweepAndPrune),
        broad(TREE, BroadPhase::Tree),
    ]
}

fn plan(form: Form) -> Vec<Planned> {
    let counts: &[usize] = if form == Form::Full {
        &[10, 30, 100, 300, 1000, 3000, 10_000]
    } else {
        &[10, 50]
    };
    counts
        .iter()
        .map(|&count| {
            // Consecutive steps: sweep and prune relies on coherent motion.
            let steps: Vec<u32> = if form == Form::Full {
                (101..=130).collect()
            } else {
                (101..=103).collect()
            };
            Planned::new(methods().len(), steps.len(), move || {
                let scene = Scene::gather(count, TRIANGLES, Scene::DEFAULT_SEED)
                    .expect("a number of bodies that there can be");
                Contest {
                    name: format!("{count} bodies"),
                    motion: Motion::of_scene(&scene, steps),
                    query: Query::All,
                    truth: truth(),
                    methods: methods(),
                    windows: vec![window("all", 1, 200)],
                    cold: false,
                }
            })
        })
        .collect()
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let query = |contest: &ContestRecord, method: &str| {
        contest
            .method(method)
            .map_or(f64::NAN, |method| crate::record::median(&method.query_ms))
    };
    let mut claims: Vec<Claim> = contests
        .iter()
        .flat_map(|contest| {
            let of = |method| duration(query(contest, method));
            let measured = |what: &str, figure| Claim {
                claim: format!("{}: broad phase and query, {what}", contest.name),
                verdict: Verdict::Measured,
                figure,
            };
            [
                measured(
                    "brute force against sweep and prune",
                    format!("{} against {}", of(BRUTE), of(SWEEP)),
                ),
                measured("a tree of bodies", of(TREE)),
            ]
        })
        .collect();
    let crossing = contests
        .iter()
        .find(|contest| query(contest, SWEEP) < query(contest, BRUTE))
        .map(|contest| contest.bodies);
    claims.push(Claim {
        claim: "brute force performs very well up to approximately 100 bodies".to_owned(),
        verdict: if crossing.is_none_or(|bodies| bodies >= 100) {
            Verdict::Holds
        } else {
            Verdict::HoldsWeaker
        },
        figure: crossing.map_or_else(
            || "sweep and prune is never faster here".to_owned(),
            |bodies| {
                format!("sweep and prune is faster from {bodies} bodies on, of the numbers tried")
            },
        ),
    });
    claims
}
