//! The inner loops: a few named functions over N boxes side by side.
//!
//! This is the only folder that will know instruction sets. What stands here now is the plain twin of every kernel, which defines what it means; the
//! lanes are laid out for wide registers already (one array of N floats per axis and side), and compilers vectorise most of them.

mod boxes;

pub(crate) use boxes::{BoxLanes, bits_of};
