//! Vertex sets: the distinct vertices below every node, from which its box is made.
//!
//! Vertices are numbered as the triangles in tree order first use them. So those that a node's
//! triangles use first are a run of numbers. The others, which an earlier triangle uses, are the
//! node's *border*. On a surface the border of k triangles is about the square root of k, so all
//! levels cost little more than the lowest. Paper, 3.3: "we update the node's AABB by traversing
//! the shared vertices of the faces in the node".

use super::build::Plan;
use crate::held::held;
use crate::ids::TreeVertex;
use crate::kernels::extent::TWELVE;
use crate::mesh::Order;
use crate::threads::Budget;

/// Most vertices of a leaf that is stored as all border: eight triangles that share none have as
/// many.
const FEW: usize = 24;

/// Vertices below every node, indexed by node, level by level.
///
/// Runs take away most of the memory for vertex lists that the paper regrets (3.3).
///
/// A small leaf, which is refitted more often than anything else, is all border. The border's
/// length is a multiple of four, so that most leaves take equally many steps. Most have twelve, and
/// most wide nodes are leaves of twelve altogether, whose lists are then read as one.
#[derive(Clone, Debug, Default)]
pub(crate) struct VertexSets {
    sets: Vec<Set>,
    border: Vec<TreeVertex>,
}

/// Vertices below one node.
#[derive(Clone, Copy, Debug)]
struct Set {
    /// First and end of the run of vertices that the node's triangles use first.
    run: [u32; 2],
    /// First border vertex.
    border: usize,
    /// How many border vertices there are.
    borders: u32,
    /// Whether this is the first of a full wide node of leaves, each of twelve border vertices.
    in_twelves: bool,
}

/// Vertex sets under construction, made some nodes at a time.
pub(super) struct VertexSetsBuilder {
    all: VertexSets,
    /// First triangle.
    start: usize,
    /// How many vertices are used before each triangle, and by all.
    used_before: Vec<u32>,
    /// Few vertices that an earlier tree uses first, ascending.
    earlier: Vec<u32>,
    /// First vertex that this tree is the first to use.
    first_vertex: u32,
    /// Last node that was seen to have each of `earlier`, and each of this tree's own vertices.
    seen_by: Vec<u32>,
}

impl VertexSetsBuilder {
    /// Begins the sets of a plan over triangles that are the first to use vertices from
    /// `first_vertex` on.
    pub(super) fn new(plan: &Plan, order: &Order, TreeVertex(first_vertex): TreeVertex) -> Self {
        let all = plan
            .nodes
            .first()
            .map_or(0..0, |root| root.triangles.clone());
        let [start, end] = [all.start as usize, all.end as usize];
        let corners = &order.all_corners()[start..end];
        let mut used_before = Vec::with_capacity(end - start + 1);
        let mut used = first_vertex;
        used_before.push(used);
        for corners in corners {
            used = corners
                .iter()
                .fold(used, |used, vertex| used.max(vertex.0 + 1));
            used_before.push(used);
        }
        let mut earlier: Vec<u32> = Vec::new();
        if first_vertex > 0 {
            let vertices = corners.as_flattened().iter().map(|vertex| vertex.0);
            earlier.extend(vertices.filter(|&vertex| vertex < first_vertex));
            earlier.sort_unstable();
            earlier.dedup();
        }
        let seen_by = vec![u32::MAX; earlier.len() + (used - first_vertex) as usize];
        Self {
            all: VertexSets {
                sets: Vec::with_capacity(plan.nodes.len()),
                border: Vec::new(),
            },
            start,
            used_before,
            earlier,
            first_vertex,
            seen_by,
        }
    }

    /// Continues with the same plan and order; returns whether all nodes have their vertices.
    pub(super) fn advance(&mut self, plan: &Plan, order: &Order, budget: &mut Budget) -> bool {
        let VertexSets { sets, border } = &mut self.all;
        let earlier = &self.earlier;
        let place = |vertex: u32| match vertex.checked_sub(self.first_vertex) {
            Some(own) => earlier.len() + own as usize,
            None => earlier.partition_point(|&it| it < vertex),
        };
        while let Some(plan_node) = plan.nodes.get(sets.len()) {
            if budget.is_spent() {
                return false;
            }
            let node = sets.len() as u32;
            let triangles = plan_node.triangles.start as usize..plan_node.triangles.end as usize;
            budget.spend(triangles.len());
            let mut run = [triangles.start, triangles.end]
                .map(|triangle| self.used_before[triangle - self.start]);
            let first = border.len();
            for &vertex in order.all_corners()[triangles].as_flattened() {
                if vertex.0 >= run[0] {
                    continue;
                }
                let seen_by = &mut self.seen_by[place(vertex.0)];
                if *seen_by != node {
                    *seen_by = node;
                    border.push(vertex);
                }
            }
            let count = border.len() - first + (run[1] - run[0]) as usize;
            if plan_node.children.is_empty() && count <= FEW {
                border.extend((run[0]..run[1]).map(TreeVertex));
                let last = border[border.len() - 1];
                border.resize(first + count.next_multiple_of(4), last);
                run[1] = run[0];
            }
            sets.push(Set {
                run,
                border: first,
                borders: (border.len() - first) as u32,
                in_twelves: false,
            });
        }
        true
    }

    /// Returns the finished sets.
    pub(super) fn finish(self, plan: &Plan) -> VertexSets {
        let VertexSets {
            mut sets,
            mut border,
        } = self.all;
        for plan_node in &plan.nodes {
            let group =
                &mut sets[plan_node.children.start as usize..plan_node.children.end as usize];
            let is_twelve = |set: &Set| set.borders as usize == TWELVE && set.run[0] == set.run[1];
            if group.len() == plan.degree && group.iter().all(is_twelve) {
                group[0].in_twelves = true;
            }
        }
        border.shrink_to_fit();
        VertexSets { sets, border }
    }
}

held!(VertexSetsBuilder: all, used_before[], earlier[], seen_by[]);

impl VertexSets {
    /// Returns the number of nodes.
    pub(crate) fn len(&self) -> usize {
        self.sets.len()
    }

    /// Returns the vertices below a node: a run and a border, in which one may be repeated.
    #[inline]
    pub(crate) fn run_and_border(&self, node: usize) -> (std::ops::Range<usize>, &[TreeVertex]) {
        let set = self.sets[node];
        let [start, end] = set.run;
        let border = &self.border[set.border..set.border + set.borders as usize];
        (start as usize..end as usize, border)
    }

    /// Returns the vertices below each of `N` nodes from the first of a wide node on, if each is a
    /// leaf of twelve.
    #[inline]
    pub(crate) fn twelves<const N: usize>(
        &self,
        node: usize,
    ) -> Option<&[[TreeVertex; TWELVE]; N]> {
        let set = self.sets[node];
        let border = set
            .in_twelves
            .then(|| self.border[set.border..].as_chunks().0);
        border?.first_chunk()
    }

    /// Iterates over the vertices below a node, the run first.
    pub(crate) fn vertices(&self, node: usize) -> impl Iterator<Item = TreeVertex> {
        let (run, border) = self.run_and_border(node);
        run.map(|vertex| TreeVertex(vertex as u32))
            .chain(border.iter().copied())
    }
}

held!(VertexSets: sets[], border[]);
