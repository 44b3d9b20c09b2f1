//! A page about experiments, and their charts as SVG files, like figures 3 and 4 of the paper.

use crate::output::{self, MARK, Overwrite};
use crate::report::{asked, chart, counted, fact, write_page};
use crate::table::grouped;
use anyhow::Context;
use pliant::{Selection, World};
use pliant_bench::experiments::{Experiment, Form};
use pliant_bench::motion::Motion;
use pliant_bench::record::{Claim, ContestRecord, ExperimentRecord, MethodRecord, Record, Verdict};
use pliant_io::shown;
use pliant_report::{Chart, Play, Recorder, Report};
use std::collections::BTreeSet;
use std::path::Path;

/// Key of a recorded motion: contests with equal keys share one recording.
type Shows = (String, usize, usize, Vec<u32>, bool);

fn shows(contest: &ContestRecord) -> Shows {
    let of_itself = contest.query == "self";
    let ContestRecord {
        motion,
        bodies,
        triangles,
        steps,
        ..
    } = contest;
    (
        motion.clone(),
        *bodies,
        *triangles,
        steps.clone(),
        of_itself,
    )
}

/// Writes a page about everything in a record.
pub(super) fn write(
    path: &Path,
    record: &Record,
    chosen: &[&Experiment],
    form: Form,
    over: Overwrite,
) -> anyhow::Result<()> {
    let mut report = Report::new(&asked());
    let machine = &record.machine;
    report.facts = vec![
        fact("processor", &machine.processor),
        fact("cores", machine.cores.to_string()),
        fact("system", &machine.system),
        fact("build", &machine.profile),
    ];
    let contests = record.experiments.iter().flat_map(|done| &done.contests);
    let motions = contests.map(shows).collect::<BTreeSet<_>>().len();
    report.found = format!(
        "{} on {}, medians of {}.",
        record
            .experiments
            .iter()
            .map(|done| done.experiment.as_str())
            .collect::<Vec<_>>()
            .join(", "),
        machine.processor,
        counted(
            record
                .experiments
                .first()
                .map_or(0, |done| done.rounds as u64),
            "round",
            "rounds"
        ),
    );
    if form == Form::Small {
        report
            .found
            .push_str(" A small form: its times mean nothing.");
    }
    let mut seen: Vec<Shows> = Vec::new();
    for (done, experiment) in record.experiments.iter().zip(chosen) {
        for (place, motion) in experiment
            .motions(form)
            .enumerate()
            .take(done.contests.len())
        {
            let mut play = play(done, place);
            let shows = shows(&done.contests[place]);
            let shown = seen
                .iter()
                .position(|known| *known == shows)
                .unwrap_or_else(|| {
                    report.motions.push(replay(&motion, shows.4, motions));
                    seen.push(shows);
                    seen.len() - 1
                });
            play.motion = Some(shown);
            report.plays.push(play);
        }
    }
    write_page(path, &report, over)
}

/// Writes every chart into a folder, as one SVG file each.
pub(super) fn write_charts(
    folder: &Path,
    experiment: &ExperimentRecord,
    over: Overwrite,
) -> anyhow::Result<()> {
    let made = std::fs::create_dir_all(folder);
    made.with_context(|| format!("cannot write {}", shown(folder)))?;
    for contest in &experiment.contests {
        for (what, chart) in charts(contest) {
            let name = file_name(&format!(
                "{} {} {what}",
                experiment.experiment, contest.name
            ));
            let path = folder.join(name + ".svg");
            output::write(&path, MARK, over, |out| {
                out.write_all(chart.svg().as_bytes())
            })?;
        }
    }
    Ok(())
}

/// File name from a text: its letters and digits in lower case, hyphens between words.
fn file_name(text: &str) -> String {
    let words = text
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_ascii_lowercase()
}

/// One contest of an experiment, as the page shows it.
fn play(done: &ExperimentRecord, place: usize) -> Play {
    let contest = &done.contests[place];
    let mut play = Play::new(&format!("{}: {}", done.experiment, contest.name), "step");
    play.facts = vec![
        fact("bodies", contest.bodies.to_string()),
        fact("triangles of a body", grouped(contest.triangles as u64)),
        fact("steps", contest.steps.len().to_string()),
        fact("query", &contest.query),
        fact(
            "most pairs",
            grouped(contest.pairs.iter().max().copied().unwrap_or(0) as u64),
        ),
        fact("checked against", &contest.truth),
    ];
    for method in &contest.methods {
        if let Some(wrong) = &method.wrong {
            play.notes.push(format!(
                "{} is wrong from step {} on and was not timed: {} pairs missing, {} too many.",
                method.name, wrong.step, wrong.missing, wrong.extra
            ));
        }
    }
    // A claim about one contest begins with its name. All others stand with the first contest.
    let names = |claim: &Claim, contest: &ContestRecord| claim.claim.starts_with(&contest.name);
    let of_this = |claim: &&Claim| {
        let of_one = done.contests.iter().any(|contest| names(claim, contest));
        names(claim, contest) || (place == 0 && !of_one)
    };
    play.notes
        .extend(done.claims.iter().filter(of_this).map(|claim| {
            let verdict = match claim.verdict {
                Verdict::Holds => "Holds",
                Verdict::HoldsWeaker => "Holds weaker",
                Verdict::DoesNotHoldToday => "Does not hold today",
                Verdict::Measured => "Measured",
            };
            format!("{verdict}: {} ({})", claim.claim, claim.figure)
        }));
    play.charts
        .extend(charts(contest).into_iter().map(|(_, chart)| chart));
    play
}

/// Charts of time per step by method: update and query together, then each phase alone.
fn charts(contest: &ContestRecord) -> Vec<(&'static str, Chart)> {
    let phases: [(&str, &str, fn(&MethodRecord, usize) -> f64); 3] = [
        ("both", "update and query", |method, step| {
            method.update_ms[step] + method.query_ms[step]
        }),
        ("update", "update alone", |method, step| {
            method.update_ms[step]
        }),
        ("query", "query alone", |method, step| method.query_ms[step]),
    ];
    let timed = || {
        contest
            .methods
            .iter()
            .filter(|method| !method.update_ms.is_empty())
    };
    phases
        .into_iter()
        .map(|(short, phase, figure)| {
            let lines = timed().map(|method| {
                (
                    method.name.clone(),
                    (0..contest.steps.len())
                        .map(|step| figure(method, step))
                        .collect(),
                )
            });
            let title = format!("{}: {phase}, time per step", contest.name);
            (short, chart(&title, "ms", "step", &contest.steps, lines))
        })
        .collect()
}

/// Plays a motion once more with our library, to record which triangles intersect and which boxes
/// are made.
fn replay(motion: &Motion, of_itself: bool, motions: usize) -> pliant_report::Motion {
    let mut world = World::<f32>::new();
    let bodies: Vec<_> = motion
        .bodies
        .iter()
        .filter_map(|body| world.add(&body.triangles, &body.first.world).ok())
        .collect();
    let mut recorder = Recorder::one_of(Vec::new(), motions);
    for (&step, frame) in motion.steps.iter().zip(&motion.frames) {
        for (&body, placed) in bodies.iter().zip(frame) {
            // No error: the methods were given the same positions.
            let _ = world.set_positions(body, &placed.world);
        }
        // The same query as the methods were asked.
        let of = if of_itself {
            bodies.iter().map(|&body| Selection::Within(body)).collect()
        } else {
            vec![Selection::World]
        };
        let mut rows: Vec<[u32; 4]> = Vec::new();
        for of in of {
            let pairs = world.intersections(of).all().unwrap_or_default();
            rows.extend(pairs.iter().map(|&pair| <[u32; 4]>::from(pair)));
        }
        recorder.frame(step, &world, &rows);
    }
    recorder.finish()
}
