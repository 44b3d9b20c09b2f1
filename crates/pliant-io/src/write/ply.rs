//! PLY writer: binary little-endian, `float` or `double` as the body has it.

use std::io::{self, Write};

use super::coordinates::widened;
use super::shape::Shape;
use crate::positions::{Positions, Precision};

/// Writes one frame; nothing is rounded.
pub(super) fn write(
    out: &mut impl Write,
    shape: &Shape,
    positions: Positions<'_>,
) -> io::Result<bool> {
    let (mut polygons, mut most) = (0_u64, 0);
    shape.each_polygon(|corners| {
        polygons += 1;
        most = most.max(corners.len());
        io::Result::Ok(())
    })?;
    let number = match shape.precision {
        Precision::F32 => "float",
        Precision::F64 => "double",
    };
    // Few readers know other types than `uchar` and `int`.
    let few = u8::try_from(most).is_ok();
    let length = if few { "uchar" } else { "uint" };
    let index = if i32::try_from(shape.vertex_count).is_ok() {
        "int"
    } else {
        "uint"
    };
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n\
         property {number} x\nproperty {number} y\nproperty {number} z\n\
         element face {polygons}\nproperty list {length} {index} vertex_indices\nend_header\n",
        shape.vertex_count
    )?;
    for position in widened(positions) {
        for x in position {
            match shape.precision {
                Precision::F32 => out.write_all(&(x as f32).to_le_bytes())?,
                Precision::F64 => out.write_all(&x.to_le_bytes())?,
            }
        }
    }
    shape.each_polygon(|corners| {
        match u8::try_from(corners.len()) {
            Ok(count) if few => out.write_all(&[count])?,
            _ => out.write_all(&(corners.len() as u32).to_le_bytes())?,
        }
        corners
            .iter()
            .try_for_each(|corner| out.write_all(&corner.to_le_bytes()))
    })?;
    Ok(false)
}
