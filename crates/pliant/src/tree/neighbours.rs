//! Which triangles of a body share a vertex, block by block: for a body that meets itself.
//!
//! Triangles that share a vertex always touch, and are no answer. The mesh never changes, so for every two blocks that hold such
//! triangles they are known beforehand, as a mask in the order of [`overlap_mask`](crate::kernels::overlap_mask). On a surface a
//! block of eight triangles has about ten neighbours; half of them come later, and fill one row.
//!
//! Where a mesh is no surface (a hundred thousand triangles round one vertex) masks would take memory by the square. Blocks
//! with that many neighbours are *crowded*: they have no masks, and the corners are compared when their triangles meet.

use super::{LEAF_LANES, Leaves};
use crate::kernels::find_lane;
use crate::mesh::Mesh;
use fearless_simd::Simd;

/// A block with more later neighbours is crowded.
const MOST_NEIGHBOURS: usize = 32;
/// So is one with a vertex of more triangles.
const MOST_TRIANGLES: usize = 256;

/// Blocks and, for each, the pairs of triangles that share a vertex.
#[derive(Clone, Debug)]
struct Row {
    blocks: [u32; 8],
    masks: [u64; 8],
}

impl Row {
    const EMPTY: Self = Self {
        blocks: [u32::MAX; 8],
        masks: [0; 8],
    };
}

/// The neighbours of all blocks of a tree.
#[derive(Debug)]
pub(crate) struct Neighbours {
    /// For each block, the pairs within it that share a vertex; every triangle does with itself.
    within: Vec<u64>,
    /// The rows of later blocks; `None` for a crowded block.
    of_block: Vec<Option<[u32; 2]>>,
    rows: Vec<Row>,
}

impl Neighbours {
    /// Cost: linear in the triangles, whatever the mesh.
    pub(crate) fn new(leaves: &Leaves, mesh: &Mesh) -> Self {
        let firsts = leaves.firsts();
        let triangles = TrianglesOfVertices::new(mesh);
        let mut block_of = vec![0; mesh.corners().len()];
        for leaf in 0..leaves.len() as u32 {
            let triangles = leaves.triangles(leaf);
            for (block, first) in leaves
                .blocks_of(leaf)
                .zip(triangles.clone().step_by(LEAF_LANES))
            {
                let end = triangles.end.min(first + LEAF_LANES as u32);
                block_of[first as usize..end as usize].fill(block);
            }
        }
        let mut all = Self {
            within: vec![0; firsts.len()],
            of_block: vec![None; firsts.len()],
            // On a surface one row a block, and for some a second; to double would take memory thrice.
            rows: Vec::with_capacity(firsts.len() + firsts.len() / 8),
        };
        // Block by block, as triangles come: in the order of their triangles, which is not always that of their numbers.
        let mut later: Vec<(u32, u64)> = Vec::new();
        let mut first = 0;
        while first < block_of.len() {
            let block = block_of[first];
            let end = (first..block_of.len())
                .find(|&triangle| block_of[triangle] != block)
                .unwrap_or(block_of.len());
            later.clear();
            let mut crowded = false;
            for triangle in first..end {
                for &vertex in &mesh.corners()[triangle] {
                    let of_vertex = triangles.get(vertex);
                    crowded |= of_vertex.len() > MOST_TRIANGLES;
                    if crowded {
                        break;
                    }
                    for &other in of_vertex {
                        let other_block = block_of[other as usize];
                        let bit = 1
                            << (8 * (triangle - first) as u32 + other
                                - firsts[other_block as usize]);
                        if other_block == block {
                            all.within[block as usize] |= bit;
                        } else if other_block > block {
                            match later.iter_mut().find(|(known, _)| *known == other_block) {
                                Some((_, mask)) => *mask |= bit,
                                None => later.push((other_block, bit)),
                            }
                        }
                    }
                }
            }
            if !crowded && later.len() <= MOST_NEIGHBOURS {
                let start = all.rows.len() as u32;
                for some in later.chunks(8) {
                    let mut row = Row::EMPTY;
                    for (lane, &(block, mask)) in some.iter().enumerate() {
                        (row.blocks[lane], row.masks[lane]) = (block, mask);
                    }
                    all.rows.push(row);
                }
                all.of_block[block as usize] = Some([start, all.rows.len() as u32]);
            }
            first = end;
        }
        all.rows.shrink_to_fit();
        all
    }

    /// Bit 8 i + j is set if triangle i of block `a` and triangle j of block `b` share a vertex; `None` if that is not known.
    #[inline(always)]
    pub(crate) fn shared<I: Simd>(&self, i: I, a: u32, b: u32) -> Option<u64> {
        let [start, end] = self.of_block[a as usize]?;
        if a >= b {
            return (a == b).then(|| self.within[a as usize]);
        }
        let mut shared = 0;
        for row in &self.rows[start as usize..end as usize] {
            let found = find_lane(i, &row.blocks, b);
            let known = row.masks[found.trailing_zeros() as usize % 8];
            shared |= if found == 0 { 0 } else { known };
        }
        Some(shared)
    }
}

/// The triangles of every vertex, one after the other.
struct TrianglesOfVertices {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl TrianglesOfVertices {
    fn new(mesh: &Mesh) -> Self {
        let mut starts = vec![0; mesh.used_vertices() + 1];
        for &vertex in mesh.corners().as_flattened() {
            starts[vertex as usize + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Each start is that of the next vertex at first, and comes down to its own.
        starts.rotate_left(1);
        let mut triangles = vec![0; 3 * mesh.corners().len()];
        for (triangle, corners) in mesh.corners().iter().enumerate().rev() {
            for &vertex in corners {
                let place = &mut starts[vertex as usize];
                *place -= 1;
                triangles[*place as usize] = triangle as u32;
            }
        }
        let last = starts.len() - 1;
        starts[last] = triangles.len() as u32;
        Self { starts, triangles }
    }

    fn get(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.triangles[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    /// Every two blocks against a comparison of all their corners. Returns the number of crowded blocks.
    fn check(triangles: &[[u32; 3]], vertices: usize, leaf_sizes: &[u32]) -> usize {
        let order = (0..triangles.len() as u32).collect();
        let mesh = Mesh::in_order(triangles, vertices, order);
        let mut leaves = Leaves::new(16);
        let mut start = 0;
        for &size in leaf_sizes.iter().cycle() {
            let end = (start + size).min(triangles.len() as u32);
            leaves.push(start..end);
            start = end;
            if start == triangles.len() as u32 {
                break;
            }
        }
        let neighbours = Neighbours::new(&leaves, &mesh);
        let ends = |block: usize| {
            let next = leaves.firsts().get(block + 1);
            next.map_or(triangles.len() as u32, |&first| first)
        };
        let mut unknown = 0;
        for (a, &first_a) in leaves.firsts().iter().enumerate() {
            for (b, &first_b) in leaves.firsts().iter().enumerate() {
                let mut expected = 0;
                for i in first_a..ends(a) {
                    for j in first_b..ends(b) {
                        let share = mesh.share_a_vertex(i, j);
                        expected |= u64::from(share) << (8 * (i - first_a) + j - first_b);
                    }
                }
                let (a, b) = (a as u32, b as u32);
                let shared = dispatch!(Level::new(), i => neighbours.shared(i, a, b));
                match shared {
                    Some(shared) => assert_eq!(shared, expected, "{a} {b}"),
                    None => unknown += usize::from(a == b),
                }
                assert!(a <= b || shared.is_none());
            }
        }
        unknown
    }

    #[test]
    fn masks_are_what_comparing_all_corners_gives() {
        // A grid, whose blocks have few neighbours.
        let grid = |width: u32| -> Vec<[u32; 3]> {
            let cells = (0..width).flat_map(|y| (0..width).map(move |x| y * (width + 1) + x));
            cells
                .flat_map(|v| [[v, v + 1, v + width + 2], [v, v + width + 2, v + width + 1]])
                .collect()
        };
        for leaf_sizes in [&[8][..], &[5, 8, 1], &[16, 3]] {
            assert_eq!(check(&grid(20), 21 * 21, leaf_sizes), 0);
        }
        // Strangers, the same triangle again and again, triangles that are points.
        assert_eq!(check(&[[0, 1, 2]; 40], 3, &[8]), 0);
        assert_eq!(check(&[[4, 4, 4]; 20], 9, &[8]), 0);
        let strangers: Vec<[u32; 3]> = (0..50).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        assert_eq!(check(&strangers, 150, &[8]), 0);
    }

    #[test]
    fn crowded_blocks_are_left_to_comparing_corners() {
        // A fan: too many triangles round one vertex.
        let fan: Vec<[u32; 3]> = (0..600).map(|t| [0, t + 1, t + 2]).collect();
        assert_eq!(check(&fan, 602, &[8]), 75);
        // Each vertex in few triangles, each block with many neighbours.
        let mut random = pliant_oracle::Random::new(9);
        let tangle: Vec<[u32; 3]> = (0..2_000)
            .map(|_| [0; 3].map(|_: u32| random.below(1_009)))
            .collect();
        let crowded = check(&tangle, 1_009, &[8]);
        assert!((100..250).contains(&crowded), "{crowded} of 250");
    }
}
