//! Coordinates and single boxes. Loops over many of them are in `kernels`.
//!
//! All boxes are axis-aligned and closed. A box that only prunes is `f32` and rounded outward,
//! whatever the coordinates are. The types of boxes in the library:
//!
//! | type | holds | where |
//! |---|---|---|
//! | `Bounds<S>` | one box in the caller's scalar, exact | here |
//! | `Aabb` | one box in `f32`; exact for `f32`, rounded outward for `f64` | here |
//! | `RowBounds<S>` | bounds of 32 points in a row, padded | here |
//! | `Extent` | one box in two registers, before it is stored in a lane | `kernels/extent.rs` |
//! | `PaddedBox` | one box, padded to registers of four | `kernels/gaps.rs` |
//! | `BoxLanes<N>` | N boxes as structure of arrays; `EightBoxes` for N = 8 | `kernels/boxes.rs` |
//! | `Capsule` | all points near a segment | here; side by side in `kernels/capsules.rs` |
//! | `Capsules` | beside the boxes of a tree of long thin triangles | `tree/boxes/capsules.rs` |
//! | `QuantizedLanes` | eight boxes in bytes, modulo 256 | `kernels/quantized.rs` |
//! | `NodeLanes` | boxes of all nodes of a tree: a list of `BoxLanes` | `tree/boxes/lanes.rs` |
//! | `BoxSet` | boxes of nodes and triangles of a tree, from one source | `tree/boxes/` |
//! | `NearBoxes` | boxes of vertices, triangles and edges, by runs | `queries/near/` |
//! | `NodeBox<S>` | public: one node's box, for pictures | `bodies/debug_view.rs` |

mod bounds;
mod capsule;
mod points;
mod real;
mod shape;
pub(crate) mod vector;

pub(crate) use bounds::{Aabb, Bounds, Origin};
pub(crate) use capsule::Capsule;
pub(crate) use points::{IN_A_ROW, Points, RowBounds, padded};
pub(crate) use real::{OUTWARD, Real, larger, smaller};
pub(crate) use shape::Shape;
