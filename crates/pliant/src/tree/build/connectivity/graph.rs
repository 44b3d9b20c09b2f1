//! Weighted undirected graph in compressed sparse rows (CSR).

/// End of an edge, in the row of its other end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Link {
    pub(super) to: u32,
    pub(super) weight: u32,
}

/// Weighted graph: a node weighs as many triangles, a link as many mesh edges, as it stands for.
///
/// No node is linked with itself, none twice with another.
#[derive(Debug)]
pub(super) struct Graph {
    weights: Vec<u32>,
    /// First link of each node, and the end.
    starts: Vec<u32>,
    links: Vec<Link>,
    total: u32,
    heaviest: u32,
}

impl Default for Graph {
    fn default() -> Self {
        Self {
            weights: Vec::new(),
            starts: vec![0],
            links: Vec::new(),
            total: 0,
            heaviest: 0,
        }
    }
}

impl Graph {
    /// Removes nodes and links, and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.weights.clear();
        self.starts.truncate(1);
        self.links.clear();
        (self.total, self.heaviest) = (0, 0);
    }

    /// Adds a link to the node that the next [`push_node`](Self::push_node) adds.
    #[inline]
    pub(super) fn push_link(&mut self, to: u32, weight: u32) {
        self.links.push(Link { to, weight });
    }

    /// Returns the links pushed since the last node, so that links to one node can be merged.
    #[inline]
    pub(super) fn new_links(&mut self) -> &mut [Link] {
        let start = self.starts[self.weights.len()] as usize;
        &mut self.links[start..]
    }

    /// Adds a node, with the links pushed since the last one.
    #[inline]
    pub(super) fn push_node(&mut self, weight: u32) {
        self.weights.push(weight);
        self.starts.push(self.links.len() as u32);
        self.total += weight;
        self.heaviest = self.heaviest.max(weight);
    }

    /// Returns how many nodes there are.
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.weights.len()
    }

    /// Returns the links of a node.
    #[inline]
    pub(super) fn links(&self, node: u32) -> &[Link] {
        let node = node as usize;
        let row = self.starts[node] as usize..self.starts[node + 1] as usize;
        #[cfg(test)]
        tests::LINKS_READ.set(tests::LINKS_READ.get() + row.len() as u64);
        &self.links[row]
    }

    /// Returns the weight of a node.
    #[inline]
    pub(super) fn weight(&self, node: u32) -> u32 {
        self.weights[node as usize]
    }

    /// Returns the weight of the heaviest node.
    #[inline]
    pub(super) fn heaviest(&self) -> u32 {
        self.heaviest
    }

    /// Returns the weight of all nodes.
    #[inline]
    pub(super) fn total(&self) -> u32 {
        self.total
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::Graph;
    use std::cell::Cell;

    thread_local! {
        /// Links in all rows that were read: work, counted.
        pub(in super::super) static LINKS_READ: Cell<u64> = const { Cell::new(0) };
    }

    /// Path of nodes.
    pub(in super::super) fn path(nodes: u32) -> Graph {
        star(1, nodes - 1)
    }

    /// Star: arms of `length` nodes each around node 0, arm by arm, from inside out.
    pub(in super::super) fn star(arms: u32, length: u32) -> Graph {
        let mut graph = Graph::default();
        (0..arms).for_each(|arm| graph.push_link(1 + length * arm, 1));
        graph.push_node(1);
        for node in 1..=length * arms {
            let first = node % length == 1 || length == 1;
            graph.push_link(if first { 0 } else { node - 1 }, 1);
            if node % length != 0 {
                graph.push_link(node + 1, 1);
            }
            graph.push_node(1);
        }
        graph
    }

    #[test]
    fn rows_and_sums() {
        let star = star(3, 2);
        let neighbours = |node| star.links(node).iter().map(|link| link.to);
        assert!(neighbours(0).eq([1, 3, 5]));
        assert!(neighbours(3).eq([0, 4]));
        assert!(neighbours(6).eq([5]));
        assert_eq!((star.len(), star.total(), star.heaviest()), (7, 7, 1));
    }
}
