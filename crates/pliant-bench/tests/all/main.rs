//! The tests of the crate, one file a module, in one program: a program each is linked with the whole library each time.
//! One file: `cargo test -p pliant-bench --test all experiments::`.

mod experiments;
mod older;
mod peers;
mod soak;
