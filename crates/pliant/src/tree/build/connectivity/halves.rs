//! Halves of a cut, and the shares of weight that they should have.

/// Side of a node in a cut: false or true.
pub(super) type Half = bool;

/// Shares of weight: how many children of equal weight each side is to become.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares([u32; 2]);

impl Shares {
    /// Halves two or more children between the sides.
    pub(super) fn halves(children: usize) -> Self {
        let children = children as u32;
        Self([children / 2, children.div_ceil(2)])
    }

    /// Returns how far two weights are from the proportion of the shares; 0 if they have it.
    #[inline]
    pub(super) fn unevenness(self, weights: [u32; 2]) -> u64 {
        let [a, b] = self.products(weights);
        a.abs_diff(b)
    }

    /// Returns the side, 0 or 1, that has more of its share than the other.
    #[inline]
    pub(super) fn fuller(self, weights: [u32; 2]) -> usize {
        let [a, b] = self.products(weights);
        usize::from(b > a)
    }

    /// Returns the most that each side may weigh: its share of `total`, and `slack`.
    pub(super) fn limits(self, total: u32, slack: u32) -> [u32; 2] {
        let children = u64::from(self.0[0] + self.0[1]);
        let share = |of| (u64::from(total) * u64::from(of)).div_ceil(children) as u32;
        self.0.map(|of| share(of) + slack)
    }

    /// Cross products of weights and shares: equal if the proportion is kept.
    fn products(self, weights: [u32; 2]) -> [u64; 2] {
        let [a, b] = self.0.map(u64::from);
        [u64::from(weights[0]) * b, u64::from(weights[1]) * a]
    }
}
