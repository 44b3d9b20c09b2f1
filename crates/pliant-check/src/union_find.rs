//! Union-find over numbers: the smallest of a set leads it.
//!
//! Each number has one above it in its set, or itself if it leads.

/// The smallest number of the set that one is in; the way to it is halved in passing.
pub(crate) fn find(leader: &mut [u32], mut vertex: u32) -> u32 {
    while leader[vertex as usize] != vertex {
        let above = leader[leader[vertex as usize] as usize];
        leader[vertex as usize] = above;
        vertex = above;
    }
    vertex
}

/// Makes one set of two.
pub(crate) fn join(leader: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(leader, a), find(leader, b));
    leader[a.max(b) as usize] = a.min(b);
}
