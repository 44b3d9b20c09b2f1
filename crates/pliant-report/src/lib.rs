//! Reports of queries and their results: an HTML page, pictures and charts.
//!
//! A [`Recorder`] is shown a world frame by frame and keeps what a page can hold. It keeps bodies
//! in motion, rounded and, with too many frames, thinned out. It keeps intersecting triangles, and
//! the boxes that the trees made. A [`Report`] puts motions and charts together and becomes a page,
//! which needs no server and no network. [`picture`] draws one frame without a browser,
//! [`Chart::svg`] a chart for a paper.
//!
//! The page's viewer is built from `web/` and checked in under `assets/`.
//!
//! ```
//! use pliant::World;
//! use pliant_report::{Play, Recorder, Report};
//!
//! let mut world = World::<f32>::new();
//! let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let across = triangle.map(|[x, y, z]| [z + 0.2, x, y - 0.5]);
//! for positions in [triangle, across] {
//!     world.add(&[[0, 1, 2]], &positions)?;
//! }
//! let mut recorder = Recorder::new(Vec::new());
//! let pairs = [[0, 0, 1, 0]];
//! recorder.frame(0, &world, &pairs);
//!
//! let mut report = Report::new("two triangles");
//! report.add(Play::new("two triangles", "frame"), recorder.finish());
//! assert!(report.page().contains("two triangles"));
//! # Ok::<(), pliant::Error>(())
//! ```

#![expect(
    clippy::cast_sign_loss,
    reason = "samples, colours and steps of positions are not negative"
)]

/// Mark near the beginning of every file that the program writes. A file with it may be
/// overwritten.
pub const MARK: &str = "written by pliant";

mod chart;
mod colours;
mod escape;
mod frames;
mod label;
mod lines;
mod pack;
mod page;
pub mod picture;
mod recorder;
mod report;

pub use chart::{Chart, Series};
pub use frames::{Contact, Elements, Gap, Moment, Motion, Spot};
pub use label::{BodyLabel, Parts};
pub use recorder::Recorder;
pub use report::{Play, Report};
