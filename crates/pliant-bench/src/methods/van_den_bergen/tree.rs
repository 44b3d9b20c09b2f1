//! Tree of boxes in one array, built once and refitted as a whole every step.
//!
//! A node *is* the run of its children, each of which holds its own box and the place of its own
//! children. So both boxes of a binary node lie in one cache line, as in the published method; a
//! wide node is a longer run. The root's box comes first, as a run of one, and parents come before
//! their children. Triangles are kept in the order of the leaves, and vertices as triangles first
//! use them, so that refit and descent read adjacent memory.

use super::centre_box::CentreBox;
use std::ops::Range;

/// A child, as its parent holds it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Child {
    pub(super) bounds: CentreBox,
    /// First of its children or, in a leaf, the triangle.
    first: u32,
    /// Number of its children; 0 in a leaf.
    count: u32,
}

impl Child {
    const UNKNOWN: Self = Self {
        bounds: CentreBox::ORIGIN,
        first: 0,
        count: 0,
    };

    /// Triangle in the tree's order, if this is a leaf.
    #[inline]
    pub(super) fn triangle(&self) -> Option<u32> {
        (self.count == 0).then_some(self.first)
    }

    /// Places of its children.
    #[inline]
    pub(super) fn children(&self) -> Range<usize> {
        let first = self.first as usize;
        first..first + self.count as usize
    }
}

/// A tree of boxes over the triangles of a body, one a leaf.
#[derive(Debug)]
pub(super) struct Tree {
    children: Vec<Child>,
    /// Place of each triangle's leaf.
    leaves: Vec<u32>,
    /// Places of all other children, last first.
    inner: Vec<u32>,
    /// Number of boxes on the longest path down.
    levels: usize,
    /// Corners, in the tree's order of triangles and of vertices.
    corners: Vec<[u32; 3]>,
    /// Number in the body of each triangle.
    triangles: Vec<u32>,
    /// Number in the body of each vertex that a triangle uses.
    vertices: Vec<u32>,
}

impl Tree {
    /// Builds a tree of nodes with up to 2^`halvings` children; there must be a triangle.
    ///
    /// A set is cut across the longest side of its box, at the centre of the box. A triangle goes
    /// by the centre of its own box. If that leaves a side empty, the order is cut in the middle.
    /// The 8-ary tree is the binary tree with three levels made one: the same cuts, and nodes that
    /// are full except near the leaves.
    pub(super) fn build(triangles: &[[u32; 3]], positions: &[[f32; 3]], halvings: u32) -> Self {
        assert!(!triangles.is_empty(), "a body without triangles");
        let boxes: Vec<CentreBox> = triangles
            .iter()
            .map(|corners| CentreBox::of_triangle(corners.map(|v| positions[v as usize])))
            .collect();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut children = vec![Child::UNKNOWN];
        let mut leaves = vec![0; order.len()];
        let mut levels = 0;
        let mut parts = Vec::new();
        // Place of a child, triangles below it, and number of boxes on the way.
        let mut ahead = vec![(0_usize, 0..order.len(), 1_usize)];
        while let Some((place, set, level)) = ahead.pop() {
            levels = levels.max(level);
            if set.len() == 1 {
                children[place].first = set.start as u32;
                leaves[set.start] = place as u32;
                continue;
            }
            parts.clear();
            parts.push(set);
            for _ in 0..halvings {
                halve_all(&mut parts, &mut order, &boxes);
            }
            let first = children.len();
            children[place].first = first as u32;
            children[place].count = parts.len() as u32;
            children.resize(first + parts.len(), Child::UNKNOWN);
            let deeper = parts.drain(..).enumerate().rev();
            ahead.extend(deeper.map(|(child, part)| (first + child, part, level + 1)));
        }

        let mut inner: Vec<u32> = (0..children.len() as u32).collect();
        inner.retain(|&place| children[place as usize].count > 0);
        inner.reverse();

        let mut new_number = vec![u32::MAX; positions.len()];
        let mut vertices = Vec::new();
        let corners = order.iter().map(|&triangle| {
            triangles[triangle as usize].map(|vertex| {
                let number = &mut new_number[vertex as usize];
                if *number == u32::MAX {
                    *number = vertices.len() as u32;
                    vertices.push(vertex);
                }
                *number
            })
        });
        let corners = corners.collect();
        Self {
            children,
            leaves,
            inner,
            levels,
            corners,
            triangles: order,
            vertices,
        }
    }

    /// Copies a body's positions into the tree's order.
    pub(super) fn take_over(&self, positions: &[[f32; 3]], own: &mut Vec<[f32; 3]>) {
        own.clear();
        own.extend(self.vertices.iter().map(|&v| positions[v as usize]));
    }

    /// Refits every box, from positions in the tree's order.
    ///
    /// All leaves come first, then the other boxes from the end to the beginning: children are
    /// always ready. Leaves are apart from the rest, because no branch predictor knows which comes
    /// next. That makes a refit a third faster and changes nothing else.
    pub(super) fn refit(&mut self, positions: &[[f32; 3]]) {
        for (triangle, &place) in (0..).zip(&self.leaves) {
            let bounds = CentreBox::of_triangle(self.corners(triangle, positions));
            self.children[place as usize].bounds = bounds;
        }
        for &place in &self.inner {
            let below = &self.children[self.children[place as usize].children()];
            let bounds = CentreBox::hull(below.iter().map(|child| &child.bounds));
            self.children[place as usize].bounds = bounds;
        }
    }

    /// Corner positions of a triangle, both in the tree's order.
    #[inline]
    pub(super) fn corners(&self, triangle: u32, positions: &[[f32; 3]]) -> [[f32; 3]; 3] {
        self.corners[triangle as usize].map(|vertex| positions[vertex as usize])
    }

    /// Whether two triangles share a vertex.
    #[inline]
    pub(super) fn share_a_vertex(&self, a: u32, b: u32) -> bool {
        crate::methods::bodies::share_a_vertex(self.corners[a as usize], self.corners[b as usize])
    }

    /// Number in the body of a triangle.
    #[inline]
    pub(super) fn number(&self, triangle: u32) -> u32 {
        self.triangles[triangle as usize]
    }

    /// Every child, with the root before them.
    #[inline]
    pub(super) fn all(&self) -> &[Child] {
        &self.children
    }

    /// Box around everything.
    pub(super) fn root(&self) -> &CentreBox {
        &self.children[0].bounds
    }

    /// Number of boxes made on the way from a corner to the root's box, over which rounding errors
    /// add up.
    pub(super) fn levels(&self) -> usize {
        self.levels
    }
}

/// Cuts each part that holds more than one triangle into two.
fn halve_all(parts: &mut Vec<Range<usize>>, order: &mut [u32], boxes: &[CentreBox]) {
    let mut halves = Vec::with_capacity(2 * parts.len());
    for part in parts.drain(..) {
        if part.len() == 1 {
            halves.push(part);
        } else {
            let middle = part.start + halve(&mut order[part.clone()], boxes);
            halves.extend([part.start..middle, middle..part.end]);
        }
    }
    *parts = halves;
}

/// Cuts a set of at least two, keeping the order on either side. Returns how many come first.
fn halve(set: &mut [u32], boxes: &[CentreBox]) -> usize {
    let hull = CentreBox::hull(set.iter().map(|&triangle| &boxes[triangle as usize]));
    let axis = (1..3).fold(0, |longest, axis| {
        if hull.half[axis] > hull.half[longest] {
            axis
        } else {
            longest
        }
    });
    let first = |triangle: &u32| boxes[*triangle as usize].centre[axis] < hull.centre[axis];
    // A stable sort by a bit is a partition.
    set.sort_by_key(|triangle| !first(triangle));
    match set.partition_point(first) {
        0 => set.len() / 2,
        count if count == set.len() => set.len() / 2,
        count => count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_scenes::Scene;

    fn sphere(triangles: usize) -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
        let scene = Scene::new("spheres", Some(triangles), 3).unwrap();
        let mut positions = Vec::new();
        scene.positions(1, 40, &mut positions);
        (scene.triangles(1).to_vec(), positions)
    }

    /// Checks that children come after parents, every triangle once, and that boxes hold their
    /// triangles except for rounding.
    fn check(tree: &Tree, own: &[[f32; 3]], degree: usize) {
        let mut met = vec![0; tree.triangles.len()];
        let mut parents = vec![0; tree.children.len()];
        for (place, child) in tree.children.iter().enumerate() {
            if let Some(triangle) = child.triangle() {
                met[triangle as usize] += 1;
                continue;
            }
            assert!((2..=degree).contains(&child.children().len()));
            assert!(child.children().start > place);
            child.children().for_each(|child| parents[child] += 1);
        }
        assert!(met.iter().all(|&times| times == 1));
        assert!(parents[0] == 0 && parents[1..].iter().all(|&times| times == 1));

        let mut ahead: Vec<(usize, Vec<usize>)> = vec![(0, Vec::new())];
        let mut deepest = 0;
        while let Some((place, mut above)) = ahead.pop() {
            above.push(place);
            deepest = deepest.max(above.len());
            let child = &tree.children[place];
            if let Some(triangle) = child.triangle() {
                // The bound of `relation` on what a box may miss: 2 D u r.
                let reach = f64::from(tree.root().reach());
                let room = tree.levels() as f64 * f64::from(f32::EPSILON) * reach;
                for corner in tree.corners(triangle, own) {
                    for &place in &above {
                        let bounds = &tree.children[place].bounds;
                        for axis in 0..3 {
                            let off = f64::from(corner[axis]) - f64::from(bounds.centre[axis]);
                            assert!(off.abs() <= f64::from(bounds.half[axis]) + room);
                        }
                    }
                }
            } else {
                ahead.extend(child.children().map(|place| (place, above.clone())));
            }
        }
        assert_eq!(deepest, tree.levels());
    }

    #[test]
    fn trees_are_trees_before_and_after_a_step() {
        for (halvings, degree) in [(1, 2), (2, 4), (3, 8)] {
            for size in [4, 320, 1_280] {
                let (triangles, positions) = sphere(size);
                let mut tree = Tree::build(&triangles, &positions, halvings);
                let mut own = Vec::new();
                for factor in [1.0, -3.0] {
                    let moved: Vec<_> = positions.iter().map(|p| p.map(|x| x * factor)).collect();
                    tree.take_over(&moved, &mut own);
                    tree.refit(&own);
                    check(&tree, &own, degree);
                }
            }
        }
    }

    #[test]
    fn a_binary_tree_has_twice_as_many_boxes_as_triangles_and_a_wide_one_fewer() {
        let (triangles, positions) = sphere(5_120);
        let boxes = [1, 3].map(|h| Tree::build(&triangles, &positions, h).all().len());
        assert_eq!(boxes[0], 2 * 5_120 - 1);
        assert!(boxes[1] < 5_120 * 7 / 5, "{}", boxes[1]);
    }

    #[test]
    fn triangles_in_one_place_are_cut_in_the_middle_of_their_order() {
        let triangles = vec![[0, 1, 2]; 1_000];
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut tree = Tree::build(&triangles, &positions, 1);
        let mut own = Vec::new();
        tree.take_over(&positions, &mut own);
        tree.refit(&own);
        check(&tree, &own, 2);
        assert_eq!(tree.levels(), 11);
    }
}
