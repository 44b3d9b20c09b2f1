//! Kernels: the inner loops, eight lanes wide; the only folder that knows instruction sets.
//!
//! A kernel takes a token `i: impl Simd` that stands for an instruction set, and is compiled once
//! for each set. Callers turn the chosen set into its token with `dispatch!`, round a whole batch
//! of work and never per node. No kernel fuses a multiplication with an addition, and none reorders
//! a sum, so all sets give the same bits. Tests compare the sets with each other and with plain
//! code that defines each kernel. Kernels use plain loops: a closure in `std::array::map` or
//! `from_fn` may not be inlined, and then it is compiled without the instructions.
//!
//! | module | kernel |
//! |---|---|
//! | `instructions` | detection of instruction sets, and `dispatch!` |
//! | `copy_checked` | the caller's positions: checked, copied, bounded in one pass |
//! | `gather` | positions into tree order, and the bounds of every row of points |
//! | `extent` | bounding boxes of points and of triangles |
//! | `boxes` | boxes in structure-of-arrays order, and which of them overlap |
//! | `capsules` | capsules of what is long and thin, and which are surely apart |
//! | `quantized` | boxes in bytes, and which of them are surely apart |
//! | `signs` | orientation signs of eight candidates, where rounding cannot change them |
//! | `apart` | separating directions of elements in motion |
//! | `closest` | closest points of elements, with lower and upper bounds of the distance |
//! | `gaps` | boxes of elements (vertices, edges, triangles), and which are near each other |
//! | `ring` | the elements of one run, each with each other |
//! | `buffer` | the set bits of a mask, appended to a list without branches |
//! | `stars` | which way the triangles at each vertex face, and whether they go round it once |
//! | `find` | search for a number among eight |
//! | `ranks` | ranks of a few numbers: how many are smaller than each |
//! | `coordinate` | points in registers, and transposed into lanes |

pub(crate) mod apart;
mod boxes;
mod buffer;
mod capsules;
pub(crate) mod closest;
mod coordinate;
mod copy_checked;
pub(crate) mod extent;
mod find;
pub(crate) mod gaps;
mod gather;
mod instructions;
mod quantized;
pub(crate) mod ranks;
pub(crate) mod ring;
pub(crate) mod signs;
mod stars;

pub(crate) use boxes::{
    BoxLanes, EightBoxes, at_most, lanes_overlapping, least_of, near_mask, near_mask_each,
    overlap_mask, priorities,
};
pub(crate) use buffer::Buffer;
pub(crate) use capsules::{EightCapsules, Volumes, cull_by_capsules};
pub(crate) use coordinate::{Coordinate, TrianglePairs};
pub(crate) use copy_checked::{check, copy_checked};
pub(crate) use fearless_simd::Simd;
pub(crate) use find::find_lane;
pub(crate) use gather::gather;
pub use instructions::Instructions;
pub(crate) use instructions::{Set, dispatch, with_baseline};
pub(crate) use quantized::{FARTHEST, QuantizedLanes, QuantizedRows, quantize};
pub(crate) use stars::{
    CLOSED, StarCounts, StarRecord, TOO_MANY, count_stars, mark_overlapping_stars,
};
