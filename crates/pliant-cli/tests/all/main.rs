//! Tests of the crate, one file a module, in one program: linking the library once saves time.
//!
//! One file: `cargo test -p pliant-cli --test all bench::`.

mod adjacent;
mod bench;
mod check;
mod common;
mod convert;
mod crossing;
mod formats;
mod hits;
mod inside;
mod labels;
mod many;
mod memory;
mod messages;
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
