//! Intersections between the triangles of mesh sequences, checked frame by frame.
//!
//! A *source* is a sequence of meshes: a file or a pattern of files, as `pliant_io` opens it. A
//! [`Check`] reads sources side by side, brings a world to each frame and returns its intersecting
//! pairs. The program `pliant check` and Python's `pliant.check` are layers over it.
//! ```
//! # let folder = format!("pliant-check-front-page-{}", std::process::id());
//! # let folder = std::env::temp_dir().join(folder);
//! # std::fs::create_dir_all(&folder)?;
//! # for (name, z) in [("wing_1.obj", 5), ("wing_2.obj", 0)] {
//! #     let corners = format!("v 0.5 0.25 {}\nv 0.5 0.25 {}\nv 0.5 0.75 {0}\n", z - 1, z + 1);
//! #     std::fs::write(folder.join(name), corners + "f 1 2 3\n")?;
//! # }
//! # std::fs::write(folder.join("ground.obj"), "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n")?;
//! # let arguments = ["wing_*.obj", "ground.obj"];
//! # let arguments = arguments.map(|name| folder.join(name).display().to_string());
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
//!     // A place is a connected region of contact. It keeps its number from frame to frame.
//!     for place in found.places.into_iter().flatten() {
//!         assert_eq!((place.number, place.count, place.first_pair), (0, 1, [0, 0, 1, 0]));
//!     }
//! }
//! // Triangle 0 of body 0 meets triangle 0 of body 1 in the second frame.
//! assert_eq!(pairs, [vec![], vec![[0, 0, 1, 0]]]);
//! // The number of places in the whole check; the second value has the lives of the largest.
//! assert_eq!(check.places().0, 1);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Invariants:
//!
//! - Only the frame being checked is in memory.
//! - No clock is read and nothing is printed.
//! - The same sources and settings give the same answers for any number of threads.
//!
//! # Map
//!
//! | file | idea |
//! |---|---|
//! | `settings.rs` | settings: the question that a check answers |
//! | `check.rs` | the loop over frames |
//! | `opened.rs` | arguments, opened as sources |
//! | `sequence.rs`, `any_world.rs` | sources side by side; their world, of either precision |
//! | `bodies.rs`, `pieces.rs` | bodies of answers; connected components of a mesh |
//! | `filter.rs` | names and groups; which bodies may meet |
//! | `row.rs`, `found.rs`, `remarks.rs` | a pair; the pairs of a frame; remarks about seams |
//! | `interval.rs`, `elements.rs` | impacts between two frames; owners of vertices and edges |
//! | `union_find.rs` | union-find over numbers |
//! | `joined.rs`, `places.rs`, `lives.rs` | vertices joined by hits; places; their lives |
//! | `solid.rs` | closed bodies as solids: what lies inside, how deep places are |
//! | `touching.rs` | places where surfaces only touch |
//! | `baseline.rs` | pairs of an earlier check, which are left out |
//! | `counts.rs` | sums over frames |
//! | `one_point.rs` | refusal of too many coincident point triangles |
//! | `error.rs` | errors, each a message of one line |

mod any_world;
mod baseline;
mod bodies;
mod check;
mod counts;
mod elements;
mod error;
mod filter;
mod found;
mod interval;
mod joined;
mod labels;
mod lives;
mod one_point;
mod opened;
mod pieces;
mod places;
mod remarks;
mod rest;
mod row;
mod sequence;
mod settings;
mod solid;
mod touching;
mod union_find;

pub use any_world::{AnyWorld, NotTaken, double, single};
pub use bodies::BodyFacts;
pub use check::Check;
pub use counts::Counts;
pub use error::Error;
pub use found::{Adjacent, CrossingEdges, Found, Gap, Kinds};
pub use interval::{FirstImpact, Impact, Interval};
pub use joined::Meshes;
pub use lives::{Life, Lives};
pub use places::{BodyThere, Place, Places};
pub use remarks::{AtSeams, Parted};
pub use row::Row;
pub use settings::{Baseline, Frames, Group, LabelFile, Rest, Settings, Split};
pub use solid::{Inside, Nested};
