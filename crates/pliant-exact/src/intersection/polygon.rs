//! Polygon that two triangles of one plane have in common: on which features its corners lie.
//!
//! Idea: a corner of it is a corner of one triangle in the other, or a point where two edges go
//! through each other. All follows from signs in a plane of two axes in which neither triangle
//! folds. A triangle without area is the segment or the point that it is, and the polygon is one.

use super::feature::{Feature, place};
use crate::adjacent::has_area;
use crate::orientation::Orientation;
use crate::point::{PLANES, Point2, Triangle, projected};
use crate::triangles::edge;

/// Corners of the polygon that two triangles have in common, in order around it. Of each, all
/// corners are in the plane of the other.
pub(super) fn corners([a, b]: [&Triangle; 2], orientation: &mut impl Orientation) -> Corners {
    let mut found = Corners::default();
    let hulls = [a, b].map(|triangle| Hull::of(triangle, orientation));
    let [of_a, of_b] = &hulls;
    // Two segments that pass each other.
    if let ([p, q], [r, s]) = (of_a.corners(), of_b.corners())
        && orientation.sign(&a[*p], &a[*q], &b[*r], &b[*s]) != 0
    {
        return found;
    }
    let plane = plane_of([a, b], &hulls, orientation);
    let [flat_a, flat_b] = [a, b].map(|triangle| projected(triangle, plane));
    for &i in of_a.corners() {
        if let Some(on) = of_b.locate(&flat_b, flat_a[i], orientation) {
            found.take([Feature::Corner(i), on]);
        }
    }
    for &j in of_b.corners() {
        if let Some(on) = of_a.locate(&flat_a, flat_b[j], orientation) {
            found.take([on, Feature::Corner(j)]);
        }
    }
    for i in of_a.edges() {
        for j in of_b.edges() {
            let (of_i, of_j) = (edge(&flat_a, i), edge(&flat_b, j));
            if go_through(of_i, of_j, orientation) {
                let on_a = of_a.feature(i, &flat_a, of_j, orientation);
                let on_b = of_b.feature(j, &flat_b, of_i, orientation);
                found.take([on_a, on_b]);
            }
        }
    }
    found.go_round();
    found
}

/// Whether the insides of two segments meet in one point.
fn go_through(
    [p, q]: [Point2; 2],
    [r, s]: [Point2; 2],
    orientation: &mut impl Orientation,
) -> bool {
    let mut side = |a, b, c| orientation.sign_in_plane(a, b, c);
    side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0
}

/// The corners of a triangle that span it: three, or two of a segment, or one of a point.
struct Hull {
    corners: [usize; 3],
    count: usize,
}

impl Hull {
    fn of(triangle: &Triangle, orientation: &mut impl Orientation) -> Self {
        if has_area(triangle, orientation) {
            let corners = [0, 1, 2];
            return Self { corners, count: 3 };
        }
        // Along a line, corners are in the order of their coordinates. Of equal ones the first.
        let (mut low, mut high) = (0, 0);
        for i in 1..3 {
            if triangle[i] < triangle[low] {
                low = i;
            }
            if triangle[i] > triangle[high] {
                high = i;
            }
        }
        let corners = [low, high, 0];
        let count = if low == high { 1 } else { 2 };
        Self { corners, count }
    }

    fn corners(&self) -> &[usize] {
        &self.corners[..self.count]
    }

    /// The edges of the triangle that bound it.
    fn edges(&self) -> impl Iterator<Item = usize> {
        let is_edge = move |&i: &usize| match self.corners() {
            [low, high] => [low, high].contains(&&i) && [low, high].contains(&&((i + 1) % 3)),
            all => all.len() == 3,
        };
        (0..3).filter(is_edge)
    }

    /// Where a point of the plane lies on the triangle; none if it does not.
    fn locate(
        &self,
        triangle: &[Point2; 3],
        point: Point2,
        orientation: &mut impl Orientation,
    ) -> Option<Feature> {
        if let Some(i) = triangle.iter().position(|corner| *corner == point) {
            return Some(Feature::Corner(i));
        }
        let mut past = |i: usize| {
            let [p, q] = edge(triangle, i);
            orientation.sign_in_plane(p, q, point)
        };
        match self.edges().next() {
            _ if self.count == 3 => place([past(0), past(1), past(2)]),
            Some(whole) if past(whole) == 0 => {
                let holds = |&i: &usize| {
                    let [p, q] = edge(triangle, i);
                    p < point && point < q || q < point && point < p
                };
                (0..3).find(holds).map(Feature::Edge)
            }
            _ => None,
        }
    }

    /// Where a line that goes through an edge of the outline meets the triangle.
    fn feature(
        &self,
        i: usize,
        triangle: &[Point2; 3],
        [r, s]: [Point2; 2],
        orientation: &mut impl Orientation,
    ) -> Feature {
        if self.count == 3 {
            return Feature::Edge(i);
        }
        let sides = triangle.map(|corner| orientation.sign_in_plane(r, s, corner));
        let corner = sides.iter().position(|&side| side == 0);
        let crosses = |&i: &usize| sides[i] * sides[(i + 1) % 3] < 0;
        corner.map_or_else(
            || Feature::Edge((0..3).find(crosses).unwrap_or(i)),
            Feature::Corner,
        )
    }
}

/// Two axes in whose plane neither triangle, nor both together, fold.
fn plane_of(
    [a, b]: [&Triangle; 2],
    hulls: &[Hull; 2],
    orientation: &mut impl Orientation,
) -> [usize; 2] {
    let [[p, q], [r, s]] = [(a, &hulls[0]), (b, &hulls[1])].map(|(triangle, hull)| {
        let [low, high, _] = hull.corners;
        [triangle[low], triangle[high]]
    });
    let mut spans = |[x, y, z]: &Triangle, plane| {
        let [x, y, z] = projected(&[*x, *y, *z], plane);
        orientation.sign_in_plane(x, y, z) != 0
    };
    for points in [*a, *b, [p, q, r], [p, q, s], [r, s, p], [r, s, q]] {
        if let Some(plane) = PLANES.into_iter().find(|&plane| spans(&points, plane)) {
            return plane;
        }
    }
    // All is on a line, or in a point.
    let differ = |[x, y]: &[usize; 2]| {
        let at = [p, q, r, s].map(|point| [point[*x], point[*y]]);
        at.iter().any(|point| *point != at[0])
    };
    PLANES.into_iter().find(differ).unwrap_or(PLANES[0])
}

/// Corners of a polygon, at most six.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corners {
    on: [[Feature; 2]; 6],
    count: usize,
}

impl Corners {
    pub(super) fn all(&self) -> &[[Feature; 2]] {
        &self.on[..self.count]
    }

    /// The ends of a segment, or one twice if it is a point.
    pub(super) fn of_segment(ends: [[Feature; 2]; 2]) -> Self {
        let mut both = Self::default();
        ends.into_iter().for_each(|on| both.take(on));
        both
    }

    /// Takes a corner, unless it is there.
    fn take(&mut self, on: [Feature; 2]) {
        if self.count < self.on.len() && !self.all().contains(&on) {
            self.on[self.count] = on;
            self.count += 1;
        }
    }

    /// Puts them in order around the polygon. A side of it lies on an edge of either triangle, and
    /// no more than two of its corners do.
    fn go_round(&mut self) {
        for next in 1..self.count.saturating_sub(1) {
            let before = self.on[next - 1];
            let follows = |on: &[Feature; 2]| {
                (0..2).any(|of| (0..3).any(|edge| before[of].is_on(edge) && on[of].is_on(edge)))
            };
            if let Some(place) = self.all()[next..].iter().position(follows) {
                self.on.swap(next, next + place);
            }
        }
    }
}
