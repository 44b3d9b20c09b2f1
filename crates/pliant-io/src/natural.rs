//! Natural order: digit sequences compare as numbers, so that `frame2` comes before `frame10`.

use std::cmp::Ordering;
use std::path::Path;

/// Compares two paths in natural order, in O(length).
///
/// Numbers may have any length and are not converted: of two digit sequences without leading zeros,
/// the longer is the larger. Names that differ only in leading zeros (`a1`, `a01`) compare by their
/// bytes, so that the order is total.
pub(crate) fn compare(a: &Path, b: &Path) -> Ordering {
    let (a, b) = (
        a.as_os_str().as_encoded_bytes(),
        b.as_os_str().as_encoded_bytes(),
    );
    let (mut left, mut right) = (a, b);
    loop {
        let (Some(&l), Some(&r)) = (left.first(), right.first()) else {
            return left.len().cmp(&right.len()).then_with(|| a.cmp(b));
        };
        let order = if l.is_ascii_digit() && r.is_ascii_digit() {
            let (number, other) = (take_digits(&mut left), take_digits(&mut right));
            number
                .len()
                .cmp(&other.len())
                .then_with(|| number.cmp(other))
        } else {
            (left, right) = (&left[1..], &right[1..]);
            l.cmp(&r)
        };
        if order.is_ne() {
            return order;
        }
    }
}

/// Cuts the leading digits off `text` and returns them without leading zeros.
fn take_digits<'a>(text: &mut &'a [u8]) -> &'a [u8] {
    let end = text
        .iter()
        .position(|c| !c.is_ascii_digit())
        .unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    *text = rest;
    let zeros = digits.iter().take_while(|&&c| c == b'0').count();
    &digits[zeros..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_compare_as_numbers() {
        let sorted = [
            "a",
            "a0",
            "a1",
            "a2.obj",
            "a2b",
            "a10.obj",
            "a10b",
            "a10b2",
            "a10b11",
            "a18446744073709551616",
            "a18446744073709551617",
            "b1",
        ];
        for (i, a) in sorted.iter().enumerate() {
            for (j, b) in sorted.iter().enumerate() {
                assert_eq!(
                    compare(Path::new(a), Path::new(b)),
                    i.cmp(&j),
                    "{a} and {b}"
                );
            }
        }
    }

    #[test]
    fn leading_zeros_count_only_between_equals() {
        let order = |a: &str, b: &str| compare(Path::new(a), Path::new(b));
        assert_eq!(order("f002", "f10"), Ordering::Less);
        assert_eq!(order("f01", "f1"), Ordering::Less);
        assert_eq!(order("f1", "f01"), Ordering::Greater);
        assert_eq!(order("f01x2", "f1x1"), Ordering::Greater);
        assert_eq!(order("f0", "f000"), Ordering::Less);
    }
}
