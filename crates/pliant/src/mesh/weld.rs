//! Welding: boundary edges that coincide within a tolerance, and the vertices that become one by
//! it.
//!
//! A boundary edge is an edge of exactly one triangle. Two coincide if their ends do, one by one.
//! Single vertices that coincide are not welded: two sheets that touch in a point stay two. Two
//! corners of one triangle are never welded, however short its edges are, so no triangle is lost.
//! How edges are found: [`Search`].

mod classes;

use super::edges::SortedEdges;
use classes::Classes;
use std::ops::Range;

/// Positions of vertices, and the tolerance within which they coincide.
pub(crate) struct Nearness<'w> {
    /// Returns the position of a vertex.
    pub(crate) position: &'w dyn Fn(u32) -> [f64; 3],
    /// Largest distance between vertices that coincide.
    pub(crate) tolerance: f64,
    /// Whether two points are at most the tolerance apart, exactly.
    pub(crate) are_near: &'w dyn Fn([f64; 3], [f64; 3]) -> bool,
}

/// Finds the vertices to weld: pairs of one that stays and one that becomes it, sorted by the
/// second.
///
/// Of all vertices that become one, the lowest stays. Returns `None` if `stop` returned true. Cost:
/// O(m log m). Sides that are all within the tolerance cost O(s g): s sides in g groups, each group
/// one pair of vertices.
pub(crate) fn coinciding(
    triangles: &[[u32; 3]],
    vertices: usize,
    near: &Nearness,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<[u32; 2]>> {
    // A boundary edge has one triangle.
    let SortedEdges { edges, .. } =
        SortedEdges::new(triangles, vertices, |count| count == 1, stop)?;
    let sides: Vec<[u32; 2]> = edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
    let classes = Classes::new(triangles, vertices, &edges, stop)?;
    drop(edges);
    let mut search = Search {
        near,
        stop,
        steps: 0,
        sides,
        nodes: Vec::new(),
        classes,
    };
    if !search.sides.is_empty() {
        search.build(0..search.sides.len())?;
        search.within(0)?;
    }
    Some(search.classes.pairs())
}

/// Most sides of a leaf in which all pairs are compared.
const FEW: usize = 8;

/// Node of the tree: the box round a run of sides, in six dimensions.
struct Node {
    lower: [f64; 6],
    upper: [f64; 6],
    below: Below,
}

/// Contents of a node.
enum Below {
    /// Sides that were not compared yet.
    Leaf(Range<usize>),
    /// Sides that were compared with each other, as the runs of their groups.
    Groups(Vec<Range<usize>>),
    /// Two children: the next node is the first, this is the second.
    Inner(usize),
}

/// Search for sides that coincide: a bounding volume hierarchy over points of six dimensions.
///
/// An edge is two *sides*, one for each direction: the positions of both ends, six coordinates. A
/// node so small that all its sides coincide is not divided further. Its sides are sorted into
/// *groups*, whose ends are one each; a new side is compared with one of each group. Two sides that
/// may not be welded never may later, since welded vertices stay so. So each two groups are asked
/// about once.
struct Search<'s> {
    near: &'s Nearness<'s>,
    stop: &'s dyn Fn() -> bool,
    /// Calls of [`go_on`](Self::go_on) so far.
    steps: u32,
    sides: Vec<[u32; 2]>,
    nodes: Vec<Node>,
    classes: Classes,
}

impl Search<'_> {
    /// Checks at every 256th call whether to stop; `None` if so.
    fn go_on(&mut self) -> Option<()> {
        self.steps = self.steps.wrapping_add(1);
        (!self.steps.is_multiple_of(256) || !(self.stop)()).then_some(())
    }

    /// Returns the point of six coordinates that a side is.
    fn at(&self, [a, b]: [u32; 2]) -> [f64; 6] {
        let [[a, b, c], [d, e, f]] = [a, b].map(self.near.position);
        [a, b, c, d, e, f]
    }

    /// Builds the tree over a run of sides, divided at the median along the widest axis.
    fn build(&mut self, sides: Range<usize>) -> Option<()> {
        self.go_on()?;
        let (mut lower, mut upper) = ([f64::INFINITY; 6], [f64::NEG_INFINITY; 6]);
        for &side in &self.sides[sides.clone()] {
            let at = self.at(side);
            for axis in 0..6 {
                lower[axis] = lower[axis].min(at[axis]);
                upper[axis] = upper[axis].max(at[axis]);
            }
        }
        let width = |axis: usize| upper[axis] - lower[axis];
        let widest = (1..6).fold(0, |most, axis| {
            if width(axis) > width(most) {
                axis
            } else {
                most
            }
        });
        let node = self.nodes.len();
        let below = Below::Leaf(sides.clone());
        self.nodes.push(Node {
            lower,
            upper,
            below,
        });
        if self.are_all_near(&self.nodes[node]) {
            // Whatever order the divisions above left: the lowest come first.
            self.sides[sides].sort_unstable();
        } else if sides.len() > FEW {
            let middle = sides.len() / 2;
            let position = self.near.position;
            let along = |&side: &[u32; 2]| position(side[widest / 3])[widest % 3];
            self.sides[sides.clone()].select_nth_unstable_by(middle, |a, b| {
                along(a).total_cmp(&along(b)).then(a.cmp(b))
            });
            self.build(sides.start..sides.start + middle)?;
            self.nodes[node].below = Below::Inner(self.nodes.len());
            self.build(sides.start + middle..sides.end)?;
        }
        Some(())
    }

    /// Whether every two sides in a node coincide.
    ///
    /// No coordinate of an end differs by more than half the tolerance, so a diagonal is less than
    /// 0.87 of it.
    fn are_all_near(&self, node: &Node) -> bool {
        let most = self.near.tolerance / 2.0;
        (0..6).all(|axis| node.upper[axis] - node.lower[axis] <= most)
    }

    /// Whether no side of one node coincides with one of the other.
    ///
    /// Differences are rounded, but never across the tolerance.
    fn are_apart(&self, a: &Node, b: &Node) -> bool {
        let gap = |axis: usize| (a.lower[axis] - b.upper[axis]).max(b.lower[axis] - a.upper[axis]);
        let tolerance = self.near.tolerance;
        let square = |first: usize| {
            let gaps = [first, first + 1, first + 2].map(|axis| gap(axis).max(0.0));
            gaps.iter().map(|gap| gap * gap).sum::<f64>()
        };
        // The factor covers all roundings, far from where squares are rounded to nothing.
        let most = tolerance * tolerance * (1.0 + 1e-9);
        (0..6).any(|axis| gap(axis) > tolerance)
            || most > 1e-290 && (square(0) > most || square(3) > most)
    }

    /// Whether two sides coincide: both ends do, one by one.
    fn coincide(&self, [a, b]: [u32; 2], [x, y]: [u32; 2]) -> bool {
        let are_near = |p: u32, q: u32| {
            let [p, q] = [p, q].map(self.near.position);
            let is_far = (0..3).any(|axis| (p[axis] - q[axis]).abs() > self.near.tolerance);
            !is_far && (p.map(f64::to_bits) == q.map(f64::to_bits) || (self.near.are_near)(p, q))
        };
        are_near(a, x) && are_near(b, y)
    }

    /// Compares all sides of a node with each other.
    fn within(&mut self, node: usize) -> Option<()> {
        let below = std::mem::replace(&mut self.nodes[node].below, Below::Inner(0));
        match below {
            Below::Inner(second) => {
                self.nodes[node].below = Below::Inner(second);
                self.within(node + 1)?;
                self.within(second)?;
                self.between(node + 1, second)
            }
            Below::Leaf(sides) => {
                let groups = if self.are_all_near(&self.nodes[node]) {
                    self.groups_of(sides)?
                } else {
                    for i in sides.clone() {
                        for j in i + 1..sides.end {
                            if self.coincide(self.sides[i], self.sides[j]) {
                                self.classes.join(self.sides[i], self.sides[j]);
                            }
                        }
                    }
                    sides.map(|side| side..side + 1).collect()
                };
                self.nodes[node].below = Below::Groups(groups);
                self.go_on()
            }
            Below::Groups(_) => Some(()),
        }
    }

    /// Welds sides that all coincide, as far as they may be, and sorts them by group. Returns the
    /// runs of the groups.
    fn groups_of(&mut self, sides: Range<usize>) -> Option<Vec<Range<usize>>> {
        let mut groups: Vec<Vec<[u32; 2]>> = Vec::new();
        for place in sides.clone() {
            let side = self.sides[place];
            let mut found = None;
            for (group, of_group) in groups.iter().enumerate() {
                self.go_on()?;
                if self.classes.join(of_group[0], side) {
                    found = Some(group);
                    break;
                }
            }
            match found {
                Some(group) => groups[group].push(side),
                None => groups.push(vec![side]),
            }
        }
        let mut end = sides.start;
        let ranges = groups.iter().map(|of_group| {
            let start = end;
            end += of_group.len();
            self.sides[start..end].copy_from_slice(of_group);
            start..end
        });
        Some(ranges.collect())
    }

    /// Compares the sides of two nodes, each of which was compared within before.
    fn between(&mut self, a: usize, b: usize) -> Option<()> {
        self.go_on()?;
        if self.are_apart(&self.nodes[a], &self.nodes[b]) {
            return Some(());
        }
        match (&self.nodes[a].below, &self.nodes[b].below) {
            (&Below::Inner(second), _) => {
                // The other node is the next to be divided.
                self.between(b, a + 1)?;
                self.between(b, second)
            }
            (_, &Below::Inner(second)) => {
                self.between(a, b + 1)?;
                self.between(a, second)
            }
            (Below::Groups(of_a), Below::Groups(of_b)) => {
                let (of_a, of_b) = (of_a.clone(), of_b.clone());
                for group in of_a {
                    for other in &of_b {
                        self.join_groups(group.clone(), other.clone())?;
                    }
                }
                Some(())
            }
            _ => Some(()),
        }
    }

    /// Welds two groups of sides, if they may be and a side of one coincides with one of the other.
    fn join_groups(&mut self, group: Range<usize>, other: Range<usize>) -> Option<()> {
        if !self
            .classes
            .may_join(self.sides[group.start], self.sides[other.start])
        {
            return Some(());
        }
        for i in group {
            self.go_on()?;
            for j in other.clone() {
                if self.coincide(self.sides[i], self.sides[j]) {
                    self.classes.join(self.sides[i], self.sides[j]);
                    return Some(());
                }
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::edges::edges_of;
    use super::super::topology::EMPTY;
    use super::*;
    use pliant_exact::distance::are_points_within;
    use pliant_oracle::{Random, compare_length};
    use std::cell::Cell;
    use std::cmp::Ordering;
    use std::collections::BTreeMap;

    /// Pairs that are welded, how often a position was asked for, and the most between two checks
    /// whether to stop.
    fn weld(
        triangles: &[[u32; 3]],
        positions: &[[f64; 3]],
        tolerance: f64,
    ) -> (Vec<[u32; 2]>, usize, usize) {
        let [asked, last, most] = [0, 0, 0].map(Cell::new);
        let position = |vertex: u32| {
            asked.set(asked.get() + 1);
            positions[vertex as usize]
        };
        let stop = || {
            most.set(most.get().max(asked.get() - last.get()));
            last.set(asked.get());
            false
        };
        let near = Nearness {
            position: &position,
            tolerance,
            are_near: &|p, q| are_points_within(&p, &q, tolerance),
        };
        let pairs = coinciding(triangles, positions.len(), &near, &stop);
        (pairs.expect("nobody stops it"), asked.get(), most.get())
    }

    fn pairs(triangles: &[[u32; 3]], positions: &[[f64; 3]], tolerance: f64) -> Vec<[u32; 2]> {
        weld(triangles, positions, tolerance).0
    }

    /// Strip of two squares, the second of which has vertices of its own where they meet.
    const APART: [[u32; 3]; 4] = [[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]];

    /// Positions of the strip, of squares as large as `scale`; the second is moved by `off` where
    /// they meet.
    fn strip(off: [f64; 3], scale: f64) -> [[f64; 3]; 8] {
        let [x, y, z] = off;
        let at = |x: f64, y: f64| [x * scale, y * scale, 0.0];
        [
            at(0.0, 0.0),
            at(0.0, 1.0),
            [0.0; 3],
            at(0.0, 1.0),
            [x, y, z],
            [x, scale + y, z],
            at(2.0, 0.0),
            at(2.0, 1.0),
        ]
    }

    #[test]
    fn edges_that_coincide_are_welded_up_to_the_tolerance_at_every_scale() {
        let welded = |off: [f64; 3], scale: f64, tolerance: f64| {
            let mut strip = strip(off, scale);
            for at in &mut strip[..2] {
                at[0] -= scale;
            }
            pairs(&APART, &strip, tolerance)
        };
        let both = [[2, 4], [3, 5]];
        let power = |exponent: i32| {
            let [a, b] = [exponent / 2, exponent - exponent / 2];
            2f64.powi(a) * 2f64.powi(b)
        };
        for exponent in [
            -1074, -1070, -1022, -1000, -538, -537, -300, -149, -40, 0, 100,
        ] {
            let by = power(exponent);
            let scale = by * 64.0;
            // 2, 3 and 6 are the sides of a box whose diagonal is 7.
            let off = [2.0 * by, 3.0 * by, 6.0 * by];
            assert_eq!(welded(off, scale, 7.0 * by), both, "{exponent}");
            assert!(
                welded(off, scale, (7.0 * by).next_down()).is_empty(),
                "{exponent}"
            );
            assert!(welded(off, scale, 0.0).is_empty(), "{exponent}");
            assert!(welded([0.0, 0.0, by], scale, 0.0).is_empty(), "{exponent}");
            assert_eq!(welded([0.0; 3], scale, 0.0), both, "{exponent}");
        }
        assert_eq!(welded([0.25, 0.0, 0.0], 1.0, 0.25), both);
        assert!(welded([0.25, 0.0, 0.0], 1.0, 0.25_f64.next_down()).is_empty());
        assert!(welded([0.0, 1.5e-162, 0.0], 1.0, 0.0).is_empty());
        assert_eq!(welded([-0.0, 0.0, -0.0], 1.0, 0.0), both);
        // Where squares are rounded to the smallest numbers there are.
        let near = [1.6e-162, 1.6e-162, 0.0];
        assert_eq!(welded(near, 1e-160, 2.3e-162), both);
        assert!(welded(near, 1e-160, 2.2e-162).is_empty());
    }

    #[test]
    fn points_are_as_far_apart_as_the_oracle_says() {
        let mut random = Random::new(47);
        let [mut near, mut far] = [0; 2];
        for round in 0..7_000 {
            let exponent = [-1074, -1060, -530, -520, -149, 0, 90][round % 7];
            let mut number = || {
                let x = f64::from(random.below(1 << 21)) - 2f64.powi(20);
                x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
            };
            let [p, q] = [0; 2].map(|_| [number(), number(), number()]);
            let way = [0, 1, 2].map(|axis| p[axis] - q[axis]);
            let most = way.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let parts = way.map(|x| x / most);
            let length = parts.iter().map(|x| x * x).sum::<f64>().sqrt() * most;
            for distance in [
                length.next_down(),
                length,
                length.next_up(),
                length * 1.1,
                0.0,
            ] {
                let distance = distance.max(0.0);
                let exact = compare_length(&[(1.0, p), (-1.0, q)], distance);
                let found = are_points_within(&p, &q, distance);
                assert_eq!(found, exact != Ordering::Greater, "{p:?} {q:?} {distance}");
                near += u32::from(found);
                far += u32::from(!found);
            }
        }
        assert!(near > 7_000 && far > 7_000, "{near} {far}");
    }

    #[test]
    fn vertices_alone_are_not_welded_and_no_triangle_is_lost() {
        // Both triangles meet in a point.
        let fan = [[0, 1, 2], [3, 4, 5]];
        let at = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let apart = [at, at.map(|at| at.map(|x| -x))].concat();
        assert!(pairs(&fan, &apart, 0.1).is_empty());
        // With a tolerance as large as all there is, triangles keep three corners.
        for tolerance in [0.0, 1.0, 10.0, 1e300] {
            let pairs = pairs(&fan, &[at, at].concat(), tolerance);
            assert_no_corner_is_lost(&fan, &pairs);
            assert_eq!(pairs.len(), 3);
        }
    }

    fn renamed(pairs: &[[u32; 2]], vertex: u32) -> u32 {
        let pair = pairs.binary_search_by_key(&vertex, |pair| pair[1]);
        pair.map_or(vertex, |at| pairs[at][0])
    }

    fn assert_no_corner_is_lost(triangles: &[[u32; 3]], pairs: &[[u32; 2]]) {
        for &[a, b, c] in triangles {
            let [x, y, z] = [a, b, c].map(|vertex| renamed(pairs, vertex));
            assert_eq!([a == b, b == c, c == a], [x == y, y == z, z == x]);
        }
    }

    /// Random meshes on a coarse lattice, in which much coincides. Welded vertices are connected by
    /// edges that coincide, and no other edges may be welded.
    #[test]
    fn all_is_welded_that_may_be() {
        let mut random = Random::new(48);
        let [mut welded, mut left, mut all_of_it] = [0; 3];
        for round in 0..1_500 {
            let vertices = 6 + random.below(40);
            let side = [2, 3, 9, 40][round % 4];
            let axes = [3, 1, 2][round % 3];
            let mut at = |axis| {
                if axis < axes {
                    f64::from(random.below(side))
                } else {
                    0.0
                }
            };
            let positions: Vec<[f64; 3]> = (0..vertices).map(|_| [at(0), at(1), at(2)]).collect();
            let soup = (0..vertices / 3).map(|it| [3 * it, 3 * it + 1, 3 * it + 2]);
            let mut triangles: Vec<[u32; 3]> = soup.collect();
            for _ in 0..random.below(4) {
                let [a, b, c] = [0; 3].map(|_| random.below(vertices));
                triangles.push([a, b, c]);
            }
            triangles.push(EMPTY);
            let tolerance = [0.0, 1.0, 1.5, 2.0, 50.0][round % 5];
            let pairs = pairs(&triangles, &positions, tolerance);
            triangles.pop();
            assert!(pairs.is_sorted_by_key(|pair| pair[1]));
            assert_no_corner_is_lost(&triangles, &pairs);

            // The reference compares all with all.
            let mut count: BTreeMap<[u32; 2], u32> = BTreeMap::new();
            for corners in &triangles {
                let mut edges: Vec<[u32; 2]> = edges_of(corners).collect();
                edges.sort_unstable();
                edges.dedup();
                edges
                    .into_iter()
                    .for_each(|edge| *count.entry(edge).or_default() += 1);
            }
            let edges = count.iter().filter(|(_, count)| **count == 1);
            let sides = edges.flat_map(|(&[a, b], _)| [[a, b], [b, a]]);
            let sides: Vec<[u32; 2]> = sides.collect();
            let near = |p: u32, q: u32| {
                let [p, q] = [p, q].map(|it| positions[it as usize]);
                (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum::<f64>() <= tolerance * tolerance
            };
            let of = |vertex: u32| renamed(&pairs, vertex);
            let share = |p: u32, q: u32| {
                let has = |corners: &[u32; 3], it: u32| corners.iter().any(|&at| of(at) == of(it));
                of(p) != of(q)
                    && triangles
                        .iter()
                        .any(|corners| has(corners, p) && has(corners, q))
            };
            let mut together: Vec<u32> = (0..vertices).collect();
            let mut free: Vec<u32> = (0..vertices).collect();
            for [a, b] in &sides {
                for [x, y] in &sides {
                    if !near(*a, *x) || !near(*b, *y) {
                        continue;
                    }
                    let are_one = of(*a) == of(*x) && of(*b) == of(*y);
                    left += u32::from(!are_one);
                    assert!(are_one || share(*a, *x) || share(*b, *y), "{round}");
                    for [p, q] in [[*a, *x], [*b, *y]] {
                        let join = |all: &mut Vec<u32>| {
                            let [p, q] = [all[p as usize], all[q as usize]];
                            let of_both = all.iter_mut().filter(|it| **it == p || **it == q);
                            of_both.for_each(|it| *it = p.min(q));
                        };
                        join(&mut free);
                        if are_one {
                            join(&mut together);
                        }
                    }
                }
            }
            let found: Vec<u32> = (0..vertices).map(of).collect();
            assert_eq!(found, together, "{round}");
            welded += pairs.len() as u32;
            // Where no triangle is in the way, it is everything that coincides.
            all_of_it += u32::from(found == free);
        }
        assert!(
            welded > 5_000 && left > 5_000 && all_of_it > 250,
            "{welded} {left} {all_of_it}"
        );
    }

    /// Triangles each with corners of its own.
    fn soup(count: usize, at: impl FnMut(usize) -> [f64; 3]) -> (Vec<[u32; 3]>, Vec<[f64; 3]>) {
        let triangles = (0..count as u32).map(|it| [3 * it, 3 * it + 1, 3 * it + 2]);
        (triangles.collect(), (0..3 * count).map(at).collect())
    }

    /// Four times as many triangles within a tolerance take little more than four times as long;
    /// checks are not far apart.
    #[test]
    fn the_work_is_in_proportion_to_the_mesh() {
        type Shape = fn(&mut Random) -> [f64; 3];
        fn unit(random: &mut Random) -> [f64; 3] {
            [(); 3].map(|()| f64::from(random.below(1 << 20)) / 2f64.powi(20))
        }
        let shapes: [(&str, Shape, f64); 6] = [
            ("one point", |_| [0.0; 3], 0.0),
            ("tolerance over all", unit, 100.0),
            ("several tolerances", unit, 0.3),
            ("apart", unit, 1e-9),
            (
                "two heaps, just too far apart",
                |random| unit(random).map(|x| (x > 0.5).into()),
                0.9,
            ),
            (
                "two places",
                |random| unit(random).map(|x| (x > 0.5).into()),
                0.0,
            ),
        ];
        for (name, shape, tolerance) in shapes {
            let work = [1_000, 4_000, 16_000].map(|count| {
                let mut random = Random::new(49);
                let (triangles, positions) = soup(count, |_| shape(&mut random));
                let (pairs, asked, between) = weld(&triangles, &positions, tolerance);
                assert_no_corner_is_lost(&triangles, &pairs);
                assert_eq!(pairs.is_empty(), name == "apart", "{name}");
                assert!(between < 2_000_000, "{name}: {between}");
                asked
            });
            println!("{name}: {work:?}");
            assert!(
                work[1] < 6 * work[0] && work[2] < 6 * work[1],
                "{name}: {work:?}"
            );
            assert!(work[2] < 16_000 * 1_000, "{name}: {work:?}");
        }
    }

    #[test]
    fn it_is_stopped_at_every_look() {
        let (triangles, positions) = soup(400, |it| [(it % 7) as f64, 0.0, 0.0]);
        let looks = Cell::new(0);
        let near = Nearness {
            position: &|vertex| positions[vertex as usize],
            tolerance: 0.0,
            are_near: &|p, q| p == q,
        };
        for allowed in 0.. {
            looks.set(0);
            let stop = || {
                looks.set(looks.get() + 1);
                looks.get() > allowed
            };
            if coinciding(&triangles, positions.len(), &near, &stop).is_some() {
                assert!(looks.get() <= allowed && allowed > 10, "{allowed}");
                break;
            }
            assert_eq!(looks.get(), allowed + 1);
        }
    }
}
