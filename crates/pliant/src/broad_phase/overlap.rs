//! Overlap: a pair that a broad phase finds.

use crate::ids::Rank;

/// Two bodies whose boxes overlap, the smaller rank first.
pub(crate) type Overlap = [Rank; 2];
