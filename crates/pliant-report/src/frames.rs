//! What was kept of a motion.

use crate::label::BodyLabel;
use pliant::{BodyId, Scalar};

/// Bodies in motion, as a page can hold them; numbers for every frame, shapes for some.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Bodies, vertices and triangles in all.
    pub(crate) sizes: [usize; 3],
    pub(crate) bodies: Vec<BodyRecord>,
    /// The numbers of all frames.
    pub(crate) numbers: Vec<u32>,
    /// Intersecting pairs in all frames.
    pub(crate) pairs: Vec<u64>,
    /// Ascending.
    pub(crate) frames: Vec<Frame>,
    /// Not even a few frames would fit into a page; then there are no bodies and no frames.
    pub(crate) too_large: bool,
}

/// What does not change while a body has one mesh. Of a body that gets another there is another record, with the same number.
#[derive(Clone, Debug)]
pub(crate) struct BodyRecord {
    pub(crate) id: BodyId,
    /// Of the body on the page, or of the first of its parts.
    pub(crate) number: u32,
    pub(crate) label: BodyLabel,
    pub(crate) vertices: usize,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Triangles in the order of the tree.
    pub(crate) order: Vec<u32>,
    /// For each level where its parts start in `order`.
    pub(crate) starts: Vec<Vec<u32>>,
}

/// One frame.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// Among all frames, from 0.
    pub(crate) place: usize,
    /// Of each record of a body; none of those whose mesh the body has not, or not yet, in this frame.
    pub(crate) shapes: Vec<Option<Shape>>,
    pub(crate) hits: Hits,
    /// Sorted; those of the triangles in `hits` that intersect none, but are close to one.
    pub(crate) near: Vec<u32>,
    /// The nearest first; of very many the nearest.
    pub(crate) gaps: Vec<GapShown>,
    /// Body by body, level by level, part by part: was the box made for this shape?
    pub(crate) made: Vec<bool>,
    /// Where hits hang together, most pairs first; of very many the first.
    pub(crate) spots: Vec<Spot>,
    /// How many there are.
    pub(crate) all_spots: usize,
    /// What meets, of a frame that is none: the bodies are where they are in the next, behind what meets on the way to there.
    pub(crate) moment: Option<Moment>,
}

/// What meets on the way from a frame to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// The number of the next frame.
    pub until: u32,
    /// How many pairs of elements meet on the way; none where only the first was looked for.
    pub count: Option<usize>,
    /// The earliest first. Of very many the page keeps the first.
    pub contacts: Vec<Contact>,
}

/// Two elements that meet on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// When they do, from 0, in the frame, to 1, in the next.
    pub time: f64,
    /// Which they are.
    pub elements: Elements,
}

/// Two elements. Bodies are numbered through, those that are split part by part; vertices and triangles as in the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elements {
    /// Body, vertex, body, triangle.
    VertexTriangle([u32; 4]),
    /// Body and two vertices, twice.
    EdgeEdge([u32; 6]),
}

/// Where hits hang together.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// The same from frame to frame while it is the same place.
    pub number: usize,
    /// How many pairs.
    pub count: usize,
    /// The smallest coordinates of its triangles.
    pub lower: [f64; 3],
    /// The largest.
    pub upper: [f64; 3],
    /// Whose they are. Anything may be in it.
    pub label: String,
}

/// Between two triangles that are close and do not intersect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Body, triangle, body, triangle.
    pub pair: [u32; 4],
    /// How far apart they are.
    pub distance: f64,
    /// A point of each, as far apart as that.
    pub points: [[f64; 3]; 2],
}

/// The same with all bodies' triangles numbered in one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GapShown {
    pub(crate) triangles: [u32; 2],
    pub(crate) points: [[f64; 3]; 2],
}

/// Which triangles intersect; all bodies' triangles are numbered in one row.
#[derive(Clone, Debug)]
pub(crate) enum Hits {
    /// Sorted.
    Pairs(Vec<[u32; 2]>),
    /// Sorted; the pairs were too many.
    Triangles(Vec<u32>),
}

/// The shape of a body: its box, and positions in it from 0 to 1 along its longest side, whatever their magnitude.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    pub(crate) lower: [f64; 3],
    /// The longest side; 0 of a point.
    pub(crate) side: f64,
    pub(crate) inside: Vec<[f32; 3]>,
}

impl Motion {
    /// Bodies, vertices and triangles in all.
    pub fn sizes(&self) -> [usize; 3] {
        self.sizes
    }

    /// Intersecting pairs in each frame.
    pub fn pairs(&self) -> &[u64] {
        &self.pairs
    }

    /// The numbers of the frames.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// The frames that can be shown, by their numbers.
    pub fn shown(&self) -> impl Iterator<Item = u32> {
        let frames = self.frames.iter().filter(|frame| frame.moment.is_none());
        frames.map(|frame| self.numbers[frame.place])
    }

    /// Whether a frame can be shown, by its number.
    pub(crate) fn shows(&self, number: u32) -> bool {
        self.shown().any(|shown| shown == number)
    }

    /// The number of the first frame in which something intersects.
    pub fn first_contact(&self) -> Option<u32> {
        let place = self.pairs.iter().position(|&pairs| pairs > 0)?;
        Some(self.numbers[place])
    }

    /// The first frame with the most pairs, and how many they are, where any intersect.
    pub fn worst(&self) -> Option<(u32, u64)> {
        let most = self.pairs.iter().copied().max().filter(|&most| most > 0)?;
        let place = self.pairs.iter().position(|&pairs| pairs == most)?;
        Some((self.numbers[place], most))
    }

    /// In how many frames something intersects.
    pub fn frames_with_hits(&self) -> usize {
        self.pairs.iter().filter(|&&pairs| pairs > 0).count()
    }
}

impl BodyRecord {
    /// `levels`: for each level the part of each triangle.
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
    /// Bytes of a page, before it is compressed.
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
        let near = 4 * self.near.len() + 56 * self.gaps.len();
        6 * vertices + hits + near + self.made.len() / 8 + spots.chain(moment).sum::<usize>()
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
