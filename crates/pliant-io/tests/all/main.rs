//! The tests of the crate, one file a module, in one program: a program each is linked with the whole library each time.
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
