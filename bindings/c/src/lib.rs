//! The functions of `include/pliant.h`, which documents them.
//!
//! Pointers of the caller are read and written here, and nowhere else in the project.
//!
//! | file | what |
//! |---|---|
//! | `status` | statuses, errors, and what becomes of a panic |
//! | `objects` | objects that the caller holds: made, used, freed |
//! | `arrays` | arrays of numbers, read and written |
//! | `points` | coordinates of the caller, wherever they lie |
//! | `faces` | triangles of the caller, of indices of any size |
//! | `pairs` | functions on single pairs, without a world |
//! | `options` | options, and whose threads work |
//! | `world` | worlds: made, copied, freed; one call at a time |
//! | `bodies` | bodies: shapes, meshes, motions, who meets whom |
//! | `looking` | a world as it is |
//! | `edits` | meshes that change |
//! | `questions` | questions with a list: all hits, the first, a visit, rows |
//! | `hits` | hits in columns |
//! | `answers` | questions with one answer |
//! | `curves` | where pairs meet; each contact once |
//! | `inside` | inside, outside or on closed bodies; what lies inside which |
//! | `closest` | closest points; how deep bodies reach into others |
//! | `changes` | what began and ended since the last list |

mod answers;
mod arrays;
mod bodies;
mod changes;
mod closest;
mod curves;
mod edits;
mod faces;
mod hits;
mod inside;
mod looking;
mod objects;
mod options;
mod pairs;
mod points;
mod questions;
mod status;
mod world;

pub use answers::*;
pub use arrays::PliantList;
pub use bodies::*;
pub use changes::*;
pub use closest::*;
pub use curves::*;
pub use edits::*;
pub use faces::PliantFaces;
pub use hits::{PliantHits, PliantRows};
pub use inside::*;
pub use looking::*;
pub use options::*;
pub use pairs::*;
pub use points::{PliantPoints, PliantScalar};
pub use questions::*;
pub use status::{PliantError, PliantStatus};
pub use world::*;

/// `pliant_version`.
#[unsafe(no_mangle)]
pub extern "C" fn pliant_version() -> u32 {
    let part = |text: &str| text.parse::<u32>().unwrap_or(0);
    let major = part(env!("CARGO_PKG_VERSION_MAJOR"));
    let minor = part(env!("CARGO_PKG_VERSION_MINOR"));
    major << 16 | minor << 8 | part(env!("CARGO_PKG_VERSION_PATCH"))
}
