//! Membership and mask of a body.

/// What a body is a member of, and which members it may meet: a bit each.
#[derive(Clone, Copy)]
pub(crate) struct Filter {
    membership: u32,
    mask: u32,
}

impl Filter {
    /// Meets everything.
    pub(crate) const ALL: Self = Self::new(u32::MAX, u32::MAX);

    pub(crate) const fn new(membership: u32, mask: u32) -> Self {
        Self { membership, mask }
    }

    /// Membership and mask.
    pub(crate) fn bits(self) -> (u32, u32) {
        (self.membership, self.mask)
    }

    /// Whether two bodies with these filters may meet.
    pub(crate) fn lets_meet(self, other: Self) -> bool {
        self.membership & other.mask != 0 && other.membership & self.mask != 0
    }
}
