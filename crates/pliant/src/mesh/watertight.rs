//! Watertight: whether a mesh is closed, and which of its edges are not.

use super::topology::EMPTY;
use crate::held::held;

/// Edges at which a mesh is not a closed surface, by the caller's vertices, the lower one first.
///
/// From [`World::watertight`](crate::World::watertight). Each list is sorted and has an edge once.
/// An edge is two vertices of the mesh, wherever they are: seams are open until they are
/// [welded](crate::World::weld). A triangle with one vertex twice has the edges that are left, as
/// often as it goes along them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watertight {
    /// Edges in an odd number of triangles: the border of a hole, where that number is 1.
    pub open: Vec<[u32; 2]>,
    /// Edges in an even number of triangles, along which more go in one direction than in the
    /// other: neighbours that are turned against each other.
    pub turned: Vec<[u32; 2]>,
    /// Edges in more than two triangles. A surface is as closed with them as without.
    pub doubled: Vec<[u32; 2]>,
}

impl Watertight {
    /// Whether each edge is in as many triangles in one direction as in the other, so that winding
    /// numbers are defined.
    pub fn is_closed(&self) -> bool {
        self.open.is_empty() && self.turned.is_empty()
    }

    /// Whether each edge is in an even number of triangles, whichever way these are turned.
    pub fn is_even(&self) -> bool {
        self.open.is_empty()
    }

    /// Looks at all edges of triangles, by their vertices. O(m log m).
    pub fn of(triangles: &[[u32; 3]]) -> Self {
        let live = triangles.iter().filter(|&&corners| corners != EMPTY);
        let sides = live.flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut ways: Vec<(u64, i32)> = sides
            .filter(|[from, to]| from != to)
            .map(|[from, to]| {
                let (low, high) = (u64::from(from.min(to)), u64::from(from.max(to)));
                (low << 32 | high, if from < to { 1 } else { -1 })
            })
            .collect();
        ways.sort_unstable_by_key(|&(ends, _)| ends);
        let mut found = Self::default();
        for of_edge in ways.chunk_by(|(one, _), (other, _)| one == other) {
            let (ends, count) = (of_edge[0].0, of_edge.len());
            let edge = [(ends >> 32) as u32, ends as u32];
            let sum: i32 = of_edge.iter().map(|&(_, way)| way).sum();
            if count % 2 == 1 {
                found.open.push(edge);
            } else if sum != 0 {
                found.turned.push(edge);
            }
            if count > 2 {
                found.doubled.push(edge);
            }
        }
        found
    }
}

held!(Watertight: open[], turned[], doubled[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_is_told() {
        let closed = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert_eq!(Watertight::of(&closed), Watertight::default());
        assert!(Watertight::of(&closed).is_closed());
        // One triangle is gone, and then it is back, turned.
        let open = Watertight::of(&[closed[0], EMPTY, closed[2], closed[3]]);
        assert_eq!(open.open, [[0, 1], [0, 3], [1, 3]]);
        assert!(open.turned.is_empty() && !open.is_even());
        let turned = Watertight::of(&[closed[0], [1, 0, 3], closed[2], closed[3]]);
        assert_eq!(turned.turned, [[0, 1], [0, 3], [1, 3]]);
        assert!(turned.is_even() && !turned.is_closed());
        // Two tetrahedra with an edge in common, a fin at it, and triangles that are less.
        let second = [[0, 1, 4], [0, 5, 1], [1, 5, 4], [5, 0, 4]];
        let two = Watertight::of(&[closed, second].concat());
        assert_eq!((two.doubled.clone(), two.is_closed()), (vec![[0, 1]], true));
        let finned =
            Watertight::of(&[&closed[..], &second, &[[1, 0, 6], [6, 6, 7], [8, 8, 8]]].concat());
        assert_eq!(finned.open, [[0, 1], [0, 6], [1, 6]]);
        assert_eq!(finned.doubled, [[0, 1]]);
        assert!(finned.turned.is_empty());
    }
}
