//! Building of a tree beside the present one of a body, in stages that stop when a budget is spent.
//!
//! The tree is of the mesh at its beginning. Triangles that are edited meanwhile are noted with the
//! corners that they had.

use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::mesh::{Changed, Order, OrderBuilder};
use crate::threads::Budget;
use crate::tree::build::{Balanced, Plan, Planner, Split};
use crate::tree::{NeighboursBuilder, Tree, TreeBuilder};
use std::collections::BTreeMap;

/// Rule by which triangles are divided.
pub(crate) type Rule = Box<dyn Split + Send + Sync>;

/// Mesh that a tree is built of: the body's mesh without the edits made since the beginning.
pub(crate) struct MeshThen {
    vertices: usize,
    /// Corners at the beginning of all triangles that were edited since, by the caller's numbers.
    /// New ones have no corners.
    edited: BTreeMap<u32, [u32; 3]>,
}

impl MeshThen {
    /// The present mesh, with `vertices` vertices.
    pub(crate) fn new(vertices: usize) -> Self {
        Self {
            vertices,
            edited: BTreeMap::new(),
        }
    }

    pub(crate) fn vertices(&self) -> usize {
        self.vertices
    }

    /// Corners of a triangle at the beginning, where `now` has the present corners of all.
    fn corners(&self, triangle: u32, now: &[[u32; 3]]) -> [u32; 3] {
        let edited = self.edited.get(&triangle).copied();
        edited.unwrap_or_else(|| now[triangle as usize])
    }

    /// Triangles whose corners differ from the beginning, by number.
    pub(crate) fn changed(&self, now: &[[u32; 3]]) -> Vec<Changed> {
        let edited = self.edited.iter();
        let both = edited.map(|(&triangle, &then)| (triangle, [then, now[triangle as usize]]));
        both.filter(|(_, [then, now])| then != now).collect()
    }
}

/// Tree that is being built.
pub(crate) struct Mending {
    mesh: MeshThen,
    stage: Stage,
}

/// Midpoint of a triangle in the present shape.
///
/// Arguments are its place among the triangles whose midpoints are asked for, and its corners with
/// the caller's numbers.
pub(crate) type MidpointOf<'m> = &'m dyn Fn(usize, [u32; 3]) -> [f64; 3];

enum Stage {
    /// Midpoints of these triangles are looked up, for a balanced tree of some degree and size of
    /// leaves. Numbers are the caller's.
    Looking(Vec<u32>, Vec<[f64; 3]>, (usize, u32)),
    /// Triangles with these caller's numbers are divided.
    Dividing(Planner<Rule>, Vec<u32>),
    /// Triangles and vertices get their numbers in tree order.
    Ordering(Plan, OrderBuilder),
    /// The vertices below all nodes are found.
    Growing(Plan, Order, TreeBuilder),
    /// Pairs of triangles that share a vertex are found, for a body that meets itself.
    Meeting(Order, Tree, NeighboursBuilder),
    Done(Order, Tree),
}

/// Looks at a triangle that computing its midpoint costs.
const LOOKS: usize = 4;
/// Triangles between two looks at the budget.
const AT_ONCE: usize = 256;
/// Looks at a triangle in a pass over all of them.
const ONCE_MORE: usize = 1;

impl Mending {
    /// Begins a balanced tree of these triangles, of some degree and size of leaves.
    pub(crate) fn balanced(
        mesh: MeshThen,
        numbers: Vec<u32>,
        (degree, leaf_size): (usize, u32),
    ) -> Self {
        let midpoints = Vec::with_capacity(numbers.len());
        let stage = Stage::Looking(numbers, midpoints, (degree, leaf_size));
        Self { mesh, stage }
    }

    /// Begins a tree whose triangles, with these numbers, a planner divides.
    pub(crate) fn by_rule(mesh: MeshThen, planner: Planner<Rule>, numbers: Vec<u32>) -> Self {
        let stage = Stage::Dividing(planner, numbers);
        Self { mesh, stage }
    }

    /// Notes that triangles of the body are edited.
    pub(crate) fn note(&mut self, changed: &[Changed]) {
        for &(triangle, [then, _]) in changed {
            self.mesh.edited.entry(triangle).or_insert(then);
        }
    }

    /// Continues until the budget is spent. `now` has the present corners of all triangles.
    ///
    /// `knows_neighbours` says whether to find triangles that share a vertex, too. It matters when
    /// that stage is reached.
    pub(crate) fn advance(
        mut self,
        now: &[[u32; 3]],
        midpoint_of: MidpointOf,
        knows_neighbours: bool,
        budget: &mut Budget,
    ) -> Self {
        while !budget.is_spent() && !self.is_done() {
            let stage = self.stage;
            self.stage = stage.advance(&self.mesh, now, midpoint_of, knows_neighbours, budget);
        }
        self
    }

    pub(crate) fn is_done(&self) -> bool {
        matches!(self.stage, Stage::Done(..))
    }

    /// The mesh that the tree is of, its order and the tree, if they are done.
    pub(crate) fn finish(self) -> Option<(MeshThen, Order, Tree)> {
        match self.stage {
            Stage::Done(order, tree) => Some((self.mesh, order, tree)),
            _ => None,
        }
    }
}

impl Stage {
    /// Continues this stage, and returns the next one if it is done.
    fn advance(
        self,
        mesh: &MeshThen,
        now: &[[u32; 3]],
        midpoint_of: MidpointOf,
        knows_neighbours: bool,
        budget: &mut Budget,
    ) -> Self {
        match self {
            Self::Looking(numbers, mut midpoints, (degree, leaf_size)) => {
                while midpoints.len() < numbers.len() {
                    if budget.is_spent() {
                        return Self::Looking(numbers, midpoints, (degree, leaf_size));
                    }
                    let first = midpoints.len();
                    let some = numbers[first..].iter().take(AT_ONCE);
                    budget.spend(LOOKS * some.len());
                    let corners = some.map(|&triangle| mesh.corners(triangle, now));
                    midpoints.extend((first..).zip(corners).map(|(it, of)| midpoint_of(it, of)));
                }
                let rule = Balanced::of_midpoints(midpoints, degree, leaf_size);
                let planner =
                    Planner::new(numbers.len(), degree, leaf_size, Box::new(rule) as Rule);
                Self::Dividing(planner, numbers)
            }
            Self::Dividing(mut planner, numbers) => {
                if !planner.advance(budget) {
                    return Self::Dividing(planner, numbers);
                }
                budget.spend(ONCE_MORE * numbers.len());
                let mut plan = planner.finish().with_numbers(&numbers);
                let triangles = std::mem::take(&mut plan.order);
                Self::Ordering(plan, OrderBuilder::new(mesh.vertices, triangles))
            }
            Self::Ordering(plan, mut order) => {
                let corners = |triangle| mesh.corners(triangle, now);
                if !order.advance(corners, budget) {
                    return Self::Ordering(plan, order);
                }
                let order = order.finish();
                budget.spend(ONCE_MORE * order.all_corners().len());
                let tree = TreeBuilder::new(&plan, &order, TreeVertex(0));
                Self::Growing(plan, order, tree)
            }
            Self::Growing(plan, order, mut tree) => {
                if !tree.advance(&plan, &order, budget) {
                    return Self::Growing(plan, order, tree);
                }
                let tree = tree.finish(&plan);
                budget.spend(ONCE_MORE * order.all_corners().len());
                match tree.begin_neighbours(&order).filter(|_| knows_neighbours) {
                    Some(neighbours) => Self::Meeting(order, tree, neighbours),
                    None => Self::Done(order, tree),
                }
            }
            Self::Meeting(order, mut tree, mut neighbours) => {
                if !neighbours.advance(&tree.leaves, &order, budget) {
                    return Self::Meeting(order, tree, neighbours);
                }
                budget.spend(ONCE_MORE * order.all_corners().len());
                tree.take_neighbours(neighbours, &order);
                Self::Done(order, tree)
            }
            Self::Done(order, tree) => Self::Done(order, tree),
        }
    }
}

/// Entries of the map, without its nodes.
impl Held for MeshThen {
    fn held(&self) -> usize {
        self.edited.len() * size_of::<(u32, [u32; 3])>()
    }
}

impl Held for Mending {
    fn held(&self) -> usize {
        let of_stage = match &self.stage {
            Stage::Looking(numbers, midpoints, _) => held::list(numbers) + held::list(midpoints),
            Stage::Dividing(planner, numbers) => planner.held() + held::list(numbers),
            Stage::Ordering(plan, order) => plan.held() + order.held(),
            Stage::Growing(plan, order, tree) => plan.held() + order.held() + tree.held(),
            Stage::Meeting(order, tree, neighbours) => {
                order.held() + tree.held() + neighbours.held()
            }
            Stage::Done(order, tree) => order.held() + tree.held(),
        };
        self.mesh.held() + of_stage
    }
}
