//! The inner loops, eight wide: the only folder that knows instruction sets.
//!
//! `level` says which instructions there are. A kernel takes a token `i: impl Simd` that stands for them and is compiled once
//! for each; the caller turns the level into the token (`dispatch!`) round a whole batch of work, never per node. No kernel
//! fuses a multiplication with an addition, and none reorders a sum, so all levels give the same bits: tests compare them, and
//! with plain code that says what each kernel means.
//!
//! ```text
//! take_over   positions of the caller: checked, copied, bounded
//! gather      positions into tree order, and the bounds of every few
//! extent      boxes of points and of triangles
//! boxes       boxes side by side, and which of them overlap
//! find        where a number is among eight
//! bits        the lanes set in a mask, written to a list without branches
//! signs       orientation signs of eight candidates at once, where rounding cannot change them
//! wide        points in registers, and points as lanes
//! ```

pub(crate) mod bits;
mod boxes;
pub(crate) mod extent;
mod find;
pub(crate) mod gather;
mod level;
pub(crate) mod signs;
pub(crate) mod take_over;
mod wide;

pub(crate) use boxes::{BoxLanes, overlap_mask};
pub(crate) use fearless_simd::Level;
pub(crate) use find::find_lane;
#[cfg(test)]
pub(crate) use level::all as all_levels;
pub(crate) use level::widest;
pub(crate) use wide::{Corners, Wide};
