//! Level of the hybrid update, from 0 to n.
//!
//! "We initially update the n / 2 first levels bottom-up, which we have found to be an efficient
//! choice" (paper, 3.3).

use super::{Experiment, Form, Planned, every, on_scene, ours, scene, titles};
use crate::contest::{Contender, Query};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::{Options, Update, World};
use pliant_scenes::Scene;
use std::num::NonZeroU32;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::LEVELS.name,
    about: titles::LEVELS.about,
    plan,
    claims,
};

/// Level of the deepest leaf, n.
fn depth(scene: &Scene) -> u32 {
    let mut positions = Vec::new();
    scene.positions(0, 1, &mut positions);
    let mut world = World::<f32>::with_options(Options::paper());
    let body = world
        .add(scene.triangles(0), &positions)
        .expect("a scene's bodies are good");
    world.tree_shape(body).expect("the body is there").depth
}

fn label(level: u32, depth: u32) -> String {
    format!("pliant, paper: level {level} of {depth}")
}

fn methods(depth: u32) -> Vec<Contender> {
    let hybrid = |level| Update::Hybrid {
        level: Some(level),
        levels_at_once: NonZeroU32::MIN,
    };
    (0..=depth)
        .map(|level| {
            ours(&label(level, depth), |options| {
                options.update = hybrid(level);
            })
        })
        .collect()
}

fn plan(form: Form) -> Vec<Planned> {
    let (triangles, steps) = if form == Form::Full {
        (20_480, every(2, 200))
    } else {
        (320, every(50, 200))
    };
    let scene = scene("spheres", triangles);
    let depth = depth(&scene);
    vec![Planned::new(methods(depth).len(), steps.len(), move || {
        on_scene(
            "levels on two spheres",
            &scene,
            &steps,
            Query::All,
            methods(depth),
        )
    })]
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let Some(contest) = contests.first() else {
        return Vec::new();
    };
    let mean = |place: usize| {
        contest.methods[place]
            .windows
            .last()
            .map_or(f64::NAN, |all| all.mean_ms)
    };
    let Some(depth) = contest.methods.len().checked_sub(1) else {
        return Vec::new();
    };
    let best = (0..=depth)
        .min_by(|&a, &b| mean(a).total_cmp(&mean(b)))
        .unwrap_or(0);
    let loss = mean(depth / 2) / mean(best);
    vec![Claim {
        claim: "n / 2 is an efficient level for the hybrid".to_owned(),
        verdict: match loss {
            loss if loss <= 1.1 => Verdict::Holds,
            loss if loss <= 1.3 => Verdict::HoldsWeaker,
            _ => Verdict::DoesNotHoldToday,
        },
        figure: format!(
            "n = {depth}: level {} takes {loss:.2} times as long as the best, level {best}; \
             level 0 {:.2} times, level n {:.2} times",
            depth / 2,
            mean(0) / mean(best),
            mean(depth) / mean(best)
        ),
    }]
}
