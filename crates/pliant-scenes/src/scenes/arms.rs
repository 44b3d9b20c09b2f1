//! `arms`: 27 bodies with several deforming arms (the paper's third experiment, its second run).
//!
//! They stand as in the crowd, close enough that arms reach for arms and now and then for the core
//! of a neighbour. Contacts come and go everywhere, between thin parts that boxes bound badly. With
//! the default size and seed, 950 to 1,770 pairs of triangles intersect at every step.

use super::crowd::places;
use crate::bodies::ArmedSphere;
use crate::error::SceneError;
use crate::motion::{Path, Spin};
use crate::rng::Rng;
use crate::scene::{About, Asks, Scene};
use crate::surface::sphere;

const ABOUT: About = About {
    name: "arms",
    asks: Asks::BetweenBodies,
    steps: 200,
};

const STREAM: u64 = 2;

/// Default number of triangles of a body.
const TRIANGLES: usize = 5_120;

/// Distance between neighbours; arms reach about 1.3.
const SPACING: f64 = 1.8;

/// Amplitude of a body's sway along each axis.
const SWAY: f64 = 0.1;

pub(crate) fn scene(triangles: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    let bodies = places(SPACING).zip(0..).map(|(place, body)| {
        let mut rng = Rng::new(seed, STREAM, body);
        let spin = Spin::new(&mut rng, 0.01, 0.03);
        let path = Path::sway(&mut rng, place, SWAY, (60.0, 150.0));
        ArmedSphere::new(&mut rng, spin, path)
    });
    Scene::assemble(ABOUT, triangles.unwrap_or(TRIANGLES), sphere, bodies)
}
