#![doc = include_str!("../README.md")]

mod adjacent;
mod contact_kind;
mod crossing_edges;
pub mod distance;
mod element_pairs;
mod environment;
mod float;
mod gap;
mod integer;
mod intersection;
mod lattice;
mod length;
pub mod motion;
mod orientation;
mod point;
mod ray;
pub mod reference;
mod ring;
mod triangles;
mod vector;

pub use adjacent::adjacent_contact;
pub use contact_kind::ContactKind;
pub use crossing_edges::crossing_edges;
pub use element_pairs::{
    ELEMENT_PAIRS, FIRST_OF_EDGES, barycentric, four_corners, is_swapped, on_edge,
};
pub use environment::{Precision, denormals_are_kept, is_in_range};
pub use gap::are_boxes_within;
pub use intersection::{End, Feature, Intersection, intersection};
use lattice::on_lattice;
pub use length::Length;
use orientation::{Certain, Filtered, Orientation};
pub use point::{Point, Triangle};
pub use ray::{Axis, Crossing, crossing};
use std::cmp::Ordering;

/// Whether debug assertions are compiled: the library asks this for its own.
///
/// Tests of this workspace compile `pliant` without debug assertions. Assertions inside the
/// standard library would be added to each vector instruction, and take half of the time.
#[doc(hidden)]
pub const DEBUG: bool = cfg!(debug_assertions);

/// Whether a triangle has no area: its corners lie on a line, or in a point.
///
/// Exact, for coordinates that are [in range](is_in_range); with others the answer is false. Single
/// precision, widened, is as good. Cost: nanoseconds, or about a microsecond where rounding does
/// not decide.
///
/// ```
/// use pliant_exact::is_degenerate;
///
/// assert!(is_degenerate([[0.0; 3], [1.0; 3], [3.0; 3]]));
/// assert!(!is_degenerate([[0.0; 3], [1.0; 3], [3.0, 3.0, 3.0 + 1e-15]]));
/// ```
pub fn is_degenerate([a, b, c]: [[f64; 3]; 3]) -> bool {
    if ![a, b, c].iter().all(is_in_range) {
        return false;
    }
    // Two corners in one place need no arithmetic, and are most of what there is.
    a == b
        || b == c
        || c == a
        || point::PLANES.into_iter().all(|plane| {
            let [a, b, c] = point::projected(&[a, b, c], plane);
            orientation::orientation_2d(a, b, c) == 0
        })
}

/// The side of a triangle's plane on which a point lies. `Greater` is where its normal (b - a) x (c
/// - a) points to, `Less` behind it, `Equal` in the plane.
///
/// Of a triangle without area it is always `Equal`. Exact, for coordinates that are [in
/// range](is_in_range); with others the answer is `Equal`. Single precision, widened, is as good.
/// Cost: nanoseconds, or about a microsecond where rounding does not decide.
///
/// ```
/// use std::cmp::Ordering::{Equal, Greater, Less};
///
/// let floor = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let sides = [1e-300, 0.0, -1e-300].map(|z| pliant_exact::side_of_plane(floor, [5.0, 7.0, z]));
/// assert_eq!(sides, [Greater, Equal, Less]);
/// ```
pub fn side_of_plane([a, b, c]: [[f64; 3]; 3], point: [f64; 3]) -> Ordering {
    if [a, b, c, point].iter().all(is_in_range) {
        let mut filtered = Filtered::new(Precision::Double);
        filtered.sign(&a, &b, &c, &point).cmp(&0)
    } else {
        Ordering::Equal
    }
}

/// Whether two closed triangles have a point in common; a degenerate triangle is the segment or
/// point that it is.
///
/// Adds one to `exact` if floating point alone did not decide. Exact, for coordinates that are [in
/// range](is_in_range). Where floating point is not certain, integers of 192 bits are asked,
/// because exact contact mostly has room in them, then expansions. Cost: some hundred nanoseconds.
/// The formulation is this crate's own, after Guigue and Devillers (2003).
///
/// ```
/// use pliant_exact::{Precision, intersect};
///
/// let floor = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let above = |z: f64| [[0.2, 0.2, z], [0.2, 0.2, 1.0], [0.3, 0.2, 1.0]];
/// let meets = |z: f64| intersect(Precision::Double, &floor, &above(z), &mut 0);
/// assert_eq!([1e-300, 0.0, -1e-300].map(meets), [false, true, true]);
/// ```
#[inline]
pub fn intersect(precision: Precision, a: &Triangle, b: &Triangle, exact: &mut u64) -> bool {
    let mut certain = Certain::new(precision);
    let intersect = triangles::triangles_intersect(a, b, &mut certain);
    if certain.are_all() {
        return intersect;
    }
    *exact += 1;
    if let Some(intersect) = on_lattice!(precision, a, b, |a, b, signs| {
        triangles::triangles_intersect(&a, &b, signs)
    }) {
        return intersect;
    }
    triangles::triangles_intersect(a, b, &mut Filtered::new(precision))
}

/// How two triangles intersect that are known to; as exact as [`intersect`], and about as fast. Of
/// two that do not the answer says nothing.
///
/// ```
/// use pliant_exact::{ContactKind, Precision, contact_kind};
///
/// let floor = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let above = |z: f64| [[0.2, 0.2, z], [0.2, 0.2, 1.0], [0.3, 0.2, 1.0]];
/// let kind = |z: f64| contact_kind(Precision::Double, &floor, &above(z));
/// assert_eq!([0.0, -1e-300].map(kind), [ContactKind::Touching, ContactKind::Crossing]);
/// ```
pub fn contact_kind(precision: Precision, a: &Triangle, b: &Triangle) -> ContactKind {
    on_lattice!(precision, a, b, |a, b, signs| {
        contact_kind::contact_kind(&a, &b, signs)
    })
    .unwrap_or_else(|| contact_kind::contact_kind(a, b, &mut Filtered::new(precision)))
}
