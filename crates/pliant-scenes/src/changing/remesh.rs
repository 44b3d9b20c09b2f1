//! `remesh`: two bumpy spheres that overlap, whose meshes are refined and coarsened without end.
//!
//! Each step some triangles are split in three, each by a vertex in its middle, and some that were are collapsed again. Empty numbers
//! are used again, as a simulator would.

use super::change::Change;
use super::scene::{ChangingScene, Rule};
use super::timeline::Timeline;
use crate::bumps::{Bumps, LANES};
use crate::error::SceneError;
use crate::motion::{Moment, rounded};
use crate::rng::Rng;
use crate::scene::{About, Asks};
use crate::surface::{Surface, sphere};
use crate::vector::{Vec3, add, scale};
use std::collections::VecDeque;

const ABOUT: About = About {
    name: "remesh",
    asks: Asks::BetweenBodies,
    steps: 200,
};

const STREAM: u64 = 9;

/// Triangles of a body unless asked otherwise.
const TRIANGLES: usize = 20_480;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.09;

/// One in so many triangles is split in a step.
const ONE_IN: usize = 205;

/// A triangle that was split is collapsed after so many steps.
const LIFE: u32 = 20;

/// Between the centres along x, in radii.
const DISTANCE: f64 = 1.5;

struct Two {
    bumps: [Bumps; 2],
    /// By step, body by body: what vertices are at rest, all that there ever are. A number that is used again is in another place.
    rest: [Vec<Vec3>; 2],
    /// Of each body when a number is in which place from then on, in order of steps.
    moves: [Vec<(u32, u32, Vec3)>; 2],
}

impl Rule for Two {
    fn place(&self, body: usize, now: Moment, out: &mut [[f32; 3]]) {
        let mut rest = self.rest[body][..out.len()].to_vec();
        for &(step, vertex, place) in &self.moves[body] {
            if f64::from(step) > now.step {
                break;
            }
            if let Some(rest) = rest.get_mut(vertex as usize) {
                *rest = place;
            }
        }
        let side = if body == 0 {
            -DISTANCE / 2.0
        } else {
            DISTANCE / 2.0
        };
        for (points, out) in rest.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let heights = self.bumps[body].heights(now.step, points);
            for ((point, height), out) in points.iter().zip(heights).zip(out) {
                *out = rounded(add([side, 0.0, 0.0], scale(*point, 1.0 + height)));
            }
        }
    }
}

/// A triangle that was split: its corners, its number and those of the two that came, the vertex that came.
type Split = ([u32; 3], [u32; 3], u32);

/// The life of one body's mesh.
struct Life {
    corners: Vec<[u32; 3]>,
    rest: Vec<Vec3>,
    moves: Vec<(u32, u32, Vec3)>,
    /// Numbers that are empty.
    free_triangles: Vec<u32>,
    free_vertices: Vec<u32>,
    /// By step.
    splits: VecDeque<Vec<Split>>,
    /// Those at the beginning, which may be split while they are whole.
    originals: usize,
    is_split: Vec<bool>,
}

impl Life {
    fn of(surface: &Surface) -> Self {
        Self {
            corners: surface.triangles.clone(),
            rest: surface.rest.clone(),
            moves: Vec::new(),
            free_triangles: Vec::new(),
            free_vertices: Vec::new(),
            splits: VecDeque::new(),
            originals: surface.triangles.len(),
            is_split: vec![false; surface.triangles.len()],
        }
    }

    /// What happens in a step. First what was split long ago is collapsed.
    fn step(&mut self, step: u32, rng: &mut Rng) -> Vec<Change> {
        let mut changes = Vec::new();
        // A vertex is empty once the step is over.
        let mut empty = Vec::new();
        if self.splits.len() >= LIFE as usize {
            let old = self.splits.pop_front().unwrap_or_default();
            let mut gone = Vec::new();
            for (corners, [triangle, second, third], vertex) in old {
                changes.push(Change::SetTriangle { triangle, corners });
                gone.extend([second, third]);
                empty.push(vertex);
                self.is_split[triangle as usize] = false;
            }
            self.free_triangles.extend(&gone);
            if !gone.is_empty() {
                changes.push(Change::RemoveTriangles(gone));
            }
        }
        let mut new = Vec::new();
        for _ in 0..(self.originals / ONE_IN).max(1) {
            let triangle = (rng.next() % self.originals as u64) as u32;
            if !std::mem::replace(&mut self.is_split[triangle as usize], true) {
                new.push(self.split(step, triangle, &mut changes));
            }
        }
        self.splits.push_back(new);
        self.free_vertices.extend(empty);
        changes
    }

    fn split(&mut self, step: u32, triangle: u32, changes: &mut Vec<Change>) -> Split {
        let corners = self.corners[triangle as usize];
        let [a, b, c] = corners;
        let middle = corners.iter().fold([0.0; 3], |sum, &vertex| {
            add(sum, self.rest[vertex as usize])
        });
        let middle = scale(middle, 1.0 / 3.0);
        let vertex = if let Some(vertex) = self.free_vertices.pop() {
            changes.push(Change::PlaceVertex(vertex));
            self.moves.push((step, vertex, middle));
            vertex
        } else {
            changes.push(Change::AddVertices(1));
            self.rest.push(middle);
            self.rest.len() as u32 - 1
        };
        changes.push(Change::SetTriangle {
            triangle,
            corners: [a, b, vertex],
        });
        let mut come = |corners: [u32; 3]| {
            if let Some(triangle) = self.free_triangles.pop() {
                changes.push(Change::SetTriangle { triangle, corners });
                triangle
            } else {
                changes.push(Change::AddTriangles(vec![corners]));
                self.corners.push(corners);
                self.corners.len() as u32 - 1
            }
        };
        let numbers = [triangle, come([b, c, vertex]), come([c, a, vertex])];
        (corners, numbers, vertex)
    }
}

pub(super) fn scene(triangles: Option<usize>, seed: u64) -> Result<ChangingScene, SceneError> {
    let surface = ABOUT.surface(triangles.unwrap_or(TRIANGLES), sphere)?;
    let mut timeline = Timeline::new(vec![surface.rest.len(); 2], ABOUT.steps);
    let lives = [0, 1].map(|body: usize| {
        let mut rng = Rng::new(seed, STREAM, body as u64);
        let mut life = Life::of(&surface);
        for step in 1..=ABOUT.steps {
            let changes = life.step(step, &mut rng);
            timeline.edit(step, body, changes, life.rest.len());
        }
        (Bumps::new(&mut rng, HEIGHT), life)
    });
    let [(bumps_a, a), (bumps_b, b)] = lives;
    Ok(ChangingScene {
        about: ABOUT,
        triangles: vec![surface.triangles; 2],
        timeline,
        rule: Box::new(Two {
            bumps: [bumps_a, bumps_b],
            rest: [a.rest, b.rest],
            moves: [a.moves, b.moves],
        }),
    })
}
