//! OBJ writer: the shortest decimals that read back as the same f64.

use std::fmt;
use std::io::{self, Write};

use super::coordinates::widened;
use super::shape::Shape;
use crate::positions::Positions;

/// Writes one frame; nothing is rounded.
pub(super) fn write(
    out: &mut impl Write,
    shape: &Shape,
    positions: Positions<'_>,
) -> io::Result<bool> {
    for [x, y, z] in widened(positions) {
        writeln!(out, "v {} {} {}", Decimal(x), Decimal(y), Decimal(z))?;
    }
    shape.each_polygon(|corners| {
        write!(out, "f")?;
        for &corner in corners {
            write!(out, " {}", u64::from(corner) + 1)?;
        }
        writeln!(out)
    })?;
    Ok(false)
}

/// A number in decimal, with an exponent where it would have many zeros.
struct Decimal(f64);

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(x) = *self;
        if x == 0.0 || (1e-5..1e16).contains(&x.abs()) {
            write!(f, "{x}")
        } else {
            write!(f, "{x:e}")
        }
    }
}
