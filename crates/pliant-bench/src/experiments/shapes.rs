//! Shapes that are hard for boxes: surfaces of long thin triangles that turn on a waving sheet.
//!
//! The box of a long thin triangle is mostly air. The same surface of good triangles is there to
//! compare: a disc, as a fan from a corner of its rim, and as rings.

use super::{DEFAULT, Experiment, Form, Planned, contender, titles, truth, whole};
use crate::contest::{Contest, Query};
use crate::motion::{Motion, MotionBody, Placed};
use crate::record::{Claim, ContestRecord, Verdict};
use pliant_scenes::thin;

pub(super) const EXPERIMENT: Experiment = Experiment {
    name: titles::SHAPES.name,
    about: titles::SHAPES.about,
    plan,
    claims,
};

const GOOD: &str = "disc of good triangles";
/// Most times that long thin triangles may take of good ones.
const MOST: f64 = 20.0;
/// Times that they are to take.
const AIM: f64 = 10.0;

/// Meshes of about as many triangles, each by the number of triangles.
const MESHES: [(&str, fn(u32) -> thin::Mesh); 4] = [
    (GOOD, |count| thin::rings((count / 6).isqrt())),
    ("disc as a fan", |count| thin::fan(count + 2)),
    ("square as a strip", thin::strip),
    ("side of a cylinder", |count| thin::tube(count / 2)),
];

/// A mesh that turns, and a sheet that does not move.
fn turning(name: &str, (triangles, positions): thin::Mesh, side: u32, steps: u32) -> Motion {
    let (good, waves) = thin::waves(side);
    let placed = |world| Placed {
        world,
        ..Placed::default()
    };
    let turned = |step: u32| placed(thin::turned(&positions, 0.9 + 0.2 * f64::from(step)));
    Motion {
        name: name.to_owned(),
        bodies: vec![
            MotionBody {
                triangles: good,
                first: placed(waves.clone()),
            },
            MotionBody {
                triangles,
                first: turned(1),
            },
        ],
        steps: (1..=steps).collect(),
        frames: (1..=steps)
            .map(|step| vec![placed(waves.clone()), turned(step)])
            .collect(),
        events: Vec::new(),
    }
}

fn plan(form: Form) -> Vec<Planned> {
    let (count, side, steps) = if form == Form::Full {
        (12_000, 300, 4)
    } else {
        (120, 12, 2)
    };
    let planned = |(name, mesh): (&'static str, fn(u32) -> thin::Mesh)| {
        Planned::new(1, steps as usize, move || {
            let motion = turning(name, mesh(count), side, steps);
            Contest {
                name: name.to_owned(),
                windows: whole(&motion.steps),
                motion,
                query: Query::All,
                truth: truth(),
                methods: vec![contender(DEFAULT)],
                cold: false,
            }
        })
    };
    MESHES.into_iter().map(planned).collect()
}

fn claims(contests: &[ContestRecord]) -> Vec<Claim> {
    let time = |contest: &ContestRecord| {
        let ours = contest.method(DEFAULT)?;
        let sum: f64 = ours.update_ms.iter().chain(&ours.query_ms).sum();
        (sum > 0.0).then(|| {
            (
                sum,
                ours.counters.iter().map(|it| it.decisions).sum::<u64>(),
            )
        })
    };
    let Some((good, _)) = contests.first().and_then(time) else {
        return Vec::new();
    };
    let claim = |contest: &ContestRecord| {
        let (ours, decisions) = time(contest)?;
        let pairs: usize = contest.pairs.iter().sum();
        let times = ours / good;
        Some(Claim {
            claim: format!(
                "{}: at most {MOST} times the good triangles, aim {AIM}",
                contest.name
            ),
            verdict: match times {
                times if times <= AIM => Verdict::Holds,
                times if times <= MOST => Verdict::HoldsWeaker,
                _ => Verdict::DoesNotHoldToday,
            },
            figure: format!("{times:.1} times; {decisions} candidates for {pairs} pairs"),
        })
    };
    contests[1..].iter().filter_map(claim).collect()
}
