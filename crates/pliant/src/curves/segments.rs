//! Segments: where each pair of a list meets.

use crate::error::Error;
use crate::queries::Pair;
use crate::world::{NamedBodies, Scalar, World};
use pliant_exact::{End, Point, Precision, intersection};
use std::ops::Range;

/// Where pairs of triangles meet: for each pair of a list a point, a segment or a polygon.
///
/// The pairs may come from any question. Two triangles that share an edge, and meet nowhere else,
/// meet in that. Each end of a segment is on a corner, on an edge or inside of either triangle, and
/// which is exact. Its coordinates are rounded: they are off by at most 2^-38 of the edge on which
/// it lies, and by four roundings. [`Curves`](crate::Curves) links segments.
///
/// ```
/// # use pliant::{Feature, Segments, Selection, World};
/// let mut world = World::new();
/// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
/// let floor = world.add(&[[0, 1, 2]], &large)?;
/// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, -1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
/// let pairs = world.intersections(Selection::Between(floor, leaf)).all()?.to_vec();
/// let mut segments = Segments::new();
/// segments.update(&world, &pairs)?;
/// let ends = segments.iter().next().unwrap().ends;
/// assert_eq!(ends[1].on, [Feature::Inside, Feature::Edge(0)]);
/// assert_eq!(ends[1].point, [0.5, 0.0, 0.0]);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Segments {
    rows: Vec<Row>,
    /// Ends of all pairs, one pair after the other.
    ends: Vec<End>,
}

/// A [`Segment`], with the places of its ends.
#[derive(Clone, Debug)]
struct Row {
    pair: Pair,
    vertices: [[u32; 3]; 2],
    normals: [Point; 2],
    is_flat: bool,
    /// Places of its ends.
    ends: Range<usize>,
}

/// Where a pair of triangles meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<'s> {
    /// The two triangles, in the order in which they were given.
    pub pair: Pair,
    /// One point, the two ends of a segment, or three to six corners of a polygon in order around
    /// it. None, if they do not meet.
    ///
    /// A segment runs along n_a x n_b, the cross product of the normals.
    pub ends: &'s [End],
    /// Whether the triangles lie in one plane; always, if neither has an area.
    pub is_flat: bool,
    /// Unit normals of both triangles, (b - a) x (c - a) at length 1. Of a triangle without area it
    /// says nothing.
    pub normals: [[f64; 3]; 2],
    /// Vertices of both triangles, by the caller's numbers.
    pub vertices: [[u32; 3]; 2],
}

impl Segments {
    /// Without any pairs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Says where these pairs meet in the present shapes of a world, and forgets all before. If it
    /// is refused, there are no segments.
    ///
    /// Cost: O(n) for the bodies named, and some hundred nanoseconds a pair.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`NoSuchTriangle`](crate::ErrorKind::NoSuchTriangle),
    /// [`EmptyTriangle`](crate::ErrorKind::EmptyTriangle).
    pub fn update<S: Scalar, P: Copy + Into<Pair>>(
        &mut self,
        world: &World<S>,
        pairs: &[P],
    ) -> Result<(), Error> {
        self.rows.clear();
        self.ends.clear();
        let done = self.meet(world, pairs);
        if done.is_err() {
            self.rows.clear();
            self.ends.clear();
        }
        done
    }

    fn meet<S: Scalar, P: Copy + Into<Pair>>(
        &mut self,
        world: &World<S>,
        pairs: &[P],
    ) -> Result<(), Error> {
        let pairs = pairs.iter().map(|&pair| pair.into());
        let named = pairs.clone().flat_map(|pair| [pair.body_a, pair.body_b]);
        let bodies = NamedBodies::of(world, named)?;
        for pair in pairs {
            let of = [
                (pair.body_a, pair.triangle_a),
                (pair.body_b, pair.triangle_b),
            ];
            let mut vertices = [[0; 3]; 2];
            let mut corners = [[[0.0; 3]; 3]; 2];
            for side in 0..2 {
                let (body, triangle) = of[side];
                vertices[side] = bodies.corners(body, triangle)?;
                corners[side] = bodies.points(body, vertices[side])?;
            }
            let [a, b] = &corners;
            let both = intersection(Precision::Double, a, b);
            let start = self.ends.len();
            self.ends.extend(both.ends());
            self.rows.push(Row {
                pair,
                vertices,
                normals: [normal(a), normal(b)],
                is_flat: both.is_flat(),
                ends: start..self.ends.len(),
            });
        }
        Ok(())
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Where a pair meets, by its place in the list.
    pub fn get(&self, place: usize) -> Option<Segment<'_>> {
        self.rows.get(place).map(|row| self.segment(row))
    }

    /// Where all pairs meet, in the order of the list.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Segment<'_>> {
        self.rows.iter().map(|row| self.segment(row))
    }

    fn segment(&self, row: &Row) -> Segment<'_> {
        Segment {
            pair: row.pair,
            ends: &self.ends[row.ends.clone()],
            is_flat: row.is_flat,
            normals: row.normals,
            vertices: row.vertices,
        }
    }

    /// The ends of a pair, by its place in the list; none behind the list.
    pub(super) fn ends_of(&self, place: usize) -> &[End] {
        let row = self.rows.get(place);
        row.map_or(&[], |row| &self.ends[row.ends.clone()])
    }

    /// Ends of all pairs, one pair after the other.
    pub fn ends(&self) -> &[End] {
        &self.ends
    }
}

/// Unit normal of a triangle; zero if it has no area.
pub(super) fn normal([a, b, c]: &[Point; 3]) -> Point {
    let [e, f] = [b, c].map(|corner| [0, 1, 2].map(|axis| corner[axis] - a[axis]));
    // Scaled, so that no product is too small or too large.
    let size = |v: &Point| v.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    let (of_e, of_f) = (size(&e), size(&f));
    let [e, f] = [e.map(|x| x / of_e), f.map(|x| x / of_f)];
    let n = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        e[j] * f[k] - e[k] * f[j]
    });
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 {
        n.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}
