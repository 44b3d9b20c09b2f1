//! Degree of the tree: 2, 4 or 8 children.
//!
//! "Using 8-ary tree versions ... was a slightly better choice than both 4-ary and binary versions"
//! (paper, 3.2). "An 8-ary tree version of van den Bergen's method ... runs approximately 10 to 20
//! percent faster than the binary version" (4).

use super::{
    BERGEN_LOCAL, BERGEN_LOCAL_8, BERGEN_WORLD, BERGEN_WORLD_8, Experiment, Form, Planned,
    contender, every, factor_claim, on_scene, ours, scene, titles,
};
use crate::contest::{Contender, Query};
use crate::record::{Claim, ContestRecord};
use pliant::Degree;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::DEGREES.name,
    about: titles::DEGREES.about,
    plan,
    claims,
};

const PAPER_2: &str = "pliant, paper: degree 2";
const PAPER_4: &str = "pliant, paper: degree 4";
const PAPER_8: &str = "pliant, paper: degree 8";

fn methods() -> Vec<Contender> {
    let degree = |label: &str, degree| ours(label, |options| options.degree = degree);
    let bergen = [BERGEN_LOCAL, BERGEN_LOCAL_8, BERGEN_WORLD, BERGEN_WORLD_8];
    [
        degree(PAPER_2, Degree::Two),
        degree(PAPER_4, Degree::Four),
        degree(PAPER_8, Degree::Eight),
    ]
    .into_iter()
    .chain(bergen.map(contender))
    .collect()
}

fn plan(form: Form) -> Vec<Planned> {
    let (triangles, steps) = if form == Form::Full {
        (20_480, every(2, 200))
    } else {
        (320, every(50, 200))
    };
    vec![Planned::new(methods().len(), steps.len(), move || {
        on_scene(
            "degrees on two spheres",
            &scene("spheres", triangles),
            &steps,
            Query::All,
            methods(),
        )
    })]
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let Some(contest) = contests.first() else {
        return Vec::new();
    };
    let compare = |fast: &str, slow: &str, claim: &str, wanted: f64| {
        let [easy, hard, all] =
            ["easy", "hard", "all"].map(|window| contest.times_faster(fast, slow, window));
        let figure = format!("{all:.2} times (easy {easy:.2}, hard {hard:.2})");
        factor_claim(claim, all, wanted, 1.0, figure)
    };
    vec![
        compare(
            PAPER_8,
            PAPER_4,
            "8-ary trees are slightly better than 4-ary",
            1.02,
        ),
        compare(
            PAPER_8,
            PAPER_2,
            "8-ary trees are slightly better than binary",
            1.02,
        ),
        compare(
            BERGEN_LOCAL_8,
            BERGEN_LOCAL,
            "van den Bergen, local frame: 8-ary is 10 to 20 % faster than binary",
            1.1,
        ),
        compare(
            BERGEN_WORLD_8,
            BERGEN_WORLD,
            "van den Bergen, world frame: 8-ary is 10 to 20 % faster than binary",
            1.1,
        ),
    ]
}
