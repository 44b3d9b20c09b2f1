//! The inner loops, eight wide: the only folder that knows instruction sets.
//!
//! `instructions` says which there are. A kernel takes a token `i: impl Simd` that stands for them and is compiled once for each set;
//! the caller turns the choice into the token (`dispatch!`) round a whole batch of work, never per node. No kernel fuses a
//! multiplication with an addition, and none reorders a sum, so all sets give the same bits: tests compare them, and with plain
//! code that says what each kernel means. Where a closure goes into `std::array::map` or `from_fn` the compiler may not inline it,
//! and then it is compiled without the instructions: kernels use plain loops.
//!
//! ```text
//! copy_checked  positions of the caller: checked, copied, bounded
//! gather        positions into tree order, and the bounds of every few
//! extent        boxes of points and of triangles
//! boxes         boxes side by side, and which of them overlap
//! apart         whether elements that move stay apart
//! closest       where elements are closest, and between what their distance is
//! gaps          boxes of vertices, edges and triangles, and which of them are near each other
//! ring          the elements of one run, each with each other
//! find          where a number is among eight
//! ranks         how many of few numbers are smaller than each
//! buffer        the lanes set in a mask, written to a list without branches
//! signs         orientation signs of eight candidates at once, where rounding cannot change them
//! coordinate    points in registers, and points as lanes
//! vector        sums and products of vectors, of numbers or of registers
//! quantized     boxes as bytes, and which of them are surely apart
//! ```

pub(crate) mod apart;
mod boxes;
mod buffer;
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
mod vector;

pub(crate) use boxes::{BoxLanes, EightBoxes, near_mask, overlap_mask};
pub(crate) use buffer::Buffer;
pub(crate) use coordinate::{Coordinate, Corners};
pub(crate) use copy_checked::{check, copy_checked};
pub(crate) use fearless_simd::Simd;
pub(crate) use find::find_lane;
pub(crate) use gather::gather;
pub use instructions::Instructions;
pub(crate) use instructions::{Set, dispatch, with_baseline};
pub(crate) use quantized::{FARTHEST, QuantizedLanes, QuantizedRows, quantize};
