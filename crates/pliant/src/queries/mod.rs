//! Kinds of queries: one room a kind.
//!
//! The update, the traversal, the sorting and what users call are the same for every kind. A kind says what is different: what its boxes
//! are made of and which set of them it uses, what two leaves do to each other, its rule for neighbours in the mesh, and what a hit is.
//! Intersections are one kind. A second, `grown`, is for tests only and shows that nothing else knows the first.

#[cfg(test)]
pub(crate) mod grown;
mod intersections;

use crate::geometry::{Aabb, Shape};
use crate::held::Held;
use crate::hits::Hit;
use crate::ids::BodyId;
use crate::ids::TreeTriangle;
use crate::kernels::{Buffer, Coordinate, Instructions};
use crate::mesh::Order;
use crate::statistics::Statistics;
use crate::threads::Interrupt;
use crate::tree::BoxSource;
pub(crate) use intersections::Intersections;

/// Two triangles whose boxes overlap, of the first body and of the second.
pub(crate) type Candidate = [TreeTriangle; 2];

/// Which set of a tree's boxes a kind uses: kinds whose boxes have the same source share one.
pub(crate) type BoxSetNumber = usize;

/// A kind of query.
pub(crate) trait Kind: Sync {
    type Scalar: Coordinate;
    /// What it finds, as the caller numbers things.
    type Hit: Hit;
    /// What it finds, in tree order.
    type TreeHit: Copy + Default + std::fmt::Debug + Send + Sync;
    /// What a task keeps for the tests of leaves, from query to query.
    type Buffers: Default + std::fmt::Debug + Held + Send;
    /// What its boxes are made of.
    type Source<'s>: BoxSource<Scalar = Self::Scalar>;

    const BOX_SET: BoxSetNumber;
    /// Whether triangles of one body that share a vertex of the mesh are left out before they are tested.
    const LEAVES_OUT_NEIGHBOURS: bool;

    /// By how much its boxes are larger than those of the shape, on every side.
    fn grows_by(&self) -> f32 {
        0.0
    }

    /// The box of a body for this kind, from that of the shape.
    fn body_box(&self, of_shape: Aabb) -> Aabb {
        of_shape
    }

    fn source<'s>(&self, shape: Shape<'s, Self::Scalar>) -> Self::Source<'s>;

    /// Decides candidates, and appends what it finds to `hits`, in an order that depends on nothing but the candidates. It counts them,
    /// exact decisions and hits.
    fn test(
        &self,
        leaves: &LeafTest<Self::Scalar>,
        candidates: &mut Buffer<Candidate>,
        buffers: &mut Self::Buffers,
        hits: &mut Buffer<Self::TreeHit>,
        statistics: &mut Statistics,
    );

    /// A hit as the caller numbers things.
    fn to_caller(&self, ids: &CallerIds, hit: Self::TreeHit) -> Self::Hit;
}

/// What a test of leaves works with.
pub(crate) struct LeafTest<'q, S> {
    pub(crate) instructions: Instructions,
    pub(crate) interrupt: &'q Interrupt<'q>,
    /// Of both bodies, or of the one twice.
    pub(crate) shapes: [&'q Shape<'q, S>; 2],
}

/// How the caller numbers things.
pub(crate) struct CallerIds<'q> {
    pub(crate) bodies: [BodyId; 2],
    pub(crate) orders: [&'q Order; 2],
}
