//! `spheres`: two bumpy spheres move slowly into each other (the paper's first experiment).
//!
//! With the default size and seed they first touch at step 60, and 3,742 pairs of triangles
//! intersect at step 200. The paper has 60 and 3,760. The bumps matter: two smooth spheres meet in
//! one circle, with 600 to 750 pairs. The motion is the same for every size, as in the paper's
//! Table 1. So is the first contact: step 60 from 5,120 triangles on, 61 with 1,280.

use crate::bodies::BumpySphere;
use crate::bumps::Bumps;
use crate::error::SceneError;
use crate::motion::{Path, Spin};
use crate::rng::Rng;
use crate::scene::{About, Asks, Scene};
use crate::surface::sphere;

const ABOUT: About = About {
    name: "spheres",
    asks: Asks::BetweenBodies,
    steps: 200,
};

const STREAM: u64 = 0;

/// Default number of triangles of a body.
const TRIANGLES: usize = 20_480;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.09;

/// Distance between the centres along x, in radii, at the first and the last step.
const DISTANCE: (f64, f64) = (3.13, 0.198);

/// Offset of the second body in y and z, in radii, so that the bodies do not meet head on.
const OFFSET: [f64; 2] = [0.04, 0.02];

pub(crate) fn scene(triangles: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    let sides = [(-0.5, [0.0, 0.0]), (0.5, OFFSET)];
    let bodies = sides.into_iter().zip(0..).map(|((side, [y, z]), body)| {
        let mut rng = Rng::new(seed, STREAM, body);
        let bumps = Bumps::new(&mut rng, HEIGHT);
        // A constant rotation of the second body: the two meshes must not be aligned.
        let spin = if body == 0 {
            Spin::NONE
        } else {
            Spin::new(&mut rng, 0.0, 0.0)
        };
        let at = |distance: f64| [side * distance, y, z];
        BumpySphere {
            bumps,
            spin,
            path: Path::Straight {
                from: at(DISTANCE.0),
                to: at(DISTANCE.1),
            },
        }
    });
    Scene::assemble(ABOUT, triangles.unwrap_or(TRIANGLES), sphere, bodies)
}
