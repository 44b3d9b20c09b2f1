//! Deforming scenes to test and measure collision detection with.
//!
//! A [`Scene`] is a pure function of its name, size, step and seed. It reads no clock, no file and
//! no platform mathematics: its positions are the same bits on every machine. The first four follow
//! the experiments of Larsson and Akenine-Möller, *Collision Detection for Continuously Deforming
//! Bodies* (2001).
//!
//! | name | bodies | triangles each | steps | what happens |
//! |---|---|---|---|---|
//! | `spheres` | 2 | 20,480 | 200 | two bumpy spheres move into each other; contact from step 60 |
//! | `crowd` | 27 | 5,120 | 200 | bumpy spheres jostle each other at every step |
//! | `arms` | 27 | 5,120 | 200 | bodies reach into each other with seven arms, at every step |
//! | `gather` | 64 | 1,280 | 200 | bumpy spheres move to one goal; contact from step 135 |
//! | `cloth` | 1 | 79,202 | 50 | a sheet folds onto itself; contact from step 26 |
//!
//! Size and number are defaults: [`Scene::new`] takes the triangles of a body, [`Scene::gather`]
//! any number of bodies. All bodies of a scene share one connectivity, which never changes. In a
//! [`ChangingScene`] it does: `cut`, `tear`, `fuse`, `shuffle`, `remesh`. Meshes of long thin
//! triangles are in [`thin`].
//!
//! ```
//! use pliant_scenes::{Asks, Scene};
//!
//! let cloth = Scene::new("cloth", None, Scene::DEFAULT_SEED)?;
//! assert_eq!(cloth.asks(), Asks::Itself);
//! assert_eq!(cloth.triangles(0).len(), 79_202);
//!
//! let mut positions = Vec::new();
//! cloth.positions(0, 26, &mut positions);
//! assert_eq!(positions.len(), 200 * 200);
//! # Ok::<(), pliant_scenes::SceneError>(())
//! ```

// From the public interface down to the arithmetic.
mod changing;
mod error;
mod limits;
mod scene;
mod scenes;

mod bodies;
mod bumps;
mod motion;
mod surface;
pub mod thin;

mod rng;
mod trig;
mod vector;

pub use changing::{Change, ChangingMesh, ChangingScene, Event};
pub use error::SceneError;
pub use motion::Pose;
pub use scene::{Asks, Scene};
