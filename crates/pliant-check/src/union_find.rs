//! Union-find over numbers, with the smallest number of a set as its root.
//!
//! Each number has a parent in its set; a root is its own parent.

/// Union-find root of `vertex`, with path halving.
pub(crate) fn find(parents: &mut [u32], mut vertex: u32) -> u32 {
    while parents[vertex as usize] != vertex {
        let grandparent = parents[parents[vertex as usize] as usize];
        parents[vertex as usize] = grandparent;
        vertex = grandparent;
    }
    vertex
}

/// Union of the sets of `a` and `b`. The smaller root wins.
pub(crate) fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parents, a), find(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}
