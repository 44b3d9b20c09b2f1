//! Which vertices become one when boundary edges that coincide are welded.
//!
//! A boundary edge is an edge of exactly one triangle. Two of them coincide if their ends do, one by one. Single vertices that coincide are
//! not welded: two sheets that touch in a point are two sheets. And never are two corners of one triangle, however short its edges are:
//! no triangle is lost.

use super::topology::EMPTY;
use std::collections::{BTreeMap, HashMap};

/// Pairs of a vertex that stays and one that becomes the same: the lowest of all that become one stays. Sorted by the second.
///
/// Two vertices coincide if they are at most a tolerance apart, as double precision has it. Cost: O(m log m), and for every vertex of the
/// boundary those within some tolerances.
pub(crate) fn coinciding(
    triangles: &[[u32; 3]],
    position: impl Fn(u32) -> [f64; 3],
    tolerance: f64,
) -> Vec<[u32; 2]> {
    let edges = boundary_edges(triangles);
    let mut others: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &[a, b] in &edges {
        others.entry(a).or_default().push(b);
        others.entry(b).or_default().push(a);
    }
    let vertices: Vec<(u32, [f64; 3])> = others.keys().map(|&it| (it, position(it))).collect();
    let grid = Grid::new(&vertices, tolerance);
    let are_near = |a: [f64; 3], b: [f64; 3]| {
        let apart: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        apart.sqrt() <= tolerance
    };
    let mut classes = Classes::new(triangles, &others);
    for &[a, b] in &edges {
        let [at_a, at_b] = [a, b].map(&position);
        for x in grid.around(at_a) {
            if !are_near(at_a, position(x)) {
                continue;
            }
            for &y in &others[&x] {
                let is_same = [x.min(y), x.max(y)] == [a, b];
                if !is_same && are_near(at_b, position(y)) {
                    classes.join([[a, x], [b, y]]);
                }
            }
        }
    }
    classes.pairs()
}

/// The edges that exactly one triangle has, the smaller end first, sorted. A degenerate triangle has an edge once, however often it runs
/// along it.
fn boundary_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for &[a, b, c] in triangles.iter().filter(|&&corners| corners != EMPTY) {
        let mut three = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
        three.sort_unstable();
        let mut last = None;
        for edge in three {
            if edge[0] != edge[1] && last != Some(edge) {
                edges.push(edge);
            }
            last = Some(edge);
        }
    }
    edges.sort_unstable();
    let alone = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
    alone.map(|same| same[0]).collect()
}

/// Vertices by the cells of a grid, whose sides are longer than two tolerances: what coincides is in cells beside each other.
struct Grid {
    lower: [f64; 3],
    side: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
}

/// No more cells than this on an axis, so that numbers of cells are exact.
const CELLS: f64 = (1_u64 << 30) as f64;

impl Grid {
    fn new(vertices: &[(u32, [f64; 3])], tolerance: f64) -> Self {
        let mut lower = [f64::INFINITY; 3];
        let mut upper = [f64::NEG_INFINITY; 3];
        for (_, at) in vertices {
            for axis in 0..3 {
                lower[axis] = lower[axis].min(at[axis]);
                upper[axis] = upper[axis].max(at[axis]);
            }
        }
        let extent = (0..3).fold(0.0, |most: f64, axis| most.max(upper[axis] - lower[axis]));
        let least = (extent / CELLS).max(f64::MIN_POSITIVE);
        let mut grid = Self {
            lower,
            side: (2.0 * tolerance).max(least),
            cells: HashMap::new(),
        };
        for &(vertex, at) in vertices {
            let cell = grid.cell(at);
            grid.cells.entry(cell).or_default().push(vertex);
        }
        grid
    }

    fn cell(&self, at: [f64; 3]) -> [i64; 3] {
        std::array::from_fn(|axis| ((at[axis] - self.lower[axis]) / self.side).floor() as i64)
    }

    /// The vertices in the cell of a place, and in those beside it.
    fn around(&self, at: [f64; 3]) -> impl Iterator<Item = u32> {
        let [i, j, k] = self.cell(at);
        let beside = |at: i64| at - 1..=at + 1;
        let cells = beside(i)
            .flat_map(move |i| beside(j).flat_map(move |j| beside(k).map(move |k| [i, j, k])));
        let of_cell = |cell| self.cells.get(&cell).into_iter().flatten();
        cells.flat_map(of_cell).copied()
    }
}

/// Vertices that become one, and the triangles at them.
struct Classes<'t> {
    triangles: &'t [[u32; 3]],
    /// For each vertex of the boundary the lowest one of those that become one with it.
    leaders: BTreeMap<u32, u32>,
    /// By the lowest: the vertices, and their triangles.
    members: BTreeMap<u32, (Vec<u32>, Vec<u32>)>,
}

impl<'t> Classes<'t> {
    fn new(triangles: &'t [[u32; 3]], boundary: &BTreeMap<u32, Vec<u32>>) -> Self {
        let mut members: BTreeMap<u32, (Vec<u32>, Vec<u32>)> = BTreeMap::new();
        for &vertex in boundary.keys() {
            members.insert(vertex, (vec![vertex], Vec::new()));
        }
        for (triangle, corners) in (0..).zip(triangles) {
            for vertex in corners {
                if let Some((_, of_vertex)) = members.get_mut(vertex) {
                    of_vertex.push(triangle);
                }
            }
        }
        Self {
            triangles,
            leaders: boundary.keys().map(|&vertex| (vertex, vertex)).collect(),
            members,
        }
    }

    fn leader(&self, vertex: u32) -> u32 {
        self.leaders.get(&vertex).copied().unwrap_or(vertex)
    }

    /// Makes the two vertices of each pair one; but none, if a triangle would lose a corner.
    fn join(&mut self, pairs: [[u32; 2]; 2]) {
        if pairs.iter().any(|&pair| self.share_a_triangle(pair)) {
            return;
        }
        for pair in pairs {
            let [a, b] = pair.map(|vertex| self.leader(vertex));
            if a == b {
                continue;
            }
            let (vertices, triangles) = self.members.remove(&a.max(b)).unwrap_or_default();
            for &vertex in &vertices {
                self.leaders.insert(vertex, a.min(b));
            }
            let kept = self.members.entry(a.min(b)).or_default();
            kept.0.extend(vertices);
            kept.1.extend(triangles);
        }
    }

    /// Whether a triangle has corners among those that are one with either of two vertices, which are not one.
    fn share_a_triangle(&self, pair: [u32; 2]) -> bool {
        let [a, b] = pair.map(|vertex| self.leader(vertex));
        let triangles = self.members.get(&a).map_or(&[][..], |(_, all)| all);
        let has_b = |&triangle: &u32| {
            let corners = self.triangles[triangle as usize];
            corners.iter().any(|&corner| self.leader(corner) == b)
        };
        a != b && triangles.iter().any(has_b)
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let pairs = self.leaders.iter().map(|(&gone, &kept)| [kept, gone]);
        pairs.filter(|[kept, gone]| kept != gone).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of two squares, the second of which has vertices of its own where they meet.
    const APART: [[u32; 3]; 4] = [[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]];

    fn strip(off: f64) -> [[f64; 3]; 8] {
        let at = |x: f64, y: f64| [x, y, 0.0];
        [
            at(0.0, 0.0),
            at(0.0, 1.0),
            at(1.0, 0.0),
            at(1.0, 1.0),
            at(1.0 + off, 0.0),
            at(1.0 + off, 1.0),
            at(2.0, 0.0),
            at(2.0, 1.0),
        ]
    }

    #[test]
    fn edges_that_coincide_are_welded_up_to_the_tolerance() {
        let welded = |off: f64, tolerance: f64| {
            let strip = strip(off);
            coinciding(&APART, |vertex| strip[vertex as usize], tolerance)
        };
        assert_eq!(welded(0.0, 0.0), [[2, 4], [3, 5]]);
        assert_eq!(welded(0.25, 0.25), [[2, 4], [3, 5]]);
        assert!(welded(0.25, 0.25_f64.next_down()).is_empty());
        assert!(welded(f64::EPSILON, 0.0).is_empty());
    }

    #[test]
    fn vertices_alone_are_not_welded_and_no_triangle_is_lost() {
        // They meet in a point.
        let fan = [[0, 1, 2], [3, 4, 5]];
        let at = |vertex: u32| [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][vertex as usize % 3];
        let apart = |vertex: u32| at(vertex).map(|x| if vertex < 3 { x } else { -x });
        assert!(coinciding(&fan, apart, 0.1).is_empty());
        // With a tolerance as large as all there is, triangles keep three corners.
        for tolerance in [0.0, 1.0, 10.0] {
            let pairs = coinciding(&fan, at, tolerance);
            let renamed = |vertex: u32| {
                let pair = pairs.iter().find(|pair| pair[1] == vertex);
                pair.map_or(vertex, |pair| pair[0])
            };
            for [a, b, c] in fan.map(|corners| corners.map(renamed)) {
                assert!(a != b && b != c && c != a, "{tolerance}");
            }
            assert_eq!(pairs.len(), 3);
        }
    }
}
