//! Places where surfaces touch but none passes through another: along a cut, or where parts lie on
//! each other.
//!
//! The test follows all contacts of a place and asks on which side of each surface the other is.
//! Signs of orientation answer exactly. A place *only touches* if no two triangles cross, and of no
//! two patches one is both in front of and behind the other. A surface that passes through another
//! is always found. A place is also kept where sides are unclear.

use crate::joined::{Joined, Meshes};
use crate::pieces::NONE;
use crate::row::Row;
use pliant::ContactKind;
use pliant::exact::side_of_plane;
use std::cmp::Ordering::{self, Equal, Greater};
use std::collections::HashMap;

type Point = [f64; 3];

/// Memory for a pair besides the pair itself, in bytes.
pub(crate) const BYTES_OF_TOUCHING: usize = 16;

/// Whether each pair is of a place where surfaces only touch.
///
/// `pairs` are all pairs of a frame, in terms of sources.
///
/// # Along segments
///
/// That no triangles cross is not enough. A surface can pass through another exactly at edges and
/// vertices: a box pushed into a block, both of unit cells.
///
/// Say no two triangles cross. Around a point of contact each surface is a fan of triangles: seen
/// from there, a closed curve on a sphere. The two curves do not cross inside their arcs. So a
/// surface changes sides only after it lies on the other. There the two have a *segment* in common.
/// Without a segment they touch in a point, which nothing can pass through. So only segments count.
/// A segment is the part of a triangle's edge inside another triangle, or on an edge of it. (Inside
/// both, the triangles would cross.)
///
/// # Around a segment
///
/// Each surface is one or two half-planes around a segment:
///
/// - at an edge, the half-planes of its triangles
/// - inside a triangle, its two halves
///
/// Two half-planes divide space into a side in front, to which the normals point, and a side
/// behind. Each half-plane of the other surface is in front, behind, or on the surface. A single
/// half-plane, at a boundary edge, divides nothing: along a cut through a sheet both surfaces end.
///
/// # Along the whole contact
///
/// The side has to be the same along the whole contact. A sheet may come from the front, lie on
/// another, and leave it behind. A *patch* is a set of triangles connected through edges, taken to
/// turn the same way round. A connected contact lies in one patch of either surface, since all
/// triangles around vertices of hits are examined. So a surface that passes through is always seen.
///
/// The reverse does not hold. Two unrelated contacts can be of one place and the same patches, on
/// different sides. Such a place is kept.
///
/// # Unclear sides
///
/// A place is kept with a triangle without area, or along an edge of more than two triangles. It is
/// kept where a patch cannot turn one way round (a Möbius strip), or is folded onto itself.
///
/// # Cost
///
/// Up to 200 bytes for each triangle around a vertex of a hit, and 32 for each pair. Linear time in
/// these, and in the triangles of sources with hits.
pub(crate) fn only_touch(meshes: &impl Meshes, pairs: &[(Row, ContactKind)]) -> Vec<bool> {
    let mut hits = Joined::default();
    // A pair that the meshes lack has no place, and is not left out.
    let mut place_of: Vec<u32> = pairs
        .iter()
        .map(|&(row, _)| hits.join(meshes, row).unwrap_or(NONE))
        .collect();
    for place in place_of.iter_mut().filter(|place| **place != NONE) {
        *place = hits.root(*place);
    }
    let mut is_kept = vec![false; hits.vertices().len()];
    let with_places = || {
        let pairs = pairs.iter().zip(&place_of);
        let pairs = pairs.filter(|&(_, &place)| place != NONE);
        pairs.map(|(&(row, kind), &place)| (row, kind, place as usize))
    };
    for (row, kind, place) in with_places() {
        is_kept[place] |= kind == ContactKind::Crossing || has_no_area(meshes, row);
    }
    let mut surfaces = Surfaces::of(meshes, &mut hits, &is_kept);
    for (row, _, place) in with_places() {
        is_kept[place] = is_kept[place] || surfaces.meet(meshes, row).is_err();
    }
    let is_left_out = |&place: &u32| place != NONE && !is_kept[place as usize];
    place_of.iter().map(is_left_out).collect()
}

fn has_no_area(meshes: &impl Meshes, [source_a, a, source_b, b]: Row) -> bool {
    [(source_a, a), (source_b, b)]
        .iter()
        .any(|&(source, triangle)| pliant::exact::is_degenerate(points(meshes, source, triangle)))
}

fn points(meshes: &impl Meshes, source: u32, triangle: u32) -> [Point; 3] {
    let corners = meshes.corners(source, triangle);
    corners.map(|vertex| meshes.position(source, vertex))
}

/// Verdict that a place is kept: a surface passes through another, or sides are unclear.
struct Passes;

/// Triangles around places that may only touch, with their patches and sides.
struct Surfaces {
    /// Number of each triangle, by source and triangle.
    numbers: HashMap<[u32; 2], u32>,
    /// Triangles at each [`edge`] with a vertex of a hit.
    edges: HashMap<[u32; 3], Faces>,
    patches: Patches,
    /// For a patch and one that touches it: whether the second is anywhere in front of the first,
    /// and behind it.
    sides: HashMap<[u32; 2], [bool; 2]>,
}

/// Triangles at an edge: their number, and up to two of them.
#[derive(Default)]
struct Faces {
    count: usize,
    some: [u32; 2],
}

impl Faces {
    fn add(&mut self, triangle: u32) {
        if let Some(place) = self.some.get_mut(self.count) {
            *place = triangle;
        }
        self.count += 1;
    }
}

/// A half-plane, bounded by a line.
#[derive(Clone, Copy)]
struct Half {
    /// A point of the half-plane that is not on the line.
    apex: Point,
    /// Whether the line has the direction in which the triangle turns.
    is_forward: bool,
}

/// Surface around a segment: one or two half-planes.
struct Around {
    /// Number of one of its triangles.
    triangle: u32,
    first: Half,
    /// `None` at a boundary edge.
    second: Option<Half>,
}

impl Surfaces {
    /// Collects all triangles around the vertices of places that are not kept.
    fn of(meshes: &impl Meshes, hits: &mut Joined, is_kept: &[bool]) -> Self {
        let slots = 0..hits.vertices().len() as u32;
        let is_open: Vec<bool> = slots
            .map(|slot| !is_kept[hits.root(slot) as usize])
            .collect();
        let is_open = |source, vertex| {
            let slot = hits.slot(source, vertex);
            slot.is_some_and(|slot| is_open[slot as usize])
        };
        let vertices = hits.vertices().iter();
        let mut sources: Vec<u32> = vertices
            .filter(|&&[source, vertex]| is_open(source, vertex))
            .map(|&[source, _]| source)
            .collect();
        sources.sort_unstable();
        sources.dedup();
        let mut numbers = HashMap::new();
        let mut edges: HashMap<[u32; 3], Faces> = HashMap::new();
        for source in sources {
            let [_, triangles] = meshes.sizes(source);
            for triangle in 0..triangles as u32 {
                let corners = meshes.corners(source, triangle);
                if !corners.iter().any(|&it| is_open(source, it)) {
                    continue;
                }
                numbers.insert([source, triangle], numbers.len() as u32);
                for (p, q) in sides_of(corners) {
                    // Other edges do not have all their triangles here.
                    if is_open(source, p) || is_open(source, q) {
                        edges.entry(edge(source, p, q)).or_default().add(triangle);
                    }
                }
            }
        }
        let mut patches = Patches::of(numbers.len());
        for (&[source, p, q], faces) in edges.iter().filter(|(_, faces)| faces.count == 2) {
            let [one, other] = faces.some.map(|it| numbers[&[source, it]]);
            let ways = faces
                .some
                .map(|it| runs_along(meshes.corners(source, it), p, q));
            patches.join(one, other, ways[0] == ways[1]);
        }
        Self {
            numbers,
            edges,
            patches,
            sides: HashMap::new(),
        }
    }

    /// Notes the sides along all segments that two triangles have in common.
    fn meet(&mut self, meshes: &impl Meshes, row: Row) -> Result<(), Passes> {
        let [source_a, a, source_b, b] = row;
        let [of_a, of_b] = [[source_a, a], [source_b, b]];
        for (own, other) in [(of_a, of_b), (of_b, of_a)] {
            let [source, triangle] = own;
            let plane = points(meshes, other[0], other[1]);
            for (from, to) in sides_of(meshes.corners(source, triangle)) {
                let line = [from, to].map(|vertex| meshes.position(source, vertex));
                if line.iter().any(|&end| side_of_plane(plane, end) != Equal) {
                    continue;
                }
                let along = sides_of(meshes.corners(other[0], other[1]))
                    .into_iter()
                    .find(|&(p, q)| {
                        let ends = [p, q].map(|vertex| meshes.position(other[0], vertex));
                        ends.iter()
                            .all(|&end| pliant::exact::is_degenerate([line[0], line[1], end]))
                    });
                let around = match along {
                    // Two edges on one line come twice; the first is enough.
                    Some(edge) if own == of_a => {
                        let ends = [edge.0, edge.1].map(|it| meshes.position(other[0], it));
                        overlap(line, ends)
                            .then(|| self.around_edge(meshes, other, edge, line))
                            .transpose()?
                    }
                    Some(_) => None,
                    None => halves(plane, line).map(|[first, second]| Around {
                        triangle: self.numbers[&other],
                        first,
                        second: Some(second),
                    }),
                };
                if let Some(around) = around {
                    let own = self.around_edge(meshes, own, (from, to), line)?;
                    self.note(line, &own, &around)?;
                    self.note(line, &around, &own)?;
                }
            }
        }
        Ok(())
    }

    /// Surface around an edge of a triangle. The edge lies on `line`.
    fn around_edge(
        &self,
        meshes: &impl Meshes,
        [source, triangle]: [u32; 2],
        (p, q): (u32, u32),
        line: [Point; 2],
    ) -> Result<Around, Passes> {
        let faces = &self.edges[&edge(source, p, q)];
        let ends = [p, q].map(|vertex| meshes.position(source, vertex));
        let is_same_way = is_same_way(line, ends);
        let half = |triangle| {
            let corners = meshes.corners(source, triangle);
            let apex = corners
                .into_iter()
                .find(|&it| it != p && it != q)
                .unwrap_or(p);
            let apex = meshes.position(source, apex);
            let has_area = !pliant::exact::is_degenerate([ends[0], ends[1], apex]);
            let is_forward = runs_along(corners, p, q) == is_same_way;
            has_area.then_some(Half { apex, is_forward }).ok_or(Passes)
        };
        let other = match faces.count {
            1 => None,
            2 => faces.some.into_iter().find(|&it| it != triangle),
            _ => return Err(Passes),
        };
        Ok(Around {
            triangle: self.numbers[&[source, triangle]],
            first: half(triangle)?,
            second: other.map(half).transpose()?,
        })
    }

    /// Notes on which sides of `base` the surface `other` is, around a line.
    fn note(&mut self, line: [Point; 2], base: &Around, other: &Around) -> Result<(), Passes> {
        let Some(second) = base.second else {
            return Ok(());
        };
        let (base_patch, is_turned) = self.patches.patch(base.triangle)?;
        let (other_patch, _) = self.patches.patch(other.triangle)?;
        let noted = self.sides.entry([base_patch, other_patch]).or_default();
        for half in [Some(other.first), other.second].into_iter().flatten() {
            let sector = sector(line, [base.first.apex, second.apex], half.apex);
            let is_in_front = match sector {
                Sector::On => continue,
                Sector::Folded => return Err(Passes),
                Sector::Between => base.first.is_forward,
                Sector::Outside => !base.first.is_forward,
            };
            noted[usize::from(is_in_front == is_turned)] = true;
        }
        if *noted == [true; 2] {
            return Err(Passes);
        }
        Ok(())
    }
}

/// Patches: union-find with parity over triangles connected through edges.
///
/// The parity says whether two triangles turn in different directions.
struct Patches {
    /// Parent of each triangle, and whether the two turn differently.
    parents: Vec<(u32, bool)>,
    /// Whether the patch of a root cannot turn one way round.
    has_one_side: Vec<bool>,
}

impl Patches {
    fn of(count: usize) -> Self {
        Self {
            parents: (0..count as u32).map(|it| (it, false)).collect(),
            has_one_side: vec![false; count],
        }
    }

    fn find(&mut self, mut triangle: u32) -> (u32, bool) {
        let mut is_turned = false;
        loop {
            let (parent, turns) = self.parents[triangle as usize];
            if parent == triangle {
                return (triangle, is_turned);
            }
            let (next, parent_turns) = self.parents[parent as usize];
            self.parents[triangle as usize] = (next, turns != parent_turns);
            is_turned ^= turns != parent_turns;
            triangle = next;
        }
    }

    fn join(&mut self, a: u32, b: u32, turn_differently: bool) {
        let ((a, is_a_turned), (b, is_b_turned)) = (self.find(a), self.find(b));
        let turns = (is_a_turned != is_b_turned) != turn_differently;
        if a == b {
            self.has_one_side[a as usize] |= turns;
        } else {
            self.parents[b as usize] = (a, turns);
            self.has_one_side[a as usize] |= self.has_one_side[b as usize];
        }
    }

    /// Root of a triangle's patch, and whether the triangle turns against it.
    fn patch(&mut self, triangle: u32) -> Result<(u32, bool), Passes> {
        let (patch, is_turned) = self.find(triangle);
        if self.has_one_side[patch as usize] {
            return Err(Passes);
        }
        Ok((patch, is_turned))
    }
}

/// Position of a half-plane relative to two others around the same line.
enum Sector {
    /// On one of the two.
    On,
    /// Between the first and the second, in the direction in which the line turns.
    Between,
    /// Between the second and the first.
    Outside,
    /// Undefined, since the two are one: a fold.
    Folded,
}

/// Sector of the half-plane through `apex`.
fn sector([s, t]: [Point; 2], [first, second]: [Point; 2], apex: Point) -> Sector {
    // Greater: less than half a turn leads from the first half-plane to the second.
    let turn = |from: Point, to: Point| side_of_plane([s, t, from], to);
    let is_same = |one: Point, other: Point| {
        let beside = beside_plane([s, t, one]);
        turn(one, other) == Equal && turn(one, beside) == turn(other, beside)
    };
    let is_between = |from: Point, to: Point| turn(from, apex).is_gt() && turn(apex, to).is_gt();
    if is_same(first, second) {
        return Sector::Folded;
    }
    if is_same(first, apex) || is_same(second, apex) {
        return Sector::On;
    }
    let is_inside = match turn(first, second) {
        Greater => is_between(first, second),
        Ordering::Less => !is_between(second, first),
        Equal => turn(first, apex).is_gt(),
    };
    if is_inside {
        Sector::Between
    } else {
        Sector::Outside
    }
}

/// A point outside the plane of a triangle with area.
fn beside_plane(triangle: [Point; 3]) -> Point {
    let moved = |axis: usize| {
        let mut point = triangle[0];
        let further = point[axis] + 1.0;
        // A number that adding 1 leaves unchanged is not 0.
        point[axis] = if further == point[axis] { 0.0 } else { further };
        point
    };
    // A plane with all three would contain a corner of space.
    let mut points = [0, 1, 2].map(moved).into_iter();
    points
        .find(|&point| side_of_plane(triangle, point) != Equal)
        .unwrap_or(triangle[0])
}

/// Halves of a triangle at a line in its plane, if the segment [s, t] of the line lies partly
/// inside.
///
/// A segment misses the inside of a convex polygon in two cases. It is on the outer closed side of
/// an edge, or the polygon is on one closed side of its line.
fn halves(triangle: [Point; 3], [s, t]: [Point; 2]) -> Option<[Half; 2]> {
    let beside = beside_plane(triangle);
    let way = side_of_plane(triangle, beside);
    let side = |[from, to]: [Point; 2], point: Point| side_of_plane([from, to, point], beside);
    let [a, b, c] = triangle;
    let misses = |edge: [Point; 2]| [s, t].iter().all(|&end| side(edge, end) != way);
    if [[a, b], [b, c], [c, a]].into_iter().any(misses) {
        return None;
    }
    let on = |wanted: Ordering| triangle.into_iter().find(|&it| side([s, t], it) == wanted);
    let half = |apex: Point, is_forward: bool| Half { apex, is_forward };
    Some([half(on(way)?, true), half(on(way.reverse())?, false)])
}

/// Whether two segments on one line have more than a point in common.
fn overlap(one: [Point; 2], other: [Point; 2]) -> bool {
    let axis = main_axis(one);
    let [one, other] = [one, other].map(|[a, b]| [a[axis].min(b[axis]), a[axis].max(b[axis])]);
    one[0].max(other[0]) < one[1].min(other[1])
}

/// Whether two segments on one line have the same direction.
fn is_same_way(one: [Point; 2], other: [Point; 2]) -> bool {
    let axis = main_axis(one);
    let is_up = |[a, b]: [Point; 2]| a[axis] < b[axis];
    is_up(one) == is_up(other)
}

/// An axis along which the ends of a segment differ.
fn main_axis([s, t]: [Point; 2]) -> usize {
    (0..3).find(|&axis| s[axis] != t[axis]).unwrap_or(0)
}

/// Key of an edge: source, smaller vertex, larger vertex.
fn edge(source: u32, p: u32, q: u32) -> [u32; 3] {
    [source, p.min(q), p.max(q)]
}

/// Directed edges of a triangle.
fn sides_of([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Whether a triangle has the directed edge `from` to `to`.
fn runs_along(corners: [u32; 3], from: u32, to: u32) -> bool {
    sides_of(corners).contains(&(from, to))
}

#[cfg(test)]
mod tests;
