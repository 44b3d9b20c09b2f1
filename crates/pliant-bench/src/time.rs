//! Durations as text: three digits, in the largest unit that needs no leading zero.

/// Formats milliseconds: 0.0213 is `21.3 µs`.
pub fn duration(milliseconds: f64) -> String {
    let (mut value, mut units) = (milliseconds * 1e6, ["µs", "ms", "s"].into_iter());
    let mut unit = "ns";
    // A value that rounds to 1000 belongs to the next unit.
    while value >= 999.5 {
        let Some(larger) = units.next() else { break };
        value /= 1e3;
        unit = larger;
    }
    let decimals = match value {
        value if unit == "ns" || value >= 99.95 => 0,
        value if value >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn three_digits_and_a_unit() {
        for (milliseconds, text) in [
            (0.0, "0 ns"),
            (0.000_042, "42 ns"),
            (0.000_999_4, "999 ns"),
            (0.000_999_6, "1.00 µs"),
            (0.002_134, "2.13 µs"),
            (0.009_996, "10.0 µs"),
            (0.0213, "21.3 µs"),
            (0.099_96, "100 µs"),
            (0.663, "663 µs"),
            (2.963, "2.96 ms"),
            (999.4, "999 ms"),
            (999.6, "1.00 s"),
            (61_500.0, "61.5 s"),
            (3_600_000.0, "3600 s"),
        ] {
            assert_eq!(duration(milliseconds), text, "{milliseconds}");
        }
        assert_eq!(duration(f64::NAN), "NaN ns");
    }
}
