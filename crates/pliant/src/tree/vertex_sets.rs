//! The distinct vertices below every node: what makes a box straight from the shape, without looking at children.
//!
//! Because vertices are numbered as the triangles in tree order first use them, those that a run of triangles uses first are
//! a run of numbers. What is left is the *border*: vertices that an earlier triangle used first. On a surface the border of
//! k triangles is about the square root of k, so all levels together cost little more than the lowest.
//!
//! A leaf has few vertices, and is made more often than anything else: it is all border, whose length is made a multiple of four,
//! so that most leaves take equally many steps. Most have twelve, and most wide nodes are leaves of twelve altogether, whose
//! lists then are one.
//!
//! Paper, 3.3: "we update the node's AABB by traversing the shared vertices of the faces in the node".

use super::build::Plan;
use crate::held::held;
use crate::ids::TreeVertex;
use crate::kernels::extent::TWELVE;
use crate::mesh::Order;
use crate::threads::Budget;

/// A leaf of so many vertices has few: eight triangles that share none have no more.
const FEW: usize = 24;

/// Indexed by node, counted level by level.
#[derive(Clone, Debug, Default)]
pub(crate) struct VertexSets {
    sets: Vec<Set>,
    border: Vec<TreeVertex>,
}

/// The vertices of one node.
#[derive(Clone, Copy, Debug)]
struct Set {
    /// First and end of the run of vertices that the node's triangles use first.
    run: [u32; 2],
    /// The first border vertex, and how many there are.
    border: usize,
    borders: u32,
    /// Whether this node and those beside it are a full wide node of leaves, each of twelve border vertices.
    in_twelves: bool,
}

/// Vertex sets on their way, made some nodes at a time.
pub(super) struct VertexSetsBuilder {
    all: VertexSets,
    /// The first triangle, and how many vertices are used before each one, and by all.
    start: usize,
    used_before: Vec<u32>,
    /// The vertices that an earlier tree uses first, of which there are few; and which this tree does, the first of them.
    earlier: Vec<u32>,
    first_vertex: u32,
    /// The last node that was seen to have each of these, and each of its own.
    seen_by: Vec<u32>,
}

impl VertexSetsBuilder {
    /// Of a plan over some triangles, which are the first to use vertices from `first_vertex` on.
    pub(super) fn new(plan: &Plan, order: &Order, TreeVertex(first_vertex): TreeVertex) -> Self {
        let all = plan
            .parts
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
                sets: Vec::with_capacity(plan.parts.len()),
                border: Vec::new(),
            },
            start,
            used_before,
            earlier,
            first_vertex,
            seen_by,
        }
    }

    /// Goes on with the same plan and order; returns whether all nodes have their vertices.
    pub(super) fn advance(&mut self, plan: &Plan, order: &Order, budget: &mut Budget) -> bool {
        let VertexSets { sets, border } = &mut self.all;
        let earlier = &self.earlier;
        let place = |vertex: u32| match vertex.checked_sub(self.first_vertex) {
            Some(own) => earlier.len() + own as usize,
            None => earlier.partition_point(|&it| it < vertex),
        };
        while let Some(part) = plan.parts.get(sets.len()) {
            if budget.is_spent() {
                return false;
            }
            let node = sets.len() as u32;
            let triangles = part.triangles.start as usize..part.triangles.end as usize;
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
            if part.children.is_empty() && count <= FEW {
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

    /// The sets, when they are done.
    pub(super) fn finish(self, plan: &Plan) -> VertexSets {
        let VertexSets {
            mut sets,
            mut border,
        } = self.all;
        for part in &plan.parts {
            let group = &mut sets[part.children.start as usize..part.children.end as usize];
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
    /// The number of nodes.
    pub(crate) fn len(&self) -> usize {
        self.sets.len()
    }

    /// The vertices below a node: a run and a border, in which one may be more than once.
    #[inline]
    pub(crate) fn run_and_border(&self, node: usize) -> (std::ops::Range<usize>, &[TreeVertex]) {
        let set = self.sets[node];
        let [start, end] = set.run;
        let border = &self.border[set.border..set.border + set.borders as usize];
        (start as usize..end as usize, border)
    }

    /// The vertices below each of `N` nodes from the first of a wide node on, if these are leaves of twelve.
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

    /// The vertices below a node, run first.
    pub(crate) fn vertices(&self, node: usize) -> impl Iterator<Item = TreeVertex> {
        let (run, border) = self.run_and_border(node);
        run.map(|vertex| TreeVertex(vertex as u32))
            .chain(border.iter().copied())
    }
}

held!(VertexSets: sets[], border[]);
