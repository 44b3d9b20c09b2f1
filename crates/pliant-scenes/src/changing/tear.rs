//! `tear`: a sheet is torn along a line of edges from one side to the other, and then folds.
//!
//! Every vertex of the wandering line becomes two when the tear reaches it: the triangles on its
//! right take the new one. Until then the sheet only waves. The two lips move apart a little behind
//! the tip. After the tear the sheet folds onto itself as in the scene `cloth`.

use super::change::Change;
use super::scene::{ChangingScene, Rule};
use super::timeline::Timeline;
use crate::bodies::FoldingSheet;
use crate::error::SceneError;
use crate::motion::Moment;
use crate::rng::Rng;
use crate::scene::{About, Asks, Body};
use crate::surface::{Surface, sheet};
use crate::vector::Vec3;
use std::collections::{BTreeMap, BTreeSet};

const ABOUT: About = About {
    name: "tear",
    asks: Asks::Itself,
    steps: 250,
};

const STREAM: u64 = 6;

/// Default number of triangles.
const TRIANGLES: usize = 79_202;

/// Step at which the sheet is torn through.
const TORN: u32 = 200;

/// Bend in radians, as in the scene `cloth`.
const FOLD: f64 = 1.946;

/// Bend in radians, added evenly over all steps.
const PRESS: f64 = 0.20;

/// Progress of the folding motion, from 0 to 1, when the sheet is torn through.
const BEFORE: f64 = 0.03;

/// Displacement of a lip in spaces between vertices, and the number of steps that it takes.
const LIP: (f64, f64) = (0.4, 20.0);

struct TornSheet {
    sheet: FoldingSheet,
    rest: Vec<Vec3>,
    /// For each vertex of the line the vertex that is split from it, and the step of the split.
    lips: Vec<(u32, u32, u32)>,
}

impl Rule for TornSheet {
    fn place(&self, _: usize, now: Moment, out: &mut [[f32; 3]]) {
        let step = now.step;
        let torn = f64::from(TORN);
        let progress = if step <= torn {
            BEFORE * (step - 1.0) / (torn - 1.0)
        } else {
            BEFORE + (1.0 - BEFORE) * (step - torn) / (f64::from(ABOUT.steps) - torn)
        };
        let (of_sheet, new) = out.split_at_mut(self.rest.len());
        let moment = Moment { step, progress };
        self.sheet.place(moment, &self.rest, of_sheet);
        let columns = self.rest.len().isqrt() as u32;
        for &(vertex, split, since) in &self.lips {
            let place = split as usize - self.rest.len();
            if place >= new.len() {
                continue;
            }
            // Along the row, toward the neighbours on either side.
            let part = LIP.0 * ((step - f64::from(since) + 1.0) / LIP.1).clamp(0.0, 1.0);
            let column = vertex % columns;
            let beside = |by: u32| of_sheet[by as usize];
            let at = beside(vertex);
            let left = if column > 0 { beside(vertex - 1) } else { at };
            let right = if column + 1 < columns {
                beside(vertex + 1)
            } else {
                at
            };
            let toward = |other: [f32; 3]| -> [f32; 3] {
                std::array::from_fn(|axis| {
                    let [a, b] = [at[axis], other[axis]].map(f64::from);
                    (a + part / 2.0 * (b - a)) as f32
                })
            };
            new[place] = toward(right);
            of_sheet[vertex as usize] = toward(left);
        }
    }
}

pub(super) fn scene(triangles: Option<usize>, seed: u64) -> Result<ChangingScene, SceneError> {
    let surface = ABOUT.surface(triangles.unwrap_or(TRIANGLES), sheet)?;
    let mut rng = Rng::new(seed, STREAM, 0);
    let line = wandering_line(&mut rng, surface.rest.len().isqrt() as u32);
    let right = right_of(&line, &surface);
    let mut timeline = Timeline::new(vec![surface.rest.len()], ABOUT.steps);
    let mut vertices = surface.rest.len();
    let mut lips = Vec::new();
    let mut reached = 0;
    for step in 1..=TORN {
        let end = (line.len() * step as usize).div_ceil(TORN as usize);
        let mut changes = Vec::new();
        for &vertex in &line[reached..end] {
            let triangles = right[&vertex].clone();
            if triangles.is_empty() {
                continue;
            }
            changes.push(Change::SplitVertex { vertex, triangles });
            lips.push((vertex, vertices as u32, step));
            vertices += 1;
        }
        reached = end;
        timeline.edit(step, 0, changes, vertices);
    }
    Ok(ChangingScene {
        about: ABOUT,
        triangles: vec![surface.triangles],
        timeline,
        rule: Box::new(TornSheet {
            sheet: FoldingSheet::new(&mut rng, FOLD, PRESS),
            rest: surface.rest,
            lips,
        }),
    })
}

/// A path from the middle of the first row to the last row.
///
/// In each row it passes some vertices to one side, then goes up.
fn wandering_line(rng: &mut Rng, columns: u32) -> Vec<u32> {
    let mut column = columns / 2;
    let mut line = vec![column];
    for row in 0..columns - 1 {
        // Never along the first row, which is the side of the sheet.
        let [far, side] = [rng.next() % 2, rng.next() % 2];
        for _ in 0..(if row == 0 { 0 } else { far }) {
            let next = if side == 0 {
                column.saturating_sub(1)
            } else {
                column + 1
            };
            // Nor near the other sides.
            if next > columns / 8 && next < columns - columns / 8 {
                column = next;
                line.push(row * columns + column);
            }
        }
        line.push((row + 1) * columns + column);
    }
    line
}

/// For each vertex of a line from side to side, its triangles on the right.
fn right_of(line: &[u32], surface: &Surface) -> BTreeMap<u32, Vec<u32>> {
    let ends = |pair: &[u32]| [pair[0].min(pair[1]), pair[0].max(pair[1])];
    let of_line: BTreeSet<[u32; 2]> = line.windows(2).map(ends).collect();
    let mut across: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|side| ends(&side));
    for (triangle, &corners) in (0..).zip(&surface.triangles) {
        for side in sides(corners) {
            across.entry(side).or_default().push(triangle);
        }
    }
    // Flood fill from the last triangle, in the last corner of the sheet, without crossing the
    // line.
    let last = surface.triangles.len() - 1;
    let mut is_right = vec![false; surface.triangles.len()];
    is_right[last] = true;
    let mut open = vec![last as u32];
    while let Some(triangle) = open.pop() {
        for side in sides(surface.triangles[triangle as usize]) {
            if of_line.contains(&side) {
                continue;
            }
            for &other in &across[&side] {
                if !std::mem::replace(&mut is_right[other as usize], true) {
                    open.push(other);
                }
            }
        }
    }
    let mut right: BTreeMap<u32, Vec<u32>> = line.iter().map(|&it| (it, Vec::new())).collect();
    for (triangle, corners) in (0..).zip(&surface.triangles) {
        if is_right[triangle as usize] {
            for vertex in corners {
                if let Some(of_vertex) = right.get_mut(vertex) {
                    of_vertex.push(triangle);
                }
            }
        }
    }
    right
}
