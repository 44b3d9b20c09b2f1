//! Frames of a motion, as a recorder keeps them.

use crate::label::BodyLabel;
use pliant::{BodyId, End, Feature, Scalar};

/// Bodies in motion, as a page can hold them: numbers for every frame, shapes for some.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Numbers of bodies, vertices and triangles.
    pub(crate) sizes: [usize; 3],
    pub(crate) bodies: Vec<BodyRecord>,
    /// Numbers of all frames.
    pub(crate) numbers: Vec<u32>,
    /// Number of intersecting pairs in each frame.
    pub(crate) pairs: Vec<u64>,
    /// Least and largest depth of places in all frames.
    pub(crate) depths: Option<[f64; 2]>,
    /// Kept frames, ascending.
    pub(crate) frames: Vec<Frame>,
    /// Whether not even a few frames fit into a page; then there are no bodies and no frames.
    pub(crate) too_large: bool,
}

/// A body with one mesh. A body whose mesh changes has several records, with one number.
#[derive(Clone, Debug)]
pub(crate) struct BodyRecord {
    pub(crate) id: BodyId,
    /// Number of the body on the page, or of the first of its parts.
    pub(crate) number: u32,
    pub(crate) label: BodyLabel,
    pub(crate) vertices: usize,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Triangles in the order of the tree.
    pub(crate) order: Vec<u32>,
    /// Starts in `order` of the parts of each level.
    pub(crate) starts: Vec<Vec<u32>>,
}

/// One kept frame.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// Index among all frames, from 0.
    pub(crate) index: usize,
    /// Shape for each record; `None` if the body does not have that mesh in this frame.
    pub(crate) shapes: Vec<Option<Shape>>,
    pub(crate) hits: Hits,
    /// Triangles in `hits` that intersect none but are close to one, sorted.
    pub(crate) near: Vec<u32>,
    /// Gaps, nearest first; of very many, the nearest.
    pub(crate) gaps: Vec<GapShown>,
    /// Lines where pairs of `hits` meet; none if there are very many.
    pub(crate) lines: Vec<LineShown>,
    /// Triangles of places with a depth, sorted, each with that depth.
    pub(crate) deep: Vec<(u32, f64)>,
    /// Whether each box was made for this shape: by body, level and part.
    pub(crate) made: Vec<bool>,
    /// Places, most pairs first; of very many, the first.
    pub(crate) spots: Vec<Spot>,
    /// Number of all places.
    pub(crate) all_spots: usize,
    /// Impacts behind a frame, if this is a moment between frames. The bodies then are where they
    /// are in the next frame.
    pub(crate) moment: Option<Moment>,
}

/// Impacts on the way from a frame to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Number of the next frame.
    pub until: u32,
    /// Number of impacts; `None` if only the first was searched.
    pub count: Option<usize>,
    /// Impacts, the earliest first. Of very many, the page keeps the first.
    pub contacts: Vec<Contact>,
}

/// Impact of two elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Time of impact, from 0 in the frame to 1 in the next.
    pub time: f64,
    /// The two elements.
    pub elements: Elements,
}

/// A pair of elements.
///
/// Bodies are numbered consecutively, split ones part by part. Vertices and triangles are numbered
/// as in the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elements {
    /// A vertex and a triangle: body, vertex, body, triangle.
    VertexTriangle([u32; 4]),
    /// Two edges: body and two vertices, twice.
    EdgeEdge([u32; 6]),
}

/// A place: a connected region of intersecting pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// Number of the place, the same in every frame of its life.
    pub number: usize,
    /// Number of pairs.
    pub count: usize,
    /// Lower corner of its box.
    pub lower: [f64; 3],
    /// Upper corner.
    pub upper: [f64; 3],
    /// How deep one body is inside another there, if known. The page colours places by depth.
    pub depth: Option<f64>,
    /// Label with the names of its bodies. It may contain any text.
    pub label: String,
}

/// Closest points of two triangles that are close and do not intersect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The pair: body, triangle, body, triangle.
    pub pair: [u32; 4],
    /// Distance of the triangles.
    pub distance: f64,
    /// A closest point of each triangle.
    pub points: [[f64; 3]; 2],
}

/// A gap, with the triangles of all bodies numbered consecutively.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GapShown {
    pub(crate) triangles: [u32; 2],
    pub(crate) points: [[f64; 3]; 2],
}

/// A line where two triangles meet, numbered consecutively through all bodies.
///
/// Its ends are not points but places on the triangles, which the page draws with rounded corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineShown {
    pub(crate) triangles: [u32; 2],
    /// Features on which the ends are. Corners of the first triangle are 0 to 2, its edges 3 to 5;
    /// from 6 on come the second one's.
    pub(crate) on: [u8; 2],
    /// Part of the way along an edge, in steps of 1/65,535.
    pub(crate) parts: [u16; 2],
}

impl LineShown {
    pub(crate) fn new(triangles: [u32; 2], ends: [End; 2]) -> Self {
        let on = |end: End| {
            let side = usize::from(end.on[0] == Feature::Inside);
            let part = end.parameter[side].unwrap_or_default();
            let on = 6 * side as u8 + u8::from(end.on[side]);
            (on, (part * 65_535.0).round() as u16)
        };
        let [(on_p, part_p), (on_q, part_q)] = ends.map(on);
        Self {
            triangles,
            on: [on_p, on_q],
            parts: [part_p, part_q],
        }
    }
}

/// Intersecting triangles of a frame, with the triangles of all bodies numbered consecutively.
#[derive(Clone, Debug)]
pub(crate) enum Hits {
    /// All pairs, sorted.
    Pairs(Vec<[u32; 2]>),
    /// Triangles only, sorted, since the pairs were too many.
    Triangles(Vec<u32>),
}

/// Shape of a body: its bounding box, and positions in it in units of its longest side.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    pub(crate) lower: [f64; 3],
    /// Longest side of the box; 0 for a point.
    pub(crate) side: f64,
    pub(crate) inside: Vec<[f32; 3]>,
}

impl Motion {
    /// Numbers of bodies, vertices and triangles in the first frame.
    pub fn sizes(&self) -> [usize; 3] {
        self.sizes
    }

    /// Number of intersecting pairs in each frame.
    pub fn pairs(&self) -> &[u64] {
        &self.pairs
    }

    /// Numbers of all frames.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Least and largest depth of places in all frames; `None` if no place has one.
    pub fn depths(&self) -> Option<[f64; 2]> {
        self.depths
    }

    /// Numbers of the frames that the page shows, ascending.
    pub fn shown(&self) -> impl Iterator<Item = u32> {
        let frames = self.frames.iter().filter(|frame| frame.moment.is_none());
        frames.map(|frame| self.numbers[frame.index])
    }

    /// Whether the page shows a frame, by its number.
    pub(crate) fn shows(&self, number: u32) -> bool {
        self.shown().any(|shown| shown == number)
    }

    /// Number of the first frame with an intersection.
    pub fn first_contact(&self) -> Option<u32> {
        let place = self.pairs.iter().position(|&pairs| pairs > 0)?;
        Some(self.numbers[place])
    }

    /// Number of the first frame with the most pairs, and their count. `None` without any pair.
    pub fn worst(&self) -> Option<(u32, u64)> {
        let most = self.pairs.iter().copied().max().filter(|&most| most > 0)?;
        let place = self.pairs.iter().position(|&pairs| pairs == most)?;
        Some((self.numbers[place], most))
    }

    /// Number of frames with an intersection.
    pub fn frames_with_hits(&self) -> usize {
        self.pairs.iter().filter(|&&pairs| pairs > 0).count()
    }
}

impl BodyRecord {
    /// Makes a record. `levels` has the part of each triangle, for each level of the tree.
    pub(crate) fn new(
        id: BodyId,
        number: u32,
        label: BodyLabel,
        vertices: usize,
        triangles: Vec<[u32; 3]>,
        levels: &[Vec<u32>],
    ) -> Self {
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        if let Some(deepest) = levels.last() {
            order.sort_by_key(|&triangle| deepest[triangle as usize]);
        }
        let starts = levels
            .iter()
            .map(|parts| {
                let part = |place: usize| parts[order[place] as usize];
                let is_start = |&place: &usize| place == 0 || part(place) != part(place - 1);
                (0..order.len())
                    .filter(is_start)
                    .map(|place| place as u32)
                    .collect()
            })
            .collect();
        Self {
            id,
            number,
            label,
            vertices,
            triangles,
            order,
            starts,
        }
    }
}

impl Frame {
    /// Size on the page, in bytes, before compression.
    pub(crate) fn cost(&self) -> usize {
        let vertices: usize = self
            .shapes
            .iter()
            .flatten()
            .map(|shape| shape.inside.len())
            .sum();
        let hits = match &self.hits {
            Hits::Pairs(pairs) => 8 * pairs.len(),
            Hits::Triangles(triangles) => 4 * triangles.len(),
        };
        let spots = self.spots.iter().map(|spot| 100 + spot.label.len());
        let moment = self
            .moment
            .iter()
            .map(|moment| 100 + 40 * moment.contacts.len());
        let near = 4 * self.near.len() + 56 * self.gaps.len() + 10 * self.lines.len();
        let deep = 12 * self.deep.len();
        6 * vertices + hits + near + deep + self.made.len() / 8 + spots.chain(moment).sum::<usize>()
    }
}

impl Shape {
    pub(crate) fn of<S: Scalar>(positions: &[[S; 3]]) -> Self {
        if positions.is_empty() {
            return Self {
                lower: [0.0; 3],
                side: 0.0,
                inside: Vec::new(),
            };
        }
        let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for position in positions {
            for axis in 0..3 {
                let x = position[axis].to_f64();
                (lower[axis], upper[axis]) = (lower[axis].min(x), upper[axis].max(x));
            }
        }
        let side = (0..3)
            .map(|axis| upper[axis] - lower[axis])
            .fold(0.0, f64::max);
        let inside = positions
            .iter()
            .map(|position| {
                std::array::from_fn(|axis| {
                    let from_lower = position[axis].to_f64() - lower[axis];
                    if side > 0.0 {
                        (from_lower / side) as f32
                    } else {
                        0.0
                    }
                })
            })
            .collect();
        Self {
            lower,
            side,
            inside,
        }
    }
}
