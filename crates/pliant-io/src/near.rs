//! Near seams: joining boundary edges whose ends nearly coincide, within a tolerance.
//!
//! Exact welding ([`weld`](crate::weld)) has joined all that coincides bit for bit. Two of the
//! remaining boundary edges are *near* if each end of one is within a distance of an end of the
//! other.
//!
//! ```text
//! edges of exactly one triangle, longer than twice the distance     a shorter one is a point here
//! a table of them, by the cells of their two ends                   spatial hashing
//! for each edge, the near ones in the cells round its two ends      by the larger distance of ends
//! the nearest pair first, then by number: join the ends             union-find, the smallest leads
//! ```
//!
//! Invariants; a pair of edges that would break one is passed over:
//!
//! - No triangle gets two corners in one vertex, which would make a hole.
//! - No vertex is further from its leader than the distance, however long a chain of near vertices
//!   is.
//! - Single points are never joined.
//!
//! The result depends only on the mesh and the distance, and every frame is searched anew. Takes
//! O(n log n), unless very many edges are crowded within the distance of one: that is an error.

use crate::boundary::boundary_edges;
use crate::classes::Classes;
use crate::error::Reason;
use crate::memory::Account;
use crate::positions::Positions;

/// Vertices joined to others near them, within a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct NearSeams {
    /// Each vertex joined away, with the smaller vertex that replaces it; ascending.
    joined: Vec<(u32, u32)>,
    farthest: f64,
}

/// Tolerances that are allowed, besides 0, which joins nothing.
///
/// Smaller ones give cell numbers beyond i64; larger ones leave nothing of a shape.
pub(crate) const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-15..=0.1;

/// Side of a cell, in tolerance distances.
///
/// Larger cells hold more edges that are not near; of smaller cells, more are within reach.
const CELL: f64 = 8.0;

/// Comparisons allowed per edge, on average.
const MOST_COMPARED: u64 = 1 << 9;
/// Comparisons allowed in any case: few enough to take no noticeable time.
const ALWAYS_COMPARED: u64 = 1 << 22;

/// A pair of near edges: larger distance of their ends, their numbers, and whether their directions
/// are opposite.
type Near = (f64, u32, u32, bool);

type Point = [f64; 3];

impl NearSeams {
    /// Finds near seams of `triangles`; None if there are none.
    ///
    /// Their sides are at most `tolerance` times the diagonal of the bounding box apart.
    pub(crate) fn find(
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
        tolerance: f64,
        account: &mut Account,
    ) -> Result<Option<Self>, Reason> {
        // During the search every triangle has three.
        let edges = 24 * triangles.len() as u64;
        account.enter(edges).map_err(too_large)?;
        let found = Self::among(
            boundary_edges(triangles),
            triangles,
            positions,
            tolerance,
            account,
        );
        account.take_off(edges);
        found
    }

    /// Finds near seams among `edges`, the boundary edges of `triangles`; see [`find`](Self::find).
    pub(crate) fn among(
        mut edges: Vec<[u32; 2]>,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
        tolerance: f64,
        account: &mut Account,
    ) -> Result<Option<Self>, Reason> {
        let Some((lowest, diagonal)) = extent(triangles, positions) else {
            return Ok(None);
        };
        let distance = tolerance * diagonal;
        if distance == 0.0 {
            return Ok(None);
        }
        let before = account.held();
        let search = Search {
            triangles,
            positions,
            lowest,
            distance,
        };
        search.keep_long(&mut edges);
        let found = search.near(&edges, account).and_then(|near| {
            // Both ends of each pair need their number, the ring, the size of a class, and some
            // triangles.
            account.enter(2 * 100 * near.len() as u64)?;
            Ok(search.join(&edges, &near, diagonal))
        });
        account.take_off(account.held() - before);
        found.map_err(too_large)
    }

    /// The vertex that represents `vertex` after joining. Takes O(log n).
    pub fn leader(&self, vertex: u32) -> u32 {
        let at = self.joined.binary_search_by_key(&vertex, |&(its, _)| its);
        at.map_or(vertex, |at| self.joined[at].1)
    }

    /// Number of vertices joined away.
    pub fn count(&self) -> usize {
        self.joined.len()
    }

    /// The largest distance of a joined vertex from its leader, in diagonals of the bounding box.
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// Replaces every corner by its leader.
    pub(crate) fn rewrite(&self, triangles: &mut [[u32; 3]]) {
        for corner in triangles.as_flattened_mut() {
            *corner = self.leader(*corner);
        }
    }

    /// Boundary edges that were joined to no other, by the leaders of their ends, ascending.
    pub(crate) fn still_open(&self, mut edges: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
        for edge in &mut edges {
            *edge = edge.map(|vertex| self.leader(vertex));
            edge.sort_unstable();
        }
        edges.sort_unstable();
        let alone = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
        alone.map(|same| same[0]).collect()
    }

    pub(crate) fn bytes(&self) -> u64 {
        size_of_val(&self.joined[..]) as u64
    }

    /// Each vertex joined away, with its leader; ascending.
    pub(crate) fn joined(&self) -> &[(u32, u32)] {
        &self.joined
    }
}

/// Turns an error of the memory account into the one for seams.
fn too_large(reason: impl Into<Reason>) -> Reason {
    match reason.into() {
        Reason::TooLarge { needed, limit } => Reason::SeamsTooLarge { needed, limit },
        reason => reason,
    }
}

/// Distance of two points, without overflow or underflow on the way.
pub(crate) fn length(a: Point, b: Point) -> f64 {
    let [x, y, z] = std::array::from_fn(|axis| a[axis] - b[axis]);
    f64::hypot(f64::hypot(x, y), z)
}

/// Lowest corner and diagonal of the bounding box of all triangles; None if it is a point.
pub(crate) fn extent(triangles: &[[u32; 3]], positions: Positions<'_>) -> Option<(Point, f64)> {
    let mut corners = triangles.as_flattened().iter().map(|&v| positions.get(v));
    let first = corners.next()?;
    let (low, high) = corners.fold((first, first), |(low, high), point| {
        (
            std::array::from_fn(|axis| low[axis].min(point[axis])),
            std::array::from_fn(|axis| high[axis].max(point[axis])),
        )
    });
    let diagonal = length(low, high);
    (diagonal > 0.0).then_some((low, diagonal))
}

/// Input of one search, with the distance in the file's unit.
struct Search<'a> {
    triangles: &'a [[u32; 3]],
    positions: Positions<'a>,
    lowest: Point,
    distance: f64,
}

impl Search<'_> {
    fn apart(&self, a: u32, b: u32) -> f64 {
        length(self.positions.get(a), self.positions.get(b))
    }

    /// Keeps the edges that are longer than twice the distance.
    fn keep_long(&self, edges: &mut Vec<[u32; 2]>) {
        // So no two edges are near in both directions: one would be at most twice the distance
        // long.
        edges.retain(|&[a, b]| self.apart(a, b) > 2.0 * self.distance);
    }

    /// Cell of a point moved by `by` distances along each axis. Rounding keeps cells in order.
    fn cell(&self, point: Point, by: [f64; 3]) -> [i64; 3] {
        std::array::from_fn(|axis| {
            let moved = (point[axis] - self.lowest[axis]) + by[axis] * self.distance;
            (moved / (CELL * self.distance)).floor() as i64
        })
    }

    /// The one to eight cells that can hold a point near this one.
    fn cells_near(&self, point: Point) -> impl Iterator<Item = [i64; 3]> + use<> {
        // A little more than 1, for the rounding of the differences.
        const REACH: f64 = 1.001;
        let [low, high] = [-REACH, REACH].map(|by| self.cell(point, [by; 3]));
        let axis = move |axis: usize| low[axis]..=high[axis];
        axis(0).flat_map(move |x| axis(1).flat_map(move |y| axis(2).map(move |z| [x, y, z])))
    }

    /// All pairs of near edges, the nearest first, then by number.
    fn near(&self, edges: &[[u32; 2]], account: &mut Account) -> Result<Vec<Near>, Reason> {
        let cell = |vertex: u32| self.cell(self.positions.get(vertex), [0.0; 3]);
        let mut table = Vec::new();
        for (number, &[a, b]) in (0_u32..).zip(edges) {
            account.push(&mut table, (key(cell(a), cell(b)), number), edges.len())?;
        }
        table.sort_unstable();
        let mut left = ALWAYS_COMPARED + MOST_COMPARED * edges.len() as u64;
        let mut near: Vec<Near> = Vec::new();
        for (number, &[a, b]) in (0_u32..).zip(edges) {
            for (from, to, against) in [(a, b, false), (b, a, true)] {
                let [from_at, to_at] = [from, to].map(|vertex| self.positions.get(vertex));
                for first in self.cells_near(from_at) {
                    for second in self.cells_near(to_at) {
                        let key = key(first, second);
                        let begin = table.partition_point(|&(its, _)| its < key);
                        let same = table[begin..].iter().take_while(|&&(its, _)| its == key);
                        for &(_, other) in same {
                            left = left.checked_sub(1).ok_or(Reason::SeamsTooDense)?;
                            if other <= number {
                                continue;
                            }
                            let [c, d] = edges[other as usize];
                            let apart = f64::max(self.apart(from, c), self.apart(to, d));
                            if apart <= self.distance {
                                account.push(&mut near, (apart, number, other, against), 0)?;
                            }
                        }
                    }
                }
            }
        }
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        Ok(near)
    }

    /// Joins the ends of near edges, one pair after another.
    fn join(&self, edges: &[[u32; 2]], near: &[Near], diagonal: f64) -> Option<NearSeams> {
        let mut joining = Joining::new(self, edges, near);
        for &(_, one, other, against) in near {
            let [a, b] = edges[one as usize].map(|vertex| joining.number(vertex));
            let [mut c, mut d] = edges[other as usize].map(|vertex| joining.number(vertex));
            if against {
                (c, d) = (d, c);
            }
            // The order of the two joins does not matter: a triangle that has corners of all four
            // vertices would already have two corners in one.
            if joining.may(a, c) && joining.may(b, d) {
                joining.join(a, c);
                joining.join(b, d);
            }
        }
        let mut farthest = 0.0_f64;
        let mut joined = Vec::new();
        for (number, &vertex) in (0_u32..).zip(&joining.vertices) {
            let leader = joining.vertices[joining.classes.leader(number) as usize];
            if leader != vertex {
                farthest = farthest.max(self.apart(vertex, leader));
                joined.push((vertex, leader));
            }
        }
        (!joined.is_empty()).then_some(NearSeams {
            joined,
            farthest: farthest / diagonal,
        })
    }
}

/// Hash of two cells. A collision costs comparisons and changes no result.
fn key(first: [i64; 3], second: [i64; 3]) -> u64 {
    first.into_iter().chain(second).fold(0, |hash: u64, cell| {
        let mixed = (hash ^ cell.cast_unsigned()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    })
}

/// Union-find of joined vertices, and the data that decides whether two classes may join.
///
/// Vertices that may be joined have numbers of their own, in ascending order.
struct Joining<'a> {
    search: &'a Search<'a>,
    /// Vertex of each number, ascending.
    vertices: Vec<u32>,
    classes: Classes,
    /// Next vertex of the same class, in a ring.
    next: Vec<u32>,
    /// Size of the class of each leader.
    size: Vec<u32>,
    /// Triangles at each vertex, sorted: number of the vertex, and numbers of the other two
    /// corners.
    corners: Vec<(u32, [u32; 2])>,
}

/// Number of a vertex that cannot be joined.
const NOT_JOINED: u32 = u32::MAX;

impl<'a> Joining<'a> {
    fn new(search: &'a Search<'a>, edges: &[[u32; 2]], near: &[Near]) -> Self {
        let ends = near.iter().flat_map(|&(_, one, other, _)| [one, other]);
        let mut vertices: Vec<u32> = ends.flat_map(|edge| edges[edge as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let count = vertices.len();
        let mut joining = Self {
            search,
            vertices,
            classes: Classes::new(count),
            next: (0..count as u32).collect(),
            size: vec![1; count],
            corners: Vec::new(),
        };
        if count > 0 {
            for three in search.triangles {
                let [a, b, c] = three.map(|vertex| joining.number(vertex));
                let at_each = [(a, [b, c]), (b, [c, a]), (c, [a, b])];
                let joined = at_each.into_iter().filter(|&(its, _)| its != NOT_JOINED);
                joining.corners.extend(joined);
            }
        }
        joining.corners.sort_unstable();
        joining
    }

    /// Number of a vertex, or [`NOT_JOINED`].
    fn number(&self, vertex: u32) -> u32 {
        let number = self.vertices.binary_search(&vertex);
        number.map_or(NOT_JOINED, |number| number as u32)
    }

    /// Members of a class, its leader first.
    fn members(&self, leader: u32) -> impl Iterator<Item = u32> + use<'_> {
        let mut vertex = Some(leader);
        std::iter::from_fn(move || {
            let this = vertex?;
            let next = self.next[this as usize];
            vertex = (next != leader).then_some(next);
            Some(this)
        })
    }

    /// Whether the classes of two vertices may join.
    fn may(&mut self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|vertex| self.classes.leader(vertex));
        if a == b {
            return true;
        }
        let (leader, led) = (a.min(b), a.max(b));
        let apart = |number: u32| {
            let [a, b] = [number, leader].map(|number| self.vertices[number as usize]);
            self.search.apart(a, b)
        };
        let is_near = |number| apart(number) <= self.search.distance;
        if !self.members(led).all(is_near) {
            return false;
        }
        let (small, large) = if self.size[a as usize] < self.size[b as usize] {
            (a, b)
        } else {
            (b, a)
        };
        let mut member = small;
        loop {
            let begin = self.corners.partition_point(|&(its, _)| its < member);
            for at in begin..self.corners.len() {
                let (its, others) = self.corners[at];
                if its != member {
                    break;
                }
                let is_of_large =
                    |&other: &u32| other != NOT_JOINED && self.classes.leader(other) == large;
                if others.iter().any(is_of_large) {
                    return false;
                }
            }
            member = self.next[member as usize];
            if member == small {
                return true;
            }
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [a, b].map(|vertex| self.classes.leader(vertex));
        if a != b {
            self.size[a.min(b) as usize] += self.size[a.max(b) as usize];
            self.classes.join(a, b);
            self.next.swap(a as usize, b as usize);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(triangles: &[[u32; 3]], positions: &[Point], tolerance: f64) -> Option<NearSeams> {
        let mut account = Account::new(1 << 30);
        let found = NearSeams::find(
            triangles,
            Positions::F64(positions),
            tolerance,
            &mut account,
        );
        assert_eq!(account.held(), 0, "all is taken off again");
        found.unwrap()
    }

    /// Random numbers from -1 to 1.
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    /// Triangles that share no vertex, every corner moved by up to `by` along each axis.
    fn soup(triangles: &[[Point; 3]], by: f64, seed: u64) -> (Vec<[u32; 3]>, Vec<Point>) {
        let mut noise = noise(seed);
        let corners = triangles.as_flattened().iter();
        let positions: Vec<Point> = corners
            .map(|point| point.map(|x| x + by * noise()))
            .collect();
        let numbers = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        (numbers.collect(), positions)
    }

    /// A cone with `sides` sides, and its base.
    fn cone(sides: u32) -> Vec<[Point; 3]> {
        let rim = |side: u32| {
            let angle = f64::from(side % sides) / f64::from(sides) * std::f64::consts::TAU;
            [angle.cos(), angle.sin(), 0.0]
        };
        let both = |side| {
            [
                [rim(side), rim(side + 1), [0.0, 0.0, 1.0]],
                [rim(side + 1), rim(side), [0.0; 3]],
            ]
        };
        (0..sides).flat_map(both).collect()
    }

    #[test]
    fn a_soup_whose_last_digits_differ_is_closed() {
        for (sides, seed) in [(3, 1), (12, 2), (100, 3)] {
            let (mut triangles, positions) = soup(&cone(sides), 1e-8, seed);
            let near = find(&triangles, &positions, 1e-6).unwrap();
            assert_eq!(near.count() as u32, 6 * sides - (sides + 2));
            assert!(near.farthest() > 1e-9 && near.farthest() < 1e-7);
            near.rewrite(&mut triangles);
            assert!(boundary_edges(&triangles).is_empty());
            for [a, b, c] in triangles {
                assert!(a != b && b != c && c != a);
            }
        }
        // Nothing is joined that is further apart than the tolerance.
        let (triangles, positions) = soup(&cone(12), 1e-4, 4);
        assert!(find(&triangles, &positions, 1e-6).is_none());
    }

    /// Invariants hold for any mesh and distance.
    #[test]
    fn leaders_are_near_and_no_triangle_loses_a_corner() {
        let mut joined = 0;
        for seed in 0..200 {
            let by = [1e-3, 1e-2, 3e-2, 0.1][seed as usize % 4];
            let (triangles, positions) = soup(&cone(3 + seed as u32 % 20), by, seed);
            for tolerance in [1e-3, 1e-2, 0.05] {
                let Some(near) = find(&triangles, &positions, tolerance) else {
                    continue;
                };
                let (_, diagonal) = extent(&triangles, Positions::F64(&positions)).unwrap();
                joined += near.count();
                let mut rewritten = triangles.clone();
                near.rewrite(&mut rewritten);
                for [a, b, c] in rewritten {
                    assert!(a != b && b != c && c != a);
                }
                for vertex in 0..positions.len() as u32 {
                    let leader = near.leader(vertex);
                    assert!(leader <= vertex && near.leader(leader) == leader);
                    let apart = length(positions[vertex as usize], positions[leader as usize]);
                    assert!(apart <= tolerance * diagonal);
                }
            }
        }
        assert!(joined > 1000, "{joined}");
    }

    /// The table finds exactly the pairs that brute force finds.
    #[test]
    fn near_edges_are_all_found() {
        let mut pairs = 0;
        for seed in 0..60 {
            let by = [1e-3, 1e-2, 3e-2][seed as usize % 3];
            let (triangles, mut positions) = soup(&cone(10), by, seed);
            // Far from the origin, too.
            for position in &mut positions {
                position[0] += [0.0, -1e6, 1e9][seed as usize / 3 % 3];
            }
            let positions = Positions::F64(&positions);
            let (lowest, diagonal) = extent(&triangles, positions).unwrap();
            let search = Search {
                triangles: &triangles,
                positions,
                lowest,
                distance: 0.01 * diagonal,
            };
            let mut edges = boundary_edges(&triangles);
            search.keep_long(&mut edges);
            let found = search.near(&edges, &mut Account::new(1 << 30)).unwrap();
            let mut expected = Vec::new();
            for (i, &[a, b]) in edges.iter().enumerate() {
                for (j, &[c, d]) in edges.iter().enumerate().skip(i + 1) {
                    for (from, to, against) in [(a, b, false), (b, a, true)] {
                        let apart = f64::max(search.apart(from, c), search.apart(to, d));
                        if apart <= search.distance {
                            expected.push((apart, i as u32, j as u32, against));
                        }
                    }
                }
            }
            pairs += expected.len();
            expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
            assert_eq!(found, expected);
        }
        assert!(pairs > 500, "{pairs}");
    }

    #[test]
    fn the_nearest_come_first_and_points_stay_points() {
        // An edge with two others near it, on a line. The chain is longer than the distance, so
        // only the nearer two join.
        let at = |x: f64| [[x, 0.0, 0.0], [x, 1.0, 0.0], [x + 0.3, 0.5, 1.0]];
        let (triangles, positions) = soup(&[at(0.0), at(0.009), at(0.014)], 0.0, 1);
        let near = find(&triangles, &positions, 0.01 / 1.45).unwrap();
        let leaders: Vec<u32> = (0..9).map(|vertex| near.leader(vertex)).collect();
        assert_eq!(leaders, [0, 1, 2, 3, 4, 5, 3, 4, 5]);
        // Two triangles that nearly touch in a point.
        let one = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let other = [[-1e-9, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
        let (triangles, positions) = soup(&[one, other], 0.0, 1);
        assert!(find(&triangles, &positions, 1e-6).is_none());
        // All in one point, and no triangle at all.
        assert!(find(&[[0, 1, 2]], &[[1.0; 3]; 3], 0.1).is_none());
        assert!(find(&[], &[], 0.1).is_none());
    }

    #[test]
    fn any_magnitude_is_as_good_as_any_other() {
        for scale in [1e-310, 1e-200, 1.0, 1e38] {
            let scaled = |triangle: [Point; 3]| triangle.map(|point| point.map(|x| x * scale));
            let cone: Vec<_> = cone(12).into_iter().map(scaled).collect();
            let (triangles, positions) = soup(&cone, 1e-8 * scale, 7);
            assert_eq!(find(&triangles, &positions, 1e-6).unwrap().count(), 72 - 14);
        }
    }

    #[test]
    fn a_crowd_of_edges_is_refused() {
        let one = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let (triangles, positions) = soup(&vec![one; 6_000], 3e-4, 1);
        let mut account = Account::new(1 << 30);
        let found = NearSeams::find(&triangles, Positions::F64(&positions), 1e-4, &mut account);
        assert!(matches!(found, Err(Reason::SeamsTooDense)));
        // Nor is more memory held than allowed.
        let mut account = Account::new(1 << 18);
        let found = NearSeams::find(&triangles, Positions::F64(&positions), 1e-4, &mut account);
        assert!(matches!(found, Err(Reason::SeamsTooLarge { .. })));
    }
}
