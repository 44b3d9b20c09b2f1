//! All integration tests of the crate in one program, since each program is linked separately.
//!
//! One file: `cargo test -p pliant-io --test all caches::`.

mod caches;
mod changes;
mod common;
mod evaluated;
mod gltf;
mod groups;
mod hostile;
mod lenient;
mod n_of_m;
mod npz;
mod real_files;
mod rewind;
mod sequences;
mod strange_archives;
mod strange_gltf;
mod welding;
mod writing;
