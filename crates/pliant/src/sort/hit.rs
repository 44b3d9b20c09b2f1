//! Hits, as they are sorted: by their numbers.

/// What a kind of query finds, as the caller numbers things. Hits are ordered by their numbers, the first the most significant.
pub(crate) trait Numbered {
    /// Which things it is about: of two, a body and a number each.
    fn numbers(&self) -> [u32; 4];
}

/// A hit that is no more than its numbers.
pub(crate) trait Hit: Numbered + Copy + std::fmt::Debug + Send + Sync {
    /// The hit that has these numbers.
    fn of_numbers(numbers: [u32; 4]) -> Self;
}
