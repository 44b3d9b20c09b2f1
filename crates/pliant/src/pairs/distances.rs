//! Closest points of single pairs of elements.

use super::{check, padded};
use crate::error::Error;
use crate::kernels::{Instructions, dispatch};
use crate::queries::{ClosestFeatures, closest_of, count, direction, weights};
use crate::threads::Interrupt;
use crate::world::Scalar;
use pliant_exact::distance::Closest;

/// How far two elements are apart, and where they are closest.
///
/// Errors are bounded as for [`CloseVertexTriangle`](crate::CloseVertexTriangle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairDistance {
    /// Distance of the two, in the unit of the positions. It is 0 exactly if they touch.
    pub distance: f64,
    /// Unit vector from the second element to the first. None if they touch.
    pub direction: Option<[f64; 3]>,
    /// Weights of the four corners in the closest points. The weights of either element sum to 1,
    /// up to rounding.
    pub weights: [f64; 4],
    /// Features that hold the closest points, from the weights that are above 0.
    pub features: ClosestFeatures,
}

/// Measures how far vertices and triangles are apart, pair by pair, shape (k, 4, 3): the vertex,
/// then the corners of the triangle.
///
/// ```
/// let corners = [[1.0, 1.0, 2.0], [0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let found = pliant::vertex_triangle_distances(&[corners])?;
/// assert_eq!((found[0].distance, found[0].direction), (2.0, Some([0.0, 0.0, 1.0])));
/// assert_eq!(found[0].weights, [1.0, 0.5, 0.25, 0.25]);
/// # Ok::<(), pliant::Error>(())
/// ```
///
/// Cost, on one thread: some tens of nanoseconds a pair; microseconds where they touch, or where a
/// triangle hardly has an area.
///
/// # Errors
///
/// [`BadCorner`](crate::ErrorKind::BadCorner) for the first coordinate that is NaN, infinite or
/// above `f32::MAX` in magnitude.
#[doc(alias = "point_triangle_distance")]
pub fn vertex_triangle_distances<S: Scalar>(
    pairs: &[[[S; 3]; 4]],
) -> Result<Vec<PairDistance>, Error> {
    distances(false, pairs)
}

/// Measures how far edges are apart, pair by pair, shape (k, 4, 3): both ends of one, then of the
/// other.
///
/// Of parallel edges, which have many closest points, an end of one holds the points found. All
/// else is as for [`vertex_triangle_distances`].
///
/// # Errors
///
/// The errors of [`vertex_triangle_distances`].
#[doc(alias = "edge_edge_distance")]
pub fn edge_edge_distances<S: Scalar>(pairs: &[[[S; 3]; 4]]) -> Result<Vec<PairDistance>, Error> {
    distances(true, pairs)
}

fn distances<S: Scalar>(
    are_edges: bool,
    pairs: &[[[S; 3]; 4]],
) -> Result<Vec<PairDistance>, Error> {
    let mut all = Vec::with_capacity(pairs.len());
    pair_distances(are_edges, pairs, |found| all.push(found))?;
    Ok(all)
}

/// Measures pairs of vertices and triangles or of edges, and shows each to `take`, in order.
///
/// # Errors
///
/// The errors of [`vertex_triangle_distances`]; nothing is shown then.
#[doc(hidden)]
pub fn pair_distances<S: Scalar>(
    are_edges: bool,
    pairs: &[[[S; 3]; 4]],
    mut take: impl FnMut(PairDistance),
) -> Result<(), Error> {
    check(pairs)?;
    let interrupt = Interrupt::default();
    dispatch!(Instructions::widest(), i => {
        for some in pairs.chunks(4) {
            // Lanes that the last group does not fill take its first pair.
            let mut four = [some[0].map(padded); 4];
            for (lane, corners) in some.iter().enumerate() {
                four[lane] = corners.map(padded);
            }
            let corners = [0, 1, 2, 3].map(|lane| four[lane].each_ref());
            let interrupt = &interrupt;
            closest_of(i, are_edges, &corners, some.len(), interrupt, |_, closest: &Closest| {
                let weights = weights(are_edges, closest);
                take(PairDistance {
                    distance: closest.distance,
                    direction: direction(closest),
                    weights,
                    features: ClosestFeatures::of(are_edges, count(&weights)),
                });
            });
        }
    });
    Ok(())
}
