//! Coordinates in the precision of the file.

use crate::positions::Positions;

/// A position in 32 bits; sets `rounded` where it was none.
pub(super) fn narrowed(position: [f64; 3], rounded: &mut bool) -> [f32; 3] {
    position.map(|x| {
        let narrow = x as f32;
        *rounded |= f64::from(narrow).to_bits() != x.to_bits();
        narrow
    })
}

/// The positions one by one, widened.
pub(super) fn widened(positions: Positions<'_>) -> impl Iterator<Item = [f64; 3]> + '_ {
    (0..positions.len() as u32).map(move |vertex| positions.get(vertex))
}
