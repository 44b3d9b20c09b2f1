//! The surfaces that the scenes deform: connectivity that never changes, and a shape at rest.
//!
//! Vertices are shared between the triangles round them. A sphere is closed and every triangle
//! turns counter-clockwise seen from outside; a sheet turns counter-clockwise seen from +z.

mod sheet;
mod sphere;

pub(crate) use sheet::sheet;
pub(crate) use sphere::sphere;

use crate::vector::Vec3;

/// No surface has more triangles: an icosahedron divided ten times. Indices and edges of it fit
/// `u32` with room to spare, and its connectivity takes a quarter of a gigabyte.
pub(crate) const MAX_TRIANGLES: usize = 20 << 20;

/// A triangle mesh at rest.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    /// On the unit sphere, or on the unit square of z = 0.
    pub(crate) rest: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// The sizes next to one that is not possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Nearest {
    pub(crate) below: Option<usize>,
    pub(crate) above: Option<usize>,
}

impl Nearest {
    /// Among `sizes`, in any order.
    fn among(sizes: impl Iterator<Item = usize> + Clone, asked: usize) -> Self {
        Self {
            below: sizes.clone().filter(|size| *size < asked).max(),
            above: sizes.filter(|size| *size > asked).min(),
        }
    }
}
