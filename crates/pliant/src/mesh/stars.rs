//! Stars of a mesh: the triangles at each vertex, and whether they are one fan.
//!
//! Idea: each triangle of a star has an edge opposite the vertex; together these are its *link*. A
//! star is a fan if its link is one path or one cycle, passed in one direction. It is a fact of the
//! mesh, whatever the shape.

use super::TrianglesAt;
use crate::held::held;
use crate::kernels::{CLOSED, StarRecord, TOO_MANY};
use std::ops::Range;

/// The star of every vertex, by the caller's numbers.
#[derive(Clone, Debug)]
pub(crate) struct Stars {
    records: Vec<StarRecord>,
}

/// Triangles, or vertices, between two looks at an interruption.
const UNINTERRUPTED: usize = 1 << 14;
/// Fewest vertices of a run whose links are made together.
const FEWEST: usize = 1 << 14;
/// Most runs, as each goes over all triangles.
const MOST_RUNS: usize = 16;

impl Stars {
    /// Finds the stars of all vertices, a run of vertices at a time, so that little memory is
    /// taken. None if `stop` returned true.
    ///
    /// Cost: O(m + n), and sorting of the triangles at each vertex.
    pub(crate) fn new(
        triangles: &[[u32; 3]],
        vertices: usize,
        stop: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let mut records = vec![0; vertices];
        let (mut ends, mut links, mut scratch) = (Vec::new(), Vec::new(), Vec::new());
        let size = vertices.div_ceil(MOST_RUNS).max(FEWEST);
        for (run, first) in records.chunks_mut(size).zip((0..).step_by(size)) {
            let vertices = first..first + run.len();
            ends.clear();
            ends.resize(run.len() + 1, 0_u32);
            each_corner(triangles, &vertices, stop, |place, _| ends[place + 1] += 1)?;
            for at in 1..ends.len() {
                ends[at] += ends[at - 1];
            }
            links.clear();
            links.resize(ends[run.len()] as usize, [0; 2]);
            // Each link is filled from its beginning, which becomes its end.
            each_corner(triangles, &vertices, stop, |place, corners| {
                links[ends[place] as usize] = opposite(corners, (first + place) as u32);
                ends[place] += 1;
            })?;
            let mut begin = 0;
            for (place, (record, &end)) in run.iter_mut().zip(&ends).enumerate() {
                *record = record_of(&mut links[begin..end as usize], &mut scratch);
                begin = end as usize;
                if place % UNINTERRUPTED == 0 && stop() {
                    return None;
                }
            }
        }
        Some(Self { records })
    }

    /// Sets how many vertices there are.
    pub(crate) fn resize(&mut self, vertices: usize) {
        self.records.resize(vertices, 0);
    }

    /// Finds the stars of some vertices anew.
    pub(crate) fn find(
        &mut self,
        vertices: impl Iterator<Item = u32>,
        triangles: &[[u32; 3]],
        at: &TrianglesAt,
    ) {
        let (mut link, mut ends) = (Vec::new(), Vec::new());
        for vertex in vertices {
            link.clear();
            let here = at.of(vertex).map(|triangle| triangles[triangle as usize]);
            link.extend(here.map(|corners| opposite(corners, vertex)));
            self.records[vertex as usize] = record_of(&mut link, &mut ends);
        }
    }

    /// Star of a vertex.
    #[inline(always)]
    pub(crate) fn of(&self, vertex: u32) -> StarRecord {
        self.records[vertex as usize]
    }
}

/// Shows `each` the corners at some vertices: the place of the vertex among these, and all corners
/// of the triangle. None if `stop` returned true.
fn each_corner(
    triangles: &[[u32; 3]],
    vertices: &Range<usize>,
    stop: &dyn Fn() -> bool,
    mut each: impl FnMut(usize, [u32; 3]),
) -> Option<()> {
    for some in triangles.chunks(UNINTERRUPTED) {
        if stop() {
            return None;
        }
        for &corners in some {
            for vertex in corners {
                let place = (vertex as usize).wrapping_sub(vertices.start);
                if place < vertices.len() {
                    each(place, corners);
                }
            }
        }
    }
    Some(())
}

/// Edge of a triangle opposite a corner, in the direction of the triangle.
pub(crate) fn opposite<V: Copy + PartialEq>([a, b, c]: [V; 3], vertex: V) -> [V; 2] {
    if vertex == a {
        [b, c]
    } else if vertex == b {
        [c, a]
    } else {
        [a, b]
    }
}

/// Record of a star with this link; `ends` is scratch memory. O(d log d) for d triangles.
///
/// Where each vertex begins at most one edge, a walk along edges cannot branch. It begins where no
/// edge ends, if there is such a vertex. If it passes all edges, they are one path or cycle.
fn record_of(link: &mut [[u32; 2]], ends: &mut Vec<u32>) -> StarRecord {
    link.sort_unstable();
    let branches = link.windows(2).any(|two| two[0][0] == two[1][0]);
    // A triangle that has a vertex twice is in no fan.
    if branches || link.iter().any(|[from, to]| from == to) {
        return CLOSED;
    }
    ends.clear();
    ends.extend(link.iter().map(|edge| edge[1]));
    ends.sort_unstable();
    let is_end = |vertex: &u32| ends.binary_search(vertex).is_ok();
    let mut begins = link.iter().map(|edge| edge[0]);
    let Some(begin) = begins
        .find(|from| !is_end(from))
        .or(Some(ends.first()).flatten().copied())
    else {
        return 0;
    };
    let mut at = begin;
    for passed in 1..=link.len() {
        let Ok(place) = link.binary_search_by_key(&at, |edge| edge[0]) else {
            return CLOSED;
        };
        at = link[place][1];
        if at == begin && passed < link.len() {
            return CLOSED;
        }
    }
    let count = link.len().min(TOO_MANY.into()) as StarRecord;
    count + if at == begin { CLOSED } else { 0 }
}

held!(Stars: records[]);

#[cfg(test)]
mod tests {
    use super::*;

    fn star(triangles: &[[u32; 3]]) -> StarRecord {
        let stars = Stars::new(triangles, 10, &|| false).unwrap();
        stars.of(0)
    }

    #[test]
    fn fans_are_told_from_other_stars() {
        assert_eq!(star(&[[1, 2, 3]]), 0);
        assert_eq!(star(&[[1, 0, 2]]), 1);
        assert_eq!(star(&[[0, 3, 4], [2, 3, 0], [1, 2, 0]]), 3);
        assert_eq!(star(&[[0, 3, 1], [2, 3, 0], [1, 2, 0]]), CLOSED + 3);
        // The same triangle from both sides is a closed fan of two.
        assert_eq!(star(&[[0, 1, 2], [0, 2, 1]]), CLOSED + 2);
        for other in [
            // Turned against each other; twice; two fans; three at an edge; a corner twice.
            &[[0, 1, 2], [0, 3, 2]][..],
            &[[0, 1, 2], [0, 1, 2]],
            &[[0, 1, 2], [0, 3, 4]],
            &[[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 4]],
            &[[0, 1, 2], [0, 2, 1], [0, 3, 4], [0, 4, 3]],
            &[[0, 1, 2], [0, 2, 3], [0, 2, 4]],
            &[[0, 1, 3], [0, 2, 3], [0, 3, 4]],
            &[[0, 1, 0], [0, 2, 3]],
            &[[0, 0, 0]],
            &[[0, 1, 1]],
        ] {
            assert_eq!(star(other), CLOSED, "{other:?}");
        }
    }

    #[test]
    fn large_fans_have_no_number() {
        for (count, is_closed) in [(15, false), (15, true), (16, false), (9_000, true)] {
            let next = |i: u32| if is_closed && i == count { 1 } else { i + 1 };
            let triangles: Vec<_> = (1..=count).map(|i| [i, next(i), 0]).collect();
            let stars = Stars::new(&triangles, 9_001 + 1, &|| false).unwrap();
            let expected = count.min(TOO_MANY.into()) as StarRecord;
            assert_eq!(stars.of(0) % CLOSED, expected);
            assert_eq!(stars.of(0) >= CLOSED, is_closed);
        }
        assert!(Stars::new(&[[0, 1, 2]], 3, &|| true).is_none());
    }

    /// More vertices than one run has, by the links of each vertex alone.
    #[test]
    fn runs_of_vertices_have_the_stars_of_single_vertices() {
        let vertices = MOST_RUNS as u32 * FEWEST as u32 + 77;
        let next = |i: u32| (i * 7_919 + 13) % vertices;
        let triangles: Vec<_> = (0..vertices)
            .map(|i| [i, next(i), next(next(i)) / 3])
            .collect();
        let stars = Stars::new(&triangles, vertices as usize, &|| false).unwrap();
        let mut again = stars.clone();
        again.records.fill(CLOSED);
        let at = TrianglesAt::new(&triangles, vertices as usize);
        again.find(0..vertices, &triangles, &at);
        assert_eq!(stars.records, again.records);
    }
}
