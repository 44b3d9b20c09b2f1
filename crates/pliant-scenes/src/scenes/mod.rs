//! The five scenes, one a file: number, shape and motion of their bodies.

mod arms;
mod cloth;
mod crowd;
mod gather;
mod spheres;

use crate::error::SceneError;
use crate::scene::Scene;

impl Scene {
    /// Makes the scene called `name`, with `triangles` triangles per body or a default.
    ///
    /// Bodies made of spheres can have 4, 8 or 20 times any power of four. The cloth can have twice
    /// any square. The limit is [`MAX_TRIANGLES`](Self::MAX_TRIANGLES).
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownName`], and [`SceneError::ImpossibleSize`] with the nearest possible
    /// sizes.
    ///
    /// ```
    /// use pliant_scenes::Scene;
    ///
    /// let error = Scene::new("spheres", Some(20_000), 0).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "a body of scene `spheres` cannot have 20000 triangles; \
    ///      the nearest possible numbers are 16384 and 20480",
    /// );
    /// ```
    pub fn new(name: &str, triangles: Option<usize>, seed: u64) -> Result<Self, SceneError> {
        match name {
            "spheres" => spheres::scene(triangles, seed),
            "crowd" => crowd::scene(triangles, seed),
            "arms" => arms::scene(triangles, seed),
            "gather" => gather::scene(None, triangles, seed),
            "cloth" => cloth::scene(triangles, seed),
            _ => Err(SceneError::UnknownName {
                asked: name.to_owned(),
            }),
        }
    }

    /// Makes the scene `gather` with any number of bodies, of `triangles` triangles each.
    ///
    /// They gather equally densely for any number: a body meets its neighbours, not all the others.
    /// Shape and motion of a body do not depend on the number of bodies.
    ///
    /// # Errors
    ///
    /// [`SceneError::ImpossibleBodyCount`] for none or more than [`MAX_BODIES`](Self::MAX_BODIES),
    /// and [`SceneError::ImpossibleSize`].
    pub fn gather(bodies: usize, triangles: usize, seed: u64) -> Result<Self, SceneError> {
        gather::scene(Some(bodies), Some(triangles), seed)
    }
}
