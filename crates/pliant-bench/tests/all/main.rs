//! Tests of the crate, one file a module, in one program: linking the library once saves time.
//!
//! One file: `cargo test -p pliant-bench --test all experiments::`.

mod cores;
mod experiments;
mod older;
mod peers;
mod soak;
