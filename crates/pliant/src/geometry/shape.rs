//! Current shape of a body: where its vertices are, and what boxes are relative to.

#[cfg(test)]
use super::Aabb;
#[cfg(test)]
use super::bounds::Bounds;
use super::bounds::Origin;
use super::{Points, Real};
use crate::ids::{TreeTriangle, TreeVertex};

/// Current shape of a body, as everything that makes boxes reads it.
#[derive(Clone, Copy)]
pub(crate) struct Shape<'a, S> {
    /// Positions of vertices in tree order.
    pub(crate) positions: &'a Points<S>,
    /// Corners of each triangle; triangles and vertices in tree order.
    pub(crate) triangles: &'a [[TreeVertex; 3]],
    /// Origin that boxes are relative to; zero for `f32`.
    pub(crate) origin: Origin,
    /// Version of the shape, counted up at each change. A box made from another version is stale.
    pub(crate) version: u64,
}

impl<S: Real> Shape<'_, S> {
    /// Box of one triangle: the reference for the kernels.
    #[cfg(test)]
    pub(crate) fn box_of(&self, triangle: TreeTriangle) -> Aabb {
        let mut bounds = Bounds::EMPTY;
        for vertex in self.triangles[triangle.index()] {
            bounds.include(self.positions.get(vertex));
        }
        bounds.to_box(self.origin)
    }

    /// Returns the corners of a triangle in `f64`, as the exact decision takes them; exact.
    #[inline]
    pub(crate) fn corners(&self, triangle: TreeTriangle) -> [[f64; 3]; 3] {
        self.triangles[triangle.index()].map(|vertex| self.positions.get(vertex).map(Real::to_f64))
    }
}

#[cfg(test)]
mod tests {
    use super::super::real::{larger, smaller};
    use super::*;
    use pliant_oracle::{Class, Random, sign_of_sum};

    /// Six corners of every size, which no `f32` holds, and an origin.
    fn corners() -> impl Iterator<Item = (Vec<[f64; 3]>, [f64; 3])> {
        let mut random = Random::new(12);
        (0..4_000).map(move |round| {
            let class = Class::ALL[round % Class::ALL.len()];
            let [a, b] = class.pair(&mut random);
            let origin = match round % 5 {
                0 => [0.0; 3],
                1 => b[0],
                2 => [1e7 + 0.1, -3e-5, 1e38],
                3 => [-1e38, 5e-324, 1e-310],
                _ => [0.1, -1.0 / 3.0, 1e-40],
            };
            ([a, b].concat(), origin)
        })
    }

    /// Side of `bound` on which the exact `x - origin` lies.
    fn side(x: f64, origin: f64, bound: f32) -> i8 {
        match bound {
            f32::INFINITY => -1,
            f32::NEG_INFINITY => 1,
            _ => sign_of_sum(&[x, -origin, -f64::from(bound)]),
        }
    }

    fn holds(found: &Aabb, x: [f64; 3], origin: [f64; 3]) -> bool {
        (0..3).all(|axis| {
            side(x[axis], origin[axis], found.lo[axis]) >= 0
                && side(x[axis], origin[axis], found.hi[axis]) <= 0
        })
    }

    #[test]
    fn a_triangle_never_leaves_its_box_nor_a_box_its_parent() {
        let (mut inexact, mut normal) = (0, 0);
        for (positions, origin) in corners() {
            let wide_origin = [origin[0], origin[1], origin[2], 0.0];
            let shape = Shape {
                positions: &Points::of(positions.iter().copied()),
                triangles: &[[0, 1, 2], [3, 4, 5]].map(|corners| corners.map(TreeVertex)),
                origin: wide_origin,
                version: 1,
            };
            let boxes = [0, 1].map(|triangle| shape.box_of(TreeTriangle(triangle)));
            let mut bounds = Bounds::EMPTY;
            positions.iter().for_each(|&p| bounds.include(p));
            let parent = bounds.to_box(wide_origin);
            for (corner, &p) in positions.iter().enumerate() {
                assert!(
                    holds(&boxes[corner / 3], p, origin),
                    "{p:?} {origin:?} {boxes:?}"
                );
                assert!(holds(&parent, p, origin), "{p:?} {origin:?} {parent:?}");
            }
            assert!(
                boxes.iter().all(|child| parent.holds_box(child)),
                "{boxes:?} {parent:?}"
            );
            for axis in 0..3 {
                // Made of its children's boxes instead of its vertices, the parent is the same.
                let lo = smaller(boxes[0].lo[axis], boxes[1].lo[axis]);
                let hi = larger(boxes[0].hi[axis], boxes[1].hi[axis]);
                assert_eq!((lo, hi), (parent.lo[axis], parent.hi[axis]), "{origin:?}");
                // And no box of normal numbers is too large by more than a few units in the last
                // place.
                if lo.abs() <= f32::MIN_POSITIVE || lo.is_infinite() {
                    continue;
                }
                let least = positions
                    .iter()
                    .fold(f64::INFINITY, |least, p| least.min(p[axis]));
                inexact += u32::from(side(least, origin[axis], lo) > 0);
                normal += 1;
                let inside = lo + (lo.abs() * 2f32.powi(-20) + 4.0 * f32::MIN_POSITIVE);
                assert!(
                    side(least, origin[axis], inside) < 0,
                    "{least} {origin:?} {lo}"
                );
            }
        }
        assert!(inexact > 3_000 && normal > 6_000, "{inexact} of {normal}");
    }

    #[test]
    fn boxes_of_f32_are_exact() {
        let positions = [
            [0.1_f32, -1e-45, f32::MAX],
            [3e-39, 0.0, -1.0],
            [7.0, 1e-45, 0.5],
        ];
        let shape = Shape {
            positions: &Points::of(positions.iter().copied()),
            triangles: &[[0, 1, 2].map(TreeVertex)],
            origin: [0.0; 4],
            version: 1,
        };
        let expected = Aabb {
            lo: [3e-39, -1e-45, -1.0],
            hi: [7.0, 1e-45, f32::MAX],
        };
        assert_eq!(shape.box_of(TreeTriangle(0)), expected);
    }
}
