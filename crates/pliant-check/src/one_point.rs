//! Triangles that are points, very many of them at one place: a sparse file of a gigabyte that takes a kilobyte on the disk holds
//! twenty million. Each meets every other, so the answer grows by the square, and is known before it is looked for.

use crate::error::Error;
use pliant_io::{Body as Source, Positions};

/// So many may be at one place: more than two thousand million pairs.
const MOST: usize = 1 << 16;

/// Refuses a source, the first frame of which is there, with more.
pub(crate) fn check(source: &Source) -> Result<(), Error> {
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
                count: together.len(),
                x,
                y,
                z,
            })
        }
        _ => Ok(()),
    }
}

/// A place, as bits that are equal where the numbers are: -0 counts as 0.
fn bits(positions: Positions<'_>, vertex: u32) -> [u64; 3] {
    positions.get(vertex).map(|value| (value + 0.0).to_bits())
}
