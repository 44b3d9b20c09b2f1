//! Welding: vertices that a file split along a seam become one again.
//!
//! Files split a vertex for each of its texture coordinates or normals. A closed surface arrives
//! cut open, and the two sides of each seam would intersect. A seam is told from a contact by whole
//! *boundary edges* (edges of exactly one triangle) that coincide. Single points never weld: two
//! bodies that touch in a point are two bodies.
//!
//! ```text
//! edges of exactly one triangle, as pairs of places   a place: the vertices at one position
//! for each run of edges between the same two places:
//!     join their ends, place by place             union-find, the smallest vertex leads
//! rewrite the triangles to the leading vertices       positions stay, each side keeps its own
//! ```
//!
//! - An edge whose two ends are at one place is a point in this sense.
//! - Every frame has its own seams, as if it were alone. They depend only on which ends of boundary
//!   edges are at one place; a later frame is searched only if this has changed ([`Seams::hold`]).
//! - Where a format moves vertices by a rule, the rule decides for all frames alike. All triangles
//!   use the leading vertex, so rounding that parts the others is never seen.

use crate::boundary::{Edge, boundary_edges};
use crate::classes::Classes;
use crate::memory::bytes_of;
use crate::near::{self, NearSeams};
use crate::positions::Positions;

/// Seams of one frame.
#[derive(Debug, Default)]
pub(crate) struct Seams {
    /// Welded triangles; None where nothing is welded.
    pub(crate) welding: Option<Welding>,
    /// Boundary edges left after welding, by the leading vertices of their ends, ascending.
    ///
    /// None where there are more than [`MOST_OPEN`].
    pub(crate) open: Option<Vec<Edge>>,
    /// For each end of a boundary edge a representative vertex at its place, else [`UNUSED`].
    ///
    /// Empty where no frame decides on welding, and where there is no boundary.
    places: Vec<u32>,
}

/// Triangles after welding, and the welded vertices.
#[derive(Debug)]
pub(crate) struct Welding {
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Each vertex welded away, with the smaller vertex that replaces it; ascending.
    pub(crate) welded: Vec<(u32, u32)>,
    /// Vertices joined with a tolerance, where one was given.
    pub(crate) near: Option<NearSeams>,
}

/// Vertices that are one in the first frame of a mesh, and apart in a later one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartedSeams {
    /// Number of vertices gained in the later frame.
    pub count: usize,
    /// The two vertices furthest apart; the first represents the second in the first frame.
    pub vertices: [u32; 2],
    /// Their positions in the later frame.
    pub positions: [[f64; 3]; 2],
    /// Their distance, in diagonals of the body's bounding box.
    pub farthest: f64,
}

/// Marks a vertex that is no end of a boundary edge.
const UNUSED: u32 = u32::MAX;

/// Upper bound of the bytes that [`weld`] takes, its result included.
///
/// Three edges per triangle, and two numbers per vertex.
pub(crate) fn memory(triangles: u64, vertices: u64) -> u64 {
    let edges = triangles.saturating_mul(3 * size_of::<Edge>() as u64);
    edges.saturating_add(vertices.saturating_mul(2 * size_of::<u32>() as u64))
}

/// Most open boundary edges that are kept for a later search: 512 KiB of them.
const MOST_OPEN: usize = 1 << 16;

/// Welds `triangles` along boundary edges that coincide, in O(n log n).
///
/// `same(v)` is the weld key of vertex `v`: only vertices of equal keys are welded. The key is the
/// position, and whatever else moves the vertex in a format that moves vertices by rule. Every
/// index must be below `vertices`. Lists are shrunk and sorted in place and freed early, to stay
/// within [`memory`].
pub(crate) fn weld<K: Ord>(
    triangles: &[[u32; 3]],
    vertices: usize,
    same: impl Fn(u32) -> K,
) -> Seams {
    let mut edges = boundary_edges(triangles);
    let mut place = places(&edges, vertices, same);
    if edges.is_empty() {
        place = Vec::new();
    }
    // The places of the two ends, the smaller first, and the ends in that order.
    let placed = |&[a, b]: &Edge| {
        let [from, to] = [place[a as usize], place[b as usize]];
        if from < to {
            ([from, to], [a, b])
        } else {
            ([to, from], [b, a])
        }
    };
    edges.retain(|edge| {
        let ([from, to], _) = placed(edge);
        from != to
    });
    edges.sort_unstable_by_key(placed);

    let mut classes = Classes::new(vertices);
    let mut open = Vec::new();
    for coinciding in edges.chunk_by(|one, other| placed(one).0 == placed(other).0) {
        let (_, first) = placed(&coinciding[0]);
        if let ([one], ..=MOST_OPEN) = (coinciding, open.len()) {
            open.push(*one);
        }
        for other in &coinciding[1..] {
            let (_, other) = placed(other);
            classes.join(first[0], other[0]);
            classes.join(first[1], other[1]);
        }
    }
    drop(edges);
    for edge in &mut open {
        *edge = edge.map(|vertex| classes.leader(vertex));
        edge.sort_unstable();
    }
    open.sort_unstable();
    let open = (open.len() <= MOST_OPEN).then_some(open);
    let numbers = || 0..vertices as u32;
    let count = numbers()
        .filter(|&vertex| classes.leader(vertex) != vertex)
        .count();
    let unwelded = Seams {
        welding: None,
        open,
        places: place,
    };
    if count == 0 {
        return unwelded;
    }
    let mut welded = Vec::with_capacity(count);
    for vertex in numbers() {
        let leader = classes.leader(vertex);
        if leader != vertex {
            welded.push((vertex, leader));
        }
    }
    let triangles = rewritten(triangles, |corner| classes.leader(corner));
    let welding = Some(Welding {
        triangles,
        welded,
        near: None,
    });
    Seams {
        welding,
        ..unwelded
    }
}

/// For each end of an edge an arbitrary representative of the vertices at its place.
fn places<K: Ord>(edges: &[Edge], vertices: usize, same: impl Fn(u32) -> K) -> Vec<u32> {
    let mut place = vec![UNUSED; vertices];
    let mut count = 0;
    for &end in edges.as_flattened() {
        count += usize::from(place[end as usize] == UNUSED);
        place[end as usize] = end;
    }
    let mut ends = Vec::with_capacity(count);
    for (&place, vertex) in place.iter().zip(0..) {
        if place == vertex {
            ends.push(vertex);
        }
    }
    ends.sort_unstable_by_key(|&vertex| same(vertex));
    for together in ends.chunk_by(|&a, &b| same(a) == same(b)) {
        for &vertex in together {
            place[vertex as usize] = together[0];
        }
    }
    place
}

/// Position of `vertex` as bits, equal where the numbers are: -0 counts as 0.
pub(crate) fn position_bits(positions: Positions<'_>, vertex: u32) -> [u64; 3] {
    positions.get(vertex).map(|value| (value + 0.0).to_bits())
}

/// Hash of a position. A collision costs a search and changes no result.
fn hash(bits: [u64; 3]) -> u64 {
    bits.into_iter().fold(0, |hash: u64, bits| {
        let mixed = (hash ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    })
}

impl Seams {
    /// Whether ends of boundary edges coincide in another frame exactly where they do in this one.
    ///
    /// Then its seams are the same, bit for bit. Takes O(n log n), and eight bytes per vertex
    /// meanwhile.
    pub(crate) fn hold(&self, positions: Positions<'_>) -> bool {
        let mut different = Vec::new();
        for (&place, vertex) in self.places.iter().zip(0..) {
            let bits = |vertex| position_bits(positions, vertex);
            if place == vertex {
                different.push(hash(bits(vertex)));
            } else if place != UNUSED && bits(vertex) != bits(place) {
                return false;
            }
        }
        different.sort_unstable();
        different.is_sorted_by(|a, b| a < b)
    }

    /// Makes the seams hold in all frames: positions no longer decide.
    pub(crate) fn are_a_rule(&mut self) {
        self.places = Vec::new();
    }

    /// Triangles after welding; `all`: triangles of the file.
    pub(crate) fn triangles<'a>(&'a self, all: &'a [[u32; 3]]) -> &'a [[u32; 3]] {
        self.welding.as_ref().map_or(all, |it| &it.triangles)
    }

    /// The seams without near ones, as exact welding left them; `all`: triangles of the file.
    pub(crate) fn exactly(&self, all: &[[u32; 3]]) -> Self {
        let welding = self.welding.as_ref().map(|it| Welding {
            triangles: rewritten(all, |vertex| leader(&it.welded, vertex)),
            welded: it.welded.clone(),
            near: None,
        });
        let joined = self.welding.as_ref().and_then(|it| it.near.as_ref());
        let open = self.open.as_ref().filter(|_| joined.is_none());
        Self {
            welding,
            open: open.cloned(),
            places: self.places.clone(),
        }
    }

    /// Adds near seams; `all`: triangles of the file.
    pub(crate) fn join(&mut self, near: NearSeams, all: &[[u32; 3]]) {
        let welding = self.welding.get_or_insert_with(|| Welding {
            triangles: all.to_vec(),
            welded: Vec::new(),
            near: None,
        });
        near.rewrite(&mut welding.triangles);
        self.open = self.open.take().map(|open| near.still_open(open));
        welding.near = Some(near);
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> u64 {
        let welding = self.welding.as_ref().map_or(0, Welding::bytes);
        welding + self.open.as_deref().map_or(0, bytes_of) + bytes_of(&self.places)
    }

    /// The vertex that represents `vertex` after welding.
    pub(crate) fn leader(&self, vertex: u32) -> u32 {
        let welding = self.welding.as_ref();
        welding.map_or(vertex, |it| it.leader(vertex))
    }

    /// Vertices that are one here and apart in a later frame.
    ///
    /// `now`: seams of the later frame; `all`: triangles of the file.
    pub(crate) fn parted(
        &self,
        now: &Self,
        all: &[[u32; 3]],
        positions: Positions<'_>,
    ) -> Option<PartedSeams> {
        let welding = self.welding.as_ref()?;
        let joined = welding.near.as_ref().map_or(&[][..], NearSeams::joined);
        let led = welding.welded.iter().chain(joined);
        let pairs = led.map(|&(vertex, _)| [self.leader(vertex), vertex]);
        let parted = pairs.filter(|pair| {
            let [a, b] = pair.map(|vertex| now.leader(vertex));
            a != b
        });
        let apart = |pair: [u32; 2]| {
            let [a, b] = pair.map(|vertex| positions.get(vertex));
            near::length(a, b)
        };
        let (mut now_lead, mut farthest, mut vertices) = (Vec::new(), -1.0, [0; 2]);
        for pair in parted {
            now_lead.push((pair[0], now.leader(pair[1])));
            if apart(pair) > farthest {
                (farthest, vertices) = (apart(pair), pair);
            }
        }
        now_lead.sort_unstable();
        now_lead.dedup();
        let count = now_lead.len();
        let diagonal = near::extent(all, positions).map_or(1.0, |(_, diagonal)| diagonal);
        (count > 0).then(|| PartedSeams {
            count,
            vertices,
            positions: vertices.map(|vertex| positions.get(vertex)),
            farthest: farthest / diagonal,
        })
    }
}

/// Triangles with each corner replaced by its leader.
fn rewritten(triangles: &[[u32; 3]], mut leader: impl FnMut(u32) -> u32) -> Vec<[u32; 3]> {
    let triangles = triangles.iter();
    triangles.map(|corners| corners.map(&mut leader)).collect()
}

/// The vertex that replaces `vertex` in the sorted list `welded`, or `vertex` itself.
fn leader(welded: &[(u32, u32)], vertex: u32) -> u32 {
    let at = welded.binary_search_by_key(&vertex, |&(its, _)| its);
    at.map_or(vertex, |at| welded[at].1)
}

impl Welding {
    fn bytes(&self) -> u64 {
        let near = self.near.as_ref().map_or(0, NearSeams::bytes);
        bytes_of(&self.triangles) + bytes_of(&self.welded) + near
    }

    /// Number of welded vertices that do not move with their leaders to the bit.
    pub(crate) fn loose(&self, moves_alike: impl Fn(u32, u32) -> bool) -> usize {
        let alike = |&&(vertex, leader): &&(u32, u32)| !moves_alike(vertex, leader);
        self.welded.iter().filter(alike).count()
    }

    fn leader(&self, vertex: u32) -> u32 {
        let vertex = leader(&self.welded, vertex);
        self.near
            .as_ref()
            .map_or(vertex, |near| near.leader(vertex))
    }

    /// Number of vertices welded away.
    pub(crate) fn count(&self) -> usize {
        self.welded.len() + self.near.as_ref().map_or(0, NearSeams::count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seams(triangles: &[[u32; 3]], positions: &[[f64; 3]]) -> Seams {
        weld(triangles, positions.len(), |vertex| {
            position_bits(Positions::F64(positions), vertex)
        })
    }

    fn welded(triangles: &[[u32; 3]], positions: &[[f64; 3]]) -> Option<Welding> {
        let Seams { welding, open, .. } = seams(triangles, positions);
        // Open edges are boundary edges of the welded triangles. Not conversely: edges of triangles
        // that became needles are boundary too, but did coincide.
        let triangles = welding.as_ref().map_or(triangles, |it| &it.triangles);
        let boundary = boundary_edges(triangles);
        assert!(open.unwrap().iter().all(|edge| boundary.contains(edge)));
        welding
    }

    /// The six sides of a cube, each with four vertices of its own.
    fn split_cube() -> (Vec<[u32; 3]>, Vec<[f64; 3]>) {
        let (mut triangles, mut positions) = (vec![], vec![]);
        for axis in 0..3 {
            for side in [0.0, 1.0] {
                let first = positions.len() as u32;
                for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                    let mut position = [u; 3];
                    position[axis] = side;
                    position[(axis + 1) % 3] = v;
                    positions.push(position);
                }
                triangles.extend(
                    [[0, 1, 2], [0, 2, 3]]
                        .map(|corners: [u32; 3]| corners.map(|corner| corner + first)),
                );
            }
        }
        (triangles, positions)
    }

    #[test]
    fn a_cube_of_six_sides_has_eight_places() {
        let (triangles, positions) = split_cube();
        let welding = welded(&triangles, &positions).unwrap();
        assert_eq!(welding.welded.len(), 24 - 8);
        let mut used = welding.triangles.concat();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), 8);
        assert_eq!(boundary_edges(&welding.triangles), Vec::<Edge>::new());
        for (welded, original) in welding.triangles.iter().zip(&triangles) {
            for (&corner, &before) in welded.iter().zip(original) {
                let bits = |vertex| position_bits(Positions::F64(&positions), vertex);
                assert_eq!(bits(corner), bits(before));
                assert!(corner <= before);
            }
        }
        assert!(
            welded(&welding.triangles, &positions).is_none(),
            "a welded mesh welds no further"
        );
    }

    #[test]
    fn minus_zero_is_zero() {
        let (triangles, mut positions) = split_cube();
        for position in &mut positions[..4] {
            *position = position.map(|value| if value == 0.0 { -0.0 } else { value });
        }
        assert_eq!(welded(&triangles, &positions).unwrap().welded.len(), 16);
    }

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn solids_that_touch_stay_apart() {
        let corners = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let mut triangles = TETRAHEDRON.to_vec();
        triangles.extend(TETRAHEDRON.map(|t| t.map(|corner| corner + 4)));
        // In a point; then, closed as they are, along an edge.
        for mirrored in [[true, true, true], [true, true, false]] {
            let mut positions = corners.to_vec();
            positions.extend(corners.map(|p: [f64; 3]| {
                let mut p = p;
                for axis in 0..3 {
                    p[axis] = if mirrored[axis] { -p[axis] } else { p[axis] };
                }
                p
            }));
            assert!(welded(&triangles, &positions).is_none());
        }
    }

    #[test]
    fn open_triangles_that_touch_in_a_point_stay_apart() {
        let positions = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0; 3],
            [-1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
        ];
        assert!(welded(&[[0, 1, 2], [3, 4, 5]], &positions).is_none());
    }

    #[test]
    fn an_edge_without_length_is_a_point() {
        // Both triangles are needles whose short side lies at the origin.
        let positions = [
            [0.0; 3],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0; 3],
            [0.0; 3],
            [0.0, 1.0, 0.0],
        ];
        let welding = welded(&[[0, 1, 2], [3, 4, 5]], &positions);
        // The two long sides of each needle coincide, which closes it; the needles stay apart.
        assert_eq!(welding.unwrap().welded, [(1, 0), (4, 3)]);
    }

    #[test]
    fn ends_are_matched_by_position_whatever_the_direction() {
        let positions = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.5, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0; 3],
            [0.5, -1.0, 0.0],
        ];
        for second in [[3, 4, 5], [4, 3, 5]] {
            assert_eq!(
                welded(&[[0, 1, 2], second], &positions).unwrap().welded,
                [(3, 1), (4, 0)]
            );
        }
    }

    #[test]
    fn edges_inside_a_surface_do_not_weld() {
        // Two folded sheets, of two triangles each, whose inner edges coincide and nothing else
        // does.
        let positions = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.5, 1.0, 0.0],
            [0.5, -1.0, 0.0],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.5, 0.0, 1.0],
            [0.5, 0.0, -1.0],
        ];
        let sheets = [[0, 1, 2], [1, 0, 3], [4, 5, 6], [5, 4, 7]];
        assert!(welded(&sheets, &positions).is_none());
    }

    #[test]
    fn seams_hold_while_the_same_ends_are_together() {
        let (triangles, mut positions) = split_cube();
        let first = seams(&triangles, &positions);
        for position in &mut positions {
            *position = position.map(|value| value * 3.0 - 1.0);
        }
        assert!(first.hold(Positions::F64(&positions)));
        let (vertex, leader) = first.welding.as_ref().unwrap().welded[5];
        let before = positions.clone();
        positions[vertex as usize][1] = positions[vertex as usize][1].next_up();
        assert!(!first.hold(Positions::F64(&positions)), "one is apart");
        let now = seams(&triangles, &positions);
        let all = Positions::F64(&positions);
        let parted = first.parted(&now, &triangles, all).unwrap();
        assert_eq!((parted.count, parted.vertices), (1, [leader, vertex]));
        assert!(parted.farthest > 0.0 && parted.farthest < 1e-15);
        assert!(now.parted(&first, &triangles, all).is_none());
        // Two places become one.
        positions = before;
        let place = positions[0];
        for position in positions.iter_mut().filter(|it| it[1] == place[1]) {
            position[0] = place[0];
        }
        assert!(!first.hold(Positions::F64(&positions)));
    }

    #[test]
    fn degenerate_triangles_are_no_danger() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]];
        assert!(welded(&[[0, 0, 0], [1, 1, 1]], &positions).is_none());
        // Each uses one edge once.
        assert_eq!(
            welded(&[[0, 0, 1], [2, 3, 3]], &positions).unwrap().welded,
            [(2, 0), (3, 1)]
        );
    }
}
