//! Labels of triangles: parts of one body that are not looked for near themselves or each other.
//!
//! Two triangles of one body are left out if their labels are equal or neighbours. A vertex or an
//! edge has the labels of all its triangles. A pair of elements is left out if every pair of their
//! labels is. So a pair of elements stays if it belongs to any pair of triangles that stays.

use crate::held::held;
use crate::ids::{TreeTriangle, TreeVertex};
use crate::labels::Labels;
use crate::mesh::{EMPTY, Elements, Order};

/// Most labels at a vertex that are listed as pairs of neighbours. A vertex with more of them is a
/// hub, and each lists the hub.
const MOST_AT_A_VERTEX: usize = 32;

/// Pairs of a body that its labels leave out, in tree order.
///
/// Labels are known by their rank among all; [`Labels::NONE`] stays as it is.
#[derive(Clone, Debug)]
pub(crate) struct LabelPairs {
    /// Labels of triangles by the caller's numbers.
    callers: Vec<u32>,
    triangles: Vec<u32>,
    /// Neighbours of each label, sorted: ranks, then hubs, numbered behind all ranks.
    neighbours: Rows,
    /// Count of labels.
    labels: u32,
    /// Labels of vertices and of edges, once elements are asked about.
    elements: Option<[Rows; 2]>,
}

impl LabelPairs {
    /// Labels brought into tree order, for a mesh with these triangles, by the caller's numbers.
    ///
    /// O(m log m), and O(k log k) for given neighbours.
    pub(crate) fn new(labels: Labels, triangles: &[[u32; 3]], order: &Order) -> Self {
        let mut names = labels.of_triangles.to_vec();
        names.sort_unstable();
        names.dedup();
        let rank = |label: u32| match names.binary_search(&label) {
            Ok(rank) if label != Labels::NONE => rank as u32,
            _ => Labels::NONE,
        };
        let callers: Vec<u32> = labels.of_triangles.iter().map(|&it| rank(it)).collect();
        let mut hubs = names.len() as u32;
        let mut pairs = Vec::new();
        if let Some(given) = labels.neighbours {
            let ranks = given.iter().map(|pair| pair.map(rank));
            let known = ranks.filter(|pair| !pair.contains(&Labels::NONE));
            pairs.extend(known.flat_map(|[a, b]| [[a, b], [b, a]]));
        } else {
            let mut at = at_vertices(triangles, &callers);
            at.retain(|&[_, label]| label != Labels::NONE);
            for star in at.chunk_by(|a, b| a[0] == b[0]) {
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
        // The number of a triangle that was removed may be none any more.
        let of_number = |&it: &u32| callers.get(it as usize).copied().unwrap_or(Labels::NONE);
        Self {
            triangles: order.triangle_order().iter().map(of_number).collect(),
            callers,
            neighbours: Rows::new(&pairs, names.len()),
            labels: names.len() as u32,
            elements: None,
        }
    }

    /// Finds the labels of vertices and edges, unless they are known. O(m log m).
    pub(crate) fn know_elements(
        &mut self,
        triangles: &[[u32; 3]],
        order: &Order,
        elements: &Elements,
    ) {
        if self.elements.is_some() {
            return;
        }
        let vertices = order.vertex_order();
        let at = Rows::new(&at_vertices(triangles, &self.callers), vertices.len());
        let vertices = Rows::of(vertices.iter().map(|&it| at.get(it as usize)));

        let of_triangle = |(&[a, b, c], &label): (&[u32; 3], &u32)| {
            [[a, b], [b, c], [c, a]].map(|[i, j]| (i.min(j), i.max(j), label))
        };
        let live = triangles.iter().zip(&self.callers);
        let live = live.filter(|(corners, _)| **corners != EMPTY);
        let mut sides: Vec<(u32, u32, u32)> = live.flat_map(of_triangle).collect();
        sides.sort_unstable();
        sides.dedup();
        let labels: Vec<u32> = sides.iter().map(|side| side.2).collect();
        let of_edge = |&number: &u32| {
            let [i, j] = elements.callers()[number as usize];
            let start = sides.partition_point(|side| (side.0, side.1) < (i, j));
            let end = sides.partition_point(|side| (side.0, side.1) <= (i, j));
            &labels[start..end]
        };
        let edges = Rows::of(elements.caller_edges().iter().map(of_edge));
        self.elements = Some([vertices, edges]);
    }

    /// Whether two triangles are left out.
    #[inline]
    pub(crate) fn leave_out(&self, pair: [TreeTriangle; 2]) -> bool {
        let [a, b] = pair.map(|triangle| self.triangles[triangle.index()]);
        self.are_together(a, b)
    }

    /// Whether a vertex and a triangle are left out.
    pub(in crate::queries) fn leave_out_vertex(
        &self,
        vertex: TreeVertex,
        triangle: TreeTriangle,
    ) -> bool {
        let label = self.triangles[triangle.index()];
        let of_vertex = self.elements.iter().map(|[vertices, _]| vertices);
        let mut of_vertex = of_vertex.flat_map(|all| all.get(vertex.index()));
        of_vertex.all(|&other| self.are_together(other, label))
    }

    /// Whether two edges are left out.
    pub(in crate::queries) fn leave_out_edges(&self, pair: [u32; 2]) -> bool {
        let Some([_, edges]) = &self.elements else {
            return false;
        };
        let [a, b] = pair.map(|edge| edges.get(edge as usize));
        a.iter()
            .all(|&a| b.iter().all(|&b| self.are_together(a, b)))
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

/// Pairs (vertex, label) of all triangles that are there, each once, sorted.
fn at_vertices(triangles: &[[u32; 3]], labels: &[u32]) -> Vec<[u32; 2]> {
    let live = triangles.iter().zip(labels);
    let live = live.filter(|(corners, _)| **corners != EMPTY);
    let mut pairs: Vec<[u32; 2]> = live
        .flat_map(|(corners, &label)| corners.map(|vertex| [vertex, label]))
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
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
        let start = |row: usize| pairs.partition_point(|pair| (pair[0] as usize) < row);
        Self {
            starts: (0..=rows).map(start).collect(),
            numbers: pairs.iter().map(|pair| pair[1]).collect(),
        }
    }

    /// Rows as they come.
    fn of<'r>(rows: impl ExactSizeIterator<Item = &'r [u32]>) -> Self {
        let mut starts = Vec::with_capacity(rows.len() + 1);
        let mut numbers = Vec::new();
        starts.push(0);
        for row in rows {
            numbers.extend_from_slice(row);
            starts.push(numbers.len());
        }
        Self { starts, numbers }
    }

    #[inline]
    fn get(&self, row: usize) -> &[u32] {
        &self.numbers[self.starts[row]..self.starts[row + 1]]
    }
}

held!(Rows: starts[], numbers[]);
held!(LabelPairs: callers[], triangles[], neighbours;
    |pairs| crate::held::within(pairs.elements.iter().flatten()));
