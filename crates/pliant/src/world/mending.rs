//! Trees that mend themselves: a body whose tree has decayed is given a fresh one, which is built some at a time beside it.
//!
//! ```text
//! each new shape of the body:
//!     nothing is being built:     begin, if by now a fresh tree would have spared what it costs   (rent, then buy)
//!     a division is on its way:   some parts of it, in proportion to what the last query did
//!     it is done:                 in one step order and tree; in another what neighbours are, and the tree is exchanged
//! ```
//!
//! The division is that of the shape of some steps before, which is as good. The mesh may be edited meanwhile: what is gone is marked in the
//! new tree, what has come is put behind it (`edits`). No answer depends on a tree. A tree along the mesh would be the same again, so it
//! is not mended.

use super::body::Body;
use super::edit_state::NOWHERE;
use super::mending_state::{Mending, Rule};
use crate::ids::TreeVertex;
use crate::kernels::Coordinate;
use crate::mesh::{EMPTY, Order};
use crate::options::{Options, Partition};
use crate::threads::Executor;
use crate::tree::Tree;
use crate::tree::build::{Balanced, CutAt, InitialShape, Plan, Planner};
use std::borrow::Cow;

/// A fresh tree costs as much as looking at so many pairs of nodes, for each triangle.
const COST: f64 = 2.0;

/// While a query looks at one pair of nodes, so many triangles are put into parts: what is built in a step takes about half as long as
/// its query.
const PACE: u64 = 2;

/// But so many at least.
const LEAST: usize = 1 << 12;

impl<const N: usize, S: Coordinate> Body<N, S> {
    /// Goes on with mending, or begins it where it pays. Returns whether the tree is another one now.
    pub(super) fn mend(&mut self, options: &Options, executor: Executor) -> bool {
        let (spared, last) = self.decay.spared();
        match self.mending.take().map(|mending| *mending) {
            None => {
                let is_worth_it = spared > COST * self.topology.live_count() as f64;
                if is_worth_it && options.partition != Partition::Connectivity {
                    self.mending = Some(Box::new(self.begin_to_mend(options)));
                }
                false
            }
            Some(Mending::Dividing(mut planner, numbers)) => {
                let is_done = planner.advance(((PACE * last) as usize).max(LEAST));
                self.mending = Some(Box::new(if is_done {
                    Mending::Divided(planner.finish().with_numbers(&numbers))
                } else {
                    Mending::Dividing(planner, numbers)
                }));
                false
            }
            Some(Mending::Divided(plan)) => {
                let built = Box::new(self.build(&plan));
                self.mending = Some(Box::new(Mending::Built(plan, built, self.meshes)));
                false
            }
            Some(Mending::Built(plan, built, meshes)) => {
                let (order, mut tree) = if meshes == self.meshes {
                    *built
                } else {
                    self.build(&plan)
                };
                if self.parts.first.tree.knows_neighbours() {
                    tree.know_neighbours(&order, executor);
                }
                self.exchange_tree(order, tree);
                self.follow_edits(options);
                true
            }
        }
    }

    /// The order and the tree of a division, of the mesh of now.
    fn build(&self, plan: &Plan) -> (Order, Tree<N>) {
        let order = Order::new(&self.topology, plan.order.clone());
        let tree = Tree::new(plan, &order, TreeVertex(0));
        (order, tree)
    }

    fn begin_to_mend(&self, options: &Options) -> Mending<N> {
        let triangles = self.topology.triangles();
        let live = (0..)
            .zip(triangles)
            .filter(|(_, corners)| **corners != EMPTY);
        let (numbers, corners): (Vec<u32>, Vec<[u32; 3]>) = live.unzip();
        let positions = self.stored_positions();
        let (degree, leaf_size) = (options.degree.get(), options.leaf_size.get());
        let by_shape = |cut| -> Rule {
            let (corners, positions) = (corners.clone(), positions.to_vec());
            let (corners, positions) = (Cow::Owned(corners), Cow::Owned(positions));
            Box::new(InitialShape::new(corners, positions, cut, degree))
        };
        let rule = match options.partition {
            Partition::Centre => by_shape(CutAt::Centre),
            Partition::Mean => by_shape(CutAt::Mean),
            Partition::Balanced | Partition::Connectivity => {
                Box::new(Balanced::new(&corners, &positions, degree, leaf_size))
            }
        };
        Mending::Dividing(
            Planner::new(numbers.len(), degree, leaf_size, rule),
            numbers,
        )
    }

    /// In a tree that was begun some steps ago marks what is gone, and puts behind it what has come.
    fn follow_edits(&mut self, options: &Options) {
        let Some(edits) = &mut self.edits else {
            return;
        };
        let topology = &self.topology;
        let numbers = 0..topology.triangles().len() as u32;
        let is_missing = |it: &u32| topology.is_live(*it) && edits.places[*it as usize] == NOWHERE;
        let coming = numbers.filter(is_missing).collect();
        for (place, &triangle) in (0..).zip(self.order.triangle_order()) {
            if !topology.is_live(triangle) {
                edits.places[triangle as usize] = NOWHERE;
                edits.gone.insert(place);
            }
        }
        self.append(coming, options);
    }
}
