//! Reference of impacts: all pairs of elements that meet on the way, and when first, decided in
//! integers.

use crate::all_pairs::{Element, ElementPairs, Moving};
use crate::error::Error;
use crate::geometry::Real;
use crate::world::scalar::Scalar;
use pliant_exact::motion::{self, Grid, first_contact};

/// Two elements by number, and the interval of times of their first contact.
pub type Timed = ([u32; 2], [f64; 2]);

/// Pairs (vertex of a, triangle of b) that meet on the way, sorted, as in
/// [`World::vertex_triangle_impacts`](crate::World::vertex_triangle_impacts).
///
/// The width is finite, and at least 0. Cost: O(n_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn vertex_triangle_impacts<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    that_meet(ElementPairs::VerticesAndTriangles, a, Some(b), width)
}

/// Pairs (vertex, triangle) of one body that meet on the way, sorted. Cost: O(n m).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_vertex_triangle_impacts<S: Scalar>(
    body: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    that_meet(ElementPairs::VerticesAndTriangles, body, None, width)
}

/// Pairs (edge of a, edge of b) that meet on the way, sorted, as in
/// [`World::edge_edge_impacts`](crate::World::edge_edge_impacts). Cost: O(m_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn edge_edge_impacts<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    that_meet(ElementPairs::EdgesAndEdges, a, Some(b), width)
}

/// Pairs (smaller edge, larger edge) of one body that meet on the way, sorted. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_edge_edge_impacts<S: Scalar>(
    body: &Moving<S>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    that_meet(ElementPairs::EdgesAndEdges, body, None, width)
}

/// Pairs that meet on the way, with the intervals of their first contact.
fn that_meet<S: Real>(
    elements: ElementPairs,
    a: &Moving<S>,
    other: Option<&Moving<S>>,
    width: f64,
) -> Result<Vec<Timed>, Error> {
    let grid = Grid::new(width);
    elements.all(a, other, |a, b| {
        let contact = first_contact(&elements_in_motion(a, b)?)?;
        Some(contact.cell(grid))
    })
}

/// Converts two elements to what the exact decision takes, if their boxes overlap.
fn elements_in_motion<S: Real>(
    (a, of_a): Element<S>,
    (b, of_b): Element<S>,
) -> Option<motion::Moving> {
    if !a.box_of(of_a).are_within(&b.box_of(of_b), 0.0) {
        return None;
    }
    let both = || {
        let of_both = of_a.iter().map(|&vertex| (a, vertex));
        of_both.chain(of_b.iter().map(|&vertex| (b, vertex)))
    };
    let start = both().map(|(body, vertex)| body.positions[vertex as usize]);
    let end = both().map(|(body, vertex)| body.end.unwrap_or(body.positions)[vertex as usize]);
    let four = |corners: Vec<[S; 3]>| -> Option<[[f64; 3]; 4]> {
        let corners: [[S; 3]; 4] = corners.try_into().ok()?;
        Some(corners.map(|corner| corner.map(Real::to_f64)))
    };
    Some(motion::Moving {
        are_edges: of_a.len() == 2,
        corners: [four(start.collect())?, four(end.collect())?],
    })
}
