//! Sequences of meshes checked frame by frame: which triangles of which bodies intersect.
//!
//! A [`Check`] reads *sources*, files or patterns of files as `pliant_io` opens them, side by side, brings a world to each frame
//! and says what intersects. The program `pliant check` and Python's `pliant.check` print and hand out what it finds.
//!
//! ```
//! # let folder = format!("pliant-check-front-page-{}", std::process::id());
//! # let folder = std::env::temp_dir().join(folder);
//! # std::fs::create_dir_all(&folder)?;
//! # for (name, z) in [("wing_1.obj", 5), ("wing_2.obj", 0)] {
//! #     let corners = format!("v 0.5 0.25 {}\nv 0.5 0.25 {}\nv 0.5 0.75 {0}\n", z - 1, z + 1);
//! #     std::fs::write(folder.join(name), corners + "f 1 2 3\n")?;
//! # }
//! # std::fs::write(folder.join("ground.obj"), "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n")?;
//! # let arguments = ["wing_*.obj", "ground.obj"].map(|name| folder.join(name).display().to_string());
//! use pliant_check::{Check, Settings};
//! use pliant_io::OpenOptions;
//!
//! // "wing_*.obj", whose files are frames, and "ground.obj", which stands still.
//! let mut settings = Settings::default();
//! settings.places = true;
//! let mut check = Check::open(&arguments, &OpenOptions::default(), &settings)?;
//! let mut pairs = Vec::new();
//! while let Some(found) = check.next_frame()? {
//!     pairs.push(found.pairs);
//!     // What hangs together, the most pairs first; a place keeps its number from frame to frame while it lives.
//!     for place in found.places.into_iter().flatten() {
//!         assert_eq!((place.number, place.count, place.first_pair), (0, 1, [0, 0, 1, 0]));
//!     }
//! }
//! // In the second frame triangle 0 of body 0 and triangle 0 of body 1.
//! assert_eq!(pairs, [vec![], vec![[0, 0, 1, 0]]]);
//! // Of the whole check: how many places there were, and the lives of the largest.
//! assert_eq!(check.places().0, 1);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What always holds: only the frame being checked is in memory; no clock is read and nothing is printed; the same sources and
//! settings give the same answers for any number of threads.
//!
//! # Map
//!
//! | file | idea |
//! |---|---|
//! | `settings.rs` | what is asked |
//! | `check.rs` | the loop |
//! | `opened.rs` | what arguments name |
//! | `sequence.rs`, `any_world.rs` | sources side by side; the world, of either precision, in a frame of theirs |
//! | `bodies.rs`, `pieces.rs` | what an answer calls a body; pieces of a mesh |
//! | `filter.rs` | names and groups; who may meet whom |
//! | `row.rs`, `found.rs`, `remarks.rs` | a pair; those of one frame; what is to be said of them |
//! | `interval.rs`, `elements.rs` | what meets on the way from a frame to the next; whose vertices and edges are |
//! | `union_find.rs` | sets of numbers that are joined |
//! | `joined.rs`, `places.rs`, `lives.rs` | vertices that hits join; places, the same from frame to frame; their lives |
//! | `touching.rs` | places where surfaces touch, and none passes through another |
//! | `baseline.rs` | the pairs of an earlier check, which are left out |
//! | `one_point.rs` | what cannot be checked for the number of pairs |
//! | `error.rs` | one type, one line |

mod any_world;
mod baseline;
mod bodies;
mod check;
mod elements;
mod error;
mod filter;
mod found;
mod interval;
mod joined;
mod lives;
mod one_point;
mod opened;
mod pieces;
mod places;
mod remarks;
mod row;
mod sequence;
mod settings;
mod touching;
mod union_find;

pub use any_world::{AnyWorld, NotTaken, double, single};
pub use bodies::BodyFacts;
pub use check::Check;
pub use error::Error;
pub use found::{Found, Gap, Kinds};
pub use interval::{FirstImpact, Impact, Interval};
pub use joined::Meshes;
pub use lives::{Life, Lives};
pub use places::{BodyThere, Place, Places};
pub use remarks::{AtSeams, Parted};
pub use row::Row;
pub use settings::{Baseline, Frames, Group, Settings, Split};
