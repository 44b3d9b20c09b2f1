//! Detection of an unquoted pattern: the shell expands `check cloth_*.obj` into many arguments.
//!
//! Each of them would be a body of its own, instead of a frame.

use std::path::Path;

use glob::Pattern;

use crate::format::Format;

/// Returns the pattern to quote, if `arguments` look like one numbered series.
///
/// They do if there are at least two, all different, and equal except for one sequence of digits.
/// All other characters are taken literally: characters with a meaning in patterns are escaped. The
/// files are not looked at.
///
/// ```
/// let arguments = ["cloth_9.obj", "cloth_10.obj"].map(String::from);
/// assert_eq!(pliant_io::looks_like_a_series(&arguments).as_deref(), Some("cloth_*.obj"));
/// let arguments = ["arm.obj", "leg.obj"].map(String::from);
/// assert_eq!(pliant_io::looks_like_a_series(&arguments), None);
/// ```
pub fn looks_like_a_series(arguments: &[String]) -> Option<String> {
    let (first, others) = arguments.split_first()?;
    let first = runs(first);
    let mut varying = None;
    let mut numbers = vec![];
    for other in others {
        let other = runs(other);
        if other.len() != first.len() {
            return None;
        }
        for (at, (a, b)) in first.iter().zip(&other).enumerate() {
            if a == b {
                continue;
            }
            if !(is_number(a) && is_number(b)) || varying.is_some_and(|known| known != at) {
                return None;
            }
            varying = Some(at);
        }
        numbers.push(other);
    }
    let varying = varying?;
    if is_behind_a_file(&first[..varying].concat()) {
        return None;
    }
    let mut numbers: Vec<&str> = numbers.iter().map(|other| other[varying]).collect();
    numbers.push(first[varying]);
    let count = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    let escape = |runs: &[&str]| Pattern::escape(&runs.concat());
    (numbers.len() == count).then(|| {
        format!(
            "{}*{}",
            escape(&first[..varying]),
            escape(&first[varying + 1..])
        )
    })
}

/// Whether a file ends before `beginning` does, so that a part of it follows: `scene.glb#arm`.
fn is_behind_a_file(beginning: &str) -> bool {
    let mut cuts = beginning.match_indices('#');
    cuts.any(|(at, _)| Format::of(Path::new(&beginning[..at])).is_ok())
}

/// Splits `text` wherever digits begin or end.
fn runs(text: &str) -> Vec<&str> {
    text.as_bytes()
        .chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit())
        .scan(0, |start, run| {
            let begin = *start;
            *start += run.len();
            Some(&text[begin..*start])
        })
        .collect()
}

fn is_number(run: &str) -> bool {
    run.starts_with(|c: char| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hint(arguments: &[&str]) -> Option<String> {
        looks_like_a_series(
            &arguments
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>(),
        )
    }

    #[test]
    fn one_varying_number_is_a_series() {
        assert_eq!(hint(&["326.ply", "327.ply"]).as_deref(), Some("*.ply"));
        assert_eq!(
            hint(&["c/f0001.obj", "c/f0002.obj", "c/f0003.obj"]).as_deref(),
            Some("c/f*.obj")
        );
        assert_eq!(
            hint(&["é1.obj", "é10.obj", "é2.obj"]).as_deref(),
            Some("é*.obj")
        );
        assert_eq!(
            hint(&["run1/v2.ply", "run2/v2.ply"]).as_deref(),
            Some("run*/v2.ply")
        );
        assert_eq!(
            hint(&["a#1/f.obj", "a#2/f.obj"]).as_deref(),
            Some("a#*/f.obj")
        );
        assert_eq!(hint(&["[a]1", "[a]2"]).as_deref(), Some("[[]a[]]*"));
    }

    #[test]
    fn anything_else_is_not() {
        assert_eq!(hint(&[]), None);
        assert_eq!(hint(&["f1.obj"]), None);
        assert_eq!(hint(&["f1.obj", "f1.obj"]), None);
        assert_eq!(hint(&["f1.obj", "f2.obj", "f1.obj"]), None);
        assert_eq!(hint(&["f1.obj", "f2.ply"]), None);
        assert_eq!(hint(&["f1.obj", "g1.obj"]), None);
        assert_eq!(hint(&["f1_1.obj", "f2_2.obj"]), None);
        assert_eq!(hint(&["f1_1.obj", "f1_2.obj", "f2_1.obj"]), None);
        assert_eq!(hint(&["", ""]), None);
        assert_eq!(hint(&["f.obj#leg1", "f.obj#leg2"]), None);
    }
}
