//! Balanced partition: a tree whose leaves and lanes are full, except near the root.
//!
//! A node of n triangles whose children can hold c each gets ceil(n / c) children. Children are
//! found by halving. Each halving divides the midpoints along the longest side of their box, at the
//! multiple of c nearest the middle. All subtrees except the last child's are full: leaf size x
//! degree^height triangles. Not in the paper, whose trees are cut at points of space; on surfaces
//! those leave about half of eight lanes empty.

use super::initial_shape::midpoint;
use super::{Pieces, Split};
use crate::geometry::{Bounds, Real};
use crate::held;
use crate::threads::Budget;

/// Rule that divides triangles by the median of their midpoints, in multiples of a full subtree.
pub(crate) struct Balanced {
    midpoints: Vec<[f64; 3]>,
    degree: usize,
    leaf_size: usize,
    /// Stack of the halves of the current node that are still to be divided: first triangle,
    /// length, children. At most log2(degree) + 1 of them.
    halves: Vec<(usize, usize, usize)>,
    /// Keys by which the triangles of a node are ordered; the memory is kept from node to node.
    keys: Vec<u128>,
}

impl Balanced {
    /// Takes triangles and positions in the caller's order.
    pub(crate) fn new<S: Real>(
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
        degree: usize,
        leaf_size: u32,
    ) -> Self {
        let midpoints = triangles
            .iter()
            .map(|corners| midpoint(corners.map(|vertex| positions[vertex as usize])));
        Self::of_midpoints(midpoints.collect(), degree, leaf_size)
    }

    /// Takes the midpoints of triangles.
    pub(crate) fn of_midpoints(midpoints: Vec<[f64; 3]>, degree: usize, leaf_size: u32) -> Self {
        Self {
            midpoints,
            degree,
            leaf_size: leaf_size as usize,
            halves: Vec::new(),
            keys: Vec::new(),
        }
    }

    /// Returns how many triangles a child of a node of `count` can hold: the smallest full tree
    /// that suffices.
    fn capacity(&self, count: usize) -> usize {
        let mut capacity = self.leaf_size;
        while capacity * self.degree < count {
            capacity *= self.degree;
        }
        capacity
    }

    /// Partitions triangles: the first `left` have the smaller midpoints along the longest side.
    /// O(n).
    fn divide(&mut self, triangles: &mut [u32], left: usize) {
        let (midpoints, keys) = (&self.midpoints, &mut self.keys);
        let midpoint = |triangle: u32| midpoints[triangle as usize];
        let mut bounds = Bounds::EMPTY;
        for &triangle in &*triangles {
            bounds.include(midpoint(triangle));
        }
        let axis = super::axes_by_length(bounds.lo, bounds.hi)[0];
        let in_order = triangles.iter();
        keys.clear();
        keys.extend(in_order.map(|&triangle| key(midpoint(triangle)[axis], triangle)));
        keys.select_nth_unstable(left);
        for (triangle, key) in triangles.iter_mut().zip(&*keys) {
            *triangle = *key as u32;
        }
    }
}

/// Sort key of a triangle: its coordinate, then its number.
///
/// Ties are broken by number, so that the tree does not depend on the selection algorithm. One
/// integer, because comparisons that look up two midpoints were half of the cost of building.
fn key(coordinate: f64, triangle: u32) -> u128 {
    let bits = coordinate.to_bits();
    // Of negative numbers the larger magnitude is the smaller number.
    let ordered = if bits >> 63 == 0 {
        bits | 1 << 63
    } else {
        !bits
    };
    u128::from(ordered) << 32 | u128::from(triangle)
}

impl Split for Balanced {
    fn held(&self) -> usize {
        held::list(&self.midpoints) + held::list(&self.keys)
    }

    fn split(&mut self, triangles: &mut [u32], pieces: &mut Pieces, budget: &mut Budget) -> bool {
        let capacity = self.capacity(triangles.len());
        if self.halves.is_empty() {
            let children = triangles.len().div_ceil(capacity);
            self.halves.push((0, triangles.len(), children));
        }
        while let Some((start, length, children)) = self.halves.pop() {
            if children == 1 {
                pieces.push(length);
                continue;
            }
            if budget.is_spent() {
                self.halves.push((start, length, children));
                return false;
            }
            budget.spend(length);
            let left_children = children / 2;
            let left = left_children * capacity;
            self.divide(&mut triangles[start..start + length], left);
            let right_children = children - left_children;
            self.halves
                .push((start + left, length - left, right_children));
            self.halves.push((start, left, left_children));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_coordinates_and_then_of_numbers() {
        let coordinates = [
            f64::MIN,
            -1.5,
            -f64::MIN_POSITIVE,
            -5e-324,
            -0.0,
            0.0,
            5e-324,
            1.0,
            f64::MAX,
        ];
        let keys = coordinates.map(|coordinate| [0, 7, u32::MAX].map(|it| key(coordinate, it)));
        assert!(keys.as_flattened().is_sorted_by(|a, b| a < b), "{keys:?}");
    }
}
