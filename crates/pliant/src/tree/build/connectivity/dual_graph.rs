//! Dual graph of a mesh: triangles, linked over the edges they share.
//!
//! The triangles around one edge are linked in a ring, in the order of their numbers. Two have one
//! link, more have as many links as triangles. So a triangle has at most six links, and nothing is
//! quadratic. Linked triangles are neighbours, and neighbours are connected by links. So this graph
//! and the mesh have the same connected components.

use super::graph::Graph;

/// Links of all triangles of a mesh, by the caller's numbers, in compressed sparse rows (CSR).
#[derive(Debug)]
pub(super) struct DualGraph {
    /// First link of each triangle, and the end.
    starts: Vec<u32>,
    links: Vec<u32>,
    /// Scratch: the place of each triangle in the current piece.
    places: Vec<u32>,
}

/// Sentinel: a triangle that is not in the current piece.
const ELSEWHERE: u32 = u32::MAX;

impl DualGraph {
    /// Links triangles that share an edge. O(m log m).
    pub(super) fn new(triangles: &[[u32; 3]]) -> Self {
        // Every edge of every triangle, so that the triangles around an edge are a run.
        let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(triangles.len() * 3);
        for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
            let edges = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
            let real = edges.into_iter().filter(|[a, b]| a != b);
            sides.extend(real.map(|edge| (edge, triangle as u32)));
        }
        sides.sort_unstable();
        // A triangle with a repeated vertex has one edge twice.
        sides.dedup();

        // Two passes: links are counted, then written.
        let mut starts = vec![0; triangles.len() + 1];
        for_each_link(&sides, |triangle, _| starts[triangle as usize + 1] += 1);
        for triangle in 0..triangles.len() {
            starts[triangle + 1] += starts[triangle];
        }
        let mut links = vec![0; starts[triangles.len()] as usize];
        let mut ends = starts.clone();
        for_each_link(&sides, |triangle, other| {
            let end = &mut ends[triangle as usize];
            links[*end as usize] = other;
            *end += 1;
        });
        Self {
            starts,
            links,
            places: vec![ELSEWHERE; triangles.len()],
        }
    }

    /// Makes `piece` the subgraph of some triangles: node i is triangle i of the list.
    pub(super) fn extract(&mut self, triangles: &[u32], piece: &mut Graph) {
        for (place, &triangle) in triangles.iter().enumerate() {
            self.places[triangle as usize] = place as u32;
        }
        piece.clear();
        for &triangle in triangles {
            let row = self.starts[triangle as usize]..self.starts[triangle as usize + 1];
            for &other in &self.links[row.start as usize..row.end as usize] {
                let to = self.places[other as usize];
                if to == ELSEWHERE {
                    continue;
                }
                // Triangles may share two edges, and duplicates three.
                match piece.new_links().iter_mut().find(|link| link.to == to) {
                    Some(link) => link.weight += 1,
                    None => piece.push_link(to, 1),
                }
            }
            piece.push_node(1);
        }
        for &triangle in triangles {
            self.places[triangle as usize] = ELSEWHERE;
        }
    }
}

/// Visits both ends of every link, given sides sorted by edge.
fn for_each_link(sides: &[([u32; 2], u32)], mut visit: impl FnMut(u32, u32)) {
    let mut both = |a, b| {
        visit(a, b);
        visit(b, a);
    };
    for ring in sides.chunk_by(|a, b| a.0 == b.0) {
        for neighbours in ring.windows(2) {
            both(neighbours[0].1, neighbours[1].1);
        }
        if let [first, _, .., last] = ring {
            both(first.1, last.1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn neighbours(triangles: &[[u32; 3]]) -> Vec<Vec<(u32, u32)>> {
        let mut piece = Graph::default();
        let all: Vec<u32> = (0..triangles.len() as u32).collect();
        DualGraph::new(triangles).extract(&all, &mut piece);
        all.iter()
            .map(|&triangle| {
                let links = piece.links(triangle).iter();
                let mut row: Vec<_> = links.map(|link| (link.to, link.weight)).collect();
                row.sort_unstable();
                row
            })
            .collect()
    }

    #[test]
    fn an_edge_is_two_different_vertices() {
        // A shared vertex is no edge; nor is a repeated one.
        assert_eq!(neighbours(&[[0, 1, 2], [2, 3, 4]]), [vec![], vec![]]);
        assert_eq!(neighbours(&[[5, 5, 5], [5, 5, 5]]), [vec![], vec![]]);
        // A degenerate triangle has its one edge once.
        let links = neighbours(&[[0, 1, 0], [1, 0, 2]]);
        assert_eq!(links, [vec![(1, 1)], vec![(0, 1)]]);
        // Duplicates share three edges.
        let links = neighbours(&[[0, 1, 2], [2, 0, 1]]);
        assert_eq!(links, [vec![(1, 3)], vec![(0, 3)]]);
    }

    #[test]
    fn many_triangles_around_an_edge_are_a_ring() {
        let fan: Vec<[u32; 3]> = (0..5).map(|i| [0, 1, 2 + i]).collect();
        let links = neighbours(&fan);
        assert_eq!(links[0], [(1, 1), (4, 1)]);
        assert_eq!(links[2], [(1, 1), (3, 1)]);
        assert!(links.iter().all(|row| row.len() == 2));
        assert_eq!(neighbours(&fan[..2]), [vec![(1, 1)], vec![(0, 1)]]);
    }

    #[test]
    fn a_piece_is_numbered_by_itself() {
        let strip: Vec<[u32; 3]> = (0..6).map(|i| [i, i + 1, i + 2]).collect();
        let mut dual = DualGraph::new(&strip);
        let mut piece = Graph::default();
        for _ in 0..2 {
            dual.extract(&[4, 1, 5], &mut piece);
            let to = |node| {
                piece
                    .links(node)
                    .iter()
                    .map(|link| link.to)
                    .collect::<Vec<_>>()
            };
            assert_eq!([0, 1, 2].map(to), [vec![2], vec![], vec![0]]);
            assert_eq!((piece.len(), piece.total()), (3, 3));
        }
    }
}
