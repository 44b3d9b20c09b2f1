//! Dealing out the components of a piece that is not connected.
//!
//! **The rule.** Components are taken in the order of their first triangles (what belongs together is often together in a
//! file), and the row is cut between two of them, as near its middle as it goes. If a large component makes that uneven, they
//! are dealt out instead, if that is more even: the largest first, each to the side that has less. One that is larger than all
//! others together then stands alone, and is bisected when its turn comes.
//!
//! So sides hold whole components, and no side has more than two thirds unless it is one component.

use super::sides::Side;
use std::cmp::Reverse;

/// A side with this part of the whole more than half of it is uneven.
const UNEVEN: u32 = 16;

#[derive(Debug, Default)]
pub(super) struct Components {
    /// Triangles of each component, in the order of their first triangles.
    sizes: Vec<u32>,
    sides: Vec<Side>,
    largest_first: Vec<u32>,
}

impl Components {
    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.sizes.clear();
    }

    /// Adds a component.
    pub(super) fn push(&mut self, size: u32) {
        self.sizes.push(size);
    }

    /// Gives every component a side; there are two at least. Returns sizes and sides.
    pub(super) fn deal(&mut self) -> impl Iterator<Item = (u32, Side)> {
        self.choose_sides();
        self.sizes.iter().copied().zip(self.sides.iter().copied())
    }

    fn choose_sides(&mut self) {
        let total: u32 = self.sizes.iter().sum();
        // The row is cut before the first component whose middle is beyond the middle.
        let (mut cut, mut before) = (0, 0);
        while 2 * before + self.sizes[cut] <= total {
            before += self.sizes[cut];
            cut += 1;
        }
        let in_a_row = before.max(total - before);
        if in_a_row > total.div_ceil(2) + total / UNEVEN && self.deal_largest_first() < in_a_row {
            return;
        }
        let row = 0..self.sizes.len();
        self.sides.clear();
        self.sides.extend(row.map(|component| component >= cut));
    }

    /// Returns what the side with more has.
    fn deal_largest_first(&mut self) -> u32 {
        let components = 0..self.sizes.len() as u32;
        self.largest_first.clear();
        self.largest_first.extend(components);
        // Stable: of equal components the first.
        self.largest_first
            .sort_by_key(|&component| Reverse(self.sizes[component as usize]));
        self.sides.clear();
        self.sides.resize(self.sizes.len(), false);
        let mut dealt = [0; 2];
        for &component in &self.largest_first {
            let side = dealt[1] < dealt[0];
            self.sides[component as usize] = side;
            dealt[usize::from(side)] += self.sizes[component as usize];
        }
        dealt[0].max(dealt[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn deal(sizes: &[u32]) -> Vec<Side> {
        let mut components = Components::default();
        sizes.iter().for_each(|&size| components.push(size));
        components.deal().map(|(_, side)| side).collect()
    }

    #[test]
    fn small_components_stay_in_order() {
        assert_eq!(deal(&[1, 1]), [false, true]);
        assert_eq!(deal(&[1, 1, 1]), [false, false, true]);
        let sides = deal(&[3; 100]);
        assert!(sides.is_sorted());
        assert_eq!(sides.iter().filter(|&&side| side).count(), 50);
    }

    #[test]
    fn a_large_component_stands_alone() {
        assert_eq!(deal(&[2, 80, 18]), [true, false, true]);
        assert_eq!(deal(&[90, 10]), [false, true]);
        assert_eq!(deal(&[10, 90]), [false, true]);
    }

    #[test]
    fn few_components_are_dealt_evenly() {
        assert_eq!(deal(&[30, 50, 20]), [true, false, true]);
        assert_eq!(deal(&[20, 20, 20, 60]), [false, false, false, true]);
    }

    proptest! {
        #[test]
        fn no_side_is_empty_and_none_too_large(sizes in prop::collection::vec(1_u32..200, 2..40)) {
            let sides = deal(&sizes);
            let total: u32 = sizes.iter().sum();
            for side in [false, true] {
                let here = || sizes.iter().zip(&sides).filter(|&(_, &other)| other == side);
                let size: u32 = here().map(|(size, _)| size).sum();
                prop_assert!(size > 0);
                prop_assert!(here().count() == 1 || 3 * size <= 2 * total, "{sizes:?} {sides:?}");
            }
        }
    }
}
