//! Mesh connectivity partition (paper, 3.2): below every node, a connected part of the mesh.
//!
//! The paper says what such a tree is, and wishes for an algorithm; this is ours. It is multilevel
//! bisection (Karypis and Kumar, *A Fast and High Quality Multilevel Scheme for Partitioning
//! Irregular Graphs*, 1998), known from METIS. What differs: both halves are connected at every
//! moment. The result depends on the triangles and their order alone. How it goes:
//! [`Connectivity`].

mod bisection;
mod coarsening;
mod components;
mod dual_graph;
mod far_ends;
mod graph;
mod halves;
mod nearby;
mod refinement;
mod search;
mod subtree;

use super::{Pieces, Split};
use crate::threads::Budget;
use bisection::Bisection;
use dual_graph::DualGraph;
use graph::Graph;
use halves::{Half, Shares};

/// Rule that divides triangles by mesh connectivity.
///
/// Two triangles are **neighbours** if they share an edge: two different vertices. Below every node
/// there is
///
/// - one connected piece of the mesh, or
/// - some of its components, each whole.
///
/// ```text
/// a node:  cut it in two, and again, until there are `degree` pieces, or a piece fits a leaf
/// cut:     components, if there are several, are shared out whole      components
///          a connected piece is bisected into two connected pieces    bisection
/// bisect:  contract neighbours, again and again                       coarsening
///          cut the coarsest graph between two far ends                far_ends
///          refine the cut, level by level back to the triangles       refinement
/// ```
///
/// Pieces are as equal as connectedness allows, up to a hundredth, and their borders have few
/// edges. Each step keeps halves connected in its own graph. That is enough, because a node of any
/// graph is a connected set of triangles. Nothing is recursive. A cut takes time in proportion to
/// its piece, so each level of the tree costs O(m), whatever the mesh.
pub(crate) struct Connectivity {
    dual: DualGraph,
    degree: usize,
    leaf_size: usize,
    bisection: Bisection,
    /// The current piece.
    piece: Graph,
    /// Side of each triangle of the piece.
    halves: Vec<Half>,
    /// Scratch: triangles of the second side.
    second: Vec<u32>,
}

impl Connectivity {
    /// Takes triangles in the caller's order.
    pub(crate) fn new(triangles: &[[u32; 3]], degree: usize, leaf_size: u32) -> Self {
        Self {
            dual: DualGraph::new(triangles),
            degree,
            leaf_size: leaf_size as usize,
            bisection: Bisection::default(),
            piece: Graph::default(),
            halves: Vec::new(),
            second: Vec::new(),
        }
    }

    /// Cuts a piece in two: orders its triangles so that each side is a run. Returns the length of
    /// the first.
    fn cut(&mut self, triangles: &mut [u32], shares: Shares) -> usize {
        self.dual.extract(triangles, &mut self.piece);
        self.bisection.bisect(&self.piece, shares, &mut self.halves);

        // The first triangle stays the first, and each side stays in order.
        let first = self.halves[0];
        let mut length = 0;
        self.second.clear();
        for (place, &side) in self.halves.iter().enumerate() {
            if side == first {
                triangles[length] = triangles[place];
                length += 1;
            } else {
                self.second.push(triangles[place]);
            }
        }
        triangles[length..].copy_from_slice(&self.second);
        length
    }
}

impl Split for Connectivity {
    fn split(&mut self, triangles: &mut [u32], pieces: &mut Pieces, budget: &mut Budget) -> bool {
        budget.spend(triangles.len());
        // Runs still to be cut, the first on top, and how many children each is to become.
        let mut runs = vec![(0, triangles.len(), self.degree)];
        while let Some((start, length, children)) = runs.pop() {
            if children == 1 || length <= self.leaf_size {
                pieces.push(length);
                continue;
            }
            let run = &mut triangles[start..start + length];
            let left = self.cut(run, Shares::halves(children));
            // In proportion to what the halves have got. That may be far from half, since
            // components stay whole.
            let left_children = (2 * children * left + length) / (2 * length);
            let left_children = left_children.clamp(1, children - 1);
            runs.push((start + left, length - left, children - left_children));
            runs.push((start, left, left_children));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::plan;
    use super::Connectivity;
    use super::graph::tests::LINKS_READ;

    /// Links read to build a tree of single triangles, for each triangle and level of halving.
    fn work(triangles: &[[u32; 3]]) -> f64 {
        let before = LINKS_READ.get();
        let rule = Connectivity::new(triangles, 8, 1);
        let plan = plan(triangles.len(), 8, 1, rule);
        assert!(plan.nodes.len() > triangles.len());
        let levels = f64::from((triangles.len() as u32).ilog2());
        (LINKS_READ.get() - before) as f64 / triangles.len() as f64 / levels
    }

    #[test]
    fn work_grows_with_the_mesh_and_no_faster() {
        let mut state = 1_u64;
        let mut random = move |below: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as u32 % below
        };
        // Any triangles over few vertices: each edge has six on average.
        let mut tangle = |count: u32| -> Vec<[u32; 3]> {
            let vertices = count.isqrt();
            (0..count)
                .map(|_| [(); 3].map(|()| random(vertices)))
                .collect()
        };
        let meshes: [(&str, f64, &mut dyn FnMut(u32) -> Vec<[u32; 3]>); 7] = [
            ("grid", 50.0, &mut |n| {
                let side = (n / 2).isqrt();
                let corner = |i| i / side * (side + 1) + i % side;
                let quads = (0..side * side).map(corner);
                quads
                    .flat_map(|c| {
                        [
                            [c, c + 1, c + side + 1],
                            [c + 1, c + side + 2, c + side + 1],
                        ]
                    })
                    .collect()
            }),
            ("strip", 20.0, &mut |n| {
                (0..n).map(|i| [i, i + 1, i + 2]).collect()
            }),
            ("fan", 20.0, &mut |n| {
                (0..n).map(|i| [0, i + 1, i + 2]).collect()
            }),
            ("book", 20.0, &mut |n| {
                (0..n).map(|i| [0, 1, i + 2]).collect()
            }),
            ("confetti", 1.0, &mut |n| {
                (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()
            }),
            ("three books", 20.0, &mut |n| {
                (0..n).map(|i| [i % 3, (i + 1) % 3, i + 3]).collect()
            }),
            ("tangle", 200.0, &mut tangle),
        ];
        for (name, most, mesh) in meshes {
            let [small, large] = [2_000, 16_000].map(|count| work(&mesh(count)));
            eprintln!("{name}: {small:.1} links a triangle and level, then {large:.1}");
            assert!(large <= most, "{name}: {large}");
            assert!(large <= 1.5 * small + 1.0, "{name}: {small}, then {large}");
        }
    }
}
