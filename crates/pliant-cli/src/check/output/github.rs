//! Annotations for GitHub Actions: lines `::error file=...::message` on standard output.
//!
//! Each place gets one, on the file of the frame in which it has the most pairs; a summary follows.
//! With `--first` or `--count` no places are found, and the first frames that intersect get one
//! each. The runner shows ten errors of a step, so no more are printed: the places with the most
//! pairs.

use super::form::Form;
use super::places;
use super::tally::Tally;
use crate::advice;
use crate::check::arguments::Arguments;
use crate::check::figures::counted;
use crate::table::{grouped, short};
use pliant_check::{Check, Found, Row};
use pliant_io::{shown, shown_within};
use std::io::{self, Write};

/// Most errors of one step that the runner shows.
const MOST_ANNOTATIONS: usize = 10;

pub(super) struct Github {
    within: Option<f64>,
    annotated: usize,
}

impl Github {
    pub(super) fn new(arguments: &Arguments) -> Self {
        Self {
            within: arguments.within,
            annotated: 0,
        }
    }
}

impl Form for Github {
    fn head(&mut self, _: &mut dyn Write, _: &Check) -> io::Result<()> {
        Ok(())
    }

    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()> {
        let adjacent = found.adjacent.as_ref().and_then(|it| it.smallest);
        let smallest = found.smallest.or(adjacent);
        let Some(smallest) = smallest.filter(|_| found.places.is_none()) else {
            return Ok(());
        };
        if self.annotated == MOST_ANNOTATIONS {
            return Ok(());
        }
        self.annotated += 1;
        let pairs = if let (Some(within), Some(distance)) = (self.within, found.distance) {
            let pairs = if found.complete {
                counted((found.count, "pair", "pairs"))
            } else {
                "at least 1 pair".to_owned()
            };
            let distance = short(distance);
            format!("{pairs} of triangles at most {within} apart, the nearest {distance}")
        } else if found.complete {
            counted((
                found.count_of_all(),
                "pair of triangles intersects",
                "pairs of triangles intersect",
            ))
        } else {
            "at least 1 pair of triangles intersects".to_owned()
        };
        let left_out = match found.left_out {
            Some(left_out @ 1..) => format!(" ({} more left out)", grouped(left_out as u64)),
            _ => String::new(),
        };
        let message = format!(
            "frame {}: {pairs}{left_out}; {}",
            found.frame,
            first_pair(check, smallest)
        );
        annotation(out, check, found.frame, smallest, &message)
    }

    fn end(
        &mut self,
        out: &mut dyn Write,
        check: &Check,
        tally: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()> {
        let (count, lives) = check.places();
        // The error that stopped the check is one of those shown.
        let room = MOST_ANNOTATIONS - usize::from(error.is_some());
        for life in lives.iter().take(room) {
            let pair = life.worst.first_pair;
            let (lived, first) = (places::lived(check, life), first_pair(check, pair));
            annotation(
                out,
                check,
                life.worst_frame,
                pair,
                &format!("{lived}; {first}"),
            )?;
        }
        if let Some(error) = error {
            return out.write_all(failure(error).as_bytes());
        }
        write!(out, "pliant: {}", tally.summary())?;
        if let Some(adjacent) = tally.adjacent.said() {
            write!(out, "; {adjacent}")?;
        }
        if count > 0 {
            write!(out, "; {}", counted((count, "place", "places")))?;
        }
        if count > MOST_ANNOTATIONS {
            write!(
                out,
                ", the {MOST_ANNOTATIONS} with the most pairs are annotated"
            )?;
        } else if count == 0 && tally.intersecting > MOST_ANNOTATIONS {
            write!(out, "; the first {MOST_ANNOTATIONS} are annotated")?;
        }
        writeln!(out)
    }
}

fn annotation(
    out: &mut dyn Write,
    check: &Check,
    frame: usize,
    pair: Row,
    message: &str,
) -> io::Result<()> {
    let file = file_of(check, frame, pair);
    let file = file.map_or_else(String::new, |file| format!("file={},", property(&file)));
    writeln!(out, "::error {file}title=pliant::{}", data(message))
}

fn first_pair(check: &Check, [body_a, a, body_b, b]: Row) -> String {
    let [one, other] = [body_a, body_b].map(|body| {
        let body = check.body(body);
        body.map_or_else(String::new, |body| shown(body.name))
    });
    format!("the first: triangle {a} of {one} and triangle {b} of {other}")
}

/// Annotation of a check that could not begin or continue.
pub(super) fn failure(error: &anyhow::Error) -> String {
    format!(
        "::error title=pliant::{}\n",
        data(&advice::with_advice(error))
    )
}

/// File of the first triangle in a frame, or the only file of its source.
fn file_of(check: &Check, frame: usize, [body, ..]: Row) -> Option<String> {
    let source = &check.sources()[check.source_of(body)?];
    let file = source.frame_file(frame).or_else(|| source.frame_file(0))?;
    // Not shortened: the runner looks for the file.
    Some(shown_within(file, usize::MAX))
}

/// Escapes a message: `%` begins an escape, and a line break ends the message.
///
/// Messages have no line breaks already. If one had, the rest could be a command.
fn data(text: &str) -> String {
    let text = text.replace('%', "%25");
    text.replace('\r', "%0D").replace('\n', "%0A")
}

/// Escapes a property, which colons and commas end.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_ends_a_message_or_a_property() {
        assert_eq!(data("a%0A:,\r\n::error::b"), "a%250A:,%0D%0A::error::b");
        assert_eq!(
            property("C:\\a,b%\r\n::x.obj"),
            "C%3A\\a%2Cb%25%0D%0A%3A%3Ax.obj"
        );
    }
}
