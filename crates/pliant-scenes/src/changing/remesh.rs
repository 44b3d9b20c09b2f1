//! `remesh`: two overlapping bumpy spheres whose meshes are refined and coarsened without end.
//!
//! At each step some triangles are split in three by a vertex in the middle, and some that were
//! split are collapsed again. Empty numbers are reused, as a simulator would.

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

/// Default number of triangles of a body.
const TRIANGLES: usize = 20_480;

/// Root mean square of the bumps, in radii.
const HEIGHT: f64 = 0.09;

/// Triangles for each one that is split in a step.
const ONE_IN: usize = 205;

/// Steps after which a split triangle is collapsed.
const LIFE: u32 = 20;

/// Distance between the centres along x, in radii.
const DISTANCE: f64 = 1.5;

struct Two {
    bumps: [Bumps; 2],
    /// For each body the rest positions of all vertices that there ever are, each at its first use.
    rest: [Vec<Vec3>; 2],
    /// For each body the reuses of vertex numbers, by step: step, vertex, and its new rest
    /// position.
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

/// A split: old corners, numbers of the triangle and of the two new ones, and the new vertex.
type Split = ([u32; 3], [u32; 3], u32);

/// History of one body's mesh.
struct Life {
    corners: Vec<[u32; 3]>,
    rest: Vec<Vec3>,
    moves: Vec<(u32, u32, Vec3)>,
    /// Empty numbers of triangles; below, of vertices.
    free_triangles: Vec<u32>,
    free_vertices: Vec<u32>,
    /// Splits of the last steps, a list for each.
    splits: VecDeque<Vec<Split>>,
    /// Number of original triangles, which may be split while they are whole.
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

    /// Changes of a step; first, old splits are collapsed.
    fn step(&mut self, step: u32, rng: &mut Rng) -> Vec<Change> {
        let mut changes = Vec::new();
        // Numbers of vertices become empty only when the step is over.
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
