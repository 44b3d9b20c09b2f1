//! Memory account: memory grows with the data that has arrived, up to a limit, never on a claim.
//!
//! A header of 100 bytes may announce 2^60 vertices, so nothing is reserved by count: arrays double
//! as they fill, in amortised O(1) per item. An announced count has two uses. It refuses a frame
//! beyond the limit before it is read, and it caps the last doubling at the right size. A body has
//! one account for positions, triangles, polygons and welding. It counts items, not capacity: the
//! unused rest of a doubled array is never touched, and so takes no memory.

use crate::error::Reason;

/// First reservation of an array, in items.
///
/// Small, so that a file of very many small bodies takes little more than its data.
const FIRST: usize = 1 << 6;

/// Bytes that a body holds, and the most that it may hold.
#[derive(Debug, Clone)]
pub(crate) struct Account {
    held: u64,
    limit: u64,
}

impl Account {
    pub(crate) fn new(limit: u64) -> Self {
        Self { held: 0, limit }
    }

    pub(crate) fn held(&self) -> u64 {
        self.held
    }

    pub(crate) fn limit(&self) -> u64 {
        self.limit
    }

    /// Bytes held once `more` are added; an error beyond the limit.
    pub(crate) fn check(&self, more: u64) -> Result<u64, Excess> {
        let needed = self.held.saturating_add(more);
        let Self { limit, .. } = *self;
        if needed > limit {
            return Err(Excess { needed, limit });
        }
        Ok(needed)
    }

    /// Adds `more` bytes; an error beyond the limit.
    pub(crate) fn enter(&mut self, more: u64) -> Result<(), Excess> {
        self.held = self.check(more)?;
        Ok(())
    }

    /// Adds bytes that [`check`](Self::check) has allowed.
    pub(crate) fn enter_allowed(&mut self, more: u64) {
        self.held = self.held.saturating_add(more);
    }

    /// Subtracts `less` bytes, which are free again.
    pub(crate) fn take_off(&mut self, less: u64) {
        self.held = self.held.saturating_sub(less);
    }

    /// Appends an item and counts its bytes, in amortised O(1).
    ///
    /// `announced`: the number of items at which doubling stops, or 0 if it is not known.
    pub(crate) fn push<T>(
        &mut self,
        items: &mut Vec<T>,
        item: T,
        announced: usize,
    ) -> Result<(), Reason> {
        self.enter(size_of::<T>() as u64)?;
        if items.len() == items.capacity() {
            grow(items, announced)?;
        }
        items.push(item);
        Ok(())
    }
}

/// Grows a full array: doubles it, but not past `announced`.
#[cold]
fn grow<T>(items: &mut Vec<T>, announced: usize) -> Result<(), Reason> {
    let len = items.len();
    let mut capacity = len.saturating_mul(2).max(FIRST);
    if announced > len {
        capacity = capacity.min(announced);
    }
    items
        .try_reserve_exact(capacity - len)
        .map_err(|_| Reason::OutOfMemory)
}

/// Size in bytes of the items of an array.
pub(crate) fn bytes_of<T>(items: &[T]) -> u64 {
    size_of_val(items) as u64
}

/// A request for more bytes than the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Excess {
    pub(crate) needed: u64,
    pub(crate) limit: u64,
}

impl From<Excess> for Reason {
    fn from(Excess { needed, limit }: Excess) -> Self {
        Reason::TooLarge { needed, limit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_reserves_little() {
        let mut items = Vec::new();
        let mut account = Account::new(100_000);
        account.push(&mut items, 1_u8, usize::MAX).unwrap();
        assert!(items.capacity() <= FIRST);
    }

    #[test]
    fn a_true_claim_is_met_exactly() {
        let mut items = Vec::new();
        let mut account = Account::new(100_000);
        for _ in 0..70_000 {
            account.push(&mut items, 1_u8, 70_000).unwrap();
        }
        assert_eq!(items.capacity(), 70_000);
    }

    #[test]
    fn the_limit_is_one_for_all_and_reached() {
        let (mut wide, mut narrow) = (Vec::new(), Vec::new());
        let mut account = Account::new(100_000);
        for _ in 0..10_000 {
            account.push(&mut narrow, 0_u8, 0).unwrap();
        }
        while account.push(&mut wide, 0_u64, 0).is_ok() {}
        assert_eq!(wide.len(), 90_000 / 8);
        account.take_off(bytes_of(&narrow));
        let excess = account.check(10_001).unwrap_err();
        assert_eq!((excess.needed, excess.limit), (100_001, 100_000));
        assert!(account.check(10_000).is_ok());
        assert!(account.check(u64::MAX).is_err());
    }
}
