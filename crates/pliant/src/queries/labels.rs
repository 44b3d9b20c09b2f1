//! Labels of triangles: parts of one body that are not looked for near themselves or each other.
//!
//! Two triangles of one body are left out if their labels are equal or neighbours. A vertex or an
//! edge has the labels of all its triangles. A pair of elements is left out if every pair of their
//! labels is. So a pair of elements stays if it belongs to any pair of triangles that stays.

use crate::held::held;
use crate::ids::{TreeTriangle, TreeVertex};
use crate::labels::Labels;
use crate::mesh::{EMPTY, Order};

/// Most labels at a vertex that are listed as pairs of neighbours. A vertex with more of them is a
/// hub, and each lists the hub.
const MOST_AT_A_VERTEX: usize = 8;

/// Pairs of a body that its labels leave out, by the caller's numbers.
///
/// Labels are known by their rank among all; [`Labels::NONE`] stays as it is.
#[derive(Clone, Debug)]
pub(crate) struct LabelPairs {
    triangles: Vec<u32>,
    /// Labels at each vertex.
    vertices: Rows,
    /// Edges between vertices of several labels, and their labels: lower end, higher end, label.
    /// Sorted.
    border: Vec<[u32; 3]>,
    /// Neighbours of each label, sorted: ranks, then hubs, numbered behind all ranks.
    neighbours: Rows,
    /// Count of labels.
    labels: u32,
}

impl LabelPairs {
    /// Pairs that labels leave out of a mesh with these triangles. `vertices` is their count.
    ///
    /// O(n + m log m), and O(k log k) for given neighbours.
    pub(crate) fn new(labels: Labels, triangles: &[[u32; 3]], vertices: usize) -> Self {
        let mut names = labels.of_triangles.to_vec();
        names.sort_unstable();
        names.dedup();
        let rank = |label: u32| match names.binary_search(&label) {
            Ok(rank) if label != Labels::NONE => rank as u32,
            _ => Labels::NONE,
        };
        let of_triangles: Vec<u32> = labels.of_triangles.iter().map(|&it| rank(it)).collect();
        let live = triangles.iter().zip(&of_triangles);
        let live = live.filter(|(corners, _)| **corners != EMPTY);
        let mut at: Vec<[u32; 2]> = Vec::with_capacity(3 * triangles.len());
        for (corners, &label) in live.clone() {
            at.extend(corners.map(|vertex| [vertex, label]));
        }
        at.sort_unstable();
        at.dedup();
        let at_vertices = Rows::new(&at, vertices);
        let has_several = |vertex: u32| at_vertices.get(vertex as usize).len() > 1;
        let mut border: Vec<[u32; 3]> = Vec::new();
        for (&[a, b, c], &label) in live {
            for [i, j] in [[a, b], [b, c], [c, a]] {
                if has_several(i) && has_several(j) {
                    border.push([i.min(j), i.max(j), label]);
                }
            }
        }
        border.sort_unstable();
        border.dedup();

        let mut hubs = names.len() as u32;
        let mut pairs = Vec::new();
        if let Some(given) = labels.neighbours {
            let ranks = given.iter().map(|pair| pair.map(rank));
            let known = ranks.filter(|pair| !pair.contains(&Labels::NONE));
            pairs.extend(known.flat_map(|[a, b]| [[a, b], [b, a]]));
        } else {
            at.retain(|&[_, label]| label != Labels::NONE);
            let stars = at.chunk_by(|a, b| a[0] == b[0]);
            let few = stars.clone().filter(|star| star.len() <= MOST_AT_A_VERTEX);
            pairs.reserve_exact(few.map(|star| star.len() * (star.len() - 1)).sum());
            for star in stars {
                if star.len() > MOST_AT_A_VERTEX {
                    pairs.extend(star.iter().map(|&[_, label]| [label, hubs]));
                    hubs += 1;
                    continue;
                }
                for &[_, a] in star {
                    let others = star.iter().filter(|it| it[1] != a);
                    pairs.extend(others.map(|&[_, b]| [a, b]));
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Self {
            triangles: of_triangles,
            vertices: at_vertices,
            border,
            neighbours: Rows::new(&pairs, names.len()),
            labels: names.len() as u32,
        }
    }

    /// Whether two triangles are left out. The order is the body's.
    #[inline]
    pub(crate) fn leave_out(&self, order: &Order, pair: [TreeTriangle; 2]) -> bool {
        let [a, b] = pair.map(|triangle| self.of_triangle(order, triangle));
        self.are_together(a, b)
    }

    /// Whether a vertex and a triangle are left out.
    pub(in crate::queries) fn leave_out_vertex(
        &self,
        order: &Order,
        vertex: TreeVertex,
        triangle: TreeTriangle,
    ) -> bool {
        let label = self.of_triangle(order, triangle);
        let of_vertex = self.vertices.get(order.caller_vertex(vertex).index());
        of_vertex
            .iter()
            .all(|&other| self.are_together(other, label))
    }

    /// Whether two edges are left out, by their ends, the lower first.
    pub(in crate::queries) fn leave_out_edges(&self, [a, b]: [[u32; 2]; 2]) -> bool {
        self.of_edge(a)
            .all(|a| self.of_edge(b).all(|b| self.are_together(a, b)))
    }

    fn of_triangle(&self, order: &Order, triangle: TreeTriangle) -> u32 {
        self.triangles[order.caller_triangle(triangle).index()]
    }

    /// Labels of an edge. All triangles of an edge are at each end: one label there is the edge's.
    fn of_edge(&self, ends: [u32; 2]) -> impl Iterator<Item = u32> {
        let at = ends.map(|end| self.vertices.get(end as usize));
        let one = at.into_iter().find_map(|labels| match labels {
            &[label] => Some(label),
            _ => None,
        });
        let of_border = if one.is_some() {
            &[]
        } else {
            let start = self.border.partition_point(|side| side[..2] < ends[..]);
            let end = self.border.partition_point(|side| side[..2] <= ends[..]);
            &self.border[start..end]
        };
        one.into_iter().chain(of_border.iter().map(|side| side[2]))
    }

    /// Whether two labels are equal or neighbours.
    fn are_together(&self, a: u32, b: u32) -> bool {
        if a == Labels::NONE || b == Labels::NONE {
            return false;
        }
        if a == b {
            return true;
        }
        let [of_a, of_b] = [a, b].map(|label| self.neighbours.get(label as usize));
        of_a.binary_search(&b).is_ok() || {
            let [hubs_a, hubs_b] =
                [of_a, of_b].map(|of| &of[of.partition_point(|&it| it < self.labels)..]);
            hubs_a.iter().any(|hub| hubs_b.binary_search(hub).is_ok())
        }
    }
}

/// Rows of numbers, one after the other.
#[derive(Clone, Debug)]
struct Rows {
    /// Where each row begins, and the end of the last.
    starts: Vec<usize>,
    numbers: Vec<u32>,
}

impl Rows {
    /// Rows of sorted pairs (row, number).
    fn new(pairs: &[[u32; 2]], rows: usize) -> Self {
        let mut starts = vec![0; rows + 1];
        for &[row, _] in pairs {
            starts[row as usize + 1] += 1;
        }
        for row in 0..rows {
            starts[row + 1] += starts[row];
        }
        let numbers = pairs.iter().map(|pair| pair[1]).collect();
        Self { starts, numbers }
    }

    #[inline]
    fn get(&self, row: usize) -> &[u32] {
        &self.numbers[self.starts[row]..self.starts[row + 1]]
    }
}

held!(Rows: starts[], numbers[]);
held!(LabelPairs: triangles[], vertices, border[], neighbours);
