//! The tests of the crate, one file a module, in one program: a program each is linked with the whole library each time.
//! One file: `cargo test -p pliant-cli --test all bench::`.

mod bench;
mod check;
mod common;
mod convert;
mod crossing;
mod formats;
mod hits;
mod memory;
mod names;
mod outputs;
mod parting;
mod people;
mod real_meshes;
mod repeatable;
mod report;
mod run;
mod sizes;
mod strange_formats;
mod strange_places;
mod strangers;
mod streams;
mod surfaces;
mod swept;
mod who_meets;
mod within;
