//! `cut`: a plane slices a bumpy sphere, and its two pieces part.
//!
//! A triangle that the plane crosses becomes three: a smaller one on the side of one corner, and
//! two on the other side. Every edge that is crossed gets two vertices, one for each side, which
//! coincide until the pieces part.

use super::change::Change;
use super::scene::{ChangingScene, Rule};
use super::timeline::Timeline;
use crate::bumps::{Bumps, LANES};
use crate::error::SceneError;
use crate::motion::{Moment, rounded};
use crate::rng::Rng;
use crate::scene::{About, Asks};
use crate::surface::sphere;
use crate::vector::{Vec3, between, scale};
use std::collections::BTreeMap;

const ABOUT: About = About {
    name: "cut",
    asks: Asks::Itself,
    steps: 200,
};

const STREAM: u64 = 5;

/// Default number of triangles.
const TRIANGLES: usize = 20_480;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.09;

/// Height of the plane, which passes through no vertex.
const PLANE: f64 = 0.0123;

/// Step at which the cut is complete.
const CUT: u32 = 100;

/// Speed of a piece from then on, in radii per step.
const SPEED: f64 = 0.004;

struct Pieces {
    bumps: Bumps,
    /// All vertices that there will ever be, and whether each belongs to the upper piece.
    rest: Vec<Vec3>,
    is_above: Vec<bool>,
}

impl Rule for Pieces {
    fn place(&self, _: usize, now: Moment, out: &mut [[f32; 3]]) {
        let apart = SPEED * (now.step - f64::from(CUT)).max(0.0);
        let sides = self.is_above.chunks(LANES);
        let points = self.rest.chunks(LANES).zip(sides);
        for ((points, sides), out) in points.zip(out.chunks_mut(LANES)) {
            let heights = self.bumps.heights(now.step, points);
            let points = points.iter().zip(sides);
            for (((point, is_above), height), out) in points.zip(heights).zip(out) {
                let mut place = scale(*point, 1.0 + height);
                place[2] += if *is_above { apart } else { -apart };
                *out = rounded(place);
            }
        }
    }
}

fn is_above([_, _, z]: Vec3) -> bool {
    z > PLANE
}

pub(super) fn scene(triangles: Option<usize>, seed: u64) -> Result<ChangingScene, SceneError> {
    let surface = ABOUT.surface(triangles.unwrap_or(TRIANGLES), sphere)?;
    let mut rest = surface.rest.clone();
    let mut sides: Vec<bool> = rest.iter().map(|&point| is_above(point)).collect();
    let mut timeline = Timeline::new(vec![rest.len()], ABOUT.steps);
    let mut of_edges: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    let corners_of = |triangle: u32| surface.triangles[triangle as usize];
    let x = |triangle: u32| {
        let at = corners_of(triangle).map(|vertex| surface.rest[vertex as usize][0]);
        at.iter().sum::<f64>() / 3.0
    };
    for step in 1..=CUT {
        // Position of the blade before and after the step.
        let blade = |step: u32| -1.01 + 2.02 * f64::from(step) / f64::from(CUT);
        let is_reached = |&triangle: &u32| (blade(step - 1)..blade(step)).contains(&x(triangle));
        let before = rest.len();
        let mut changes = Vec::new();
        let mut added = Vec::new();
        for triangle in (0..surface.triangles.len() as u32).filter(is_reached) {
            let Some([alone, next, last]) = alone_first(corners_of(triangle), &surface.rest) else {
                continue;
            };
            let side = usize::from(!is_above(surface.rest[alone as usize]));
            let [p, q] = [next, last].map(|other| {
                let edge = [alone.min(other), alone.max(other)];
                *of_edges.entry(edge).or_insert_with(|| {
                    let [a, b] = edge.map(|vertex| surface.rest[vertex as usize]);
                    let at = between(a, b, (PLANE - a[2]) / (b[2] - a[2]));
                    let first = rest.len() as u32;
                    rest.extend([at; 2]);
                    sides.extend([true, false]);
                    [first, first + 1]
                })
            });
            let other = 1 - side;
            changes.push(Change::SetTriangle {
                triangle,
                corners: [alone, p[side], q[side]],
            });
            added.extend([[p[other], next, last], [p[other], last, q[other]]]);
        }
        if added.is_empty() {
            continue;
        }
        changes.insert(0, Change::AddVertices(rest.len() - before));
        changes.push(Change::AddTriangles(added));
        timeline.edit(step, 0, changes, rest.len());
    }
    let bumps = Bumps::new(&mut Rng::new(seed, STREAM, 0), HEIGHT);
    Ok(ChangingScene {
        about: ABOUT,
        triangles: vec![surface.triangles],
        timeline,
        rule: Box::new(Pieces {
            bumps,
            rest,
            is_above: sides,
        }),
    })
}

/// The corners in order, beginning with the one that is alone on its side of the plane.
///
/// None if all are on one side.
fn alone_first([a, b, c]: [u32; 3], rest: &[Vec3]) -> Option<[u32; 3]> {
    let above = [a, b, c].map(|vertex| is_above(rest[vertex as usize]));
    match above {
        [x, y, z] if x == y && y == z => None,
        [x, y, z] if y == z && x != y => Some([a, b, c]),
        [x, y, z] if x == z && x != y => Some([b, c, a]),
        _ => Some([c, a, b]),
    }
}
