//! Surfaces that the scenes deform: constant connectivity, and a shape at rest.
//!
//! Adjacent triangles share vertices. A sphere is closed, with triangles counter-clockwise seen
//! from outside; the triangles of a sheet are counter-clockwise seen from +z.

mod sheet;
mod sphere;

pub(crate) use sheet::sheet;
pub(crate) use sphere::sphere;

use crate::vector::Vec3;

/// Most triangles of a surface: an icosahedron divided ten times.
///
/// Its indices and edges fit `u32` with room to spare; its connectivity takes a quarter of a
/// gigabyte.
pub(crate) const MAX_TRIANGLES: usize = 20 << 20;

/// A triangle mesh at rest.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    /// Vertices on the unit sphere, or on the unit square of z = 0.
    pub(crate) rest: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// The possible sizes nearest to an impossible one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Nearest {
    pub(crate) below: Option<usize>,
    pub(crate) above: Option<usize>,
}

impl Nearest {
    /// The nearest ones among `sizes`, which may be in any order.
    fn among(sizes: impl Iterator<Item = usize> + Clone, asked: usize) -> Self {
        Self {
            below: sizes.clone().filter(|size| *size < asked).max(),
            above: sizes.filter(|size| *size > asked).min(),
        }
    }
}
