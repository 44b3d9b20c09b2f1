//! How two triangles that intersect do so, on signs alone.
//!
//! They cross if they intersect after every small enough move of their corners. They overlap if
//! they lie in one plane and have an area in common; else they touch. All three follow from signs
//! of determinants, so the kind is as exact as these are. The two signs that tell a crossing are
//! the ones of Guigue and Devillers (2003). Here triangles without area have a kind too.

use super::orientation::Orientation;
use super::point::{PLANES, Point, Point2, Sign, Triangle, projected};
use super::triangles::{edge, one_side};

/// How two triangles, as closed sets, have points in common. Each pair that intersects is of one
/// kind, decided exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ContactKind {
    /// Neither of the others: a corner or an edge on the other triangle, or two edges at a point. A
    /// move of their corners, however small, could part them.
    #[default]
    Touching,
    /// Triangles in one plane that have an area in common. A small move could part them too.
    Overlapping,
    /// Triangles that go through each other: after every small enough move of their corners they
    /// still intersect. So there is no plane with one triangle on either closed side of it. A
    /// triangle without area, a segment, crosses another if it goes through its inside.
    Crossing,
}

/// Kind of contact of two triangles that are known to intersect.
///
/// They cross if they intersect after every small enough move. The origin is then inside the set of
/// differences of their points, not on its boundary. That is, no plane has the one on its one
/// closed side and the other on the other. These differences fill space only if the triangles span
/// it. Then their inside is the differences of what is inside either, seen in its own plane or
/// line. So
///
/// - two triangles with area cross if each has corners on both open sides of the other's plane.
///   Their open segments on the line of both planes must also overlap. Let p1 and p2 be the corners
///   alone on their sides, and the others in the order of `pliant`'s vector lanes. Then these are
///   the two signs of Guigue and Devillers (2003), both negative: a zero is two ends in one point;
/// - a segment crosses a triangle with area if its ends are on both open sides of the plane. Its
///   line must also have the three edges on one side;
/// - all others do not: two segments span no space, a point has nothing inside.
///
/// Triangles of one plane overlap if both have area and no edge of either has them on its two
/// closed sides. (Of two convex polygons with disjoint insides one has an edge whose line parts
/// them.)
pub(super) fn contact_kind(
    a: &Triangle,
    b: &Triangle,
    orientation: &mut impl Orientation,
) -> ContactKind {
    let of_b = orientation.plane_signs(a, b);
    let of_a = orientation.plane_signs(b, a);
    // If all of one triangle is in the plane of another that is not in its own, that other is a
    // segment. In its planes everything is.
    let do_cross = match (on_both_sides(of_a), on_both_sides(of_b)) {
        (true, true) => lines_cross([a, b], [of_a, of_b], orientation),
        (true, false) if of_b == [0; 3] => goes_through(a, of_a, b, orientation),
        (false, true) if of_a == [0; 3] => goes_through(b, of_b, a, orientation),
        _ => false,
    };
    if do_cross {
        ContactKind::Crossing
    } else if of_a == [0; 3] && of_b == [0; 3] && overlap_in_plane(a, b, orientation) {
        ContactKind::Overlapping
    } else {
        ContactKind::Touching
    }
}

fn on_both_sides(signs: [Sign; 3]) -> bool {
    signs.contains(&1) && signs.contains(&-1)
}

/// Whether the open segments overlap in which two triangles, each on both sides of the other's
/// plane, meet the line of the planes.
fn lines_cross(
    [a, b]: [&Triangle; 2],
    [of_a, of_b]: [[Sign; 3]; 2],
    orientation: &mut impl Orientation,
) -> bool {
    let (alone_a, alone_b) = (alone(of_a), alone(of_b));
    let [p1, q1, r1] = alone_first(a, alone_a, of_b[alone_b] < 0);
    let [p2, q2, r2] = alone_first(b, alone_b, of_a[alone_a] < 0);
    orientation.sign(p1, q1, p2, q2) < 0 && orientation.sign(p1, r1, r2, p2) < 0
}

/// The corner that has its side of a plane for itself.
fn alone(signs: [Sign; 3]) -> usize {
    let of = |side: Sign| (0..3).filter(move |&corner| signs[corner] == side);
    let side = if of(1).count() == 1 { 1 } else { -1 };
    of(side).next().unwrap_or(0)
}

/// The corners from one on, in order, or the other way round.
fn alone_first(triangle: &Triangle, first: usize, is_turned: bool) -> [&Point; 3] {
    let [mut q, mut r] = [1, 2].map(|step| &triangle[(first + step) % 3]);
    if is_turned {
        std::mem::swap(&mut q, &mut r);
    }
    [&triangle[first], q, r]
}

/// Whether a segment, which has corners on both sides of a triangle's plane, goes through its
/// inside.
fn goes_through(
    segment: &Triangle,
    signs: [Sign; 3],
    triangle: &Triangle,
    orientation: &mut impl Orientation,
) -> bool {
    let long = (0..3).find(|&i| edge(&signs, i).iter().product::<Sign>() < 0);
    long.is_some_and(|i| {
        let [p, q] = edge(segment, i);
        let edges = [0, 1, 2].map(|j| edge(triangle, j));
        one_side(edges.map(|[r, s]| orientation.sign(&p, &q, &r, &s)))
    })
}

/// Whether triangles in one plane have an area in common.
pub(super) fn overlap_in_plane(
    a: &Triangle,
    b: &Triangle,
    orientation: &mut impl Orientation,
) -> bool {
    for plane in PLANES {
        let [a, b] = [a, b].map(|triangle| projected(triangle, plane));
        let mut way = |[p, q, r]: [Point2; 3]| orientation.sign_in_plane(p, q, r);
        let (way_a, way_b) = (way(a), way(b));
        // Where one has an area seen from an axis, so has the other.
        if way_a != 0 && way_b != 0 {
            return !parts(a, way_a, b, orientation) && !parts(b, way_b, a, orientation);
        }
    }
    false
}

/// Whether an edge of a triangle has the other on its outer closed side.
fn parts(
    triangle: [Point2; 3],
    way: Sign,
    other: [Point2; 3],
    orientation: &mut impl Orientation,
) -> bool {
    (0..3).any(|i| {
        let [p, q] = edge(&triangle, i);
        other
            .iter()
            .all(|&r| orientation.sign_in_plane(p, q, r) * way <= 0)
    })
}
