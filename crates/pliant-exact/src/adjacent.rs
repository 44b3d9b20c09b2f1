//! Triangles that have corners in common, and whether they meet beyond these.
//!
//! Corners in common are vertices of one mesh, whatever stands in one place by chance. Idea: with
//! one corner p in common, both triangles are cones from p that their opposite edges cut off. So
//! they meet beyond p if and only if the opposite edge of one meets the other. Signs alone decide
//! it, as for triangles without a corner in common (`triangles`).

use super::contact_kind::{self, ContactKind, overlap_in_plane};
use super::environment::Precision;
use super::lattice::on_lattice;
use super::orientation::{Filtered, Orientation};
use super::point::{PLANES, Point, Sign, Triangle, projected};
use super::triangles::triangles_intersect;

/// How two triangles of one mesh meet beyond the hull of the corners that they have in common, if
/// they do. Corners of equal `numbers` are one vertex, and stand in one place.
///
/// - **No corner in common**: whether they [intersect](crate::intersect), and how.
/// - **One**: the opposite edge of one meets the other triangle. They cross if they still do after
///   every small enough move of the vertices. They overlap if they lie in one plane with an area in
///   common. Else they touch.
/// - **Two**: they lie in one plane, on one side of the edge in common, and overlap. Triangles
///   without area touch, if they go on along the line of the edge beyond the same end.
/// - **Three**: the triangle is there twice; overlapping, always.
///
/// A degenerate triangle is the segment or point that it is. Adds one to `exact` if floating point
/// alone did not decide. As exact as [`intersect`](crate::intersect).
///
/// ```
/// use pliant_exact::{ContactKind, Precision, adjacent_contact};
///
/// // Two triangles with corner 0 in common; the second is turned about an axis through it.
/// let fixed = [[0.0; 3], [4.0, -1.0, 0.0], [4.0, 1.0, 0.0]];
/// let turned = |x: f64| [[0.0; 3], [x, 0.0, -1.0], [x, 0.0, 1.0]];
/// let numbers = [[0, 1, 2], [0, 3, 4]];
/// let meet = |x| adjacent_contact(Precision::Double, numbers, &fixed, &turned(x), &mut 0);
/// assert_eq!(meet(4.0), Some(ContactKind::Crossing));
/// assert_eq!(meet(-4.0), None);
/// ```
pub fn adjacent_contact(
    precision: Precision,
    numbers: [[u32; 3]; 2],
    a: &Triangle,
    b: &Triangle,
    exact: &mut u64,
) -> Option<ContactKind> {
    if let Some(contact) = on_lattice!(precision, a, b, |a, b, signs| {
        beyond_common(numbers, [&a, &b], signs)
    }) {
        *exact += 1;
        return contact;
    }
    let mut filtered = Filtered::new(precision);
    let contact = beyond_common(numbers, [a, b], &mut filtered);
    *exact += u64::from(filtered.was_uncertain());
    contact
}

/// How two triangles meet beyond the hull of the corners that they have in common; none if they do
/// not. Corners are the same if their numbers are.
///
/// Let H be the hull of the corners in common, and K what both closed triangles have in common.
/// They meet beyond H if K is more than H. By the number of corners in common:
///
/// - **none**: H is empty, so this is the question whether they intersect, and how.
/// - **one**, p: see [`beyond_corner`].
/// - **two**, p and q: see [`beyond_edge`].
/// - **three**: K is H, but the triangle is there twice: overlapping, always.
///
/// A triangle that has a corner twice is the segment or point that it is; of its numbers each
/// counts once. If all of them are the other's too, K is H.
pub(super) fn beyond_common(
    numbers: [[u32; 3]; 2],
    [a, b]: [&Triangle; 2],
    orientation: &mut impl Orientation,
) -> Option<ContactKind> {
    let [of_a, of_b] = numbers;
    let mut common: [Option<usize>; 3] = [None; 3];
    let mut count = 0;
    for i in 0..3 {
        // The first of a corner that is there twice.
        if !of_a[..i].contains(&of_a[i]) && of_b.contains(&of_a[i]) {
            common[count] = Some(i);
            count += 1;
        }
    }
    let others = |numbers: [u32; 3], triangle: &Triangle| {
        let mut others = [None; 3];
        let mut next = 0;
        for i in 0..3 {
            let is_common = common.iter().flatten().any(|&j| of_a[j] == numbers[i]);
            if !is_common && !numbers[..i].contains(&numbers[i]) {
                others[next] = Some(triangle[i]);
                next += 1;
            }
        }
        others
    };
    let (rest_a, rest_b) = (others(of_a, a), others(of_b, b));
    match common {
        [None, ..] => triangles_intersect(a, b, orientation)
            .then(|| contact_kind::contact_kind(a, b, orientation)),
        [Some(p), None, _] => beyond_corner(&a[p], [rest_a, rest_b], orientation),
        [Some(p), Some(q), None] => match (rest_a[0], rest_b[0]) {
            (Some(r), Some(s)) => beyond_edge([&a[p], &a[q]], [&r, &s], orientation),
            _ => None,
        },
        [Some(_), Some(_), Some(_)] => Some(ContactKind::Overlapping),
    }
}

/// Triangles p q r and p s t meet beyond p if edge q r meets the second, or edge s t the first.
///
/// Where K has a point x other than p, the ray from p through x leaves the one triangle or the
/// other first. It does so through the opposite edge, in a point of both, which is not p as p is
/// not on that edge. A triangle without area is one or two segments from p, to its corners that are
/// elsewhere. Each is a triangle p q q, with the edge q q, and the same holds.
///
/// They cross if three things hold. Both q and r are off the plane of the other, on its two sides;
/// so are s and t. The two cones hold the same ray of the line of both planes: then side(s) has the
/// sign of side(r). All this is open, so small moves do not change it. If one sign is zero, a small
/// move takes a corner to the side of its edge's other end, and the triangles apart.
fn beyond_corner(
    p: &Point,
    rests: [[Option<Point>; 3]; 2],
    orientation: &mut impl Orientation,
) -> Option<ContactKind> {
    let [of_a, of_b] = rests.map(|rest| cones(p, rest, orientation));
    if let ([Some([q, r]), None], [Some([s, t]), None]) = (of_a, of_b) {
        let (a, b) = ([*p, q, r], [*p, s, t]);
        let [_, side_q, side_r] = orientation.plane_signs(&b, &a);
        let [_, side_s, side_t] = orientation.plane_signs(&a, &b);
        if side_q * side_r > 0 || side_s * side_t > 0 {
            return None;
        }
        if side_q * side_r < 0 && side_s * side_t < 0 {
            return (side_s == side_r).then_some(ContactKind::Crossing);
        }
        let do_meet = meet_beyond(p, [q, r], [s, t], orientation);
        let is_flat = [side_q, side_r, side_s, side_t] == [0; 4];
        return do_meet.then(|| {
            if is_flat && overlap_in_plane(&a, &b, orientation) {
                ContactKind::Overlapping
            } else {
                ContactKind::Touching
            }
        });
    }
    let mut pairs = of_a
        .into_iter()
        .flatten()
        .flat_map(|edge| of_b.into_iter().flatten().map(move |other| (edge, other)));
    pairs
        .any(|(edge, other)| meet_beyond(p, edge, other, orientation))
        .then_some(ContactKind::Touching)
}

/// Edges opposite p of the cones that a triangle consists of. A triangle with area has one. Of
/// another it is a point for each corner that is not in the place of p.
fn cones(
    p: &Point,
    [q, r, _]: [Option<Point>; 3],
    orientation: &mut impl Orientation,
) -> [Option<[Point; 2]>; 2] {
    if let (Some(q), Some(r)) = (q, r)
        && has_area(&[*p, q, r], orientation)
    {
        return [Some([q, r]), None];
    }
    [q, r].map(|corner| {
        corner
            .filter(|corner| corner != p)
            .map(|corner| [corner; 2])
    })
}

pub(super) fn has_area(triangle: &Triangle, orientation: &mut impl Orientation) -> bool {
    PLANES.into_iter().any(|plane| {
        let [a, b, c] = projected(triangle, plane);
        orientation.sign_in_plane(a, b, c) != 0
    })
}

fn meet_beyond(
    p: &Point,
    [q, r]: [Point; 2],
    [s, t]: [Point; 2],
    orientation: &mut impl Orientation,
) -> bool {
    triangles_intersect(&[q, r, r], &[*p, s, t], orientation)
        || triangles_intersect(&[s, t, t], &[*p, q, r], orientation)
}

/// Triangles p q r and p q s overlap if they lie in one plane, and on one side of edge p q.
///
/// If r and s lie on the line of the edge, both must be beyond the same end of it: they touch. They
/// never cross, as a small move takes them out of one plane.
fn beyond_edge(
    [p, q]: [&Point; 2],
    [r, s]: [&Point; 2],
    orientation: &mut impl Orientation,
) -> Option<ContactKind> {
    if orientation.sign(p, q, r, s) != 0 {
        return None;
    }
    let mut are_on_the_line = [true; 2];
    for plane in PLANES {
        let sides = [r, s].map(|&corner| {
            let [p, q, corner] = projected(&[*p, *q, corner], plane);
            orientation.sign_in_plane(p, q, corner)
        });
        if let [1, 1] | [-1, -1] = sides {
            return Some(ContactKind::Overlapping);
        }
        for (is_on, side) in are_on_the_line.iter_mut().zip(sides) {
            *is_on &= side == 0;
        }
    }
    let is_beyond = are_on_the_line == [true; 2] && {
        if p == q {
            // Two segments from p, the same way.
            r != p && s != p && meet_beyond(p, [*r; 2], [*s; 2], orientation)
        } else {
            let ends = [ends_passed([p, q], r), ends_passed([p, q], s)];
            ends[0] != 0 && ends[0] == ends[1]
        }
    };
    is_beyond.then_some(ContactKind::Touching)
}

/// The end of a segment beyond which a point of its line lies: -1 for p, 1 for q, 0 for none.
fn ends_passed([p, q]: [&Point; 2], point: &Point) -> Sign {
    for axis in 0..3 {
        let (p, q, x) = (p[axis], q[axis], point[axis]);
        let (low, high) = (p.min(q), p.max(q));
        if p != q && x < low {
            return if p < q { -1 } else { 1 };
        }
        if p != q && x > high {
            return if p < q { 1 } else { -1 };
        }
    }
    0
}

#[cfg(test)]
mod tests {
    use super::super::orientation::Exact;
    use super::*;
    use pliant_oracle::{Random, adjacent_contact as expected};

    /// Numbers of two triangles by how many corners they have in common, some of them twice.
    const NUMBERS: [[[u32; 3]; 2]; 14] = [
        [[0, 1, 2], [3, 4, 5]],
        [[0, 1, 2], [0, 3, 4]],
        [[1, 0, 2], [3, 4, 0]],
        [[1, 2, 0], [3, 0, 4]],
        [[0, 1, 2], [0, 1, 3]],
        [[0, 1, 2], [3, 1, 0]],
        [[2, 0, 1], [1, 3, 0]],
        [[0, 1, 2], [0, 1, 2]],
        [[0, 1, 2], [1, 0, 2]],
        [[0, 0, 1], [0, 2, 3]],
        [[0, 1, 1], [1, 2, 1]],
        [[0, 1, 1], [0, 1, 2]],
        [[0, 0, 0], [0, 1, 2]],
        [[0, 1, 0], [1, 0, 1]],
    ];

    /// On small lattices everything happens: corners in one place, on edges, planes in common.
    #[test]
    fn every_kind_is_the_oracles() {
        let mut random = Random::new(51);
        let mut seen = [[0; 4]; 4];
        for round in 0..60_000 {
            let size = [2, 3, 5, 9][round % 4];
            let flat = round % 3 == 0;
            let mut point = || {
                let mut at = [0; 3].map(|_: i64| i64::from(random.below(size)));
                if flat {
                    at[2] = 0;
                }
                at
            };
            let places: [[i64; 3]; 6] = std::array::from_fn(|_| point());
            let numbers = NUMBERS[round / 12 % NUMBERS.len()];
            let lattice = numbers.map(|of| of.map(|number| places[number as usize]));
            let [a, b] = lattice.map(|triangle| triangle.map(|at| at.map(|x| x as f64)));
            let found = beyond_common(numbers, [&a, &b], &mut Exact);
            assert_eq!(
                found,
                expected(numbers, lattice).map(kind),
                "{numbers:?} {lattice:?}"
            );
            let swapped = [numbers[1], numbers[0]];
            assert_eq!(found, beyond_common(swapped, [&b, &a], &mut Exact));
            let mut filtered = Filtered::new(Precision::Double);
            assert_eq!(found, beyond_common(numbers, [&a, &b], &mut filtered));
            // The same, far from the lattice of the quick way.
            let tiny = 0.5_f64.powi(600);
            let [a, b] = [&a, &b].map(|triangle| triangle.map(|at| at.map(|x| tiny * x)));
            let precision = Precision::Double;
            assert_eq!(found, adjacent_contact(precision, numbers, &a, &b, &mut 0));
            let common = numbers[0].iter().collect::<std::collections::BTreeSet<_>>();
            let common = common
                .into_iter()
                .filter(|number| numbers[1].contains(number));
            seen[common.count()][found.map_or(3, |kind| kind as usize)] += 1;
        }
        // Touching, overlapping, crossing, none; two corners in common never cross.
        for (common, kinds) in seen.iter().enumerate() {
            let never = [false, false, common >= 2, common == 3];
            for (kind, &count) in kinds.iter().enumerate() {
                let is_possible = common != 3 && !never[kind] || common == 3 && kind == 1;
                assert_eq!(count > 30, is_possible, "{common} {kind}: {seen:?}");
            }
        }
    }

    fn kind(number: u8) -> ContactKind {
        [
            ContactKind::Touching,
            ContactKind::Overlapping,
            ContactKind::Crossing,
        ][usize::from(number)]
    }
}
