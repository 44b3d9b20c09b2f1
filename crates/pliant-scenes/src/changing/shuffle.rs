//! `shuffle`: a body of 1,024 small pieces in a lattice, all of which move to other places of it.
//!
//! Its mesh never changes, but neighbours do not stay neighbours. A tree built at the beginning
//! becomes useless above the pieces.

use super::scene::{ChangingScene, Rule};
use super::timeline::Timeline;
use crate::error::SceneError;
use crate::motion::{Moment, rounded};
use crate::rng::Rng;
use crate::scene::{About, Asks};
use crate::surface::{Nearest, Surface, sphere};
use crate::trig::sin;
use crate::vector::{Vec3, add, between, scale};

const ABOUT: About = About {
    name: "shuffle",
    asks: Asks::Itself,
    steps: 200,
};

const STREAM: u64 = 8;

/// Default number of triangles.
const TRIANGLES: usize = 81_920;

/// Pieces along each axis.
const LATTICE: [usize; 3] = [16, 8, 8];

/// Radius of a piece, in lattice spacings: neighbours overlap a little.
const RADIUS: f64 = 0.53;

/// Amplitude of the change of a radius, and its rate in radians per step.
const BREATH: (f64, f64) = (0.02, 0.1);

/// Step at which the pieces arrive.
const THERE: f64 = 150.0;

struct Pieces {
    /// Vertices of one piece at rest.
    rest: Vec<Vec3>,
    /// For each piece its first and last place, and the phase of its radius.
    ways: Vec<(Vec3, Vec3, f64)>,
}

impl Rule for Pieces {
    fn place(&self, _: usize, now: Moment, out: &mut [[f32; 3]]) {
        let part = ((now.step - 1.0) / (THERE - 1.0)).min(1.0);
        let smooth = part * part * (3.0 - 2.0 * part);
        for (&(from, to, phase), out) in self.ways.iter().zip(out.chunks_mut(self.rest.len())) {
            let centre = between(from, to, smooth);
            let radius = RADIUS + BREATH.0 * sin(phase + BREATH.1 * now.step);
            for (point, out) in self.rest.iter().zip(out) {
                *out = rounded(add(centre, scale(*point, radius)));
            }
        }
    }
}

/// Makes one piece, if a 1,024th of `triangles` is a possible size of a sphere.
fn pieces(triangles: usize) -> Result<Surface, Nearest> {
    let count: usize = LATTICE.iter().product();
    let times = |size: Option<usize>| size.map(|size| size * count);
    let of_one = triangles / count;
    let exact = if triangles == count * of_one {
        of_one
    } else {
        of_one.max(1) + 1
    };
    sphere(exact).map_err(|nearest| Nearest {
        below: times(nearest.below),
        above: times(nearest.above),
    })
}

pub(super) fn scene(triangles: Option<usize>, seed: u64) -> Result<ChangingScene, SceneError> {
    let piece = ABOUT.surface(triangles.unwrap_or(TRIANGLES), pieces)?;
    let mut rng = Rng::new(seed, STREAM, 0);
    let [columns, rows, layers] = LATTICE;
    let mut places = Vec::new();
    for layer in 0..layers {
        for row in 0..rows {
            for column in 0..columns {
                // No two pieces lie exactly beside each other.
                let off: Vec3 = std::array::from_fn(|_| rng.between(-0.02, 0.02));
                places.push(add([column as f64, row as f64, layer as f64], off));
            }
        }
    }
    let mut goals = places.clone();
    for at in (1..goals.len()).rev() {
        goals.swap(at, (rng.next() % (at as u64 + 1)) as usize);
    }
    let ways: Vec<_> = places
        .into_iter()
        .zip(goals)
        .map(|(from, to)| (from, to, rng.angle()))
        .collect();
    let vertices = piece.rest.len();
    let moved = |number: usize| {
        let by = (number * vertices) as u32;
        piece
            .triangles
            .iter()
            .map(move |it| it.map(|vertex| by + vertex))
    };
    let triangles = (0..ways.len()).flat_map(moved).collect();
    Ok(ChangingScene {
        about: ABOUT,
        triangles: vec![triangles],
        timeline: Timeline::new(vec![ways.len() * vertices], ABOUT.steps),
        rule: Box::new(Pieces {
            rest: piece.rest,
            ways,
        }),
    })
}
