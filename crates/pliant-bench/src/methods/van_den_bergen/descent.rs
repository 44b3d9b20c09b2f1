//! Traversal of two trees, or of one with itself, from the roots to pairs of leaves whose boxes
//! overlap.
//!
//! Of two nodes the larger is opened, by the largest half extent of their boxes; the first of equal
//! ones. Leaves are never opened. All children of the opened node are tested against the box of the
//! other. There are two in a binary tree, up to eight in a wide one. Depth first, on a stack
//! instead of recursion.

use super::relation::Relation;
use super::tree::{Child, Tree};
use std::ops::ControlFlow;

/// Pending pairs of places; kept between descents for its memory.
pub(super) type Stack = Vec<[u32; 2]>;

/// Visits pairs of triangles, in the order of their trees, and adds up the box tests.
pub(super) fn two_trees<R: Relation>(
    [a, b]: [&Tree; 2],
    relation: &R,
    stack: &mut Stack,
    tests: &mut u64,
    mut visit: impl FnMut(u32, u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    stack.clear();
    *tests += 1;
    if R::meets(&relation.hold_a(a.root()), b.root()) {
        stack.push([0, 0]);
    }
    while let Some([i, j]) = stack.pop() {
        if let Some([s, t]) = step([a.all(), b.all()], [i, j], relation, stack, tests) {
            visit(s, t)?;
        }
    }
    ControlFlow::Continue(())
}

/// Visits pairs of triangles of one tree, each once, in either order. `relation` is of the tree to
/// itself.
pub(super) fn one_tree<R: Relation>(
    tree: &Tree,
    relation: &R,
    stack: &mut Stack,
    tests: &mut u64,
    mut visit: impl FnMut(u32, u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let all = tree.all();
    stack.clear();
    stack.push([0, 0]);
    while let Some([i, j]) = stack.pop() {
        if i != j {
            if let Some([s, t]) = step([all, all], [i, j], relation, stack, tests) {
                visit(s, t)?;
            }
            continue;
        }
        // A node against itself: each child against itself and against later children.
        let children = all[i as usize].children();
        for first in children.clone() {
            stack.push([first as u32; 2]);
            let held = relation.hold_a(&all[first].bounds);
            for second in first + 1..children.end {
                *tests += 1;
                if R::meets(&held, &all[second].bounds) {
                    stack.push([first as u32, second as u32]);
                }
            }
        }
    }
    ControlFlow::Continue(())
}

/// Handles a pair of places whose boxes overlap: two triangles, or pairs below them.
#[inline]
fn step<R: Relation>(
    [a, b]: [&[Child]; 2],
    [i, j]: [u32; 2],
    relation: &R,
    stack: &mut Stack,
    tests: &mut u64,
) -> Option<[u32; 2]> {
    let (x, y) = (&a[i as usize], &b[j as usize]);
    let open_b = match (x.triangle(), y.triangle()) {
        (Some(s), Some(t)) => return Some([s, t]),
        (Some(_), None) => true,
        (None, Some(_)) => false,
        (None, None) => x.bounds.size() < y.bounds.size(),
    };
    if open_b {
        let held = relation.hold_a(&x.bounds);
        *tests += y.children().len() as u64;
        for (child, k) in b[y.children()].iter().zip(y.children()) {
            if R::meets(&held, &child.bounds) {
                stack.push([i, k as u32]);
            }
        }
    } else {
        let held = relation.hold_b(&y.bounds);
        *tests += x.children().len() as u64;
        for (child, k) in a[x.children()].iter().zip(x.children()) {
            if R::meets(&held, &child.bounds) {
                stack.push([k as u32, j]);
            }
        }
    }
    None
}
