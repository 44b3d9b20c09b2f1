//! Table of a check, for people.

use super::files::Files;
use super::form::Form;
use super::places;
use super::tally::Tally;
use crate::check::arguments::Arguments;
use crate::check::figures::counted;
use crate::check::moments::elements;
use crate::check::names::{Names, at_rest, labelled};
use crate::table::{grouped, short};
use pliant_check::{Baseline, BodyFacts, Check, Found, Interval, LabelFile, Rest};
use pliant_io::shown;
use std::io::{self, Write};

/// Most pieces or groups of a file that have lines of their own in the head.
const MOST_PIECES: usize = 20;

/// Most places that have a line.
const MOST_PLACES: usize = 20;

#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub(super) struct Table {
    count_only: bool,
    itself: bool,
    ignore: Vec<Names>,
    baseline: Option<Baseline>,
    skip_degenerate: bool,
    within: Option<f64>,
    rest: Option<Rest>,
    labels: Vec<LabelFile>,
    crossing: bool,
    swept: bool,
    ignore_adjacent: bool,
    /// Whether pairs that share a vertex are asked for. Set when the head is written.
    adjacent: bool,
    /// Set when the head is written.
    files: Option<Files>,
}

impl Table {
    pub(super) fn new(arguments: &Arguments) -> Self {
        Self {
            count_only: arguments.count,
            itself: arguments.itself,
            ignore: arguments.ignore.clone(),
            baseline: arguments.baseline.clone(),
            skip_degenerate: arguments.skip_degenerate,
            within: arguments.within,
            rest: arguments.rest.clone(),
            labels: arguments.labels.clone(),
            crossing: arguments.crossing,
            swept: arguments.swept,
            ignore_adjacent: arguments.ignore_adjacent,
            adjacent: false,
            files: None,
        }
    }

    /// The question, in words.
    fn asked(&self, check: &Check) -> String {
        let bodies = match (check.body_count(), self.itself) {
            (1, _) => "the body with itself",
            (_, true) => "the bodies with each other, and each with itself",
            (_, false) => "the bodies with each other, not with themselves",
        };
        let two = |[a, b]: &Names| format!("{} with {}", shown(a), shown(b));
        let ignored: Vec<_> = self.ignore.iter().map(two).collect();
        let ignored = match ignored.join(", ") {
            none if none.is_empty() => none,
            some => format!("; ignored: {some}"),
        };
        let known = match &self.baseline {
            None => None,
            Some(Baseline::Frame(frame)) => Some(format!("pairs that frame {frame} has")),
            Some(Baseline::File(file)) => Some(format!("pairs that {} has", shown(file))),
        };
        let degenerate = self
            .skip_degenerate
            .then(|| "pairs with a triangle without area".to_owned());
        let touching = self
            .crossing
            .then(|| "places where surfaces only touch".to_owned());
        let adjacent = self
            .ignore_adjacent
            .then(|| "triangles that share a vertex".to_owned());
        let rest = self.rest.as_ref().map(at_rest);
        let labels = labelled(&self.labels);
        let left_out = [known, rest, labels, degenerate, touching, adjacent]
            .into_iter()
            .flatten();
        let left_out: Vec<_> = left_out.collect();
        let left_out = match left_out.join(", and ") {
            none if none.is_empty() => none,
            some => format!("; left out: {some}"),
        };
        let within = self.within.map_or_else(String::new, |within| {
            format!(", triangles at most {within} apart")
        });
        let swept = if self.swept {
            ", and what meets on the way from frame to frame"
        } else {
            ""
        };
        format!("{bodies}{within}{swept}{ignored}{left_out}")
    }
}

impl Form for Table {
    fn head(&mut self, out: &mut dyn Write, check: &Check) -> io::Result<()> {
        let boxes = check.boxes();
        let mut bodies = check.bodies().enumerate();
        for (place, source) in check.sources().iter().enumerate() {
            let of_source = check.bodies_of(place);
            let (first, count) = (of_source.start, of_source.len());
            let each = bodies.by_ref().take(count);
            let name = shown(source.name());
            let [vertices, triangles] = sizes(source.vertex_count(), source.triangles().len());
            if !check.is_split(place) {
                each.for_each(drop);
                let size = size(check.box_of(place));
                write!(out, "body {first}: {name}, {vertices}, {triangles}, {size}")?;
            } else if count > MOST_PIECES {
                let mut named = each.map(|(_, body)| body.name);
                let [one, other] = [named.next(), named.last()].map(Option::unwrap_or_default);
                let other = shown(other.strip_prefix(source.name()).unwrap_or(&other));
                let last = first as usize + count - 1;
                write!(
                    out,
                    "bodies {first} to {last}: {} to {other}, {vertices}, {triangles}, {}",
                    shown(one),
                    size(check.box_of(place))
                )?;
            } else {
                for (number, body) in each {
                    let BodyFacts { first_triangle, .. } = body;
                    let name = shown(&body.name);
                    let [vertices, triangles] = sizes(body.vertices, body.triangles);
                    let size = size(boxes[number]);
                    writeln!(
                        out,
                        "body {number}: {name}, {vertices}, {triangles}, \
                         from triangle {first_triangle} on, {size}"
                    )?;
                }
                write!(out, "  of {name}, {vertices}, {triangles}")?;
            }
            if source.welded() > 0 {
                let welded = counted((source.welded(), "vertex", "vertices"));
                write!(out, ", {welded} welded where boundary edges coincide")?;
            }
            if let Some(clip) = source.clip() {
                write!(out, ", clip {}", shown(clip))?;
            }
            writeln!(out)?;
        }
        self.files = Files::of(check);
        let file = self.files.as_ref().map_or_else(String::new, Files::header);
        self.adjacent = check.asks_adjacent();
        let adjacent = if self.adjacent { "  adjacent" } else { "" };
        let distance = self.within.map_or("", |_| "    distance");
        let left_out = self.baseline.as_ref().map_or("", |_| "  left out");
        let first_pair = if self.count_only { "" } else { "  first pair" };
        writeln!(
            out,
            "checked: {}\n\n{:>8}{file}{:>10}{adjacent}{distance}{left_out}{first_pair}",
            self.asked(check),
            "frame",
            "pairs"
        )
    }

    fn says_inside(&self) -> bool {
        true
    }

    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()> {
        let &Found { frame, count, .. } = found;
        for &number in &found.changed {
            if let Some(body) = check.body(number) {
                let [vertices, triangles] = sizes(body.vertices, body.triangles);
                writeln!(
                    out,
                    "{:>8}  body {number} has another mesh from here on: {vertices}, {triangles}",
                    ""
                )?;
            }
        }
        let files = self.files.as_ref();
        let file = files.map_or_else(String::new, |files| files.frame(check, frame));
        write!(out, "{frame:>8}{file} {:>9}", grouped(count as u64))?;
        if self.adjacent {
            match &found.adjacent {
                Some(adjacent) => write!(out, " {:>9}", grouped(adjacent.count as u64))?,
                None => write!(out, "{:>10}", "-")?,
            }
        }
        if self.within.is_some() {
            let distance = found.distance.map_or_else(|| "-".to_owned(), short);
            write!(out, "{distance:>12}")?;
        }
        if self.baseline.is_some() {
            let adjacent = found.adjacent.as_ref();
            let of_adjacent = adjacent.map_or(Some(0), |adjacent| adjacent.left_out);
            match found
                .left_out
                .zip(of_adjacent)
                .map(|(one, other)| one + other)
            {
                Some(left_out) => write!(out, " {:>9}", grouped(left_out as u64))?,
                None => write!(out, "{:>10}", "-")?,
            }
        }
        let adjacent = found.adjacent.as_ref().and_then(|it| it.smallest);
        let smallest = found.smallest.or(adjacent);
        if let Some([body_a, a, body_b, b]) = smallest.filter(|_| !self.count_only) {
            write!(
                out,
                "  triangle {a} of body {body_a}, triangle {b} of body {body_b}"
            )?;
        }
        writeln!(out)
    }

    fn interval(&mut self, out: &mut dyn Write, _: &Check, interval: &Interval) -> io::Result<()> {
        let to = format!("to {}", interval.until);
        let files = self.files.as_ref();
        let file = files.map_or_else(String::new, Files::blank);
        write!(out, "{to:>8}{file} ")?;
        if !interval.changed.is_empty() {
            let bodies: Vec<_> = interval.changed.iter().map(u32::to_string).collect();
            let (of, change) = match bodies.len() {
                1 => ("mesh of body", "changes"),
                _ => ("meshes of bodies", "change"),
            };
            let bodies = bodies.join(", ");
            return writeln!(out, "{:>9}  not looked at: the {of} {bodies} {change}", "-");
        }
        write!(out, "{:>9}", grouped(interval.count as u64))?;
        if let Some(first) = &interval.first {
            let time = short(first.time());
            write!(out, "  met on the way, the first at {time}")?;
            if !self.count_only {
                write!(
                    out,
                    ": {}",
                    elements(first, |body| format!("body {body}")).join(", ")
                )?;
            }
        }
        match interval.at_start {
            0 => writeln!(out),
            met => {
                let before = if interval.first.is_some() { ";" } else { " " };
                let frame = interval.frame;
                let met = grouped(met as u64);
                writeln!(out, "{before} in contact in frame {frame} already: {met}")
            }
        }
    }

    fn end(
        &mut self,
        out: &mut dyn Write,
        check: &Check,
        tally: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()> {
        if !self.count_only {
            list_places(out, check)?;
        }
        match error {
            None => {
                writeln!(out, "\n{}", tally.summary())?;
                for line in tally.inside.lines(check) {
                    writeln!(out, "{line}")?;
                }
                if let Some(swept) = tally.swept() {
                    writeln!(out, "{swept}")?;
                }
                if let Some(kinds) = tally.kinds(self.crossing) {
                    writeln!(out, "{kinds}")?;
                }
                if let Some(adjacent) = tally.adjacent.said() {
                    writeln!(out, "{adjacent}; `--ignore-adjacent` leaves them out")?;
                }
                if tally.degenerate == 0 {
                    return Ok(());
                }
                let pairs = counted((
                    tally.degenerate,
                    "pair has a triangle without area",
                    "pairs have a triangle without area",
                ));
                if self.skip_degenerate {
                    writeln!(out, "left out: {pairs}")
                } else {
                    writeln!(out, "{pairs}; `--skip-degenerate` leaves such pairs out")
                }
            }
            Some(_) => Ok(()),
        }
    }
}

/// Prints a line for each place, most pairs first.
fn list_places(out: &mut dyn Write, check: &Check) -> io::Result<()> {
    let (count, lives) = check.places();
    if count == 0 {
        return Ok(());
    }
    let many = counted((count, "place", "places, most pairs first"));
    writeln!(out, "\n{many}:")?;
    for life in lives.iter().take(MOST_PLACES) {
        let (lived, lies) = (places::lived(check, life), places::lies(check, &life.worst));
        writeln!(out, "  {lived}; {lies}")?;
    }
    if count > MOST_PLACES {
        writeln!(out, "  and {} more", grouped((count - MOST_PLACES) as u64))?;
    }
    Ok(())
}

/// Side lengths of a box.
fn size([lower, upper]: [[f64; 3]; 2]) -> String {
    let sides = [0, 1, 2].map(|axis| short(upper[axis] - lower[axis]));
    format!("{} large", sides.join(" x "))
}

fn sizes(vertices: usize, triangles: usize) -> [String; 2] {
    [
        (vertices, "vertex", "vertices"),
        (triangles, "triangle", "triangles"),
    ]
    .map(counted)
}
