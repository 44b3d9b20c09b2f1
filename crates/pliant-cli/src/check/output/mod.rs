//! What `pliant check` prints, frame by frame as it goes. Each format is a file.

mod files;
mod github;
mod json;
mod lines;
mod places;
mod table;

use super::{Arguments, Format};
use crate::Outcome;
use crate::table::grouped;
use anyhow::Context;
use pliant_check::{Check, Found, Interval, Kinds};
use std::io::{self, BufWriter, Stdout, Write};

/// What a failing write is the failure of.
const WRITING: &str = "cannot write to standard output";

/// Where answers go.
pub(super) struct Output {
    out: BufWriter<Stdout>,
    /// None where nothing is to be printed.
    form: Option<Box<dyn Form>>,
    tally: Tally,
}

/// How answers are written.
trait Form {
    /// What is known before the first frame.
    fn head(&mut self, out: &mut dyn Write, check: &Check) -> io::Result<()>;
    /// One frame.
    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()>;
    /// What meets on the way from the frame to the next; of forms that are refused where this is asked, nothing.
    fn interval(&mut self, _: &mut dyn Write, _: &Check, _: &Interval) -> io::Result<()> {
        Ok(())
    }
    /// The end, of a check that was completed or of one that could not be.
    fn end(
        &mut self,
        out: &mut dyn Write,
        check: &Check,
        tally: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()>;
}

/// What all frames so far come to.
#[derive(Default)]
struct Tally {
    frames: usize,
    intersecting: usize,
    /// The distance that was asked for, if not what intersects was.
    within: Option<f64>,
    /// The frame with the nearest pair, and how far apart it is.
    nearest: Option<(usize, f64)>,
    /// The frame with the most pairs, and their number; none where not all pairs are known.
    worst: Option<(usize, usize)>,
    /// How many pairs are of which kind, in frames of which all were asked for.
    kinds: Kinds,
    /// Pairs that are left out, for their places only touch.
    only_touching: usize,
    /// Pairs with a triangle that has no area, counted or left out.
    degenerate: usize,
    /// Intervals between frames that were looked at, and those in which something meets.
    intervals: [usize; 2],
    /// The frames of the first that was not, for a mesh changes in it, and how many were not.
    skipped: Option<([usize; 2], usize)>,
}

impl Tally {
    fn count(&mut self, found: &Found) {
        self.frames += 1;
        self.intersecting += usize::from(found.count > 0);
        self.degenerate += found.degenerate;
        self.only_touching += found.only_touching.unwrap_or(0);
        let kinds = found.kinds.unwrap_or_default();
        self.kinds.crossing += kinds.crossing;
        self.kinds.overlapping += kinds.overlapping;
        self.kinds.touching += kinds.touching;
        if let Some(distance) = found.distance
            && self.nearest.is_none_or(|(_, least)| distance < least)
        {
            self.nearest = Some((found.frame, distance));
        }
        if found.complete && found.count > self.worst.map_or(0, |(_, most)| most) {
            self.worst = Some((found.frame, found.count));
        }
    }

    fn count_interval(&mut self, interval: &Interval) {
        if interval.changed.is_empty() {
            self.intervals[0] += 1;
            self.intervals[1] += usize::from(interval.count > 0);
        } else {
            let (_, count) = self
                .skipped
                .get_or_insert(([interval.frame, interval.until], 0));
            *count += 1;
        }
    }

    /// One line for people about pairs that do not cross: those counted, or those of places that were left out.
    fn kinds(&self, leaves_touching_out: bool) -> Option<String> {
        if leaves_touching_out {
            let pairs = counted((self.only_touching, "pair of a place", "pairs of places"));
            return Some(format!("left out: {pairs} where surfaces only touch"));
        }
        let Kinds {
            crossing,
            overlapping,
            touching,
        } = self.kinds;
        if overlapping + touching == 0 {
            return None;
        }
        let [cross, overlap, touch] = [crossing, overlapping, touching].map(|n| grouped(n as u64));
        Some(format!(
            "{cross} of these pairs cross, {overlap} overlap in a plane, {touch} touch; `--crossing` leaves out places where surfaces only touch"
        ))
    }

    /// One line for people about what meets between frames, if that was asked.
    fn swept(&self) -> Option<String> {
        let [looked_at, meeting] = self.intervals.map(|n| grouped(n as u64));
        let not = match self.skipped {
            None if self.intervals[0] == 0 => return None,
            None => String::new(),
            Some((_, count)) => {
                format!(
                    "; {} not looked at, for a mesh changes",
                    grouped(count as u64)
                )
            }
        };
        Some(format!(
            "on the way from a frame to the next something meets in {meeting} of {looked_at}{not}"
        ))
    }

    /// One line for people.
    fn summary(&self) -> String {
        let [intersecting, frames] = [self.intersecting, self.frames].map(|n| grouped(n as u64));
        let worst = self.worst.map_or_else(String::new, |(frame, count)| {
            format!("; most pairs: {} in frame {frame}", grouped(count as u64))
        });
        let Some(within) = self.within else {
            return format!("{intersecting} of {frames} frames intersect{worst}");
        };
        let nearest = self.nearest.map_or_else(String::new, |(frame, distance)| {
            format!("; least distance: {} in frame {frame}", short(distance))
        });
        format!(
            "{intersecting} of {frames} frames have triangles of two bodies at most {within} apart{nearest}{worst}"
        )
    }
}

impl Output {
    /// Prints what is known before the first frame.
    pub(super) fn begin(arguments: &Arguments, check: &Check) -> anyhow::Result<Self> {
        let form: Box<dyn Form> = match arguments.format {
            Format::Table => Box::new(table::Table::new(arguments)),
            Format::Json => Box::new(json::Json::new(arguments)),
            Format::Github => Box::new(github::Github::new(arguments)),
            Format::Lines => Box::new(lines::Lines::new(arguments)),
        };
        let mut output = Self {
            out: BufWriter::new(io::stdout()),
            form: (!arguments.quiet).then_some(form),
            tally: Tally {
                within: arguments.within,
                ..Tally::default()
            },
        };
        output.print(|form, out, _| form.head(out, check))?;
        Ok(output)
    }

    /// Prints one frame.
    pub(super) fn frame(&mut self, check: &Check, found: &Found) -> anyhow::Result<()> {
        self.print(|form, out, _| {
            form.frame(out, check, found)?;
            // Someone is looking, or reading: each frame is shown when it is done.
            out.flush()
        })?;
        self.tally.count(found);
        Ok(())
    }

    /// Prints what meets on the way to the next frame.
    pub(super) fn interval(&mut self, check: &Check, interval: &Interval) -> anyhow::Result<()> {
        self.print(|form, out, _| {
            form.interval(out, check, interval)?;
            out.flush()
        })?;
        self.tally.count_interval(interval);
        Ok(())
    }

    /// Prints the end, of a check that was completed or of one that could not be.
    pub(super) fn end(
        mut self,
        check: &Check,
        checked: anyhow::Result<()>,
    ) -> anyhow::Result<Outcome> {
        let error = checked.as_ref().err();
        let printed = self.print(|form, out, tally| {
            form.end(out, check, tally, error)?;
            out.flush()
        });
        // If both went wrong, what stopped the check comes first.
        checked.and(printed)?;
        let [_, meeting] = self.tally.intervals;
        if let (Some(([frame, until], count)), Some(_)) = (self.tally.skipped, &self.form) {
            let count = counted((count, "interval", "intervals"));
            crate::complain(&format!(
                "note: {count} between frames not looked at, for a mesh changes there: the first from frame {frame} to {until}"
            ));
        }
        Ok(if self.tally.intersecting > 0 || meeting > 0 {
            Outcome::Intersects
        } else {
            Outcome::Clear
        })
    }

    fn print(
        &mut self,
        write: impl FnOnce(&mut dyn Form, &mut dyn Write, &Tally) -> io::Result<()>,
    ) -> anyhow::Result<()> {
        match &mut self.form {
            Some(form) => write(form.as_mut(), &mut self.out, &self.tally).context(WRITING),
            None => Ok(()),
        }
    }
}

/// Passes on why a check could not begin; where errors are annotations, prints that too.
pub(super) fn annotate<T>(arguments: &Arguments, error: anyhow::Error) -> anyhow::Result<T> {
    if arguments.format == Format::Github && !arguments.quiet {
        // What stopped the check comes first, whether this can be printed or not.
        let _ = crate::print_all(&github::failure(&error));
    }
    Err(error)
}

/// Four digits that count: nobody types it elsewhere.
pub(super) fn short(x: f64) -> String {
    let digits = format!("{x:.3e}");
    match digits.parse::<f64>() {
        Ok(rounded) if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) => {
            format!("{}", rounded + 0.0)
        }
        _ => digits,
    }
}

/// `1 vertex`, `2 vertices`.
fn counted((number, one, many): (usize, &str, &str)) -> String {
    let name = if number == 1 { one } else { many };
    format!("{} {name}", grouped(number as u64))
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn coordinates_have_four_digits() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-1.234_56, "-1.235"),
            (123_456.0, "123500"),
            (0.000_123_456, "0.0001235"),
            (1.0 / 3.0 * 1e-9, "3.333e-10"),
            (f64::MAX, "1.798e308"),
        ] {
            assert_eq!(short(x), text, "{x}");
        }
    }
}
