//! The trees of all bodies: where the degree turns from a value into a type, once for every query.

use crate::geometry::Scalar;
use crate::mesh::Mesh;
use crate::options::{Degree, Options, Partition};
use crate::tree::Tree;
use crate::tree::build::{Balanced, Connectivity, Cut, InitialShape, Plan, plan};

/// One tree a body, all of one degree.
#[derive(Debug)]
pub(super) enum Forest {
    Two(Vec<Tree<2>>),
    Four(Vec<Tree<4>>),
    Eight(Vec<Tree<8>>),
}

/// Evaluates an expression with the trees as a list of `Tree<N>`.
macro_rules! with_trees {
    ($forest:expr, $trees:ident => $body:expr) => {
        match $forest {
            $crate::world::forest::Forest::Two($trees) => $body,
            $crate::world::forest::Forest::Four($trees) => $body,
            $crate::world::forest::Forest::Eight($trees) => $body,
        }
    };
}
pub(super) use with_trees;

impl Forest {
    pub(super) fn new(degree: Degree) -> Self {
        match degree {
            Degree::Two => Self::Two(Vec::new()),
            Degree::Four => Self::Four(Vec::new()),
            Degree::Eight => Self::Eight(Vec::new()),
        }
    }

    /// Builds a tree at `place`, at the end or for the one that is there, and returns the mesh in its order.
    pub(super) fn plant<S: Scalar>(
        &mut self,
        place: usize,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
        options: &Options,
    ) -> Mesh {
        let mut plan = divide(triangles, positions, options);
        let mesh = Mesh::in_order(triangles, positions.len(), std::mem::take(&mut plan.order));
        with_trees!(self, trees => {
            let tree = Tree::new(&plan, &mesh);
            if place < trees.len() {
                trees[place] = tree;
            } else {
                trees.push(tree);
            }
        });
        mesh
    }

    /// The tree at `place` goes, and the last takes its place.
    pub(super) fn swap_remove(&mut self, place: usize) {
        with_trees!(self, trees => drop(trees.swap_remove(place)));
    }
}

/// The plan that the options ask for.
fn divide<S: Scalar>(triangles: &[[u32; 3]], positions: &[[S; 3]], options: &Options) -> Plan {
    let degree = options.degree.get();
    let leaf_size = options.leaf_size.get();
    let initial_shape = |cut| {
        plan(
            triangles.len(),
            degree,
            leaf_size,
            &mut InitialShape::new(triangles, positions, cut, degree),
        )
    };
    match options.partition {
        Partition::Centre => initial_shape(Cut::Centre),
        Partition::Mean => initial_shape(Cut::Mean),
        Partition::Balanced => plan(
            triangles.len(),
            degree,
            leaf_size,
            &mut Balanced::new(triangles, positions, degree, leaf_size),
        ),
        Partition::Connectivity => plan(
            triangles.len(),
            degree,
            leaf_size,
            &mut Connectivity::new(triangles, degree, leaf_size),
        ),
    }
}
