//! What boxes are made of.
//!
//! A box over some vertices is the least that holds them, in the sense of its source: where they are now; grown by a distance; at both
//! ends of a motion. The rules that the update relies on hold for every source:
//!
//! - the box over some vertices holds the box over any of them;
//! - it is the union of boxes over parts of them, so boxes of inner nodes may be merged from those of their children, bit for bit.
//!
//! Growing keeps both, because rounding is monotonic.

use crate::geometry::{Aabb, Bounds, Shape};
use crate::ids::TreeVertex;
use crate::kernels::extent::{self, Extent, TWELVE};
use crate::kernels::{Coordinate, Simd};
use std::ops::Range;

/// Which boxes a source gives: two sources of one body give the same if they have the same version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Version {
    /// The version of the shape,
    shape: u64,
    /// and, where boxes hold a second shape as well, that of the second; 0 is before every version.
    second: u64,
    /// The bits of the distance by which boxes are grown.
    grown_by: u32,
}

impl Version {
    /// By how much boxes are grown.
    pub(crate) fn grown_by(self) -> f32 {
        f32::from_bits(self.grown_by)
    }
}

/// Gives the box over any vertices of a body.
pub(crate) trait BoxSource: Sync {
    type Scalar: Coordinate;

    /// The shape that the body has now.
    fn shape(&self) -> &Shape<'_, Self::Scalar>;

    fn version(&self) -> Version;

    /// The box over a run of vertices and some others; there is one at least.
    fn over<I: Simd>(&self, i: I, run: Range<usize>, others: &[TreeVertex]) -> Extent<I>;

    /// The box over twelve vertices: as many as most leaves have.
    fn over_twelve<I: Simd>(&self, i: I, vertices: &[TreeVertex; TWELVE]) -> Extent<I>;

    /// The box over the corners of a triangle.
    fn over_triangle<I: Simd>(&self, i: I, corners: [TreeVertex; 3]) -> Extent<I>;

    /// What all of these mean, one vertex after the other.
    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb;
}

impl<S: Coordinate> BoxSource for Shape<'_, S> {
    type Scalar = S;

    #[inline(always)]
    fn shape(&self) -> &Shape<'_, S> {
        self
    }

    fn version(&self) -> Version {
        Version {
            shape: self.version,
            ..Version::default()
        }
    }

    #[inline(always)]
    fn over<I: Simd>(&self, i: I, run: Range<usize>, others: &[TreeVertex]) -> Extent<I> {
        extent::of_points(i, self, run, others)
    }

    #[inline(always)]
    fn over_twelve<I: Simd>(&self, i: I, vertices: &[TreeVertex; TWELVE]) -> Extent<I> {
        extent::of_twelve(i, self, vertices)
    }

    #[inline(always)]
    fn over_triangle<I: Simd>(&self, i: I, corners: [TreeVertex; 3]) -> Extent<I> {
        extent::of_corners(i, self, corners)
    }

    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb {
        let mut bounds = Bounds::EMPTY;
        vertices.for_each(|vertex| bounds.include(self.positions.get(vertex)));
        bounds.to_box(self.origin)
    }
}

/// Boxes of another source, grown by a distance on every side, and a little more where that is not exact.
#[derive(Clone, Copy)]
pub(crate) struct Grown<B> {
    pub(crate) source: B,
    /// At least 0, and finite.
    pub(crate) distance: f32,
}

impl<B> Grown<B> {
    #[inline(always)]
    fn grow<I: Simd>(&self, i: I, known: Extent<I>) -> Extent<I> {
        extent::grown(i, known, self.distance)
    }
}

impl<B: BoxSource> BoxSource for Grown<B> {
    type Scalar = B::Scalar;

    fn shape(&self) -> &Shape<'_, B::Scalar> {
        self.source.shape()
    }

    fn version(&self) -> Version {
        Version {
            grown_by: self.distance.to_bits(),
            ..self.source.version()
        }
    }

    #[inline(always)]
    fn over<I: Simd>(&self, i: I, run: Range<usize>, others: &[TreeVertex]) -> Extent<I> {
        self.grow(i, self.source.over(i, run, others))
    }

    #[inline(always)]
    fn over_twelve<I: Simd>(&self, i: I, vertices: &[TreeVertex; TWELVE]) -> Extent<I> {
        self.grow(i, self.source.over_twelve(i, vertices))
    }

    #[inline(always)]
    fn over_triangle<I: Simd>(&self, i: I, corners: [TreeVertex; 3]) -> Extent<I> {
        self.grow(i, self.source.over_triangle(i, corners))
    }

    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb {
        self.source.plainly(vertices).grown(self.distance)
    }
}

/// Boxes that hold the shapes at both ends of a motion; of a body that stands still, its shape.
#[derive(Clone, Copy)]
pub(crate) struct Swept<'s, S> {
    pub(crate) from: Shape<'s, S>,
    pub(crate) to: Option<Shape<'s, S>>,
}

impl<S: Coordinate> BoxSource for Swept<'_, S> {
    type Scalar = S;

    #[inline(always)]
    fn shape(&self) -> &Shape<'_, S> {
        &self.from
    }

    fn version(&self) -> Version {
        Version {
            second: self.to.map_or(0, |to| to.version),
            ..self.from.version()
        }
    }

    #[inline(always)]
    fn over<I: Simd>(&self, i: I, run: Range<usize>, others: &[TreeVertex]) -> Extent<I> {
        let from = self.from.over(i, run.clone(), others);
        match &self.to {
            Some(to) => extent::union(from, to.over(i, run, others)),
            None => from,
        }
    }

    #[inline(always)]
    fn over_twelve<I: Simd>(&self, i: I, vertices: &[TreeVertex; TWELVE]) -> Extent<I> {
        let from = self.from.over_twelve(i, vertices);
        match &self.to {
            Some(to) => extent::union(from, to.over_twelve(i, vertices)),
            None => from,
        }
    }

    #[inline(always)]
    fn over_triangle<I: Simd>(&self, i: I, corners: [TreeVertex; 3]) -> Extent<I> {
        let from = self.from.over_triangle(i, corners);
        match &self.to {
            Some(to) => extent::union(from, to.over_triangle(i, corners)),
            None => from,
        }
    }

    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb {
        let from = self.from.plainly(vertices.clone());
        match &self.to {
            Some(to) => from.union(&to.plainly(vertices)),
            None => from,
        }
    }
}

/// What a set of boxes of one body is made of: the shape; or the shape and perhaps the end of a motion, grown.
///
/// Whoever makes boxes matches on it once a batch, with `of_source`.
#[derive(Clone, Copy)]
pub(crate) enum Source<'s, S> {
    Shape(Shape<'s, S>),
    Grown(Grown<Swept<'s, S>>),
}

/// Compiles an expression for every source.
macro_rules! of_source {
    ($source:expr, $it:ident => $body:expr) => {
        match $source {
            $crate::tree::Source::Shape($it) => $body,
            $crate::tree::Source::Grown($it) => $body,
        }
    };
}
pub(crate) use of_source;

impl<'s, S: Coordinate> Source<'s, S> {
    /// Boxes that are grown hold the end of a motion, if there is one.
    pub(crate) fn new(
        shape: Shape<'s, S>,
        end: Option<Shape<'s, S>>,
        grows_by: Option<f32>,
    ) -> Self {
        match grows_by {
            None => Self::Shape(shape),
            Some(distance) => Self::Grown(Grown {
                source: Swept {
                    from: shape,
                    to: end,
                },
                distance,
            }),
        }
    }

    #[inline]
    pub(crate) fn shape(&self) -> &Shape<'s, S> {
        match self {
            Self::Shape(shape) => shape,
            Self::Grown(grown) => &grown.source.from,
        }
    }

    /// The shape at the end of a motion, if boxes hold that too.
    #[inline]
    pub(crate) fn end(&self) -> Option<&Shape<'s, S>> {
        match self {
            Self::Shape(_) => None,
            Self::Grown(grown) => grown.source.to.as_ref(),
        }
    }

    pub(crate) fn version(&self) -> Version {
        of_source!(self, source => source.version())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Points;
    use crate::kernels::{Instructions, dispatch};

    /// All kernels of a source give what it means.
    fn check(source: &impl BoxSource) {
        let vertices = |numbers: &[u32]| -> Vec<TreeVertex> {
            numbers.iter().copied().map(TreeVertex).collect()
        };
        let twelve = [3, 1, 4, 15, 9, 2, 6, 5, 35, 8, 39, 7].map(TreeVertex);
        for instructions in Instructions::all() {
            dispatch!(instructions, i => {
                for (run, others) in [(4..9, &[][..]), (0..40, &[]), (2..2, &[1]), (5..6, &[0, 8]), (0..3, &[7, 5, 9, 11, 30])] {
                    let others = vertices(others);
                    let run_of = run.clone().map(|vertex| TreeVertex(vertex as u32));
                    let expected = source.plainly(run_of.chain(others.iter().copied()));
                    assert_eq!(extent::to_box(source.over(i, run, &others)), expected);
                }
                assert_eq!(extent::to_box(source.over_twelve(i, &twelve)), source.plainly(twelve.into_iter()));
                let corners = [7, 2, 2].map(TreeVertex);
                assert_eq!(extent::to_box(source.over_triangle(i, corners)), source.plainly(corners.into_iter()));
            });
        }
    }

    fn check_all<S: Coordinate>(of: fn(f64) -> S, origin: [f64; 4]) {
        let shape_at = |phase: f64| {
            let wave =
                move |at: usize| [0.3, 1.7, 2.9].map(|x| of((x * at as f64 + phase).sin() * 4.0));
            Points::of((0..40).map(wave))
        };
        let [from, to] = [shape_at(0.0), shape_at(0.8)];
        let shape = |positions, version| Shape {
            positions,
            triangles: &[],
            origin,
            version,
        };
        let (from, to) = (shape(&from, 3), shape(&to, 7));
        check(&from);
        let still = Swept { from, to: None };
        check(&still);
        assert_eq!(still.version(), from.version());
        let hull = Swept { from, to: Some(to) };
        check(&hull);
        for distance in [0.0, 0.1, 1e6] {
            let grown = |source| Grown { source, distance };
            check(&grown(from));
            let swept = Grown {
                source: hull,
                distance,
            };
            check(&swept);
            // A box holds what it is grown from, by the distance at least.
            let vertices = || (0..9).map(TreeVertex);
            let (inner, outer) = (hull.plainly(vertices()), swept.plainly(vertices()));
            for axis in 0..3 {
                let below = f64::from(inner.lo[axis]) - f64::from(outer.lo[axis]);
                let above = f64::from(outer.hi[axis]) - f64::from(inner.hi[axis]);
                assert!(below.min(above) >= f64::from(distance));
            }
            // Versions tell them apart, but for boxes that are grown by nothing.
            assert_ne!(from.version(), hull.version());
            assert_ne!(grown(from).version(), swept.version());
            assert_eq!(from.version() == grown(from).version(), distance == 0.0);
        }
    }

    #[test]
    fn every_source_gives_the_boxes_that_it_means() {
        check_all(|x| x as f32, [0.0; 4]);
        check_all(|x| x, [0.3, -9.0, 1e5, 0.0]);
    }
}
