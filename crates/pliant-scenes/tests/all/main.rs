//! The tests of the crate, one file a module, in one program: a program each is linked with the whole library each time.
//! One file: `cargo test -p pliant-scenes --test all contacts::`.

mod changing;
mod contacts;
mod count;
mod determinism;
mod interface;
mod poses;
