//! Invariant of a mesh connectivity tree: below a node is one connected piece, or whole components.
//!
//! Checked by union-find over edges: nothing in common with how the tree was built.

use crate::mesh::find_root;
use std::collections::BTreeMap;
use std::ops::Range;

/// Components of a mesh, connected over edges.
pub(super) struct Connectedness {
    triangles: Vec<[u32; 3]>,
    /// Component of each triangle.
    components: Vec<u32>,
    /// How many triangles each component has.
    sizes: BTreeMap<u32, usize>,
}

impl Connectedness {
    pub(super) fn new(triangles: Vec<[u32; 3]>) -> Self {
        let components = components(&triangles);
        let sizes = sizes(&components);
        Self {
            triangles,
            components,
            sizes,
        }
    }

    /// Whether a run of triangles is one connected piece, or whole components.
    pub(super) fn holds_for(&self, run: Range<usize>) -> bool {
        if sizes(&components(&self.triangles[run.clone()])).len() == 1 {
            return true;
        }
        let within = sizes(&self.components[run]);
        within
            .iter()
            .all(|(component, size)| self.sizes[component] == *size)
    }
}

/// Counts the triangles of each component.
fn sizes(components: &[u32]) -> BTreeMap<u32, usize> {
    let mut sizes = BTreeMap::new();
    for &component in components {
        *sizes.entry(component).or_insert(0) += 1;
    }
    sizes
}

/// Labels each triangle with one triangle of its component, the same for all of them.
fn components(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (triangle, [a, b, c]) in (0_u32..).zip(triangles) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if from != to {
                sides.push((from.min(to), from.max(to), triangle));
            }
        }
    }
    sides.sort_unstable();
    let mut parents: Vec<u32> = (0..triangles.len() as u32).collect();
    for pair in sides.windows(2) {
        if (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1) {
            let [a, b] = [pair[0].2, pair[1].2].map(|triangle| find_root(&mut parents, triangle));
            parents[a.max(b) as usize] = a.min(b);
        }
    }
    (0..triangles.len() as u32)
        .map(|triangle| find_root(&mut parents, triangle))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_or_whole_components() {
        // A strip of three, a strip of two, one that touches both in a vertex, one that is a
        // segment of the first strip's.
        let triangles = vec![
            [0, 1, 2],
            [1, 2, 3],
            [2, 3, 4],
            [5, 6, 7],
            [7, 8, 6],
            [0, 9, 5],
            [4, 3, 4],
        ];
        let mesh = Connectedness::new(triangles);
        assert_eq!(mesh.components, [0, 0, 0, 3, 3, 5, 0]);
        for run in [0..1, 0..2, 1..3, 3..5, 3..4, 3..6, 5..6, 6..7, 0..7] {
            assert!(mesh.holds_for(run.clone()), "{run:?}");
        }
        for run in [0..4, 2..5, 2..7, 4..6, 5..7, 0..6] {
            assert!(!mesh.holds_for(run.clone()), "{run:?}");
        }
    }
}
