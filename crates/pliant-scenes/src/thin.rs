//! Meshes of long thin triangles, and two of good ones to compare them with.
//!
//! Each is two units wide, round the origin. As CAD makes them: lids of cylinders as fans, ribbons
//! as strips, sides of cylinders as tubes. Turned against the axes, the box of a needle is mostly
//! empty.

use crate::trig::{cos, sin};
use std::f64::consts::TAU;

/// A mesh: triangles, and positions of the vertices.
pub type Mesh = (Vec<[u32; 3]>, Vec<[f32; 3]>);

/// A disc with `corners` corners, at least 3, as a fan of triangles from one of them.
pub fn fan(corners: u32) -> Mesh {
    let positions = (0..corners).map(|corner| on_circle(corner, corners, 1.0, 0.0));
    let triangles = (1..corners - 1).map(|corner| [0, corner, corner + 1]);
    (triangles.collect(), positions.collect())
}

/// A square of `needles` needles, an even number, side by side.
pub fn strip(needles: u32) -> Mesh {
    let rows = needles / 2;
    let row = |row: u32| {
        let y = row as f32 / rows as f32 * 2.0 - 1.0;
        [[-1.0, y, 0.0], [1.0, y, 0.0]]
    };
    let triangles = (0..2 * rows).map(|first| [first, first + 1, first + 2]);
    (triangles.collect(), (0..=rows).flat_map(row).collect())
}

/// The side of a cylinder of half the width, of `facets` facets, at least 3, of two needles each.
pub fn tube(facets: u32) -> Mesh {
    let last = 2 * facets;
    let triangles = (0..last).map(|first| [first, (first + 1) % last, (first + 2) % last]);
    let facet = |facet: u32| [-1.0, 1.0].map(|z| on_circle(facet, facets, 0.5, z));
    (triangles.collect(), (0..facets).flat_map(facet).collect())
}

/// A disc of `rings` rings round its middle, 6 `rings`² nearly regular triangles.
pub fn rings(rings: u32) -> Mesh {
    // A ring of number r has 6 r vertices; 1 + 3 r (r - 1) are within it.
    let vertex = |ring: u32, place: u32| match ring {
        0 => 0,
        _ => 1 + 3 * ring * (ring - 1) + place % (6 * ring),
    };
    let mut positions = vec![[0.0; 3]];
    let mut triangles = Vec::new();
    for ring in 1..=rings {
        let radius = f64::from(ring) / f64::from(rings);
        positions.extend((0..6 * ring).map(|place| on_circle(place, 6 * ring, radius, 0.0)));
        for place in 0..6 * ring {
            // A sixth of a ring has one edge more than a sixth of the ring within.
            let within = place / ring * (ring - 1) + place % ring;
            let [a, b] = [vertex(ring, place), vertex(ring, place + 1)];
            let c = vertex(ring - 1, within);
            triangles.push([a, b, c]);
            if place % ring + 1 < ring {
                triangles.push([b, vertex(ring - 1, within + 1), c]);
            }
        }
    }
    (triangles, positions)
}

/// A square of 2 `side`² triangles that waves a little along x.
pub fn waves(side: u32) -> Mesh {
    let along = |i: u32| 2.0 * f64::from(i) / f64::from(side) - 1.0;
    let row = side + 1;
    let position = |i: u32| {
        let [x, y] = [along(i % row), along(i / row)];
        [x as f32, y as f32, (0.02 * sin(9.0 * x)) as f32]
    };
    let square = |i: u32| {
        let a = i / side * row + i % side;
        [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]
    };
    let triangles = (0..side * side).flat_map(square).collect();
    (triangles, (0..row * row).map(position).collect())
}

/// Positions turned by an angle about z, then by half of it about x.
pub fn turned(positions: &[[f32; 3]], angle: f64) -> Vec<[f32; 3]> {
    let ([s, c], [hs, hc]) = (
        [sin(angle), cos(angle)],
        [sin(angle / 2.0), cos(angle / 2.0)],
    );
    let turn = |position: &[f32; 3]| {
        let [x, y, z] = position.map(f64::from);
        let [x, y] = [c * x - s * y, s * x + c * y];
        [x, hc * y - hs * z, hs * y + hc * z].map(|x| x as f32)
    };
    positions.iter().map(turn).collect()
}

fn on_circle(number: u32, count: u32, radius: f64, z: f32) -> [f32; 3] {
    let angle = TAU * f64::from(number) / f64::from(count);
    [
        (radius * cos(angle)) as f32,
        (radius * sin(angle)) as f32,
        z,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mesh_has_its_size_and_every_vertex_a_triangle() {
        for ((triangles, positions), count) in [
            (fan(9), 7),
            (strip(12), 12),
            (tube(7), 14),
            (rings(4), 96),
            (waves(3), 18),
        ] {
            assert_eq!(triangles.len(), count);
            let mut used: Vec<u32> = triangles.concat();
            used.sort_unstable();
            used.dedup();
            assert!(used.into_iter().eq(0..positions.len() as u32));
            let flat = turned(&positions, 0.0);
            assert_eq!(flat, positions);
        }
    }
}
