//! Packing of hits into integer keys that have the order of the hits.
//!
//! Numbers of bodies, and numbers within them, take few bits each, so the four numbers of a hit
//! side by side make one key.

use super::hit::Hit;

/// Bits for a body's number and bits for a number within a body: how four numbers make one key.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Packing {
    body: u32,
    number: u32,
}

impl Packing {
    /// More bits than a key has.
    pub(super) const UNFIT: Self = Self {
        body: u32::BITS,
        number: u32::BITS,
    };

    /// Packing with enough bits for these hits too.
    pub(super) fn with<T: Hit>(self, hits: &[T]) -> Self {
        let all = hits.iter().map(T::numbers);
        let (bodies, numbers) = all.fold((0, 0), |(bodies, numbers), [a, x, b, y]| {
            (bodies | a | b, numbers | x | y)
        });
        self.and(Self {
            body: u32::BITS - bodies.leading_zeros(),
            number: u32::BITS - numbers.leading_zeros(),
        })
    }

    /// Packing with enough bits for the hits of both packings.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            body: self.body.max(other.body),
            number: self.number.max(other.number),
        }
    }

    /// Whether 63 bits are enough.
    pub(super) fn fits(self) -> bool {
        2 * (self.body + self.number) < u64::BITS
    }

    /// Bit positions of the first three numbers.
    fn shifts(self) -> [u32; 3] {
        let Self { body, number } = self;
        [body + 2 * number, body + number, number]
    }

    #[inline(always)]
    pub(super) fn key(self, numbers: [u32; 4]) -> u64 {
        let shifts = self.shifts();
        let [a, x, b, y] = numbers.map(u64::from);
        a << shifts[0] | x << shifts[1] | b << shifts[2] | y
    }

    #[inline(always)]
    pub(super) fn numbers(self, key: u64) -> [u32; 4] {
        let shifts = self.shifts();
        let [body, number] = [self.body, self.number].map(|bits| (1_u64 << bits) - 1);
        [
            (key >> shifts[0] & body) as u32,
            (key >> shifts[1] & number) as u32,
            (key >> shifts[2] & body) as u32,
            (key & number) as u32,
        ]
    }
}
