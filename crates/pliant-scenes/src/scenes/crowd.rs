//! `crowd`: 27 bumpy spheres that jostle each other all the time (the paper's third experiment).
//!
//! They stand three by three by three, a little more than a diameter apart, so that a body touches
//! its neighbours with its bumps. The paper keeps them apart by a simple collision response. Here
//! each sways about its place, which needs no state between steps. With the default size and seed,
//! 2,000 to 2,650 pairs of triangles intersect at every step.

use crate::bodies::BumpySphere;
use crate::bumps::Bumps;
use crate::error::SceneError;
use crate::motion::{Path, Spin};
use crate::rng::Rng;
use crate::scene::{About, Asks, Scene};
use crate::surface::sphere;
use crate::vector::Vec3;

const ABOUT: About = About {
    name: "crowd",
    asks: Asks::BetweenBodies,
    steps: 200,
};

/// Stream of random numbers with the steadiest number of pairs among four hundred.
///
/// That holds with the default seed. Others have about the same mean and range from 1,500 to 3,250.
const STREAM: u64 = 248;

/// Default number of triangles of a body.
const TRIANGLES: usize = 5_120;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.09;

/// Distance between neighbours, in radii. A hundredth less is 150 pairs more.
const SPACING: f64 = 2.112;

/// Amplitude of a body's sway along each axis, in radii.
const SWAY: f64 = 0.06;

pub(crate) fn scene(triangles: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    let bodies = places(SPACING).zip(0..).map(|(place, body)| {
        let mut rng = Rng::new(seed, STREAM, body);
        BumpySphere {
            bumps: Bumps::new(&mut rng, HEIGHT),
            spin: Spin::new(&mut rng, 0.01, 0.03),
            path: Path::sway(&mut rng, place, SWAY, (60.0, 150.0)),
        }
    });
    Scene::assemble(ABOUT, triangles.unwrap_or(TRIANGLES), sphere, bodies)
}

/// Three by three by three places, `spacing` apart, round the origin.
pub(crate) fn places(spacing: f64) -> impl Iterator<Item = Vec3> {
    (0..27).map(move |i| [i % 3, i / 3 % 3, i / 9].map(|n| f64::from(n - 1) * spacing))
}
