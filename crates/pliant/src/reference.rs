//! Slow and obviously right: every pair of triangles, no tree, no box, no filter, exact signs.
//!
//! Every configuration of [`World`](crate::World) must give these pairs. O(m^2) or O(m_a m_b) exact decisions.

use crate::Scalar;
use crate::error::Error;
use crate::mesh::share_a_vertex;
use crate::predicates::{Exact, Triangle, triangles_intersect};

/// The pairs (triangle of a, triangle of b) that intersect, sorted.
///
/// # Errors
///
/// [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange), [`BadPosition`](crate::ErrorKind::BadPosition) and the others of
/// [`World::add`](crate::World::add).
pub fn intersection_pairs<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let (a, b) = (
        corners(triangles_a, positions_a)?,
        corners(triangles_b, positions_b)?,
    );
    Ok(pairs_of_two(&a, &b))
}

fn pairs_of_two(a: &[Triangle], b: &[Triangle]) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            if triangles_intersect(a, b, &mut Exact) {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}

/// The pairs (smaller triangle, larger triangle) of one body that intersect and share no vertex, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`].
pub fn self_intersection_pairs<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let all = corners(triangles, positions)?;
    Ok(pairs_of_one(triangles, &all))
}

fn pairs_of_one(triangles: &[[u32; 3]], all: &[Triangle]) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate().skip(i + 1) {
            if !share_a_vertex(triangles[i], triangles[j]) && triangles_intersect(a, b, &mut Exact)
            {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}

fn corners<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<Triangle>, Error> {
    crate::world::validate_body(triangles, positions).map_err(|kind| Error { body: None, kind })?;
    let corner = |vertex: u32| positions[vertex as usize].map(Scalar::to_f64);
    Ok(triangles
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect())
}
