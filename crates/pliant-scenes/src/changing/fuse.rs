//! `fuse`: two bumpy spheres meet, merge and go on as one.
//!
//! The second is the mirror image of the first in a plane between them. They move into each other.
//! When they merge, the caps inside the other sphere are removed, and the two rims become one, in
//! the plane.

use super::change::Change;
use super::scene::{ChangingScene, Rule};
use super::timeline::Timeline;
use crate::bumps::{Bumps, LANES};
use crate::error::SceneError;
use crate::motion::{Moment, rounded};
use crate::rng::Rng;
use crate::scene::{About, Asks};
use crate::surface::sphere;
use crate::vector::{Vec3, scale};

const ABOUT: About = About {
    name: "fuse",
    asks: Asks::BetweenBodies,
    steps: 200,
};

const STREAM: u64 = 7;

/// Default number of triangles of a body.
const TRIANGLES: usize = 20_480;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.06;

/// Step at which they merge.
const MERGED: u32 = 100;

/// Distance of the rim from the centre of its sphere, in radii.
const RIM: f64 = 0.8;

/// Distance of the centres from the plane at the first step, at the merge and at the last step.
const CENTRES: [f64; 3] = [1.5, 0.8, 0.6];

struct Mirrored {
    bumps: Bumps,
    rest: Vec<Vec3>,
    /// Whether a vertex is on the rim.
    is_rim: Vec<bool>,
}

impl Mirrored {
    /// Positions of the first sphere, on the lower side of the plane x = 0, or of its mirror image.
    fn one(&self, now: Moment, side: f64, out: &mut [[f32; 3]]) {
        let merged = f64::from(MERGED);
        let [first, then, last] = CENTRES;
        let centre = if now.step < merged {
            first + (then - first) * (now.step - 1.0) / (merged - 1.0)
        } else {
            then + (last - then) * (now.step - merged) / (f64::from(ABOUT.steps) - merged)
        };
        for (place, (points, out)) in (0..).zip(self.rest.chunks(LANES).zip(out.chunks_mut(LANES)))
        {
            let heights = self.bumps.heights(now.step, points);
            for (lane, ((point, height), out)) in points.iter().zip(heights).zip(out).enumerate() {
                let [x, y, z] = scale(*point, 1.0 + height);
                let is_joined = now.step >= merged && self.is_rim[place * LANES + lane];
                let x = if is_joined { 0.0 } else { side * (x - centre) };
                *out = rounded([x, y, z]);
            }
        }
    }
}

impl Rule for Mirrored {
    fn place(&self, body: usize, now: Moment, out: &mut [[f32; 3]]) {
        if out.len() > self.rest.len() {
            let (first, second) = out.split_at_mut(self.rest.len());
            self.one(now, 1.0, first);
            self.one(now, -1.0, second);
        } else {
            self.one(now, if body == 0 { 1.0 } else { -1.0 }, out);
        }
    }
}

pub(super) fn scene(triangles: Option<usize>, seed: u64) -> Result<ChangingScene, SceneError> {
    let surface = ABOUT.surface(triangles.unwrap_or(TRIANGLES), sphere)?;
    let vertices = surface.rest.len();
    let count = surface.triangles.len() as u32;
    let is_beyond = |vertex: u32| surface.rest[vertex as usize][0] > RIM;
    let is_of_cap = |corners: &[u32; 3]| corners.iter().any(|&vertex| is_beyond(vertex));
    let mut is_rim = vec![false; vertices];
    let mut caps = Vec::new();
    for (triangle, corners) in (0..).zip(&surface.triangles) {
        if is_of_cap(corners) {
            caps.extend([triangle, count + triangle]);
            for &vertex in corners {
                is_rim[vertex as usize] |= !is_beyond(vertex);
            }
        }
    }
    caps.sort_unstable();
    let mut timeline = Timeline::new(vec![vertices; 2], ABOUT.steps);
    timeline.fuse(MERGED, 0, 1);
    let rim = (0..vertices as u32).filter(|&vertex| is_rim[vertex as usize]);
    let joined = rim.map(|vertex| Change::MergeVertices {
        kept: vertex,
        gone: vertices as u32 + vertex,
    });
    let changes = std::iter::once(Change::RemoveTriangles(caps)).chain(joined);
    timeline.edit(MERGED, 0, changes.collect(), 2 * vertices);
    // Mirroring reverses the orientation of triangles.
    let mirrored = surface.triangles.iter().map(|&[a, b, c]| [a, c, b]);
    Ok(ChangingScene {
        about: ABOUT,
        triangles: vec![surface.triangles.clone(), mirrored.collect()],
        timeline,
        rule: Box::new(Mirrored {
            bumps: Bumps::new(&mut Rng::new(seed, STREAM, 0), HEIGHT),
            rest: surface.rest,
            is_rim,
        }),
    })
}
