//! Which triangles hang together: those that share a vertex, and those that these share one with, and so on.

use super::topology::EMPTY;

/// The component of an empty number.
const NO_COMPONENT: u32 = u32::MAX;

/// For each triangle its component; numbered in the order of their first triangles. How many there are. Cost: O(m + n), about.
pub(crate) fn components(triangles: &[[u32; 3]], vertices: usize) -> (Vec<u32>, usize) {
    // Of each vertex another of its component, of one of them itself.
    let mut next: Vec<u32> = (0..vertices as u32).collect();
    for &[a, b, c] in triangles.iter().filter(|&&corners| corners != EMPTY) {
        let first = leader(&mut next, a);
        for other in [b, c] {
            let other = leader(&mut next, other);
            next[other as usize] = first;
        }
    }
    let mut of_leader = vec![NO_COMPONENT; vertices];
    let mut count = 0;
    let of_triangle = |&corners: &[u32; 3]| {
        if corners == EMPTY {
            return NO_COMPONENT;
        }
        let of_leader = &mut of_leader[leader(&mut next, corners[0]) as usize];
        if *of_leader == NO_COMPONENT {
            *of_leader = count;
            count += 1;
        }
        *of_leader
    };
    let of_triangles = triangles.iter().map(of_triangle).collect();
    (of_triangles, count as usize)
}

/// What stands for all things that one is joined with, of things each of which has another that it is joined with, or itself. The way to
/// it is halved in passing.
pub(crate) fn leader(next: &mut [u32], mut thing: u32) -> u32 {
    while next[thing as usize] != thing {
        let nearer = next[next[thing as usize] as usize];
        next[thing as usize] = nearer;
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
