//! Triangulated sphere: a platonic solid, subdivided repeatedly.
//!
//! A subdivision cuts each triangle in four and pushes the midpoints of edges to the unit sphere.
//! Icosahedron, octahedron and tetrahedron give 20, 8 and 4 times the powers of four. These are the
//! sizes of the paper's Table 1, and no two of the solids share one.

use super::{MAX_TRIANGLES, Nearest, Surface};
use crate::vector::{Vec3, add, normalised};

/// A solid to subdivide: corners of any length, triangles counter-clockwise from outside.
struct Solid {
    corners: &'static [Vec3],
    triangles: &'static [[u32; 3]],
}

/// The golden ratio, (1 + √5) / 2.
const PHI: f64 = 1.618_033_988_749_895;

const ICOSAHEDRON: Solid = Solid {
    corners: &[
        [-1.0, PHI, 0.0],
        [1.0, PHI, 0.0],
        [-1.0, -PHI, 0.0],
        [1.0, -PHI, 0.0],
        [0.0, -1.0, PHI],
        [0.0, 1.0, PHI],
        [0.0, -1.0, -PHI],
        [0.0, 1.0, -PHI],
        [PHI, 0.0, -1.0],
        [PHI, 0.0, 1.0],
        [-PHI, 0.0, -1.0],
        [-PHI, 0.0, 1.0],
    ],
    // Five round corner 0, five beside them, five round corner 3, five beside these.
    triangles: &[
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ],
};

const OCTAHEDRON: Solid = Solid {
    corners: &[
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ],
    triangles: &[
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ],
};

const TETRAHEDRON: Solid = Solid {
    corners: &[
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ],
    triangles: &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]],
};

const SOLIDS: [&Solid; 3] = [&ICOSAHEDRON, &OCTAHEDRON, &TETRAHEDRON];

/// Possible numbers of triangles, not sorted.
fn sphere_sizes() -> impl Iterator<Item = usize> + Clone {
    recipes().map(|(_, _, size)| size)
}

/// All pairs of a solid and a number of subdivisions, with the number of triangles.
fn recipes() -> impl Iterator<Item = (&'static Solid, u32, usize)> + Clone {
    SOLIDS.into_iter().flat_map(|solid| {
        (0..)
            .map(move |times| (solid, times, solid.triangles.len() << (2 * times)))
            .take_while(|(_, _, size)| *size <= MAX_TRIANGLES)
    })
}

/// The unit sphere with `triangles` triangles.
pub(crate) fn sphere(triangles: usize) -> Result<Surface, Nearest> {
    let (solid, times, _) = recipes()
        .find(|(_, _, size)| *size == triangles)
        .ok_or_else(|| Nearest::among(sphere_sizes(), triangles))?;
    let start = Surface {
        rest: solid.corners.iter().copied().map(normalised).collect(),
        triangles: solid.triangles.to_vec(),
    };
    Ok((0..times).fold(start, |surface, _| divided(&surface)))
}

/// Subdivides every triangle into four. Old vertices keep their numbers.
fn divided(coarse: &Surface) -> Surface {
    let edges = coarse.triangles.len() / 2 * 3;
    let mut rest = Vec::with_capacity(coarse.rest.len() + edges);
    rest.extend_from_slice(&coarse.rest);
    let mut midpoints = Midpoints::new(coarse.rest.len());
    let mut triangles = Vec::with_capacity(4 * coarse.triangles.len());
    for &[a, b, c] in &coarse.triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| midpoints.of(a, b, &mut rest));
        triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    Surface { rest, triangles }
}

/// Midpoints of the edges met so far, so that both triangles of an edge share one.
///
/// An edge is stored at its smaller end. No vertex has more than six neighbours, so six slots per
/// vertex replace a hash table.
struct Midpoints {
    places: Vec<[(u32, u32); 6]>,
}

impl Midpoints {
    const FREE: (u32, u32) = (u32::MAX, u32::MAX);

    fn new(vertices: usize) -> Self {
        Self {
            places: vec![[Self::FREE; 6]; vertices],
        }
    }

    /// Midpoint of `a` and `b`, created for the first triangle that asks.
    fn of(&mut self, a: u32, b: u32, rest: &mut Vec<Vec3>) -> u32 {
        let (low, high) = (a.min(b), a.max(b));
        for place in &mut self.places[low as usize] {
            if place.0 == high {
                return place.1;
            }
            if *place == Self::FREE {
                let made = rest.len() as u32;
                rest.push(normalised(add(rest[low as usize], rest[high as usize])));
                *place = (high, made);
                return made;
            }
        }
        unreachable!("a vertex has at most six neighbours")
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::{Nearest, sphere, sphere_sizes};
    use crate::vector::{cross, dot};

    #[test]
    fn is_closed_round_and_turned_outward() {
        for size in sphere_sizes().filter(|size| *size <= 32_768) {
            let surface = sphere(size).unwrap();
            assert_eq!(surface.triangles.len(), size);
            assert_eq!(surface.rest.len(), size / 2 + 2, "Euler");
            assert!(
                surface
                    .rest
                    .iter()
                    .all(|p| (dot(*p, *p) - 1.0).abs() < 1e-14)
            );

            let mut edges = HashSet::new();
            for t in &surface.triangles {
                let [a, b, c] = t.map(|v| surface.rest[v as usize]);
                assert!(dot(a, cross(b, c)) > 0.0, "{size}: {t:?} is turned inward");
                for (from, to) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    assert!(edges.insert((from, to)), "{size}: edge {from} {to} twice");
                }
            }
            assert!(
                edges.iter().all(|&(from, to)| edges.contains(&(to, from))),
                "{size}: a hole"
            );
        }
    }

    #[test]
    fn vertices_are_shared() {
        let surface = sphere(5_120).unwrap();
        let places: HashSet<_> = surface.rest.iter().map(|p| p.map(f64::to_bits)).collect();
        assert_eq!(places.len(), surface.rest.len());
    }

    #[test]
    fn has_the_sizes_of_table_1() {
        let possible: HashSet<usize> = sphere_sizes().collect();
        for size in [
            1280,
            5120,
            8192,
            16384,
            20480,
            32768,
            65536,
            327_680,
            1_310_720,
            20 << 20,
        ] {
            assert!(possible.contains(&size), "{size}");
        }
    }

    #[test]
    fn names_the_nearest_sizes() {
        let nearest = |below, above| Nearest { below, above };
        assert_eq!(sphere(0).unwrap_err(), nearest(None, Some(4)));
        assert_eq!(
            sphere(20_000).unwrap_err(),
            nearest(Some(16_384), Some(20_480))
        );
        assert_eq!(
            sphere(usize::MAX).unwrap_err(),
            nearest(Some(20 << 20), None)
        );
    }
}
