//! The functions of `include/pliant.h`, which documents them.
//!
//! Pointers of the caller are read and written here, and nowhere else in the project.
//!
//! | file | what |
//! |---|---|
//! | `status` | statuses, errors, and what becomes of a panic |
//! | `points` | coordinates of the caller, wherever they lie |
//! | `faces` | triangles of the caller, of indices of any size |
//! | `pairs` | functions on single pairs, without a world |
//! | `world` | worlds: bodies, shapes, motions, filters |
//! | `questions` | questions of a world: all hits, the first, a visit |
//! | `hits` | hits in columns |

mod faces;
mod hits;
mod pairs;
mod points;
mod questions;
mod status;
mod world;

pub use faces::PliantFaces;
pub use hits::PliantHits;
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
