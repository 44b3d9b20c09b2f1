//! Boundary edges of a surface.

/// An edge: its end points, the smaller first.
pub(crate) type Edge = [u32; 2];

/// Boundary edges, ascending: the edges of exactly one triangle. Takes O(n log n) for n triangles.
///
/// A degenerate triangle uses an edge once, however often it runs along it.
pub(crate) fn boundary_edges(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let mut edges: Vec<Edge> = Vec::with_capacity(3 * triangles.len());
    for &[a, b, c] in triangles {
        let mut three = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
        three.sort_unstable();
        let own = three.iter().enumerate();
        edges.extend(
            own.filter(|&(i, edge)| edge[0] != edge[1] && (i == 0 || three[i - 1] != *edge))
                .map(|(_, edge)| *edge),
        );
    }
    edges.sort_unstable();
    let (mut read, mut kept) = (0, 0);
    while let Some(&edge) = edges.get(read) {
        let uses = edges[read..]
            .iter()
            .take_while(|&&other| other == edge)
            .count();
        if uses == 1 {
            edges[kept] = edge;
            kept += 1;
        }
        read += uses;
    }
    edges.truncate(kept);
    edges
}
