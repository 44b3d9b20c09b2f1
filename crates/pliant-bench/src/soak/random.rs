//! Small pseudorandom generator (SplitMix64), the same on every machine.

/// A pseudorandom sequence, determined by its seed.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    /// A number below `range`, which is not 0.
    pub(super) fn below(&mut self, range: u32) -> u32 {
        (((self.next() >> 32) * u64::from(range)) >> 32) as u32
    }

    /// A place in a list of length `count`, which is not 0.
    pub(super) fn index(&mut self, count: usize) -> usize {
        self.below(count as u32) as usize
    }

    /// A number in [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// True with probability 1 / `times`.
    pub(super) fn one_in(&mut self, times: u32) -> bool {
        self.below(times) == 0
    }
}
