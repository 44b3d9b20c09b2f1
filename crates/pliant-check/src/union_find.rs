//! Union-find over numbers, with the smallest number of a set as its root.
//!
//! Each number has a parent in its set; a root is its own parent.

/// Union-find root of `vertex`, with path halving.
pub(crate) fn find(leader: &mut [u32], mut vertex: u32) -> u32 {
    while leader[vertex as usize] != vertex {
        let above = leader[leader[vertex as usize] as usize];
        leader[vertex as usize] = above;
        vertex = above;
    }
    vertex
}

/// Union of the sets of `a` and `b`. The smaller root wins.
pub(crate) fn join(leader: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(leader, a), find(leader, b));
    leader[a.max(b) as usize] = a.min(b);
}
