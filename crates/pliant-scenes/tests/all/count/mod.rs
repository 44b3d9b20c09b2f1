//! Counter of intersecting triangles: one sweep along z, then signs of volumes in `f64`.
//!
//! The plainest method that is fast enough, independent of the library that the scenes are made to
//! test. Not exact: it relies on generic scenes, without a vertex in the plane of a triangle.

use pliant_scenes::{Asks, Scene};

type Point = [f64; 3];

struct Triangle {
    body: usize,
    corners: [u32; 3],
    points: [Point; 3],
    low: Point,
    high: Point,
}

impl Triangle {
    fn new(body: usize, corners: [u32; 3], positions: &[[f32; 3]]) -> Self {
        let points = corners.map(|v| positions[v as usize].map(f64::from));
        let [a, b, c] = points;
        Self {
            body,
            corners,
            points,
            low: std::array::from_fn(|axis| a[axis].min(b[axis]).min(c[axis])),
            high: std::array::from_fn(|axis| a[axis].max(b[axis]).max(c[axis])),
        }
    }

    fn shares_a_vertex_with(&self, other: &Self) -> bool {
        self.corners.iter().any(|v| other.corners.contains(v))
    }

    fn box_meets(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }

    /// Whether an edge of one triangle passes through the other.
    fn intersects(&self, other: &Self) -> bool {
        crosses(&self.points, &other.points) || crosses(&other.points, &self.points)
    }
}

/// Number of pairs of intersecting triangles for which `scene` is made, at `step`.
pub(crate) fn pairs(scene: &Scene, step: u32) -> usize {
    match scene.asks() {
        Asks::BetweenBodies => sweep(scene, step, |a, b| a.body != b.body),
        Asks::Itself => pairs_within_bodies(scene, step),
    }
}

/// Number of pairs of intersecting triangles of one body that share no vertex, over all bodies.
pub(crate) fn pairs_within_bodies(scene: &Scene, step: u32) -> usize {
    sweep(scene, step, |a, b| {
        a.body == b.body && !a.shares_a_vertex_with(b)
    })
}

fn sweep(scene: &Scene, step: u32, wanted: impl Fn(&Triangle, &Triangle) -> bool) -> usize {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for body in 0..scene.body_count() {
        scene.positions(body, step, &mut positions);
        let corners = scene.triangles(body).iter();
        triangles.extend(corners.map(|corners| Triangle::new(body, *corners, &positions)));
    }
    triangles.sort_by(|a, b| a.low[2].total_cmp(&b.low[2]));
    let mut found = 0;
    for (i, first) in triangles.iter().enumerate() {
        let rest = triangles[i + 1..].iter();
        found += rest
            .take_while(|second| second.low[2] <= first.high[2])
            .filter(|second| first.box_meets(second) && wanted(first, second))
            .filter(|second| first.intersects(second))
            .count();
    }
    found
}

/// Whether an edge of `a` passes through `b`.
fn crosses(a: &[Point; 3], b: &[Point; 3]) -> bool {
    let side = a.map(|p| volume(b[0], b[1], b[2], p));
    (0..3).any(|i| {
        let (from, to) = (i, (i + 1) % 3);
        side[from] * side[to] < 0.0 && {
            let round = [0, 1, 2].map(|j| volume(a[from], a[to], b[j], b[(j + 1) % 3]));
            round.iter().all(|v| *v > 0.0) || round.iter().all(|v| *v < 0.0)
        }
    })
}

/// Six times the signed volume of a tetrahedron.
fn volume(a: Point, b: Point, c: Point, d: Point) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| [p[0] - d[0], p[1] - d[1], p[2] - d[2]]);
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
