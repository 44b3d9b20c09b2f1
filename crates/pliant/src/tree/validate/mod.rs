//! What is always true of a tree.

mod connectedness;

use super::{Below, NodeId, Tree};
use crate::geometry::{Aabb, Bounds, Scalar, Shape};
use crate::mesh::Mesh;
use crate::options::Partition;
use connectedness::Connectedness;
use std::collections::BTreeSet;
use std::ops::Range;

impl<const N: usize> Tree<N> {
    /// Checks structure, boxes and what the partition promises; `Err` says what is wrong. Allocates and takes its time.
    pub(crate) fn validate<S: Scalar>(
        &self,
        mesh: &Mesh,
        shape: &Shape<S>,
        partition: Partition,
    ) -> Result<(), String> {
        if partition == Partition::Connectivity {
            self.validate_connectedness(mesh)?;
        }
        let count = mesh.corners().len() as u32;
        let mut visited = 0;
        let mut deepest = 0;
        // Node, its level, the triangles that must be below it (None for the root: all), and its parent's box if that is true.
        let mut open: Vec<(NodeId, u32, Option<Aabb>)> = vec![(NodeId::ROOT, 0, None)];
        if self.triangles_below(NodeId::ROOT)? != (0..count) {
            return Err("the root does not hold all triangles".into());
        }
        while let Some((node, level, parent)) = open.pop() {
            visited += 1;
            deepest = deepest.max(level);
            let (group, lane) = node.group_and_lane::<N>();
            let siblings = &self.groups[group];
            if !self.level(level).contains(&(group as u32)) {
                return Err(format!(
                    "group {group}: not in the run of its level, {level}"
                ));
            }
            let triangles = self.triangles_below(node)?;

            let below: BTreeSet<u32> = mesh.corners()
                [triangles.start as usize..triangles.end as usize]
                .as_flattened()
                .iter()
                .copied()
                .collect();
            let listed: BTreeSet<u32> = self
                .vertices
                .vertices(siblings.first_node as usize + lane)
                .collect();
            if listed != below {
                return Err(format!(
                    "node {group}/{lane}: its vertex list is not the set of vertices below it"
                ));
            }

            let is_true = siblings.epoch == shape.epoch;
            let own_box = is_true.then(|| siblings.boxes.get(lane));
            if let Some(own_box) = own_box {
                let mut bounds = Bounds::EMPTY;
                listed
                    .iter()
                    .for_each(|&vertex| bounds.include(shape.positions.get(vertex)));
                let exact = bounds.to_box(shape.origin);
                if own_box != exact {
                    return Err(format!(
                        "node {group}/{lane}: claims to be true and is {own_box:?}, not {exact:?}"
                    ));
                }
                if group != 0 && !parent.is_some_and(|parent| parent.holds(&own_box)) {
                    return Err(format!(
                        "node {group}/{lane}: is true and not inside a true parent"
                    ));
                }
            }

            match siblings.children[lane].below() {
                Below::Leaf(leaf) => self.validate_leaf(leaf, is_true, shape)?,
                Below::Group(below) => {
                    let mut next = triangles.start;
                    let lanes = self.groups[below as usize].len();
                    if lanes < 2 {
                        return Err(format!("group {below}: {lanes} children"));
                    }
                    for lane in 0..lanes {
                        let child = NodeId::new::<N>(below, lane);
                        let run = self.triangles_below(child)?;
                        if run.start != next || run.is_empty() {
                            return Err(format!(
                                "group {below}: children do not divide their parent's triangles"
                            ));
                        }
                        next = run.end;
                        open.push((child, level + 1, own_box));
                    }
                    if next != triangles.end {
                        return Err(format!(
                            "group {below}: children do not hold all of their parent's triangles"
                        ));
                    }
                }
            }
        }
        if visited != self.node_count() || deepest != self.depth {
            return Err(format!(
                "{visited} nodes down to level {deepest}; {} and {} said",
                self.node_count(),
                self.depth
            ));
        }
        Ok(())
    }

    /// Of every node, leaves included.
    fn validate_connectedness(&self, mesh: &Mesh) -> Result<(), String> {
        let connectedness = Connectedness::new(mesh.corners());
        let mut open = vec![NodeId::ROOT];
        while let Some(node) = open.pop() {
            let triangles = self.triangles_below(node)?;
            if !connectedness.holds_for(triangles.start as usize..triangles.end as usize) {
                let (group, lane) = node.group_and_lane::<N>();
                return Err(format!(
                    "node {group}/{lane}: neither one connected piece nor whole components"
                ));
            }
            if let Below::Group(below) = self.child(node).below() {
                let lanes = 0..self.groups[below as usize].len();
                open.extend(lanes.map(|lane| NodeId::new::<N>(below, lane)));
            }
        }
        Ok(())
    }

    fn validate_leaf<S: Scalar>(
        &self,
        leaf: u32,
        is_true: bool,
        shape: &Shape<S>,
    ) -> Result<(), String> {
        if !self.leaves.have_boxes() {
            return Ok(());
        }
        let claimed = self.leaves.are_true(leaf, shape.epoch);
        if claimed && !is_true {
            return Err(format!(
                "leaf {leaf}: the boxes of its triangles are true and its own is not"
            ));
        }
        let triangles = self.leaves.triangles(leaf);
        for (index, triangle) in triangles.enumerate() {
            let block = self.leaves.blocks_of(leaf).start as usize + index / super::LEAF_LANES;
            if self.leaves.firsts()[block] as usize + index % super::LEAF_LANES != triangle as usize
            {
                return Err(format!("leaf {leaf}: its blocks hold other triangles"));
            }
            let found = self.leaves.blocks()[block].get(index % super::LEAF_LANES);
            let exact = shape.box_of(triangle);
            if claimed && found != exact {
                return Err(format!(
                    "leaf {leaf}: triangle {triangle} has box {found:?}, not {exact:?}"
                ));
            }
        }
        Ok(())
    }

    /// The run of triangles below a node, from its first leaf to its last.
    fn triangles_below(&self, node: NodeId) -> Result<Range<u32>, String> {
        let end_of = |last: bool| {
            let mut node = node;
            for _ in 0..=self.depth {
                match self.child(node).below() {
                    Below::Leaf(leaf) => return Ok(self.leaves.triangles(leaf)),
                    Below::Group(below) => {
                        let lane = if last {
                            self.groups[below as usize].len() - 1
                        } else {
                            0
                        };
                        node = NodeId::new::<N>(below, lane);
                    }
                }
            }
            Err(format!("a path of more than {} levels", self.depth))
        };
        Ok(end_of(false)?.start..end_of(true)?.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exec::Threads;
    use crate::geometry::Points;
    use crate::kernels::widest;
    use crate::tree::build::{Balanced, Connectivity, Split, plan};

    /// What is wrong with the tree that a rule makes of these triangles, as a mesh connectivity tree.
    fn fault(triangles: &[[u32; 3]], positions: &[[f32; 3]], rule: &mut impl Split) -> String {
        let mut plan = plan(triangles.len(), 8, 2, rule);
        let order = std::mem::take(&mut plan.order);
        let mesh = Mesh::in_order(triangles, positions.len(), order);
        let mut in_tree_order = Points::with_len(positions.len());
        in_tree_order.gather(widest(), &Threads::one(), positions, mesh.vertex_ids());
        let shape = Shape {
            positions: &in_tree_order,
            triangles: mesh.corners(),
            origin: [0.0; 4],
            epoch: 1,
        };
        let tree = Tree::<8>::new(&plan, &mesh);
        assert_eq!(tree.validate(&mesh, &shape, Partition::Balanced), Ok(()));
        let found = tree.validate(&mesh, &shape, Partition::Connectivity);
        found.err().unwrap_or_default()
    }

    #[test]
    fn a_tree_by_shape_is_no_connectivity_tree() {
        // A strip whose triangles lie to and fro.
        let strip: Vec<[u32; 3]> = (0..32).map(|i| [i, i + 1, i + 2]).collect();
        let positions: Vec<[f32; 3]> = (0..34).map(|i| [(i * 13 % 34) as f32, 0.0, 0.0]).collect();
        let mut balanced = Balanced::new(&strip, &positions, 8, 2);
        let found = fault(&strip, &positions, &mut balanced);
        assert!(found.contains("neither one connected piece"), "{found}");
        let mut connectivity = Connectivity::new(&strip, 8, 2);
        assert_eq!(fault(&strip, &positions, &mut connectivity), "");
    }
}
