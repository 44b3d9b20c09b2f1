//! Which frames: `10..20`, `10..`, `..20`, `10`, `..`; the end is not one of them.

use anyhow::bail;
use std::ops::Range;
use std::str::FromStr;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Frames {
    start: usize,
    /// None for the last frame there is.
    end: Option<usize>,
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| {
            let help = "write frames as 10..20, 10.., ..20 or 10; they count from 0, and the end is not one of them";
            text.parse::<usize>().map_err(|_| help.to_owned())
        };
        let Some((start, end)) = text.split_once("..") else {
            let start = number(text)?;
            let end = Some(start.saturating_add(1));
            return Ok(Self { start, end });
        };
        let start = if start.is_empty() { 0 } else { number(start)? };
        let end = if end.is_empty() {
            None
        } else {
            Some(number(end)?)
        };
        if end.is_some_and(|end| end <= start) {
            return Err(format!(
                "no frame is from {start} up to, but not, {}; write the first frame, and the one behind the last",
                end.unwrap_or(0)
            ));
        }
        Ok(Self { start, end })
    }
}

impl Frames {
    /// These of so many.
    pub(super) fn within(self, count: usize) -> anyhow::Result<Range<usize>> {
        let Self { start, end } = self;
        let end = end.unwrap_or(count);
        if start >= end || end > count {
            bail!(
                "there are frames 0 to {}; choose among these with `--frames`",
                count - 1
            );
        }
        Ok(start..end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_as_people_write_them() {
        let of_ten = |text: &str| text.parse::<Frames>().unwrap().within(10).ok();
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
            ("18446744073709551615", None),
        ] {
            assert_eq!(of_ten(text), frames, "{text}");
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
            "18446744073709551616",
        ] {
            assert!(text.parse::<Frames>().is_err(), "{text}");
        }
    }
}
