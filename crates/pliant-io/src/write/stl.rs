//! Binary STL writer: f32, each triangle with its own corners and its normal.

use std::io::{self, Write};

use super::coordinates::narrowed;
use super::shape::Shape;
use crate::positions::Positions;

/// Writes one frame; returns whether a coordinate was rounded.
pub(super) fn write(
    out: &mut impl Write,
    shape: &Shape,
    positions: Positions<'_>,
) -> io::Result<bool> {
    let mut rounded = false;
    // Some readers take a file that begins with "solid" for text.
    out.write_all(&[b' '; 80])?;
    out.write_all(&(shape.triangles.len() as u32).to_le_bytes())?;
    for corners in &shape.triangles {
        let corners = corners.map(|corner| positions.get(corner));
        let normal = normal(corners).map(|x| x as f32);
        let corners = corners.map(|corner| narrowed(corner, &mut rounded));
        for x in [normal, corners[0], corners[1], corners[2]].as_flattened() {
            out.write_all(&x.to_le_bytes())?;
        }
        out.write_all(&[0, 0])?;
    }
    Ok(rounded)
}

/// Unit normal of a triangle; 0 where it has no direction.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [u, v] = [b, c].map(|corner| [0, 1, 2].map(|axis| corner[axis] - a[axis]));
    let cross = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() {
        cross.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}
