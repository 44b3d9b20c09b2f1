//! Memory grows with the data that has arrived, never on a claim, and never beyond a limit.
//!
//! A header may announce 2^60 vertices in a file of 100 bytes. So nothing is reserved by count: arrays double as they fill. Where
//! a count is announced, it is used twice: to refuse a frame beyond the limit before it is read, and to stop the last doubling at
//! the right size.
//!
//! One account for all that a body holds: positions, triangles, polygons, what was welded. It counts what is in the arrays; room
//! that a doubling leaves unused is never touched, and so takes none.

use crate::error::Reason;

/// The first reservation, in items: so few that a file of very many small bodies takes no more than it says.
const FIRST: usize = 1 << 6;

/// What a body holds, in bytes, and the most that it may.
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

    /// What is held and `more`; an error where that is not allowed.
    pub(crate) fn check(&self, more: u64) -> Result<u64, Excess> {
        let needed = self.held.saturating_add(more);
        let Self { limit, .. } = *self;
        if needed > limit {
            return Err(Excess { needed, limit });
        }
        Ok(needed)
    }

    /// Enters `more` bytes.
    pub(crate) fn enter(&mut self, more: u64) -> Result<(), Excess> {
        self.held = self.check(more)?;
        Ok(())
    }

    /// Enters what [`check`](Self::check) has allowed.
    pub(crate) fn enter_allowed(&mut self, more: u64) {
        self.held = self.held.saturating_add(more);
    }

    /// Takes `less` bytes off: they are free again.
    pub(crate) fn take_off(&mut self, less: u64) {
        self.held = self.held.saturating_sub(less);
    }

    /// Appends and enters, growing as described above; `announced` is the size at which doubling stops, if it is reached.
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

/// The bytes of items in an array.
pub(crate) fn bytes_of<T>(items: &[T]) -> u64 {
    size_of_val(items) as u64
}

/// More than the limit.
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
