//! The tests of the crate, one file a module, in one program: a program each is linked with the whole library each time.
//! One file: `cargo test -p pliant-check --test all against_worlds::`.

mod against_worlds;
mod changing;
mod formats;
mod groups;
mod messages;
mod places;
mod settings;
mod swept;
