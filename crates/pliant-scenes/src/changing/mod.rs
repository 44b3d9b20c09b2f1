//! Scenes whose meshes change: [`ChangingScene`] and its events.
//!
//! All events are fixed when the scene is made, so events and positions can be asked for in any
//! order. Numbers are stable: removal leaves a number empty, and addition appends a number or
//! reuses an empty one.

mod change;
mod cut;
mod fuse;
mod mesh;
mod remesh;
mod scene;
mod shuffle;
mod tear;
mod timeline;

pub use change::{Change, Event};
pub use mesh::ChangingMesh;
pub use scene::ChangingScene;

use crate::error::SceneError;

impl ChangingScene {
    /// Makes the scene called `name`, with `triangles` triangles per body at the beginning, or a
    /// default.
    ///
    /// Possible sizes are as in [`Scene::new`](crate::Scene::new): `tear` is a sheet, the others
    /// are made of spheres. In `shuffle` each of the 1,024 pieces is a sphere.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownName`], and [`SceneError::ImpossibleSize`] with the nearest possible
    /// sizes.
    pub fn new(name: &str, triangles: Option<usize>, seed: u64) -> Result<Self, SceneError> {
        match name {
            "cut" => cut::scene(triangles, seed),
            "tear" => tear::scene(triangles, seed),
            "fuse" => fuse::scene(triangles, seed),
            "shuffle" => shuffle::scene(triangles, seed),
            "remesh" => remesh::scene(triangles, seed),
            _ => Err(SceneError::UnknownName {
                asked: name.to_owned(),
            }),
        }
    }
}
