//! Byte counts as messages write them.

use std::fmt;

/// A byte count for people: `95 bytes`, `4 GiB`, `1.5 GiB`. Rounded up to a tenth.
pub(crate) struct Size(pub(crate) u64);

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(bytes) = *self;
        let units = [(40, "TiB"), (30, "GiB"), (20, "MiB"), (10, "KiB")];
        let Some((shift, unit)) = units.into_iter().find(|(shift, _)| bytes >> shift > 0) else {
            return write!(f, "{bytes} bytes");
        };
        let tenths = (u128::from(bytes) * 10).div_ceil(1 << shift);
        match tenths % 10 {
            0 => write!(f, "{} {unit}", tenths / 10),
            tenth => write!(f, "{}.{tenth} {unit}", tenths / 10),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_written_for_people() {
        for (bytes, written) in [
            (0, "0 bytes"),
            (1023, "1023 bytes"),
            (1024, "1 KiB"),
            (4 << 30, "4 GiB"),
            ((4 << 30) + 1, "4.1 GiB"),
            (3 << 29, "1.5 GiB"),
            ((1 << 40) - 1, "1024 GiB"),
            (u64::MAX, "16777216 TiB"),
        ] {
            assert_eq!(Size(bytes).to_string(), written);
        }
    }
}
