//! Building of a tree as the options ask for.

use crate::geometry::Real;
use crate::ids::TreeVertex;
use crate::mesh::{Order, Topology};
use crate::options::{Options, Partition};
use crate::tree::Tree;
use crate::tree::build::{Balanced, Connectivity, CutAt, InitialShape, Plan, has_many_thin, plan};

/// Builds the tree that the options ask for, and the order into which it brings the mesh.
pub(crate) fn build<S: Real>(
    topology: &Topology,
    positions: &[[S; 3]],
    options: &Options,
) -> (Order, Tree) {
    let all = topology.triangles();
    let mut plan = if topology.live_count() == all.len() {
        divide(all, positions, options)
    } else {
        let numbers = (0..all.len() as u32).filter(|&triangle| topology.is_live(triangle));
        let numbers: Vec<u32> = numbers.collect();
        let corners: Vec<_> = numbers
            .iter()
            .map(|&triangle| all[triangle as usize])
            .collect();
        let plan = divide(&corners, positions, options);
        plan.with_numbers(&numbers)
    };
    let order = Order::new(topology, std::mem::take(&mut plan.order));
    let tree = Tree::new(&plan, &order, TreeVertex(0));
    (order, tree)
}

/// Divides triangles by the partition that the options ask for.
pub(crate) fn divide<S: Real>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
    options: &Options,
) -> Plan {
    let degree = options.degree.get();
    let leaf_size = options.leaf_size.get();
    let count = triangles.len();
    let by_shape = |cut| {
        let rule = InitialShape::new(triangles.into(), positions.into(), cut, degree);
        plan(count, degree, leaf_size, rule)
    };
    let plan = match options.partition {
        Partition::Centre => by_shape(CutAt::Centre),
        Partition::Mean => by_shape(CutAt::Mean),
        Partition::Balanced => {
            let rule = Balanced::new(triangles, positions, degree, leaf_size);
            plan(count, degree, leaf_size, rule)
        }
        Partition::Connectivity => {
            let rule = Connectivity::new(triangles, degree, leaf_size);
            plan(count, degree, leaf_size, rule)
        }
    };
    Plan {
        has_thin: has_many_thin(triangles, positions),
        ..plan
    }
}
