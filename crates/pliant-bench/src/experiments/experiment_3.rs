//! Experiment 3 (figure 4 of the paper): 27 translating, rotating and deforming bodies that
//! collide.
//!
//! Bumpy spheres (4a) and bodies with arms (4b), with a collision response.

use super::response::with_response;
use super::{
    BERGEN_LOCAL, BERGEN_WORLD, BOTTOM_UP, DEFAULT, Experiment, Form, HYBRID, OBVHS_4, PARRY,
    Planned, contenders, every, factor_claim, scene, titles, truth, windows,
};
use crate::contest::{Contest, Query};
use crate::record::{Claim, ContestRecord};

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::EXPERIMENT_3.name,
    about: titles::EXPERIMENT_3.about,
    plan,
    claims,
};

const METHODS: [&str; 7] = [
    BERGEN_LOCAL,
    BERGEN_WORLD,
    BOTTOM_UP,
    HYBRID,
    DEFAULT,
    PARRY,
    OBVHS_4,
];

/// Figure, scene, triangles in small form, and the paper's factor over van den Bergen.
const SCENES: [(&str, &str, usize, f64); 2] = [
    ("figure 4a: 27 spheres", "crowd", 320, 5.6),
    ("figure 4b: 27 bodies with arms", "arms", 1280, 4.5),
];

fn plan(form: Form) -> Vec<Planned> {
    SCENES
        .into_iter()
        .map(|(name, scene_name, small, _)| {
            let (triangles, steps) = if form == Form::Full {
                (5120, every(2, 200))
            } else {
                (small, every(4, 8))
            };
            Planned::new(METHODS.len(), steps.len(), move || Contest {
                name: name.to_owned(),
                motion: with_response(&scene(scene_name, triangles), &steps),
                query: Query::All,
                truth: truth(),
                methods: contenders(&METHODS),
                windows: windows(),
                cold: false,
            })
        })
        .collect()
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (contest, (what, _, _, paper)) in contests.iter().zip(SCENES) {
        for (fast, slow) in [
            (HYBRID, BERGEN_LOCAL),
            (HYBRID, BERGEN_WORLD),
            (DEFAULT, BERGEN_LOCAL),
            (DEFAULT, BERGEN_WORLD),
        ] {
            let factor = contest.times_faster(fast, slow, "all");
            claims.push(factor_claim(
                &format!("{what}: {fast} is {paper} times faster than {slow}, mean of all steps"),
                factor,
                paper,
                1.3,
                format!("{factor:.2} times"),
            ));
        }
    }
    claims
}
