//! Curves: segments linked where they end on the same vertex, edge or triangle of both meshes.
//!
//! Idea: the *place* of an end is the smallest part of either mesh that holds it. That is a vertex,
//! the inside of an edge, or the inside of a triangle. Ends of two segments are in one place
//! exactly if these parts are the same. In general position that is an edge that goes through a
//! triangle, and the two triangles at the edge have a segment each.

use super::segments::{Segment, Segments};
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::Pair;
use crate::world::{Scalar, World};
use pliant_exact::{End, Feature};
use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::Range;

/// Curves in which pairs of triangles meet: their segments, linked.
///
/// Segments that end in the same place are linked. A place is a vertex, an edge or a triangle of
/// either mesh, so nothing is joined or parted by rounding. In general position it is an edge that
/// goes through a triangle. A curve then ends at the border of a mesh, or at a vertex that both
/// triangles share, and nowhere else.
///
/// Through a vertex, or along an edge, one rule holds. Pairs that meet in the same segment are one
/// segment, of the first of them. Where exactly two segments end in a place, the curve goes on.
/// Where more do, no rule can order them, and all end there, as
/// [`Branching`](CurveEnd::Branching). Nor does a curve go on at a vertex that both triangles have.
///
/// Triangles of one plane are in no curve, whether they overlap or touch: see
/// [`Segment::is_flat`]. Around an overlap a curve goes where other triangles meet its border.
/// Where surfaces touch in one point and no segment ends there, there is no curve either:
/// [`touching`](Self::touching). Triangles without area may end a curve, as several parts of the
/// mesh hold the same place.
///
/// ```
/// # use pliant::{Curves, Selection, World};
/// let mut world = World::<f64>::new();
/// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
/// world.add(&[[0, 1, 2]], &large)?;
/// let corners = [[0.0, 0.0, -1.0], [2.0, 0.0, 1.0], [-1.0, 2.0, 1.0], [-1.0, -2.0, 1.0]];
/// let top = world.add(&[[0, 2, 1], [0, 3, 2], [0, 1, 3]], &corners)?;
/// let of = Selection::Everything;
/// let mut pairs = world.intersections(of).all()?.to_vec();
/// // In which a body meets itself: triangles that share a vertex, too.
/// pairs.extend(world.adjacent_intersections(of).all()?.iter().map(|it| it.pair));
/// let mut curves = Curves::new();
/// curves.update(&world, &pairs)?;
/// let curve = curves.iter().next().unwrap();
/// assert!(curve.is_closed());
/// assert_eq!(curve.points().count(), 3);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Curves {
    segments: Segments,
    places: Places,
    is_taken: Vec<bool>,
    steps: Vec<Step>,
    all: Vec<Extent>,
}

/// A step along a curve: a segment of the list, from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Place of the segment in the list.
    pub segment: usize,
    /// Whether the curve runs from its second end to its first.
    pub is_reversed: bool,
    /// Whether the second triangle of the pair is on the first side of the curve.
    pub is_swapped: bool,
}

/// End of an open curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CurveEnd {
    /// No other segment goes on: at the border of a mesh, where surfaces begin to touch, or where a
    /// pair is not listed.
    Border,
    /// A vertex that both triangles have, however many segments end there.
    SharedVertex,
    /// A corner of a polygon in which triangles of one plane overlap.
    Overlap,
    /// A place from which three or more segments go.
    Branching,
}

#[derive(Clone, Debug)]
struct Extent {
    steps: Range<usize>,
    length: f64,
    ends: Option<[CurveEnd; 2]>,
    turns_over: bool,
}

/// A curve of intersection: segments, each beginning where the last ends.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'c> {
    segments: &'c Segments,
    steps: &'c [Step],
    extent: &'c Extent,
}

impl Curves {
    /// Without any pairs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Finds the curves in which these pairs meet in the present shapes of a world, and forgets all
    /// before. If it is refused, there are no curves.
    ///
    /// Give every pair once. Curves are in the order of their first segments in the list.
    ///
    /// Cost: that of [`Segments::update`], and some ten nanoseconds a pair.
    ///
    /// # Errors
    ///
    /// The errors of [`Segments::update`].
    pub fn update<S: Scalar, P: Copy + Into<Pair>>(
        &mut self,
        world: &World<S>,
        pairs: &[P],
    ) -> Result<(), Error> {
        self.all.clear();
        self.steps.clear();
        let done = self.segments.update(world, pairs);
        self.places.find(&self.segments);
        self.is_taken.clear();
        self.is_taken.resize(self.segments.len(), false);
        for start in 0..self.segments.len() {
            if self.places.of_ends[start] != [NONE; 2] && !self.is_taken[start] {
                self.trace(start);
            }
        }
        done
    }

    /// Where each pair meets, in the order of the list.
    pub fn segments(&self) -> &Segments {
        &self.segments
    }

    /// Number of curves.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is no curve.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// All curves.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Curve<'_>> {
        self.all.iter().map(|extent| Curve {
            segments: &self.segments,
            steps: &self.steps[extent.steps.clone()],
            extent,
        })
    }

    /// Places in the list of pairs that meet in one point, where no curve and no corner of an
    /// overlap is; one for each point.
    pub fn touching(&self) -> &[usize] {
        &self.places.touching
    }

    /// Follows a curve from one of its segments, whose direction and sides it has.
    fn trace(&mut self, start: usize) {
        let first = Step {
            segment: start,
            is_reversed: false,
            is_swapped: false,
        };
        let from = self.steps.len();
        self.is_taken[start] = true;
        self.steps.push(first);
        let mut turns_over = false;
        let forward = loop {
            let last = self.steps[self.steps.len() - 1];
            match self.places.next(last) {
                Ok(step) if step.segment == start => {
                    turns_over = step.is_swapped;
                    break None;
                }
                Ok(step) => {
                    self.is_taken[step.segment] = true;
                    self.steps.push(step);
                }
                Err(end) => break Some(end),
            }
        };
        let ends = forward.map(|last| {
            // Backward from the first segment; then all of that is turned.
            let middle = self.steps.len();
            let mut step = first.turned();
            let first = loop {
                match self.places.next(step) {
                    Ok(next) => {
                        self.is_taken[next.segment] = true;
                        self.steps.push(next.turned());
                        step = next;
                    }
                    Err(end) => break end,
                }
            };
            self.steps[middle..].reverse();
            let back = self.steps.len() - middle;
            self.steps[from..].rotate_right(back);
            [first, last]
        });
        let steps = from..self.steps.len();
        let lengths = self.steps[steps.clone()].iter().map(|step| {
            let [p, q] = step.ends(&self.segments).map(|end| end.point);
            let squares = (0..3).map(|axis| (q[axis] - p[axis]).powi(2));
            squares.sum::<f64>().sqrt()
        });
        self.all.push(Extent {
            length: lengths.sum(),
            steps,
            ends,
            turns_over,
        });
    }
}

impl Step {
    fn turned(self) -> Self {
        Self {
            is_reversed: !self.is_reversed,
            ..self
        }
    }

    /// The two ends of its segment, in the order of the curve.
    fn ends(self, segments: &Segments) -> [End; 2] {
        match *segments.ends_of(self.segment) {
            [p, q] if self.is_reversed => [q, p],
            [p, q] => [p, q],
            _ => [End::default(); 2],
        }
    }
}

impl<'c> Curve<'c> {
    /// Steps in order.
    ///
    /// It has the direction of the lowest of its segments, along n_0 x n_1, with the triangles of
    /// that pair on its two sides. On the other segments the sides go on from triangle to
    /// neighbour. If triangles at an edge are oriented alike, and surfaces do not only touch there,
    /// the curve runs along n_0 x n_1 everywhere. Here n_0 and n_1 are the normals of the two
    /// sides. On side 0, what is behind side 1 is on the left of the curve. On side 1, what is
    /// behind side 0 is on its right.
    pub fn steps(&self) -> &'c [Step] {
        self.steps
    }

    /// Whether it comes back to where it begins.
    pub fn is_closed(&self) -> bool {
        self.extent.ends.is_none()
    }

    /// Ends, first the one where it begins; none if it is closed.
    pub fn ends(&self) -> Option<[CurveEnd; 2]> {
        self.extent.ends
    }

    /// Sum of the lengths of its segments, rounded.
    pub fn length(&self) -> f64 {
        self.extent.length
    }

    /// Whether a closed curve comes back with its two sides exchanged. That happens only on meshes
    /// whose triangles are not oriented alike.
    pub fn turns_over(&self) -> bool {
        self.extent.turns_over
    }

    /// Points along it: where each step begins, and where the last ends unless it is closed.
    pub fn points(&self) -> impl Iterator<Item = [f64; 3]> + 'c {
        let (segments, is_closed) = (self.segments, self.is_closed());
        let ends = move |step: &Step| step.ends(segments).map(|end| end.point);
        let last = self
            .steps
            .last()
            .filter(|_| !is_closed)
            .map(move |step| ends(step)[1]);
        self.steps.iter().map(move |step| ends(step)[0]).chain(last)
    }

    /// The triangle on either side at a step of this curve: its body, its number, its vertices.
    ///
    /// Of a step that no pair has, all are [`u32::MAX`].
    pub fn sides(&self, step: &Step) -> [(BodyId, u32, [u32; 3]); 2] {
        let Some(Segment { pair, vertices, .. }) = self.segments.get(step.segment) else {
            return [(BodyId(u32::MAX), u32::MAX, [u32::MAX; 3]); 2];
        };
        let of = [
            (pair.body_a, pair.triangle_a, vertices[0]),
            (pair.body_b, pair.triangle_b, vertices[1]),
        ];
        let first = usize::from(step.is_swapped);
        [of[first], of[1 - first]]
    }

    /// Where a step begins and ends, in the order of the curve, on the features of either side.
    pub fn ends_of(&self, step: &Step) -> [End; 2] {
        let turned = |end: End| End {
            on: [end.on[1], end.on[0]],
            parameter: [end.parameter[1], end.parameter[0]],
            ..end
        };
        let ends = step.ends(self.segments);
        if step.is_swapped {
            ends.map(turned)
        } else {
            ends
        }
    }
}

/// Places in which ends of segments are, and what else is there.
#[derive(Clone, Debug, Default)]
struct Places {
    names: Names,
    /// Places of both ends of all segments so far, as one number.
    seen: HashSet<u64, Fast>,
    /// The places of both ends of each segment, `NONE` for what is no segment.
    of_ends: Vec<[Name; 2]>,
    all: Vec<Place>,
    touching: Vec<usize>,
}

/// Number of a place, and whether the first triangle's part of the mesh is the higher of its two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Name {
    place: u32,
    is_turned: bool,
}

const NONE: Name = Name {
    place: u32::MAX,
    is_turned: false,
};

#[derive(Clone, Copy, Debug, Default)]
struct Place {
    /// Number of segments that end here, and the first two: each a segment and which of its ends.
    count: u32,
    first: [(usize, usize); 2],
    is_shared_vertex: bool,
    is_of_overlap: bool,
}

impl Places {
    fn find(&mut self, segments: &Segments) {
        self.names.clear();
        self.seen.clear();
        self.of_ends.clear();
        self.of_ends.resize(segments.len(), [NONE; 2]);
        self.all.clear();
        self.touching.clear();
        for (number, segment) in segments.iter().enumerate() {
            match segment.ends {
                [p, q] if !segment.is_flat => {
                    let ends = [p, q].map(|end| self.name(&segment, end));
                    let [p, q] = ends.map(|name| u64::from(name.place));
                    if self.seen.insert(p.min(q) << 32 | p.max(q)) {
                        self.take(number, ends);
                    }
                }
                [] | [_] | [_, _] => {}
                corners => {
                    for corner in corners {
                        let name = self.name(&segment, corner);
                        self.all[name.place as usize].is_of_overlap = true;
                    }
                }
            }
        }
        // What is left are points, where no segment and no polygon has been.
        for (number, segment) in segments.iter().enumerate() {
            if let [point] = segment.ends {
                let before = self.all.len();
                self.name(&segment, point);
                if self.all.len() > before {
                    self.touching.push(number);
                }
            }
        }
    }

    /// Finds the place of an end, or makes it.
    fn name(&mut self, segment: &Segment, end: &End) -> Name {
        let Segment { pair, vertices, .. } = segment;
        let a = part(pair.body_a, pair.triangle_a, vertices[0], end.on[0]);
        let b = part(pair.body_b, pair.triangle_b, vertices[1], end.on[1]);
        let is_turned = a > b;
        let [low, high] = if is_turned { [b, a] } else { [a, b] };
        let bodies = u64::from(low.0.0) << 32 | u64::from(high.0.0);
        let place = *self
            .names
            .entry((bodies, low.1, high.1))
            .or_insert_with(|| {
                self.all.push(Place {
                    is_shared_vertex: a == b,
                    ..Place::default()
                });
                self.all.len() as u32 - 1
            });
        Name { place, is_turned }
    }

    fn take(&mut self, segment: usize, ends: [Name; 2]) {
        self.of_ends[segment] = ends;
        for (end, name) in ends.iter().enumerate() {
            let place = &mut self.all[name.place as usize];
            if let Some(first) = place.first.get_mut(place.count as usize) {
                *first = (segment, end);
            }
            place.count += 1;
        }
    }

    /// The step behind a step, or what the curve ends at.
    fn next(&self, step: Step) -> Result<Step, CurveEnd> {
        let far = usize::from(!step.is_reversed);
        let here = self.of_ends[step.segment][far];
        let place = &self.all[here.place as usize];
        if place.is_shared_vertex {
            return Err(CurveEnd::SharedVertex);
        }
        match place.count {
            2 => {
                let [one, other] = place.first;
                let (segment, end) = if one == (step.segment, far) {
                    other
                } else {
                    one
                };
                let there = self.of_ends[segment][end];
                Ok(Step {
                    segment,
                    is_reversed: end == 1,
                    is_swapped: step.is_swapped ^ here.is_turned ^ there.is_turned,
                })
            }
            3.. => Err(CurveEnd::Branching),
            _ if place.is_of_overlap => Err(CurveEnd::Overlap),
            _ => Err(CurveEnd::Border),
        }
    }
}

/// Smallest part of a mesh that holds a point: a vertex twice, two vertices of an edge, or a
/// triangle and no vertex.
fn part(body: BodyId, triangle: u32, vertices: [u32; 3], on: Feature) -> (BodyId, u64) {
    let [x, y] = match on {
        Feature::Corner(i) => [vertices[i]; 2],
        Feature::Edge(i) => {
            let [p, q] = [vertices[i], vertices[(i + 1) % 3]];
            [p.min(q), p.max(q)]
        }
        Feature::Inside => [triangle, u32::MAX],
    };
    (body, u64::from(x) << 32 | u64::from(y))
}

/// Numbers of places, by the bodies and the parts of both meshes.
type Names = HashMap<(u64, u64, u64), u32, Fast>;

type Fast = BuildHasherDefault<Multiplied>;

/// Hash of a few whole numbers. Nobody gains by making it slow: its keys are numbers of mesh parts.
#[derive(Default)]
struct Multiplied(u64);

impl Hasher for Multiplied {
    fn write(&mut self, bytes: &[u8]) {
        bytes
            .iter()
            .for_each(|&byte| self.write_u64(u64::from(byte)));
    }

    fn write_u64(&mut self, number: u64) {
        self.0 = (self.0.rotate_left(23) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn finish(&self) -> u64 {
        self.0.rotate_left(26)
    }
}
