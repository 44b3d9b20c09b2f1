//! Measurements of a run, as tables, as JSON and for a page.

use crate::report::{chart, counted, fact};
use crate::table::{grouped, table};
use crate::tree_options::TreeOptions;
use pliant::Statistics;
use pliant_bench::time::duration;
use pliant_report::Play;
use serde_json::{Value, json};
use std::fmt::Write;

/// Measurements of one step.
pub(super) struct StepRecord {
    pub(super) step: u32,
    pub(super) pairs: usize,
    /// Time to set the positions of all bodies and to prepare the query.
    pub(super) update_ms: f64,
    /// Time of the query itself, including boxes that the traversal makes.
    pub(super) query_ms: f64,
    pub(super) statistics: Statistics,
}

/// Measurements of a whole run.
pub(super) struct Record<'a> {
    pub(super) scene: &'a str,
    pub(super) bodies: usize,
    pub(super) triangles: usize,
    pub(super) steps: u32,
    pub(super) stride: u32,
    pub(super) seed: u64,
    pub(super) query: String,
    pub(super) precision: String,
    pub(super) trees: &'a TreeOptions,
    /// At least one step.
    pub(super) played: Vec<StepRecord>,
}

/// Counters with their JSON names and their titles, in the order of the phases.
fn named(statistics: &Statistics) -> [(&'static str, &'static str, u64); 8] {
    [
        ("body_pairs", "pairs of bodies", statistics.body_pairs),
        (
            "boxes_bottom_up",
            "boxes made bottom-up",
            statistics.boxes_bottom_up,
        ),
        (
            "boxes_top_down",
            "boxes made top-down",
            statistics.boxes_top_down,
        ),
        (
            "triangle_boxes",
            "triangle boxes in leaves",
            statistics.triangle_boxes,
        ),
        ("node_pairs", "node pairs", statistics.node_pairs),
        (
            "candidate_pairs",
            "candidate pairs",
            statistics.candidate_pairs,
        ),
        (
            "exact_decisions",
            "decided by exact arithmetic",
            statistics.exact_decisions,
        ),
        ("pairs", "intersecting pairs", statistics.pairs),
    ]
}

impl Record<'_> {
    fn first_contact(&self) -> Option<u32> {
        self.played
            .iter()
            .find(|step| step.pairs > 0)
            .map(|step| step.step)
    }

    fn total(&self) -> Statistics {
        let mut total = Statistics::default();
        self.played.iter().for_each(|step| total += step.statistics);
        total
    }

    /// One JSON object: scene, options, and one list per figure with an entry for each step played.
    pub(super) fn json(&self) -> Value {
        let list =
            |figure: fn(&StepRecord) -> Value| self.played.iter().map(figure).collect::<Value>();
        let mut object = json!({
            "scene": self.scene,
            "bodies": self.bodies,
            "triangles": self.triangles,
            "steps": self.steps,
            "stride": self.stride,
            "seed": self.seed,
            "query": self.query,
            "precision": self.precision,
            "first_contact": self.first_contact(),
            "step": list(|step| step.step.into()),
            "pairs": list(|step| step.pairs.into()),
            "update_ms": list(|step| step.update_ms.into()),
            "query_ms": list(|step| step.query_ms.into()),
            "statistics": named(&self.total())
                .into_iter()
                .map(|(name, _, count)| (name.to_owned(), count.into()))
                .collect::<serde_json::Map<_, _>>(),
        });
        if let Value::Object(members) = &mut object {
            members.extend(self.trees.named());
        }
        object
    }

    /// Adds facts and charts to a page.
    pub(super) fn tell(&self, play: &mut Play) {
        play.facts.extend([
            fact("query", self.asked()),
            fact("precision", &self.precision),
            fact("trees", self.trees.describe()),
            fact("seed", self.seed.to_string()),
        ]);
        let steps: Vec<u32> = self.played.iter().map(|step| step.step).collect();
        let list =
            |figure: fn(&StepRecord) -> f64| self.played.iter().map(figure).collect::<Vec<_>>();
        play.charts.extend([
            chart(
                "time per step, by phase",
                "ms",
                "step",
                &steps,
                [
                    (
                        "both".to_owned(),
                        list(|step| step.update_ms + step.query_ms),
                    ),
                    ("query".to_owned(), list(|step| step.query_ms)),
                    ("update".to_owned(), list(|step| step.update_ms)),
                ],
            ),
            chart(
                "boxes made per step",
                "boxes",
                "step",
                &steps,
                [
                    (
                        "bottom-up".to_owned(),
                        list(|step| step.statistics.boxes_bottom_up as f64),
                    ),
                    (
                        "top-down".to_owned(),
                        list(|step| step.statistics.boxes_top_down as f64),
                    ),
                ],
            ),
        ]);
    }

    /// The query in words.
    fn asked(&self) -> &'static str {
        match self.query.as_str() {
            "first" => "first pair between bodies",
            "self" => "all pairs of each body with itself",
            "everything" => "all pairs between bodies and of each with itself",
            _ => "all pairs between bodies",
        }
    }

    /// Tables for a terminal.
    pub(super) fn table(&self) -> String {
        let mut text = String::new();
        let asked = self.asked();
        let bodies = if self.bodies == 1 {
            "1 body".to_owned()
        } else {
            format!("{} bodies", self.bodies)
        };
        let _ = writeln!(
            text,
            "{}: {bodies} of {} triangles, {} steps, {asked}, {}",
            self.scene,
            grouped(self.triangles as u64),
            self.played.len(),
            self.precision
        );
        let _ = writeln!(text, "trees: {}\n", self.trees.describe());

        let Some(last) = self.played.last() else {
            return text;
        };
        let time = |step: &StepRecord| step.update_ms + step.query_ms;
        let worst = self
            .played
            .iter()
            .max_by(|a, b| time(a).total_cmp(&time(b)))
            .unwrap_or(last);
        let contact = self
            .first_contact()
            .map_or("none".to_owned(), |step| format!("step {step}"));
        let mut found = table(&["found", ""]);
        found.add_row(["first contact".to_owned(), contact]);
        found.add_row([
            format!("pairs at step {}", last.step),
            grouped(last.pairs as u64),
        ]);
        found.add_row([
            "slowest step".to_owned(),
            format!(
                "step {}, {}, {}",
                worst.step,
                counted(worst.pairs as u64, "pair", "pairs"),
                duration(time(worst))
            ),
        ]);
        let _ = writeln!(text, "{}\n", found.trim_fmt());

        let mut times = table(&["time a step", "median", "slowest"]);
        let figures: [(&str, fn(&StepRecord) -> f64); 3] = [
            ("update", |step| step.update_ms),
            ("query", |step| step.query_ms),
            ("both", |step| step.update_ms + step.query_ms),
        ];
        for (name, figure) in figures {
            let mut sorted: Vec<f64> = self.played.iter().map(figure).collect();
            sorted.sort_by(f64::total_cmp);
            let worst = sorted.last().copied().unwrap_or_default();
            times.add_row([name.to_owned(), duration(median(&sorted)), duration(worst)]);
        }
        let _ = writeln!(text, "{}\n", times.trim_fmt());

        let mut work = table(&["work", "all steps", &format!("step {}", last.step)]);
        for ((_, what, total), (_, _, at_last)) in named(&self.total())
            .into_iter()
            .zip(named(&last.statistics))
        {
            work.add_row([what.to_owned(), grouped(total), grouped(at_last)]);
        }
        let _ = writeln!(text, "{}", work.trim_fmt());
        text
    }
}

/// Median of sorted values, at least one.
fn median(sorted: &[f64]) -> f64 {
    f64::midpoint(sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2])
}
