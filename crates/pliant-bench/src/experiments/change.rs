//! Changing meshes, and trees that follow: bodies that are cut, torn and merged (paper, future
//! work).
//!
//! Every scene is played by our edits, and by obvhs with its own insertion and removal of leaves.
//! It is also played by building anew at every change, as people do today. `shuffle` and `remesh`
//! also have a fresh tree for every query, whose building is not counted. `tear` also has the same
//! shapes without edits.

use super::{Experiment, Form, Planned, titles, whole};
use crate::contest::{Contender, Contest, Query};
use crate::decision::exact;
use crate::method::Method;
use crate::methods::{ChangingObvhs, Everywhere, Ours, Rebuilt, Unedited};
use crate::motion::Motion;
use crate::record::{Claim, ContestRecord, MethodRecord, Verdict, median};
use pliant::Options;
use pliant_scenes::ChangingScene;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::CHANGE.name,
    about: titles::CHANGE.about,
    plan,
    claims,
};

const EDITED: &str = "pliant";
const MENDED: &str = "pliant, mending";
const REBUILT: &str = "pliant, built anew";
const UNEDITED: &str = "pliant, without edits";
const FRESH: &str = "pliant, fresh trees";
const OBVHS: &str = "obvhs, insertion and removal";

fn ours() -> Ours<f32> {
    Ours::new("pliant", Options::default()).intersections()
}

fn mended() -> Ours<f32> {
    let mut options = Options::default();
    options.mending = true;
    Ours::new("pliant", options).intersections()
}

fn everywhere() -> Everywhere {
    Everywhere::new(exact)
}

fn methods(scene: &str) -> Vec<Contender> {
    let mut methods = vec![
        Contender::new(EDITED, ours()),
        Contender::new(MENDED, mended()),
    ];
    match scene {
        "tear" => methods.push(
            Contender::new(UNEDITED, Unedited::new(ours()))
                .compared_with(Unedited::new(everywhere())),
        ),
        "shuffle" | "remesh" => methods.push(Contender::new(FRESH, ours().fresh())),
        _ => {}
    }
    if scene != "shuffle" {
        methods.push(Contender::new(REBUILT, Rebuilt::new(ours())));
    }
    methods.push(Contender::new(OBVHS, ChangingObvhs::new(exact)));
    methods
}

fn plan(form: Form) -> Vec<Planned> {
    ChangingScene::NAMES
        .into_iter()
        .map(|name| {
            let (size, last) = match (form, name) {
                (Form::Full, _) => (None, u32::MAX),
                (Form::Small, "tear") => (Some(2 * 20 * 20), 220),
                (Form::Small, "shuffle") => (Some(8 * 1024), 60),
                (Form::Small, _) => (Some(320), 110),
            };
            let scene = ChangingScene::new(name, size, ChangingScene::DEFAULT_SEED)
                .expect("the size is one of the scene's");
            let steps = last.min(scene.steps());
            Planned::new(methods(name).len(), steps as usize, move || Contest {
                name: name.to_owned(),
                motion: Motion::of_changing(&scene, steps),
                query: Query::Everything,
                truth: Box::new(Rebuilt::new(everywhere())) as Box<dyn Method>,
                methods: methods(name),
                windows: whole(&(1..=steps).collect::<Vec<_>>()),
                cold: false,
            })
        })
        .collect()
}

/// Time of all steps of a method, over the time of another.
fn times(contest: &ContestRecord, method: &str, other: &str) -> f64 {
    let all = |method: &str| {
        let figures = contest.method(method);
        figures.map_or(f64::NAN, |it| {
            it.update_ms.iter().sum::<f64>() + it.query_ms.iter().sum::<f64>()
        })
    };
    all(method) / all(other)
}

/// Time of every step of a method, in milliseconds.
fn steps(method: &MethodRecord) -> Vec<f64> {
    let both = method.update_ms.iter().zip(&method.query_ms);
    both.map(|(update, query)| update + query).collect()
}

/// Longest step of a method, over its median step.
fn longest_against_median(method: &MethodRecord) -> f64 {
    let steps = steps(method);
    steps.iter().copied().fold(f64::NAN, f64::max) / median(&steps)
}

/// Largest excess of a step over the same step of another method, over the median step of that.
fn most_added(method: &MethodRecord, other: &MethodRecord) -> f64 {
    let [longer, steps] = [steps(method), steps(other)];
    let added = longer
        .iter()
        .zip(&steps)
        .map(|(longer, step)| longer - step);
    added.fold(f64::NAN, f64::max) / median(&steps)
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for contest in contests {
        let measured = |what: &str, figure: String| Claim {
            claim: format!("{}: {what}", contest.name),
            verdict: Verdict::Measured,
            figure,
        };
        for (method, other, what) in [
            (
                EDITED,
                UNEDITED,
                "a step, against the same step without edits",
            ),
            (
                EDITED,
                FRESH,
                "a step, against fresh trees whose building is not counted",
            ),
            (
                MENDED,
                FRESH,
                "a step with mending, against fresh trees whose building is not counted",
            ),
        ] {
            if contest.method(other).is_some() {
                let figure = format!("{:.2} times", times(contest, method, other));
                claims.push(measured(what, figure));
            }
        }
        for (other, what) in [
            (REBUILT, "faster than building anew"),
            (
                OBVHS,
                "faster than obvhs with its own insertion and removal",
            ),
        ] {
            if contest.method(other).is_some() {
                let factor = times(contest, other, EDITED);
                claims.push(measured(what, format!("{factor:.2} times")));
            }
        }
        // Edits make long steps themselves. The cost of mending shows beside the same steps without
        // it.
        if let (Some(mended), Some(edited)) = (contest.method(MENDED), contest.method(EDITED)) {
            let added = most_added(mended, edited);
            claims.push(measured(
                "what mending adds to a step at most, against the median step without",
                format!("{added:.2} times"),
            ));
        }
        let of_all = [
            (EDITED, ""),
            (MENDED, " with mending"),
            (FRESH, " with fresh trees"),
        ];
        let of_all = of_all.into_iter().filter_map(|(method, which)| {
            let worst = longest_against_median(contest.method(method)?);
            Some(format!("{worst:.2} times{which}"))
        });
        let of_all: Vec<String> = of_all.collect();
        claims.push(measured(
            "the longest step against the median",
            of_all.join(", "),
        ));
    }
    claims
}
