//! Two halves of a cut, and what each should weigh.

/// One of two: false or true, by node.
pub(super) type Half = bool;

/// How many children of equal weight each side is to become: halves should weigh like their shares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares([u32; 2]);

impl Shares {
    /// Of two children at least, half for each side.
    pub(super) fn halves(children: usize) -> Self {
        let children = children as u32;
        Self([children / 2, children.div_ceil(2)])
    }

    /// How far two weights are from the proportion of the shares; 0 if they have it.
    #[inline]
    pub(super) fn unevenness(self, weights: [u32; 2]) -> u64 {
        let [a, b] = self.products(weights);
        a.abs_diff(b)
    }

    /// The side that has more of its share than the other, 0 or 1.
    #[inline]
    pub(super) fn fuller(self, weights: [u32; 2]) -> usize {
        let [a, b] = self.products(weights);
        usize::from(b > a)
    }

    /// What each side weighs at most, if it may have `slack` more than its share of a total.
    pub(super) fn limits(self, total: u32, slack: u32) -> [u32; 2] {
        let children = u64::from(self.0[0] + self.0[1]);
        let share = |of| (u64::from(total) * u64::from(of)).div_ceil(children) as u32;
        self.0.map(|of| share(of) + slack)
    }

    fn products(self, weights: [u32; 2]) -> [u64; 2] {
        let [a, b] = self.0.map(u64::from);
        [u64::from(weights[0]) * b, u64::from(weights[1]) * a]
    }
}
