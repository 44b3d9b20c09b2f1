//! How deep a body reaches into another: of its vertices, and a bracket for its whole surface.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::points::{InsideRule, Side};
use crate::selection::Selection;
use crate::threads::Question;
use pliant_exact::{Point, Triangle};
use std::ops::ControlFlow;

/// How deep a body reaches into a closed one, from [`World::depth`].
///
/// The deepest point of the surface of `a` inside `b` is at least as deep as the deepest vertex,
/// and at most `at_most`. The difference is one covering radius: how far a point of a triangle may
/// be from its nearest corner. So it shrinks with the triangles. A volume is no depth: a thin sheet
/// that goes in deep has hardly any.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Depth {
    /// Depth of each vertex of `a`, shape (n,): the distance of a vertex inside `b` from the
    /// surface of `b`, and 0 of all others.
    pub of_vertices: Vec<f64>,
    /// The deepest vertex, the first of several, if any is inside.
    pub vertex: Option<u32>,
    /// Its depth, else 0; as good as the distance of a [`ClosestPoint`](crate::ClosestPoint).
    pub at_least: f64,
    /// Upper bound of the depth of all points of the surface of `a`. 0 if no triangle of `a` meets
    /// `b` or has a corner inside.
    pub at_most: f64,
}

/// # Questions: depth
impl<S: Scalar> World<S> {
    /// Measures how deep a body reaches into another, a closed one, in their present shapes.
    ///
    /// Inside is said by [`NonZero`](InsideRule::NonZero). Body `a` need not be closed. Filters and
    /// motions do not count. Of a body that overlaps itself its walls within count too.
    ///
    /// Cost: where all vertices are, closest points of the ones inside, and a query for the
    /// intersections of both.
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f64>::new();
    /// let corners = |x: f64, s: f64| [[x, x, x], [x + s, x, x], [x, x + s, x], [x, x, x + s]];
    /// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let large = world.add(&faces, &corners(0.0, 8.0))?;
    /// let small = world.add(&faces, &corners(-1.5, 8.0))?;
    /// // Of the corner (0, 0, 0) of the large one in the small one.
    /// let depth = world.depth(large, small)?;
    /// assert_eq!((depth.vertex, depth.at_least), (Some(0), 1.5));
    /// assert!(depth.at_least <= depth.at_most);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody),
    /// [`NotClosed`](crate::ErrorKind::NotClosed) if `b` is not.
    #[doc(alias = "penetration_depth")]
    pub fn depth(&mut self, a: BodyId, b: BodyId) -> Result<Depth, Error> {
        self.find_depth(a, b, None)
    }

    /// [`World::depth`].
    pub(super) fn find_depth(
        &mut self,
        a: BodyId,
        b: BodyId,
        question: Option<Question>,
    ) -> Result<Depth, Error> {
        let located = self.find_inside(a, b, InsideRule::NonZero, question)?;
        let mut statistics = *self.statistics();
        let positions = self.positions(a)?;
        let is_inside = |&vertex: &usize| located[vertex].side == Side::Inside;
        let inside: Vec<usize> = (0..located.len()).filter(is_inside).collect();
        let points: Vec<[S; 3]> = inside.iter().map(|&it| positions[it]).collect();
        let closest = self
            .verbs
            .closest_points(&points, Some(b), f64::INFINITY, question)?;
        statistics += *self.statistics();
        let mut depth = Depth {
            of_vertices: vec![0.0; located.len()],
            ..Depth::default()
        };
        for (&vertex, closest) in inside.iter().zip(&closest) {
            let distance = closest.map_or(0.0, |it| it.distance);
            depth.of_vertices[vertex] = distance;
            if depth.vertex.is_none() || distance > depth.at_least {
                (depth.vertex, depth.at_least) = (Some(vertex as u32), distance);
            }
        }
        let mut reaches = vec![false; self.triangle_count(a)?];
        let pairs = self.intersections(Selection::Between(a, b));
        let _ = pairs.interrupt(question).visit_some(|pairs| {
            for pair in pairs {
                reaches[pair.triangle_a as usize] = true;
            }
            ControlFlow::<()>::Continue(())
        })?;
        statistics += *self.statistics();
        for (corners, meets) in self.triangles(a)?.iter().zip(reaches) {
            if corners[0] == u32::MAX {
                continue;
            }
            let corners = corners.map(|it| it as usize);
            if meets || corners.iter().any(is_inside) {
                let deepest = corners
                    .iter()
                    .fold(0.0, |m: f64, &it| m.max(depth.of_vertices[it]));
                let triangle = corners.map(|it| positions[it].map(Scalar::to_f64));
                // Distances are off by 2^-30 of themselves.
                let most = (deepest + covering_radius(&triangle)) * (1.0 + f64::powi(0.5, 28));
                depth.at_most = depth.at_most.max(most.next_up());
            }
        }
        self.verbs.state_mut().common.statistics = statistics;
        Ok(depth)
    }
}

/// The largest distance of a point of a triangle from its nearest corner, with an error of less
/// than 2^-40 of itself.
///
/// That is the radius of the circle through the corners if all angles are acute. Else at most half
/// of the longest side, since a circle round each end of it then covers the triangle. The radius is
/// taken from the two shorter sides, which then form an angle of 60 to 90 degrees, so that nothing
/// cancels. If the shortest is below 2^-30 of the longest, both are the same.
fn covering_radius(&[a, b, c]: &Triangle) -> f64 {
    let way = |p: Point, q: Point| [0, 1, 2].map(|axis| q[axis] - p[axis]);
    let mut sides = [way(a, b), way(b, c), way(c, a)];
    let largest = sides
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    // In units in which squares are neither lost nor infinite.
    sides = sides.map(|side| side.map(|x| x / largest));
    let square = |[x, y, z]: Point| x * x + y * y + z * z;
    sides.sort_unstable_by(|p, q| square(*p).total_cmp(&square(*q)));
    let [s, m, l] = sides.map(square);
    let half = 0.5 * l.sqrt() * largest;
    if s + m <= l || s <= l * f64::powi(0.5, 60) {
        return half;
    }
    let [e, f, _] = sides;
    let normal = [1, 2, 0].map(|i| {
        let j = (i + 1) % 3;
        e[i] * f[j] - e[j] * f[i]
    });
    half * ((s * m) / square(normal)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_of_known_triangles() {
        let radius = |b: Point, c: Point| covering_radius(&[[0.0; 3], b, c]);
        let equilateral = radius([2.0, 0.0, 0.0], [1.0, 3.0_f64.sqrt(), 0.0]);
        assert!((equilateral - 2.0 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(radius([3.0, 0.0, 0.0], [0.0, 4.0, 0.0]), 2.5);
        assert_eq!(radius([8.0, 0.0, 0.0], [1.0, 0.5, 0.0]), 4.0);
        assert_eq!(radius([8.0, 0.0, 0.0], [4.0, 0.0, 0.0]), 4.0);
        assert_eq!(radius([0.0; 3], [0.0; 3]), 0.0);
        // Acute needles, and triangles of any size.
        for w in [1e-3, 1e-6, 1e-9, 1e-12] {
            let found = radius([w, 0.0, 0.0], [w / 2.0, 1.0, 0.0]);
            let exact = 0.5 + w * w / 8.0;
            assert!((found - exact).abs() <= 1e-13, "{w} {found}");
        }
        for scale in [1e-300, 1e-170, 1e-80, 1e30] {
            let found = radius(
                [2.0 * scale, 0.0, 0.0],
                [scale, 3.0_f64.sqrt() * scale, 0.0],
            );
            assert!(
                (found / scale - 2.0 / 3.0_f64.sqrt()).abs() < 1e-12,
                "{scale}"
            );
        }
    }
}
