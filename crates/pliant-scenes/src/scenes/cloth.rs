//! `cloth`: one sheet that folds onto itself; the scene is made for its self-intersections.
//!
//! With the default size and seed it first touches itself at step 26. From then on the pairs of
//! triangles that intersect and share no vertex grow steadily, to 10,393 at step 50.

use crate::bodies::FoldingSheet;
use crate::error::SceneError;
use crate::rng::Rng;
use crate::scene::{About, Asks, Scene};
use crate::surface::sheet;

const ABOUT: About = About {
    name: "cloth",
    asks: Asks::Itself,
    steps: 50,
};

const STREAM: u64 = 4;

/// Default number of triangles: 200 by 200 vertices.
const TRIANGLES: usize = 79_202;

/// Bend in radians, almost all of it reached in the first third of the steps.
///
/// Together with the part of [`PRESS`] added until then it causes the first contact, at a bend of
/// 2.04, at step 26.
const FOLD: f64 = 1.946;

/// Bend in radians, added evenly over all steps; a hundredth is about a thousand pairs at the end.
const PRESS: f64 = 0.20;

pub(crate) fn scene(triangles: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    let mut rng = Rng::new(seed, STREAM, 0);
    let bodies = std::iter::once(FoldingSheet::new(&mut rng, FOLD, PRESS));
    Scene::assemble(ABOUT, triangles.unwrap_or(TRIANGLES), sheet, bodies)
}
