//! Feature pairs: each contact of close elements once, whatever number of pairs it comes up in.
//!
//! Idea: a contact is named by its closest features, which are decided exactly. Rows of one name
//! are one contact. Source: the collisions that ipc-toolkit sums (Li et al. 2020, *Incremental
//! Potential Contact*). Difference: rounding decides no feature.

use crate::error::Error;
use crate::geometry::vector::{dot, minus, square_of};
use crate::ids::BodyId;
use crate::queries::{
    CloseEdgeEdge, CloseVertexTriangle, ClosestFeatures, EdgeEdge, VertexTriangle,
};
use crate::selection::Selection;
use crate::threads::Question;
use crate::world::{NamedBodies, Scalar, World};
use pliant_exact::Feature;
use pliant_exact::distance::{Primitives, closest_features};
use std::ops::Range;

/// Two features that are close: a contact, as solvers sum it.
///
/// A vertex near an edge is close to both triangles there, and each edge at the vertex is close to
/// that edge. All these close pairs have the same closest features, and are one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeaturePair {
    /// Kinds of the two features.
    pub features: ClosestFeatures,
    /// The bodies of the first feature and of the second.
    pub bodies: [BodyId; 2],
    /// Numbers of the features: of a vertex, an edge as [`World::edges`] numbers it, or a triangle.
    ///
    /// A vertex comes before an edge or a face. Of two vertices or two edges the lower comes first,
    /// by body and number.
    pub numbers: [u32; 2],
    /// Vertices of the first feature, then of the second; `u32::MAX` in the rest.
    ///
    /// An edge has two, as [`World::edges`] orders them, a face three.
    pub vertices: [u32; 4],
    /// Weights of these vertices in the closest points. The weights of either feature sum to 1, up
    /// to rounding.
    pub weights: [f64; 4],
    /// Distance of the two, in the unit of the positions.
    pub distance: f64,
    /// Unit vector from the second feature to the first. None if they touch.
    pub direction: Option<[f64; 3]>,
    /// How many close pairs, of both lists, it stands for.
    pub multiplicity: u32,
}

impl FeaturePair {
    /// Places, in vertices and weights, of the first feature and of the second.
    pub fn places(&self) -> [Range<usize>; 2] {
        let (first, end) = match self.features {
            ClosestFeatures::VertexVertex => (1, 2),
            ClosestFeatures::VertexEdge => (1, 3),
            ClosestFeatures::EdgeEdge => (2, 4),
            ClosestFeatures::VertexFace => (1, 4),
        };
        [0..first, first..end]
    }
}

/// Contacts of close elements, each once: a vertex and a vertex, an edge or a face, or two edges.
///
/// Close pairs have a contact as often as triangles and edges have it. A barrier that is summed
/// over contacts, each weighted by its multiplicity, is the sum over all close pairs, in fewer
/// terms. With weight 1 it would jump where the closest features change. Rows are sorted: vertices
/// with vertices, then vertices with edges, edges with edges, vertices with faces, each by bodies
/// and numbers. Multiplicities sum to the lengths of the two lists.
///
/// Which features are closest is exact, in real arithmetic on the numbers given. Parallel edges
/// have several; the contact is the first of them in order. Distance, direction and weights have
/// the bounds of [`CloseVertexTriangle`].
///
/// ```
/// # use pliant::{ClosestFeatures, FeaturePairs, Selection, World};
/// // The tip of a leaf above the side that two triangles of a floor have in common.
/// let mut world = World::<f64>::new();
/// let square = [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
/// let floor = world.add(&[[0, 1, 2], [0, 2, 3]], &square)?;
/// let leaf = world.add(&[[0, 1, 2]], &[[2.0, 2.0, 0.25], [2.0, 3.0, 3.0], [3.0, 2.0, 3.0]])?;
/// let vertices = world.close_vertex_triangle_pairs(Selection::World, 0.5).all()?.to_vec();
/// let edges = world.close_edge_edge_pairs(Selection::World, 0.5).all()?.to_vec();
/// assert_eq!((vertices.len(), edges.len()), (2, 2));
///
/// let mut contacts = FeaturePairs::new();
/// contacts.update(&world, &vertices, &edges)?;
/// let [contact] = contacts.all() else { panic!() };
/// assert_eq!(contact.features, ClosestFeatures::VertexEdge);
/// assert_eq!((contact.bodies, contact.multiplicity), ([leaf, floor], 4));
/// assert_eq!(contact.vertices, [0, 0, 2, u32::MAX]);
/// assert_eq!(contact.weights, [1.0, 0.5, 0.5, 0.0]);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct FeaturePairs {
    rows: Vec<FeaturePair>,
    /// Name of each close pair, and its place in both lists: kept from call to call.
    named: Vec<(Name, usize)>,
}

/// Name of a contact: the place of its kind in the order, and both features by body and number.
type Name = (u8, [(BodyId, u32); 2]);

impl FeaturePairs {
    /// Without any contacts.
    pub fn new() -> Self {
        Self::default()
    }

    /// Finds the contacts of these close pairs in the present shapes of a world, and forgets all
    /// before. If it is refused, there are no contacts.
    ///
    /// Cost: O(n) for the bodies named, and about a microsecond a pair, on one thread.
    ///
    /// # Errors
    ///
    /// If the lists are of another world or another mesh:
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`NoSuchTriangle`](crate::ErrorKind::NoSuchTriangle),
    /// [`EmptyTriangle`](crate::ErrorKind::EmptyTriangle),
    /// [`NoSuchVertex`](crate::ErrorKind::NoSuchVertex),
    /// [`EmptyVertex`](crate::ErrorKind::EmptyVertex),
    /// [`NoSuchEdge`](crate::ErrorKind::NoSuchEdge).
    pub fn update<S: Scalar>(
        &mut self,
        world: &World<S>,
        vertices: &[CloseVertexTriangle],
        edges: &[CloseEdgeEdge],
    ) -> Result<(), Error> {
        self.rows.clear();
        self.named.clear();
        let of_vertices = vertices.iter().map(|it| it.pair);
        let of_vertices = of_vertices.flat_map(|pair| [pair.vertex_body, pair.triangle_body]);
        let of_edges = edges.iter().map(|it| it.pair);
        let of_edges = of_edges.flat_map(|pair| [pair.body_a, pair.body_b]);
        let bodies = NamedBodies::of(world, of_vertices.chain(of_edges))?;
        for (close, place) in vertices.iter().zip(0..) {
            let name = bodies.name_of_vertex_and_triangle(close.pair)?;
            self.named.push((name, place));
        }
        for (close, place) in edges.iter().zip(vertices.len()..) {
            self.named.push((bodies.name_of_edges(close.pair)?, place));
        }
        self.named.sort_unstable();
        for same in self.named.chunk_by(|(a, _), (b, _)| a == b) {
            let (name, place) = same[0];
            let contact = match place.checked_sub(vertices.len()) {
                None => bodies.of_vertex_and_triangle(name, &vertices[place]),
                Some(place) => bodies.of_edges(name, &edges[place]),
            };
            let multiplicity = same.len() as u32;
            self.rows.push(FeaturePair {
                multiplicity,
                ..contact?
            });
        }
        Ok(())
    }

    /// Finds the contacts of all elements at most `distance` apart, for bindings.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`](crate::Query).
    #[doc(hidden)]
    pub fn ask<S: Scalar>(
        &mut self,
        world: &mut World<S>,
        (of, distance): (Selection, f64),
        question: Option<Question>,
    ) -> Result<(), Error> {
        let vertices = world.close_vertex_triangle_pairs(of, distance);
        let vertices = vertices.interrupt(question).all()?.to_vec();
        let edges = world.close_edge_edge_pairs(of, distance);
        let edges = edges.interrupt(question).all()?.to_vec();
        self.update(world, &vertices, &edges)
    }

    /// All contacts, sorted.
    pub fn all(&self) -> &[FeaturePair] {
        &self.rows
    }

    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no contact.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// A feature of a mesh: 0 for a vertex, 1 for an edge, 2 for a face; its body and its number there.
type Named = (u8, BodyId, u32);

/// Name of a contact of two features. The first is the lower.
fn name_of(a: Named, b: Named) -> Name {
    let [(a, body_a, number_a), (b, body_b, number_b)] = if b < a { [b, a] } else { [a, b] };
    let kind = match (a, b) {
        (0, 0) => VERTICES,
        (0, 1) => VERTEX_EDGE,
        (1, 1) => EDGES,
        _ => VERTEX_FACE,
    };
    (kind, [(body_a, number_a), (body_b, number_b)])
}

const VERTICES: u8 = 0;
const VERTEX_EDGE: u8 = 1;
const EDGES: u8 = 2;
const VERTEX_FACE: u8 = 3;

/// The lowest name of the closest features of two elements.
fn lowest_name(
    elements: &Primitives,
    named: impl Fn(usize, Feature) -> Option<Named>,
) -> Option<Name> {
    let mut lowest: Option<Name> = None;
    closest_features(elements, |[of_a, of_b]| {
        if let (Some(a), Some(b)) = (named(0, of_a), named(1, of_b)) {
            let name = name_of(a, b);
            lowest = Some(lowest.map_or(name, |lowest| lowest.min(name)));
        }
    });
    lowest
}

impl<S: Scalar> NamedBodies<'_, S> {
    fn name_of_vertex_and_triangle(&self, pair: VertexTriangle) -> Result<Name, Error> {
        let VertexTriangle {
            vertex_body,
            vertex,
            triangle_body,
            triangle,
        } = pair;
        let corners = self.corners(triangle_body, triangle)?;
        let [p] = self.points(vertex_body, [vertex])?;
        let [a, b, c] = self.points(triangle_body, corners)?;
        let sides = self.sides(triangle_body, triangle);
        let named = |which: usize, on| match (which, on) {
            (0, _) => Some((0, vertex_body, vertex)),
            (_, Feature::Corner(k)) => Some((0, triangle_body, corners[k])),
            (_, Feature::Edge(k)) => sides[k].map(|edge| (1, triangle_body, edge)),
            (_, Feature::Inside) => Some((2, triangle_body, triangle)),
        };
        let whole = name_of((0, vertex_body, vertex), (2, triangle_body, triangle));
        let elements = Primitives::VertexTriangle([p, a, b, c]);
        Ok(lowest_name(&elements, named).unwrap_or(whole))
    }

    fn name_of_edges(&self, pair: EdgeEdge) -> Result<Name, Error> {
        let of = [(pair.body_a, pair.edge_a), (pair.body_b, pair.edge_b)];
        let mut ends = [[0; 2]; 2];
        for (ends, (body, edge)) in ends.iter_mut().zip(of) {
            *ends = self.ends(body, edge)?;
        }
        let [a0, a1] = self.points(pair.body_a, ends[0])?;
        let [b0, b1] = self.points(pair.body_b, ends[1])?;
        let named = |which: usize, on| match on {
            Feature::Corner(k) => Some((0, of[which].0, ends[which][k])),
            _ => Some((1, of[which].0, of[which].1)),
        };
        let whole = name_of((1, of[0].0, of[0].1), (1, of[1].0, of[1].1));
        let elements = Primitives::EdgeEdge([a0, a1, b0, b1]);
        Ok(lowest_name(&elements, named).unwrap_or(whole))
    }

    /// The contact of a name, measured as this pair is.
    fn of_vertex_and_triangle(
        &self,
        name: Name,
        close: &CloseVertexTriangle,
    ) -> Result<FeaturePair, Error> {
        let first = (close.pair.vertex_body, &[close.pair.vertex][..]);
        let [u, v, w] = close.barycentric;
        let mut row = self.contact(name, first, (close.distance, close.direction))?;
        if row.features == ClosestFeatures::VertexFace {
            row.weights = [1.0, u, v, w];
        }
        Ok(row)
    }

    /// The contact of a name, measured as this pair is.
    fn of_edges(&self, name: Name, close: &CloseEdgeEdge) -> Result<FeaturePair, Error> {
        let pair = close.pair;
        let ends = self.ends(pair.body_a, pair.edge_a)?;
        let first = (pair.body_a, &ends[..]);
        let mut row = self.contact(name, first, (close.distance, close.direction))?;
        if row.features == ClosestFeatures::EdgeEdge {
            let (mut a, mut b) = (close.barycentric_a, close.barycentric_b);
            if name.1[0] != (pair.body_a, pair.edge_a) {
                (a, b) = (b, a);
            }
            row.weights = [a[0], a[1], b[0], b[1]];
        }
        Ok(row)
    }

    /// The contact of a name, without weights of insides of faces and of two edges. `first` is the
    /// first element of a pair that has it, with its vertices; the direction is to that.
    fn contact(
        &self,
        (kind, [(body_a, a), (body_b, b)]): Name,
        (body, first): (BodyId, &[u32]),
        (distance, direction): (f64, Option<[f64; 3]>),
    ) -> Result<FeaturePair, Error> {
        let (mut weights, mut vertices) = ([0.0; 4], [u32::MAX; 4]);
        let features = match kind {
            VERTICES => {
                vertices[..2].copy_from_slice(&[a, b]);
                weights[..2].copy_from_slice(&[1.0; 2]);
                ClosestFeatures::VertexVertex
            }
            VERTEX_EDGE => {
                let ends = self.ends(body_b, b)?;
                vertices[..3].copy_from_slice(&[a, ends[0], ends[1]]);
                let [p] = self.points(body_a, [a])?;
                let along = along(p, self.points(body_b, ends)?);
                weights[..3].copy_from_slice(&[1.0, 1.0 - along, along]);
                ClosestFeatures::VertexEdge
            }
            EDGES => {
                let [[p, q], [r, s]] = [self.ends(body_a, a)?, self.ends(body_b, b)?];
                vertices = [p, q, r, s];
                ClosestFeatures::EdgeEdge
            }
            _ => {
                let [p, q, r] = self.corners(body_b, b)?;
                vertices = [a, p, q, r];
                ClosestFeatures::VertexFace
            }
        };
        // Elements of one body that share a vertex are no pair, so it is of one of the two.
        let is_turned = body != body_a || !first.contains(&vertices[0]);
        Ok(FeaturePair {
            features,
            bodies: [body_a, body_b],
            numbers: [a, b],
            vertices,
            weights,
            distance,
            direction: direction.map(|d| if is_turned { d.map(|x| 0.0 - x) } else { d }),
            multiplicity: 0,
        })
    }
}

/// The part of the way along an edge at which it is nearest to a point. It is nearest inside.
fn along(p: [f64; 3], [from, to]: [[f64; 3]; 2]) -> f64 {
    let (e, t) = (minus(to, from), minus(p, from));
    // Scaled, so that no product is too small or too large.
    let size = e
        .iter()
        .chain(&t)
        .fold(0.0, |size: f64, x| size.max(x.abs()));
    let [e, t] = [e, t].map(|way| way.map(|x| x / size));
    (dot(t, e) / square_of(e)).clamp(0.0, 1.0)
}

impl From<FeaturePairs> for Vec<FeaturePair> {
    fn from(contacts: FeaturePairs) -> Self {
        contacts.rows
    }
}
