//! Shapes that are hard for boxes and for arithmetic.
//!
//! Three families, each beside what is easy. Surfaces of long thin triangles turn on a waving
//! sheet: boxes of such triangles are mostly empty. Sheets slide over each other in one plane, so
//! most signs are exact zeros. All triangles of a lid have one vertex, so their boxes all overlap.

use super::{DEFAULT, Experiment, Form, Planned, STEPS, titles, truth, whole};
use crate::contest::{Contender, Contest, Query};
use crate::method::Method;
use crate::methods::{NearSweep, Ours};
use crate::motion::{Motion, MotionBody, Placed};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant::Options;
use pliant_scenes::thin;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::SHAPES.name,
    about: titles::SHAPES.about,
    plan,
    claims,
};

const DOUBLE: &str = "pliant, f64";

const GOOD: &str = "disc of good triangles";
/// Meshes of about as many triangles, each by the number of triangles.
const THIN: [(&str, fn(u32) -> thin::Mesh); 4] = [
    (GOOD, |count| thin::rings((count / 6).isqrt())),
    ("disc as a fan", |count| thin::fan(count + 2)),
    ("square as a strip", thin::strip),
    ("side of a cylinder", |count| thin::tube(count / 2)),
];
/// Most times that long thin triangles may take of good ones, and times that they are to take.
const TIMES: [f64; 2] = [20.0, 10.0];

/// Maps of the plane z = 0: onto itself, onto another with no rounding, and nearly onto a third.
const PLANES: [(&str, fn([f32; 3]) -> [f32; 3]); 3] = [
    ("grids in one plane", |at| at),
    ("grids in a slanted plane", |[x, y, _]| {
        [x + 0.5 * y, y - 0.25 * x, 0.75 * x + 0.125 * y]
    }),
    ("grids nearly in one plane", |at| {
        thin::turned(&[at], 0.9)[0]
    }),
];
/// Nanoseconds that a candidate in a plane is to take in double precision.
const NANOSECONDS: f64 = 400.0;

const FEW: &str = "lid, few triangles";
const MANY: &str = "lid, four times as many";
/// Most times that four times as many triangles round one vertex may take: linear is 4.
const LINEAR: f64 = 8.0;

fn plan(form: Form) -> Vec<Planned> {
    let is_full = form == Form::Full;
    let (count, side, steps) = if is_full {
        (12_000, 300, 4)
    } else {
        (120, 12, 2)
    };
    let mut plan = Vec::new();
    for (name, mesh) in THIN {
        plan.push(planned(name, [1, steps], Query::All, truth, move || {
            let (good, waves) = thin::waves(side);
            let (triangles, positions) = mesh(count);
            let turned = turned(&positions, steps);
            let frames = turned.into_iter().map(|at| vec![waves.clone(), at]);
            motion([good, triangles].into(), &frames.collect::<Vec<_>>())
        }));
    }
    // Powers of two: coordinates and shifts have no rounding.
    let (side, steps) = if is_full { (32, 8) } else { (4, 2) };
    for (name, map) in PLANES {
        plan.push(planned(name, [2, steps], Query::All, truth, move || {
            let (triangles, waves) = thin::waves(side);
            let shifted = |shift: f32| -> Vec<[f32; 3]> {
                let positions = waves.iter().copied();
                positions
                    .map(|[x, y, _]| map([x + shift, y + 0.5 * shift, 0.0]))
                    .collect()
            };
            let shift = |step: u32| step as f32 / 64.0;
            let frames = (1..=steps).map(|step| vec![shifted(0.0), shifted(shift(step))]);
            motion(
                vec![triangles.clone(), triangles],
                &frames.collect::<Vec<_>>(),
            )
        }));
    }
    let (count, steps) = if is_full { (5_000, 4) } else { (150, 2) };
    for (name, count) in [(FEW, count), (MANY, 4 * count)] {
        let truth = || -> Box<dyn Method> { Box::new(NearSweep::new(0.0)) };
        plan.push(planned(name, [1, steps], Query::Near, truth, move || {
            let (triangles, positions) = lid(count);
            let frames = turned(&positions, steps).into_iter().map(|at| vec![at]);
            motion(vec![triangles], &frames.collect::<Vec<_>>())
        }));
    }
    plan
}

/// A lid of `count` triangles round a middle that is above their rim.
fn lid(count: u32) -> thin::Mesh {
    let (_, rim) = thin::fan(count);
    let triangles = (0..count).map(|at| [0, 1 + at, 1 + (at + 1) % count]);
    (triangles.collect(), [vec![[0.0, 0.0, 0.3]], rim].concat())
}

/// Plans a contest of the library in one precision, or in both.
fn planned(
    name: &'static str,
    [precisions, steps]: [u32; 2],
    query: Query,
    truth: fn() -> Box<dyn Method>,
    motion: impl Fn() -> Motion + 'static,
) -> Planned {
    Planned::new(precisions as usize, steps as usize, move || {
        let motion = Motion {
            name: name.to_owned(),
            ..motion()
        };
        let options = Options::default();
        let single = Ours::<f32>::new(DEFAULT, options);
        let methods = if query == Query::Near {
            vec![Contender::new(DEFAULT, single.within(0.0))]
        } else {
            let double = Ours::<f64>::new(DOUBLE, options);
            let both = [
                Contender::new(DEFAULT, single),
                Contender::new(DOUBLE, double),
            ];
            both.into_iter().take(precisions as usize).collect()
        };
        Contest {
            name: name.to_owned(),
            windows: whole(&motion.steps),
            motion,
            query,
            truth: truth(),
            methods,
            cold: false,
        }
    })
}

/// Positions turned against the axes, further in each step.
fn turned(positions: &[[f32; 3]], steps: u32) -> Vec<Vec<[f32; 3]>> {
    let angle = |step: u32| 0.9 + 0.2 * f64::from(step);
    let turned = (1..=steps).map(|step| thin::turned(positions, angle(step)));
    turned.collect()
}

/// Motion of bodies through the positions of all of them in each step.
fn motion(meshes: Vec<Vec<[u32; 3]>>, frames: &[Vec<Vec<[f32; 3]>>]) -> Motion {
    let placed = |world: &Vec<[f32; 3]>| Placed {
        world: world.clone(),
        ..Placed::default()
    };
    let bodies = meshes.into_iter().zip(&frames[0]);
    Motion {
        name: String::new(),
        bodies: bodies
            .map(|(triangles, first)| MotionBody {
                triangles,
                first: placed(first),
            })
            .collect(),
        steps: (1..=frames.len() as u32).collect(),
        frames: frames
            .iter()
            .map(|frame| frame.iter().map(placed).collect())
            .collect(),
        events: Vec::new(),
    }
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let time = |contest: &ContestRecord, method| Some(contest.window(method, STEPS)?.mean_ms);
    let named = |name: &str| contests.iter().find(|contest| contest.name == name);
    let over = |contest: &ContestRecord, easy: &str| {
        Some(time(contest, DEFAULT)? / time(named(easy)?, DEFAULT)?)
    };
    let mut claims = Vec::new();
    let mut claim = |claim: String, found: f64, [most, aim]: [f64; 2], figure: String| {
        let verdict = match found {
            found if found <= aim => Verdict::Holds,
            found if found <= most => Verdict::HoldsWeaker,
            _ => Verdict::DoesNotHoldToday,
        };
        claims.push(Claim {
            claim,
            verdict,
            figure,
        });
    };
    for contest in contests {
        let name = &contest.name;
        let pairs: usize = contest.pairs.iter().sum();
        let decisions = |method: &str| -> u64 {
            let counters = contest
                .method(method)
                .into_iter()
                .flat_map(|it| &it.counters);
            counters.map(|it| it.decisions).sum()
        };
        if THIN[1..].iter().any(|(thin, _)| thin == name)
            && let Some(times) = over(contest, GOOD)
        {
            let [most, aim] = TIMES;
            let candidates = decisions(DEFAULT);
            claim(
                format!("{name}: at most {most} times the good triangles, aim {aim}"),
                times,
                TIMES,
                format!("{times:.1} times; {candidates} candidates for {pairs} pairs"),
            );
        }
        if PLANES.iter().any(|(plane, _)| plane == name)
            && let (Some(single), Some(double)) = (time(contest, DEFAULT), time(contest, DOUBLE))
        {
            let steps = contest.steps.len() as f64;
            let each = |ms: f64, method| ms * steps * 1e6 / decisions(method) as f64;
            let (single, double) = (each(single, DEFAULT), each(double, DOUBLE));
            claim(
                format!("{name}: a candidate takes at most {NANOSECONDS} ns in f64"),
                double,
                [NANOSECONDS; 2],
                format!("{double:.0} ns; {single:.0} ns in f32; {pairs} pairs"),
            );
        }
        if name == MANY
            && let Some(times) = over(contest, FEW)
        {
            claim(
                format!("{name}: at most {LINEAR} times as long"),
                times,
                [LINEAR; 2],
                format!("{times:.1} times; {pairs} candidates"),
            );
        }
    }
    claims
}
