//! Bodies inside bodies, over all frames of a check, and the lines that say it.

use crate::check::figures::counted;
use pliant_check::{Check, Found};
use pliant_io::shown;
use std::collections::{BTreeMap, BTreeSet};

/// Most lines about what lies inside.
const MOST: usize = 20;
/// Most names in a line.
const MOST_NAMED: usize = 5;

/// Components inside a body, over the frames so far.
#[derive(Default)]
struct Contents {
    components: BTreeSet<u32>,
    /// How many components the body has, at most.
    all_of_body: u32,
    /// Number of frames, and the first.
    frames: (usize, usize),
}

/// Components inside bodies, by the two bodies.
#[derive(Default)]
pub(super) struct InsideTally {
    of: BTreeMap<[u32; 2], Contents>,
    /// Bodies that were not closed in some frame.
    open: BTreeSet<u32>,
    frames: usize,
}

impl InsideTally {
    pub(super) fn count(&mut self, found: &Found) {
        self.frames += 1;
        let Some(inside) = &found.inside else { return };
        self.open.extend(&inside.open);
        for it in &inside.all {
            let of = self.of.entry([it.body, it.inside]).or_default();
            if of.components.is_empty() {
                of.frames.1 = found.frame;
            }
            of.components.insert(it.component);
            of.all_of_body = of.all_of_body.max(it.components);
        }
        let here: BTreeSet<[u32; 2]> = inside.all.iter().map(|it| [it.body, it.inside]).collect();
        for both in here {
            self.of.entry(both).or_default().frames.0 += 1;
        }
    }

    /// Whether anything lies inside a body in some frame.
    pub(super) fn is_any(&self) -> bool {
        !self.of.is_empty()
    }

    /// Lines that say what lies inside, and of which bodies nothing is said.
    pub(super) fn lines(&self, check: &Check) -> Vec<String> {
        let name = |body: u32| {
            let facts = check.body(body);
            facts.map_or_else(String::new, |body| shown(body.name))
        };
        let mut lines = Vec::new();
        for ([body, inside], of) in self.of.iter().take(MOST) {
            let (count, first) = of.frames;
            let frames = if count == self.frames {
                String::new()
            } else {
                let frames = counted((count, "frame", "frames"));
                format!(", in {frames}, the first {first}")
            };
            let numbers: Vec<String> = of.components.iter().map(u32::to_string).collect();
            let (which, lies) = match &numbers[..] {
                [_] if of.all_of_body == 1 => (String::new(), "lies"),
                [only] => (format!("component {only} of "), "lies"),
                several if several.len() <= MOST_NAMED => {
                    (format!("components {} of ", several.join(", ")), "lie")
                }
                several => {
                    let some = several[..MOST_NAMED].join(", ");
                    let more = several.len() - MOST_NAMED;
                    (format!("components {some} and {more} more of "), "lie")
                }
            };
            let [body, inside] = [name(*body), name(*inside)];
            lines.push(format!("{which}{body} {lies} inside {inside}{frames}"));
        }
        if self.of.len() > MOST {
            lines.push(format!(
                "and {} more lie inside others",
                self.of.len() - MOST
            ));
        }
        if !self.open.is_empty() {
            let named = self.open.iter().take(MOST_NAMED).map(|&body| name(body));
            let named: Vec<String> = named.collect();
            let more = match self.open.len().saturating_sub(MOST_NAMED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let named = named.join(", ");
            lines.push(format!(
                "not closed, so nothing is said to lie inside: {named}{more}"
            ));
        }
        lines
    }
}
