//! All integration tests of the crate in one program, since each program is linked separately.
//!
//! One file: `cargo test -p pliant-scenes --test all contacts::`.

mod changing;
mod contacts;
mod count;
mod determinism;
mod interface;
mod poses;
