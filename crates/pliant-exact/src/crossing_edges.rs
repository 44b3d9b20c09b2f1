//! Edges of two triangles that cross the other one.

use super::environment::Precision;
use super::lattice::on_lattice;
use super::orientation::{Certain, Filtered, Orientation};
use super::point::{Sign, Triangle};
use super::triangles::one_side;

/// Which edges of each triangle cross the other: the open edge meets the open triangle, and not in
/// its plane.
///
/// Edge i goes from corner i to the next. An edge that touches, or lies in the plane, does not
/// cross; nor does one with a corner in common. Two triangles that go through each other, with no
/// corner or edge on the other, have two crossing edges in all. Crossing edges stay after every
/// small enough move. As exact as [`intersect`](crate::intersect), and about as fast.
///
/// ```
/// use pliant_exact::{Precision, crossing_edges};
///
/// let floor = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let above = |z: f64| [[1.0, 1.0, z], [1.0, 1.0, 1.0], [1.5, 1.0, 1.0]];
/// let crossing = |z| crossing_edges(Precision::Double, &floor, &above(z));
/// assert_eq!(crossing(-1.0), [[false; 3], [true, false, true]]);
/// assert_eq!(crossing(0.0), [[false; 3]; 2]);
/// ```
pub fn crossing_edges(precision: Precision, a: &Triangle, b: &Triangle) -> [[bool; 3]; 2] {
    // Triangles that cross are mostly in general position.
    let mut certain = Certain::new(precision);
    let found = of_both(a, b, &mut certain);
    if certain.are_all() {
        return found;
    }
    on_lattice!(precision, a, b, |a, b, signs| of_both(&a, &b, signs))
        .unwrap_or_else(|| of_both(a, b, &mut Filtered::new(precision)))
}

fn of_both(a: &Triangle, b: &Triangle, orientation: &mut impl Orientation) -> [[bool; 3]; 2] {
    let none = [[false; 3]; 2];
    let of_b = orientation.plane_signs(a, b);
    if one_side(of_b) {
        return none;
    }
    let of_a = orientation.plane_signs(b, a);
    if one_side(of_a) {
        return none;
    }
    [
        crossing(a, of_a, b, orientation),
        crossing(b, of_b, a, orientation),
    ]
}

/// Edges of a triangle, with its corners on these sides of the other's plane, that cross the other.
fn crossing(
    triangle: &Triangle,
    sides: [Sign; 3],
    other: &Triangle,
    orientation: &mut impl Orientation,
) -> [bool; 3] {
    let mut crossing = [false; 3];
    for i in 0..3 {
        let next = (i + 1) % 3;
        if sides[i] * sides[next] >= 0 {
            continue;
        }
        let (p, q) = (&triangle[i], &triangle[next]);
        let mut past = |j: usize| orientation.sign(p, q, &other[j], &other[(j + 1) % 3]);
        let first = past(0);
        crossing[i] = first != 0 && past(1) == first && past(2) == first;
    }
    crossing
}

#[cfg(test)]
mod tests {
    use super::super::orientation::Exact;
    use super::super::triangles::edge;
    use super::*;
    use pliant_oracle::{Class, ContactKind, Random, contact_kind};

    /// An edge crosses a triangle if the segment, as a triangle without area, does.
    #[test]
    fn crossing_edges_are_the_oracles() {
        let mut random = Random::new(9);
        let mut seen = [0; 7];
        for class in Class::ALL {
            for _ in 0..400 {
                let [a, b] = class.pair(&mut random);
                let found = crossing_edges(Precision::Double, &a, &b);
                let expected = |triangle: &Triangle, other: &Triangle| {
                    [0, 1, 2].map(|i| {
                        let [p, q] = edge(triangle, i);
                        contact_kind(&[p, q, q], other) == ContactKind::Crossing
                    })
                };
                assert_eq!(found, [expected(&a, &b), expected(&b, &a)], "{a:?} {b:?}");
                assert_eq!(found, of_both(&a, &b, &mut Exact));
                let [of_a, of_b] = found;
                assert_eq!(
                    crossing_edges(Precision::Double, &b, &a),
                    [of_b, of_a],
                    "{a:?} {b:?}"
                );
                seen[found.as_flattened().iter().filter(|it| **it).count()] += 1;
            }
        }
        // Two edges, or one beside a corner or an edge on the other triangle, or none.
        assert!(seen[..3].iter().all(|&count| count > 20), "{seen:?}");
        assert!(seen[3..].iter().all(|&count| count == 0), "{seen:?}");
    }
}
