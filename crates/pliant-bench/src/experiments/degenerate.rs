//! Hard arithmetic: exactly coplanar grids that slide over each other, and a scene far from the
//! origin.
//!
//! At 10^4 from the origin, an `f32` has lost four of its seven digits. The same scene at the
//! origin is there to compare. The paper's triangle test takes part, and its wrong answers are
//! counted.

use super::{
    DEFAULT, Experiment, Form, HYBRID, OBVHS_4, PARRY, Planned, contenders, every, factor_claim,
    scene, titles, truth, window,
};
use crate::contest::{Contender, Contest, Query};
use crate::decision::moller;
use crate::methods::Sweep;
use crate::motion::{Motion, MotionBody, Placed};
use crate::record::{Claim, ContestRecord, Verdict};

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::DEGENERATE.name,
    about: titles::DEGENERATE.about,
    plan,
    claims,
};

const METHODS: [&str; 4] = [HYBRID, DEFAULT, PARRY, OBVHS_4];
/// The paper's triangle test, to count its wrong answers. It may be wrong.
const MOLLER: &str = "flat sweep with the paper's triangle test";

const COPLANAR: &str = "coplanar grids";
const NEAR: &str = "two spheres, at the origin";
const FAR: &str = "two spheres, 10^4 from the origin";

fn methods() -> Vec<Contender> {
    let mut methods = contenders(&METHODS);
    methods.push(Contender::new(MOLLER, Sweep::new(moller)));
    methods
}

/// Two grids of `2 (side - 1)^2` triangles in the plane z = 0. The second slides by a quarter of a
/// cell a step.
fn sliding_grids(side: u32, steps: u32) -> Motion {
    let grid = |shift: f32| -> Vec<[f32; 3]> {
        (0..side * side)
            .map(|i| {
                [
                    (i % side) as f32 + shift,
                    (i / side) as f32 + shift / 2.0,
                    0.0,
                ]
            })
            .collect()
    };
    let corners = (0..(side - 1) * (side - 1)).map(|i| i / (side - 1) * side + i % (side - 1));
    let triangles: Vec<[u32; 3]> = corners
        .flat_map(|i| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]])
        .collect();
    let placed = |shift| Placed {
        world: grid(shift),
        ..Placed::default()
    };
    let at = |step: u32| side as f32 * 0.75 - step as f32 * 0.25;
    Motion {
        name: COPLANAR.to_owned(),
        bodies: [0.0, at(1)]
            .map(|shift| MotionBody {
                triangles: triangles.clone(),
                first: placed(shift),
            })
            .to_vec(),
        steps: (1..=steps).collect(),
        frames: (1..=steps)
            .map(|step| vec![placed(0.0), placed(at(step))])
            .collect(),
        events: Vec::new(),
    }
}

/// The two spheres, moved by `shift` along every axis.
fn shifted_spheres(name: &str, shift: f32, triangles: usize, steps: &[u32]) -> Motion {
    let mut motion = Motion::of_scene(&scene("spheres", triangles), steps.iter().copied());
    let bodies = motion.bodies.iter_mut().map(|body| &mut body.first);
    for placed in bodies.chain(motion.frames.iter_mut().flatten()) {
        placed.rigid = None;
        placed.world.iter_mut().flatten().for_each(|x| *x += shift);
    }
    name.clone_into(&mut motion.name);
    motion
}

fn plan(form: Form) -> Vec<Planned> {
    let (side, grid_steps) = if form == Form::Full { (40, 20) } else { (6, 3) };
    let (triangles, sphere_steps) = if form == Form::Full {
        (20_480, every(10, 200))
    } else {
        (320, every(50, 200))
    };
    let contest = |motion: Motion| Contest {
        name: motion.name.clone(),
        motion,
        query: Query::All,
        truth: truth(),
        methods: methods(),
        windows: vec![window("all", 1, 200)],
        cold: false,
    };
    let mut plan = vec![Planned::new(
        methods().len(),
        grid_steps as usize,
        move || contest(sliding_grids(side, grid_steps)),
    )];
    for (name, shift) in [(NEAR, 0.0), (FAR, 1e4)] {
        let steps = sphere_steps.clone();
        plan.push(Planned::new(methods().len(), steps.len(), move || {
            contest(shifted_spheres(name, shift, triangles, &steps))
        }));
    }
    plan
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    let mut costs = Vec::new();
    for contest in contests {
        let pairs: usize = contest.pairs.iter().sum();
        if let Some(ours) = contest
            .method(DEFAULT)
            .filter(|method| method.wrong.is_none())
        {
            let time: f64 = ours.update_ms.iter().chain(&ours.query_ms).sum();
            let decisions: u64 = ours
                .counters
                .iter()
                .map(|counters| counters.decisions)
                .sum();
            let cost = time * 1e6 / decisions as f64;
            costs.push(cost);
            claims.push(Claim {
                claim: format!("{}: the cost of a candidate pair", contest.name),
                verdict: Verdict::Measured,
                figure: format!("{cost:.0} ns of {decisions} candidates, {pairs} of them true"),
            });
        }
        let wrong = contest
            .method(MOLLER)
            .and_then(|method| method.wrong.as_ref());
        claims.push(Claim {
            claim: format!(
                "{}: the paper's triangle test (Möller 1997) is right",
                contest.name
            ),
            verdict: if wrong.is_none() {
                Verdict::Holds
            } else {
                Verdict::DoesNotHoldToday
            },
            figure: wrong.map_or_else(
                || format!("all {pairs} pairs"),
                |wrong| {
                    format!(
                        "from step {} on: {} pairs missing, {} too many, of {pairs}",
                        wrong.step, wrong.missing, wrong.extra
                    )
                },
            ),
        });
    }
    // The grids come first, then spheres that touch nowhere exactly.
    if let [coplanar, generic, ..] = costs[..] {
        claims.push(factor_claim(
            "a candidate of the coplanar grids costs at most ten times one of the spheres",
            generic / coplanar,
            0.1,
            0.1,
            format!("{:.1} times", coplanar / generic),
        ));
    }
    claims
}
