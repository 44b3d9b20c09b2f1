//! Trees that mend themselves: a body whose tree has decayed is given a fresh one, which is built some at a time beside it.
//!
//! ```text
//! each new shape of the body:
//!     no tree is on its way:   begin one, if by now a fresh tree would have spared what it costs   (rent, then buy)
//!     a tree is on its way:    build a share of it, in proportion to what the last query did and a fresh tree would have spared
//!     it is done:              exchange the trees
//! ```
//!
//! The tree is that of the mesh and the shape of some steps before. For the shape that is as good. What was edited meanwhile follows as an
//! edit does (`edits`): what is gone is marked in the new tree, what has come is put behind it. No answer depends on a tree. A tree along
//! the mesh would be the same again, so it is not mended.
//!
//! What goes through all triangles at once is not divided: listing them, the first cuts, and exchanging the trees.

use super::body::Body;
use super::mending_state::{Mending, MeshThen, Rule};
use crate::ids::TreeTriangle;
use crate::kernels::Coordinate;
use crate::mesh::{EMPTY, Order};
use crate::options::{Options, Partition};
use crate::threads::Budget;
use crate::tree::Tree;
use crate::tree::build::{CutAt, InitialShape, Planner, midpoint};
use std::borrow::Cow;

/// A fresh tree costs as much as looking at so many pairs of nodes, for each triangle.
const COST: f64 = 4.0;

/// While a query looks at a pair of nodes or of triangles, building looks at so many triangles: in `shuffle` what is built in a step takes
/// up to two thirds as long as its query. Slower, the old tree decays meanwhile by more than that.
const PACE: f64 = 1.5;

/// For a pair of nodes that a fresh tree would have spared in the last shape, building looks at so many triangles at most: the less a tree has
/// decayed, the less hurry there is, and the shorter are the steps in which it is mended.
const GAIN: f64 = 8.0;

impl<S: Coordinate> Body<S> {
    /// Goes on with mending, or begins it where it pays. Returns whether the tree is another one now.
    pub(crate) fn mend(&mut self, options: &Options) -> bool {
        let spared = self.decay.spared();
        #[expect(
            clippy::cast_sign_loss,
            reason = "neither what was looked at nor what would have been spared is negative"
        )]
        let looks = (PACE * spared.looked_at).min(GAIN * spared.in_last_shape) as usize;
        let mut budget = Budget::of(looks);
        let is_worth_it = || {
            let is_decayed = spared.since_built > COST * self.topology.live_count() as f64;
            is_decayed && options.partition != Partition::Connectivity
        };
        let mending = match self.mending.take() {
            Some(mending) => *mending,
            None if is_worth_it() => {
                // Listing the triangles is a look at each.
                budget.spend(self.topology.live_count());
                self.begin_to_mend(options)
            }
            None => return false,
        };
        let knows_neighbours = self.parts.first.tree.knows_neighbours();
        let vertices = self.order.vertex_order();
        let at = |vertex| self.positions.get(vertex, vertices);
        let triangles = self.topology.triangles();
        let midpoint_of = |place: usize, corners: [u32; 3]| {
            midpoint(match &self.edits {
                Some(edits) => corners.map(|vertex| at(edits.slots[vertex as usize])),
                None => self.order.corners(TreeTriangle(place as u32)).map(at),
            })
        };
        let advanced = mending.advance(triangles, &midpoint_of, knows_neighbours, &mut budget);
        if !advanced.is_done() {
            self.mending = Some(Box::new(advanced));
            return false;
        }
        if let Some((mesh, order, tree)) = advanced.finish() {
            self.exchange_mended(&mesh, order, tree, options);
        }
        true
    }

    fn begin_to_mend(&self, options: &Options) -> Mending {
        // In the order of the tree, in which corners lie near each other.
        let places = (0..).map(TreeTriangle).zip(self.order.triangle_order());
        let places = places.filter(|&(place, _)| !self.is_gone(place));
        let mut numbers = Vec::with_capacity(self.topology.live_count());
        numbers.extend(places.map(|(_, &number)| number));
        let triangles = self.topology.triangles();
        let mesh = MeshThen::new(self.vertex_count());
        let (degree, leaf_size) = (options.degree.get(), options.leaf_size.get());
        let by_shape = |cut| -> Rule {
            let corners = numbers.iter().map(|&it| triangles[it as usize]);
            let positions = self.stored_positions().into_owned();
            let (corners, positions) = (Cow::Owned(corners.collect()), Cow::Owned(positions));
            Box::new(InitialShape::new(corners, positions, cut, degree))
        };
        let rule = match options.partition {
            Partition::Centre => by_shape(CutAt::Centre),
            Partition::Mean => by_shape(CutAt::Mean),
            Partition::Balanced | Partition::Connectivity => {
                return Mending::balanced(mesh, numbers, (degree, leaf_size));
            }
        };
        let planner = Planner::new(numbers.len(), degree, leaf_size, rule);
        Mending::by_rule(mesh, planner, numbers)
    }

    /// Takes a tree of a mesh of some steps before. What was edited since is marked as gone in it, or comes behind it.
    fn exchange_mended(
        &mut self,
        mesh: &MeshThen,
        mut order: Order,
        tree: Tree,
        options: &Options,
    ) {
        // Numbers of triangles and of vertices do not become fewer while a tree is built.
        order.add_vertices(mesh.vertices() as u32..self.vertex_count() as u32);
        let changed = mesh.changed(self.topology.triangles());
        self.exchange_tree(order, tree, &changed);
        self.leave_orphans(&changed);
        let coming = changed.iter().filter(|(_, [_, now])| *now != EMPTY);
        self.append(coming.map(|&(triangle, _)| triangle).collect(), options);
    }
}
