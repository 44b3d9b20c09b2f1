//! Single pairs of elements or of triangles, without a world: for callers with a search of their
//! own.
//!
//! Each answer is the one that a [`World`](crate::World) gives for such a pair. One thread looks at
//! them in order, at distances and impacts side by side in lanes.

mod contacts;
mod distances;
mod impacts;

use crate::error::{Error, ErrorKind};
use crate::world::Scalar;
pub use contacts::triangle_contacts;
pub use distances::{PairDistance, edge_edge_distances, pair_distances, vertex_triangle_distances};
pub use impacts::{edge_edge_impacts, pair_impacts, vertex_triangle_impacts};
use pliant_exact::denormals_are_kept;

/// A corner in four lanes, the last coordinate twice.
fn padded<S: Copy>([x, y, z]: [S; 3]) -> [S; 4] {
    [x, y, z, z]
}

/// Refuses coordinates that no body may have, and that this thread would lose.
fn check<S: Scalar, const C: usize>(pairs: &[[[S; 3]; C]]) -> Result<(), Error> {
    let loses = !denormals_are_kept();
    for (pair, corners) in pairs.iter().enumerate() {
        for (corner, position) in corners.iter().enumerate() {
            let is_lost = loses && position.iter().any(|x| x.needs_subnormals());
            let position = position.map(Scalar::to_f64);
            if is_lost || !position.iter().all(|x| x.abs() <= f64::from(f32::MAX)) {
                return Err(ErrorKind::BadCorner {
                    pair,
                    corner,
                    position,
                }
                .of_query());
            }
        }
    }
    Ok(())
}
