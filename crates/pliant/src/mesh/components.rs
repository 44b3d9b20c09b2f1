//! Which triangles hang together: those that share a vertex, and those that these share one with, and so on.

use super::topology::EMPTY;

/// The component of an empty number.
pub(crate) const NO_COMPONENT: u32 = u32::MAX;

/// For each triangle its component; numbered in the order of their first triangles. How many there are. Cost: O(m + n), about.
pub(crate) fn components(triangles: &[[u32; 3]], vertices: usize) -> (Vec<u32>, usize) {
    // Of each vertex another of its component, of one of them itself.
    let mut next: Vec<u32> = (0..vertices as u32).collect();
    for &[a, b, c] in triangles.iter().filter(|&&corners| corners != EMPTY) {
        let root = root(&mut next, a);
        for other in [b, c] {
            let other = self::root(&mut next, other);
            next[other as usize] = root;
        }
    }
    let mut of_root = vec![NO_COMPONENT; vertices];
    let mut count = 0;
    let of_triangle = |&corners: &[u32; 3]| {
        if corners == EMPTY {
            return NO_COMPONENT;
        }
        let of_root = &mut of_root[root(&mut next, corners[0]) as usize];
        if *of_root == NO_COMPONENT {
            *of_root = count;
            count += 1;
        }
        *of_root
    };
    let of_triangles = triangles.iter().map(of_triangle).collect();
    (of_triangles, count as usize)
}

/// The vertex that stands for a component. The way to it is halved in passing.
fn root(next: &mut [u32], mut vertex: u32) -> u32 {
    while next[vertex as usize] != vertex {
        let other = next[next[vertex as usize] as usize];
        next[vertex as usize] = other;
        vertex = other;
    }
    vertex
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
