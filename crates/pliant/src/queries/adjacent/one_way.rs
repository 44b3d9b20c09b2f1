//! Whether a star is seen without overlaps from some direction, any direction.
//!
//! Idea: a direction is sought along which all triangles of the star face up. The first is the mean
//! of their normals. Then the normal that faces up least is added, as a perceptron does. Invariant:
//! yes is certain; no says nothing. Source: the perceptron of Rosenblatt 1958.

use super::sector::Sector;
use crate::geometry::vector::{self, dot};

/// Most directions that are tried.
const MOST_TRIED: usize = 8;

/// Largest relative error of a sum of two products of differences, and of a scalar product with it.
const ERROR: f64 = 10.0 * (f64::EPSILON / 2.0);
/// Far above all that is lost below the normal range: 2^-1022, times two lengths below 2^130.
const LOST: f64 = 1e-220;

type Vector = vector::Vector<f64>;

/// Normal of the triangle at the vertex between two edges, with the sizes of its terms.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wing {
    edges: [Vector; 2],
    normal: Vector,
    terms: Vector,
}

impl Wing {
    /// From the two edges at the vertex, each a difference of positions.
    pub(super) fn new(edges: [Vector; 2]) -> Self {
        let [e, f] = edges;
        let of = |i: usize, j: usize| [e[i] * f[j], e[j] * f[i]];
        let products = [of(1, 2), of(2, 0), of(0, 1)];
        Self {
            edges,
            normal: products.map(|[p, q]| p - q),
            terms: products.map(|[p, q]| p.abs() + q.abs()),
        }
    }

    /// Box round the directions from the vertex into the triangle.
    pub(super) fn sector(&self, place: usize) -> Sector {
        Sector::new(place, self.edges)
    }

    /// The side of the triangle's plane on which the end of an edge at the vertex certainly lies.
    fn side(&self, edge: Vector) -> Option<bool> {
        let height = dot(edge, self.normal);
        let bound = ERROR * dot(edge.map(f64::abs), self.terms) + LOST;
        (height.abs() > bound).then_some(height > 0.0)
    }

    /// Whether another triangle at the vertex certainly lies on one side of this one's plane.
    ///
    /// Then they meet in nothing but the corners that they have in common. `is_common` says whether
    /// the other's two corners beside the vertex are such.
    pub(super) fn has_on_one_side(&self, other: &Self, is_common: [bool; 2]) -> bool {
        match is_common {
            [true, true] => false,
            [true, false] => self.side(other.edges[1]).is_some(),
            [false, true] => self.side(other.edges[0]).is_some(),
            [false, false] => {
                let [from, to] = other.edges.map(|edge| self.side(edge));
                from.is_some() && from == to
            }
        }
    }
}

/// Whether a fan is certainly seen without overlaps from some direction.
///
/// # Proof
///
/// As of `mark_overlapping_stars`, with any direction n in the place of an axis. The line across
/// is (n_y, -n_x, 0) or one of its like, which is exactly perpendicular to n.
///
/// # Rounding
///
/// Each difference has one rounding, each component of a normal three more, the product with n or
/// an edge four more: eight in all. Two products and their difference have four. [`ERROR`] is ten.
pub(super) fn is_seen_without_overlaps(star: &[Wing], is_closed: bool) -> bool {
    let mut direction = [0.0; 3];
    let mut next = star.iter().map(unit).fold([0.0; 3], plus);
    for _ in 0..MOST_TRIED {
        direction = plus(direction, next);
        let length = dot(direction, direction).sqrt();
        if length == 0.0 || length.is_nan() {
            return false;
        }
        let n = direction.map(|x| x / length);
        if star.iter().all(|wing| wing.side(n) == Some(true)) {
            return crosses_once(star, n, is_closed);
        }
        let units = star.iter().map(unit);
        let worst = units.min_by(|p, q| dot(n, *p).total_cmp(&dot(n, *q)));
        next = worst.unwrap_or_default();
    }
    false
}

/// Whether a star that faces up along n goes round its vertex once, or less if it is open.
fn crosses_once(star: &[Wing], n: Vector, is_closed: bool) -> bool {
    (0..3).any(|axis| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        // The side of the line on which the end of an edge certainly lies.
        let side = |edge: Vector| {
            let (p, q) = (n[j] * edge[i], n[i] * edge[j]);
            let bound = ERROR * (p.abs() + q.abs()) + LOST;
            (p - q).abs().gt(&bound).then_some(p > q)
        };
        let mut crossed = 0;
        for wing in star {
            let [Some(from), Some(to)] = wing.edges.map(side) else {
                return false;
            };
            crossed += usize::from(from != to);
        }
        if is_closed {
            crossed == 2
        } else {
            crossed <= 1
        }
    })
}

fn unit(wing: &Wing) -> Vector {
    let length = dot(wing.normal, wing.normal).sqrt();
    wing.normal.map(|x| x / length)
}

fn plus(p: Vector, q: Vector) -> Vector {
    [p[0] + q[0], p[1] + q[1], p[2] + q[2]]
}
