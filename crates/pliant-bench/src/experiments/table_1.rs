//! Table 1 of the paper: two spheres at seven sizes, at first contact and at the worst step; and
//! larger sizes of today.

use super::{
    DEFAULT, Experiment, Form, HYBRID, Planned, contenders, every, on_scene, scene, titles, window,
};
use crate::contest::{Contest, Query};
use crate::record::{Claim, ContestRecord, Verdict};
use crate::time::duration;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::TABLE_1.name,
    about: titles::TABLE_1.about,
    plan,
    claims,
};

/// The paper's table: faces a body, milliseconds at first and at worst contact, and intersections
/// there.
///
/// Measured on a Pentium III at 550 MHz.
const PAPER: [(usize, f64, f64, usize); 7] = [
    (1280, 2.0, 4.0, 138),
    (5120, 6.0, 15.0, 562),
    (8192, 8.0, 28.0, 1010),
    (16_384, 15.0, 64.0, 2422),
    (20_480, 20.0, 98.0, 3760),
    (32_768, 30.0, 151.0, 4775),
    (65_536, 62.0, 334.0, 12_358),
];

const METHODS: [&str; 2] = [HYBRID, DEFAULT];

fn plan(form: Form) -> Vec<Planned> {
    let sizes: Vec<(usize, Vec<u32>)> = if form == Form::Full {
        // Today's sizes at a few steps only, first contact and the end among them.
        let today =
            [327_680, 1_310_720].map(|triangles| (triangles, vec![30, 60, 61, 100, 150, 175, 200]));
        PAPER
            .iter()
            .map(|&(triangles, ..)| (triangles, every(1, 200)))
            .chain(today)
            .collect()
    } else {
        vec![(80, every(20, 200)), (320, every(20, 200))]
    };
    sizes
        .into_iter()
        .map(|(triangles, steps)| {
            Planned::new(METHODS.len(), steps.len(), move || {
                let scene = scene("spheres", triangles);
                let name = format!("2 x {triangles} triangles");
                Contest {
                    windows: vec![window("all", 1, 200)],
                    ..on_scene(&name, &scene, &steps, Query::All, contenders(&METHODS))
                }
            })
        })
        .collect()
}

/// Milliseconds at the first contact and at the worst step, and the number of pairs there.
fn row(contest: &ContestRecord, method: &str) -> Option<(f64, f64, usize)> {
    let method = contest.method(method)?;
    let both = |step: usize| {
        method
            .update_ms
            .get(step)
            .zip(method.query_ms.get(step))
            .map(|(update, query)| update + query)
    };
    let contact = contest.pairs.iter().position(|&pairs| pairs > 0)?;
    let worst = (0..contest.steps.len())
        .max_by(|&a, &b| both(a).unwrap_or(0.0).total_cmp(&both(b).unwrap_or(0.0)))?;
    Some((both(contact)?, both(worst)?, contest.pairs[worst]))
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for contest in contests {
        let paper = PAPER
            .iter()
            .find(|(triangles, ..)| *triangles == contest.triangles)
            .map_or_else(
                || "not in the paper".to_owned(),
                |(_, first, worst, pairs)| format!("paper: {first} ms, {worst} ms, {pairs}"),
            );
        for method in METHODS {
            if let Some((first, worst, pairs)) = row(contest, method) {
                claims.push(Claim {
                    claim: format!(
                        "{}, {method}: first contact, worst contact, intersections there ({paper})",
                        contest.name
                    ),
                    verdict: Verdict::Measured,
                    figure: format!("{}, {}, {pairs}", duration(first), duration(worst)),
                });
            }
        }
    }
    // The model is time = a faces^b, with b from the smallest and the largest size.
    for method in METHODS {
        let worst = |contest: &ContestRecord| {
            row(contest, method).map(|(_, worst, _)| (contest.triangles as f64, worst))
        };
        if let (Some((few, fast)), Some((many, slow))) = (
            contests.first().and_then(worst),
            contests
                .iter()
                .take(PAPER.len())
                .next_back()
                .and_then(worst),
        ) {
            let exponent = (slow / fast).ln() / (many / few).ln();
            let verdict = match exponent {
                e if e <= 1.1 => Verdict::Holds,
                e if e <= 1.3 => Verdict::HoldsWeaker,
                _ => Verdict::DoesNotHoldToday,
            };
            claims.push(Claim {
                claim: format!("worst time grows roughly linearly with the faces ({method})"),
                verdict,
                figure: format!(
                    "as faces to the power {exponent:.2}, from {few} to {many} \
                     (the paper's own table: {:.2})",
                    paper_exponent()
                ),
            });
        }
    }
    claims
}

fn paper_exponent() -> f64 {
    let ((few, _, fast, _), (many, _, slow, _)) = (PAPER[0], PAPER[PAPER.len() - 1]);
    (slow / fast).ln() / (many as f64 / few as f64).ln()
}
