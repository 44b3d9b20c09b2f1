//! Scenes whose meshes change: [`ChangingScene`], and what happens in them.
//!
//! What happens is known when the scene is made; after that nothing changes, so events and positions can be asked for in any order.
//! Numbers stay: what goes leaves its number empty, what comes is numbered behind all others, or uses an empty number again.

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
    /// The scene called `name`, with `triangles` triangles a body at the beginning, or the scene's own number. Possible sizes are those of
    /// [`Scene::new`](crate::Scene::new): the sheet is torn, the others are made of spheres; of `shuffle` a piece has a 1,024th of them.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownName`], and [`SceneError::ImpossibleSize`] with the nearest possible sizes.
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
