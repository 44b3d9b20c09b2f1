//! All integration tests of the crate as one program, so that the library is linked once.
//!
//! Each file is a module. One file: `cargo test -p pliant-report --test all page::`.

mod page;
mod picture;
