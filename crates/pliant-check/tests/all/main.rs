//! All integration tests of the crate as one program, so that the library is linked once.
//!
//! Each file is a module. One file: `cargo test -p pliant-check --test all against_worlds::`.

mod against_worlds;
mod changing;
mod curves;
mod formats;
mod groups;
mod messages;
mod places;
mod settings;
mod swept;
