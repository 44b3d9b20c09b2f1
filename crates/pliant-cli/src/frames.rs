//! Frame ranges on the command line: `10..20`, `10..`, `..20`, `10`, `..`, `10..20:3`.
//!
//! The end is exclusive. `:3` takes every third frame of the range.

use anyhow::bail;
use std::iter::StepBy;
use std::ops::Range;
use std::str::FromStr;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frames {
    start: usize,
    /// Exclusive end. `None`: up to the last frame.
    end: Option<usize>,
    /// Distance from one frame to the next.
    step: usize,
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| {
            let help = "write frames as 10..20, 10.., ..20, 10 or 10..20:3; \
                        they count from 0, and the end is not one of them";
            text.parse::<usize>().map_err(|_| help.to_owned())
        };
        let Some((start, end)) = text.split_once("..") else {
            let start = number(text)?;
            let end = Some(start.saturating_add(1));
            return Ok(Self {
                start,
                end,
                step: 1,
            });
        };
        let (end, step) = match end.split_once(':') {
            Some((end, step)) => (end, number(step)?),
            None => (end, 1),
        };
        if step == 0 {
            return Err("a step of 0 frames goes nowhere; 10..20:3 is every third".to_owned());
        }
        let start = if start.is_empty() { 0 } else { number(start)? };
        let end = if end.is_empty() {
            None
        } else {
            Some(number(end)?)
        };
        if end.is_some_and(|end| end <= start) {
            return Err(format!(
                "{start}..{} has no frames, for its end is not one of them; \
                 write the first frame, and the one behind the last",
                end.unwrap_or(0)
            ));
        }
        Ok(Self { start, end, step })
    }
}

impl Frames {
    /// Numbers of the chosen frames, out of `count`. An error if one of them does not exist.
    pub(crate) fn within(self, count: usize) -> anyhow::Result<StepBy<Range<usize>>> {
        let Self { start, end, step } = self;
        let end = end.unwrap_or(count);
        let last = end.checked_sub(1).filter(|&last| start <= last);
        let last = last.map(|last| last - (last - start) % step);
        if last.is_none_or(|last| last >= count) {
            bail!(
                "not all of the chosen frames exist; there are frames 0 to {}; \
                 choose among these with `--frames`",
                count - 1
            );
        }
        Ok((start..end).step_by(step))
    }

    /// The chosen frames as settings of a check, which finds out how many exist.
    pub(crate) fn to_check(self) -> pliant_check::Frames {
        let Self { start, end, step } = self;
        pliant_check::Frames {
            start,
            step,
            count: end.map_or(usize::MAX, |end| (end - start).div_ceil(step)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_as_people_write_them() {
        let of_ten = |text: &str| {
            let frames = text.parse::<Frames>().unwrap();
            let within = frames.within(10).ok().map(Iterator::collect::<Vec<_>>);
            // A check is asked for the same frames.
            let asked = frames.to_check();
            let count = if asked.count == usize::MAX {
                10
            } else {
                asked.count
            };
            if let Some(within) = &within {
                let all = (asked.start..).step_by(asked.step).take(count);
                assert!(
                    all.take_while(|&frame| frame < 10)
                        .eq(within.iter().copied())
                );
            } else {
                let to_last = asked.step.saturating_mul(count.saturating_sub(1));
                assert!(asked.start.saturating_add(to_last) > 9, "{text}");
            }
            within
        };
        for (text, frames) in [
            ("..", Some(0..10)),
            ("3..7", Some(3..7)),
            ("3..", Some(3..10)),
            ("..7", Some(0..7)),
            ("9", Some(9..10)),
            ("0..10", Some(0..10)),
            ("0..11", None),
            ("10..", None),
            ("10", None),
            ("10..:3", None),
            ("0..11:5", None),
            ("18446744073709551615", None),
        ] {
            assert_eq!(of_ten(text), frames.map(Vec::from_iter), "{text}");
        }
        for (text, frames) in [
            ("2..9:3", &[2, 5, 8][..]),
            ("2..8:3", &[2, 5]),
            ("..:4", &[0, 4, 8]),
            ("7..:1", &[7, 8, 9]),
            // The end does not exist, but the last frame that this step reaches does.
            ("..11:4", &[0, 4, 8]),
            ("3..:100", &[3]),
            ("..5:18446744073709551615", &[0]),
        ] {
            assert_eq!(of_ten(text).as_deref(), Some(frames), "{text}");
        }
        for text in [
            "",
            "a",
            "-1",
            "3..3",
            "7..3",
            "..0",
            "1...3",
            "1..2..3",
            "1:3",
            "1..3:0",
            "1..3:",
            "1..3:-1",
            "1..3:1:1",
            "18446744073709551616",
        ] {
            assert!(text.parse::<Frames>().is_err(), "{text}");
        }
    }
}
