//! Lines where pairs of triangles meet: segments, and the sides of polygons.

use pliant::{End, Pair, Scalar, Segments, World};

/// Lines of pairs, each with its pair: body, triangle, body, triangle. If one of the pairs is not
/// there, there are no lines.
pub(crate) fn of_pairs<S: Scalar>(
    world: &World<S>,
    rows: &[[u32; 4]],
) -> Vec<([u32; 4], [End; 2])> {
    let pairs: Vec<Pair> = rows.iter().map(|&row| row.into()).collect();
    let mut segments = Segments::new();
    // If it is refused, it has none.
    let _ = segments.update(world, &pairs);
    let sides = segments.iter().flat_map(|segment| {
        let ends = segment.ends.to_vec();
        let count = match ends.len() {
            0 | 1 => 0,
            2 => 1,
            corners => corners,
        };
        let row = segment.pair.into();
        (0..count).map(move |i| (row, [ends[i], ends[(i + 1) % ends.len()]]))
    });
    sides.collect()
}
