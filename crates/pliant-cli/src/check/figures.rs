//! Numbers, formatted for people.

use crate::table::grouped;

/// Four significant digits. Enough to read; nobody types them elsewhere.
pub(super) fn short(x: f64) -> String {
    let digits = format!("{x:.3e}");
    match digits.parse::<f64>() {
        Ok(rounded) if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) => {
            format!("{}", rounded + 0.0)
        }
        _ => digits,
    }
}

/// A number and its noun: `1 vertex`, `2 vertices`.
pub(super) fn counted((number, one, many): (usize, &str, &str)) -> String {
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
