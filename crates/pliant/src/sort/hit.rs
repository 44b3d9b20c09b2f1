//! Hits as the sorter sees them: four numbers.

/// Result of a kind of query, with the caller's numbers. Hits are ordered by their numbers, the
/// first the most significant.
pub(crate) trait Numbered {
    /// Numbers of the hit's two things: a body, and the thing's number in it, for each.
    fn numbers(&self) -> [u32; 4];
}

/// Hit that consists of its four numbers alone, so that it can be sorted as a key.
pub(crate) trait Hit: Numbered + Copy + std::fmt::Debug + Send + Sync {
    /// Makes the hit that has these numbers.
    fn of_numbers(numbers: [u32; 4]) -> Self;
}
