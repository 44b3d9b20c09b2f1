//! Division of a graph that is not connected: whole components are dealt out to two sides.
//!
//! Components form a row in the order of their first triangles, since what belongs together is
//! often together in a file. The row is cut between two of them, as near its middle as possible. If
//! that is uneven, they are dealt out largest first, each to the lighter side, if this is more
//! even. A component larger than all others together stands alone, and is bisected later. No side
//! has more than two thirds unless it is one component.

use super::halves::Half;
use std::cmp::Reverse;

/// A side is uneven if it exceeds half by more than the whole divided by this.
const UNEVEN: u32 = 16;

/// Components to be dealt out, and memory for their sides.
#[derive(Debug, Default)]
pub(super) struct Components {
    /// Triangles of each component, in the order of their first triangles.
    sizes: Vec<u32>,
    halves: Vec<Half>,
    largest_first: Vec<u32>,
}

impl Components {
    /// Removes all components.
    pub(super) fn clear(&mut self) {
        self.sizes.clear();
    }

    /// Adds a component.
    pub(super) fn push(&mut self, size: u32) {
        self.sizes.push(size);
    }

    /// Assigns each of two or more components to a side. Returns sizes and sides.
    pub(super) fn share_out(&mut self) -> impl Iterator<Item = (u32, Half)> {
        self.choose_sides();
        self.sizes.iter().copied().zip(self.halves.iter().copied())
    }

    /// Chooses the sides: the row cut in two, or dealt out largest first if that is more even.
    fn choose_sides(&mut self) {
        let total: u32 = self.sizes.iter().sum();
        // The row is cut before the first component whose middle is beyond the row's middle.
        let (mut cut, mut before) = (0, 0);
        while 2 * before + self.sizes[cut] <= total {
            before += self.sizes[cut];
            cut += 1;
        }
        let in_a_row = before.max(total - before);
        if in_a_row > total.div_ceil(2) + total / UNEVEN
            && self.share_out_largest_first() < in_a_row
        {
            return;
        }
        let row = 0..self.sizes.len();
        self.halves.clear();
        self.halves.extend(row.map(|component| component >= cut));
    }

    /// Deals out components, largest first. Returns the size of the larger side.
    fn share_out_largest_first(&mut self) -> u32 {
        let components = 0..self.sizes.len() as u32;
        self.largest_first.clear();
        self.largest_first.extend(components);
        // Stable: of equal components the first.
        self.largest_first
            .sort_by_key(|&component| Reverse(self.sizes[component as usize]));
        self.halves.clear();
        self.halves.resize(self.sizes.len(), false);
        let mut shared = [0; 2];
        for &component in &self.largest_first {
            let side = shared[1] < shared[0];
            self.halves[component as usize] = side;
            shared[usize::from(side)] += self.sizes[component as usize];
        }
        shared[0].max(shared[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn share_out(sizes: &[u32]) -> Vec<Half> {
        let mut components = Components::default();
        sizes.iter().for_each(|&size| components.push(size));
        components.share_out().map(|(_, side)| side).collect()
    }

    #[test]
    fn small_components_stay_in_order() {
        assert_eq!(share_out(&[1, 1]), [false, true]);
        assert_eq!(share_out(&[1, 1, 1]), [false, false, true]);
        let halves = share_out(&[3; 100]);
        assert!(halves.is_sorted());
        assert_eq!(halves.iter().filter(|&&side| side).count(), 50);
    }

    #[test]
    fn a_large_component_stands_alone() {
        assert_eq!(share_out(&[2, 80, 18]), [true, false, true]);
        assert_eq!(share_out(&[90, 10]), [false, true]);
        assert_eq!(share_out(&[10, 90]), [false, true]);
    }

    #[test]
    fn few_components_are_dealt_evenly() {
        assert_eq!(share_out(&[30, 50, 20]), [true, false, true]);
        assert_eq!(share_out(&[20, 20, 20, 60]), [false, false, false, true]);
    }

    proptest! {
        #[test]
        fn no_side_is_empty_and_none_too_large(sizes in prop::collection::vec(1_u32..200, 2..40)) {
            let halves = share_out(&sizes);
            let total: u32 = sizes.iter().sum();
            for side in [false, true] {
                let here = || sizes.iter().zip(&halves).filter(|&(_, &other)| other == side);
                let size: u32 = here().map(|(size, _)| size).sum();
                prop_assert!(size > 0);
                prop_assert!(here().count() == 1 || 3 * size <= 2 * total, "{sizes:?} {halves:?}");
            }
        }
    }
}
