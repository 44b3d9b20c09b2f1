//! A tree that is being built beside the one that a body has: how far it has come.

use crate::held::{self, Held};
use crate::mesh::Order;
use crate::tree::Tree;
use crate::tree::build::{Plan, Planner, Split};

/// How its triangles are divided.
pub(super) type Rule = Box<dyn Split + Send + Sync>;

/// A tree that is being built.
pub(super) enum Mending<const N: usize> {
    /// The division of these triangles, as the caller numbers them.
    Dividing(Planner<Rule>, Vec<u32>),
    /// It is done.
    Divided(Plan),
    /// The tree of it, of a mesh that had this number.
    Built(Plan, Box<(Order, Tree<N>)>, u64),
}

impl<const N: usize> Held for Mending<N> {
    fn held(&self) -> usize {
        match self {
            Self::Dividing(planner, numbers) => planner.held() + held::list(numbers),
            Self::Divided(plan) => plan.held(),
            Self::Built(plan, built, _) => {
                let (order, tree) = &**built;
                plan.held() + size_of_val(&**built) + order.held() + tree.held()
            }
        }
    }
}
