//! Union-find over vertices.

/// Union-find with path halving; the root of a class is its smallest vertex.
pub(crate) struct Classes(Vec<u32>);

impl Classes {
    pub(crate) fn new(vertices: usize) -> Self {
        Self((0..vertices as u32).collect())
    }

    /// Root of the class of `vertex`, with path halving.
    pub(crate) fn leader(&mut self, mut vertex: u32) -> u32 {
        let Self(parent) = self;
        while parent[vertex as usize] != vertex {
            let above = parent[parent[vertex as usize] as usize];
            parent[vertex as usize] = above;
            vertex = above;
        }
        vertex
    }

    /// Joins the classes of two vertices; the smaller root stays a root.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.leader(a), self.leader(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
