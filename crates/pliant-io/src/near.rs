//! Seams that nearly coincide: two sides of a surface that meet, but whose vertices differ in their last digits.
//!
//! Bit for bit [`weld`](crate::weld) has joined what it could. What is left are boundary edges, and two of them are *near* if each
//! end of the one is within a distance of an end of the other. Near edges are joined, the nearest first:
//!
//! ```text
//! edges of exactly one triangle, longer than twice the distance       a shorter one is a point in this sense
//! a table of them, by the cells that their two ends are in
//! for each edge, those in the cells round its two ends: near ones, with the larger distance of their ends
//! from the least distance on, then by number: join their ends          union-find, the smallest vertex leads
//! ```
//!
//! Always true: no triangle gets two corners in one, which would make a hole; no vertex is further from the one that leads it than
//! the distance, however long a chain of near vertices is; single points are never joined. A pair of edges that would break one of
//! these is passed over. The result depends on nothing but the mesh and the distance.
//!
//! It is asked of every frame anew.
//!
//! Time is that of sorting, unless very many edges are crowded into the reach of one: then it is refused, not waited for.

use crate::boundary::boundary_edges;
use crate::classes::Classes;
use crate::error::Reason;
use crate::memory::Account;
use crate::positions::Positions;

/// Vertices joined to others near them.
#[derive(Debug, Clone, PartialEq)]
pub struct NearSeams {
    /// Each vertex joined away, with the smaller vertex that takes its place; ascending.
    joined: Vec<(u32, u32)>,
    farthest: f64,
}

/// Tolerances that can be asked for, but for 0, which joins nothing: below, cells have no numbers; above, nothing is left of a shape.
pub(crate) const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-15..=0.1;

/// The side of a cell, in distances. Wider ones hold more edges that are not near, of narrower ones more are within reach.
const CELL: f64 = 8.0;

/// An edge may be compared with so many others, on average and beyond a number that is nothing.
const MOST_COMPARED: u64 = 1 << 9;
const ALWAYS_COMPARED: u64 = 1 << 22;

/// Two edges that are near: the larger distance of their ends, their numbers, and whether the one runs against the other.
type Near = (f64, u32, u32, bool);

type Point = [f64; 3];

impl NearSeams {
    /// Finds the seams of `triangles` whose sides are at most `tolerance` times the diagonal of their box apart. None if there is none.
    pub(crate) fn find(
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
        tolerance: f64,
        account: &mut Account,
    ) -> Result<Option<Self>, Reason> {
        // While they are found, every triangle has three.
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

    /// The same, where the boundary edges of the triangles are known.
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
            // Of each of the two ends: its number, the ring, the size of a class, and some triangles.
            account.enter(2 * 100 * near.len() as u64)?;
            Ok(search.join(&edges, &near, diagonal))
        });
        account.take_off(account.held() - before);
        found.map_err(too_large)
    }

    /// The vertex that stands for this one.
    pub fn leader(&self, vertex: u32) -> u32 {
        let at = self.joined.binary_search_by_key(&vertex, |&(its, _)| its);
        at.map_or(vertex, |at| self.joined[at].1)
    }

    /// How many vertices another one stands for.
    pub fn count(&self) -> usize {
        self.joined.len()
    }

    /// The largest distance of a vertex from the one that stands for it, in diagonals of the box.
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// Puts leaders in the place of those that they stand for.
    pub(crate) fn rewrite(&self, triangles: &mut [[u32; 3]]) {
        for corner in triangles.as_flattened_mut() {
            *corner = self.leader(*corner);
        }
    }

    /// Those of the boundary edges that were joined to no other, by leaders, ascending.
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

    /// Each vertex joined away, with the one that stands for it; ascending.
    pub(crate) fn joined(&self) -> &[(u32, u32)] {
        &self.joined
    }
}

/// Memory that is not allowed, as what finds seams says it.
fn too_large(reason: impl Into<Reason>) -> Reason {
    match reason.into() {
        Reason::TooLarge { needed, limit } => Reason::SeamsTooLarge { needed, limit },
        reason => reason,
    }
}

/// The distance of two points, without overflow or underflow on the way.
pub(crate) fn length(a: Point, b: Point) -> f64 {
    let [x, y, z] = std::array::from_fn(|axis| a[axis] - b[axis]);
    f64::hypot(f64::hypot(x, y), z)
}

/// The lowest corner and the diagonal of the box of all triangles; None where that is a point.
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

/// What is searched.
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

    /// Keeps the edges that are long enough.
    fn keep_long(&self, edges: &mut Vec<[u32; 2]>) {
        // So no two of them are near both ways round, for then one were no longer than twice the distance.
        edges.retain(|&[a, b]| self.apart(a, b) > 2.0 * self.distance);
    }

    /// The cell of a place, moved by so many distances along every axis. Rounding never changes the order of cells along an axis.
    fn cell(&self, point: Point, by: [f64; 3]) -> [i64; 3] {
        std::array::from_fn(|axis| {
            let moved = (point[axis] - self.lowest[axis]) + by[axis] * self.distance;
            (moved / (CELL * self.distance)).floor() as i64
        })
    }

    /// The cells in which anything near a point can be: one to eight.
    fn cells_near(&self, point: Point) -> impl Iterator<Item = [i64; 3]> + use<> {
        // A little more than the distance, for the rounding of the differences.
        const REACH: f64 = 1.001;
        let [low, high] = [-REACH, REACH].map(|by| self.cell(point, [by; 3]));
        let axis = move |axis: usize| low[axis]..=high[axis];
        axis(0).flat_map(move |x| axis(1).flat_map(move |y| axis(2).map(move |z| [x, y, z])))
    }

    /// All pairs of edges that are near, the nearest first, then by number.
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

    /// Joins the ends of near edges one after another.
    fn join(&self, edges: &[[u32; 2]], near: &[Near], diagonal: f64) -> Option<NearSeams> {
        let mut joining = Joining::new(self, edges, near);
        for &(_, one, other, against) in near {
            let [a, b] = edges[one as usize].map(|vertex| joining.number(vertex));
            let [mut c, mut d] = edges[other as usize].map(|vertex| joining.number(vertex));
            if against {
                (c, d) = (d, c);
            }
            // Neither end decides for the other: a triangle that had corners of all four would have two corners in one already.
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

/// Two cells as one number; others may have the same, which costs comparisons and changes nothing.
fn key(first: [i64; 3], second: [i64; 3]) -> u64 {
    first.into_iter().chain(second).fold(0, |hash: u64, cell| {
        let mixed = (hash ^ cell.cast_unsigned()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    })
}

/// Classes of joined vertices, and what must be known to join them. Vertices that may be joined have numbers of their own, in their
/// order.
struct Joining<'a> {
    search: &'a Search<'a>,
    /// Ascending.
    vertices: Vec<u32>,
    classes: Classes,
    /// The next vertex of the same class, in a ring.
    next: Vec<u32>,
    /// Of a leader, how many its class has.
    size: Vec<u32>,
    /// For each triangle at a vertex the number of that, and of its other corners; sorted.
    corners: Vec<(u32, [u32; 2])>,
}

/// The number of a vertex that is not joined.
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

    fn number(&self, vertex: u32) -> u32 {
        let number = self.vertices.binary_search(&vertex);
        number.map_or(NOT_JOINED, |number| number as u32)
    }

    /// The members of a class.
    fn members(&self, leader: u32) -> impl Iterator<Item = u32> + use<'_> {
        let mut vertex = Some(leader);
        std::iter::from_fn(move || {
            let this = vertex?;
            let next = self.next[this as usize];
            vertex = (next != leader).then_some(next);
            Some(this)
        })
    }

    /// Whether the classes of two vertices may become one.
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

    /// Numbers from -1 to 1.
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    /// Every corner of every triangle a vertex of its own, moved by up to so much along each axis.
    fn soup(triangles: &[[Point; 3]], by: f64, seed: u64) -> (Vec<[u32; 3]>, Vec<Point>) {
        let mut noise = noise(seed);
        let corners = triangles.as_flattened().iter();
        let positions: Vec<Point> = corners
            .map(|point| point.map(|x| x + by * noise()))
            .collect();
        let numbers = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        (numbers.collect(), positions)
    }

    /// A cone of so many sides, and its base.
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
        // Further apart than asked for, all stays as it is.
        let (triangles, positions) = soup(&cone(12), 1e-4, 4);
        assert!(find(&triangles, &positions, 1e-6).is_none());
    }

    /// Whatever the mesh and the distance, what is promised holds.
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

    /// The table finds the pairs that comparing all with all finds.
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
        // An edge with two others near it, on a line: the chain is longer than the distance, and the nearer two join.
        let at = |x: f64| [[x, 0.0, 0.0], [x, 1.0, 0.0], [x + 0.3, 0.5, 1.0]];
        let (triangles, positions) = soup(&[at(0.0), at(0.009), at(0.014)], 0.0, 1);
        let near = find(&triangles, &positions, 0.01 / 1.45).unwrap();
        let leaders: Vec<u32> = (0..9).map(|vertex| near.leader(vertex)).collect();
        assert_eq!(leaders, [0, 1, 2, 3, 4, 5, 3, 4, 5]);
        // Two triangles that touch in a point, nearly.
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
        // Nor is more held than may be.
        let mut account = Account::new(1 << 18);
        let found = NearSeams::find(&triangles, Positions::F64(&positions), 1e-4, &mut account);
        assert!(matches!(found, Err(Reason::SeamsTooLarge { .. })));
    }
}
