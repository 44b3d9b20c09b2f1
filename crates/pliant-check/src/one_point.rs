//! Refuses meshes with very many triangles that are one and the same point.
//!
//! Each of them meets every other, so the number of pairs grows with the square. A sparse file that
//! takes a kilobyte on disk can hold twenty million such triangles. So they are counted before
//! pairs are looked for.

use crate::error::Error;
use pliant_io::{Body as Source, Positions};

/// Most point triangles at one place; more have over two thousand million pairs.
const MOST: usize = 1 << 16;

/// Refuses the current frame, `frame`, of a source if more than [`MOST`] triangles are one point.
///
/// O(t) for t triangles, and O(p log p) for p point triangles.
pub(crate) fn check(source: &Source, frame: usize) -> Result<(), Error> {
    let (triangles, positions) = (source.triangles(), source.positions());
    let place = |vertex: u32| bits(positions, vertex);
    let is_point = |&number: &u32| {
        let [a, b, c] = triangles[number as usize].map(place);
        a == b && a == c
    };
    let place_of = |&number: &u32| place(triangles[number as usize][0]);
    let mut points: Vec<u32> = (0..triangles.len() as u32).filter(is_point).collect();
    if points.len() <= MOST {
        return Ok(());
    }
    points.sort_unstable_by_key(place_of);
    let together = points.chunk_by(|a, b| place_of(a) == place_of(b));
    match together.max_by_key(|together| together.len()) {
        Some(together) if together.len() > MOST => {
            let [x, y, z] = place_of(&together[0]).map(f64::from_bits);
            Err(Error::OnePoint {
                source_name: source.name().to_owned(),
                frame,
                count: together.len(),
                x,
                y,
                z,
            })
        }
        _ => Ok(()),
    }
}

/// Bits of a position, equal where the coordinates are equal: -0 counts as 0.
fn bits(positions: Positions<'_>, vertex: u32) -> [u64; 3] {
    positions.get(vertex).map(|value| (value + 0.0).to_bits())
}
