//! Whether and how single pairs of triangles intersect.

use super::check;
use crate::error::Error;
use crate::geometry::Real;
use crate::queries::ContactKind;
use crate::world::Scalar;
use pliant_exact::{contact_kind, intersect};

/// Finds whether and how triangles intersect, pair by pair, shape (k, 6, 3): the corners of one,
/// then of the other.
///
/// `None` if they have no point in common as closed sets; else the kind of their contact. Both are
/// decided exactly, as [`World::contacts`](crate::World::contacts) decides them.
///
/// ```
/// # use pliant::ContactKind;
/// let floor = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let tip = |z: f64| [[1.0, 1.0, z], [1.0, 1.0, 9.0], [2.0, 1.0, 9.0]];
/// let pair = |z: f64| [floor[0], floor[1], floor[2], tip(z)[0], tip(z)[1], tip(z)[2]];
/// let kinds = pliant::triangle_contacts(&[1e-300, 0.0, -1e-300].map(pair))?;
/// assert_eq!(kinds, [None, Some(ContactKind::Touching), Some(ContactKind::Crossing)]);
/// # Ok::<(), pliant::Error>(())
/// ```
///
/// Cost, on one thread: some hundred nanoseconds a pair, and some microseconds where rounding hides
/// a sign.
///
/// # Errors
///
/// [`BadCorner`](crate::ErrorKind::BadCorner) for the first coordinate that is NaN, infinite or
/// above `f32::MAX` in magnitude.
pub fn triangle_contacts<S: Scalar>(
    pairs: &[[[S; 3]; 6]],
) -> Result<Vec<Option<ContactKind>>, Error> {
    check(pairs)?;
    let precision = S::PRECISION;
    let kind = |corners: &[[S; 3]; 6]| {
        let [a, b, c, d, e, f] = corners.map(|corner| corner.map(Real::to_f64));
        let (one, other) = ([a, b, c], [d, e, f]);
        intersect(precision, &one, &other, &mut 0).then(|| contact_kind(precision, &one, &other))
    };
    Ok(pairs.iter().map(kind).collect())
}
