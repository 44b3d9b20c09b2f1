//! Memory grows with the data that has arrived, never on a claim, and never beyond a limit.
//!
//! A header may announce 2^60 vertices in a file of 100 bytes. So nothing is reserved by count:
//! arrays double as they fill, and the doubling stops at the limit. Where a count is announced, it
//! is used twice: to refuse a frame beyond the limit before it is read, and to stop the last
//! doubling at the right size.

use crate::error::Reason;

/// The first reservation, in items: large enough that small meshes grow once, small enough to mean
/// nothing (under 2 MiB).
const FIRST: usize = 1 << 16;

/// What one array may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Allowance {
    /// What is stored, for the message: "the vertices of a frame".
    pub(crate) what: &'static str,
    /// In bytes.
    pub(crate) limit: u64,
}

impl Allowance {
    /// Refuses `count` announced items of type `T` that the limit does not allow.
    pub(crate) fn check<T>(self, count: u64) -> Result<(), Reason> {
        if count > self.items::<T>() {
            return Err(self.refusal());
        }
        Ok(())
    }

    /// Appends, growing as described above; `announced` is the size at which doubling stops, if it
    /// is reached.
    pub(crate) fn push<T>(
        self,
        items: &mut Vec<T>,
        item: T,
        announced: usize,
    ) -> Result<(), Reason> {
        if items.len() == items.capacity() {
            self.grow(items, announced)?;
        }
        items.push(item);
        Ok(())
    }

    #[cold]
    fn grow<T>(self, items: &mut Vec<T>, announced: usize) -> Result<(), Reason> {
        let len = items.len();
        let allowed = usize::try_from(self.items::<T>()).unwrap_or(usize::MAX);
        if len >= allowed {
            return Err(self.refusal());
        }
        let mut capacity = len.saturating_mul(2).max(FIRST).min(allowed);
        if announced > len {
            capacity = capacity.min(announced);
        }
        let Self { what, .. } = self;
        items
            .try_reserve_exact(capacity - len)
            .map_err(|_| Reason::OutOfMemory { what })
    }

    fn items<T>(self) -> u64 {
        self.limit / (size_of::<T>() as u64)
    }

    fn refusal(self) -> Reason {
        let Self { what, limit } = self;
        Reason::TooLarge { what, limit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BYTES: Allowance = Allowance {
        what: "bytes",
        limit: 100_000,
    };

    #[test]
    fn a_claim_reserves_little() {
        let mut items = Vec::new();
        BYTES.push(&mut items, 1_u8, usize::MAX).unwrap();
        assert!(items.capacity() <= FIRST);
    }

    #[test]
    fn a_true_claim_is_met_exactly() {
        let mut items = Vec::new();
        for _ in 0..70_000 {
            BYTES.push(&mut items, 1_u8, 70_000).unwrap();
        }
        assert_eq!(items.capacity(), 70_000);
    }

    #[test]
    fn the_limit_is_reached_and_not_passed() {
        let mut items = Vec::new();
        while BYTES.push(&mut items, 0_u64, 0).is_ok() {}
        assert_eq!((items.len(), items.capacity()), (12_500, 12_500));
        assert!(BYTES.check::<u64>(12_500).is_ok());
        assert!(BYTES.check::<u64>(12_501).is_err());
    }
}
