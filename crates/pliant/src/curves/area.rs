//! Area that a closed curve encloses on either of its two sheets.
//!
//! Idea: going across the curve from right to left, a number goes up by one. If the curve bounds a
//! part of a sheet, the vertices have such numbers, up to a constant. They are spread along edges,
//! with a jump where the curve crosses one. Whole triangles count by their vertices. In a triangle
//! that the curve passes, a polygon between it and the outline is added.

use super::linking::{Curve, Step};
use super::segments::normal;
use crate::error::Error;
use crate::ids::BodyId;
use crate::world::{Scalar, World};
use pliant_exact::{End, Feature, Point};
use std::cmp::Ordering::Less;
use std::collections::{HashMap, HashSet};

impl Curve<'_> {
    /// Areas that a closed curve encloses on the sheets of its two sides.
    ///
    /// Ask before the bodies move again: the world must still have the shapes in which the curve
    /// was found.
    ///
    /// A curve that goes around a part of a sheet cuts it in two. The area is that of the smaller
    /// part, rounded. It is positive on the left of the curve, where the normal of the sheet points
    /// up, and negative on the right. What is enclosed twice counts twice. A sheet is all of a mesh
    /// that can be reached along edges.
    ///
    /// None for an open curve, and on a sheet where the curve bounds no part, as around the tube of
    /// a torus. None also if it passes a vertex of the sheet or runs along an edge. None if
    /// triangles that it passes are not oriented alike, stand twice, or have changed since.
    ///
    /// Cost: O(m + n) for the bodies of the curve.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn enclosed_areas<S: Scalar>(&self, world: &World<S>) -> Result<[Option<f64>; 2], Error> {
        let area = |side| {
            let Some(chords) = chords(self, side) else {
                return Ok(None);
            };
            let triangles = world.triangles(chords.body)?;
            let positions = world.positions(chords.body)?;
            let is_there =
                |chord: &Chord| triangles.get(chord.triangle as usize) == Some(&chord.vertices);
            if !chords.all.iter().all(is_there) {
                return Ok(None);
            }
            Ok(chords.enclosed(triangles, &positions))
        };
        Ok([area(0)?, area(1)?])
    }
}

/// A closed curve on one sheet, triangle by triangle.
struct Chords {
    body: BodyId,
    all: Vec<Chord>,
    /// Edges that the curve crosses, the lower vertex first, and how much the number of the higher
    /// is above that of the lower.
    jumps: HashMap<[u32; 2], i64>,
}

/// A way through a triangle, from an edge to an edge; or all around in one triangle.
struct Chord {
    triangle: u32,
    vertices: [u32; 3],
    edges: Option<[usize; 2]>,
    points: Vec<Point>,
}

/// The ways of a closed curve through the triangles of one of its sides. None if it passes edges
/// otherwise than across, or triangles that are not oriented alike.
fn chords(curve: &Curve<'_>, side: usize) -> Option<Chords> {
    if !curve.is_closed() || curve.turns_over() {
        return None;
    }
    let steps = curve.steps();
    let edges = |step: &Step| {
        let edge = |end: End| match end.on[side] {
            Feature::Edge(edge) => Some(Some(edge)),
            Feature::Inside => Some(None),
            Feature::Corner(_) => None,
        };
        let [from, to] = curve.ends_of(step).map(edge);
        Some([from?, to?])
    };
    // Begin where a triangle is entered, if one is.
    let enters = |step: &Step| matches!(edges(step), Some([Some(_), _]));
    let first = steps.iter().position(enters).unwrap_or(0);
    let (body, ..) = curve.sides(steps.first()?)[side];
    let mut all: Vec<Chord> = Vec::new();
    for step in steps[first..].iter().chain(&steps[..first]) {
        let (_, triangle, vertices) = curve.sides(step)[side];
        let [entered, left] = edges(step)?;
        // A segment with both ends on one edge runs along it.
        if entered.is_some() && entered == left {
            return None;
        }
        let [from, to] = curve.ends_of(step);
        if all.is_empty() || entered.is_some() {
            all.push(Chord {
                triangle,
                vertices,
                edges: entered.map(|edge| [edge; 2]),
                points: vec![from.point],
            });
        }
        let chord = all.last_mut()?;
        if let (Some([_, last]), Some(left)) = (&mut chord.edges, left) {
            *last = left;
        }
        chord.points.push(to.point);
    }
    let mut jumps = HashMap::new();
    for (chord, next) in all.iter().zip(all.iter().cycle().skip(1)) {
        let (Some([_, left]), Some([entered, _])) = (chord.edges, next.edges) else {
            continue;
        };
        let [p, q] = edge(&chord.vertices, left);
        if edge(&next.vertices, entered) == [q, p] {
            // On the way out, the far end of an edge is on the left.
            *jumps.entry([p.min(q), p.max(q)]).or_default() += if p < q { 1 } else { -1 };
        } else if chord.triangle != next.triangle || entered != left {
            return None;
        }
    }
    Some(Chords { body, all, jumps })
}

impl Chords {
    /// The area enclosed; none if the curve bounds no part of its sheet.
    fn enclosed<S: Scalar>(&self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Option<f64> {
        let at = |vertex: u32| positions[vertex as usize].map(Scalar::to_f64);
        let mut numbers = Numbers::of(positions.len());
        let mut is_crossed = vec![false; positions.len()];
        for vertex in self.jumps.keys().flatten() {
            is_crossed[*vertex as usize] = true;
        }
        let passed: HashSet<u32> = self.all.iter().map(|chord| chord.triangle).collect();
        let live = || {
            (0..)
                .zip(triangles)
                .filter(|(_, corners)| corners[0] != u32::MAX)
        };
        for (triangle, corners) in live() {
            for [p, q] in (0..3).map(|i| edge(corners, i)) {
                let mut jump = 0;
                if is_crossed[p as usize]
                    && is_crossed[q as usize]
                    && let Some(of_edge) = self.jumps.get(&[p.min(q), p.max(q)])
                {
                    // A triangle at the edge, and not on the way of the curve: it stands twice.
                    if !passed.contains(&triangle) {
                        return None;
                    }
                    jump = of_edge * if p < q { 1 } else { -1 };
                }
                numbers.join([p, q], jump)?;
            }
        }
        let (sheet, _) = numbers.of_vertex(self.all.first()?.vertices[0]);
        let (mut low, mut high, mut enclosed, mut whole) = (i64::MAX, i64::MIN, 0.0, 0.0);
        for (_, corners) in live() {
            let (of, number) = numbers.of_vertex(corners[0]);
            if of == sheet {
                let all = corners.map(|vertex| numbers.of_vertex(vertex).1);
                low = all.iter().fold(low, |low, &it| low.min(it));
                high = all.iter().fold(high, |high, &it| high.max(it));
                let area = area(&corners.map(at), &corners.map(at));
                enclosed += area * number as f64;
                whole += area;
            }
        }
        for chord in &self.all {
            enclosed += chord.cut_off(&at);
        }
        // Numbers are known up to a constant: what is outside has the lowest, or the highest. Where
        // all vertices are in one part, the other has the next number.
        let from = |outside: i64| enclosed - outside as f64 * whole;
        let first = from(low);
        let second = match low.cmp(&high) {
            Less => from(high),
            _ if first > 0.0 => from(low + 1),
            _ => from(low - 1),
        };
        Some(if first.abs() <= second.abs() {
            first
        } else {
            second
        })
    }
}

impl Chord {
    /// Area between it and the outline, away from corner 0; negative on the right.
    fn cut_off(&self, at: &impl Fn(u32) -> Point) -> f64 {
        let corners = self.vertices.map(at);
        let mut outline = self.points.clone();
        if let Some([from, to]) = self.edges {
            if to < from {
                outline.extend(&corners[to + 1..=from]);
            } else {
                outline.extend(corners[from + 1..=to].iter().rev());
            }
        }
        area(&corners, &outline)
    }
}

/// Area of a polygon in the plane of a triangle; negative if it goes around the other way.
fn area(triangle: &[Point; 3], polygon: &[Point]) -> f64 {
    let up = normal(triangle);
    let from = polygon[0];
    let mut twice = 0.0;
    for pair in polygon.windows(2) {
        let [p, q] = [pair[0], pair[1]].map(|point| [0, 1, 2].map(|axis| point[axis] - from[axis]));
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            twice += up[i] * (p[j] * q[k] - p[k] * q[j]);
        }
    }
    twice / 2.0
}

fn edge(vertices: &[u32; 3], i: usize) -> [u32; 2] {
    [vertices[i], vertices[(i + 1) % 3]]
}

/// Numbers of vertices, known up to a constant in each sheet: union-find with differences.
struct Numbers {
    /// The vertex above each, or itself, and how much its number is above that one's.
    above: Vec<(u32, i64)>,
}

impl Numbers {
    fn of(count: usize) -> Self {
        Self {
            above: (0..count as u32).map(|vertex| (vertex, 0)).collect(),
        }
    }

    /// The vertex that stands for the sheet, and how much the number of this one is above its.
    fn of_vertex(&mut self, vertex: u32) -> (u32, i64) {
        let (mut root, mut number) = (vertex, 0);
        loop {
            let (above, more) = self.above[root as usize];
            if above == root {
                break;
            }
            (root, number) = (above, number + more);
        }
        let (mut here, mut rest) = (vertex, number);
        while here != root {
            let (above, more) = self.above[here as usize];
            self.above[here as usize] = (root, rest);
            (here, rest) = (above, rest - more);
        }
        (root, number)
    }

    /// Says that the second number is above the first by so much; none if it is not.
    fn join(&mut self, [p, q]: [u32; 2], more: i64) -> Option<()> {
        let ((root_p, of_p), (root_q, of_q)) = (self.of_vertex(p), self.of_vertex(q));
        if root_p == root_q {
            return (of_q - of_p == more).then_some(());
        }
        self.above[root_q as usize] = (root_p, of_p + more - of_q);
        Some(())
    }
}
