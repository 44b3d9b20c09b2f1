//! Clearance of vertices: half the least distance of all pairs of elements that a vertex is a
//! corner of.
//!
//! Two elements at a distance d meet only if some point of one and some point of the other come
//! together. No point of an element moves further than its corners; so where each corner moves less
//! than d / 2, they do not meet. Triangles begin to intersect where a vertex meets a triangle or
//! two edges meet. Chen et al. 2025, Offset Geometric Contact, give each vertex such a bound. A
//! distance is off by at most 2^-30 of itself, so clearances are d / 2 less 2^-29 of it.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::most;
use crate::selection::Selection;
use crate::threads::Question;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Factor by which a distance is rounded down: 1 - 2^-29.
const ROUNDED: f64 = 1.0 - f64::from_bits((1023 - 29) << 52);

/// Half of what a distance is more than the thickness of two elements, rounded down.
fn half_of(distance: f64, thickness: [f64; 2]) -> f64 {
    let [a, b] = thickness;
    // Among the smallest numbers a step is more than 2^-29. A difference is off by less than that
    // of the distance.
    ((distance * ROUNDED - a - b) / 2.0).next_down().max(0.0)
}

/// A body as its clearance is computed.
struct Mesh {
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    thickness: Vec<f64>,
}

/// Half the least distance so far, for each vertex of each body.
type Clearances = BTreeMap<BodyId, Vec<f64>>;

/// # Questions: clearance of vertices
impl<S: Scalar> World<S> {
    /// Computes how far each vertex may move before anything can touch, in the unit of the
    /// positions.
    ///
    /// Returns n numbers for each body of the selection, each at most half of `cut_off`. A number
    /// is half the least distance of the pairs that the vertex is a corner of. They are the pairs
    /// of a vertex and a triangle, and of two edges, that have no vertex in common, as
    /// [`close_vertex_triangle_pairs`](Self::close_vertex_triangle_pairs) looks at them. It is
    /// rounded down by at most 1e-6 of itself and 1e-323, and is 0 where something touches.
    /// [Thickness](Self::set_thickness) is taken off each distance; the number is then rounded down
    /// by at most 2^-29 of the distance.
    ///
    /// Let every vertex move less than that, in whatever direction. Then none of these pairs
    /// touches, or comes nearer than it is thick, on the way or at the end. Pairs that filters or
    /// vertex groups keep apart do not count. Rest shapes leave out none.
    ///
    /// Cost: both queries for close pairs within `cut_off`.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &large)?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.5], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// let clearance = world.clearance(Selection::World, 2.0)?;
    /// assert!(clearance[&leaf][0] <= 0.25 && clearance[&leaf][0] > 0.249_999);
    /// assert!(clearance[&leaf][1] > 0.999_999);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Query`](crate::Query).
    pub fn clearance(
        &mut self,
        of: Selection,
        cut_off: f64,
    ) -> Result<BTreeMap<BodyId, Vec<f64>>, Error> {
        self.find_clearance(of, cut_off, None)
    }

    /// [`World::clearance`].
    pub(super) fn find_clearance(
        &mut self,
        of: Selection,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Clearances, Error> {
        let mut clearances = Clearances::new();
        let mut meshes: BTreeMap<BodyId, Mesh> = BTreeMap::new();
        for body in self.bodies_of(of) {
            let vertices = self.vertex_count(body)?;
            clearances.insert(body, vec![half_of(cut_off, [0.0; 2]); vertices]);
            let mesh = Mesh {
                triangles: self.triangles(body)?.to_vec(),
                edges: self.edges(body)?.to_vec(),
                thickness: self.thickness(body)?,
            };
            meshes.insert(body, mesh);
        }
        let mut take = |elements: [(BodyId, &[u32]); 2], distance: f64| {
            let thickness = elements.map(|(body, vertices)| {
                let of_body = meshes.get(&body).map(|mesh| &mesh.thickness);
                of_body.map_or(0.0, |all| most(vertices.iter().map(|&it| all[it as usize])))
            });
            let half = half_of(distance, thickness);
            for (body, vertices) in elements {
                let Some(of_body) = clearances.get_mut(&body) else {
                    continue;
                };
                for &vertex in vertices {
                    let least = &mut of_body[vertex as usize];
                    *least = least.min(half);
                }
            }
        };

        let close = self.close_vertex_triangle_pairs(of, cut_off);
        let close = close.leaving_nothing_out().interrupt(question);
        let _ = close.visit_some(|close| {
            for close in close {
                let pair = close.pair;
                if let Some(mesh) = meshes.get(&pair.triangle_body) {
                    let corners = &mesh.triangles[pair.triangle as usize];
                    let vertex = (pair.vertex_body, &[pair.vertex][..]);
                    take([vertex, (pair.triangle_body, corners)], close.distance);
                }
            }
            ControlFlow::<()>::Continue(())
        })?;
        let close = self.close_edge_edge_pairs(of, cut_off);
        let close = close.leaving_nothing_out().interrupt(question);
        let _ = close.visit_some(|close| {
            for close in close {
                let pair = close.pair;
                let ends = [(pair.body_a, pair.edge_a), (pair.body_b, pair.edge_b)]
                    .map(|(body, edge)| Some((body, &meshes.get(&body)?.edges[edge as usize][..])));
                if let [Some(a), Some(b)] = ends {
                    take([a, b], close.distance);
                }
            }
            ControlFlow::<()>::Continue(())
        })?;
        Ok(clearances)
    }
}
