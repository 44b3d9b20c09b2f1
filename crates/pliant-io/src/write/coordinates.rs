//! Conversion of coordinates to the precision of the file.

use crate::positions::Positions;

/// Rounds a position to f32; sets `rounded` if that changes a coordinate.
pub(super) fn narrowed(position: [f64; 3], rounded: &mut bool) -> [f32; 3] {
    position.map(|x| {
        let narrow = x as f32;
        *rounded |= f64::from(narrow).to_bits() != x.to_bits();
        narrow
    })
}

/// Positions one by one, widened to f64.
pub(super) fn widened(positions: Positions<'_>) -> impl Iterator<Item = [f64; 3]> + '_ {
    (0..positions.len() as u32).map(move |vertex| positions.get(vertex))
}
