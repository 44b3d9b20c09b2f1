//! Surfaces of a soak test, and random shapes that share little from one call to the next.

use super::random::Random;
use pliant_scenes::Scene;

/// A mesh and its original shape, about as large as the unit cube.
pub(super) struct Surface {
    pub(super) triangles: Vec<[u32; 3]>,
    rest: Vec<[f64; 3]>,
}

/// Surfaces of 2 to 128 triangles, the largest first.
///
/// Closed and open ones, one with unused vertices, and triangles that form no surface.
pub(super) fn surfaces() -> Vec<Surface> {
    let mut all: Vec<Surface> = [
        ("spheres", 128),
        ("spheres", 80),
        ("spheres", 20),
        ("cloth", 72),
        ("cloth", 2),
    ]
    .into_iter()
    .map(|(name, triangles)| {
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED)
            .expect("the scene comes in this size");
        let mut positions = Vec::new();
        scene.positions(0, 1, &mut positions);
        Surface {
            triangles: scene.triangles(0).to_vec(),
            rest: into_unit_cube(&positions),
        }
    })
    .collect();
    let mut with_unused = Surface {
        triangles: all[1].triangles.clone(),
        rest: all[1].rest.clone(),
    };
    with_unused.rest.extend([[0.0; 3], [1.0; 3], [0.5; 3]]);
    all.push(with_unused);
    // Corners on a lattice of five points a side: triangles of one body touch, coincide and
    // degenerate.
    let mut random = Random::new(5);
    let places = 30;
    all.push(Surface {
        triangles: (0..40)
            .map(|_| [(); 3].map(|()| random.below(places)))
            .collect(),
        rest: (0..places)
            .map(|_| [(); 3].map(|()| f64::from(random.below(5)) / 4.0))
            .collect(),
    });
    all
}

/// The shape, moved and scaled so that its longest side goes from 0 to 1.
fn into_unit_cube(positions: &[[f32; 3]]) -> Vec<[f64; 3]> {
    let side = |axis: usize| {
        let values = positions
            .iter()
            .map(move |position| f64::from(position[axis]));
        let ends = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
            (lo.min(x), hi.max(x))
        });
        (ends.0, ends.1 - ends.0)
    };
    let sides = [side(0), side(1), side(2)];
    let longest = sides.iter().map(|side| side.1).fold(0.0, f64::max);
    positions
        .iter()
        .map(|position| {
            std::array::from_fn(|axis| (f64::from(position[axis]) - sides[axis].0) / longest)
        })
        .collect()
}

impl Surface {
    /// A random shape at a place: crumpled, and sometimes on a lattice, flat, or a single point.
    pub(super) fn somewhere(&self, random: &mut Random, place: [f64; 3]) -> Vec<[f64; 3]> {
        let crumple = [0.0, 0.03, 0.2][random.index(3)];
        let [on_lattice, flat, point] = [20, 30, 100].map(|rarely| random.one_in(rarely));
        self.rest
            .iter()
            .map(|rest| {
                std::array::from_fn(|axis| {
                    let x = rest[axis] + crumple * (random.unit() - 0.5);
                    let x = place[axis] + if point { 0.0 } else { x };
                    match axis {
                        // Common planes: flattened bodies overlap one another.
                        2 if flat => x.floor(),
                        _ if on_lattice => (x * 4.0).round() / 4.0,
                        _ => x,
                    }
                })
            })
            .collect()
    }
}
