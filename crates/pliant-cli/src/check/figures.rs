//! Numbers, formatted for people.

use crate::table::grouped;

/// A number and its noun: `1 vertex`, `2 vertices`.
pub(super) fn counted((number, one, many): (usize, &str, &str)) -> String {
    let name = if number == 1 { one } else { many };
    format!("{} {name}", grouped(number as u64))
}
