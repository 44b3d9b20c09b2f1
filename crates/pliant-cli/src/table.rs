//! Tables and numbers, formatted for people.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};

/// A table without lines: the first column aligned left, the others right.
pub(crate) fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// Decimal digits in groups of three: 20480 is `20,480`.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// Four significant digits. Enough to read; nobody types them elsewhere.
pub(crate) fn short(x: f64) -> String {
    let digits = format!("{x:.3e}");
    match digits.parse::<f64>() {
        Ok(rounded) if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) => {
            format!("{}", rounded + 0.0)
        }
        _ => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::{grouped, short};

    #[test]
    fn groups_of_three() {
        for (number, text) in [
            (0, "0"),
            (999, "999"),
            (1000, "1,000"),
            (20480, "20,480"),
            (1_310_720, "1,310,720"),
        ] {
            assert_eq!(grouped(number), text);
        }
    }

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
