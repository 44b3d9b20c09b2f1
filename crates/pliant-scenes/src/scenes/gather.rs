//! `gather`: many bodies move from far starts to one goal point (the paper's figure 6).
//!
//! If all reached the point, every body would intersect every other, and a thousand bodies would
//! have hundreds of millions of pairs. So each moves straight toward the goal and stops at its own
//! point of a jittered cubic lattice, equally dense for any number of bodies. Its start lies on the
//! same ray, farther out, so that the first steps are without contact. With the defaults, bodies
//! first touch at step 135 and have 19,110 pairs at step 200.

use crate::bodies::BumpySphere;
use crate::bumps::Bumps;
use crate::error::SceneError;
use crate::limits::MAX_BODIES;
use crate::motion::{Path, Spin};
use crate::rng::Rng;
use crate::scene::{About, Asks, Scene};
use crate::surface::sphere;
use crate::vector::{Vec3, add, dot, scale};

const ABOUT: About = About {
    name: "gather",
    asks: Asks::BetweenBodies,
    steps: 200,
};

const STREAM: u64 = 3;

/// Stream of random numbers for the places; no body uses it.
const PLACES: u64 = u64::MAX;

/// Default number of bodies.
const BODIES: usize = 64;

/// Default number of triangles of a body.
const TRIANGLES: usize = 1_280;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.09;

/// Lattice spacing at the goal in radii, before the jitter.
const SPACING: f64 = 1.6;

/// Displacement of a place along each axis, in radii.
const JITTER: f64 = 0.15;

/// Factor between the distances of start and place from the goal.
///
/// Neighbours are at least 1.3 radii apart, so they start at least 3.2 apart, and bumps seldom
/// stand out more than 0.3.
const STRETCH: f64 = 2.5;

/// Additional distance of the start in radii, which spreads out bodies that stop near the goal.
const FARTHER: f64 = 3.0;

pub(crate) fn scene(
    bodies: Option<usize>,
    triangles: Option<usize>,
    seed: u64,
) -> Result<Scene, SceneError> {
    let bodies = bodies.unwrap_or(BODIES);
    if !(1..=MAX_BODIES).contains(&bodies) {
        return Err(SceneError::ImpossibleBodyCount { asked: bodies });
    }
    let bodies = places(bodies, seed)
        .into_iter()
        .zip(0..)
        .map(|(place, body)| {
            let mut rng = Rng::new(seed, STREAM, body);
            BumpySphere {
                bumps: Bumps::new(&mut rng, HEIGHT),
                spin: Spin::new(&mut rng, 0.01, 0.03),
                path: Path::Straight {
                    from: start(place),
                    to: place,
                },
            }
        });
    Scene::assemble(ABOUT, triangles.unwrap_or(TRIANGLES), sphere, bodies)
}

/// The `bodies` places nearest to the goal, which is the origin, nearest first.
///
/// More bodies only add places.
fn places(bodies: usize, seed: u64) -> Vec<Vec3> {
    let mut rng = Rng::new(seed, STREAM, PLACES);
    // The goal is no point of the lattice, so that it is not the middle of a body.
    let shift: Vec3 = std::array::from_fn(|_| rng.between(0.25, 0.75));
    // A ball of this radius, without its rim, holds more lattice points than there are bodies.
    let radius = 2
        + (1..=bodies)
            .find(|r| 4 * r.pow(3) >= bodies)
            .unwrap_or(bodies);
    let axis = || (0..=2 * radius).map(|i| i as f64 - radius as f64);
    let mut places: Vec<Vec3> = axis()
        .flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])))
        .map(|cell| scale(add(cell, shift), SPACING))
        .collect();
    places.sort_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)));
    places.truncate(bodies);
    for place in &mut places {
        *place = place.map(|x| x + rng.between(-JITTER, JITTER));
    }
    places
}

/// The start: a point on the ray from the goal through `place`.
fn start(place: Vec3) -> Vec3 {
    let distance = dot(place, place).sqrt();
    scale(place, STRETCH + FARTHER / distance)
}
