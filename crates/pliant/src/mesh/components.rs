//! Connected components of a mesh over shared vertices, by union-find (disjoint sets).

use super::topology::EMPTY;

/// Component of an empty triangle number: a sentinel.
const NO_COMPONENT: u32 = u32::MAX;

/// Labels each triangle with its connected component; returns the labels and how many there are.
///
/// Triangles that share a vertex are connected. Components are numbered in the order of their first
/// triangles. Cost: about O(m + n) for m triangles and n vertices.
pub(crate) fn components(triangles: &[[u32; 3]], vertices: usize) -> (Vec<u32>, usize) {
    // Union-find: the parent of each vertex; a root is its own parent.
    let mut parents: Vec<u32> = (0..vertices as u32).collect();
    for &[a, b, c] in triangles.iter().filter(|&&corners| corners != EMPTY) {
        let first = find_root(&mut parents, a);
        for other in [b, c] {
            let other = find_root(&mut parents, other);
            parents[other as usize] = first;
        }
    }
    let mut of_root = vec![NO_COMPONENT; vertices];
    let mut count = 0;
    let of_triangle = |&corners: &[u32; 3]| {
        if corners == EMPTY {
            return NO_COMPONENT;
        }
        let of_root = &mut of_root[find_root(&mut parents, corners[0]) as usize];
        if *of_root == NO_COMPONENT {
            *of_root = count;
            count += 1;
        }
        *of_root
    };
    let of_triangles = triangles.iter().map(of_triangle).collect();
    (of_triangles, count as usize)
}

/// Union-find root of `thing`, with path halving.
///
/// `parents` holds the parent of each thing; a root is its own parent. To unite two sets, one root
/// becomes the parent of the other.
pub(crate) fn find_root(parents: &mut [u32], mut thing: u32) -> u32 {
    while parents[thing as usize] != thing {
        let nearer = parents[parents[thing as usize] as usize];
        parents[thing as usize] = nearer;
        thing = nearer;
    }
    thing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_shares_a_vertex_hangs_together() {
        let triangles = [
            [5, 6, 7],
            [0, 1, 2],
            EMPTY,
            [2, 3, 4],
            [8, 8, 8],
            [7, 9, 10],
            [10, 0, 11],
        ];
        let (found, count) = components(&triangles, 13);
        assert_eq!(found, [0, 0, NO_COMPONENT, 0, 1, 0, 0]);
        assert_eq!(count, 2);
        let (found, count) = components(&triangles[..5], 13);
        assert_eq!(found, [0, 1, NO_COMPONENT, 1, 2]);
        assert_eq!(count, 3);
    }
}
