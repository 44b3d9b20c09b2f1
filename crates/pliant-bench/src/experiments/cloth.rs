//! Self-collision of a sheet that folds onto itself, beside the Rust libraries of today.
//!
//! The paper leaves self-collision to others ("another very important feature").

use super::{
    DEFAULT, Experiment, Form, HYBRID, OBVHS_1, OBVHS_4, PARRY, Planned, contenders, every,
    on_scene, scene, titles, window,
};
use crate::contest::{Contest, Query};
use crate::record::{Claim, ContestRecord, Verdict};

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::CLOTH.name,
    about: titles::CLOTH.about,
    plan,
    claims,
};

const METHODS: [&str; 5] = [PARRY, OBVHS_1, OBVHS_4, HYBRID, DEFAULT];

fn plan(form: Form) -> Vec<Planned> {
    let (triangles, steps) = if form == Form::Full {
        (79_202, every(1, 50))
    } else {
        (648, every(10, 50))
    };
    vec![Planned::new(METHODS.len(), steps.len(), move || Contest {
        windows: vec![
            window("easy", 1, 20),
            window("hard", 35, 50),
            window("all", 1, 50),
        ],
        ..on_scene(
            "folding cloth with itself",
            &scene("cloth", triangles),
            &steps,
            Query::Itself,
            contenders(&METHODS),
        )
    })]
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let Some(contest) = contests.first() else {
        return Vec::new();
    };
    let figure = |window: &str| {
        let factor = |peer| contest.times_faster(DEFAULT, peer, window);
        format!(
            "{window}: {:.2} times parry3d, {:.2} and {:.2} times obvhs (1 and 4 a leaf)",
            factor(PARRY),
            factor(OBVHS_1),
            factor(OBVHS_4)
        )
    };
    vec![Claim {
        claim: "pliant against parry3d and obvhs, mean update and query".to_owned(),
        verdict: Verdict::Measured,
        figure: format!("{}; {}", figure("easy"), figure("hard")),
    }]
}
